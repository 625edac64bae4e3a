//! Section "Time" of the header: resonances of a Campbell diagram with their amplitudes.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{Range, check_pointer, count as length, disjoint, input, optional, put};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::{KeptBranch, read};
use crate::capi::crossing::versioned_struct::{VersionedStruct, init, load};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_interrupt};
use crate::capi::structures::model::hbvib_model;
use crate::capi::time_calls::time_run_up::{of_mode, synthesis};
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Status, try_push};
use crate::model::Model;
use crate::options::CampbellResponseOptions;
use crate::studies::campbell_response;

/// Options of hbvib_campbell_response. Fill it by hbvib_campbell_options_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_campbell_options {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// As of hbvib_synthesis_options; default 0.
    pub model_damping: i32,
    /// Angular frequency of the forces over the speed of rotation, > 0; default 1.
    pub engine_order: f64,
    /// Change of the speed per time in a passage, either sign; default 0: no passage.
    pub acceleration: f64,
    /// Damping ratio that is added to the mode's; default 0.
    pub damping_ratio: f64,
}

unsafe impl VersionedStruct for hbvib_campbell_options {
    const NAME: &'static str = "hbvib_campbell_options";
    const FIRST_SIZE: usize = 32;

    fn defaults() -> Self {
        let defaults = CampbellResponseOptions::default();
        Self {
            struct_size: 0,
            model_damping: 0,
            engine_order: defaults.engine_order,
            acceleration: defaults.acceleration,
            damping_ratio: defaults.synthesis.damping_ratio,
        }
    }
}

/// Fills the options of resonances in a Campbell diagram: engine order 1, no passage.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_campbell_options_init(o: *mut hbvib_campbell_options, size_of_o: usize) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// The highest resonance of a nonlinear mode where an engine order meets it, under each of several
/// factors on the forces, and how much of it a passage reaches: the numbers of a Campbell diagram
/// coloured by amplitude. A passage is that of hbvib_branch_mission. Several modes and engine
/// orders are as many calls.
///
/// branch         a nonlinear mode.
/// model          as for hbvib_branch_synthesis; its own speed has no effect.
/// options        engine order, acceleration, damping; NULL: the defaults.
/// hooks          phase and cancellation; NULL: none.
/// n              number of factors, >= 1.
/// force_factors  factors on all forces of the model, > 0, n numbers.
/// speed          receives the speed of rotation of each resonance, n numbers, or NULL.
/// omega          receives its angular frequency, n numbers, or NULL.
/// amplitude      receives the steady amplitude of the degree of freedom of the mode, in the
///                fundamental, n numbers, or NULL.
/// damping_ratio  receives the damping ratio there, n numbers, or NULL.
/// passed         receives the largest amplitude of the passage, n numbers, or NULL; NaN without
///                acceleration.
/// error          receives the steady amplitude over the computed one, minus 1, n numbers, or NULL;
///                NaN where it was not computed.
/// All numbers of a factor are NaN where the mode has no resonance under it within its amplitudes.
/// Errors: HBVIB_E_ARGUMENT, HBVIB_E_NOT_FINITE, HBVIB_E_DIMENSION (options, factors, overlapping
/// arrays; a passage that leaves the amplitudes of the mode), HBVIB_E_UNSUPPORTED (an unbalance
/// with a passage), those of hbvib_branch_synthesis. HBVIB_STOPPED_BY_CALLER: nothing is written.
/// Threads: any number on one model and branch.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_campbell_response(
    branch: *const hbvib_branch,
    model: *const hbvib_model,
    options: *const hbvib_campbell_options,
    hooks: *const hbvib_hooks,
    n: i64,
    force_factors: *const f64,
    speed: *mut f64,
    omega: *mut f64,
    amplitude: *mut f64,
    damping_ratio: *mut f64,
    passed: *mut f64,
    error: *mut f64,
) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        let model = read::<Model>(model, 2)?;
        let o = if options.is_null() {
            hbvib_campbell_options::defaults()
        } else {
            unsafe { load(options, 3) }?
        };
        let hooks = unsafe { load_hooks(hooks, 4) }?;
        let n = length(n, 5, "n")?;
        check_pointer(force_factors, 6, "force_factors")?;
        let factors = unsafe { input(force_factors, n, 6, "force_factors") }?;
        let options = CampbellResponseOptions {
            engine_order: o.engine_order,
            acceleration: o.acceleration,
            force_factors: factors,
            synthesis: synthesis((1.0, o.damping_ratio, o.model_damping), 3)?,
        };
        options.check().with_argument(3)?;
        let arrays = [
            (speed, 7, "speed"),
            (omega, 8, "omega"),
            (amplitude, 9, "amplitude"),
            (damping_ratio, 10, "damping_ratio"),
            (passed, 11, "passed"),
            (error, 12, "error"),
        ];
        let mut ranges = Vec::new();
        for (p, argument, name) in arrays {
            optional((p, argument), name)?;
            try_push(
                &mut ranges,
                Range::new(p, n, argument, name)?,
                "the arrays of a Campbell diagram",
            )?;
        }
        disjoint(&[Range::new(force_factors, n, 6, "force_factors")?], &ranges)?;
        let found = unsafe {
            with_interrupt(&hooks, |interrupt| {
                campbell_response(&kept.branch, &model, &options, interrupt)
            })
        }
        .map_err(of_mode)?;
        for (i, one) in found.iter().enumerate() {
            unsafe {
                put(speed, i, one.speed);
                put(omega, i, one.omega);
                put(amplitude, i, one.amplitude);
                put(damping_ratio, i, one.damping_ratio);
                put(passed, i, one.passed);
                put(error, i, one.error);
            }
        }
        Ok(Status::Ok)
    })
}
