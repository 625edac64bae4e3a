//! Tests of tables of the flexibility from modes.

use super::*;
use crate::condense::by_factors::flexibility::Workspace;
use crate::condense::by_modes::modal_slopes::tests::assert_slopes;
use crate::condense::by_modes::wave_cache::{SharedWaves, WaveCache};
use crate::condense::test_chains::{DAMPED, chain, real_wheel, structure};
use crate::condense::{Condensed, Reference};
use crate::contact::Contact;
use crate::model::Model;
use crate::options::SolverOptions;

fn condensed(model: &Model, reference: Reference) -> Condensed {
    let options = SolverOptions {
        harmonics: 7,
        ..SolverOptions::default()
    };
    Condensed::with_reference(model, &options, 1.3, Some(reference), &Interrupt::none()).unwrap()
}

fn table_of(condensed: &Condensed, i: usize, source: Source) -> ModalTable {
    let rows = ModalRows::new((condensed, i, 4), source).unwrap();
    ModalTable::new((condensed, i), Arc::new(rows)).unwrap()
}

#[test]
fn tables_from_modes_are_those_by_factorisation() {
    for (sectors, reference) in [
        (1, Reference::Stuck),
        (24, Reference::Stuck),
        (8, Reference::Stuck),
        (1, Reference::Complex),
        (24, Reference::Complex),
    ] {
        for (damping, loss_factor) in DAMPED {
            let mut model = chain(sectors, damping);
            model.set_loss_factor(loss_factor).unwrap();
            let condensed = condensed(&model, reference);
            let mut cache = WaveCache::default();
            let mut direct = Workspace::new(&condensed, Some(4)).unwrap();
            for i in 0..condensed.blocks().len() {
                let modes = cache.of(&model, &condensed, i, &Interrupt::none()).unwrap().unwrap();
                let by_modes = table_of(&condensed, i, modes);
                let mut work = ModalWork::default();
                let mut table = Table::new(condensed.coordinates()).unwrap();
                for omega in [0.05, 0.4, 1.0, 1.3, 2.7, 9.0] {
                    let found = by_modes.evaluate((omega, true), &mut work, &mut table, &Interrupt::none());
                    assert!(found.unwrap(), "{sectors} sectors, {damping:?}, block {i} at {omega}");
                    let exact = direct.evaluate(&condensed, i, omega, true, &Interrupt::none()).unwrap();
                    let size = |z: &[Complex64]| z.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
                    for (name, of_modes, exact) in [
                        ("H", &table.value, &exact.value),
                        ("its slope", &table.slope, &exact.slope),
                    ] {
                        let off: Vec<Complex64> = of_modes.iter().zip(exact).map(|(a, b)| a - b).collect();
                        assert!(
                            size(&off) <= 1e-10 * size(exact),
                            "{sectors} sectors, {damping:?}, {loss_factor}, {name} of block {i} at {omega}: {:e}",
                            size(&off) / size(exact)
                        );
                    }
                    assert_slopes((&by_modes, omega), exact, 1e-10);
                }
            }
            // On eight sectors harmonics travel either way, with conjugate modes.
            let waves = match sectors {
                1 => 1,
                8 => 2,
                _ => 4,
            };
            assert_eq!(cache.count(), waves, "{sectors} sectors");
        }
    }
}

/// Rows that harmonics share belong to the direction in which the wave of these harmonics travels.
#[test]
fn shared_rows_of_waves_with_the_same_real_matrices_are_their_own() {
    for (damping, loss_factor) in DAMPED {
        let mut model = real_wheel(damping);
        model.set_loss_factor(loss_factor).unwrap();
        let condensed = condensed(&model, Reference::Stuck);
        let waves = SharedWaves::default();
        let mut direct = Workspace::new(&condensed, Some(1)).unwrap();
        for i in 0..condensed.blocks().len() {
            let modes = waves.of(&model, &condensed, i, &Interrupt::none()).unwrap().unwrap();
            let rows = waves.rows((&condensed, i, 1), modes).unwrap();
            let by_modes = ModalTable::new((&condensed, i), rows).unwrap();
            let mut table = Table::new(condensed.coordinates()).unwrap();
            let work = &mut ModalWork::default();
            assert!(
                by_modes
                    .evaluate((0.9, false), work, &mut table, &Interrupt::none())
                    .unwrap()
            );
            let exact = direct.evaluate(&condensed, i, 0.9, false, &Interrupt::none()).unwrap();
            for (a, b) in table.value.iter().zip(&exact.value) {
                assert!(
                    (a - b).norm() <= 1e-12,
                    "{damping:?}, {loss_factor}, block {i}: {a} {b}"
                );
            }
        }
    }
}

#[test]
fn the_table_of_a_single_contact_is_that_by_factorisation() {
    for (damping, loss_factor) in DAMPED {
        let mut model = structure(1, damping);
        model.add_contact(&Contact::jenkins(1, Some(4), 9.0, 0.3, 1.0)).unwrap();
        model.set_loss_factor(loss_factor).unwrap();
        for reference in [Reference::Stuck, Reference::Complex] {
            let condensed = condensed(&model, reference);
            let mut cache = WaveCache::default();
            let mut direct = Workspace::new(&condensed, Some(4)).unwrap();
            for i in 0..condensed.blocks().len() {
                let modes = cache.of(&model, &condensed, i, &Interrupt::none()).unwrap().unwrap();
                let by_modes = table_of(&condensed, i, modes);
                let mut work = ModalWork::default();
                let mut table = Table::new(1).unwrap();
                for omega in [0.05, 0.4, 1.3, 9.0] {
                    assert!(
                        by_modes
                            .evaluate((omega, true), &mut work, &mut table, &Interrupt::none())
                            .unwrap()
                    );
                    let exact = direct.evaluate(&condensed, i, omega, true, &Interrupt::none()).unwrap();
                    for (a, b) in [(&table.value, &exact.value), (&table.slope, &exact.slope)] {
                        for (a, b) in a.iter().zip(b) {
                            assert!((a - b).norm() <= 1e-10 * b.norm(), "{damping:?}, {i}, {omega}: {a} {b}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn near_a_resonance_of_the_stuck_structure_nothing_is_told_that_lost_its_digits() {
    let model = chain(1, (0.0, 1e-10));
    let condensed = condensed(&model, Reference::Stuck);
    let mut cache = WaveCache::default();
    let modes = cache.of(&model, &condensed, 0, &Interrupt::none()).unwrap().unwrap();
    let Source::Modes(of_wave) = &modes else {
        panic!("no modes");
    };
    let resonance = of_wave.values.last().unwrap().sqrt().recip();
    let by_modes = table_of(&condensed, 0, modes);
    let mut work = ModalWork::default();
    let mut table = Table::new(condensed.coordinates()).unwrap();
    for (factor, clear) in [(1.0, false), (1.0 + 1e-7, false), (1.01, true)] {
        let found = by_modes.evaluate((factor * resonance, true), &mut work, &mut table, &Interrupt::none());
        assert_eq!(found.unwrap(), clear, "{factor}");
    }
}
