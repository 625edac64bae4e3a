//! Products with Newton's matrix of a forced response, and its block between the first harmonics, for linear
//! solutions that never form the whole matrix.

use crate::error::{Result, fail, try_vec};
use crate::fourier::HarmonicSet;
use crate::linalg::dense::complex_columns;
use crate::linalg::newton::linear_system::{Forces, MatrixFree, Ring};
use crate::problem::harmonic_balance::HarmonicBalance;
use crate::problem::parametric_problem::{Problem, put};
use crate::problem::ring_blocks::RingBlocks;
use num_complex::Complex64;

const CONTEXT: &str = "the products of the forced response";

/// Equations on packed harmonics of the relative motions, which provide products with their Jacobian.
pub trait PackedHarmonics: Problem + MatrixFree {
    /// The set of carried harmonics.
    fn harmonics(&self) -> &HarmonicSet;
}

impl PackedHarmonics for HarmonicBalance<'_> {
    fn harmonics(&self) -> &HarmonicSet {
        self.condensed.set()
    }
}

impl MatrixFree for HarmonicBalance<'_> {
    fn group(&self) -> usize {
        self.condensed.set().packed_len()
    }

    fn coupled(&self) -> usize {
        let coordinates = 0..self.condensed.coordinates();
        self.group() * coordinates.filter(|&c| self.forces.is_coupled(c)).count()
    }

    fn couples_all(&self) -> bool {
        self.condensed.has_exchanges()
    }

    fn fill_block(&mut self, part: usize, matrix: &mut [f64], active: &mut [bool]) -> Result<()> {
        let set = self.condensed.set();
        let m = set.packed_len();
        let coordinates = self.condensed.coordinates();
        let harmonics = (0..set.numbers().len()).filter(|&i| set.offset(i) < part).count();
        let order = part * coordinates;
        if self.products.column.is_empty() {
            self.products.column = try_vec(m * coordinates, 0.0, CONTEXT)?;
        }
        let column = &mut self.products.column[..];
        for (k, to) in matrix.chunks_exact_mut(order.max(1)).enumerate() {
            let (c, q) = (k / part, k % part);
            active[k] = self.forces.is_coupled(c);
            to.fill(0.0);
            to[k] = 1.0;
            if !active[k] {
                continue;
            }
            self.forces.interrupt().check()?;
            column.fill(0.0);
            let tables = self.tables.current();
            let flexibility = (|i: usize| &tables[i].value[..], coordinates + 1);
            self.forces
                .couple(0..harmonics, (c, q), flexibility, &mut self.memory.sum, column);
            for (to, from) in to.chunks_exact_mut(part).zip(column.chunks_exact(m)) {
                for (to, from) in to.iter_mut().zip(from) {
                    *to += from;
                }
            }
        }
        Ok(())
    }

    fn fill_pair(&mut self, at: usize, matrix: &mut [Complex64]) {
        let set = self.condensed.set();
        let coordinates = self.condensed.coordinates();
        let Some(i) = (0..set.numbers().len()).find(|&i| set.offset(i) == at) else {
            return;
        };
        let table = &self.tables.current()[i].value;
        matrix.fill(Complex64::ZERO);
        for (motion, column) in matrix.chunks_exact_mut(coordinates.max(1)).enumerate() {
            column[motion] = Complex64::ONE;
            self.forces.add_mean_coupling(motion, i, table, coordinates + 1, column);
        }
    }

    fn ring(&self) -> Option<Ring<'_>> {
        self.products.ring.as_deref().map(RingBlocks::ring)
    }

    fn fill_ring(&mut self, wave: usize, matrix: &mut [Complex64]) -> Result<()> {
        let Some(ring) = &mut self.products.ring else {
            return fail!(Internal, "the waves of a structure that is no wheel");
        };
        self.forces.interrupt().check()?;
        if wave == 0 {
            let (tables, stride) = (self.tables.current(), self.condensed.coordinates() + 1);
            ring.average(
                (self.condensed, &self.forces),
                (|i: usize| &tables[i].value[..], stride),
            );
        }
        ring.fill(self.condensed, wave, matrix)
    }

    fn forces(&mut self) -> Option<&mut dyn Forces> {
        (self.products.ring.is_some() || !self.condensed.has_exchanges()).then_some(self)
    }

    fn keep(&mut self) -> Result<()> {
        self.forces.copy_silent(&mut self.products.silent)?;
        self.forces.copy_jacobians(&mut self.products.kept)
    }

    fn multiply(&mut self, d: &[f64], out: &mut [f64]) -> Result<()> {
        // The contact Jacobians are the stored ones, not those of the motion evaluated last.
        self.forces.swap_jacobians(&mut self.products.kept);
        for (c, dw) in self
            .products
            .change
            .chunks_exact_mut(self.condensed.set().packed_len())
            .enumerate()
        {
            if self.products.silent.get(c) == Some(&true) {
                dw.fill(0.0);
            } else {
                self.forces.change(d, c, dw);
            }
        }
        self.multiply_change(d, out);
        self.forces.swap_jacobians(&mut self.products.kept);
        Ok(())
    }
}

impl HarmonicBalance<'_> {
    /// out ← J d with the contact Jacobians at the point last evaluated.
    pub(super) fn multiply_current(&mut self, d: &[f64], out: &mut [f64]) {
        for (c, dw) in self
            .products
            .change
            .chunks_exact_mut(self.condensed.set().packed_len())
            .enumerate()
        {
            self.forces.change(d, c, dw);
        }
        self.multiply_change(d, out);
    }

    /// out = d + G w with the change w of the contact forces along d.
    fn multiply_change(&mut self, d: &[f64], out: &mut [f64]) {
        let set = self.condensed.set();
        let m = set.packed_len();
        let coordinates = self.condensed.coordinates();
        let dw = &self.products.change[..];
        out.copy_from_slice(d);
        let (sum, [z, memory]) = (&mut self.memory.sum[..], &mut self.products.harmonic);
        for (i, table) in self.tables.current().iter().enumerate() {
            let (at, mean) = (set.offset(i), set.numbers()[i] == 0);
            for (z, dw) in z.iter_mut().zip(dw.chunks_exact(m)) {
                *z = set.get(dw, i);
            }
            complex_columns::multiply(&table.value, coordinates + 1, z, sum, memory);
            for (c, sum) in sum.iter().enumerate() {
                put(out, c * m + at, mean, *sum);
                if mean {
                    out[c * m + at] += self.forces.mean_floor(c) * d[c * m + at];
                }
            }
        }
    }
}

/// Length of the packed form of the first carried harmonics.
pub fn packed_up_to(set: &HarmonicSet, harmonics: usize) -> usize {
    if harmonics < set.numbers().len() {
        set.offset(harmonics)
    } else {
        set.packed_len()
    }
}
