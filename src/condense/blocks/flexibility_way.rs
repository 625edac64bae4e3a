//! How the flexibility of the contacts along a branch is made, and why so.

use std::fmt;

/// The way to the flexibility of the lowest vibrating harmonic that is carried.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(i32)]
pub enum FlexibilityWay {
    /// Factors: at a single frequency they take the least time.
    #[default]
    SingleFrequency = 0,
    /// A sum over all modes of the wave.
    Modes = 1,
    /// A sum over the poles of the wave: damping couples the modes.
    Poles = 2,
    /// Factors at each frequency: the small motion of a near-rigid contact is lost in the rounding of modes.
    NearRigid = 3,
    /// Factors: damping couples the modes, and with so few degrees of freedom factors take no longer than poles.
    Few = 4,
    /// Factors: damping couples the modes, and with matrices so sparse factors take no longer than poles.
    Sparse = 5,
    /// Factors: there are too many degrees of freedom for all modes or poles.
    Many = 6,
    /// Factors: the reference stiffness is not definite, or poles are badly conditioned.
    Unsuitable = 7,
    /// Factors: sums over modes or poles did not agree with a factorisation at an end of the range.
    Disagreement = 8,
    /// Factors of the waves of a tuned wheel, and a correction of low rank for the differences of its sectors.
    TunedWheel = 9,
}

impl fmt::Display for FlexibilityWay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::SingleFrequency => "factors: at a single frequency they take the least time",
            Self::Modes => "a sum over all modes",
            Self::Poles => "a sum over all poles: damping couples the modes",
            Self::NearRigid => "factors at each frequency: modes lose the motion of a near-rigid contact",
            Self::Few => "factors at each frequency: damping couples the modes of few degrees of freedom",
            Self::Sparse => "factors at each frequency: damping couples the modes, and the matrices are sparse",
            Self::Many => "factors at each frequency: there are too many degrees of freedom for all modes or poles",
            Self::Unsuitable => {
                "factors at each frequency: the reference stiffness is not definite, or poles are badly conditioned"
            }
            Self::TunedWheel => {
                "factors of the waves of a tuned wheel, and a correction of low rank for its differences"
            }
            Self::Disagreement => "factors at each frequency: sums did not agree with them at an end of the range",
        })
    }
}
