//! Models: matrices, waves and forces in.

use super::boundary::{Blame, call, check_pointer, count, index, input};
use super::handles::{free, insert, read, write};
use super::sized::{Described, check_reserved, init, load};
use super::types::{hbvib_contact_state, hbvib_matrix, hbvib_matrix_kind, hbvib_model};
use super::types::{hbvib_part, hbvib_scalar, hbvib_status, hbvib_storage};
use crate::error::{Error, Result, Status, fail};
use crate::linalg::matrix_view::{MatrixView, Part, Storage, Values};
use crate::model::Model;
use crate::model::linear_modes::ContactState;
use crate::model::structure::MatrixKind;
use core::ptr;
use num_complex::Complex64;

unsafe impl Described for hbvib_matrix {
    const NAME: &'static str = "hbvib_matrix";
    const FIRST: usize = 72;

    fn filled() -> Self {
        Self {
            struct_size: 0,
            storage: hbvib_storage::HBVIB_COL_MAJOR as i32,
            scalar: hbvib_scalar::HBVIB_REAL as i32,
            part: hbvib_part::HBVIB_FULL as i32,
            rows: 0,
            cols: 0,
            ld: 0,
            values: ptr::null(),
            col_ptr: ptr::null(),
            row_idx: ptr::null(),
            index_base: 0,
            reserved: 0,
        }
    }
}

const COL_MAJOR: i32 = hbvib_storage::HBVIB_COL_MAJOR as i32;
const ROW_MAJOR: i32 = hbvib_storage::HBVIB_ROW_MAJOR as i32;
const CSC: i32 = hbvib_storage::HBVIB_CSC as i32;

/// One of M, C, K by its number.
fn matrix_kind(which: i32) -> Result<MatrixKind> {
    const MASS: i32 = hbvib_matrix_kind::HBVIB_MASS as i32;
    const DAMPING: i32 = hbvib_matrix_kind::HBVIB_DAMPING as i32;
    const STIFFNESS: i32 = hbvib_matrix_kind::HBVIB_STIFFNESS as i32;
    match which {
        MASS => Ok(MatrixKind::Mass),
        DAMPING => Ok(MatrixKind::Damping),
        STIFFNESS => Ok(MatrixKind::Stiffness),
        _ => fail!(
            Argument,
            "which = {which}, needs HBVIB_MASS = 0, HBVIB_DAMPING = 1 or HBVIB_STIFFNESS = 2"
        ),
    }
    .blame(2)
}

fn part(value: i32) -> Result<Part> {
    const FULL: i32 = hbvib_part::HBVIB_FULL as i32;
    const LOWER: i32 = hbvib_part::HBVIB_LOWER as i32;
    const UPPER: i32 = hbvib_part::HBVIB_UPPER as i32;
    const GENERAL: i32 = hbvib_part::HBVIB_GENERAL as i32;
    match value {
        FULL => Ok(Part::Full),
        LOWER => Ok(Part::Lower),
        UPPER => Ok(Part::Upper),
        GENERAL => Ok(Part::General),
        _ => fail!(
            Argument,
            "hbvib_matrix: part = {value}, needs HBVIB_FULL = 0 .. HBVIB_GENERAL = 3"
        ),
    }
}

