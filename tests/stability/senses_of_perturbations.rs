//! Perturbations of both senses of each nodal diameter, where gyroscopic and aerodynamic forces distinguish the senses: with
//! contacts stuck the multipliers of the wheel are e^{λT} with the eigenvalues λ of all signed diameters, and a flow and its
//! mirror image have the same limit cycles in opposite waves.

use crate::common::models::Structure;
use crate::common::{amplitude_range, harmonics, omega_range};
use hbvib::{
    AeroForm, Contact, FloquetOptions, Hooks, LinearContacts, MatrixKind, MatrixView, ModeOptions, Model,
    MultiplierClass, Speed, Waves, damped_modes, floquet, forced_response, nonlinear_mode,
};
use num_complex::Complex64;
use std::f64::consts::TAU;

const N: usize = 5;
const SECTORS: usize = 7;
const OMEGA: f64 = 1.9;

fn view(a: &[f64]) -> MatrixView<'_> {
    MatrixView::dense(N, a)
}

/// A sector of five masses with Coriolis forces in a flow, and friction that sticks between two sectors.
fn sector(engine_order: i64, held: &[usize]) -> Model {
    let mut model = Model::cyclic(N, SECTORS).unwrap();
    let at = |i: usize, j: usize, size: f64| size * (1.3 * i as f64 + 2.1 * j as f64 + 0.7).sin();
    let dense = |value: &dyn Fn(usize, usize) -> f64| -> Vec<f64> { (0..N * N).map(|k| value(k % N, k / N)).collect() };
    let diagonal = |i: usize, j: usize, value: f64| if i == j { value } else { 0.0 };
    for (kind, own) in [
        (MatrixKind::Mass, dense(&|i, j| diagonal(i, j, 1.0 + 0.1 * i as f64))),
        (MatrixKind::Damping, dense(&|i, j| diagonal(i, j, 0.2))),
        (
            MatrixKind::Stiffness,
            dense(&|i, j| diagonal(i, j, 14.0 + 3.0 * i as f64) + at(i, j, 0.5) + at(j, i, 0.5)),
        ),
        (MatrixKind::Gyroscopic, dense(&|i, j| at(i, j, 0.4) - at(j, i, 0.4))),
    ] {
        model.set_matrix(kind, &view(&own)).unwrap();
    }
    model
        .set_coupling(MatrixKind::Stiffness, &view(&dense(&|i, j| at(i, 2 * j + 1, 0.9))))
        .unwrap();
    model
        .set_coupling(MatrixKind::Gyroscopic, &view(&dense(&|i, j| at(2 * i, j, 0.2))))
        .unwrap();
    model
        .set_aero(&[0], &[0.3.into(), (-0.3).into()], &[1, -1], AeroForm::Displacement)
        .unwrap();
    model.set_speed(Speed::Fixed(1.1)).unwrap();
    model.set_wave(engine_order);
    for &dof in held {
        let contact = Contact {
            sector_offset: 1,
            ..Contact::jenkins(dof, Some(dof), 0.5, 0.5, 1e4)
        };
        model.add_contact(&contact).unwrap();
    }
    model.add_force(2, 1, Complex64::ONE).unwrap();
    model
}

/// Largest distance of an ordinary multiplier from e^{λT} or its conjugate, of those that are there.
fn worst(model: &Model, options: &FloquetOptions, diameters: &[i64]) -> (f64, usize) {
    let solver = harmonics(1);
    let at = omega_range(OMEGA, OMEGA);
    let branch = forced_response(model, &solver, &at, &mut Hooks::default()).unwrap();
    let found = floquet(model, &branch, 0, options, &mut Hooks::default()).unwrap();
    let ordinary = found
        .multipliers
        .iter()
        .filter(|m| m.class == MultiplierClass::Ordinary);
    let mut values: Vec<Complex64> = ordinary.map(|m| m.value).collect();
    let mut worst = 0.0_f64;
    for &d in diameters {
        let modes = damped_modes(model, d, LinearContacts::Stuck, N, &mut Hooks::default()).unwrap();
        assert_eq!(modes.count(), N);
        for lambda in modes.eigenvalue {
            for known in [(lambda * (TAU / OMEGA)).exp(), (lambda.conj() * (TAU / OMEGA)).exp()] {
                let distance = |z: &Complex64| (z - known).norm();
                let nearest = (0..values.len()).min_by(|a, b| distance(&values[*a]).total_cmp(&distance(&values[*b])));
                worst = worst.max(distance(&values.swap_remove(nearest.unwrap())));
            }
        }
    }
    (worst, values.len())
}

