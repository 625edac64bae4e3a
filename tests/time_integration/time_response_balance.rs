//! Harmonic balance tends to the motion in time as its harmonics grow: waves with contacts across
//! sectors, several laws at once, a beam that lifts off its support.

use crate::common::models::dense;
use crate::common::{SECTORS, Wheel, all_harmonics, harmonics, relative_gap, slip, solve_at, sweep};
use hbvib::{
    Constant, Contact, Hooks, MatrixKind, MatrixView, Model, Part, Spring, TimeOptions, TimeResponse, time_response,
};
use num_complex::Complex64;

fn in_time(model: &Model, omega: f64, highest: usize, start: Option<&[Complex64]>) -> TimeResponse {
    let options = TimeOptions {
        omega,
        harmonics: highest,
        start,
        ..TimeOptions::default()
    };
    time_response(model, &options, &mut Hooks::default()).unwrap()
}

/// Relative distance of the harmonics up to `common` of a solution with H harmonics.
fn distance(model: &Model, highest: usize, omega: f64, truth: &TimeResponse, common: usize) -> f64 {
    let balanced = all_harmonics(&solve_at(model, &harmonics(highest), omega), 0);
    let len = (common + 1) * model.ndof();
    relative_gap(&balanced[..len], &truth.harmonics[..len])
}

const N: usize = 3;
const MASS: [f64; 9] = [1.0, 0.1, 0.0, 0.1, 1.5, 0.0, 0.0, 0.0, 0.7];
const MASS_NEXT: [f64; 9] = [0.02, 0.0, 0.05, 0.0, 0.01, 0.0, -0.03, 0.0, 0.0];
const STIFFNESS: [f64; 9] = [9.0, -2.0, -1.0, -2.0, 8.0, -1.5, -1.0, -1.5, 7.0];
/// Column-major: [i + 3 j] couples i of a sector to j of the next.
const STIFFNESS_NEXT: [f64; 9] = [-0.8, 0.1, -0.9, 0.4, -0.5, 0.0, -0.2, 0.7, -0.6];
const DAMPING: [f64; 9] = [0.25, 0.0, 0.01, 0.0, 0.26, 0.0, 0.01, 0.0, 0.24];
const DAMPING_NEXT: [f64; 9] = [0.004, 0.01, 0.0, -0.003, 0.0, 0.006, 0.0, 0.002, 0.001];
const DAMPING_PREVIOUS: [f64; 9] = [0.002, 0.0, 0.005, 0.0, 0.003, -0.007, 0.001, 0.0, 0.0];

/// A contact within the sector, and one that reaches into another.
fn contacts(offset: i64) -> [Contact; 2] {
    let mut across = Contact::jenkins(2, Some(0), 3.0, 0.4, 0.5);
    across.sector_offset = offset;
    [Contact::jenkins(0, Some(1), 2.0, 0.3, 0.4), across]
}

const FORCES: [(usize, f64, f64); 2] = [(0, 1.0, 0.3), (1, -0.4, 0.8)];

/// A kind of matrix with its blocks: own, to the next and to the previous sector.
type Matrices<'a> = (MatrixKind, &'a [f64; 9], &'a [f64; 9], Option<&'a [f64; 9]>);

/// A sector without mirror symmetry, by blocks or by matrices per nodal diameter.
fn sector(engine_order: i64, offset: i64, by_diameter: bool) -> Model {
    let mut model = Model::cyclic(N, SECTORS).unwrap();
    let all: [Matrices<'_>; 3] = [
        (MatrixKind::Mass, &MASS, &MASS_NEXT, None),
        (MatrixKind::Stiffness, &STIFFNESS, &STIFFNESS_NEXT, None),
        (MatrixKind::Damping, &DAMPING, &DAMPING_NEXT, Some(&DAMPING_PREVIOUS)),
    ];
    for (which, own, next, previous) in all {
        if by_diameter {
            for d in 0..=SECTORS / 2 {
                let lag = Complex64::cis(-std::f64::consts::TAU * d as f64 / SECTORS as f64);
                let a: Vec<Complex64> = (0..9)
                    .map(|k| {
                        let (i, j) = (k % 3, k / 3);
                        let back = previous.map_or(next[3 * i + j], |p| p[k]);
                        own[k] + lag * next[k] + lag.conj() * back
                    })
                    .collect();
                let part = if previous.is_some() { Part::General } else { Part::Full };
                model
                    .set_diameter(which, d as i64, &MatrixView::dense_complex(N, &a).part(part))
                    .unwrap();
            }
        } else {
            model.set_matrix(which, &MatrixView::dense(N, own)).unwrap();
            model.set_coupling(which, &MatrixView::dense(N, next)).unwrap();
            if let Some(previous) = previous {
                model
                    .set_coupling_previous(which, &MatrixView::dense(N, previous))
                    .unwrap();
            }
        }
    }
    model.set_wave(engine_order);
    for contact in contacts(offset) {
        model.add_contact(&contact).unwrap();
    }
    for (dof, re, im) in FORCES {
        model.add_force(dof, 1, Complex64::new(re, im)).unwrap();
    }
    model
        .add_spring(&Spring {
            dof_a: Some(1),
            dof_b: Some(2),
            sector_offset: offset,
            stiffness: 0.3,
        })
        .unwrap();
    model
}

