//! Tests of the flexibility of nonlinear modes.

use super::*;
use crate::condense::by_modes::wave_cache::SharedWaves;
use crate::condense::test_chains::{DAMPED, N, chain, long_chain, real_wheel, structure};
use crate::contact::Contact;
use crate::model::Model;
use crate::options::{DampingForm, SolverOptions};

fn norm(z: &[Complex64]) -> f64 {
    z.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt()
}

/// Compares all that sums give with factorisations, at points (ω, D).
fn compare(model: &Model, form: DampingForm, (harmonics, allowed): (usize, f64), points: &[(f64, f64)], case: &str) {
    let n = model.ndof();
    let reference_dof = n.min(5) - 1;
    let shape: Vec<Complex64> = (0..n).map(|i| Complex64::new(1.0 + i as f64, 0.3)).collect();
    let options = SolverOptions {
        harmonics,
        ..SolverOptions::default()
    };
    let (direct, _) = Condensed::for_mode(model, &options, (form, false), &shape, &Interrupt::none()).unwrap();
    let quick = SharedWaves::default()
        .attach(model, direct.clone(), &Interrupt::none())
        .unwrap();
    assert!(quick.blocks().iter().all(|b| b.source.is_some()), "{case}");
    let [mut by_sums, mut exact] = [&quick, &direct].map(|c| ModeFlexibility::new(c, reference_dof).unwrap());
    let w: Vec<Complex64> = (0..direct.coordinates())
        .map(|c| Complex64::new(1.0 - c as f64, 0.4))
        .collect();
    for i in 0..direct.blocks().len() {
        for &at in points {
            let case = format!("{case}, {form:?}, harmonic {i} at {at:?}");
            let damped = DampedFrequency::new(at.0, at.1);
            let solve = |of: &mut ModeFlexibility, c| of.solve(c, i, damped, &w, &Interrupt::none()).unwrap();
            solve(&mut by_sums, &quick);
            solve(&mut exact, &direct);
            assert!(by_sums.by_sums == Some(i) && exact.by_sums.is_none(), "{case}");
            let check = |name: &str, a: &[Complex64], b: &[Complex64], size: f64| {
                let error = off(a, b) * norm(b) / size;
                assert!(error <= allowed, "{name}, {case}: {error:e}");
            };
            let mut x = by_sums.x.clone();
            if by_sums.is_of_modes() {
                by_sums.expand(i, &by_sums.x, &mut x, &mut vec![Complex64::ZERO; n]);
            }
            let largest = exact.largest();
            assert!(by_sums.largest() >= (1.0 - 1e-9) * largest, "{case}");
            check("x", &x, &exact.x, norm(&exact.x));
            check("flexibility", &by_sums.value, &exact.value, norm(&exact.value));
            for k in 0..3 {
                let part = k * w.len()..(k + 1) * w.len();
                let (a, b) = (&by_sums.relative[part.clone()], &exact.relative[part]);
                check("relative motion", a, b, norm(b));
            }
            // The normalisation is that of the fundamental.
            if direct.blocks()[i].number != 1 {
                continue;
            }
            let weighted: Vec<Complex64> = exact.x.iter().map(|x| x * 0.7).collect();
            by_sums.fix_gauge(&weighted);
            exact.fix_gauge(&weighted);
            // Far above the frequencies of a chain one end moves far less than the other.
            let known = exact.direct.as_ref().unwrap();
            for (k, size) in [norm(&weighted), 1.0].into_iter().enumerate() {
                let columns = |of: &ModeFlexibility| of.gauge.of_columns.iter().map(|z| z[k]).collect::<Vec<_>>();
                let (a, b) = (columns(&by_sums), columns(&exact));
                check("columns in the gauge", &a, &b, size * norm(&known.columns));
                let rates = |of: &ModeFlexibility| of.gauge.of_rates.map(|z| z[k]);
                let largest = known.rates.iter().map(|rate| norm(rate)).fold(0.0, f64::max);
                check("rates in the gauge", &rates(&by_sums), &rates(&exact), size * largest);
            }
        }
    }
}

#[test]
fn sums_of_a_nonlinear_mode_are_its_factorisations() {
    let points = [(0.05, 0.0), (0.4, 0.02), (1.3, -0.1), (2.7, 0.3), (9.0, 1e-4)];
    for (sectors, form) in [1, 24]
        .into_iter()
        .flat_map(|n| [(n, DampingForm::Mass), (n, DampingForm::Stiffness)])
    {
        // With several contacts, and with one.
        for ((damping, loss_factor), single) in DAMPED.into_iter().flat_map(|d| [(d, false), (d, true)]) {
            let mut model = if single {
                let mut model = structure(sectors, damping);
                model.add_contact(&Contact::jenkins(1, Some(4), 9.0, 0.3, 1.0)).unwrap();
                model
            } else {
                chain(sectors, damping)
            };
            model.set_loss_factor(loss_factor).unwrap();
            assert_eq!(model.ndof(), N);
            let case = format!("{sectors} sectors, {damping:?}, {loss_factor}");
            compare(&model, form, (5, 1e-10), &points, &case);
        }
    }
}

/// Where the matrices of a wave are those of the wave that travels the other way, its rows are not.
#[test]
fn sums_of_waves_that_share_real_matrices_are_their_factorisations() {
    for (damping, loss_factor) in DAMPED {
        for form in [DampingForm::Mass, DampingForm::Stiffness] {
            let mut model = real_wheel(damping);
            model.set_loss_factor(loss_factor).unwrap();
            let case = format!("{damping:?}, {loss_factor}");
            compare(&model, form, (9, 1e-10), &[(0.4, 0.02), (1.3, -0.1)], &case);
        }
    }
}

/// Below, at and beside the lowest frequencies, and far above; with few contacts and with so many that stiff modes are a series.
#[test]
fn sums_of_long_chains_are_their_factorisations() {
    for n in [10, 33, 101, 200] {
        for (contacts, (damping, loss_factor)) in [(1, DAMPED[0]), (9, DAMPED[2]), (9, DAMPED[4])] {
            for form in [DampingForm::Mass, DampingForm::Stiffness] {
                let mut model = long_chain(n, contacts, damping);
                model.set_loss_factor(loss_factor).unwrap();
                let lowest = std::f64::consts::PI / (n + 1) as f64;
                let points = [0.3, 1.1, 2.9, 40.0].map(|f| (f * lowest, 1e-3 * f));
                let case = format!("{n} masses, {contacts} contacts, {damping:?}, {loss_factor}");
                compare(&model, form, (3, 1e-10), &points, &case);
            }
        }
    }
}
