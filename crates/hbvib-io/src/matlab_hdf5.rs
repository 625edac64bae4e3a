//! MATLAB files of version 7.3 (`save -v7.3`), which are HDF5: tables of numbers and sparse matrices, compressed or not. Structures,
//! cells, texts and the like are listed and left out.

use crate::Result;
use crate::bytes_read::whole_file;
use crate::error::Error;
use crate::matrix::{Dof, Matrices, Matrix, Symmetry};
use crate::named_matrices::sorted;
use hdf5_pure::{AttrValue, DType, Dataset, File, Group};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

type Told<T> = std::result::Result<T, String>;

/// Deflated bytes grow at most by this factor.
const MOST: u64 = 1032;

/// Orders up to this need no file of a size.
const SMALL: u64 = 1 << 20;

/// Whether the first bytes of a file are those of this version.
pub(crate) fn is_head(start: &[u8]) -> bool {
    start.starts_with(b"MATLAB 7.3")
}

/// The matrices of a file.
///
/// # Errors
/// File, variable and reason.
pub(crate) fn matrices(path: &Path) -> Result<Matrices> {
    let bytes = whole_file(path)?;
    let length = bytes.len() as u64;
    let found = catch_unwind(AssertUnwindSafe(|| contents(bytes, length)));
    let found = found.unwrap_or_else(|_| Err("the HDF5 file is damaged".into()));
    found.map_err(|reason| {
        Error::new(
            path,
            0,
            format_args!("MATLAB file of version 7.3: {reason} (save -v7 writes version 5, which is read, too)"),
        )
    })
}

fn contents(bytes: Vec<u8>, length: u64) -> Told<Matrices> {
    let said = |e: hdf5_pure::Error| e.to_string();
    let file = File::from_bytes(bytes).map_err(said)?;
    let root = file.root();
    let (mut found, mut others, mut dofs) = (Vec::new(), Vec::new(), Vec::new());
    let mut names = root.datasets().map_err(said)?;
    names.sort_unstable();
    for name in names {
        let told = |e: String| format!("{name}: {e}");
        let set = root.dataset(&name).map_err(|e| told(said(e)))?;
        let Some(numbers) = Numbers::of(&set, length).map_err(told)? else {
            others.push(name);
            continue;
        };
        match numbers.shape {
            (_, 2) if name == "dofs" => dofs = numbers.dofs().map_err(told)?,
            (1, 1) => found.push((name.clone(), numbers.table().map_err(told)?)),
            (rows, columns) if rows > 1 && columns > 1 => found.push((name.clone(), numbers.table().map_err(told)?)),
            _ => others.push(name),
        }
    }
    let mut names = root.groups().map_err(said)?;
    names.sort_unstable();
    for name in names {
        let told = |e: String| format!("{name}: {e}");
        let group = root.group(&name).map_err(|e| told(said(e)))?;
        match sparse_rows(&group).map_err(told)? {
            Some(rows) => found.push((name.clone(), sparse(&group, rows, length).map_err(told)?)),
            // Contents of cells.
            None if name.starts_with('#') => {}
            None => others.push(name),
        }
    }
    let mut all = sorted(found, others)?;
    if !dofs.is_empty() && all.named().any(|(_, a)| a.rows != dofs.len()) {
        return Err(format!(
            "dofs has {} rows, needs as many as the matrices have",
            dofs.len()
        ));
    }
    all.dofs = dofs;
    Ok(all)
}

/// A table of numbers, column by column as MATLAB has them.
struct Numbers {
    shape: (usize, usize),
    is_complex: bool,
    values: Vec<f64>,
}

