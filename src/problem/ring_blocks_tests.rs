//! The waves of a wheel as the factors of its Newton matrix: exact for a motion that is a wave, a preconditioner elsewhere.

use super::RingBlocks;
use crate::condense::Condensed;
use crate::condense::test_chains::chain;
use crate::interrupt::Interrupt;
use crate::linalg::newton::linear_system::dense::DenseSystem;
use crate::linalg::newton::linear_system::krylov::KrylovSystem;
use crate::linalg::newton::linear_system::{Border, Forces, Jacobian, LinearSystem};
use crate::model::Model;
use crate::model::wheels::mistuning::{BladeProperty, Mistuning};
use crate::options::SolverOptions;
use crate::problem::harmonic_balance::HarmonicBalance;
use crate::problem::{Problem, Residual};
use num_complex::Complex64;

const SECTORS: usize = 12;

fn condensed(model: &Model, harmonics: usize) -> Condensed {
    let options = SolverOptions {
        harmonics,
        ..SolverOptions::default()
    };
    Condensed::new(model, &options, (0.6, 0.9), &Interrupt::none()).unwrap()
}

/// A wheel as it is and mistuned; where the sectors are unlike, most contacts of some of them stick.
#[test]
fn the_waves_are_the_matrix_of_a_tuned_wheel_and_nearly_that_of_a_mistuned_one_as_terms_of_low_rank_are() {
    let sector = chain(SECTORS, (0.01, 1e-3));
    let mut mistuned = sector.wheel().unwrap();
    let delta: Vec<f64> = (0..SECTORS).map(|s| 0.1 * (1.7 * s as f64).sin()).collect();
    mistuned
        .mistune(&sector, &Mistuning::Blade(BladeProperty::Stiffness, &[8]), &delta)
        .unwrap();
    let none = Interrupt::none();
    for (wheel, (noise, unlike), most) in [
        (&sector.wheel().unwrap(), (0.0, false), 2),
        (&mistuned, (0.2, false), 60),
        (&mistuned, (0.2, true), 12),
    ] {
        let condensed = condensed(wheel, 9);
        let mut problem = HarmonicBalance::new(&condensed, 8, (0.6, 0.9).into(), 0, None, &none).unwrap();
        let (n, set) = (problem.unknowns(), condensed.set());
        let (m, k) = (set.packed_len(), condensed.coordinates() / SECTORS);
        let mut u = vec![0.0; n];
        for (c, u) in u.chunks_exact_mut(m).enumerate() {
            for (i, &h) in set.numbers().iter().enumerate() {
                let x = |q: usize| (0.9 * (7 * h + 3 * (c % k) + q) as f64).sin() / (h * h) as f64;
                let lag = sector.structure().phase(h, (c / k) as i64);
                let own = noise * (1.3 * (c + 5 * i) as f64).sin() / (h * h) as f64;
                let size = if unlike { 0.05_f64.powi((c / k % 3) as i32) } else { 1.0 };
                set.set(u, i, (lag * Complex64::new(x(0), x(1)) + own) * size);
            }
        }
        let mut at = Residual::new(n).unwrap();
        problem.evaluate(&u, 0.7, &mut at).unwrap();
        let slip = problem.slip_fractions().iter().fold(0.0_f64, |m, x| m.max(*x));
        let row: Vec<f64> = (0..=n).map(|i| (0.7 * i as f64 + 0.2).sin()).collect();
        let b: Vec<f64> = (0..=n).map(|i| (2.1 * i as f64).sin() + 1.0).collect();
        let border = Border {
            column: &at.d_parameter,
            scales: (0.7, 3.0),
            row: &row,
        };
        let unlikeness = problem.unlikeness().unwrap();
        assert_eq!(unlikeness > 0.5, unlike, "{unlikeness}");
        assert!(noise > 0.0 || unlikeness < 1e-6, "{unlikeness}");
        let sectors = problem.matrix_free().unwrap().ring().unwrap();
        let mut ring = KrylovSystem::of_ring(n, (m, sectors), 240).unwrap();
        let mut dense = DenseSystem::new(n).unwrap();
        let (mut x, mut y) = (b.clone(), b.clone());
        for (system, x) in [(&mut ring as &mut dyn LinearSystem, &mut x), (&mut dense, &mut y)] {
            system.update(&mut problem, border, &none).unwrap();
            system.factor(&mut problem, &none).unwrap();
            assert!(system.solve(&mut problem, 1e-10, x, &none).unwrap());
        }
        let size = y.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
        let gap = x.iter().zip(&y).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs())) / size;
        println!(
            "{n} unknowns, slip {slip:.2}, unlike {unlikeness:.2}: {} products, gap {gap:.1e}",
            ring.products()
        );
        assert!(slip > 0.1 && (1..=most).contains(&ring.products()));
        assert!(gap < 1e-8, "{gap}");
        assert_eq!(ring.is_positive(), dense.is_positive());
    }
}

#[test]
fn a_structure_whose_sectors_differ_in_their_contacts_is_no_wheel() {
    let sector = chain(SECTORS, (0.01, 1e-3));
    let has_waves = |model: &Model| RingBlocks::new(&condensed(model, 3)).unwrap().is_some();
    let wheel = sector.wheel().unwrap();
    assert!(has_waves(&wheel) && !has_waves(&sector));
    let mut more = wheel;
    more.add_contact(&crate::contact::Contact::jenkins(5, None, 1.0, 0.3, 1.0))
        .unwrap();
    assert!(!has_waves(&more));
}
