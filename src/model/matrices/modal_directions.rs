//! Damping ratios of a few modes as their directions: C = R + L Lᴴ with one column of L for each mode and a matrix R without modal
//! damping, which is sparse where the structure is.

use crate::error::{Result, try_copy, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::iterative::block_krylov::SparseVector;
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;
use crate::linalg::sparse_storage::sparse::{Columns, Csc, Form};
use crate::model::matrices::structure::Structure;
use crate::model::matrices::wave::Wave;
use num_complex::Complex64;

const CONTEXT: &str = "the directions of the modal damping";

/// Degrees of freedom up to which the matrix of modal damping is as good as its directions.
/// Kind: tuned; measured on: chains of 50 to 200.
const WHOLE_UP_TO: usize = 100;

/// Degrees of freedom over directions, and the most directions: each costs a solution with the factors at every frequency.
/// Kind: cap.
const DEGREES_PER_MODE: usize = 6;
const MOST_DAMPED_MODES: usize = 200;

/// Part of a diagonal entry that is left of it, beyond which a direction is none of rounding.
/// Kind: rounding.
const LEFT_OF_MODES: f64 = 1e-13;

/// Damping of a wave without that of modes, and the columns of L; `None` where the modal damping has no few directions.
///
/// # Errors
/// As [`Structure::wave_matrix`]; `StoppedByCaller`.
pub(crate) fn split_damping(
    structure: &Structure,
    wave: Wave,
    interrupt: &Interrupt<'_>,
) -> Result<Option<(Csc, Vec<SparseVector>)>> {
    let n = structure.ndof();
    if n <= WHOLE_UP_TO || structure.whole_wheel().is_some() {
        return Ok(None);
    }
    let Some((matrix, form)) = structure.modal_damping_of_wave(wave) else {
        return Ok(None);
    };
    // The mean has the real part alone.
    if matches!(wave, Wave::Harmonic(0)) && !matrix.is_real() {
        return Ok(None);
    }
    let most = (n / DEGREES_PER_MODE).min(MOST_DAMPED_MODES);
    let Some(mut directions) = directions(matrix, most, interrupt)? else {
        return Ok(None);
    };
    if form == Form::Conjugated {
        for (_, z) in directions.iter_mut().flatten() {
            *z = z.conj();
        }
    }
    let rest = structure.damping_beside_modes(wave)?;
    Ok(Some((rest, directions)))
}

/// The columns of L of a matrix L Lᴴ by Cholesky's method with pivots, which are compared after division by their diagonal entries, so that
/// units do not matter; `None` where there would be more than `most`.
fn directions(matrix: &KeptMatrix, most: usize, interrupt: &Interrupt<'_>) -> Result<Option<Vec<SparseVector>>> {
    let n = matrix.order();
    let mut own = try_vec(n, 0.0, CONTEXT)?;
    for (j, own) in own.iter_mut().enumerate() {
        *own = Columns::get(matrix, j, j).re;
    }
    let mut left = try_copy(&own, CONTEXT)?;
    let mut factor: Vec<Vec<Complex64>> = Vec::new();
    let share = |left: &[f64], p: usize| if own[p] > 0.0 { left[p] / own[p] } else { 0.0 };
    loop {
        interrupt.check_before(8 * (n * (factor.len() + 1)) as u64)?;
        let pivot = (0..n).max_by(|&a, &b| share(&left, a).total_cmp(&share(&left, b)));
        let Some(p) = pivot.filter(|&p| share(&left, p) > LEFT_OF_MODES) else {
            break;
        };
        if factor.len() == most {
            return Ok(None);
        }
        let mut column = try_vec(n, Complex64::ZERO, CONTEXT)?;
        matrix.visit(p, |i, z| column[i] = z);
        for known in factor.iter().filter(|known| known[p] != Complex64::ZERO) {
            let part = known[p].conj();
            for (to, z) in column.iter_mut().zip(known) {
                *to -= z * part;
            }
        }
        let scale = left[p].sqrt().recip();
        for (z, left) in column.iter_mut().zip(&mut left) {
            *z *= scale;
            *left -= z.norm_sqr();
        }
        left[p] = 0.0;
        try_push(&mut factor, column, CONTEXT)?;
    }
    let mut found = Vec::new();
    for column in factor {
        let mut direction = Vec::new();
        for (i, z) in column.into_iter().enumerate().filter(|(_, z)| *z != Complex64::ZERO) {
            try_push(&mut direction, (i, z), CONTEXT)?;
        }
        try_push(&mut found, direction, CONTEXT)?;
    }
    Ok(Some(found))
}
