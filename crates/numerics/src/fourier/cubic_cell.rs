//! A function between two times, from its values and derivatives there: a cubic, from which it departs by
//!
//! > |f − cubic| ≤ M w⁴/384,  |f′ − cubic′| ≤ √3 M w³/216
//!
//! over a width w, where M bounds |f⁗| (Birkhoff & Priver, J. Math. Phys. 46 (1967) 440–447, doi:10.1002/sapm1967461440).

/// Factors of M w⁴ and M w³.
/// Kind: fixed.
const OF_VALUES: f64 = 1.0 / 384.0;
const CUBIC_CELL_OF_SLOPES: f64 = 0.008_018_753_738_744_8;

/// Steps of Newton's method towards the root of the cubic: a guess.
/// Kind: tuned; measured on: not recorded.
const CUBIC_CELL_STEPS: usize = 2;

/// A cubic by the ordinates of its control points, between which it lies (Bernstein form).
pub(super) struct CubicCell {
    control: [f64; 4],
    width: f64,
}

impl CubicCell {
    /// The cubic with given values and slopes at both ends of a cell.
    pub fn new(values: [f64; 2], slopes: [f64; 2], width: f64) -> Self {
        let third = width / 3.0;
        Self {
            control: [
                values[0],
                values[0] + third * slopes[0],
                values[1] - third * slopes[1],
                values[1],
            ],
            width,
        }
    }

    /// Whether the function certainly stays farther from zero than `noise`; `fourth` is a bound of its fourth
    /// derivative.
    pub fn keeps_sign(&self, fourth: f64, noise: f64) -> bool {
        let square = self.width * self.width;
        let rest = OF_VALUES * fourth * square * square + noise;
        self.control.iter().all(|c| *c > rest) || self.control.iter().all(|c| *c < -rest)
    }

    /// Whether the slope of the function certainly keeps its sign, where values err by `noise`.
    pub fn is_monotone(&self, fourth: f64, noise: f64) -> bool {
        let [a, b, c, d] = self.control;
        let square = self.width * self.width;
        let rest = CUBIC_CELL_OF_SLOPES / 3.0 * fourth * square * square + 2.0 * noise;
        let rises = [b - a, c - b, d - c];
        rises.iter().all(|rise| *rise > rest) || rises.iter().all(|rise| *rise < -rest)
    }

    /// Approximate root of the cubic, as a share of the width; the values at both ends must have opposite signs.
    pub fn root(&self) -> f64 {
        let [a, b, c, d] = self.control;
        // The cubic in powers of the share.
        let (first, second, third) = (3.0 * (b - a), 3.0 * (c - 2.0 * b + a), d - a + 3.0 * (b - c));
        let mut s = a / (a - d);
        for _ in 0..CUBIC_CELL_STEPS {
            let value = a + s * (first + s * (second + s * third));
            let slope = first + s * (2.0 * second + s * 3.0 * third);
            s -= value / slope;
        }
        s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// cos(t) + e cos(3t) with its derivative, between two times.
    fn cell(e: f64, [a, b]: [f64; 2]) -> CubicCell {
        let value = |t: f64| t.cos() + e * (3.0 * t).cos();
        let slope = |t: f64| -t.sin() - 3.0 * e * (3.0 * t).sin();
        CubicCell::new([value(a), value(b)], [slope(a), slope(b)], b - a)
    }

    #[test]
    fn nothing_is_certain_that_is_not_so() {
        let (mut certain, mut possible) = ([0; 2], [0; 2]);
        for i in 0..200 {
            for k in 0..60 {
                let (e, a) = (0.02 * f64::from(i) - 2.0, 0.11 * f64::from(k));
                let ends = [a, a + 0.05 * f64::from(1 + i % 7)];
                let found = cell(e, ends);
                let fourth = 1.0 + 81.0 * e.abs();
                let n = 400;
                let at = |j: i32| ends[0] + (ends[1] - ends[0]) * f64::from(j) / f64::from(n);
                let same = |f: &dyn Fn(f64) -> f64| (0..=n).all(|j| (f(at(j)) > 0.0) == (f(ends[0]) > 0.0));
                let keeps = same(&|t| t.cos() + e * (3.0 * t).cos());
                let monotone = same(&|t| -t.sin() - 3.0 * e * (3.0 * t).sin());
                let told = [found.keeps_sign(fourth, 0.0), found.is_monotone(fourth, 0.0)];
                for (m, (told, is)) in told.into_iter().zip([keeps, monotone]).enumerate() {
                    assert!(is || !told, "{e}, {ends:?}");
                    certain[m] += i32::from(told);
                    possible[m] += i32::from(is);
                }
            }
        }
        for (told, is) in certain.into_iter().zip(possible) {
            assert!(10 * told > 8 * is && told < is, "{told} of {is}");
        }
    }

    #[test]
    fn the_guess_is_as_near_as_the_cubic() {
        for k in 1..20 {
            let a = std::f64::consts::FRAC_PI_2 - 0.01 * f64::from(k);
            let found = cell(0.1, [a, a + 0.2]);
            let guess = a + 0.2 * found.root();
            assert!((guess - std::f64::consts::FRAC_PI_2).abs() < 2e-5, "{guess}");
        }
    }
}
