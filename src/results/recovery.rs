//! The motion of all degrees of freedom at a stored point, from the relative motions of the contacts.

use crate::condense::Condensed;
use crate::condense::Resolution;
use crate::condense::flexibility::Workspace;
use crate::condense::near_rigid_motion;
use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::problem::contact_forces::ContactForces;
use crate::results::branch::Branch;
use num_complex::Complex64;

/// Recovers the motion of stored points, one at a time.
pub(crate) struct Recovery<'a> {
    branch: &'a Branch,
    interrupt: &'a Interrupt<'a>,
    resolution: usize,
    condensed: &'a Condensed,
    workspace: Workspace,
    point: usize,
    forces: ContactForces<'a>,
    w: Vec<Complex64>,
    q: Vec<Complex64>,
}

const CONTEXT: &str = "the harmonics";

impl<'a> Recovery<'a> {
    /// Memory for the points of a branch, with a stored point selected; see [`Self::go_to`].
    ///
    /// # Errors
    /// `Index` for an unknown point, `OutOfMemory`; those of callbacks; `StoppedByCaller`.
    pub fn at(branch: &'a Branch, point: usize, interrupt: &'a Interrupt<'a>) -> Result<Self> {
        interrupt.check()?;
        branch.carried_of(point)?;
        let resolution = branch.places[point].resolution;
        let Resolution { condensed, samples } = &branch.resolutions[resolution];
        let mut recovery = Self {
            branch,
            interrupt,
            resolution,
            condensed,
            workspace: Workspace::new(condensed, None)?,
            point,
            forces: ContactForces::unchecked(condensed, *samples, interrupt)?,
            w: try_vec(condensed.coordinates(), Complex64::ZERO, CONTEXT)?,
            q: Vec::new(),
        };
        recovery.go_to(point)?;
        Ok(recovery)
    }

    fn motion(&self) -> &'a [f64] {
        self.branch.motion_at(self.point).unwrap_or(&[])
    }

    /// Selects a stored point and evaluates its contact forces.
    ///
    /// # Errors
    /// `OutOfMemory`; those of callbacks; `StoppedByCaller`.
    pub fn go_to(&mut self, point: usize) -> Result<()> {
        if self.branch.places[point].resolution != self.resolution {
            *self = Self::at(self.branch, point, self.interrupt)?;
            return Ok(());
        }
        self.point = point;
        self.workspace.set_damping(self.branch.damping_at(point));
        let motion = self.motion();
        self.forces.evaluate(motion, self.branch.omega[point])
    }

    /// Packed contact forces per coordinate at the point, in the solver's units.
    pub fn forces(&self) -> &[f64] {
        self.forces.forces()
    }

    /// Motion of all degrees of freedom in the i-th carried harmonic, in the caller's unit and numbering.
    ///
    /// # Errors
    /// `Singular` at an undamped resonance that moves no contact; `OutOfMemory`.
    pub fn harmonic(&mut self, i: usize, x: &mut [Complex64]) -> Result<()> {
        let condensed = self.condensed;
        let degrees = condensed.degrees();
        if degrees.is_identity() && !condensed.is_reduced() {
            return self.coordinates(i, x);
        }
        let mut q = core::mem::take(&mut self.q);
        if q.len() != condensed.ndof() {
            q = try_vec(condensed.ndof(), Complex64::ZERO, CONTEXT)?;
        }
        self.coordinates(i, &mut q)?;
        if degrees.is_identity() {
            condensed.expand(i, &q, x)?;
        } else if condensed.is_reduced() {
            let mut independent = try_vec(degrees.independent(), Complex64::ZERO, CONTEXT)?;
            condensed.expand(i, &q, &mut independent)?;
            degrees.expand(condensed.blocks()[i].next, &independent, x);
        } else {
            degrees.expand(condensed.blocks()[i].next, &q, x);
        }
        self.q = q;
        Ok(())
    }

    /// The same for the coordinates of the harmonic: the independent degrees of freedom, or those of its basis.
    ///
    /// # Errors
    /// As [`Self::harmonic`].
    pub fn coordinates(&mut self, i: usize, x: &mut [Complex64]) -> Result<()> {
        let condensed = self.condensed;
        let set = condensed.set();
        let motion = self.motion();
        for (c, w) in self.w.iter_mut().enumerate() {
            *w = self.forces.minus_reference(motion, c, i);
        }
        let omega = self.branch.omega[self.point];
        self.workspace
            .recover(condensed, i, omega, &self.w, x, self.interrupt)?;
        let m = set.packed_len();
        for (c, y) in self.w.iter_mut().enumerate() {
            *y = set.get(&motion[c * m..(c + 1) * m], i);
        }
        near_rigid_motion::correct(&mut self.workspace, condensed, (i, omega), &self.w, x, self.interrupt)?;
        for z in x.iter_mut() {
            *z *= condensed.length();
            if set.numbers()[i] == 0 {
                z.im = 0.0;
            }
        }
        Ok(())
    }
}
