//! Section "Time" of the header: run-ups and missions by the slow flow of a nonlinear mode.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{Column, Entry, check_pointer, count as length, fill_list, input, output};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::{KeptBranch, read};
use crate::capi::crossing::indices::index;
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, fill_out, init, load};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_interrupt};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Error, Result, Status, fail};
use crate::model::Model;
use crate::options::{MissionOptions, RUN_UP_INTEGRATED_TURNS, RunUpOptions, SynthesisOptions, Woehler};
use crate::studies;
use core::ptr;

/// Options of hbvib_branch_run_up. Fill it by hbvib_run_up_options_init, then set frequencies and
/// rate.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_run_up_options {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// As of hbvib_synthesis_options; default 0.
    pub model_damping: i32,
    /// First angular frequency of the forces, > 0, rad per time unit.
    pub omega_start: f64,
    /// Last one, > 0; below the first for a run-down.
    pub omega_stop: f64,
    /// Change of the angular frequency per time, > 0 in both senses.
    pub rate: f64,
    /// Degree of freedom whose displacement is observed; default -1: that of the mode.
    pub dof: i64,
    /// Factor on all forces of the model, > 0; default 1.
    pub force_factor: f64,
    /// Damping ratio that is added to the mode's; default 0. With one, nothing is integrated.
    pub damping_ratio: f64,
    /// Most turns that are integrated in time around the largest displacement, which corrects it and
    /// tells its error; default 10000; 0: none.
    pub integrated_turns: i64,
}

unsafe impl VersionedStruct for hbvib_run_up_options {
    const NAME: &'static str = "hbvib_run_up_options";
    const FIRST_SIZE: usize = 64;

    fn defaults() -> Self {
        let defaults = SynthesisOptions::default();
        Self {
            struct_size: 0,
            model_damping: 0,
            omega_start: 0.0,
            omega_stop: 0.0,
            rate: 0.0,
            dof: -1,
            force_factor: defaults.force_factor,
            damping_ratio: defaults.damping_ratio,
            integrated_turns: RUN_UP_INTEGRATED_TURNS as i64,
        }
    }
}

/// Fills the options of a run-up: the degree of freedom of the mode, forces and damping as they
/// are.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_run_up_options_init(o: *mut hbvib_run_up_options, size_of_o: usize) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// Numbers of a run-up. Fill it by hbvib_run_up_info_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_run_up_info {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 0.
    pub reserved: i32,
    /// Largest displacement.
    pub largest: f64,
    /// Angular frequency of the forces then.
    pub largest_omega: f64,
    /// That time, from the begin of the run-up.
    pub largest_time: f64,
    /// Relative error of the largest displacement: by how much three leads of the integration in time
    /// change it. Where `integrated` is 0 it is an estimate that may be too small; NaN where no
    /// steady resonance of the mode under these forces was found to compare with.
    pub error: f64,
    /// The largest displacement without the memory of sliders.
    pub without_memory: f64,
    /// Largest displacement of the highest steady resonance at the degree of freedom, with the mean
    /// and all harmonics as `largest` has it; NaN without one.
    pub steady: f64,
    /// The largest displacement by the slow flow alone.
    pub slow_flow: f64,
    /// Turns that were integrated in time; 0: none, and `largest` is that of the slow flow.
    pub integrated: i64,
}

unsafe impl VersionedStruct for hbvib_run_up_info {
    const NAME: &'static str = "hbvib_run_up_info";
    const FIRST_SIZE: usize = 72;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            reserved: 0,
            largest: 0.0,
            largest_omega: 0.0,
            largest_time: 0.0,
            error: 0.0,
            without_memory: 0.0,
            steady: 0.0,
            slow_flow: 0.0,
            integrated: 0,
        }
    }
}

/// Fills the numbers of a run-up with zeros.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_run_up_info_init(i: *mut hbvib_run_up_info, size_of_i: usize) -> hbvib_status {
    call(|| unsafe { init(i, size_of_i) })
}

