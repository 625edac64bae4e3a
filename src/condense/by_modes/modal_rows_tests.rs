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

/// A chain between walls with sliders at four masses, one of which never slips, damped by stiffness.
fn chain() -> (Model, Condensed) {
    let mut model = Model::new(N).unwrap();
    let dense = |entry: &dyn Fn(usize, usize) -> f64| -> Vec<f64> { (0..N * N).map(|k| entry(k % N, k / N)).collect() };
    let mass = dense(&|i, j| if i == j { 1.0 + 0.2 * (i as f64).sin() } else { 0.0 });
    let stiffness = dense(&|i, j| [2.0, -1.0].get(i.abs_diff(j)).copied().unwrap_or(0.0));
    for (kind, values) in [(MatrixKind::Mass, mass), (MatrixKind::Stiffness, stiffness)] {
        model.set_matrix(kind, &MatrixView::dense(N, &values)).unwrap();
    }
    model.set_rayleigh(0.0, 0.05).unwrap();
    for (dof, limit) in [(0, 1.0), (40, 1.0), (41, f64::INFINITY), (149, 1.0)] {
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

fn table(model: &Model, condensed: &Condensed, i: usize, tolerance: f64) -> ModalTable {
    let modes = WaveCache::default().of(model, condensed, i, &Interrupt::none());
    let rows = ModalRows::new((condensed, i, RESPONSE), modes.unwrap().ok().unwrap());
    ModalTable::new((condensed, i), Arc::new(rows.unwrap()), tolerance).unwrap()
}

#[test]
fn a_series_over_the_stiff_modes_is_the_sum_within_its_tolerance() {
    let (model, condensed) = chain();
    let interrupt = Interrupt::none();
    let mut direct = Workspace::new(&condensed, Some(RESPONSE)).unwrap();
    let (mut work, mut found) = (ModalWork::default(), Table::new(condensed.coordinates()).unwrap());
    let mut firsts = Vec::new();
    for i in (0..condensed.blocks().len()).filter(|&i| condensed.blocks()[i].number > 0) {
        for tolerance in [1e-4, 1e-7, 1e-11] {
            let by_series = table(&model, &condensed, i, tolerance);
            for omega in [0.01, 0.03, 0.1, 0.2, 0.35] {
                assert!(
                    by_series
                        .evaluate((omega, false), &mut work, &mut found, &interrupt)
                        .unwrap()
                );
                let exact = &direct.evaluate(&condensed, i, omega, false, &interrupt).unwrap().value;
                let size = |z: &mut dyn Iterator<Item = Complex64>| z.map(|z| z.norm_sqr()).sum::<f64>().sqrt();
                let off = size(&mut found.value.iter().zip(exact).map(|(a, b)| a - b));
                let off = off / size(&mut exact.iter().copied());
                assert!(off <= tolerance, "block {i} at {omega}: {off:e} for {tolerance:e}");
                let nu = omega * condensed.blocks()[i].number as f64;
                let mut out = vec![Complex64::ZERO; by_series.rows().count().pow(2)];
                firsts.push(
                    by_series
                        .rows()
                        .add_stiff(
                            by_series.rows().source().denominator(1.0, nu),
                            terms_within(tolerance),
                            &mut out,
                            None,
                        )
                        .unwrap(),
                );
            }
        }
    }
    // Each number of soft modes was met that the structure allows, and the exact sum.
    for first in [N - SOFT[0], 0] {
        assert!(firsts.contains(&first), "{firsts:?}");
    }
}
