//! Nastran OP4 text files (`ASSIGN OUTPUT4 ... FORMATTED`): dense columns, strings, and strings of large matrices.
//!
//! Matrices whose names begin with K, M and B are stiffness, mass and damping, K4 is structural damping.

use crate::Result;
use crate::harwell_boeing::{Fields, field, fields};
use crate::lines::Lines;
use crate::matrix::{Matrices, Matrix, Symmetry};
use crate::numbers::{real, whole};
use crate::op4_parts::Parts;

/// Widths of the four numbers of a head, and the place of the name: large models have sizes of 16 columns.
const LAYOUTS: [([usize; 5], usize); 2] = [([0, 8, 16, 24, 32], 32), ([0, 16, 32, 40, 48], 48)];

/// The layout of a line that may be the head of a matrix: four whole numbers, and a name.
fn layout(line: &str) -> Option<([usize; 5], usize)> {
    LAYOUTS.into_iter().find(|(starts, name)| {
        starts.windows(2).all(|at| {
            let number = line.get(at[0]..at[1]);
            number.is_some_and(|text| text.trim().parse::<i64>().is_ok())
        }) && line
            .get(*name..name + 1)
            .is_some_and(|c| c.bytes().all(|b| b.is_ascii_alphabetic()))
    })
}

/// Whether a line may be the head of a matrix.
pub(crate) fn is_head(line: &str) -> bool {
    layout(line).is_some()
}

/// The matrices of a file whose first line is the present one.
///
/// # Errors
/// The line and reason.
pub(crate) fn matrices(lines: &mut Lines) -> Result<Matrices> {
    let mut parts = Parts::default();
    lines.repeat();
    while lines.advance()? {
        if lines.text().trim().is_empty() {
            continue;
        }
        let head = head(lines)?;
        let matrix = body(lines, &head)?;
        parts.take(head.name, matrix);
    }
    parts.finished().or_else(|reason| lines.fail(reason))
}

struct Head {
    columns: usize,
    rows: usize,
    /// Strings have their row in a number of its own.
    large: bool,
    is_complex: bool,
    /// Words of a number of the type.
    words: usize,
    name: String,
    fields: Fields,
}

fn head(lines: &Lines) -> Result<Head> {
    let (starts, name_at) = layout(lines.text()).unwrap_or(LAYOUTS[0]);
    let number = |i: usize, what: &str| whole(lines, lines.text().get(starts[i]..starts[i + 1]), what);
    let (columns, rows) = (number(0, "columns")?, number(1, "rows")?);
    let _form = number(2, "form")?;
    let (is_complex, words) = match number(3, "type")? {
        1 => (false, 1),
        2 => (false, 2),
        3 => (true, 2),
        4 => (true, 4),
        other => return lines.fail(format_args!("type = {other}, needs 1 .. 4")),
    };
    let rest = lines.text().get(name_at..).unwrap_or("");
    let name = rest.get(..8.min(rest.len())).unwrap_or("").trim().to_ascii_uppercase();
    // The format of numbers, and of the whole numbers of columns: 1P,3E23.16|I16.
    let format = rest.get(8.min(rest.len())..).unwrap_or("");
    let format = format.split('|').next().unwrap_or("").trim();
    let format = if format.is_empty() { "1P,5E16.9" } else { format };
    let Some(fields) = fields(format) else {
        return lines.fail(format_args!("{format:?} is no Fortran format, as 1P,3E23.16"));
    };
    let (Ok(columns), Ok(height)) = (usize::try_from(columns), usize::try_from(rows.unsigned_abs())) else {
        return lines.fail(format_args!("{columns} columns, needs a number >= 0"));
    };
    Ok(Head {
        columns,
        rows: height,
        large: rows < 0,
        is_complex,
        words,
        name,
        fields,
    })
}

/// Whether the present line holds whole numbers only.
fn is_whole(lines: &Lines) -> bool {
    let mut words = lines.text().split_whitespace().peekable();
    words.peek().is_some() && words.all(|word| word.parse::<i64>().is_ok())
}

