//! The motion of all degrees of freedom at a point, from the relative motions of the contacts.

use crate::condense::Resolution;
use crate::condense::by_factors::flexibility::Workspace;
use crate::condense::by_factors::near_rigid_motion;
use crate::error::{Result, try_copy, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::problem::contact_forces::ContactForces;
use crate::results::stored::branch::Branch;
use num_complex::Complex64;

/// A solution: packed relative motions in the solver's units, angular frequency, and damping ratio of the artificial
/// damping.
type Solution<'a> = (&'a [f64], f64, f64);

/// Packed relative motions of a stored point, in the solver's units.
///
/// # Errors
/// As [`Recovery::at`].
pub(crate) fn relative_motion_at(branch: &Branch, point: usize, interrupt: &Interrupt<'_>) -> Result<Vec<f64>> {
    let motion = branch.motion_at(point).unwrap_or(&[]);
    let condensed = branch.condensed_at(point);
    if !condensed.has_exchanges() {
        return try_copy(motion, CONTEXT);
    }
    let recovery = Recovery::at(branch, point, interrupt)?;
    condensed.relative_motion(motion, recovery.forces(), branch.table.omega[point])
}

/// Recovers the motion of points, one at a time.
pub(crate) struct Recovery<'a> {
    interrupt: &'a Interrupt<'a>,
    resolution: &'a Resolution,
    workspace: Workspace,
    motion: &'a [f64],
    omega: f64,
    forces: ContactForces<'a>,
    w: Vec<Complex64>,
    q: Vec<Complex64>,
}

const CONTEXT: &str = "the harmonics";

impl<'a> Recovery<'a> {
    /// A recovery for the points of a branch, with a stored point selected; see [`Self::go_to`].
    ///
    /// # Errors
    /// `Index` for an unknown point, `OutOfMemory`; those of callbacks; `StoppedByCaller`.
    pub fn at(branch: &'a Branch, point: usize, interrupt: &'a Interrupt<'a>) -> Result<Self> {
        interrupt.check()?;
        branch.carried_of(point)?;
        let resolution = &branch.resolutions[branch.table.places[point].resolution];
        Self::of(resolution, Self::stored(branch, point), interrupt)
    }

    /// A recovery for the points of one resolution, with a solution selected that need not be stored.
    ///
    /// # Errors
    /// `OutOfMemory`; those of callbacks; `StoppedByCaller`.
    pub fn of(resolution: &'a Resolution, solution: Solution<'a>, interrupt: &'a Interrupt<'a>) -> Result<Self> {
        let Resolution { condensed, samples } = resolution;
        let mut recovery = Self {
            interrupt,
            resolution,
            workspace: Workspace::new(condensed, None)?,
            motion: &[],
            omega: 0.0,
            forces: ContactForces::forces_alone(condensed, *samples, interrupt)?,
            w: try_vec(condensed.coordinates(), Complex64::ZERO, CONTEXT)?,
            q: Vec::new(),
        };
        recovery.select(solution)?;
        Ok(recovery)
    }

    fn stored(branch: &'a Branch, point: usize) -> Solution<'a> {
        let motion = branch.motion_at(point).unwrap_or(&[]);
        (motion, branch.table.omega[point], branch.damping_at(point))
    }

    /// Selects a stored point and evaluates its contact forces.
    ///
    /// # Errors
    /// `OutOfMemory`; those of callbacks; `StoppedByCaller`.
    pub fn go_to(&mut self, branch: &'a Branch, point: usize) -> Result<()> {
        let resolution = &branch.resolutions[branch.table.places[point].resolution];
        if !core::ptr::eq(self.resolution, resolution) {
            *self = Self::at(branch, point, self.interrupt)?;
            return Ok(());
        }
        self.select(Self::stored(branch, point))
    }

    fn select(&mut self, (motion, omega, damping): Solution<'a>) -> Result<()> {
        (self.motion, self.omega) = (motion, omega);
        self.workspace.set_damping(damping);
        self.forces.evaluate(motion, omega)
    }

    /// The motion of all degrees of freedom in harmonics 0 ..= `harmonics`, which is at least the highest carried one,
    /// harmonic by harmonic, in the caller's unit and numbering.
    ///
    /// # Errors
    /// As [`Self::harmonic`].
    pub fn all(&mut self, harmonics: usize) -> Result<Vec<Complex64>> {
        let carried = self.resolution.condensed.set().numbers();
        let n = self.resolution.condensed.degrees().given();
        let mut found = try_vec((harmonics + 1).saturating_mul(n), Complex64::ZERO, CONTEXT)?;
        for (i, &h) in carried.iter().enumerate() {
            self.interrupt.part(Phase::Results, i, carried.len())?;
            self.harmonic(i, &mut found[h * n..(h + 1) * n])?;
        }
        Ok(found)
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
        let condensed = &*self.resolution.condensed;
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

    /// Motion of the coordinates in the i-th carried harmonic: independent degrees of freedom, or columns of the
    /// basis.
    ///
    /// # Errors
    /// As [`Self::harmonic`].
    pub fn coordinates(&mut self, i: usize, x: &mut [Complex64]) -> Result<()> {
        let condensed = &*self.resolution.condensed;
        let set = condensed.set();
        let motion = self.motion;
        for (c, w) in self.w.iter_mut().enumerate() {
            *w = self.forces.minus_reference(motion, c, i);
        }
        let omega = self.omega;
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
