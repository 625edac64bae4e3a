//! Matrices of Abaqus, `*MATRIX GENERATE` with `*MATRIX OUTPUT`: lines of row and column, each a node and a direction
//! (FORMAT=MATRIX INPUT) or an equation number (FORMAT=COORDINATE), and a value. Internal nodes of elements have negative
//! labels, in either form.
//!
//! A symmetric matrix comes as one triangle or as a whole; which of both is seen when all entries are known.

use crate::Result;
use crate::lines::Lines;
use crate::matrix::{Dof, Matrix, Symmetry};
use crate::numbered::Numbered;
use crate::numbers::{real, whole};

/// A first line of three whole numbers, which may be the sizes of a file without its banner.
struct FirstLine {
    line: usize,
    numbers: [i64; 3],
}

impl FirstLine {
    fn of(lines: &Lines, words: &[&str]) -> Option<Self> {
        let [a, b, c] = words else { return None };
        let numbers = [a.parse().ok()?, b.parse().ok()?, c.parse().ok()?];
        Some(Self {
            line: lines.number(),
            numbers,
        })
    }

    /// Sizes are no less than all rows and columns, and their last number is that of entries, or unlike values, which have
    /// points.
    fn is_sizes(&self, matrix: &Matrix, pointed: bool) -> bool {
        let most = |places: &[u32]| {
            places
                .iter()
                .skip(1)
                .map(|bits| bits.cast_signed())
                .max()
                .unwrap_or(i32::MAX)
        };
        let [rows, columns, last] = self.numbers;
        rows >= i64::from(most(&matrix.row))
            && columns >= i64::from(most(&matrix.column))
            && (pointed || last == matrix.entries() as i64 - 1)
    }
}

/// The matrix of a file, and its degrees of freedom, sorted by node and direction. The direction is 0 for labels without one.
///
/// # Errors
/// The line and reason.
pub(crate) fn matrix(lines: &mut Lines) -> Result<(Matrix, Vec<Dof>)> {
    let mut matrix = Matrix::new(lines, (0, 0), Symmetry::General, (0, false))?;
    let mut numbered = Numbered::default();
    let (mut fields, mut pointed) = (0, false);
    let mut sizes: Option<FirstLine> = None;
    while lines.advance()? {
        let line = lines.text().trim();
        if line.is_empty() || line.starts_with("**") {
            continue;
        }
        if line.starts_with('*') {
            return lines.fail(format_args!("{line:?} is a keyword, needs entries of a matrix"));
        }
        if lines.is_unended() && line.ends_with(',') {
            return lines.fail("the file ends before the value of an entry");
        }
        let words: Vec<&str> = line.split([',', ' ', '\t']).filter(|word| !word.is_empty()).collect();
        if fields == 0 {
            fields = words.len();
            sizes = FirstLine::of(lines, &words);
        }
        if words.len() != fields || (fields != 3 && fields != 5) {
            return lines.fail(format_args!(
                "{} fields, needs 3 (row, column, value) or 5 (node and direction of row and column, value), as in all other lines",
                words.len()
            ));
        }
        let (row, column) = if fields == 3 {
            (label(lines, words[0], "row")?, label(lines, words[1], "column")?)
        } else {
            let mut number = |node: &str, direction: &str| {
                let dof = node_and_direction(lines, node, direction)?;
                numbered.number(lines, dof)
            };
            (number(words[0], words[1])?, number(words[2], words[3])?)
        };
        pointed |= words[fields - 1].contains(['.', 'e', 'E', 'd', 'D']);
        let value = real(lines, Some(words[fields - 1]), "value")?;
        matrix.push(lines, row, column, (value, 0.0))?;
    }
    if fields == 0 {
        lines.expect("an entry")?;
    }
    if let Some(first) = sizes.filter(|first| fields == 3 && first.is_sizes(&matrix, pointed)) {
        return lines.fail_at(
            first.line,
            "three whole numbers, as the sizes of a Matrix Market file: the first line needs its banner, %%MatrixMarket \
             matrix coordinate real symmetric (or general)",
        );
    }
    lines.refuse_cut_number()?;
    let dofs = if fields == 5 {
        let all = vec![true; numbered.len()];
        let (dofs, places) = numbered.sorted(&all);
        for at in matrix.row.iter_mut().chain(&mut matrix.column) {
            *at = places[*at as usize];
        }
        matrix.rows = dofs.len();
        dofs
    } else {
        from_labels(lines, &mut matrix)?
    };
    // Checks the order against the size of the file.
    let empty = Matrix::new(lines, (matrix.rows, matrix.rows), Symmetry::General, (0, false))?;
    let below = |(row, column): (&u32, &u32)| row > column;
    let above = |(row, column): (&u32, &u32)| row < column;
    let places = || matrix.row.iter().zip(&matrix.column);
    let symmetric = if dofs.is_empty() {
        !(places().any(below) && places().any(above))
    } else {
        !matrix.lists_mirror_images()
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

/// An equation number, or the label of an internal degree of freedom below zero, as the bits of a signed number.
fn label(lines: &Lines, word: &str, what: &str) -> Result<u32> {
    match whole(lines, Some(word), what)? {
        0 => lines.fail(format_args!("{what} = 0, needs a number from 1, or a label below 0")),
        label => match i32::try_from(label) {
            Ok(label) => Ok(label.cast_unsigned()),
            Err(_) => lines.fail(format_args!("{what} = {label}, needs at most {}", i32::MAX)),
        },
    }
}

/// Turns labels into rows from 0. Equation numbers are rows; where a label lies below zero, labels are names with gaps, and are
/// returned in order.
fn from_labels(lines: &Lines, matrix: &mut Matrix) -> Result<Vec<Dof>> {
    let places = || matrix.row.iter().chain(&matrix.column).map(|bits| bits.cast_signed());
    if places().all(|label| label > 0) {
        matrix.rows = places().max().unwrap_or(0) as usize;
        for at in matrix.row.iter_mut().chain(&mut matrix.column) {
            *at -= 1;
        }
        return Ok(Vec::new());
    }
    let mut labels: Vec<i32> = Vec::new();
    if labels.try_reserve_exact(2 * matrix.entries()).is_err() {
        return lines.fail("no memory for the labels");
    }
    labels.extend(places());
    labels.sort_unstable();
    labels.dedup();
    matrix.rows = labels.len();
    for at in matrix.row.iter_mut().chain(&mut matrix.column) {
        *at = labels.partition_point(|label| *label < at.cast_signed()) as u32;
    }
    Ok(labels.into_iter().map(|label| (i64::from(label), 0)).collect())
}

fn node_and_direction(lines: &Lines, node: &str, direction: &str) -> Result<Dof> {
    let dof = (
        whole(lines, Some(node), "node")?,
        whole(lines, Some(direction), "direction")?,
    );
    if dof.1 < 1 {
        return lines.fail(format_args!("direction = {}, needs at least 1", dof.1));
    }
    Ok(dof)
}