/// Hands the matrix at `p`, of order `n`, to `then`; errors blame `argument`.
///
/// # Safety
/// The caller of the C function states that the arrays of the view are as long as it says.
unsafe fn with_matrix<T>(
    p: *const hbvib_matrix,
    argument: i32,
    n: usize,
    then: impl FnOnce(&MatrixView<'_>) -> Result<T>,
) -> Result<T> {
    let a = unsafe { load(p, argument) }?;
    let view = unsafe { matrix_view(&a, n, argument) }.blame(argument)?;
    then(&view).blame(argument)
}

unsafe fn matrix_view(a: &hbvib_matrix, n: usize, argument: i32) -> Result<MatrixView<'_>> {
    const NAME: &str = "hbvib_matrix: values";
    check_reserved(a.reserved, argument, "hbvib_matrix")?;
    if usize::try_from(a.rows) != Ok(n) || usize::try_from(a.cols) != Ok(n) {
        return fail!(
            Dimension,
            "hbvib_matrix: rows x cols = {} x {}, needs {n} x {n}",
            a.rows,
            a.cols
        );
    }
    let index_base = match a.index_base {
        0 => 0,
        1 => 1,
        other => return fail!(Argument, "hbvib_matrix: index_base = {other}, needs 0 or 1"),
    };
    let (len, storage) = match a.storage {
        COL_MAJOR | ROW_MAJOR => {
            let ld = usize::try_from(a.ld).unwrap_or(0);
            if a.ld < 0 || (ld > 0 && ld < n) {
                return fail!(
                    Dimension,
                    "hbvib_matrix: ld = {}, needs at least {n}, or 0 for a packed matrix",
                    a.ld
                );
            }
            let distance = if ld == 0 { n } else { ld };
            let len = (n - 1).checked_mul(distance).and_then(|l| l.checked_add(n));
            let storage = if a.storage == COL_MAJOR {
                Storage::ColMajor { ld }
            } else {
                Storage::RowMajor { ld }
            };
            (len.unwrap_or(usize::MAX), storage)
        }
        CSC => {
            let col_ptr = unsafe { input(a.col_ptr, n + 1, argument, "hbvib_matrix: col_ptr") }?;
            // Offsets that make no sense are refused, with their place, before an entry is read.
            let stored = col_ptr[n].checked_sub(index_base as i64);
            let stored = stored.and_then(|s| usize::try_from(s).ok()).unwrap_or(0);
            let row_idx = unsafe { input(a.row_idx, stored, argument, "hbvib_matrix: row_idx") }?;
            (stored, Storage::Csc { col_ptr, row_idx })
        }
        other => {
            return fail!(
                Argument,
                "hbvib_matrix: storage = {other}, needs HBVIB_COL_MAJOR = 0, HBVIB_ROW_MAJOR = 1 or HBVIB_CSC = 2"
            );
        }
    };
    let values = match a.scalar {
        0 => Values::Real(unsafe { input(a.values, len, argument, NAME) }?),
        1 => Values::Complex(unsafe { input(a.values.cast(), len, argument, NAME) }?),
        other => {
            return fail!(
                Argument,
                "hbvib_matrix: scalar = {other}, needs HBVIB_REAL = 0 or HBVIB_COMPLEX = 1"
            );
        }
    };
    Ok(MatrixView {
        rows: n,
        cols: n,
        storage,
        values,
        part: part(a.part)?,
        index_base,
    })
}

/// Fills a matrix description: struct_size, dense column-major, real, symmetric in full, the rest
/// zero. Set rows, cols and values at least.
///
/// a          the struct; untouched on error.
/// size_of_a  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_matrix_init(a: *mut hbvib_matrix, size_of_a: usize) -> hbvib_status {
    call(|| unsafe { init(a, size_of_a) })
}

/// Creates a plain structure: all matrices zero, no contact, no force.
///
/// ndof  degrees of freedom, 1 .. 2^31.
/// out   receives the model; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_DIMENSION, HBVIB_E_NULL, HBVIB_E_OUT_OF_MEMORY. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_new(ndof: i64, out: *mut *mut hbvib_model) -> hbvib_status {
    call(|| {
        check_pointer(out, 2, "out")?;
        let model = Model::new(count(ndof, 1, "ndof")?).blame(1)?;
        unsafe { out.write(insert(model)?) };
        Ok(Status::Ok)
    })
}

