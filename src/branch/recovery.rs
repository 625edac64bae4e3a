//! The motion of all degrees of freedom at a stored point, from the relative motions of the contacts.

use super::Branch;
use crate::condense::flexibility::Workspace;
use crate::error::{Result, try_vec};
use crate::problem::contact_forces::ContactForces;
use num_complex::Complex64;

/// Recovers one point after the other.
pub(crate) struct Recovery<'a> {
    branch: &'a Branch,
    workspace: Workspace,
    point: usize,
    forces: ContactForces<'a>,
    w: Vec<Complex64>,
}

const WHAT: &str = "the harmonics";

impl<'a> Recovery<'a> {
    /// Memory for the points of a branch.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(branch: &'a Branch) -> Result<Self> {
        let condensed = &branch.condensed;
        Ok(Self {
            branch,
            workspace: Workspace::new(condensed, None)?,
            point: 0,
            forces: ContactForces::unchecked(condensed, branch.samples)?,
            w: try_vec(condensed.coordinates(), Complex64::ZERO, WHAT)?,
        })
    }

    fn motion(&self) -> &'a [f64] {
        let size = self.forces.forces().len();
        &self.branch.motion[self.point * size..(self.point + 1) * size]
    }

    /// Evaluates the contact forces at a stored point.
    ///
    /// # Errors
    /// Those of callbacks.
    pub fn go_to(&mut self, point: usize) -> Result<()> {
        self.point = point;
        self.workspace.set_damping(self.branch.damping_at(point));
        let motion = self.motion();
        self.forces.evaluate(motion, self.branch.omega[point])
    }

    /// Packed contact forces per coordinate at the point, in the solver's units.
    pub fn forces(&self) -> &[f64] {
        self.forces.forces()
    }

    /// Motion of all degrees of freedom in the i-th carried harmonic, in the caller's unit.
    ///
    /// # Errors
    /// `Singular` at an undamped resonance that no contact feels.
    pub fn harmonic(&mut self, i: usize, x: &mut [Complex64]) -> Result<()> {
        let condensed = &self.branch.condensed;
        let set = condensed.set();
        let motion = self.motion();
        for (c, w) in self.w.iter_mut().enumerate() {
            *w = self.forces.minus_reference(motion, c, i);
        }
        let omega = self.branch.omega[self.point];
        self.workspace.recover(condensed, i, omega, &self.w, x)?;
        for z in x.iter_mut() {
            *z *= condensed.length();
            if set.numbers()[i] == 0 {
                z.im = 0.0;
            }
        }
        Ok(())
    }
}
