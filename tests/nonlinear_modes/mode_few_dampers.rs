//! Nonlinear modes with damping of few directions beside αM + βK: beside a second structure that is not connected, which brings the model
//! above the sizes at which the flexibility is made in other ways, a mode is the one of its own structure alone.

use crate::common::models::dense;
use crate::common::{amplitude_range, harmonics};
use hbvib::{Contact, DampingForm, Hooks, ModeOptions, Model, nonlinear_mode};

/// Damping of the chain.
#[derive(Clone, Copy, Debug)]
enum Damping {
    /// Dashpots at 3 and between 7 and 9 beside 0.002 K.
    Dashpots,
    /// These with a loss factor.
    Lossy,
    /// Springs and a contact that never slips beside the dashpots.
    Springs,
}

/// Twelve masses in a row with two contacts, and `others` oscillators of high frequency beside it.
fn model(damping: Damping, others: usize) -> Model {
    let n = 12 + others;
    let (mut m, mut k, mut c) = (vec![0.0; n * n], vec![0.0; n * n], vec![0.0; n * n]);
    let add = |a: &mut [f64], i: usize, j: usize, value: f64| a[j * n + i] += value;
    for i in 0..12 {
        add(&mut m, i, i, 1.0 + 0.05 * i as f64);
        add(&mut k, i, i, 4.0);
        if i > 0 {
            let spring = 40.0 + i as f64;
            for (p, q, sign) in [(i, i, 1.0), (i - 1, i - 1, 1.0), (i, i - 1, -1.0), (i - 1, i, -1.0)] {
                add(&mut k, p, q, sign * spring);
            }
        }
    }
    for i in 12..n {
        add(&mut m, i, i, 1.0);
        add(&mut k, i, i, 900.0 + 7.0 * i as f64);
    }
    for (i, j, value) in [(3, 3, 0.05), (7, 7, 0.08), (9, 9, 0.08), (7, 9, -0.08), (9, 7, -0.08)] {
        add(&mut c, i, j, value);
    }
    let mut model = dense(&m, &k).damping(&c).rayleigh(0.0, 0.002).build();
    match damping {
        Damping::Dashpots => {}
        Damping::Lossy => model.set_loss_factor(0.01).unwrap(),
        Damping::Springs => {
            model
                .add_contact(&Contact::jenkins(6, None, 3.0, 0.3, f64::INFINITY))
                .unwrap();
        }
    }
    model.add_contact(&Contact::jenkins(11, None, 8.0, 0.3, 1.0)).unwrap();
    model.add_contact(&Contact::cubic(5, None, 0.5, 0.7)).unwrap();
    model
}

#[test]
fn a_mode_is_the_same_beside_a_structure_that_is_not_connected() {
    let solver = harmonics(3);
    let at = [-0.7, -0.1, 0.3];
    for damping in [Damping::Dashpots, Damping::Lossy, Damping::Springs] {
        for damping_form in [DampingForm::Mass, DampingForm::Stiffness] {
            let of = |others: usize| {
                let options = ModeOptions {
                    at: &at,
                    damping_form,
                    reference_dof: Some(11),
                    ..amplitude_range(-1.5, 0.4)
                };
                let branch = nonlinear_mode(&model(damping, others), &solver, &options, &mut Hooks::default()).unwrap();
                (0..at.len())
                    .map(|i| {
                        let found = &branch.at(i)[0];
                        let mode = branch.mode_at(found.point).unwrap();
                        (found.omega, mode.damping_ratio)
                    })
                    .collect::<Vec<_>>()
            };
            // Factors of all harmonics up to 48, poles or sums from there on, other sums above 100 and 200.
            let alone = of(0);
            for others in [37, 88, 90, 150, 220] {
                for (i, ((omega, d), (own, own_d))) in of(others).iter().zip(&alone).enumerate() {
                    let told = format!("{damping:?}, {damping_form:?}, {others} others, at {}", at[i]);
                    assert!((omega / own - 1.0).abs() < 1e-10, "{told}: {omega} for {own}");
                    assert!((d / own_d - 1.0).abs() < 1e-9, "{told}: {d} for {own_d}");
                }
            }
        }
    }
}
