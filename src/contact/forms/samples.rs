//! Samples of a law without memory at equidistant times of a period.

/// Results of a law without memory, sample after sample; within a sample direction after direction.
///
/// All numbers are 0 when the law is evaluated.
#[derive(Debug)]
pub struct Samples<'a> {
    /// Force fᵢ, N × d.
    pub f: &'a mut [f64],
    /// ∂fᵢ/∂uⱼ at the same time, N × d × d, the row i in one piece.
    pub df_du: &'a mut [f64],
    /// ∂fᵢ/∂vⱼ at the same time, N × d × d; empty for laws without velocities.
    pub df_dv: &'a mut [f64],
    /// Memory for the law's own use, 2·N × d.
    pub scratch: &'a mut [f64],
}

/// Samples per period for a law of unknown form: 16 per period of the highest harmonic,
/// at least 64, rounded up to a power of two.
#[must_use]
pub fn automatic_samples(highest: usize) -> usize {
    highest
        .saturating_mul(16)
        .clamp(64, 1 << (usize::BITS - 2))
        .next_power_of_two()
}
