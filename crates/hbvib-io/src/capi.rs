//! The C interface, declared in `include/hbvib_io.h`.

use crate::matrix::{Dof, Matrices, Matrix, Symmetry};
use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

thread_local! {
    static LAST_ERROR: RefCell<CString> = RefCell::new(CString::default());
}

/// The matrices of a file, and the report on them.
pub struct HbvibIoFile {
    pub(crate) found: Matrices,
    facts: Vec<CString>,
    warnings: Vec<CString>,
}

impl HbvibIoFile {
    pub(crate) fn new(found: Matrices) -> Self {
        let report = crate::report(&found);
        let lines = |all: Vec<String>| all.into_iter().filter_map(|line| CString::new(line).ok()).collect();
        Self {
            facts: lines(report.facts),
            warnings: lines(report.warnings),
            found,
        }
    }
}

/// A matrix as the caller sees it; the arrays belong to the file.
#[repr(C)]
pub struct HbvibIoMatrix {
    pub(crate) rows: i64,
    pub(crate) columns: i64,
    pub(crate) entries: i64,
    pub(crate) is_complex: i32,
    pub(crate) symmetry: i32,
    pub(crate) row: *const u32,
    pub(crate) column: *const u32,
    pub(crate) values: *const f64,
}

pub(crate) const OK: i32 = 0;
const ABSENT: i32 = 1;
pub(crate) const FAILED: i32 = -1;

pub(crate) fn report(sentence: &str) -> i32 {
    LAST_ERROR.with(|last| *last.borrow_mut() = CString::new(sentence.replace('\0', " ")).unwrap_or_default());
    FAILED
}

/// Runs `body`; a panic becomes a status.
pub(crate) fn guarded(body: impl FnOnce() -> i32) -> i32 {
    catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|_| report("internal error: the reader panicked"))
}

/// The sentence of the last error of this thread.
#[unsafe(no_mangle)]
pub extern "C" fn hbvib_io_last_error() -> *const c_char {
    LAST_ERROR.with(|last| last.borrow().as_ptr())
}

/// Reads a file; `path` ends with a zero byte.
///
/// # Safety
/// `path` is NULL or such a string, `out` NULL or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_io_read(path: *const c_char, out: *mut *mut HbvibIoFile) -> i32 {
    guarded(|| {
        if path.is_null() || out.is_null() {
            return report("hbvib_io_read: path or out is NULL");
        }
        let bytes = unsafe { CStr::from_ptr(path) }.to_bytes();
        match crate::read(&path_of(bytes)) {
            Ok(matrices) => {
                unsafe { out.write(Box::into_raw(Box::new(HbvibIoFile::new(matrices)))) };
                OK
            }
            Err(error) => report(&error.to_string()),
        }
    })
}

/// Reads the matrices of one model from several files; a path may be NULL.
///
/// # Safety
/// Paths are NULL or end with a zero byte; `out` is NULL or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_io_read_files(
    matrices: *const c_char,
    stiffness: *const c_char,
    mass: *const c_char,
    damping: *const c_char,
    structural: *const c_char,
    out: *mut *mut HbvibIoFile,
) -> i32 {
    guarded(|| {
        if out.is_null() {
            return report("hbvib_io_read_files: out is NULL");
        }
        let paths = [matrices, stiffness, mass, damping, structural]
            .map(|path| (!path.is_null()).then(|| path_of(unsafe { CStr::from_ptr(path) }.to_bytes())));
        if paths.iter().all(Option::is_none) {
            return report("hbvib_io_read_files: names no file");
        }
        let [matrices, stiffness, mass, damping, structural] = paths.each_ref().map(Option::as_deref);
        let files = crate::Files {
            matrices,
            stiffness,
            mass,
            damping,
            structural,
        };
        match crate::read_files(&files) {
            Ok(matrices) => {
                unsafe { out.write(Box::into_raw(Box::new(HbvibIoFile::new(matrices)))) };
                OK
            }
            Err(error) => report(&error.to_string()),
        }
    })
}

