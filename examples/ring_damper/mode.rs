//! One nonlinear mode as the flags describe it: a summary on the screen and, on request, a JSON file.

use std::error::Error;
use std::io::Write;
use std::path::PathBuf;

use hbvib::{DampingForm, SolverOptions};

use crate::backbone::{Backbone, ModeRequest, Point};
use crate::flags::{self, Flag, Flags};
use crate::json::write_json;
use crate::model::{DOFS, LARGEST_DIAMETER, Parameters};
use crate::progress::{Bar, write_stderr};
use crate::single::{self, solver_options};

/// The flags that only a mode has.
pub const FLAGS: [Flag; 7] = [
    Flag::new("--mode", "", "compute a nonlinear mode instead of a response"),
    Flag::new("--diameter", "n", "nodal diameter, 0 to 12 (2)"),
    Flag::new(
        "--family",
        "k",
        "number of the mode by rising frequency, ring stuck, 1 to 4 (1)",
    ),
    Flag::new(
        "--mode-damping",
        "mass|stiffness",
        "form of the artificial damping (mass)",
    ),
    Flag::new("--from-slip", "a", "slip at the beginning of the range (0.5)"),
    Flag::new("--to-slip", "a", "slip at the end of the range (1e4)"),
    Flag::new("--at-slip", "a", "list every passage of exactly this slip; repeatable").repeatable(),
];

/// Text of the help about modes beside their flags.
pub const NOTE: &str = "Slip a is the peak of the fundamental of the relative motion of disk and ring, over the motion mu N0/kt at\n\
    which the contact begins to slip: up to a = 1 the ring sticks. max_damping in the JSON is the largest\n\
    maximum of the damping ratio inside the range; where there is none, it is null.\n";

/// Slip at the ends of the range if the flags do not set it: from stuck to sliding.
const RANGE: (f64, f64) = (0.5, 1e4);

/// One requested mode.
#[derive(Clone, Debug)]
pub struct Request {
    requested: ModeRequest,
    solver: SolverOptions,
    json: Option<PathBuf>,
}

impl Request {
    /// Interprets the flags.
    ///
    /// # Errors
    ///
    /// A sentence naming the flag whose value cannot be used.
    pub fn new(flags: &Flags) -> Result<Self, String> {
        if let Some(name) = flags.first_of(&single::FLAGS) {
            return Err(format!("{name} belongs to a response, it cannot be given with --mode"));
        }
        let positive = |name: &str, default: f64| Ok::<f64, String>(flags.positive(name)?.unwrap_or(default));
        let base = Parameters::default();
        let diameter = flags.value(
            "--diameter",
            &format!("an integer 0 to {LARGEST_DIAMETER}"),
            |d: &i64| (0..=LARGEST_DIAMETER).contains(d),
        )?;
        let family = flags.value("--family", &format!("an integer 1 to {}", DOFS.len()), |k: &usize| {
            (1..=DOFS.len()).contains(k)
        })?;
        let damping = match flags
            .value("--mode-damping", "mass or stiffness", |_: &String| true)?
            .as_deref()
        {
            None | Some("mass") => DampingForm::Mass,
            Some("stiffness") => DampingForm::Stiffness,
            Some(other) => return Err(format!("--mode-damping {other}: needs mass or stiffness")),
        };
        let requested = ModeRequest {
            parameters: Parameters {
                ring_mass: positive("--ring-mass", base.ring_mass)?,
                rpm: positive("--rpm", base.rpm)?,
                engine_order: diameter.unwrap_or(base.engine_order),
                kt: positive("--kt", base.kt)?,
                beta: flags.amount("--beta")?.unwrap_or(0.0),
                ..base
            },
            family: family.unwrap_or(1),
            damping,
            from: positive("--from-slip", RANGE.0)?,
            to: positive("--to-slip", RANGE.1)?,
            at: flags.values("--at-slip", "a finite number above 0", flags::is_positive)?,
        };
        let (from, to) = (requested.from, requested.to);
        if from >= to {
            return Err(format!("--from-slip {from} needs to be below --to-slip {to}"));
        }
        if let Some(slip) = requested.at.iter().find(|a| **a < from || **a > to) {
            return Err(format!("--at-slip {slip}: needs a slip within {from} to {to}"));
        }
        requested
            .check()
            .map_err(|e| format!("--from-slip, --to-slip, --at-slip: {e}"))?;
        Ok(Self {
            requested,
            solver: solver_options(flags)?,
            json: flags.path("--json"),
        })
    }

    /// Computes the mode, shows its ends, its largest damping and the requested points, and writes the file.
    ///
    /// # Errors
    ///
    /// If the mode cannot be computed to its end or the file cannot be written.
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let mut bar = Bar::new("Mode, percent", 100);
        let mode = Backbone::follow(&self.requested, &self.solver, |share| bar.set(share))?;
        bar.finish();
        if mode.stalled {
            write_stderr("note: rounding kept the residual of some points above the solver's tolerance\n");
        }
        if mode.max_damping.is_none() {
            write_stderr("note: the damping ratio has no maximum inside the range, max_damping is null\n");
        }
        if mode.missed {
            write_stderr("note: some points miss the tolerance, or their error is unknown: see their error_estimate\n");
        }
        if let Some(path) = &self.json {
            write_json(path, &mode.to_json()?)?;
        }
        let mut screen = std::io::stdout().lock();
        let (from, to) = (self.requested.from, self.requested.to);
        writeln!(screen, "{} points from slip {from} to {to}", mode.points.len())?;
        for end in mode.points.first().into_iter().chain(mode.points.last()) {
            show(&mut screen, "end", end)?;
        }
        if let Some(peak) = &mode.max_damping {
            show(&mut screen, "peak", peak)?;
        }
        for point in &mode.at {
            show(&mut screen, "at", point)?;
        }
        if let Some(path) = &self.json {
            writeln!(screen, "written to {}", path.display())?;
        }
        Ok(())
    }
}

fn show(screen: &mut impl Write, what: &str, point: &Point) -> std::io::Result<()> {
    writeln!(
        screen,
        "{what:<5}slip {:.9e}   {:.9} Hz   damping ratio {:.9e}   energy {:.9e} J",
        point.slip, point.frequency, point.damping_ratio, point.energy
    )
}
