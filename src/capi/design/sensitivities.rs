//! Section "Design studies" of the header: parameters of a model, and derivatives of results by them.

#![allow(non_camel_case_types)]

use crate::at_a_point::{self, Quantity};
use crate::capi::crossing::arrays::{Range, check_pointer, disjoint, exact_len, output};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::{KeptBranch, read};
use crate::capi::crossing::indices::index;
use crate::capi::crossing::versioned_struct::{VersionedStruct, init, load};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_interrupt};
use crate::capi::structures::matrices::{hbvib_matrix, matrix_view};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::contact::forms::constants::Constant;
use crate::error::{Result, Status, fail, try_push};
use crate::model::Model;
use crate::model::matrices::structure::MatrixKind;
use crate::sensitivity::{Parameter, Reason};
use core::ptr;

/// Kinds of parameters.
#[repr(C)]
pub enum hbvib_parameter_kind {
    /// A factor on all forces, 1 at present.
    HBVIB_PARAMETER_FORCE = 0,
    /// Normal load of a contact at rest.
    HBVIB_PARAMETER_PRELOAD = 1,
    /// Friction coefficient of a contact.
    HBVIB_PARAMETER_MU = 2,
    /// Stiffness kt of a contact.
    HBVIB_PARAMETER_KT = 3,
    /// Normal stiffness of a contact.
    HBVIB_PARAMETER_KN = 4,
    /// Gap of a contact.
    HBVIB_PARAMETER_GAP = 5,
    /// The mass matrix.
    HBVIB_PARAMETER_MASS = 6,
    /// The damping matrix.
    HBVIB_PARAMETER_DAMPING = 7,
    /// The stiffness matrix of the structure, without springs and contacts.
    HBVIB_PARAMETER_STIFFNESS = 8,
    /// The fixed speed of rotation Omega.
    HBVIB_PARAMETER_SPEED = 9,
    /// Place of the slider of a contact before any motion, along t1.
    HBVIB_PARAMETER_SLIDER_T1 = 10,
    /// The same along t2, of friction in a plane.
    HBVIB_PARAMETER_SLIDER_T2 = 11,
}

/// How a parameter changes a matrix.
#[repr(C)]
pub enum hbvib_scaling {
    /// The coefficient, 0 at present, of a direction that is added to the matrix; in a cyclic model
    /// to the block of the sector itself.
    HBVIB_SCALING_ADDITIVE = 0,
    /// A factor, 1 at present, on the whole matrix with its couplings.
    HBVIB_SCALING_FACTOR = 1,
}

/// A parameter of a model. Fill it by hbvib_parameter_init. Rayleigh damping and the loss factor
/// follow the mass and stiffness matrices, as where a matrix is set anew; the factor of the damping
/// acts on Rayleigh and modal damping as well. Where a list has a factor s and a direction E of one
/// matrix A, the values make s A + d E of it, in any order of the list.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_parameter {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// HBVIB_PARAMETER_FORCE and so on.
    pub kind: i32,
    /// Constants of contacts: number of the contact, or -1: the constant of all contacts that have
    /// it, changed together. Other kinds: -1.
    pub contact: i64,
    /// Matrices, additive: the direction, ndof x ndof. Otherwise NULL.
    pub direction: *const hbvib_matrix,
    /// Matrices: HBVIB_SCALING_ADDITIVE or HBVIB_SCALING_FACTOR. Otherwise 0.
    pub scaling: i32,
    /// Must be 0.
    pub reserved: i32,
}

unsafe impl VersionedStruct for hbvib_parameter {
    const NAME: &'static str = "hbvib_parameter";
    const FIRST_SIZE: usize = 32;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            kind: hbvib_parameter_kind::HBVIB_PARAMETER_FORCE as i32,
            contact: -1,
            direction: ptr::null(),
            scaling: hbvib_scaling::HBVIB_SCALING_ADDITIVE as i32,
            reserved: 0,
        }
    }
}

/// Fills a parameter: a factor on all forces.
///
/// p          the struct; untouched on error.
/// size_of_p  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_parameter_init(p: *mut hbvib_parameter, size_of_p: usize) -> hbvib_status {
    call(|| unsafe { init(p, size_of_p) })
}

