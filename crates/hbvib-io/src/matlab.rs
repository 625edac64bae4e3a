//! MATLAB files of version 5 (`save -v6` and `-v7`): tables of numbers and sparse matrices, compressed or not, in either byte
//! order. Structures, cells, texts and the like are listed and left out.

use crate::Result;
use crate::bytes_read::{Kind, at, whole_file};
use crate::error::Error;
use crate::matrix::{Dof, Matrices, Matrix, Symmetry};
use crate::named_matrices::sorted;
use crate::number_array::NumberArray;
use flate2::read::ZlibDecoder;
use std::io::Read;
use std::path::Path;

type Told<T> = std::result::Result<T, String>;

/// Bytes before the first variable.
const HEAD: usize = 128;

/// Types of elements.
const COMPRESSED: u64 = 15;
const MATRIX: u64 = 14;

/// Classes of variables.
const SPARSE: u64 = 5;
const NUMBERS: core::ops::RangeInclusive<u64> = 6..=15;

/// Whether the first bytes of a file are those of this version.
pub(crate) fn is_head(start: &[u8]) -> bool {
    start.starts_with(b"MATLAB 5.0") && start.get(126..128).is_some_and(|mark| mark == b"IM" || mark == b"MI")
}

/// The matrices of a file.
///
/// # Errors
/// File, variable and reason.
pub(crate) fn matrices(path: &Path) -> Result<Matrices> {
    let bytes = whole_file(path)?;
    let mut file = Contents {
        little: bytes.get(126..128) == Some(b"IM"),
        length: bytes.len(),
        found: Vec::new(),
        others: Vec::new(),
        dofs: Vec::new(),
        vectors: None,
    };
    let outcome = file.variables(&bytes).and_then(|()| {
        let mut all = sorted(file.found, file.others)?;
        if !file.dofs.is_empty() && all.named().any(|(_, a)| a.rows != file.dofs.len()) {
            return Err(format!(
                "dofs has {} rows, needs as many as the matrices have",
                file.dofs.len()
            ));
        }
        all.dofs = file.dofs;
        Ok(all)
    });
    outcome.map_err(|reason| Error::new(path, 0, format_args!("MATLAB file: {reason}")))
}

/// The vectors of numbers of a file, among which columns of tests; all else is left out.
///
/// # Errors
/// File, variable and reason.
pub(crate) fn vectors(path: &Path, bytes: &[u8]) -> Result<Vec<NumberArray>> {
    let mut file = Contents {
        little: bytes.get(126..128) == Some(b"IM"),
        length: bytes.len(),
        found: Vec::new(),
        others: Vec::new(),
        dofs: Vec::new(),
        vectors: Some(Vec::new()),
    };
    file.variables(bytes)
        .map_err(|reason| Error::new(path, 0, format_args!("MATLAB file: {reason}")))?;
    Ok(file.vectors.unwrap_or_default())
}

struct Contents {
    little: bool,
    length: usize,
    found: Vec<(String, Matrix)>,
    others: Vec<String>,
    dofs: Vec<Dof>,
    /// Vectors alone are wanted.
    vectors: Option<Vec<NumberArray>>,
}

/// An element: its type, its bytes, and those after it.
struct Element<'a> {
    kind: u64,
    body: &'a [u8],
    rest: &'a [u8],
}

/// The first element of some bytes, which begin at `place` of the file.
fn element(bytes: &[u8], place: usize, little: bool) -> Told<Element<'_>> {
    let cut = || format!("cut off or damaged at byte {place}");
    let first = at(bytes, 0, 4, little).ok_or_else(cut)?;
    // A short element has its length beside its type, and its bytes in the second word.
    if first >> 16 != 0 {
        let length = (first >> 16) as usize;
        let body = bytes.get(4..4 + length).filter(|_| length <= 4).ok_or_else(cut)?;
        return Ok(Element {
            kind: first & 0xffff,
            body,
            rest: bytes.get(8..).ok_or_else(cut)?,
        });
    }
    let length = at(bytes, 4, 4, little).ok_or_else(cut)? as usize;
    let body = bytes.get(8..).and_then(|rest| rest.get(..length)).ok_or_else(cut)?;
    // Elements begin at multiples of eight bytes, but for compressed ones.
    let next = if first == COMPRESSED {
        length
    } else {
        length.next_multiple_of(8)
    };
    Ok(Element {
        kind: first,
        body,
        rest: bytes.get(8 + next..).unwrap_or(&[]),
    })
}

