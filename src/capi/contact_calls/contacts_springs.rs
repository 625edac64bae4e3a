//! Section "Contacts" of the header: nonlinear springs and dampers, from tables of points,
//! polynomials and stiffness tensors.

use crate::capi::crossing::arrays::{count, input};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::{Writing, write};
use crate::capi::crossing::indices::{at_least_1, check_id, list, side, with_named_argument};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::contact::laws::Table;
use crate::contact::laws::{HIGHEST_EXPONENT, Monomial, Polynomial};
use crate::contact::{Contact, ContactKind};
use crate::error::{Error, Result, Status, fail, try_push};
use crate::model::Model;

/// Adds a spring whose force is given by a table, f = f(y), y = x_a - x_b: linear between the
/// points, and beyond them along the first and the last line. Its Fourier integrals are exact.
///
/// dof_a, dof_b   degrees of freedom of the two sides, from 0, or HBVIB_GROUND.
/// sector_offset  sector of side b counted from that of side a; 0 in plain models.
/// n              number of points, >= 2.
/// displacement   y of the points, strictly ascending; n numbers.
/// force          f of the points; n numbers. A table whose force at y = 0 is not 0 loads the
///                structure at rest.
/// id             receives the number of the contact, from 0; may be NULL; untouched on error.
/// Errors: HBVIB_E_INDEX (dof_a, dof_b), HBVIB_E_DIMENSION (n), HBVIB_E_ARGUMENT (points that are
/// not sorted, equal sides, sector_offset in a plain structure), HBVIB_E_NOT_FINITE, HBVIB_E_NULL,
/// HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_model_add_table(
    model: *mut hbvib_model,
    dof_a: i64,
    dof_b: i64,
    sector_offset: i64,
    n: i64,
    displacement: *const f64,
    force: *const f64,
    id: *mut i64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let between = between(dof_a, dof_b, sector_offset, model.ndof())?;
        let n = count(n, 5, "n")?;
        if n < 2 {
            return fail!(Dimension, "n = {n}, needs at least 2 points of a table").with_argument(5);
        }
        let displacement = unsafe { input(displacement, n, 6, "displacement") }?;
        let force = unsafe { input(force, n, 7, "force") }?;
        check_id(id, 8, "id")?;
        let table = Table::new(displacement, force).map_err(|e| match e.status {
            Status::OutOfMemory => e,
            // An infinite slope follows from both arrays; the force is the likelier cause.
            _ => with_named_argument(e, &[("displacement", 6), ("", 7)]),
        })?;
        let contact = Contact {
            kind: ContactKind::Table(table),
            ..between
        };
        unsafe { add(&mut model, &contact, id) }.map_err(|e| with_side_argument(e, 4))
    })
}

/// Adds a spring and a damper of polynomial form between two degrees of freedom: `f = sum spring[k]
/// y^(k+1) + sum damper[k] v^(k+1)`, k = 0, 1, ..., with y = x_a - x_b and v = y'. Harmonic balance
/// of it is exact.
///
/// dof_a, dof_b   degrees of freedom of the two sides, from 0, or HBVIB_GROUND.
/// sector_offset  sector of side b counted from that of side a; 0 in plain models.
/// n_spring       number of stiffness coefficients, 0 .. 15.
/// spring         coefficients of y, y^2, ..., of any sign; NULL if there are none.
/// n_damper       number of damping coefficients, 0 .. 15; not 0 if n_spring is.
/// damper         coefficients of v, v^2, ..., of any sign; NULL if there are none.
/// id             receives the number of the contact, from 0; may be NULL; untouched on error.
/// Errors: HBVIB_E_INDEX (dof_a, dof_b), HBVIB_E_DIMENSION (n_spring, n_damper), HBVIB_E_ARGUMENT
/// (equal sides, sector_offset in a plain structure), HBVIB_E_NOT_FINITE, HBVIB_E_NULL,
/// HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: one at a time per model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_model_add_spring_damper(
    model: *mut hbvib_model,
    dof_a: i64,
    dof_b: i64,
    sector_offset: i64,
    n_spring: i64,
    spring: *const f64,
    n_damper: i64,
    damper: *const f64,
    id: *mut i64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let between = between(dof_a, dof_b, sector_offset, model.ndof())?;
        let number = |value: i64, argument, name: &str| match usize::try_from(value) {
            Ok(n) if n <= HIGHEST_EXPONENT as usize => Ok(n),
            _ => fail!(Dimension, "{name} = {value}, needs 0 .. {HIGHEST_EXPONENT}").with_argument(argument),
        };
        let (n_spring, n_damper) = (number(n_spring, 5, "n_spring")?, number(n_damper, 7, "n_damper")?);
        if n_spring == 0 && n_damper == 0 {
            return fail!(Dimension, "n_spring and n_damper are 0, needs one coefficient at least").with_argument(5);
        }
        let spring = unsafe { input(spring, n_spring, 6, "spring") }?;
        let damper = unsafe { input(damper, n_damper, 8, "damper") }?;
        check_id(id, 9, "id")?;
        let law = Polynomial::scalar(spring, damper).map_err(|e| match e.status {
            Status::OutOfMemory => e,
            _ => with_named_argument(e, &[("damper", 8), ("", 6)]),
        })?;
        let contact = Contact {
            kind: ContactKind::Polynomial(law),
            ..between
        };
        unsafe { add(&mut model, &contact, id) }.map_err(|e| with_side_argument(e, 4))
    })
}

