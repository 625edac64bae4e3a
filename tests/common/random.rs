//! Numbers without pattern that repeat from run to run.

/// The next number in [0, 1) of a linear congruence (Knuth's MMIX): the highest 53 bits of the state.
pub fn unit(state: &mut u64) -> f64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}

/// The next number in [−1, 1).
pub fn signed(state: &mut u64) -> f64 {
    2.0 * unit(state) - 1.0
}
