//! One response as the flags describe it: a summary on the screen and, on request, a JSON file.

use std::error::Error;
use std::io::Write;
use std::path::PathBuf;

use hbvib::options::SolverOptions;

use crate::flags::{self, Flag, Flags};
use crate::json::write_json;
use crate::mode;
use crate::model::{DOFS, Parameters, REPORTED_DOFS};
use crate::progress::{Bar, write_stderr};
use crate::response::{Point, Range, Response};

/// The flags that only a response has.
pub const FLAGS: [Flag; 6] = [
    Flag::new("--force", "N", "amplitude of the force on each forced mass (5)"),
    Flag::new("--engine-order", "k", "engine order of the force, any integer (2)"),
    Flag::new("--tip-only", "", "force on b2 alone instead of b2 and b1"),
    Flag::new(
        "--from",
        "Hz",
        "beginning of the range (below the resonance, 207 in the base case)",
    ),
    Flag::new(
        "--to",
        "Hz",
        "end of the range (above the resonance, 211 in the base case)",
    ),
    Flag::new(
        "--at-hz",
        "f",
        "list the solutions at exactly this frequency; repeatable",
    )
    .repeatable(),
];

/// One requested response.
#[derive(Clone, Debug)]
pub struct Request {
    parameters: Parameters,
    solver: SolverOptions,
    range: Range,
    json: Option<PathBuf>,
}

impl Request {
    /// Interprets the flags.
    ///
    /// # Errors
    ///
    /// A sentence naming the flag whose value cannot be used.
    pub fn new(flags: &Flags) -> Result<Self, String> {
        if let Some(name) = flags.first_of(&mode::FLAGS) {
            return Err(format!("{name} belongs to a nonlinear mode: give --mode as well"));
        }
        let amount = |name: &str, default: f64| Ok::<f64, String>(flags.amount(name)?.unwrap_or(default));
        let base = Parameters::default();
        let parameters = Parameters {
            force: amount("--force", base.force)?,
            tip_only: flags.has("--tip-only"),
            ring_mass: amount("--ring-mass", base.ring_mass)?,
            rpm: amount("--rpm", base.rpm)?,
            engine_order: flags
                .value("--engine-order", "an integer", |_| true)?
                .unwrap_or(base.engine_order),
            kt: amount("--kt", base.kt)?,
            beta: amount("--beta", base.beta)?,
        };
        let solver = solver_options(flags)?;
        let (from, to) = (flags.positive("--from")?, flags.positive("--to")?);
        let at = flags.values("--at-hz", "a finite number above 0", flags::is_positive)?;
        let range = complete(&parameters, from, to, at)?;
        Ok(Self {
            parameters,
            solver,
            range,
            json: flags.path("--json"),
        })
    }

    /// Computes the response, shows its peak and the requested solutions, and writes the file.
    ///
    /// # Errors
    ///
    /// If the response cannot be computed to its end or the file cannot be written.
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let mut bar = Bar::new("Response, percent", 100);
        let model = self.parameters.model()?;
        let response = Response::follow(&model, &self.solver, &self.range, &REPORTED_DOFS, |share| {
            bar.set(share);
        })?;
        bar.finish();
        if response.stalled {
            write_stderr("note: rounding kept the residual of some points above the solver's tolerance\n");
        }
        if response.missed {
            write_stderr("note: some points miss the tolerance, or their error is unknown: see their error_estimate\n");
        }
        if let Some(path) = &self.json {
            write_json(path, &response.to_json("amplitude_b2_m", &DOFS)?)?;
        }
        let mut screen = std::io::stdout().lock();
        let (from, to) = (self.range.from, self.range.to);
        writeln!(screen, "{} points from {from} Hz to {to} Hz", response.points.len())?;
        show(&mut screen, "peak", &response.peak)?;
        for point in &response.at {
            show(&mut screen, "at", point)?;
        }
        if let Some(path) = &self.json {
            writeln!(screen, "written to {}", path.display())?;
        }
        Ok(())
    }
}

fn show(screen: &mut impl Write, what: &str, point: &Point) -> std::io::Result<()> {
    let (frequency, amplitude) = (point.frequency, point.amplitude());
    writeln!(screen, "{what:<5}{frequency:.9} Hz   |X_1| of b2 {amplitude:.9e} m")
}

/// Solver options from the flags about the harmonics.
///
/// # Errors
///
/// A sentence naming the flag whose value cannot be used.
pub fn solver_options(flags: &Flags) -> Result<SolverOptions, String> {
    // Without a tolerance the number of harmonics is fixed, so that one H can be compared with another.
    let mut solver = SolverOptions::default().fixed();
    let above = |t: &f64| *t > 0.0 && *t < 1.0;
    let tolerance = flags.value("--tolerance", "a number above 0 and below 1", above)?;
    if let Some(highest) = flags.value("--harmonics", "an integer of at least 1", |h: &usize| *h >= 1)? {
        if tolerance.is_some() {
            return Err("--tolerance chooses the harmonics: give --max-harmonics instead of --harmonics".into());
        }
        solver.harmonics = highest;
    }
    solver.tolerance = tolerance.unwrap_or(0.0);
    if let Some(most) = flags.value("--max-harmonics", "an integer of at least 1", |h: &usize| *h >= 1)? {
        if solver.tolerance == 0.0 {
            return Err("--max-harmonics belongs to a tolerance: give --tolerance as well".into());
        }
        solver.max_harmonics = most;
    }
    if let Some(samples) = flags.value("--samples", "an integer of at least 1", |n: &usize| *n >= 1)? {
        solver.samples = samples;
    }
    solver
        .check()
        .map_err(|e| format!("--harmonics, --max-harmonics, --tolerance, --samples: {e}"))?;
    Ok(solver)
}

/// Completes the range with the default ends, and checks the whole.
fn complete(parameters: &Parameters, from: Option<f64>, to: Option<f64>, at: Vec<f64>) -> Result<Range, String> {
    let (low, high) = match (from, to) {
        (Some(from), Some(to)) => (from, to),
        _ => parameters
            .resonance_range()
            .map_err(|e| format!("no range of frequency can be chosen ({e}); give --from and --to"))?,
    };
    let range = Range {
        from: from.unwrap_or(low),
        to: to.unwrap_or(high),
        at,
    };
    // A downward sweep must be explicit: it requires both ends.
    if (from.is_none() || to.is_none()) && range.from >= range.to {
        let (given, other) = if from.is_some() {
            ("--from", "--to")
        } else {
            ("--to", "--from")
        };
        return Err(format!(
            "{given} lies outside of the default range of {low} to {high} Hz; give {other} as well"
        ));
    }
    let (low, high) = (range.from.min(range.to), range.from.max(range.to));
    match range.at.iter().find(|f| **f < low || **f > high) {
        Some(f) => Err(format!("--at-hz {f}: needs a frequency within {low} to {high} Hz")),
        None => Ok(range),
    }
}