impl Contents {
    fn variables(&mut self, bytes: &[u8]) -> Told<()> {
        let mut rest = bytes.get(HEAD..).ok_or("the head is cut off")?;
        while !rest.is_empty() {
            let place = bytes.len() - rest.len();
            let element = element(rest, place, self.little)?;
            rest = element.rest;
            if element.kind == COMPRESSED {
                let mut unpacked = Vec::new();
                ZlibDecoder::new(element.body)
                    .read_to_end(&mut unpacked)
                    .map_err(|error| format!("the variable at byte {place} cannot be unpacked: {error}"))?;
                let inner = self::element(&unpacked, place, self.little)?;
                self.variable(inner.kind, inner.body, place)?;
            } else {
                self.variable(element.kind, element.body, place)?;
            }
        }
        Ok(())
    }

    fn variable(&mut self, kind: u64, body: &[u8], place: usize) -> Told<()> {
        if kind != MATRIX {
            return Err(format!(
                "an element of type {kind} at byte {place}, needs a variable (14)"
            ));
        }
        let flags = element(body, place, self.little)?;
        let word = at(flags.body, 0, 4, self.little).ok_or_else(|| format!("cut off at byte {place}"))?;
        let (class, is_complex) = (word & 0xff, word & 0x0800 != 0);
        let shape = element(flags.rest, place, self.little)?;
        let name = element(shape.rest, place, self.little)?;
        let text = String::from_utf8_lossy(name.body).into_owned();
        let shape: Vec<usize> = shape
            .body
            .chunks_exact(4)
            .map(|four| at(four, 0, 4, self.little).unwrap_or(0) as usize)
            .collect();
        let [rows, columns] = shape[..] else {
            self.others.push(text);
            return Ok(());
        };
        let variable = Variable {
            name: &text,
            place,
            little: self.little,
            size: (rows, columns),
            is_complex,
        };
        if let Some(vectors) = &mut self.vectors {
            if NUMBERS.contains(&class) && (rows == 1 || columns == 1) {
                vectors.push(variable.vector(name.rest)?);
            }
        } else if class == SPARSE {
            let matrix = variable.sparse(name.rest, self.length)?;
            self.found.push((text, matrix));
        } else if NUMBERS.contains(&class) && text == "dofs" && columns == 2 {
            self.dofs = variable.dofs(name.rest)?;
        } else if NUMBERS.contains(&class) && (rows > 1 && columns > 1 || rows == 1 && columns == 1) {
            let matrix = variable.table(name.rest)?;
            self.found.push((text, matrix));
        } else {
            self.others.push(text);
        }
        Ok(())
    }
}

/// Type of numbers.
fn number_type(kind: u64) -> Option<Kind> {
    Some(match kind {
        1 => Kind::Signed(1),
        2 => Kind::Unsigned(1),
        3 => Kind::Signed(2),
        4 => Kind::Unsigned(2),
        5 => Kind::Signed(4),
        6 => Kind::Unsigned(4),
        7 => Kind::Real(4),
        9 => Kind::Real(8),
        12 => Kind::Signed(8),
        13 => Kind::Unsigned(8),
        _ => return None,
    })
}

struct Variable<'a> {
    name: &'a str,
    place: usize,
    little: bool,
    size: (usize, usize),
    is_complex: bool,
}

/// Numbers of an element.
struct Numbers<'a> {
    kind: Kind,
    little: bool,
    bytes: &'a [u8],
}

impl Numbers<'_> {
    fn len(&self) -> usize {
        self.bytes.len() / self.kind.size()
    }

    fn part(&self, k: usize) -> &[u8] {
        let size = self.kind.size();
        &self.bytes[k * size..(k + 1) * size]
    }

    fn value(&self, k: usize) -> f64 {
        self.kind.value(self.part(k), self.little).0
    }

    fn index(&self, k: usize, size: usize) -> Option<usize> {
        let index = self.kind.integer(self.part(k), self.little)?;
        usize::try_from(index).ok().filter(|i| *i < size)
    }
}

