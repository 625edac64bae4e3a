//! Section "Matrices" of the header: the matrix view of the caller, checked and turned into that of
//! the library.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::input;
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_reserved, init, load};
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, fail};
use crate::linalg::sparse_storage::matrix_view::{MatrixView, Part, Storage, Values};
use crate::model::matrices::structure::MatrixKind;
use core::ptr;

/// Layouts of a matrix view.
#[repr(C)]
pub enum hbvib_storage {
    /// Dense, column after column (Fortran, MATLAB).
    HBVIB_COL_MAJOR = 0,
    /// Dense, row after row (C, numpy).
    HBVIB_ROW_MAJOR = 1,
    /// Compressed sparse columns; duplicates are summed.
    HBVIB_CSC = 2,
}

/// Kinds of numbers in a view.
#[repr(C)]
pub enum hbvib_scalar {
    /// One double each.
    HBVIB_REAL = 0,
    /// Two doubles each, (re, im).
    HBVIB_COMPLEX = 1,
}

/// The part of a matrix that is given, and the symmetry that the caller promises.
#[repr(C)]
pub enum hbvib_part {
    /// All of a symmetric or Hermitian matrix; the symmetry is checked.
    HBVIB_FULL = 0,
    /// The lower triangle of a symmetric or Hermitian matrix; the upper one is not read.
    HBVIB_LOWER = 1,
    /// The upper triangle of a symmetric or Hermitian matrix; the lower one is not read.
    HBVIB_UPPER = 2,
    /// All of any matrix.
    HBVIB_GENERAL = 3,
    /// All of a matrix with A = A^T, real or complex; the symmetry is checked.
    HBVIB_SYMMETRIC = 4,
    /// The lower triangle of a matrix with A = A^T, real or complex; the upper one is not read.
    HBVIB_SYMMETRIC_LOWER = 5,
    /// The upper triangle of a matrix with A = A^T, real or complex; the lower one is not read.
    HBVIB_SYMMETRIC_UPPER = 6,
}

/// A matrix of the caller, read during the call and never kept. Fill it by hbvib_matrix_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_matrix {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// HBVIB_COL_MAJOR, HBVIB_ROW_MAJOR or HBVIB_CSC.
    pub storage: i32,
    /// HBVIB_REAL or HBVIB_COMPLEX.
    pub scalar: i32,
    /// HBVIB_FULL .. HBVIB_SYMMETRIC_UPPER.
    pub part: i32,
    /// Number of rows.
    pub rows: i64,
    /// Number of columns.
    pub cols: i64,
    /// Dense: distance of columns (rows, if row-major) in numbers; 0 = packed.
    pub ld: i64,
    /// The numbers: ld * (cols - 1) + rows of them if column-major, the last entry of col_ptr less
    /// index_base if sparse; each is two doubles if complex.
    pub values: *const f64,
    /// Sparse only: cols + 1 offsets, the first equal to index_base.
    pub col_ptr: *const i64,
    /// Sparse only: row of each number, counted from index_base.
    pub row_idx: *const i64,
    /// 0 or 1: base of the sparse indices, and of the indices in error sentences.
    pub index_base: i32,
    /// Must be 0.
    pub reserved: i32,
}

unsafe impl VersionedStruct for hbvib_matrix {
    const NAME: &'static str = "hbvib_matrix";
    const FIRST_SIZE: usize = 72;

