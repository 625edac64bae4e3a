//! Polynomial laws: what their terms say, exactly sampled, against the cubic spring and dense sums.

use crate::common::pointwise::{
    at_one_time, coupled, dense, evaluate, evaluate_with, gap, largest, mixed, motion, quintic, sets, suits, tensor,
    term, van_der_pol,
};
use hbvib::internals::HarmonicSet;
use hbvib::internals::Law;
use hbvib::internals::Memoryless;
use hbvib::internals::{Evaluation, Evaluator};
use hbvib::{Contact, Interrupt, Polynomial};

#[test]
fn a_cubic_polynomial_is_the_cubic_spring() {
    let (kt, k3) = (0.7, -2.3);
    let law = Polynomial::scalar(&[kt, 0.0, k3], &[]).unwrap();
    let spring = Contact::cubic(0, None, kt, k3).law(1.0).unwrap();
    for highest in [3, 9, 40, 63] {
        for (which, set) in sets(highest).iter().enumerate() {
            let x = motion(set, 1, which + highest);
            let mut expected = Evaluation::new(set, 1).unwrap();
            let mut evaluator = Evaluator::new(set, 0, std::iter::once(&*spring)).unwrap();
            evaluator.prepare(set, &x, &Interrupt::none()).unwrap();
            evaluator
                .evaluate(&*spring, set, &x, 1.3, &mut expected, &Interrupt::none())
                .unwrap();
            let found = evaluate(&law, set, 1.3, &x);
            for (a, b) in [
                (&found.force, &expected.force),
                (&found.jacobian, &expected.jacobian),
                (&found.offset, &expected.offset),
            ] {
                assert!(gap(a, b) < 1e-14, "H = {highest}, set {which}: {:.1e}", gap(a, b));
            }
        }
    }
}

#[test]
fn harmonics_of_polynomials_are_those_of_dense_sampling() {
    let omega = 0.8;
    let laws = [van_der_pol(), quintic(), coupled(), mixed()];
    for (law, name) in laws.iter().zip(["van der Pol", "quintic", "coupled", "mixed"]) {
        for (which, set) in sets(6).iter().enumerate().filter(|(_, set)| suits(law, set)) {
            let d = law.directions();
            let x = motion(set, d, which);
            let found = evaluate(law, set, omega, &x);
            let expected = dense(set, d, omega, &x, |u, v| at_one_time(law, omega, u, v));
            let gap = gap(&found.force, &expected);
            assert!(gap < 1e-12, "{name}, set {which}: {gap:.1e}");
        }
    }
}

#[test]
fn a_polynomial_is_the_sum_that_its_terms_say() {
    let (u, v) = ([0.7, -1.1, 0.4], [0.3, 0.9, -0.6]);
    let (k1, k2, k3) = (tensor(9, 1), tensor(27, 2), tensor(81, 3));
    let f = at_one_time(&coupled(), 1.0, &u, &v);
    for i in 0..3 {
        let mut expected = 0.0;
        for j in 0..3 {
            expected += k1[3 * i + j] * u[j];
            for k in 0..3 {
                expected += k2[9 * i + 3 * j + k] * u[j] * u[k];
                for l in 0..3 {
                    expected += k3[27 * i + 9 * j + 3 * k + l] * u[j] * u[k] * u[l];
                }
            }
        }
        assert!((f[i] - expected).abs() < 1e-14);
    }
    let f = at_one_time(&mixed(), 1.0, &u[..2], &v[..2]);
    let first = 0.8 * u[0] * u[1] * u[1] * v[1] - 0.3 * v[0] * v[0];
    let second = 0.6 * u[0].powi(3) + 0.5 * u[1] * v[0] * v[1];
    assert!((f[0] - first).abs() < 1e-15 && (f[1] - second).abs() < 1e-15);
    let f = at_one_time(&quintic(), 1.0, &u[..1], &v[..1]);
    let spring = 0.3 * u[0] - 0.5 * u[0].powi(3) + 0.8 * u[0].powi(5);
    assert!((f[0] - spring - 0.05 * v[0] - 0.02 * v[0].powi(3)).abs() < 1e-15);
}

