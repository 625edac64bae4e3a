//! Resonances that a step along a branch passes as a whole.
//!
//! Forces, slip and impacts excite harmonics h of the frequency, which resonate where hω meets a natural frequency. With light damping
//! such a resonance may lie within one step, and its ends are smooth and predict each other. Its pole shows at them all the same.
//! With
//!
//! > X_h ≈ B + R/(s₀ − s),  X_h′ ≈ R/(s₀ − s)²
//!
//! along the arc s from a to b, distances u and w before and behind the pole, the harmonic changes against its derivatives:
//!
//! > X_h(b) − X_h(a) ≈ −R (1/u + 1/w),  |X_h′(a)| u² ≈ |X_h′(b)| w² ≈ |R|.
//!
//! A smooth function of s does so where it oscillates within the step: then, too, the step is too long. Harmonics above the first
//! are seen in the time of that one, in which e^{−ihφ} takes a shift φ out.

use crate::fourier::HarmonicSet;
use crate::problem::parametric_problem::End;
use num_complex::Complex64;
use std::f64::consts::FRAC_PI_2;

/// Least change of a harmonic that counts, as a share of the motion.
/// Kind: tuned; measured on: not recorded.
const RELEVANT: f64 = 1e-4;

/// Cosine of the angle between the change and a derivative below which they have opposite directions.
/// Kind: tuned; measured on: not recorded.
const OPPOSITE: f64 = -0.5;

/// Largest ratio of the change to that of the pole, either way.
/// Kind: tuned; measured on: not recorded.
const ALIKE: f64 = 2.0;

/// Position, as a share of the step length, at which a harmonic resonates between the ends `a` and `b`; the first one
/// where several do.
pub(super) fn between(set: &HarmonicSet, a: &End<'_>, b: &End<'_>, length: f64) -> Option<f64> {
    let least = RELEVANT * a.size.max(b.size);
    let mut base: Option<(usize, usize)> = None;
    let mut shift: Option<Shift> = None;
    let mut first: Option<f64> = None;
    for (i, &h) in set.numbers().iter().enumerate().filter(|(_, h)| **h > 0) {
        let (lowest, number) = *base.get_or_insert((i, h));
        // The lowest one is seen in its own time.
        let own = if i == lowest {
            Shift::NONE
        } else {
            let shift = shift.get_or_insert_with(|| Shift::of(set, lowest, a, b));
            let order = h / number;
            if largest_change(set, i, a, b, order as f64 * shift.angle) < least {
                continue;
            }
            shift.in_harmonic(order)
        };
        let found = Passage::of(set, i, (a, b), &own, least).and_then(|passage| passage.pole(length));
        if let Some(share) = found {
            first = Some(first.map_or(share, |f| f.min(share)));
        }
    }
    first
}

/// Upper bound of the change of a harmonic whose motion at `b` is shifted by at most `angle`: the change without the
/// shift, plus the angle times the size of the motion.
fn largest_change(set: &HarmonicSet, i: usize, a: &End<'_>, b: &End<'_>, angle: f64) -> f64 {
    let (m, mut first) = (set.packed_len(), set.offset(i));
    let (mut change, mut size) = (0.0, 0.0);
    while let (Some(xa), Some(xb)) = (pair(a.unknowns, first), pair(b.unknowns, first)) {
        change += (xb - xa).norm_sqr();
        size += xb.norm_sqr();
        first += m;
    }
    change.sqrt() + angle * size.sqrt()
}

/// The complex number stored at position `at` and the next one; `None` beyond the end.
#[inline]
fn pair(packed: &[f64], at: usize) -> Option<Complex64> {
    match packed.get(at..at + 2)? {
        [re, im] => Some(Complex64::new(*re, *im)),
        _ => None,
    }
}

/// Shift of time from one end to the other: a factor e^{−iφ} for the motion at the other end, and −iφ′ at both.
struct Shift {
    turn: Complex64,
    /// Upper bound of the phase |φ|.
    angle: f64,
    rates: (Complex64, Complex64),
}

impl Shift {
    const NONE: Self = Self {
        turn: Complex64::ONE,
        angle: 0.0,
        rates: (Complex64::ZERO, Complex64::ZERO),
    };

    /// The shift of time between the ends, by the phase of the i-th harmonic.
    fn of(set: &HarmonicSet, i: usize, a: &End<'_>, b: &End<'_>) -> Self {
        let product = |x: &[f64], y: &[f64]| {
            let (m, mut first) = (set.packed_len(), set.offset(i));
            let mut sum = Complex64::ZERO;
            while let (Some(x), Some(y)) = (pair(x, first), pair(y, first)) {
                sum += x.conj() * y;
                first += m;
            }
            sum
        };
        let rate = |end: &End<'_>| {
            let tangent = &end.tangent[..end.unknowns.len()];
            let rate = end.unit * product(end.unknowns, tangent).im / product(end.unknowns, end.unknowns).re;
            -Complex64::I * if rate.is_finite() { rate } else { 0.0 }
        };
        let both = product(a.unknowns, b.unknowns);
        let length = both.norm_sqr().sqrt();
        let turn = if length > 0.0 {
            both.conj() / length
        } else {
            Complex64::ONE
        };
        Self {
            turn,
            // An arc is shorter than π/2 of its chord.
            angle: FRAC_PI_2 * (turn - 1.0).norm_sqr().sqrt(),
            rates: (rate(a), rate(b)),
        }
    }

    /// The shift in a harmonic whose number is `order` times that of this one.
    fn in_harmonic(&self, order: usize) -> Self {
        Self {
            turn: self.turn.powu(order as u32),
            angle: self.angle * order as f64,
            rates: (self.rates.0 * order as f64, self.rates.1 * order as f64),
        }
    }
}

