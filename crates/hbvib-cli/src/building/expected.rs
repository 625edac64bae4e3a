//! Values that another program tells of a model.

/// Relative difference up to which a value is the expected one.
const NEAR: f64 = 0.01;

/// Whether a value is the expected one, within a hundredth.
pub fn near(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= NEAR * expected.abs()
}
