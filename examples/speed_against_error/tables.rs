//! The measurements on the screen and as CSV.

use std::error::Error;
use std::io::Write;
use std::path::Path;

use hbvib::Status;

use crate::csv::write_csv;
use crate::front::{Front, fewest};
use crate::measure::Outcome;
use crate::systems::System;
use crate::truth::{ROUNDING, Truth};

/// Errors at which exact events and samples are compared.
const EQUAL: [f64; 3] = [1e-3, 1e-6, 1e-9];

/// Result of every part of the program.
pub type Done = Result<(), Box<dyn Error>>;

/// Measurements of one system.
pub struct Measured {
    pub system: System,
    pub truth: Truth,
    pub outcomes: Vec<Outcome>,
    /// CPU time of one LU factorisation of order 11 with a solution, before and after, s.
    pub units: [f64; 2],
    /// Largest resident memory of the program so far, MiB, where the system tells it.
    pub memory: Option<f64>,
}

impl Measured {
    /// Smallest meaningful true error: smaller ones are not far above the error of the truth, or above rounding.
    fn floor(&self) -> f64 {
        self.truth.change.max(ROUNDING)
    }

    /// Shows the tables of this system.
    ///
    /// # Errors
    ///
    /// If the screen cannot be written to.
    pub fn show(&self, screen: &mut impl Write) -> Done {
        let (truth, floor) = (&self.truth, self.floor());
        let (harmonics, samples) = truth.with;
        write!(
            screen,
            "\n({}) {}\ntruth: H = {harmonics}",
            self.system.key, self.system.title
        )?;
        if samples > 0 {
            write!(screen, ", {samples} samples")?;
        }
        writeln!(
            screen,
            ", {} frequencies; half as many change it by {:.1e} at most\n\
             one LU factorisation of order 11 with a solution, LU11: {} µs before, {} µs after; \
             largest memory so far {} MiB\n\n\
             way                  time ms  1000 LU11  points     H along it  estimates  largest error  own points     peak  \
             estimate/error in [0.3, 3]  [0.1, 10]  unknown",
            truth.solutions.len(),
            truth.change,
            format_args!("{:.3}", 1e6 * self.units[0]),
            format_args!("{:.3}", 1e6 * self.units[1]),
            self.memory.map_or("?".into(), |m| format!("{m:.0}")),
        )?;
        let unit = self.units[0].min(self.units[1]);
        for o in &self.outcomes {
            let [low, middle, high] = o.used;
            let [near, far, all] = o.effectivity(floor);
            let own = if o.own.is_empty() {
                String::new()
            } else {
                shown(o.own_error(), floor)
            };
            let share = |part: usize| {
                if all == 0 {
                    "–".into()
                } else {
                    format!("{part} of {all}")
                }
            };
            let along = if o.way.is_automatic() {
                format!("{low}, {middle}, {high}")
            } else {
                high.to_string()
            };
            write!(
                screen,
                "{:<18}  {:>8.3}  {:>9.2}  {:>6}  {along:>13}  {:>9}  {:>13}  {own:>10}  {:>7}  {:>26}  {:>9}  {:>7}",
                name(o),
                1e3 * o.seconds,
                1e-3 * o.seconds / unit,
                o.points,
                o.estimates,
                shown(o.error(), floor),
                shown(o.peak, floor),
                share(near),
                share(far),
                o.unknown,
            )?;
            if o.status != Status::Ok {
                write!(screen, "  {:?}", o.status)?;
            }
            if o.missing() > 0 {
                write!(screen, "  {} solutions missing", o.missing())?;
            }
            if o.unsolved() > 0 {
                write!(screen, "  {} own points without truth", o.unsolved())?;
            }
            if o.way.is_automatic() && o.at_folds > high {
                write!(screen, "  H = {} at a fold", o.at_folds)?;
            }
            writeln!(screen)?;
        }
        self.show_tolerances(screen)?;
        self.show_samples(screen)
    }

