//! Data of a branch over a parameter of the model, beside those that every branch has.

use crate::error::{Error, Result, fail};
use crate::results::branch::{Branch, Special};

/// An optimum of the amplitude over a parameter.
#[derive(Clone, Copy, Debug)]
pub struct Optimum {
    /// The stored point.
    pub special: Special,
    /// Value of the parameter.
    pub parameter: f64,
    /// Whether the amplitude is largest there, else smallest.
    pub is_maximum: bool,
}

/// Numbers of the stored points over a parameter.
#[derive(Debug, Default)]
pub(crate) struct ParameterData {
    /// Value of the parameter at each stored point.
    parameter: Vec<f64>,
    /// Total derivative of the amplitude by it; NaN where there is none.
    d_amplitude: Vec<f64>,
    optima: Vec<Optimum>,
}

impl ParameterData {
    /// Stores the numbers of a point, or nothing if memory is exhausted.
    pub fn push(&mut self, parameter: f64, d_amplitude: f64) -> Result<()> {
        const CONTEXT: &str = "the points of the branch";
        for numbers in [&mut self.parameter, &mut self.d_amplitude] {
            numbers.try_reserve(1).map_err(|_| Error::out_of_memory(CONTEXT))?;
        }
        self.parameter.push(parameter);
        self.d_amplitude.push(d_amplitude);
        Ok(())
    }

    /// Stores an optimum.
    pub fn push_optimum(&mut self, optimum: Optimum) -> Result<()> {
        crate::error::try_push(&mut self.optima, optimum, "the optima")
    }
}

impl Branch {
    pub(crate) fn set_parameter_data(&mut self, data: ParameterData) {
        self.parameter = Some(data);
    }

    /// Value of the parameter at each point of the curve; `None` for a branch over frequency or amplitude.
    #[must_use]
    pub fn parameter(&self) -> Option<&[f64]> {
        self.parameter.as_ref().map(|data| &data.parameter[..self.points()])
    }

    /// Total derivative of the amplitude by the parameter at each point of the curve; NaN where there is none.
    #[must_use]
    pub fn d_amplitude(&self) -> Option<&[f64]> {
        self.parameter.as_ref().map(|data| &data.d_amplitude[..self.points()])
    }

    /// Parameter, and the total derivative of the amplitude by it, at a stored point, the special ones included.
    #[must_use]
    pub fn parameter_at(&self, point: usize) -> Option<(f64, f64)> {
        let data = self.parameter.as_ref()?;
        data.parameter
            .get(point)
            .copied()
            .zip(data.d_amplitude.get(point).copied())
    }

    /// Minima and maxima of the amplitude over the parameter; none for other branches.
    #[must_use]
    pub fn optima(&self) -> &[Optimum] {
        self.parameter.as_ref().map_or(&[], |data| &data.optima)
    }

    /// Refuses a branch whose points belong to several models.
    pub(crate) fn check_one_model(&self) -> Result<()> {
        if self.parameter.is_none() {
            return Ok(());
        }
        fail!(
            Argument,
            "each point of a branch over a parameter has a model of its own: solve at the value of the parameter"
        )
    }
}
