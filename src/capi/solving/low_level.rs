//! Section "Low level" of the header: a contact law and the residual at given motions, and indices that
//! count from 1.

use crate::at_a_point;
use crate::capi::contact_calls::contacts::{hbvib_contact, law};
use crate::capi::crossing::arrays::{Range, check_pointer, disjoint, exact_len, input, output};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::read;
use crate::capi::crossing::versioned_struct::load;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_interrupt};
use crate::capi::solving::solve_options::{harmonics_and_samples, hbvib_solver_options, solver_options};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::contact::ContactKind;
use crate::contact::forms::constants::Constant;
use crate::error::{Error, Result, Status, fail};
use crate::model::Model;
use core::ffi::{c_char, c_uchar};
use num_complex::Complex64;

/// Force of one contact law on prescribed relative motions y(t) = Re sum Y_h exp(i h omega t),
/// once it has become periodic, and its Jacobian. Degrees of freedom, sector_offset and directions
/// in the description are ignored. The law has d motions, side a minus side b: t1 and n of
/// HBVIB_FRICTION_2D, d = 2; t1, t2 and n of HBVIB_FRICTION_3D, d = 3, but t1 and t2 under a
/// constant load (kn = 0), d = 2; n of HBVIB_UNILATERAL and t1 of the others, d = 1. The force
/// along n is -N.
///
/// c           the law and its constants.
/// harmonics   highest harmonic number H, 0 .. 100000.
/// samples     0: events are located exactly where the law has them; else samples per period, at
///             least 2H + 1. HBVIB_CUBIC, HBVIB_FRICTION_2D and HBVIB_FRICTION_3D are exact in both
///             cases; HBVIB_REGULARISED is always sampled, with 0 by a number that follows from H.
/// omega       angular frequency, >= 0; has an effect on laws that depend on velocities.
/// motion      d (H + 1) complex numbers, Y_0 .. Y_H of one motion after the other; the imaginary
///             part of Y_0 has no effect.
/// motion_len  complex numbers in it, d (H + 1).
/// force       receives d (H + 1) complex numbers, F_0 .. F_H of one direction after the other.
/// force_len   complex numbers in it, d (H + 1).
/// jac         receives d F / d Y over the pairs (re, im), real, column-major of order 2 d (H + 1);
///             or NULL.
/// jac_len     doubles in it, (2 d (H + 1))^2; 0 with NULL.
/// Memory with jac: at most 8 (1 + d) (2 d (H + 1))^2 bytes, 250 bytes for each of the samples or
/// of 128 (H + 1), whichever are more, and 1 MiB, with d > 1 another 2 MiB (H + 1) or
/// 256 MiB + 64 KiB (H + 1), whichever are fewer. Without jac no Jacobian is formed:
/// 2.5 KiB d (H + 1), 250 bytes for each of the samples, of which HBVIB_REGULARISED takes
/// 128 (H + 1) by itself, and 1 MiB, for HBVIB_FRICTION_3D another term as above. Where the latter
/// is more than 500 MiB, or the former more than 16 GiB, nothing is requested, and the error is
/// HBVIB_E_OUT_OF_MEMORY.
/// Errors: HBVIB_E_ARGUMENT (kind, constants, harmonics, samples, omega, overlapping arrays),
/// HBVIB_E_DIMENSION (lengths), HBVIB_E_NOT_FINITE, HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL,
/// HBVIB_E_OUT_OF_MEMORY. Threads: any.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_contact_evaluate(
    c: *const hbvib_contact,
    harmonics: i64,
    samples: i64,
    omega: f64,
    motion: *const f64,
    motion_len: i64,
    force: *mut f64,
    force_len: i64,
    jac: *mut f64,
    jac_len: i64,
) -> hbvib_status {
    unsafe {
        hbvib_contact_evaluate_with_hooks(
            c,
            harmonics,
            samples,
            omega,
            motion,
            motion_len,
            force,
            force_len,
            jac,
            jac_len,
            core::ptr::null(),
        )
    }
}

