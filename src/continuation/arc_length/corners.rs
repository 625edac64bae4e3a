//! Corners of a branch: where the residual has a kink, the direction changes at once.

use super::{ALONG, Continuation, STRAIGHT, same_line};
use crate::continuation::corrector::Outcome;
use crate::continuation::metric::Metric;
use crate::continuation::point::Point;
use crate::error::{Result, try_copy};
use crate::interrupt::Interrupt;
use crate::problem::Problem;

/// Lengths of the steps that leave a wider corner.
/// Kind: tuned; measured on: not recorded.
const WIDE_CORNERS: [f64; 5] = [1e-6, 1e-5, 1e-4, 1e-3, 1e-2];

/// Lengths of the steps that leave an event's surface. Longer ones would lead to another solution, as across a resonance
/// without damping.
/// Kind: tuned; measured on: not recorded.
const BESIDE_SURFACE: [f64; 3] = [1e-6, 1e-5, 1e-4];

/// Sense of the changes of the parameter that are tried to leave such a corner, and how far along the branch, over the change, the search
/// for the solution starts: where the branch turns back in the parameter, that it came from lies at the same parameter.
/// Kind: tuned; measured on: not recorded.
const SIDES_AND_DEPTHS: [(f64, f64); 6] = [
    (1.0, 0.0),
    (1.0, 1.0),
    (1.0, 10.0),
    (-1.0, 0.0),
    (-1.0, 1.0),
    (-1.0, 10.0),
];

/// Length of the chord from such a corner to the next point, above which that is another solution.
/// Kind: tuned; measured on: not recorded.
const FARTHEST_BESIDE: f64 = 1e-2;

const CONTEXT: &str = "the continuation";

