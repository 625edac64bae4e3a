//! Writes matrices as NumPy arrays in a ZIP archive (.npz), compressed columns as scipy has them, to the last bit.
//!
//! One matrix is a file of `scipy.sparse.save_npz`; several have the names of its arrays after the letter of the matrix: `K_data`,
//! `K_indices`, `K_indptr`, `K_shape`, `K_format`, and M, C, D alike. Nodes and directions are the array `dofs`.

use crate::Result;
use crate::columns::Columns;
use crate::error::Error;
use crate::matrix::{Dof, Matrices, Matrix};
use crate::output_file::{OutputFile, check, order};
use flate2::Crc;
use std::path::Path;

/// Writes the matrices of one model.
///
/// # Errors
/// No matrix, matrices of different sizes, numbers that are not finite, more than 4 GB; the reason of the system.
pub fn write_npz(path: &Path, matrices: &Matrices) -> Result<()> {
    order(path, matrices)?;
    let mut arrays = Vec::new();
    let single = matrices.named().count() == 1;
    for (kind, matrix) in matrices.named() {
        let prefix = match kind {
            _ if single => "",
            "stiffness" => "K_",
            "mass" => "M_",
            "damping" => "C_",
            _ => "D_",
        };
        arrays.extend(sparse(prefix, matrix));
    }
    if !matrices.dofs.is_empty() {
        arrays.push(dof_table(&matrices.dofs));
    }
    archive(path, &arrays)
}

/// Writes one matrix, of any shape, as `scipy.sparse.save_npz` does.
///
/// # Errors
/// Numbers that are not finite, more than 4 GB; the reason of the system.
pub fn write_scipy_npz(path: &Path, matrix: &Matrix) -> Result<()> {
    check(path, "the matrix", matrix)?;
    archive(path, &sparse("", matrix))
}

/// An array: name, type, shape and bytes.
struct Npy {
    name: String,
    kind: &'static str,
    shape: String,
    bytes: Vec<u8>,
}

impl Npy {
    fn new(name: String, kind: &'static str, shape: String, bytes: Vec<u8>) -> Self {
        Self {
            name,
            kind,
            shape,
            bytes,
        }
    }

    /// The bytes of a file .npy, version 1.0.
    fn file(&self) -> Vec<u8> {
        let dictionary = format!(
            "{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}",
            self.kind, self.shape
        );
        // Magic bytes, length and dictionary fill a multiple of 64, the last byte is a new line.
        let room = (10 + dictionary.len() + 1).next_multiple_of(64) - 10 - 1;
        let mut all = b"\x93NUMPY\x01\x00".to_vec();
        all.extend(((room + 1) as u16).to_le_bytes());
        all.extend(format!("{dictionary:<room$}\n").bytes());
        all.extend(&self.bytes);
        all
    }
}

fn sparse(prefix: &str, a: &Matrix) -> Vec<Npy> {
    let columns = Columns::whole(a);
    let all = columns.all();
    let count = |n: usize| format!("({n},)");
    let value = |&(_, re, im): &(u32, f64, f64)| if a.is_complex { vec![re, im] } else { vec![re] };
    let data = all.iter().flat_map(value).flat_map(f64::to_le_bytes).collect();
    let indices = all.iter().flat_map(|entry| i64::from(entry.0).to_le_bytes()).collect();
    let pointers = columns
        .starts()
        .iter()
        .flat_map(|at| (*at as i64).to_le_bytes())
        .collect();
    let shape = [a.rows, a.columns]
        .iter()
        .flat_map(|n| (*n as i64).to_le_bytes())
        .collect();
    let name = |name: &str| format!("{prefix}{name}");
    let complex = if a.is_complex { "<c16" } else { "<f8" };
    vec![
        Npy::new(name("data"), complex, count(all.len()), data),
        Npy::new(name("indices"), "<i8", count(all.len()), indices),
        Npy::new(name("indptr"), "<i8", count(a.columns + 1), pointers),
        Npy::new(name("shape"), "<i8", count(2), shape),
        Npy::new(name("format"), "|S3", "()".into(), b"csc".to_vec()),
    ]
}

fn dof_table(dofs: &[Dof]) -> Npy {
    let bytes = dofs
        .iter()
        .flat_map(|dof| [dof.0, dof.1])
        .flat_map(i64::to_le_bytes)
        .collect();
    Npy::new("dofs".into(), "<i8", format!("({}, 2)", dofs.len()), bytes)
}

/// A ZIP archive of arrays, each stored as it is.
fn archive(path: &Path, arrays: &[Npy]) -> Result<()> {
    let mut file = OutputFile::create(path)?;
    let (mut at, mut directory) = (0_usize, Vec::new());
    for array in arrays {
        let body = array.file();
        let name = format!("{}.npy", array.name);
        let (Ok(offset), Ok(size)) = (u32::try_from(at), u32::try_from(body.len())) else {
            return Err(Error::new(path, 0, "more than 4 GB, needs less: write OP4 binary"));
        };
        let mut crc = Crc::new();
        crc.update(&body);
        // Version 2.0, stored, no time: 1 January 1980.
        let mut common = vec![20, 0, 0, 0, 0, 0, 0, 0, 33, 0];
        for number in [crc.sum(), size, size] {
            common.extend(number.to_le_bytes());
        }
        common.extend((name.len() as u16).to_le_bytes());
        common.extend([0, 0]);
        let head = [b"PK\x03\x04", &common[..], name.as_bytes()].concat();
        directory.extend(b"PK\x01\x02\x14\x00");
        directory.extend(&common);
        // Comment, disk, attributes.
        directory.extend([0; 10]);
        directory.extend(offset.to_le_bytes());
        directory.extend(name.bytes());
        at += head.len() + body.len();
        file.put(head)?;
        file.put(body)?;
    }
    let Ok(offset) = u32::try_from(at) else {
        return Err(Error::new(path, 0, "more than 4 GB, needs less: write OP4 binary"));
    };
    let count = (arrays.len() as u16).to_le_bytes();
    let length = (directory.len() as u32).to_le_bytes();
    file.put(&directory)?;
    let end = [
        b"PK\x05\x06\x00\x00\x00\x00",
        &count[..],
        &count,
        &length,
        &offset.to_le_bytes(),
        &[0, 0],
    ]
    .concat();
    file.put(end)?;
    file.finish()
}
