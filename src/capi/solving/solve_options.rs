//! Section "Solve" of the header: the options that every analysis shares.

#![allow(non_camel_case_types)]

use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::indices::number;
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_reserved, init, load};
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, fail};
use crate::options::{Flexibility, SolverOptions, Waves};

/// Ways to the flexibility of the structure at its contacts.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum hbvib_flexibility {
    /// A basis for large structures where it holds, factors otherwise.
    HBVIB_FLEXIBILITY_AUTOMATIC = 0,
    /// Complex LU factors of the dynamic stiffness of all degrees of freedom, at each frequency that
    /// is needed.
    HBVIB_FLEXIBILITY_DIRECT = 1,
    /// A basis of few motions per nodal diameter, from one real or Hermitian factorisation, which is
    /// kept with the model until its matrices change; hbvib_branch_reduction has its certificate.
    HBVIB_FLEXIBILITY_KRYLOV = 2,
}

/// Stability along the curve of a forced response.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum hbvib_stability {
    /// None is computed.
    HBVIB_STABILITY_NONE = 0,
    /// Perturbations of the block that contains the wave itself, as HBVIB_WAVES_WAVE.
    HBVIB_STABILITY_WAVE = 1,
    /// All perturbations of the wheel, as HBVIB_WAVES_WHEEL.
    HBVIB_STABILITY_WHEEL = 2,
}

/// Options that every analysis shares. Fill it by hbvib_solver_options_init. A model without
/// contacts is linear: a tolerance other than 0, max_harmonics, samples, step, step_min,
/// tol_residual, max_newton and estimate_error have no effect on its response.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_solver_options {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// Reserved: must be 0 or 1. A solve starts no thread.
    pub num_threads: i32,
    /// Bound of the estimated relative error (default 1e-3), from which the harmonics of each point
    /// are chosen: error of the complex fundamental of the response degree of freedom; in a
    /// nonlinear mode of the frequency and of the damping ratio, the latter relative to the largest
    /// one so far. 0: exactly `harmonics`, whatever the error.
    pub tolerance: f64,
    /// Highest harmonic number H; with a tolerance it has no effect in forced and parameter
    /// responses.
    pub harmonics: i64,
    /// Cap on H with a tolerance, at least the highest harmonic that is forced. Points that need
    /// more are stored, and the status is HBVIB_STOPPED_MAX_HARMONICS.
    pub max_harmonics: i64,
    /// 0: events of contacts are located exactly. Else samples per period, at least 2H + 1; with a
    /// tolerance at least 8H are taken. HBVIB_CUBIC, HBVIB_FRICTION_2D, HBVIB_FRICTION_3D and
    /// polynomials are exact in both cases; HBVIB_REGULARISED is always sampled, with 0 by a number
    /// that follows from H, and from the tolerance: a run that has too few samples begins again,
    /// progress included, with more.
    pub samples: i64,
    /// First arc-length step in scaled unknowns; 0 = automatic. A single frequency needs no step: the
    /// steps and max_points have no effect there.
    pub step: f64,
    /// Smallest step; 0 = automatic.
    pub step_min: f64,
    /// Largest step; 0 = automatic. Where every contact is linear, points lie at the resonances,
    /// and this is the largest share of the range between neighbours.
    pub step_max: f64,
    /// Relative residual of a converged point.
    pub tol_residual: f64,
    /// Cap on Newton iterations per point.
    pub max_newton: i64,
    /// Cap on the number of points.
    pub max_points: i64,
    /// Degree of freedom whose fundamental defines amplitude and peaks; -1: the forced one that
    /// moves most at the lower end of the range, contacts at their reference stiffness. In a
    /// nonlinear mode it defines the reported amplitude alone; -1: the phase reference.
    pub response_dof: i64,
    /// 1: carry the mean and the even harmonics also where symmetry makes them zero; 0: do not.
    pub keep_even_harmonics: i32,
    /// 1: estimate the error of every point, for HBVIB_ERROR_ESTIMATE, at the cost of a solution
    /// with more harmonics at each point; 0 (default): do so only with a tolerance.
    pub estimate_error: i32,
    /// Largest number of bytes for factors and bases of the structure, for the equations of a point,
    /// and for an estimate of its error, each by itself; 0 (default): no limit. A request beyond it
    /// is refused with HBVIB_E_OUT_OF_MEMORY before it is allocated; the message has the need and
    /// the limit. Where a tolerance chooses the harmonics, fewer are used, and an estimate that
    /// needs more is an unknown error.
    pub memory_limit: i64,
    /// Way to the flexibility of the structure at its contacts in a forced response: a value of
    /// enum hbvib_flexibility.
    pub flexibility: i32,
    /// Perturbations whose Floquet multipliers are computed at each point of the curve of a forced
    /// response, a value of enum hbvib_stability: for HBVIB_FLOQUET_RADIUS,
    /// HBVIB_UNSTABLE_DIRECTIONS and hbvib_branch_bifurcations. A nonlinear mode refuses any but
    /// HBVIB_STABILITY_NONE, the default.
    pub stability: i32,
    /// 1: the free sliders of each stored point of a forced response, as hbvib_branch_freedom has
    /// them for one point: for HBVIB_FREE_SLIDERS and HBVIB_D_AMPLITUDE_BY_PLACE. Hardly any work
    /// where nothing is free, else about that of one more Newton iteration a point. 0 (default):
    /// none. A nonlinear mode and a parameter response refuse it.
    pub freedom: i32,
    /// Must be 0.
    pub reserved: i32,
}

