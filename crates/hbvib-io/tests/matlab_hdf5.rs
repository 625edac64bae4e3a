//! MATLAB files of version 7.3, which libhdf5 wrote in the layout of MATLAB: see `data/make.py`.

#![cfg(feature = "hdf5")]

mod counting;

use counting::{MOST, USED};
use hbvib_io::{Matrix, read};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

fn whole(a: &Matrix) -> Vec<[(f64, f64); 3]> {
    let mut all = vec![[(0.0, 0.0); 3]; 3];
    let parts = if a.is_complex { 2 } else { 1 };
    for ((i, j), v) in a.row.iter().zip(&a.column).zip(a.values.chunks_exact(parts)) {
        all[*i as usize][*j as usize] = (v[0], v.get(1).copied().unwrap_or(0.0));
    }
    all
}

#[test]
fn tables_and_sparse_matrices_are_read_by_their_names() {
    for name in ["version73.mat", "packed73.mat"] {
        let found = read(&data(name)).unwrap();
        let k = [[4.0, -1.0, 0.5], [-1.0, 4.0, -1.0], [0.25, -1.0, 4.0]];
        let real = |a: [[f64; 3]; 3]| a.map(|row| row.map(|v| (v, 0.0))).to_vec();
        assert_eq!(whole(&found.stiffness.unwrap()), real(k), "{name}");
        assert_eq!(
            whole(&found.damping.unwrap()),
            real(k.map(|row| row.map(|v| 0.5 * v))),
            "{name}"
        );
        assert_eq!(
            whole(&found.mass.unwrap()),
            real([[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]])
        );
        let o = (0.0, 0.0);
        let d = vec![[o, (1.0, -2.0), o], [o, o, o], [(0.0, 3.0), o, (0.5, 0.0)]];
        assert_eq!(whole(&found.structural.unwrap()), d, "{name}");
        assert_eq!(found.dofs, [(1, 1), (1, 2), (2, 1)]);
        assert_eq!(found.others, ["dt", "title", "settings"]);
    }
}

#[test]
fn damaged_files_are_read_or_refused() {
    damaged(173);
}

/// Two minutes.
#[test]
#[ignore = "reads 30,000 files"]
fn files_damaged_at_each_third_byte_are_read_or_refused() {
    damaged(3);
}

/// Files that are changed at some bytes, and cut.
fn damaged(step: usize) {
    let path = std::env::temp_dir().join(format!("hbvib_io_{}_{step}_73.mat", std::process::id()));
    for name in ["version73.mat", "packed73.mat"] {
        let good = std::fs::read(data(name)).unwrap();
        let (mut count, mut refused) = (0, 0);
        let mut tried = |bytes: &[u8]| {
            std::fs::write(&path, bytes).unwrap();
            let before = USED.load(Ordering::Relaxed);
            MOST.store(before, Ordering::Relaxed);
            let outcome = std::panic::catch_unwind(|| read(&path));
            let memory = MOST.load(Ordering::Relaxed).saturating_sub(before);
            let outcome = outcome.unwrap_or_else(|_| panic!("{name}: the reader panicked"));
            assert!(memory < 64 << 20, "{name}: {memory} bytes");
            count += 1;
            if let Err(e) = outcome {
                refused += 1;
                assert!(e.to_string().contains("_73.mat"), "{e}");
            }
        };
        for at in (0..good.len()).step_by(step) {
            for flip in [0x01, 0x80, 0xff] {
                let mut bytes = good.clone();
                bytes[at] ^= flip;
                tried(&bytes);
            }
        }
        for at in (0..good.len()).step_by(10 * step) {
            tried(&good[..at]);
        }
        assert!(refused > count / 20, "{name}: {refused} of {count}");
    }
    std::fs::remove_file(&path).unwrap();
}
