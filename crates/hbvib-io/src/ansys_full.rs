//! Ansys .full files: assembled stiffness and mass of a model, symmetric, in records of four-byte words in either byte order.
//!
//! The layout is public in Ansys' programmer's reference and in pymapdl-reader: two records for each equation, with the numbers and the
//! values of its row on one side of the diagonal. Rows that constraints hold are left out.

use crate::Result;
use crate::bytes_read::{at, whole_file};
use crate::error::Error;
use crate::matrix::{Dof, Matrices, Matrix, Symmetry};
use std::path::Path;

type Told<T> = std::result::Result<T, String>;

/// Words of the two heads.
const HEAD: usize = 100;

/// Words around the data of a record: length and flags before it, length after it.
const FRAME: usize = 3;

/// Number of the kind of the file.
const FULL: u64 = 4;

/// Places of numbers in the second head.
const KIND: usize = 0;
const EQUATIONS: usize = 1;
const DOFS_OF_NODE: usize = 7;
const STIFFNESS_TERMS: [usize; 2] = [8, 9];
const LUMPED: usize = 10;
const UNSYMMETRIC: usize = 13;
const STIFFNESS: [usize; 2] = [18, 19];
const CONSTRAINT_EQUATIONS: usize = 20;
const MASS: [usize; 2] = [26, 27];
const MASS_TERMS: [usize; 2] = [33, 21];
const DAMPING_TERMS: [usize; 2] = [34, 39];
const NODE_DOFS: [usize; 2] = [35, 36];

/// Other ways to the matrices.
const INSTEAD: &str =
    "write them by HBMAT with FORM = ASCII (Harwell-Boeing), or by *SMAT and *EXPORT with MMF (Matrix Market)";

/// Kind of an Ansys binary file by its first bytes.
pub(crate) fn kind(start: &[u8]) -> Option<u64> {
    let little = is_little(start)?;
    // The flag of whole numbers.
    (at(start, 4, 4, little)? == 0x8000_0000).then(|| at(start, 8, 4, little))?
}

fn is_little(start: &[u8]) -> Option<bool> {
    [true, false]
        .into_iter()
        .find(|little| at(start, 0, 4, *little) == Some(HEAD as u64))
}

/// Whether a kind is this one.
pub(crate) fn is_full(kind: u64) -> bool {
    kind == FULL
}

/// The matrices of a file.
///
/// # Errors
/// The reason, with the byte where the file is damaged.
pub(crate) fn matrices(path: &Path) -> Result<Matrices> {
    let bytes = whole_file(path)?;
    let file = Full {
        little: is_little(&bytes) == Some(true),
        bytes: &bytes,
    };
    file.matrices()
        .map_err(|reason| Error::new(path, 0, format_args!("Ansys .full file: {reason}")))
}

struct Full<'a> {
    bytes: &'a [u8],
    little: bool,
}

/// The data of a record, and the word where the next one begins.
struct Record<'a> {
    words: &'a [u8],
    next: usize,
    whole: bool,
}

