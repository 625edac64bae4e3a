//! Section "Results" of the header: energies and losses of a point.

#![allow(non_camel_case_types)]

use crate::capi::crossing::boundary::call;
use crate::capi::crossing::handles::{KeptBranch, read};
use crate::capi::crossing::indices::index;
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, fill_out, init};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_interrupt};
use crate::capi::version_and_errors::hbvib_status;
use crate::error::Status;

/// Energies and losses of one point, in the units of the caller. Fill it by hbvib_energy_init. In a
/// plain model the sector is the whole structure. Kinetic energy is v'Mv/2. Potential energy is
/// x'Kx/2 of the linear structure, with springs and contacts that never slip (infinite limit);
/// contacts that may slip are left out. The energy of a coupling is shared evenly by its two
/// sectors.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_energy {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 0.
    pub reserved: i32,
    /// Sum over h > 0 of (h omega)^2 X_h^H M_h X_h / 2 of a sector: twice its mean kinetic energy.
    pub twice_mean_kinetic: f64,
    /// Kinetic energy of a sector, mean over the period.
    pub kinetic_mean: f64,
    /// Kinetic energy of a sector, largest over the period.
    pub kinetic_peak: f64,
    /// Potential energy of a sector, mean over the period.
    pub potential_mean: f64,
    /// Potential energy of a sector, largest over the period.
    pub potential_peak: f64,
    /// Kinetic energy of the wheel, mean over the period.
    pub wheel_kinetic_mean: f64,
    /// Kinetic energy of the wheel, largest over the period.
    pub wheel_kinetic_peak: f64,
    /// Potential energy of the wheel, mean over the period.
    pub wheel_potential_mean: f64,
    /// Potential energy of the wheel, largest over the period.
    pub wheel_potential_peak: f64,
    /// Work per cycle and sector that damping, and stiffness without symmetry, take from the
    /// motion.
    pub structural_loss: f64,
    /// Work per cycle and sector of the contacts that may slip. In a forced response both losses
    /// together are the work of the forces.
    pub friction_loss: f64,
}

unsafe impl VersionedStruct for hbvib_energy {
    const NAME: &'static str = "hbvib_energy";
    const FIRST_SIZE: usize = 96;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            reserved: 0,
            twice_mean_kinetic: 0.0,
            kinetic_mean: 0.0,
            kinetic_peak: 0.0,
            potential_mean: 0.0,
            potential_peak: 0.0,
            wheel_kinetic_mean: 0.0,
            wheel_kinetic_peak: 0.0,
            wheel_potential_mean: 0.0,
            wheel_potential_peak: 0.0,
            structural_loss: 0.0,
            friction_loss: 0.0,
        }
    }
}

/// Fills an energy with zeros.
///
/// e          the struct; untouched on error.
/// size_of_e  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_energy_init(e: *mut hbvib_energy, size_of_e: usize) -> hbvib_status {
    call(|| unsafe { init(e, size_of_e) })
}

/// Energies and losses of a stored point.
///
/// point  number of a point of the curve, or of a peak, fold or requested solution.
/// out    receives the numbers; fill it by hbvib_energy_init before; untouched on error.
/// Errors: HBVIB_E_INDEX (point), HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE,
/// HBVIB_E_OUT_OF_MEMORY. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_energy(
    branch: *const hbvib_branch,
    point: i64,
    out: *mut hbvib_energy,
) -> hbvib_status {
    unsafe { hbvib_branch_energy_with_hooks(branch, point, out, core::ptr::null()) }
}

/// The same as hbvib_branch_energy; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and out is untouched.
///
/// point  number of a point of the curve, or of a peak, fold or requested solution.
/// out    receives the numbers; fill it by hbvib_energy_init before; untouched on error.
/// hooks  phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_branch_energy.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_energy_with_hooks(
    branch: *const hbvib_branch,
    point: i64,
    out: *mut hbvib_energy,
    hooks: *const hbvib_hooks,
) -> hbvib_status {
    call(|| {
        let hooks = unsafe { load_hooks(hooks, 4) }?;
        let kept = read::<KeptBranch>(branch, 1)?;
        let point = index(point, kept.branch.stored(), 2, "point")?;
        unsafe { check_out(out, 3) }?;
        let e = unsafe { with_interrupt(&hooks, |interrupt| kept.branch.energy_at_with(point, interrupt)) }?;
        let value = hbvib_energy {
            twice_mean_kinetic: e.twice_mean_kinetic,
            kinetic_mean: e.kinetic_mean,
            kinetic_peak: e.kinetic_peak,
            potential_mean: e.potential_mean,
            potential_peak: e.potential_peak,
            wheel_kinetic_mean: e.wheel_kinetic_mean,
            wheel_kinetic_peak: e.wheel_kinetic_peak,
            wheel_potential_mean: e.wheel_potential_mean,
            wheel_potential_peak: e.wheel_potential_peak,
            structural_loss: e.structural_loss,
            friction_loss: e.friction_loss,
            ..hbvib_energy::defaults()
        };
        unsafe { fill_out(out, value) };
        Ok(Status::Ok)
    })
}
