//! Forces of one contact in slip as a load on a forced response: how the response changes with them.

use crate::problem::harmonic_balance::HarmonicBalance;
use crate::problem::parametric_problem::put;
use num_complex::Complex64;

/// The change of the residual with the logarithm of the slip limit of a coordinate, at the point last evaluated; `false` where it
/// does not slip.
pub(crate) fn by_slip_limit(balance: &HarmonicBalance<'_>, coordinate: usize, out: &mut [f64]) -> bool {
    by_force(balance, coordinate, |i| balance.forces.d_ln_scale(coordinate, i), out)
}

/// The change of the residual with the force of a coordinate, whose change in the i-th harmonic is given; `false` where it is zero.
pub(crate) fn by_force(
    balance: &HarmonicBalance<'_>,
    coordinate: usize,
    change: impl Fn(usize) -> Complex64,
    out: &mut [f64],
) -> bool {
    let set = balance.condensed.set();
    let (m, coordinates) = (set.packed_len(), balance.condensed.coordinates());
    out.fill(0.0);
    let mut slips = false;
    for (i, table) in balance.tables.current().iter().enumerate() {
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
pub(crate) fn observed_by_slip_limit(balance: &HarmonicBalance<'_>, coordinate: usize) -> Complex64 {
    observed_by_force(balance, coordinate, |i| balance.forces.d_ln_scale(coordinate, i))
}

/// Change of the observed amplitude with the force of a coordinate, as in [`by_force`].
#[must_use]
pub(crate) fn observed_by_force(
    balance: &HarmonicBalance<'_>,
    coordinate: usize,
    change: impl Fn(usize) -> Complex64,
) -> Complex64 {
    let (i, coordinates) = (balance.observed(), balance.condensed.coordinates());
    let table = &balance.tables.current()[i].value;
    -table[coordinate * (coordinates + 1) + coordinates] * change(i)
}
