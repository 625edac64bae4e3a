//! Writes a Matrix Market file: coordinates, of a symmetric matrix the lower triangle, numbers to the last bit.

use crate::Result;
use crate::columns::Columns;
use crate::matrix::{Matrix, Symmetry};
use crate::output_file::{OutputFile, check};
use std::path::Path;

/// Writes one matrix as a Matrix Market file.
///
/// # Errors
/// Numbers that are not finite; the reason of the system.
pub fn write_matrix_market(path: &Path, matrix: &Matrix) -> Result<()> {
    check(path, "the matrix", matrix)?;
    let columns = Columns::listed(matrix);
    let field = if matrix.is_complex { "complex" } else { "real" };
    let symmetry = match matrix.symmetry {
        Symmetry::General => "general",
        Symmetry::Symmetric => "symmetric",
        Symmetry::Hermitian => "hermitian",
        Symmetry::Skew => "skew-symmetric",
    };
    let mut file = OutputFile::create(path)?;
    let (rows, count) = (matrix.rows, columns.entries());
    file.put(format!(
        "%%MatrixMarket matrix coordinate {field} {symmetry}\n{rows} {} {count}\n",
        matrix.columns
    ))?;
    for column in 0..matrix.columns {
        for &(row, re, im) in columns.column(column) {
            let place = (row + 1, column + 1);
            file.put(if matrix.is_complex {
                format!("{} {} {re:e} {im:e}\n", place.0, place.1)
            } else {
                format!("{} {} {re:e}\n", place.0, place.1)
            })?;
        }
    }
    file.finish()
}
