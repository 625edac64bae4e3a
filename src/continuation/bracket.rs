//! Bracket of a root along an arc.

/// Width of the bracket, as a share of the step, at which a root counts as found.
/// Kind: rounding.
pub const BRACKET_WIDTH: f64 = 1e-11;

/// Distance of a place found by interpolation from the one before it below which its error is less than [`BRACKET_WIDTH`]: the
/// order of convergence is 1.8.
/// Kind: tuned; measured on: not recorded.
const BRACKET_CLOSE: f64 = 1e-7;

/// Bracket of a root on an arc from 0 to 1, narrowed by inverse quadratic interpolation where the last three values lie on a
/// monotonic curve, else by halving (Chandrupatla, Adv. Eng. Software 28, 1997, doi:10.1016/S0965-9978(96)00051-8); first by
/// the secant.
pub struct Bracket {
    /// The end found last, the other end, and the end that was replaced last, if there is one; each with its value.
    last: (f64, f64),
    other: (f64, f64),
    before: Option<(f64, f64)>,
    /// First position to try, if a better one than that of the secant is known.
    first: Option<f64>,
}

/// Largest ratio of that distance to the one before where interpolation converges fast.
/// Kind: tuned; measured on: not recorded.
const BRACKET_FAST: f64 = 1e-2;

impl Bracket {
    /// The whole arc with the values at its ends, of different signs.
    #[must_use]
    pub fn new(low: f64, high: f64) -> Self {
        Self::between((0.0, low), (1.0, high))
    }

    /// A bracket between two positions, with their values.
    pub(super) fn between(low: (f64, f64), high: (f64, f64)) -> Self {
        Self {
            last: high,
            other: low,
            before: None,
            first: None,
        }
    }

    /// Uses a first position from the quadratic on the whole arc that has the values at the ends and this integral.
    pub(super) fn with_integral(mut self, integral: f64) -> Self {
        let (a, b) = (self.other.1, self.last.1);
        let square = 3.0 * (a + b) - 6.0 * integral;
        let linear = b - a - square;
        let root = (linear * linear - 4.0 * square * a).sqrt();
        let candidates = [-2.0 * a / (linear + root), -2.0 * a / (linear - root)];
        self.first = candidates.into_iter().find(|s| *s > 0.0 && *s < 1.0);
        self
    }

    /// Width of the bracket, as a share of the arc.
    pub fn width(&self) -> f64 {
        (self.last.0 - self.other.0).abs()
    }

    /// Middle of the bracket.
    pub(super) fn middle(&self) -> f64 {
        0.5 * (self.last.0 + self.other.0)
    }

    /// Whether the guess follows from interpolation and is so close to the end found last that its own error, far
    /// below this distance, is rounding. Beside a kink, where interpolation converges slowly, distances do not fall
    /// as fast.
    pub fn is_last(&self) -> bool {
        self.is_last_within(BRACKET_CLOSE)
    }

    /// Whether the guess is close enough, as `is_last` tells, for the distance `close`, whose power 1.8 is the error
    /// that counts as rounding.
    pub fn is_last_within(&self, close: f64) -> bool {
        let guess = self.guess();
        let distance = (guess - self.last.0).abs();
        let falls = |before: (f64, f64)| distance <= BRACKET_FAST * (self.last.0 - before.0).abs();
        guess.to_bits() != self.middle().to_bits() && distance < close && self.before.is_some_and(falls)
    }

    /// Position where the root is expected, as a share of the arc.
    pub fn guess(&self) -> f64 {
        let ((a, fa), (b, fb)) = (self.last, self.other);
        if let (None, Some(first)) = (self.before, self.first) {
            return first;
        }
        let share = match self.before {
            None => fa / (fa - fb),
            Some((c, fc)) => {
                let (place, value) = ((a - b) / (c - b), (fa - fb) / (fc - fb));
                if value * value < place && (1.0 - value).powi(2) < 1.0 - place {
                    fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
                } else {
                    0.5
                }
            }
        };
        let guess = a + share * (b - a);
        if share > 0.0 && share < 1.0 {
            guess
        } else {
            self.middle()
        }
    }

    /// Takes the value f at position s within the bracket, and returns the distance to the end that it replaces.
    pub fn narrow(&mut self, s: f64, f: f64) -> f64 {
        let replaces_last = (f > 0.0) == (self.last.1 > 0.0);
        let (replaced, kept) = if replaces_last {
            (self.last, self.other)
        } else {
            (self.other, self.last)
        };
        (self.last, self.other, self.before) = ((s, f), kept, Some(replaced));
        (s - replaced.0).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Narrows a bracket of `f` and returns where it ends with the number of values taken.
    fn root(f: impl Fn(f64) -> f64) -> (f64, usize) {
        let mut bracket = Bracket::new(f(0.0), f(1.0));
        for taken in 1..100 {
            let (s, is_last) = (bracket.guess(), bracket.is_last());
            let value = f(s);
            if is_last || value == 0.0 || bracket.width() < BRACKET_WIDTH || bracket.narrow(s, value) < BRACKET_WIDTH {
                return (s, taken);
            }
        }
        (f64::NAN, 100)
    }

    #[test]
    fn roots_are_found_wherever_they_lie() {
        for k in 1..100 {
            let at = f64::from(k) / 100.0;
            let (smooth, taken) = root(|s| (s - at) * (2.0 + s * s));
            assert!(
                (smooth - at).abs() < 1e-11 && taken <= 9,
                "{smooth} for {at} after {taken}"
            );
            // Nine times as steep on one side; and one beside a pole.
            let (bent, taken) = root(|s| if s < at { (s - at) / 3.0 } else { (s - at) * 3.0 });
            assert!((bent - at).abs() < 1e-10 && taken < 60, "{bent} for {at} after {taken}");
            let (steep, taken) = root(|s| (s - at) / (1.001 - s));
            assert!(
                (steep - at).abs() < 1e-10 && taken < 60,
                "{steep} for {at} after {taken}"
            );
        }
    }

    #[test]
    fn the_first_place_is_the_root_of_a_quadratic_with_its_integral() {
        let f = |s: f64| (0.3 - s) * (4.0 - s);
        let integral = 1.2 - 4.3 / 2.0 + 1.0 / 3.0;
        let bracket = Bracket::new(f(0.0), f(1.0)).with_integral(integral);
        assert!((bracket.guess() - 0.3).abs() < 1e-15);
    }
}
