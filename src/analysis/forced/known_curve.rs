//! Points of curves that are known: whether a new point lies on a branch that was followed already.

use crate::condense::Condensed;
use crate::continuation::{ONE_SOLUTION, Point};
use crate::error::{Result, fail, try_push};
use crate::fourier::HarmonicSet;
use crate::harmonics::discretised::Discretised;
use crate::harmonics::transfer::transferred;
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::results::Branch;
use crate::results::stored::mode_branch::ModeField;
use num_complex::Complex64;
use std::sync::Arc;

/// Most halvings of the line between two points of a branch.
/// Kind: cap.
const KNOWN_CURVE_HALVINGS: usize = 8;

/// Distance to that line, over its length, beyond which a solution found from it may lie on another curve.
/// Kind: tuned; measured on: not recorded.
const KNOWN_CURVE_BESIDE: f64 = 0.5;

/// Unknowns of a nonlinear mode that are no motions, frequency and damping ratio.
/// Kind: fixed.
const OTHERS_OF_MODE: usize = 2;

/// Whether a point, or its mirror image, lies on a branch. The solutions at its parameter (the frequency of a
/// response, the amplitude of a mode) between neighbours of the branch decide.
pub(crate) fn lies_on(
    response: &mut dyn Discretised,
    known: &Branch,
    point: &Point,
    periods: usize,
    interrupt: &Interrupt<'_>,
) -> Result<bool> {
    let level = response.resolution();
    let mode = known.mode_data();
    let omega = mode.map_or(known.omega(), |mode| {
        &mode.field(ModeField::Log10Amplitude)[..known.points()]
    });
    for i in 0..omega.len().saturating_sub(1) {
        let before = i.checked_sub(1).map(|before| omega[i] - omega[before]);
        let after = omega.get(i + 2).map(|after| after - omega[i + 1]);
        let step = omega[i + 1] - omega[i];
        let beside = [before, after].into_iter().flatten();
        // Beyond its points a fold reaches no further than the steps around it.
        let beyond = if beside.clone().any(|other| other * step <= 0.0) {
            beside.fold(step.abs(), |most, other| most.max(other.abs()))
        } else {
            0.0
        };
        if !reaches(omega[i], omega[i + 1], point.parameter(), beyond) {
            continue;
        }
        interrupt.check()?;
        let to = Arc::clone(&response.levels().at(level)?.condensed);
        let moved = |i: usize| state_of(known, i, &to);
        let segment = Segment {
            point,
            periods,
            set: to.set(),
            others: mode.map_or(0, |_| OTHERS_OF_MODE),
        };
        if segment.has(
            response,
            &moved(i)?,
            &moved(i + 1)?,
            (KNOWN_CURVE_HALVINGS, beyond),
            interrupt,
        )? {
            return Ok(true);
        }
    }
    Ok(false)
}

/// A point of a branch, as unknowns and parameter in the harmonics of a model.
fn state_of(known: &Branch, point: usize, to: &Condensed) -> Result<Vec<f64>> {
    let from = known.condensed_at(point);
    let factor = from.length() / to.length();
    if let Some(mode) = known.mode_data() {
        let Some((state, _)) = mode.state(point) else {
            return fail!(Internal, "a point of a mode has no state");
        };
        return transferred(from, to, state, OTHERS_OF_MODE + 1, factor);
    }
    let motion = known.motion_at(point).unwrap_or(&[]);
    let mut v = transferred(from, to, motion, 0, factor)?;
    try_push(&mut v, known.omega()[point], "a point of a known curve")?;
    Ok(v)
}

/// Whether the line between two frequencies, or a fold of the curve beside it, reaches the frequency `omega`.
fn reaches(a: f64, b: f64, omega: f64, beyond: f64) -> bool {
    omega >= a.min(b) - beyond && omega <= a.max(b) + beyond
}

