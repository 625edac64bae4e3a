//! Values of a real Fourier series over one turn, and its crossings of a level.

use crate::fourier::HarmonicSet;
use crate::roots::safe_halley;
use num_complex::Complex64;
use std::f64::consts::PI;

/// Value and three derivatives of a series at one time.
#[derive(Clone, Copy, Debug)]
pub struct Jet {
    /// Value x(τ).
    pub x: f64,
    /// First derivative dx/dτ.
    pub dx: f64,
    /// Second derivative d²x/dτ².
    pub ddx: f64,
    /// Third derivative d³x/dτ³.
    pub dddx: f64,
}

impl Jet {
    const ZERO: Self = Self {
        x: 0.0,
        dx: 0.0,
        ddx: 0.0,
        dddx: 0.0,
    };
}

/// Value and three derivatives of a packed signal at τ.
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
    let mut pairs = rest.as_chunks::<2>().0;
    if pairs.len() >= GROUPED_FROM {
        let sums = in_groups(pairs, turn, step, stride as f64);
        (low, high, pairs, turn, p) = (sums.low, sums.high, sums.rest, sums.turn, sums.number);
    }
    for [a, b] in pairs {
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

/// Harmonics of which each has a power of e^{iτ} of its own, so that none waits for the one before.
/// Kind: block.
const SERIES_GROUP: usize = 8;

/// Harmonics from which that takes less time.
/// Kind: tuned; measured on: one slider with 5 and with 64 odd harmonics.
const GROUPED_FROM: usize = 16;

/// Sums over whole groups of harmonics, and where the pairs that are left begin.
struct Sums<'a> {
    /// Values and p times the quadratures, and both times p².
    low: [f64; 2],
    high: [f64; 2],
    /// The pairs that are left, e^{ipτ} and p of their first.
    rest: &'a [[f64; 2]],
    turn: Complex64,
    number: f64,
}