#[test]
fn waves_of_either_sense_are_what_harmonic_balance_tends_to() {
    for (engine_order, offset) in [(2, 1), (22, 1), (-2, -1), (5, 1), (0, 1), (12, 3), (9, 2)] {
        let model = sector(engine_order, offset, false);
        let truth = in_time(&model, 2.3, 5, None);
        let [coarse, fine] = [9, 63].map(|h| distance(&model, h, 2.3, &truth, 5));
        println!(
            "EO {engine_order}: H = 9 {coarse:.1e}, H = 63 {fine:.1e}; {} periods, {} events",
            truth.periods, truth.events
        );
        assert!(truth.events > 0);
        assert!(fine < 2e-5 && fine < 0.05 * coarse, "EO {engine_order}");
    }
}

#[test]
fn matrices_per_nodal_diameter_give_the_same_motion() {
    for engine_order in [2, -5] {
        let blocks = in_time(&sector(engine_order, 1, false), 2.3, 9, None);
        let diameters = in_time(&sector(engine_order, 1, true), 2.3, 9, None);
        let error = relative_gap(&diameters.harmonics, &blocks.harmonics);
        println!("EO {engine_order}: {error:.1e}");
        assert!(error < 1e-11);
    }
}

#[test]
fn a_wave_is_the_motion_of_the_whole_wheel() {
    let engine_order = 8;
    let model = sector(engine_order, 1, false);
    let mut full_wheel = Wheel::new(N, SECTORS);
    full_wheel.set(MatrixKind::Mass, &MASS, Some(&MASS_NEXT), None);
    let tied = |own: [f64; 9], next: [f64; 9]| {
        let (mut own, mut next) = (own, next);
        own[4] += 0.3;
        own[8] += 0.3;
        next[7] -= 0.3;
        (own, next)
    };
    let (own, next) = tied(STIFFNESS, STIFFNESS_NEXT);
    full_wheel.set(MatrixKind::Stiffness, &own, Some(&next), None);
    full_wheel.set(
        MatrixKind::Damping,
        &DAMPING,
        Some(&DAMPING_NEXT),
        Some(&DAMPING_PREVIOUS),
    );
    for contact in contacts(1) {
        full_wheel.add_contact(&contact);
    }
    for (dof, re, im) in FORCES {
        full_wheel.add_force(dof, 1, Complex64::new(re, im), engine_order);
    }
    let wave = in_time(&model, 2.3, 5, None);
    let all = in_time(&full_wheel.model, 2.3, 5, None);
    let first: Vec<Complex64> = all
        .harmonics
        .chunks_exact(N * SECTORS)
        .flat_map(|x| x[..N].to_vec())
        .collect();
    let error = relative_gap(&first, &wave.harmonics);
    println!("{error:.1e}, {} and {} periods", wave.periods, all.periods);
    assert!(error < 1e-10);
}

