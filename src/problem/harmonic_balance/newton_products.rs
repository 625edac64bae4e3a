//! Products with Newton's matrix of a forced response, and the part of it between its first harmonics, for linear
//! solutions that never have the whole of it.

use crate::fourier::HarmonicSet;
use crate::problem::contact_forces::ContactForces;
use crate::problem::harmonic_balance::HarmonicBalance;
use crate::problem::put;

impl<'a> HarmonicBalance<'a> {
    /// ∂R/∂y·d with the contact Jacobians at hand, at the frequency evaluated last; `dw` has as many numbers as d.
    pub fn multiply(&self, d: &[f64], dw: &mut [f64], out: &mut [f64]) {
        let set = self.condensed.set();
        let m = set.packed_len();
        let coordinates = self.condensed.coordinates();
        out.copy_from_slice(d);
        for (c, dw) in dw.chunks_exact_mut(m).enumerate() {
            self.forces.change(d, c, dw);
        }
        for (i, table) in self.tables.current().iter().enumerate() {
            let (at, mean) = (set.offset(i), set.numbers()[i] == 0);
            for c in 0..coordinates {
                let z = set.get(&dw[c * m..(c + 1) * m], i);
                let column = &table.value[c * (coordinates + 1)..];
                for (row, g) in column.iter().take(coordinates).enumerate() {
                    put(out, row * m + at, mean, g * z);
                }
                if mean {
                    out[c * m + at] += self.forces.mean_floor(c) * d[c * m + at];
                }
            }
        }
    }

    /// The part of ∂R/∂y between the first `harmonics` carried harmonics, column-major, and which of its columns
    /// differ from those of the identity. `column` has as many numbers as there are unknowns.
    pub fn core(&mut self, harmonics: usize, column: &mut [f64], core: &mut [f64], active: &mut [bool]) {
        let set = self.condensed.set();
        let m = set.packed_len();
        let part = packed_up_to(set, harmonics);
        let coordinates = self.condensed.coordinates();
        let order = part * coordinates;
        for (k, to) in core.chunks_exact_mut(order.max(1)).enumerate() {
            let (c, q) = (k / part, k % part);
            active[k] = self.forces.is_felt(c);
            to.fill(0.0);
            to[k] = 1.0;
            if !active[k] {
                continue;
            }
            column.fill(0.0);
            let tables = self.tables.current();
            let flexibility = (|i: usize| &tables[i].value[..], coordinates + 1);
            self.forces
                .couple(0..harmonics, (c, q), flexibility, &mut self.sum, column);
            for (to, from) in to.chunks_exact_mut(part).zip(column.chunks_exact(m)) {
                for (to, from) in to.iter_mut().zip(from) {
                    *to += from;
                }
            }
        }
    }

    /// The carried harmonics.
    #[must_use]
    pub fn set(&self) -> &'a HarmonicSet {
        self.condensed.set()
    }

    /// The contact forces at the point last evaluated.
    pub fn forces(&mut self) -> &mut ContactForces<'a> {
        &mut self.forces
    }
}

/// Length of the packed form of the first carried harmonics.
#[must_use]
pub fn packed_up_to(set: &HarmonicSet, harmonics: usize) -> usize {
    if harmonics < set.numbers().len() {
        set.offset(harmonics)
    } else {
        set.packed_len()
    }
}
