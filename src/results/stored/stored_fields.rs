//! A number of each stored point: of the points of the curve first, then of those beside it.

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