/// The amplitude while the frequency of the forces changes at a constant rate, from the steady
/// motion at the first frequency on, by the slow flow of a nonlinear mode with the memory of
/// sliders. Turns around the largest displacement are integrated in time, which corrects it and
/// tells its error. hbvib_time_sweep integrates the whole motion.
///
/// branch           a nonlinear mode.
/// model            a plain model as for hbvib_branch_synthesis; forces in other harmonics act in
///                  the turns that are integrated alone.
/// options          frequencies and rate.
/// hooks            phase and cancellation; NULL: none.
/// capacity         numbers that fit into each array.
/// time             receives the time at the begin of each turn of the forces, or NULL.
/// omega            receives the angular frequency there, or NULL.
/// amplitude        receives the largest displacement in each turn, or NULL.
/// modal_amplitude  receives the modal amplitude at its begin, or NULL.
/// count            receives the number of turns, also when `capacity` is too small; or NULL.
/// info             receives the numbers; fill it by hbvib_run_up_info_init before; or NULL.
/// Errors: HBVIB_E_ARGUMENT (options; the amplitude leaves those of the mode), HBVIB_E_INDEX (dof),
/// HBVIB_E_UNSUPPORTED (a cyclic model, an unbalance, a law that is not integrated in time),
/// HBVIB_E_DIMENSION (capacity), those of hbvib_branch_synthesis. HBVIB_STOPPED_BY_CALLER: nothing
/// is written. Threads: any number on one model and branch.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_branch_run_up(
    branch: *const hbvib_branch,
    model: *const hbvib_model,
    options: *const hbvib_run_up_options,
    hooks: *const hbvib_hooks,
    capacity: i64,
    time: *mut f64,
    omega: *mut f64,
    amplitude: *mut f64,
    modal_amplitude: *mut f64,
    count: *mut i64,
    info: *mut hbvib_run_up_info,
) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        let model = read::<Model>(model, 2)?;
        let o = unsafe { load(options, 3) }?;
        let options = RunUpOptions {
            omega_start: o.omega_start,
            omega_stop: o.omega_stop,
            rate: o.rate,
            dof: observed(o.dof, &model, 3)?,
            integrated_turns: length(o.integrated_turns, 3, "integrated_turns")?,
            synthesis: synthesis((o.force_factor, o.damping_ratio, o.model_damping), 3)?,
        };
        options.check(model.ndof()).with_argument(3)?;
        let hooks = unsafe { load_hooks(hooks, 4) }?;
        if !info.is_null() {
            unsafe { check_out(info, 11) }?;
        }
        let mut unused = 0_i64;
        let count = if count.is_null() { &raw mut unused } else { count };
        check_pointer(count, 10, "count")?;
        let columns = [
            Column::Reals(time, 6, "time"),
            Column::Reals(omega, 7, "omega"),
            Column::Reals(amplitude, 8, "amplitude"),
            Column::Reals(modal_amplitude, 9, "modal_amplitude"),
        ];
        let found = unsafe {
            with_interrupt(&hooks, |interrupt| {
                studies::run_up(&kept.branch, &model, &options, interrupt)
            })
        }
        .map_err(of_mode)?;
        let turns = found.turns.iter().map(|turn| {
            [
                Entry::Real(turn.time),
                Entry::Real(turn.omega),
                Entry::Real(turn.amplitude),
                Entry::Real(turn.modal_amplitude),
            ]
        });
        let wanted = [time, omega, amplitude, modal_amplitude].iter().any(|p| !p.is_null());
        let room = if wanted { capacity } else { found.turns.len() as i64 };
        unsafe { fill_list(&columns, turns, (room, 5), (count, 10)) }?;
        if !info.is_null() {
            let value = hbvib_run_up_info {
                largest: found.largest,
                largest_omega: found.largest_omega,
                largest_time: found.largest_time,
                error: found.error,
                without_memory: found.without_memory,
                steady: found.steady,
                slow_flow: found.slow_flow,
                integrated: found.integrated as i64,
                ..hbvib_run_up_info::defaults()
            };
            unsafe { fill_out(info, value) };
        }
        Ok(Status::Ok)
    })
}

