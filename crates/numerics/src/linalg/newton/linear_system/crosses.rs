//! A matrix of blocks between groups of unknowns as terms of low rank, F_c ≈ Σ_a u_a v_aᵀ = U_c V_cᵀ for the rows of each group c.
//!
//! A term is a cross through the largest number that those before it leave (adaptive cross approximation, Bebendorf 2000,
//! doi:10.1007/PL00005410), which is Gaussian elimination with complete pivoting.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::error::{Result, try_extend, try_push};
use crate::linalg::add_product;
use crate::linalg::newton::linear_system::Forces;
use pulp::{Arch, Simd, WithSimd};

const CONTEXT: &str = "the terms of low rank";

/// Largest number that crosses may leave, over the stiffness of the contact.
/// Kind: tuned; measured on: wheels of 24 sectors, where an iteration takes 2 products for four digits and 4 or 5 for ten; a hundredth
/// of it has a fifth more crosses.
const LEFT_BY_CROSSES: f64 = 1e-3;

/// Factors U and V of all groups.
#[derive(Default)]
pub(super) struct Crosses {
    groups: Vec<Group>,
    rank: usize,
    /// U_c, column after column, group after group.
    left: Vec<f64>,
    /// V_cᵀ, column after column, motion after motion, group after group.
    right: Vec<f64>,
    /// Motion group of each block of V_cᵀ.
    motions: Vec<usize>,
    /// Remaining numbers of F_c; and rows of V_cᵀ, one after another.
    rest: Vec<f64>,
    rows: Vec<f64>,
}

/// Position of the crosses that belong to the forces of a group.
#[derive(Clone, Copy)]
struct Group {
    force: usize,
    /// Index of the first cross, and number of crosses.
    first: usize,
    rank: usize,
    /// Index of the first motion group, and number of them.
    motions: (usize, usize),
    /// Positions at which U_c and V_cᵀ begin.
    left: usize,
    right: usize,
}

impl Crosses {
    /// Finds the crosses for forces in groups of length `m`; returns their number, or `None` where there are more
    /// than `most`.
    ///
    /// # Errors
    /// `OutOfMemory`; those of the forces.
    pub fn find(&mut self, forces: &mut dyn Forces, m: usize, most: usize) -> Result<Option<usize>> {
        self.rank = 0;
        self.groups.clear();
        self.left.clear();
        self.right.clear();
        self.motions.clear();
        for force in 0..forces.groups() {
            let before = self.motions.len();
            let stiffness = forces.rows(force, &mut self.rest, &mut self.motions)?;
            if !self.rest.iter().fold(true, |finite, x| finite & x.is_finite()) {
                return Ok(None);
            }
            let mut group = Group {
                force,
                first: self.rank,
                rank: 0,
                motions: (before, self.motions.len() - before),
                left: self.left.len(),
                right: self.right.len(),
            };
            let columns = m * group.motions.1;
            self.rows.clear();
            while group.rank < m {
                let (place, pivot) = Arch::new().dispatch(Largest { m, rest: &self.rest });
                if pivot.abs() <= LEFT_BY_CROSSES * stiffness {
                    break;
                }
                if self.rank == most || !pivot.is_finite() {
                    return Ok(None);
                }
                self.take_cross(m, place, pivot)?;
                group.rank += 1;
                self.rank += 1;
            }
            try_extend(&mut self.right, &self.rows, CONTEXT)?;
            let transposed = self.right[group.right..].chunks_exact_mut(group.rank.max(1));
            for (q, column) in transposed.enumerate() {
                for (a, x) in column.iter_mut().enumerate() {
                    *x = self.rows[a * columns + q];
                }
            }
            try_push(&mut self.groups, group, CONTEXT)?;
        }
        Ok(Some(self.rank))
    }