/// Results that may be differentiated.
#[repr(C)]
pub enum hbvib_quantity {
    /// Amplitude of a forced response at a fixed frequency.
    HBVIB_OF_AMPLITUDE = 0,
    /// Amplitude of a peak, which moves with the parameter.
    HBVIB_OF_PEAK_AMPLITUDE = 1,
    /// Angular frequency of a peak.
    HBVIB_OF_PEAK_OMEGA = 2,
    /// Angular frequency of a nonlinear mode at a fixed amplitude.
    HBVIB_OF_MODE_OMEGA = 3,
    /// Damping ratio of a nonlinear mode at a fixed amplitude; at its maximum also the derivative of
    /// the largest damping ratio.
    HBVIB_OF_MODE_DAMPING = 4,
    /// Plus the number of a response of hbvib_forced_options: that response, at a fixed frequency or
    /// at a peak of it, which moves with the parameter.
    HBVIB_OF_RESPONSE = 1_000_000,
    /// Plus the number of a response: angular frequency of a peak of it.
    HBVIB_OF_RESPONSE_PEAK_OMEGA = 2_000_000,
}

/// Reasons of derivatives.
#[repr(C)]
pub enum hbvib_derivative {
    /// The derivative exists.
    HBVIB_DERIVATIVE_EXISTS = 0,
    /// NaN: a contact is at the onset of slip, where the derivatives on the two sides differ.
    HBVIB_DERIVATIVE_ONSET_OF_SLIP = 1,
    /// NaN: the constant is 0 and may not fall, so that a derivative exists on one side only.
    HBVIB_DERIVATIVE_ONE_SIDED = 2,
    /// NaN: the point is a fold, where the result changes infinitely fast.
    HBVIB_DERIVATIVE_FOLD = 3,
}

/// Derivatives of a result at a stored point by parameters of the model, exact for the harmonics of
/// the point: dA/dp = A_p - lambda^T R_p with the adjoint lambda of the equations R = 0, which is
/// solved once for all parameters (for the frequency of a peak five times). The derivatives of
/// contact forces follow from their exact events. By the preload and mu of a contact that sticks
/// they are exactly 0.
///
/// model           the model of which the branch is a result, unchanged since.
/// point           number of a point of the curve, or of a peak, fold or requested solution.
/// of              HBVIB_OF_AMPLITUDE and so on; those of a peak need the number of a peak.
/// parameters      array of parameters, struct_size of the first apart.
/// count           how many, >= 1.
/// derivatives     receives the derivatives, NaN where there is none.
/// derivatives_len numbers in it: count.
/// reasons         receives numbers of hbvib_derivative, count of them; or NULL.
/// onset           receives the contact that is at the onset of slip, or -1; or NULL.
/// hooks           phase, log and cancellation; progress is not called. NULL: none.
/// HBVIB_STOPPED_BY_CALLER: the arrays are untouched.
/// Errors: HBVIB_E_INDEX (point, contact), HBVIB_E_UNSUPPORTED (a constant that the law of a
/// contact does not have, or of a law of the caller; mass and stiffness under modal damping; a
/// speed that is tied to the frequency), HBVIB_E_ARGUMENT (another model, a result that the point
/// does not have, fields of a parameter, overlapping arrays), HBVIB_E_DIMENSION (count,
/// derivatives_len, a direction), HBVIB_E_CALLBACK (a force callback failed), HBVIB_E_NULL,
/// HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: any number on
/// one model and branch.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_sensitivity(
    model: *const hbvib_model,
    branch: *const hbvib_branch,
    point: i64,
    of: i32,
    parameters: *const hbvib_parameter,
    count: i64,
    derivatives: *mut f64,
    derivatives_len: i64,
    reasons: *mut i64,
    onset: *mut i64,
    hooks: *const hbvib_hooks,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let kept = read::<KeptBranch>(branch, 2)?;
        let point = index(point, kept.branch.stored(), 3, "point")?;
        let of = quantity(of).with_argument(4)?;
        let count = parameter_count(count)?;
        let given = unsafe { loaded(parameters, count) }?;
        let described = unsafe { all_parameters(&given, &model) }?;
        let hooks = unsafe { load_hooks(hooks, 11) }?;
        let len = exact_len(derivatives_len, count, 8, "count")?;
        let reasons_len = if reasons.is_null() { 0 } else { count };
        disjoint(
            &[],
            &[
                Range::new(derivatives, len, 7, "derivatives")?,
                Range::new(reasons, reasons_len, 9, "reasons")?,
            ],
        )?;
        if !onset.is_null() {
            check_pointer(onset, 10, "onset")?;
        }
        let values = unsafe { output(derivatives, len, 7, "derivatives") }?;
        let found = unsafe {
            with_interrupt(&hooks, |interrupt| {
                at_a_point::sensitivity_with(&model, &kept.branch, point, &described, of, interrupt)
            })
        }
        .map_err(|e| match e.status {
            Status::Unsupported | Status::Index => e.in_argument(5),
            _ => e,
        })?;
        values.copy_from_slice(&found.values);
        let mut contact = -1;
        for (i, reason) in found.reasons.iter().enumerate() {
            if let Reason::OnsetOfSlip { contact: id } = reason {
                contact = *id as i64;
            }
            if !reasons.is_null() {
                unsafe { reasons.add(i).write(reason_number(*reason)) };
            }
        }
        if !onset.is_null() {
            unsafe { onset.write(contact) };
        }
        Ok(Status::Ok)
    })
}

