//! Subharmonic curves of the orders 2 and 3, by a net of starts.
//!
//! A subharmonic motion may have no connection to the response, and the resonance of a mode under its strong forced motion is not
//! that of the mode alone. From a few points of the response a linear mode is added at the fraction of the frequency, with
//! amplitudes and phases of a net; each is a start of Newton's method at that frequency. A solution with other harmonics than
//! multiples of the order is a point of a subharmonic curve.

use crate::analysis::forced::inside_start::Inside;
use crate::analysis::forced::start_net::Net;
use crate::analysis::other_solutions::branch_switching::{Found, Tree};
use crate::error::{Result, Status, try_push, try_vec};
use crate::hooks::{Hooks, LogLevel};
use crate::model::natural_modes::linear_modes::ContactState;
use crate::options::Content;
use crate::results::{Branch, Descent, Recovery};
use core::cell::Cell;
use num_complex::Complex64;

const CONTEXT: &str = "the subharmonic curves";

/// Orders that are sought.
/// Kind: tuned; measured on: not recorded.
const ORDERS: [usize; 2] = [2, 3];

/// Shares of the points of the response at which starts are made.
/// Kind: tuned; measured on: not recorded.
const PLACES: [f64; 3] = [0.25, 0.5, 0.75];

/// Most modes that are added, and their frequencies over the fraction of that of the response.
/// Kind: cap.
const SUBHARMONIC_NET_MOST_MODES: usize = 4;
/// Frequencies of these modes over the fraction of that of the response.
/// Kind: tuned; measured on: not recorded.
const SUBHARMONIC_NET_NEAR: (f64, f64) = (0.3, 2.0);

/// Adds subharmonic curves, with their children, down to `depth`.
///
/// # Errors
/// `OutOfMemory`; `StoppedByCaller`; those of callbacks.
pub(crate) fn add_subharmonics(
    tree: &mut Tree<'_>,
    branch: &mut Branch,
    depth: usize,
    hooks: &mut Hooks<'_>,
) -> Result<()> {
    let interrupt = hooks.interrupt();
    let count = SUBHARMONIC_NET_MOST_MODES.min(tree.model.structure().degrees().independent());
    for order in ORDERS {
        let model = match tree.model.with_longer_period(order) {
            Ok(model) => model,
            Err(e) if matches!(e.status, Status::Unsupported | Status::Argument) => {
                hooks.log(LogLevel::Warn, e.message());
                continue;
            }
            Err(e) => return Err(e),
        };
        let wave = model.structure().engine_order();
        let modes = match model.lowest_modes_with(wave, ContactState::Stuck, count, &interrupt) {
            Ok(modes) => modes,
            Err(e) if e.status == Status::StoppedByCaller => return Err(e),
            Err(_) => continue,
        };
        let ndof = branch.ndof().max(1);
        for place in PLACES {
            let point = ((branch.points().max(1) - 1) as f64 * place) as usize;
            let omega = branch.omega()[point] / order as f64;
            let highest = branch
                .carried_at(point)
                .and_then(|all| all.last().copied())
                .unwrap_or(1);
            let own = Recovery::at(branch, point, &interrupt)?.all(highest)?;
            let mut guess = try_vec((highest * order + 1) * ndof, Complex64::ZERO, CONTEXT)?;
            for (h, row) in own.chunks_exact(ndof).enumerate() {
                guess[h * order * ndof..(h * order + 1) * ndof].copy_from_slice(row);
            }
            let size = own.iter().fold(0.0_f64, |most, x| most.max(x.norm()));
            for (number, shape) in modes.shapes.chunks_exact(ndof).enumerate() {
                let ratio = modes.omega[number] / omega;
                if tree.left == 0 || !(SUBHARMONIC_NET_NEAR.0..=SUBHARMONIC_NET_NEAR.1).contains(&ratio) {
                    continue;
                }
                let largest = shape.iter().fold(0.0_f64, |most, x| most.max(x.norm()));
                let mut added = try_vec(2 * ndof, Complex64::ZERO, CONTEXT)?;
                for (x, shape) in added[ndof..].iter_mut().zip(shape) {
                    *x = shape * (size / largest);
                }
                let mut known = Vec::new();
                for sibling in branch.children().iter().filter(|sibling| sibling.periods() == order) {
                    try_push(&mut known, sibling, CONTEXT)?;
                }
                let net = Net { order, added: &added };
                let inside = Inside {
                    omega,
                    content: Content { base: 1, even: true },
                    leaves: None,
                    known: &known,
                    periods: order,
                    entry: Cell::default(),
                    net: Some(&net),
                    deflation: None,
                };
                tree.searched.starts += 1;
                let way = (order, branch.response_dof());
                let Found::Curve(curve, _) = tree.at_period(&model, &inside, &guess, way, hooks)? else {
                    continue;
                };
                let whole = tree.whole(&model, &curve, order, hooks)?;
                let mut found = whole.unwrap_or(curve);
                tree.left -= 1;
                found.set_descent(Descent {
                    periods: order,
                    mode: Some(number),
                    ..Descent::default()
                });
                tree.add(branch, found, (order, depth), hooks)?;
            }
        }
    }
    Ok(())
}
