//! Structures on which other programs for harmonic balance were measured.

use crate::common::models::dense;
use hbvib::{Contact, Model};
use std::f64::consts::PI;

/// A structure from column-major matrices.
pub fn structure(mass: &[f64], damping: &[f64], stiffness: &[f64]) -> Model {
    dense(mass, stiffness).damping(damping).build()
}

/// Four degrees of freedom of a bladed disk and its ring in a standing pattern, limit force 5 N, on which
/// other programs were measured.
pub fn blade_and_ring(force: f64, damped: bool) -> Model {
    let bend = 4.0 * (PI / 12.0).sin().powi(2);
    let (disk, ring) = (6e5 + bend * 5e7, bend * 2e7);
    let mut mass = [0.0; 16];
    for (i, m) in [0.2, 0.3, 1.2, 0.03].into_iter().enumerate() {
        mass[5 * i] = m;
    }
    let mut k = [0.0; 16];
    for (i, v) in [2e6, 3e6, 1e6 + disk, ring].into_iter().enumerate() {
        k[5 * i] = v;
    }
    for (i, j, v) in [(0, 1, -2e6), (1, 2, -1e6)] {
        k[4 * i + j] = v;
        k[4 * j + i] = v;
    }
    let c = k.map(|v| if damped { 2e-6 * v } else { 0.0 });
    let mut model = structure(&mass, &c, &k);
    model.add_contact(&Contact::jenkins(2, Some(3), 5e7, 1.0, 5.0)).unwrap();
    if force > 0.0 {
        model.add_force(0, 1, force.into()).unwrap();
    }
    model
}

/// Range of frequency of its responses.
pub const RANGE: (f64, f64) = (1187.306, 1451.152);
