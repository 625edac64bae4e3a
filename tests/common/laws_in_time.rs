//! Shared code of the tests of laws in time: structures for them, and the comparison of harmonic balance with the
//! motion in time.

use crate::common::models::dense;
use crate::common::{all_harmonics, harmonics, relative_gap, solve_at};
use hbvib::{Constant, Contact, Error, Hooks, Model, Status, TimeOptions, TimeResponse, time_response};
use num_complex::Complex64;

/// Harmonics that are compared.
pub const COMMON: usize = 5;

/// Number of times of the period at which motions are compared.
pub const SAMPLES: usize = 200;

/// A structure with contacts and forces (degree of freedom, harmonic, value).
pub fn model([m, c, k]: [&[f64]; 3], contacts: &[Contact], forces: &[(usize, usize, Complex64)]) -> Model {
    dense(m, k)
        .damping(c)
        .contacts(contacts)
        .forces(forces.iter().copied())
        .build()
}

/// Mass 1, damping 0.05, stiffness 1 with a contact to the ground under a force of harmonic 1 and a mean one.
pub fn oscillator(contact: Contact, force: f64, mean: f64) -> Model {
    let forces = [(0, 1, force.into()), (0, 0, mean.into())];
    model([&[1.0], &[0.05], &[1.0]], &[contact], &forces)
}

pub const MASS: [f64; 9] = [1.0, 0.1, 0.0, 0.1, 1.2, 0.0, 0.0, 0.0, 0.8];

pub const STIFFNESS: [f64; 9] = [3.0, -0.4, -1.0, -0.4, 2.5, -0.3, -1.0, -0.3, 2.0];

/// Damping over stiffness.
pub const BETA: f64 = 0.04;

/// Masses that move along the surface (0) and along its normal (1), coupled; and one beyond (2).
pub fn slanted(contacts: &[Contact], forces: &[(usize, usize, Complex64)]) -> Model {
    let c = STIFFNESS.map(|k| BETA * k);
    model([&MASS, &c, &STIFFNESS], contacts, forces)
}

pub const KT: f64 = 2.0;

pub const KN: f64 = 3.0;

/// Friction between the first two degrees of freedom of [`slanted`] and the ground; a negative preload is a
/// gap.
pub fn friction(mu: f64, preload: f64) -> Contact {
    let contact = Contact::friction_2d([Some(0), Some(1)], [None, None], (KT, KN), mu, preload.max(0.0));
    contact.with(Constant::Gap, (-preload).max(0.0) / KN).unwrap()
}

/// A force along the surface and one a quarter of a period ahead along the normal.
pub fn forces(normal: f64) -> [(usize, usize, Complex64); 2] {
    [(0, 1, 1.0.into()), (1, 1, Complex64::new(0.0, normal))]
}

pub fn try_in_time(model: &Model, options: &TimeOptions<'_>) -> Result<TimeResponse, Error> {
    time_response(model, options, &mut Hooks::default())
}

pub fn in_time(model: &Model, omega: f64, start: Option<&[Complex64]>) -> TimeResponse {
    let options = TimeOptions {
        omega,
        harmonics: COMMON,
        samples: SAMPLES,
        start,
        ..TimeOptions::default()
    };
    let found = try_in_time(model, &options).unwrap();
    assert_eq!(found.status, Status::Ok);
    found
}

/// Integrates from the solution of 15 harmonics, and returns the distances from it of the solutions with few and with
/// many.
pub fn distances(name: &str, model: &Model, omega: f64, [few, many]: [usize; 2]) -> (TimeResponse, [f64; 2]) {
    let balanced = |highest: usize| all_harmonics(&solve_at(model, &harmonics(highest), omega), 0);
    let truth = in_time(model, omega, Some(&balanced(15)));
    let errors = [few, many].map(|highest| {
        let found = balanced(highest);
        relative_gap(&found[..truth.harmonics.len()], &truth.harmonics)
    });
    println!(
        "{name}, {omega}: H = {few} {:.1e}, H = {many} {:.1e}; {} events, {} periods, residual {:.0e}",
        errors[0], errors[1], truth.events, truth.periods, truth.residual
    );
    (truth, errors)
}