impl Numbers {
    /// The numbers of a dataset with two sizes; `None` for something else.
    fn of(set: &Dataset, length: u64) -> Told<Option<Self>> {
        let said = |e: hdf5_pure::Error| e.to_string();
        let shape = set.shape().map_err(said)?;
        // HDF5 has the sizes in the other order. An empty array has its sizes as its values.
        let &[columns, rows] = &shape[..] else { return Ok(None) };
        let attributes = set.attrs().map_err(said)?;
        let text = |value: &AttrValue| match value {
            AttrValue::String(text) | AttrValue::AsciiString(text) => Some(text.clone()),
            _ => None,
        };
        let is_class = |class: &str| {
            attributes
                .get("MATLAB_class")
                .and_then(text)
                .is_some_and(|of| of == class)
        };
        if is_class("char") || is_class("cell") || attributes.contains_key("MATLAB_empty") {
            return Ok(None);
        }
        let is_complex = match set.dtype().map_err(said)? {
            DType::F32
            | DType::F64
            | DType::I8
            | DType::I16
            | DType::I32
            | DType::I64
            | DType::U8
            | DType::U16
            | DType::U32
            | DType::U64 => false,
            DType::Compound(parts) => {
                let named = |(name, kind): &(String, DType), wanted: &str| name == wanted && matches!(kind, DType::F64);
                match &parts[..] {
                    [re, im] if named(re, "real") && named(im, "imag") => true,
                    _ => return Ok(None),
                }
            }
            _ => return Ok(None),
        };
        let size = set.element_size().map_err(said)?;
        let bytes = columns.checked_mul(rows).and_then(|count| count.checked_mul(size));
        if bytes.is_none_or(|bytes| bytes > length.saturating_mul(MOST)) {
            return Err(format!("{rows} x {columns} numbers in a file of {length} bytes"));
        }
        let values = if is_complex {
            // Real and imaginary part of MATLAB on the machines that it runs on: eight bytes each, the lowest first.
            let raw = set.read_raw().map_err(said)?;
            let part = |bytes: &[u8]| bytes.try_into().map_or(f64::NAN, f64::from_le_bytes);
            raw.chunks_exact(8).map(part).collect()
        } else {
            set.read_f64().map_err(said)?
        };
        let parts = if is_complex { 2 } else { 1 };
        if values.len() as u64 != parts * rows * columns {
            return Err(format!("has {} numbers, needs {rows} x {columns}", values.len()));
        }
        Ok(Some(Self {
            shape: (rows as usize, columns as usize),
            is_complex,
            values,
        }))
    }

    fn value(&self, k: usize) -> (f64, f64) {
        if self.is_complex {
            (self.values[2 * k], self.values[2 * k + 1])
        } else {
            (self.values[k], 0.0)
        }
    }

    fn table(&self) -> Told<Matrix> {
        let (rows, columns) = self.shape;
        let mut matrix = Matrix::empty(self.shape, Symmetry::General, self.is_complex);
        for column in 0..columns {
            for row in 0..rows {
                add(&mut matrix, (row, column), self.value(column * rows + row))?;
            }
        }
        Ok(matrix.finished())
    }

    fn dofs(&self) -> Told<Vec<Dof>> {
        let rows = self.shape.0;
        let whole = |k: usize| {
            Some(self.value(k).0)
                .filter(|x| x.fract() == 0.0 && x.abs() < 9e15)
                .map(|x| x as i64)
        };
        (0..rows)
            .map(|row| {
                whole(row)
                    .zip(whole(rows + row))
                    .ok_or_else(|| format!("row {} needs whole numbers", row + 1))
            })
            .collect()
    }
}

fn add(matrix: &mut Matrix, (row, column): (usize, usize), value: (f64, f64)) -> Told<()> {
    if !(value.0.is_finite() && value.1.is_finite()) {
        return Err(format!("the entry ({}, {}) is not finite", row + 1, column + 1));
    }
    if matrix.add(row as u32, column as u32, value) {
        Ok(())
    } else {
        Err("no memory for the entries".into())
    }
}

