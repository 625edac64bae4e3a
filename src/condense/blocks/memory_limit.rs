//! The limit of memory that the caller sets: what needs more is refused before it is allocated.

use crate::error::{Error, Result, Status};
use crate::linalg::factors::factor::Factor;
use crate::model::Model;
use crate::model::matrices::structure::MatrixKind;
use num_complex::Complex64;

/// Arrays of matrix entries that each harmonic has where no basis is used.
/// Kind: fixed.
const ARRAYS: usize = 5;

/// Refuses a `need` of bytes above the `limit`; a limit of 0 allows all.
pub fn within(limit: usize, need: usize) -> Result<()> {
    if limit == 0 || need <= limit {
        return Ok(());
    }
    Err(beyond(format_args!(
        "factors and matrices need about {} MB, more than memory_limit = {limit} bytes; raise it, or reduce model or harmonics",
        mega(need)
    )))
}

/// The error for a need of memory above the limit.
pub fn beyond(sentence: std::fmt::Arguments<'_>) -> Error {
    Error::new(Status::OutOfMemory, sentence).beyond_limit()
}

/// Converts bytes to MB, rounded up.
pub fn mega(bytes: usize) -> usize {
    bytes.div_ceil(1 << 20)
}

/// Bytes of a condensed model for each of its contacts.
/// Kind: tuned; measured on: not recorded.
const OF_A_CONTACT: usize = 500;

/// Refuses a model whose contacts alone would exceed the limit.
pub(crate) fn within_for_contacts(limit: usize, model: &Model) -> Result<()> {
    let contacts = model.contacts().len();
    let need = contacts.saturating_mul(OF_A_CONTACT);
    if limit == 0 || need <= limit {
        return Ok(());
    }
    Err(beyond(format_args!(
        "{contacts} contacts need about {} MB beside the model, more than memory_limit = {limit} bytes; raise it to {need} at least, \
         or gather contacts between the same degrees of freedom",
        mega(need)
    )))
}

/// Refuses a model whose matrices would exceed the limit, where its factors need less than these.
pub(crate) fn within_matrices(limit: usize, model: &Model, numbers: &[usize]) -> Result<()> {
    if limit == 0 {
        return Ok(());
    }
    let number = numbers.first().copied().unwrap_or(0);
    let k = model.structure().wave_matrix(MatrixKind::Stiffness, number)?;
    let matrices = k.values.len() * (ARRAYS * size_of::<Complex64>() + size_of::<usize>());
    within(limit, (1 + numbers.len()) * matrices)
}

/// Refuses a model whose matrices and complex LU factors would exceed the limit.
pub(crate) fn within_directly(limit: usize, model: &Model, numbers: &[usize]) -> Result<()> {
    if limit == 0 {
        return Ok(());
    }
    let number = numbers.first().copied().unwrap_or(0);
    let k = model.structure().wave_matrix(MatrixKind::Stiffness, number)?;
    let matrices = k.values.len() * (ARRAYS * size_of::<Complex64>() + size_of::<usize>());
    within(limit, Factor::bytes(&k)? + numbers.len() * matrices)
}