/// A line of the report on a file: totals, or warnings; NULL past the last one.
///
/// # Safety
/// `file` is NULL or comes from [`hbvib_io_read`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_io_report_line(file: *const HbvibIoFile, warnings: i32, index: i64) -> *const c_char {
    let lines = unsafe { file.as_ref() }.map(|file| if warnings == 0 { &file.facts } else { &file.warnings });
    let line = lines.and_then(|lines| lines.get(usize::try_from(index).ok()?));
    line.map_or(core::ptr::null(), |line| line.as_ptr())
}

#[cfg(unix)]
pub(crate) fn path_of(bytes: &[u8]) -> PathBuf {
    use std::os::unix::ffi::OsStrExt;
    PathBuf::from(std::ffi::OsStr::from_bytes(bytes))
}

#[cfg(not(unix))]
pub(crate) fn path_of(bytes: &[u8]) -> PathBuf {
    PathBuf::from(String::from_utf8_lossy(bytes).into_owned())
}

/// Fills `out` with the mass (0), damping (1), stiffness (2) or structural damping (3) of a file; 1 if there is none.
///
/// # Safety
/// `file` is NULL or comes from [`hbvib_io_read`], `out` NULL or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_io_matrix_of(file: *const HbvibIoFile, which: i32, out: *mut HbvibIoMatrix) -> i32 {
    guarded(|| {
        let Some(HbvibIoFile { found, .. }) = (unsafe { file.as_ref() }) else {
            return report("hbvib_io_matrix_of: file is NULL");
        };
        if out.is_null() {
            return report("hbvib_io_matrix_of: out is NULL");
        }
        let matrix = match which {
            0 => &found.mass,
            1 => &found.damping,
            2 => &found.stiffness,
            3 => &found.structural,
            _ => {
                return report(
                    "hbvib_io_matrix_of: which needs 0 (mass), 1 (damping), 2 (stiffness) or 3 (structural damping)",
                );
            }
        };
        let Some(matrix) = matrix else { return ABSENT };
        unsafe { out.write(view(matrix)) };
        OK
    })
}

fn view(matrix: &Matrix) -> HbvibIoMatrix {
    HbvibIoMatrix {
        rows: matrix.rows as i64,
        columns: matrix.columns as i64,
        entries: matrix.entries() as i64,
        is_complex: i32::from(matrix.is_complex),
        symmetry: match matrix.symmetry {
            Symmetry::General => 0,
            Symmetry::Symmetric => 1,
            Symmetry::Hermitian => 2,
            Symmetry::Skew => 3,
        },
        row: matrix.row.as_ptr(),
        column: matrix.column.as_ptr(),
        values: matrix.values.as_ptr(),
    }
}

/// Number of degrees of freedom that the file names.
///
/// # Safety
/// `file` is NULL or comes from [`hbvib_io_read`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_io_dofs(file: *const HbvibIoFile) -> i64 {
    unsafe { file.as_ref() }.map_or(-1, |file| file.found.dofs.len() as i64)
}

/// Copies node and direction of each degree of freedom, two numbers each.
///
/// # Safety
/// `file` is NULL or comes from [`hbvib_io_read`]; `table` has room for 2 [`hbvib_io_dofs`] numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_io_dof_table(file: *const HbvibIoFile, table: *mut i64) -> i32 {
    let Some(file) = (unsafe { file.as_ref() }) else {
        return report("hbvib_io_dof_table: file is NULL");
    };
    if table.is_null() {
        return report("hbvib_io_dof_table: table is NULL");
    }
    let dofs: &[Dof] = &file.found.dofs;
    for (i, (node, direction)) in dofs.iter().enumerate() {
        unsafe {
            table.add(2 * i).write(*node);
            table.add(2 * i + 1).write(*direction);
        }
    }
    OK
}

/// Frees a file; NULL does nothing.
///
/// # Safety
/// `file` is NULL or comes from [`hbvib_io_read`], once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_io_free(file: *mut HbvibIoFile) {
    if !file.is_null() {
        drop(unsafe { Box::from_raw(file) });
    }
}
