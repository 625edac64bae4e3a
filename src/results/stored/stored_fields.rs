//! A number of each stored point: of the points of the curve first, then of those beside it.

use crate::error::{Error, Result};
use crate::results::Branch;
use crate::results::stored::mode_branch::ModeField;

/// Field of values that each stored point has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointField {
    /// Angular frequency of the point.
    Omega,
    /// Amplitude of the response degree of freedom.
    Amplitude,
    /// Relative residual of the point.
    Residual,
    /// Number of Newton iterations of the point.
    NewtonIterations,
    /// Highest harmonic number carried.
    HarmonicsUsed,
    /// Share of the period that each contact slips, for each contact.
    SlipFraction,
    /// Relative change of the sampled forces with the number of samples.
    SamplingError,
    /// Estimated error of the response, in a nonlinear mode of the frequency.
    ErrorEstimate,
    /// Estimated error of the damping ratio of a nonlinear mode.
    DampingErrorEstimate,
    /// Largest modulus of the ordinary Floquet multipliers; NaN beside the curve.
    FloquetRadius,
    /// Number of ordinary multipliers outside the unit circle; NaN beside the curve.
    UnstableDirections,
    /// Number of free sliders.
    FreeSliders,
    /// Derivatives of the amplitude by the places of free sliders, for each contact and direction.
    ByPlace,
    /// Value of the parameter.
    Parameter,
    /// Total derivative of the amplitude by the parameter.
    DAmplitude,
    /// Total derivative of the largest damping ratio by the parameter.
    DDamping,
    /// A value of a nonlinear mode.
    Mode(ModeField),
}

impl Branch {
    /// A field of all stored points; `None` where the branch does not have it.
    pub(crate) fn stored_field(&self, field: PointField) -> Option<&[f64]> {
        let is_mode = self.mode.is_some();
        match field {
            PointField::Omega => Some(&self.table.omega),
            PointField::Amplitude => Some(&self.table.amplitude),
            PointField::Residual => Some(&self.table.residual),
            PointField::NewtonIterations => Some(&self.table.iterations),
            PointField::HarmonicsUsed => Some(&self.table.harmonics_used),
            PointField::SlipFraction => Some(&self.table.slip_fraction),
            PointField::SamplingError => Some(&self.errors.sampling),
            PointField::ErrorEstimate => Some(&self.errors.truncation),
            PointField::DampingErrorEstimate => is_mode.then_some(&self.errors.damping[..]),
            PointField::FloquetRadius => self.run.tells_stability.then_some(&self.stability.floquet_radius[..]),
            PointField::UnstableDirections => self
                .run
                .tells_stability
                .then_some(&self.stability.unstable_directions[..]),
            PointField::FreeSliders => self.freedom.as_ref().map(|freedom| freedom.count()),
            PointField::ByPlace => self.freedom.as_ref().map(|freedom| freedom.by_place().as_flattened()),
            PointField::Parameter => self.parameter.as_ref().map(|data| &data.parameter[..]),
            PointField::DAmplitude => self.parameter.as_ref().map(|data| &data.d_amplitude[..]),
            PointField::DDamping => self
                .parameter
                .as_ref()
                .filter(|_| is_mode)
                .map(|data| &data.d_damping[..]),
            PointField::Mode(field) => self.mode.as_ref().map(|data| data.field(field)),
        }
    }

    /// Completes the fields of stability by NaN for points without it, including those beside the curve.
    pub(crate) fn complete_stability(&mut self) -> Result<()> {
        if !self.run.tells_stability {
            return Ok(());
        }
        let stored = self.table.omega.len();
        for numbers in [
            &mut self.stability.floquet_radius,
            &mut self.stability.unstable_directions,
        ] {
            numbers
                .try_reserve(stored.saturating_sub(numbers.len()))
                .map_err(|_| Error::out_of_memory("the stability of the points"))?;
            numbers.resize(stored, f64::NAN);
        }
        Ok(())
    }
}
