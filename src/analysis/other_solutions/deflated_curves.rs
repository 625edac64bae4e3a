//! Curves of a forced response without connection to the branch, by deflation: at points of the response Newton's method is led away
//! from the solutions that are known there. It needs neither a nonlinear mode nor a peak over the force, and shows those alone that its
//! starts lead to.

use crate::analysis::forced::deflation::Deflation;
use crate::analysis::forced::inside_start::Inside;
use crate::analysis::other_solutions::branch_switching::{Found, Tree};
use crate::error::{Result, try_push, try_vec};
use crate::hooks::Hooks;
use crate::options::Content;
use crate::results::{Branch, Descent, Recovery};
use core::cell::Cell;
use num_complex::Complex64;

const CONTEXT: &str = "the deflated curves";

/// Shares of the points of the response at which solutions are sought, beside its peaks, of which at most so many count.
/// Kind: tuned; measured on: not recorded.
const DEFLATION_PLACES: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];
/// Most peaks of the response at which solutions are sought.
/// Kind: cap.
const DEFLATION_MOST_PEAKS: usize = 3;

/// Adds the curves that deflation finds beside a branch, with their children, down to `depth`.
///
/// # Errors
/// `OutOfMemory`; `StoppedByCaller`; those of callbacks.
pub(crate) fn add_deflated(
    tree: &mut Tree<'_>,
    branch: &mut Branch,
    depth: usize,
    hooks: &mut Hooks<'_>,
) -> Result<()> {
    let last = branch.points().saturating_sub(1);
    let mut places = Vec::new();
    for share in DEFLATION_PLACES {
        try_push(&mut places, (last as f64 * share) as usize, CONTEXT)?;
    }
    for peak in branch.peaks().iter().take(DEFLATION_MOST_PEAKS) {
        try_push(&mut places, peak.point, CONTEXT)?;
    }
    for point in places {
        let Some(omega) = branch.omega_at(point).filter(|_| tree.left > 0) else {
            continue;
        };
        tree.searched.deflations += 1;
        let Found::Curve(curve, _) = deflated(tree, branch, point, omega, hooks)? else {
            continue;
        };
        let mut found = tree.whole(tree.model, &curve, 1, hooks)?.unwrap_or(curve);
        if tree.shares_an_end(&found, branch, &hooks.interrupt())? {
            continue;
        }
        tree.left -= 1;
        tree.searched.deflated += 1;
        found.set_descent(Descent::default());
        tree.add(branch, found, (1, depth), hooks)?;
    }
    Ok(())
}

/// The curve through a solution that deflation finds beside a point of the response.
fn deflated(tree: &Tree<'_>, branch: &Branch, point: usize, omega: f64, hooks: &mut Hooks<'_>) -> Result<Found> {
    let mut known = Vec::new();
    try_push(&mut known, branch, CONTEXT)?;
    for sibling in branch.children().iter().filter(|sibling| sibling.periods() == 1) {
        try_push(&mut known, sibling, CONTEXT)?;
    }
    let highest = branch.carried_at(point).and_then(|carried| carried.last().copied());
    let highest = highest.unwrap_or(1);
    let motion = Recovery::at(branch, point, &hooks.interrupt())?.all(highest)?;
    let mut guess = try_vec(motion.len(), Complex64::ZERO, CONTEXT)?;
    guess.copy_from_slice(&motion);
    let inside = Inside {
        omega,
        content: Content::of(&guess, &tree.model.felt_by_contacts()?).0,
        leaves: None,
        known: &known,
        periods: 1,
        entry: Cell::default(),
        net: None,
        deflation: Some(Deflation),
    };
    tree.at_period(tree.model, &inside, &guess, (1, branch.response_dof()), hooks)
}