fn body(lines: &mut Lines, head: &Head) -> Result<Matrix> {
    let size = (head.rows, head.columns);
    let mut matrix = Matrix::new(lines, size, Symmetry::General, (0, head.is_complex))?;
    let mut last = 0;
    loop {
        lines.expect("a column, or the one after the last")?;
        let numbers: Vec<&str> = lines.text().split_whitespace().collect();
        let [column, row, words] = numbers[..] else {
            return lines.fail("needs the three numbers of a column: number, first row, words");
        };
        let column = whole(lines, Some(column), "column")?;
        let (row, words) = (
            whole(lines, Some(row), "first row")?,
            whole(lines, Some(words), "words")?,
        );
        if column == head.columns as i64 + 1 {
            // One number follows the last column.
            lines.expect("the number after the last column")?;
            real(lines, field(lines, head.fields, 0), "value")?;
            return Ok(matrix.finished());
        }
        if column < 1 || column > head.columns as i64 {
            return lines.fail(format_args!("column = {column}, needs 1 .. {}", head.columns + 1));
        }
        // Sparse columns may come in any order, dense ones may not.
        let column = (column - 1) as u32;
        if row > 0 {
            if column < last {
                return lines.fail(format_args!("column {} after column {}", column + 1, last));
            }
            last = column + 1;
            run(lines, head, &mut matrix, (row, column), words)?;
        } else {
            strings(lines, head, &mut matrix, column, words)?;
        }
    }
}

/// Strings of a sparse column, `words` in all.
fn strings(lines: &mut Lines, head: &Head, matrix: &mut Matrix, column: u32, words: i64) -> Result<()> {
    let mut left = words;
    while left > 0 {
        lines.expect("a string")?;
        let numbers: Vec<&str> = lines.text().split_whitespace().collect();
        let (length, row) = match (head.large, &numbers[..]) {
            (true, [length, row]) => (
                whole(lines, Some(length), "length of a string")?,
                whole(lines, Some(row), "row of a string")?,
            ),
            (false, [both]) => {
                let both = whole(lines, Some(both), "head of a string")?;
                (both.div_euclid(1 << 16), both.rem_euclid(1 << 16))
            }
            _ => return lines.fail("needs the head of a string: its length and row"),
        };
        // The row of a large matrix is a word of its own.
        let own = if head.large { 2 } else { 1 };
        if length < 2 || length - 1 + own > left {
            return lines.fail(format_args!(
                "a string of {length} words, of which {left} are left in the column"
            ));
        }
        run(lines, head, matrix, (row, column), length - 1)?;
        left -= length - 1 + own;
    }
    Ok(())
}

/// Numbers below each other from a row on. `words` counts words of the type, or in dense columns numbers.
fn run(lines: &mut Lines, head: &Head, matrix: &mut Matrix, (row, column): (i64, u32), words: i64) -> Result<()> {
    let parts = if head.is_complex { 2 } else { 1 };
    let per_number = head.words / parts;
    let words = usize::try_from(words).unwrap_or(0);
    let first = match usize::try_from(row) {
        Ok(row) if (1..=head.rows).contains(&row) => row - 1,
        _ => return lines.fail(format_args!("row = {row}, needs 1 .. {}", head.rows)),
    };
    if words == 0 || words > lines.length() {
        return lines.fail(format_args!(
            "{words} words, needs a number from 1 to the length of the file"
        ));
    }
    let mut count = 0;
    let mut pending = 0.0;
    // Writers disagree whether a column of double precision counts words or numbers.
    while count < words {
        lines.expect("the numbers of a column")?;
        if is_whole(lines) {
            lines.repeat();
            break;
        }
        for i in 0..head.fields.per_line {
            let Some(text) = field(lines, head.fields, i).filter(|text| !text.trim().is_empty()) else {
                break;
            };
            let value = real(lines, Some(text), "value")?;
            let at = first + count / parts;
            if at >= head.rows {
                return lines.fail(format_args!("a number for row {}, needs 1 .. {}", at + 1, head.rows));
            }
            if parts == 1 {
                matrix.push(lines, at as u32, column, (value, 0.0))?;
            } else if count % 2 == 1 {
                matrix.push(lines, at as u32, column, (pending, value))?;
            }
            pending = value;
            count += 1;
        }
    }
    if count == words || count * per_number == words {
        return Ok(());
    }
    lines.fail(format_args!("{count} numbers where {words} words were announced"))
}
