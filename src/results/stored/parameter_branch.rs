//! Data of a branch over a parameter of the model, beside those that every branch has.

use crate::error::{Error, Result, try_push};

/// An optimum of the amplitude over a parameter.
#[derive(Clone, Copy, Debug)]
pub struct Optimum {
    /// Index of the stored point.
    pub point: usize,
    /// Angular frequency of the optimum.
    pub omega: f64,
    /// Amplitude of the response degree of freedom; where the maximum of damping of a mode is followed, the damping
    /// ratio.
    pub amplitude: f64,
    /// Value of the parameter at the optimum.
    pub parameter: f64,
    /// Whether the amplitude is largest at this point; else it is smallest.
    pub is_maximum: bool,
}

/// A point at which a branch over a parameter turns: beyond its value the result does not exist.
///
/// The turns of a peak that is followed through folds over the force are the forces at which a detached curve is born
/// (a minimum) or merges with another one (a maximum). A followed fold turns at these forces, too: under less force the
/// two folds that meet do not exist. It also turns in a cusp.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// Index of the stored point.
    pub point: usize,
    /// Value of the parameter at the turn.
    pub parameter: f64,
    /// Angular frequency of the turn.
    pub omega: f64,
    /// Followed result at the turn, as in an [`Optimum`].
    pub amplitude: f64,
    /// Whether the parameter is largest at this point; else it is smallest.
    pub is_maximum: bool,
}

/// A peak that is higher than the followed one, in the same design.
#[derive(Clone, Copy, Debug)]
pub struct HigherPeak {
    /// Index of the stored point of the followed peak.
    pub point: usize,
    /// Value of the parameter.
    pub parameter: f64,
    /// Angular frequency of the higher peak.
    pub omega: f64,
    /// Amplitude of the higher peak.
    pub amplitude: f64,
}

/// Values of the stored points of a branch over a parameter.
#[derive(Debug, Default)]
pub(crate) struct ParameterData {
    /// Value of the parameter at each stored point.
    pub(crate) parameter: Vec<f64>,
    /// Total derivative of the amplitude by the parameter; NaN where it does not exist.
    pub(crate) d_amplitude: Vec<f64>,
    /// Total derivative of the largest damping ratio by the parameter; NaN where a response is followed.
    pub(crate) d_damping: Vec<f64>,
    pub(crate) optima: Vec<Optimum>,
    pub(crate) turns: Vec<Turn>,
    pub(crate) higher: Vec<HigherPeak>,
}

impl ParameterData {
    /// Stores the numbers of a point, or nothing if memory is exhausted.
    pub fn push(&mut self, parameter: f64, d_amplitude: f64, d_damping: f64) -> Result<()> {
        const CONTEXT: &str = "the points of the branch";
        for numbers in [&mut self.parameter, &mut self.d_amplitude, &mut self.d_damping] {
            numbers.try_reserve(1).map_err(|_| Error::out_of_memory(CONTEXT))?;
        }
        self.parameter.push(parameter);
        self.d_amplitude.push(d_amplitude);
        self.d_damping.push(d_damping);
        Ok(())
    }

    /// Stores an optimum of the branch.
    pub fn push_optimum(&mut self, optimum: Optimum) -> Result<()> {
        try_push(&mut self.optima, optimum, "the optima")
    }

    /// Stores a turn of the branch.
    pub fn push_turn(&mut self, turn: Turn) -> Result<()> {
        try_push(&mut self.turns, turn, "the turns")
    }

    /// Stores a higher peak.
    pub fn push_higher(&mut self, peak: HigherPeak) -> Result<()> {
        try_push(&mut self.higher, peak, "the higher peaks")
    }

    /// The optima stored so far.
    pub fn optima(&self) -> &[Optimum] {
        &self.optima
    }

    /// The turns stored so far.
    pub fn turns(&self) -> &[Turn] {
        &self.turns
    }

    /// Value of the parameter at a stored point.
    pub fn parameter_at(&self, point: usize) -> Option<f64> {
        self.parameter.get(point).copied()
    }
}
