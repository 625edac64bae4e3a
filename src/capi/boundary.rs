//! The border to C: panics become a status, errors the thread's last error, raw pointers slices.

use super::arithmetic::Arithmetic;
use super::told::Told;
use super::types::hbvib_status;
use crate::error::{Error, Result, Status, TEXT_CAPACITY, Text};
use core::cell::{Cell, RefCell};
use core::ffi::{CStr, c_char};
use core::fmt::Write as _;
use std::panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind};
use std::sync::{Once, OnceLock};

/// The thread's last error: a fixed buffer that needs neither memory nor a destructor, so that it
/// can be written when memory is exhausted and the library can be unloaded.
struct LastError {
    /// Ends with NUL.
    text: [u8; TEXT_CAPACITY + 1],
    argument: i32,
}

thread_local! {
    static LAST: RefCell<LastError> = const { RefCell::new(LastError { text: [0; TEXT_CAPACITY + 1], argument: 0 }) };
    /// What a panic inside the library said.
    static PANIC: RefCell<Text> = const { RefCell::new(Text::EMPTY) };
    /// Whether this thread runs code of the library (and not a callback of the host).
    static INSIDE: Cell<bool> = const { Cell::new(false) };
    /// The arithmetic of the call's host, for its callbacks.
    static HOST: Cell<Arithmetic> = const { Cell::new(Arithmetic::DEFAULT) };
}

/// Runs the body of an exported function and turns its outcome into a status. Success empties the
/// last error; anything else fills it.
pub(super) fn call<T: Into<Told>>(body: impl FnOnce() -> Result<T>) -> hbvib_status {
    match guarded(body) {
        Ok(told) => {
            let Told { status, reason } = told.into();
            remember(reason.as_ref().map_or(status.sentence(), Error::message), 0);
            status as hbvib_status
        }
        Err(error) => {
            remember(error.message(), error.argument);
            error.status as hbvib_status
        }
    }
}

/// The same for functions that return a count: negative values are a status.
pub(super) fn call_count(body: impl FnOnce() -> Result<usize>) -> i64 {
    match guarded(body) {
        Ok(count) => {
            remember("", 0);
            i64::try_from(count).unwrap_or(i64::MAX)
        }
        Err(error) => {
            remember(error.message(), error.argument);
            error.status as i64
        }
    }
}

/// Runs a callback of the host, in its own arithmetic: a panic of its own is none of the library's.
pub(super) fn outside<T>(callback: impl FnOnce() -> T) -> T {
    let before = INSIDE.replace(false);
    HOST.get().restore();
    let result = callback();
    // What the host changes in a callback is its business as well.
    HOST.set(Arithmetic::of_the_host());
    Arithmetic::enter();
    INSIDE.set(before);
    result
}

fn guarded<T>(body: impl FnOnce() -> Result<T>) -> Result<T> {
    quiet_panics();
    let before = INSIDE.replace(true);
    let host_before = HOST.replace(Arithmetic::of_the_host());
    Arithmetic::enter();
    let outcome = catch_unwind(AssertUnwindSafe(body));
    HOST.replace(host_before).restore();
    INSIDE.set(before);
    outcome.unwrap_or_else(|_| {
        let said = PANIC.with_borrow(|text| *text);
        Err(Error::new(
            Status::Internal,
            format_args!("defect of the library, please report it: {}", said.as_str()),
        ))
    })
}

