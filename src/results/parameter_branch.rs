//! Data of a branch over a parameter of the model, beside those that every branch has.

use crate::error::{Error, Result, try_push};

/// An optimum of the amplitude over a parameter.
#[derive(Clone, Copy, Debug)]
pub struct Optimum {
    /// Number of the stored point.
    pub point: usize,
    /// Angular frequency.
    pub omega: f64,
    /// Amplitude of the response degree of freedom.
    pub amplitude: f64,
    /// Value of the parameter.
    pub parameter: f64,
    /// Whether the amplitude is largest there, else smallest.
    pub is_maximum: bool,
}

/// Numbers of the stored points over a parameter.
#[derive(Debug, Default)]
pub(crate) struct ParameterData {
    /// Value of the parameter at each stored point.
    pub(super) parameter: Vec<f64>,
    /// Total derivative of the amplitude by it; NaN where there is none.
    pub(super) d_amplitude: Vec<f64>,
    pub(super) optima: Vec<Optimum>,
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
        try_push(&mut self.optima, optimum, "the optima")
    }
}
