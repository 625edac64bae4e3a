//! Many contacts or springs in one call, from arrays.

use super::boundary::{Blame, call, check_pointer, count, input};
use super::handles::write;
use super::types::{hbvib_model, hbvib_special_dof, hbvib_status};
use crate::contact::Contact;
use crate::contact::laws::iwan::Iwan;
use crate::error::{Error, Result, Status, fail, try_push};
use crate::model::Model;
use crate::model::spring::Spring;
use core::fmt;

const GROUND: i64 = hbvib_special_dof::HBVIB_GROUND as i64;

/// The sides of contacts or springs as the caller's arrays give them: arguments 3 to 5.
struct Sides<'a> {
    a: &'a [i64],
    b: &'a [i64],
    offsets: Option<&'a [i64]>,
    ndof: usize,
}

impl Sides<'_> {
    /// # Safety
    /// As for [`input`]; `sector_offset` may be NULL.
    unsafe fn new(
        dof_a: *const i64,
        dof_b: *const i64,
        sector_offset: *const i64,
        n: usize,
        ndof: usize,
    ) -> Result<Self> {
        Ok(Self {
            a: unsafe { input(dof_a, n, 3, "dof_a") }?,
            b: unsafe { input(dof_b, n, 4, "dof_b") }?,
            offsets: if sector_offset.is_null() {
                None
            } else {
                Some(unsafe { input(sector_offset, n, 5, "sector_offset") }?)
            },
            ndof,
        })
    }

    /// Side a, side b and sector offset of entry `i`.
    fn entry(&self, i: usize) -> Result<(Option<usize>, Option<usize>, i64)> {
        let side = |dofs: &[i64], argument, name: &str| side(dofs[i], self.ndof, argument, format_args!("{name}[{i}]"));
        let offset = self.offsets.map_or(0, |o| o[i]);
        Ok((side(self.a, 3, "dof_a")?, side(self.b, 4, "dof_b")?, offset))
    }
}

/// One side of an element as the caller gives it.
pub(super) fn side(dof: i64, ndof: usize, argument: i32, name: fmt::Arguments<'_>) -> Result<Option<usize>> {
    match dof {
        GROUND => Ok(None),
        dof if (0..ndof as i64).contains(&dof) => Ok(Some(dof as usize)),
        dof => fail!(Index, "{name} = {dof}, needs 0 .. {} or HBVIB_GROUND = -1", ndof - 1).blame(argument),
    }
}

/// Which array an error in the constants of an entry is about; 0: none of them.
pub(super) fn blame_constant(e: Error, arrays: &[(&str, i32)]) -> Error {
    let found = arrays.iter().find(|(name, _)| e.message().contains(name));
    e.in_argument(found.map_or(0, |&(_, argument)| argument))
}

/// Adds many Jenkins contacts from arrays; entry i of each array describes one. All of them are
/// checked before any is added.
///
/// n              number of contacts, >= 0.
/// dof_a, dof_b   degrees of freedom of the two sides, from 0, or HBVIB_GROUND; n each.
/// sector_offset  sector of side b counted from that of side a, n numbers; NULL: all 0.
/// kt, mu, preload  tangential stiffness, friction coefficient, normal load; n each.
/// first_id       receives the number of the first contact, the others follow; may be NULL.
/// Errors: as hbvib_model_add_contact, naming the entry; HBVIB_E_DIMENSION (n).
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_model_add_jenkins(
    model: *mut hbvib_model,
    n: i64,
    dof_a: *const i64,
    dof_b: *const i64,
    sector_offset: *const i64,
    kt: *const f64,
    mu: *const f64,
    preload: *const f64,
    first_id: *mut i64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let n = count(n, 2, "n")?;
        let sides = unsafe { Sides::new(dof_a, dof_b, sector_offset, n, model.ndof()) }?;
        let kt = unsafe { input(kt, n, 6, "kt") }?;
        let mu = unsafe { input(mu, n, 7, "mu") }?;
        let preload = unsafe { input(preload, n, 8, "preload") }?;
        if !first_id.is_null() {
            check_pointer(first_id, 9, "first_id")?;
        }
        let mut contacts = Vec::new();
        for i in 0..n {
            let mut contact = Contact::jenkins(0, None, kt[i], mu[i], preload[i]);
            (contact.dof_a[0], contact.dof_b[0], contact.sector_offset) = sides.entry(i)?;
            try_push(&mut contacts, contact, "the contacts")?;
        }
        let first = model.add_contacts(&contacts).map_err(|e| {
            let arrays = [("kt", 6), ("mu", 7), ("preload", 8), ("sector_offset", 5), ("dof_a", 3)];
            blame_constant(e, &arrays)
        })?;
        if !first_id.is_null() {
            unsafe { first_id.write(first as i64) };
        }
        Ok(Status::Ok)
    })
}

