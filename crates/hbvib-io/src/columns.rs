//! A matrix column by column, with sums of entries at one place: the order in which files are written.

use crate::matrix::{Matrix, Symmetry};

/// An entry: row, real and imaginary part.
pub(crate) type Entry = (u32, f64, f64);

/// Entries by column, then by row; zeros are left out.
pub(crate) struct Columns {
    starts: Vec<usize>,
    entries: Vec<Entry>,
}

impl Columns {
    /// All entries, with the mirror images of those that stand for two.
    pub fn whole(a: &Matrix) -> Self {
        Self::of(a, |row, column, value, to| {
            to.push((column, row, value.0, value.1));
            if row != column {
                match a.symmetry {
                    Symmetry::General => {}
                    Symmetry::Symmetric => to.push((row, column, value.0, value.1)),
                    Symmetry::Hermitian => to.push((row, column, value.0, -value.1)),
                    Symmetry::Skew => to.push((row, column, -value.0, -value.1)),
                }
            }
        })
    }

    /// The lower triangle of a matrix of which one triangle is listed; all entries of a general one.
    pub fn listed(a: &Matrix) -> Self {
        Self::of(a, |row, column, (re, im), to| {
            let turned = a.symmetry != Symmetry::General && row < column;
            to.push(match (turned, a.symmetry) {
                (false, _) => (column, row, re, im),
                (true, Symmetry::Hermitian) => (row, column, re, -im),
                (true, Symmetry::Skew) => (row, column, -re, -im),
                (true, _) => (row, column, re, im),
            });
        })
    }

    fn of(a: &Matrix, put: impl Fn(u32, u32, (f64, f64), &mut Vec<(u32, u32, f64, f64)>)) -> Self {
        let parts = if a.is_complex { 2 } else { 1 };
        let mut all = Vec::with_capacity(2 * a.entries());
        for (k, value) in a.values.chunks_exact(parts).enumerate() {
            let value = (value[0], value.get(1).copied().unwrap_or(0.0));
            put(a.row[k], a.column[k], value, &mut all);
        }
        // A stable sort adds entries at one place in the order of the list.
        all.sort_by_key(|&(column, row, ..)| (column, row));
        all.dedup_by(|next, kept| {
            let same = (next.0, next.1) == (kept.0, kept.1);
            if same {
                kept.2 += next.2;
                kept.3 += next.3;
            }
            same
        });
        all.retain(|&(_, _, re, im)| (re, im) != (0.0, 0.0));
        let mut starts = vec![0; a.columns + 1];
        for &(column, ..) in &all {
            starts[column as usize + 1] += 1;
        }
        for column in 0..a.columns {
            starts[column + 1] += starts[column];
        }
        Self {
            starts,
            entries: all.into_iter().map(|(_, row, re, im)| (row, re, im)).collect(),
        }
    }

    /// Number of entries.
    pub fn entries(&self) -> usize {
        self.entries.len()
    }

    /// Positions of the first entry of each column, and of the end.
    pub fn starts(&self) -> &[usize] {
        &self.starts
    }

    /// Entries of all columns.
    pub fn all(&self) -> &[Entry] {
        &self.entries
    }

    /// Entries of a column.
    pub fn column(&self, j: usize) -> &[Entry] {
        &self.entries[self.starts[j]..self.starts[j + 1]]
    }

    /// Whether each entry equals its mirror image.
    pub fn is_symmetric(&self) -> bool {
        let place = |row: u32, column: usize| {
            let entries = self.column(column);
            let at = entries.binary_search_by_key(&row, |entry| entry.0).ok();
            at.map(|at| (entries[at].1, entries[at].2))
        };
        (0..self.starts.len() - 1).all(|j| {
            self.column(j).iter().all(|&(i, re, im)| {
                (i as usize) + 1 < self.starts.len() && place(j as u32, i as usize) == Some((re, im))
            })
        })
    }
}
