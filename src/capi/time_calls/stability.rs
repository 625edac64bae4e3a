//! Section "Stability" of the header: Floquet multipliers of stored points.

#![allow(non_camel_case_types)]

use crate::at_a_point;
use crate::capi::crossing::arrays::{Range, count, disjoint, output};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::indices::number;
use crate::capi::crossing::stored_point::StoredPoint;
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, fill_out, init, load};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_hooks};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::contact::forms::time_piece::Grazing;
use crate::error::{Result, fail};
use crate::options::{FloquetOptions, Waves};
use crate::results::MultiplierClass;
use num_complex::Complex64;

/// Perturbations whose multipliers are computed.
#[repr(C)]
pub enum hbvib_waves {
    /// The block of perturbations that contains the wave itself.
    HBVIB_WAVES_WAVE = 0,
    /// All perturbations of the wheel.
    HBVIB_WAVES_WHEEL = 1,
}

/// Reasons of multipliers.
#[repr(C)]
pub enum hbvib_multiplier_class {
    /// Decides about stability.
    HBVIB_MULTIPLIER_ORDINARY = 0,
    /// Zero: a slider that slips forgets its place.
    HBVIB_MULTIPLIER_MEMORY = 1,
    /// One: the slider of a contact that always sticks stays where it is put.
    HBVIB_MULTIPLIER_NEUTRAL_STUCK = 2,
    /// One: a rigid motion takes all sliders along.
    HBVIB_MULTIPLIER_NEUTRAL_RIGID = 3,
    /// One: a motion that no force drives may begin at any time.
    HBVIB_MULTIPLIER_TRIVIAL = 4,
}

/// Events that a motion touches without passing them.
#[repr(C)]
pub enum hbvib_grazing {
    /// None.
    HBVIB_GRAZING_NONE = 0,
    /// The force of friction touches its limit.
    HBVIB_GRAZING_SLIP_LIMIT = 1,
    /// The contact closes without normal speed.
    HBVIB_GRAZING_LANDING = 2,
}

/// Options of hbvib_floquet. Fill it by hbvib_floquet_options_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_floquet_options {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// HBVIB_WAVES_WAVE or HBVIB_WAVES_WHEEL, which have the same effect on a plain structure.
    pub waves: i32,
    /// 1: move the point to the periodic motion in time by shooting first; 0: take it as it is.
    pub refine: i32,
    /// Modes of each nodal diameter, with contacts stuck, on which a large structure is computed, and
    /// with half as many once more; 0: on all degrees of freedom; -1: on all unless that counts more
    /// than 1e11 operations, then on as many modes as agreement needs.
    pub modes: i32,
    /// As in hbvib_time_options.
    pub tolerance: f64,
    /// Cap on the periods that shooting integrates. With refine = 0 it has no effect, as tolerance.
    pub max_periods: i64,
}

unsafe impl VersionedStruct for hbvib_floquet_options {
    const NAME: &'static str = "hbvib_floquet_options";
    const FIRST_SIZE: usize = 32;

    fn defaults() -> Self {
        let defaults = FloquetOptions::default();
        Self {
            struct_size: 0,
            waves: hbvib_waves::HBVIB_WAVES_WAVE as i32,
            refine: i32::from(defaults.refine),
            modes: -1,
            tolerance: defaults.tolerance,
            max_periods: defaults.max_periods as i64,
        }
    }
}

/// Fills the options of Floquet multipliers with their defaults: those of the wave, refine = 1,
/// tolerance = 1e-11, modes = -1.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_floquet_options_init(o: *mut hbvib_floquet_options, size_of_o: usize) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// Numbers of the stability of a point. Fill it by hbvib_floquet_info_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_floquet_info {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// Event that the motion touches, HBVIB_GRAZING_NONE and so on. Derivatives then differ on its
    /// two sides: ordinary multipliers and radius are NaN.
    pub grazing: i32,
    /// Angular frequency of the motion: that of the point, unless no force drives it.
    pub omega: f64,
    /// Largest modulus of the ordinary multipliers; the motion is unstable if it is above 1.
    pub radius: f64,
    /// Number of multipliers.
    pub count: i64,
    /// Number of ordinary multipliers outside the unit circle.
    pub unstable: i64,
    /// Number of multipliers that are 1 by construction, a trivial one not among them.
    pub neutral: i64,
    /// Contact that touches the event; -1: none.
    pub grazing_contact: i64,
    /// Distance of the motion in time from that of the point, relative to it; 0 with refine = 0.
    pub orbit_change: f64,
    /// Largest change over a period of the motion in time, relative to its largest displacement and
    /// velocity; NaN with refine = 0.
    pub residual: f64,
    /// Modes of each nodal diameter on which the motion was computed; 0: on all degrees of freedom.
    pub modes: i64,
    /// Largest change of a multiplier above half the radius from half as many modes; NaN where
    /// orbit_change is above 0.2.
    pub modes_change: f64,
    /// Estimate of the error of the radius that the other modes make, from the changes of those
    /// multipliers that reach as far from zero; 0 on all degrees of freedom, NaN as modes_change.
    pub radius_error: f64,
}

