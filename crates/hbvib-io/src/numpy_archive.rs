//! NumPy files: an array (.npy), and archives of arrays (.npz) with plain tables or the sparse matrices of scipy.

use crate::Result;
use crate::bytes_read::whole_file;
use crate::error::Error;
use crate::matrix::{Dof, Matrices, Matrix, Symmetry};
use crate::named_matrices::sorted;
use crate::npy::{Array, MAGIC, Npy, array};
use crate::zip_archive::members;
use std::path::Path;

type Told<T> = std::result::Result<T, String>;

/// Most rows and columns, as in other formats.
const SMALL: usize = 1 << 20;

/// The matrices of a file.
///
/// # Errors
/// File, array and reason.
pub(crate) fn matrices(path: &Path) -> Result<Matrices> {
    let bytes = whole_file(path)?;
    let found = if bytes.starts_with(MAGIC) {
        single(path, bytes)
    } else {
        archive(&bytes)
    };
    found.map_err(|reason| Error::new(path, 0, format_args!("NumPy file: {reason}")))
}

fn single(path: &Path, bytes: Vec<u8>) -> Told<Matrices> {
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    match array(&name, bytes)? {
        Npy::Numbers(array) if array.shape.len() == 2 => sorted(vec![(name.into_owned(), table(&array)?)], Vec::new()),
        Npy::Numbers(array) => Err(format!("an array of the shape {:?}, needs a table", array.shape)),
        Npy::Text(_) => Err("an array of text, needs numbers".into()),
        Npy::Other(kind) => Err(format!(
            "an array of {kind}, needs numbers: write scipy's matrices by scipy.sparse.save_npz"
        )),
    }
}

/// Arrays and texts of an archive by their names.
struct Contents {
    arrays: Vec<Array>,
    texts: Vec<(String, String)>,
    others: Vec<String>,
}

fn archive(bytes: &[u8]) -> Told<Matrices> {
    let mut contents = Contents {
        arrays: Vec::new(),
        texts: Vec::new(),
        others: Vec::new(),
    };
    for member in members(bytes)? {
        let Some(name) = member.name.strip_suffix(".npy") else {
            contents.others.push(member.name);
            continue;
        };
        match array(name, member.content(bytes)?)? {
            Npy::Numbers(array) => contents.arrays.push(array),
            Npy::Text(text) => contents.texts.push((name.to_owned(), text)),
            Npy::Other(kind) => contents.others.push(format!("{name} ({kind})")),
        }
    }
    let mut dofs = Vec::new();
    if let Some(at) = contents
        .arrays
        .iter()
        .position(|array| array.name == "dofs" && array.shape.get(1) == Some(&2))
    {
        dofs = dof_table(&contents.arrays.swap_remove(at))?;
    }
    let mut found = Vec::new();
    let file_length = bytes.len();
    for prefix in contents.prefixes() {
        let matrix = contents.sparse(&prefix, file_length)?;
        let name = prefix.trim_end_matches(['_', '.']).to_owned();
        found.push((name, matrix));
    }
    for array in &contents.arrays {
        match array.shape[..] {
            [rows, columns] if rows > 1 || columns > 1 => found.push((array.name.clone(), table(array)?)),
            [1, 1] => found.push((array.name.clone(), table(array)?)),
            _ => contents.others.push(array.name.clone()),
        }
    }
    contents.others.extend(contents.texts.into_iter().map(|(name, _)| name));
    let mut all = sorted(found, contents.others)?;
    let fits = all.named().all(|(_, a)| a.rows == dofs.len());
    if !dofs.is_empty() && !fits {
        return Err(format!(
            "dofs has {} rows, needs as many as the matrices have",
            dofs.len()
        ));
    }
    all.dofs = dofs;
    Ok(all)
}

fn dof_table(array: &Array) -> Told<Vec<Dof>> {
    (0..array.shape[0])
        .map(|row| {
            let number = |column| array.integer(array.place(row, column));
            number(0)
                .zip(number(1))
                .ok_or_else(|| format!("dofs[{row}] needs whole numbers"))
        })
        .collect()
}

fn finite(name: &str, k: usize, value: (f64, f64)) -> Told<(f64, f64)> {
    if value.0.is_finite() && value.1.is_finite() {
        return Ok(value);
    }
    Err(format!("{name}: number {k} is not finite"))
}

/// A matrix from a table.
fn table(array: &Array) -> Told<Matrix> {
    let (rows, columns) = (array.shape[0], array.shape[1]);
    let mut matrix = Matrix::empty((rows, columns), Symmetry::General, array.is_complex());
    for column in 0..columns {
        for row in 0..rows {
            let place = array.place(row, column);
            let value = finite(&array.name, place, array.value(place))?;
            add(&mut matrix, (row, column), value)?;
        }
    }
    Ok(matrix.finished())
}

