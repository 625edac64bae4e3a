//! The prescribed motion of a contact over the period, and the results under it.

use crate::contact::forms::contact_state::State;
use crate::error::{Error, Result};
use crate::fourier::{Extremum, HarmonicSet};
use std::f64::consts::TAU;

pub(super) const CONTEXT: &str = "the loop of a contact";

/// The relative motions of a contact, in the units of its law.
#[derive(Clone, Copy)]
pub struct PeriodicMotion<'a> {
    pub set: &'a HarmonicSet,
    /// Packed motions, d·m numbers, one direction after the other.
    pub packed: &'a [f64],
    pub directions: usize,
    pub omega: f64,
}

impl<'a> PeriodicMotion<'a> {
    /// Packed motion in the k-th direction.
    pub fn signal(&self, k: usize) -> &'a [f64] {
        let m = self.set.packed_len();
        &self.packed[k * m..(k + 1) * m]
    }
}

/// Motion, force and state of a contact at the times ωt = 2πj/n, j = 0 .. n.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Times {
    /// Relative motions, n × d, time after time.
    pub motion: Vec<f64>,
    /// Contact forces, n × d, time after time.
    pub force: Vec<f64>,
    /// States of the contact, n values.
    pub state: Vec<State>,
}

/// Work and states of a contact over the whole period.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Account {
    /// Work per cycle that the contact takes from the motion.
    pub work: f64,
    /// Share of the period in slip.
    pub slip: f64,
    /// Share of the period in which the contact is open.
    pub open: f64,
}

/// Index of sample j of n over the period, among the samples of the turn of τ, which is shorter where only multiples
/// of a harmonic are carried. Whole numbers are exact.
pub(super) fn sample(set: &HarmonicSet, j: usize, n: usize) -> usize {
    (set.base() as u128 * j as u128 % n.max(1) as u128) as usize
}

/// The time τ in [0, 2π) of sample j.
pub(super) fn time(set: &HarmonicSet, j: usize, n: usize) -> f64 {
    TAU * sample(set, j, n) as f64 / n.max(1) as f64
}

/// An empty list with memory for the turning points of any motion: x' has at most 2·highest roots per turn, and
/// rounding may split some.
pub(super) fn extrema(set: &HarmonicSet) -> Result<Vec<Extremum>> {
    let mut found = Vec::new();
    found
        .try_reserve(2 * set.highest_reduced() + 4)
        .map_err(|_| Error::out_of_memory(CONTEXT))?;
    Ok(found)
}

/// Smallest and largest value of a signal with the given turning points.
pub(super) fn range(set: &HarmonicSet, signal: &[f64], extrema: &[Extremum]) -> (f64, f64) {
    if extrema.is_empty() {
        let mean = if set.has_mean() { signal[0] } else { 0.0 };
        return (mean, mean);
    }
    let low = extrema.iter().map(|e| e.x).fold(f64::INFINITY, f64::min);
    let high = extrema.iter().map(|e| e.x).fold(f64::NEG_INFINITY, f64::max);
    if set.is_odd() {
        // The other half of the turn is the mirror image of the one that was scanned.
        let largest = high.max(-low);
        return (-largest, largest);
    }
    (low, high)
}
