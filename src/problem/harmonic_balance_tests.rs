//! Derivatives by the frequency against differences where contacts are so many that their slopes are made along the motion.

use super::*;
use crate::contact::Contact;
use crate::linalg::factors::lu::Lu;
use crate::linalg::norm;
use crate::linalg::sparse_storage::matrix_view::MatrixView;
use crate::model::Model;
use crate::model::matrices::structure::MatrixKind;
use crate::options::SolverOptions;
use crate::problem::Problem;
use crate::problem::homotopy::AlongPath;

const N: usize = 90;

/// A chain with a dashpot, so that factors make its flexibility, with a slider on each of the first masses. Weak springs between masses
/// that are up to `reach` apart make the factors dense.
fn chain(sliders: usize, reach: usize) -> Model {
    let mut model = Model::new(N).unwrap();
    let (mut m, mut c, mut k) = (vec![0.0; N * N], vec![0.0; N * N], vec![0.0; N * N]);
    for i in 0..N {
        m[i * N + i] = 1.0 + 0.3 * (i as f64).sin();
        c[i * N + i] = if i == 40 { 0.5 } else { 0.01 };
        k[i * N + i] = 8.0;
        if i > 0 {
            k[i * N + i - 1] = -3.9;
            k[(i - 1) * N + i] = -3.9;
        }
        for j in (i + 2..=i + reach).filter(|&j| j < N) {
            (k[i * N + j], k[j * N + i]) = (-1e-4, -1e-4);
        }
    }
    for (kind, values) in [
        (MatrixKind::Mass, &m),
        (MatrixKind::Damping, &c),
        (MatrixKind::Stiffness, &k),
    ] {
        model.set_matrix(kind, &MatrixView::dense(N, values)).unwrap();
    }
    for dof in 0..sliders {
        model.add_contact(&Contact::jenkins(dof, None, 1.0, 0.3, 0.5)).unwrap();
    }
    model.add_force(85, 1, Complex64::new(0.7, -0.2)).unwrap();
    model
}

#[test]
fn derivatives_by_the_frequency_are_differences_for_few_contacts_and_for_many() {
    let interrupt = Interrupt::none();
    let (range, omega) = ((1.0, 2.0).into(), 1.37);
    // Factors with few entries solve the columns of eight contacts side by side, and then make no slopes.
    let slender = [3, 7, 8, 64, 80].map(|sliders| (sliders, 0, sliders > 7));
    let dense = [3, 63, 64, 65, 80].map(|sliders| (sliders, 20, sliders > 64));
    for (sliders, reach, lacks_slopes) in slender.into_iter().chain(dense) {
        let model = chain(sliders, reach);
        let options = SolverOptions {
            harmonics: 3,
            ..SolverOptions::default()
        };
        let condensed = Condensed::new(&model, &options, range, &interrupt).unwrap();
        let mut problem = HarmonicBalance::new(&condensed, 88, range, 0, None, &interrupt).unwrap();
        let n = problem.unknowns();
        let u: Vec<f64> = (0..n).map(|i| 0.4 * (0.37 * (i * 13) as f64).sin()).collect();
        let mut direction = vec![0.0; n + 1];
        direction[n] = 1.0;
        let mut at = |omega: f64| {
            let mut out = Residual::new(n).unwrap();
            problem.evaluate(&u, omega, &mut out).unwrap();
            let (z, dz) = problem.observe(&u, &direction);
            assert_eq!(problem.tables.lacks_slopes(), lacks_slopes, "{sliders}, {reach}");
            (out.values, out.d_parameter, z, dz)
        };
        let h = 1e-5;
        let [here, below, above, far_below, far_above] = [0.0, -h, h, -2.0 * h, 2.0 * h].map(|step| at(omega + step));
        let size = here.1.iter().fold(0.0_f64, |m, d| m.max(d.abs()));
        for (i, d) in here.1.iter().enumerate() {
            let difference = (8.0 * (above.0[i] - below.0[i]) - (far_above.0[i] - far_below.0[i])) / (12.0 * h);
            assert!((d - difference).abs() < 1e-8 * size, "{sliders}: {d} {difference}");
        }
        let difference = ((above.2 - below.2) * 8.0 - (far_above.2 - far_below.2)) / (12.0 * h);
        assert!(
            (here.3 - difference).norm() < 1e-8 * here.3.norm(),
            "{sliders}: {} {difference}",
            here.3
        );
    }
}

