//! Tests of the poles of quadratic pencils.

use super::*;
use crate::condense::Reference;
use crate::condense::by_factors::flexibility::{Table, Workspace};
use crate::condense::by_modes::modal_rows::ModalRows;
use crate::condense::by_modes::modal_slopes::tests::assert_slopes;
use crate::condense::by_modes::modal_table::{ModalTable, ModalWork};
use crate::condense::by_modes::sum_terms::Source;
use crate::condense::test_chains::{N, chain};
use crate::linalg::sparse_storage::matrix_view::MatrixView;
use crate::model::Model;
use crate::model::matrices::speed::Speed;
use crate::model::matrices::structure::MatrixKind;
use crate::options::SolverOptions;

const RESPONSE: usize = 4;

fn condensed(model: &Model, reference: Reference) -> Condensed {
    let options = SolverOptions {
        harmonics: 7,
        ..SolverOptions::default()
    };
    Condensed::with_reference(model, &options, 1.3, Some(reference), &Interrupt::none()).unwrap()
}

fn set(model: &mut Model, kind: MatrixKind, entry: impl Fn(usize, usize) -> f64) {
    let values: Vec<f64> = (0..N * N).map(|k| entry(k % N, k / N)).collect();
    model.set_matrix(kind, &MatrixView::dense(N, &values)).unwrap();
}

/// Dashpots, structural damping, gyroscopic forces at a fixed and a tied speed, and an unbalance.
fn structures(sectors: usize) -> Vec<Model> {
    let dashpot = |i: usize, j: usize| if i == 2 && j == 2 { 0.3 } else { 0.0 };
    let gyroscopic = |i: usize, j: usize| match (i, j) {
        (3, 4) | (7, 6) => 0.4,
        (4, 3) | (6, 7) => -0.4,
        _ => 0.0,
    };
    let mut made = Vec::new();
    let mut viscous = chain(sectors, (0.0, 0.0));
    set(&mut viscous, MatrixKind::Damping, dashpot);
    made.push(viscous);
    let mut structural = chain(sectors, (0.01, 1e-3));
    set(&mut structural, MatrixKind::Structural, dashpot);
    made.push(structural);
    let mut fixed = chain(sectors, (0.01, 1e-3));
    set(&mut fixed, MatrixKind::Gyroscopic, gyroscopic);
    fixed.set_speed(Speed::Fixed(1.5)).unwrap();
    made.push(fixed);
    let mut tied = chain(sectors, (0.01, 1e-3));
    set(&mut tied, MatrixKind::Gyroscopic, gyroscopic);
    tied.set_speed(Speed::PerOmega(0.5)).unwrap();
    made.push(tied);
    made
}

fn size(z: impl Iterator<Item = Complex64>) -> f64 {
    z.map(|z| z.norm_sqr()).sum::<f64>().sqrt()
}

/// Checks the sums over poles of all harmonics against factorisations; returns how many there were.
fn check(model: &Model, reference: Reference) -> usize {
    let (condensed, interrupt) = (condensed(model, reference), Interrupt::none());
    let mut direct = Workspace::new(&condensed, Some(RESPONSE)).unwrap();
    let mut count = 0;
    for i in (0..condensed.blocks().len()).filter(|&i| condensed.blocks()[i].number > 0) {
        let found = poles(&condensed, i, None, &interrupt).unwrap().unwrap();
        assert!(are_of(&found, &condensed.blocks()[i]));
        let rows = ModalRows::new((&condensed, i, RESPONSE), Source::Poles(Arc::new(found))).unwrap();
        let by_poles = ModalTable::new((&condensed, i), Arc::new(rows)).unwrap();
        let (mut work, mut table) = (ModalWork::default(), Table::new(condensed.coordinates()).unwrap());
        for omega in [0.05, 0.4, 1.0, 1.3, 2.7, 9.0] {
            assert!(
                by_poles
                    .evaluate((omega, true), &mut work, &mut table, &interrupt)
                    .unwrap()
            );
            let exact = direct.evaluate(&condensed, i, omega, true, &interrupt).unwrap();
            for (found, exact) in [(&table.value, &exact.value), (&table.slope, &exact.slope)] {
                let off = size(found.iter().zip(exact).map(|(a, b)| a - b)) / size(exact.iter().copied());
                assert!(off <= 1e-11, "block {i} at {omega}: {off:e}");
            }
            assert_slopes((&by_poles, omega), exact, 1e-11);
            count += 1;
        }
    }
    count
}

#[test]
fn sums_over_poles_are_tables_by_factorisation() {
    for (sectors, reference) in [
        (1, Reference::Stuck),
        (1, Reference::Complex),
        (24, Reference::Stuck),
        (8, Reference::Complex),
    ] {
        for model in structures(sectors) {
            assert!(check(&model, reference) >= 12);
        }
    }
}

#[test]
fn equal_poles_are_summed_as_well_as_others() {
    // Two alike halves without a connection but contacts: each pole twice.
    let mut model = Model::new(N - 1).unwrap();
    let half = (N - 1) / 2;
    let of = |entry: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
        (0..(N - 1) * (N - 1))
            .map(|k| (k % (N - 1), k / (N - 1)))
            .map(|(i, j)| {
                if i / half == j / half {
                    entry(i % half, j % half)
                } else {
                    0.0
                }
            })
            .collect()
    };
    let chain = |i: usize, j: usize| [2.5, -1.0].get(i.abs_diff(j)).copied().unwrap_or(0.0);
    let mass = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
    let dashpot = |i: usize, j: usize| if i == 1 && j == 1 { 0.2 } else { 0.0 };
    for (kind, values) in [
        (MatrixKind::Stiffness, of(&chain)),
        (MatrixKind::Mass, of(&mass)),
        (MatrixKind::Damping, of(&dashpot)),
    ] {
        model.set_matrix(kind, &MatrixView::dense(N - 1, &values)).unwrap();
    }
    for dof in [0, half] {
        let contact = crate::contact::Contact::jenkins(dof, None, 0.7, 0.3, 1.0);
        model.add_contact(&contact).unwrap();
    }
    model.add_force(2, 1, Complex64::new(0.7, -0.2)).unwrap();
    assert!(check(&model, Reference::Stuck) >= 12);
}

#[test]
fn a_badly_conditioned_pole_is_refused() {
    // Critical damping: one double pole with one vector.
    let mut model = Model::new(1).unwrap();
    for (kind, value) in [
        (MatrixKind::Mass, 1.0),
        (MatrixKind::Stiffness, 1.0),
        (MatrixKind::Damping, 4.0),
    ] {
        model.set_matrix(kind, &MatrixView::dense(1, &[value])).unwrap();
    }
    // K + kt = 4 = (C/2)²/M
    model
        .add_contact(&crate::contact::Contact::jenkins(0, None, 3.0, 0.3, 1.0))
        .unwrap();
    model.add_force(0, 1, Complex64::ONE).unwrap();
    let condensed = condensed(&model, Reference::Stuck);
    let i = condensed.blocks().iter().position(|block| block.number == 1).unwrap();
    assert!(poles(&condensed, i, None, &Interrupt::none()).unwrap().is_err());
}
