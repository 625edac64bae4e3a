//! Cosine and sine of a part of a turn.

use num_complex::Complex64;
use std::f64::consts::TAU;

/// e^{−2πi·parts/sectors}, exact at quarter turns.
pub(super) fn lag(parts: usize, sectors: usize) -> Complex64 {
    match (4 * parts).checked_div(sectors) {
        Some(q) if 4 * parts == q * sectors => [Complex64::ONE, -Complex64::I, -Complex64::ONE, Complex64::I][q % 4],
        _ => Complex64::cis(-TAU * parts as f64 / sectors as f64),
    }
}