#[test]
fn factors_by_terms_solve_newtons_matrix_of_a_slider_with_many_harmonics() {
    use crate::condense::test_chains::structure;
    use crate::linalg::newton::linear_system::dense::DenseSystem;
    use crate::linalg::newton::linear_system::{Border, LinearSystem};

    let interrupt = Interrupt::none();
    let mut model = structure(1, (0.0, 1e-3));
    model.add_contact(&Contact::jenkins(1, Some(4), 9.0, 0.3, 1.0)).unwrap();
    let options = SolverOptions {
        harmonics: 95,
        ..SolverOptions::default()
    };
    let condensed = Condensed::new(&model, &options, (0.3, 2.0), &interrupt).unwrap();
    let mut problem = HarmonicBalance::new(&condensed, 8, (0.3, 2.0).into(), 0, None, &interrupt).unwrap();
    let n = problem.unknowns();
    assert_eq!(n, 96);
    let mut system = DenseSystem::new(n).unwrap();
    let mut at = Residual::new(n).unwrap();
    let row: Vec<f64> = (0..=n).map(|i| (0.3 + i as f64).sin()).collect();
    // From motions that just slip to such that hardly stick, smooth and with a ring in a high harmonic.
    let (mut near, mut far) = (0, 0);
    for k in 0..48 {
        let size = 0.035 * 1.15_f64.powi(k);
        let ring = if k % 2 == 0 { 0.0 } else { 0.02 * size };
        let u: Vec<f64> = (0..n)
            .map(|i| {
                let h = (i / 2 * 2 + 1) as f64;
                size * (1.0 + i as f64).cos() / h.powi(3) + if i == 22 { ring } else { 0.0 }
            })
            .collect();
        problem.evaluate(&u, 0.4 + 0.02 * f64::from(k), &mut at).unwrap();
        if problem.forces.all_stuck() {
            continue;
        }
        let scales = (0.3, 2.0);
        let border = Border {
            column: &at.d_parameter,
            scales,
            row: &row,
        };
        system.update(&mut problem, border, &interrupt).unwrap();
        system.factor(&mut problem, &interrupt).unwrap();
        let b: Vec<f64> = (0..=n).map(|i| (0.7 * i as f64).cos()).collect();
        let mut x = b.clone();
        assert!(system.solve(&mut problem, 1e-12, &mut x, &interrupt).unwrap());
        // The bordered matrix by LU.
        let (mut matrix, mut active) = (vec![0.0; n * n], vec![true; n]);
        problem.fill(&mut matrix, &mut active).unwrap();
        let mut lu = Lu::new(n + 1, 1).unwrap();
        for j in 0..=n {
            let to = &mut lu.matrix()[j * (n + 1)..(j + 1) * (n + 1)];
            let (from, unit) = if j < n {
                (&matrix[j * n..(j + 1) * n], scales.0)
            } else {
                (&at.d_parameter[..], scales.1)
            };
            for (to, from) in to.iter_mut().zip(from) {
                *to = unit * from;
            }
            to[n] = row[j];
        }
        lu.factor(&interrupt).unwrap();
        let mut expected = b;
        lu.solve(&mut expected);
        let largest = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for (x, expected) in x.iter().zip(&expected) {
            assert!((x - expected).abs() < 1e-10 * largest, "{k}: {x} {expected}");
        }
        assert_eq!(system.is_positive(), lu.is_positive(), "{k}");
        if problem.near_diagonal(&mut vec![Complex64::ZERO; n / 2]) {
            near += 1;
        } else {
            far += 1;
        }
    }
    assert!(near > 8 && far > 4, "{near} near, {far} far");
}

