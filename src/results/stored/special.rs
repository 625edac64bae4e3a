//! A solution beside the curve.

/// A solution beside the curve: a peak, a fold, or one at a requested parameter value.
#[derive(Clone, Copy, Debug)]
pub struct Special {
    /// Index of the stored point; it continues the numbering of the curve.
    pub point: usize,
    /// Angular frequency of the point.
    pub omega: f64,
    /// Amplitude of the response degree of freedom.
    pub amplitude: f64,
}
