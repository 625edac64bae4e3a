//! The text of a first job, with its choices explained.

use crate::building::build::built;
use crate::building::built::Built;
use crate::building::contact_guess::{Guess, preload};
use crate::job_file::job::Job;
use crate::texts::outcome::Outcome;
use hbvib::{ContactState, Interrupt};
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

/// Damping ratio of the first mode in a first job.
const DAMPING: f64 = 1e-3;

/// Frequency, relative to the highest that is looked at, of a rigid motion.
const RIGID: f64 = 1e-4;

/// Range of the response about the first natural frequency.
const AROUND: f64 = 0.1;

/// Choices that the arguments make for a job.
pub struct Choices {
    /// Lines of [model] that name the files.
    pub files: String,
    pub has_mesh: bool,
    pub sectors: usize,
    pub engine_order: i64,
    /// Sets of the faces.
    pub faces: Option<[String; 2]>,
    /// Nodes of the mesh may be clamped.
    pub clamped: bool,
    /// Sets of both sides of contacts.
    pub contacts: Vec<(String, String)>,
}

impl Choices {
    /// The part on the model, which decides about all other parts.
    fn model(&self) -> String {
        let mut text = format!("[model]\n{}", self.files);
        if self.sectors > 1 {
            let _ = writeln!(text, "sectors = {}", self.sectors);
        }
        if self.sectors > 1 || self.engine_order != 0 {
            let _ = writeln!(
                text,
                "engine_order = {}                    # sector s + 1 lags by 360 deg EO / sectors",
                self.engine_order
            );
        }
        if self.clamped {
            text += "absent = \"fixed\"                    # nodes of the mesh without rows are clamped\n";
        }
        if let Some([left, right]) = &self.faces {
            let _ = write!(
                text,
                "\n[model.faces]                       # sets of nodes of the mesh, paired by position\nleft = {left:?}\nright = {right:?}\n\
                 axis = [0, 0, 1]                    # direction = -1 where sector s + 1 follows against its sense\n"
            );
        }
        text
    }
}

/// A job and the model that it was made for.
pub struct Written {
    pub text: String,
    pub built: Built,
    /// First natural frequency that is not of a rigid motion, Hz.
    pub first_hz: f64,
}

/// The text of a job on matrices that are there: the response about their first natural frequency, excited where the mode moves most.
///
/// # Errors
/// A sentence: matrices that cannot be read, no vibration.
pub fn text(choices: &Choices, folder: &Path) -> Outcome<Written> {
    let model = choices.model();
    let bare = Job::parse(&model, folder)?;
    let first = built(&bare)?;
    let guesses: Outcome<Vec<Guess>> = choices
        .contacts
        .iter()
        .map(|(a, b)| Guess::of(&first, (a, b)))
        .collect();
    let guesses = guesses?;
    let contacts = |preload: f64| guesses.iter().map(|guess| guess.text(preload)).collect::<String>();
    let built = if guesses.is_empty() {
        first
    } else {
        built(&Job::parse(&format!("{model}{}", contacts(1.0)), folder)?)?
    };
    let mode = first_mode(&built)?;
    let (first_hz, dof) = (mode.first_hz, mode.dof);
    let contacts = contacts(preload(&built, &mode.shape, (TAU * mode.stuck_hz, DAMPING, dof)));
    let beta = 2.0 * DAMPING / (TAU * mode.stuck_hz);
    let mut name = built.nodes.name_of(dof);
    if name.contains('.') {
        name = format!("{name:?}");
    }
    let damped = format!(
        "{:<36}# C = beta K: damping ratio {DAMPING} at {:.4} Hz; measure it\n",
        format!("rayleigh = [0.0, {beta:.3e}]"),
        mode.stuck_hz
    );
    let model = match model.split_once("\n[model.faces]") {
        Some((before, after)) => format!("{before}{damped}\n[model.faces]{after}"),
        None => format!("{model}{damped}"),
    };
    let mut text = format!(
        "# A first job, written by hbvib init. Lengths, forces and masses have the units of the matrices.\n\
         # hbvib check job.toml reports on the model; hbvib schema has all keys.\n\n{model}\n"
    );
    if guesses.is_empty() {
        text += &sample_contact(choices.has_mesh, &name);
    } else {
        text += &contacts[1..];
        text += "\n";
    }
    let (from_hz, to_hz) = ((1.0 - AROUND) * mode.stuck_hz, (1.0 + AROUND) * mode.stuck_hz);
    let _ = write!(
        text,
        "[[force]]                           # Re(value exp(i omega t))\n{:<36}# where the first mode moves most\nvalue = 1.0\n\n\
         [forced]                            # about the first natural frequency, with stuck contacts\nfrom_hz = {from_hz:.6}\n\
         to_hz = {to_hz:.6}\nresponse_dof = {name}\n\
         harmonics = 3                       # fixed; instead, tolerance = 1e-3 chooses them at each point\n\n",
        format!("dof = {name}"),
    );
    text += "[output]\ncsv = \"response.csv\"\nnpz = \"response.npz\"                # all harmonics; [restart] goes on from it\nfigure = \"response.svg\"\nreport = \"report.html\"              # all of it on one page\n";
    if choices.has_mesh && !built.nodes.numbers().is_empty() {
        text += "vtu = \"motion.pvd\"                  # ParaView\n";
    }
    // It must run.
    Job::parse(&text, folder)?;
    Ok(Written { text, built, first_hz })
}