/// Number of rows of a group that is a sparse matrix.
fn sparse_rows(group: &Group) -> Told<Option<u64>> {
    let attributes = group.attrs().map_err(|e| e.to_string())?;
    let rows = match attributes.get("MATLAB_sparse") {
        None => return Ok(None),
        Some(AttrValue::U64(rows)) => Some(*rows),
        Some(AttrValue::U64Array(rows)) if rows.len() == 1 => Some(rows[0]),
        Some(AttrValue::I64(rows)) => u64::try_from(*rows).ok(),
        Some(_) => None,
    };
    rows.map(Some)
        .ok_or_else(|| "the number of rows is no whole number".into())
}

/// A matrix by compressed columns.
fn sparse(group: &Group, rows: u64, length: u64) -> Told<Matrix> {
    let said = |e: hdf5_pure::Error| e.to_string();
    let known = group.datasets().map_err(said)?;
    let set = |name: &str| -> Told<Option<Dataset>> {
        if !known.iter().any(|other| other == name) {
            return Ok(None);
        }
        group.dataset(name).map(Some).map_err(said)
    };
    let indices = |name: &str| -> Told<Vec<u64>> {
        let Some(set) = set(name)? else { return Ok(Vec::new()) };
        let shape = set.shape().map_err(said)?;
        let count = shape.iter().try_fold(1_u64, |all, n| all.checked_mul(*n));
        if count.is_none_or(|count| count > length.saturating_mul(MOST)) {
            return Err(format!("{name} has {shape:?} numbers in a file of {length} bytes"));
        }
        set.read_u64().map_err(said)
    };
    let (starts, row) = (indices("jc")?, indices("ir")?);
    let columns = starts.len().saturating_sub(1) as u64;
    if rows > length.max(SMALL) || columns > length.max(SMALL) {
        return Err(format!("{rows} x {columns} in a file of {length} bytes"));
    }
    // The values are a list, which is a table with one row for Numbers.
    let (values, is_complex) = match set("data")? {
        None => (Vec::new(), false),
        Some(data) => list(&data, length)?,
    };
    let parts = if is_complex { 2 } else { 1 };
    let damaged = || "the rows or columns of its entries are damaged".to_owned();
    if values.len() != parts * row.len() || starts.last().copied() != Some(row.len() as u64) {
        return Err(damaged());
    }
    let mut matrix = Matrix::empty((rows as usize, columns as usize), Symmetry::General, is_complex);
    for (column, ends) in starts.windows(2).enumerate() {
        let (first, end) = (ends[0] as usize, ends[1] as usize);
        for k in first..end {
            let row = row.get(k).copied().filter(|row| *row < rows).ok_or_else(damaged)?;
            let value = if is_complex {
                (values[2 * k], values[2 * k + 1])
            } else {
                (values[k], 0.0)
            };
            add(&mut matrix, (row as usize, column), value)?;
        }
    }
    Ok(matrix.finished())
}

/// The values of a sparse matrix, and whether they are complex.
fn list(data: &Dataset, length: u64) -> Told<(Vec<f64>, bool)> {
    let said = |e: hdf5_pure::Error| e.to_string();
    let shape = data.shape().map_err(said)?;
    let size = data.element_size().map_err(said)?;
    let bytes = shape.iter().try_fold(size, |all, n| all.checked_mul(*n));
    if bytes.is_none_or(|bytes| bytes > length.saturating_mul(MOST)) {
        return Err(format!("data has {shape:?} numbers in a file of {length} bytes"));
    }
    if let DType::Compound(parts) = data.dtype().map_err(said)? {
        if parts.len() != 2 || size != 16 {
            return Err("its values are no numbers".into());
        }
        let raw = data.read_raw().map_err(said)?;
        let part = |bytes: &[u8]| bytes.try_into().map_or(f64::NAN, f64::from_le_bytes);
        return Ok((raw.chunks_exact(8).map(part).collect(), true));
    }
    Ok((data.read_f64().map_err(said)?, false))
}
