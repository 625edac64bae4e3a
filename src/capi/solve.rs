//! Options and hooks in, a branch out.

use super::boundary::{Blame, call, check_pointer, count, input, outside};
use super::handles::{KeptBranch, insert, read};
use super::sized::{Described, check_reserved, init, load};
use super::told::Told;
use super::types::{
    hbvib_branch, hbvib_cancel_flag, hbvib_forced_options, hbvib_hooks, hbvib_model, hbvib_progress,
    hbvib_solver_options, hbvib_status,
};
use crate::analysis;
use crate::error::{Result, TEXT_CAPACITY, fail};
use crate::hooks::{Hooks, LogLevel, Progress};
use crate::model::Model;
use crate::options::{ForcedOptions, SolverOptions};
use crate::results::Branch;
use core::ptr;
use core::sync::atomic::{AtomicI32, Ordering};
use num_complex::Complex64;

unsafe impl Described for hbvib_solver_options {
    const NAME: &'static str = "hbvib_solver_options";
    const FIRST: usize = 104;

    fn filled() -> Self {
        let defaults = SolverOptions::default();
        Self {
            struct_size: 0,
            num_threads: 0,
            tolerance: defaults.tolerance,
            harmonics: defaults.harmonics as i64,
            max_harmonics: defaults.max_harmonics as i64,
            samples: defaults.samples as i64,
            step: defaults.step,
            step_min: defaults.step_min,
            step_max: defaults.step_max,
            tol_residual: defaults.tol_residual,
            max_newton: defaults.max_newton as i64,
            max_points: defaults.max_points as i64,
            response_dof: -1,
            keep_even_harmonics: i32::from(defaults.keep_even_harmonics),
            estimate_error: i32::from(defaults.estimate_error),
        }
    }
}

unsafe impl Described for hbvib_forced_options {
    const NAME: &'static str = "hbvib_forced_options";
    const FIRST: usize = 56;

    fn filled() -> Self {
        Self {
            struct_size: 0,
            reserved: 0,
            omega_start: 0.0,
            omega_stop: 0.0,
            at: ptr::null(),
            at_len: 0,
            guess: ptr::null(),
            guess_len: 0,
        }
    }
}

unsafe impl Described for hbvib_hooks {
    const NAME: &'static str = "hbvib_hooks";
    const FIRST: usize = 40;

    fn filled() -> Self {
        Self {
            struct_size: 0,
            log_level: 0,
            user: ptr::null_mut(),
            progress: None,
            log: None,
            cancel: ptr::null(),
        }
    }
}

/// Fills solver options with their defaults: tolerance = 1e-3, from which the harmonics follow, exact events,
/// automatic steps. For exactly so many harmonics set tolerance = 0 and harmonics.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_solver_options_init(o: *mut hbvib_solver_options, size_of_o: usize) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// Fills the options of a forced response with zeros: the frequencies must be set.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_forced_options_init(o: *mut hbvib_forced_options, size_of_o: usize) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// Fills hooks with nothing to call.
///
/// h          the struct; untouched on error.
/// size_of_h  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_hooks_init(h: *mut hbvib_hooks, size_of_h: usize) -> hbvib_status {
    call(|| unsafe { init(h, size_of_h) })
}

/// A number of the caller that must not be negative, where a negative one is a bad value.
pub(super) fn number(value: i64, name: &str) -> Result<usize> {
    match usize::try_from(value) {
        Ok(v) => Ok(v),
        Err(_) => fail!(Argument, "{name} = {value}, needs a number >= 0"),
    }
}

/// Checked harmonics and samples, given as the arguments of these numbers.
pub(super) fn harmonics_and_samples(harmonics: i64, samples: i64, arguments: (i32, i32)) -> Result<(usize, usize)> {
    let plain = |harmonics, samples| {
        SolverOptions {
            harmonics,
            samples,
            tolerance: 0.0,
            ..SolverOptions::default()
        }
        .fixed()
        .check()
    };
    let harmonics = number(harmonics, "harmonics").blame(arguments.0)?;
    plain(harmonics, 0).blame(arguments.0)?;
    let samples = number(samples, "samples").blame(arguments.1)?;
    plain(harmonics, samples).blame(arguments.1)?;
    Ok((harmonics, samples))
}

