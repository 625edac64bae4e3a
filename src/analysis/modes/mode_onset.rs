//! Amplitudes at which contacts begin to slip and to lift off along a nonlinear mode.

use crate::contact::forms::onset::Onset;
use crate::continuation::special_points::Locator;
use crate::continuation::{Point, Settings};
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::problem::epmc::Epmc;
use crate::problem::{Problem, Residual};

/// Width of log₁₀ of the amplitude to which an onset is located.
/// Kind: rounding.
const MODE_ONSET_WIDTH: f64 = 1e-7;

/// Share of the period that counts as slip or opening.
/// Kind: rounding.
const MODE_ONSET_SHARE: f64 = 1e-9;

/// Number of kinds of onset: slip, lift-off.
/// Kind: fixed.
const MODE_ONSET_KINDS: usize = 2;

/// Finds the amplitudes of onset while points are recorded one after the other.
pub(crate) struct OnsetSearch {
    /// Amplitudes, as log₁₀, where slip and lift-off begin, as far as known.
    found: [Option<f64>; MODE_ONSET_KINDS],
    /// The point recorded last, with the index of its resolution.
    before: Option<(Point, usize)>,
}

impl OnsetSearch {
    /// Starts a search, with the onsets of the linear mode. Those are valid for the nonlinear mode too, as far as it
    /// is linear.
    pub fn new(onset: Onset) -> Self {
        let first = |a: f64| (a <= onset.linear && a.is_finite()).then(|| a.log10());
        Self {
            found: [first(onset.slip), first(onset.lift_off)],
            before: None,
        }
    }

    /// Amplitudes, as log₁₀, where slip and lift-off begin; infinite where no point shows such.
    pub fn found(&self) -> [f64; MODE_ONSET_KINDS] {
        self.found.map(|a| a.unwrap_or(f64::INFINITY))
    }

    /// Whether slip and lift-off occur at the point where the problem was evaluated last.
    fn shown(problem: &Epmc<'_>) -> [bool; MODE_ONSET_KINDS] {
        let forces = problem.forces();
        [
            forces.slip_fractions().iter().any(|&share| share > MODE_ONSET_SHARE),
            forces.lifted_shares().any(|share| share > MODE_ONSET_SHARE),
        ]
    }

    /// Considers a point at which the problem was evaluated last; `transfer` turns the point recorded before into one
    /// of the current resolution. Returns whether the problem was evaluated elsewhere.
    ///
    /// # Errors
    /// Those of the problem; `StoppedByCaller`.
    pub fn note(
        &mut self,
        problem: &mut Epmc<'_>,
        (point, resolution): (&Point, usize),
        transfer: impl Fn(&Point, usize) -> Result<Point>,
        settings: &Settings,
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let shown = Self::shown(problem);
        let mut moved = false;
        for (kind, shown) in shown.into_iter().enumerate() {
            if self.found[kind].is_some() || !shown {
                continue;
            }
            self.found[kind] = Some(match &self.before {
                // It began below the first point.
                None => f64::NEG_INFINITY,
                Some((before, from)) => {
                    let before = transfer(before, *from)?;
                    moved = true;
                    locate(problem, kind, &before, point, settings, interrupt)?
                }
            });
        }
        self.before = if self.found.iter().all(Option::is_some) {
            None
        } else {
            Some((point.try_clone()?, resolution))
        };
        Ok(moved)
    }
}

/// Amplitude of an onset, as log₁₀, by bisection between a point without and one with it.
fn locate(
    problem: &mut Epmc<'_>,
    kind: usize,
    a: &Point,
    b: &Point,
    settings: &Settings,
    interrupt: &Interrupt<'_>,
) -> Result<f64> {
    let mut locator = Locator::new(a.unknowns().len(), *settings)?;
    let mut out = Residual::new(a.unknowns().len())?;
    let (mut low, mut high) = (a.parameter(), b.parameter());
    while (high - low).abs() > MODE_ONSET_WIDTH {
        let middle = 0.5 * (low + high);
        let Some(point) = locator.at_parameter(problem, a, b, middle, interrupt)? else {
            break;
        };
        problem.evaluate(point.unknowns(), middle, &mut out)?;
        if OnsetSearch::shown(problem)[kind] {
            high = middle;
        } else {
            low = middle;
        }
    }
    Ok(high)
}