unsafe impl VersionedStruct for hbvib_floquet_info {
    const NAME: &'static str = "hbvib_floquet_info";
    const FIRST_SIZE: usize = 72;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            grazing: hbvib_grazing::HBVIB_GRAZING_NONE as i32,
            omega: 0.0,
            radius: 0.0,
            count: 0,
            unstable: 0,
            neutral: 0,
            grazing_contact: -1,
            orbit_change: 0.0,
            residual: 0.0,
            modes: 0,
            modes_change: 0.0,
            radius_error: 0.0,
        }
    }
}

/// Fills the numbers of a stability with zeros, grazing_contact with -1.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_floquet_info_init(i: *mut hbvib_floquet_info, size_of_i: usize) -> hbvib_status {
    call(|| unsafe { init(i, size_of_i) })
}

/// Computes the Floquet multipliers of a stored point: the factors by which small perturbations of
/// its motion grow in one period. The equations of perturbations are integrated along the exact
/// path in time from event to event, sliders included, so that the multipliers are those of the
/// motion, not of its harmonics. The motion is unstable where an ordinary multiplier lies outside
/// the unit circle. A cyclic model has one block of perturbations that contains the wave itself,
/// and others: HBVIB_WAVES_WHEEL computes all of them. A point of a nonlinear mode must be a limit
/// cycle, damping ratio zero, and its motion is one without forces. A large structure is computed
/// on the degrees of freedom of its contacts and on modes; numbers of modes whose verdicts differ
/// are HBVIB_E_NO_CONVERGENCE.
///
/// model            the model of which the branch is a result.
/// point            number of a point of the curve, or of a peak, fold or requested solution.
/// options          NULL: the defaults.
/// hooks            progress, log and cancellation as in hbvib_time_response; NULL: none.
/// multipliers      receives the largest multipliers, complex, by falling modulus, as many as it
///                  holds; or NULL.
/// multipliers_len  complex numbers in it; 0 with NULL. Each sector of the wheel has at most 2 ndof
///                  multipliers and one per contact.
/// classes          receives the reasons of the same multipliers, numbers of
///                  hbvib_multiplier_class; or NULL.
/// classes_len      numbers in it; 0 with NULL.
/// out              receives numbers of the stability; fill it by hbvib_floquet_info_init before;
///                  or NULL.
/// HBVIB_STOPPED_BY_CALLER: there are no multipliers, and the radius is NaN.
/// Errors: HBVIB_E_INDEX (point), HBVIB_E_UNSUPPORTED (a point of a nonlinear mode that is no limit
/// cycle; a model that hbvib_time_response refuses), HBVIB_E_ARGUMENT (another model, options,
/// overlapping arrays), HBVIB_E_DIMENSION (a length), HBVIB_E_NO_CONVERGENCE (shooting did not
/// converge from the point), HBVIB_E_NO_BOUNDED_SOLUTION, HBVIB_E_CALLBACK (a force callback
/// failed), HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE, HBVIB_E_BUSY,
/// HBVIB_E_OUT_OF_MEMORY. Threads: any number on one model and branch.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_floquet(
    model: *const hbvib_model,
    branch: *const hbvib_branch,
    point: i64,
    options: *const hbvib_floquet_options,
    hooks: *const hbvib_hooks,
    multipliers: *mut f64,
    multipliers_len: i64,
    classes: *mut i64,
    classes_len: i64,
    out: *mut hbvib_floquet_info,
) -> hbvib_status {
    call(|| {
        let at = StoredPoint::read(model, branch, point)?;
        let options = unsafe { floquet_options(options) }?;
        let hooks = unsafe { load_hooks(hooks, 5) }?;
        let room = room(multipliers.is_null(), multipliers_len, 7, "multipliers_len")?;
        let class_room = self::room(classes.is_null(), classes_len, 9, "classes_len")?;
        if !out.is_null() {
            unsafe { check_out(out, 10) }?;
        }
        disjoint(
            &[],
            &[
                Range::new::<Complex64>(multipliers.cast(), room, 6, "multipliers")?,
                Range::new(classes, class_room, 8, "classes")?,
            ],
        )?;
        let found = unsafe {
            with_hooks(&hooks, |hooks| {
                at_a_point::floquet(&at.model, at.branch(), at.number, &options, hooks)
            })
        }
        .map_err(|e| at.blame(e, 3))?;
        if room > 0 {
            let values = unsafe { output::<Complex64>(multipliers.cast(), room, 6, "multipliers") }?;
            for (value, m) in values.iter_mut().zip(&found.multipliers) {
                *value = m.value;
            }
        }
        if class_room > 0 {
            let numbers = unsafe { output(classes, class_room, 8, "classes") }?;
            for (number, m) in numbers.iter_mut().zip(&found.multipliers) {
                *number = class_number(m.class);
            }
        }
        if !out.is_null() {
            let (contact, grazing) = match found.grazing {
                None => (-1, hbvib_grazing::HBVIB_GRAZING_NONE),
                Some((contact, Grazing::SlipLimit)) => (contact as i64, hbvib_grazing::HBVIB_GRAZING_SLIP_LIMIT),
                Some((contact, Grazing::Landing)) => (contact as i64, hbvib_grazing::HBVIB_GRAZING_LANDING),
            };
            let value = hbvib_floquet_info {
                grazing: grazing as i32,
                omega: found.omega,
                radius: found.radius,
                count: found.multipliers.len() as i64,
                unstable: found.unstable as i64,
                neutral: found.neutral as i64,
                grazing_contact: contact,
                orbit_change: found.orbit_change,
                residual: found.residual,
                modes: found.modes as i64,
                modes_change: found.modes_change,
                radius_error: found.radius_error,
                ..hbvib_floquet_info::defaults()
            };
            unsafe { fill_out(out, value) };
        }
        Ok(found.status)
    })
}

