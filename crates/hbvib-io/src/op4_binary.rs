//! Nastran OP4 binary files, as `OUTPUT4` writes them without `FORMATTED`: Fortran records of words of four bytes, in either
//! byte order; dense columns, strings, and strings of large matrices.

use crate::Result;
use crate::error::Error;
use crate::matrix::{Matrices, Matrix, Symmetry};
use crate::op4_parts::Parts;
use std::path::Path;

/// Bytes of the head of a matrix: columns, rows, form, type and a name.
const HEAD: usize = 24;

/// Whether the first bytes of a file are the head of a matrix.
pub(crate) fn is_head(bytes: &[u8]) -> bool {
    [true, false].into_iter().any(|little| {
        let word = |at: usize| bytes.get(at..at + 4).map(|four| integer(four, little));
        let name = bytes.get(20..28);
        word(0) == Some(HEAD as i32)
            && word(16).is_some_and(|kind| (1..=4).contains(&kind))
            && word(28) == Some(HEAD as i32)
            && name.is_some_and(|name| name[0].is_ascii_alphabetic() && name.is_ascii())
    })
}

fn integer(four: &[u8], little: bool) -> i32 {
    let four = [four[0], four[1], four[2], four[3]];
    if little {
        i32::from_le_bytes(four)
    } else {
        i32::from_be_bytes(four)
    }
}

/// The matrices of a file.
///
/// # Errors
/// The matrix and the reason.
pub(crate) fn matrices(path: &Path) -> Result<Matrices> {
    let fail = |reason: String| Error::new(path, 0, format_args!("OP4 binary: {reason}"));
    let bytes = std::fs::read(path).map_err(|error| fail(format!("cannot be read: {error}")))?;
    let little = bytes.get(..4).is_some_and(|four| integer(four, true) == HEAD as i32);
    let mut records = Records {
        bytes: &bytes,
        at: 0,
        little,
    };
    let mut parts = Parts::default();
    while let Some(head) = records.next().map_err(&fail)? {
        let (name, matrix) = matrix(&mut records, head, bytes.len()).map_err(&fail)?;
        parts.take(name, matrix);
    }
    parts.finished().map_err(fail)
}

/// Records of Fortran: a length, bytes, and the length again.
struct Records<'a> {
    bytes: &'a [u8],
    at: usize,
    little: bool,
}

impl<'a> Records<'a> {
    fn next(&mut self) -> std::result::Result<Option<&'a [u8]>, String> {
        let rest = &self.bytes[self.at..];
        if rest.is_empty() {
            return Ok(None);
        }
        let cut = || format!("the file is cut off in the record at byte {}", self.at);
        let length = rest.get(..4).map(|four| integer(four, self.little)).ok_or_else(cut)?;
        let length = usize::try_from(length).map_err(|_| cut())?;
        let end = 4 + length;
        let body = rest.get(4..end).ok_or_else(cut)?;
        let mark = rest
            .get(end..end + 4)
            .map(|four| integer(four, self.little))
            .ok_or_else(cut)?;
        if usize::try_from(mark) != Ok(length) {
            return Err(format!("the record at byte {} ends with another length", self.at));
        }
        self.at += end + 4;
        Ok(Some(body))
    }
}

struct Head {
    name: String,
    columns: usize,
    rows: usize,
    /// Strings have their row in a word of its own.
    large: bool,
    is_complex: bool,
    double: bool,
}

type Told<T> = std::result::Result<T, String>;

fn head(record: &[u8], little: bool) -> Told<Head> {
    if record.len() != HEAD {
        return Err(format!("a head of {} bytes, needs {HEAD}", record.len()));
    }
    let word = |i: usize| integer(&record[4 * i..4 * i + 4], little);
    let name = String::from_utf8_lossy(&record[16..24]).trim().to_ascii_uppercase();
    let kind = word(3);
    if !(1..=4).contains(&kind) {
        return Err(format!("{name}: type = {kind}, needs 1 .. 4"));
    }
    Ok(Head {
        columns: usize::try_from(word(0)).map_err(|_| format!("{name}: columns = {}, needs a number >= 0", word(0)))?,
        rows: word(1).unsigned_abs() as usize,
        large: word(1) < 0,
        is_complex: kind > 2,
        double: kind % 2 == 0,
        name,
    })
}

