//! The Jacobians ∂f/∂y of the contact forces as blocks between relative coordinates: one for each coordinate by
//! itself, and one for each pair that some law couples.

use crate::condense::Condensed;
use crate::error::{Result, try_copy, try_extend, try_push, try_vec};

/// Blocks ∂f/∂y of order m, column-major, sorted by the coordinate of the force.
pub struct Blocks {
    order: usize,
    /// Per force coordinate the index of its first block; one more index at the end.
    first: Vec<usize>,
    /// Motion coordinate of each block.
    motion: Vec<usize>,
    /// Blocks sorted by the coordinate of the motion: force coordinate and index of each. The pattern is symmetric,
    /// so that they begin where `first` states.
    of_motions: Vec<(usize, usize)>,
    values: Vec<f64>,
    /// Per block, whether a law has been added since the last [`Self::clear`].
    filled: Vec<bool>,
    /// Per law, the index of the block for each pair of directions: force direction after force direction.
    of_laws: Vec<usize>,
}

impl Blocks {
    /// Zero blocks of order `m` for the laws of a condensed model; 0 where the forces alone are evaluated.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(condensed: &Condensed, m: usize) -> Result<Self> {
        const CONTEXT: &str = "the contact Jacobians";
        let coordinates = condensed.coordinates();
        let mut pairs = Vec::new();
        for c in 0..coordinates {
            try_push(&mut pairs, (c, c), CONTEXT)?;
        }
        let of_law = |at: &[usize], pairs: &mut Vec<(usize, usize)>| -> Result<()> {
            for &force in at {
                for &motion in at {
                    try_push(pairs, (force, motion), CONTEXT)?;
                }
            }
            Ok(())
        };
        for assembled in condensed.laws() {
            of_law(&assembled.coordinates, &mut pairs)?;
        }
        pairs.sort_unstable();
        pairs.dedup();
        let mut first = try_vec(coordinates + 1, 0, CONTEXT)?;
        let mut motion = try_vec(pairs.len(), 0, CONTEXT)?;
        for (m, &(force, by)) in motion.iter_mut().zip(&pairs) {
            first[force + 1] += 1;
            *m = by;
        }
        let mut of_motions = try_vec(pairs.len(), (0, 0), CONTEXT)?;
        for c in 0..coordinates {
            first[c + 1] += first[c];
        }
        let mut filled = try_copy(&first, CONTEXT)?;
        for (block, &(force, by)) in pairs.iter().enumerate() {
            of_motions[filled[by]] = (force, block);
            filled[by] += 1;
        }
        let mut of_laws = Vec::new();
        let mut wanted = Vec::new();
        for assembled in condensed.laws() {
            wanted.clear();
            of_law(&assembled.coordinates, &mut wanted)?;
            for pair in &wanted {
                try_push(&mut of_laws, pairs.partition_point(|p| p < pair), CONTEXT)?;
            }
        }
        let size = m.saturating_mul(m).saturating_mul(pairs.len());
        Ok(Self {
            order: m,
            first,
            motion,
            of_motions,
            values: try_vec(size, 0.0, CONTEXT)?,
            filled: try_vec(pairs.len(), false, CONTEXT)?,
            of_laws,
        })
    }

    /// Starts a new sum: the first law of a block replaces the old values. Every block has laws.
    pub fn clear(&mut self) {
        self.filled.fill(false);
    }

    /// Adds the Jacobian of a law of `d` directions whose blocks begin at position `from` in the list of all laws'
    /// blocks; returns the position of the next law. The contents of `jacobian` afterwards are unspecified.
    pub fn add(&mut self, from: usize, d: usize, jacobian: &mut Vec<f64>) -> usize {
        let m = self.order;
        if m == 0 {
            return from + d * d;
        }
        if self.filled == [false] && self.values.len() == jacobian.len() {
            // One law alone fills all blocks: no copy is needed.
            core::mem::swap(&mut self.values, jacobian);
            self.filled.fill(true);
            return from + d * d;
        }
        for force in 0..d {
            for motion in 0..d {
                let block = self.of_laws[from + force * d + motion];
                let at = block * m * m;
                let filled = core::mem::replace(&mut self.filled[block], true);
                for (k, column) in self.values[at..at + m * m].chunks_exact_mut(m).enumerate() {
                    let begin = (motion * m + k) * d * m + force * m;
                    let added = &jacobian[begin..begin + m];
                    if !filled {
                        column.copy_from_slice(added);
                        continue;
                    }
                    for (sum, j) in column.iter_mut().zip(added) {
                        *sum += j;
                    }
                }
            }
        }
        from + d * d
    }

    /// Multiplies all blocks by a factor.
    pub fn scale(&mut self, factor: f64) {
        for x in &mut self.values {
            *x *= factor;
        }
    }

    /// Adds springs of `stiffness` per block to a law of `d` directions whose blocks begin at position `from` in the
    /// list of all laws' blocks; returns the position of the next law.
    pub fn add_springs(&mut self, from: usize, d: usize, stiffness: impl Fn(usize) -> f64) -> usize {
        let m = self.order;
        for k in 0..d * d {
            let at = self.of_laws[from + k] * m * m;
            for x in self.values[at..at + m * m].iter_mut().step_by(m + 1) {
                *x += stiffness(k);
            }
        }
        from + d * d
    }

    /// Exchanges the numbers of all blocks for stored ones.
    pub fn swap(&mut self, values: &mut Vec<f64>) {
        core::mem::swap(&mut self.values, values);
    }

    /// Copies the numbers of all blocks.
    pub fn copy(&self, values: &mut Vec<f64>) -> Result<()> {
        values.clear();
        try_extend(values, &self.values, "the contact Jacobians")
    }

    /// The blocks of one force coordinate, as (motion coordinate, block).
    #[inline]
    pub fn of_force(&self, coordinate: usize) -> impl Iterator<Item = (usize, &[f64])> {
        let size = self.order * self.order;
        let range = self.first[coordinate]..self.first[coordinate + 1];
        range.map(move |b| (self.motion[b], &self.values[b * size..(b + 1) * size]))
    }

    /// The blocks of one motion coordinate, as (force coordinate, block).
    #[inline]
    pub fn of_motion(&self, coordinate: usize) -> impl Iterator<Item = (usize, &[f64])> {
        let size = self.order * self.order;
        let range = self.first[coordinate]..self.first[coordinate + 1];
        let blocks = self.of_motions[range].iter();
        blocks.map(move |&(force, b)| (force, &self.values[b * size..(b + 1) * size]))
    }
}