/// Creates a cyclic structure, described by one of its sectors, under engine order 0: all matrices
/// zero, no contact, no force.
///
/// ndof_sector  degrees of freedom of the sector, 1 .. 2^31.
/// sectors      number of equal sectors N, 1 .. 2^20.
/// out          receives the model; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_DIMENSION (ndof_sector), HBVIB_E_ARGUMENT (sectors), HBVIB_E_NULL,
/// HBVIB_E_OUT_OF_MEMORY. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_cyclic_new(ndof_sector: i64, sectors: i64, out: *mut *mut hbvib_model) -> hbvib_status {
    call(|| {
        check_pointer(out, 3, "out")?;
        let ndof = count(ndof_sector, 1, "ndof_sector")?;
        let Ok(sectors) = usize::try_from(sectors) else {
            return fail!(Argument, "sectors = {sectors}, needs at least 1").blame(2);
        };
        let model = Model::cyclic(ndof, sectors);
        let model = model.map_err(|e| {
            let argument = if e.status == Status::Dimension { 1 } else { 2 };
            e.in_argument(argument)
        })?;
        unsafe { out.write(insert(model)?) };
        Ok(Status::Ok)
    })
}

/// Sets the mass, damping or stiffness matrix of a structure, or of a sector on itself.
///
/// which  HBVIB_MASS, HBVIB_DAMPING or HBVIB_STIFFNESS.
/// a      ndof x ndof. M must be symmetric or Hermitian; C and K may be HBVIB_GENERAL. Complex
///        entries act on all harmonics above zero, the mean sees their real part.
/// Errors: HBVIB_E_NOT_FINITE, HBVIB_E_NOT_HERMITIAN, HBVIB_E_INDEX, each naming the entry;
/// HBVIB_E_DIMENSION, HBVIB_E_ARGUMENT, HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL, HBVIB_E_HANDLE,
/// HBVIB_E_BUSY, HBVIB_E_NOT_POSITIVE_DEFINITE (negative diagonal mass), HBVIB_E_OUT_OF_MEMORY.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_set_matrix(
    model: *mut hbvib_model,
    which: i32,
    a: *const hbvib_matrix,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let which = matrix_kind(which)?;
        unsafe { with_matrix(a, 3, model.ndof(), |a| model.set_matrix(which, a)) }?;
        Ok(Status::Ok)
    })
}

/// Adds alpha_mass * M + beta_stiffness * K to the damping; a later call replaces an earlier one.
/// K is the structure's, without contacts.
///
/// alpha_mass, beta_stiffness  finite, 1 / time and time.
/// Errors: HBVIB_E_NOT_FINITE, HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_set_rayleigh(
    model: *mut hbvib_model,
    alpha_mass: f64,
    beta_stiffness: f64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let argument = if alpha_mass.is_finite() { 3 } else { 2 };
        model.set_rayleigh(alpha_mass, beta_stiffness).blame(argument)?;
        Ok(Status::Ok)
    })
}

/// Sets the coupling of a sector to the next one: rows of sector s, columns of s + 1. The coupling
/// to the previous sector is its transpose unless hbvib_cyclic_set_coupling_previous is called.
///
/// which    HBVIB_MASS, HBVIB_DAMPING or HBVIB_STIFFNESS.
/// to_next  ndof x ndof, any matrix whatever its `part` promises; of a triangle, the mirror image
///          is completed.
/// Where sector s + 1 lags by phi, harmonic p sees A0 + A1 exp(-i p phi) + A1^T exp(i p phi).
/// Errors: as hbvib_model_set_matrix; HBVIB_E_UNSUPPORTED for a plain structure.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_cyclic_set_coupling(
    model: *mut hbvib_model,
    which: i32,
    to_next: *const hbvib_matrix,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let which = matrix_kind(which)?;
        unsafe { with_matrix(to_next, 3, model.ndof(), |a| model.set_coupling(which, a)) }?;
        Ok(Status::Ok)
    })
}

