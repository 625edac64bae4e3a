//! Small files of each format, cut and changed at every byte, are read or refused: no panic, and no memory beyond a multiple of the
//! file.

mod counting;

use counting::{MOST, USED};
use hbvib_io::{Format, Matrices, Matrix, Symmetry, read, read_universal, report, write};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

/// Buffers of readers, which do not grow with the file.
const BUFFERS: usize = 256 << 10;

/// Bytes of memory for a byte of a file.
const PLAIN: usize = 40;

/// The same where the file is packed: deflated bytes grow by 1032 at most, in a buffer that doubles.
const PACKED: usize = 4 * 1032;

/// Where files of mutations are: in memory if the system has that.
fn folder() -> PathBuf {
    let memory = Path::new("/dev/shm");
    let place = if memory.is_dir() {
        memory.to_owned()
    } else {
        std::env::temp_dir()
    };
    place.join(format!("hbvib_io_mutations_{}", std::process::id()))
}

/// A reader of a file, which returns the sentence of a refusal.
type Reader = fn(&Path) -> Result<(), String>;

fn matrices(path: &Path) -> Result<(), String> {
    let found = read(path).map_err(|error| error.to_string())?;
    assert!(found.named().next().is_some());
    for (_, a) in found.named() {
        let parts = if a.is_complex { 2 } else { 1 };
        assert_eq!((a.row.len(), parts * a.row.len()), (a.column.len(), a.values.len()));
        assert!(a.row.iter().all(|i| (*i as usize) < a.rows) && a.column.iter().all(|j| (*j as usize) < a.columns));
        assert!(a.values.iter().all(|v| v.is_finite()));
    }
    Ok(())
}

/// The report on what was read takes memory for each row, and must not panic either.
fn reported(path: &Path) -> Result<(), String> {
    let found = read(path).map_err(|error| error.to_string())?;
    let _ = report(&found);
    Ok(())
}

fn universal(path: &Path) -> Result<(), String> {
    read_universal(path).map(drop).map_err(|error| error.to_string())
}

/// Files that writers make, and those of other programs.
fn originals(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let dense = |shift: f64| Matrix {
        rows: 3,
        columns: 3,
        symmetry: Symmetry::Symmetric,
        row: vec![0, 1, 1, 2, 2],
        column: vec![0, 0, 1, 1, 2],
        values: vec![4.0 + shift, -1.0, 4.0, -1.0 / 3.0, 4.0],
        is_complex: false,
    };
    let model = Matrices {
        stiffness: Some(dense(0.5)),
        mass: Some(dense(100.0)),
        dofs: vec![(1, 1), (1, 2), (4, 1)],
        ..Matrices::default()
    };
    let sparse = Matrices {
        stiffness: Some(Matrix {
            row: vec![0, 1, 2],
            column: vec![0, 1, 2],
            values: vec![1.0, 2.0, 3.0],
            ..dense(0.0)
        }),
        mass: None,
        ..model.clone()
    };
    let mut all = Vec::new();
    for (name, model, format) in [
        ("a.op4", &model, Format::Op4Text),
        ("b.op4", &sparse, Format::Op4Text),
        ("c.op4", &model, Format::Op4Binary),
        ("d.op4", &sparse, Format::Op4Binary),
        ("e.pch", &model, Format::Dmig),
        ("f.inp", &model, Format::UserElement),
        ("g.npz", &sparse, Format::Npz),
        ("h.mtx", &sparse, Format::MatrixMarket),
    ] {
        let path = folder.join(name);
        write(&path, model, format).unwrap();
        all.push((name.to_owned(), std::fs::read(path).unwrap()));
    }
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    for name in [
        "small.mat",
        "packed.mat",
        "packed.npz",
        "small.full",
        "wide.op4",
        "general.rua",
        "wheel_STIF1.mtx",
        "symmetric.mtx.gz",
        "hermitian.mtx",
    ] {
        all.push((name.to_owned(), std::fs::read(data.join(name)).unwrap()));
    }
    all
}

/// Reads a file of these bytes, and returns whether it was accepted.
fn accepted(reader: Reader, (path, bytes): (&Path, &[u8]), most: usize, change: &str) -> bool {
    std::fs::write(path, bytes).unwrap();
    let before = USED.load(Ordering::Relaxed);
    MOST.store(before, Ordering::Relaxed);
    let outcome = std::panic::catch_unwind(|| reader(path));
    let memory = MOST.load(Ordering::Relaxed).saturating_sub(before);
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    let Ok(outcome) = outcome else {
        panic!("{name}, {change}: the reader panicked");
    };
    assert!(
        memory <= most * bytes.len() + BUFFERS,
        "{name}, {change}: {memory} bytes for a file of {}",
        bytes.len()
    );
    match outcome {
        Ok(()) => true,
        Err(sentence) => {
            assert!(
                sentence.contains(&name) && sentence.len() < 1000,
                "{name}, {change}: {sentence}"
            );
            false
        }
    }
}

/// All cuts and changes of a file, and the number of those that were accepted.
fn mutated(reader: Reader, path: &Path, good: &[u8], most: usize) -> (usize, usize) {
    let (mut count, mut taken) = (0, 0);
    let mut one = |bytes: &[u8], change: &str| {
        count += 1;
        taken += usize::from(accepted(reader, (path, bytes), most, change));
    };
    for at in 0..good.len() {
        one(&good[..at], &format!("cut at {at}"));
        let mut bytes = good.to_vec();
        for flip in [0x01, 0x80, 0xff] {
            bytes[at] = good[at] ^ flip;
            one(&bytes, &format!("byte {at} changed by {flip:#x}"));
        }
        for byte in *b"9- \n" {
            bytes[at] = byte;
            one(&bytes, &format!("byte {at} set to {byte}"));
        }
        bytes.remove(at);
        one(&bytes, &format!("byte {at} removed"));
    }
    (count, taken)
}

#[test]
fn files_cut_and_changed_at_each_byte_are_read_or_refused() {
    let folder = folder();
    std::fs::create_dir_all(&folder).unwrap();
    let outcome = std::panic::catch_unwind(|| {
        for (name, good) in originals(&folder) {
            let path = folder.join(&name);
            let most = if name.contains("packed") || name.contains(".gz") {
                PACKED
            } else {
                PLAIN
            };
            assert!(accepted(matrices, (&path, &good), most, "unchanged"), "{name}");
            let (count, taken) = mutated(matrices, &path, &good, most);
            assert!(count == 9 * good.len() && taken < count, "{name}: {taken} of {count}");
            // Reports take memory by rows, at most a million of them.
            for at in (0..good.len()).step_by(7) {
                let mut bytes = good.clone();
                bytes[at] ^= 0x55;
                accepted(reported, (&path, &bytes), 1 << 30, &format!("byte {at} of a report"));
            }
        }
        let good = std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/shapes.uff")).unwrap();
        let path = folder.join("shapes.uff");
        assert!(accepted(universal, (&path, &good), PLAIN, "unchanged"));
        mutated(universal, &path, &good, PLAIN);
    });
    let _ = std::fs::remove_dir_all(&folder);
    if let Err(told) = outcome {
        std::panic::resume_unwind(told);
    }
}
