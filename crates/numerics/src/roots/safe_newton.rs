//! Roots of a function with derivatives inside a bracket: Newton's and Halley's methods.

/// Width below which another Newton step no longer matters: the force is continuous at every
/// event, so an event misplaced by ε changes the Fourier integrals by O(ε²).
/// Kind: rounding.
const EVENT_TOLERANCE: f64 = 1e-9;

/// Values of a function up to which a root is sought.
/// Kind: cap.
const MOST_VALUES: usize = 100;

/// Largest error that the curvature leaves after the last step of Halley's method.
/// Kind: rounding.
const LAST_ERROR: f64 = 1e-17;

/// Interval between two times in which a function changes its sign.
struct Bracket {
    /// Time at which the function is negative; and time at which it is not.
    low: f64,
    high: f64,
    /// Length of the last step towards the root.
    last: f64,
}

impl Bracket {
    /// The bracket of two times, with the value at the first one.
    #[inline]
    fn new(a: f64, b: f64, fa: f64) -> Self {
        let (low, high) = if fa < 0.0 { (a, b) } else { (b, a) };
        Self {
            low,
            high,
            last: (b - a).abs(),
        }
    }

    /// Replaces an end by a time within the bracket, according to the value at this time.
    #[inline]
    fn narrow(&mut self, tau: f64, value: f64) {
        if value < 0.0 {
            self.low = tau;
        } else {
            self.high = tau;
        }
    }

    /// First time to try: the guess if it lies between `a` and `b`, else the middle; comparisons with NaN are false.
    #[inline]
    fn begin(a: f64, b: f64, guess: f64) -> f64 {
        if guess > a && guess < b { guess } else { 0.5 * (a + b) }
    }

    #[inline]
    fn holds(&self, tau: f64) -> bool {
        (tau - self.low) * (tau - self.high) < 0.0
    }

    /// Next time to try: the proposed one if it lies within the bracket and at least halves the step, else the
    /// middle.
    #[inline]
    fn step(&mut self, tau: f64, proposed: f64) -> f64 {
        let next = if self.holds(proposed) && (proposed - tau).abs() <= 0.5 * self.last {
            proposed
        } else {
            0.5 * (self.low + self.high)
        };
        self.last = (next - tau).abs();
        next
    }

    /// The root after one more Newton step, if this is not longer than twice the last step.
    ///
    /// Twice as long at most: bisection towards an end of the bracket that is the root but for rounding stops as far from it
    /// as its last step was long.
    #[inline]
    fn polished(&self, tau: f64, step: f64) -> f64 {
        if step.abs() <= 2.0 * self.last { tau - step } else { tau }
    }
}

/// Newton's method inside a bracket, with bisection where a step leaves it or does not converge.
/// The last evaluation of `f` is within the tolerance of the returned root.
#[must_use]
#[inline]
pub fn safe_newton(a: f64, b: f64, fa: f64, fb: f64, mut f: impl FnMut(f64) -> (f64, f64)) -> f64 {
    let mut bracket = Bracket::new(a, b, fa);
    // The secant step; equal end values give NaN or infinity.
    let mut tau = Bracket::begin(a, b, a - fa * (b - a) / (fb - fa));
    for _ in 0..MOST_VALUES {
        let (value, slope) = f(tau);
        if value == 0.0 {
            return tau;
        }
        bracket.narrow(tau, value);
        tau = bracket.step(tau, tau - value / slope);
        if bracket.last < EVENT_TOLERANCE {
            let (value, slope) = f(tau);
            return bracket.polished(tau, value / slope);
        }
    }
    tau
}

/// Halley's method inside a bracket from a guess, with bisection where a step leaves it or does not converge: fewer
/// values of the function than Newton's method needs. `f` returns a function and two derivatives; a step of the length
/// `short` is the last one.
#[must_use]
pub fn safe_halley((a, b): (f64, f64), fa: f64, (guess, short): (f64, f64), mut f: impl FnMut(f64) -> [f64; 3]) -> f64 {
    let mut bracket = Bracket::new(a, b, fa);
    let mut tau = Bracket::begin(a, b, guess);
    for _ in 0..MOST_VALUES {
        let [value, slope, curvature] = f(tau);
        if value == 0.0 {
            return tau;
        }
        bracket.narrow(tau, value);
        let newton = value / slope;
        let bend = 0.5 * newton * curvature / slope;
        let next = if bend.abs() < 0.5 {
            tau - newton / (1.0 - bend)
        } else {
            tau - newton
        };
        let step = (next - tau).abs();
        if step == 0.0 {
            // It does not lie within the bracket, whose middle is far away.
            return tau;
        }
        if bracket.holds(next) && step <= short && bend * bend * step <= LAST_ERROR {
            return next;
        }
        tau = bracket.step(tau, next);
        if bracket.last < EVENT_TOLERANCE {
            // Near a tangent, or at an end of the bracket.
            let [value, slope, _] = f(tau);
            return bracket.polished(tau, value / slope);
        }
    }
    tau
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    /// Root of sin(τ − c) and the number of values taken.
    fn sine(bracket: (f64, f64), guess: f64, c: f64) -> (f64, usize) {
        let taken = Cell::new(0);
        let root = safe_halley(bracket, (bracket.0 - c).sin(), (guess, 3e-7), |tau| {
            taken.set(taken.get() + 1);
            let (value, slope) = (tau - c).sin_cos();
            [value, slope, -value]
        });
        (root, taken.get())
    }

    #[test]
    fn a_good_guess_is_left_by_its_own_step_alone() {
        let mut most = 0;
        for k in 0..500 {
            let c = 0.3 + 0.0041 * f64::from(k);
            for error in [0.0, 1e-17, 1e-12, 1e-8, 1e-6, 1e-4, 1e-2, 4e-2] {
                for guess in [c - error, c + error] {
                    let (root, taken) = sine((c - 0.05, c + 0.05), guess, c);
                    assert!((root - c).abs() < 1e-15, "{root} for {c} from {guess}");
                    most = most.max(taken);
                }
            }
        }
        assert!(most <= 4, "{most} values");
    }
}