/// A point, and the data to search for it between neighbours of a branch.
struct Segment<'s> {
    point: &'s Point,
    periods: usize,
    set: &'s HarmonicSet,
    /// Number of unknowns that are no motions.
    others: usize,
}

impl Segment<'_> {
    /// Whether the curve between `a` and `b` (unknowns with their frequency) contains the point. From a line that is
    /// short against the curve's bends Newton's method finds the curve; a longer line is halved, in the plane across
    /// it.
    fn has(
        &self,
        response: &mut dyn Discretised,
        a: &[f64],
        b: &[f64],
        (halvings, beyond): (usize, f64),
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let n = self.point.unknowns().len();
        let omega = self.point.parameter();
        let length = a[..n].iter().zip(b).fold(0.0_f64, |s, (a, b)| s.hypot(a - b));
        let on_line = |share: f64| -> Result<Point> {
            let mut near = self.point.try_clone()?;
            for ((v, a), b) in near.v.iter_mut().zip(a).zip(b) {
                *v = a + share * (b - a);
            }
            for ((t, a), b) in near.tangent.iter_mut().zip(a).zip(b) {
                *t = b - a;
            }
            Ok(near)
        };
        let is_near = |found: &Point, near: &Point| {
            let pairs = found.unknowns().iter().zip(near.unknowns());
            pairs.fold(0.0_f64, |s, (x, y)| s.hypot(x - y)) <= KNOWN_CURVE_BESIDE * length
        };
        if reaches(a[n], b[n], omega, 0.0) {
            let step = b[n] - a[n];
            let mut near = on_line(if step.abs() > 0.0 { (omega - a[n]) / step } else { 0.5 })?;
            near.v[n] = omega;
            if let Some(found) = response.resolve(&near, true, interrupt)? {
                if self.is_one(&found) {
                    return Ok(true);
                }
                if beyond == 0.0 && is_near(&found, &near) {
                    return Ok(false);
                }
            }
        }
        if halvings == 0 || length == 0.0 {
            return Ok(false);
        }
        let near = on_line(0.5)?;
        let middle = match response.resolve(&near, false, interrupt)? {
            Some(middle) if is_near(&middle, &near) => middle,
            _ => return Ok(false),
        };
        for (a, b) in [(a, &middle.v[..]), (&middle.v[..], b)] {
            // A fold is at most as far away as the line is long.
            let beyond = 0.5 * beyond;
            if reaches(a[n], b[n], omega, beyond) && self.has(response, a, b, (halvings - 1, beyond), interrupt)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Whether a solution equals the point, apart from a shift by whole periods of the force, or by half a period
    /// with the opposite sign, under which an odd model has the same motions.
    fn is_one(&self, found: &Point) -> bool {
        let motion = |point: &'_ Point| point.unknowns().len() - self.others;
        let (a, b) = (&found.v[..motion(found)], &self.point.v[..motion(self.point)]);
        let bound = ONE_SOLUTION * norm(b);
        let m = self.set.packed_len().max(1);
        // A mode is autonomous: half of its period later it is the same, whatever the model.
        let signs: &[f64] = if self.others > 0 { &[1.0, -1.0] } else { &[1.0] };
        let shifts = signs
            .iter()
            .flat_map(|sign| (0..2 * self.periods).map(move |half| (*sign, half)));
        shifts.into_iter().any(|(sign, half)| {
            let sign = if half % 2 == 0 { sign } else { -sign };
            let turn = core::f64::consts::PI * half as f64 / self.periods as f64;
            let mut gap = 0.0_f64;
            for (a, b) in a.chunks_exact(m).zip(b.chunks_exact(m)) {
                for (i, h) in self.set.numbers().iter().enumerate() {
                    let shifted = self.set.get(a, i) * Complex64::cis(turn * *h as f64) * sign;
                    gap = gap.hypot((shifted - self.set.get(b, i)).norm());
                }
            }
            gap <= bound
        })
    }
}
