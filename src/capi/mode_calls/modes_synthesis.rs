//! Section "Modes" of the header: forced responses synthesised from a nonlinear mode.

#![allow(non_camel_case_types)]

use crate::analysis::synthesis::{Synthesis, SynthesisPeak, synthesise_with};
use crate::capi::crossing::arrays::{self, Range, check_pointer, disjoint, optional};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::{KeptBranch, read};
use crate::capi::crossing::versioned_struct::{VersionedStruct, init, load};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_interrupt};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, Status, fail};
use crate::model::Model;
use crate::options::SynthesisOptions;

/// Options of a synthesised response. Fill it by hbvib_synthesis_options_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_synthesis_options {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 1: add the damping of the model's C, for a mode that was computed without it; 0: do not.
    pub model_damping: i32,
    /// Factor on all forces of the model, > 0.
    pub force_factor: f64,
    /// Damping ratio that is added to the mode's, between -1 and 1.
    pub damping_ratio: f64,
}

unsafe impl VersionedStruct for hbvib_synthesis_options {
    const NAME: &'static str = "hbvib_synthesis_options";
    const FIRST_SIZE: usize = 24;

    fn defaults() -> Self {
        let defaults = SynthesisOptions::default();
        Self {
            struct_size: 0,
            model_damping: i32::from(defaults.model_damping),
            force_factor: defaults.force_factor,
            damping_ratio: defaults.damping_ratio,
        }
    }
}

/// Fills the options of a synthesis with their defaults: the forces and the damping as they are.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_synthesis_options_init(
    o: *mut hbvib_synthesis_options,
    size_of_o: usize,
) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// Response to the forces of a model in the fundamental, synthesised from a nonlinear mode: near
/// resonance the structure moves like one oscillator whose frequency and damping depend on the
/// amplitude. Points are ordered by rising amplitude below the resonance, then by falling amplitude
/// above it, two for each point of the branch at whose amplitude the force balances the damping.
///
/// branch           a nonlinear mode.
/// model            the model of the mode, or one with other forces or damping; forces in other
///                  harmonics have no effect.
/// options          NULL: the defaults.
/// capacity         numbers that fit into each array; twice the points of the branch suffice.
/// omega            receives the angular frequencies of the force, or NULL.
/// response         receives the fundamentals of the branch's response degree of freedom, complex,
///                  in phase with the force where real; or NULL.
/// modal_amplitude  receives the modal amplitudes, or NULL.
/// count            receives how many points there are, also when `capacity` is too small.
/// Errors: HBVIB_E_UNSUPPORTED (branch is no mode), HBVIB_E_DIMENSION (capacity too small, a model
/// of another size), HBVIB_E_ARGUMENT (options, a model whose forces excite another wave or none,
/// overlapping arrays), HBVIB_E_NOT_FINITE, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_STRUCT_SIZE,
/// HBVIB_E_OUT_OF_MEMORY. Threads: any number on one branch.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_branch_synthesis(
    branch: *const hbvib_branch,
    model: *const hbvib_model,
    options: *const hbvib_synthesis_options,
    capacity: i64,
    omega: *mut f64,
    response: *mut f64,
    modal_amplitude: *mut f64,
    count: *mut i64,
) -> hbvib_status {
    unsafe {
        hbvib_branch_synthesis_with_hooks(
            branch,
            model,
            options,
            capacity,
            omega,
            response,
            modal_amplitude,
            count,
            core::ptr::null(),
        )
    }
}

