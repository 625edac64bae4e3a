//! Points of curves that are known: whether a new point lies on a branch that was followed already.

use crate::adaptivity::discretised::Discretised;
use crate::adaptivity::transfer::transferred;
use crate::analysis::forced_discretised::ForcedDiscretised;
use crate::continuation::Point;
use crate::error::{Error, Result, try_push};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::results::Branch;
use num_complex::Complex64;
use std::sync::Arc;

/// Distance of two solutions that are one, over their size.
const ONE: f64 = 1e-6;

/// Most halvings of the line between two points of a branch.
const KNOWN_CURVE_HALVINGS: usize = 8;

/// Distance to that line, over its length, beyond which a solution found from it may lie on another curve.
const KNOWN_CURVE_BESIDE: f64 = 0.5;

/// Whether a point lies on a branch, or its mirror image does: the solutions at its frequency between neighbours of the branch
/// decide.
pub(super) fn lies_on(
    response: &mut ForcedDiscretised<'_>,
    known: &Branch,
    (point, periods): (&Point, usize),
    interrupt: &Interrupt<'_>,
) -> Result<bool> {
    let level = response.resolution();
    let omega = known.omega();
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
        if !reaches((omega[i], omega[i + 1]), point.parameter(), beyond) {
            continue;
        }
        interrupt.check()?;
        let to = Arc::clone(&response.levels().at(level)?.condensed);
        let moved = |i: usize| {
            let from = known.condensed_at(i);
            let motion = known.motion_at(i).unwrap_or(&[]);
            let mut v = transferred(from, &to, motion, 0, from.length() / to.length())?;
            try_push(&mut v, omega[i], "a point of a known curve")?;
            Ok::<_, Error>(v)
        };
        let segment = Segment {
            point,
            periods,
            set: to.set(),
        };
        if segment.has(
            response,
            (&moved(i)?, &moved(i + 1)?),
            (KNOWN_CURVE_HALVINGS, beyond),
            interrupt,
        )? {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Whether the line between two frequencies, or a fold of the curve beside it, reaches another one.
fn reaches((a, b): (f64, f64), omega: f64, beyond: f64) -> bool {
    omega >= a.min(b) - beyond && omega <= a.max(b) + beyond
}

/// A point that is sought between neighbours of a branch.
struct Segment<'s> {
    point: &'s Point,
    periods: usize,
    set: &'s HarmonicSet,
}

impl Segment<'_> {
    /// Whether the curve between `a` and `b`, unknowns with their frequency, has the point. From a line that is short against the
    /// curve's bends Newton's method finds the curve; a longer one is halved, in the plane across it.
    fn has(
        &self,
        response: &mut ForcedDiscretised<'_>,
        (a, b): (&[f64], &[f64]),
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
        if reaches((a[n], b[n]), omega, 0.0) {
            let step = b[n] - a[n];
            let mut near = on_line(if step.abs() > 0.0 { (omega - a[n]) / step } else { 0.5 })?;
            near.v[n] = omega;
            if let Some(found) = response.resolve(&near, true, interrupt)? {
                if is_one(&found, self.point, self.set, self.periods) {
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
            if reaches((a[n], b[n]), omega, beyond) && self.has(response, (a, b), (halvings - 1, beyond), interrupt)? {
                return Ok(true);
            }
        }
        Ok(false)
    }
}

/// Whether two solutions at one frequency are one, but for a shift by whole periods of the force, or by half a period with the
/// opposite sign, under which an odd model has the same motions.
fn is_one(a: &Point, b: &Point, set: &HarmonicSet, periods: usize) -> bool {
    let (a, b) = (a.unknowns(), b.unknowns());
    let bound = ONE * norm(b);
    let m = set.packed_len().max(1);
    (0..2 * periods).any(|half| {
        let sign = if half % 2 == 0 { 1.0 } else { -1.0 };
        let turn = core::f64::consts::PI * half as f64 / periods as f64;
        let mut gap = 0.0_f64;
        for (a, b) in a.chunks_exact(m).zip(b.chunks_exact(m)) {
            for (i, h) in set.numbers().iter().enumerate() {
                let shifted = set.get(a, i) * Complex64::cis(turn * *h as f64) * sign;
                gap = gap.hypot((shifted - set.get(b, i)).norm());
            }
        }
        gap <= bound
    })
}
