//! NumPy arrays (.npy): numbers of any size and byte order, and short texts.

use crate::bytes_read::{Kind, at};

/// An array of numbers.
pub(crate) struct Array {
    pub name: String,
    pub shape: Vec<usize>,
    /// Rows are next to each other otherwise.
    columns_first: bool,
    little: bool,
    kind: Kind,
    bytes: Vec<u8>,
}

/// Contents of a file.
pub(crate) enum Npy {
    Numbers(Array),
    Text(String),
    /// Objects, records and the like, by their type.
    Other(String),
}

type Told<T> = std::result::Result<T, String>;

/// First bytes of a file.
pub(crate) const MAGIC: &[u8] = b"\x93NUMPY";

/// The array of a file.
///
/// # Errors
/// A sentence.
pub(crate) fn array(name: &str, bytes: Vec<u8>) -> Told<Npy> {
    let cut = || format!("{name}: the head of the NumPy array is cut off or damaged");
    if !bytes.starts_with(MAGIC) {
        return Err(format!("{name}: no NumPy array"));
    }
    let (start, width) = if bytes.get(6) == Some(&1) { (10, 2) } else { (12, 4) };
    let length = at(&bytes, 8, width, true).ok_or_else(cut)? as usize;
    let head = bytes.get(start..start + length).ok_or_else(cut)?;
    let head = core::str::from_utf8(head).map_err(|_| cut())?.to_owned();
    let value = |key: &str| {
        head.split_once(key)
            .and_then(|(_, rest)| rest.split_once(':'))
            .map(|(_, rest)| rest.trim_start())
    };
    let (Some(kind), Some(order), Some(shape)) = (value("'descr'"), value("'fortran_order'"), value("'shape'")) else {
        return Err(cut());
    };
    let shape = shape
        .strip_prefix('(')
        .and_then(|rest| rest.split_once(')'))
        .ok_or_else(cut)?
        .0;
    let shape: Vec<usize> = shape
        .split(',')
        .map(str::trim)
        .filter(|word| !word.is_empty())
        .map(|word| word.parse().map_err(|_| cut()))
        .collect::<Told<_>>()?;
    let Some(kind) = kind
        .strip_prefix('\'')
        .and_then(|rest| rest.split_once('\''))
        .map(|(kind, _)| kind)
    else {
        return Ok(Npy::Other("records".into()));
    };
    let (mark, letters) = kind.split_at_checked(1).ok_or_else(cut)?;
    let (letter, size) = letters.split_at_checked(1).ok_or_else(cut)?;
    let size: usize = size.parse().unwrap_or(0);
    let body = &bytes[start + length..];
    let numbers = match (letter, size) {
        ("f", 4 | 8) => Kind::Real(size),
        ("c", 8 | 16) => Kind::Complex(size),
        ("i", 1 | 2 | 4 | 8) => Kind::Signed(size),
        ("u", 1 | 2 | 4 | 8) | ("b", 1) => Kind::Unsigned(size),
        ("S", _) => {
            return Ok(Npy::Text(
                String::from_utf8_lossy(body).trim_end_matches('\0').to_owned(),
            ));
        }
        ("U", _) => {
            let letters = body
                .chunks_exact(4)
                .filter_map(|four| char::from_u32(at(four, 0, 4, mark != ">")? as u32));
            return Ok(Npy::Text(letters.collect::<String>().trim_end_matches('\0').to_owned()));
        }
        _ => return Ok(Npy::Other(kind.to_owned())),
    };
    let count = shape.iter().try_fold(1_usize, |all, n| all.checked_mul(*n));
    let needed = count.and_then(|count| count.checked_mul(size));
    if needed != Some(body.len()) {
        return Err(format!(
            "{name}: {} bytes for an array of the shape {shape:?} of type {kind}",
            body.len()
        ));
    }
    let mut bytes = bytes;
    bytes.drain(..start + length);
    Ok(Npy::Numbers(Array {
        name: name.to_owned(),
        columns_first: order.starts_with("True"),
        shape,
        little: mark != ">",
        kind: numbers,
        bytes,
    }))
}

impl Array {
    /// Number of numbers.
    pub fn len(&self) -> usize {
        self.bytes.len() / self.kind.size()
    }

    /// Numbers have an imaginary part.
    pub fn is_complex(&self) -> bool {
        matches!(self.kind, Kind::Complex(_))
    }

    /// A table of several rows and columns whose columns are next to each other.
    pub fn is_by_columns(&self) -> bool {
        self.columns_first && self.shape.iter().filter(|n| **n > 1).count() > 1
    }

    fn part(&self, k: usize) -> &[u8] {
        let size = self.kind.size();
        &self.bytes[k * size..(k + 1) * size]
    }

    /// A number by its place in the list of all.
    pub fn value(&self, k: usize) -> (f64, f64) {
        self.kind.value(self.part(k), self.little)
    }

    /// A whole number by its place in the list of all.
    pub fn integer(&self, k: usize) -> Option<i64> {
        self.kind.integer(self.part(k), self.little)
    }

    /// Place of an entry of a table.
    pub fn place(&self, row: usize, column: usize) -> usize {
        if self.columns_first {
            column * self.shape[0] + row
        } else {
            row * self.shape[1] + column
        }
    }
}
