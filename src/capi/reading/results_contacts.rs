//! Section "Results" of the header: states, loops and work of a contact at a point.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{Range, disjoint, optional};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::{KeptBranch, read};
use crate::capi::crossing::indices::{index, times};
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, fill_out, init};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_interrupt};
use crate::capi::version_and_errors::hbvib_status;
use crate::contact::forms::contact_state::State;
use crate::error::{Status, fail};

/// State of a contact at one time.
#[repr(C)]
pub enum hbvib_state {
    /// It sticks, or presses. Contacts that never slip, contacts without force and laws without
    /// states (springs except HBVIB_UNILATERAL) are always in this state.
    HBVIB_STATE_STICK = 0,
    /// It slips: the force is at the slip limit.
    HBVIB_STATE_SLIP = 1,
    /// It is open, without force.
    HBVIB_STATE_OPEN = 2,
}

/// Hysteresis loop of a contact in one of its directions over one period of the fundamental at a
/// stored point: entry j at omega t = 2 pi j / n. The force is that of this contact alone and not
/// truncated at harmonic H: the law at the motion of the point. Events of HBVIB_JENKINS and
/// HBVIB_UNILATERAL are located exactly, also where the branch was solved with samples; friction in
/// a plane is followed exactly, and a law of the caller is called with the n times, up to 16384 at
/// once; with states it is marched over them. In a cyclic model the contact is that of sector 0. A
/// contact that is linear at any motion has its linear force and sticks; the motion of the whole
/// structure is recovered for it.
///
/// point      number of a point of the curve, or of a peak, fold or requested solution.
/// contact    number from hbvib_model_add_contact.
/// direction  one of the directions of the contact from 0, in the order t1, t2, n of those in which
///            it acts: 0 for laws of one direction. hbvib_contact_summary has their number.
/// n          number of times, 1 .. 2^24.
/// motion     receives n relative motions, side a minus side b, or NULL.
/// force      receives n forces f, which act on side a as + f and on side b as - f in
///            M x'' + C x' + K x + f = f_ex; or NULL. Along the normal f is minus the normal load.
/// state      receives n states of the contact, HBVIB_STATE_STICK and so on, the same for all its
///            directions, or NULL. Not all three may be NULL.
/// Errors, with all arrays untouched: HBVIB_E_INDEX (point, contact, direction), HBVIB_E_DIMENSION
/// (n), HBVIB_E_NULL, HBVIB_E_ARGUMENT (overlapping arrays), HBVIB_E_HANDLE, HBVIB_E_OUT_OF_MEMORY,
/// HBVIB_E_CALLBACK, HBVIB_E_NO_CONVERGENCE.
/// Memory: 16 n bytes and n, and a law of the caller with states some hundred n: a march above
/// 500 MB is refused with the n that it needs (HBVIB_E_OUT_OF_MEMORY).
/// Threads: any number on one branch.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_branch_contact_loop(
    branch: *const hbvib_branch,
    point: i64,
    contact: i64,
    direction: i64,
    n: i64,
    motion: *mut f64,
    force: *mut f64,
    state: *mut i32,
) -> hbvib_status {
    unsafe {
        hbvib_branch_contact_loop_with_hooks(
            branch,
            point,
            contact,
            direction,
            n,
            motion,
            force,
            state,
            core::ptr::null(),
        )
    }
}

/// The same as hbvib_branch_contact_loop; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and what it writes is untouched.
///
/// point      number of a point of the curve, or of a peak, fold or requested solution.
/// contact    number from hbvib_model_add_contact.
/// direction  one of the directions of the contact from 0, in the order t1, t2, n of those in which
///            it acts: 0 for laws of one direction. hbvib_contact_summary has their number.
/// n          number of times, 1 .. 2^24.
/// motion     receives n relative motions, side a minus side b, or NULL.
/// force      receives n forces f, which act on side a as + f and on side b as - f in
///            M x'' + C x' + K x + f = f_ex; or NULL. Along the normal f is minus the normal load.
/// state      receives n states of the contact, HBVIB_STATE_STICK and so on, the same for all its
///            directions, or NULL. Not all three may be NULL.
/// hooks      phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_branch_contact_loop.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_branch_contact_loop_with_hooks(
    branch: *const hbvib_branch,
    point: i64,
    contact: i64,
    direction: i64,
    n: i64,
    motion: *mut f64,
    force: *mut f64,
    state: *mut i32,
    hooks: *const hbvib_hooks,
) -> hbvib_status {
    call(|| {
        let hooks = unsafe { load_hooks(hooks, 9) }?;
        let kept = read::<KeptBranch>(branch, 1)?;
        let branch = &kept.branch;
        let point = index(point, branch.stored(), 2, "point")?;
        let contact = index(contact, branch.contacts(), 3, "contact")?;
        let directions = branch.contact_directions(contact).unwrap_or(0);
        let direction = index(direction, directions, 4, "direction")?;
        let n = times(n, 5)?;
        if motion.is_null() && force.is_null() && state.is_null() {
            return fail!(Null, "motion, force and state are NULL, needs one of them").with_argument(6);
        }
        disjoint(
            &[],
            &[
                Range::new(motion, n, 6, "motion")?,
                Range::new(force, n, 7, "force")?,
                Range::new(state, n, 8, "state")?,
            ],
        )?;
        let motion = optional((motion, 6), "motion")?;
        let force = optional((force, 7), "force")?;
        let state = optional((state, 8), "state")?;
        let wanted = [motion.is_some(), force.is_some(), state.is_some()];
        let found = unsafe {
            with_interrupt(&hooks, |interrupt| {
                branch.contact_loop_along((point, contact, direction), n, wanted, interrupt)
            })
        }?;
        for (out, values) in [(motion, &found.motion), (force, &found.force)] {
            if let Some(p) = out {
                for (j, value) in values.iter().enumerate() {
                    unsafe { p.add(j).write(*value) };
                }
            }
        }
        if let Some(p) = state {
            for (j, &now) in found.state.iter().enumerate() {
                unsafe { p.add(j).write(state_number(now)) };
            }
        }
        Ok(Status::Ok)
    })
}

