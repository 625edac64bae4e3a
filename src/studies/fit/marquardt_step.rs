//! Steps of Levenberg and Marquardt: (H + λ diag H) s = −g, over the unknowns that are free to move.

use crate::error::{Result, Status, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::lu::Lu;

const CONTEXT: &str = "a step of a fit";

/// Least diagonal entry over the largest one: unknowns that no datum sees stay where they are.
/// Kind: rounding.
const STEP_FLOOR: f64 = 1e-14;

/// The step s of all unknowns; 0 where `moves` is false.
///
/// # Errors
/// `OutOfMemory`, `StoppedByCaller`, `Singular`.
pub(super) fn marquardt_step(
    h: &[f64],
    g: &[f64],
    lambda: f64,
    moves: &[bool],
    interrupt: &Interrupt<'_>,
) -> Result<Vec<f64>> {
    let n = g.len();
    let largest = (0..n).map(|k| h[k * n + k]).fold(0.0_f64, f64::max);
    let floor = STEP_FLOOR * largest;
    let mut system = Lu::new(n, 1)?;
    let mut step = try_vec(n, 0.0, CONTEXT)?;
    let matrix = system.matrix();
    for i in 0..n {
        for j in 0..n {
            matrix[j * n + i] = match (i == j, moves[i] && moves[j]) {
                (true, true) => h[i * n + i] + lambda * h[i * n + i].max(floor) + floor,
                (true, false) => 1.0,
                (false, true) => h[i * n + j],
                (false, false) => 0.0,
            };
        }
        if moves[i] {
            step[i] = -g[i];
        }
    }
    if largest == 0.0 {
        step.fill(0.0);
        return Ok(step);
    }
    match system.factor(interrupt) {
        Err(e) if e.status == Status::Singular => step.fill(0.0),
        factored => {
            factored?;
            system.solve(&mut step);
        }
    }
    Ok(step)
}

/// The inverse of a positive definite matrix over the unknowns that move, 0 elsewhere.
///
/// # Errors
/// As [`marquardt_step`].
pub(super) fn inverse(h: &[f64], moves: &[bool], interrupt: &Interrupt<'_>) -> Result<Vec<f64>> {
    let n = moves.len();
    let mut found = try_vec(n * n, 0.0, CONTEXT)?;
    // In units of its diagonal the matrix has entries of one size.
    let scale = |k: usize| 1.0 / h[k * n + k].sqrt();
    let mut system = Lu::new(n, 1)?;
    let matrix = system.matrix();
    for i in 0..n {
        for j in 0..n {
            matrix[j * n + i] = match (moves[i] && moves[j], i == j) {
                (true, _) => h[i * n + j] * scale(i) * scale(j),
                (false, true) => 1.0,
                (false, false) => 0.0,
            };
        }
    }
    system.factor(interrupt)?;
    for j in (0..n).filter(|j| moves[*j]) {
        let mut column = try_vec(n, 0.0, CONTEXT)?;
        column[j] = 1.0;
        system.solve(&mut column);
        for i in (0..n).filter(|i| moves[*i]) {
            found[i * n + j] = column[i] * scale(i) * scale(j);
        }
    }
    Ok(found)
}
