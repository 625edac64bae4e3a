//! Section "Modes" of the header: results that only the branch of a nonlinear mode has.

#![allow(non_camel_case_types)]

use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::{KeptBranch, read};
use crate::capi::crossing::indices::index;
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, fill_out, init};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, Status, fail};
use crate::model::natural_modes::repeated_modes::Multiple;
use crate::options::Amplitude;

/// Numbers of one point of a nonlinear mode, in the units of the caller; energies are of one
/// sector. Fill it by hbvib_mode_point_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_mode_point {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 0.
    pub reserved: i32,
    /// log10 of the amplitude, the parameter.
    pub log10_amplitude: f64,
    /// Angular frequency.
    pub omega: f64,
    /// Damping ratio D.
    pub damping_ratio: f64,
    /// Modal amplitude sqrt(X_1^H M X_1), whichever measure the parameter has.
    pub modal_amplitude: f64,
    /// T, sum over h > 0 of (h omega)^2 X_h^H M_h X_h / 2, which is twice the mean kinetic energy.
    pub energy: f64,
    /// Share of the fundamental in this energy, 0 to 1.
    pub fundamental_share: f64,
    /// Work of friction per cycle.
    pub friction_loss: f64,
    /// Work of the structure's damping per cycle.
    pub structural_loss: f64,
    /// (friction_loss + structural_loss) / (4 pi energy). With HBVIB_DAMPING_MASS it equals
    /// damping_ratio by the balance of work, which checks both.
    pub energy_damping_ratio: f64,
    /// |X_1^H M Y_1|^2 / (X_1^H M X_1 Y_1^H M Y_1) with the fundamental Y_1 of the point before; 1
    /// for the first.
    pub assurance: f64,
}

unsafe impl VersionedStruct for hbvib_mode_point {
    const NAME: &'static str = "hbvib_mode_point";
    const FIRST_SIZE: usize = 88;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            reserved: 0,
            log10_amplitude: 0.0,
            omega: 0.0,
            damping_ratio: 0.0,
            modal_amplitude: 0.0,
            energy: 0.0,
            fundamental_share: 0.0,
            friction_loss: 0.0,
            structural_loss: 0.0,
            energy_damping_ratio: 0.0,
            assurance: 0.0,
        }
    }
}

/// Fills a point of a mode with zeros.
///
/// p          the struct; untouched on error.
/// size_of_p  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_mode_point_init(p: *mut hbvib_mode_point, size_of_p: usize) -> hbvib_status {
    call(|| unsafe { init(p, size_of_p) })
}

/// Numbers of a stored point of a nonlinear mode.
///
/// point  number of a point of the curve, or of a peak, fold or requested solution.
/// out    receives the numbers; fill it by hbvib_mode_point_init before; untouched on error.
/// Errors: HBVIB_E_UNSUPPORTED (the branch of a forced response), HBVIB_E_INDEX (point),
/// HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_mode_point(
    branch: *const hbvib_branch,
    point: i64,
    out: *mut hbvib_mode_point,
) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        let branch = &kept.branch;
        if branch.mode().is_none() {
            return no_mode();
        }
        let point = index(point, branch.stored(), 2, "point")?;
        unsafe { check_out(out, 3) }?;
        let (Some(omega), Some(p)) = (branch.omega_at(point), branch.mode_at(point)) else {
            return fail!(Internal, "point {point} of the mode is incomplete");
        };
        let value = hbvib_mode_point {
            log10_amplitude: p.log10_amplitude,
            omega,
            damping_ratio: p.damping_ratio,
            modal_amplitude: p.modal_amplitude,
            energy: p.energy,
            fundamental_share: p.fundamental_share,
            friction_loss: p.friction_loss,
            structural_loss: p.structural_loss,
            energy_damping_ratio: p.energy_damping_ratio(),
            assurance: p.assurance,
            ..hbvib_mode_point::defaults()
        };
        unsafe { fill_out(out, value) };
        Ok(Status::Ok)
    })
}