/// Checked solver options for a model of `ndof` degrees of freedom; NULL is the defaults.
pub(super) unsafe fn solver_options(p: *const hbvib_solver_options, ndof: usize) -> Result<SolverOptions> {
    if p.is_null() {
        return Ok(SolverOptions::default());
    }
    let o = unsafe { load(p, 2) }?;
    convert(&o, ndof).blame(2)
}

fn convert(o: &hbvib_solver_options, ndof: usize) -> Result<SolverOptions> {
    let num_threads = number(o.num_threads.into(), "num_threads")?.max(1);
    let response_dof = match o.response_dof {
        -1 => None,
        dof if (0..ndof as i64).contains(&dof) => Some(dof as usize),
        dof => {
            return fail!(Index, "response_dof = {dof}, needs 0 .. {} or -1 (automatic)", ndof - 1);
        }
    };
    let flag = |value: i32, name: &str| match value {
        0 => Ok(false),
        1 => Ok(true),
        other => fail!(Argument, "{name} = {other}, needs 0 or 1"),
    };
    let options = SolverOptions {
        tolerance: o.tolerance,
        harmonics: number(o.harmonics, "harmonics")?,
        max_harmonics: number(o.max_harmonics, "max_harmonics")?,
        samples: number(o.samples, "samples")?,
        step: o.step,
        step_min: o.step_min,
        step_max: o.step_max,
        tol_residual: o.tol_residual,
        max_newton: number(o.max_newton, "max_newton")?,
        max_points: number(o.max_points, "max_points")?,
        response_dof,
        keep_even_harmonics: flag(o.keep_even_harmonics, "keep_even_harmonics")?,
        estimate_error: flag(o.estimate_error, "estimate_error")?,
        num_threads,
    };
    options.check()?;
    Ok(options)
}

unsafe fn forced_options<'a>(o: &hbvib_forced_options, guess_len: usize) -> Result<ForcedOptions<'a>> {
    check_reserved(o.reserved, 3, "hbvib_forced_options")?;
    let at_len = count(o.at_len, 3, "at_len")?;
    let given = count(o.guess_len, 3, "guess_len")?;
    let guess = if o.guess.is_null() && given == 0 {
        None
    } else if given == guess_len {
        Some(unsafe { input::<Complex64>(o.guess.cast(), given, 3, "guess") }?)
    } else {
        return fail!(
            Dimension,
            "guess_len = {given}, needs (harmonics + 1) * ndof = {guess_len}"
        );
    };
    let options = ForcedOptions {
        omega_start: o.omega_start,
        omega_stop: o.omega_stop,
        at: unsafe { input(o.at, at_len, 3, "at") }?,
        guess,
    };
    options.check(guess_len)?;
    Ok(options)
}