#[test]
fn friction_a_stop_and_a_cubic_spring_at_once_are_what_harmonic_balance_tends_to() {
    let chain = |k: f64| [2.0 * k, -k, 0.0, -k, 2.0 * k, -k, 0.0, -k, k];
    let model = dense(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], &chain(3.0))
        .damping(&chain(0.1))
        .slider(0, 2.0, 0.5, 0.3)
        .contact(Contact::unilateral(Some(1), None, 4.0, 0.3))
        .contact(Contact::cubic(2, Some(0), 0.4, 0.3))
        .force(2, 1, 0.4)
        .build();
    for omega in [0.5, 0.9, 1.7] {
        let start = all_harmonics(&solve_at(&model, &harmonics(15), omega), 0);
        let truth = in_time(&model, omega, 5, Some(&start));
        let [coarse, fine] = [7, 63].map(|h| distance(&model, h, omega, &truth, 5));
        println!(
            "{omega}: H = 7 {coarse:.1e}, H = 63 {fine:.1e}; {} events, {} periods",
            truth.events, truth.periods
        );
        assert!(fine < 1e-5 && fine < 0.05 * coarse);
    }
}

/// A cantilever of Euler–Bernoulli elements with its tip pressed onto an elastic support.
fn beam(elements: usize, force: f64) -> Model {
    let n = 2 * elements;
    let l = 1.0 / elements as f64;
    let (mut m, mut k) = (vec![0.0; n * n], vec![0.0; n * n]);
    let stiffness = [
        [12.0, 6.0 * l, -12.0, 6.0 * l],
        [6.0 * l, 4.0 * l * l, -6.0 * l, 2.0 * l * l],
        [-12.0, -6.0 * l, 12.0, -6.0 * l],
        [6.0 * l, 2.0 * l * l, -6.0 * l, 4.0 * l * l],
    ];
    let mass = [
        [156.0, 22.0 * l, 54.0, -13.0 * l],
        [22.0 * l, 4.0 * l * l, 13.0 * l, -3.0 * l * l],
        [54.0, 13.0 * l, 156.0, -22.0 * l],
        [-13.0 * l, -3.0 * l * l, -22.0 * l, 4.0 * l * l],
    ];
    for e in 0..elements {
        for (i, (ks, ms)) in stiffness.iter().zip(&mass).enumerate() {
            for j in 0..4 {
                // The clamped end has no degrees of freedom.
                let (Some(row), Some(column)) = ((2 * e + i).checked_sub(2), (2 * e + j).checked_sub(2)) else {
                    continue;
                };
                k[column * n + row] += ks[j] / l.powi(3);
                m[column * n + row] += ms[j] * l / 420.0;
            }
        }
    }
    let mut model = dense(&m, &k).rayleigh(0.4, 2e-4).build();
    let mut support = Contact::unilateral(Some(n - 2), None, 60.0, 0.0);
    support.set(Constant::Preload, 0.5).unwrap();
    model.add_contact(&support).unwrap();
    model.add_force(n - 2, 1, force.into()).unwrap();
    model
}

#[test]
fn a_beam_that_lifts_off_its_support_is_what_harmonic_balance_tends_to() {
    let model = beam(4, 0.6);
    // The first resonance, lowered by lifting off.
    for omega in [9.0, 11.0] {
        let branch = sweep(&model, &harmonics(31), 5.0, omega, &[]);
        let start = all_harmonics(&branch, branch.points() - 1);
        let truth = in_time(&model, omega, 5, Some(&start));
        let errors = [7, 15, 63].map(|h| {
            let branch = sweep(&model, &harmonics(h), 5.0, omega, &[]);
            let x = all_harmonics(&branch, branch.points() - 1);
            relative_gap(&x[..6 * 8], &truth.harmonics)
        });
        println!(
            "{omega}: {errors:?}, {} events, {} periods",
            truth.events, truth.periods
        );
        assert!(truth.events >= 2);
        assert!(errors[2] < 1e-6 && errors[2] < 0.05 * errors[0]);
    }
}

#[test]
fn points_of_a_branch_are_checked_from_themselves() {
    let model = sector(2, 1, false);
    let branch = sweep(&model, &harmonics(15), 1.4, 3.1, &[]);
    for point in (0..branch.points()).step_by(branch.points() / 5) {
        let omega = branch.omega()[point];
        let x = all_harmonics(&branch, point);
        let truth = in_time(&model, omega, 15, Some(&x));
        let error = relative_gap(&x, &truth.harmonics);
        println!(
            "{omega:.3}: slip {:.2}, error of H = 15: {error:.1e}, {} periods",
            slip(&branch, point),
            truth.periods
        );
        assert!(truth.events > 0 && error < 1e-4);
        // The start leaves nothing to march for.
        assert!(truth.periods <= 2);
    }
}
