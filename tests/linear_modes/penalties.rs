//! Natural and damped modes beside penalties, at sizes of dense and of sparse algebra, against closed forms of the chains that
//! penalties make: a mass held at one place leaves two chains, and two halves of a mass that are linked leave one.

use crate::common::models::dense;
use hbvib::{ContactState, Hooks, LinearContacts, Model, damped_modes};
use std::f64::consts::PI;

/// Spring between the masses of 1. It and the penalties are stored exactly in all sums.
const SPRING: f64 = 4.0;

/// Frequencies of n masses between walls.
fn chain(n: usize) -> impl Iterator<Item = f64> {
    (1..=n).map(move |j| 2.0 * SPRING.sqrt() * (0.5 * PI * j as f64 / (n + 1) as f64).sin())
}

/// K of masses in a row between walls, and M; the spring behind mass `at` is replaced by a `link` between its two halves.
fn linked(n: usize, at: usize, link: f64) -> (Vec<f64>, Vec<f64>) {
    let order = n + 1;
    let (mut mass, mut stiffness) = (vec![0.0; order * order], vec![0.0; order * order]);
    for i in 0..order {
        mass[i * order + i] = if i == at || i == at + 1 { 0.5 } else { 1.0 };
    }
    stiffness[0] += SPRING;
    stiffness[order * order - 1] += SPRING;
    for i in 0..order - 1 {
        let k = if i == at { link } else { SPRING };
        for (row, column, sign) in [(i, i, 1.0), (i + 1, i + 1, 1.0), (i, i + 1, -1.0), (i + 1, i, -1.0)] {
            stiffness[column * order + row] += sign * k;
        }
    }
    (mass, stiffness)
}

/// The lowest frequencies off those expected, and damping ratios off β ω/2.
fn errors(model: &mut Model, expected: &[f64], beta: f64) -> [f64; 3] {
    let count = expected.len();
    let natural = model.lowest_modes(0, ContactState::Free, count).unwrap().omega;
    let off = |(found, exact): (f64, &f64)| (found / exact - 1.0).abs();
    let of_natural = natural.into_iter().zip(expected).map(off).fold(0.0, f64::max);
    model.set_rayleigh(0.0, beta).unwrap();
    let damped = damped_modes(model, 0, LinearContacts::Free, count, &mut Hooks::default()).unwrap();
    let (mut of_damped, mut of_ratio) = (0.0_f64, 0.0_f64);
    for (k, exact) in expected.iter().enumerate() {
        let ratio = 0.5 * beta * exact;
        of_damped = of_damped.max(off((damped.omega(k), &(exact * (1.0 - ratio * ratio).sqrt()))));
        of_ratio = of_ratio.max(off((damped.damping_ratio(k), &ratio)));
    }
    [of_natural, of_damped, of_ratio]
}

#[test]
fn a_mass_held_by_a_penalty_is_a_wall() {
    for n in [4, 10, 33, 98, 99, 100, 101, 250] {
        let at = n / 3;
        let mut expected: Vec<f64> = chain(at).chain(chain(n - 1 - at)).collect();
        expected.sort_by(f64::total_cmp);
        expected.truncate(3);
        for penalty in [1e8, 1e10, 1e12, 1e14, 1e16] {
            let mut mass = vec![0.0; n * n];
            let mut stiffness = vec![0.0; n * n];
            for i in 0..n {
                mass[i * n + i] = 1.0;
                stiffness[i * n + i] = 2.0 * SPRING + if i == at { penalty } else { 0.0 };
                if i > 0 {
                    stiffness[i * n + i - 1] = -SPRING;
                    stiffness[(i - 1) * n + i] = -SPRING;
                }
            }
            let mut model = dense(&mass, &stiffness).build();
            // The wall gives by SPRING/penalty.
            let allowed = 20.0 * SPRING / penalty + 2e-12;
            let found = errors(&mut model, &expected, 1e-3);
            assert!(found.iter().all(|off| *off < allowed), "{n}, {penalty:e}: {found:?}");
        }
    }
}

#[test]
fn two_halves_that_a_penalty_links_are_one_mass() {
    for n in [3, 9, 32, 98, 99, 100, 150, 300] {
        let expected: Vec<f64> = chain(n).take(3).collect();
        for link in [1e4, 1e6, 1e8, 1e10, 1e12] {
            let (mass, stiffness) = linked(n, n / 2, link);
            let mut model = dense(&mass, &stiffness).build();
            let [natural, damped, ratio] = errors(&mut model, &expected, 1e-3);
            let gives = 20.0 * SPRING / link;
            // Above 100 degrees of freedom solutions lose digits to the link, and βK as stored has lost ε link of the damping beside it.
            let (lost, stored) = (
                if n < 100 { 1e-12 } else { 1e-18 * link * n as f64 },
                1e-18 * link * n as f64,
            );
            let case = format!("{n}, {link:e}: {natural:e} {damped:e} {ratio:e}");
            assert!(natural < gives + 2e-12 + lost, "{case}");
            assert!(damped < gives + 2e-12 + stored * 1e-3, "{case}");
            assert!(ratio < gives + 2e-12 + 100.0 * stored, "{case}");
        }
    }
}
