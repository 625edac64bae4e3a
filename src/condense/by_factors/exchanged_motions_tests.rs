//! Tests of exchanged motions.

use crate::condense::Condensed;
use crate::condense::frequency_cache::FrequencyCache;
use crate::condense::test_chains::{DAMPED, structure};
use crate::contact::Contact;
use crate::interrupt::Interrupt;
use crate::options::{Exchanged, SolverOptions};
use num_complex::Complex64;

/// Whatever the forces are, the motion that follows from the exchanged one is that of the structure under them.
#[test]
fn exchanged_motions_are_those_of_the_structure() {
    let interrupt = Interrupt::none();
    for sectors in [1, 9] {
        let mut model = structure(sectors, DAMPED[0].0);
        model.add_contact(&Contact::jenkins(1, None, 1e7, 0.3, 1.0)).unwrap();
        // A mean.
        model
            .add_contact(&Contact::unilateral(None, Some(2), 3.0, 0.1))
            .unwrap();
        let options = |exchange| SolverOptions {
            harmonics: 5,
            exchange,
            ..SolverOptions::default()
        };
        let [plain, exchanged] = [Exchanged::None, Exchanged::NearRigid].map(|exchange| {
            let condensed = Condensed::new(&model, &options(exchange), (0.6, 0.9), &interrupt).unwrap();
            let tables = FrequencyCache::new(&condensed, 0, (0.7, 0.7).into(), &interrupt).unwrap();
            (condensed, tables)
        });
        let ((plain, mut of_plain), (exchanged, mut of_exchanged)) = (plain, exchanged);
        let own: Vec<usize> = (0..2).filter(|&c| exchanged.is_exchanged(c)).collect();
        let [own] = own[..] else { panic!("{own:?}") };
        assert!(!plain.has_exchanges() && exchanged.is_exchanged(own));
        of_plain.tabulate(&plain, (0.7, true), &interrupt).unwrap();
        of_exchanged.tabulate(&exchanged, (0.7, true), &interrupt).unwrap();
        let set = exchanged.set();
        assert!(set.has_mean());
        let (m, unit) = (set.packed_len(), plain.length() / exchanged.length());
        let (mut x, mut forces) = (vec![0.0; 2 * m], vec![0.0; 2 * m]);
        let force = |c: usize, i: usize| {
            let imaginary = if i == 0 { 0.0 } else { 0.3 * i as f64 };
            Complex64::new(0.2 + c as f64, imaginary)
        };
        for i in 0..set.numbers().len() {
            for c in 0..2 {
                set.set(&mut forces[c * m..(c + 1) * m], i, force(c, i));
            }
            // The other contact moves such that f − κ y = f for it: by nothing.
            let table = &of_exchanged.current()[i].value;
            let mut z = table[2 * 3 + own];
            for c in 0..2 {
                z -= table[c * 3 + own] * force(c, i);
            }
            set.set(&mut x[own * m..(own + 1) * m], i, z);
        }
        let y = exchanged.relative_motion(&x, &forces, 0.7).unwrap();
        for i in 0..set.numbers().len() {
            // Without exchange y = y_lin − G (f − κ y): both rows solved, with κ of the contact alone.
            let table = &of_plain.current()[i].value;
            let (mut right, kappa) = (table[2 * 3 + own] * unit, plain.kappa(own, i));
            for c in 0..2 {
                right -= table[c * 3 + own] * force(c, i);
            }
            let exact = right / (1.0 - table[own * 3 + own] * kappa);
            let found = set.get(&y[own * m..(own + 1) * m], i);
            // The creep of the mean is divided out with its digits.
            let digits = if i == 0 { 1e-8 } else { 1e-11 };
            let off = (found - exact).norm();
            assert!(off <= digits * exact.norm(), "{sectors}, {i}: {found} for {exact}");
        }
    }
}

#[test]
fn slopes_of_exchanged_tables_are_differences() {
    let interrupt = Interrupt::none();
    let mut model = structure(1, DAMPED[0].0);
    model.add_contact(&Contact::jenkins(1, None, 1e7, 0.3, 1.0)).unwrap();
    let options = SolverOptions {
        harmonics: 5,
        exchange: Exchanged::NearRigid,
        ..SolverOptions::default()
    };
    let condensed = Condensed::new(&model, &options, (0.6, 0.9), &interrupt).unwrap();
    let at = |omega: f64| {
        let mut tables = FrequencyCache::new(&condensed, 0, (0.6, 0.9).into(), &interrupt).unwrap();
        tables.tabulate(&condensed, (omega, true), &interrupt).unwrap();
        tables
    };
    let step = 1e-5;
    let [below, here, above] = [0.7 - step, 0.7, 0.7 + step].map(at);
    for i in 0..condensed.set().numbers().len() {
        let values = above.current()[i].value.iter().zip(&below.current()[i].value);
        for ((a, b), slope) in values.zip(&here.current()[i].slope) {
            let difference = (a - b) / (2.0 * step);
            assert!(
                (difference - slope).norm() <= 1e-5 * (1.0 + slope.norm()),
                "{difference} for {slope}"
            );
        }
    }
}
