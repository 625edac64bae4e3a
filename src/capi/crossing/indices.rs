//! Counts, indices and degrees of freedom of the caller: checked.

use crate::capi::crossing::arrays::{check_pointer, count, input};
use crate::capi::crossing::boundary::WithArgument;
use crate::error::{Error, Result, Status, fail, try_push};
use crate::results::MOST_TIMES;
use core::fmt;

/// HBVIB_GROUND, the degree of freedom of the ground.
pub(crate) const GROUND: i64 = -1;

/// A count of the caller, at least 1.
pub(crate) fn at_least_1(value: i64, argument: i32, name: &str) -> Result<usize> {
    match count(value, argument, name)? {
        0 => fail!(Dimension, "{name} = 0, needs a count >= 1").with_argument(argument),
        n => Ok(n),
    }
}

/// A number of the caller that must not be negative; a negative one is an argument out of range.
pub(crate) fn number(value: i64, name: &str) -> Result<usize> {
    match usize::try_from(value) {
        Ok(v) => Ok(v),
        Err(_) => fail!(Argument, "{name} = {value}, needs a number >= 0"),
    }
}

/// An index of the caller below `limit`.
pub(crate) fn index(value: i64, limit: usize, argument: i32, name: &str) -> Result<usize> {
    usize::try_from(value).ok().filter(|&i| i < limit).ok_or_else(|| {
        let error = if limit == 0 {
            Error::new(Status::Index, format_args!("{name} = {value}, but there is none"))
        } else {
            Error::new(
                Status::Index,
                format_args!("{name} = {value}, needs 0 .. {}", limit - 1),
            )
        };
        error.in_argument(argument)
    })
}

/// A list of indices of the caller below `limit`.
pub(crate) fn indices(values: &[i64], limit: usize, argument: i32, name: &str) -> Result<Vec<usize>> {
    let mut list = Vec::new();
    for (i, &value) in values.iter().enumerate() {
        match usize::try_from(value).ok().filter(|&value| value < limit) {
            Some(value) => try_push(&mut list, value, name)?,
            None => return fail!(Index, "{name}[{i}] = {value}, needs 0 .. {}", limit - 1).with_argument(argument),
        }
    }
    Ok(list)
}

/// One side of a contact or spring.
pub(crate) fn side(dof: i64, ndof: usize, argument: i32, name: fmt::Arguments<'_>) -> Result<Option<usize>> {
    match dof {
        GROUND => Ok(None),
        dof if (0..ndof as i64).contains(&dof) => Ok(Some(dof as usize)),
        dof => fail!(Index, "{name} = {dof}, needs 0 .. {} or HBVIB_GROUND = -1", ndof - 1).with_argument(argument),
    }
}

/// The sides of contacts or springs from arrays: arguments 3 to 5.
pub(crate) struct Sides<'a> {
    a: &'a [i64],
    b: &'a [i64],
    offsets: Option<&'a [i64]>,
    ndof: usize,
}

impl Sides<'_> {
    /// # Safety
    /// As for [`input`]; `sector_offset` may be NULL.
    pub(crate) unsafe fn new(
        dof_a: *const i64,
        dof_b: *const i64,
        sector_offset: *const i64,
        n: usize,
        ndof: usize,
    ) -> Result<Self> {
        Ok(Self {
            a: unsafe { input(dof_a, n, 3, "dof_a") }?,
            b: unsafe { input(dof_b, n, 4, "dof_b") }?,
            offsets: if sector_offset.is_null() {
                None
            } else {
                Some(unsafe { input(sector_offset, n, 5, "sector_offset") }?)
            },
            ndof,
        })
    }

    /// Side a, side b and sector offset of entry `i`.
    pub(crate) fn entry(&self, i: usize) -> Result<(Option<usize>, Option<usize>, i64)> {
        let side = |dofs: &[i64], argument, name: &str| side(dofs[i], self.ndof, argument, format_args!("{name}[{i}]"));
        let offset = self.offsets.map_or(0, |o| o[i]);
        Ok((side(self.a, 3, "dof_a")?, side(self.b, 4, "dof_b")?, offset))
    }
}

/// The degrees of freedom of a law over several motions: argument 2. The ground is not among them.
///
/// # Safety
/// Those of [`input`].
pub(crate) unsafe fn list(dofs: *const i64, n: usize, ndof: usize) -> Result<Vec<usize>> {
    let mut list = Vec::new();
    for (i, &dof) in unsafe { input(dofs, n, 2, "dofs") }?.iter().enumerate() {
        match usize::try_from(dof) {
            Ok(dof) if dof < ndof => try_push(&mut list, dof, "an element")?,
            _ => return fail!(Index, "dofs[{i}] = {dof}, needs 0 .. {}", ndof - 1).with_argument(2),
        }
    }
    Ok(list)
}

/// Checks a pointer to one number that may be NULL.
pub(crate) fn check_id(id: *mut i64, argument: i32, name: &str) -> Result<()> {
    if id.is_null() {
        return Ok(());
    }
    check_pointer(id, argument, name)
}

/// Attributes an error in a constant to the array that its sentence names.
pub(crate) fn with_named_argument(e: Error, arrays: &[(&str, i32)]) -> Error {
    let found = arrays.iter().find(|(name, _)| e.message().contains(name));
    e.in_argument(found.map_or(0, |&(_, argument)| argument))
}

/// A number of times of the caller.
pub(crate) fn times(n: i64, argument: i32) -> Result<usize> {
    match usize::try_from(n) {
        Ok(times @ 1..=MOST_TIMES) => Ok(times),
        _ => fail!(Dimension, "n = {n}, needs 1 .. {MOST_TIMES}").with_argument(argument),
    }
}
