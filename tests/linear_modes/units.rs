//! Modes do not depend on the units of single degrees of freedom, as radians beside micrometres: x = S x′ with S diagonal makes SMS and
//! SKS, the same frequencies, and the shapes S⁻¹φ.

use crate::common::models::dense;
use crate::common::{at_dof, harmonics, omega_range};
use hbvib::{Contact, ContactState, Hooks, Model, forced_response};

const STIFFNESS: [[f64; 3]; 3] = [[2.0, -1.0, 0.0], [-1.0, 3.0, -1.0], [0.0, -1.0, 1.5]];
const MASS: [f64; 3] = [1.0, 0.8, 1.2];

/// The chain with its last motion in another unit.
fn chain(unit: f64) -> Model {
    let units = [1.0, 1.0, unit];
    let (mut k, mut m) = ([0.0; 9], [0.0; 9]);
    for i in 0..3 {
        m[4 * i] = MASS[i] * units[i] * units[i];
        for j in 0..3 {
            k[3 * j + i] = STIFFNESS[i][j] * units[i] * units[j];
        }
    }
    dense(&m, &k).build()
}

#[test]
fn frequencies_and_shapes_are_those_in_any_unit() {
    let plain = chain(1.0).linear_modes(0, ContactState::Free).unwrap();
    for exponent in [-40, -30, -24, -17, -10, 10, 17, 24, 30, 40] {
        let unit = 2.0_f64.powi(exponent);
        let found = chain(unit).linear_modes(0, ContactState::Free).unwrap();
        assert_eq!(found.omega.len(), 3, "unit 2^{exponent}");
        for r in 0..3 {
            let error = (found.omega[r] / plain.omega[r] - 1.0).abs();
            assert!(error < 1e-12, "unit 2^{exponent}, mode {r}: {}", found.omega[r]);
            // The sign of a shape is free.
            let (a, b) = (
                found.shapes[3 * r] / plain.shapes[3 * r],
                found.shapes[3 * r + 2] * unit / plain.shapes[3 * r + 2],
            );
            assert!(
                (a.norm() - 1.0).abs() < 1e-10 && (a - b).norm() < 1e-10,
                "unit 2^{exponent}, mode {r}: {a} {b}"
            );
        }
    }
}

#[test]
fn modal_damping_is_that_in_any_unit() {
    let peak = |unit: f64| {
        let mut model = chain(unit);
        model.set_modal_damping(&[0.02]).unwrap();
        model.add_contact(&Contact::jenkins(0, None, 0.4, 0.3, 1.0)).unwrap();
        model.add_force(1, 1, 0.1.into()).unwrap();
        let range = omega_range(0.8, 1.0);
        let solver = at_dof(0, harmonics(3));
        let branch = forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap();
        branch.peaks().iter().map(|peak| peak.amplitude).fold(0.0, f64::max)
    };
    let plain = peak(1.0);
    for exponent in [-30, -20, 20, 30] {
        let found = peak(2.0_f64.powi(exponent));
        assert!(
            (found / plain - 1.0).abs() < 1e-6,
            "unit 2^{exponent}: {found}, needs {plain}"
        );
    }
}
