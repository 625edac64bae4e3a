//! A resonance that is known before a branch is followed.

/// A resonance of the structure with linear forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearResonance {
    /// Value of the parameter.
    pub at: f64,
    /// Half width of the peak; where there is no damping, the distance at which the resonance is passed.
    pub half_width: f64,
    /// Distance from the resonance to the place of the comparison: the response is unbounded at an undamped one.
    pub aside: f64,
}
