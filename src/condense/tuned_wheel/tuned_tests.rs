//! The flexibility of wheels as tuned plus low rank against factors of all sectors.

use crate::condense::Condensed;
use crate::condense::by_factors::flexibility::{Slopes, Workspace};
use crate::condense::test_chains::{DAMPED, N, chain};
use crate::condense::tuned_wheel::tuned_plan::TunedPlan;
use crate::interrupt::Interrupt;
use crate::linalg::sparse_storage::matrix_view::MatrixView;
use crate::model::Model;
use crate::model::matrices::structure::MatrixKind;
use crate::model::wheels::mistuning::{BladeProperty, Mistuning};
use crate::options::{Flexibility, SolverOptions};
use num_complex::Complex64;
use std::sync::Arc;

const SECTORS: usize = 7;
const DELTA: [f64; SECTORS] = [0.03, -0.02, 0.0, 0.05, -0.01, 0.04, -0.03];

/// A wheel with patterns within sectors and, over the coupling of its blade, between them.
fn wheel(damping: (f64, f64), loss_factor: f64) -> Model {
    let mut sector = chain(SECTORS, damping);
    sector.set_loss_factor(loss_factor).unwrap();
    let mut wheel = sector.wheel().unwrap();
    for what in [
        Mistuning::Blade(BladeProperty::Frequency, &[3, 4]),
        Mistuning::Blade(BladeProperty::Mass, &[8]),
        Mistuning::Blade(BladeProperty::Damping, &[8]),
        Mistuning::Force,
    ] {
        wheel.mistune(&sector, &what, &DELTA).unwrap();
    }
    let mut dashpot = [0.0; N * N];
    dashpot[0] = 0.02;
    let view = MatrixView::dense(N, &dashpot);
    let turned: Vec<f64> = DELTA.iter().rev().copied().collect();
    wheel
        .mistune(&sector, &Mistuning::Matrix(MatrixKind::Damping, &view), &turned)
        .unwrap();
    wheel
}

fn condensed(model: &Model) -> (Condensed, Condensed) {
    let options = SolverOptions {
        harmonics: 5,
        flexibility: Flexibility::Direct,
        ..SolverOptions::default()
    };
    let none = Interrupt::none();
    let plain = Condensed::new(model, &options, 0.7, &none).unwrap();
    let mut tuned = plain.clone();
    let plan = TunedPlan::new(&tuned.blocks, SECTORS, &none)
        .unwrap()
        .expect("low rank");
    tuned.wave.tuned = Some(Arc::new(plan));
    (plain, tuned)
}

fn gap(a: &[Complex64], b: &[Complex64]) -> f64 {
    let size = b.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
    // Harmonics without force have no motion under it.
    a.iter().zip(b).fold(0.0_f64, |m, (a, b)| m.max((a - b).norm())) / if size > 0.0 { size } else { 1.0 }
}

#[test]
fn tables_of_a_mistuned_wheel_are_those_of_its_factors() {
    let none = Interrupt::none();
    for (damping, loss_factor) in DAMPED {
        let (plain, tuned) = condensed(&wheel(damping, loss_factor));
        let rank = tuned.tuned().unwrap().basis.rank;
        // Two motions of the blade that is coupled to its neighbours, and those of degrees of freedom 8 and 0, to rounding.
        println!("{damping:?} {loss_factor}: rank {rank}");
        assert!((4..=6).contains(&rank), "{rank}");
        let (mut known, mut found) = (
            Workspace::new(&plain, Some(17)).unwrap(),
            Workspace::new(&tuned, Some(17)).unwrap(),
        );
        for i in 0..plain.blocks().len() {
            for omega in [0.31, 0.9, 2.3] {
                let expected = known.tabulate(&plain, (i, omega), Slopes::OfResponse, &none).unwrap();
                let table = found.tabulate(&tuned, (i, omega), Slopes::OfResponse, &none).unwrap();
                let of_values = gap(&table.value, &expected.value);
                assert!(of_values < 1e-12, "{i} {omega}: {of_values:e}");
                if plain.blocks()[i].number > 0 {
                    let of_slopes = gap(&table.slope, &expected.slope);
                    assert!(of_slopes < 1e-11, "{i} {omega}: {of_slopes:e}");
                }
                assert!(gap(found.excited(), known.excited()) < 1e-12);
                let (expected, table) = (
                    known.tabulate(&plain, (i, omega), Slopes::All, &none).unwrap(),
                    found.tabulate(&tuned, (i, omega), Slopes::All, &none).unwrap(),
                );
                assert!(gap(&table.value, &expected.value) < 1e-12);
                if plain.blocks()[i].number > 0 {
                    assert!(gap(&table.slope, &expected.slope) < 1e-11);
                }
                let mut b: Vec<Complex64> = (0..plain.ndof()).map(|k| Complex64::cis(k as f64)).collect();
                let mut x = b.clone();
                known.adjoint(&plain, i, omega, &mut b, &none).unwrap();
                found.adjoint(&tuned, i, omega, &mut x, &none).unwrap();
                assert!(gap(&x, &b) < 1e-12);
            }
        }
    }
}

#[test]
fn a_tuned_wheel_has_no_rank_and_other_wheels_no_plan() {
    let none = Interrupt::none();
    let sector = chain(SECTORS, (0.0, 1e-3));
    let (plain, tuned) = condensed(&sector.wheel().unwrap());
    assert_eq!(tuned.tuned().unwrap().basis.rank, 0);
    let (mut known, mut found) = (
        Workspace::new(&plain, Some(0)).unwrap(),
        Workspace::new(&tuned, Some(0)).unwrap(),
    );
    let expected = known.evaluate(&plain, 0, 0.9, false, &none).unwrap();
    let table = found.evaluate(&tuned, 0, 0.9, false, &none).unwrap();
    assert!(gap(&table.value, &expected.value) < 1e-13);
    // Where all degrees of freedom differ there is nothing to gain.
    let mut wheel = sector.wheel().unwrap();
    for dof in 0..N {
        let delta: Vec<f64> = DELTA.iter().map(|d| d * (1.0 + dof as f64)).collect();
        wheel
            .mistune(&sector, &Mistuning::Blade(BladeProperty::Mass, &[dof]), &delta)
            .unwrap();
    }
    let blocks = &Condensed::new(&wheel, &SolverOptions::default(), 0.7, &none)
        .unwrap()
        .blocks;
    assert!(TunedPlan::new(blocks, SECTORS, &none).unwrap().is_none());
}