    /// Time of each tolerance against the fewest fixed harmonics whose error is not above it.
    fn show_tolerances(&self, screen: &mut impl Write) -> Done {
        writeln!(
            screen,
            "\ntolerance  largest error/tolerance  fewest H that reach it  time/time with these H"
        )?;
        for o in self.outcomes.iter().filter(|o| o.way.is_automatic()) {
            let tolerance = o.way.tolerance;
            let fixed = fewest(&self.outcomes, tolerance);
            let (reached, ratio) = fixed.map_or(("none of the list".into(), "–".into()), |f| {
                (f.way.harmonics.to_string(), format!("{:.2}", o.seconds / f.seconds))
            });
            let worst = o.error().max(o.own_error()) / tolerance;
            writeln!(screen, "{tolerance:>9.0e}  {worst:>23.2}  {reached:>22}  {ratio:>22}")?;
        }
        Ok(())
    }

    /// Time by samples against that by exact events, at equal error.
    fn show_samples(&self, screen: &mut impl Write) -> Done {
        if self.system.sampled.is_empty() {
            return Ok(writeln!(screen, "\nsamples: the law does not use them")?);
        }
        let of = |sampled: bool| {
            let fixed = self.outcomes.iter().filter(|o| !o.way.is_automatic());
            Front::new(fixed.filter(move |o| (o.way.samples > 0) == sampled))
        };
        let (exact, sampled) = (of(false), of(true));
        writeln!(screen, "\nerror   N automatic or exact, ms  N given, ms  ratio")?;
        for error in EQUAL {
            if error < self.floor() {
                writeln!(screen, "{error:.0e}  the truth is not exact enough")?;
                continue;
            }
            let text = |time: Option<f64>| time.map_or("not reached".into(), |t| format!("{:.3}", 1e3 * t));
            let (one, other) = (exact.time(error), sampled.time(error));
            let ratio = one.zip(other).map_or(String::new(), |(a, b)| format!("{:.1}", b / a));
            writeln!(
                screen,
                "{error:.0e}  {:>25}  {:>11}  {ratio:>5}",
                text(one),
                text(other)
            )?;
        }
        Ok(())
    }
}

/// An error, unless it is below the smallest meaningful one.
fn shown(error: f64, floor: f64) -> String {
    if error <= floor {
        format!("<{floor:.0e}")
    } else {
        format!("{error:.1e}")
    }
}

/// Name of a way.
fn name(outcome: &Outcome) -> String {
    let way = outcome.way;
    if way.is_automatic() {
        format!("tolerance {:.0e}", way.tolerance)
    } else if way.samples > 0 {
        format!("H = {}, N = {}", way.harmonics, way.samples)
    } else {
        format!("H = {}", way.harmonics)
    }
}

/// Writes all ways to `ways.csv`, all compared solutions to `solutions.csv`. Systems are numbered from 0.
///
/// # Errors
///
/// If a file cannot be written.
pub fn write(all: &[Measured], folder: &Path) -> Done {
    let (mut ways, mut solutions) = (Vec::new(), Vec::new());
    for (number, measured) in all.iter().enumerate() {
        for o in &measured.outcomes {
            let way = [
                number as f64,
                o.way.tolerance,
                o.way.harmonics as f64,
                o.way.samples as f64,
            ];
            let [near, far, known] = o.effectivity(measured.floor());
            let found = [
                o.seconds,
                o.points as f64,
                o.used[0] as f64,
                o.used[1] as f64,
                o.used[2] as f64,
                o.estimates as f64,
                o.error(),
                o.own_error(),
                o.peak,
                near as f64,
                far as f64,
                known as f64,
                o.unknown as f64,
                o.missing() as f64,
                f64::from(o.status as i32),
            ];
            ways.push([&way[..], &found].concat());
            for (own, list) in [(0.0, &o.checked), (1.0, &o.own)] {
                let of = |c: &crate::measure::Checked| [own, c.omega, c.harmonics as f64, c.estimate, c.error];
                solutions.extend(list.iter().map(|c| [&way[..], &of(c)].concat()));
            }
        }
    }
    let way = ["system", "tolerance", "harmonics", "samples"];
    let found = [
        "seconds",
        "points",
        "least_harmonics",
        "median_harmonics",
        "most_harmonics",
        "estimates",
        "largest_error",
        "largest_error_of_own_points",
        "error_of_peak",
        "ratios_within_0.3_to_3",
        "ratios_within_0.1_to_10",
        "ratios",
        "unknown",
        "missing",
        "status",
    ];
    write_csv(folder.join("ways.csv"), &[&way[..], &found].concat(), &ways)?;
    let of = ["own_point", "omega", "highest_harmonic", "estimate", "error"];
    write_csv(folder.join("solutions.csv"), &[&way[..], &of].concat(), &solutions)
}
