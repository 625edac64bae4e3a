//! The rules by which structs cross the C boundary: they begin with their size, grow at their end only, and
//! a field that one side does not know has its default there.

use crate::capi::crossing::arrays::check_pointer;
use crate::error::{Error, Result, Status};

/// A struct that begins with its size in bytes, so that it can grow at its end.
///
/// # Safety
/// `repr(C)`, begins with a `u32`, no padding, any bits are a value.
pub(crate) unsafe trait VersionedStruct: Copy {
    /// Name in the header.
    const NAME: &'static str;
    /// Size of its first version.
    const FIRST_SIZE: usize;
    /// The struct as `_init` fills it, but for its size.
    fn defaults() -> Self;
}

/// A size above this is taken for an uninitialised field, not for a newer header.
const LARGEST: usize = 4096;

/// Checks a stated size.
fn check_size<T: VersionedStruct>(size: usize, argument: i32) -> Result<()> {
    if size >= T::FIRST_SIZE && size <= LARGEST && size.is_multiple_of(8) {
        return Ok(());
    }
    Err(Error::new(
        Status::StructSize,
        format_args!(
            "{}: struct_size = {size}, needs {} = sizeof; fill the struct by {}_init",
            T::NAME,
            size_of::<T>(),
            T::NAME
        ),
    )
    .in_argument(argument))
}

/// Fills a struct of the caller, of size `size`, with its defaults.
///
/// # Safety
/// The caller of the C function states that `size` writable bytes lie at `p`.
pub(crate) unsafe fn init<T: VersionedStruct>(p: *mut T, size: usize) -> Result<Status> {
    check_pointer(p, 1, T::NAME)?;
    check_size::<T>(size, 2)?;
    unsafe { store(p, size, T::defaults()) };
    Ok(Status::Ok)
}

/// Writes as much of `value` as the struct of the caller holds, and zeros into fields unknown here.
unsafe fn store<T: VersionedStruct>(p: *mut T, size: usize, value: T) {
    unsafe {
        let bytes = p.cast::<u8>();
        bytes.write_bytes(0, size);
        bytes.copy_from_nonoverlapping((&raw const value).cast(), size.min(size_of::<T>()));
        p.cast::<u32>().write(size as u32);
    }
}

/// Reads a struct of the caller. Fields that it does not have take their defaults; fields unknown
/// here must be zero.
///
/// # Safety
/// The caller of the C function states that a struct of its stated size lies at `p`.
pub(crate) unsafe fn load<T: VersionedStruct>(p: *const T, argument: i32) -> Result<T> {
    check_pointer(p, argument, T::NAME)?;
    let size = unsafe { p.cast::<u32>().read() } as usize;
    check_size::<T>(size, argument)?;
    let known = size_of::<T>();
    let bytes = p.cast::<u8>();
    for i in known..size.max(known) {
        if unsafe { bytes.add(i).read() } != 0 {
            return Err(Error::new(
                Status::StructSize,
                format_args!(
                    "{}: struct_size = {size}, but only {known} bytes are known here and byte {i} is not 0; use a newer library",
                    T::NAME
                ),
            )
            .in_argument(argument));
        }
    }
    let mut value = T::defaults();
    unsafe {
        (&raw mut value)
            .cast::<u8>()
            .copy_from_nonoverlapping(bytes, size.min(known));
    };
    Ok(value)
}

/// Checks a struct for results, whose size the caller has stated.
///
/// # Safety
/// Those of [`load`].
pub(crate) unsafe fn check_out<T: VersionedStruct>(p: *const T, argument: i32) -> Result<()> {
    check_pointer(p, argument, T::NAME)?;
    check_size::<T>(unsafe { p.cast::<u32>().read() } as usize, argument)
}

/// Writes a struct of results that [`check_out`] has checked.
///
/// # Safety
/// Those of [`load`].
pub(crate) unsafe fn fill_out<T: VersionedStruct>(p: *mut T, value: T) {
    unsafe { store(p, p.cast::<u32>().read() as usize, value) };
}

/// Refuses reserved fields that are not zero.
pub(crate) fn check_reserved(value: i32, argument: i32, name: &str) -> Result<()> {
    if value == 0 {
        return Ok(());
    }
    Err(Error::new(Status::Argument, format_args!("{name}: reserved = {value}, needs 0")).in_argument(argument))
}
