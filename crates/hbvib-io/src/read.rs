//! Reading a file of any format, which its name and first line tell.

use crate::error::Error;
use crate::lines::Lines;
use crate::matrix::{Matrices, Matrix};
use crate::{
    Result, abaqus, ansys_full, calculix, dmig, harwell_boeing, matlab, matrix_market, npy, numpy_archive, op4,
    op4_binary, unreadable, user_element,
};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Bytes at the start of a file by which a format is known.
const START: u64 = 4096;

/// Reads the matrices of a file.
///
/// | format | recognised by | holds |
/// |---|---|---|
/// | Matrix Market, also gzipped | `%%MatrixMarket`, in any case | one matrix |
/// | CalculiX | `.sti`, `.mas`, `.dof`: all files of the job | stiffness, mass, degrees of freedom |
/// | Nastran OP4, text or binary | `.op4`, or the head of a matrix | matrices whose names begin with K, M, B, K4 |
/// | Nastran DMIG | a line that begins with `DMIG`, `.pch` | matrices by name, as OP4; nodes and directions |
/// | NumPy and scipy | `.npz`, `.npy` | matrices named K, M, C, D or stiffness, mass, ..., or one matrix |
/// | Ansys .full | the head of the file | stiffness, mass; nodes and directions |
/// | MATLAB 5 | `.mat` of `save -v6` and `-v7` | as NumPy |
/// | MATLAB 7.3, with the feature `hdf5` | `.mat` of `save -v7.3` | as NumPy |
/// | Abaqus and CalculiX superelements | `*USER ELEMENT`, `*MATRIX, TYPE=` | stiffness, mass; nodes and directions |
/// | Abaqus | `.mtx` | one matrix: MASS or DMP in the name of the file tell which |
/// | Harwell-Boeing text | else | one matrix |
///
/// One matrix of an unknown kind is returned as stiffness.
///
/// # Errors
/// File, line and reason.
pub fn read(path: &Path) -> Result<Matrices> {
    let extension = path
        .extension()
        .and_then(|e| e.to_str())
        .unwrap_or("")
        .to_ascii_lowercase();
    if calculix::EXTENSIONS.contains(&extension.as_str()) {
        return calculix::matrices(path);
    }
    if path.is_dir() {
        return Err(Error::new(path, 0, "is a folder, needs a file with matrices"));
    }
    let start = start(path)?;
    if op4_binary::is_head(&start) {
        return op4_binary::matrices(path);
    }
    if start.starts_with(b"PK\x03\x04") || start.starts_with(npy::MAGIC) {
        return numpy_archive::matrices(path);
    }
    #[cfg(feature = "hdf5")]
    if crate::matlab_hdf5::is_head(&start) {
        return crate::matlab_hdf5::matrices(path);
    }
    if matlab::is_head(&start) {
        return matlab::matrices(path);
    }
    if ansys_full::kind(&start).is_some_and(ansys_full::is_full) {
        return ansys_full::matrices(path);
    }
    if let Some(sentence) = unreadable::format(path, &start) {
        return Err(Error::new(path, 0, sentence));
    }
    let mut lines = Lines::open(path)?;
    let text = String::from_utf8_lossy(&start);
    if extension == "pch" || dmig::is_dmig(&text) {
        return dmig::matrices(&mut lines);
    }
    if user_element::is_user_element(&text) {
        return user_element::matrices(&mut lines).map(|found| doubted(found, &lines));
    }
    lines.expect("a matrix")?;
    if matrix_market::is_banner(lines.text()) {
        return matrix_market::matrix(&mut lines).map(|found| doubted(one(found), &lines));
    }
    if extension == "op4" || op4::is_head(lines.text()) {
        return op4::matrices(&mut lines).map(|found| doubted(found, &lines));
    }
    if extension == "mtx" {
        lines.repeat();
        return abaqus_matrix(path, &mut lines);
    }
    if lines.text().starts_with(['*', '%']) {
        return Err(Error::new(
            path,
            1,
            "the format is unknown: Matrix Market, Abaqus .mtx, CalculiX .sti, superelements (*USER ELEMENT), Harwell-Boeing, OP4, \
             DMIG and .npz are read",
        ));
    }
    harwell_boeing::matrix(&mut lines).map(|found| doubted(one(found), &lines))
}

/// Files of formats that count their numbers miss none of them, but may be cut off within the last one: programs that do not end the
/// last line write them, too.
fn doubted(mut found: Matrices, lines: &Lines) -> Matrices {
    found.doubts.extend(lines.cut_number());
    found
}

/// The first bytes of a file.
fn start(path: &Path) -> Result<Vec<u8>> {
    let failed = |error: std::io::Error| Error::new(path, 0, format_args!("cannot be read: {error}"));
    let mut bytes = Vec::new();
    File::open(path)
        .map_err(failed)?
        .take(START)
        .read_to_end(&mut bytes)
        .map_err(failed)?;
    Ok(bytes)
}

fn one(matrix: Matrix) -> Matrices {
    Matrices {
        stiffness: Some(matrix),
        ..Matrices::default()
    }
}

/// Abaqus calls its files job_STIF1.mtx, job_MASS1.mtx, job_DMPV1.mtx (viscous damping).
fn abaqus_matrix(path: &Path, lines: &mut Lines) -> Result<Matrices> {
    let (matrix, dofs) = abaqus::matrix(lines)?;
    let name = path
        .file_stem()
        .and_then(|name| name.to_str())
        .unwrap_or("")
        .to_ascii_uppercase();
    let mut found = Matrices {
        dofs,
        ..Matrices::default()
    };
    if name.contains("_MASS") {
        found.mass = Some(matrix);
    } else if name.contains("_DMP") {
        found.damping = Some(matrix);
    } else {
        found.stiffness = Some(matrix);
    }
    Ok(found)
}
