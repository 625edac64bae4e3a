//! Where the answer is linear, and how it scales: exact statements about the equations, hence both
//! the same-H solution and the truth.

use crate::common::{self, BASE, Blisk, NDOF, all_harmonics, harmonics, relative_gap, slip, solve_at, sweep};
use hbvib::{Constant, Contact, Model};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Fundamental of the sector with the given contact stiffness as a linear spring, by a direct
/// solution of (K − ω²M + iωC) x = F.
fn linear(case: &Blisk, contact_stiffness: f64, omega: f64) -> Vec<Complex64> {
    let a = case.matrices();
    let n = a.n;
    let lag = common::phase(1, case.engine_order, 1, common::SECTORS);
    let k = DMatrix::from_fn(n, n, |i, j| {
        a.own[j * n + i] + lag * a.next[j * n + i] + lag.conj() * a.next[i * n + j]
    });
    let mut z = DMatrix::from_fn(n, n, |i, j| {
        k[(i, j)] * Complex64::new(1.0, omega * common::BETA) - Complex64::from(omega * omega * a.mass[j * n + i])
    });
    for (i, j, s) in [(2, 2, 1.0), (3, 3, 1.0), (2, 3, -1.0), (3, 2, -1.0)] {
        z[(i, j)] += s * contact_stiffness;
    }
    let force = case.load_factor * case.force / case.units.2;
    let f = DVector::from_fn(n, |i, _| Complex64::from(if i < 2 { force } else { 0.0 }));
    z.lu().solve(&f).unwrap().as_slice().to_vec()
}

/// Fundamental at one frequency; all other harmonics must vanish.
fn fundamental(model: &Model, highest: usize, omega: f64) -> Vec<Complex64> {
    let branch = solve_at(model, &harmonics(highest), omega);
    assert!(slip(&branch, 0) <= 0.0);
    let x = all_harmonics(&branch, 0);
    for (h, block) in x.chunks_exact(NDOF).enumerate() {
        assert!(
            h == 1
                || block
                    .iter()
                    .all(|z| *z == Complex64::ZERO || z.norm() < 1e-13 * x[NDOF].norm())
        );
    }
    x[NDOF..2 * NDOF].to_vec()
}

#[test]
fn below_the_stick_limit_the_response_is_that_of_the_stuck_structure() {
    for engine_order in [1, 2, 3, 12] {
        let case = Blisk {
            force: 0.3,
            engine_order,
            ..BASE
        };
        let modes = case
            .sector()
            .linear_modes(engine_order, hbvib::ContactState::Stuck)
            .unwrap();
        // Away from the resonance and in it.
        for omega in [TAU * 150.0, 0.99 * modes.omega[0], modes.omega[0], TAU * 400.0] {
            let found = fundamental(&case.sector(), 9, omega);
            let gap = relative_gap(&found, &linear(&case, case.kt(), omega));
            println!("EO {engine_order}, {:.3} Hz: {gap:.1e}", omega / TAU);
            assert!(gap < 1e-12);
        }
    }
}

#[test]
fn below_the_stick_limit_a_sweep_is_linear_throughout() {
    let case = Blisk { force: 0.3, ..BASE };
    let branch = sweep(&case.sector(), &harmonics(9), TAU * 205.0, TAU * 213.0, &[]);
    assert!(branch.slip_fraction().iter().all(|&s| s == 0.0));
    for i in 0..branch.points() {
        let x = all_harmonics(&branch, i);
        let expected = linear(&case, case.kt(), branch.omega()[i]);
        assert!(relative_gap(&x[NDOF..2 * NDOF], &expected) < 1e-12);
    }
}

fn with_contact(case: &Blisk, contact: &Contact) -> Model {
    let mut model = case.sector_without_contact();
    model.add_contact(contact).unwrap();
    model
}

