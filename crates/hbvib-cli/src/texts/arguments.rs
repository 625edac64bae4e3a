//! Arguments of the command, from which its help, the completions of shells and the page for `man` are made.

use clap::{Parser, Subcommand, ValueEnum};
use std::ffi::OsString;
use std::path::PathBuf;

/// Exit codes, as the help tells them.
const CODES: &str = "\
Exit codes, the first that applies:
  1  an error: nothing was computed, or one of several analyses failed; wrong arguments
  4  an output could not be made; all others are there
  2  the run ended early (Ctrl-C, SIGTERM, a range that was not finished); what it found is written
  3  integration in time finds another solution than a verified point
  0  all is done";

/// Examples of the first page of the help.
const EXAMPLES: &str = "\
Examples:
  hbvib init --stiffness k.mtx --mass m.mtx   # writes job.toml, which runs
  hbvib check job.toml                        # reads all files and reports on the model
  hbvib run job.toml                          # or: hbvib job.toml
  hbvib run --log json job.toml 2> log.jsonl  # a line of JSON for each event";

/// Steady-state vibration of structures with friction contacts, from a job file in TOML.
#[derive(Debug, Parser)]
#[command(name = "hbvib", version, arg_required_else_help = true, after_help = format!("{EXAMPLES}\n\n{CODES}"))]
pub struct Arguments {
    #[command(subcommand)]
    pub verb: Verb,
    /// Form of messages on standard error: lines of JSON have no progress bar.
    #[arg(long, global = true, value_enum, default_value_t = LogForm::Text, value_name = "FORM")]
    pub log: LogForm,
}

/// Form of the messages on standard error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LogForm {
    /// Sentences, and a progress bar on a terminal.
    Text,
    /// A line of JSON for each event, for a pipe.
    Json,
}

/// Shells whose completions are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ShellName {
    Bash,
    Zsh,
    Fish,
}

/// Ways to reduce a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MethodName {
    /// Static motion under displacements of the kept degrees of freedom, and modes with these fixed.
    CraigBampton,
    /// Static motion under forces on the kept degrees of freedom, and modes with these free (MacNeal, Rubin).
    FreeInterface,
}

/// Verbs of the command.
#[derive(Debug, Subcommand)]
pub enum Verb {
    /// Writes a small job, a bladed disk with a friction ring, runs it, and tells where its pictures are.
    #[command(after_help = "\
Examples:
  hbvib demo                     # into the folder hbvib-demo, which must not be there yet
  hbvib demo --open first        # into the folder first, and shows the report")]
    Demo {
        /// The new folder.
        #[arg(default_value = "hbvib-demo")]
        folder: PathBuf,
        /// Opens the report with the program of the desktop.
        #[arg(long)]
        open: bool,
    },
    /// Solves a job and writes what it names.
    #[command(after_help = format!(
        "Examples:\n  hbvib run job.toml\n  hbvib run --strict job.toml   # warnings on the model are errors\n\n{CODES}"
    ))]
    Run(JobArguments),
    /// Fits parameters of the model of a job to data of tests: its parts [fit] and [[data]].
    #[command(after_help = format!("Example:\n  hbvib fit job.toml\n\n{CODES}"))]
    Fit(JobArguments),
    /// Reads a job and its files, builds the model, and reports on it without solving.
    #[command(after_help = "\
Examples:
  hbvib check job.toml
  hbvib check --strict job.toml          # exit code 1 where there are warnings
  hbvib check --json job.toml | jq .contacts")]
    Check {
        #[command(flatten)]
        of: JobArguments,
        /// Writes the report as JSON.
        #[arg(long)]
        json: bool,
    },
    /// Lists natural frequencies of all nodal diameters as CSV, with free and with stuck contacts.
    ///
    /// The job needs no analysis.
    #[command(after_help = "Example:\n  hbvib modes job.toml > modes.csv")]
    Modes(JobArguments),
    /// Writes a first job, with comments, that runs: from matrices, or from a mesh whose matrices CalculiX makes.
    ///
    /// The response is that about the first natural frequency, and the force acts where its mode moves most.
    #[command(after_help = "\
