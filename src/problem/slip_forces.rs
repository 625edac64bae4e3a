//! Forces of one contact in slip as a load on a forced response: how the response changes with them.

use crate::problem::harmonic_balance::HarmonicBalance;
use crate::problem::parametric_problem::put;
use num_complex::Complex64;

impl HarmonicBalance<'_> {
    /// The change of the residual with the logarithm of the slip limit of a coordinate, at the point last evaluated; `false` where it
    /// does not slip.
    pub fn by_slip_limit(&self, coordinate: usize, out: &mut [f64]) -> bool {
        self.by_force(coordinate, |i| self.forces.d_ln_scale(coordinate, i), out)
    }

    /// The change of the residual with the force of a coordinate, whose change in the i-th harmonic is given; `false` where it is zero.
    pub fn by_force(&self, coordinate: usize, change: impl Fn(usize) -> Complex64, out: &mut [f64]) -> bool {
        let set = self.condensed.set();
        let (m, coordinates) = (set.packed_len(), self.condensed.coordinates());
        out.fill(0.0);
        let mut slips = false;
        for (i, table) in self.tables.current().iter().enumerate() {
            let slip = change(i);
            slips |= slip != Complex64::ZERO;
            let (at, mean) = (set.offset(i), set.numbers()[i] == 0);
            let column = &table.value[coordinate * (coordinates + 1)..][..coordinates];
            for (r, g) in (at..).step_by(m).zip(column) {
                put(out, r, mean, g * slip);
            }
        }
        slips
    }

    /// Change of the observed amplitude with the logarithm of the slip limit of a coordinate at fixed motions of the
    /// contacts.
    #[must_use]
    pub fn observed_by_slip_limit(&self, coordinate: usize) -> Complex64 {
        self.observed_by_force(coordinate, |i| self.forces.d_ln_scale(coordinate, i))
    }

    /// Change of the observed amplitude with the force of a coordinate, as in [`Self::by_force`].
    #[must_use]
    pub fn observed_by_force(&self, coordinate: usize, change: impl Fn(usize) -> Complex64) -> Complex64 {
        let (i, coordinates) = (self.observed(), self.condensed.coordinates());
        let table = &self.tables.current()[i].value;
        -table[coordinate * (coordinates + 1) + coordinates] * change(i)
    }
}
