//! Section "Solve" of the header: forced responses.

#![allow(non_camel_case_types)]

use crate::analysis;
use crate::capi::crossing::arrays::{check_pointer, count, input};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::branch_tree::insert_tree;
use crate::capi::crossing::handles::{Kept, KeptBranch, Object, read};
use crate::capi::crossing::indices::number;
use crate::capi::crossing::outcome::Outcome;
use crate::capi::crossing::versioned_struct::{VersionedStruct, init, load};
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_hooks};
use crate::capi::solving::solve_options::{hbvib_solver_options, solver_options};
use crate::capi::solving::solve_responses::{Watched, hbvib_response};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, fail};
use crate::hooks::Hooks;
use crate::model::Model;
use crate::options::{ForcedOptions, MAX_HARMONIC, Response};
use crate::results::Branch;
use core::ptr;
use num_complex::Complex64;

/// A branch of solutions, created by hbvib_forced_response or hbvib_nonlinear_mode.
pub struct hbvib_branch(());

impl Kept for KeptBranch {
    type Opaque = hbvib_branch;
    const TAG: u64 = 2;
    const NAME: &'static str = "branch";

    fn wrap(object: Vec<Self>) -> Object {
        Object::Branch(object)
    }

    fn pick(object: &mut Object) -> Option<*mut Self> {
        match object {
            Object::Branch(one) => Some(one.as_mut_ptr()),
            _ => None,
        }
    }

    fn holds(object: &Object) -> bool {
        matches!(object, Object::Branch(_))
    }
}

/// Options of hbvib_forced_response. Fill it by hbvib_forced_options_init, then set the range.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_forced_options {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 1: the tolerance holds for all responses in one norm, the root of the sum of |error|^2 over
    /// that of |response|^2; 0: for each by itself.
    pub together: i32,
    /// First angular frequency, > 0, rad per time unit.
    pub omega_start: f64,
    /// Last angular frequency: below the first for a downward sweep, equal to it for one point.
    pub omega_stop: f64,
    /// Angular frequencies within the range at which every solution is computed exactly, or NULL.
    pub at: *const f64,
    /// Number of these frequencies.
    pub at_len: i64,
    /// Start values, complex (H + 1) x ndof, harmonic after harmonic with an H of their own, or NULL:
    /// the stuck solution. The motion at the contacts counts; the imaginary part of the mean has
    /// no effect. Harmonics that forces and laws do not excite by themselves (a subharmonic, the
    /// mean and even harmonics of a symmetric model) are carried where the guess has them. One
    /// above harmonics, or with a tolerance above max_harmonics, is refused. hbvib_reduction tells
    /// whether the first point was found from the guess.
    pub guess: *const f64,
    /// Complex numbers in guess.
    pub guess_len: i64,
    /// Array of the responses that are watched, struct_size of the first apart, or NULL: the
    /// fundamental of the response degree of freedom. The first one leads HBVIB_AMPLITUDE and
    /// hbvib_branch_peaks, and a tolerance holds for each; see hbvib_branch_response.
    pub responses: *const hbvib_response,
    /// Number of these responses.
    pub responses_len: i64,
    /// Further solutions that are sought, for hbvib_branch_children: 0 (default) none; 1 branches
    /// that branch off where the period doubles, a symmetry breaks or at simple branch points; 2
    /// detached curves, too, near the resonances that nonlinear modes predict; 3 those that peaks
    /// and folds lead to over the force, and subharmonic curves of the orders 2 and 3, too, by a net
    /// of starts; 4 those that deflation finds beside the response, too. Stability is then computed
    /// along all of them, as by HBVIB_STABILITY_WAVE where the solver option is none.
    pub branches: i32,
    /// Largest number of generations of branches that branch off, up to 8; 0 (default): 3.
    pub branch_depth: i32,
    /// Largest number of branches beside the response; 0 (default): 32.
    pub most_branches: i64,
}

unsafe impl VersionedStruct for hbvib_forced_options {
    const NAME: &'static str = "hbvib_forced_options";
    const FIRST_SIZE: usize = 56;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            together: 0,
            omega_start: 0.0,
            omega_stop: 0.0,
            at: ptr::null(),
            at_len: 0,
            guess: ptr::null(),
            guess_len: 0,
            responses: ptr::null(),
            responses_len: 0,
            branches: 0,
            branch_depth: 0,
            most_branches: 0,
        }
    }
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