/// Sets the coupling of a sector (rows) to the previous one (columns), for damping and stiffness
/// without symmetry.
///
/// which        HBVIB_DAMPING or HBVIB_STIFFNESS.
/// to_previous  ndof x ndof, any matrix.
/// Errors: as hbvib_cyclic_set_coupling; HBVIB_E_UNSUPPORTED for the mass.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_cyclic_set_coupling_previous(
    model: *mut hbvib_model,
    which: i32,
    to_previous: *const hbvib_matrix,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let which = matrix_kind(which)?;
        unsafe { with_matrix(to_previous, 3, model.ndof(), |a| model.set_coupling_previous(which, a)) }?;
        Ok(Status::Ok)
    })
}

/// Sets the matrix of the wave in which sector s + 1 lags by 2 pi diameter / N, instead of sector
/// blocks. Waves that run the other way see its conjugate. A harmonic whose diameter was not given
/// is an error when it is needed.
///
/// which     HBVIB_MASS, HBVIB_DAMPING or HBVIB_STIFFNESS.
/// diameter  nodal diameter, 0 .. N/2.
/// a         ndof x ndof, Hermitian; C and K may be HBVIB_GENERAL.
/// Errors: as hbvib_model_set_matrix; HBVIB_E_ARGUMENT for a diameter out of range and for
/// matrices that were given by sector blocks. Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_cyclic_set_diameter(
    model: *mut hbvib_model,
    which: i32,
    diameter: i64,
    a: *const hbvib_matrix,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let which = matrix_kind(which)?;
        let diameter = nodal_diameter(&model, diameter, 3)?;
        unsafe { with_matrix(a, 4, model.ndof(), |a| model.set_diameter(which, diameter, a)) }?;
        Ok(Status::Ok)
    })
}

fn nodal_diameter(model: &Model, diameter: i64, argument: i32) -> Result<usize> {
    let sectors = model.structure().sectors();
    match usize::try_from(diameter) {
        Ok(d) if d <= sectors / 2 => Ok(d),
        _ => Err(Error::new(
            Status::Argument,
            format_args!(
                "diameter = {diameter}, needs 0 .. {} for {sectors} sectors; a wave of {diameter} diameters is that of {}",
                sectors / 2,
                model.structure().fold(diameter).0
            ),
        )
        .in_argument(argument)),
    }
}

/// Sets the engine order of the excitation: sector s + 1 lags behind sector s by 2 pi EO / N per
/// harmonic, so that harmonic p lives on nodal diameter p EO mod N. Any sign and size; a plain
/// structure does not notice.
///
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_cyclic_set_wave(model: *mut hbvib_model, engine_order: i64) -> hbvib_status {
    call(|| {
        write::<Model>(model, 1)?.set_wave(engine_order);
        Ok(Status::Ok)
    })
}

/// Copies a model.
///
/// out  receives the copy; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY (being changed), HBVIB_E_NULL, HBVIB_E_OUT_OF_MEMORY.
/// Threads: any number may copy and solve one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_clone(model: *const hbvib_model, out: *mut *mut hbvib_model) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        check_pointer(out, 2, "out")?;
        unsafe { out.write(insert(model.try_clone()?)?) };
        Ok(Status::Ok)
    })
}

/// Frees a model. Branches solved from it stay. NULL is nothing to free and a success.
///
/// Errors: HBVIB_E_HANDLE (freed before, for example), HBVIB_E_BUSY (a call is using it: the model
/// stays alive). Threads: any, once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_free(model: *mut hbvib_model) -> hbvib_status {
    call(|| free::<Model>(model, 1).map(|()| Status::Ok))
}

