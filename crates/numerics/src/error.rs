//! Status codes, their names, and the one error type of the crate.
//!
//! An error is small, as every fallible function has room for one on the stack. Its sentence is on the heap; where there
//! is no memory for that, the error is one of memory with a fixed sentence.

use crate::shortage;
use core::fmt;
use std::borrow::Cow;
use std::collections::TryReserveError;

/// Outcome of a call. `0` is success; negative values mean that nothing was written, positive values that the work
/// stopped early and a partial result is available.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Success: the call has done all of its work.
    Ok = 0,
    /// A progress hook or the cancel flag requested the stop; the points found so far are kept.
    StoppedByCaller = 1,
    /// The step fell below its minimum; the points found so far are kept.
    StoppedStepTooSmall = 2,
    /// The limit on the number of points was reached; the points found so far are kept.
    StoppedMaxPoints = 3,
    /// The whole range was covered, but some points miss the tolerance: they need more harmonics than the options
    /// or the memory allow, or their error is unknown. All points are kept.
    StoppedMaxHarmonics = 4,
    /// Round-off stopped the residual above the requested tolerance; all points are kept.
    StoppedStalled = 5,
    /// The branch turned back, left the range at the end where it began and did not return; all points are kept.
    StoppedLeftRange = 6,
    /// A callback of the caller failed; the points found so far are kept.
    StoppedCallback = 7,
    /// The whole range was covered, but an undamped resonance lies in it, at which the response has no bound; all points
    /// are kept, and the amplitude there is what round-off makes of it.
    StoppedUnbounded = 8,
    /// The whole range was covered, but no force acts on the model, so that it does not vibrate; all points are kept.
    StoppedNoForce = 9,
    /// The whole range was covered, but the amplitude has no maximum in it; all points are kept.
    StoppedNoPeak = 10,
    /// The followed peak, or maximum of damping, vanished: it met a minimum; the points found so far are kept.
    StoppedPeakVanished = 11,
    /// The curve is closed, an isolated branch: it came back to its first point, and all of it within the range is kept.
    StoppedClosed = 12,
    /// A required pointer is NULL.
    Null = -1,
    /// An argument has a value outside its range.
    Argument = -2,
    /// A count or length does not fit.
    Dimension = -3,
    /// A number is NaN or infinite where it must be finite.
    NotFinite = -4,
    /// A matrix that was declared symmetric or Hermitian is not.
    NotHermitian = -5,
    /// A linear system has no unique solution.
    Singular = -6,
    /// The iteration did not converge.
    NoConvergence = -7,
    /// A struct was not filled by its `_init` function, or comes from another version.
    StructSize = -8,
    /// A callback reported a failure or returned numbers that are not finite.
    Callback = -9,
    /// The requested combination is not provided.
    Unsupported = -10,
    /// Memory could not be allocated.
    OutOfMemory = -11,
    /// The problem has no bounded periodic solution.
    NoBoundedSolution = -12,
    /// A handle is not (or no longer) one of this library, or is of another type.
    Handle = -13,
    /// An object is in use by a running call.
    Busy = -14,
    /// An index lies outside its range.
    Index = -15,
    /// A matrix that must be positive definite is not.
    NotPositiveDefinite = -16,
    /// A defect in the library itself.
    Internal = -99,
}

