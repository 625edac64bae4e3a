//! Options of a fit.

use crate::error::{Result, fail};

/// Loss of a residual r, in units of its standard deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Loss {
    /// The square r².
    Square,
    /// The square r² up to this number of standard deviations, and its tangent beyond (Huber 1964,
    /// doi:10.1214/aoms/1177703732).
    Huber(f64),
}

/// Default of the step at which a search ends.
/// Kind: fixed.
pub(super) const FIT_STEP: f64 = 1e-6;

/// Options of a fit.
#[derive(Clone, Copy, Debug)]
pub struct FitOptions {
    /// Loss of the residuals.
    pub loss: Loss,
    /// Number of starts of the search: the given one, then those of a fixed sequence within the bounds.
    pub starts: usize,
    /// Largest number of iterations from each start.
    pub max_iterations: usize,
    /// Step, in standard deviations of the unknowns, at which the search ends. With 200 numbers of data and more it ends at an estimated
    /// error of 1e-5, unless this is smaller than the default; a complex point has two numbers.
    pub step: f64,
    /// Whether the covariance is multiplied by χ² over the degrees of freedom, where standard deviations are known up to a factor.
    pub scale_covariance: bool,
}

impl Default for FitOptions {
    fn default() -> Self {
        Self {
            loss: Loss::Square,
            starts: 1,
            max_iterations: 60,
            step: FIT_STEP,
            scale_covariance: false,
        }
    }
}

/// Data points from which a share of them is searched first: below, a point is cheap beside the curve that it lies on.
/// Kind: tuned; measured on: not recorded.
pub(super) const FIT_THINNED_FROM: usize = 100;

/// Most starts and iterations of a fit.
/// Kind: cap.
const FIT_LARGEST: (usize, usize) = (1000, 10_000);

/// Intervals of the integrals of the normal distribution.
/// Kind: rounding.
const NORMAL_INTERVALS: usize = 200;

impl FitOptions {
    /// Checks the values of all options.
    ///
    /// # Errors
    /// `Argument`, naming the field, its value and its range.
    pub fn check(&self) -> Result<()> {
        if let Loss::Huber(k) = self.loss
            && !(k > 0.0 && k.is_finite())
        {
            return fail!(Argument, "huber = {k}, needs a finite number > 0");
        }
        for (name, value, most) in [
            ("starts", self.starts, FIT_LARGEST.0),
            ("max_iterations", self.max_iterations, FIT_LARGEST.1),
        ] {
            if value == 0 || value > most {
                return fail!(Argument, "{name} = {value}, needs 1 .. {most}");
            }
        }
        if !(self.step > 0.0 && self.step < 1.0) {
            return fail!(Argument, "step = {}, needs 0 < step < 1", self.step);
        }
        Ok(())
    }
}

impl Loss {
    /// Loss of a residual r.
    pub(super) fn cost(self, r: f64) -> f64 {
        match self {
            Self::Huber(k) if r.abs() > k => 2.0 * k * r.abs() - k * k,
            _ => r * r,
        }
    }

    /// Weight of a residual r: half the derivative of the loss, over r.
    pub(super) fn weight(self, r: f64) -> f64 {
        match self {
            Self::Huber(k) if r.abs() > k => k / r.abs(),
            _ => 1.0,
        }
    }

    /// Variance of an estimate with this loss over that of least squares under normal noise: E ψ²/(E ψ')².
    pub(super) fn inefficiency(self) -> f64 {
        let Self::Huber(k) = self else { return 1.0 };
        // Beyond 12 standard deviations nothing is left of the distribution.
        let end = k.min(12.0);
        let h = end / NORMAL_INTERVALS as f64;
        let density = |r: f64| (-0.5 * r * r).exp() / std::f64::consts::TAU.sqrt();
        let (mut inside, mut squares) = (0.0, 0.0);
        for i in 0..=NORMAL_INTERVALS {
            // Simpson's rule over one half of the distribution.
            let share = match i {
                0 | NORMAL_INTERVALS => 1.0,
                _ if i % 2 == 1 => 4.0,
                _ => 2.0,
            };
            let r = h * i as f64;
            inside += 2.0 * share * h / 3.0 * density(r);
            squares += 2.0 * share * h / 3.0 * r * r * density(r);
        }
        (squares + k * k * (1.0 - inside).max(0.0)) / (inside * inside)
    }
}
