//! The force that resonates at each amplitude of a mode, and where it is extreme.
//!
//! F(a) = 2Dω₀²a²/|X₁ᴴF| is the factor of the forces that have the motion of the mode at the amplitude a, in phase with its velocity.
//! With F rising along the mode there is one resonance at each force. A minimum of F is the force at which a detached curve is born, and the maximum below it the
//! one at which it merges with the curve beneath.

use crate::analysis::synthesis::oscillator::State;
use crate::analysis::synthesis::resonance::Refinement;
use crate::error::{Result, try_push};

/// A level of the force along a mode: where it is extreme, the resonances of a detached curve meet, or those of two curves do.
#[derive(Clone, Copy, Debug)]
pub struct ForceExtremum {
    pub log10_amplitude: f64,
    /// Factor of all forces.
    pub factor: f64,
    pub is_maximum: bool,
}

/// Largest number of evaluations for one extremum, and its width in log₁₀ of the amplitude: the force is flat there.
const MAX_EVALUATIONS: usize = 60;
const WIDTH: f64 = 1e-7;

/// Ratio of the golden section.
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// Appends the extrema between the points of a mode, whose states are given.
pub(super) fn find(refinement: &mut Refinement<'_>, states: &[State], found: &mut Vec<ForceExtremum>) -> Result<()> {
    for k in 1..states.len().saturating_sub(1) {
        let at = [k - 1, k, k + 1].map(|i| (states[i].log10, states[i].log_force_factor()));
        let [(p0, Some(f0)), (p1, Some(f1)), (p2, Some(f2))] = at else {
            continue;
        };
        let is_maximum = f1 > f0 && f1 >= f2;
        if !(is_maximum || f1 < f0 && f1 <= f2) || !(p0 < p1 && p1 < p2) {
            continue;
        }
        let sign = if is_maximum { -1.0 } else { 1.0 };
        let (p, f) = minimum(
            refinement,
            (k, p1),
            [(p0, sign * f0), (p1, sign * f1), (p2, sign * f2)],
            sign,
        )?;
        let extremum = ForceExtremum {
            log10_amplitude: p,
            factor: (sign * f).exp(),
            is_maximum,
        };
        try_push(found, extremum, "the extrema of the force")?;
    }
    Ok(())
}

/// The minimum of sign·ln F in a bracket of three points around point k: parabolas, and golden sections where they do not help.
fn minimum(
    refinement: &mut Refinement<'_>,
    (k, at): (usize, f64),
    [mut a, mut b, mut c]: [(f64, f64); 3],
    sign: f64,
) -> Result<(f64, f64)> {
    let mut use_parabola = true;
    for _ in 0..MAX_EVALUATIONS {
        if c.0 - a.0 <= WIDTH {
            break;
        }
        let wide = if c.0 - b.0 > b.0 - a.0 { c } else { a };
        let golden = b.0 + GOLDEN * (wide.0 - b.0);
        let mut p = if use_parabola {
            vertex(a, b, c).unwrap_or(golden)
        } else {
            golden
        };
        // Neither an end nor the point itself.
        let least = 1e-2 * WIDTH;
        if !(p > a.0 + least && p < c.0 - least) {
            p = golden;
        }
        if (p - b.0).abs() < least {
            p = b.0 + least * (wide.0 - b.0).signum();
        }
        let side = if p < at { k - 1 } else { k };
        let Some(f) = refinement
            .state_at(side, p)?
            .and_then(|state| state.log_force_factor())
            .map(|f| sign * f)
        else {
            break;
        };
        let width = c.0 - a.0;
        let new = (p, f);
        if f < b.1 {
            if p < b.0 {
                c = b;
            } else {
                a = b;
            }
            b = new;
        } else if p < b.0 {
            a = new;
        } else {
            c = new;
        }
        use_parabola = c.0 - a.0 < 0.7 * width || !use_parabola;
    }
    Ok(b)
}

/// The vertex of the parabola through three points.
fn vertex(a: (f64, f64), b: (f64, f64), c: (f64, f64)) -> Option<f64> {
    let (u, v) = (b.0 - a.0, b.0 - c.0);
    let (s, t) = (u * (b.1 - c.1), v * (b.1 - a.1));
    let p = b.0 - 0.5 * (u * s - v * t) / (s - t);
    p.is_finite().then_some(p)
}
