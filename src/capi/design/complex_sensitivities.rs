//! Section "Design studies" of the header: derivatives of complex amplitudes.

#![allow(non_camel_case_types)]

use crate::at_a_point;
use crate::capi::crossing::arrays::{Range, check_pointer, disjoint, exact_len, output};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::{KeptBranch, read};
use crate::capi::crossing::indices::index;
use crate::capi::design::sensitivities::{all_parameters, hbvib_parameter, loaded, parameter_count, reason_number};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_interrupt};
use crate::capi::solving::solve_responses::{Watched, hbvib_response};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::Status;
use crate::model::Model;
use crate::options::Response;
use crate::sensitivity::Reason;

/// Derivatives of the complex amplitude of a response at a stored point of a forced response by
/// parameters of the model, at a fixed frequency, exact for the harmonics of the point: the
/// real and the imaginary part have one adjoint each, from one factorised matrix. The branch
/// need not have watched the response.
///
/// model            the model of which the branch is a result, unchanged since.
/// branch           a forced response.
/// point            number of a stored point.
/// response         a fundamental or a harmonic; NULL: the fundamental of the response degree of
///                  freedom.
/// parameters       array of parameters, struct_size of the first apart.
/// count            how many, >= 1.
/// derivatives      receives the complex derivatives, re and im, 2 count doubles; NaN where
///                  there is none.
/// derivatives_len  complex numbers in it: count.
/// reasons          receives numbers of hbvib_derivative, count of them; or NULL.
/// onset            receives the contact that is at the onset of slip, or -1; or NULL.
/// value            receives the amplitude, re and im; or NULL.
/// by_omega         receives its derivative by the angular frequency along the branch, re and
///                  im, NaN in a fold; or NULL.
/// hooks            phase, log and cancellation; progress is not called. NULL: none.
/// HBVIB_STOPPED_BY_CALLER: the arrays are untouched.
/// Errors: HBVIB_E_INDEX (point, contact), HBVIB_E_UNSUPPORTED (a nonlinear mode, near-rigid
/// contacts, parameters as in hbvib_sensitivity), HBVIB_E_ARGUMENT (another model, a measure
/// without phase, overlapping arrays), HBVIB_E_DIMENSION, HBVIB_E_CALLBACK, HBVIB_E_NULL,
/// HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: any
/// number on one model and branch.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_response_sensitivity(
    model: *const hbvib_model,
    branch: *const hbvib_branch,
    point: i64,
    response: *const hbvib_response,
    parameters: *const hbvib_parameter,
    count: i64,
    derivatives: *mut f64,
    derivatives_len: i64,
    reasons: *mut i64,
    onset: *mut i64,
    value: *mut f64,
    by_omega: *mut f64,
    hooks: *const hbvib_hooks,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let kept = read::<KeptBranch>(branch, 2)?;
        let point = index(point, kept.branch.stored(), 3, "point")?;
        let watched =
            unsafe { Watched::new(response, i64::from(!response.is_null()), model.ndof(), 4) }.with_argument(4)?;
        let responses = unsafe { watched.responses(4) }.with_argument(4)?;
        let response = responses.first().copied().unwrap_or_else(Response::default);
        let count = parameter_count(count)?;
        let given = unsafe { loaded(parameters, count) }?;
        let described = unsafe { all_parameters(&given, &model) }?;
        let len = exact_len(derivatives_len, count, 8, "count")?;
        let hooks = unsafe { load_hooks(hooks, 13) }?;
        let number = |p: *mut f64| if p.is_null() { 0 } else { 2 };
        disjoint(
            &[],
            &[
                Range::new(derivatives, 2 * len, 7, "derivatives")?,
                Range::new(reasons, if reasons.is_null() { 0 } else { count }, 9, "reasons")?,
                Range::new(value, number(value), 11, "value")?,
                Range::new(by_omega, number(by_omega), 12, "by_omega")?,
            ],
        )?;
        if !onset.is_null() {
            check_pointer(onset, 10, "onset")?;
        }
        let to = unsafe { output(derivatives, 2 * len, 7, "derivatives") }?;
        let found = unsafe {
            with_interrupt(&hooks, |interrupt| {
                at_a_point::complex_sensitivity_with(&model, &kept.branch, point, &response, &described, interrupt)
            })
        }
        .map_err(|e| match e.status {
            Status::Unsupported | Status::Index if e.argument == 0 => e.in_argument(5),
            _ => e,
        })?;
        for (to, from) in to.chunks_exact_mut(2).zip(&found.values) {
            to.copy_from_slice(&[from.re, from.im]);
        }
        let mut contact = -1;
        for (i, reason) in found.reasons.iter().enumerate() {
            if let Reason::OnsetOfSlip { contact: id } = reason {
                contact = *id as i64;
            }
            if !reasons.is_null() {
                unsafe { reasons.add(i).write(reason_number(*reason)) };
            }
        }
        unsafe {
            if !onset.is_null() {
                onset.write(contact);
            }
            for (p, number) in [(value, found.value), (by_omega, found.by_omega)] {
                if !p.is_null() {
                    p.write(number.re);
                    p.add(1).write(number.im);
                }
            }
        }
        Ok(Status::Ok)
    })
}