/// Follows the periodic response of a model to its forces over a range of frequency, by harmonic
/// balance and arc-length continuation: folds are passed, peaks and folds refined.
///
/// solver  options; NULL: the defaults.
/// forced  range of frequency, requested exact frequencies, start values.
/// hooks   progress, log and cancellation; NULL: none.
/// out     receives the branch; untouched on error. Free it by hbvib_branch_free.
/// A positive status says why the branch ends early; the branch then has all points found, possibly
/// none. Where the amplitude grows without bound, at an undamped resonance, hbvib_last_error says
/// so.
/// Errors: HBVIB_E_ARGUMENT, HBVIB_E_DIMENSION, HBVIB_E_INDEX and HBVIB_E_NOT_FINITE for options
/// out of range, forces beyond the harmonics and missing matrices; HBVIB_E_NO_CONVERGENCE where no
/// first point was found; HBVIB_E_NO_BOUNDED_SOLUTION where none is known to exist, because the
/// force at an undamped resonance exceeds what the contacts can dissipate; HBVIB_E_SINGULAR,
/// HBVIB_E_UNSUPPORTED, HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY,
/// HBVIB_E_OUT_OF_MEMORY.
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
        let sectors = model.structure().sectors();
        solver
            .stability
            .map_or(Ok(()), |waves| waves.check("stability", sectors))
            .with_argument(2)?;
        let forced = unsafe { load(forced, 3) }?;
        let watched =
            unsafe { Watched::new(forced.responses, forced.responses_len, model.ndof(), 3) }.with_argument(3)?;
        let responses = unsafe { watched.responses(3) }.with_argument(3)?;
        let forced = unsafe { forced_options(&forced, &responses, model.ndof()) }.with_argument(3)?;
        unsafe {
            follow(hooks, out, forced.at.len(), |hooks| {
                analysis::forced_response(&model, &solver, &forced, hooks)
            })
        }
    })
}

unsafe fn forced_options<'a>(
    o: &hbvib_forced_options,
    responses: &'a [Response<'a>],
    ndof: usize,
) -> Result<ForcedOptions<'a>> {
    if !matches!(o.together, 0 | 1) {
        return fail!(Argument, "together = {}, needs 0 or 1", o.together);
    }
    let at_len = count(o.at_len, 3, "at_len")?;
    let given = count(o.guess_len, 3, "guess_len")?;
    let guess = if o.guess.is_null() && given == 0 {
        None
    } else if given > 0 && given % ndof == 0 && given / ndof <= MAX_HARMONIC + 1 {
        Some(unsafe { input::<Complex64>(o.guess.cast(), given, 3, "guess") }?)
    } else {
        return fail!(
            Dimension,
            "guess_len = {given}, needs (H + 1) * ndof, a multiple of {ndof}, H = 0 .. {MAX_HARMONIC}"
        );
    };
    let options = ForcedOptions {
        omega_start: o.omega_start,
        omega_stop: o.omega_stop,
        at: unsafe { input(o.at, at_len, 3, "at") }?,
        guess,
        responses,
        together: o.together == 1,
        branches: number(i64::from(o.branches), "branches")?,
        branch_depth: number(i64::from(o.branch_depth), "branch_depth")?,
        most_branches: number(o.most_branches, "most_branches")?,
    };
    options.check()?;
    options.check_search()?;
    options.check_guess(ndof)?;
    Ok(options)
}

/// Runs an analysis with the hooks in argument 4 and returns its branch, for which `requested`
/// exact frequencies or amplitudes were given, in argument 5.
///
/// # Safety
/// The caller of the C function states that the pointers are what they are said to be.
pub(crate) unsafe fn follow(
    hooks: *const hbvib_hooks,
    out: *mut *mut hbvib_branch,
    requested: usize,
    analysis: impl FnOnce(&mut Hooks<'_>) -> Result<Branch>,
) -> Result<Outcome> {
    let hooks = unsafe { load_hooks(hooks, 4) }?;
    check_pointer(out, 5, "out")?;
    let found = unsafe { with_hooks(&hooks, analysis) };
    unsafe { hand_over(found, out, requested) }
}

/// Hands a branch to the caller. A function of its own: its copies do not lie on the stack under the analysis.
///
/// # Safety
/// `out` points to a writable pointer.
#[inline(never)]
unsafe fn hand_over(found: Result<Branch>, out: *mut *mut hbvib_branch, requested: usize) -> Result<Outcome> {
    let branch = found?;
    let outcome = Outcome::from(&branch);
    unsafe { out.write(insert_tree(branch, requested, false)?) };
    Ok(outcome)
}
