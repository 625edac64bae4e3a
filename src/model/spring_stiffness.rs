//! Stiffness of a wave with springs and stuck contacts.

use crate::contact::Contact;
use crate::contact::relative_motion::Direction;
use crate::error::{Result, try_push};
use crate::linalg::sparse::{Csc, Form};
use crate::model::Model;
use crate::model::spring::{Row, relative_row};
use crate::model::structure::MatrixKind;
use num_complex::Complex64;

/// A wave on the structure, which determines the phase of a sector offset and the stiffness matrix.
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
    pub fn sprung_stiffness<'c>(&self, wave: Wave, stuck: impl Iterator<Item = &'c Contact>) -> Result<Csc> {
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