#[test]
fn multipliers_of_the_wheel_are_those_of_all_signed_diameters_each_once() {
    let all: Vec<i64> = (-3..=3).collect();
    for engine_order in [1, -1, 3, -3, 6] {
        let model = sector(engine_order, &[0]);
        for modes in [Some(0), Some(8)] {
            let options = FloquetOptions {
                waves: Waves::Wheel,
                modes,
                ..FloquetOptions::default()
            };
            let (gap, left) = worst(&model, &options, &all);
            println!("EO {engine_order}, modes {modes:?}: {gap:.1e}, {left} left");
            assert!(gap < 1e-11 && left == 0, "EO {engine_order}, modes {modes:?}: {gap:e}");
        }
    }
}

#[test]
fn contacts_on_all_degrees_of_freedom_leave_no_modes_and_no_defect() {
    let model = sector(-1, &[0, 1, 2, 3, 4]);
    let options = FloquetOptions {
        waves: Waves::Wheel,
        modes: Some(2),
        ..FloquetOptions::default()
    };
    let (gap, _) = worst(&model, &options, &(-3..=3).collect::<Vec<i64>>());
    assert!(gap < 1e-11, "{gap:e}");
}

/// A ring with friction, in a flow that drives the waves of one sense.
fn driven(drive: f64) -> Model {
    let mut model = Structure::cyclic(1, 24)
        .mass(&[1.0])
        .stiffness(&[1.0])
        .damping(&[0.005])
        .next(MatrixKind::Stiffness, &[-0.1])
        .build();
    let contact = Contact {
        sector_offset: 1,
        ..Contact::jenkins(0, Some(0), 0.2, 0.5, 0.02)
    };
    model.add_contact(&contact).unwrap();
    model
        .set_aero(&[0], &[(-drive).into(), drive.into()], &[1, -1], AeroForm::Displacement)
        .unwrap();
    model
}

#[test]
fn a_flow_and_its_mirror_image_have_the_same_limit_cycles_in_opposite_waves() {
    let solver = harmonics(9);
    let of = |drive: f64, diameter: i64| {
        let model = driven(drive);
        let range = ModeOptions {
            diameter: Some(diameter),
            ..amplitude_range(-3.0, 1.0)
        };
        let branch = nonlinear_mode(&model, &solver, &range, &mut Hooks::default()).unwrap();
        let cycles = branch.limit_cycles().unwrap();
        let mut found = Vec::new();
        for cycle in &cycles {
            let mut in_wave = model.try_clone().unwrap();
            in_wave.set_wave(diameter);
            let options = FloquetOptions {
                waves: Waves::Wheel,
                ..FloquetOptions::default()
            };
            let stability = floquet(&in_wave, &branch, cycle.point, &options, &mut Hooks::default()).unwrap();
            found.push((stability.omega, stability.radius, stability.unstable));
        }
        (found, branch.mode().unwrap().engine_order)
    };
    for (drive, diameter) in [(0.01, 2), (0.01, 6)] {
        let (one, forward) = of(drive, diameter);
        let (other, backward) = of(-drive, -diameter);
        let (third, again) = of(-drive, 24 - diameter);
        assert_eq!((forward, backward, again), (diameter, -diameter, -diameter));
        assert!(!one.is_empty() && one.len() == other.len() && one.len() == third.len());
        for ((a, b), c) in one.iter().zip(&other).zip(&third) {
            println!("diameter {diameter}: {a:?} {b:?}");
            assert!((a.0 / b.0 - 1.0).abs() < 1e-10 && (a.1 / b.1 - 1.0).abs() < 1e-8 && a.2 == b.2);
            assert!((b.0 - c.0).abs() < 1e-12 && b.2 == c.2);
        }
        // The flow damps the other sense: it has no limit cycle.
        assert!(of(-drive, diameter).0.is_empty());
    }
}