/// The same as hbvib_contact_evaluate; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and what it writes is untouched.
///
/// c           the law and its constants.
/// harmonics   highest harmonic number H, 0 .. 100000.
/// samples     0: events are located exactly where the law has them; else samples per period, at
///             least 2H + 1. HBVIB_CUBIC, HBVIB_FRICTION_2D and HBVIB_FRICTION_3D are exact in both
///             cases; HBVIB_REGULARISED is always sampled, with 0 by a number that follows from H.
/// omega       angular frequency, >= 0; has an effect on laws that depend on velocities.
/// motion      d (H + 1) complex numbers, Y_0 .. Y_H of one motion after the other; the imaginary
///             part of Y_0 has no effect.
/// motion_len  complex numbers in it, d (H + 1).
/// force       receives d (H + 1) complex numbers, F_0 .. F_H of one direction after the other.
/// force_len   complex numbers in it, d (H + 1).
/// jac         receives d F / d Y over the pairs (re, im), real, column-major of order 2 d (H + 1);
///             or NULL.
/// jac_len     doubles in it, (2 d (H + 1))^2; 0 with NULL.
/// hooks       phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_contact_evaluate.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_contact_evaluate_with_hooks(
    c: *const hbvib_contact,
    harmonics: i64,
    samples: i64,
    omega: f64,
    motion: *const f64,
    motion_len: i64,
    force: *mut f64,
    force_len: i64,
    jac: *mut f64,
    jac_len: i64,
    hooks: *const hbvib_hooks,
) -> hbvib_status {
    call(|| {
        let hooks = unsafe { load_hooks(hooks, 11) }?;
        let mut contact = law(&unsafe { load(c, 1) }?).with_argument(1)?;
        if matches!(contact.kind, ContactKind::Friction3d(_)) && contact.constant(Constant::Kn) != 0.0 {
            // A degree of freedom along n declares that the load varies.
            contact.dof_a[2] = Some(0);
        }
        contact.check_constants().with_argument(1)?;
        let (harmonics, samples) = harmonics_and_samples(harmonics, samples, (2, 3))?;
        if !omega.is_finite() || omega < 0.0 {
            return fail!(Argument, "omega = {omega}, needs a finite angular frequency >= 0").with_argument(4);
        }
        let needed = (harmonics + 1) * contact.directions();
        let motion_len = exact_len(motion_len, needed, 6, "motion_len = d (harmonics + 1)")?;
        let force_len = exact_len(force_len, needed, 8, "force_len = d (harmonics + 1)")?;
        let jac_len = if jac.is_null() && jac_len == 0 {
            0
        } else {
            exact_len(
                jac_len,
                (2 * needed).saturating_mul(2 * needed),
                10,
                "jac_len = (2 d (harmonics + 1))^2",
            )?
        };
        check_pointer(motion, 5, "motion")?;
        check_pointer(force, 7, "force")?;
        disjoint(
            &[Range::new(motion, 2 * motion_len, 5, "motion")?],
            &[
                Range::new(force, 2 * force_len, 7, "force")?,
                Range::new(jac, jac_len, 9, "jac")?,
            ],
        )?;
        let motion = unsafe { input(motion.cast(), motion_len, 5, "motion") }?;
        let force = unsafe { output(force.cast(), force_len, 7, "force") }?;
        let jac = match jac_len {
            0 => None,
            len => Some(unsafe { output(jac, len, 9, "jac") }?),
        };
        let at = (harmonics, samples, omega);
        let evaluated = unsafe {
            with_interrupt(&hooks, |interrupt| {
                at_a_point::contact_evaluate_with(&contact, at, motion, force, jac, interrupt)
            })
        };
        evaluated.with_argument(5)?;
        Ok(Status::Ok)
    })
}