impl Continuation {
    /// The next point beyond a corner of the branch that lies within `step`.
    ///
    /// Where a contact begins to slip the residual has a kink, and the branch may turn there by any angle, back in
    /// the parameter too. The Jacobian just beyond determines the new direction. The sign of the bordered
    /// determinant, which a path through a piecewise smooth map keeps, determines its sense (Allgower & Georg, ch.
    /// 15).
    pub(super) fn turn_corner(
        &mut self,
        problem: &mut dyn Problem,
        metric: Metric,
        depth: f64,
        step: f64,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Point>> {
        let mut probe = try_copy(&self.current.v, CONTEXT)?;
        metric.unit(&self.current.tangent, &mut self.memory.row);
        metric.add(&mut probe, depth, &self.memory.row);
        let Some(positive) = self.direction_beyond(problem, metric, &probe, interrupt)? else {
            return Ok(None);
        };
        if positive != self.current.positive {
            for r in &mut self.memory.row {
                *r = -*r;
            }
        }
        if self.onwards(metric)? < -same_line(depth) {
            return Ok(None);
        }
        let here = try_copy(&self.current.v, CONTEXT)?;
        // Where a contact closes that is nearly rigid, a prediction from before the corner lies where it is open.
        for from in [here, probe] {
            if let Some(point) = self.beyond_corner(problem, metric, &from, (step, true), interrupt)? {
                return Ok(Some(point));
            }
        }
        Ok(None)
    }

    /// Leaves the direction of the linearisation at `probe` as the row that defines the plane of the correction.
    /// Returns whether the bordered determinant is positive at `probe`; `None` where the direction is not found.
    fn direction_beyond(
        &mut self,
        problem: &mut dyn Problem,
        metric: Metric,
        probe: &[f64],
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<bool>> {
        metric.unit(&self.current.tangent, &mut self.memory.row);
        let found = self.corrector.direction_at(
            problem,
            probe,
            &self.memory.row,
            metric,
            &mut self.memory.scratch,
            interrupt,
        )?;
        metric.unit(&self.memory.scratch, &mut self.memory.row);
        Ok(found)
    }

    /// A point beyond the current one along the row, from which the branch continues in that direction; with the sign
    /// of the bordered determinant kept if `keeps_sense`.
    fn beyond_corner(
        &mut self,
        problem: &mut dyn Problem,
        metric: Metric,
        from: &[f64],
        (step, keeps_sense): (f64, bool),
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Point>> {
        let n = self.memory.row.len() - 1;
        for factor in [2.0, 8.0, 32.0] {
            let length = factor * step;
            let mut v = try_copy(from, CONTEXT)?;
            metric.add(&mut v, length, &self.memory.row);
            let outcome = self
                .corrector
                .correct(problem, &mut v, &self.memory.row, metric, false, interrupt)?;
            let Outcome::Converged(corrected) = outcome else {
                continue;
            };
            let mut point = Point::new(v, corrected, length);
            let along = |point: &Point, scratch: &mut [f64], row: &[f64]| -> f64 {
                metric.unit(&point.tangent, scratch);
                scratch.iter().zip(row).map(|(a, b)| a * b).sum()
            };
            let turned = if keeps_sense {
                point.positive != self.current.positive
            } else {
                along(&point, &mut self.memory.scratch, &self.memory.row) < 0.0
            };
            if turned {
                point.reverse();
            }
            let along = along(&point, &mut self.memory.scratch, &self.memory.row);
            let near = metric.distance(&point.v, &self.current.v) <= 3.0 * length;
            if along >= ALONG && near && self.overshoot(point.v[n]).is_none() {
                return Ok(Some(point));
            }
        }
        Ok(None)
    }

    /// The next point beyond a corner that the branch reaches along the surface of an event, where no step in its
    /// direction crosses that surface: friction in a plane, whose sticking slider is held by two circles that cease
    /// to meet. The linearisation is taken at other parameters. Its sense is the one in which a point is found,
    /// straight back excepted.
    fn leave_along_surface(
        &mut self,
        problem: &mut dyn Problem,
        metric: Metric,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Point>> {
        let n = self.memory.row.len() - 1;
        let here = try_copy(&self.current.v, CONTEXT)?;
        for length in BESIDE_SURFACE {
            for side in [length, -length] {
                let mut probe = try_copy(&self.current.v, CONTEXT)?;
                probe[n] += side * (self.settings.end - self.settings.start).signum() * metric.p;
                if self.direction_beyond(problem, metric, &probe, interrupt)?.is_none() {
                    continue;
                }
                for _ in 0..2 {
                    let onwards = self.onwards(metric)?;
                    if (-STRAIGHT..=same_line(length)).contains(&onwards)
                        && let Some(point) = self.beyond_corner(problem, metric, &here, (length, false), interrupt)?
                    {
                        self.steps.restart(length);
                        self.surfaces.left = true;
                        return Ok(Some(point));
                    }
                    for r in &mut self.memory.row {
                        *r = -*r;
                    }
                }
            }
        }
        Ok(None)
    }

    /// The next point beyond a corner at which the branch has a direction on one side only near the corner itself.
    /// Where two circles that hold a sticking slider cease to meet, its position changes with the root of the
    /// distance in the parameter, and the linearisation beside the corner, on either side, shows the direction from
    /// which the branch came.
    ///
    /// A point at another parameter, solved for from the corner, is on the branch beyond if the branch there leads straight away from the
    /// corner, and not back to where it came from.
    fn leave_at_parameter(
        &mut self,
        problem: &mut dyn Problem,
        metric: Metric,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Point>> {
        let n = self.memory.row.len() - 1;
        let sense = (self.settings.end - self.settings.start).signum() * metric.p;
        for length in BESIDE_SURFACE {
            for (change, depth) in SIDES_AND_DEPTHS.map(|(side, depth)| (side * length, depth * length)) {
                let mut v = try_copy(&self.current.v, CONTEXT)?;
                metric.unit(&self.current.tangent, &mut self.memory.row);
                metric.add(&mut v, depth, &self.memory.row);
                let at = self.current.v[n] + sense * change;
                v[n] = at;
                if self.overshoot(at).is_some() {
                    continue;
                }
                self.memory.row.fill(0.0);
                self.memory.row[n] = 1.0;
                let outcome = self
                    .corrector
                    .correct(problem, &mut v, &self.memory.row, metric, false, interrupt)?;
                let Outcome::Converged(corrected) = outcome else {
                    continue;
                };
                v[n] = at;
                let mut point = Point::new(v, corrected, length);
                let chord = metric.distance(&point.v, &self.current.v);
                let along_chord = |tangent: &[f64]| -> f64 {
                    let difference = metric.dot(&point.v, tangent) - metric.dot(&self.current.v, tangent);
                    difference / (chord * metric.norm(tangent))
                };
                let (onwards, along) = (along_chord(&self.current.tangent), along_chord(&point.tangent));
                if chord <= FARTHEST_BESIDE && onwards > -ALONG && along.abs() >= ALONG {
                    if along < 0.0 {
                        point.reverse();
                    }
                    self.steps.restart(length);
                    self.surfaces.left = true;
                    return Ok(Some(point));
                }
            }
        }
        Ok(None)
    }

    /// Cosine of the angle between the row and the direction at the current point.
    fn onwards(&self, metric: Metric) -> Result<f64> {
        let row = self.unscaled_row(metric)?;
        Ok(metric.dot(&row, &self.current.tangent) / metric.norm(&self.current.tangent))
    }

    /// The row that defines the plane of the correction, in unscaled numbers.
    fn unscaled_row(&self, metric: Metric) -> Result<Vec<f64>> {
        let mut row = try_copy(&self.memory.row, CONTEXT)?;
        metric.unscale(&mut row);
        Ok(row)
    }

    /// The next point beyond a corner that is wider than [`CORNER_STEP`], or within which rounding hides the
    /// direction of the branch, as with contacts that are nearly rigid.
    pub(super) fn leave_corner(
        &mut self,
        problem: &mut dyn Problem,
        metric: Metric,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Point>> {
        let smallest = self.steps.smallest();
        let deep = WIDE_CORNERS.map(|length| (length, length));
        for (depth, length) in deep.into_iter().chain(WIDE_CORNERS.map(|length| (smallest, length))) {
            if let Some(point) = self.turn_corner(problem, metric, depth, length, interrupt)? {
                self.steps.restart(length);
                return Ok(Some(point));
            }
        }
        if self.surfaces.may_leave && !self.surfaces.left {
            if let Some(point) = self.leave_along_surface(problem, metric, interrupt)? {
                return Ok(Some(point));
            }
            return self.leave_at_parameter(problem, metric, interrupt);
        }
        Ok(None)
    }
}

#[cfg(test)]
#[path = "corners_tests.rs"]
mod tests;
