//! Pointers and arrays of the caller: checked, and borrowed as slices.

use crate::capi::crossing::boundary::WithArgument;
use crate::error::{Error, Result, Status, fail};

/// A length or count of the caller; negative ones are refused.
pub(crate) fn count(value: i64, argument: i32, name: &str) -> Result<usize> {
    usize::try_from(value).map_err(|_| {
        Error::new(Status::Dimension, format_args!("{name} = {value}, needs a count >= 0")).in_argument(argument)
    })
}

/// Refuses a pointer that is NULL or not aligned for `T`.
pub(crate) fn check_pointer<T>(p: *const T, argument: i32, name: &str) -> Result<()> {
    if p.is_null() {
        return Err(Error::new(Status::Null, format_args!("{name} is NULL")).in_argument(argument));
    }
    if !p.is_aligned() {
        return Err(Error::new(
            Status::Argument,
            format_args!(
                "{name} = {p:p} is misaligned, needs a multiple of {} bytes",
                align_of::<T>()
            ),
        )
        .in_argument(argument));
    }
    Ok(())
}

/// A pointer that may be NULL but not misaligned.
pub(crate) fn optional<T>((p, argument): (*mut T, i32), name: &str) -> Result<Option<*mut T>> {
    if p.is_null() {
        return Ok(None);
    }
    check_pointer(p, argument, name)?;
    Ok(Some(p))
}

/// Writes an entry of an array of the caller, unless it is NULL.
pub(crate) unsafe fn put<T>(p: *mut T, i: usize, value: T) {
    if !p.is_null() {
        unsafe { p.add(i).write(value) };
    }
}

/// The number of bytes that `len` values take, refused where no array in memory can be so long.
fn byte_len<T>(p: *const T, len: usize, argument: i32, name: &str) -> Result<usize> {
    len.checked_mul(size_of::<T>())
        .filter(|&bytes| isize::try_from(bytes).is_ok() && p.addr().checked_add(bytes).is_some())
        .ok_or_else(|| {
            Error::new(
                Status::Dimension,
                format_args!("{name}: {len} entries cannot lie in memory"),
            )
            .in_argument(argument)
        })
}

/// A borrowed input array; an empty one may be NULL.
///
/// # Safety
/// The caller of the C function states that `len` readable values lie at `p`.
pub(crate) unsafe fn input<'a, T>(p: *const T, len: usize, argument: i32, name: &str) -> Result<&'a [T]> {
    if len == 0 && p.is_null() {
        return Ok(&[]);
    }
    check_pointer(p, argument, name)?;
    byte_len(p, len, argument, name)?;
    Ok(unsafe { core::slice::from_raw_parts(p, len) })
}

/// A borrowed output array.
///
/// # Safety
/// The caller of the C function states that `len` writable values lie at `p`; it must not overlap
/// any other array in use (see [`disjoint`]).
pub(crate) unsafe fn output<'a, T>(p: *mut T, len: usize, argument: i32, name: &str) -> Result<&'a mut [T]> {
    check_pointer(p, argument, name)?;
    byte_len(p, len, argument, name)?;
    Ok(unsafe { core::slice::from_raw_parts_mut(p, len) })
}

/// A length that must be `needed`.
pub(crate) fn exact_len(len: i64, needed: usize, argument: i32, name: &str) -> Result<usize> {
    match count(len, argument, name) {
        Ok(len) if len == needed => Ok(len),
        _ => fail!(Dimension, "length = {len}, needs {name} = {needed}").with_argument(argument),
    }
}

/// The length of an output array that may be NULL, stated in the argument after the array.
pub(crate) fn optional_len(p: *mut f64, len: i64, needed: usize, argument: i32, name: &str) -> Result<usize> {
    if p.is_null() && len == 0 {
        return Ok(0);
    }
    check_pointer(p, argument, name)?;
    exact_len(len, needed, argument + 1, name)
}

/// An array for the check of overlaps.
#[derive(Clone, Copy)]
pub(crate) struct Range {
    begin: usize,
    bytes: usize,
    argument: i32,
    name: &'static str,
}

impl Range {
    /// The range of an array; NULL is the empty one.
    pub(crate) fn new<T>(p: *const T, len: usize, argument: i32, name: &'static str) -> Result<Self> {
        let bytes = if p.is_null() {
            0
        } else {
            byte_len(p, len, argument, name)?
        };
        Ok(Self {
            begin: p.addr(),
            bytes,
            argument,
            name,
        })
    }
}

/// Refuses arrays that overlap: each of `outputs` must be separate from all other arrays.
pub(crate) fn disjoint(inputs: &[Range], outputs: &[Range]) -> Result<()> {
    for (i, a) in outputs.iter().enumerate() {
        for b in inputs.iter().chain(&outputs[..i]) {
            if a.begin < b.begin + b.bytes && b.begin < a.begin + a.bytes {
                return Err(Error::new(
                    Status::Argument,
                    format_args!("{} and {} overlap; they must be separate arrays", a.name, b.name),
                )
                .in_argument(a.argument));
            }
        }
    }
    Ok(())
}

/// A column of a list: its array, which may be NULL, the number of its argument, and its name.
pub(crate) enum Column {
    Reals(*mut f64, i32, &'static str),
    Numbers(*mut i64, i32, &'static str),
}

/// An entry of a list.
#[derive(Clone, Copy)]
pub(crate) enum Entry {
    Real(f64),
    Number(i64),
}

/// Writes a list of `rows` rows column by column, and its length to `length` in any case. Without arrays only the length
/// is written. `capacity` and `length` have the numbers of their arguments.
///
/// # Safety
/// The caller of the C function states that `capacity` values fit into each array.
pub(crate) unsafe fn fill_list<const N: usize>(
    columns: &[Column; N],
    rows: impl ExactSizeIterator<Item = [Entry; N]>,
    capacity: (i64, i32),
    length: (*mut i64, i32),
) -> Result<Status> {
    let room = count(capacity.0, capacity.1, "capacity")?;
    let mut given = false;
    for column in columns {
        given |= match *column {
            Column::Reals(p, argument, name) => optional((p, argument), name)?.is_some(),
            Column::Numbers(p, argument, name) => optional((p, argument), name)?.is_some(),
        };
    }
    check_pointer(length.0, length.1, "count")?;
    unsafe { length.0.write(rows.len() as i64) };
    if !given {
        return Ok(Status::Ok);
    }
    if room < rows.len() {
        return fail!(Dimension, "capacity = {room}, needs {}", rows.len()).with_argument(capacity.1);
    }
    for (i, row) in rows.enumerate() {
        for (column, entry) in columns.iter().zip(row) {
            unsafe {
                match (column, entry) {
                    (Column::Reals(p, ..), Entry::Real(value)) if !p.is_null() => p.add(i).write(value),
                    (Column::Numbers(p, ..), Entry::Number(value)) if !p.is_null() => p.add(i).write(value),
                    _ => {}
                }
            }
        }
    }
    Ok(Status::Ok)
}