impl Full<'_> {
    fn record(&self, word: usize) -> Told<Record<'_>> {
        let place = word.saturating_mul(4);
        let cut = || format!("cut off or damaged at byte {place}");
        let length = at(self.bytes, place, 4, self.little).ok_or_else(cut)? as usize;
        let flags = at(self.bytes, place.saturating_add(4), 4, self.little).ok_or_else(cut)? >> 24;
        let words = self
            .bytes
            .get(place + 8..)
            .and_then(|rest| rest.get(..length.checked_mul(4)?))
            .ok_or_else(cut)?;
        if at(self.bytes, place + 8 + 4 * length, 4, self.little) != Some(length as u64) {
            return Err(cut());
        }
        // Highest bit: whole numbers; the next one: half the precision; those below: packed.
        if flags & 0x7f != 0 {
            return Err(format!(
                "the record at byte {place} is packed or in single precision, which is not read: {INSTEAD}"
            ));
        }
        Ok(Record {
            words,
            next: word + length + FRAME,
            whole: flags == 0x80,
        })
    }

    fn integers(&self, word: usize) -> Told<(Vec<i32>, usize)> {
        let record = self.record(word)?;
        if !record.whole {
            return Err(format!("the record at byte {} needs whole numbers", 4 * word));
        }
        let number = |four: &[u8]| (at(four, 0, 4, self.little).unwrap_or(0) as u32).cast_signed();
        Ok((record.words.chunks_exact(4).map(number).collect(), record.next))
    }

    fn reals(&self, word: usize) -> Told<(impl Iterator<Item = f64> + '_, usize, usize)> {
        let record = self.record(word)?;
        if record.whole {
            return Err(format!("the record at byte {} needs real numbers", 4 * word));
        }
        let count = record.words.len() / 8;
        let number = |eight: &[u8]| f64::from_bits(at(eight, 0, 8, self.little).unwrap_or(0));
        Ok((record.words.chunks_exact(8).map(number), count, record.next))
    }

    fn matrices(&self) -> Told<Matrices> {
        let (_, word) = self.integers(0)?;
        let (head, word) = self.integers(word)?;
        let item = |i: usize| head.get(i).copied().unwrap_or(0);
        let long = |[low, high]: [usize; 2]| {
            let (low, high) = (
                u64::from(item(low).cast_unsigned()),
                u64::from(item(high).cast_unsigned()),
            );
            usize::try_from(high << 32 | low).unwrap_or(usize::MAX)
        };
        if item(KIND) != -4 {
            return Err(format!("matrices of the frontal solver, which are not read: {INSTEAD}"));
        }
        if item(UNSYMMETRIC) != 0 || item(LUMPED) != 0 {
            return Err(format!(
                "unsymmetric matrices or a lumped mass, which are not read: {INSTEAD}"
            ));
        }
        if item(CONSTRAINT_EQUATIONS) != 0 {
            return Err(format!(
                "matrices with constraint equations apart from them, which are not read: {INSTEAD}"
            ));
        }
        let (directions, word) = self.integers(word)?;
        let (nodes, _) = self.integers(word)?;
        let (of_node, word) = self.integers(long(NODE_DOFS))?;
        let (held, _) = self.integers(word)?;
        let n = usize::try_from(item(EQUATIONS)).unwrap_or(0);
        let mut dofs: Vec<Dof> = Vec::new();
        for (node, count) in nodes.iter().zip(&of_node) {
            let count = usize::try_from(*count).unwrap_or(0).min(directions.len());
            dofs.extend(
                directions[..count]
                    .iter()
                    .map(|direction| (i64::from(*node), i64::from(*direction))),
            );
        }
        if n == 0
            || dofs.len() != n
            || held.len() != n
            || directions.len() != usize::try_from(item(DOFS_OF_NODE)).unwrap_or(0)
        {
            return Err(format!(
                "{n} equations, and {} degrees of freedom of its nodes",
                dofs.len()
            ));
        }
        // Places of free rows by node and direction, and their numbers among the equations.
        let mut free: Vec<usize> = (0..n).filter(|i| held[*i] >= 0).collect();
        free.sort_by_key(|i| dofs[*i]);
        let mut places = vec![None; n];
        for (place, i) in free.iter().enumerate() {
            places[*i] = Some(place as u32);
        }
        let mut all = Matrices {
            dofs: free.iter().map(|i| dofs[*i]).collect(),
            ..Matrices::default()
        };
        let matrix = |terms, pointer| -> Told<Option<Matrix>> {
            if long(terms) == 0 || long(pointer) == 0 {
                return Ok(None);
            }
            self.matrix(long(pointer), &places, free.len()).map(Some)
        };
        all.stiffness = matrix(STIFFNESS_TERMS, STIFFNESS)?;
        all.mass = matrix(MASS_TERMS, MASS)?;
        if long(DAMPING_TERMS) != 0 {
            all.others.push("the damping matrix".into());
        }
        if all.stiffness.is_none() && all.mass.is_none() {
            return Err(format!("it holds no stiffness and no mass: {INSTEAD}"));
        }
        Ok(all)
    }

    fn matrix(&self, mut word: usize, places: &[Option<u32>], free: usize) -> Told<Matrix> {
        let mut matrix = Matrix::empty((free, free), Symmetry::Symmetric, false);
        for column in places {
            let (rows, next) = self.integers(word)?;
            let (values, count, end) = self.reals(next)?;
            if count != rows.len() {
                return Err(format!("{} rows and {count} values at byte {}", rows.len(), 4 * word));
            }
            for (row, value) in rows.into_iter().zip(values) {
                let row = usize::try_from(row)
                    .ok()
                    .and_then(|row| places.get(row.wrapping_sub(1)));
                let Some(row) = row else {
                    return Err(format!("a row out of 1 .. {} at byte {}", places.len(), 4 * word));
                };
                if !value.is_finite() {
                    return Err(format!("a number at byte {} is not finite", 4 * next));
                }
                if let (Some(row), Some(column)) = (row, column)
                    && !matrix.add((*row).max(*column), (*row).min(*column), (value, 0.0))
                {
                    return Err("no memory for the entries".into());
                }
            }
            word = end;
        }
        Ok(matrix.finished())
    }
}