Examples:
  hbvib init --stiffness k.mtx --mass m.mtx
  hbvib init --matrices wheel.sti --mesh wheel.inp --sectors 24 --engine-order 3
  hbvib init --mesh wheel.inp --fixed BORE --sectors 24 --engine-order 3 --contact RING:RIM   # ccx makes the matrices
  hbvib init --mesh blade.inp --young 210e3 --density 7.85e-9                                 # mm, N, t")]
    Init(Box<InitArguments>),
    /// Converts matrix files between the formats that are read and written.
    ///
    /// Read: Matrix Market, CalculiX, Abaqus, user elements, OP4, DMIG, Ansys .full and Harwell-Boeing, NumPy, MATLAB. Written: OP4,
    /// DMIG, user elements, NumPy and scipy, Matrix Market.
    #[command(after_help = "\
Examples:
  hbvib convert wheel.sti --output wheel.op4
  hbvib convert --stiffness k.mtx --mass m.mtx --output wheel.pch   # DMIG
  hbvib convert wheel.op4 --output wheel.mtx                        # wheel_stiffness.mtx, wheel_mass.mtx
  hbvib convert wheel.op4 --format op4-binary --output other.op4")]
    Convert(ConvertArguments),
    /// Reduces the model of a job by Craig-Bampton or with a free interface, tells the error, and writes the matrices and a job on them.
    ///
    /// Degrees of freedom of faces, contacts, forces and responses stay; all others follow them statically, and by natural modes: with
    /// these degrees of freedom fixed (craig-bampton), or free (free-interface). Free modes are the structure's own: all that are taken
    /// are exact, and rigid motions are always among them.
    #[command(after_help = "\
Examples:
  hbvib reduce job.toml --output reduced.npz                # and reduced.toml, which runs
  hbvib reduce job.toml --modes 100 --output reduced.pch    # DMIG
  hbvib reduce job.toml --method free-interface --output reduced.npz
  hbvib reduce job.toml --up-to-hz 5000 --keep 12.3 --output reduced.op4")]
    Reduce(ReduceArguments),
    /// Makes the matrices of a sector that the static step of a CalculiX deck has loaded, as by rotation.
    ///
    /// The deck has one *STATIC step with all loads, and may have cyclic symmetry and contacts. Its displacements are prescribed on the
    /// sector alone, and released in a perturbation that stores the matrices: neither symmetry nor contacts are in them.
    #[command(after_help = "\
Examples:
  hbvib prestress static.inp                              # static_prestressed.sti, .mas and .dof
  hbvib prestress static.inp --speed 800 --output at_800.sti
  hbvib prestress static.inp --nodes FACES,CONTACT        # where constraints tie nodes")]
    Prestress(PrestressArguments),
    /// Draws stored responses (.npz of [output]), several of them in one figure.
    #[command(after_help = "\
Examples:
  hbvib plot response.npz --output response.svg
  hbvib plot one.npz two.npz --log-y --markers --unit mm --output both.png
  hbvib plot response.npz --dof 12.3 --output harmonics.svg # node 12 along z, a line for each harmonic
  hbvib plot mode.npz --damping --output damping.svg")]
    Plot(PlotArguments),
    /// Prints the JSON schema of a job, for editors that complete and check TOML.
    #[command(after_help = "Example:\n  hbvib schema > job.schema.json")]
    Schema,
    /// Prints completions of a shell.
    #[command(after_help = "\
Examples:
  hbvib completions bash > ~/.local/share/bash-completion/completions/hbvib
  hbvib completions zsh > ~/.zfunc/_hbvib
  hbvib completions fish > ~/.config/fish/completions/hbvib.fish")]
    Completions {
        #[arg(value_enum)]
        shell: ShellName,
    },
    /// Prints the manual page of the command.
    #[command(after_help = "Example:\n  hbvib man > hbvib.1 && man ./hbvib.1")]
    Man,
}

