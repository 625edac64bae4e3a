//! The load, when new, with which the largest amplitude over a life is least.
//!
//! Loads above the best one of a new machine make it worse at first and better as they wear; loads below make it worse with wear. So the
//! largest amplitude over the life, as a function of a factor on the loads, has its minimum as a rule where the new and the worn machine
//! vibrate alike: a corner, found as a root. Otherwise the minimum is smooth, and found by golden sections.

use crate::error::{Error, Result, Status, fail, try_push};
use crate::hooks::{Hooks, Progress};
use crate::model::Model;
use crate::options::{LifeOptions, SolverOptions};
use crate::roots::{Bracket, least};
use crate::studies::wear::life::{Life, life};

/// Lives over the range of factors that find the neighbourhood of the minimum.
/// Kind: tuned; measured on: not recorded.
const SCANNED_LIVES: usize = 9;

/// Most lives after that.
/// Kind: cap.
const LIVES_TO_CLOSE: usize = 60;

/// Relative accuracy of the factor.
/// Kind: rounding.
const FACTOR_ACCURACY: f64 = 1e-7;

/// Loads with which the largest amplitude over a life is least.
#[derive(Clone, Copy, Debug)]
pub struct BestLoad {
    /// Factor on the loads of the contacts that wear.
    pub factor: f64,
    /// Largest amplitude over the life with these loads.
    pub amplitude: f64,
    /// Amplitude of the new machine with these loads.
    pub new: f64,
    /// Amplitude at the end of the life with these loads.
    pub worn: f64,
    /// Number of lives that were followed.
    pub lives: usize,
}

/// A life that was followed with a factor on its loads.
#[derive(Clone, Copy)]
struct Tried {
    factor: f64,
    largest: f64,
    ends: (f64, f64),
}

impl Tried {
    /// Amplitude of the new machine minus that of the worn one.
    fn difference(&self) -> f64 {
        self.ends.0 - self.ends.1
    }
}

/// Searches for the factor on the loads of the contacts that wear, within a range, with which the largest amplitude
/// over the life is least. It is the lowest of the minima that nine lives over the range show.
///
/// # Errors
/// `Argument` for the range; those of [`life`]; `NoConvergence` for a life that has no peak at its start or ends early;
/// `StoppedByCaller`.
pub fn best_load_for_life(
    model: &Model,
    solver: &SolverOptions,
    options: &LifeOptions<'_>,
    (low, high): (f64, f64),
    hooks: &mut Hooks<'_>,
) -> Result<BestLoad> {
    if !(low.is_finite() && high.is_finite() && low > 0.0 && high > low) {
        return fail!(Argument, "factors {low} .. {high}, needs 0 < low < high, both finite");
    }
    options.check(model)?;
    let mut search = LoadSearch {
        model,
        solver: *solver,
        options,
        lives: 0,
    };
    let mut scan: Vec<Tried> = Vec::new();
    for i in 0..SCANNED_LIVES {
        let share = i as f64 / (SCANNED_LIVES - 1) as f64;
        let tried = search.with((low.ln() + share * (high / low).ln()).exp(), hooks)?;
        try_push(&mut scan, tried, "the lives")?;
    }
    let best = (0..scan.len()).fold(0, |a, b| if scan[b].largest < scan[a].largest { b } else { a });
    let mut found = scan[best];
    let (a, b) = (scan[best.saturating_sub(1)], scan[(best + 1).min(scan.len() - 1)]);
    for (a, b) in [(a, found), (found, b)] {
        if a.difference() < 0.0 && b.difference() > 0.0 {
            let corner = search.corner(a, b, hooks)?;
            if corner.largest < found.largest {
                found = corner;
            }
        }
    }
    let smooth = search.smooth(a.factor, b.factor, found, hooks)?;
    if smooth.largest < found.largest {
        found = smooth;
    }
    Ok(BestLoad {
        factor: found.factor,
        amplitude: found.largest,
        new: found.ends.0,
        worn: found.ends.1,
        lives: search.lives,
    })
}

/// The error of a search for which a life is missing. The status of a partial result does not apply, since none is
/// kept.
fn without_life(e: Error, factor: f64) -> Error {
    if matches!(
        e.status,
        Status::StoppedByCaller | Status::OutOfMemory | Status::Callback
    ) {
        return e;
    }
    let mut e = e.at(format_args!("with the factor {factor} on the loads"));
    if (e.status as i32) > 0 {
        e.status = Status::NoConvergence;
    }
    e
}

struct LoadSearch<'a> {
    model: &'a Model,
    solver: SolverOptions,
    options: &'a LifeOptions<'a>,
    lives: usize,
}

impl LoadSearch<'_> {
    fn with(&mut self, factor: f64, hooks: &mut Hooks<'_>) -> Result<Tried> {
        let mut model = self.model.separate_clone()?;
        for wear in self.options.wear {
            let load = self.model.contacts()[wear.contact].load();
            model.set_worn_load(wear.contact, factor * load)?;
        }
        let mut quiet = hooks.quiet();
        let found: Life = life(&model, &self.solver, self.options, &mut quiet).map_err(|e| without_life(e, factor))?;
        if found.status != Status::Ok {
            let reason = found.reason;
            let e = reason.unwrap_or_else(|| Error::new(found.status, format_args!("{}", found.status.sentence())));
            return Err(without_life(e, factor));
        }
        self.lives += 1;
        let progress = Progress {
            point: self.lives,
            parameter: factor,
            amplitude: found.largest.0,
            ..Progress::default()
        };
        if hooks.report(&progress) {
            return fail!(StoppedByCaller, "stopped by the caller after {} lives", self.lives);
        }
        Ok(Tried {
            factor,
            largest: found.largest.0,
            ends: found.ends,
        })
    }

    /// The factor at which the new and the worn machine vibrate alike.
    fn corner(&mut self, mut a: Tried, mut b: Tried, hooks: &mut Hooks<'_>) -> Result<Tried> {
        let mut bracket = Bracket::between((a.factor, a.difference()), (b.factor, b.difference()));
        for _ in 0..LIVES_TO_CLOSE {
            let middle = self.with(bracket.guess(), hooks)?;
            let difference = middle.difference();
            let close = FACTOR_ACCURACY * middle.factor;
            if difference.abs() <= FACTOR_ACCURACY * middle.largest
                || bracket.narrow(middle.factor, difference) <= close
                || bracket.width() <= close
            {
                return Ok(middle);
            }
            if difference < 0.0 {
                a = middle;
            } else {
                b = middle;
            }
        }
        Ok(if a.largest < b.largest { a } else { b })
    }

    /// Minimum of the largest amplitude by golden sections, as long as they may find less than a known one.
    fn smooth(&mut self, low: f64, high: f64, known: Tried, hooks: &mut Hooks<'_>) -> Result<Tried> {
        let mut found = known;
        // Inside of the bracket the known one may be the corner itself: both neighbours at a small distance decide.
        for side in [-1.0, 1.0] {
            let at = known.factor * (1.0 + side * 1e-4);
            if at <= low || at >= high {
                continue;
            }
            let near = self.with(at, hooks)?;
            if near.largest < found.largest {
                found = near;
            }
        }
        if found.factor.to_bits() == known.factor.to_bits() && known.factor > low && known.factor < high {
            return Ok(known);
        }
        let width = FACTOR_ACCURACY.sqrt() * high;
        least([low, high], width, |factor| -> Result<f64> {
            let one = self.with(factor, hooks)?;
            if one.largest < found.largest {
                found = one;
            }
            Ok(one.largest)
        })?;
        Ok(found)
    }
}
