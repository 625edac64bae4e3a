//! The Jacobian of a contact law against finite differences on random motions: an identity of the
//! same-H equations, whatever the motion.

use crate::common::stencil::{Checked, Stencil, config, pairs, parts};
use hbvib::{Contact, contact_evaluate};
use num_complex::Complex64;
use proptest::prelude::*;
use std::f64::consts::TAU;

/// Half the range of a motion: extremes of dense samples, each refined by the parabola through its
/// neighbours, to about 1e-9 of the motion.
fn half_range(motion: &[Complex64]) -> f64 {
    let n = 512 * motion.len();
    let x: Vec<f64> = (0..n)
        .map(|j| {
            let tau = TAU * j as f64 / n as f64;
            let terms = motion.iter().enumerate();
            terms.map(|(h, x)| (x * Complex64::cis(h as f64 * tau)).re).sum()
        })
        .collect();
    let highest = |sign: f64| {
        let at = (0..n).max_by(|&i, &j| (sign * x[i]).total_cmp(&(sign * x[j]))).unwrap();
        let (a, b, c) = (x[(at + n - 1) % n], x[at], x[(at + 1) % n]);
        let curvature = a - 2.0 * b + c;
        let beyond = if curvature == 0.0 {
            0.0
        } else {
            (c - a).powi(2) / (8.0 * curvature)
        };
        sign * (b - beyond)
    };
    0.5 * (highest(1.0) + highest(-1.0))
}

/// A motion whose harmonics fall off, from random numbers in −1 .. 1.
fn motion(numbers: &[f64]) -> Vec<Complex64> {
    pairs(numbers)
        .iter()
        .enumerate()
        .map(|(h, z)| if h == 0 { z.re.into() } else { z / h as f64 })
        .collect()
}

/// Force coefficients as pairs, and their Jacobian.
fn law(contact: &Contact, x: &[Complex64], jacobian: Option<&mut [f64]>) -> Vec<f64> {
    let mut f = vec![Complex64::ZERO; x.len()];
    contact_evaluate(contact, x.len() - 1, 0, 1.0, x, &mut f, jacobian).unwrap();
    parts(&f)
}

fn friction(limit: f64) -> Contact {
    Contact::jenkins(0, None, 1.0, 1.0, limit)
}

/// Every column of the law's Jacobian at x, or only its action along given directions.
fn check_law(x: &[Complex64], contact: &Contact, directions: Option<&[Vec<f64>]>) -> Checked {
    let order = 2 * x.len();
    let mut jacobian = vec![0.0; order * order];
    law(contact, x, Some(&mut jacobian));
    let units: Vec<Vec<f64>> = (0..order)
        .map(|c| (0..order).map(|i| f64::from(u8::from(i == c))).collect())
        .collect();
    for d in directions.unwrap_or(&units) {
        let mut slope = vec![0.0; order];
        for (column, d) in jacobian.chunks_exact(order).zip(d) {
            for (s, j) in slope.iter_mut().zip(column) {
                *s += j * d;
            }
        }
        let stencil = Stencil::of(1e-6, |h| {
            let moved: Vec<f64> = parts(x).iter().zip(d).map(|(x, d)| x + h * d).collect();
            law(contact, &pairs(&moved), None)
        });
        let scale = slope.iter().fold(1.0_f64, |m, s| m.max(s.abs()));
        stencil.check("contact Jacobian", &slope, scale)?;
    }
    Ok(())
}

proptest! {
    #![proptest_config(config(200))]

    #[test]
    fn the_jacobian_of_the_law_on_random_motions(
        numbers in prop::collection::vec(-1.0..1.0_f64, 20),
        highest in 0_usize..=9,
        exponent in -2.0..0.2_f64,
    ) {
        let x = motion(&numbers[..2 * (highest + 1)]);
        // From far beyond the slip limit to below it; without oscillation the mean sets the scale.
        let size = half_range(&x).max(if highest == 0 { x[0].norm() } else { 0.0 });
        check_law(&x, &friction(size * 10.0_f64.powf(exponent)), None)?;
    }

    #[test]
    fn the_jacobian_of_the_law_near_the_onset_of_slip(
        numbers in prop::collection::vec(-1.0..1.0_f64, 20),
        highest in 1_usize..=9,
        beyond in prop::sample::select(vec![-1e-2, -1e-4, 1e-4, 1e-3, 1e-2, 0.1]),
    ) {
        let x = motion(&numbers[..2 * (highest + 1)]);
        check_law(&x, &friction(half_range(&x) / (1.0 + beyond)), None)?;
    }

    #[test]
    fn the_jacobian_of_the_unilateral_spring(
        numbers in prop::collection::vec(-1.0..1.0_f64, 20),
        highest in 0_usize..=9,
        gap in -1.0..1.0_f64,
    ) {
        let x = motion(&numbers[..2 * (highest + 1)]);
        check_law(&x, &Contact::unilateral(Some(0), None, 1.0, gap), None)?;
    }

    #[test]
    fn the_jacobian_of_the_cubic_spring(
        numbers in prop::collection::vec(-1.0..1.0_f64, 20),
        highest in 0_usize..=9,
        kt in prop::sample::select(vec![0.0, 1.0]),
        k3 in -3.0..3.0_f64,
    ) {
        let x = motion(&numbers[..2 * (highest + 1)]);
        check_law(&x, &Contact::cubic(0, None, kt, k3), None)?;
    }
}

proptest! {
    #![proptest_config(config(40))]

    #[test]
    fn the_jacobian_of_the_law_at_many_harmonics(
        numbers in prop::collection::vec(-1.0..1.0_f64, 2 * 61),
        directions in prop::collection::vec(prop::collection::vec(-1.0..1.0_f64, 2 * 61), 4),
        highest in 38_usize..=60,
        exponent in -2.0..0.2_f64,
    ) {
        let order = 2 * (highest + 1);
        let x = motion(&numbers[..order]);
        let directions: Vec<Vec<f64>> = directions
            .iter()
            .map(|d| d[..order].iter().map(|v| v / (order as f64).sqrt()).collect())
            .collect();
        check_law(&x, &friction(half_range(&x) * 10.0_f64.powf(exponent)), Some(&directions))?;
    }
}
