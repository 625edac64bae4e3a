//! Section "Solve" of the header: progress, phases, log and cancellation.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::check_pointer;
use crate::capi::crossing::boundary::{WithArgument, call, outside};
use crate::capi::crossing::thread_memory;
use crate::capi::crossing::versioned_struct::{VersionedStruct, init, load};
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, Status, TEXT_CAPACITY, fail};
use crate::hooks::{Hooks, LogLevel, Progress};
use crate::interrupt::{Interrupt, PhaseReport, PhaseSink};
use core::ffi::{c_char, c_void};
use core::ptr;
use core::sync::atomic::{AtomicI32, Ordering};

/// State of a solve, passed to the progress callback.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_progress {
    /// Bytes of this struct as the library knows it.
    pub struct_size: u32,
    /// Newton iterations that the point took.
    pub newton_iterations: i32,
    /// Number of points accepted so far, this one included.
    pub point: i64,
    /// Angular frequency; in a nonlinear mode log10 of the amplitude.
    pub parameter: f64,
    /// Peak amplitude of the response degree of freedom: of the fundamental, or of the harmonic that
    /// hbvib_reduction names.
    pub amplitude: f64,
    /// Relative residual.
    pub residual: f64,
    /// Arc length of the step that led here, in scaled unknowns.
    pub step: f64,
    /// Part of the range that is done, 0 to 1.
    pub fraction_done: f64,
}

/// Levels of log lines.
#[repr(C)]
pub enum hbvib_log_level {
    /// No line at all.
    HBVIB_LOG_NONE = 0,
    /// Warnings.
    HBVIB_LOG_WARN = 1,
    /// Steps of the method.
    HBVIB_LOG_INFO = 2,
    /// Detail for debugging.
    HBVIB_LOG_DEBUG = 3,
}

/// Phases of a running call.
#[repr(C)]
pub enum hbvib_phase {
    /// Checks of the model and its assembly.
    HBVIB_PHASE_SETUP = 0,
    /// Natural frequencies and mode shapes.
    HBVIB_PHASE_MODES = 1,
    /// Condensation onto the contacts and tables of their flexibility.
    HBVIB_PHASE_CONDENSATION = 2,
    /// Search for the first point of a branch.
    HBVIB_PHASE_FIRST_POINT = 3,
    /// Points of a branch, one after the other.
    HBVIB_PHASE_CONTINUATION = 4,
    /// Error estimate of a point.
    HBVIB_PHASE_ESTIMATE = 5,
    /// Integration in time; the share is that of a lapse.
    HBVIB_PHASE_TIME_INTEGRATION = 6,
    /// Harmonics, energies and other results of solved motions.
    HBVIB_PHASE_RESULTS = 7,
    /// One factorisation of a sparse matrix, which cannot be stopped, begins.
    HBVIB_PHASE_FACTORISATION = 8,
}

/// Phase of a running call, passed to the phase callback.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_phase_report {
    /// Bytes of this struct as the library knows it.
    pub struct_size: u32,
    /// HBVIB_PHASE_SETUP .. HBVIB_PHASE_FACTORISATION; later versions may add others.
    pub phase: i32,
    /// Part of the phase that is done, 0 to 1. It begins again with each phase.
    pub share: f64,
}

/// Called at the begin of a phase, whenever its share has grown by 0.01, and after some ten
/// milliseconds of work. A result other than 0 stops the call and keeps the points. Accepted points
/// have a callback of their own, because callers count its calls.
pub type hbvib_phase_fn =
    Option<unsafe extern "C-unwind" fn(user: *mut c_void, report: *const hbvib_phase_report) -> i32>;

/// Called at each accepted point. A result other than 0 stops the solve and keeps the points.
/// Results of what is kept, as those of the last period in hbvib_time_response, are still computed;
/// phase and cancel stop these, too.
pub type hbvib_progress_fn =
    Option<unsafe extern "C-unwind" fn(user: *mut c_void, progress: *const hbvib_progress) -> i32>;

/// Receives a line of the log, whose text is valid during the call.
pub type hbvib_log_fn = Option<unsafe extern "C-unwind" fn(user: *mut c_void, level: i32, message: *const c_char)>;

/// A flag that another thread or a signal handler may set while a call runs, by hbvib_cancel or by
/// an atomic store of its own: a plain store while another thread reads is a data race in C11 and
/// C++11.
pub type hbvib_cancel_flag = i32;

/// Sets a cancel flag by an atomic store, with which any running call that has it ends soon. A
/// signal handler may call it. The text of the last error stays as it is.
///
/// flag   the flag.
/// value  1: stop; 0: no longer, for the next call.
/// Errors: HBVIB_E_NULL, HBVIB_E_ARGUMENT (value, alignment). Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_cancel(flag: *mut hbvib_cancel_flag, value: i32) -> hbvib_status {
    if flag.is_null() {
        return Status::Null as hbvib_status;
    }
    if !flag.is_aligned() || !(0..=1).contains(&value) {
        return Status::Argument as hbvib_status;
    }
    unsafe { AtomicI32::from_ptr(flag) }.store(value, Ordering::Relaxed);
    Status::Ok as hbvib_status
}