impl Status {
    /// Name of the constant in the C header, as static text.
    #[must_use]
    pub const fn name(self) -> &'static core::ffi::CStr {
        match self {
            Self::Ok => c"HBVIB_OK",
            Self::StoppedByCaller => c"HBVIB_STOPPED_BY_CALLER",
            Self::StoppedStepTooSmall => c"HBVIB_STOPPED_STEP_TOO_SMALL",
            Self::StoppedMaxPoints => c"HBVIB_STOPPED_MAX_POINTS",
            Self::StoppedMaxHarmonics => c"HBVIB_STOPPED_MAX_HARMONICS",
            Self::StoppedStalled => c"HBVIB_STOPPED_STALLED",
            Self::StoppedLeftRange => c"HBVIB_STOPPED_LEFT_RANGE",
            Self::StoppedCallback => c"HBVIB_STOPPED_CALLBACK",
            Self::StoppedUnbounded => c"HBVIB_STOPPED_UNBOUNDED",
            Self::StoppedNoForce => c"HBVIB_STOPPED_NO_FORCE",
            Self::StoppedNoPeak => c"HBVIB_STOPPED_NO_PEAK",
            Self::StoppedPeakVanished => c"HBVIB_STOPPED_PEAK_VANISHED",
            Self::StoppedClosed => c"HBVIB_STOPPED_CLOSED",
            Self::Null => c"HBVIB_E_NULL",
            Self::Argument => c"HBVIB_E_ARGUMENT",
            Self::Dimension => c"HBVIB_E_DIMENSION",
            Self::NotFinite => c"HBVIB_E_NOT_FINITE",
            Self::NotHermitian => c"HBVIB_E_NOT_HERMITIAN",
            Self::Singular => c"HBVIB_E_SINGULAR",
            Self::NoConvergence => c"HBVIB_E_NO_CONVERGENCE",
            Self::StructSize => c"HBVIB_E_STRUCT_SIZE",
            Self::Callback => c"HBVIB_E_CALLBACK",
            Self::Unsupported => c"HBVIB_E_UNSUPPORTED",
            Self::OutOfMemory => c"HBVIB_E_OUT_OF_MEMORY",
            Self::NoBoundedSolution => c"HBVIB_E_NO_BOUNDED_SOLUTION",
            Self::Handle => c"HBVIB_E_HANDLE",
            Self::Busy => c"HBVIB_E_BUSY",
            Self::Index => c"HBVIB_E_INDEX",
            Self::NotPositiveDefinite => c"HBVIB_E_NOT_POSITIVE_DEFINITE",
            Self::Internal => c"HBVIB_E_INTERNAL",
        }
    }

    /// Sentence for the user about a call that stopped early; empty for success and for errors, which carry their
    /// own.
    #[must_use]
    pub const fn sentence(self) -> &'static str {
        match self {
            Self::StoppedByCaller => {
                "stopped by the progress hook or the cancel flag; the points found so far are kept"
            }
            Self::StoppedStepTooSmall => {
                "the step fell below step_min; the points found so far are kept; lower step_min or raise max_newton"
            }
            Self::StoppedMaxPoints => "max_points was reached; the points found so far are kept; raise max_points",
            Self::StoppedMaxHarmonics => {
                "some points miss the tolerance with max_harmonics, or their error is unknown; all points are kept; raise max_harmonics, or samples for sampled laws"
            }
            Self::StoppedStalled => {
                "round-off stopped the residual above tol_residual; all points are kept; raise tol_residual"
            }
            Self::StoppedLeftRange => {
                "the branch turned back and left the range where it began for good; all points are kept; start elsewhere or from the other end"
            }
            Self::StoppedCallback => "a callback of the caller failed; the points found so far are kept",
            Self::StoppedUnbounded => {
                "the response has no bound at an undamped resonance within the range; all points are kept; add damping"
            }
            Self::StoppedNoForce => {
                "no force acts on the model: unless a law of the caller excites it by itself or a guess began at a motion of its own, the response is zero, or the static motion under preloads; all points are kept"
            }
            Self::StoppedNoPeak => {
                "the amplitude has no maximum within the range; all points are kept; widen the range of frequency"
            }
            Self::StoppedPeakVanished => {
                "the followed maximum met a minimum and vanished; the points found so far are kept; follow another peak from there"
            }
            Self::StoppedClosed => {
                "the curve is closed: it came back to its first point, or to a fold that it had passed often; all of it within the range is kept"
            }
            _ => "",
        }
    }

    /// All statuses, for tables and for the conversion of an integer into a status.
    pub const ALL: [Self; 30] = [
        Self::Ok,
        Self::StoppedByCaller,
        Self::StoppedStepTooSmall,
        Self::StoppedMaxPoints,
        Self::StoppedMaxHarmonics,
        Self::StoppedStalled,
        Self::StoppedLeftRange,
        Self::StoppedCallback,
        Self::StoppedUnbounded,
        Self::StoppedNoForce,
        Self::StoppedNoPeak,
        Self::StoppedPeakVanished,
        Self::StoppedClosed,
        Self::Null,
        Self::Argument,
        Self::Dimension,
        Self::NotFinite,
        Self::NotHermitian,
        Self::Singular,
        Self::NoConvergence,
        Self::StructSize,
        Self::Callback,
        Self::Unsupported,
        Self::OutOfMemory,
        Self::NoBoundedSolution,
        Self::Handle,
        Self::Busy,
        Self::Index,
        Self::NotPositiveDefinite,
        Self::Internal,
    ];
}