/// Hands the hooks of the caller, as the library knows them, to `then`.
pub(super) unsafe fn with_hooks<T>(h: &hbvib_hooks, then: impl FnOnce(&mut Hooks<'_>) -> T) -> T {
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
    let flag = h.cancel;
    // An aligned load, as C's volatile read is, but defined while another thread writes.
    let cancelled = || unsafe { AtomicI32::from_ptr(flag.cast_mut()) }.load(Ordering::Relaxed) != 0;
    let mut hooks = Hooks {
        progress: progress.as_mut().map(|f| f as &mut dyn FnMut(&Progress) -> bool),
        cancelled: (!flag.is_null()).then_some(&cancelled as &dyn Fn() -> bool),
        log: log.as_mut().map(|f| f as &mut dyn FnMut(LogLevel, &str)),
    };
    then(&mut hooks)
}

/// The hooks given as the argument of this number; NULL is none.
pub(super) unsafe fn load_hooks(p: *const hbvib_hooks, argument: i32) -> Result<hbvib_hooks> {
    if p.is_null() {
        return Ok(hbvib_hooks::filled());
    }
    let hooks = unsafe { load(p, argument) }?;
    if !(0..=3).contains(&hooks.log_level) {
        return fail!(
            Argument,
            "hbvib_hooks: log_level = {}, needs HBVIB_LOG_NONE = 0 .. HBVIB_LOG_DEBUG = 3",
            hooks.log_level
        )
        .blame(argument);
    }
    if !hooks.cancel.is_null() {
        check_pointer::<hbvib_cancel_flag>(hooks.cancel, argument, "hbvib_hooks: cancel")?;
    }
    Ok(hooks)
}

/// Follows the periodic response of a model to its forces over a range of frequency, by harmonic
/// balance and arc-length continuation: folds are passed, peaks and folds refined.
///
/// solver  options; NULL: the defaults.
/// forced  range of frequency, frequencies wanted exactly, start values.
/// hooks   progress, log and cancellation; NULL: none.
/// out     receives the branch; untouched on error. Free it by hbvib_branch_free.
/// A positive status says why the branch ends early; the branch is there with all points found,
/// which may be none. Where it ends on its way to infinity, at an undamped resonance,
/// hbvib_last_error says so.
/// Errors: HBVIB_E_ARGUMENT, HBVIB_E_DIMENSION, HBVIB_E_INDEX and HBVIB_E_NOT_FINITE for options
/// out of range, forces beyond the harmonics and missing matrices; HBVIB_E_NO_CONVERGENCE where no
/// first point was found; HBVIB_E_NO_BOUNDED_SOLUTION where it is known that there is none, an
/// undamped resonance being forced beyond what the contacts can take; HBVIB_E_SINGULAR, HBVIB_E_UNSUPPORTED, HBVIB_E_STRUCT_SIZE,
/// HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY.
/// Threads: any number may solve one model at a time, with the same results as one alone; changing
/// or freeing it meanwhile is HBVIB_E_BUSY.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_forced_response(
    model: *const hbvib_model,
    solver: *const hbvib_solver_options,
    forced: *const hbvib_forced_options,
    hooks: *const hbvib_hooks,
    out: *mut *mut hbvib_branch,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let solver = unsafe { solver_options(solver, model.ndof()) }?;
        let forced = unsafe { load(forced, 3) }?;
        let guess_len = (solver.harmonics + 1).saturating_mul(model.ndof());
        let forced = unsafe { forced_options(&forced, guess_len) }.blame(3)?;
        unsafe {
            follow(&solver, hooks, out, forced.at.len(), |hooks| {
                analysis::forced_response(&model, &solver, &forced, hooks)
            })
        }
    })
}

/// Runs an analysis with the hooks in argument 4 and keeps its branch, with `wanted` solutions asked
/// for, in argument 5.
///
/// # Safety
/// The caller of the C function states that the pointers are what they are said to be.
pub(super) unsafe fn follow(
    solver: &SolverOptions,
    hooks: *const hbvib_hooks,
    out: *mut *mut hbvib_branch,
    wanted: usize,
    analysis: impl FnOnce(&mut Hooks<'_>) -> Result<Branch>,
) -> Result<Told> {
    let hooks = unsafe { load_hooks(hooks, 4) }?;
    check_pointer(out, 5, "out")?;
    let branch = unsafe {
        with_hooks(&hooks, |hooks| {
            if solver.num_threads > 1 {
                let line = "a branch is followed on one thread, whatever num_threads says";
                hooks.log(LogLevel::Info, line);
            }
            analysis(hooks)
        })
    }?;
    let told = Told::from(&branch);
    unsafe { out.write(insert(KeptBranch { branch, wanted })?) };
    Ok(told)
}
