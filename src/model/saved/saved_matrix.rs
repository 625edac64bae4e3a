//! Sparse matrices as bytes. Real ones are stored as such.

use crate::byte_stream::{ByteReader, ByteWriter};
use crate::error::{Result, try_push, try_vec};
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;
use crate::linalg::sparse_storage::sparse::{Columns, Csc};
use num_complex::Complex64;

const CONTEXT: &str = "a loaded matrix";

/// Marks of a matrix: none, one of real entries, one of complex entries.
/// Kind: fixed.
const NONE: u8 = 0;
const SAVED_MATRIX_REAL: u8 = 1;
const COMPLEX: u8 = 2;

/// Writes a matrix, or a mark that there is none.
pub(crate) fn save(matrix: Option<&KeptMatrix>, out: &mut ByteWriter<'_>) {
    let Some(a) = matrix else {
        out.u8(NONE);
        return;
    };
    let real = a.real_values();
    out.u8(if real.is_some() { SAVED_MATRIX_REAL } else { COMPLEX });
    out.count(a.stored());
    for length in a.lengths() {
        out.u32(length as u32);
    }
    for &row in a.rows() {
        out.u32(row);
    }
    match real {
        Some(values) => values.iter().for_each(|&v| out.f64(v)),
        None => (0..a.order()).flat_map(|j| a.column(j)).for_each(|(_, v)| {
            out.f64(v.re);
            out.f64(v.im);
        }),
    }
}

/// Reads a matrix of order n, or the mark that there is none.
///
/// # Errors
/// `Argument` where it is none of compressed sparse columns; `OutOfMemory`.
pub(crate) fn load(n: usize, input: &mut ByteReader<'_>) -> Result<Option<KeptMatrix>> {
    let real = match input.u8()? {
        NONE => return Ok(None),
        SAVED_MATRIX_REAL => true,
        COMPLEX => false,
        _ => return Err(input.damaged("a matrix is neither real nor complex")),
    };
    let entries = input.entries(if real { 12 } else { 20 })?;
    if n.checked_mul(4).is_none_or(|bytes| bytes > input.left()) {
        return Err(input.damaged("a matrix has fewer columns than degrees of freedom"));
    }
    let mut a = Csc {
        rows: n,
        cols: n,
        col_ptr: try_vec(n + 1, 0, CONTEXT)?,
        row_idx: try_vec(entries, 0, CONTEXT)?,
        values: try_vec(entries, Complex64::ZERO, CONTEXT)?,
    };
    for j in 0..n {
        // Fewer than 2³² × 2³² entries.
        a.col_ptr[j + 1] = a.col_ptr[j] + input.u32()? as usize;
    }
    if a.col_ptr[n] != entries {
        return Err(input.damaged("the columns of a matrix do not have its entries"));
    }
    for row in &mut a.row_idx {
        *row = input.u32()? as usize;
    }
    for column in a.col_ptr.windows(2) {
        let rows = &a.row_idx[column[0]..column[1]];
        if !rows.is_sorted_by(|a, b| a < b) || rows.last().is_some_and(|&last| last >= n) {
            return Err(input.damaged("rows of a matrix do not ascend within its order"));
        }
    }
    for v in &mut a.values {
        v.re = input.finite()?;
        if !real {
            v.im = input.finite()?;
        }
    }
    Ok(Some(KeptMatrix::new(a)?))
}

/// Writes a list of matrices some of which may be missing.
pub(crate) fn save_list(matrices: &[Option<KeptMatrix>], out: &mut ByteWriter<'_>) {
    out.count(matrices.len());
    for matrix in matrices {
        save(matrix.as_ref(), out);
    }
}

/// Reads a list of matrices whose length is one of `lengths`; it may be empty.
///
/// # Errors
/// As [`load`]; `Argument` for another length.
pub(crate) fn load_list(n: usize, lengths: [usize; 2], input: &mut ByteReader<'_>) -> Result<Vec<Option<KeptMatrix>>> {
    let count = input.entries(1)?;
    if count != 0 && !lengths.contains(&count) {
        return Err(input.damaged("the number of matrices is not that of the nodal diameters"));
    }
    let mut matrices = Vec::new();
    for _ in 0..count {
        try_push(&mut matrices, load(n, input)?, CONTEXT)?;
    }
    Ok(matrices)
}
