//! Writes Nastran OP4 files, text or binary, with the names that EXTSEOUT gives: KAA, MAA, BAA, K4AA. Numbers are exact to the
//! last bit in both forms.

use crate::Result;
use crate::columns::{Columns, Entry};
use crate::error::Error;
use crate::matrix::{Matrices, Matrix};
use crate::number_text::e23_16;
use crate::output_file::{OutputFile, order};
use std::path::Path;

/// Text or binary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Op4Form {
    /// As `FORM = FORMATTED`, 1P,3E23.16.
    Text,
    /// Records of Fortran, double precision, the lowest byte first.
    Binary,
}

/// From this share of entries on, columns are dense.
const DENSE: f64 = 0.25;

/// Writes the matrices of one model as an OP4 file.
///
/// # Errors
/// No matrix, matrices of different sizes, numbers that are not finite; the reason of the system.
pub fn write_op4(path: &Path, matrices: &Matrices, form: Op4Form) -> Result<()> {
    let n = order(path, matrices)?;
    if i32::try_from(2 * n + 2).is_err() || (form == Op4Form::Text && n > 9_999_999) {
        return Err(Error::new(path, 0, format!("{n} rows are too many for OP4")));
    }
    let mut file = OutputFile::create(path)?;
    for (kind, matrix) in matrices.named() {
        let name = match kind {
            "stiffness" => "KAA",
            "mass" => "MAA",
            "damping" => "BAA",
            _ => "K4AA",
        };
        let columns = Columns::whole(matrix);
        let dense = columns.entries() as f64 >= DENSE * (n * n) as f64;
        let one = One {
            name,
            matrix,
            columns,
            dense,
        };
        match form {
            Op4Form::Text => one.text(&mut file)?,
            Op4Form::Binary => one.binary(&mut file)?,
        }
    }
    file.finish()
}

/// A matrix with its columns.
struct One<'a> {
    name: &'static str,
    matrix: &'a Matrix,
    columns: Columns,
    dense: bool,
}

/// Columns of dense form, from the first entry to the last, or strings of entries below each other.
fn strings(entries: &[Entry], dense: bool) -> Vec<(u32, Vec<(f64, f64)>)> {
    let mut all: Vec<(u32, Vec<(f64, f64)>)> = Vec::new();
    for &(row, re, im) in entries {
        if let Some((first, values)) = all.last_mut() {
            let next = *first + values.len() as u32;
            if dense || row == next {
                values.resize((row - *first) as usize, (0.0, 0.0));
                values.push((re, im));
                continue;
            }
        }
        all.push((row, vec![(re, im)]));
    }
    all
}

impl One<'_> {
    /// Form of a matrix (6: symmetric, 1: square), type (2: real, 4: complex double precision), and rows, below zero where strings
    /// have their row in a word of its own.
    fn head(&self) -> (i32, i32, i32) {
        let form = if self.columns.is_symmetric() { 6 } else { 1 };
        let rows = self.matrix.rows as i32;
        let kind = if self.matrix.is_complex { 4 } else { 2 };
        (if self.dense { rows } else { -rows }, form, kind)
    }

    /// Words of a number.
    fn words(&self) -> usize {
        if self.matrix.is_complex { 4 } else { 2 }
    }

    fn numbers(&self, values: &[(f64, f64)]) -> Vec<f64> {
        let both = |&(re, im): &(f64, f64)| if self.matrix.is_complex { vec![re, im] } else { vec![re] };
        values.iter().flat_map(both).collect()
    }

    fn text(&self, file: &mut OutputFile) -> Result<()> {
        let (rows, form, kind) = self.head();
        let columns = self.matrix.columns;
        file.put(format!(
            "{columns:8}{rows:8}{form:8}{kind:8}{:<8}1P,3E23.16\n",
            self.name
        ))?;
        for j in 0..columns {
            let strings = strings(self.columns.column(j), self.dense);
            let Some((first, _)) = strings.first() else { continue };
            let words: usize = strings.iter().map(|(_, values)| values.len() * self.words()).sum();
            if self.dense {
                file.put(format!("{:8}{:8}{words:8}\n", j + 1, first + 1))?;
            } else {
                file.put(format!("{:8}{:8}{:8}\n", j + 1, 0, words + 2 * strings.len()))?;
            }
            for (row, values) in &strings {
                if !self.dense {
                    file.put(format!("{:8}{:8}\n", values.len() * self.words() + 1, row + 1))?;
                }
                for line in self.numbers(values).chunks(3) {
                    let line: String = line.iter().map(|v| e23_16(*v)).collect();
                    file.put(line + "\n")?;
                }
            }
        }
        file.put(format!("{:8}{:8}{:8}\n{}\n", columns + 1, 1, 1, e23_16(1.0)))
    }

    fn binary(&self, file: &mut OutputFile) -> Result<()> {
        let (rows, form, kind) = self.head();
        let columns = self.matrix.columns as i32;
        let words = |all: &[i32]| all.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
        let doubles = |all: &[f64]| all.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
        let mut head = words(&[columns, rows, form, kind]);
        head.extend(format!("{:<8}", self.name).bytes());
        record(file, &head)?;
        for j in 0..self.matrix.columns {
            let strings = strings(self.columns.column(j), self.dense);
            let Some((first, _)) = strings.first() else { continue };
            let mut body = Vec::new();
            for (row, values) in &strings {
                if !self.dense {
                    body.extend(words(&[(values.len() * self.words() + 1) as i32, *row as i32 + 1]));
                }
                body.extend(doubles(&self.numbers(values)));
            }
            let first = if self.dense { *first as i32 + 1 } else { 0 };
            let mut all = words(&[j as i32 + 1, first, (body.len() / 4) as i32]);
            all.extend(body);
            record(file, &all)?;
        }
        let mut end = words(&[columns + 1, 1, 2]);
        end.extend(doubles(&[1.0]));
        record(file, &end)
    }
}

/// A record of Fortran.
fn record(file: &mut OutputFile, bytes: &[u8]) -> Result<()> {
    let length = (bytes.len() as u32).to_le_bytes();
    file.put(length)?;
    file.put(bytes)?;
    file.put(length)
}
