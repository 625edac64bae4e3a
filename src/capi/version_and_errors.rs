//! Section "Version and errors" of the header.

#![allow(non_camel_case_types)]

use super::crossing::last_error::LAST;
use crate::error::Status;
use core::ffi::{CStr, c_char};

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

/// Outcome of a call: a value of enum hbvib_status_code.
pub type hbvib_status = i32;

/// Values of hbvib_status. Zero: done. Negative: an error, nothing was written. Positive: stopped
/// early, the partial result was written.
#[repr(C)]
pub enum hbvib_status_code {
    /// Done.
    HBVIB_OK = 0,
    /// The progress hook or the cancel flag asked to stop.
    HBVIB_STOPPED_BY_CALLER = 1,
    /// The step fell below step_min.
    HBVIB_STOPPED_STEP_TOO_SMALL = 2,
    /// max_points was reached.
    HBVIB_STOPPED_MAX_POINTS = 3,
    /// Some points need more harmonics for the tolerance than max_harmonics or the memory allows,
    /// or their error is unknown; HBVIB_ERROR_ESTIMATE shows which. The whole range was covered,
    /// and all points are stored.
    HBVIB_STOPPED_MAX_HARMONICS = 4,
    /// Round-off kept the residual above tol_residual.
    HBVIB_STOPPED_STALLED = 5,
    /// The branch turned back, left the range where it began and did not come back.
    HBVIB_STOPPED_LEFT_RANGE = 6,
    /// A force callback failed; hbvib_last_error has the code that it returned.
    HBVIB_STOPPED_CALLBACK = 7,
    /// An undamped resonance lies in the range, where the response has no bound; the amplitude there
    /// is what round-off makes of it. hbvib_last_error names the frequency.
    HBVIB_STOPPED_UNBOUNDED = 8,
    /// No force acts on the model: unless a law of the caller excites it by itself or a guess began
    /// at a motion of its own, the response is zero, or the static motion under preloads.
    HBVIB_STOPPED_NO_FORCE = 9,
    /// Batches only: the amplitude has no maximum within the range.
    HBVIB_STOPPED_NO_PEAK = 10,
    /// Parameter responses only: the followed peak, or maximum of damping, met a minimum and
    /// vanished.
    HBVIB_STOPPED_PEAK_VANISHED = 11,
    /// The curve is closed: it came back to its first point, or eight times to a fold that it had
    /// passed, where a step entered it. All of it within the range is kept.
    HBVIB_STOPPED_CLOSED = 12,
    /// A required pointer is NULL.
    HBVIB_E_NULL = -1,
    /// A value lies outside its range.
    HBVIB_E_ARGUMENT = -2,
    /// A count or length does not fit.
    HBVIB_E_DIMENSION = -3,
    /// A number is NaN or infinite.
    HBVIB_E_NOT_FINITE = -4,
    /// A matrix that was declared symmetric or Hermitian is not.
    HBVIB_E_NOT_HERMITIAN = -5,
    /// A linear system has no unique solution.
    HBVIB_E_SINGULAR = -6,
    /// An iteration did not converge.
    HBVIB_E_NO_CONVERGENCE = -7,
    /// A struct was not filled by its _init function, or comes from another version.
    HBVIB_E_STRUCT_SIZE = -8,
    /// A callback failed or returned numbers that are not finite.
    HBVIB_E_CALLBACK = -9,
    /// The requested combination is not provided.
    HBVIB_E_UNSUPPORTED = -10,
    /// Memory could not be allocated.
    HBVIB_E_OUT_OF_MEMORY = -11,
    /// The problem has no bounded periodic solution.
    HBVIB_E_NO_BOUNDED_SOLUTION = -12,
    /// A handle was not returned by this library, was freed, or is of another type.
    HBVIB_E_HANDLE = -13,
    /// A running call uses the object.
    HBVIB_E_BUSY = -14,
    /// An index lies outside its range.
    HBVIB_E_INDEX = -15,
    /// A matrix that must be positive definite is not.
    HBVIB_E_NOT_POSITIVE_DEFINITE = -16,
    /// A defect of the library itself.
    HBVIB_E_INTERNAL = -99,
}

/// Checks that status codes of the header are those of the library.
macro_rules! same {
    ($($constant:ident = $status:ident),* $(,)?) => {
        $(const _: () = assert!(hbvib_status_code::$constant as i32 == Status::$status as i32);)*
    };
}

same!(
    HBVIB_OK = Ok,
    HBVIB_STOPPED_BY_CALLER = StoppedByCaller,
    HBVIB_STOPPED_STEP_TOO_SMALL = StoppedStepTooSmall,
    HBVIB_STOPPED_MAX_POINTS = StoppedMaxPoints,
    HBVIB_STOPPED_MAX_HARMONICS = StoppedMaxHarmonics,
    HBVIB_STOPPED_STALLED = StoppedStalled,
    HBVIB_STOPPED_LEFT_RANGE = StoppedLeftRange,
    HBVIB_STOPPED_CALLBACK = StoppedCallback,
    HBVIB_STOPPED_UNBOUNDED = StoppedUnbounded,
    HBVIB_STOPPED_NO_FORCE = StoppedNoForce,
    HBVIB_STOPPED_NO_PEAK = StoppedNoPeak,
    HBVIB_STOPPED_PEAK_VANISHED = StoppedPeakVanished,
    HBVIB_STOPPED_CLOSED = StoppedClosed,
    HBVIB_E_NULL = Null,
    HBVIB_E_ARGUMENT = Argument,
    HBVIB_E_DIMENSION = Dimension,
    HBVIB_E_NOT_FINITE = NotFinite,
    HBVIB_E_NOT_HERMITIAN = NotHermitian,
    HBVIB_E_SINGULAR = Singular,
    HBVIB_E_NO_CONVERGENCE = NoConvergence,
    HBVIB_E_STRUCT_SIZE = StructSize,
    HBVIB_E_CALLBACK = Callback,
    HBVIB_E_UNSUPPORTED = Unsupported,
    HBVIB_E_OUT_OF_MEMORY = OutOfMemory,
    HBVIB_E_NO_BOUNDED_SOLUTION = NoBoundedSolution,
    HBVIB_E_HANDLE = Handle,
    HBVIB_E_BUSY = Busy,
    HBVIB_E_INDEX = Index,
    HBVIB_E_NOT_POSITIVE_DEFINITE = NotPositiveDefinite,
    HBVIB_E_INTERNAL = Internal,
);

/// Name of a status, "HBVIB_E_SINGULAR": static text, never to be freed. A number that is no status
/// gives "HBVIB_UNKNOWN_STATUS".
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

/// Number of the argument that caused the last error, counted from 1 in the order of the parameters
/// of the function; 0 where no single argument caused it, and after a success.
///
/// Errors: none. Threads: each has its own.
#[unsafe(no_mangle)]
pub extern "C" fn hbvib_last_error_argument() -> i32 {
    LAST.with_borrow(|last| last.argument)
}

/// Copies the sentence of hbvib_last_error into a buffer of the caller.
///
/// buffer  receives the text, always NUL-terminated and cut at a whole UTF-8 character where it is
///         too long; may be NULL where only the size is needed.
/// len     size of the buffer in bytes; 0 writes nothing.
/// Returns the size of the whole text in bytes, its NUL included.
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
    use crate::capi::crossing::boundary::remember;

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
