//! A forced response with the solutions that a sweep does not show: branches that branch off, and detached curves.

use crate::analysis::branch_switching::{Place, Tree};
use crate::analysis::forced_curve::alone;
use crate::error::{Result, Status};
use crate::hooks::Hooks;
use crate::model::Model;
use crate::options::{ForcedOptions, SolverOptions, Waves};
use crate::results::{Branch, Searched};

/// A response with its children. Stability is computed along all of them, as bifurcations follow from it.
///
/// # Errors
/// As [`crate::analysis::forced_response()`].
// Inlined, its variables would lie on the stack under every response.
#[inline(never)]
pub(super) fn forced_response(
    model: &Model,
    solver: &SolverOptions,
    range: &ForcedOptions<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Branch> {
    let solver = SolverOptions {
        stability: solver.stability.or(Some(Waves::Wave)),
        ..*solver
    };
    let mut branch = alone(model, &solver, range, hooks)?;
    if branch.status() == Status::StoppedByCaller || branch.points() == 0 {
        return Ok(branch);
    }
    let carried = branch.carried_at(0).unwrap_or(&[]);
    let base = carried.iter().copied().find(|h| *h > 0).unwrap_or(1);
    let (depth, most) = range.size_of_tree();
    let mut tree = Tree {
        model,
        solver: &solver,
        range,
        left: most,
        base,
        searched: Searched::default(),
    };
    tree.grow(&mut branch, &Place::root(), depth, hooks)?;
    if range.branches > 1 {
        tree.add_detached(&mut branch, depth, hooks)?;
    }
    // Where modes tell nothing, peaks and folds over the force do.
    let told_by_modes = tree.searched.modes > tree.searched.incomplete_modes;
    if range.branches > 2 || (range.branches > 1 && !told_by_modes) {
        tree.add_over_force(&mut branch, depth, hooks)?;
    }
    if range.branches > 2 {
        tree.add_subharmonics(&mut branch, depth, hooks)?;
    }
    if range.branches > 3 {
        tree.add_deflated(&mut branch, depth, hooks)?;
    }
    branch.set_searched(tree.searched);
    Ok(branch)
}
