//! All undamped modes of a pencil K φ = λ M φ by dense algebra, soft ones beside stiff springs as well.
//!
//! Dense eigenvalues err by ε times the largest one. Where a penalty makes that far larger than the lowest, these come from the pencil
//! turned round, M φ = μ (K + σM) φ, whose errors are ε times the largest μ = 1/(λ + σ), and which is refined
//! ([`refined_modes`]). σ = 0 where K is positive definite, else the stiffness of the softest degree of freedom over its mass: motions
//! that nothing holds have μ = 1/σ then. Each mode is taken from the pencil that has it with the smaller error.

use crate::error::{Result, Status, check_memory, try_push};
use crate::interrupt::Interrupt;
use crate::linalg::dense::eigen::{self, Pairs};
use crate::linalg::exact_sums::quadratic::quadratic;
use crate::linalg::iterative::refined_modes::{self, dense};
use crate::linalg::sparse_storage::sparse::{Csc, Form};
use num_complex::Complex64;

/// Largest number of square matrices that [`eigen::generalised`] holds at a time.
/// Kind: fixed.
pub(super) const EIGEN_COPIES: usize = 8;

/// Largest eigenvalue over the smallest from which the lowest ones are sought in the pencil turned round. They have eleven digits
/// up to there.
/// Kind: rounding.
const GRADED: f64 = 1e5;

/// Relative distance of eigenvalues that are taken from one pencil.
/// Kind: rounding.
const ALL_UNDAMPED_TOGETHER: f64 = 1e-3;

const CONTEXT: &str = "the natural modes";

/// All modes, as [`eigen::generalised`] has them.
///
/// # Errors
/// As [`eigen::generalised`]; `OutOfMemory`.
pub(crate) fn all_undamped(stiffness: &Csc, mass: &Csc, interrupt: &Interrupt<'_>) -> Result<Pairs> {
    let n = stiffness.rows;
    // The eigensolver allocates through nalgebra, which aborts the process when memory is exhausted.
    check_memory::<Complex64>(n.saturating_mul(n).saturating_mul(EIGEN_COPIES), CONTEXT)?;
    let whole = |a: &Csc| dense(a, &a.values);
    let mut pairs = eigen::generalised(&whole(stiffness)?, &whole(mass)?, interrupt)?;
    let sizes = pairs.values.iter().map(|x| x.abs());
    let (least, largest) = sizes.fold((f64::INFINITY, 0.0_f64), |(least, most), x| (least.min(x), most.max(x)));
    if largest > GRADED * least {
        for shift in [Some(0.0), softest(stiffness, mass)].into_iter().flatten() {
            if replace_soft(&mut pairs, stiffness, mass, shift, interrupt)? {
                break;
            }
        }
    }
    Ok(pairs)
}

/// The least stiffness of a degree of freedom alone over its mass; `None` where that is none.
fn softest(stiffness: &Csc, mass: &Csc) -> Option<f64> {
    let own = |j| (stiffness.get(j, j).re, mass.get(j, j).re);
    let quotients = (0..mass.rows).map(own).filter(|&(_, m)| m > 0.0).map(|(k, m)| k / m);
    let least = quotients.fold(f64::INFINITY, f64::min);
    (least > 0.0 && least.is_finite()).then_some(least)
}

/// Replaces the modes that the pencil turned round about −`shift` has with the smaller error; `false` where it has no solution.
fn replace_soft(pairs: &mut Pairs, stiffness: &Csc, mass: &Csc, shift: f64, interrupt: &Interrupt<'_>) -> Result<bool> {
    let n = stiffness.rows;
    let largest = pairs.values.last().copied().unwrap_or(0.0);
    let terms = [
        (Complex64::ONE, stiffness, Form::Plain),
        (shift.into(), mass, Form::Plain),
    ];
    let shifted = Csc::sum(n, &terms)?;
    let mut masses = Vec::new();
    for j in 0..n {
        for (i, _) in shifted.column(j) {
            try_push(&mut masses, mass.get(i, j), CONTEXT)?;
        }
    }
    let turned = match refined_modes::modes(&shifted, &masses, interrupt) {
        Ok(turned) => turned,
        Err(e) if matches!(e.status, Status::OutOfMemory | Status::StoppedByCaller) => return Err(e),
        Err(_) => return Ok(false),
    };
    let lowest = turned.values.last().copied().unwrap_or(0.0);
    if turned.values.len() != n || lowest <= 0.0 {
        return Ok(false);
    }
    // Both errors, ε μ_max λ² and ε λ_max, are equal at their geometric mean. Modes of about one frequency stay together.
    let soft = |mu: f64| mu > 0.0 && mu * mu * largest >= lowest;
    let mut count = 0;
    let mut last = f64::INFINITY;
    for &mu in turned.values.iter().rev().take(pairs.values.len()) {
        let is_beside = mu > 0.0 && last - mu <= ALL_UNDAMPED_TOGETHER * last;
        if !(soft(mu) || is_beside) {
            break;
        }
        last = mu;
        count += 1;
    }
    for i in 0..count {
        interrupt.check()?;
        let shape = turned.vectors.column(n - 1 - i);
        let (k, m) = (
            quadratic(stiffness, shape.as_slice()),
            quadratic(mass, shape.as_slice()),
        );
        pairs.values[i] = k / m;
        for (to, z) in pairs.vectors.column_mut(i).iter_mut().zip(shape.iter()) {
            *to = z / m.sqrt();
        }
    }
    Ok(true)
}
