//! Memory that evaluations at a given motion need, counted before any of it is requested.

use crate::condense::blocks::memory_limit::{beyond, mega, within};
use crate::contact::Contact;
use crate::contact::forms::law::Form;
use crate::error::Result;
use crate::model::Model;
use crate::model::matrices::structure::MatrixKind;
use crate::options::SolverOptions;

/// Bytes above which the evaluation of a law is refused, and the same without the matrices that a Jacobian of the caller asks for.
/// Kind: cap.
const MOST_OF_A_LAW: usize = 16 << 30;
const MOST_OF_A_FORCE: usize = 500 << 20;

/// Bytes of the path of friction in a plane at most: the pieces of a motion that passes between stick and slip very often, and the
/// tables of its panels.
/// Kind: cap.
const OF_A_PATH: usize = 256 << 20;
const OF_PANELS: usize = 64 << 10;
const OF_PIECES: usize = 2 << 20;

fn need_of_a_path(harmonics: usize) -> usize {
    let count = harmonics + 1;
    let panels = count.saturating_mul(OF_PANELS);
    count.saturating_mul(OF_PIECES).min(OF_A_PATH.saturating_add(panels))
}

/// Bytes that suffice to evaluate a law: 8 (1 + d) (2 d (H + 1))² for Jacobians, 250 a sample (of which a law that is
/// always sampled takes at most 128 (H + 1) by itself), 1 MiB, and the path of friction in a plane.
fn need_of_a_law(harmonics: usize, directions: usize, samples: usize) -> usize {
    let order = (harmonics + 1).saturating_mul(2 * directions);
    let samples = samples.max((harmonics + 1).saturating_mul(128));
    let jacobians = order.saturating_mul(order).saturating_mul(8 * (1 + directions));
    let path = if directions > 1 { need_of_a_path(harmonics) } else { 0 };
    jacobians
        .saturating_add(samples.saturating_mul(250))
        .saturating_add(path)
        .saturating_add(1 << 20)
}

/// Bytes that suffice for the force of a law without Jacobian: 2.5 KiB for each of its d (H + 1) harmonics, 250 a
/// sample where the law is sampled, 1 MiB, and the pieces of the path of friction in a plane.
fn need_of_a_force(contact: &Contact, harmonics: usize, samples: usize) -> Result<usize> {
    let directions = contact.directions();
    let (own, of_path) = match contact.law(1.0)?.form() {
        Form::Memoryless(_) | Form::Hysteretic(_) => ((harmonics + 1).saturating_mul(128), 0),
        Form::PlaneFriction(_) => (0, need_of_a_path(harmonics)),
        Form::PiecewiseLinear(_) | Form::Spectral(_) | Form::VaryingNormalLoad(_) => (0, 0),
    };
    Ok((harmonics + 1)
        .saturating_mul(directions.saturating_mul(5 << 9))
        .saturating_add(of_path)
        .saturating_add(samples.max(own).saturating_mul(250))
        .saturating_add(1 << 20))
}

/// Bytes that suffice for a residual: its contacts, and two sparse matrices a harmonic, of at most as many entries as all
/// matrices of the structure have together.
fn need_of_a_residual(model: &Model, solver: &SolverOptions) -> Result<usize> {
    let mut entries = 0_usize;
    for kind in [
        MatrixKind::Stiffness,
        MatrixKind::Damping,
        MatrixKind::Structural,
        MatrixKind::Mass,
    ] {
        entries = entries.saturating_add(model.structure().wave_matrix(kind, 0)?.values.len());
    }
    let matrices = (solver.harmonics + 1).saturating_mul(entries.saturating_mul(96));
    let contacts = model
        .contacts()
        .iter()
        .map(|contact| need_of_a_law(solver.harmonics, contact.directions(), solver.samples));
    Ok(contacts.fold(matrices, usize::saturating_add))
}

/// Refuses the evaluation of a law that needs more than 500 MB beyond the Jacobian that the caller requests, or more
/// than 16 GiB in all.
pub fn allow_law(contact: &Contact, harmonics: usize, samples: usize, jacobian: bool) -> Result<()> {
    let directions = contact.directions();
    let with_jacobian = need_of_a_law(harmonics, directions, samples);
    let without = need_of_a_force(contact, harmonics, samples)?;
    if without <= MOST_OF_A_FORCE && (!jacobian || with_jacobian <= MOST_OF_A_LAW) {
        return Ok(());
    }
    let (need, most) = if without > MOST_OF_A_FORCE {
        (without, MOST_OF_A_FORCE)
    } else {
        (with_jacobian, MOST_OF_A_LAW)
    };
    Err(beyond(format_args!(
        "the evaluation of a contact with harmonics = {harmonics} and samples = {samples} needs about {} MB, more than the {} MB \
         that it may take{}; reduce harmonics or samples",
        mega(need),
        mega(most),
        if without > MOST_OF_A_FORCE {
            " beside jac"
        } else {
            " with jac"
        }
    )))
}

/// Refuses a residual that needs more than the limit of the options, if there is one.
pub fn allow_residual(model: &Model, solver: &SolverOptions) -> Result<()> {
    if solver.memory_limit == 0 {
        return Ok(());
    }
    within(solver.memory_limit, need_of_a_residual(model, solver)?)
}
