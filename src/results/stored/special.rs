//! A solution beside the curve.

/// A solution beside the curve: a peak, a fold, or one at a requested parameter value.
#[derive(Clone, Copy, Debug)]
pub struct Special {
    /// Number of the point; it continues the numbering of the curve.
    pub point: usize,
    /// Angular frequency.
    pub omega: f64,
    /// Amplitude of the response degree of freedom.
    pub amplitude: f64,
}
