//! Structures whose linear modes are known, and checks of a mode.

use crate::common::models::{Structure, diagonal};
use crate::common::{B1, B2, BASE, D, NDOF, SECTORS, largest};
use hbvib::{Contact, MatrixKind, Model, Spring};
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};

/// The blisk's sector under an engine order.
pub fn sector(engine_order: i64) -> Model {
    let mut model = BASE.sector();
    model.set_wave(engine_order);
    model
}

/// A sector without mirror symmetry: a second contact connects to the next sector, so that the matrices of a wave are
/// complex.
pub fn skewed(engine_order: i64) -> Model {
    let mut model = sector(engine_order);
    model
        .add_contact(&Contact {
            dof_a: [Some(B1), None, None],
            sector_offset: 1,
            ..Contact::jenkins(D, Some(B1), 3e6, 0.3, 10.0)
        })
        .unwrap();
    model
        .add_spring(&Spring {
            dof_a: Some(B2),
            dof_b: Some(D),
            sector_offset: 1,
            stiffness: 4e5,
        })
        .unwrap();
    model
}

/// aᴴ M b over one sector.
pub fn mass_product(model: &Model, a: &[Complex64], b: &[Complex64]) -> Complex64 {
    let mass = model.structure().wave_matrix(MatrixKind::Mass, 1).unwrap();
    let mut mb = vec![Complex64::ZERO; b.len()];
    mass.multiply_add(Complex64::ONE, b, &mut mb);
    a.iter().zip(&mb).map(|(a, b)| a.conj() * b).sum()
}

pub fn gap(a: &[Complex64], b: &[Complex64]) -> f64 {
    largest(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>()) / largest(b)
}

/// Asserts that every sector of the wheel lags behind the one before by 2π·diameter/N.
pub fn assert_wave(shape: &[Complex64], diameter: f64) {
    let lag = Complex64::cis(-TAU * diameter / SECTORS as f64);
    for s in 0..SECTORS {
        let next = (s + 1) % SECTORS;
        for i in 0..NDOF {
            let (a, b) = (shape[s * NDOF + i], shape[next * NDOF + i]);
            assert!((b - lag * a).norm() < 1e-9 * largest(shape), "sector {s}, dof {i}");
        }
    }
}

/// `chains` equal chains of unit masses and springs, one end of each held by a contact of
/// stiffness 1; the other free.
pub fn chains(chains: usize, length: usize) -> Model {
    let n = chains * length;
    let between = (0..n).filter(|i| (i + 1) % length != 0).map(|i| Spring {
        dof_a: Some(i),
        dof_b: Some(i + 1),
        sector_offset: 0,
        stiffness: 1.0,
    });
    Structure::plain(n)
        .mass(&diagonal(&vec![1.0; n]))
        .springs(between)
        .contacts((0..chains).map(|c| Contact::jenkins(c * length, None, 1.0, 0.5, 1.0)))
        .build()
}

/// Frequency k of a chain of unit masses, one end held by a unit spring.
pub fn chain_frequency(k: usize, length: usize) -> f64 {
    2.0 * (PI * (2 * k + 1) as f64 / (4 * length + 2) as f64).sin()
}