/// Callbacks and cancel flag of a solve. Fill it by hbvib_hooks_init. Callbacks run on the calling
/// thread, one at a time; they may call the library, but not change or free a handle in use.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_hooks {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// HBVIB_LOG_NONE .. HBVIB_LOG_DEBUG: the finest lines that `log` receives.
    pub log_level: i32,
    /// Passed to the callbacks.
    pub user: *mut c_void,
    /// Called at each accepted point. May be NULL.
    pub progress: hbvib_progress_fn,
    /// Called with each line of the log. May be NULL.
    pub log: hbvib_log_fn,
    /// Read often, in every long loop: a number other than 0 stops the call and keeps the points.
    /// Another thread or a signal handler may set it by hbvib_cancel; the call never writes it.
    /// May be NULL.
    pub cancel: *const hbvib_cancel_flag,
    /// Called with the phase of the call, from the set-up on. May be NULL.
    pub phase: hbvib_phase_fn,
}

unsafe impl VersionedStruct for hbvib_hooks {
    const NAME: &'static str = "hbvib_hooks";
    const FIRST_SIZE: usize = 40;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            log_level: 0,
            user: ptr::null_mut(),
            progress: None,
            log: None,
            cancel: ptr::null(),
            phase: None,
        }
    }
}

/// Fills hooks with no callback and no flag.
///
/// h          the struct; untouched on error.
/// size_of_h  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_hooks_init(h: *mut hbvib_hooks, size_of_h: usize) -> hbvib_status {
    call(|| unsafe { init(h, size_of_h) })
}

/// Passes the hooks of the caller, in the form of the library, to `then`.
pub(crate) unsafe fn with_hooks<T>(h: &hbvib_hooks, then: impl FnOnce(&mut Hooks<'_>) -> T) -> T {
    let user = h.user;
    let mut progress = h.progress.map(|f| {
        move |p: &Progress| {
            let state = hbvib_progress {
                struct_size: size_of::<hbvib_progress>() as u32,
                newton_iterations: i32::try_from(p.newton_iterations).unwrap_or(i32::MAX),
                point: p.point as i64,
                parameter: p.parameter,
                amplitude: p.amplitude,
                residual: p.residual,
                step: p.step,
                fraction_done: p.fraction_done,
            };
            outside(|| unsafe { f(user, &raw const state) }) != 0
        }
    });
    let finest = h.log_level;
    let mut log = h.log.map(|f| {
        move |level: LogLevel, message: &str| {
            if level as i32 > finest {
                return;
            }
            let mut text = [0_u8; TEXT_CAPACITY + 1];
            let mut len = message.len().min(TEXT_CAPACITY);
            while !message.is_char_boundary(len) {
                len -= 1;
            }
            text[..len].copy_from_slice(&message.as_bytes()[..len]);
            outside(|| unsafe { f(user, level as i32, text.as_ptr().cast()) });
        }
    });
    let phase = h.phase.map(|f| {
        move |report: &PhaseReport| {
            let state = hbvib_phase_report {
                struct_size: size_of::<hbvib_phase_report>() as u32,
                phase: report.phase as i32,
                share: report.share.clamp(0.0, 1.0),
            };
            outside(|| unsafe { f(user, &raw const state) }) != 0
        }
    });
    let flag = h.cancel;
    // An aligned load as that of a volatile in C, but defined while another thread writes.
    let cancelled = || unsafe { AtomicI32::from_ptr(flag.cast_mut()) }.load(Ordering::Relaxed) != 0;
    let mut hooks = Hooks {
        progress: progress.as_mut().map(|f| f as &mut dyn FnMut(&Progress) -> bool),
        cancelled: (!flag.is_null()).then_some(&cancelled as &dyn Fn() -> bool),
        phase: phase.as_ref().map(|f| f as &PhaseSink<'_>),
        log: log.as_mut().map(|f| f as &mut dyn FnMut(LogLevel, &str)),
    };
    then(&mut hooks)
}

/// Passes an interrupt with the hooks of the caller to a function that has no points to report.
pub(crate) unsafe fn with_interrupt<T>(h: &hbvib_hooks, then: impl FnOnce(&Interrupt<'_>) -> T) -> T {
    unsafe { with_hooks(h, |hooks| then(&hooks.interrupt())) }
}

/// The hooks given as the argument of this number; NULL is none. A call with hooks may multiply large matrices, for
/// which this thread is prepared.
pub(crate) unsafe fn load_hooks(p: *const hbvib_hooks, argument: i32) -> Result<hbvib_hooks> {
    thread_memory::prepare()?;
    if p.is_null() {
        return Ok(hbvib_hooks::defaults());
    }
    let hooks = unsafe { load(p, argument) }?;
    if !(0..=3).contains(&hooks.log_level) {
        return fail!(
            Argument,
            "hbvib_hooks: log_level = {}, needs HBVIB_LOG_NONE = 0 .. HBVIB_LOG_DEBUG = 3",
            hooks.log_level
        )
        .with_argument(argument);
    }
    if !hooks.cancel.is_null() {
        check_pointer::<hbvib_cancel_flag>(hooks.cancel, argument, "hbvib_hooks: cancel")?;
    }
    Ok(hooks)
}
