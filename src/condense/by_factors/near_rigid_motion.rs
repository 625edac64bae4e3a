//! Motion of the structure whose near-rigid contacts have the relative motions y of the solution.
//!
//! A solution meets y = W x to its residual, a small number against y. Over a stuck near-rigid contact the same number
//! is a force kt (y − W x) that is not small: the motion x = Z⁻¹ (F − Wᴴ w) of the structure under the contact forces
//! is in balance with w, but the forces of its own relative motion W x are not. Forces κ (y − W x) of the size of the
//! reference stiffness correct x:
//!
//! > x ← x + Z_κ⁻¹ Wᴴ λ, G λ = y − W x, G = W Z_κ⁻¹ Wᴴ.

use crate::condense::Condensed;
use crate::condense::by_factors::flexibility::Workspace;
use crate::error::{Result, try_copy, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::least_squares::LeastSquares;
use num_complex::Complex64;

const CONTEXT: &str = "the motion of near-rigid contacts";

/// Largest number of corrections: each leaves the rounding of the last.
/// Kind: cap.
const CORRECTIONS: usize = 4;

/// Relative size below which a direction of G is no flexibility: relative motions that depend on each other.
/// Kind: rounding.
const RANK: f64 = 1e-11;

/// Corrects the motion `x` of the i-th carried harmonic at `omega` so that near-rigid coordinates have their share of
/// the relative motions `y`. `workspace` has the factors of this harmonic.
pub fn correct(
    workspace: &mut Workspace,
    condensed: &Condensed,
    (i, omega): (usize, f64),
    y: &[Complex64],
    x: &mut [Complex64],
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    let mut rigid = Vec::new();
    for c in (0..condensed.coordinates()).filter(|&c| condensed.is_near_rigid(c)) {
        try_push(&mut rigid, c, CONTEXT)?;
    }
    if rigid.is_empty() {
        return Ok(());
    }
    let rows = &condensed.blocks()[i].motions.rows;
    let (n, order) = (x.len(), 2 * rigid.len());
    let columns = workspace.contact_columns(condensed, i, omega, interrupt)?;
    let mut system = LeastSquares::new(order, interrupt)?;
    let mut lambda = try_vec(order, 0.0, CONTEXT)?;
    let mut last = f64::INFINITY;
    let mut before = try_copy(x, CONTEXT)?;
    for _ in 0..=CORRECTIONS {
        let mut size = 0.0;
        for (lambda, &c) in lambda.chunks_exact_mut(2).zip(&rigid) {
            let missing = y[c] - rows[c].along(x);
            lambda.copy_from_slice(&[missing.re, missing.im]);
            size += missing.norm_sqr();
        }
        if size.is_nan() || size >= last {
            // The last correction was no gain.
            x.copy_from_slice(&before);
            break;
        }
        if size == 0.0 {
            break;
        }
        last = size;
        before.copy_from_slice(x);
        for (k, &column) in rigid.iter().enumerate() {
            for (j, &row) in rigid.iter().enumerate() {
                let g = rows[row].along(&columns[column * n..(column + 1) * n]);
                let (re, im) = (2 * k * order + 2 * j, (2 * k + 1) * order + 2 * j);
                system.matrix()[re..re + 2].copy_from_slice(&[g.re, g.im]);
                system.matrix()[im..im + 2].copy_from_slice(&[-g.im, g.re]);
            }
        }
        system.solve(&mut lambda, RANK, interrupt)?;
        for (lambda, &c) in lambda.chunks_exact(2).zip(&rigid) {
            let lambda = Complex64::new(lambda[0], lambda[1]);
            for (x, z) in x.iter_mut().zip(&columns[c * n..(c + 1) * n]) {
                *x += lambda * z;
            }
        }
    }
    Ok(())
}