/// How the linear mode was chosen among those of one frequency.
#[repr(C)]
pub enum hbvib_mode_multiple {
    /// The frequency is simple: there was nothing to choose.
    HBVIB_MODE_SINGLE = 0,
    /// Two real modes make a travelling wave (phi_1 + i phi_2) / sqrt(2), or the wave in the
    /// opposite direction.
    HBVIB_MODE_TRAVELLING_WAVE = 1,
    /// The mass-weighted projection of the given shape.
    HBVIB_MODE_PROJECTED = 2,
    /// The first mode found; another machine may find another one.
    HBVIB_MODE_FIRST = 3,
}

/// Start of a nonlinear mode. Fill it by hbvib_mode_info_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_mode_info {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// How one of several modes of the same frequency was chosen: HBVIB_MODE_SINGLE and so on.
    pub multiple: i32,
    /// Number of the linear mode, contacts stuck, from 0 by rising frequency.
    pub mode_index: i64,
    /// Number of modes of this frequency.
    pub multiplicity: i64,
    /// Degree of freedom whose fundamental is real.
    pub reference_dof: i64,
    /// Engine order of the wave: waves of the fundamental per turn, with the sign of their
    /// direction.
    pub engine_order: i64,
    /// -1: the parameter measures the modal amplitude; else the motion of this contact.
    pub amplitude_contact: i64,
    /// Angular frequency of the linear mode without damping.
    pub omega: f64,
    /// log10 of the largest amplitude at which all contacts stick, or keep their state at rest;
    /// minus infinity where a law is never linear, or the call was stopped before this was known.
    pub linear_up_to: f64,
    /// log10 of the amplitude at which the first contact begins to slip. Infinity: none slips on
    /// this branch. Minus infinity: one slips at the first point already, and it is not known from
    /// which amplitude on, or at every amplitude.
    pub slip_from: f64,
    /// The same for the first contact that presses at rest and lifts off.
    pub lift_off_from: f64,
}

unsafe impl VersionedStruct for hbvib_mode_info {
    const NAME: &'static str = "hbvib_mode_info";
    const FIRST_SIZE: usize = 64;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            multiple: hbvib_mode_multiple::HBVIB_MODE_SINGLE as i32,
            mode_index: 0,
            multiplicity: 0,
            reference_dof: 0,
            engine_order: 0,
            amplitude_contact: -1,
            omega: 0.0,
            linear_up_to: 0.0,
            slip_from: 0.0,
            lift_off_from: 0.0,
        }
    }
}

/// Fills the description of a mode with zeros, amplitude_contact with -1.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_mode_info_init(i: *mut hbvib_mode_info, size_of_i: usize) -> hbvib_status {
    call(|| unsafe { init(i, size_of_i) })
}

/// Start of a nonlinear mode, and how the linear mode was chosen.
///
/// out  receives the description; fill it by hbvib_mode_info_init before; untouched on error.
/// Errors: HBVIB_E_UNSUPPORTED (the branch of a forced response), HBVIB_E_NULL,
/// HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_mode_info(
    branch: *const hbvib_branch,
    out: *mut hbvib_mode_info,
) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        let Some(info) = kept.branch.mode() else {
            return no_mode();
        };
        unsafe { check_out(out, 2) }?;
        let multiple = match info.multiple {
            Multiple::Single => hbvib_mode_multiple::HBVIB_MODE_SINGLE,
            Multiple::TravellingWave => hbvib_mode_multiple::HBVIB_MODE_TRAVELLING_WAVE,
            Multiple::Projected => hbvib_mode_multiple::HBVIB_MODE_PROJECTED,
            Multiple::First => hbvib_mode_multiple::HBVIB_MODE_FIRST,
        };
        let value = hbvib_mode_info {
            multiple: multiple as i32,
            mode_index: info.index as i64,
            multiplicity: info.multiplicity as i64,
            reference_dof: info.reference_dof as i64,
            engine_order: info.engine_order,
            amplitude_contact: match info.amplitude {
                Amplitude::Modal => -1,
                Amplitude::Contact(id) => id as i64,
            },
            omega: info.omega,
            linear_up_to: info.linear_up_to,
            slip_from: info.slip_from,
            lift_off_from: info.lift_off_from,
            ..hbvib_mode_info::defaults()
        };
        unsafe { fill_out(out, value) };
        Ok(Status::Ok)
    })
}

fn no_mode<T>() -> Result<T> {
    fail!(Unsupported, "a forced response has no mode; call hbvib_nonlinear_mode").with_argument(1)
}
