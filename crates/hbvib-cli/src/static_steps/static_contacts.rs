//! Contacts at rest: forces under constant loads and preload, and which are closed.

use crate::building::built::Built;
use hbvib::{Constant, ForcedOptions, Hooks, Model, SolverOptions, State, forced_response};
use num_complex::Complex64;

/// Share of the vibrating forces under which the mean of each contact is that at rest.
const SMALL: f64 = 1e-4;

/// Times of the period over which forces are averaged.
const TIMES: usize = 32;

/// A contact at rest.
#[derive(Clone, Copy, Debug)]
pub struct AtRest {
    /// Force along the normal; the given load where the law has none.
    pub normal: f64,
    pub tangential: f64,
    pub open: bool,
}

/// Forces of all contacts at rest, by a vibration that is too small to change them.
///
/// # Errors
/// A sentence: no equilibrium.
pub fn at_rest(built: &Built, omega: f64) -> Result<Vec<AtRest>, String> {
    let model = &built.model;
    let contacts = model.contacts();
    if contacts.is_empty() {
        return Ok(Vec::new());
    }
    let calm = calm(model).map_err(|e| e.to_string())?;
    let solver = SolverOptions {
        harmonics: 1,
        tolerance: 0.0,
        ..SolverOptions::default()
    };
    let range = ForcedOptions {
        omega_start: omega,
        omega_stop: omega,
        ..ForcedOptions::default()
    };
    let branch = forced_response(&calm, &solver, &range, &mut Hooks::default()).map_err(|e| e.to_string())?;
    let mut all = Vec::new();
    for (id, contact) in contacts.iter().enumerate() {
        let found = branch
            .contact_loop(0, id, TIMES)
            .map_err(|e| format!("contact {id}: {e}"))?;
        let mean = |d: usize| found.force.iter().skip(d).step_by(found.directions).sum::<f64>() / TIMES as f64;
        let along = contact.normal_direction();
        let across = (0..found.directions).filter(|d| along != Some(*d)).map(mean);
        let tangential = across.fold(0.0, f64::hypot);
        all.push(AtRest {
            normal: along.map_or(contact.load(), |d| mean(d).abs()),
            tangential,
            open: found.state.iter().filter(|state| **state == State::Open).count() * 2 > TIMES,
        });
    }
    Ok(all)
}

/// The model under its constant forces and a small share of the others.
fn calm(model: &Model) -> hbvib::Result<Model> {
    let mut calm = model.try_clone()?;
    let forces: Vec<(usize, usize, Complex64)> = model
        .excitation()
        .forces()
        .iter()
        .map(|force| (force.dof, force.harmonic, force.value))
        .collect();
    calm.clear_forces();
    let mut vibrates = false;
    for (dof, harmonic, value) in forces {
        let share = if harmonic == 0 { 1.0 } else { SMALL };
        // One harmonic is carried.
        vibrates |= harmonic == 1;
        calm.add_force(dof, harmonic.min(1), value * share)?;
    }
    if !vibrates {
        let first = model.contacts().iter().find_map(|contact| {
            let sides = contact.dof_a.iter().chain(&contact.dof_b).flatten();
            sides.chain(&contact.dofs).next().copied()
        });
        let scale = model
            .contacts()
            .iter()
            .map(|contact| contact.constant(Constant::Preload))
            .fold(0.0, f64::max);
        calm.add_force(
            first.unwrap_or(0),
            1,
            (SMALL * if scale > 0.0 { scale } else { 1.0 }).into(),
        )?;
    }
    Ok(calm)
}
