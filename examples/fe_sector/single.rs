//! One response as the flags describe it: a summary on the screen and, on request, a JSON file.

use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use hbvib::SolverOptions;

use crate::cost;
use crate::flags::{self, Flag, Flags};
use crate::json::write_json;
use crate::progress::Bar;
use crate::response::{Point, Range, Response};
use crate::sector::{Sector, Size};

/// The flags of the program.
pub const FLAGS: [Flag; 10] = [
    Flag::new("--force", "N", "amplitude of the force at the blade tip (2)"),
    Flag::new("--harmonics", "H", "highest harmonic number (3)"),
    Flag::new(
        "--tolerance",
        "e",
        "relative error of the tip, from which the harmonics follow",
    ),
    Flag::new("--model", "rom|full", "reduced or full sector (rom)"),
    Flag::new("--from", "Hz", "beginning of the range (512)"),
    Flag::new("--to", "Hz", "end of the range (548)"),
    Flag::new(
        "--at-hz",
        "f",
        "list the solutions at exactly this frequency; repeatable",
    )
    .repeatable(),
    Flag::new("--data", "FOLDER", "read the sector from here (examples/data/fe)"),
    Flag::new("--json", "FILE", "write the response to this file"),
    Flag::new("--help", "", "show this text"),
];

/// Range of frequency that shows the resonance of the blade from sticking (537 Hz) to sliding (528 Hz).
pub const RANGE: (f64, f64) = (512.0, 548.0);

/// The text of `--help`.
pub fn help() -> String {
    format!(
        "HarmonicBalance response of a finite-element sector with a friction ring under its rim.\n\n\
         Without flags: natural frequencies, responses to 0.2 and 2 N and maps of the slip in the contact, as\n\
         CSV, SVG and PNG under target/fe_sector/.\n\
         With flags: one response; what is not given has the value in brackets.\n\n{}",
        flags::table(&FLAGS)
    )
}

/// One requested response.
#[derive(Clone, Debug)]
pub struct Request {
    size: Size,
    force: f64,
    solver: SolverOptions,
    range: Range,
    folder: PathBuf,
    json: Option<PathBuf>,
}

impl Request {
    /// Interprets the flags; `folder` holds the data if no flag names one.
    ///
    /// # Errors
    ///
    /// A sentence naming the flag whose value cannot be used.
    pub fn new(flags: &Flags, folder: &Path) -> Result<Self, String> {
        let force = flags.amount("--force")?;
        let size = match flags.value("--model", "rom or full", |_: &String| true)?.as_deref() {
            None | Some("rom") => Size::Reduced,
            Some("full") => Size::Full,
            Some(other) => return Err(format!("--model {other}: needs rom or full")),
        };
        let mut solver = SolverOptions {
            harmonics: 3,
            tolerance: 0.0,
            ..SolverOptions::default()
        };
        if let Some(highest) = flags.value("--harmonics", "an integer of at least 1", |h: &usize| *h >= 1)? {
            solver.harmonics = highest;
        }
        solver.check().map_err(|e| format!("--harmonics: {e}"))?;
        if let Some(tolerance) = flags.positive("--tolerance")? {
            solver.tolerance = tolerance;
            solver.check().map_err(|e| format!("--tolerance: {e}"))?;
        }
        let range = Range {
            from: flags.positive("--from")?.unwrap_or(RANGE.0),
            to: flags.positive("--to")?.unwrap_or(RANGE.1),
            at: flags.values("--at-hz", "a finite number above 0", flags::is_positive)?,
        };
        // A downward sweep must be explicit: it requires both ends.
        if !(flags.has("--from") && flags.has("--to")) && range.from >= range.to {
            return Err(format!(
                "--from or --to lies outside of the default range of {} to {} Hz; give both",
                RANGE.0, RANGE.1
            ));
        }
        let (low, high) = (range.from.min(range.to), range.from.max(range.to));
        if let Some(f) = range.at.iter().find(|f| **f < low || **f > high) {
            return Err(format!("--at-hz {f}: needs a frequency within {low} to {high} Hz"));
        }
        Ok(Self {
            size,
            force: force.unwrap_or(2.0),
            solver,
            range,
            folder: flags.path("--data").unwrap_or_else(|| folder.to_owned()),
            json: flags.path("--json"),
        })
    }

    /// Computes the response, shows its peak and the requested solutions, and writes the file.
    ///
    /// # Errors
    ///
    /// If the data cannot be read, the response cannot be computed to its end or the file cannot be
    /// written.
    pub fn run(&self, screen: &mut impl Write) -> Result<(), Box<dyn Error>> {
        let begin = Instant::now();
        let sector = Sector::read(&self.folder, self.size)?;
        let read = begin.elapsed();
        let mut bar = Bar::new("response", 100);
        let tip = [self.size.tip()];
        let model = sector.forced(self.force)?;
        let response = Response::follow(&model, &self.solver, &self.range, &tip, |share| bar.set(share))?;
        bar.finish();
        if response.stalled {
            eprintln!("note: rounding kept the residual of some points above the solver's tolerance");
        }
        if let Some(path) = &self.json {
            write_json(path, &response.to_json("amplitude_tip_m", &["tip"])?)?;
        }
        let (from, to) = (self.range.from, self.range.to);
        writeln!(screen, "{} points from {from} Hz to {to} Hz", response.points.len())?;
        show(screen, "peak", &response.peak)?;
        for point in &response.at {
            show(screen, "at", point)?;
        }
        cost::show(screen, read, &model, &response)?;
        if let Some(path) = &self.json {
            writeln!(screen, "written to {}", path.display())?;
        }
        Ok(())
    }
}

fn show(screen: &mut impl Write, what: &str, point: &Point) -> std::io::Result<()> {
    let (frequency, amplitude) = (point.frequency, point.amplitude());
    writeln!(
        screen,
        "{what:<5}{frequency:.9} Hz   |X_1| of the tip {amplitude:.9e} m"
    )
}