/// Residual R_h = (K - h^2 omega^2 M + i h omega C) X_h + f_h - F_h of harmonic balance at a motion
/// of the caller, for continuation methods of the caller and for tests. Nothing is removed:
/// harmonics 0 .. H of all degrees of freedom, harmonic after harmonic.
///
/// solver       options, of which harmonics, samples and memory_limit are used; NULL: the defaults.
/// omega        angular frequency, >= 0.
/// x            (H + 1) x ndof complex numbers; the imaginary part of the mean is no unknown.
/// x_len        complex numbers in it.
/// r            receives as many complex numbers; the imaginary part of the rows of the mean is
///              that of x.
/// r_len        complex numbers in it.
/// jac          receives d R / d X over the pairs (re, im), real, column-major of order
///              2 (H + 1) ndof; or NULL.
/// jac_len      doubles in it; 0 with NULL.
/// d_omega      receives d R / d omega, complex like r; or NULL.
/// d_omega_len  complex numbers in it; 0 with NULL.
/// Memory: that of hbvib_contact_evaluate for each contact, and 96 (H + 1) bytes for each entry of
/// the matrices; a memory_limit below that is refused with HBVIB_E_OUT_OF_MEMORY.
/// Errors: HBVIB_E_DIMENSION (a length, with the one needed), HBVIB_E_NOT_FINITE,
/// HBVIB_E_ARGUMENT (options, omega, overlapping arrays, a force beyond the harmonics),
/// HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY.
/// Threads: any number on one model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_forced_residual(
    model: *const hbvib_model,
    solver: *const hbvib_solver_options,
    omega: f64,
    x: *const f64,
    x_len: i64,
    r: *mut f64,
    r_len: i64,
    jac: *mut f64,
    jac_len: i64,
    d_omega: *mut f64,
    d_omega_len: i64,
) -> hbvib_status {
    unsafe {
        hbvib_forced_residual_with_hooks(
            model,
            solver,
            omega,
            x,
            x_len,
            r,
            r_len,
            jac,
            jac_len,
            d_omega,
            d_omega_len,
            core::ptr::null(),
        )
    }
}

/// The same as hbvib_forced_residual; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and the arrays are untouched or hold NaN.
///
/// solver       options, of which harmonics, samples and memory_limit are used; NULL: the defaults.
/// omega        angular frequency, >= 0.
/// x            (H + 1) x ndof complex numbers; the imaginary part of the mean is no unknown.
/// x_len        complex numbers in it.
/// r            receives as many complex numbers; the imaginary part of the rows of the mean is
///              that of x.
/// r_len        complex numbers in it.
/// jac          receives d R / d X over the pairs (re, im), real, column-major of order
///              2 (H + 1) ndof; or NULL.
/// jac_len      doubles in it; 0 with NULL.
/// d_omega      receives d R / d omega, complex like r; or NULL.
/// d_omega_len  complex numbers in it; 0 with NULL.
/// hooks        phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_forced_residual.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_forced_residual_with_hooks(
    model: *const hbvib_model,
    solver: *const hbvib_solver_options,
    omega: f64,
    x: *const f64,
    x_len: i64,
    r: *mut f64,
    r_len: i64,
    jac: *mut f64,
    jac_len: i64,
    d_omega: *mut f64,
    d_omega_len: i64,
    hooks: *const hbvib_hooks,
) -> hbvib_status {
    const COMPLEX: &str = "(harmonics + 1) * ndof";
    call(|| {
        let hooks = unsafe { load_hooks(hooks, 12) }?;
        let model = read::<Model>(model, 1)?;
        let solver = unsafe { solver_options(solver, model.ndof()) }?;
        if !omega.is_finite() {
            return fail!(NotFinite, "omega = {omega}, needs a finite angular frequency >= 0").with_argument(3);
        }
        if omega < 0.0 {
            return fail!(Argument, "omega = {omega}, needs an angular frequency >= 0").with_argument(3);
        }
        let needed = (solver.harmonics + 1).saturating_mul(model.ndof());
        let order = needed.saturating_mul(2);
        check_pointer(x, 4, "x")?;
        check_pointer(r, 6, "r")?;
        let x_len = exact_len(x_len, needed, 5, COMPLEX)?;
        let r_len = exact_len(r_len, needed, 7, COMPLEX)?;
        let jac_len = if jac.is_null() && jac_len == 0 {
            0
        } else {
            check_pointer(jac, 8, "jac")?;
            exact_len(
                jac_len,
                order.saturating_mul(order),
                9,
                "(2 * (harmonics + 1) * ndof)^2",
            )?
        };
        let d_omega_len = if d_omega.is_null() && d_omega_len == 0 {
            0
        } else {
            check_pointer(d_omega, 10, "d_omega")?;
            exact_len(d_omega_len, needed, 11, COMPLEX)?
        };
        // Arguments count complex numbers, memory holds doubles.
        disjoint(
            &[Range::new::<Complex64>(x.cast(), x_len, 4, "x")?],
            &[
                Range::new::<Complex64>(r.cast(), r_len, 6, "r")?,
                Range::new(jac, jac_len, 8, "jac")?,
                Range::new::<Complex64>(d_omega.cast(), d_omega_len, 10, "d_omega")?,
            ],
        )?;
        let x = unsafe { input::<Complex64>(x.cast(), x_len, 4, "x") }?;
        let r = unsafe { output::<Complex64>(r.cast(), r_len, 6, "r") }?;
        let jac = match jac_len {
            0 => None,
            len => Some(unsafe { output(jac, len, 8, "jac") }?),
        };
        let d_omega = match d_omega_len {
            0 => None,
            len => Some(unsafe { output::<Complex64>(d_omega.cast(), len, 10, "d_omega") }?),
        };
        if let Some(i) = x.iter().position(|z| !z.is_finite()) {
            return fail!(NotFinite, "x[{i}] is not finite").with_argument(4);
        }
        unsafe {
            with_interrupt(&hooks, |interrupt| {
                at_a_point::forced_residual_with(&model, &solver, omega, x, (r, jac, d_omega), interrupt)
            })
        }?;
        Ok(Status::Ok)
    })
}

