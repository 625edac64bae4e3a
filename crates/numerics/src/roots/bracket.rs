//! Roots of a function inside a bracket, and minima of a function in a range, without derivatives.
//!
//! A caller whose values are dear, or who keeps what was found with them, narrows a [`Bracket`] himself; [`root`] and [`least`] take a
//! function.

/// Width of the bracket, as a share of the step, at which a root counts as found.
/// Kind: rounding.
pub const BRACKET_WIDTH: f64 = 1e-11;

/// Distance of a place found by interpolation from the one before it below which its error is less than [`BRACKET_WIDTH`]: the
/// order of convergence is 1.8.
/// Kind: tuned; measured on: not recorded.
const BRACKET_CLOSE: f64 = 1e-7;

/// Bracket of a root, as on an arc from 0 to 1, narrowed by inverse quadratic interpolation where the last three values lie on a
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
    #[must_use]
    pub fn between(low: (f64, f64), high: (f64, f64)) -> Self {
        Self {
            last: high,
            other: low,
            before: None,
            first: None,
        }
    }

    /// Uses a first position from the quadratic on the whole arc that has the values at the ends and this integral.
    #[must_use]
    pub fn with_integral(mut self, integral: f64) -> Self {
        let (a, b) = (self.other.1, self.last.1);
        let square = 3.0 * (a + b) - 6.0 * integral;
        let linear = b - a - square;
        let root = (linear * linear - 4.0 * square * a).sqrt();
        let candidates = [-2.0 * a / (linear + root), -2.0 * a / (linear - root)];
        self.first = candidates.into_iter().find(|s| *s > 0.0 && *s < 1.0);
        self
    }

    /// Width of the bracket, as a share of the arc.
    #[must_use]
    pub fn width(&self) -> f64 {
        (self.last.0 - self.other.0).abs()
    }

    /// Middle of the bracket.
    #[must_use]
    pub fn middle(&self) -> f64 {
        0.5 * (self.last.0 + self.other.0)
    }

    /// Whether the guess follows from interpolation and is so close to the end found last that its own error, far
    /// below this distance, is rounding. Beside a kink, where interpolation converges slowly, distances do not fall
    /// as fast.
    #[must_use]
    pub fn is_last(&self) -> bool {
        self.is_last_within(BRACKET_CLOSE)
    }

    /// Whether the guess is close enough, as `is_last` tells, for the distance `close`, whose power 1.8 is the error
    /// that counts as rounding.
    #[must_use]
    pub fn is_last_within(&self, close: f64) -> bool {
        let guess = self.guess();
        let distance = (guess - self.last.0).abs();
        let falls = |before: (f64, f64)| distance <= BRACKET_FAST * (self.last.0 - before.0).abs();
        guess.to_bits() != self.middle().to_bits() && distance < close && self.before.is_some_and(falls)
    }

    /// Position where the root is expected, as a share of the arc.
    #[must_use]
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

/// Values of a function up to which a root is sought.
/// Kind: cap.
const MOST_VALUES_OF_ROOT: usize = 200;

/// Distance to the end of a bracket, over the larger end, at which a root is found.
/// Kind: rounding.
const ROUNDING_OF_A_ROOT: f64 = 2.0 * f64::EPSILON;

/// Ratio of the golden section, (√5 − 1)/2.
/// Kind: fixed.
const GOLDEN_SECTION: f64 = 0.618_033_988_749_894_9;

/// The root of a function between two places, given with their values of different signs, but for rounding.
///
/// # Errors
/// Those of the function.
pub fn root<E>(
    low: (f64, f64),
    high: (f64, f64),
    mut f: impl FnMut(f64) -> core::result::Result<f64, E>,
) -> core::result::Result<f64, E> {
    let mut bracket = Bracket::between(low, high);
    let rounding = ROUNDING_OF_A_ROOT * low.0.abs().max(high.0.abs());
    for _ in 0..MOST_VALUES_OF_ROOT {
        let (a, b) = (bracket.last.0.min(bracket.other.0), bracket.last.0.max(bracket.other.0));
        if b - a <= rounding {
            break;
        }
        // A step of rounding at least, so that a root that is known closes the bracket from its other side.
        let place = bracket.guess().clamp(a + 0.5 * rounding, b - 0.5 * rounding);
        let value = f(place)?;
        if value == 0.0 {
            return Ok(place);
        }
        bracket.narrow(place, value);
    }
    Ok(bracket.guess())
}