impl<'v> Variable<'_> {
    fn numbers(&self, bytes: &'v [u8]) -> Told<(Numbers<'v>, &'v [u8])> {
        let Element { kind, body, rest } = element(bytes, self.place, self.little)?;
        let Some(kind) = number_type(kind) else {
            return Err(format!("{}: numbers of type {kind}", self.name));
        };
        let little = self.little;
        let bytes = body;
        Ok((Numbers { kind, little, bytes }, rest))
    }

    /// The numbers of the real part, and of the imaginary part.
    fn both(&self, bytes: &'v [u8], least: usize) -> Told<(Numbers<'v>, Option<Numbers<'v>>)> {
        let (re, rest) = self.numbers(bytes)?;
        let im = if self.is_complex {
            Some(self.numbers(rest)?.0)
        } else {
            None
        };
        let count = re.len().min(im.as_ref().map_or(usize::MAX, Numbers::len));
        if count < least {
            return Err(format!("{}: {count} numbers, needs {least}", self.name));
        }
        Ok((re, im))
    }

    fn vector(&self, bytes: &'v [u8]) -> Told<NumberArray> {
        let count = self.count()?;
        let (re, im) = self.both(bytes, count)?;
        Ok(NumberArray {
            name: self.name.to_owned(),
            shape: vec![count],
            real: (0..count).map(|k| re.value(k)).collect(),
            imaginary: im.map_or_else(Vec::new, |im| (0..count).map(|k| im.value(k)).collect()),
        })
    }

    fn add(&self, matrix: &mut Matrix, (row, column): (usize, usize), value: (f64, f64)) -> Told<()> {
        if !(value.0.is_finite() && value.1.is_finite()) {
            return Err(format!("{}({}, {}) is not finite", self.name, row + 1, column + 1));
        }
        if matrix.add(row as u32, column as u32, value) {
            Ok(())
        } else {
            Err("no memory for the entries".into())
        }
    }

    /// Number of numbers of a table.
    fn count(&self) -> Told<usize> {
        let (rows, columns) = self.size;
        let count = rows.checked_mul(columns);
        count.ok_or_else(|| format!("{}: {rows} x {columns} numbers", self.name))
    }

    fn table(&self, bytes: &[u8]) -> Told<Matrix> {
        let (re, im) = self.both(bytes, self.count()?)?;
        let (rows, columns) = self.size;
        let mut matrix = Matrix::empty(self.size, Symmetry::General, self.is_complex);
        for column in 0..columns {
            for row in 0..rows {
                let k = column * rows + row;
                let value = (re.value(k), im.as_ref().map_or(0.0, |im| im.value(k)));
                self.add(&mut matrix, (row, column), value)?;
            }
        }
        Ok(matrix.finished())
    }

    fn dofs(&self, bytes: &[u8]) -> Told<Vec<Dof>> {
        let (numbers, _) = self.both(bytes, self.count()?)?;
        let rows = self.size.0;
        let number = |k: usize| numbers.kind.integer(numbers.part(k), self.little);
        (0..rows)
            .map(|row| {
                number(row)
                    .zip(number(rows + row))
                    .ok_or_else(|| format!("dofs({}, :) needs whole numbers", row + 1))
            })
            .collect()
    }

    fn sparse(&self, bytes: &[u8], length: usize) -> Told<Matrix> {
        let (rows, columns) = self.size;
        let most = length.max(1 << 20);
        if rows > most || columns > most {
            return Err(format!("{}: {rows} x {columns} in a file of {length} bytes", self.name));
        }
        let (row, rest) = self.numbers(bytes)?;
        let (starts, rest) = self.numbers(rest)?;
        let damaged = || format!("{}: the rows or columns of its entries are damaged", self.name);
        if starts.len() <= columns {
            return Err(damaged());
        }
        let count = starts.index(columns, row.len() + 1).ok_or_else(damaged)?;
        let (re, im) = self.both(rest, count)?;
        let mut matrix = Matrix::empty(self.size, Symmetry::General, self.is_complex);
        let mut first = 0;
        for column in 0..columns {
            let end = starts
                .index(column + 1, count + 1)
                .filter(|end| *end >= first)
                .ok_or_else(damaged)?;
            for k in first..end {
                let place = (row.index(k, rows).ok_or_else(damaged)?, column);
                let value = (re.value(k), im.as_ref().map_or(0.0, |im| im.value(k)));
                self.add(&mut matrix, place, value)?;
            }
            first = end;
        }
        Ok(matrix.finished())
    }
}
