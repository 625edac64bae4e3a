//! The force that resonates at each amplitude of a mode, and where it is extreme.
//!
//! F(a) = 2Dω₀²a²/|X₁ᴴF| is the factor of the forces that have the motion of the mode at the amplitude a, in phase with its velocity.
//! With F rising along the mode there is one resonance at each force. A minimum of F is the force at which a detached curve is born, and the maximum below it the
//! one at which it merges with the curve beneath.

use crate::analysis::synthesis::mode_motions::{ForceExtremum, Motions};
use crate::analysis::synthesis::oscillator::State;
use crate::analysis::synthesis::resonance::Refinement;
use crate::error::{Result, try_push};

/// Largest number of evaluations for one extremum, and its width in log₁₀ of the amplitude: the force is flat there.
/// Kind: cap.
const FORCE_EXTREMA_MAX_EVALUATIONS: usize = 60;
/// Width of an extremum in log₁₀ of the amplitude: the force is flat there.
/// Kind: rounding.
const FORCE_EXTREMA_WIDTH: f64 = 1e-7;

/// Width of a resonance, of which a start is made, in log₁₀ of the amplitude.
/// Kind: rounding.
const CROSSING: f64 = 1e-10;

/// Ratio of the golden section.
/// Kind: fixed.
const FORCE_EXTREMA_GOLDEN: f64 = 0.381_966_011_250_105_1;

/// Appends the extrema between the points of a mode, whose states are given, and the resonances next to them that no point shows.
pub(super) fn find(refinement: &mut Refinement<'_>, states: &[State], found: &mut Motions) -> Result<()> {
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
            k,
            p1,
            [(p0, sign * f0), (p1, sign * f1), (p2, sign * f2)],
            sign,
        )?;
        let extremum = ForceExtremum {
            log10_amplitude: p,
            factor: (sign * f).exp(),
            is_maximum,
        };
        try_push(&mut found.extrema, extremum, "the extrema of the force")?;
        let extreme = (p, sign * f);
        // Points of the mode show no resonance where both lie between neighbours.
        if [f0, f1, f2].iter().all(|at| at * extreme.1 < 0.0) {
            let (below, above) = if p < p1 {
                ((k - 1, (p0, f0)), (k - 1, (p1, f1)))
            } else {
                ((k, (p1, f1)), (k, (p2, f2)))
            };
            for (side, end) in [below, above] {
                if let Some(state) = crossing(refinement, side, extreme, end)?
                    && let Some(at) = state.at_peak()
                {
                    found.push(refinement, &state, at.omega)?;
                }
            }
        }
    }
    Ok(())
}

/// The state at which the factor of the force is 1, between two amplitudes with log factors of opposite sign.
fn crossing(refinement: &mut Refinement<'_>, k: usize, mut a: (f64, f64), mut b: (f64, f64)) -> Result<Option<State>> {
    let mut found = None;
    for _ in 0..FORCE_EXTREMA_MAX_EVALUATIONS {
        let p = 0.5 * (a.0 + b.0);
        let Some(state) = refinement.state_at(k, p)? else { break };
        let Some(f) = state.log_force_factor() else { break };
        found = Some(state);
        if (f < 0.0) == (a.1 < 0.0) {
            a = (p, f);
        } else {
            b = (p, f);
        }
        if (b.0 - a.0).abs() <= CROSSING {
            break;
        }
    }
    Ok(found)
}

/// The minimum of sign·ln F in a bracket of three points around point k, by parabolas, and by golden sections where
/// these do not help.
fn minimum(
    refinement: &mut Refinement<'_>,
    k: usize,
    at: f64,
    [mut a, mut b, mut c]: [(f64, f64); 3],
    sign: f64,
) -> Result<(f64, f64)> {
    let mut use_parabola = true;
    for _ in 0..FORCE_EXTREMA_MAX_EVALUATIONS {
        if c.0 - a.0 <= FORCE_EXTREMA_WIDTH {
            break;
        }
        let wide = if c.0 - b.0 > b.0 - a.0 { c } else { a };
        let golden = b.0 + FORCE_EXTREMA_GOLDEN * (wide.0 - b.0);
        let mut p = if use_parabola {
            vertex(a, b, c).unwrap_or(golden)
        } else {
            golden
        };
        // Neither an end nor the point itself.
        let least = 1e-2 * FORCE_EXTREMA_WIDTH;
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

/// Abscissa of the vertex of the parabola through three points; `None` where they lie on a line.
fn vertex(a: (f64, f64), b: (f64, f64), c: (f64, f64)) -> Option<f64> {
    let (u, v) = (b.0 - a.0, b.0 - c.0);
    let (s, t) = (u * (b.1 - c.1), v * (b.1 - a.1));
    let p = b.0 - 0.5 * (u * s - v * t) / (s - t);
    p.is_finite().then_some(p)
}