/// Number of parameters, argument 6.
pub(crate) fn parameter_count(count: i64) -> Result<usize> {
    match crate::capi::crossing::arrays::count(count, 6, "count")? {
        0 => fail!(Dimension, "count = 0, needs at least one parameter").with_argument(6),
        count => Ok(count),
    }
}

/// The parameters described for a model.
///
/// # Safety
/// The caller of the C function states that the directions of the parameters lie where they say.
pub(crate) unsafe fn all_parameters<'a>(given: &'a [hbvib_parameter], model: &Model) -> Result<Vec<Parameter<'a>>> {
    let mut described = Vec::new();
    for one in given {
        try_push(
            &mut described,
            unsafe { parameter(one, model.ndof()) }?,
            "the parameters",
        )?;
    }
    Ok(described)
}

/// The parameters of an array whose distance is the size that the first one states.
///
/// # Safety
/// The caller of the C function states that `count` structs lie there.
pub(crate) unsafe fn loaded(parameters: *const hbvib_parameter, count: usize) -> Result<Vec<hbvib_parameter>> {
    check_pointer(parameters, 5, "parameters")?;
    let distance = unsafe { parameters.cast::<u32>().read() } as usize;
    let mut loaded_ones = Vec::new();
    for i in 0..count {
        let one = unsafe { parameters.byte_add(i * distance) };
        let read = unsafe { load(one, 5) }.map_err(|e| e.at(format_args!("parameter {i}")).in_argument(5))?;
        if i > 0 && read.struct_size as usize != distance {
            return fail!(
                StructSize,
                "parameter {i}: struct_size = {}, but that of the first is {distance}",
                read.struct_size
            )
            .with_argument(5);
        }
        try_push(&mut loaded_ones, read, "the parameters")?;
    }
    Ok(loaded_ones)
}

/// A parameter of the caller.
///
/// # Safety
/// The caller of the C function states that the direction is a matrix.
pub(crate) unsafe fn parameter(p: &hbvib_parameter, ndof: usize) -> Result<Parameter<'_>> {
    let described = unsafe { describe(p, ndof) };
    described.with_argument(5)
}