/// Files and choices of a first job.
#[derive(Debug, clap::Args)]
pub struct InitArguments {
    /// File of the stiffness matrix.
    #[arg(long, value_name = "FILE", requires = "mass", conflicts_with = "matrices")]
    pub stiffness: Option<PathBuf>,
    /// File of the mass matrix.
    #[arg(long, value_name = "FILE", requires = "stiffness")]
    pub mass: Option<PathBuf>,
    /// File of the damping matrix.
    #[arg(long, value_name = "FILE")]
    pub damping: Option<PathBuf>,
    /// One file with all matrices (CalculiX, OP4, DMIG, user elements).
    #[arg(long, value_name = "FILE")]
    pub matrices: Option<PathBuf>,
    /// Mesh of Abaqus, CalculiX or gmsh (.inp); without matrices CalculiX makes them.
    #[arg(long, value_name = "FILE")]
    pub mesh: Option<PathBuf>,
    /// Number of sectors of a wheel.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub sectors: usize,
    /// Engine order of the excitation.
    #[arg(long, value_name = "EO", default_value_t = 0, allow_negative_numbers = true)]
    pub engine_order: i64,
    /// Sets of nodes of both faces of a sector.
    #[arg(long, value_name = "SET", default_value = "LEFT")]
    pub left: String,
    #[arg(long, value_name = "SET", default_value = "RIGHT")]
    pub right: String,
    /// Sets of nodes that are clamped, where CalculiX makes the matrices.
    #[arg(long, value_name = "SET", value_delimiter = ',')]
    pub fixed: Vec<String>,
    /// Sets of nodes on both sides of a contact.
    #[arg(long, value_name = "A:B", value_delimiter = ',')]
    pub contact: Vec<String>,
    /// Young's modulus, where CalculiX makes the matrices; the defaults are steel in SI units.
    #[arg(long, value_name = "E", default_value_t = 2.1e11)]
    pub young: f64,
    /// Poisson's ratio.
    #[arg(long, value_name = "NU", default_value_t = 0.3)]
    pub poisson: f64,
    /// Density.
    #[arg(long, value_name = "RHO", default_value_t = 7850.0)]
    pub density: f64,
    /// Program of CalculiX.
    #[arg(long, value_name = "PROGRAM", default_value = "ccx")]
    pub ccx: String,
    /// File of the job.
    #[arg(long, short, value_name = "FILE", default_value = "job.toml")]
    pub output: PathBuf,
    /// Replaces a job that is there.
    #[arg(long)]
    pub overwrite: bool,
}

/// Files that are converted.
#[derive(Debug, clap::Args)]
pub struct ConvertArguments {
    /// File with one matrix or several.
    #[arg(value_name = "FILE", required_unless_present_any = ["stiffness", "mass"])]
    pub matrices: Option<PathBuf>,
    /// File of the stiffness matrix.
    #[arg(long, value_name = "FILE")]
    pub stiffness: Option<PathBuf>,
    /// File of the mass matrix.
    #[arg(long, value_name = "FILE")]
    pub mass: Option<PathBuf>,
    /// File of the damping matrix.
    #[arg(long, value_name = "FILE")]
    pub damping: Option<PathBuf>,
    /// File of the matrix of structural damping.
    #[arg(long, value_name = "FILE")]
    pub structural: Option<PathBuf>,
    /// File that is written; its name tells the format: .op4, .pch (DMIG), .inp (user element), .npz, .mtx.
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
    /// Format that is written: op4, op4-binary, dmig, user-element, npz, matrix-market.
    #[arg(long, value_name = "FORMAT")]
    pub format: Option<String>,
    /// Replaces a file that is there.
    #[arg(long)]
    pub overwrite: bool,
}

/// A job whose model is reduced.
#[derive(Debug, clap::Args)]
pub struct ReduceArguments {
    /// File of the job.
    #[arg(value_name = "JOB.TOML")]
    pub job: PathBuf,
    /// File of the reduced matrices; its name tells the format, as in convert.
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
    /// Format that is written, as in convert.
    #[arg(long, value_name = "FORMAT")]
    pub format: Option<String>,
    /// Modes that are taken: with the kept degrees of freedom fixed, or free.
    #[arg(long, value_enum, default_value_t = MethodName::CraigBampton)]
    pub method: MethodName,
    /// Number of modes; as many as the tolerance needs unless given. Rigid motions with a free interface are taken beyond it.
    #[arg(long, value_name = "N", conflicts_with = "up_to_hz")]
    pub modes: Option<usize>,
    /// Largest relative error of natural frequencies up to half above the range of [forced], or of the first three without it.
    #[arg(long, value_name = "ERROR", default_value_t = 1e-6, conflicts_with_all = ["modes", "up_to_hz"])]
    pub tolerance: f64,
    /// Frequency up to which all of these modes are taken.
    #[arg(long, value_name = "HZ")]
    pub up_to_hz: Option<f64>,
    /// More degrees of freedom that stay, by number or as 12.3.
    #[arg(long, value_name = "DOF", value_delimiter = ',')]
    pub keep: Vec<String>,
}

