//! Linear springs between degrees of freedom, and the stiffness that springs and stuck contacts add
//! to a wave.

use super::Model;
use super::structure::MatrixKind;
use crate::error::{Result, try_push};
use crate::linalg::sparse::{Csc, Form};
use num_complex::Complex64;

/// A linear spring. It takes no part in Rayleigh damping.
#[derive(Clone, Copy, Debug)]
pub struct Spring {
    /// Degree of freedom on side a; `None` is the ground.
    pub dof_a: Option<usize>,
    /// Degree of freedom on side b; `None` is the ground.
    pub dof_b: Option<usize>,
    /// Side b lies in sector s + offset (cyclic models).
    pub sector_offset: i64,
    /// Force per length.
    pub stiffness: f64,
}

/// Row of a relative motion, at most two entries as (degree of freedom, coefficient).
pub type Row = [Option<(usize, Complex64)>; 2];

/// Row r of the relative motion y = r·x between two sides: side a minus side b, where `phase` is the motion of b's sector over a's.
#[must_use]
pub fn relative_row(a: Option<usize>, b: Option<usize>, phase: Complex64) -> Row {
    [a.map(|dof| (dof, Complex64::ONE)), b.map(|dof| (dof, -phase))]
}

/// r·x, the relative motion of a row.
#[must_use]
pub fn along(row: &Row, x: &[Complex64]) -> Complex64 {
    row.iter().flatten().map(|&(p, a)| a * x[p]).sum()
}

/// A wave on the structure: how a sector offset turns the phase, and its stiffness matrix.
#[derive(Clone, Copy, Debug)]
pub enum Wave {
    /// Harmonic of the engine-order wave.
    Harmonic(usize),
    /// Nodal diameter, sector s + 1 lagging.
    Diameter(usize),
}

impl Model {
    /// K of a wave with the springs of the model and those of the `stuck` contacts.
    ///
    /// # Errors
    /// Those of [`Structure::wave_matrix`](super::structure::Structure::wave_matrix).
    pub fn sprung_stiffness<'c>(
        &self,
        wave: Wave,
        stuck: impl Iterator<Item = &'c crate::contact::Contact>,
    ) -> Result<Csc> {
        let structure = self.structure();
        let n = self.ndof();
        let own = match wave {
            Wave::Harmonic(h) => structure.wave_matrix(MatrixKind::Stiffness, h)?,
            Wave::Diameter(d) => structure.diameter_matrix(MatrixKind::Stiffness, d)?,
        };
        let phase = |offset| match wave {
            Wave::Harmonic(h) => structure.phase(h, offset),
            Wave::Diameter(d) => structure.wave_phase(d, offset),
        };
        let mut entries = Vec::new();
        let mut add = |a, b, offset, stiffness: f64| -> Result<()> {
            let row = relative_row(a, b, phase(offset));
            for (p, x) in row.into_iter().flatten() {
                for (q, y) in row.into_iter().flatten() {
                    try_push(&mut entries, (p, q, x.conj() * y * stiffness), "the springs")?;
                }
            }
            Ok(())
        };
        for s in self.springs() {
            add(s.dof_a, s.dof_b, s.sector_offset, s.stiffness)?;
        }
        for c in stuck {
            add(c.dof_a, c.dof_b, c.sector_offset, c.stiffness_at_rest())?;
        }
        if entries.is_empty() {
            return Ok(own);
        }
        let springs = Csc::from_triplets(n, n, entries)?;
        Csc::sum(
            n,
            &[
                (Complex64::ONE, &own, Form::Plain),
                (Complex64::ONE, &springs, Form::Plain),
            ],
        )
    }
}