/// Adds the force Re((re + i im) exp(i harmonic omega t)) on a degree of freedom (of sector 1; the
/// others lag with the wave). Forces on the same degree of freedom and harmonic add up.
///
/// dof       0 .. ndof - 1.
/// harmonic  harmonic number, 0 .. 100000; 0 is a constant force.
/// re, im    finite, force, peak; im must be 0 for a constant force.
/// Errors: HBVIB_E_INDEX (dof), HBVIB_E_ARGUMENT (harmonic, im), HBVIB_E_NOT_FINITE,
/// HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_add_force(
    model: *mut hbvib_model,
    dof: i64,
    harmonic: i64,
    re: f64,
    im: f64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let dof = index(dof, model.ndof(), 2, "dof")?;
        let Ok(harmonic) = usize::try_from(harmonic) else {
            return fail!(Argument, "harmonic = {harmonic}, needs at least 0").blame(3);
        };
        let argument = match (re.is_finite(), im.is_finite()) {
            (false, _) => 4,
            (_, false) => 5,
            _ if harmonic == 0 => 5,
            _ => 3,
        };
        model.add_force(dof, harmonic, Complex64::new(re, im)).blame(argument)?;
        Ok(Status::Ok)
    })
}

/// Removes all forces.
///
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_clear_forces(model: *mut hbvib_model) -> hbvib_status {
    call(|| {
        write::<Model>(model, 1)?.clear_forces();
        Ok(Status::Ok)
    })
}

/// Undamped natural modes, in ascending order of frequency. Motion without mass has no mode, so a
/// singular mass matrix gives fewer modes than degrees of freedom.
///
/// diameter  nodal diameter 0 .. N/2 of the wave whose sector s + 1 lags; 0 for a plain structure.
/// contacts  HBVIB_CONTACTS_FREE, or HBVIB_CONTACTS_STUCK: linear springs kt.
/// count     modes wanted, at least 1.
/// omega     receives `count` natural angular frequencies.
/// shapes    receives `count` complex shapes of ndof numbers each, one after the other, with
///           phi^H M phi = 1 over one sector; or NULL.
/// Errors: HBVIB_E_ARGUMENT (diameter, contacts), HBVIB_E_DIMENSION (more modes wanted than there
/// are), HBVIB_E_NOT_HERMITIAN, HBVIB_E_NOT_POSITIVE_DEFINITE, HBVIB_E_SINGULAR,
/// HBVIB_E_NO_CONVERGENCE, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY.
/// Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_linear_modes(
    model: *const hbvib_model,
    diameter: i64,
    contacts: i32,
    count: i64,
    omega: *mut f64,
    shapes: *mut f64,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let diameter = nodal_diameter(&model, diameter, 2)?;
        let state = contact_state(contacts)?;
        let wanted = usize::try_from(count).unwrap_or(0);
        check_pointer(omega, 5, "omega")?;
        if !shapes.is_null() {
            check_pointer(shapes, 6, "shapes")?;
        }
        if wanted == 0 || wanted > model.ndof() {
            return fail!(Dimension, "count = {count}, needs 1 .. ndof = {}", model.ndof()).blame(4);
        }
        let modes = model.linear_modes(diameter, state)?;
        if wanted > modes.omega.len() {
            return fail!(
                Dimension,
                "count = {count}, but only {} modes have mass",
                modes.omega.len()
            )
            .blame(4);
        }
        unsafe {
            omega.copy_from(modes.omega.as_ptr(), wanted);
            if !shapes.is_null() {
                shapes.copy_from(modes.shapes.as_ptr().cast(), 2 * wanted * model.ndof());
            }
        }
        Ok(Status::Ok)
    })
}

fn contact_state(value: i32) -> Result<ContactState> {
    const FREE: i32 = hbvib_contact_state::HBVIB_CONTACTS_FREE as i32;
    const STUCK: i32 = hbvib_contact_state::HBVIB_CONTACTS_STUCK as i32;
    match value {
        FREE => Ok(ContactState::Free),
        STUCK => Ok(ContactState::Stuck),
        _ => fail!(
            Argument,
            "contacts = {value}, needs HBVIB_CONTACTS_FREE = 0 or HBVIB_CONTACTS_STUCK = 1"
        ),
    }
    .blame(3)
}