    fn defaults() -> Self {
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

/// The matrices of a structure.
#[repr(C)]
pub enum hbvib_matrix_kind {
    /// M
    HBVIB_MASS = 0,
    /// C
    HBVIB_DAMPING = 1,
    /// K
    HBVIB_STIFFNESS = 2,
    /// D of the structural damping iD in harmonics above 0; positive dissipates.
    HBVIB_STRUCTURAL = 3,
    /// G of the gyroscopic forces Omega G x', skew-symmetric: G = -G^T.
    HBVIB_GYROSCOPIC = 4,
    /// K1 of the stiffness K + Omega^2 K1 at speed; that of softening is negative.
    HBVIB_STIFFNESS_SPEED2 = 5,
}

const COL_MAJOR: i32 = hbvib_storage::HBVIB_COL_MAJOR as i32;
const ROW_MAJOR: i32 = hbvib_storage::HBVIB_ROW_MAJOR as i32;
const CSC: i32 = hbvib_storage::HBVIB_CSC as i32;

/// One of the matrices by its number.
pub(crate) fn matrix_kind(which: i32) -> Result<MatrixKind> {
    const MASS: i32 = hbvib_matrix_kind::HBVIB_MASS as i32;
    const DAMPING: i32 = hbvib_matrix_kind::HBVIB_DAMPING as i32;
    const STIFFNESS: i32 = hbvib_matrix_kind::HBVIB_STIFFNESS as i32;
    const STRUCTURAL: i32 = hbvib_matrix_kind::HBVIB_STRUCTURAL as i32;
    const GYROSCOPIC: i32 = hbvib_matrix_kind::HBVIB_GYROSCOPIC as i32;
    const STIFFNESS_SPEED2: i32 = hbvib_matrix_kind::HBVIB_STIFFNESS_SPEED2 as i32;
    match which {
        MASS => Ok(MatrixKind::Mass),
        DAMPING => Ok(MatrixKind::Damping),
        STIFFNESS => Ok(MatrixKind::Stiffness),
        STRUCTURAL => Ok(MatrixKind::Structural),
        GYROSCOPIC => Ok(MatrixKind::Gyroscopic),
        STIFFNESS_SPEED2 => Ok(MatrixKind::StiffnessSpeed2),
        _ => fail!(
            Argument,
            "which = {which}, needs HBVIB_MASS = 0 .. HBVIB_STIFFNESS_SPEED2 = 5"
        ),
    }
    .with_argument(2)
}

fn part(value: i32) -> Result<Part> {
    const FULL: i32 = hbvib_part::HBVIB_FULL as i32;
    const LOWER: i32 = hbvib_part::HBVIB_LOWER as i32;
    const UPPER: i32 = hbvib_part::HBVIB_UPPER as i32;
    const GENERAL: i32 = hbvib_part::HBVIB_GENERAL as i32;
    const SYMMETRIC: i32 = hbvib_part::HBVIB_SYMMETRIC as i32;
    const SYMMETRIC_LOWER: i32 = hbvib_part::HBVIB_SYMMETRIC_LOWER as i32;
    const SYMMETRIC_UPPER: i32 = hbvib_part::HBVIB_SYMMETRIC_UPPER as i32;
    match value {
        FULL => Ok(Part::Full),
        LOWER => Ok(Part::Lower),
        UPPER => Ok(Part::Upper),
        GENERAL => Ok(Part::General),
        SYMMETRIC => Ok(Part::Symmetric),
        SYMMETRIC_LOWER => Ok(Part::SymmetricLower),
        SYMMETRIC_UPPER => Ok(Part::SymmetricUpper),
        _ => fail!(
            Argument,
            "hbvib_matrix: part = {value}, needs HBVIB_FULL = 0 .. HBVIB_SYMMETRIC_UPPER = 6"
        ),
    }
}

/// Passes the matrix at `p`, of order `n`, to `then`; errors carry the number `argument`, and `name` is that of the matrix.
///
/// # Safety
/// The caller of the C function states that the arrays of the view have the lengths that it contains.
pub(crate) unsafe fn with_matrix<T>(
    p: *const hbvib_matrix,
    (name, argument): (&str, i32),
    n: usize,
    then: impl FnOnce(&MatrixView<'_>) -> Result<T>,
) -> Result<T> {
    let a = unsafe { load(p, argument) }?;
    let view = unsafe { matrix_view(&a, (name, n), argument) }.with_argument(argument)?;
    then(&view).with_argument(argument)
}

/// The view of a description, whose arrays belong to the caller.
///
/// # Safety
/// As for [`with_matrix`].
pub(crate) unsafe fn matrix_view<'a>(
    a: &hbvib_matrix,
    (name, n): (&str, usize),
    argument: i32,
) -> Result<MatrixView<'a>> {
    const NAME: &str = "hbvib_matrix: values";
    check_reserved(a.reserved, argument, "hbvib_matrix")?;
    if usize::try_from(a.rows) != Ok(n) || usize::try_from(a.cols) != Ok(n) {
        return fail!(
            Dimension,
            "{name} is {} x {}, needs {n} x {n}: the model has {n} degrees of freedom (ndof)",
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
            // The model refuses inconsistent offsets, with their place, before it reads an entry.
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
