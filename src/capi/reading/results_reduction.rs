//! Section "Results" of the header: the size of the problem that was solved.

#![allow(non_camel_case_types)]

use crate::capi::crossing::boundary::call;
use crate::capi::crossing::handles::{KeptBranch, read};
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, fill_out, init};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::Status;

/// Ways to the flexibility of the contacts along a branch, told by hbvib_branch_reduction with the
/// reason.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum hbvib_flexibility_way {
    /// Factors: at a single frequency they take the least time.
    HBVIB_FLEXIBILITY_WAY_SINGLE_FREQUENCY = 0,
    /// A sum over all modes of each wave.
    HBVIB_FLEXIBILITY_WAY_MODES = 1,
    /// A sum over all poles of each wave: damping couples the modes.
    HBVIB_FLEXIBILITY_WAY_POLES = 2,
    /// Factors at each frequency: modes lose the motion of a near-rigid contact.
    HBVIB_FLEXIBILITY_WAY_NEAR_RIGID = 3,
    /// Factors: damping couples the modes, and few degrees of freedom are factored as quickly.
    HBVIB_FLEXIBILITY_WAY_FEW = 4,
    /// Factors: damping couples the modes, and sparse matrices are factored as quickly.
    HBVIB_FLEXIBILITY_WAY_SPARSE = 5,
    /// Factors: there are too many degrees of freedom for all modes or poles.
    HBVIB_FLEXIBILITY_WAY_MANY = 6,
    /// Factors: the reference stiffness is not definite, or poles are badly conditioned; in a
    /// nonlinear mode also where damping couples the modes.
    HBVIB_FLEXIBILITY_WAY_UNSUITABLE = 7,
    /// Factors: sums did not agree with them at an end of the range.
    HBVIB_FLEXIBILITY_WAY_DISAGREEMENT = 8,
    /// Factors of the waves of a tuned wheel at each frequency, and a correction of low rank for the
    /// differences of its sectors.
    HBVIB_FLEXIBILITY_WAY_TUNED_WHEEL = 9,
}

/// Size of the problem that was solved, and the parts that were removed from it before. Fill it by
/// hbvib_reduction_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_reduction {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 0.
    pub reserved: i32,
    /// Sectors of the wheel; all but one are removed.
    pub sectors: i64,
    /// Degrees of freedom of one sector.
    pub degrees_of_freedom: i64,
    /// Relative contact coordinates that remain of them.
    pub coordinates: i64,
    /// Contacts in the model.
    pub contacts: i64,
    /// Contacts that became linear springs (infinite slip limit, no cubic term).
    pub never_slipping: i64,
    /// Contacts without force (no stiffness, or no slip limit).
    pub inert: i64,
    /// Highest harmonic number H of the results: the requested one or, with a tolerance, the
    /// highest one that a point carries.
    pub harmonics_asked: i64,
    /// Number of harmonics carried, the largest of all points.
    pub harmonics_carried: i64,
    /// Real unknowns of the nonlinear problem, the largest number of all points.
    pub unknowns: i64,
    /// Degree of freedom whose amplitude was followed.
    pub response_dof: i64,
    /// 1 if the mean is carried, else 0.
    pub mean_carried: i32,
    /// 1 if even harmonics were left out because law and forcing are odd, else 0.
    pub even_removed: i32,
    /// Rigid-body modes of the mean motion that contacts alone hold; 0 where the mean is not
    /// carried.
    pub held_by_contacts: i64,
    /// Coordinates of each harmonic to which the structure was reduced, the largest number of all
    /// points; 0 where all its degrees of freedom were kept.
    pub basis: i64,
    /// Estimated relative error of the motion of the structure on its basis, under unit forces at
    /// the contacts, the excitation and the response over the frequencies of the call, the largest
    /// of all points; 0 without a basis.
    pub certificate: f64,
    /// Harmonic whose amplitude is that of the response: the lowest one in which a vibrating force
    /// acts that is at least a thousandth of the largest; of a nonlinear mode 1.
    pub response_harmonic: i64,
    /// 1: the first point was found from the given guess. 0: there was a guess, and no solution was
    /// found from it; another way found the first point. -1: no guess was given.
    pub guess_used: i32,
    /// How the flexibility of the contacts is made along the branch, and why so: see
    /// hbvib_flexibility_way.
    pub flexibility_way: i32,
}

unsafe impl VersionedStruct for hbvib_reduction {
    const NAME: &'static str = "hbvib_reduction";
    const FIRST_SIZE: usize = 96;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            reserved: 0,
            sectors: 0,
            degrees_of_freedom: 0,
            coordinates: 0,
            contacts: 0,
            never_slipping: 0,
            inert: 0,
            harmonics_asked: 0,
            harmonics_carried: 0,
            unknowns: 0,
            response_dof: 0,
            mean_carried: 0,
            even_removed: 0,
            held_by_contacts: 0,
            basis: 0,
            certificate: 0.0,
            response_harmonic: 0,
            guess_used: -1,
            flexibility_way: 0,
        }
    }
}

/// Fills a reduction with zeros.
///
/// r          the struct; untouched on error.
/// size_of_r  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_reduction_init(r: *mut hbvib_reduction, size_of_r: usize) -> hbvib_status {
    call(|| unsafe { init(r, size_of_r) })
}

/// Size of the problem that was solved, the parts that were removed from it, and the degree of
/// freedom that was followed.
///
/// out  receives the numbers; fill it by hbvib_reduction_init before; untouched on error.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_reduction(
    branch: *const hbvib_branch,
    out: *mut hbvib_reduction,
) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        unsafe { check_out(out, 2) }?;
        let r = kept.branch.reduction();
        let value = hbvib_reduction {
            sectors: r.sectors as i64,
            degrees_of_freedom: r.degrees_of_freedom as i64,
            coordinates: r.coordinates as i64,
            contacts: r.contacts as i64,
            never_slipping: r.never_slipping as i64,
            inert: r.inert as i64,
            harmonics_asked: r.harmonics_asked as i64,
            harmonics_carried: r.harmonics_carried as i64,
            unknowns: r.unknowns as i64,
            response_dof: kept.branch.response_dof() as i64,
            mean_carried: i32::from(r.mean_carried),
            even_removed: i32::from(r.even_removed),
            held_by_contacts: r.held_by_contacts as i64,
            basis: r.basis as i64,
            certificate: r.certificate,
            response_harmonic: r.response_harmonic as i64,
            guess_used: r.guess_used.map_or(-1, i32::from),
            flexibility_way: r.flexibility_way as i32,
            ..hbvib_reduction::defaults()
        };
        unsafe { fill_out(out, value) };
        Ok(Status::Ok)
    })
}