/// A mission of hbvib_branch_mission. Fill it by hbvib_mission_options_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_mission_options {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// As of hbvib_synthesis_options; default 0.
    pub model_damping: i32,
    /// Rising times, points_len numbers.
    pub times: *const f64,
    /// Speeds of rotation at the times, > 0, points_len numbers; straight between them.
    pub speeds: *const f64,
    /// Number of times, >= 2.
    pub points_len: i64,
    /// Angular frequency of the forces over the speed, > 0; default 1.
    pub engine_order: f64,
    /// Degree of freedom whose amplitude is read; default -1: that of the mode.
    pub dof: i64,
    /// Rising amplitudes between which cycles are counted, edges_len numbers; or NULL.
    pub edges: *const f64,
    /// Number of edges.
    pub edges_len: i64,
    /// Stress amplitude per modal amplitude of each place, >= 0, stresses_len numbers; or NULL.
    pub stresses: *const f64,
    /// Number of stresses.
    pub stresses_len: i64,
    /// Stress amplitude of the knee of the Woehler line, > 0; needed with stresses.
    pub woehler_stress: f64,
    /// Cycles to failure at the knee, > 0.
    pub woehler_cycles: f64,
    /// Slope k above the knee, N ~ stress^-k, > 0.
    pub woehler_slope: f64,
    /// Slope below the knee; default 0: stresses below do no damage.
    pub woehler_slope_below: f64,
    /// Factor on all forces of the model, > 0; default 1.
    pub force_factor: f64,
    /// Damping ratio that is added to the mode's; default 0.
    pub damping_ratio: f64,
}

unsafe impl VersionedStruct for hbvib_mission_options {
    const NAME: &'static str = "hbvib_mission_options";
    const FIRST_SIZE: usize = 128;

    fn defaults() -> Self {
        let defaults = SynthesisOptions::default();
        Self {
            struct_size: 0,
            model_damping: 0,
            times: ptr::null(),
            speeds: ptr::null(),
            points_len: 0,
            engine_order: 1.0,
            dof: -1,
            edges: ptr::null(),
            edges_len: 0,
            stresses: ptr::null(),
            stresses_len: 0,
            woehler_stress: 0.0,
            woehler_cycles: 0.0,
            woehler_slope: 0.0,
            woehler_slope_below: 0.0,
            force_factor: defaults.force_factor,
            damping_ratio: defaults.damping_ratio,
        }
    }
}

