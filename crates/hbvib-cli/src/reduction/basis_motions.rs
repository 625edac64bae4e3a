//! Motions of a structure that a reduction is made of.

/// Columns of a basis for some modes.
pub struct Motions {
    pub columns: Vec<Vec<f64>>,
    /// Frequencies of the modes, Hz.
    pub hertz: Vec<f64>,
    /// Whether there are no more modes.
    pub is_complete: bool,
}