/// Installs, once, a panic hook that keeps silent about panics inside the library. All others go
/// to the hook that was there before, so that a Rust host which links the crate is not disturbed.
fn quiet_panics() {
    type Hook = Box<dyn Fn(&PanicHookInfo<'_>) + Send + Sync>;
    static PREVIOUS: OnceLock<Hook> = OnceLock::new();
    static INSTALLED: Once = Once::new();
    if INSTALLED.is_completed() || std::thread::panicking() {
        return;
    }
    INSTALLED.call_once(|| {
        PREVIOUS.get_or_init(std::panic::take_hook);
        // The closure holds nothing, so its box takes no memory that unloading would leak.
        std::panic::set_hook(Box::new(|info| {
            if !INSIDE.get() {
                if let Some(previous) = PREVIOUS.get() {
                    previous(info);
                }
                return;
            }
            PANIC.with(|text| {
                let Ok(mut text) = text.try_borrow_mut() else { return };
                *text = Text::EMPTY;
                // Writing into the fixed buffer cuts, it cannot fail.
                let _ = match info.location() {
                    Some(place) => write!(text, "{}:{}: ", place.file(), place.line()),
                    None => Ok(()),
                };
                let payload = info.payload();
                let said = payload.downcast_ref::<&str>().copied();
                let said = said.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
                let _ = text.write_str(said.unwrap_or("panic"));
            });
        }));
    });
}

fn remember(sentence: &str, argument: i32) {
    LAST.with_borrow_mut(|last| {
        let len = sentence.len().min(TEXT_CAPACITY);
        last.text[..len].copy_from_slice(&sentence.as_bytes()[..len]);
        last.text[len] = 0;
        last.argument = argument;
    });
}

/// Blames an argument of the C function.
pub(super) trait Blame<T> {
    /// The same error with the argument's number, counted from 1, unless one was blamed already.
    fn blame(self, argument: i32) -> Result<T>;
}

impl<T> Blame<T> for Result<T> {
    fn blame(self, argument: i32) -> Result<T> {
        self.map_err(|e| if e.argument == 0 { e.in_argument(argument) } else { e })
    }
}

/// Refuses a pointer that is NULL or not aligned for `T`.
pub(super) fn check_pointer<T>(p: *const T, argument: i32, name: &str) -> Result<()> {
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
pub(super) unsafe fn input<'a, T>(p: *const T, len: usize, argument: i32, name: &str) -> Result<&'a [T]> {
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
pub(super) unsafe fn output<'a, T>(p: *mut T, len: usize, argument: i32, name: &str) -> Result<&'a mut [T]> {
    check_pointer(p, argument, name)?;
    byte_len(p, len, argument, name)?;
    Ok(unsafe { core::slice::from_raw_parts_mut(p, len) })
}

/// An array for the check of overlaps.
#[derive(Clone, Copy)]
pub(super) struct Range {
    begin: usize,
    bytes: usize,
    argument: i32,
    name: &'static str,
}

impl Range {
    /// The range of an array; NULL is the empty one.
    pub(super) fn new<T>(p: *const T, len: usize, argument: i32, name: &'static str) -> Result<Self> {
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

/// Refuses arrays that overlap: each of `outputs` must be apart from all other arrays.
pub(super) fn disjoint(inputs: &[Range], outputs: &[Range]) -> Result<()> {
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

/// A length or count of the caller; negative ones are refused.
pub(super) fn count(value: i64, argument: i32, name: &str) -> Result<usize> {
    usize::try_from(value).map_err(|_| {
        Error::new(Status::Dimension, format_args!("{name} = {value}, needs a count >= 0")).in_argument(argument)
    })
}

/// An index of the caller below `limit`.
pub(super) fn index(value: i64, limit: usize, argument: i32, name: &str) -> Result<usize> {
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

/// Version of the library as major * 65536 + minor * 256 + patch.
///
/// Errors: none. Threads: any.
#[unsafe(no_mangle)]
pub extern "C" fn hbvib_version() -> u32 {
    const fn number(text: &str) -> u32 {
        let mut value = 0;
        let mut i = 0;
        while i < text.len() {
            value = 10 * value + (text.as_bytes()[i] - b'0') as u32;
            i += 1;
        }
        value
    }
    const VERSION: u32 = number(env!("CARGO_PKG_VERSION_MAJOR")) << 16
        | number(env!("CARGO_PKG_VERSION_MINOR")) << 8
        | number(env!("CARGO_PKG_VERSION_PATCH"));
    VERSION
}

/// Version of the library as text, "0.1.0": static, never to be freed.
///
/// Errors: none. Threads: any.
#[unsafe(no_mangle)]
pub extern "C" fn hbvib_version_string() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// Name of a status, "HBVIB_E_SINGULAR": static text, never to be freed. Numbers that are no
/// status give "HBVIB_UNKNOWN_STATUS".
///
/// Errors: none. Threads: any.
#[unsafe(no_mangle)]
pub extern "C" fn hbvib_status_name(status: hbvib_status) -> *const c_char {
    const UNKNOWN: &CStr = c"HBVIB_UNKNOWN_STATUS";
    Status::ALL
        .iter()
        .find(|s| **s as i32 == status)
        .map_or(UNKNOWN, |s| s.name())
        .as_ptr()
}

/// Sentence that explains the outcome of this thread's last call that returned a status or a
/// count: what is wrong, where, and the range that is accepted. Empty after a success. UTF-8, at
/// most 255 bytes, ends with NUL, valid until the thread's next such call.
///
/// Errors: none. Threads: each has its own text and never sees that of another.
#[unsafe(no_mangle)]
pub extern "C" fn hbvib_last_error() -> *const c_char {
    LAST.with(|last| unsafe { (&raw const (*last.as_ptr()).text).cast() })
}

/// Number of the argument that the last error is about, counted from 1 in the order of the
/// function's parameters; 0 where no single argument is to blame, and after a success.
///
/// Errors: none. Threads: each has its own.
#[unsafe(no_mangle)]
pub extern "C" fn hbvib_last_error_argument() -> i32 {
    LAST.with_borrow(|last| last.argument)
}

/// Copies the sentence of hbvib_last_error into a buffer of the caller.
///
/// buffer  receives the text, always NUL-terminated and cut at a whole UTF-8 character where it is
///         too long; may be NULL when only the size is wanted.
/// len     size of the buffer in bytes; 0 writes nothing.
/// Returns the bytes that the whole text needs, its NUL included.
/// Errors: none. Threads: each has its own text.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_last_error_copy(buffer: *mut c_char, len: usize) -> usize {
    LAST.with_borrow(|last| {
        let text = CStr::from_bytes_until_nul(&last.text).map_or("", |t| t.to_str().unwrap_or(""));
        if !buffer.is_null() && len > 0 {
            let mut take = text.len().min(len - 1);
            while !text.is_char_boundary(take) {
                take -= 1;
            }
            unsafe {
                core::ptr::copy_nonoverlapping(text.as_ptr(), buffer.cast(), take);
                buffer.add(take).write(0);
            }
        }
        text.len() + 1
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// Panics that the host's own hook has seen from this test.
    static SEEN: AtomicUsize = AtomicUsize::new(0);

    #[test]
    fn a_panic_becomes_a_status_and_only_the_hosts_own_are_reported() {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(|_| {
            SEEN.fetch_add(1, Ordering::Relaxed);
        }));
        let status = call::<Status>(|| panic!("out of {}", "order"));
        assert_eq!(status, Status::Internal as i32);
        let text = unsafe { CStr::from_ptr(hbvib_last_error()) }.to_str().unwrap();
        assert!(text.contains("boundary.rs") && text.ends_with("out of order"), "{text}");
        assert_eq!(SEEN.load(Ordering::Relaxed), 0);

        // The host's panics, in a callback too, are the host's business.
        assert_eq!(
            call(|| outside(|| {
                assert!(catch_unwind(|| panic!("host")).is_err());
                Ok(Status::Ok)
            })),
            0
        );
        assert!(catch_unwind(|| panic!("host")).is_err());
        assert_eq!(SEEN.load(Ordering::Relaxed), 2);
        std::panic::set_hook(before);
    }

    #[test]
    fn the_copy_of_an_error_is_cut_between_characters() {
        remember("µω", 3);
        let mut buffer = [1 as c_char; 6];
        let mut copy = |len| unsafe {
            let needed = hbvib_last_error_copy(buffer.as_mut_ptr(), len);
            (
                needed,
                CStr::from_ptr(buffer.as_ptr()).to_str().unwrap_or("?").to_owned(),
            )
        };
        assert_eq!(copy(1), (5, String::new()));
        assert_eq!(copy(2), (5, String::new()));
        assert_eq!(copy(4), (5, "µ".into()));
        assert_eq!(copy(5), (5, "µω".into()));
        assert_eq!(unsafe { hbvib_last_error_copy(core::ptr::null_mut(), 9) }, 5);
        assert_eq!(hbvib_last_error_argument(), 3);
    }
}
