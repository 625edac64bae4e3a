//! A matrix row by row, with mirror images and sums of entries at one place.

use crate::matrix::{Matrix, Symmetry};

/// The real part of a square matrix; that of the loss is of no use to a check of consistency.
pub(crate) struct Rows {
    starts: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl Rows {
    /// All entries of a matrix.
    pub fn of(a: &Matrix) -> Self {
        let parts = if a.is_complex { 2 } else { 1 };
        let mut entries: Vec<(u32, u32, f64)> = Vec::with_capacity(2 * a.entries());
        for (k, value) in a.values.chunks_exact(parts).enumerate() {
            let (i, j, v) = (a.row[k], a.column[k], value[0]);
            entries.push((i, j, v));
            if i != j && a.symmetry != Symmetry::General {
                entries.push((j, i, if a.symmetry == Symmetry::Skew { -v } else { v }));
            }
        }
        entries.sort_unstable_by_key(|&(i, j, _)| (i, j));
        entries.dedup_by(|next, kept| {
            let same = (next.0, next.1) == (kept.0, kept.1);
            if same {
                kept.2 += next.2;
            }
            same
        });
        let mut starts = vec![0; a.rows + 1];
        for &(i, ..) in &entries {
            starts[i as usize + 1] += 1;
        }
        for i in 0..a.rows {
            starts[i + 1] += starts[i];
        }
        Self {
            starts,
            columns: entries.iter().map(|e| e.1).collect(),
            values: entries.iter().map(|e| e.2).collect(),
        }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Columns and values of a row.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.starts[i]..self.starts[i + 1];
        self.columns[range.clone()]
            .iter()
            .map(|j| *j as usize)
            .zip(self.values[range].iter().copied())
    }

    /// An entry, 0 where there is none.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let range = self.starts[i]..self.starts[i + 1];
        match self.columns[range.clone()].binary_search(&(j as u32)) {
            Ok(at) => self.values[range.start + at],
            Err(_) => 0.0,
        }
    }

    /// The diagonal.
    pub fn diagonal(&self) -> Vec<f64> {
        (0..self.len()).map(|i| self.get(i, i)).collect()
    }

    /// Rows that a penalty on the diagonal holds, as the 1e36 that Abaqus writes for fixed degrees of freedom: it exceeds the
    /// sum of the entries beside it, or without them the diagonals of all rows with couplings, by more than 1/ε.
    pub fn fixed_by_penalty(&self) -> Vec<bool> {
        let exceeds = |own: f64, rest: f64| own * f64::EPSILON > rest;
        let beside = |i: usize| self.row(i).filter(|(j, _)| *j != i).map(|(_, v)| v.abs()).sum::<f64>();
        let rows: Vec<(f64, f64)> = (0..self.len()).map(|i| (self.get(i, i), beside(i))).collect();
        let moving = || rows.iter().filter(|(own, rest)| *rest > 0.0 && !exceeds(*own, *rest));
        let largest = moving().fold(0.0_f64, |m, (own, _)| m.max(*own));
        let any = moving().next().is_some();
        let held = |(own, rest): &(f64, f64)| {
            if *rest > 0.0 {
                exceeds(*own, *rest)
            } else {
                any && exceeds(*own, largest)
            }
        };
        rows.iter().map(held).collect()
    }
}
