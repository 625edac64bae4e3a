//! The numbers of a parameter response that a branch holds.

use crate::error::{Result, fail};
use crate::results::Branch;
use crate::results::stored::parameter_branch::{HigherPeak, Optimum, ParameterData, Turn};

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

    /// Total derivative of the largest damping ratio of a mode by the parameter at each point of the curve; NaN where a
    /// response is followed.
    #[must_use]
    pub fn d_damping(&self) -> Option<&[f64]> {
        self.parameter.as_ref().map(|data| &data.d_damping[..self.points()])
    }

    /// Total derivative of the largest damping ratio of a mode by the parameter at a stored point, the special ones
    /// included.
    #[must_use]
    pub fn d_damping_at(&self, point: usize) -> Option<f64> {
        self.parameter.as_ref()?.d_damping.get(point).copied()
    }

    /// Peaks that are higher than the followed one at its first point, its optima or its last point; none for other
    /// branches.
    #[must_use]
    pub fn higher_peaks(&self) -> &[HigherPeak] {
        self.parameter.as_ref().map_or(&[], |data| &data.higher)
    }

    /// Value of the parameter, and total derivative of the amplitude by it, at a stored point, the special ones
    /// included.
    #[must_use]
    pub fn parameter_at(&self, point: usize) -> Option<(f64, f64)> {
        let data = self.parameter.as_ref()?;
        data.parameter
            .get(point)
            .copied()
            .zip(data.d_amplitude.get(point).copied())
    }

    /// Minima and maxima of the amplitude, or of the largest damping ratio, over the parameter; none for other branches.
    #[must_use]
    pub fn optima(&self) -> &[Optimum] {
        self.parameter.as_ref().map_or(&[], |data| &data.optima)
    }

    /// Points at which the branch turns over the parameter; none for other branches, and for the largest damping ratio of a mode.
    #[must_use]
    pub fn turns(&self) -> &[Turn] {
        self.parameter.as_ref().map_or(&[], |data| &data.turns)
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
