//! Floquet multipliers of periodic motions.

#[path = "../common/mod.rs"]
mod common;

mod aero_influence;
mod along_branch;
mod bifurcations;
mod branch_switching;
mod chains_without_detached;
mod detached_curves;
mod floquet_classes;
mod floquet_references;
mod floquet_wheel;
mod hard_cases_in_time;
mod hill;
mod limit_cycles;
mod on_modes;
mod over_force;
mod senses_of_perturbations;
mod smallest_kick;
mod subharmonic_net;

use hbvib::{Branch, Floquet, FloquetOptions, Hooks, Model, MultiplierClass, Waves, floquet};
use num_complex::Complex64;

/// Multipliers of a point after shooting.
pub(crate) fn multipliers(model: &Model, branch: &Branch, point: usize, waves: Waves) -> Floquet {
    let options = FloquetOptions {
        waves,
        ..FloquetOptions::default()
    };
    floquet(model, branch, point, &options, &mut Hooks::default()).unwrap()
}

/// The ordinary ones.
pub(crate) fn ordinary(found: &Floquet) -> Vec<Complex64> {
    of_class(found, MultiplierClass::Ordinary)
}

/// Those of a class.
pub(crate) fn of_class(found: &Floquet, class: MultiplierClass) -> Vec<Complex64> {
    found
        .multipliers
        .iter()
        .filter(|m| m.class == class)
        .map(|m| m.value)
        .collect()
}
