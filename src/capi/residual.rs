//! The residual at a point of the caller's, for hosts with a continuation of their own.

use super::boundary::{Blame, Range, call, check_pointer, disjoint, input, output};
use super::contact::exact_len;
use super::handles::read;
use super::solve::solver_options;
use super::types::{hbvib_model, hbvib_solver_options, hbvib_status};
use crate::analysis;
use crate::error::{Status, fail};
use crate::model::Model;
use num_complex::Complex64;

/// Residual R_h = (K - h^2 omega^2 M + i h omega C) X_h + f_h - F_h of harmonic balance at a point
/// of the caller, for hosts with a continuation of their own and for tests. Nothing is removed:
/// harmonics 0 .. H of all degrees of freedom, harmonic after harmonic.
///
/// solver       options, of which harmonics and samples count; NULL: the defaults.
/// omega        angular frequency, >= 0.
/// x            (H + 1) x ndof complex numbers; the imaginary part of the mean is no unknown.
/// x_len        complex numbers in it.
/// r            receives as many; the imaginary part of the mean's rows is that of x.
/// r_len        complex numbers in it.
/// jac          receives d R / d X over the pairs (re, im), real, column-major of order
///              2 (H + 1) ndof; or NULL.
/// jac_len      doubles in it; 0 with NULL.
/// d_omega      receives d R / d omega, complex like r; or NULL.
/// d_omega_len  complex numbers in it; 0 with NULL.
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
    const COMPLEX: &str = "(harmonics + 1) * ndof";
    call(|| {
        let model = read::<Model>(model, 1)?;
        let solver = unsafe { solver_options(solver, model.ndof()) }?;
        if !omega.is_finite() {
            return fail!(NotFinite, "omega = {omega}, needs a finite angular frequency >= 0").blame(3);
        }
        if omega < 0.0 {
            return fail!(Argument, "omega = {omega}, needs an angular frequency >= 0").blame(3);
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
        // Complex numbers are counted, doubles lie in memory.
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
            return fail!(NotFinite, "x[{i}] is not finite").blame(4);
        }
        analysis::forced_residual(&model, &solver, omega, x, r, jac, d_omega)?;
        Ok(Status::Ok)
    })
}
