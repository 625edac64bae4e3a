//! One array of numbers of a file.

/// An array of numbers with rows next to each other.
#[derive(Clone, Debug)]
pub struct NumberArray {
    /// Name in the archive.
    pub name: String,
    /// Length of each dimension.
    pub shape: Vec<usize>,
    /// Real parts.
    pub real: Vec<f64>,
    /// Imaginary parts; empty for real numbers.
    pub imaginary: Vec<f64>,
}
