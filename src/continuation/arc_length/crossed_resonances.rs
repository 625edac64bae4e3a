//! Resonances of the linear structure that lie within a step.
//!
//! Where several resonances lie within one step, the flanks of those next to its ends hide the others: the ends predict each other,
//! and the peak between them is lost. The natural frequencies are known beforehand. At each of them the solution is compared with
//! the cubic through the ends of the step; where it departs from the cubic, the branch feels the resonance, and the step is too long.

use crate::continuation::arc_length::{CORNER_STEP, Continuation, FLOOR};
use crate::continuation::linear_resonance::LinearResonance;
use crate::continuation::point::Point;
use crate::continuation::special_points::Locator;
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::problem::Problem;

/// Half widths of a resonance that a step may have: its ends then show the peak.
/// Kind: tuned; measured on: random chains with light coupling.
const SEEN_WIDTHS: f64 = 4.0;

/// Largest departure from the cubic, over the motion or the amplitude.
/// Kind: tuned; measured on: random chains with light coupling.
const UNFELT: f64 = 0.05;

impl Continuation {
    /// Position of a resonance that the branch feels within the step to `point`, as a share of the change of the parameter; the
    /// first one of the resonances `known`, which ascend.
    // Its points do not lie on the stack under a correction.
    #[inline(never)]
    pub(super) fn crossed(
        &self,
        problem: &mut dyn Problem,
        point: &Point,
        length: f64,
        known: &[LinearResonance],
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<f64>> {
        let here = &self.current;
        let (from, to) = (here.parameter(), point.parameter());
        let n = here.unknowns().len();
        let has_fold = here.tangent[n] * point.tangent[n] <= 0.0 || (to - from) * point.tangent[n] <= 0.0;
        if has_fold || length <= self.steps.smallest().max(CORNER_STEP) {
            return Ok(None);
        }
        let (low, high) = (from.min(to), from.max(to));
        let first = known.partition_point(|r| r.at <= low);
        let count = known[first..].partition_point(|r| r.at < high);
        let inside = &known[first..first + count];
        let mut locator = None;
        let mut share = None;
        // In the order in which the step meets them.
        for i in 0..count {
            let resonance = &inside[if to > from { i } else { count - 1 - i }];
            let place = resonance.at + resonance.aside;
            if high - low <= SEEN_WIDTHS * resonance.half_width || place >= high {
                continue;
            }
            let locator = match &mut locator {
                Some(known) => known,
                None => locator.insert(Locator::new(n, self.settings)?),
            };
            if !self.is_met(locator, problem, point, place, interrupt)? {
                share = Some((resonance.at - from) / (to - from));
                break;
            }
        }
        // The problem is to be evaluated at the point again.
        if share.is_none()
            && let Some(mut locator) = locator
        {
            locator.corrector.evaluate(problem, &point.v)?;
        }
        Ok(share)
    }

    /// Whether the solution at a parameter value within the step to `point` is where the cubic through both ends has it.
    fn is_met(
        &self,
        locator: &mut Locator,
        problem: &mut dyn Problem,
        point: &Point,
        place: f64,
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let ends = (&self.current, point);
        let Some((found, guess)) = locator.beside_cubic(problem, ends, place, interrupt)? else {
            return Ok(false);
        };
        let size = norm(found.unknowns()).max(self.least_size());
        let amplitude = found.amplitude.norm().max(FLOOR * self.largest.1);
        let squares = found
            .unknowns()
            .iter()
            .zip(guess.unknowns())
            .map(|(a, b)| (a - b) * (a - b));
        let departure = squares.sum::<f64>().sqrt();
        let observed = (found.amplitude - guess.amplitude).norm();
        Ok(departure <= UNFELT * size && observed <= UNFELT * amplitude)
    }
}
