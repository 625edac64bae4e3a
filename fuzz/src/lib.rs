//! What is done with input of any bytes: it is accepted or refused, and what was accepted can be used. Each function
//! returns whether it was accepted.

use hbvib::{MatrixKind, MatrixView, Model, Part, Storage, Values};
use std::fs;
use std::path::{Path, PathBuf};

#[allow(dead_code)]
#[path = "../../crates/hbvib-cli/src/job_file/mod.rs"]
mod job_file;
/// Decks, without the rest of what the command has on meshes.
#[allow(dead_code)]
#[path = "."]
mod meshes {
    #[path = "../../crates/hbvib-cli/src/meshes/inp_cards.rs"]
    pub mod inp_cards;
    #[path = "../../crates/hbvib-cli/src/meshes/mesh.rs"]
    pub mod mesh;
    #[path = "../../crates/hbvib-cli/src/meshes/mesh_elements.rs"]
    pub mod mesh_elements;
}
#[path = "."]
mod texts {
    #[path = "../../crates/hbvib-cli/src/texts/outcome.rs"]
    pub mod outcome;
}

/// Numbers from bytes, zeros after the last.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn byte(&mut self) -> u8 {
        let Some((&first, rest)) = self.0.split_first() else {
            return 0;
        };
        self.0 = rest;
        first
    }

    /// A small number, or rarely any.
    fn index(&mut self) -> i64 {
        match self.byte() {
            255 => i64::from_le_bytes(std::array::from_fn(|_| self.byte())),
            small => i64::from(small % 16) - 1,
        }
    }

    fn value(&mut self) -> f64 {
        match self.byte() {
            255 => f64::from_le_bytes(std::array::from_fn(|_| self.byte())),
            small => f64::from(small) / 16.0 - 4.0,
        }
    }
}

/// A matrix of the caller as the C interface takes it: order, layout, part, indices and values.
pub fn matrix(data: &[u8]) -> bool {
    let mut bytes = Bytes(data);
    let n = usize::from(bytes.byte() % 8) + 1;
    let (layout, part, which) = (bytes.byte(), bytes.byte(), bytes.byte());
    let (rows, cols) = match bytes.byte() {
        0 => (bytes.index().unsigned_abs() as usize, n),
        1 => (n, bytes.index().unsigned_abs() as usize),
        _ => (n, n),
    };
    let index_base = usize::from(bytes.byte() % 2);
    let entries = usize::from(bytes.byte()).min(4 * n * n);
    let col_ptr: Vec<i64> = (0..=n).map(|_| bytes.index()).collect();
    let row_idx: Vec<i64> = (0..entries).map(|_| bytes.index()).collect();
    let ld = usize::from(bytes.byte() % 16);
    let values: Vec<f64> = (0..entries.max(n * n)).map(|_| bytes.value()).collect();
    let view = MatrixView {
        rows,
        cols,
        storage: match layout % 3 {
            0 => Storage::ColMajor { ld },
            1 => Storage::RowMajor { ld },
            _ => Storage::Csc {
                col_ptr: &col_ptr,
                row_idx: &row_idx,
            },
        },
        values: Values::Real(&values),
        part: [
            Part::Full,
            Part::Lower,
            Part::Upper,
            Part::General,
            Part::Symmetric,
            Part::SymmetricLower,
            Part::SymmetricUpper,
        ][usize::from(part % 7)],
        index_base,
    };
    let kind = [
        MatrixKind::Mass,
        MatrixKind::Damping,
        MatrixKind::Stiffness,
        MatrixKind::Structural,
    ][usize::from(which % 4)];
    let mut model = Model::new(n).expect("a model");
    model.set_matrix(kind, &view).is_ok()
}

/// A saved model as it is, and with length and checksum that fit; one that is accepted is saved to the same bytes again
/// and again.
pub fn saved_model(data: &[u8]) -> bool {
    let mut sealed = data.to_vec();
    if let Some(length) = data.len().checked_sub(HEAD + TAIL) {
        let end = data.len() - TAIL;
        sealed[HEAD - 8..HEAD].copy_from_slice(&(length as u64).to_le_bytes());
        let sum = checksum(&sealed[..end]);
        sealed[end..].copy_from_slice(&sum.to_le_bytes());
    }
    let accepted = [data, &sealed].map(|bytes| {
        let Ok(model) = Model::load(bytes) else { return false };
        let again = model.save().expect("a loaded model can be saved");
        let twice = Model::load(&again).expect("and loaded").save().expect("and saved");
        assert_eq!(again, twice);
        true
    });
    accepted.contains(&true)
}

/// Bytes before the content of a saved model, the last eight its length, and the checksum after it.
const HEAD: usize = 24;
const TAIL: usize = 8;

/// CRC-64/XZ.
fn checksum(bytes: &[u8]) -> u64 {
    !bytes.iter().fold(!0, |sum: u64, &byte| {
        (0..8).fold(sum ^ u64::from(byte), |sum, _| {
            (sum >> 1) ^ if sum & 1 == 1 { 0xC96C_5795_D787_0F42 } else { 0 }
        })
    })
}

/// A file of these bytes, in memory where the system has that.
fn file(name: &str, data: &[u8]) -> PathBuf {
    let memory = Path::new("/dev/shm");
    let folder = if memory.is_dir() {
        memory.to_owned()
    } else {
        std::env::temp_dir()
    };
    let path = folder.join(format!("hbvib-fuzz-{}-{name}", std::process::id()));
    fs::write(&path, data).expect("a file");
    path
}

/// A job file, and a mesh.
pub fn job(data: &[u8]) -> bool {
    let path = file("job.toml", data);
    let accepted = job_file::job::Job::read(&path).is_ok();
    let mesh = meshes::mesh::Mesh::read(&path).is_ok();
    let _ = fs::remove_file(path);
    accepted || mesh
}

/// Files of matrices, of the format that the first byte selects, and universal files; the three files of CalculiX are separated by
/// zeros.
pub fn element_files(data: &[u8]) -> bool {
    let (&format, content) = data.split_first().unwrap_or((&0, data));
    let format = usize::from(format) % (NAMES.len() + 1);
    let Some(name) = NAMES.get(format) else {
        let mut parts = content.splitn(3, |&byte| byte == 0);
        let paths = ["a.dof", "a.sti", "a.mas"].map(|name| file(name, parts.next().unwrap_or_default()));
        let accepted = hbvib_io::read(&paths[1]).is_ok();
        for path in paths {
            let _ = fs::remove_file(path);
        }
        return accepted;
    };
    let path = file(name, content);
    let accepted = hbvib_io::read(&path).is_ok() || hbvib_io::read_universal(&path).is_ok();
    let _ = fs::remove_file(path);
    accepted
}

/// Names that lead to each reader; the number after the last one is a job of CalculiX.
pub const NAMES: [&str; 11] = [
    "a.mtx",
    "a.op4",
    "a.rsa",
    "K_STIF1.mtx",
    "a.mtx.gz",
    "a.npz",
    "a.mat",
    "a.full",
    "a.pch",
    "a.inp",
    "a.uff",
];
