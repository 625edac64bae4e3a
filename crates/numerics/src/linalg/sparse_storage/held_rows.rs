//! Rows that a penalty on the diagonal of the stiffness holds, as the 1e36 that Abaqus writes for fixed degrees of freedom.
//! In natural modes they are fixed: beside such a number all others would be rounding.

use crate::error::{Result, try_extend, try_push, try_vec};
use crate::linalg::dense::eigen::Pairs;
use crate::linalg::sparse_storage::sparse::Csc;
use nalgebra::DMatrix;
use num_complex::Complex64;

const CONTEXT: &str = "the rows that move";

/// Rows of a pencil of stiffness and mass that no penalty stiffness holds.
#[derive(Debug)]
pub struct MovingRows {
    /// Indices of these rows, ascending.
    rows: Vec<usize>,
    order: usize,
}

impl MovingRows {
    /// Finds the rows that move; `None` if all do. A row is held if its diagonal exceeds the sum of its other entries
    /// by more than 1/ε; a row without other entries is held if its diagonal exceeds those of all coupled rows as
    /// much.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn of(stiffness: &Csc) -> Result<Option<Self>> {
        let n = stiffness.rows;
        let mut beside = try_vec(n, 0.0_f64, CONTEXT)?;
        let mut largest = 0.0_f64;
        let mut any = false;
        let exceeds = |own: f64, rest: f64| own * f64::EPSILON > rest;
        for (j, sum) in beside.iter_mut().enumerate() {
            *sum = stiffness
                .column(j)
                .filter(|&(i, _)| i != j)
                .map(|(_, v)| v.norm())
                .sum();
            let own = stiffness.get(j, j).re;
            if *sum > 0.0 && !exceeds(own, *sum) {
                largest = largest.max(own);
                any = true;
            }
        }
        let mut rows = Vec::new();
        for (j, &sum) in beside.iter().enumerate() {
            let own = stiffness.get(j, j).re;
            let held = if sum > 0.0 {
                exceeds(own, sum)
            } else {
                any && exceeds(own, largest)
            };
            if !held {
                try_push(&mut rows, j, CONTEXT)?;
            }
        }
        Ok((rows.len() < n && !rows.is_empty()).then_some(Self { rows, order: n }))
    }

    /// The matrix restricted to the rows and columns that move.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn reduced(&self, a: &Csc) -> Result<Csc> {
        let mut entries = Vec::new();
        for (to, &j) in self.rows.iter().enumerate() {
            for (i, v) in a.column(j) {
                if let Ok(i) = self.rows.binary_search(&i) {
                    try_push(&mut entries, (i, to, v), CONTEXT)?;
                }
            }
        }
        Csc::from_triplets(self.rows.len(), self.rows.len(), entries)
    }

    /// A vector restricted to the rows that move.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn reduced_vector(&self, vector: &[(usize, Complex64)]) -> Result<Vec<(usize, Complex64)>> {
        let mut found = Vec::new();
        for (i, v) in vector {
            if let Ok(i) = self.rows.binary_search(i) {
                try_push(&mut found, (i, *v), CONTEXT)?;
            }
        }
        Ok(found)
    }

    /// Shapes over all rows, one after the other, with zeros where rows are held.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn expanded(&self, shapes: &[Complex64]) -> Result<Vec<Complex64>> {
        let mut all = Vec::new();
        for shape in shapes.chunks_exact(self.rows.len().max(1)) {
            let mut whole = try_vec(self.order, Complex64::ZERO, CONTEXT)?;
            for (&i, &x) in self.rows.iter().zip(shape) {
                whole[i] = x;
            }
            try_extend(&mut all, &whole, CONTEXT)?;
        }
        Ok(all)
    }

    /// Eigenpairs whose vectors cover all rows, with zeros where rows are held.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn expanded_pairs(&self, pairs: Pairs) -> Result<Pairs> {
        let vectors = self.expanded(pairs.vectors.as_slice())?;
        Ok(Pairs {
            vectors: DMatrix::from_vec(self.order, pairs.values.len(), vectors),
            values: pairs.values,
        })
    }

    /// Whether a row moves.
    #[must_use]
    pub fn contains(&self, row: usize) -> bool {
        self.rows.binary_search(&row).is_ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(n: usize, entries: &[(usize, usize, f64)]) -> Csc {
        let all = entries.iter().map(|&(i, j, v)| (i, j, Complex64::from(v))).collect();
        Csc::from_triplets(n, n, all).unwrap()
    }

    #[test]
    fn rows_beyond_rounding_are_held_and_stiff_ones_are_not() {
        let chain = [(0, 0, 2.0), (0, 1, -1.0), (1, 0, -1.0), (1, 1, 2.0), (2, 2, 1.0)];
        assert!(MovingRows::of(&matrix(3, &chain)).unwrap().is_none());
        for (size, moving) in [(1e15, 3), (1e36, 2)] {
            // Alone, and with a spring to the row before it.
            let mut alone = chain.to_vec();
            alone[4].2 = size;
            let mut coupled = alone.clone();
            coupled.extend([(1, 2, -1.0), (2, 1, -1.0)]);
            for entries in [alone, coupled] {
                let found = MovingRows::of(&matrix(3, &entries)).unwrap();
                assert_eq!(found.map_or(3, |found| found.rows.len()), moving);
            }
        }
        // Rows beside one of almost no stiffness are not held, and those of a diagonal matrix keep their own frequencies.
        let weak = [(0, 0, 1e-20), (1, 1, 2.0), (1, 2, -1.0), (2, 1, -1.0), (2, 2, 2.0)];
        assert!(MovingRows::of(&matrix(3, &weak)).unwrap().is_none());
        assert!(
            MovingRows::of(&matrix(2, &[(0, 0, 1.0), (1, 1, 1e36)]))
                .unwrap()
                .is_none()
        );
        let mut stiff = chain;
        stiff[4].2 = 1e36;
        let held = MovingRows::of(&matrix(3, &stiff)).unwrap().unwrap();
        let reduced = held.reduced(&matrix(3, &stiff)).unwrap();
        assert_eq!(
            (reduced.rows, reduced.get(0, 1).re, reduced.get(1, 1).re),
            (2, -1.0, 2.0)
        );
        let shapes = held.expanded(&[Complex64::ONE, Complex64::I]).unwrap();
        assert_eq!(shapes, [Complex64::ONE, Complex64::I, Complex64::ZERO]);
    }
}
