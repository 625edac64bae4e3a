//! Points of curves that are known: whether a new point lies on a branch that was followed already.

use crate::adaptivity::discretised::Discretised;
use crate::adaptivity::transfer::transferred;
use crate::analysis::forced_discretised::ForcedDiscretised;
use crate::continuation::Point;
use crate::error::Result;
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::results::Branch;
use num_complex::Complex64;
use std::sync::Arc;

/// Distance of two solutions that are one, over their size.
const ONE: f64 = 1e-6;

/// Whether a point lies on a branch, or its mirror image does: the solutions at its frequency between neighbours of the branch
/// decide.
pub(super) fn lies_on(
    response: &mut ForcedDiscretised<'_>,
    known: &Branch,
    (point, periods): (&Point, usize),
    interrupt: &Interrupt<'_>,
) -> Result<bool> {
    let n = point.unknowns().len();
    let level = response.resolution();
    for (i, pair) in known.omega().windows(2).enumerate() {
        let (a, b) = (pair[0], pair[1]);
        let omega = point.parameter();
        if omega < a.min(b) || omega > a.max(b) {
            continue;
        }
        interrupt.check()?;
        let to = Arc::clone(&response.levels().at(level)?.condensed);
        let moved = |i: usize| {
            let from = known.condensed_at(i);
            let motion = known.motion_at(i).unwrap_or(&[]);
            transferred(from, &to, motion, 0, from.length() / to.length())
        };
        let (first, second) = (moved(i)?, moved(i + 1)?);
        let share = if (b - a).abs() > 0.0 {
            (omega - a) / (b - a)
        } else {
            0.5
        };
        let mut near = point.try_clone()?;
        for ((v, a), b) in near.v[..n].iter_mut().zip(&first).zip(&second) {
            *v = a + share * (b - a);
        }
        let Some(found) = response.resolve(&near, true, interrupt)? else {
            continue;
        };
        if is_one(&found, point, to.set(), periods) {
            return Ok(true);
        }
    }
    Ok(false)
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
