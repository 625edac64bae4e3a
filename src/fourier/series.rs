//! Values of a real Fourier series over one turn, and its crossings of a level.

use crate::fourier::HarmonicSet;
use num_complex::Complex64;

/// Value, first and second derivative of a series at one time.
#[derive(Clone, Copy, Debug)]
pub struct Jet {
    /// x(τ)
    pub x: f64,
    /// dx/dτ
    pub dx: f64,
    /// d²x/dτ²
    pub ddx: f64,
}

/// x, x′ and x″ of a packed signal at τ.
#[must_use]
pub fn jet(set: &HarmonicSet, packed: &[f64], tau: f64) -> Jet {
    let (mean, rest) = packed.split_at(usize::from(set.has_mean()));
    let mut j = Jet {
        x: mean.first().copied().unwrap_or(0.0),
        dx: 0.0,
        ddx: 0.0,
    };
    let mut turn = Complex64::cis(tau);
    let stride = set.stride();
    let step = if stride == 2 { turn * turn } else { turn };
    let mut p = 1.0;
    for pair in rest.chunks_exact(2) {
        let x = pair[0] * turn.re - pair[1] * turn.im;
        let quadrature = pair[0] * turn.im + pair[1] * turn.re;
        j.x += x;
        j.dx -= p * quadrature;
        j.ddx -= p * p * x;
        turn *= step;
        p += stride as f64;
    }
    j
}

/// The time in (a, b) at which a signal, monotone there, passes `level`.
#[must_use]
pub fn crossing(set: &HarmonicSet, packed: &[f64], a: f64, b: f64, xa: f64, xb: f64, level: f64) -> f64 {
    safe_newton(a, b, xa - level, xb - level, |tau| {
        let at = jet(set, packed, tau);
        (at.x - level, at.dx)
    })
}

/// Width below which another Newton step no longer matters: the force is continuous at every
/// event, so an event misplaced by ε changes the Fourier integrals by O(ε²).
const EVENT_TOLERANCE: f64 = 1e-9;

/// Newton's method inside a bracket, with bisection where a step leaves it or does not converge.
/// The last evaluation of `f` is within the tolerance of the returned root.
#[must_use]
pub fn safe_newton(a: f64, b: f64, fa: f64, fb: f64, mut f: impl FnMut(f64) -> (f64, f64)) -> f64 {
    let (mut low, mut high) = if fa < 0.0 { (a, b) } else { (b, a) };
    // The secant step; equal end values give NaN or infinity, and then the middle is taken.
    let mut tau = a - fa * (b - a) / (fb - fa);
    if !(tau > a && tau < b) {
        tau = 0.5 * (a + b);
    }
    let mut last = (b - a).abs();
    for _ in 0..100 {
        let (value, slope) = f(tau);
        if value == 0.0 {
            return tau;
        }
        if value < 0.0 {
            low = tau;
        } else {
            high = tau;
        }
        let newton = tau - value / slope;
        let inside = (newton - low) * (newton - high) < 0.0;
        let next = if inside && (newton - tau).abs() <= 0.5 * last {
            newton
        } else {
            0.5 * (low + high)
        };
        last = (next - tau).abs();
        tau = next;
        if last < EVENT_TOLERANCE {
            let (value, slope) = f(tau);
            let polished = tau - value / slope;
            // Factor two: bisection towards an end of the bracket that is the root but for rounding stops as far
            // from it as its last step was long.
            return if (polished - tau).abs() <= 2.0 * last {
                polished
            } else {
                tau
            };
        }
    }
    tau
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_crossing_is_found_to_rounding_wherever_its_bracket_ends() {
        // cos t = cos c between its turning points at 0 and π, or with the root itself, but for rounding, at an
        // end.
        let set = HarmonicSet::all(3).unwrap();
        let mut worst = 0.0_f64;
        for k in 1..400 {
            let c = PI * f64::from(k) / 400.0;
            for size in [0.3, 0.7, 1.9] {
                for (a, b) in [
                    (0.0, PI),
                    (c - 1e-16, PI),
                    (0.0, c + 1e-16),
                    (c - 1e-10, PI),
                    (0.0, c + 1e-10),
                ] {
                    let packed = [0.0, size, 0.0, 0.0, 0.0, 0.0, 0.0];
                    let level = size * c.cos();
                    let at = crossing(&set, &packed, a, b, size * a.cos(), size * b.cos(), level);
                    worst = worst.max((at - c).abs() * c.sin());
                }
            }
        }
        assert!(worst < 1e-15, "{worst:e}");
    }
}