#[test]
fn more_samples_than_a_polynomial_asks_for_change_nothing() {
    for law in [van_der_pol(), quintic(), coupled(), mixed()] {
        for set in sets(7).iter().filter(|set| suits(&law, set)) {
            let x = motion(set, law.directions(), 3);
            let highest = set.highest_reduced();
            let least = law.samples(highest, 0);
            assert_eq!(least, (law.degree() as usize + 1) * highest + 1);
            let exact = evaluate(&law, set, 0.9, &x);
            // A fast transform has the last.
            for n in [least + 1, least + 6, 8192] {
                let more = evaluate_with(n, &law, set, 0.9, &x);
                assert!(gap(&more.force, &exact.force) < 1e-13);
                assert!(gap(&more.jacobian, &exact.jacobian) < 1e-13);
            }
            // Fewer are too few: some harmonic is mistaken for another.
            let fewer = evaluate_with(2 * highest + 1, &law, set, 0.9, &x);
            assert!(gap(&fewer.jacobian, &exact.jacobian) > 1e-3);
        }
    }
}

/// A stiffness from a potential V: fᵢ = ∂V/∂xᵢ, so its tensors are symmetric in all indices.
#[test]
fn a_potential_gives_a_symmetric_jacobian() {
    let d = 3_usize;
    let symmetric = |rank: u32, seed: usize| -> Vec<f64> {
        (0..d * d * d * if rank == 4 { d } else { 1 })
            .map(|entry| {
                let mut indices: Vec<usize> = (0..rank).map(|p| entry / d.pow(p) % d).collect();
                indices.sort_unstable();
                let key = indices.iter().fold(seed, |k, i| k * 7 + i);
                (key as f64 * 0.37).sin()
            })
            .collect()
    };
    let (k2, k3) = (symmetric(3, 1), symmetric(4, 2));
    let law = Polynomial::tensors(d, &[], &k2, &k3).unwrap();
    let set = HarmonicSet::all(5).unwrap();
    let m = set.packed_len();
    let x = motion(&set, d, 2);
    let out = evaluate(&law, &set, 1.0, &x);
    // The mean of V over a turn has the slopes F₀ by a mean, but F/2 by an oscillating part.
    let weight = |i: usize| if i.is_multiple_of(m) { 1.0 } else { 0.5 };
    let scale = largest(&out.jacobian);
    for r in 0..d * m {
        for c in 0..d * m {
            let (a, b) = (out.jacobian[c * d * m + r], out.jacobian[r * d * m + c]);
            assert!((weight(r) * a - weight(c) * b).abs() < 1e-14 * scale);
        }
    }
    // Two turns of the indices of one entry make it unsymmetric.
    let mut broken = k3;
    broken[1] += 1.0;
    let law = Polynomial::tensors(d, &[], &k2, &broken).unwrap();
    let out = evaluate(&law, &set, 1.0, &x);
    let skew = |r: usize, c: usize| weight(r) * out.jacobian[c * d * m + r] - weight(c) * out.jacobian[r * d * m + c];
    assert!((0..d * m).any(|r| (0..d * m).any(|c| skew(r, c).abs() > 1e-2)));
}

#[test]
fn oddness_is_that_of_the_degrees() {
    assert!(van_der_pol().is_odd() && quintic().is_odd() && !coupled().is_odd() && !mixed().is_odd());
    assert!(Polynomial::tensors(2, &[], &[], &[1.0; 16]).unwrap().is_odd());
    // Terms that cancel are none, and equal ones are merged.
    let law = Polynomial::new(2, &[term(0, 1.5, &[2, 0], &[]), term(0, -1.5, &[2, 0], &[])]).unwrap();
    assert!(law.is_odd() && law.degree() == 0);
    assert_eq!(at_one_time(&law, 1.0, &[2.0, 3.0], &[]), [0.0, 0.0]);
}