/// Adds springs and dampers of polynomial form over the motions x_j of several degrees of freedom
/// over the ground and their velocities v_j: term t adds `coefficient[t] * product of
/// x_j^x_powers[t][j] * product of v_j^v_powers[t][j]` to the force on degree of freedom
/// `dofs[direction[t]]`. Harmonic balance of it is exact.
///
/// dofs         degrees of freedom from 0, each once; n_dofs numbers.
/// n_dofs       their number, >= 1.
/// n_terms      number of terms, >= 1.
/// direction    place in dofs of the force that a term adds to, from 0; n_terms numbers.
/// coefficient  of any sign; n_terms numbers.
/// x_powers     exponents of the motions, 0 .. 15, n_terms x n_dofs, term after term; NULL: all 0.
/// v_powers     exponents of the velocities, likewise; NULL: all 0. No term may have exponents 0
///              alone.
/// id           receives the number of the contact, from 0; may be NULL; untouched on error.
/// Errors: HBVIB_E_INDEX (dofs, direction), HBVIB_E_DIMENSION (n_dofs, n_terms), HBVIB_E_ARGUMENT
/// (exponents, a degree of freedom twice), HBVIB_E_NOT_FINITE, HBVIB_E_NULL, HBVIB_E_HANDLE,
/// HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: one at a time per model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_model_add_polynomial(
    model: *mut hbvib_model,
    dofs: *const i64,
    n_dofs: i64,
    n_terms: i64,
    direction: *const i64,
    coefficient: *const f64,
    x_powers: *const i32,
    v_powers: *const i32,
    id: *mut i64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let d = at_least_1(n_dofs, 3, "n_dofs")?;
        let terms = at_least_1(n_terms, 4, "n_terms")?;
        let dofs = unsafe { list(dofs, d, model.ndof()) }?;
        let direction = unsafe { input(direction, terms, 5, "direction") }?;
        let coefficient = unsafe { input(coefficient, terms, 6, "coefficient") }?;
        let x = unsafe { powers((x_powers, 7), (terms, d), "x_powers") }?;
        let v = unsafe { powers((v_powers, 8), (terms, d), "v_powers") }?;
        check_id(id, 9, "id")?;
        let mut monomials = Vec::new();
        for (t, (&i, &coefficient)) in direction.iter().zip(coefficient).enumerate() {
            let Some(direction) = usize::try_from(i).ok().filter(|&i| i < d) else {
                return fail!(Index, "direction[{t}] = {i}, needs 0 .. {}", d - 1).with_argument(5);
            };
            if !coefficient.is_finite() {
                return fail!(NotFinite, "coefficient[{t}] = {coefficient}, needs a finite number").with_argument(6);
            }
            let of_term = |powers: &'_ [u32]| if powers.is_empty() { 0..0 } else { t * d..(t + 1) * d };
            let monomial = Monomial {
                direction,
                coefficient,
                displacements: &x[of_term(&x)],
                velocities: &v[of_term(&v)],
            };
            try_push(&mut monomials, monomial, "a polynomial")?;
        }
        let law = Polynomial::new(d, &monomials).map_err(|e| match e.status {
            Status::OutOfMemory => e,
            // The sum of coefficients that each are finite.
            Status::NotFinite => e.in_argument(6),
            _ => e.in_argument(7),
        })?;
        let contact = Contact::over(dofs, ContactKind::Polynomial(law));
        unsafe { add(&mut model, &contact, id) }.with_argument(2)
    })
}

