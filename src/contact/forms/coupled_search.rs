//! Memory in which a law under a varying normal load searches its pieces: turning points of the normal
//! motion and of the two signals that bound the slider.

use crate::contact::forms::piece::{CoupledPiece, Piece};
use crate::error::{Error, Result, try_vec};
use crate::fourier::{Extremum, HarmonicSet, TurningPoints};
use crate::interrupt::Interrupt;
use std::f64::consts::PI;

/// One bound of a slider: its signal and the turning points of it over a whole turn.
pub struct Bound {
    /// Packed signal.
    pub(crate) signal: Vec<f64>,
    /// Its turning points in order.
    pub(crate) turning_points: Vec<Extremum>,
}

/// Memory for the search of the pieces of motions with one harmonic set.
pub struct CoupledSearch {
    pub(crate) search: TurningPoints,
    pub(crate) normal: Vec<Extremum>,
    pub(crate) bounds: [Bound; 2],
}

impl CoupledSearch {
    /// Memory for motions of `set`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(set: &HarmonicSet) -> Result<Self> {
        let bound = || -> Result<Bound> {
            Ok(Bound {
                signal: try_vec(set.packed_len(), 0.0, "a motion")?,
                turning_points: try_reserve(2 * most_closings(set))?,
            })
        };
        Ok(Self {
            search: TurningPoints::new(set)?,
            normal: try_reserve(2 * most_closings(set))?,
            bounds: [bound()?, bound()?],
        })
    }
}

/// Bound of the number of closings of a contact in a turn, with room for rounding where a motion touches;
/// a signal has at most twice as many turning points.
fn most_closings(set: &HarmonicSet) -> usize {
    set.highest_reduced() + 2
}

fn try_reserve<T>(count: usize) -> Result<Vec<T>> {
    let mut v = Vec::new();
    v.try_reserve_exact(count)
        .map_err(|_| Error::out_of_memory("the pieces of a motion"))?;
    Ok(v)
}

/// Empty lists with memory for the normal and tangential pieces of any motion of `set`.
pub fn piece_lists(set: &HarmonicSet) -> Result<(Vec<Piece>, Vec<CoupledPiece>)> {
    let closings = most_closings(set);
    // One stick and one slip at most between neighbours of the turning points of both bounds and the ends of
    // the closed times, and the open times.
    Ok((
        try_reserve(4 * closings)?,
        try_reserve(2 * (4 * closings + 2 * closings) + closings)?,
    ))
}

/// Turning points over a whole turn, also for sets of odd harmonics: a varying load has no such symmetry.
pub(crate) fn find(
    search: &mut TurningPoints,
    set: &HarmonicSet,
    signal: &[f64],
    found: &mut Vec<Extremum>,
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    search.find(set, signal, found, interrupt)?;
    if set.is_odd() {
        for i in 0..found.len() {
            let Extremum { tau, x } = found[i];
            found.push(Extremum { tau: tau + PI, x: -x });
        }
    }
    Ok(())
}