/// One harmonic of all coordinates at the ends of a step: squares and products of its change and its derivatives.
#[derive(Default)]
struct Passage {
    change: f64,
    before: f64,
    behind: f64,
    along_before: f64,
    along_behind: f64,
}

impl Passage {
    /// Data of the i-th harmonic; `None` where it changes by less than `least`, or as it does away from a pole.
    fn of(set: &HarmonicSet, i: usize, (a, b): (&End<'_>, &End<'_>), shift: &Shift, least: f64) -> Option<Self> {
        let mut sums = Self::default();
        let (m, at) = (set.packed_len(), set.offset(i));
        let mut first = at;
        while let (Some(xa), Some(xb), Some(ta)) =
            (pair(a.unknowns, first), pair(b.unknowns, first), pair(a.tangent, first))
        {
            let change = shift.turn * xb - xa;
            let before = a.unit * ta + shift.rates.0 * xa;
            sums.change += change.norm_sqr();
            sums.before += before.norm_sqr();
            sums.along_before += (change.conj() * before).re;
            first += m;
        }
        if sums.change < least * least || !sums.is_opposite(sums.along_before, sums.before) {
            return None;
        }
        first = at;
        while let (Some(xa), Some(xb), Some(tb)) =
            (pair(a.unknowns, first), pair(b.unknowns, first), pair(b.tangent, first))
        {
            let change = shift.turn * xb - xa;
            let behind = shift.turn * (b.unit * tb + shift.rates.1 * xb);
            sums.behind += behind.norm_sqr();
            sums.along_behind += (change.conj() * behind).re;
            first += m;
        }
        Some(sums)
    }

    /// Whether the change and a derivative point in opposite directions, from their product `along` and the square
    /// `size` of the derivative.
    fn is_opposite(&self, along: f64, size: f64) -> bool {
        along < OPPOSITE * (self.change * size).sqrt()
    }

    /// Position of a pole within the step, as a share of its length; `None` where there is none.
    fn pole(&self, length: f64) -> Option<f64> {
        if !self.is_opposite(self.along_behind, self.behind) {
            return None;
        }
        let share = 1.0 / (1.0 + (self.before / self.behind).powf(0.25));
        let foreseen = self.before.sqrt() * share * length / (1.0 - share);
        let ratio = self.change.sqrt() / foreseen;
        (1.0 / ALIKE..=ALIKE).contains(&ratio).then_some(share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::norm;

    /// A motion of two coordinates in harmonics 1, 3, 5 along s, and its derivative: harmonic 3 has a pole at 0.37 + iδ, of
    /// strength R in the first coordinate, and all are shifted in time by 3s.
    fn at(set: &HarmonicSet, s: f64, (strength, half_width): (f64, f64)) -> [Vec<f64>; 2] {
        let m = set.packed_len();
        let (mut motion, mut derivative) = (vec![0.0; 2 * m], vec![0.0; 2 * m + 1]);
        for (i, &h) in set.numbers().iter().enumerate() {
            for c in 0..2 {
                let place = h as f64 + c as f64;
                let mut value = Complex64::new((2.0 * s + place).cos(), s) / place.powi(2);
                let mut slope = Complex64::new(-2.0 * (2.0 * s + place).sin(), 1.0) / place.powi(2);
                if h == 3 && c == 0 {
                    let distance = Complex64::new(0.37 - s, half_width);
                    value += strength / distance;
                    slope += strength / distance.powi(2);
                }
                let turn = Complex64::from_polar(1.0, 3.0 * s * h as f64);
                set.set(&mut motion[c * m..(c + 1) * m], i, turn * value);
                let slope = turn * (slope + 3.0 * Complex64::I * h as f64 * value);
                set.set(&mut derivative[c * m..(c + 1) * m], i, slope);
            }
        }
        [motion, derivative]
    }

    /// The pole found in a step.
    fn found(from: f64, to: f64, pole: (f64, f64)) -> Option<f64> {
        let set = HarmonicSet::excited(&[1], 5, true, true, false).unwrap();
        let ends = [from, to].map(|s| at(&set, s, pole));
        // Derivatives in other units than the motion.
        let tangents = [&ends[0], &ends[1]].map(|end| end[1].iter().map(|t| 7.0 * t).collect::<Vec<_>>());
        let end = |i: usize| End {
            unknowns: &ends[i][0],
            size: norm(&ends[i][0]),
            tangent: &tangents[i],
            unit: 1.0 / 7.0,
        };
        between(&set, &end(0), &end(1), (to - from).abs())
    }

    #[test]
    fn a_pole_is_found_at_its_place_within_a_step() {
        for (from, to) in [(0.3, 0.4), (0.35, 0.38), (0.36, 0.45)] {
            let share = found(from, to, (0.01, 1e-6)).unwrap();
            let truth = (0.37 - from) / (to - from);
            assert!((share / truth - 1.0).abs() < 0.2, "{share}, {truth}");
        }
    }

    #[test]
    fn steps_without_a_pole_or_finer_than_it_pass_none() {
        for i in 0..200_i32 {
            let s = 0.01 * f64::from(i);
            assert_eq!(found(s, s + 0.05, (0.0, 1.0)), None);
            // A wide one, and one that is not worth its points.
            assert_eq!(found(s, s + 0.01, (0.01, 0.05)), None);
            assert_eq!(found(s, s + 0.05, (1e-7, 1e-4)), None);
        }
        assert_eq!(found(0.2, 0.36, (0.01, 1e-6)), None);
    }
}