/// Checked capacity of an array that may be NULL.
fn room(null: bool, len: i64, argument: i32, name: &str) -> Result<usize> {
    let len = count(len, argument, name)?;
    if null && len > 0 {
        return fail!(Dimension, "{name} = {len}, needs 0 with NULL").with_argument(argument);
    }
    Ok(len)
}

fn class_number(class: MultiplierClass) -> i64 {
    use hbvib_multiplier_class as c;
    let class = match class {
        MultiplierClass::Ordinary => c::HBVIB_MULTIPLIER_ORDINARY,
        MultiplierClass::Memory => c::HBVIB_MULTIPLIER_MEMORY,
        MultiplierClass::NeutralStuck => c::HBVIB_MULTIPLIER_NEUTRAL_STUCK,
        MultiplierClass::NeutralRigid => c::HBVIB_MULTIPLIER_NEUTRAL_RIGID,
        MultiplierClass::Trivial => c::HBVIB_MULTIPLIER_TRIVIAL,
    };
    class as i64
}

unsafe fn floquet_options(p: *const hbvib_floquet_options) -> Result<FloquetOptions> {
    if p.is_null() {
        return Ok(FloquetOptions::default());
    }
    let o = unsafe { load(p, 4) }?;
    let chosen = || -> Result<FloquetOptions> {
        let options = FloquetOptions {
            waves: waves(o.waves)?,
            refine: match o.refine {
                0 => false,
                1 => true,
                other => return fail!(Argument, "refine = {other}, needs 0 or 1"),
            },
            tolerance: o.tolerance,
            max_periods: number(o.max_periods, "max_periods")?,
            modes: match o.modes {
                -1 => None,
                modes => match usize::try_from(modes) {
                    Ok(modes) => Some(modes),
                    Err(_) => return fail!(Argument, "modes = {modes}, needs -1, 0 or a number of modes"),
                },
            },
        };
        options.check()?;
        Ok(options)
    };
    chosen().with_argument(4)
}

/// The perturbations of a number.
fn waves(waves: i32) -> Result<Waves> {
    match waves {
        0 => Ok(Waves::Wave),
        1 => Ok(Waves::Wheel),
        other => fail!(
            Argument,
            "waves = {other}, needs HBVIB_WAVES_WAVE = 0 or HBVIB_WAVES_WHEEL = 1"
        ),
    }
}
