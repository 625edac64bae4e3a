//! e^{iτ} by a table of 64 directions and a short series, to rounding.

use num_complex::Complex64;
use std::f64::consts::PI;

/// Largest angle of which [`small_turn`] returns all digits.
pub(super) const SMALL_ANGLE: f64 = 0.1;

/// e^{is} of a small angle, by its series up to s¹⁰.
#[inline]
pub(super) fn small_turn(s: f64) -> Complex64 {
    let q = s * s;
    let cosine = 1.0 - q / 2.0 * (1.0 - q / 12.0 * (1.0 - q / 30.0 * (1.0 - q / 56.0 * (1.0 - q / 90.0))));
    let sine = s * (1.0 - q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0 * (1.0 - q / 72.0))));
    Complex64::new(cosine, sine)
}

/// Directions of the table in a turn.
const DIRECTIONS: usize = 64;

/// sin(kπ/32) for k = 0 ..= 16.
const SINES: [f64; 17] = [
    0.0,
    0.098_017_140_329_560_6,
    0.195_090_322_016_128_27,
    0.290_284_677_254_462_4,
    0.382_683_432_365_089_8,
    0.471_396_736_825_997_64,
    0.555_570_233_019_602_2,
    0.634_393_284_163_645_5,
    0.707_106_781_186_547_5,
    0.773_010_453_362_737,
    0.831_469_612_302_545_2,
    0.881_921_264_348_355,
    0.923_879_532_511_286_7,
    0.956_940_335_732_208_9,
    0.980_785_280_403_230_4,
    0.995_184_726_672_196_9,
    1.0,
];

/// e^{ikπ/32} for k = 0 .. 64.
const TABLE: [Complex64; DIRECTIONS] = {
    let mut table = [Complex64::new(1.0, 0.0); DIRECTIONS];
    let mut k = 0;
    while k < DIRECTIONS {
        let rest = k % 16;
        let (s, c) = (SINES[rest], SINES[16 - rest]);
        table[k] = match k / 16 {
            0 => Complex64::new(c, s),
            1 => Complex64::new(-s, c),
            2 => Complex64::new(-c, -s),
            _ => Complex64::new(s, -c),
        };
        k += 1;
    }
    table
};

/// π/32 in 33 bits, whose products with small integers are exact, and the rest.
const STEP: (f64, f64) = (f64::from_bits((PI / 32.0).to_bits() & !0xF_FFFF), STEP_REST);
const STEP_REST: f64 = (PI / 32.0 - f64::from_bits((PI / 32.0).to_bits() & !0xF_FFFF)) + PI_REST / 32.0;

/// π beyond its first 53 bits.
const PI_REST: f64 = 1.224_646_799_147_353_2e-16;

/// Angles up to this one are reduced to the table.
const FARTHEST: f64 = 1e4;

/// 1.5·2⁵²: adding it rounds to an integer.
const TO_INTEGER: f64 = 6_755_399_441_055_744.0;

/// e^{iτ}.
#[inline]
pub(super) fn turn(tau: f64) -> Complex64 {
    if tau.is_nan() || tau.abs() >= FARTHEST {
        return Complex64::cis(tau);
    }
    let k = (tau * (32.0 / PI) + TO_INTEGER) - TO_INTEGER;
    let rest = (tau - k * STEP.0) - k * STEP.1;
    TABLE[k as i64 as usize % DIRECTIONS] * small_turn(rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_is_that_of_sine_and_cosine() {
        let mut worst = 0.0_f64;
        for k in -40_000..40_000 {
            let tau = 3.1e-4 * f64::from(k);
            for tau in [tau, 30.0 * tau, 1e-9 * tau] {
                worst = worst.max((turn(tau) - Complex64::cis(tau)).norm());
            }
        }
        assert!(worst < 4e-16, "{worst:e}");
        for tau in [1e-300, 1e-12, 1e-3, 0.04] {
            assert!((turn(tau).im / tau.sin() - 1.0).abs() < 3e-16);
        }
        assert!(turn(f64::NAN).re.is_nan() && turn(f64::INFINITY).re.is_nan());
    }
}
