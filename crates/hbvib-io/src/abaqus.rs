//! Matrices of Abaqus, `*MATRIX GENERATE` with `*MATRIX OUTPUT`: lines of row and column, each a node and a direction
//! (FORMAT=MATRIX INPUT) or an equation number (FORMAT=COORDINATE), and a value.
//!
//! A symmetric matrix comes as one triangle or as a whole; which of both is seen when all entries are known.

use crate::Result;
use crate::lines::Lines;
use crate::matrix::{Dof, Matrix, Symmetry};
use crate::numbers::{index, real, whole};
use std::collections::HashMap;

/// The matrix of a file, and its degrees of freedom in the order in which rows and columns name them first.
///
/// # Errors
/// The line and reason.
pub(crate) fn matrix(lines: &mut Lines) -> Result<(Matrix, Vec<Dof>)> {
    let mut matrix = Matrix::new(lines, (0, 0), Symmetry::General, (0, false))?;
    let mut dofs: Vec<Dof> = Vec::new();
    let mut numbers: HashMap<Dof, u32> = HashMap::new();
    let (mut fields, mut lower, mut upper) = (0, false, false);
    let most = (u32::MAX / 2) as usize;
    while lines.advance()? {
        let line = lines.text().trim();
        if line.is_empty() || line.starts_with("**") {
            continue;
        }
        if line.starts_with('*') {
            return lines.fail(format_args!("{line:?} is a keyword, needs entries of a matrix"));
        }
        let words: Vec<&str> = line.split([',', ' ', '\t']).filter(|word| !word.is_empty()).collect();
        if fields == 0 {
            fields = words.len();
        }
        if words.len() != fields || (fields != 3 && fields != 5) {
            return lines.fail(format_args!(
                "{} fields, needs 3 (row, column, value) or 5 (node and direction of row and column, value), as in all other lines",
                words.len()
            ));
        }
        let (row, column) = if fields == 3 {
            let [row, column] =
                [("row", words[0]), ("column", words[1])].map(|(what, word)| index(lines, Some(word), most, what));
            let (row, column) = (row?, column?);
            matrix.rows = matrix.rows.max(row.max(column) as usize + 1);
            (row, column)
        } else {
            let mut number = |node: &str, direction: &str| -> Result<u32> {
                let dof = (
                    whole(lines, Some(node), "node")?,
                    whole(lines, Some(direction), "direction")?,
                );
                if dof.1 < 1 {
                    return lines.fail(format_args!("direction = {}, needs at least 1", dof.1));
                }
                if let Some(number) = numbers.get(&dof) {
                    return Ok(*number);
                }
                if dofs.try_reserve(1).is_err() || numbers.try_reserve(1).is_err() {
                    return lines.fail("no memory for the degrees of freedom");
                }
                let number = dofs.len() as u32;
                numbers.insert(dof, number);
                dofs.push(dof);
                Ok(number)
            };
            (number(words[0], words[1])?, number(words[2], words[3])?)
        };
        lower |= row > column;
        upper |= row < column;
        let value = real(lines, Some(words[fields - 1]), "value")?;
        matrix.push(lines, row, column, (value, 0.0))?;
    }
    if fields == 0 {
        lines.expect("an entry")?;
    }
    if fields == 5 {
        matrix.rows = dofs.len();
    }
    // Checks the order against the size of the file.
    let empty = Matrix::new(lines, (matrix.rows, matrix.rows), Symmetry::General, (0, false))?;
    if fields == 5 {
        in_order(&mut matrix, &mut dofs);
    }
    let symmetric = if fields == 5 {
        !is_whole(&matrix)
    } else {
        !(lower && upper)
    };
    Ok((
        Matrix {
            columns: empty.columns,
            symmetry: if symmetric {
                Symmetry::Symmetric
            } else {
                Symmetry::General
            },
            ..matrix
        }
        .finished(),
        dofs,
    ))
}

/// Sorts the degrees of freedom by node and direction.
fn in_order(matrix: &mut Matrix, dofs: &mut [Dof]) {
    let mut order: Vec<u32> = (0..dofs.len() as u32).collect();
    order.sort_by_key(|&i| dofs[i as usize]);
    let mut new = vec![0; dofs.len()];
    for (to, &from) in order.iter().enumerate() {
        new[from as usize] = to as u32;
    }
    dofs.sort_unstable();
    for at in matrix.row.iter_mut().chain(&mut matrix.column) {
        *at = new[*at as usize];
    }
}

/// Whether some entry is listed at its place and at that of its mirror image.
fn is_whole(matrix: &Matrix) -> bool {
    let mut places: Vec<(u32, u32, bool)> = matrix
        .row
        .iter()
        .zip(&matrix.column)
        .filter(|(row, column)| row != column)
        .map(|(&row, &column)| (row.min(column), row.max(column), row < column))
        .collect();
    places.sort_unstable();
    places
        .windows(2)
        .any(|two| (two[0].0, two[0].1) == (two[1].0, two[1].1) && two[0].2 != two[1].2)
}