/// A deck with a static step.
#[derive(Debug, clap::Args)]
pub struct PrestressArguments {
    /// Deck of CalculiX with one *STATIC step.
    #[arg(value_name = "DECK.INP")]
    pub deck: PathBuf,
    /// Speed of rotation, in rad per time unit, in place of that of the centrifugal loads of the deck.
    #[arg(long, value_name = "OMEGA")]
    pub speed: Option<f64>,
    /// Sets of nodes whose displacements are prescribed; all nodes of elements unless given.
    #[arg(long, value_name = "SET", value_delimiter = ',')]
    pub nodes: Vec<String>,
    /// File of the stiffness; mass and names of rows are beside it. That of the deck with _prestressed.sti unless given.
    #[arg(long, short, value_name = "FILE.STI")]
    pub output: Option<PathBuf>,
    /// Program of CalculiX.
    #[arg(long, value_name = "PROGRAM", default_value = "ccx")]
    pub ccx: String,
}

/// Stored responses, and what is drawn of them.
#[allow(clippy::struct_excessive_bools, reason = "switches of a command line")]
#[derive(Debug, clap::Args)]
pub struct PlotArguments {
    /// Files of [output], npz.
    #[arg(value_name = "RESPONSE.NPZ", required = true)]
    pub responses: Vec<PathBuf>,
    /// File of the figure: .svg or .png.
    #[arg(long, short, value_name = "FILE", default_value = "response.svg")]
    pub output: PathBuf,
    /// Amplitude of each harmonic of a degree of freedom, by number from 0 or as 12.3, instead of the response.
    #[arg(long, value_name = "DOF")]
    pub dof: Option<String>,
    /// This harmonic alone.
    #[arg(long, value_name = "H", requires = "dof")]
    pub harmonic: Option<usize>,
    /// A response of [[response]], from 0.
    #[arg(long, value_name = "N", conflicts_with = "dof")]
    pub response: Option<usize>,
    /// The largest slip fraction of all contacts.
    #[arg(long, conflicts_with_all = ["dof", "response"])]
    pub slip: bool,
    /// The damping ratio of a nonlinear mode over its amplitude.
    #[arg(long, conflicts_with_all = ["dof", "response", "slip"])]
    pub damping: bool,
    /// Logarithmic axis of the frequency.
    #[arg(long)]
    pub log_x: bool,
    /// Logarithmic axis of the amplitude.
    #[arg(long)]
    pub log_y: bool,
    /// A mark at each point.
    #[arg(long)]
    pub markers: bool,
    /// Unit of the amplitude, for its axis.
    #[arg(long, value_name = "UNIT")]
    pub unit: Option<String>,
    /// Title of the figure.
    #[arg(long, value_name = "TEXT")]
    pub title: Option<String>,
}

/// A job, and how strictly it is taken.
#[derive(Debug, clap::Args)]
pub struct JobArguments {
    /// File of the job; its paths are relative to its folder.
    #[arg(value_name = "JOB.TOML")]
    pub job: PathBuf,
    /// Warnings on the model are errors.
    #[arg(long)]
    pub strict: bool,
}

/// Options before a job or a verb that take a value of their own.
const WITH_VALUE: &str = "--log";

/// The words of the command line; a job alone is one to run.
pub fn words(given: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let mut words: Vec<OsString> = given.collect();
    let mut at = 1;
    while let Some(word) = words.get(at).and_then(|word| word.to_str()) {
        match word {
            WITH_VALUE => at += 2,
            _ if word.starts_with('-') => at += 1,
            _ => break,
        }
    }
    let is_job = |word: &OsString| {
        PathBuf::from(word)
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("toml"))
    };
    if words.get(at).is_some_and(is_job) {
        words.insert(1, "run".into());
    }
    words
}

#[cfg(test)]
mod tests {
    use super::{Arguments, words};
    use clap::CommandFactory;

    #[test]
    fn the_description_contradicts_itself_nowhere() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn a_job_alone_is_run() {
        let of = |line: &str| {
            let words = words(line.split(' ').map(Into::into));
            words.join(std::ffi::OsStr::new(" ")).into_string().unwrap()
        };
        assert_eq!(of("hbvib job.toml"), "hbvib run job.toml");
        assert_eq!(
            of("hbvib --log json --strict a/b.TOML"),
            "hbvib run --log json --strict a/b.TOML"
        );
        for line in [
            "hbvib",
            "hbvib check job.toml",
            "hbvib --log json modes job.toml",
            "hbvib job",
            "hbvib --version",
        ] {
            assert_eq!(of(line), line);
        }
    }
}
