//! A response of the motion: a gauge, and the number that is read from it over a period.

use crate::error::{Result, fail};
use crate::fourier::Measure;

/// Derivative of the motion by time that a response reads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Component {
    /// Displacement x.
    #[default]
    Displacement,
    /// Velocity dx/dt.
    Velocity,
    /// Acceleration d²x/dt².
    Acceleration,
}

impl Component {
    /// Order of the derivative.
    #[must_use]
    pub fn order(self) -> i32 {
        self as i32
    }
}

/// A response: a gauge Σ w x over degrees of freedom of one sector, and the number that is read from it over a
/// period.
#[derive(Clone, Copy, Debug, Default)]
pub struct Response<'a> {
    /// Measure: the number that is read over a period.
    pub measure: Measure,
    /// Degrees of freedom of the gauge; empty: the response degree of freedom of the solver.
    pub dofs: &'a [usize],
    /// Weights of these degrees of freedom; empty: 1 each.
    pub weights: &'a [f64],
    /// Sector of the wheel that is read, from 0.
    pub sector: usize,
    /// Displacement, velocity or acceleration.
    pub component: Component,
}

/// Most responses of one run.
/// Kind: cap.
const MOST_RESPONSES: usize = 100_000;

impl Response<'_> {
    /// Checks a response of a model with `ndof` degrees of freedom and `sectors` sectors.
    ///
    /// # Errors
    /// `Index`, `Dimension`, `NotFinite` or `Argument`, naming the field, its value and its range.
    pub fn check(&self, ndof: usize, sectors: usize) -> Result<()> {
        if let Some(dof) = self.dofs.iter().find(|dof| **dof >= ndof) {
            return fail!(Index, "dofs has {dof}, needs 0 .. {}", ndof.saturating_sub(1));
        }
        if !self.weights.is_empty() && self.weights.len() != self.dofs.len() {
            return fail!(
                Dimension,
                "weights has {} numbers, needs one for each of the {} dofs, or none",
                self.weights.len(),
                self.dofs.len()
            );
        }
        if let Some(weight) = self.weights.iter().find(|weight| !weight.is_finite()) {
            return fail!(NotFinite, "weights has {weight}, needs finite numbers");
        }
        if !self.weights.is_empty() && self.weights.iter().all(|weight| *weight == 0.0) {
            return fail!(Argument, "weights are all 0, needs one that is not");
        }
        if self.sector >= sectors {
            return fail!(Index, "sector = {}, needs 0 .. {}", self.sector, sectors - 1);
        }
        if self.measure == Measure::Harmonic(0) && self.component != Component::Displacement {
            return fail!(Argument, "harmonic = 0, the mean, has no velocity and no acceleration");
        }
        Ok(())
    }

    /// Response of a run without forces in the fundamental: the root mean square of the response degree of freedom.
    pub(crate) fn of_no_fundamental() -> Self {
        Self {
            measure: Measure::Rms,
            ..Self::default()
        }
    }

    /// Whether this is the fundamental displacement of one degree of freedom, as every forced response observes it.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.measure == Measure::Fundamental
            && self.component == Component::Displacement
            && self.dofs.len() <= 1
            && self.weights.iter().all(|weight| weight.to_bits() == 1.0_f64.to_bits())
    }
}

/// Checks all responses of a run.
///
/// # Errors
/// As [`Response::check`], with the number of the response.
pub(crate) fn check_responses(responses: &[Response<'_>], ndof: usize, sectors: usize) -> Result<()> {
    if responses.len() > MOST_RESPONSES {
        return fail!(
            Argument,
            "responses has {}, needs 0 .. {MOST_RESPONSES}",
            responses.len()
        );
    }
    for (i, response) in responses.iter().enumerate() {
        response
            .check(ndof, sectors)
            .map_err(|e| e.at(format_args!("responses[{i}]")))?;
    }
    Ok(())
}
