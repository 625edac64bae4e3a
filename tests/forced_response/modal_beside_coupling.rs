//! Damping ratios of a few modes beside forces that couple the modes: gyroscopic ones, a structural matrix, a complex stiffness and a speed
//! that follows the frequency. Factors without the modal damping and a term of low rank respond as factors of the whole matrix do, which is
//! given as a matrix from closed forms of the modes, with sliding contacts, next to resonances and between them.

use crate::common::{harmonics, omega_range};
use hbvib::{Contact, Hooks, MatrixKind, MatrixView, Model, Part, SolverOptions, Speed, forced_response};
use num_complex::Complex64;
use std::f64::consts::PI;

/// Forces that couple the modes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Coupling {
    Gyroscopic,
    Tied,
    Structural,
    Complex,
}

const MODES: usize = 6;
const SPRING: f64 = 1e4;

/// Natural frequency of the k-th mode, from 1 on, of a chain of `n` unit masses between walls.
fn natural(n: usize, k: usize) -> f64 {
    2.0 * SPRING.sqrt() * (k as f64 * PI / 2.0 / (n + 1) as f64).sin()
}

/// A chain with two sliders, and damping ratios of its lowest modes: by their directions, or as a full matrix where `is_whole`.
fn chain(n: usize, coupling: Coupling, ratio: f64, is_whole: bool) -> Model {
    let mut model = Model::new(n).unwrap();
    let (mut m, mut k, mut g, mut d) = (
        vec![0.0; n * n],
        vec![Complex64::ZERO; n * n],
        vec![0.0; n * n],
        vec![0.0; n * n],
    );
    for i in 0..n {
        m[i * n + i] = 1.0;
        let lost = if coupling == Coupling::Complex && i % 3 == 0 {
            4.0 + (i % 5) as f64
        } else {
            0.0
        };
        k[i * n + i] = Complex64::new(2.0 * SPRING, lost);
        d[i * n + i] = 0.3 + 0.1 * (i % 7) as f64;
        if i > 0 {
            (k[i * n + i - 1], k[(i - 1) * n + i]) = ((-SPRING).into(), (-SPRING).into());
            (g[i * n + i - 1], g[(i - 1) * n + i]) = (0.05, -0.05);
        }
    }
    model.set_matrix(MatrixKind::Mass, &MatrixView::dense(n, &m)).unwrap();
    if coupling == Coupling::Complex {
        model
            .set_matrix(
                MatrixKind::Stiffness,
                &MatrixView::dense_complex(n, &k).part(Part::Symmetric),
            )
            .unwrap();
    } else {
        let real: Vec<f64> = k.iter().map(|z| z.re).collect();
        model
            .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(n, &real))
            .unwrap();
    }
    match coupling {
        Coupling::Gyroscopic | Coupling::Tied => {
            model
                .set_matrix(MatrixKind::Gyroscopic, &MatrixView::dense(n, &g))
                .unwrap();
            model
                .set_speed(if coupling == Coupling::Tied {
                    Speed::PerOmega(0.7)
                } else {
                    Speed::Fixed(1.0)
                })
                .unwrap();
        }
        Coupling::Structural => model
            .set_matrix(MatrixKind::Structural, &MatrixView::dense(n, &d))
            .unwrap(),
        Coupling::Complex => {}
    }
    if is_whole {
        let shape = |r: usize, i: usize| {
            (2.0 / (n + 1) as f64).sqrt() * (r as f64 * (i + 1) as f64 * PI / (n + 1) as f64).sin()
        };
        let mut c = vec![0.0; n * n];
        for r in 1..=MODES {
            for j in 0..n {
                for i in 0..n {
                    c[j * n + i] += 2.0 * ratio * natural(n, r) * shape(r, i) * shape(r, j);
                }
            }
        }
        model
            .set_matrix(MatrixKind::Damping, &MatrixView::dense(n, &c))
            .unwrap();
    } else {
        model.set_modal_damping(&[ratio; MODES]).unwrap();
    }
    for dof in [n / 5, 2 * n / 3] {
        model
            .add_contact(&Contact::jenkins(dof, None, 100.0, 0.9, 1.0))
            .unwrap();
    }
    model.add_force(3 * n / 8, 1, Complex64::new(5.0, 1.0)).unwrap();
    model
}

/// Largest difference of all harmonics of all degrees of freedom at a frequency, relative to the largest motion.
fn departure(models: [&Model; 2], omega: f64) -> f64 {
    let motion = |model: &Model| {
        let solver = SolverOptions {
            tol_residual: 1e-12,
            ..harmonics(5)
        };
        let branch = forced_response(model, &solver, &omega_range(omega, omega), &mut Hooks::default()).unwrap();
        let mut x = vec![Complex64::ZERO; (branch.harmonics() + 1) * branch.ndof()];
        branch.harmonics_at(0, &mut x).unwrap();
        x
    };
    let [a, b] = models.map(motion);
    let largest = b.iter().map(|z| z.norm()).fold(0.0, f64::max);
    a.iter().zip(&b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / largest
}

#[test]
fn points_are_those_of_the_whole_matrix() {
    for n in [10, 33, 101, 200] {
        for coupling in [
            Coupling::Gyroscopic,
            Coupling::Tied,
            Coupling::Structural,
            Coupling::Complex,
        ] {
            for ratio in [1e-5, 1e-2] {
                let (own, whole) = (chain(n, coupling, ratio, false), chain(n, coupling, ratio, true));
                for omega in [natural(n, 1), 1.37 * natural(n, 1), 2.9 * natural(n, 1)] {
                    let off = departure([&own, &whole], omega);
                    // At a resonance the rounding of the stiffness counts by the width of its peak.
                    let width = 2.0 * ratio * natural(n, 1).powi(2);
                    let allowed = 1e-10 + 20.0 * f64::EPSILON * 4.0 * SPRING / width;
                    assert!(off < allowed, "{n}, {coupling:?}, {ratio:e}, {omega}: {off:e}");
                }
            }
        }
    }
}
