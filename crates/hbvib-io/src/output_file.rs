//! A file that is written, with errors that name it.

use crate::Result;
use crate::error::Error;
use crate::matrix::{Matrices, Matrix};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// A new file.
pub(crate) struct OutputFile {
    path: PathBuf,
    to: BufWriter<File>,
}

impl OutputFile {
    /// Creates a file, in place of one that is there.
    ///
    /// # Errors
    /// The reason of the system.
    pub fn create(path: &Path) -> Result<Self> {
        match File::create(path) {
            Ok(file) => Ok(Self {
                path: path.to_owned(),
                to: BufWriter::new(file),
            }),
            Err(error) => Err(Error::new(path, 0, format_args!("cannot be written: {error}"))),
        }
    }

    /// Writes bytes.
    ///
    /// # Errors
    /// The reason of the system.
    pub fn put(&mut self, bytes: impl AsRef<[u8]>) -> Result<()> {
        let outcome = self.to.write_all(bytes.as_ref());
        self.checked(outcome)
    }

    /// Writes what is left.
    ///
    /// # Errors
    /// The reason of the system.
    pub fn finish(mut self) -> Result<()> {
        let outcome = self.to.flush();
        self.checked(outcome)
    }

    fn checked(&self, outcome: std::io::Result<()>) -> Result<()> {
        outcome.map_err(|error| Error::new(&self.path, 0, format_args!("cannot be written: {error}")))
    }
}

/// The order of square matrices of one model.
///
/// # Errors
/// No matrix; one that is not square or of another size, numbers that are not finite, entries out of range.
pub(crate) fn order(path: &Path, matrices: &Matrices) -> Result<usize> {
    let mut order: Option<(&str, usize)> = None;
    for (name, a) in matrices.named() {
        check(path, name, a)?;
        if a.rows != a.columns {
            let reason = format!("{name} is {} x {}, needs a square matrix", a.rows, a.columns);
            return Err(Error::new(path, 0, reason));
        }
        match order {
            Some((first, n)) if n != a.rows => {
                let reason = format!(
                    "{name} has {} rows, and {first} has {n}: needs matrices of one size",
                    a.rows
                );
                return Err(Error::new(path, 0, reason));
            }
            _ => order = Some((name, a.rows)),
        }
    }
    let Some((_, n)) = order else {
        return Err(Error::new(path, 0, "there is no matrix to write"));
    };
    if !matrices.dofs.is_empty() && matrices.dofs.len() != n {
        let count = matrices.dofs.len();
        let reason = format!("{count} degrees of freedom are named, needs {n} as the matrices have rows");
        return Err(Error::new(path, 0, reason));
    }
    Ok(n)
}

/// Checks a matrix that a caller made.
///
/// # Errors
/// Entries out of range, lists of different lengths, numbers that are not finite.
pub(crate) fn check(path: &Path, name: &str, a: &Matrix) -> Result<()> {
    let parts = if a.is_complex { 2 } else { 1 };
    let fits = a.row.len() == a.column.len()
        && a.values.len() == parts * a.row.len()
        && a.row.iter().all(|i| (*i as usize) < a.rows)
        && a.column.iter().all(|j| (*j as usize) < a.columns);
    if !fits {
        let reason = format!("{name} has entries out of range, or lists of different lengths");
        return Err(Error::new(path, 0, reason));
    }
    if a.values.iter().any(|v| !v.is_finite()) {
        return Err(Error::new(path, 0, format!("{name} holds a number that is not finite")));
    }
    Ok(())
}
