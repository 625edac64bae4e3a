//! Peaks of the ring damper and their derivatives by the normal load equal those of separate computations with many
//! digits, and obey the homogeneity of friction.

use crate::common::{BASE, Blisk};
use crate::design::{Design, Results, tight};
use hbvib::{Constant, Parameter, Quantity, sensitivity};
use std::f64::consts::TAU;

const PRELOAD: Parameter<'static> = Parameter::Contact {
    constant: Constant::Preload,
    contact: None,
};

/// Normal load in N, frequency of the peak in Hz, its amplitude in m and the derivative of that by the load.
const REFERENCE: [[f64; 4]; 4] = [
    [100.0, 207.845_047_9, 4.886_556_792e-3, -1.752_396e-5],
    [300.0, 208.097_030_8, 1.934_880_980e-3, -8.294_694_705e-6],
    [488.545_417_9, 208.814_072_9, 1.415_917_557e-3, 7.417_615_6e-8],
    [800.0, 209.376_838_4, 1.706_910_530e-3, 1.262_963_439e-6],
];

/// Blisk with a peak within 200 and 215 Hz.
const RANGE: (f64, f64) = (200.0 * TAU, 215.0 * TAU);

#[test]
fn peaks_and_their_derivatives_by_the_normal_load_are_the_references() {
    for [preload, frequency, amplitude, slope] in REFERENCE {
        let model = Design::ring_damper(&BASE, preload).model();
        let (branch, point, values) = Results::Peak(RANGE.0, RANGE.1).solve(&model, &tight(9));
        let (peak, omega) = (values[0].1, values[1].1);
        assert!(
            (omega / TAU / frequency - 1.0).abs() < 1e-8,
            "{preload}: {}",
            omega / TAU
        );
        assert!((peak / amplitude - 1.0).abs() < 1e-8, "{preload}: {peak}");
        for of in [Quantity::Amplitude, Quantity::PeakAmplitude] {
            let found = sensitivity(&model, &branch, point, &[PRELOAD], of).unwrap().values[0];
            assert!((found / slope - 1.0).abs() < 1e-6, "{preload}: {found} of {of:?}");
        }
    }
}

#[test]
fn force_and_normal_load_together_scale_the_motion() {
    let stiffer = Blisk {
        ring_mass: Some(0.05),
        engine_order: 4,
        ..BASE
    };
    for (case, preload, hertz) in [(BASE, 300.0, 208.85), (BASE, 608.0, 208.85), (stiffer, 200.0, 480.0)] {
        let model = Design::ring_damper(&case, preload).model();
        for highest in [1, 9, 21] {
            let (branch, point, values) = Results::At(hertz * TAU).solve(&model, &tight(highest));
            let amplitude = values[0].1;
            let parameters = [Parameter::Force, PRELOAD];
            let of = Quantity::Amplitude;
            let found = sensitivity(&model, &branch, point, &parameters, of).unwrap().values;
            let sum = found[0] + preload * found[1];
            assert!(
                (sum / amplitude - 1.0).abs() < 1e-8,
                "{preload} at H = {highest}: {sum}, {amplitude}"
            );
        }
    }
}
