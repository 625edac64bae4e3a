//! The C interface of the writers, declared in `include/hbvib_io.h`.

use crate::capi::{FAILED, HbvibIoFile, HbvibIoMatrix, OK, guarded, path_of, report};
use crate::matrix::{Matrices, Matrix, Symmetry};
use crate::universal::{Universal, UniversalNode};
use crate::universal_data::{Function, Shape};
use crate::write::Format;
use std::ffi::{CStr, c_char};

/// Results of nodes that are gathered for a file.
pub struct HbvibIoResults(Universal);

/// Numbers of the caller; empty for none of them.
///
/// # Safety
/// `at` is NULL or has so many numbers.
unsafe fn numbers<'a, T>(at: *const T, count: usize) -> Option<&'a [T]> {
    match (at.is_null(), count) {
        (_, 0) => Some(&[]),
        (true, _) => None,
        (false, _) => Some(unsafe { core::slice::from_raw_parts(at, count) }),
    }
}

/// A copy; `None` without memory.
fn copied<T: Copy>(from: &[T]) -> Option<Vec<T>> {
    let mut to = Vec::new();
    to.try_reserve_exact(from.len()).ok()?;
    to.extend_from_slice(from);
    Some(to)
}

/// Pairs of numbers; `None` without memory.
fn pairs(from: &[f64]) -> Option<Vec<(f64, f64)>> {
    let mut to = Vec::new();
    to.try_reserve_exact(from.len() / 2).ok()?;
    to.extend(from.chunks_exact(2).map(|two| (two[0], two[1])));
    Some(to)
}

/// Text of the caller; empty for NULL.
///
/// # Safety
/// `text` is NULL or ends with a zero byte.
unsafe fn text_of(text: *const c_char) -> String {
    if text.is_null() {
        return String::new();
    }
    unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
}

/// Matrices without any, to be set and written.
///
/// # Safety
/// `out` is NULL or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_io_new(out: *mut *mut HbvibIoFile) -> i32 {
    guarded(|| {
        if out.is_null() {
            return report("hbvib_io_new: out is NULL");
        }
        unsafe { out.write(Box::into_raw(Box::new(HbvibIoFile::new(Matrices::default())))) };
        OK
    })
}

/// Copies a matrix into a file, in place of the one that is there.
///
/// # Safety
/// `file` is NULL or comes from this library, `matrix` NULL or one whose arrays have so many entries.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_io_set_matrix(file: *mut HbvibIoFile, which: i32, matrix: *const HbvibIoMatrix) -> i32 {
    guarded(|| {
        let (Some(file), Some(given)) = (unsafe { file.as_mut() }, unsafe { matrix.as_ref() }) else {
            return report("hbvib_io_set_matrix: file or matrix is NULL");
        };
        let place = match which {
            0 => &mut file.found.mass,
            1 => &mut file.found.damping,
            2 => &mut file.found.stiffness,
            3 => &mut file.found.structural,
            _ => {
                return report(
                    "hbvib_io_set_matrix: which needs 0 (mass), 1 (damping), 2 (stiffness) or 3 (structural damping)",
                );
            }
        };
        match unsafe { matrix_of(given) } {
            Ok(matrix) => {
                *place = Some(matrix);
                OK
            }
            Err(e) => report(&format!("hbvib_io_set_matrix: {e}")),
        }
    })
}

