//! Tests of rows of modes.

use super::*;
use crate::condense::Reference;
use crate::condense::by_factors::flexibility::{Table, Workspace};
use crate::condense::by_modes::modal_table::{ModalTable, ModalWork};
use crate::condense::by_modes::wave_cache::WaveCache;
use crate::contact::Contact;
use crate::interrupt::Interrupt;
use crate::linalg::sparse_storage::matrix_view::MatrixView;
use crate::model::Model;
use crate::model::matrices::structure::MatrixKind;
use crate::options::SolverOptions;

const N: usize = 150;
const RESPONSE: usize = 7;

/// A chain between walls with sliders at eight masses, one of which never slips, damped by stiffness.
fn chain() -> (Model, Condensed) {
    let mut model = Model::new(N).unwrap();
    let dense = |entry: &dyn Fn(usize, usize) -> f64| -> Vec<f64> { (0..N * N).map(|k| entry(k % N, k / N)).collect() };
    let mass = dense(&|i, j| if i == j { 1.0 + 0.2 * (i as f64).sin() } else { 0.0 });
    let stiffness = dense(&|i, j| [2.0, -1.0].get(i.abs_diff(j)).copied().unwrap_or(0.0));
    for (kind, values) in [(MatrixKind::Mass, mass), (MatrixKind::Stiffness, stiffness)] {
        model.set_matrix(kind, &MatrixView::dense(N, &values)).unwrap();
    }
    model.set_rayleigh(0.0, 0.05).unwrap();
    for dof in [0, 20, 40, 41, 60, 80, 100, 149] {
        let limit = if dof == 41 { f64::INFINITY } else { 1.0 };
        model
            .add_contact(&Contact::jenkins(dof, None, 0.4, 0.3, limit))
            .unwrap();
    }
    model.add_force(3, 1, Complex64::new(0.7, -0.2)).unwrap();
    let options = SolverOptions {
        harmonics: 5,
        ..SolverOptions::default()
    };
    let stuck = Some(Reference::Stuck);
    let condensed = Condensed::with_reference(&model, &options, 0.1, stuck, &Interrupt::none()).unwrap();
    (model, condensed)
}

fn table(model: &Model, condensed: &Condensed, i: usize) -> ModalTable {
    let modes = WaveCache::default().of(model, condensed, i, &Interrupt::none());
    let rows = ModalRows::new((condensed, i, RESPONSE), modes.unwrap().ok().unwrap());
    ModalTable::new((condensed, i), Arc::new(rows.unwrap())).unwrap()
}

#[test]
fn a_series_over_the_stiff_modes_has_the_digits_of_the_sum() {
    let (model, condensed) = chain();
    let interrupt = Interrupt::none();
    let mut direct = Workspace::new(&condensed, Some(RESPONSE)).unwrap();
    let (mut work, mut found) = (ModalWork::default(), Table::new(condensed.coordinates()).unwrap());
    let mut firsts = Vec::new();
    for i in (0..condensed.blocks().len()).filter(|&i| condensed.blocks()[i].number > 0) {
        let by_series = table(&model, &condensed, i);
        for omega in [0.01, 0.03, 0.1, 0.2, 0.35] {
            let evaluated = by_series.evaluate((omega, false), &mut work, &mut found, &interrupt);
            assert!(evaluated.unwrap());
            let exact = &direct.evaluate(&condensed, i, omega, false, &interrupt).unwrap().value;
            let size = |z: &mut dyn Iterator<Item = Complex64>| z.map(|z| z.norm_sqr()).sum::<f64>().sqrt();
            let off = size(&mut found.value.iter().zip(exact).map(|(a, b)| a - b));
            let off = off / size(&mut exact.iter().copied());
            assert!(off <= 1e-11, "block {i} at {omega}: {off:e}");
            let nu = omega * condensed.blocks()[i].number as f64;
            let rows = &by_series.rows;
            let mut out = vec![Complex64::ZERO; rows.count().pow(2)];
            let first = rows.add_stiff(rows.source().denominator(1.0, nu), &mut out, None);
            firsts.push(first.unwrap());
        }
    }
    // Each number of soft modes was met that the structure allows, and the exact sum.
    for first in [N - SOFT[0], 0] {
        assert!(firsts.contains(&first), "{firsts:?}");
    }
}
