//! Counted operations of the multipliers of a motion, from which it follows whether a structure is too large to be
//! carried as a whole.

use crate::linalg::sparse_storage::sparse::Csc;
use crate::stability::slider_map::SLIDER_MAP_STEP;
use crate::time_integration::DEGREE;

/// Operations of the eigenvalues of a complex matrix of order 1 (Golub & Van Loan, Matrix Computations, 2013, §7.5: 25 n³
/// complex ones).
/// Kind: fixed.
const OF_EIGENVALUES: f64 = 100.0;

/// Columns that are carried: those of shooting and those of the perturbations.
/// Kind: fixed.
const TWICE: f64 = 2.0;

/// Sizes of a structure that determine the operations of its perturbations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    /// Number of degrees of freedom of a block of perturbations.
    pub order: f64,
    pub sliders: f64,
    /// Number of entries of the matrices of a block.
    pub entries: f64,
    /// Largest natural frequency times the time over which perturbations are carried.
    pub fastest: f64,
    /// Number of blocks of perturbations.
    pub blocks: f64,
}

impl Extent {
    /// Number of operations for the multipliers of all blocks.
    pub fn operations(&self) -> f64 {
        let states = 2.0 * self.order + self.sliders;
        let steps = 1.0 + self.fastest / SLIDER_MAP_STEP;
        let carried = TWICE * DEGREE as f64 * 2.0 * self.entries * states * steps;
        self.blocks * (carried + OF_EIGENVALUES * states.powi(3))
    }
}

/// Upper bound of the largest natural angular frequency: the largest row sum of the stiffness over the diagonal of
/// the mass.
pub(crate) fn fastest_motion(stiffness: &Csc, mass: &Csc) -> f64 {
    let square = (0..stiffness.cols).fold(0.0_f64, |most, j| {
        let sum: f64 = stiffness.column(j).map(|(_, v)| v.norm()).sum();
        let mass = mass.get(j, j).re;
        if mass > 0.0 { most.max(sum / mass) } else { most }
    });
    square.sqrt()
}
