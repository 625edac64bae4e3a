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

    /// Rows whose diagonal exceeds all else by 1/ε, as the 1e36 that Abaqus writes for fixed degrees of freedom: the
    /// diagonals of all other rows, and the entries beside it.
    pub fn fixed_by_penalty(&self) -> Vec<bool> {
        let diagonal = self.diagonal();
        let mut sorted: Vec<f64> = diagonal.iter().copied().filter(|d| *d > 0.0).collect();
        sorted.sort_by(f64::total_cmp);
        let step = sorted.windows(2).position(|two| two[1] * f64::EPSILON > two[0]);
        let Some(least) = step.map(|at| sorted[at + 1]) else {
            return vec![false; self.len()];
        };
        let is_large: Vec<bool> = diagonal.iter().map(|d| *d >= least).collect();
        let alone = |i: usize| {
            let beside = self.row(i).filter(|(j, _)| *j != i && !is_large[*j]);
            beside.fold(0.0_f64, |m, (_, v)| m.max(v.abs())) <= f64::EPSILON * diagonal[i]
        };
        (0..self.len()).map(|i| is_large[i] && alone(i)).collect()
    }
}