/// A contact that the user completes.
fn sample_contact(has_mesh: bool, name: &str) -> String {
    let mut text = String::from(
        "# [[contact]]                       # friction and gaps: remove the marks and choose\n# name = \"joint\"\n# kind = \"jenkins\"                  \
         # friction_3d, friction_2d, unilateral, cubic, regularised\n",
    );
    if has_mesh {
        text = text.replace("jenkins\"                  ", "friction_3d\"              ");
        text += "# normal = [0, 0, 1]                # from side b to side a\n# kt = 1e7\n# kn = 1e7\n# mu = 0.3\n# preload = 10.0\n\
                 # [contact.nodes]\n# a = \"SIDE_A\"                      # sets of nodes of the mesh\n# b = \"SIDE_B\"\n# largest_distance = 1e-3\n\n";
    } else {
        let _ = write!(
            text,
            "# a = [0]                           # degrees of freedom from 0; the force acts on {name}\n# b = [-1]                          # the ground\n\
             # kt = 1e7\n# mu = 0.3\n# preload = 10.0\n\n"
        );
    }
    text
}

/// The first mode that is not rigid, with stuck contacts.
struct FirstMode {
    /// Without contacts.
    first_hz: f64,
    stuck_hz: f64,
    shape: Vec<Complex64>,
    /// Degree of freedom that moves most.
    dof: usize,
}

fn first_mode(built: &Built) -> Outcome<FirstMode> {
    let model = &built.model;
    let structure = model.structure();
    let diameter = structure.signed_diameter(structure.engine_order());
    let said = |e: hbvib::Error| format!("natural frequencies: {e}");
    let rigid = model.rigid_modes(diameter, &Interrupt::none()).map_err(said)?;
    let count = (rigid + 1).min(structure.ndof());
    let free = model.lowest_modes(diameter, ContactState::Free, count).map_err(said)?;
    let stuck = model.lowest_modes(diameter, ContactState::Stuck, count).map_err(said)?;
    let elastic = |omega: &[f64]| {
        let highest = omega.last().map_or(0.0, |w| w.abs());
        omega.iter().position(|w| *w > RIGID * highest)
    };
    let (Some(a), Some(b)) = (elastic(&free.omega), elastic(&stuck.omega)) else {
        return Err("no natural frequency above zero was found: check stiffness and mass".into());
    };
    let shape = stuck.shapes[b * model.ndof()..(b + 1) * model.ndof()].to_vec();
    // Rotations, internal nodes and generalised coordinates are no places for a force.
    let named = !built.nodes.numbers().is_empty();
    let may = |dof: &usize| !named || built.nodes.name_of(*dof).contains('.');
    let most = (0..shape.len())
        .filter(may)
        .max_by(|i, j| shape[*i].norm().total_cmp(&shape[*j].norm()));
    Ok(FirstMode {
        first_hz: free.omega[a] / TAU,
        stuck_hz: stuck.omega[b] / TAU,
        dof: most.ok_or("no degree of freedom moves")?,
        shape,
    })
}