/// The same as hbvib_branch_synthesis; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and what it writes is untouched.
///
/// branch           a nonlinear mode.
/// model            the model of the mode, or one with other forces or damping; forces in other
///                  harmonics have no effect.
/// options          NULL: the defaults.
/// capacity         numbers that fit into each array; twice the points of the branch suffice.
/// omega            receives the angular frequencies of the force, or NULL.
/// response         receives the fundamentals of the branch's response degree of freedom, complex,
///                  in phase with the force where real; or NULL.
/// modal_amplitude  receives the modal amplitudes, or NULL.
/// count            receives how many points there are, also when `capacity` is too small.
/// hooks            phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_branch_synthesis.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_branch_synthesis_with_hooks(
    branch: *const hbvib_branch,
    model: *const hbvib_model,
    options: *const hbvib_synthesis_options,
    capacity: i64,
    omega: *mut f64,
    response: *mut f64,
    modal_amplitude: *mut f64,
    count: *mut i64,
    hooks: *const hbvib_hooks,
) -> hbvib_status {
    call(|| {
        let hooks = unsafe { load_hooks(hooks, 9) }?;
        let capacity = arrays::count(capacity, 4, "capacity")?;
        check_pointer(count, 8, "count")?;
        let omega = optional((omega, 5), "omega")?;
        let response = optional((response, 6), "response")?;
        let modal = optional((modal_amplitude, 7), "modal_amplitude")?;
        let found = unsafe { synthesis((branch, model, options), false, &hooks) }?.points;
        let none = omega.is_none() && response.is_none() && modal.is_none();
        if !none && capacity < found.len() {
            unsafe { count.write(found.len() as i64) };
            return fail!(Dimension, "capacity = {capacity}, needs {}", found.len()).with_argument(4);
        }
        let range = |p: Option<*mut f64>, len, argument, name| {
            Range::new(p.unwrap_or(core::ptr::null_mut()).cast_const(), len, argument, name)
        };
        disjoint(
            &[],
            &[
                range(omega, found.len(), 5, "omega")?,
                range(response, 2 * found.len(), 6, "response")?,
                range(modal, found.len(), 7, "modal_amplitude")?,
            ],
        )?;
        for (i, point) in found.iter().enumerate() {
            unsafe {
                if let Some(p) = omega {
                    p.add(i).write(point.omega);
                }
                if let Some(p) = response {
                    p.add(2 * i).write(point.response.re);
                    p.add(2 * i + 1).write(point.response.im);
                }
                if let Some(p) = modal {
                    p.add(i).write(point.modal_amplitude);
                }
            }
        }
        unsafe { count.write(found.len() as i64) };
        Ok(Status::Ok)
    })
}

/// Reasons to doubt a synthesised resonance: bits of a sum.
#[repr(C)]
pub enum hbvib_synthesis_flag {
    /// No reason for doubt was found, and the computed resonance has the same amplitude within 1 %.
    HBVIB_SYNTHESIS_VALID = 0,
    /// Another mode lies within the half-power bandwidth, or shares the frequency of the linear
    /// mode.
    HBVIB_SYNTHESIS_ANOTHER_MODE = 1,
    /// Higher harmonics hold more than 1 % of the kinetic energy, or the point lies where the
    /// amplitude falls along the branch, beyond a fold.
    HBVIB_SYNTHESIS_INTERNAL_RESONANCE = 2,
    /// The amplitude falls as the force rises: a detached response begins here.
    HBVIB_SYNTHESIS_FALLING = 4,
    /// The amplitude differs by 1 % or more from that of the computed resonance next to it, or no
    /// such resonance was found.
    HBVIB_SYNTHESIS_INACCURATE = 8,
}

/// Resonances of a synthesised response, refined on the equations of the mode, in the order of the
/// branch; none where the force is too small or too large for its amplitudes.
///
/// branch, model           as for hbvib_branch_synthesis.
/// options                 NULL: the defaults.
/// capacity                numbers that fit into each array.
/// omega                   receives their angular frequencies, or NULL.
/// amplitude               receives the amplitudes |X_1| of the response degree of freedom, or
///                         NULL.
/// log10_amplitude         receives the amplitudes as the branch measures them, log10, or NULL.
/// damping_ratio           receives the total damping ratios there, or NULL.
/// other_mode              receives the distance to the nearest other natural frequency of the wave
///                         over the half-power bandwidth, infinite where none is known; or NULL.
/// error                   receives the amplitudes over those of the computed resonances next to
///                         them, minus 1, NaN where none was found; or NULL.
/// flags                   receives reasons for doubt, sums of hbvib_synthesis_flag; or NULL.
/// count                   receives how many there are, also when `capacity` is too small.
/// Errors and threads: as for hbvib_branch_synthesis.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_branch_synthesis_peaks(
    branch: *const hbvib_branch,
    model: *const hbvib_model,
    options: *const hbvib_synthesis_options,
    capacity: i64,
    omega: *mut f64,
    amplitude: *mut f64,
    log10_amplitude: *mut f64,
    damping_ratio: *mut f64,
    other_mode: *mut f64,
    error: *mut f64,
    flags: *mut i32,
    count: *mut i64,
) -> hbvib_status {
    unsafe {
        hbvib_branch_synthesis_peaks_with_hooks(
            branch,
            model,
            options,
            capacity,
            omega,
            amplitude,
            log10_amplitude,
            damping_ratio,
            other_mode,
            error,
            flags,
            count,
            core::ptr::null(),
        )
    }
}

