//! Optima of a result between two points of its curve: beside plateaus, on which contacts stick, and on both sides of corners, at
//! which they change their state.

use crate::analysis::over_parameter::parameter_curve::{Beside, CurveRecorder};
use crate::continuation::Point;
use crate::continuation::special_points::{Locator, SpecialPoint};
use crate::error::Result;
use crate::harmonics::discretised::Discretised;
use num_complex::Complex64;

/// Change of a result over a step by its slope at one end, relative to it, that is none.
/// Kind: rounding.
const PLATEAU_SLOPE: f64 = 1e-10;

/// Halvings between a plateau and the other end of a step: an optimum within a thousandth of the step from the edge may be missed.
/// Kind: cap.
const PLATEAU_HALVINGS: usize = 10;

/// Departure of a change from that of the mean slope, over that of the larger slope, that shows a corner; and halvings of a step
/// in which corners are sought.
/// Kind: tuned; measured on: 800 responses of one slider over its limit.
const CORNER: f64 = 0.05;
const CORNER_HALVINGS: usize = 6;

impl CurveRecorder<'_> {
    /// Locates the optima between two neighbours, each with its level of harmonics, without a turn between them.
    pub(super) fn find_optima(&mut self, a: &Point, level_a: usize, b: &Point, level_b: usize) -> Result<()> {
        let level = level_a.max(level_b);
        self.followed.select(level)?;
        let ends = [self.followed.transfer(a, level_a)?, self.followed.transfer(b, level_b)?];
        match self.beside_plateau(ends)? {
            Some([a, b]) => self.optima(&a, &b, level, CORNER_HALVINGS),
            None => Ok(()),
        }
    }

    /// The part between two points in which an optimum is sought; `None`: there is none.
    ///
    /// While all contacts stick, or none acts, a result does not depend on their limits. At an end on such a plateau the slope
    /// is zero, so that its sign says nothing of an optimum between the edge of the plateau and the other end. Halving finds the
    /// edge, or a point before it whose slope has the other sign.
    fn beside_plateau(&mut self, ends: [Point; 2]) -> Result<Option<[Point; 2]>> {
        let [a, b] = &ends;
        let range = b.parameter() - a.parameter();
        let is_flat = |point: &Point| change_by_slope(point, range).abs() <= PLATEAU_SLOPE * point.amplitude.norm();
        let [flat_a, flat_b] = [is_flat(a), is_flat(b)];
        if flat_a == flat_b {
            return Ok((!flat_a).then_some(ends));
        }
        let slope = |point: &Point| SpecialPoint::Peak.function(point, 1.0);
        let mut locator = Locator::new(a.unknowns().len(), self.settings)?;
        let (mut flat, mut steep, mut inner) = if flat_a {
            (0.0, 1.0, b.try_clone()?)
        } else {
            (1.0, 0.0, a.try_clone()?)
        };
        let sense = slope(&inner);
        for _ in 0..PLATEAU_HALVINGS {
            let share = 0.5 * (flat + steep);
            let Some(point) = locator.between(self.followed.problem(), (a, b), share, self.interrupt)? else {
                break;
            };
            if is_flat(&point) {
                flat = share;
            } else if slope(&point) * sense < 0.0 {
                return Ok(Some(if flat_a { [point, inner] } else { [inner, point] }));
            } else {
                (steep, inner) = (share, point);
            }
        }
        Ok(None)
    }

    /// Locates optima between two points of a level, on both sides of corners: there may be two between points with slopes of one sign.
    fn optima(&mut self, a: &Point, b: &Point, level: usize, halvings: usize) -> Result<()> {
        let interrupt = self.interrupt;
        // The search for another optimum may have raised the level.
        self.followed.select(level)?;
        if halvings > 0 && has_corner(a, b) {
            let mut locator = Locator::new(a.unknowns().len(), self.settings)?;
            if let Some(middle) = locator.between(self.followed.problem(), (a, b), 0.5, interrupt)? {
                self.optima(a, &middle, level, halvings - 1)?;
                return self.optima(&middle, b, level, halvings - 1);
            }
        }
        for is_maximum in [true, false] {
            let (a, b) = (sensed(a, is_maximum)?, sensed(b, is_maximum)?);
            // At most one kind: the level is still the one selected.
            if SpecialPoint::Peak.between(&a, &b) {
                let beside = Beside::Optimum { is_maximum };
                self.find(beside, (&a, level), (&b, level), |locator, problem, a, b| {
                    locator.locate(problem, SpecialPoint::Peak, a, b, interrupt)
                })?;
            }
        }
        Ok(())
    }
}

/// Change of a result over a range of the parameter, if its slope stayed that of a point; infinite at a turn.
fn change_by_slope(point: &Point, range: f64) -> f64 {
    let rate = point.tangent.last().copied().unwrap_or(0.0);
    SpecialPoint::Peak.function(point, 1.0) * range / rate
}

/// Whether the result has a corner between two points, or changes too much to tell: its change is that of the mean slope but for
/// the third derivative where it is smooth. `false` beside a turn.
fn has_corner(a: &Point, b: &Point) -> bool {
    let range = b.parameter() - a.parameter();
    let (from_a, from_b) = (change_by_slope(a, range), change_by_slope(b, range));
    let change = b.amplitude.norm() - a.amplitude.norm();
    (change - 0.5 * (from_a + from_b)).abs() > CORNER * from_a.abs().max(from_b.abs())
}

/// A point whose observed number is its result or, for a minimum, the reciprocal.
fn sensed(point: &Point, is_maximum: bool) -> Result<Point> {
    let mut copy = point.try_clone()?;
    if !is_maximum {
        let value = point.amplitude.re;
        copy.amplitude = Complex64::from(1.0 / value);
        copy.slope = Complex64::from(-point.slope.re / (value * value));
    }
    Ok(copy)
}
