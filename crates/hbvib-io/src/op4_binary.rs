//! Nastran OP4 binary files, as `OUTPUT4` writes them without `FORMATTED`: Fortran records of words of four bytes, or of eight as
//! Nastran with 64-bit integers has them, in either byte order; dense columns, strings, and strings of large matrices.

use crate::Result;
use crate::bytes_read::{Kind, unsigned};
use crate::error::Error;
use crate::matrix::{Matrices, Matrix, Symmetry};
use crate::op4_parts::Parts;
use std::path::Path;

/// Words of the head of a matrix: columns, rows, form, type and a name of two words.
const HEAD: usize = 6;

/// Bytes of a word.
const WORDS: [usize; 2] = [4, 8];

/// Whether the first bytes of a file are the head of a matrix.
pub(crate) fn is_head(bytes: &[u8]) -> bool {
    layout(bytes).is_some()
}

/// Byte order and bytes of a word.
#[derive(Clone, Copy)]
struct Layout {
    little: bool,
    word: usize,
}

fn layout(bytes: &[u8]) -> Option<Layout> {
    let all = [true, false]
        .into_iter()
        .flat_map(|little| WORDS.map(|word| Layout { little, word }));
    all.into_iter().find(|layout| {
        let length = HEAD * layout.word;
        let mark = |at: usize| bytes.get(at..at + 4).map(|four| unsigned(four, layout.little) as usize);
        let kind = bytes.get(4 + 3 * layout.word..4 + 4 * layout.word);
        let name = bytes.get(4 + 4 * layout.word..4 + length);
        mark(0) == Some(length)
            && kind.is_some_and(|kind| (1..=4).contains(&layout.integer(kind)))
            && mark(4 + length) == Some(length)
            && name.is_some_and(|name| name[0].is_ascii_alphabetic() && name.is_ascii())
    })
}

impl Layout {
    /// A whole number of one word.
    fn integer(self, bytes: &[u8]) -> i64 {
        Kind::Signed(self.word)
            .integer(&bytes[..self.word], self.little)
            .unwrap_or(0)
    }
}

/// The matrices of a file.
///
/// # Errors
/// The matrix and the reason.
pub(crate) fn matrices(path: &Path) -> Result<Matrices> {
    let fail = |reason: String| Error::new(path, 0, format_args!("OP4 binary: {reason}"));
    let bytes = std::fs::read(path).map_err(|error| fail(format!("cannot be read: {error}")))?;
    let layout = layout(&bytes).ok_or_else(|| fail("no head of a matrix".into()))?;
    let mut records = Records {
        bytes: &bytes,
        at: 0,
        layout,
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
    layout: Layout,
}

impl<'a> Records<'a> {
    fn next(&mut self) -> std::result::Result<Option<&'a [u8]>, String> {
        let rest = &self.bytes[self.at..];
        if rest.is_empty() {
            return Ok(None);
        }
        let cut = || format!("the file is cut off in the record at byte {}", self.at);
        let little = self.layout.little;
        let length = rest
            .get(..4)
            .map(|four| unsigned(four, little) as usize)
            .ok_or_else(cut)?;
        let end = 4 + length;
        let body = rest.get(4..end).ok_or_else(cut)?;
        let mark = rest
            .get(end..end + 4)
            .map(|four| unsigned(four, little) as usize)
            .ok_or_else(cut)?;
        if mark != length {
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
    /// Bytes of a real number.
    size: usize,
}

type Told<T> = std::result::Result<T, String>;

fn head(record: &[u8], layout: Layout) -> Told<Head> {
    let length = HEAD * layout.word;
    if record.len() != length {
        return Err(format!("a head of {} bytes, needs {length}", record.len()));
    }
    let word = |i: usize| layout.integer(&record[i * layout.word..]);
    let name = String::from_utf8_lossy(&record[4 * layout.word..])
        .trim()
        .to_ascii_uppercase();
    let kind = word(3);
    if !(1..=4).contains(&kind) {
        return Err(format!("{name}: type = {kind}, needs 1 .. 4"));
    }
    Ok(Head {
        columns: usize::try_from(word(0)).map_err(|_| format!("{name}: columns = {}, needs a number >= 0", word(0)))?,
        rows: usize::try_from(word(1).unsigned_abs()).unwrap_or(usize::MAX),
        large: word(1) < 0,
        is_complex: kind > 2,
        // Words of eight bytes hold numbers of either precision.
        size: if kind % 2 == 0 { 8 } else { layout.word },
        name,
    })
}

fn matrix(records: &mut Records<'_>, record: &[u8], length: usize) -> Told<(String, Matrix)> {
    let layout = records.layout;
    let head = head(record, layout)?;
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
        let first = 3 * layout.word;
        if record.len() < first {
            return Err(format!(
                "{name}: a column of {} bytes, needs at least {first}",
                record.len()
            ));
        }
        let word = |i: usize| layout.integer(&record[i * layout.word..]);
        let (column, row, words) = (word(0), word(1), word(2));
        let data = &record[first..];
        let announced = usize::try_from(words)
            .ok()
            .and_then(|words| words.checked_mul(layout.word));
        if announced != Some(data.len()) {
            return Err(format!(
                "{name}: {words} words are announced, and {} bytes follow",
                data.len()
            ));
        }
        if column == *columns as i64 + 1 {
            return Ok((head.name, matrix));
        }
        if column < 1 || column > *columns as i64 {
            return Err(format!("{name}: column = {column}, needs 1 .. {}", columns + 1));
        }
        let column = (column - 1) as u32;
        if row > 0 {
            run(&head, &mut matrix, (row, column), data, layout)?;
            continue;
        }
        let mut left = data;
        while !left.is_empty() {
            let own = if head.large { 2 * layout.word } else { layout.word };
            let start = left.get(..own).ok_or_else(|| format!("{name}: a string is cut off"))?;
            let first = layout.integer(start);
            let (length, row) = if head.large {
                (first, layout.integer(&start[layout.word..]))
            } else {
                (first >> 16, first & 0xffff)
            };
            let words = length.checked_sub(1).and_then(|words| usize::try_from(words).ok());
            let bytes = words.and_then(|words| words.checked_mul(layout.word));
            let Some(body) = bytes
                .filter(|bytes| *bytes > 0)
                .and_then(|bytes| left.get(own..own + bytes))
            else {
                return Err(format!("{name}: a string of {length} words in column {}", column + 1));
            };
            run(&head, &mut matrix, (row, column), body, layout)?;
            left = &left[own + body.len()..];
        }
    }
}

/// Numbers below each other from a row on.
fn run(head: &Head, matrix: &mut Matrix, (row, column): (i64, u32), bytes: &[u8], layout: Layout) -> Told<()> {
    let name = &head.name;
    let size = head.size;
    let parts = if head.is_complex { 2 } else { 1 };
    if !bytes.len().is_multiple_of(size * parts) {
        return Err(format!("{name}: {} bytes are no whole numbers", bytes.len()));
    }
    let number = |bytes: &[u8]| Kind::Real(size).value(bytes, layout.little).0;
    for (k, one) in bytes.chunks_exact(size * parts).enumerate() {
        let at = row.saturating_add(k as i64);
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
