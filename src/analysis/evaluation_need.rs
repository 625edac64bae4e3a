//! Memory that evaluations at a given motion need, counted before any of it is requested.

use crate::condense::memory_limit::{beyond, mega, within};
use crate::error::Result;
use crate::model::Model;
use crate::model::structure::MatrixKind;
use crate::options::SolverOptions;

/// Bytes above which the evaluation of a law is refused, and the same where its Jacobian is not asked for.
const MOST_OF_A_LAW: usize = 16 << 30;
const MOST_OF_A_FORCE: usize = 500_000_000;

/// Bytes that suffice for the evaluation of a law: 8 (1 + d) (2 d (H + 1))² for Jacobians, 250 a sample, of which a law that
/// is always sampled takes at most 128 (H + 1) by itself, and 1 MiB; in a plane the pieces of the path take 2 MiB (H + 1) at most.
fn need_of_a_law(harmonics: usize, directions: usize, samples: usize) -> usize {
    let order = (harmonics + 1).saturating_mul(2 * directions);
    let samples = samples.max((harmonics + 1).saturating_mul(128));
    let jacobians = order.saturating_mul(order).saturating_mul(8 * (1 + directions));
    let pieces = if directions > 1 {
        (harmonics + 1).saturating_mul(2 << 20)
    } else {
        0
    };
    jacobians
        .saturating_add(samples.saturating_mul(250))
        .saturating_add(pieces)
        .saturating_add(1 << 20)
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

/// Refuses the evaluation of a law that needs more than 16 GiB, or without its Jacobian more than 500 MB.
pub fn allow_law(harmonics: usize, directions: usize, samples: usize, jacobian: bool) -> Result<()> {
    let most = if jacobian { MOST_OF_A_LAW } else { MOST_OF_A_FORCE };
    let need = need_of_a_law(harmonics, directions, samples);
    if need <= most {
        return Ok(());
    }
    Err(beyond(format_args!(
        "the evaluation of a contact with {harmonics} harmonics and {samples} samples needs about {} MB, more than the {} MB that \
         an evaluation may take (500 MB without jac, 16 GiB with it); reduce harmonics or samples",
        mega(need),
        mega(most)
    )))
}

/// Refuses a residual that needs more than the limit of the options, if there is one.
pub fn allow_residual(model: &Model, solver: &SolverOptions) -> Result<()> {
    if solver.memory_limit == 0 {
        return Ok(());
    }
    within(solver.memory_limit, need_of_a_residual(model, solver)?)
}
