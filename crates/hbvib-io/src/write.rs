//! Writing matrices in a format that a name tells.

use crate::Result;
use crate::error::Error;
use crate::matrix::{Matrices, Matrix};
use crate::write_dmig::write_dmig;
use crate::write_market::write_matrix_market;
use crate::write_npz::write_npz;
use crate::write_op4::{Op4Form, write_op4};
use crate::write_user_element::write_user_element;
use std::path::{Path, PathBuf};

/// Formats that are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Nastran OP4 as text, with the names of EXTSEOUT.
    Op4Text,
    /// Nastran OP4 binary, with the names of EXTSEOUT.
    Op4Binary,
    /// Nastran bulk data with DMIG.
    Dmig,
    /// `*USER ELEMENT` with `*MATRIX`, as substructures of Abaqus and CalculiX.
    UserElement,
    /// NumPy arrays of scipy's sparse matrices.
    Npz,
    /// Matrix Market, one file a matrix.
    MatrixMarket,
}

impl Format {
    /// All of them with their names in jobs and commands.
    pub const NAMES: [(&'static str, Self); 6] = [
        ("op4", Self::Op4Text),
        ("op4-binary", Self::Op4Binary),
        ("dmig", Self::Dmig),
        ("user-element", Self::UserElement),
        ("npz", Self::Npz),
        ("matrix-market", Self::MatrixMarket),
    ];

    /// The format that an extension tells: `.op4`, `.pch` and `.bdf` (DMIG), `.inp` (user element), `.npz`, `.mtx` (Matrix Market).
    #[must_use]
    pub fn of_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "op4" => Some(Self::Op4Text),
            "pch" | "bdf" | "dat" | "nas" => Some(Self::Dmig),
            "inp" => Some(Self::UserElement),
            "npz" => Some(Self::Npz),
            "mtx" | "mm" => Some(Self::MatrixMarket),
            _ => None,
        }
    }
}

/// Writes matrices of one model, and returns the files. Several matrices in Matrix Market are a file each, whose names end with
/// `_stiffness`, `_mass`, `_damping` and `_structural`.
///
/// # Errors
/// A format that cannot hold these matrices; the reason of the system.
pub fn write(path: &Path, matrices: &Matrices, format: Format) -> Result<Vec<PathBuf>> {
    match format {
        Format::Op4Text => write_op4(path, matrices, Op4Form::Text)?,
        Format::Op4Binary => write_op4(path, matrices, Op4Form::Binary)?,
        Format::Dmig => write_dmig(path, matrices)?,
        Format::UserElement => write_user_element(path, matrices)?,
        Format::Npz => write_npz(path, matrices)?,
        Format::MatrixMarket => {
            let all: Vec<(&str, &Matrix)> = matrices.named().collect();
            if let [(_, matrix)] = all[..] {
                write_matrix_market(path, matrix)?;
                return Ok(vec![path.to_owned()]);
            }
            let mut files = Vec::new();
            let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let extension = path
                .extension()
                .map_or("mtx".into(), |e| e.to_string_lossy().into_owned());
            for (name, matrix) in all {
                let file = path.with_file_name(format!("{stem}_{name}.{extension}"));
                write_matrix_market(&file, matrix)?;
                files.push(file);
            }
            if files.is_empty() {
                return Err(Error::new(path, 0, "there is no matrix to write"));
            }
            return Ok(files);
        }
    }
    Ok(vec![path.to_owned()])
}
