//! Matrix Market files: `coordinate` and `array`; real, integer or complex; general, symmetric, Hermitian, skew.

use crate::Result;
use crate::lines::Lines;
use crate::matrix::{Matrix, Symmetry};
use crate::numbers::{count, index, real};

/// Whether a line is the banner of a file: `%%MatrixMarket` in any case, after spaces as MUMPS writes them, or with one %.
pub(crate) fn is_banner(line: &str) -> bool {
    let word = line.split_whitespace().next().unwrap_or("");
    let name = word.trim_start_matches('%');
    (1..=2).contains(&(word.len() - name.len())) && name.eq_ignore_ascii_case("MatrixMarket")
}

/// The matrix of a file whose first line is the present one.
///
/// # Errors
/// The line and reason.
pub(crate) fn matrix(lines: &mut Lines) -> Result<Matrix> {
    let banner = lines.text().to_ascii_lowercase();
    let words: Vec<&str> = banner.split_whitespace().collect();
    let [_, "matrix", format, field, symmetry] = words[..] else {
        return lines.fail("the banner needs five words: %%MatrixMarket matrix coordinate real symmetric");
    };
    let is_complex = match field {
        "real" | "integer" | "double" => false,
        "complex" => true,
        other => return lines.fail(format_args!("entries are {other:?}, needs real, integer or complex")),
    };
    let symmetry = match symmetry {
        "general" => Symmetry::General,
        "symmetric" => Symmetry::Symmetric,
        "hermitian" => Symmetry::Hermitian,
        "skew-symmetric" => Symmetry::Skew,
        other => {
            return lines.fail(format_args!(
                "symmetry is {other:?}, needs general, symmetric, hermitian or skew-symmetric"
            ));
        }
    };
    let dense = match format {
        "coordinate" => false,
        "array" => true,
        other => return lines.fail(format_args!("format is {other:?}, needs coordinate or array")),
    };
    expect_data(lines, "the size of the matrix")?;
    let mut words = lines.text().split_whitespace();
    let (rows, columns) = (
        count(lines, words.next(), "rows")?,
        count(lines, words.next(), "columns")?,
    );
    let entries = if dense {
        let all = rows.saturating_mul(columns);
        if symmetry == Symmetry::General {
            all
        } else {
            all / 2 + rows / 2
        }
    } else {
        count(lines, words.next(), "number of entries")?
    };
    refuse_more(lines, words.next())?;
    let mut matrix = Matrix::new(lines, (rows, columns), symmetry, (entries, is_complex))?;
    if dense {
        array(lines, &mut matrix)?;
    } else {
        let mut triangle = None;
        for _ in 0..entries {
            expect_data(lines, "an entry")?;
            let mut words = lines.text().split_whitespace();
            let row = index(lines, words.next(), rows, "row")?;
            let column = index(lines, words.next(), columns, "column")?;
            let value = value(lines, &mut words, is_complex)?;
            refuse_more(lines, words.next())?;
            if row == column {
                refuse_diagonal(lines, &matrix, value)?;
            }
            if symmetry == Symmetry::General || row == column {
                matrix.push(lines, row, column, value)?;
                continue;
            }
            // The format has the lower triangle; some programs write the upper one.
            let lower = row > column;
            if *triangle.get_or_insert(lower) != lower {
                return lines.fail("entries on both sides of the diagonal, needs one triangle of a symmetric matrix");
            }
            if lower {
                matrix.push(lines, row, column, value)?;
            } else {
                matrix.push(lines, column, row, mirrored(symmetry, value))?;
            }
        }
    }
    while lines.advance()? {
        if !is_comment(lines.text()) {
            return lines.fail("more entries than the file announces");
        }
    }
    Ok(matrix.finished())
}

/// Column after column, of a symmetric matrix the lower triangle.
fn array(lines: &mut Lines, matrix: &mut Matrix) -> Result<()> {
    for column in 0..matrix.columns {
        let first = match matrix.symmetry {
            Symmetry::General => 0,
            Symmetry::Skew => column + 1,
            _ => column,
        };
        for row in first..matrix.rows {
            expect_data(lines, "an entry")?;
            let mut words = lines.text().split_whitespace();
            let value = value(lines, &mut words, matrix.is_complex)?;
            refuse_more(lines, words.next())?;
            if row == column {
                refuse_diagonal(lines, matrix, value)?;
            }
            matrix.push(lines, row as u32, column as u32, value)?;
        }
    }
    Ok(())
}

fn value<'a>(lines: &Lines, words: &mut impl Iterator<Item = &'a str>, is_complex: bool) -> Result<(f64, f64)> {
    let re = real(lines, words.next(), "value")?;
    let im = if is_complex {
        real(lines, words.next(), "imaginary part")?
    } else {
        0.0
    };
    Ok((re, im))
}

/// The entry at the mirror image of another one.
fn mirrored(symmetry: Symmetry, (re, im): (f64, f64)) -> (f64, f64) {
    match symmetry {
        Symmetry::General | Symmetry::Symmetric => (re, im),
        Symmetry::Hermitian => (re, -im),
        Symmetry::Skew => (-re, -im),
    }
}

/// The diagonal of a Hermitian matrix is real: with a loss factor the matrix is symmetric. That of a skew one is zero.
fn refuse_diagonal(lines: &Lines, matrix: &Matrix, (re, im): (f64, f64)) -> Result<()> {
    match matrix.symmetry {
        Symmetry::Hermitian if im != 0.0 => lines.fail(format_args!(
            "an imaginary part of {im} on the diagonal of a hermitian matrix, needs 0, or symmetric in the banner"
        )),
        Symmetry::Skew if (re, im) != (0.0, 0.0) => lines.fail(format_args!(
            "{re} on the diagonal of a skew-symmetric matrix, needs 0, or another symmetry in the banner"
        )),
        _ => Ok(()),
    }
}

fn refuse_more(lines: &Lines, word: Option<&str>) -> Result<()> {
    match word {
        None => Ok(()),
        Some(word) => lines.fail(format_args!("{word:?} is one word too many")),
    }
}

fn is_comment(line: &str) -> bool {
    let line = line.trim_start();
    line.is_empty() || line.starts_with('%')
}

fn expect_data(lines: &mut Lines, needed: &str) -> Result<()> {
    lines.expect(needed)?;
    while is_comment(lines.text()) {
        lines.expect(needed)?;
    }
    Ok(())
}
