//! Harwell-Boeing text files, as Ansys `HBMAT` and others write them: fixed-width fields by Fortran formats (Duff, Grimes
//! & Lewis 1989, doi:10.1145/62038.62043).

use crate::Result;
use crate::lines::Lines;
use crate::matrix::{Matrix, Symmetry};
use crate::numbers::{count, real, whole};

/// Fields of a Fortran format such as (16I5), (1X,8I9), (1P,4D20.13) or (3(1P,E24.16)): so many a line, so wide, after so many
/// characters.
#[derive(Clone, Copy)]
pub(crate) struct Fields {
    pub per_line: usize,
    pub width: usize,
    pub skipped: usize,
}

/// Parses a Fortran format.
pub(crate) fn fields(format: &str) -> Option<Fields> {
    let format = format.trim().to_ascii_uppercase();
    let format = format
        .strip_prefix('(')
        .and_then(|rest| rest.strip_suffix(')'))
        .unwrap_or(&format);
    let mut rest = format.trim();
    let mut skipped = 0;
    let mut repeat: usize = 1;
    loop {
        let end = rest.bytes().take_while(u8::is_ascii_digit).count();
        let number: usize = if end == 0 { 1 } else { rest[..end].parse().ok()? };
        let after = &rest[end..];
        if let Some(after) = after.strip_prefix('X') {
            skipped += number;
            rest = after.trim_start_matches([',', ' ']);
        } else if let Some(after) = after.strip_prefix('P') {
            // A scale factor does not change how numbers with an exponent are read.
            rest = after.trim_start_matches([',', ' ']);
        } else if let Some(inner) = after.strip_prefix('(') {
            repeat = number;
            rest = inner.strip_suffix(')')?.trim();
        } else {
            let width = after.strip_prefix(['I', 'E', 'D', 'F', 'G'])?;
            let width = width.split(['.', 'E']).next()?.trim().parse().ok()?;
            let per_line = number.checked_mul(repeat)?;
            let small = (1..=1000).contains(&per_line) && (1..=1000).contains(&width) && skipped <= 1000;
            return small.then_some(Fields {
                per_line,
                width,
                skipped,
            });
        }
    }
}

/// Field `i` of the present line.
pub(crate) fn field(lines: &Lines, fields: Fields, i: usize) -> Option<&str> {
    let line = lines.text();
    let start = fields.skipped + i * fields.width;
    line.get(start..line.len().min(start + fields.width))
}

/// The matrix of a file whose first line is the present one.
///
/// # Errors
/// The line and reason.
pub(crate) fn matrix(lines: &mut Lines) -> Result<Matrix> {
    lines.expect("the numbers of lines")?;
    let mut words = lines.text().split_whitespace();
    let mut number = |what: &str| count(lines, words.next(), what);
    let total = number("lines of data")?;
    let (pointers, indices, values) = (
        number("lines of pointers")?,
        number("lines of indices")?,
        number("lines of values")?,
    );
    let right = words
        .next()
        .map_or(Ok(0), |word| count(lines, Some(word), "lines of right-hand sides"))?;
    let sum = [pointers, indices, values, right]
        .iter()
        .try_fold(0_usize, |sum, n| sum.checked_add(*n));
    if sum != Some(total) {
        return lines.fail(format_args!(
            "{total} lines of data are announced, but the parts do not add up to that"
        ));
    }
    lines.expect("the type and size of the matrix")?;
    let mut words = lines.text().split_whitespace();
    let kind = words.next().unwrap_or("").to_ascii_uppercase();
    let (is_complex, symmetry) = match kind.as_str() {
        "RSA" => (false, Symmetry::Symmetric),
        "RUA" | "RRA" => (false, Symmetry::General),
        "RZA" => (false, Symmetry::Skew),
        "CSA" => (true, Symmetry::Symmetric),
        "CHA" => (true, Symmetry::Hermitian),
        "CZA" => (true, Symmetry::Skew),
        "CUA" | "CRA" => (true, Symmetry::General),
        other => {
            return lines.fail(format_args!(
                "the type is {other:?}, needs an assembled matrix with values: RSA, RUA, CSA, CHA, CUA, ..."
            ));
        }
    };
    let mut number = |what: &str| count(lines, words.next(), what);
    let (rows, columns, entries) = (number("rows")?, number("columns")?, number("entries")?);
    lines.expect("the formats")?;
    let formats: Vec<Option<Fields>> = split_formats(lines.text()).into_iter().map(fields).collect();
    let [Some(pointer_format), Some(index_format), Some(value_format), ..] = formats[..] else {
        return lines.fail("needs three Fortran formats, as (16I5) (16I5) (5E16.8)");
    };
    if right > 0 {
        lines.expect("the type of right-hand sides")?;
    }
    let mut matrix = Matrix::new(lines, (rows, columns), symmetry, (entries, is_complex))?;
    let starts = pointers_of(lines, (columns, entries), (pointers, pointer_format))?;
    let mut reader = Reader::new(index_format, indices);
    let mut column = 0;
    for at in 0..entries {
        while starts[column + 1] <= at {
            column += 1;
        }
        reader.advance(lines)?;
        let row = whole(lines, reader.text(lines), "row")?;
        let row = match usize::try_from(row) {
            Ok(row) if (1..=rows).contains(&row) => row - 1,
            _ => return lines.fail(format_args!("row = {row}, needs 1 .. {rows}")),
        };
        if symmetry != Symmetry::General && row < column {
            return lines.fail(format_args!(
                "row {} of column {} lies above the diagonal of a symmetric matrix",
                row + 1,
                column + 1
            ));
        }
        matrix.row.push(row as u32);
        matrix.column.push(column as u32);
    }
    reader.finished(lines)?;
    let mut reader = Reader::new(value_format, values);
    for _ in 0..entries * if is_complex { 2 } else { 1 } {
        reader.advance(lines)?;
        let value = real(lines, reader.text(lines), "value")?;
        matrix.values.push(value);
    }
    reader.finished(lines)?;
    for _ in 0..right {
        lines.expect("a right-hand side")?;
    }
    while lines.advance()? {
        if !lines.text().trim().is_empty() {
            return lines.fail("more lines than the file announces");
        }
    }
    Ok(matrix.finished())
}

