//! Arrays of numbers of a NumPy archive (.npz) and vectors of a MATLAB file, for callers that know their names.

use crate::Result;
use crate::bytes_read::whole_file;
use crate::error::Error;
use crate::matlab;
use crate::npy::{Npy, array};
use crate::number_array::NumberArray;
use crate::zip_archive::members;
use std::path::Path;

/// Reads the arrays of numbers of an archive, or the vectors of a MATLAB file of version 5 (`save -v7`); all else is left out.
///
/// # Errors
/// File, array and reason.
pub fn read_number_arrays(path: &Path) -> Result<Vec<NumberArray>> {
    let bytes = whole_file(path)?;
    if matlab::is_head(&bytes) {
        return matlab::vectors(path, &bytes);
    }
    let said = |reason: String| Error::new(path, 0, format_args!("NumPy file: {reason}"));
    let mut all = Vec::new();
    for member in members(&bytes).map_err(said)? {
        let Some(name) = member.name.strip_suffix(".npy") else {
            continue;
        };
        let Npy::Numbers(found) = array(name, member.content(&bytes).map_err(said)?).map_err(said)? else {
            continue;
        };
        if found.is_by_columns() {
            return Err(said(format!(
                "{name} is stored by columns, needs rows (numpy.ascontiguousarray)"
            )));
        }
        let mut one = NumberArray {
            name: name.to_owned(),
            shape: found.shape.clone(),
            real: (0..found.len()).map(|k| found.value(k).0).collect(),
            imaginary: Vec::new(),
        };
        if found.is_complex() {
            one.imaginary = (0..found.len()).map(|k| found.value(k).1).collect();
        }
        all.push(one);
    }
    Ok(all)
}
