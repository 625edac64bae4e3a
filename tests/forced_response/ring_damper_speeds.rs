//! Ring masses and speeds of the paper's Figs 6 and 7 from one model whose normal load is m_r R Ω²: against stored peaks of
//! separate computations, by the scaling of forces and loads, against natural frequencies with the ring stuck, and against
//! models that are built anew.

use crate::common::{BASE, Blisk, data, harmonics, number, slip, sweep};
use hbvib::{MatrixKind, MatrixView, Model, SolverOptions, Speed, Status};
use std::f64::consts::TAU;

/// Hz; all resonances of the figures lie within.
const RANGE: (f64, f64) = (205.0, 213.0);

/// Radius of the ring, m.
fn radius() -> f64 {
    number(&data("frf_base.json")["curve_F5"]["R_m"])
}

/// The bladed disk at rest, its normal load tied to the speed.
fn at_rest() -> Model {
    let mut model = BASE.sector();
    model.set_preload_at_speed(0, 0.0, 0.03 * radius()).unwrap();
    model
}

fn with_ring(model: &mut Model, mass: f64) {
    let matrices = Blisk {
        ring_mass: Some(mass),
        ..BASE
    }
    .matrices();
    let view = MatrixView::dense(matrices.n, &matrices.mass);
    model.set_matrix(MatrixKind::Mass, &view).unwrap();
    model.set_preload_at_speed(0, 0.0, mass * radius()).unwrap();
}

/// Frequency in Hz and amplitude of the highest peak, and the share of slip there.
fn peak(model: &Model, solver: &SolverOptions) -> (f64, f64, f64) {
    let branch = sweep(model, solver, TAU * RANGE.0, TAU * RANGE.1, &[]);
    assert_eq!(branch.status(), Status::Ok);
    let highest = branch
        .peaks()
        .iter()
        .max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
        .unwrap();
    (highest.omega / TAU, highest.amplitude, slip(&branch, highest.point))
}

fn turn(model: &mut Model, rpm: f64) {
    model.set_speed(Speed::Fixed(rpm * TAU / 60.0)).unwrap();
}

#[test]
fn peaks_at_other_speeds_are_those_of_other_forces() {
    // A(F, N₀ s) = s A(F/s, N₀): 5 N at 3000 rpm √(5/F) is F at 3000 rpm.
    let reference = data("frf_base.json");
    let mut model = at_rest();
    for (name, force) in [("F1", 1.0), ("F5", 5.0), ("F20", 20.0)] {
        let stored = &reference["peaks"][name];
        let scale: f64 = 5.0 / force;
        turn(&mut model, 3000.0 * scale.sqrt());
        for highest in [1, 3, 7, 15] {
            let stored = &stored["peak_hbm"][highest.to_string()];
            let (f, amplitude, share) = peak(&model, &harmonics(highest));
            let known = scale * number(&stored["amp_b2_fund_m"]);
            let gap = amplitude / known - 1.0;
            println!(
                "{:.1} rpm, H = {highest}: {f:.6} Hz, amplitude off by {gap:.1e}",
                3000.0 * scale.sqrt()
            );
            assert!(gap.abs() < 1e-7 && share > 0.0);
            // The reference gives its peak frequencies to about 1e-4 Hz.
            assert!((f - number(&stored["f_Hz"])).abs() < 5e-4);
        }
        // The truth, by event-driven integration of the whole wheel.
        let solver = SolverOptions {
            tolerance: 1e-4,
            ..SolverOptions::default()
        };
        let (f, amplitude, _) = peak(&model, &solver);
        let truth = &stored["peak_td"];
        let gap = amplitude / (scale * number(&truth["amp_b2_fund_m"])) - 1.0;
        println!("   with a tolerance: {f:.6} Hz, amplitude off by {gap:.1e}");
        assert!(gap.abs() < 1e-4);
        assert!((f - number(&truth["f_Hz"])).abs() < 5e-4);
    }
}

#[test]
fn masses_and_speeds_of_one_model_are_those_of_models_built_anew() {
    let nine = harmonics(9);
    let mut model = at_rest();
    let stuck = data("nf_nd.json");
    let mut over_mass = Vec::new();
    for grams in [10, 20, 30, 40, 50, 60] {
        let mass = f64::from(grams) / 1000.0;
        with_ring(&mut model, mass);
        turn(&mut model, 3000.0);
        let case = Blisk {
            ring_mass: Some(mass),
            ..BASE
        };
        let (found, known) = (peak(&model, &nine), peak(&case.sector(), &nine));
        println!("{grams} g: {:.6} Hz, {:.6e} m, slip {:.3}", found.0, found.1, found.2);
        assert!((found.1 / known.1 - 1.0).abs() < 1e-9 && (found.0 / known.0 - 1.0).abs() < 1e-9);
        over_mass.push(found.1);
        // A load at which nothing slips: the natural frequency with the ring stuck.
        turn(&mut model, 60_000.0);
        let (f, _, share) = peak(&model, &nine);
        let natural = number(&stuck["ring_stuck"][format!("{grams}g")]["2"]["f"][0]);
        assert!(share < f64::EPSILON);
        // Damping of 0.1 % lowers the frequency of the peak by its square.
        assert!((f / natural - 1.0).abs() < 5e-6, "{f} {natural}");
    }
    with_ring(&mut model, 0.03);
    let mut over_speed = Vec::new();
    for rpm in [1000.0, 2000.0, 3000.0, 4000.0, 5000.0, 6000.0] {
        turn(&mut model, rpm);
        let case = Blisk { rpm, ..BASE };
        let (found, known) = (peak(&model, &nine), peak(&case.sector(), &nine));
        println!("{rpm} rpm: {:.6} Hz, {:.6e} m, slip {:.3}", found.0, found.1, found.2);
        assert!((found.1 / known.1 - 1.0).abs() < 1e-9 && (found.0 / known.0 - 1.0).abs() < 1e-9);
        over_speed.push((found.0, found.1));
    }
    // 30 g and 3000 rpm damp best, and the peaks move to the right with the speed.
    let lowest = |list: &[f64]| (0..list.len()).min_by(|&i, &j| list[i].total_cmp(&list[j])).unwrap();
    assert_eq!(lowest(&over_mass), 2, "{over_mass:?}");
    let amplitudes: Vec<f64> = over_speed.iter().map(|p| p.1).collect();
    assert_eq!(lowest(&amplitudes), 2, "{amplitudes:?}");
    assert!(over_speed.windows(2).all(|pair| pair[0].0 < pair[1].0));
}
