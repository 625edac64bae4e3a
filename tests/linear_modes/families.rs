//! Natural modes of structures with a family of close frequencies far from zero: equal blades in a ring, a chain on springs.

use crate::common::models::{dense, diagonal};
use hbvib::{ContactState, Model};
use std::f64::consts::PI;

fn plain(n: usize, stiffness: &[f64]) -> Model {
    dense(&diagonal(&vec![1.0; n]), stiffness).build()
}

/// The first natural frequencies against those in closed form, which may come in pairs.
fn check(model: &Model, exact: &[f64]) {
    let found = model.lowest_modes(0, ContactState::Free, exact.len()).unwrap();
    assert_eq!(found.omega.len(), exact.len());
    assert_eq!(found.omega.len(), exact.len());
    for (omega, exact) in found.omega.iter().zip(exact) {
        assert!((omega / exact - 1.0).abs() < 1e-13, "{omega} for {exact}");
    }
}

#[test]
fn equal_blades_in_a_ring_have_a_pair_for_each_diameter() {
    // Blades of two masses: a root on a spring to the ground, a tip, springs between neighbouring roots. On diameter d
    // K = [[k + c + 2g(1 − cos 2πd/N), −c], [−c, c]].
    let (ground, between, coupling) = (50.0, 1.0, 0.5);
    for blades in [60, 127, 200] {
        let n = 2 * blades;
        let mut k = vec![0.0; n * n];
        for i in 0..blades {
            let (root, tip, next) = (2 * i, 2 * i + 1, 2 * ((i + 1) % blades));
            k[root * (n + 1)] += ground + between + coupling;
            k[next * (n + 1)] += coupling;
            k[tip * (n + 1)] += between;
            for (p, q, stiffness) in [(root, tip, between), (root, next, coupling)] {
                k[p * n + q] -= stiffness;
                k[q * n + p] -= stiffness;
            }
        }
        let of_diameter = |d: usize| {
            let root = ground + between + 4.0 * coupling * (PI * d as f64 / blades as f64).sin().powi(2);
            // The lower root of λ² − (root + c) λ + c (root − c) without cancellation.
            let half = 0.5 * (root + between);
            let other = half + (half * half - between * (root - between)).sqrt();
            (between * (root - between) / other).sqrt()
        };
        check(&plain(n, &k), &[0, 1, 1, 2, 2].map(of_diameter));
    }
}

#[test]
fn chains_on_springs_have_the_frequencies_of_their_closed_form() {
    for (n, spring) in [(101, 100.0), (130, 100.0), (300, 1.0), (450, 1e4), (610, 0.2)] {
        let mut k = vec![0.0; n * n];
        for i in 0..n {
            k[i * (n + 1)] = 2.0 + spring;
            if i > 0 {
                k[i * n + i - 1] = -1.0;
                k[(i - 1) * n + i] = -1.0;
            }
        }
        let of_wave = |j: usize| {
            let half = 0.5 * PI * j as f64 / (n + 1) as f64;
            (spring + 4.0 * half.sin().powi(2)).sqrt()
        };
        check(&plain(n, &k), &[1, 2, 3].map(of_wave));
    }
}