/// The sums over whole groups from the first harmonic on.
#[inline(never)]
fn in_groups(pairs: &[[f64; 2]], mut turn: Complex64, step: Complex64, stride: f64) -> Sums<'_> {
    let (groups, rest) = pairs.as_chunks::<SERIES_GROUP>();
    // Powers of the first group, and the factor to the next.
    let (mut re, mut im, mut p) = ([0.0; SERIES_GROUP], [0.0; SERIES_GROUP], [0.0; SERIES_GROUP]);
    for k in 0..SERIES_GROUP {
        (re[k], im[k], p[k]) = (turn.re, turn.im, 1.0 + stride * k as f64);
        turn *= step;
    }
    let next = step.powu(SERIES_GROUP as u32);
    let [mut x, mut dx, mut ddx, mut dddx] = [[0.0; SERIES_GROUP]; 4];
    for group in groups {
        for k in 0..SERIES_GROUP {
            let [a, b] = group[k];
            let value = a * re[k] - b * im[k];
            let slope = (a * im[k] + b * re[k]) * p[k];
            let square = p[k] * p[k];
            x[k] += value;
            dx[k] += slope;
            ddx[k] += square * value;
            dddx[k] += square * slope;
            (re[k], im[k]) = (re[k] * next.re - im[k] * next.im, re[k] * next.im + im[k] * next.re);
            p[k] += stride * SERIES_GROUP as f64;
        }
    }
    let sum = |of: [f64; SERIES_GROUP]| of.iter().sum::<f64>();
    Sums {
        low: [sum(x), sum(dx)],
        high: [sum(ddx), sum(dddx)],
        rest,
        turn: Complex64::new(re[0], im[0]),
        number: p[0],
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

/// e^{is} for a small angle s, by its power series up to s¹⁰.
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

/// Longest last step to a turning point, in the same unit: it leaves 2e-16 of this unit, and the value there feels its square.
/// Kind: rounding.
const TURNING_LAST_STEP: f64 = 1e-5;

#[inline]
fn last_step(set: &HarmonicSet) -> f64 {
    SERIES_LAST_STEP / set.highest_reduced().max(1) as f64
}

/// Values of a series that a crossing, or another root, takes, about.
/// Kind: block.
pub const VALUES_OF_A_CROSSING: usize = 8;

/// The time in (a, b) at which a signal passes `level`; the signal must be monotone between these times.
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

/// The time between two others at which x′ vanishes, and x at this time. x′ has opposite signs at both; the value at
/// the first one and a guess are given.
#[inline]
pub(super) fn turning_point(
    set: &HarmonicSet,
    packed: &[f64],
    (a, b): (f64, f64),
    (slope, guess): (f64, f64),
) -> (f64, f64) {
    let mut signal = Approach::new(set, packed);
    let mut last = (0.0, Jet::ZERO);
    let short = TURNING_LAST_STEP / set.highest_reduced().max(1) as f64;
    let tau = safe_halley((a, b), slope, (guess, short), |tau| {
        let at = signal.at(tau);
        last = (tau, at);
        [at.dx, at.ddx, at.dddx]
    });
    let (at, jet) = last;
    let step = tau - at;
    // The next term is the fourth power of a short step.
    (
        tau,
        jet.x + step * (jet.dx + step * (jet.ddx / 2.0 + step * jet.dddx / 6.0)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_in_groups_are_sums_one_by_one() {
        for (highest, odd) in [
            (15, false),
            (16, false),
            (31, true),
            (47, false),
            (127, true),
            (130, false),
        ] {
            let set = HarmonicSet::excited(&[1], highest, true, odd, false).unwrap();
            let packed: Vec<f64> = (0..set.packed_len())
                .map(|i| (1.7 * i as f64).sin() / (1.0 + i as f64))
                .collect();
            for k in 0..20 {
                let tau = 0.31 * f64::from(k);
                let (mut x, mut d) = (0.0, [0.0; 3]);
                let mean = usize::from(set.has_mean());
                if mean == 1 {
                    x += packed[0];
                }
                for (i, pair) in packed[mean..].as_chunks::<2>().0.iter().enumerate() {
                    let p = set.reduced(i) as f64;
                    let z = Complex64::new(pair[0], pair[1]) * Complex64::cis(p * tau);
                    x += z.re;
                    d[0] -= p * z.im;
                    d[1] -= p * p * z.re;
                    d[2] += p * p * p * z.im;
                }
                let at = jet(&set, &packed, tau);
                let scale = highest as f64;
                for (found, expected, scale) in [
                    (at.x, x, 1.0),
                    (at.dx, d[0], scale),
                    (at.ddx, d[1], scale * scale),
                    (at.dddx, d[2], scale * scale * scale),
                ] {
                    assert!(
                        (found - expected).abs() < 1e-13 * scale,
                        "{highest}, {k}: {found} {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_turning_point_is_found_to_rounding_of_its_value() {
        // cos(τ − c) + e cos 9(τ − c) has its largest value 1 + e at c; guesses are off by less and by more than a last step.
        let set = HarmonicSet::all(9).unwrap();
        let mut worst = [0.0_f64; 2];
        for k in 0..300 {
            let c = 1.0 + 0.003 * f64::from(k);
            for e in [0.0, 1e-3, 0.1] {
                for off in [0.0, 1e-13, 1e-9, 1e-7, 3e-6, 1e-5, 1e-4, 1e-2] {
                    let mut packed = [0.0; 19];
                    for (p, size) in [(1, 1.0), (9, e)] {
                        let angle = f64::from(p) * c;
                        packed[2 * p as usize - 1] = size * angle.cos();
                        packed[2 * p as usize] = -size * angle.sin();
                    }
                    let bracket = (c - 0.03, c + 0.02);
                    let slope = jet(&set, &packed, bracket.0).dx;
                    let (tau, x) = turning_point(&set, &packed, bracket, (slope, c + off));
                    worst = [worst[0].max((tau - c).abs()), worst[1].max((x - 1.0 - e).abs())];
                }
            }
        }
        assert!(worst[0] < 2e-15 && worst[1] < 2e-15, "{worst:?}");
    }

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