/// A copy of a matrix of the caller.
///
/// # Safety
/// Its arrays have so many entries.
unsafe fn matrix_of(given: &HbvibIoMatrix) -> Result<Matrix, &'static str> {
    let size = |n: i64| usize::try_from(n).ok().filter(|n| *n <= 1 << 31);
    let entries = usize::try_from(given.entries).ok().filter(|n| *n <= usize::MAX / 32);
    let (Some(rows), Some(columns), Some(entries)) = (size(given.rows), size(given.columns), entries) else {
        return Err("rows, columns or entries are out of range");
    };
    let symmetry = match given.symmetry {
        0 => Symmetry::General,
        1 => Symmetry::Symmetric,
        2 => Symmetry::Hermitian,
        3 => Symmetry::Skew,
        _ => return Err("symmetry needs 0 (general), 1 (symmetric), 2 (Hermitian) or 3 (skew)"),
    };
    let is_complex = given.is_complex != 0;
    let parts = if is_complex { 2 } else { 1 };
    let arrays = unsafe {
        (
            numbers(given.row, entries),
            numbers(given.column, entries),
            numbers(given.values, parts * entries),
        )
    };
    let (Some(row), Some(column), Some(values)) = arrays else {
        return Err("row, column or values is NULL");
    };
    if row.iter().any(|i| *i as usize >= rows) || column.iter().any(|j| *j as usize >= columns) {
        return Err("an entry is outside of the matrix");
    }
    if !values.iter().all(|v| v.is_finite()) {
        return Err("values need to be finite");
    }
    match (copied(row), copied(column), copied(values)) {
        (Some(row), Some(column), Some(values)) => Ok(Matrix {
            rows,
            columns,
            symmetry,
            row,
            column,
            values,
            is_complex,
        }),
        _ => Err("no memory for the entries"),
    }
}

/// Copies node and direction of each degree of freedom into a file.
///
/// # Safety
/// `file` is NULL or comes from this library; `table` has 2 `count` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_io_set_dofs(file: *mut HbvibIoFile, count: i64, table: *const i64) -> i32 {
    guarded(|| {
        let Some(file) = (unsafe { file.as_mut() }) else {
            return report("hbvib_io_set_dofs: file is NULL");
        };
        let Some(count) = usize::try_from(count).ok().filter(|n| *n <= usize::MAX / 32) else {
            return report("hbvib_io_set_dofs: count is out of range");
        };
        let Some(table) = (unsafe { numbers(table, 2 * count) }) else {
            return report("hbvib_io_set_dofs: table is NULL");
        };
        let mut dofs = Vec::new();
        if dofs.try_reserve_exact(count).is_err() {
            return report("hbvib_io_set_dofs: no memory");
        }
        dofs.extend(table.chunks_exact(2).map(|two| (two[0], two[1])));
        file.found.dofs = dofs;
        OK
    })
}

/// Writes the matrices of a file in a format, or in that of the name for NULL.
///
/// # Safety
/// `file` is NULL or comes from this library; `path` and `format` are NULL or end with a zero byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_io_write(file: *const HbvibIoFile, path: *const c_char, format: *const c_char) -> i32 {
    guarded(|| {
        let Some(file) = (unsafe { file.as_ref() }) else {
            return report("hbvib_io_write: file is NULL");
        };
        if path.is_null() {
            return report("hbvib_io_write: path is NULL");
        }
        let path = path_of(unsafe { CStr::from_ptr(path) }.to_bytes());
        let found = if format.is_null() {
            Format::of_path(&path)
        } else {
            let name = unsafe { text_of(format) };
            let known = Format::NAMES.into_iter().find(|(known, _)| *known == name);
            known.map(|(_, format)| format)
        };
        let Some(format) = found else {
            let known = Format::NAMES.map(|(name, _)| name).join(", ");
            return report(&format!(
                "hbvib_io_write: {}: format needs one of {known}",
                path.display()
            ));
        };
        written(crate::write(&path, &file.found, format).map(|_| ()))
    })
}

fn written(outcome: crate::Result<()>) -> i32 {
    match outcome {
        Ok(()) => OK,
        Err(e) => {
            report(&e.to_string());
            FAILED
        }
    }
}

/// Results without any, of nodes with positions or, for NULL, without.
///
/// # Safety
/// `nodes` has `count` numbers, `positions` is NULL or has 3 `count`; `out` is NULL or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_io_results_new(
    count: i64,
    nodes: *const i64,
    positions: *const f64,
    out: *mut *mut HbvibIoResults,
) -> i32 {
    guarded(|| {
        if out.is_null() {
            return report("hbvib_io_results_new: out is NULL");
        }
        let Some(count) = usize::try_from(count).ok().filter(|n| *n <= usize::MAX / 64) else {
            return report("hbvib_io_results_new: count is out of range");
        };
        let Some(numbers_of) = (unsafe { numbers(nodes, count) }) else {
            return report("hbvib_io_results_new: nodes is NULL");
        };
        let mut all = Universal::default();
        if !positions.is_null() {
            let Some(at) = (unsafe { numbers(positions, 3 * count) }) else {
                return report("hbvib_io_results_new: positions is NULL");
            };
            if all.nodes.try_reserve_exact(count).is_err() {
                return report("hbvib_io_results_new: no memory");
            }
            let pairs = numbers_of.iter().zip(at.chunks_exact(3));
            all.nodes.extend(pairs.map(|(number, at)| UniversalNode {
                number: *number,
                position: [at[0], at[1], at[2]],
            }));
        }
        unsafe { out.write(Box::into_raw(Box::new(HbvibIoResults(all)))) };
        OK
    })
}

