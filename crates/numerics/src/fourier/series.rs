//! Values of a real Fourier series over one turn, and its crossings of a level.

use crate::fourier::HarmonicSet;
use crate::fourier::roots::safe_halley;
use num_complex::Complex64;
use std::f64::consts::PI;

/// Value and three derivatives of a series at one time.
#[derive(Clone, Copy, Debug)]
pub struct Jet {
    /// x(τ)
    pub x: f64,
    /// dx/dτ
    pub dx: f64,
    /// d²x/dτ²
    pub ddx: f64,
    /// d³x/dτ³
    pub dddx: f64,
}

/// x to x‴ of a packed signal at τ.
#[must_use]
#[inline]
pub fn jet(set: &HarmonicSet, packed: &[f64], tau: f64) -> Jet {
    at_turn(set, packed, Complex64::cis(tau))
}

/// ∫ x dτ of a packed signal without its mean, up to τ: the integral whose mean is zero.
#[must_use]
#[inline]
pub fn integral(set: &HarmonicSet, packed: &[f64], tau: f64) -> f64 {
    let mut turn = Complex64::cis(tau);
    let stride = set.stride();
    let step = if stride == 2 { turn * turn } else { turn };
    let (mut sum, mut p) = (0.0, 1.0);
    for [a, b] in packed[usize::from(set.has_mean())..].as_chunks::<2>().0 {
        sum += (a * turn.im + b * turn.re) / p;
        turn *= step;
        p += stride as f64;
    }
    sum
}

/// x to x‴ at the time whose e^{iτ} is `turn`.
fn at_turn(set: &HarmonicSet, packed: &[f64], mut turn: Complex64) -> Jet {
    let (mean, rest) = packed.split_at(usize::from(set.has_mean()));
    let stride = set.stride();
    let step = if stride == 2 { turn * turn } else { turn };
    // Value and p times the quadrature, which the processor makes side by side, and their products with p².
    let (mut low, mut high) = ([0.0; 2], [0.0; 2]);
    let mut p = 1.0;
    for [a, b] in rest.as_chunks::<2>().0 {
        let (along, across) = ([turn.re, turn.im], [-turn.im, turn.re]);
        let factors = [1.0, p];
        let square = p * p;
        for k in 0..2 {
            let value = (a * along[k] + b * across[k]) * factors[k];
            low[k] += value;
            high[k] += square * value;
        }
        turn *= step;
        p += stride as f64;
    }
    Jet {
        x: mean.first().copied().unwrap_or(0.0) + low[0],
        dx: -low[1],
        ddx: -high[0],
        dddx: high[1],
    }
}

/// The jets of a signal at times that approach one another: most e^{iτ} follow from the one before.
struct Approach<'a> {
    set: &'a HarmonicSet,
    packed: &'a [f64],
    tau: f64,
    turn: Complex64,
}

/// Largest angle of which [`small_turn`] returns all digits.
/// Kind: fixed.
const SMALL_ANGLE: f64 = 0.1;

/// e^{is} of a small angle, by its series up to s¹⁰.
#[inline]
fn small_turn(s: f64) -> Complex64 {
    let q = s * s;
    let cosine = 1.0 - q / 2.0 * (1.0 - q / 12.0 * (1.0 - q / 30.0 * (1.0 - q / 56.0 * (1.0 - q / 90.0))));
    let sine = s * (1.0 - q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0 * (1.0 - q / 72.0))));
    Complex64::new(cosine, sine)
}

impl<'a> Approach<'a> {
    #[inline]
    fn new(set: &'a HarmonicSet, packed: &'a [f64]) -> Self {
        Self {
            set,
            packed,
            tau: f64::INFINITY,
            turn: Complex64::ONE,
        }
    }

    #[inline]
    fn at(&mut self, tau: f64) -> Jet {
        let step = tau - self.tau;
        self.turn = if step.abs() <= SMALL_ANGLE {
            self.turn * small_turn(step)
        } else {
            Complex64::cis(tau)
        };
        self.tau = tau;
        at_turn(self.set, self.packed, self.turn)
    }
}

/// Longest step, in angles of the highest harmonic, after which the error of Halley's method is rounding: it is the
/// cube of the step.
/// Kind: rounding.
const SERIES_LAST_STEP: f64 = 3e-6;

#[inline]
fn last_step(set: &HarmonicSet) -> f64 {
    SERIES_LAST_STEP / set.highest_reduced().max(1) as f64
}

/// Values of a series that a crossing takes, about.
/// Kind: tuned; measured on: not recorded.
pub const VALUES_OF_A_CROSSING: usize = 8;

/// The time in (a, b) at which a signal, monotone there, passes `level`.
#[must_use]
#[inline]
pub fn crossing(set: &HarmonicSet, packed: &[f64], a: f64, b: f64, xa: f64, xb: f64, level: f64) -> f64 {
    // Between two turning points a motion resembles half a wave of a cosine.
    let guess = a + (b - a) * (1.0 - 2.0 * (level - xa) / (xb - xa)).acos() / PI;
    let mut signal = Approach::new(set, packed);
    safe_halley((a, b), xa - level, (guess, last_step(set)), |tau| {
        let at = signal.at(tau);
        [at.x - level, at.dx, at.ddx]
    })
}

/// The time between two at which x′, of opposite signs there, vanishes, and x there; from x′ at the first one and a guess.
#[inline]
pub(super) fn turning_point(
    set: &HarmonicSet,
    packed: &[f64],
    (a, b): (f64, f64),
    (slope, guess): (f64, f64),
) -> (f64, f64) {
    let mut signal = Approach::new(set, packed);
    let mut last = (0.0, 0.0, 0.0);
    let tau = safe_halley((a, b), slope, (guess, last_step(set)), |tau| {
        let at = signal.at(tau);
        last = (tau, at.x, at.dx);
        [at.dx, at.ddx, at.dddx]
    });
    // The step from the last jet is short, and x′ falls to zero along it.
    let (at, x, slope) = last;
    (tau, x + 0.5 * (tau - at) * slope)
}

#[cfg(test)]
mod tests {
    use super::*;

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
