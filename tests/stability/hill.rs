//! Hill's method, which is right for laws without memory, finds the multipliers of the flow.

use crate::common::models::dense;
use crate::common::{all_harmonics, harmonics, solve_at};
use crate::{multipliers, ordinary};
use hbvib::{Contact, ContactKind, Model, Polynomial, Waves};
use nalgebra::{DMatrix, Schur};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Tangents of a law by its motion and by its velocity.
type Tangents = fn(f64, f64) -> (f64, f64);

/// Structure without contacts: masses, damping and stiffness.
struct Plain {
    mass: Vec<f64>,
    damping: Vec<f64>,
    stiffness: Vec<f64>,
}

fn one() -> Plain {
    Plain {
        mass: vec![1.0],
        damping: vec![0.08],
        stiffness: vec![1.0],
    }
}

fn two() -> Plain {
    Plain {
        mass: vec![1.0, 0.6],
        damping: vec![0.06, -0.02, -0.02, 0.05],
        stiffness: vec![1.5, -0.5, -0.5, 1.1],
    }
}

impl Plain {
    fn model(&self, contact: &Contact, force: f64) -> Model {
        let n = self.mass.len();
        let mut mass = vec![0.0; n * n];
        for (i, m) in self.mass.iter().enumerate() {
            mass[i * n + i] = *m;
        }
        dense(&mass, &self.stiffness)
            .damping(&self.damping)
            .contact(contact)
            .force(0, 1, force)
            .build()
    }
}

/// e^{λT} of the exponents λ in the strip next to the real axis, from the tangents along a motion x.
fn hill(
    plain: &Plain,
    (x, row): (&[Complex64], &[f64]),
    tangents: Tangents,
    omega: f64,
    highest: i64,
) -> Vec<Complex64> {
    const SAMPLES: usize = 1 << 13;
    let n = plain.mass.len();
    let count = 2 * highest + 1;
    let mut coefficients = vec![(Complex64::ZERO, Complex64::ZERO); (2 * count + 1) as usize];
    for k in 0..SAMPLES {
        let tau = TAU * k as f64 / SAMPLES as f64;
        let (mut y, mut v) = (0.0, 0.0);
        for (h, all) in x.chunks_exact(n).enumerate() {
            let turned: Complex64 =
                all.iter().zip(row).map(|(x, r)| r * x).sum::<Complex64>() * Complex64::cis(h as f64 * tau);
            y += turned.re;
            v -= h as f64 * omega * turned.im;
        }
        let (by_y, by_v) = tangents(y, v);
        for (d, (a, b)) in coefficients.iter_mut().enumerate() {
            let turn = Complex64::cis(-(d as f64 - count as f64) * tau) / SAMPLES as f64;
            (*a, *b) = (*a + by_y * turn, *b + by_v * turn);
        }
    }
    let size = count as usize * n;
    let mut a = DMatrix::<Complex64>::zeros(2 * size, 2 * size);
    for h in -highest..=highest {
        for l in -highest..=highest {
            let (by_y, by_v) = coefficients[(h - l + count) as usize];
            let at = |h: i64, i: usize| (h + highest) as usize * n + i;
            for i in 0..n {
                for j in 0..n {
                    let (r, c) = (at(h, i), at(l, j));
                    let both = row[i] * row[j];
                    let rate = Complex64::new(0.0, l as f64 * omega);
                    let (mut k, mut d) = (both * (by_y + by_v * rate), both * by_v);
                    if h == l {
                        k += plain.stiffness[j * n + i] + rate * plain.damping[j * n + i];
                        d += plain.damping[j * n + i];
                        if i == j {
                            k += rate * rate * plain.mass[i];
                            d += 2.0 * rate * plain.mass[i];
                        }
                    }
                    a[(size + r, c)] = -k / plain.mass[i];
                    a[(size + r, size + c)] = -d / plain.mass[i];
                }
            }
        }
    }
    for i in 0..size {
        a[(i, size + i)] = Complex64::ONE;
    }
    let (_, triangle) = Schur::new(a).unpack();
    let all = (0..2 * size).map(|i| triangle[(i, i)]);
    all.filter(|z| z.im.abs() < 0.6 * omega)
        .map(|z| (z * TAU / omega).exp())
        .collect()
}

/// A law between two masses or one and the ground.
struct Case {
    name: &'static str,
    plain: Plain,
    contact: Contact,
    row: &'static [f64],
    tangents: Tangents,
    force: f64,
    omega: f64,
    bound: f64,
}

fn cases() -> Vec<Case> {
    let damper = Polynomial::scalar(&[0.1, 0.0, 0.3], &[0.05, 0.0, 0.1]).unwrap();
    let case = |name, plain, contact, row, tangents, (force, omega)| Case {
        name,
        plain,
        contact,
        row,
        tangents,
        force,
        omega,
        bound: 1e-9,
    };
    vec![
        case(
            "cubic",
            one(),
            Contact::cubic(0, None, 0.2, 0.3),
            &[1.0],
            |y, _| (0.2 + 0.9 * y * y, 0.0),
            (0.5, 1.6),
        ),
        case(
            "softening",
            two(),
            Contact::cubic(1, None, 0.1, -0.05),
            &[0.0, 1.0],
            |y, _| (0.1 - 0.15 * y * y, 0.0),
            (0.3, 0.7),
        ),
        case(
            "polynomial",
            two(),
            Contact::between(0, Some(1), ContactKind::Polynomial(damper)),
            &[1.0, -1.0],
            |y, v| (0.1 + 0.9 * y * y, 0.05 + 0.3 * v * v),
            (0.6, 1.2),
        ),
        case(
            "smooth friction",
            two(),
            Contact::regularised(0, Some(1), 0.5, 0.4, 0.5),
            &[1.0, -1.0],
            |_, v| (0.0, 0.4 / (v / 0.5).cosh().powi(2)),
            (0.5, 1.0),
        ),
        // The tangent jumps, so that its harmonics fall off slowly.
        Case {
            bound: 2e-4,
            ..case(
                "stop",
                one(),
                Contact::unilateral(Some(0), None, 2.0, 0.1),
                &[1.0],
                |y, _| (if y < -0.1 { 2.0 } else { 0.0 }, 0.0),
                (0.5, 2.0),
            )
        },
    ]
}

#[test]
fn laws_without_memory_have_the_multipliers_of_hill() {
    for case in cases() {
        let (name, omega) = (case.name, case.omega);
        let model = case.plain.model(&case.contact, case.force);
        let branch = solve_at(&model, &harmonics(25), omega);
        let expected = ordinary(&multipliers(&model, &branch, 0, Waves::Wave));
        let motion = all_harmonics(&branch, 0);
        let found = hill(&case.plain, (&motion, case.row), case.tangents, omega, 20);
        assert_eq!(expected.len(), 2 * case.plain.mass.len());
        for mu in &expected {
            let gap = found.iter().map(|z| (z - mu).norm()).fold(f64::INFINITY, f64::min);
            println!("{name}: {mu:.9}, {gap:.1e} off");
            assert!(gap < case.bound, "{name}: {mu} {gap:.1e}");
        }
    }
}
