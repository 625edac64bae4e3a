//! The cubic spring on prescribed motions, and what every law promises about easing.

use crate::common::relative_gap;
use hbvib::internals::HarmonicSet;
use hbvib::internals::Law;
use hbvib::internals::Range;
use hbvib::internals::{Evaluation, Evaluator};
use hbvib::{Contact, Interrupt, contact_evaluate};
use num_complex::Complex64;
use std::f64::consts::TAU;

const KT: f64 = 0.7;
const K3: f64 = -2.3;

/// A packed motion rich in harmonics, in numbers of size 1.
fn motion(set: &HarmonicSet, seed: usize) -> Vec<f64> {
    (0..set.packed_len())
        .map(|i| ((i * 37 + seed * 11 + 5) as f64 * 0.61).sin() / (1.0 + 0.2 * i as f64))
        .collect()
}

/// Odd, full and sparse sets of harmonics up to `highest`.
fn sets(highest: usize) -> [HarmonicSet; 4] {
    let excited = |forced: &[usize], odd| HarmonicSet::excited(forced, highest, true, odd, false).unwrap();
    [
        excited(&[1], true),
        excited(&[1], false),
        excited(&[3], true),
        HarmonicSet::all(highest).unwrap(),
    ]
}

fn evaluate(law: &dyn Law, set: &HarmonicSet, samples: usize, motion: &[f64]) -> Evaluation {
    let mut out = Evaluation::new(set, 1).unwrap();
    let mut evaluator = Evaluator::new(set, samples, std::iter::once(law)).unwrap();
    evaluator.prepare(set, motion, &Interrupt::none()).unwrap();
    evaluator
        .evaluate(law, set, motion, 1.0, &mut out, &Interrupt::none())
        .unwrap();
    out
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m, x| m.max(x.abs()))
}

fn gap(a: &[f64], b: &[f64]) -> f64 {
    let difference: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    largest(&difference) / largest(b)
}

/// Packed coefficients of g(x(τ)) by the trapezoidal rule, exact for polynomials of few harmonics.
fn quadrature(set: &HarmonicSet, motion: &[f64], g: impl Fn(f64) -> f64) -> Vec<f64> {
    let n = 4096;
    let mut row = vec![0.0; motion.len()];
    let mut sums = vec![0.0; motion.len()];
    for j in 0..n {
        set.basis(TAU * f64::from(j) / f64::from(n), &mut row);
        let f = g(row.iter().zip(motion).map(|(c, x)| c * x).sum());
        for (i, (s, c)) in sums.iter_mut().zip(&row).enumerate() {
            let weight = if set.has_mean() && i == 0 { 1.0 } else { 2.0 };
            *s += weight * f * c / f64::from(n);
        }
    }
    sums
}

#[test]
fn the_harmonics_of_the_force_are_those_of_the_polynomial() {
    for highest in [3, 9, 40] {
        for (which, set) in sets(highest).iter().enumerate() {
            for (kt, k3) in [(KT, K3), (0.0, 1.9), (KT, 0.0), (3.0, 1e-9)] {
                let x = motion(set, which + highest);
                let law = Contact::cubic(0, None, kt, k3).law(1.0).unwrap();
                let expected = quadrature(set, &x, |x| kt * x + k3 * x * x * x);
                for samples in [0, 2 * highest + 1, 1024] {
                    let found = evaluate(&*law, set, samples, &x);
                    let gap = gap(&found.force, &expected);
                    assert!(gap < 1e-13, "H = {highest}, set {which}, {samples} samples: {gap:.1e}");
                    assert!(found.slip_fraction == 0.0 && !found.stuck);
                }
            }
        }
    }
}

#[test]
fn one_harmonic_sees_the_describing_function() {
    let x = Complex64::from_polar(1.7, 0.4);
    let motion = [Complex64::ZERO, x];
    let mut f = [Complex64::ZERO; 2];
    contact_evaluate(&Contact::cubic(0, None, KT, K3), 1, 0, 1.0, &motion, &mut f, None).unwrap();
    let expected = [Complex64::ZERO, (KT + 0.75 * K3 * x.norm_sqr()) * x];
    assert!(relative_gap(&f, &expected) < 1e-15);
    // About a mean: (x₀ + y)³ has the mean x₀³ + ³⁄₂ x₀ A².
    let mean = 0.3;
    contact_evaluate(
        &Contact::cubic(0, None, KT, K3),
        1,
        0,
        1.0,
        &[mean.into(), x],
        &mut f,
        None,
    )
    .unwrap();
    let static_force = KT * mean + K3 * (mean.powi(3) + 1.5 * mean * x.norm_sqr());
    assert!((f[0].re - static_force).abs() < 1e-14 && f[0].im == 0.0);
}

#[test]
fn units_of_length_do_not_matter() {
    let length = 1.0 / 1024.0;
    let contact = Contact::cubic(0, None, KT, K3);
    let set = HarmonicSet::all(5).unwrap();
    let x = motion(&set, 3);
    let scaled: Vec<f64> = x.iter().map(|x| x / length).collect();
    let mut expected = evaluate(&*contact.law(1.0).unwrap(), &set, 0, &x).force;
    let found = evaluate(&*contact.law(length).unwrap(), &set, 0, &scaled).force;
    for f in &mut expected {
        *f /= length;
    }
    assert!(gap(&found, &expected) < 1e-15);
}

#[test]
fn the_offset_is_the_slope_of_the_law_as_seen_at_a_smaller_motion() {
    let laws = [
        Contact::cubic(0, None, KT, K3),
        Contact::cubic(0, None, 0.0, 1.9),
        Contact::jenkins(0, None, 1.3, 0.5, 0.8),
    ];
    for set in sets(9) {
        for contact in &laws {
            let law = contact.law(1.0).unwrap();
            let x = motion(&set, 1);
            let seen = |s: f64| {
                let smaller: Vec<f64> = x.iter().map(|x| x / s).collect();
                let mut found = evaluate(&*law, &set, 0, &smaller);
                for part in [&mut found.force, &mut found.offset] {
                    for f in part.iter_mut() {
                        *f *= s;
                    }
                }
                found
            };
            for factor in [0.6_f64, 1.0, 1.7] {
                let h = 1e-5;
                let found = seen(factor);
                let (above, below) = (seen(factor * f64::exp(h)).force, seen(factor * f64::exp(-h)).force);
                for ((offset, a), b) in found.offset.iter().zip(&above).zip(&below) {
                    let slope = (a - b) / (2.0 * h);
                    assert!(
                        (offset - slope).abs() < 1e-7 * largest(&found.force),
                        "{offset} {slope}"
                    );
                }
            }
        }
    }
}

#[test]
fn far_from_its_cubic_term_the_spring_is_linear() {
    let set = HarmonicSet::all(5).unwrap();
    let x = motion(&set, 2);
    let law = Contact::cubic(0, None, KT, K3).law(1.0).unwrap();
    // The homotopy begins where the cubic term is tiny against the reference.
    let reference = 5.0;
    let range = Range {
        half: 1.5,
        mean: -0.5,
        speed: 0.0,
    };
    let factor = law.linearisation_scale(&[range], reference);
    let term = K3.abs() * (2.0 / factor).powi(2);
    assert!((term / reference / 1e-12 - 1.0).abs() < 1e-12);
    let smaller: Vec<f64> = x.iter().map(|x| x / factor).collect();
    let found = evaluate(&*law, &set, 0, &smaller);
    let spring: Vec<f64> = smaller.iter().map(|x| KT * x).collect();
    assert!(gap(&found.force, &spring) < 1e-10 && largest(&found.offset) < 1e-10 * largest(&spring));
}