unsafe impl VersionedStruct for hbvib_solver_options {
    const NAME: &'static str = "hbvib_solver_options";
    const FIRST_SIZE: usize = 104;

    fn defaults() -> Self {
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
            memory_limit: 0,
            flexibility: hbvib_flexibility::HBVIB_FLEXIBILITY_AUTOMATIC as i32,
            stability: hbvib_stability::HBVIB_STABILITY_NONE as i32,
            freedom: 0,
            reserved: 0,
        }
    }
}

/// Fills solver options with their defaults: tolerance = 1e-3, from which the harmonics follow,
/// exact events, automatic steps. For a fixed number of harmonics set tolerance = 0 and harmonics.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_solver_options_init(o: *mut hbvib_solver_options, size_of_o: usize) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// Checked harmonics and samples, given as the arguments of these numbers.
pub(crate) fn harmonics_and_samples(harmonics: i64, samples: i64, arguments: (i32, i32)) -> Result<(usize, usize)> {
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
    let harmonics = number(harmonics, "harmonics").with_argument(arguments.0)?;
    plain(harmonics, 0).with_argument(arguments.0)?;
    let samples = number(samples, "samples").with_argument(arguments.1)?;
    plain(harmonics, samples).with_argument(arguments.1)?;
    Ok((harmonics, samples))
}

/// Checked solver options for a model of `ndof` degrees of freedom; NULL is the defaults.
pub(crate) unsafe fn solver_options(p: *const hbvib_solver_options, ndof: usize) -> Result<SolverOptions> {
    if p.is_null() {
        return Ok(SolverOptions::default());
    }
    let o = unsafe { load(p, 2) }?;
    convert(&o, ndof).with_argument(2)
}

fn flexibility(value: i32) -> Result<Flexibility> {
    use hbvib_flexibility as ways;
    for (way, found) in [
        (ways::HBVIB_FLEXIBILITY_AUTOMATIC, Flexibility::Automatic),
        (ways::HBVIB_FLEXIBILITY_DIRECT, Flexibility::Direct),
        (ways::HBVIB_FLEXIBILITY_KRYLOV, Flexibility::Krylov),
    ] {
        if value == way as i32 {
            return Ok(found);
        }
    }
    fail!(
        Argument,
        "flexibility = {value}, needs a value of enum hbvib_flexibility"
    )
}

fn stability(value: i32) -> Result<Option<Waves>> {
    use hbvib_stability as kinds;
    for (kind, found) in [
        (kinds::HBVIB_STABILITY_NONE, None),
        (kinds::HBVIB_STABILITY_WAVE, Some(Waves::Wave)),
        (kinds::HBVIB_STABILITY_WHEEL, Some(Waves::Wheel)),
    ] {
        if value == kind as i32 {
            return Ok(found);
        }
    }
    fail!(Argument, "stability = {value}, needs a value of enum hbvib_stability")
}

fn convert(o: &hbvib_solver_options, ndof: usize) -> Result<SolverOptions> {
    if !matches!(o.num_threads, 0 | 1) {
        return fail!(Argument, "num_threads = {}, needs 0 or 1 (reserved)", o.num_threads);
    }
    check_reserved(o.reserved, 2, "hbvib_solver_options")?;
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
        refinement: 1,
        step: o.step,
        step_min: o.step_min,
        step_max: o.step_max,
        tol_residual: o.tol_residual,
        max_newton: number(o.max_newton, "max_newton")?,
        max_points: number(o.max_points, "max_points")?,
        response_dof,
        keep_even_harmonics: flag(o.keep_even_harmonics, "keep_even_harmonics")?,
        estimate_error: flag(o.estimate_error, "estimate_error")?,
        flexibility: flexibility(o.flexibility)?,
        certificate: SolverOptions::default().certificate,
        memory_limit: number(o.memory_limit, "memory_limit")?,
        stability: stability(o.stability)?,
        freedom: flag(o.freedom, "freedom")?,
        exchange: SolverOptions::default().exchange,
        content: SolverOptions::default().content,
    };
    options.check()?;
    Ok(options)
}
