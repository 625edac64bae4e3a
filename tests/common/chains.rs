//! Chains of masses and an oscillator, from plain numbers.

use crate::common::models::{self, oscillator};
use hbvib::{Contact, Model};

/// A chain of n masses of 1 between springs of 1, held at both ends, C = 0.02 K, a force on the first mass, and two sliders against
/// the ground. A `preload` adds a stop with that load at rest; with an infinite one nothing slips.
pub fn chain(n: usize, preload: f64) -> Model {
    chain_with(n, preload, [1.5, 0.3, 1.0])
}

/// The same with stiffness and slip limit of the first slider, and the force.
pub fn chain_with(n: usize, preload: f64, [kt, limit, force]: [f64; 3]) -> Model {
    let mass: Vec<f64> = (0..n).map(|i| 1.0 + 0.1 * i as f64).collect();
    let mut model = models::chain(&mass, &vec![1.0; n + 1])
        .rayleigh(0.0, 0.02)
        .force(0, 1, force);
    if preload.is_finite() {
        let between = Contact::jenkins(n - 1, Some(n - 2), 2.0, 0.5, 1.0);
        model = model.slider(1, kt, limit, 1.0).contact(between);
    }
    if preload.is_finite() && preload > 0.0 {
        model = model
            .contact(Contact::unilateral(Some(2), None, 0.5, 0.0))
            .force(2, 0, -preload);
    }
    model.build()
}

/// x″ + d x′ + x + c x³ = F cos ωt.
pub fn duffing(damping: f64, cubic: f64, force: f64) -> Model {
    oscillator(1.0, 1.0)
        .damping(&[damping])
        .contact(Contact::cubic(0, None, 0.0, cubic))
        .force(0, 1, force)
        .build()
}

/// x″ + 0.02 x′ + x = F cos ωt with a slider of stiffness 0.2 and limit 0.1.
pub fn rubbing_mass(force: f64) -> Model {
    driven_mass(0.02, &Contact::jenkins(0, None, 0.2, 0.1, 1.0), &[(1, force)])
}

/// Mass 1 on a spring of 1 with a contact, under forces (harmonic, value).
pub fn driven_mass(damping: f64, contact: &Contact, forces: &[(usize, f64)]) -> Model {
    oscillator(1.0, 1.0)
        .damping(&[damping])
        .contact(contact)
        .forces(forces.iter().map(|&(harmonic, force)| (0, harmonic, force)))
        .build()
}
