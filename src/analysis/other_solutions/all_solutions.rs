//! A forced response with the solutions that a sweep does not show: branches that branch off, and detached curves.

use crate::analysis::forced::forced_curve::alone;
use crate::analysis::other_solutions::branch_switching::{Place, Tree};
use crate::analysis::other_solutions::deflated_curves;
use crate::analysis::other_solutions::subharmonic_net;
use crate::error::{Result, Status};
use crate::hooks::Hooks;
use crate::model::Model;
use crate::options::{ForcedOptions, SolverOptions, Waves};
use crate::results::{Branch, Searched};

/// A forced response with its children. Stability is computed along all of them, since bifurcations follow from it.
///
/// # Errors
/// As [`crate::analysis::forced_response()`].
// Inlined, its variables would lie on the stack under every response.
#[inline(never)]
pub(crate) fn forced_response(
    model: &Model,
    solver: &SolverOptions,
    range: &ForcedOptions<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Branch> {
    range.check_search()?;
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
    match seek(&mut tree, &mut branch, depth, hooks) {
        // Branches that were found before a stop are kept.
        Err(e) if e.status == Status::StoppedByCaller => branch.set_ending(e.status, None, (false, false)),
        sought => sought?,
    }
    if branch.was_stopped() {
        branch.set_ending(Status::StoppedByCaller, None, (false, false));
    }
    branch.set_searched(tree.searched);
    Ok(branch)
}

/// Adds all branches that the options request, until the largest number is reached, or the caller stops the run.
fn seek(tree: &mut Tree<'_>, branch: &mut Branch, depth: usize, hooks: &mut Hooks<'_>) -> Result<()> {
    let sought = tree.range.branches;
    tree.grow(branch, &Place::root(), depth, hooks)?;
    if sought > 1 && tree.left > 0 {
        tree.add_detached(branch, depth, hooks)?;
    }
    // Where modes tell nothing, peaks and folds over the force do.
    let told_by_modes = tree.searched.modes > tree.searched.incomplete_modes;
    if tree.left > 0 && (sought > 2 || (sought > 1 && !told_by_modes)) {
        tree.add_over_force(branch, depth, hooks)?;
    }
    if sought > 2 && tree.left > 0 {
        subharmonic_net::add_subharmonics(tree, branch, depth, hooks)?;
    }
    if sought > 3 && tree.left > 0 {
        deflated_curves::add_deflated(tree, branch, depth, hooks)?;
    }
    Ok(())
}