/// Longest error sentence in bytes; a longer one is cut at a character boundary.
/// Kind: cap.
pub const TEXT_CAPACITY: usize = 231;

/// A sentence in a fixed buffer.
#[derive(Clone, Copy)]
pub struct Text {
    bytes: [u8; TEXT_CAPACITY],
    len: usize,
}

impl Text {
    /// The empty sentence.
    pub const EMPTY: Self = Self {
        bytes: [0; TEXT_CAPACITY],
        len: 0,
    };

    /// The sentence as text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        core::str::from_utf8(&self.bytes[..self.len]).unwrap_or("")
    }
}

impl fmt::Write for Text {
    fn write_str(&mut self, s: &str) -> fmt::Result {
        let mut take = s.len().min(TEXT_CAPACITY - self.len);
        while !s.is_char_boundary(take) {
            take -= 1;
        }
        self.bytes[self.len..self.len + take].copy_from_slice(&s.as_bytes()[..take]);
        self.len += take;
        Ok(())
    }
}

/// A failure: its kind, its place and its remedy.
pub struct Error {
    /// Kind of failure: negative, or `StoppedByCaller` on its way to the analysis that ends with it.
    pub status: Status,
    /// Index of the offending argument of the C function, counted from 1; 0 if none.
    pub argument: i32,
    /// Code that a callback of the caller returned; 0 if none did.
    pub callback: i32,
    /// Whether the call may succeed at another motion: a callback reported so, or its numbers were not finite. A
    /// solver then tries a smaller step before it fails.
    pub recoverable: bool,
    /// Whether nothing was allocated because the counted size exceeds the limit that the caller has set.
    pub beyond_limit: bool,
    text: Cow<'static, str>,
}

/// Fixed sentence for an error when there is no memory for its own.
const NO_MEMORY: &str = "no memory; reduce the size of the problem";

impl Error {
    /// An error with its sentence: `Error::new(Status::Index, format_args!("dof {i} …"))`.
    #[must_use]
    #[cold]
    #[inline(never)]
    pub fn new(status: Status, message: fmt::Arguments<'_>) -> Self {
        let (status, text) = match message.as_str() {
            Some(text) => (status, Cow::Borrowed(text)),
            None => match on_heap(message) {
                Some(text) => (status, Cow::Owned(text)),
                None => (Status::OutOfMemory, Cow::Borrowed(NO_MEMORY)),
            },
        };
        Self {
            status,
            argument: 0,
            callback: 0,
            recoverable: false,
            beyond_limit: false,
            text,
        }
    }

    /// A callback of the caller returned `code` instead of 0: above 0 it may succeed at another motion, below 0 it
    /// has failed for good.
    #[must_use]
    pub fn from_callback(code: i32, message: fmt::Arguments<'_>) -> Self {
        Self {
            callback: code,
            recoverable: code > 0,
            ..Self::new(Status::Callback, message)
        }
    }

    /// Marks the error as one that may not occur at another motion.
    #[must_use]
    pub fn recoverable(mut self) -> Self {
        self.recoverable = true;
        self
    }

    /// Marks the error as a refusal before anything was allocated.
    #[must_use]
    pub fn beyond_limit(mut self) -> Self {
        self.beyond_limit = true;
        self
    }

    /// Attributes the error to argument number `argument` (from 1) of the C function.
    #[must_use]
    pub fn in_argument(mut self, argument: i32) -> Self {
        self.argument = argument;
        self
    }

    /// Puts `place` and a colon in front of the sentence of the error.
    #[must_use]
    pub fn at(self, place: fmt::Arguments<'_>) -> Self {
        let placed = Self::new(self.status, format_args!("{place}: {}", self.text));
        Self {
            status: placed.status,
            text: placed.text,
            ..self
        }
    }

    /// Memory for `what` could not be allocated.
    #[must_use]
    pub fn out_of_memory(what: &str) -> Self {
        Self::new(
            Status::OutOfMemory,
            format_args!("no memory for {what}; reduce the size of the problem"),
        )
    }

    /// The sentence of the error.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.text
    }
}