/// Adds complex motions of nodes at a frequency.
///
/// # Safety
/// `results` is NULL or comes from [`hbvib_io_results_new`]; `text` is NULL or ends with a zero byte; `nodes` has `count` numbers,
/// `values` 6 `count`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_io_results_add_shape(
    results: *mut HbvibIoResults,
    text: *const c_char,
    frequency: f64,
    count: i64,
    nodes: *const i64,
    values: *const f64,
) -> i32 {
    guarded(|| {
        let Some(results) = (unsafe { results.as_mut() }) else {
            return report("hbvib_io_results_add_shape: results is NULL");
        };
        let Some(count) = usize::try_from(count).ok().filter(|n| *n <= usize::MAX / 64) else {
            return report("hbvib_io_results_add_shape: count is out of range");
        };
        let (Some(nodes), Some(values)) = (unsafe { (numbers(nodes, count), numbers(values, 6 * count)) }) else {
            return report("hbvib_io_results_add_shape: nodes or values is NULL");
        };
        let (Some(nodes), Some(values)) = (copied(nodes), pairs(values)) else {
            return report("hbvib_io_results_add_shape: no memory");
        };
        results.0.shapes.push(Shape {
            text: vec![unsafe { text_of(text) }],
            analysis: 5,
            integers: vec![1, results.0.shapes.len() as i64 + 1],
            reals: vec![frequency],
            nodes,
            per_node: 3,
            values,
        });
        OK
    })
}

/// Adds a complex function over frequency at a node and direction.
///
/// # Safety
/// As [`hbvib_io_results_add_shape`], with `count` frequencies and 2 `count` values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_io_results_add_function(
    results: *mut HbvibIoResults,
    text: *const c_char,
    node: i64,
    direction: i64,
    count: i64,
    frequencies: *const f64,
    values: *const f64,
) -> i32 {
    guarded(|| {
        let Some(results) = (unsafe { results.as_mut() }) else {
            return report("hbvib_io_results_add_function: results is NULL");
        };
        let Some(count) = usize::try_from(count).ok().filter(|n| *n <= usize::MAX / 64) else {
            return report("hbvib_io_results_add_function: count is out of range");
        };
        let (Some(at), Some(values)) = (unsafe { (numbers(frequencies, count), numbers(values, 2 * count)) }) else {
            return report("hbvib_io_results_add_function: frequencies or values is NULL");
        };
        let (Some(abscissa), Some(values)) = (copied(at), pairs(values)) else {
            return report("hbvib_io_results_add_function: no memory");
        };
        results.0.functions.push(Function {
            text: vec![unsafe { text_of(text) }],
            kind: 12,
            response: (node, direction),
            reference: (0, 0),
            quantity: 8,
            abscissa,
            values,
        });
        OK
    })
}

/// Writes results as a universal file.
///
/// # Safety
/// `results` is NULL or comes from [`hbvib_io_results_new`]; `path` is NULL or ends with a zero byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_io_results_write(results: *const HbvibIoResults, path: *const c_char) -> i32 {
    guarded(|| {
        let Some(results) = (unsafe { results.as_ref() }) else {
            return report("hbvib_io_results_write: results is NULL");
        };
        if path.is_null() {
            return report("hbvib_io_results_write: path is NULL");
        }
        let path = path_of(unsafe { CStr::from_ptr(path) }.to_bytes());
        written(crate::write_universal(&path, &results.0))
    })
}

/// Frees results; NULL does nothing.
///
/// # Safety
/// `results` is NULL or comes from [`hbvib_io_results_new`], once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_io_results_free(results: *mut HbvibIoResults) {
    if !results.is_null() {
        drop(unsafe { Box::from_raw(results) });
    }
}
