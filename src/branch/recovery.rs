//! The motion of all degrees of freedom at a stored point, from the relative motions of the contacts.

use super::Branch;
use crate::aft::{Evaluation, Evaluator};
use crate::condense::flexibility::Workspace;
use crate::error::{Result, try_vec};
use num_complex::Complex64;

/// Recovers one point after the other.
pub(crate) struct Recovery<'a> {
    branch: &'a Branch,
    workspace: Workspace,
    laws: Option<(Evaluator, Evaluation)>,
    point: usize,
    /// Packed contact forces per coordinate at the point.
    forces: Vec<f64>,
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
        let set = condensed.set();
        let coordinates = condensed.coordinates();
        Ok(Self {
            branch,
            workspace: Workspace::new(condensed, None)?,
            laws: if coordinates == 0 {
                None
            } else {
                Some((Evaluator::new(set, branch.samples)?, Evaluation::new(set, 1)?))
            },
            point: 0,
            forces: try_vec(coordinates * set.packed_len(), 0.0, WHAT)?,
            w: try_vec(coordinates, Complex64::ZERO, WHAT)?,
        })
    }

    fn motion(&self) -> &'a [f64] {
        let size = self.forces.len();
        &self.branch.motion[self.point * size..(self.point + 1) * size]
    }

    /// Evaluates the contact forces at a stored point.
    pub fn go_to(&mut self, point: usize) {
        self.point = point;
        self.workspace.set_damping(self.branch.damping_at(point));
        let set = self.branch.condensed.set();
        let m = set.packed_len();
        let motion = self.motion();
        self.forces.fill(0.0);
        let Some((evaluator, evaluation)) = &mut self.laws else {
            return;
        };
        for placed in self.branch.condensed.laws() {
            let packed = placed.coordinate * m..(placed.coordinate + 1) * m;
            evaluator.prepare(set, &motion[packed.clone()]);
            evaluator.evaluate(&placed.law, set, &motion[packed.clone()], evaluation);
            for (f, e) in self.forces[packed].iter_mut().zip(&evaluation.force) {
                *f += e;
            }
        }
    }

    /// Packed contact forces per coordinate at the point, in the solver's units.
    pub fn forces(&self) -> &[f64] {
        &self.forces
    }

    /// Motion of all degrees of freedom in the i-th carried harmonic, in the caller's unit.
    ///
    /// # Errors
    /// `Singular` at an undamped resonance that no contact feels.
    pub fn harmonic(&mut self, i: usize, x: &mut [Complex64]) -> Result<()> {
        let condensed = &self.branch.condensed;
        let set = condensed.set();
        let m = set.packed_len();
        let motion = self.motion();
        for (c, w) in self.w.iter_mut().enumerate() {
            let packed = c * m..(c + 1) * m;
            let y = set.get(&motion[packed.clone()], i);
            *w = set.get(&self.forces[packed], i) - condensed.kappa(c, i) * y;
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