unsafe fn describe(p: &hbvib_parameter, ndof: usize) -> Result<Parameter<'_>> {
    use hbvib_parameter_kind as k;
    const KINDS: [i32; 12] = [
        k::HBVIB_PARAMETER_FORCE as i32,
        k::HBVIB_PARAMETER_PRELOAD as i32,
        k::HBVIB_PARAMETER_MU as i32,
        k::HBVIB_PARAMETER_KT as i32,
        k::HBVIB_PARAMETER_KN as i32,
        k::HBVIB_PARAMETER_GAP as i32,
        k::HBVIB_PARAMETER_MASS as i32,
        k::HBVIB_PARAMETER_DAMPING as i32,
        k::HBVIB_PARAMETER_STIFFNESS as i32,
        k::HBVIB_PARAMETER_SPEED as i32,
        k::HBVIB_PARAMETER_SLIDER_T1 as i32,
        k::HBVIB_PARAMETER_SLIDER_T2 as i32,
    ];
    const NAME: &str = "hbvib_parameter";
    crate::capi::crossing::versioned_struct::check_reserved(p.reserved, 5, NAME)?;
    let constants = [
        Constant::Preload,
        Constant::Mu,
        Constant::Kt,
        Constant::Kn,
        Constant::Gap,
    ];
    let matrices = [MatrixKind::Mass, MatrixKind::Damping, MatrixKind::Stiffness];
    let Some(kind) = KINDS.iter().position(|kind| *kind == p.kind) else {
        return fail!(
            Argument,
            "{NAME}: kind = {}, needs HBVIB_PARAMETER_FORCE = 0 .. HBVIB_PARAMETER_SLIDER_T2 = 11",
            p.kind
        );
    };
    let (of_contact, of_matrix) = (matches!(kind, 1..=5 | 10 | 11), (6..=8).contains(&kind));
    if !of_contact && p.contact != -1 {
        return fail!(
            Argument,
            "{NAME}: contact = {}, needs -1 for a parameter that is no constant of a contact",
            p.contact
        );
    }
    if !of_matrix && (p.scaling != 0 || !p.direction.is_null()) {
        return fail!(
            Argument,
            "{NAME}: scaling = {} and direction, need 0 and NULL for a parameter that is no matrix",
            p.scaling
        );
    }
    if of_contact {
        let contact = match p.contact {
            -1 => None,
            id => match usize::try_from(id) {
                Ok(id) => Some(id),
                Err(_) => return fail!(Index, "{NAME}: contact = {id}, needs a number >= 0, or -1 for all"),
            },
        };
        return Ok(Parameter::Contact {
            constant: if kind > 9 {
                Constant::Slider(kind - 10)
            } else {
                constants[kind - 1]
            },
            contact,
        });
    }
    if !of_matrix {
        return Ok(if kind == 0 { Parameter::Force } else { Parameter::Speed });
    }
    let which = matrices[kind - 6];
    match (p.scaling, p.direction.is_null()) {
        (1, true) => Ok(Parameter::Factor { which }),
        (1, false) => fail!(Argument, "{NAME}: direction, needs NULL with HBVIB_SCALING_FACTOR"),
        (0, true) => fail!(
            Argument,
            "{NAME}: direction is NULL, but an additive parameter needs a matrix"
        ),
        (0, false) => {
            let a = unsafe { load(p.direction, 5) }?;
            Ok(Parameter::Direction {
                which,
                direction: unsafe { matrix_view(&a, ("direction", ndof), 5) }?,
            })
        }
        (other, _) => fail!(
            Argument,
            "{NAME}: scaling = {other}, needs HBVIB_SCALING_ADDITIVE = 0 or HBVIB_SCALING_FACTOR = 1"
        ),
    }
}

fn quantity(of: i32) -> Result<Quantity> {
    use hbvib_quantity as q;
    let (first, second) = (q::HBVIB_OF_RESPONSE as i32, q::HBVIB_OF_RESPONSE_PEAK_OMEGA as i32);
    if of >= first && of < second {
        return Ok(Quantity::Response((of - first) as usize));
    }
    if of >= second && of < second + (second - first) {
        return Ok(Quantity::ResponsePeakOmega((of - second) as usize));
    }
    for (number, quantity) in [
        (q::HBVIB_OF_AMPLITUDE as i32, Quantity::Amplitude),
        (q::HBVIB_OF_PEAK_AMPLITUDE as i32, Quantity::PeakAmplitude),
        (q::HBVIB_OF_PEAK_OMEGA as i32, Quantity::PeakOmega),
        (q::HBVIB_OF_MODE_OMEGA as i32, Quantity::ModeOmega),
        (q::HBVIB_OF_MODE_DAMPING as i32, Quantity::ModeDamping),
    ] {
        if number == of {
            return Ok(quantity);
        }
    }
    fail!(
        Argument,
        "of = {of}, needs HBVIB_OF_AMPLITUDE = 0 .. HBVIB_OF_MODE_DAMPING = 4"
    )
}

pub(crate) fn reason_number(reason: Reason) -> i64 {
    use hbvib_derivative as d;
    let reason = match reason {
        Reason::Exists => d::HBVIB_DERIVATIVE_EXISTS,
        Reason::OnsetOfSlip { .. } => d::HBVIB_DERIVATIVE_ONSET_OF_SLIP,
        Reason::ZeroConstant => d::HBVIB_DERIVATIVE_ONE_SIDED,
        Reason::Fold => d::HBVIB_DERIVATIVE_FOLD,
    };
    reason as i64
}