    /// Subtracts the cross through a number from the remaining m rows; its column goes to `left`, its row divided by
    /// the number to `rows`.
    fn take_cross(&mut self, m: usize, (i, j): (usize, usize), pivot: f64) -> Result<()> {
        let (first, row) = (self.left.len(), self.rows.len());
        try_extend(&mut self.left, &self.rest[j * m..(j + 1) * m], CONTEXT)?;
        for column in self.rest.chunks_exact(m) {
            try_push(&mut self.rows, column[i] / pivot, CONTEXT)?;
        }
        Arch::new().dispatch(Subtraction {
            column: &self.left[first..],
            row: &self.rows[row..],
            rest: &mut self.rest,
        });
        for of_row in self.rest[i..].iter_mut().step_by(m) {
            *of_row = 0.0;
        }
        Ok(())
    }

    /// Fills in the core matrix C = I + Vᵀ D⁻¹ G U, column-major; `u` is memory for all unknowns.
    ///
    /// # Errors
    /// Those of the forces.
    pub fn fill_core(&self, forces: &mut dyn Forces, m: usize, u: &mut [f64], matrix: &mut [f64]) -> Result<()> {
        let mut columns = matrix.chunks_exact_mut(self.rank.max(1)).enumerate();
        for group in &self.groups {
            let of_group = &self.left[group.left..group.left + group.rank * m];
            for (of_cross, (k, column)) in of_group.chunks_exact(m.max(1)).zip(&mut columns) {
                forces.response_of(group.force, of_cross, u)?;
                self.reduce(m, u, column);
                column[k] += 1.0;
            }
        }
        Ok(())
    }

    /// x ← Vᵀ u.
    pub fn reduce(&self, m: usize, u: &[f64], x: &mut [f64]) {
        x.fill(0.0);
        for group in self.groups.iter().filter(|group| group.rank > 0) {
            let x = &mut x[group.first..group.first + group.rank];
            let blocks = self.right[group.right..].chunks_exact(group.rank * m);
            let motions = &self.motions[group.motions.0..group.motions.0 + group.motions.1];
            for (by, block) in motions.iter().zip(blocks) {
                add_product(1.0, block, &u[by * m..(by + 1) * m], x);
            }
        }
    }

    /// w ← U x.
    pub fn expand(&self, m: usize, x: &[f64], w: &mut [f64]) {
        w.fill(0.0);
        for group in &self.groups {
            let x = &x[group.first..group.first + group.rank];
            let columns = &self.left[group.left..group.left + group.rank * m];
            add_product(1.0, columns, x, &mut w[group.force * m..(group.force + 1) * m]);
        }
    }
}

/// Finds the number of largest size, with its row and column.
struct Largest<'a> {
    m: usize,
    rest: &'a [f64],
}

impl WithSimd for Largest<'_> {
    type Output = ((usize, usize), f64);

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> Self::Output {
        let (mut place, mut found) = (0, 0.0);
        for (j, column) in self.rest.chunks_exact(self.m.max(1)).enumerate() {
            let mut sizes = [0.0_f64; 8];
            let (eights, rest) = column.as_chunks::<8>();
            for eight in eights {
                for (size, x) in sizes.iter_mut().zip(eight) {
                    *size = if x.abs() > *size { x.abs() } else { *size };
                }
            }
            let sizes = sizes.iter().copied().chain(rest.iter().map(|x| x.abs()));
            let size = sizes.fold(0.0_f64, f64::max);
            if size > found {
                (place, found) = (j, size);
            }
        }
        let column = self.rest.get(place * self.m..).unwrap_or(&[]);
        let row = column.iter().position(|x| x.abs() >= found).unwrap_or(0);
        ((row, place), column.get(row).copied().unwrap_or(0.0))
    }
}

/// Subtracts the product of a column and a row from a matrix.
struct Subtraction<'a> {
    column: &'a [f64],
    row: &'a [f64],
    rest: &'a mut [f64],
}

impl WithSimd for Subtraction<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let columns = self.rest.chunks_exact_mut(self.column.len().max(1));
        for (of_rest, along) in columns.zip(self.row) {
            for (x, u) in of_rest.iter_mut().zip(self.column) {
                *x -= along * u;
            }
        }
    }
}

#[cfg(test)]
#[path = "crosses_tests.rs"]
mod tests;
