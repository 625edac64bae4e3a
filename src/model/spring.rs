//! Linear springs between degrees of freedom, and the stiffness that springs and stuck contacts add
//! to a wave.

use crate::contact::relative_motion::Direction;
use crate::error::{Result, try_push};
use crate::linalg::sparse::{Csc, Form};
use crate::model::Model;
use crate::model::structure::MatrixKind;
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

/// Row of a relative motion, at most three entries a side as (degree of freedom, coefficient).
pub type Row = [Option<(usize, Complex64)>; 6];

/// Row r of the relative motion y = r·x in a direction: side a minus side b, where `phase` is the
/// motion of b's sector over a's.
#[must_use]
pub fn relative_row(direction: &Direction, phase: Complex64) -> Row {
    let mut row = [None; 6];
    let (a, b) = row.split_at_mut(3);
    for (entry, term) in a.iter_mut().zip(direction.a) {
        *entry = term.map(|(dof, c)| (dof, c.into()));
    }
    for (entry, term) in b.iter_mut().zip(direction.b) {
        *entry = term.map(|(dof, c)| (dof, -phase * c));
    }
    row
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
    /// Those of [`Structure::wave_matrix`](crate::model::structure::Structure::wave_matrix).
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
        let mut add = |force: &Row, motion: &Row, stiffness: f64| -> Result<()> {
            if stiffness == 0.0 {
                return Ok(());
            }
            for (p, x) in force.iter().flatten() {
                for (q, y) in motion.iter().flatten() {
                    try_push(&mut entries, (*p, *q, x.conj() * y * stiffness), "the springs")?;
                }
            }
            Ok(())
        };
        for s in self.springs() {
            let row = relative_row(&Direction::between(s.dof_a, s.dof_b), phase(s.sector_offset));
            add(&row, &row, s.stiffness)?;
        }
        for c in stuck {
            let row = |k| relative_row(&c.direction(k), phase(c.sector_offset));
            for k in 0..c.directions() {
                for l in 0..c.directions() {
                    add(&row(k), &row(l), c.stiffness_at_small_motion(k, l))?;
                }
            }
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