/// Adds the quadratic and cubic stiffness of a reduced structure, over the motions of degrees of
/// freedom over the ground: `f_i = sum quadratic[i][j][k] x_j x_k + sum cubic[i][j][k][l] x_j x_k
/// x_l` on degree of freedom `dofs[i]`. The linear stiffness is that of the model. No symmetry of
/// the tensors is assumed. Harmonic balance of it is exact.
///
/// dofs       degrees of freedom from 0, each once; n numbers.
/// n          their number, >= 1.
/// quadratic  n^3 numbers, the last index running fastest, or NULL.
/// cubic      n^4 numbers, likewise, or NULL. Not both may be NULL.
/// id         receives the number of the contact, from 0; may be NULL; untouched on error.
/// Errors: HBVIB_E_INDEX (dofs), HBVIB_E_DIMENSION (n), HBVIB_E_ARGUMENT (a degree of freedom
/// twice), HBVIB_E_NOT_FINITE, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_add_stiffness_tensors(
    model: *mut hbvib_model,
    dofs: *const i64,
    n: i64,
    quadratic: *const f64,
    cubic: *const f64,
    id: *mut i64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let n = at_least_1(n, 3, "n")?;
        let dofs = unsafe { list(dofs, n, model.ndof()) }?;
        if quadratic.is_null() && cubic.is_null() {
            return fail!(Null, "quadratic and cubic are NULL, needs one of them").with_argument(4);
        }
        let tensor = |p: *const f64, rank, argument, name: &str| {
            if p.is_null() {
                return Ok(&[][..]);
            }
            unsafe { input(p, volume(n, rank, argument, name)?, argument, name) }
        };
        let quadratic = tensor(quadratic, 3, 4, "quadratic")?;
        let cubic = tensor(cubic, 4, 5, "cubic")?;
        check_id(id, 6, "id")?;
        let law = Polynomial::tensors(n, &[], quadratic, cubic).map_err(|e| match e.status {
            Status::OutOfMemory => e,
            _ => with_named_argument(e, &[("cubic", 5), ("degree 3", 5), ("", 4)]),
        })?;
        let contact = Contact::over(dofs, ContactKind::Polynomial(law));
        unsafe { add(&mut model, &contact, id) }.with_argument(2)
    })
}

/// Adds a contact and writes its number for the caller.
///
/// # Safety
/// `id`, checked before, is NULL or writable.
unsafe fn add(model: &mut Writing<Model>, contact: &Contact, id: *mut i64) -> Result<Status> {
    let number = model.add_contact(contact)?;
    if !id.is_null() {
        unsafe { id.write(number as i64) };
    }
    Ok(Status::Ok)
}

/// The sides of a law that acts on one relative motion: arguments 2 to 4.
fn between(dof_a: i64, dof_b: i64, sector_offset: i64, ndof: usize) -> Result<Contact> {
    Ok(Contact {
        dof_a: [side(dof_a, ndof, 2, format_args!("dof_a"))?, None, None],
        dof_b: [side(dof_b, ndof, 3, format_args!("dof_b"))?, None, None],
        sector_offset,
        ..Contact::jenkins(0, None, 0.0, 0.0, 0.0)
    })
}

/// n to the power of `rank`, the length of an array.
fn volume(n: usize, rank: u32, argument: i32, name: &str) -> Result<usize> {
    let Some(len) = n.checked_pow(rank) else {
        return fail!(Dimension, "{name}: {n}^{rank} entries cannot lie in memory").with_argument(argument);
    };
    Ok(len)
}

/// Exponents of terms, checked; none for NULL.
///
/// # Safety
/// Those of [`input`].
unsafe fn powers((p, argument): (*const i32, i32), (terms, d): (usize, usize), name: &str) -> Result<Vec<u32>> {
    let mut powers = Vec::new();
    if p.is_null() {
        return Ok(powers);
    }
    let Some(len) = terms.checked_mul(d) else {
        return fail!(Dimension, "{name}: {terms} x {d} entries cannot lie in memory").with_argument(argument);
    };
    for (i, &power) in unsafe { input(p, len, argument, name) }?.iter().enumerate() {
        match u32::try_from(power) {
            Ok(power) if power <= HIGHEST_EXPONENT => try_push(&mut powers, power, "a polynomial")?,
            _ => {
                return fail!(
                    Argument,
                    "{name}[{},{}] = {power}, needs 0 .. {HIGHEST_EXPONENT}",
                    i / d,
                    i % d
                )
                .with_argument(argument);
            }
        }
    }
    Ok(powers)
}

/// Attributes an error of the model to the sector offset or to the sides.
fn with_side_argument(e: Error, sector_offset: i32) -> Error {
    if e.status == Status::OutOfMemory {
        return e;
    }
    with_named_argument(e, &[("sector_offset", sector_offset), ("", 2)])
}