fn matrix(records: &mut Records<'_>, record: &[u8], length: usize) -> Told<(String, Matrix)> {
    let little = records.little;
    let head = head(record, little)?;
    let Head {
        name, rows, columns, ..
    } = &head;
    let most = length.max(1 << 20);
    if *rows > most || *columns > most {
        return Err(format!("{name}: {rows} x {columns} in a file of {length} bytes"));
    }
    let mut matrix = Matrix::empty((*rows, *columns), Symmetry::General, head.is_complex);
    loop {
        let Some(record) = records.next()? else {
            return Err(format!("{name}: the file ends before the last column"));
        };
        if record.len() < 12 {
            return Err(format!("{name}: a column of {} bytes, needs at least 12", record.len()));
        }
        let word = |i: usize| integer(&record[4 * i..4 * i + 4], little);
        let (column, row, words) = (word(0), word(1), word(2));
        let data = &record[12..];
        if usize::try_from(words).ok().and_then(|words| words.checked_mul(4)) != Some(data.len()) {
            return Err(format!(
                "{name}: {words} words are announced, and {} bytes follow",
                data.len()
            ));
        }
        if i64::from(column) == *columns as i64 + 1 {
            return Ok((head.name, matrix));
        }
        if column < 1 || i64::from(column) > *columns as i64 {
            return Err(format!("{name}: column = {column}, needs 1 .. {}", columns + 1));
        }
        let column = (column - 1) as u32;
        if row > 0 {
            run(&head, &mut matrix, (row, column), data, little)?;
            continue;
        }
        let mut left = data;
        while !left.is_empty() {
            let own = if head.large { 8 } else { 4 };
            let start = left.get(..own).ok_or_else(|| format!("{name}: a string is cut off"))?;
            let first = integer(start, little);
            let (length, row) = if head.large {
                (first, integer(&start[4..], little))
            } else {
                (first >> 16, first & 0xffff)
            };
            let words = length.checked_sub(1).and_then(|words| usize::try_from(words).ok());
            let bytes = words.and_then(|words| words.checked_mul(4));
            let Some(body) = bytes
                .filter(|bytes| *bytes > 0)
                .and_then(|bytes| left.get(own..own + bytes))
            else {
                return Err(format!("{name}: a string of {length} words in column {}", column + 1));
            };
            run(&head, &mut matrix, (row, column), body, little)?;
            left = &left[own + body.len()..];
        }
    }
}

/// Numbers below each other from a row on.
fn run(head: &Head, matrix: &mut Matrix, (row, column): (i32, u32), bytes: &[u8], little: bool) -> Told<()> {
    let name = &head.name;
    let size = if head.double { 8 } else { 4 };
    let parts = if head.is_complex { 2 } else { 1 };
    if !bytes.len().is_multiple_of(size * parts) {
        return Err(format!("{name}: {} bytes are no whole numbers", bytes.len()));
    }
    let number = |bytes: &[u8]| -> f64 {
        let mut all = [0_u8; 8];
        all[..size].copy_from_slice(bytes);
        if !little {
            all[..size].reverse();
        }
        if head.double {
            f64::from_le_bytes(all)
        } else {
            f64::from(f32::from_le_bytes([all[0], all[1], all[2], all[3]]))
        }
    };
    for (k, one) in bytes.chunks_exact(size * parts).enumerate() {
        let at = i64::from(row) + k as i64;
        if at < 1 || at > head.rows as i64 {
            return Err(format!("{name}: row = {at}, needs 1 .. {}", head.rows));
        }
        let (re, im) = (
            number(&one[..size]),
            if parts == 2 { number(&one[size..]) } else { 0.0 },
        );
        if !(re.is_finite() && im.is_finite()) {
            return Err(format!(
                "{name}: the number at row {at}, column {} is not finite",
                column + 1
            ));
        }
        if !matrix.add((at - 1) as u32, column, (re, im)) {
            return Err("no memory for the entries".into());
        }
    }
    Ok(())
}
