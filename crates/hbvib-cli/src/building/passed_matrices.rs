//! Matrices of files as the library takes them: compressed columns of all entries, and the symmetry that they have.
//!
//! Formats that list all entries do not name a symmetry. The library takes such a complex matrix as Hermitian, and a stiffness with loss,
//! K(1 + iη), is symmetric instead: equal to its transpose, not to its conjugate one. The entries tell which of both it is.

use hbvib::{MatrixView, Part, Storage, Values};
use hbvib_io::{Matrix, Symmetry};
use num_complex::Complex64;

/// Deviation from symmetry over the largest entry that is rounding; the library removes as much by averaging.
const MIRROR_ROUNDING: f64 = 1e-10;

/// Passes a matrix as compressed columns, all entries of it.
pub fn with_view<R>(a: &Matrix, take: impl FnOnce(&MatrixView<'_>) -> R) -> R {
    let entries = entries(a);
    let mut col_ptr = vec![0_i64; a.columns + 1];
    for &(_, j, _) in &entries {
        col_ptr[j as usize + 1] += 1;
    }
    for j in 0..a.columns {
        col_ptr[j + 1] += col_ptr[j];
    }
    let row_idx: Vec<i64> = entries.iter().map(|&(i, ..)| i64::from(i)).collect();
    let real: Vec<f64> = entries.iter().map(|(_, _, v)| v.re).collect();
    let complex: Vec<Complex64> = entries.iter().map(|(_, _, v)| *v).collect();
    take(&MatrixView {
        rows: a.rows,
        cols: a.columns,
        storage: Storage::Csc {
            col_ptr: &col_ptr,
            row_idx: &row_idx,
        },
        values: if a.is_complex {
            Values::Complex(&complex)
        } else {
            Values::Real(&real)
        },
        part: match a.symmetry {
            Symmetry::Skew => Part::General,
            Symmetry::Symmetric => Part::Symmetric,
            Symmetry::General if a.is_complex && is_complex_symmetric(&entries) => Part::Symmetric,
            Symmetry::General | Symmetry::Hermitian => Part::Full,
        },
        index_base: 0,
    })
}

/// Row, column and value.
type Entry = (u32, u32, Complex64);

/// All entries, column after column.
fn entries(a: &Matrix) -> Vec<Entry> {
    let parts = if a.is_complex { 2 } else { 1 };
    let mut entries: Vec<Entry> = Vec::with_capacity(2 * a.entries());
    for (k, v) in a.values.chunks_exact(parts).enumerate() {
        let (i, j) = (a.row[k], a.column[k]);
        let v = Complex64::new(v[0], v.get(1).copied().unwrap_or(0.0));
        entries.push((i, j, v));
        if i != j {
            match a.symmetry {
                Symmetry::General => {}
                Symmetry::Symmetric => entries.push((j, i, v)),
                Symmetry::Hermitian => entries.push((j, i, v.conj())),
                Symmetry::Skew => entries.push((j, i, -v)),
            }
        }
    }
    entries.sort_unstable_by_key(|&(i, j, _)| (j, i));
    entries
}

/// Whether a matrix with an imaginary part is equal to its transpose: a Hermitian one that is has none.
fn is_complex_symmetric(entries: &[Entry]) -> bool {
    let mut merged: Vec<Entry> = Vec::with_capacity(entries.len());
    for &(i, j, v) in entries {
        match merged.last_mut() {
            Some(last) if (last.0, last.1) == (i, j) => last.2 += v,
            _ => merged.push((i, j, v)),
        }
    }
    let rounding = MIRROR_ROUNDING * merged.iter().map(|(.., v)| v.norm()).fold(0.0, f64::max);
    let mut mirrored = merged.clone();
    mirrored.sort_unstable_by_key(|&(i, j, _)| (i, j));
    let is_symmetric = merged
        .iter()
        .zip(&mirrored)
        .all(|(a, b)| (a.0, a.1) == (b.1, b.0) && (a.2 - b.2).norm() <= rounding);
    is_symmetric && merged.iter().any(|(.., v)| 2.0 * v.im.abs() > rounding)
}