/// Adds many linear springs from arrays; they take no part in Rayleigh damping. All of them are
/// checked before any is added.
///
/// n              number of springs, >= 0.
/// dof_a, dof_b   degrees of freedom of the two sides, from 0, or HBVIB_GROUND; n each.
/// sector_offset  sector of side b counted from that of side a, n numbers; NULL: all 0.
/// stiffness      force per length, of any sign; n numbers.
/// Errors: HBVIB_E_INDEX (dof_a, dof_b), HBVIB_E_ARGUMENT (both sides the same, sector_offset in a
/// plain structure), HBVIB_E_NOT_FINITE, HBVIB_E_DIMENSION (n), HBVIB_E_NULL, HBVIB_E_HANDLE,
/// HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY, naming the entry.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_add_springs(
    model: *mut hbvib_model,
    n: i64,
    dof_a: *const i64,
    dof_b: *const i64,
    sector_offset: *const i64,
    stiffness: *const f64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let n = count(n, 2, "n")?;
        let sides = unsafe { Sides::new(dof_a, dof_b, sector_offset, n, model.ndof()) }?;
        let stiffness = unsafe { input(stiffness, n, 6, "stiffness") }?;
        let mut springs = Vec::new();
        for (i, &stiffness) in stiffness.iter().enumerate() {
            let (dof_a, dof_b, sector_offset) = sides.entry(i)?;
            let spring = Spring {
                dof_a,
                dof_b,
                sector_offset,
                stiffness,
            };
            try_push(&mut springs, spring, "the springs")?;
        }
        model.add_springs(&springs).map_err(|e| {
            let arrays = [("stiffness", 6), ("sector_offset", 5), ("dof_a", 3)];
            blame_constant(e, &arrays)
        })?;
        Ok(Status::Ok)
    })
}

/// Adds an Iwan joint with four parameters (Segalman 2005): Jenkins contacts in parallel whose slip
/// limits are distributed so that the loss per cycle grows with the power 3 + chi of the amplitude.
///
/// dof_a, dof_b   degrees of freedom of the two sides, from 0, or HBVIB_GROUND.
/// sector_offset  sector of side b counted from that of side a; 0 in plain models.
/// slip_force     force at which the whole joint slips, > 0.
/// stiffness      tangent stiffness at rest, force per length, > 0.
/// chi            -1 < chi <= 0.
/// beta           stiffness that slips last over the rest of it, >= 0.
/// elements       Jenkins contacts to make of it, 2 .. 10000; they span five decades of displacement.
/// first_id       receives the number of the first of them, the others follow; may be NULL.
/// Errors: HBVIB_E_INDEX (dof_a, dof_b), HBVIB_E_ARGUMENT and HBVIB_E_NOT_FINITE (parameters, both
/// sides the same, sector_offset in a plain structure), HBVIB_E_DIMENSION (elements < 0),
/// HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_model_add_iwan(
    model: *mut hbvib_model,
    dof_a: i64,
    dof_b: i64,
    sector_offset: i64,
    slip_force: f64,
    stiffness: f64,
    chi: f64,
    beta: f64,
    elements: i64,
    first_id: *mut i64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let ndof = model.ndof();
        let between = Contact {
            dof_a: [side(dof_a, ndof, 2, format_args!("dof_a"))?, None, None],
            dof_b: [side(dof_b, ndof, 3, format_args!("dof_b"))?, None, None],
            sector_offset,
            ..Contact::jenkins(0, None, 0.0, 0.0, 0.0)
        };
        let joint = Iwan {
            slip_force,
            stiffness,
            chi,
            beta,
        };
        let elements = count(elements, 9, "elements")?;
        if !first_id.is_null() {
            check_pointer(first_id, 10, "first_id")?;
        }
        let first = model.add_iwan(&between, &joint, elements).map_err(|e| {
            let names = [
                ("slip_force", 5),
                ("stiffness", 6),
                ("chi", 7),
                ("beta", 8),
                ("elements", 9),
                ("sector_offset", 4),
                ("dof_a", 2),
            ];
            blame_constant(e, &names)
        })?;
        if !first_id.is_null() {
            unsafe { first_id.write(first as i64) };
        }
        Ok(Status::Ok)
    })
}
