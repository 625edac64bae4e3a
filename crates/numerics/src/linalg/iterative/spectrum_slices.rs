//! The eigenpairs of an interval of a large sparse pencil K φ = λ M φ, slice by slice (spectrum slicing; Grimes, Lewis & Simon 1994,
//! doi:10.1137/S0895479888151111).

use crate::error::{Result, try_extend, try_push};
use crate::interrupt::Interrupt;
use crate::linalg::dense::eigen::Pairs;
use crate::linalg::factors::inertia::eigenvalues_below;
use crate::linalg::iterative::lanczos::within_at_once;
use crate::linalg::sparse_storage::sparse::Csc;
use nalgebra::DMatrix;

const CONTEXT: &str = "the eigenvectors";

/// Eigenvalues of a slice.
/// Kind: tuned; measured on: a chain of 3,000 masses with 190 and 3,000 eigenvalues, this number alone.
const PER_SLICE: usize = 48;

/// Most eigenvalues of a search that is not cut.
/// Kind: cap.
const SEARCHED_AT_ONCE: usize = 500;

/// Halvings of an interval within which a slice is found: eigenvalues that are closer are together.
/// Kind: cap.
const SLICE_HALVINGS: usize = 40;

/// All eigenpairs with λ in an interval (low, high), mass-normalised and ascending; `None` if they are more than `most`.
///
/// Their orthogonalisation costs as the square of their number. Where that is large, and known by the law of inertia, the interval is
/// cut into slices of few.
///
/// # Errors
/// As [`crate::linalg::iterative::lanczos::lowest`].
pub fn within(
    (k, m): (&Csc, &Csc),
    (low, high): (f64, f64),
    most: usize,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Pairs>> {
    let real = k.is_real() && m.is_real();
    let below = |sigma: f64| -> Result<Option<usize>> {
        let counted = eigenvalues_below(k, (sigma, m), real, interrupt)?;
        Ok(counted.map(|below| below.count))
    };
    let (first, end) = (below(low)?, below(high)?);
    if let (Some(first), Some(end)) = (first, end) {
        let count = end.saturating_sub(first);
        if count > most {
            return Ok(None);
        }
        if count > PER_SLICE
            && let Some(pairs) = in_slices(k, m, (low, first), (high, end), &below, interrupt)?
        {
            return Ok(Some(pairs));
        }
    }
    within_at_once((k, m), (low, high), most.min(SEARCHED_AT_ONCE), interrupt)
}

/// Searches the interval slice by slice, from the numbers of eigenvalues below both ends; `None` where some slice cannot be searched, or the slices have
/// another number of them in all, as where one is on an end.
fn in_slices(
    k: &Csc,
    m: &Csc,
    (low, first): (f64, usize),
    (high, end): (f64, usize),
    below: &impl Fn(f64) -> Result<Option<usize>>,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Pairs>> {
    let n = k.rows;
    let (mut values, mut vectors) = (Vec::new(), Vec::new());
    let mut waiting = Vec::new();
    try_push(&mut waiting, ((low, first), (high, end), SLICE_HALVINGS), CONTEXT)?;
    while let Some((from, to, halvings)) = waiting.pop() {
        interrupt.check()?;
        let count = to.1.saturating_sub(from.1);
        if count == 0 {
            continue;
        }
        if count > PER_SLICE && halvings > 0 {
            let middle = 0.5 * (from.0 + to.0);
            let Some(known) = below(middle)? else {
                return Ok(None);
            };
            // The lower half comes first.
            try_push(&mut waiting, ((middle, known), to, halvings - 1), CONTEXT)?;
            try_push(&mut waiting, (from, (middle, known), halvings - 1), CONTEXT)?;
            continue;
        }
        let Some(pairs) = within_at_once((k, m), (from.0, to.0), SEARCHED_AT_ONCE, interrupt)? else {
            return Ok(None);
        };
        if pairs.values.len() != count {
            return Ok(None);
        }
        try_extend(&mut values, &pairs.values, CONTEXT)?;
        try_extend(&mut vectors, pairs.vectors.as_slice(), CONTEXT)?;
    }
    let found = values.len();
    Ok((found == end - first).then(|| Pairs {
        values,
        vectors: DMatrix::from_vec(n, found, vectors),
    }))
}

#[cfg(test)]
#[path = "spectrum_slices_tests.rs"]
mod tests;