/// The equations of exchanged motions with a mass: of a stick and a slip, of slip that reverses, and with forces that are late.
#[test]
fn derivatives_of_sliding_masses_are_differences() {
    let interrupt = Interrupt::none();
    let (range, omega) = ((1.0, 2.0).into(), 1.37);
    let mut shares = Vec::new();
    for kt in [f64::INFINITY, 4e6] {
        let mut model = chain(0, 0);
        model.add_contact(&Contact::jenkins(2, None, kt, 0.3, 0.5)).unwrap();
        let options = SolverOptions {
            harmonics: 9,
            exchange: crate::options::Exchanged::NearRigid,
            ..SolverOptions::default()
        };
        let condensed = Condensed::new(&model, &options, range, &interrupt).unwrap();
        let exchange = condensed.exchange_of(0).unwrap();
        assert!(exchange.mass_at.is_some());
        let at_limit = 0.15 / exchange.stiffness / condensed.length();
        let mut problem = HarmonicBalance::new(&condensed, 88, range, 0, None, &interrupt).unwrap();
        let n = problem.unknowns();
        for size in [1.3, 2.0, 5.0, 20.0] {
            let fall = |i: usize| (0.6 + 0.37 * (i * 13) as f64).sin() / (1.0 + (i / 2) as f64).powi(2);
            let u: Vec<f64> = (0..n).map(|i| size * at_limit * fall(i)).collect();
            let mut out = Residual::new(n).unwrap();
            let (mut filled, mut active) = (vec![0.0; n * n], vec![true; n]);
            problem.evaluate(&u, omega, &mut out).unwrap();
            problem.fill(&mut filled, &mut active).unwrap();
            shares.push(problem.slip_fractions()[0]);
            let largest = filled.iter().fold(0.0_f64, |m, d| m.max(d.abs()));
            let by_omega = out.d_parameter.clone();
            let step = 1e-6 * at_limit;
            let mut beside = |step: f64| {
                problem.evaluate(&u, omega + step, &mut out).unwrap();
                out.values.clone()
            };
            let [below, above] = [-1e-6, 1e-6].map(&mut beside);
            let largest_by_omega = by_omega.iter().fold(0.0_f64, |m, d| m.max(d.abs()));
            for i in 0..n {
                let difference = (above[i] - below[i]) / 2e-6;
                assert!(
                    (by_omega[i] - difference).abs() < 1e-6 * largest_by_omega,
                    "{kt:e}, {size}, {i} by omega: {} for {difference}",
                    by_omega[i]
                );
            }
            for j in 0..n {
                let mut at = |step: f64| {
                    let mut moved = u.clone();
                    moved[j] += step;
                    problem.evaluate(&moved, omega, &mut out).unwrap();
                    out.values.clone()
                };
                let [below, above] = [-step, step].map(&mut at);
                for i in 0..n {
                    let (found, difference) = (filled[j * n + i], (above[i] - below[i]) / (2.0 * step));
                    assert!(
                        (found - difference).abs() < 1e-5 * largest,
                        "{kt:e}, {size}, {i}, {j}: {found} for {difference}"
                    );
                }
            }
        }
    }
    assert!(shares.iter().any(|s| *s > 0.05 && *s < 0.95), "{shares:?}");
    assert!(shares.iter().any(|s| *s > 0.999), "{shares:?}");
}

/// Contacts that become stiffer: the derivatives of the residual by ln σ and by the motions, below and above the number of coordinates
/// from which products are taken as a whole.
#[test]
fn derivatives_along_the_stiffness_of_contacts_are_differences() {
    let interrupt = Interrupt::none();
    let (range, omega, p) = ((1.0, 2.0).into(), 1.37, -0.8_f64);
    for sliders in [1, 3, 20] {
        let model = chain(sliders, 0);
        let options = SolverOptions {
            harmonics: 3,
            ..SolverOptions::default()
        };
        let condensed = Condensed::new(&model, &options, range, &interrupt).unwrap();
        let mut problem = HarmonicBalance::new(&condensed, 88, range, 0, None, &interrupt).unwrap();
        let n = problem.unknowns();
        let u: Vec<f64> = (0..n).map(|i| 0.9 * (0.37 * (i * 13) as f64).sin()).collect();
        let mut out = Residual::new(n).unwrap();
        let mut at = |problem: &mut HarmonicBalance<'_>, u: &[f64], p: f64| {
            problem.evaluate_along(Path::Stiffening, omega, u, p, &mut out).unwrap();
            (out.values.clone(), out.d_parameter.clone())
        };
        let (_, by_p) = at(&mut problem, &u, p);
        let (mut filled, mut active) = (vec![0.0; n * n], vec![true; n]);
        problem.fill(&mut filled, &mut active).unwrap();
        let step = 1e-6;
        let (below, above) = (at(&mut problem, &u, p - step).0, at(&mut problem, &u, p + step).0);
        let size = norm(&by_p);
        assert!(size > 1e-3, "{size:e}");
        for i in 0..n {
            let difference = (above[i] - below[i]) / (2.0 * step);
            assert!((by_p[i] - difference).abs() < 1e-6 * size, "{sliders}, {i}");
        }
        for j in (0..n).step_by(1 + n / 8) {
            let mut moved = |step: f64| {
                let mut u = u.clone();
                u[j] += step;
                at(&mut problem, &u, p).0
            };
            let (below, above) = (moved(-step), moved(step));
            for i in 0..n {
                let difference = (above[i] - below[i]) / (2.0 * step);
                assert!((filled[j * n + i] - difference).abs() < 1e-6, "{sliders}, {i}, {j}");
            }
        }
    }
}
