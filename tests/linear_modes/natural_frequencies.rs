//! Natural frequencies of the paper's blisk against its reference data: exact eigenvalues, so these
//! tests check the truth.

use crate::common::{BASE, Blisk, data, number};
use hbvib::{ContactState, Model};
use serde_json::Value;
use std::f64::consts::TAU;

/// Compares all modes of one nodal diameter. A stored zero is a rigid-body motion: round-off of
/// order 1e-16 in the eigenvalues ω², measured by the largest, leaves 1e-8 in the frequencies.
fn compare(model: &Model, state: ContactState, diameter: i64, expected: &[Value]) -> f64 {
    let modes = model.linear_modes(diameter, state).unwrap();
    let expected: Vec<f64> = expected.iter().map(number).collect();
    assert_eq!(modes.omega.len(), expected.len(), "diameter {diameter}");
    let highest = expected.last().copied().unwrap();
    let mut worst = 0.0_f64;
    for (omega, f) in modes.omega.iter().zip(&expected) {
        let found = omega / TAU;
        if *f == 0.0 {
            assert!(
                found < 1e-7 * highest,
                "diameter {diameter}: rigid motion at {found} Hz"
            );
        } else {
            let error = (found / f - 1.0).abs();
            assert!(error < 1e-10, "diameter {diameter}: {found} Hz, needs {f}");
            worst = worst.max(error);
        }
    }
    worst
}

/// The mass in a key such as "30g", in kg.
fn grams(key: &str) -> f64 {
    key.strip_suffix('g').unwrap().parse::<f64>().unwrap() * 1e-3
}

#[test]
fn without_ring_all_diameters_agree_with_the_truth() {
    let reference = data("nf_nd.json");
    let model = Blisk {
        ring_mass: None,
        ..BASE
    }
    .sector();
    let diameters = reference["no_ring"].as_object().unwrap();
    assert_eq!(diameters.len(), 13);
    for (diameter, modes) in diameters {
        let frequencies = modes["f"].as_array().unwrap();
        compare(&model, ContactState::Free, diameter.parse().unwrap(), frequencies);
    }
}

#[test]
fn with_free_ring_all_diameters_and_masses_agree_with_the_truth() {
    each_mass("ring_free", ContactState::Free, |modes| modes.as_array().unwrap());
}

#[test]
fn with_stuck_ring_all_diameters_and_masses_agree_with_the_truth() {
    each_mass("ring_stuck", ContactState::Stuck, |modes| {
        modes["f"].as_array().unwrap()
    });
}

fn each_mass(state_name: &str, state: ContactState, frequencies: impl Fn(&Value) -> &Vec<Value>) {
    let reference = data("nf_nd.json");
    let masses = reference[state_name].as_object().unwrap();
    assert_eq!(masses.len(), 6);
    let mut worst = 0.0_f64;
    for (mass, diameters) in masses {
        let model = Blisk {
            ring_mass: Some(grams(mass)),
            ..BASE
        }
        .sector();
        let diameters = diameters.as_object().unwrap();
        assert_eq!(diameters.len(), 13);
        for (diameter, modes) in diameters {
            worst = worst.max(compare(&model, state, diameter.parse().unwrap(), frequencies(modes)));
        }
    }
    println!("{state_name}: largest relative error {worst:.1e}");
}

#[test]
fn shapes_are_mass_normalised_and_agree_with_the_truth() {
    let reference = data("nf_nd.json");
    let modes = &reference["ring_stuck"]["30g"]["2"];
    let found = BASE.sector().linear_modes(2, ContactState::Stuck).unwrap();
    for (k, shape) in modes["shape"].as_array().unwrap().iter().enumerate() {
        let expected: Vec<f64> = shape.as_array().unwrap().iter().map(number).collect();
        let shape = &found.shapes[k * 4..(k + 1) * 4];
        // The sign (phase) of a shape is free; the reference takes b2 positive.
        let turn = shape[0].conj() / shape[0].norm();
        for (z, e) in shape.iter().zip(&expected) {
            assert!((z * turn - e).norm() < 1e-10 * expected.iter().fold(0.0, |m: f64, x| m.max(x.abs())));
        }
    }
}