/// The same as hbvib_branch_synthesis_peaks; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and what it writes is untouched.
///
/// branch, model           as for hbvib_branch_synthesis.
/// options                 NULL: the defaults.
/// capacity                numbers that fit into each array.
/// omega                   receives their angular frequencies, or NULL.
/// amplitude               receives the amplitudes |X_1| of the response degree of freedom, or
///                         NULL.
/// log10_amplitude         receives the amplitudes as the branch measures them, log10, or NULL.
/// damping_ratio           receives the total damping ratios there, or NULL.
/// other_mode              receives the distance to the nearest other natural frequency of the wave
///                         over the half-power bandwidth, infinite where none is known; or NULL.
/// error                   receives the amplitudes over those of the computed resonances next to
///                         them, minus 1, NaN where none was found; or NULL.
/// flags                   receives reasons for doubt, sums of hbvib_synthesis_flag; or NULL.
/// count                   receives how many there are, also when `capacity` is too small.
/// hooks                   phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_branch_synthesis_peaks.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_branch_synthesis_peaks_with_hooks(
    branch: *const hbvib_branch,
    model: *const hbvib_model,
    options: *const hbvib_synthesis_options,
    capacity: i64,
    omega: *mut f64,
    amplitude: *mut f64,
    log10_amplitude: *mut f64,
    damping_ratio: *mut f64,
    other_mode: *mut f64,
    error: *mut f64,
    flags: *mut i32,
    count: *mut i64,
    hooks: *const hbvib_hooks,
) -> hbvib_status {
    call(|| {
        let hooks = unsafe { load_hooks(hooks, 13) }?;
        let capacity = arrays::count(capacity, 4, "capacity")?;
        check_pointer(count, 12, "count")?;
        let columns: [(*mut f64, i32, &str, Column); 6] = [
            (omega, 5, "omega", |p| p.at.omega),
            (amplitude, 6, "amplitude", |p| p.at.response.norm()),
            (log10_amplitude, 7, "log10_amplitude", |p| p.log10_amplitude),
            (damping_ratio, 8, "damping_ratio", |p| p.at.damping_ratio),
            (other_mode, 9, "other_mode", |p| p.validity.other_mode),
            (error, 10, "error", |p| p.validity.error),
        ];
        let mut wanted = false;
        for (p, argument, name, _) in &columns {
            wanted |= optional((*p, *argument), name)?.is_some();
        }
        let flags = optional((flags, 11), "flags")?;
        wanted |= flags.is_some();
        // The computed resonances take their time, which a caller who only counts does not need.
        let compare = flags.is_some() || !error.is_null();
        let found = unsafe { synthesis((branch, model, options), compare, &hooks) }?.peaks;
        unsafe { count.write(found.len() as i64) };
        if wanted && capacity < found.len() {
            return fail!(Dimension, "capacity = {capacity}, needs {}", found.len()).with_argument(4);
        }
        for (i, peak) in found.iter().enumerate() {
            for (p, .., value) in &columns {
                if !p.is_null() {
                    unsafe { p.add(i).write(value(peak)) };
                }
            }
            if let Some(p) = flags {
                unsafe { p.add(i).write(bits(peak)) };
            }
        }
        Ok(Status::Ok)
    })
}

/// The common first part of both functions.
unsafe fn synthesis(
    (branch, model, options): (*const hbvib_branch, *const hbvib_model, *const hbvib_synthesis_options),
    compare: bool,
    hooks: &hbvib_hooks,
) -> Result<Synthesis> {
    let kept = read::<KeptBranch>(branch, 1)?;
    let model = read::<Model>(model, 2)?;
    let mut chosen = SynthesisOptions {
        compare,
        ..SynthesisOptions::default()
    };
    if !options.is_null() {
        let o = unsafe { load(options, 3) }?;
        chosen = SynthesisOptions {
            force_factor: o.force_factor,
            damping_ratio: o.damping_ratio,
            compare,
            model_damping: match o.model_damping {
                0 => false,
                1 => true,
                other => return fail!(Argument, "model_damping = {other}, needs 0 or 1").with_argument(3),
            },
        };
        chosen.check().with_argument(3)?;
    }
    let found = unsafe {
        with_interrupt(hooks, |interrupt| {
            synthesise_with(&kept.branch, &model, &chosen, interrupt)
        })
    };
    found.map_err(|e| match e.status {
        Status::Unsupported => e.in_argument(1),
        Status::Argument | Status::Dimension => e.in_argument(2),
        _ => e,
    })
}

/// A number of a resonance.
type Column = fn(&SynthesisPeak) -> f64;

fn bits(peak: &SynthesisPeak) -> i32 {
    use hbvib_synthesis_flag as Flag;
    let mut sum = Flag::HBVIB_SYNTHESIS_VALID as i32;
    for (set, flag) in [
        (peak.validity.another_mode(), Flag::HBVIB_SYNTHESIS_ANOTHER_MODE as i32),
        (
            peak.validity.internal_resonance(),
            Flag::HBVIB_SYNTHESIS_INTERNAL_RESONANCE as i32,
        ),
        (!peak.rising, Flag::HBVIB_SYNTHESIS_FALLING as i32),
        (peak.validity.inaccurate(), Flag::HBVIB_SYNTHESIS_INACCURATE as i32),
    ] {
        if set {
            sum += flag;
        }
    }
    sum
}
