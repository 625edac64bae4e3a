//! Linear springs between degrees of freedom, and the rows of relative motions.

use crate::contact::described::relative_motion::{TERMS_A, TERMS_B};
use num_complex::Complex64;

/// A linear spring. Rayleigh damping excludes it.
#[derive(Clone, Copy, Debug)]
pub struct Spring {
    /// Degree of freedom on side a; `None` is the ground.
    pub dof_a: Option<usize>,
    /// Degree of freedom on side b; `None` is the ground.
    pub dof_b: Option<usize>,
    /// Sector offset: side b lies in sector s + offset (cyclic models).
    pub sector_offset: i64,
    /// Stiffness, force per length.
    pub stiffness: f64,
}

/// Row of a relative motion: at most six entries of side a and three of side b, each a pair (degree of freedom,
/// coefficient).
pub type Row = [Option<(usize, Complex64)>; TERMS_A + TERMS_B];

/// Relative motion r·x that the row reads from x.
pub fn along(row: &Row, x: &[Complex64]) -> Complex64 {
    row.iter().flatten().map(|&(p, a)| a * x[p]).sum()
}