impl Clone for Error {
    fn clone(&self) -> Self {
        let (status, text) = match &self.text {
            Cow::Borrowed(text) => (self.status, Cow::Borrowed(*text)),
            Cow::Owned(text) => match on_heap(format_args!("{text}")) {
                Some(text) => (self.status, Cow::Owned(text)),
                None => (Status::OutOfMemory, Cow::Borrowed(NO_MEMORY)),
            },
        };
        Self { status, text, ..*self }
    }
}

/// A sentence on the heap, cut at [`TEXT_CAPACITY`]; `None` without memory for it.
fn on_heap(message: fmt::Arguments<'_>) -> Option<String> {
    let mut text = Text::EMPTY;
    // Writing into the fixed buffer truncates; it cannot fail.
    let _ = fmt::Write::write_fmt(&mut text, message);
    let mut owned = String::new();
    owned.try_reserve_exact(text.len).ok()?;
    owned.push_str(text.as_str());
    Some(owned)
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.message())
    }
}

impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}: {}", self.status, self.message())
    }
}

impl std::error::Error for Error {}

/// Result with the crate's [`Error`].
pub type Result<T> = core::result::Result<T, Error>;

/// Shorthand for `Err(Error::new(Status::$status, format_args!(…)))`.
#[macro_export]
#[doc(hidden)]
macro_rules! fail {
    ($status:ident, $($message:tt)*) => {
        Err($crate::error::Error::new($crate::error::Status::$status, format_args!($($message)*)))
    };
}
#[doc(hidden)]
pub use crate::fail;

/// A vector of `len` copies of `value`, allocated fallibly.
///
/// # Errors
/// [`Status::OutOfMemory`] naming `what`.
pub fn try_vec<T: Clone>(len: usize, value: T, what: &str) -> Result<Vec<T>> {
    let mut v = Vec::new();
    reserved(&v.try_reserve_exact(len), what)?;
    v.resize(len, value);
    Ok(v)
}

/// Outcome of a request for memory: an error also if the last request was served from the reserve of the allocator.
///
/// # Errors
/// [`Status::OutOfMemory`] naming `what`.
pub fn reserved(outcome: &core::result::Result<(), TryReserveError>, what: &str) -> Result<()> {
    if outcome.is_err() || shortage::is_noted() {
        return Err(Error::out_of_memory(what));
    }
    Ok(())
}

/// An empty vector with room for `len` values and no more.
///
/// # Errors
/// [`Status::OutOfMemory`] naming `what`.
pub fn try_room<T>(len: usize, what: &str) -> Result<Vec<T>> {
    let mut v = Vec::new();
    reserved(&v.try_reserve_exact(len), what)?;
    Ok(v)
}

/// Checks that memory for `len` values is available at this moment, before code that does not allocate fallibly
/// itself.
///
/// # Errors
/// [`Status::OutOfMemory`] naming `what`.
pub fn check_memory<T>(len: usize, what: &str) -> Result<()> {
    let mut v = Vec::<T>::new();
    reserved(&v.try_reserve_exact(len), what)
}

/// A copy of `values`, allocated fallibly.
///
/// # Errors
/// [`Status::OutOfMemory`] naming `what`.
pub fn try_copy<T: Copy>(values: &[T], what: &str) -> Result<Vec<T>> {
    let mut v = Vec::new();
    try_extend(&mut v, values, what)?;
    Ok(v)
}

/// Makes a value and moves it into a box. It is a function of its own so that the parts of a large value use a small
/// stack one after the other.
///
/// # Errors
/// Those of `make`.
#[inline(never)]
pub fn boxed<T>(make: impl FnOnce() -> Result<T>) -> Result<Box<T>> {
    Ok(Box::new(make()?))
}

/// Appends `value`, allocating fallibly.
///
/// # Errors
/// [`Status::OutOfMemory`] naming `what`.
pub fn try_push<T>(v: &mut Vec<T>, value: T, what: &str) -> Result<()> {
    reserved(&v.try_reserve(1), what)?;
    v.push(value);
    Ok(())
}

/// Appends copies of `values`, allocating fallibly.
///
/// # Errors
/// [`Status::OutOfMemory`] naming `what`.
pub fn try_extend<T: Clone>(v: &mut Vec<T>, values: &[T], what: &str) -> Result<()> {
    reserved(&v.try_reserve(values.len()), what)?;
    v.extend_from_slice(values);
    Ok(())
}