/// The place between two others at which a function with one minimum is least, within a width: golden sections, with one value each.
///
/// # Errors
/// Those of the function.
pub fn least<E>(
    [mut low, mut high]: [f64; 2],
    width: f64,
    mut f: impl FnMut(f64) -> core::result::Result<f64, E>,
) -> core::result::Result<f64, E> {
    let section = GOLDEN_SECTION * (high - low);
    let mut inner = [high - section, low + section];
    let mut values = [f(inner[0])?, f(inner[1])?];
    while high - low > width && low < inner[0] && inner[0] < inner[1] && inner[1] < high {
        if values[0] < values[1] {
            high = inner[1];
            inner = [high - GOLDEN_SECTION * (high - low), inner[0]];
            values = [f(inner[0])?, values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + GOLDEN_SECTION * (high - low)];
            values = [values[1], f(inner[1])?];
        }
    }
    Ok(inner[usize::from(values[1] < values[0])])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Narrows a bracket of `f` and returns where it ends with the number of values taken.
    fn narrowed(f: impl Fn(f64) -> f64) -> (f64, usize) {
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
            let (smooth, taken) = narrowed(|s| (s - at) * (2.0 + s * s));
            assert!(
                (smooth - at).abs() < 1e-11 && taken <= 9,
                "{smooth} for {at} after {taken}"
            );
            // Nine times as steep on one side; and one beside a pole.
            let (bent, taken) = narrowed(|s| if s < at { (s - at) / 3.0 } else { (s - at) * 3.0 });
            assert!((bent - at).abs() < 1e-10 && taken < 60, "{bent} for {at} after {taken}");
            let (steep, taken) = narrowed(|s| (s - at) / (1.001 - s));
            assert!(
                (steep - at).abs() < 1e-10 && taken < 60,
                "{steep} for {at} after {taken}"
            );
        }
    }

    #[test]
    fn roots_of_a_function_have_all_digits_wherever_the_bracket_lies() {
        for k in 1..60 {
            let at = 1e3 + 17.0 * f64::from(k) + f64::from(k).sqrt();
            for f in [
                |s: f64, at: f64| s - at,
                |s: f64, at: f64| (s - at).powi(3),
                |s: f64, at: f64| (s - at).signum(),
                |s: f64, at: f64| (s / at).ln().exp_m1() * (5e3 - s),
            ] {
                let taken = std::cell::Cell::new(0);
                let value = |s: f64| {
                    taken.set(taken.get() + 1);
                    Ok::<_, ()>(f(s, at))
                };
                let found = root((900.0, f(900.0, at)), (2100.0, f(2100.0, at)), value).unwrap();
                assert!((found - at).abs() <= 1e-6 * at && taken.get() < 150, "{found} for {at}");
                assert!(
                    f(found - 1e-12 * at, at) <= 0.0 || (found - at).powi(3) == 0.0,
                    "{found} for {at}"
                );
            }
        }
        assert_eq!(root((0.0, -1.0), (1.0, 1.0), |_| Err("no value")), Err("no value"));
    }

    #[test]
    fn the_least_value_is_found_within_the_width() {
        for k in 1..50 {
            let at = f64::from(k) / 50.0;
            let found = least([-0.1, 1.2], 1e-9, |s| Ok::<_, ()>((s - at).abs())).unwrap();
            assert!((found - at).abs() < 1e-9, "{found} for {at}");
        }
        // At an end.
        let found = least([0.0, 1.0], 1e-9, |s: f64| Ok::<_, ()>(s)).unwrap();
        assert!(found < 1e-9, "{found}");
    }

    #[test]
    fn the_first_place_is_the_root_of_a_quadratic_with_its_integral() {
        let f = |s: f64| (0.3 - s) * (4.0 - s);
        let integral = 1.2 - 4.3 / 2.0 + 1.0 / 3.0;
        let bracket = Bracket::new(f(0.0), f(1.0)).with_integral(integral);
        assert!((bracket.guess() - 0.3).abs() < 1e-15);
    }
}