/// Turns an index of a language that counts from 1 into one that counts from 0, and refuses an
/// index outside with a sentence in numbers from 1: "dof = 0, needs 1 .. 4".
///
/// name       name of the index, ends with NUL; of more than 40 bytes the first 40 are used.
///            NULL: "index".
/// index      1 .. count.
/// count      number of valid indices, >= 0.
/// from_zero  receives index - 1; untouched on error.
/// Errors: HBVIB_E_INDEX, HBVIB_E_DIMENSION (count), HBVIB_E_NULL. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_index_from_one(
    name: *const c_char,
    index: i64,
    count: i64,
    from_zero: *mut i64,
) -> hbvib_status {
    call(|| {
        let mut bytes = [0; 40];
        let name = unsafe { short_text(name.cast(), &mut bytes) }.unwrap_or("index");
        check_pointer(from_zero, 4, "from_zero")?;
        let shifted = shift(name, index, count)?;
        unsafe { from_zero.write(shifted) };
        Ok(Status::Ok)
    })
}

fn shift(name: &str, index: i64, count: i64) -> Result<i64> {
    let error = match count {
        ..0 => {
            let error = Error::new(Status::Dimension, format_args!("count = {count}, needs at least 0"));
            return Err(error).with_argument(3);
        }
        0 => Error::new(Status::Index, format_args!("{name} = {index}, but there is none")),
        _ if (1..=count).contains(&index) => return Ok(index - 1),
        _ => Error::new(Status::Index, format_args!("{name} = {index}, needs 1 .. {count}")),
    };
    Err(error).with_argument(2)
}

/// The first bytes of a text of the caller, as far as they are UTF-8 and fit; none of NULL.
unsafe fn short_text(text: *const c_uchar, buffer: &mut [u8]) -> Option<&str> {
    if text.is_null() {
        return None;
    }
    let mut len = 0;
    while len < buffer.len() {
        let byte = unsafe { text.add(len).read() };
        if byte == 0 {
            break;
        }
        buffer[len] = byte;
        len += 1;
    }
    let whole = match core::str::from_utf8(&buffer[..len]) {
        Ok(_) => len,
        Err(error) => error.valid_up_to(),
    };
    core::str::from_utf8(&buffer[..whole]).ok()
}