/// Formats at columns 1, 17, 33, 53, or separated by blanks.
fn split_formats(line: &str) -> Vec<&str> {
    let fixed = [0..16, 16..32, 32..52, 52..72].map(|range| line.get(range.start..line.len().min(range.end)));
    let fixed: Vec<&str> = fixed.into_iter().flatten().collect();
    let whole = |format: &&str| format.trim().starts_with('(') && format.trim().ends_with(')');
    if fixed.len() >= 3 && fixed[..3].iter().all(whole) {
        fixed
    } else {
        line.split_whitespace().collect()
    }
}

/// Offsets of the columns, from 0.
fn pointers_of(
    lines: &mut Lines,
    (columns, entries): (usize, usize),
    (count, format): (usize, Fields),
) -> Result<Vec<usize>> {
    let mut starts = Vec::new();
    if starts.try_reserve_exact(columns + 1).is_err() {
        return lines.fail("no memory for the pointers");
    }
    let mut reader = Reader::new(format, count);
    for _ in 0..=columns {
        reader.advance(lines)?;
        let start = whole(lines, reader.text(lines), "pointer")?;
        let least = starts.last().copied().unwrap_or(0);
        match usize::try_from(start) {
            Ok(start) if start >= 1 && start > least && start - 1 <= entries => starts.push(start - 1),
            Ok(start) if start >= 1 && start - 1 == least => starts.push(least),
            _ => {
                return lines.fail(format_args!(
                    "pointer = {start}, needs {} .. {}",
                    least + 1,
                    entries + 1
                ));
            }
        }
    }
    reader.finished(lines)?;
    if starts[0] != 0 || starts[columns] != entries {
        return lines.fail(format_args!(
            "the pointers run from {} to {}, needs 1 to {}",
            starts[0] + 1,
            starts[columns] + 1,
            entries + 1
        ));
    }
    Ok(starts)
}

/// Numbers in fields of so many lines.
struct Reader {
    fields: Fields,
    lines_left: usize,
    next: usize,
}

impl Reader {
    fn new(fields: Fields, lines: usize) -> Self {
        Self {
            fields,
            lines_left: lines,
            next: fields.per_line,
        }
    }

    /// Moves to the next field.
    fn advance(&mut self, lines: &mut Lines) -> Result<()> {
        if self.next == self.fields.per_line {
            if self.lines_left == 0 {
                return lines.fail("the announced lines hold too few numbers");
            }
            lines.expect("more numbers")?;
            self.lines_left -= 1;
            self.next = 0;
        }
        self.next += 1;
        Ok(())
    }

    /// The present field.
    fn text<'l>(&self, lines: &'l Lines) -> Option<&'l str> {
        field(lines, self.fields, self.next - 1)
    }

    /// Refuses lines and fields that were not needed.
    fn finished(&self, lines: &Lines) -> Result<()> {
        let rest = (self.next..self.fields.per_line).filter_map(|i| field(lines, self.fields, i));
        if self.lines_left > 0 || rest.into_iter().any(|text| !text.trim().is_empty()) {
            return lines.fail("the announced lines hold more numbers than needed");
        }
        Ok(())
    }
}