/// Fills the options of a mission: no point, engine order 1.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_mission_options_init(o: *mut hbvib_mission_options, size_of_o: usize) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// One resonance over a mission, speed against time, by the slow flow of its nonlinear mode without
/// the memory of sliders: amplitudes, cycles of each amplitude, and the sum of Miner. Several
/// resonances are as many calls, whose sums add. No error of the damage is told: in quick passages
/// it is too small (docs/life.md has figures); sum turns of hbvib_time_sweep where they count.
///
/// branch        a nonlinear mode.
/// model         as for hbvib_branch_synthesis; its own speed has no effect.
/// options       the mission.
/// hooks         phase and cancellation; NULL: none.
/// amplitude     receives the amplitude at each time, in the fundamental, points_len numbers; or
///               NULL.
/// cycles        receives the cycles below the first edge, between edges, and above the last one,
///               edges_len + 1 numbers; or NULL.
/// damage        receives the sum of Miner of each stress, stresses_len numbers; or NULL.
/// capacity      passages that fit into the arrays that follow.
/// crossing      receives for each passage through the resonance the time of its largest amplitude,
///               the angular frequency, its change per time, and the largest amplitude, then the
///               steady one (NaN if unknown), and the cycles with at least 1/sqrt(2) of the largest
///               amplitude: six numbers each; or NULL.
/// count         receives the number of passages, also when `capacity` is too small; or NULL.
/// error         receives the amplitude of the highest steady resonance of the mode over that of
///               the computed one, minus 1; NaN if unknown; or NULL.
/// Errors: HBVIB_E_ARGUMENT (options; the amplitude leaves those of the mode), HBVIB_E_INDEX (dof),
/// HBVIB_E_UNSUPPORTED (an unbalance), HBVIB_E_DIMENSION (lengths, capacity), those of
/// hbvib_branch_synthesis. HBVIB_STOPPED_BY_CALLER: nothing is written. Threads: any number on one
/// model and branch.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_branch_mission(
    branch: *const hbvib_branch,
    model: *const hbvib_model,
    options: *const hbvib_mission_options,
    hooks: *const hbvib_hooks,
    amplitude: *mut f64,
    cycles: *mut f64,
    damage: *mut f64,
    capacity: i64,
    crossing: *mut f64,
    count: *mut i64,
    error: *mut f64,
) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        let model = read::<Model>(model, 2)?;
        let o = unsafe { load(options, 3) }?;
        let points = length(o.points_len, 3, "points_len")?;
        let edges = length(o.edges_len, 3, "edges_len")?;
        let stresses = length(o.stresses_len, 3, "stresses_len")?;
        let has_line = stresses > 0 || o.woehler_stress != 0.0 || o.woehler_cycles != 0.0 || o.woehler_slope != 0.0;
        let options = MissionOptions {
            times: unsafe { input(o.times, points, 3, "times") }?,
            speeds: unsafe { input(o.speeds, points, 3, "speeds") }?,
            engine_order: o.engine_order,
            dof: observed(o.dof, &model, 3)?,
            edges: unsafe { input(o.edges, edges, 3, "edges") }?,
            stresses: unsafe { input(o.stresses, stresses, 3, "stresses") }?,
            woehler: has_line.then_some(Woehler {
                stress: o.woehler_stress,
                cycles: o.woehler_cycles,
                slope: o.woehler_slope,
                slope_below: o.woehler_slope_below,
            }),
            synthesis: synthesis((o.force_factor, o.damping_ratio, o.model_damping), 3)?,
        };
        options.check(model.ndof()).with_argument(3)?;
        let hooks = unsafe { load_hooks(hooks, 4) }?;
        let room = length(capacity, 8, "capacity")?;
        for (p, argument, name) in [
            (amplitude, 5, "amplitude"),
            (cycles, 6, "cycles"),
            (damage, 7, "damage"),
            (crossing, 9, "crossing"),
            (error, 11, "error"),
        ] {
            if !p.is_null() {
                check_pointer(p, argument, name)?;
            }
        }
        if !count.is_null() {
            check_pointer(count, 10, "count")?;
        }
        let found = unsafe {
            with_interrupt(&hooks, |interrupt| {
                studies::mission(&kept.branch, &model, &options, interrupt)
            })
        }
        .map_err(of_mode)?;
        let passages = found.crossings.len();
        unsafe {
            if !count.is_null() {
                count.write(passages as i64);
            }
            if !crossing.is_null() && room < passages {
                return fail!(Dimension, "capacity = {room}, needs {passages}").with_argument(8);
            }
            for (p, list, argument, name) in [
                (amplitude, &found.amplitude, 5, "amplitude"),
                (cycles, &found.cycles, 6, "cycles"),
                (damage, &found.damage, 7, "damage"),
            ] {
                if !p.is_null() {
                    output(p, list.len(), argument, name)?.copy_from_slice(list);
                }
            }
            if !crossing.is_null() {
                let rows = output(crossing, 6 * passages, 9, "crossing")?;
                for (row, one) in rows.chunks_exact_mut(6).zip(&found.crossings) {
                    row.copy_from_slice(&[one.time, one.omega, one.rate, one.amplitude, one.steady, one.cycles]);
                }
            }
            if !error.is_null() {
                error.write(found.error);
            }
        }
        Ok(Status::Ok)
    })
}

/// A degree of freedom, or -1 for that of the mode.
fn observed(dof: i64, model: &Model, argument: i32) -> Result<Option<usize>> {
    if dof == -1 {
        return Ok(None);
    }
    index(dof, model.ndof(), argument, "dof").map(Some)
}

/// Forces and damping of a synthesis.
pub(crate) fn synthesis(
    (force_factor, damping_ratio, damping): (f64, f64, i32),
    argument: i32,
) -> Result<SynthesisOptions> {
    Ok(SynthesisOptions {
        force_factor,
        damping_ratio,
        model_damping: match damping {
            0 => false,
            1 => true,
            other => return fail!(Argument, "model_damping = {other}, needs 0 or 1").with_argument(argument),
        },
        ..SynthesisOptions::default()
    })
}

/// The argument of an error of the mode or its model.
pub(crate) fn of_mode(e: Error) -> Error {
    match e.status {
        Status::Unsupported | Status::Argument | Status::Dimension if e.argument == 0 => e.in_argument(1),
        _ => e,
    }
}
