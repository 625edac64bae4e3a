//! Tests of tables by soft modes.

use super::*;
use crate::condense::by_factors::flexibility::Workspace;
use crate::condense::by_modes::modal_rows::ModalRows;
use crate::condense::by_modes::modal_slopes::tests::assert_slopes;
use crate::condense::by_modes::wave_cache::WaveCache;
use crate::condense::test_chains::long_chain;
use crate::condense::{Condensed, Reference};
use crate::model::Model;
use crate::options::SolverOptions;

/// A chain of masses between sliders, under a force that grows with the square of the frequency as well.
fn damped_chain(n: usize, contacts: usize, (beta, loss_factor): (f64, f64)) -> Model {
    let mut model = long_chain(n, contacts, (1e-3, beta));
    model.set_loss_factor(loss_factor).unwrap();
    model.add_force(n / 2, 1, Complex64::new(0.7, -0.2)).unwrap();
    model.add_unbalance(n / 4, n / 5, 0.1, 0.4).unwrap();
    model
}

#[test]
fn tables_by_soft_modes_are_those_by_factorisation() {
    let none = Interrupt::none();
    for (n, contacts) in [(33, 12), (101, 33), (200, 60), (201, 16)] {
        for damping in [(2e-2, 0.0), (1e-4, 0.0), (1e-3, 0.03)] {
            let model = damped_chain(n, contacts, damping);
            let options = SolverOptions {
                harmonics: 3,
                ..SolverOptions::default()
            };
            let stuck = Some(Reference::Stuck);
            let condensed = Condensed::with_reference(&model, &options, 0.1, stuck, &none).unwrap();
            let mut cache = WaveCache::default();
            let mut direct = Workspace::new(&condensed, Some(n / 2)).unwrap();
            for i in 0..condensed.blocks().len() {
                let modes = cache.of(&model, &condensed, i, &none).unwrap().unwrap();
                let rows = Arc::new(ModalRows::new((&condensed, i, n / 2), modes).unwrap());
                let table = || ModalTable::new((&condensed, i), Arc::clone(&rows)).unwrap();
                let by_modes = table().over(Range::new(0.06, 0.02)).unwrap();
                let mut work = ModalWork::default();
                while by_modes.soft.as_ref().is_some_and(|soft| soft.made.get().is_none()) {
                    by_modes.count(0.03, &mut work, &none).unwrap();
                }
                // Few contacts, and many soft modes, take less time by sums.
                if by_modes.soft.is_none() {
                    assert!(i > 0 || contacts < 20);
                    continue;
                }
                assert!(by_modes.soft_modes().is_some(), "{n}, {contacts}, {damping:?}, {i}");
                // Another table of the harmonic shares them, one over another range does not.
                assert!(table().over(Range::new(0.02, 0.06)).unwrap().soft_modes().is_some());
                assert!(table().over(Range::new(0.02, 0.07)).unwrap().soft_modes().is_none());
                let mut found = Table::new(condensed.coordinates()).unwrap();
                for omega in [0.02, 0.0231, 0.04, 0.0517, 0.06] {
                    assert!(by_modes.evaluate((omega, false), &mut work, &mut found, &none).unwrap() && work.by_soft);
                    let exact = direct.evaluate(&condensed, i, omega, true, &none).unwrap();
                    let columns = found
                        .value
                        .chunks_exact(contacts + 1)
                        .zip(exact.value.chunks_exact(contacts + 1));
                    for (column, (a, b)) in columns.enumerate() {
                        let off: f64 = a.iter().zip(b).map(|(a, b)| (a - b).norm_sqr()).sum();
                        let size: f64 = b.iter().map(Complex64::norm_sqr).sum();
                        assert!(
                            off <= 1e-22 * size,
                            "{n}, {damping:?}, column {column} of block {i} at {omega}: {:e}",
                            (off / size).sqrt()
                        );
                    }
                    assert_slopes((&by_modes, omega), exact, 1e-10);
                }
                assert!(by_modes.evaluate((0.07, false), &mut work, &mut found, &none).unwrap() && !work.by_soft);
            }
        }
    }
}
