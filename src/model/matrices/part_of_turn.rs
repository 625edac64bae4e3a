//! Cosine and sine of a part of a turn.

use num_complex::Complex64;
use std::f64::consts::TAU;

/// Phase factor e^{−2πi·parts/sectors}, exact at quarter turns; for sectors − parts it is exactly the conjugate
/// number.
pub(crate) fn lag(parts: usize, sectors: usize) -> Complex64 {
    if parts < sectors && 2 * parts > sectors {
        return lag(sectors - parts, sectors).conj();
    }
    match (4 * parts).checked_div(sectors) {
        Some(q) if 4 * parts == q * sectors => [Complex64::ONE, -Complex64::I, -Complex64::ONE, Complex64::I][q % 4],
        _ => Complex64::cis(-TAU * parts as f64 / sectors as f64),
    }
}

#[cfg(test)]
mod tests {
    use super::lag;

    #[test]
    fn waves_that_travel_either_way_have_conjugate_lags() {
        for sectors in [1, 2, 3, 8, 23, 24] {
            for parts in 1..sectors {
                let (one, other) = (lag(parts, sectors), lag(sectors - parts, sectors));
                assert_eq!(one, other.conj(), "{parts} of {sectors}");
                let whole = one.powu(sectors as u32);
                assert!((whole - 1.0).norm() < 1e-13, "{parts} of {sectors}: {whole}");
            }
        }
    }
}