#[test]
fn limits_of_the_law_are_linear_systems() {
    let case = Blisk { force: 50.0, ..BASE };
    let contact = case.contact();
    let omega = TAU * 208.9;
    for (name, contact, stiffness) in [
        ("no load", contact.clone().with(Constant::Preload, 0.0).unwrap(), 0.0),
        ("no friction", contact.clone().with(Constant::Mu, 0.0).unwrap(), 0.0),
        (
            "no friction under infinite load",
            contact
                .clone()
                .with(Constant::Mu, 0.0)
                .unwrap()
                .with(Constant::Preload, f64::INFINITY)
                .unwrap(),
            0.0,
        ),
        (
            "infinite load",
            contact.clone().with(Constant::Preload, f64::INFINITY).unwrap(),
            contact.constant(Constant::Kt),
        ),
    ] {
        let model = with_contact(&case, &contact);
        let found = fundamental(&model, 5, omega);
        let gap = relative_gap(&found, &linear(&case, stiffness, omega));
        println!("{name}: {gap:.1e}");
        assert!(gap < 1e-12, "{name}");
        // A whole sweep over the resonances works without any nonlinear unknown.
        let branch = sweep(&model, &harmonics(5), TAU * 205.0, TAU * 213.0, &[]);
        assert_eq!(branch.status(), hbvib::Status::Ok);
        assert_eq!(branch.peaks().len(), 1);
        assert_eq!(branch.reduction().unknowns, 0);
    }
}

#[test]
fn nearly_infinite_and_nearly_zero_limits_approach_the_linear_systems() {
    let case = Blisk { force: 50.0, ..BASE };
    let contact = case.contact();
    let omega = TAU * 208.9;
    let at = |preload: f64| {
        let model = with_contact(&case, &contact.clone().with(Constant::Preload, preload).unwrap());
        all_harmonics(&solve_at(&model, &harmonics(5), omega), 0)[NDOF..2 * NDOF].to_vec()
    };
    assert!(relative_gap(&at(1e12), &linear(&case, contact.constant(Constant::Kt), omega)) < 1e-12);
    assert!(relative_gap(&at(1e-6), &linear(&case, 0.0, omega)) < 1e-6);
}

#[test]
fn scaling_force_and_slip_limit_together_scales_the_response() {
    let options = harmonics(7);
    for hz in [208.2, 208.85, 210.0] {
        let reference = all_harmonics(&solve_at(&BASE.sector(), &options, TAU * hz), 0);
        for load_factor in [1e-9, 1e-6, 1e-3, 0.1, 7.0, 1e3, 1e6, 1e9] {
            let branch = solve_at(&Blisk { load_factor, ..BASE }.sector(), &options, TAU * hz);
            assert!(slip(&branch, 0) > 0.0);
            let x: Vec<Complex64> = all_harmonics(&branch, 0).iter().map(|z| z / load_factor).collect();
            let gap = relative_gap(&x, &reference);
            assert!(gap < 1e-12, "{hz} Hz, factor {load_factor:e}: {gap:.1e}");
        }
    }
}

#[test]
fn a_scaled_sweep_takes_the_same_points() {
    let options = harmonics(5);
    let run = |load_factor: f64| {
        sweep(
            &Blisk { load_factor, ..BASE }.sector(),
            &options,
            TAU * 205.0,
            TAU * 213.0,
            &[],
        )
    };
    let reference = run(1.0);
    for load_factor in [1e-9, 1e9] {
        let branch = run(load_factor);
        assert_eq!(branch.points(), reference.points());
        let (a, b) = (branch.peaks()[0], reference.peaks()[0]);
        assert!((a.amplitude / load_factor / b.amplitude - 1.0).abs() < 1e-12);
    }
}

#[test]
fn metres_and_kilograms_agree_with_millimetres_and_tonnes() {
    let options = harmonics(7);
    // Newton stays: 1 t mm/s² = 1 N.
    let small = Blisk {
        units: (1e3, 1e-3, 1.0),
        ..BASE
    };
    for hz in [207.8, 208.85, 210.0] {
        let metres = all_harmonics(&solve_at(&BASE.sector(), &options, TAU * hz), 0);
        let millimetres = all_harmonics(&solve_at(&small.sector(), &options, TAU * hz), 0);
        let x: Vec<Complex64> = millimetres.iter().map(|z| z * 1e-3).collect();
        let gap = relative_gap(&x, &metres);
        println!("{hz} Hz: {gap:.1e}");
        assert!(gap < 1e-10);
    }
    let run = |case: &Blisk| sweep(&case.sector(), &options, TAU * 205.0, TAU * 213.0, &[]);
    let (a, b) = (run(&BASE), run(&small));
    let ratio = b.peaks()[0].amplitude * 1e-3 / a.peaks()[0].amplitude;
    assert!((ratio - 1.0).abs() < 1e-10);
}