/// Numbers of one contact over one period, in the units of the caller. Ranges are exact for the
/// motion of the point, and so are all numbers of HBVIB_JENKINS, HBVIB_CUBIC and HBVIB_UNILATERAL;
/// shares and work of laws that are sampled have the accuracy of the samples of the branch. Fill it
/// by hbvib_contact_summary_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_contact_summary {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 0.
    pub reserved: i32,
    /// Work per cycle that the contact takes from the motion in all its directions; exactly 0 for
    /// friction that does not slip and for springs of one motion. The sum over all contacts is the
    /// friction_loss of hbvib_energy, up to the error by sampling where the branch was solved with
    /// samples.
    pub work: f64,
    /// Share of the period that it slips, 0 to 1, open time not included.
    pub slip_share: f64,
    /// Share of the period that it is open, 0 to 1.
    pub open_share: f64,
    /// Half the range of the relative motion in the first direction, (max - min) / 2.
    pub half_range: f64,
    /// Smallest relative motion in the first direction, side a minus side b.
    pub motion_min: f64,
    /// Largest relative motion in the first direction.
    pub motion_max: f64,
    /// Smallest normal load. A constant load is reported as it is, also the infinite preload of
    /// HBVIB_JENKINS. Springs that cannot open have no load: 0.
    pub load_min: f64,
    /// Largest normal load.
    pub load_max: f64,
    /// Number of directions of the contact, in the order t1, t2, n of those in which it acts.
    pub directions: i64,
    /// Smallest relative motions, direction by direction, of up to three; 0 beyond `directions`.
    pub all_min: [f64; 3],
    /// Largest relative motions likewise.
    pub all_max: [f64; 3],
}

unsafe impl VersionedStruct for hbvib_contact_summary {
    const NAME: &'static str = "hbvib_contact_summary";
    const FIRST_SIZE: usize = 72;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            reserved: 0,
            work: 0.0,
            slip_share: 0.0,
            open_share: 0.0,
            half_range: 0.0,
            motion_min: 0.0,
            motion_max: 0.0,
            load_min: 0.0,
            load_max: 0.0,
            directions: 0,
            all_min: [0.0; 3],
            all_max: [0.0; 3],
        }
    }
}

/// Fills the summary of a contact with zeros.
///
/// s          the struct; untouched on error.
/// size_of_s  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_contact_summary_init(s: *mut hbvib_contact_summary, size_of_s: usize) -> hbvib_status {
    call(|| unsafe { init(s, size_of_s) })
}

/// Work, shares of the period and ranges of a contact at a stored point.
///
/// point    number of a point of the curve, or of a peak, fold or requested solution.
/// contact  number from hbvib_model_add_contact.
/// out      receives the numbers; fill it by hbvib_contact_summary_init before; untouched on error.
/// Errors: HBVIB_E_INDEX (point, contact), HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE,
/// HBVIB_E_OUT_OF_MEMORY, HBVIB_E_CALLBACK, HBVIB_E_NO_CONVERGENCE. Threads: any number on one
/// branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_contact_summary(
    branch: *const hbvib_branch,
    point: i64,
    contact: i64,
    out: *mut hbvib_contact_summary,
) -> hbvib_status {
    unsafe { hbvib_branch_contact_summary_with_hooks(branch, point, contact, out, core::ptr::null()) }
}

/// The same as hbvib_branch_contact_summary; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and out is untouched.
///
/// point    number of a point of the curve, or of a peak, fold or requested solution.
/// contact  number from hbvib_model_add_contact.
/// out      receives the numbers; fill it by hbvib_contact_summary_init before; untouched on error.
/// hooks    phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_branch_contact_summary.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_contact_summary_with_hooks(
    branch: *const hbvib_branch,
    point: i64,
    contact: i64,
    out: *mut hbvib_contact_summary,
    hooks: *const hbvib_hooks,
) -> hbvib_status {
    call(|| {
        let hooks = unsafe { load_hooks(hooks, 5) }?;
        let kept = read::<KeptBranch>(branch, 1)?;
        let branch = &kept.branch;
        let point = index(point, branch.stored(), 2, "point")?;
        let contact = index(contact, branch.contacts(), 3, "contact")?;
        unsafe { check_out(out, 4) }?;
        let s = unsafe {
            with_interrupt(&hooks, |interrupt| {
                branch.contact_summary_with(point, contact, interrupt)
            })
        }?;
        let value = hbvib_contact_summary {
            work: s.work,
            slip_share: s.slip_share,
            open_share: s.open_share,
            half_range: s.half_range[0],
            motion_min: s.motion_min[0],
            motion_max: s.motion_max[0],
            load_min: s.load_min,
            load_max: s.load_max,
            directions: s.directions as i64,
            all_min: s.motion_min,
            all_max: s.motion_max,
            ..hbvib_contact_summary::defaults()
        };
        unsafe { fill_out(out, value) };
        Ok(Status::Ok)
    })
}

fn state_number(state: State) -> i32 {
    match state {
        State::Stick => hbvib_state::HBVIB_STATE_STICK as i32,
        State::Slip => hbvib_state::HBVIB_STATE_SLIP as i32,
        State::Open => hbvib_state::HBVIB_STATE_OPEN as i32,
    }
}