fn add(matrix: &mut Matrix, (row, column): (usize, usize), value: (f64, f64)) -> Told<()> {
    if matrix.add(row as u32, column as u32, value) {
        Ok(())
    } else {
        Err("no memory for the entries".into())
    }
}

impl Contents {
    /// Beginnings of the names of the arrays of scipy's matrices.
    fn prefixes(&self) -> Vec<String> {
        let named = self.arrays.iter().filter_map(|array| array.name.strip_suffix("shape"));
        let whole = named.filter(|prefix| self.find(prefix, "data").is_some());
        let mut all: Vec<String> = whole.map(str::to_owned).collect();
        all.sort();
        all.dedup();
        all
    }

    fn find(&self, prefix: &str, name: &str) -> Option<usize> {
        self.arrays
            .iter()
            .position(|array| array.name.strip_prefix(prefix) == Some(name))
    }

    fn take(&mut self, prefix: &str, name: &str) -> Told<Array> {
        let at = self
            .find(prefix, name)
            .ok_or_else(|| format!("{prefix}{name} is missing in a matrix of scipy"))?;
        Ok(self.arrays.swap_remove(at))
    }

    fn sparse(&mut self, prefix: &str, file_length: usize) -> Told<Matrix> {
        let wanted = format!("{prefix}format");
        let format = self
            .texts
            .iter()
            .position(|(name, _)| *name == wanted)
            .map(|at| self.texts.swap_remove(at).1);
        let shape = self.take(prefix, "shape")?;
        let size = |k: usize| shape.integer(k).and_then(|n| usize::try_from(n).ok());
        let (2, Some(rows), Some(columns)) = (shape.len(), size(0), size(1)) else {
            return Err(format!("{prefix}shape needs two whole numbers >= 0"));
        };
        let most = SMALL.max(file_length);
        if rows > most || columns > most {
            return Err(format!(
                "{prefix}shape is {rows} x {columns} in a file of {file_length} bytes"
            ));
        }
        let data = self.take(prefix, "data")?;
        // Files without a format by hand have compressed columns or coordinates.
        let coordinates = self.find(prefix, "row").is_some();
        let format = format.unwrap_or_else(|| if coordinates { "coo".into() } else { "csc".into() });
        let mut matrix = Matrix::empty((rows, columns), Symmetry::General, data.is_complex());
        let many = |array: &Array, n: usize| -> Told<()> {
            if array.len() == n {
                return Ok(());
            }
            Err(format!("{} has {} numbers, needs {n}", array.name, array.len()))
        };
        let index = |array: &Array, k: usize, size: usize| -> Told<usize> {
            let index = array
                .integer(k)
                .and_then(|i| usize::try_from(i).ok())
                .filter(|i| *i < size);
            index.ok_or_else(|| {
                format!(
                    "{}[{k}] needs a whole number 0 .. {}",
                    array.name,
                    size.saturating_sub(1)
                )
            })
        };
        match &format[..] {
            "coo" => {
                let (row, column) = (self.take(prefix, "row")?, self.take(prefix, "col")?);
                many(&row, data.len())?;
                many(&column, data.len())?;
                for k in 0..data.len() {
                    let place = (index(&row, k, rows)?, index(&column, k, columns)?);
                    add(&mut matrix, place, finite(&data.name, k, data.value(k))?)?;
                }
            }
            "csr" | "csc" => {
                let (indices, pointers) = (self.take(prefix, "indices")?, self.take(prefix, "indptr")?);
                let by_rows = format == "csr";
                let (outer, inner) = if by_rows { (rows, columns) } else { (columns, rows) };
                many(&indices, data.len())?;
                many(&pointers, outer + 1)?;
                let mut first = 0;
                if index(&pointers, 0, 1)? != 0 || index(&pointers, outer, data.len() + 1)? != data.len() {
                    return Err(format!("{} needs to run from 0 to {}", pointers.name, data.len()));
                }
                for j in 0..outer {
                    let end = index(&pointers, j + 1, data.len() + 1)?;
                    if end < first {
                        return Err(format!(
                            "{}[{}] is less than the number before it",
                            pointers.name,
                            j + 1
                        ));
                    }
                    for k in first..end {
                        let i = index(&indices, k, inner)?;
                        let place = if by_rows { (j, i) } else { (i, j) };
                        add(&mut matrix, place, finite(&data.name, k, data.value(k))?)?;
                    }
                    first = end;
                }
            }
            other => {
                return Err(format!(
                    "{prefix}format is {other:?}, which is not read: convert the matrix by .tocsc() before scipy.sparse.save_npz"
                ));
            }
        }
        Ok(matrix.finished())
    }
}
