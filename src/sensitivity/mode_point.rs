//! The adjoint of the frequency or of the damping ratio of a nonlinear mode at a fixed amplitude.

use crate::condense::Condensed;
use crate::condense::by_factors::dynamic_stiffness::DampedFrequency;
use crate::condense::by_factors::flexibility::Workspace;
use crate::error::{Result, Status, try_copy, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::lu::Lu;
use crate::linalg::newton::linear_system::Jacobian;
use crate::problem::epmc::{Epmc, Gauge, LinearMode};
use crate::problem::{Problem, Residual};
use crate::results::stored::mode_branch::ModePoint;
use crate::sensitivity::adjoint::{Adjoint, CONTEXT};
use num_complex::Complex64;

/// Result of a nonlinear mode that is differentiated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ModeQuantity {
    /// Angular frequency of the mode.
    Omega,
    /// Damping ratio of the mode.
    Damping,
}

/// A solved point of a nonlinear mode.
pub(crate) struct ModePointAdjoint<'a> {
    pub condensed: &'a Condensed,
    pub linear: &'a LinearMode,
    pub gauge: &'a Gauge,
    pub samples: usize,
    /// Packed relative motions, static ones included.
    pub motion: &'a [f64],
    pub omega: f64,
    pub point: ModePoint,
}

impl ModePointAdjoint<'_> {
    /// Unknowns: packed relative motions about the static state per unit of amplitude, then those of frequency and
    /// damping ratio.
    fn unknowns(&self) -> Result<Vec<f64>> {
        let condensed = self.condensed;
        let amplitude = 10f64.powf(self.point.log10_amplitude);
        let mut u = try_vec(self.motion.len() + 2, 0.0, CONTEXT)?;
        u[..self.motion.len()].copy_from_slice(self.motion);
        let rest = self.linear.rest.in_units(condensed.length())?;
        for (u, rest) in u.iter_mut().step_by(condensed.set().packed_len()).zip(&rest.motion) {
            *u -= rest;
        }
        for u in &mut u {
            *u /= amplitude;
        }
        Epmc::set_frequency_and_damping(
            self.linear,
            DampedFrequency::new(self.omega, self.point.damping_ratio),
            &mut u,
        );
        Ok(u)
    }

    /// The adjoint of a result; `None` where Newton's matrix is singular.
    ///
    /// # Errors
    /// Those of the model and of callbacks; `OutOfMemory`; `StoppedByCaller`.
    pub fn solve(&self, quantity: ModeQuantity, interrupt: &Interrupt<'_>) -> Result<Option<Adjoint>> {
        let condensed = self.condensed;
        let (omega, damping) = (self.omega, self.point.damping_ratio);
        let mut problem = Epmc::new(condensed, self.gauge, self.linear, self.samples, interrupt)?;
        let size = problem.size();
        let u = self.unknowns()?;
        problem.evaluate(&u, self.point.log10_amplitude, &mut Residual::new(size)?)?;
        let mut system = Lu::new(size, 1)?;
        problem.fill(system.matrix(), &mut try_vec(size, true, CONTEXT)?)?;
        match system.factor(interrupt) {
            Err(e) if e.status == Status::Singular => return Ok(None),
            factored => factored?,
        }
        let (unknown, rate) = match quantity {
            ModeQuantity::Omega => problem.frequency_unknown(omega),
            ModeQuantity::Damping => problem.damping_unknown(),
        };
        let mut lambda = try_vec(size, 0.0, CONTEXT)?;
        lambda[unknown] = rate;
        system.solve_transposed(&mut lambda);
        let mut adjoint = Adjoint::new(
            condensed,
            DampedFrequency { omega, damping },
            try_copy(self.motion, CONTEXT)?,
        )?;
        adjoint.is_forced = false;
        let amplitude = 10f64.powf(self.point.log10_amplitude);
        let unit = amplitude * condensed.length();
        adjoint.normalisation = if self.gauge.contact.is_none() {
            -lambda[size - 2] / (amplitude * amplitude)
        } else {
            0.0
        };
        let mut workspace = Workspace::new(condensed, None)?;
        workspace.set_damping(damping);
        let set = condensed.set();
        let (m, n) = (set.packed_len(), condensed.ndof());
        for (i, block) in condensed.blocks().iter().enumerate() {
            let range = i * n..(i + 1) * n;
            let field = &mut adjoint.field[range.clone()];
            for (c, row) in block.motions.rows.iter().enumerate() {
                let of_row = set.get(&lambda[c * m..(c + 1) * m], i);
                for &(p, a) in row.terms() {
                    field[p] += a.conj() * of_row;
                }
            }
            if block.number == 1 {
                for (z, weighted) in field.iter_mut().zip(problem.weighted()) {
                    *z -= 2.0 * lambda[size - 2] * weighted;
                }
                field[self.gauge.reference_dof] -= lambda[size - 1] * problem.phase_scale() * Complex64::I;
            }
            workspace.adjoint(condensed, i, omega, field, interrupt)?;
            let x = &mut adjoint.motion[range.clone()];
            for ((x, z), shape) in x.iter_mut().zip(field).zip(&problem.shape()[range]) {
                *x = unit * shape;
                *z /= unit;
                if block.number == 0 {
                    (x.im, z.im) = (0.0, 0.0);
                }
            }
            if block.number == 0 {
                for (x, rest) in x.iter_mut().zip(&self.linear.rest.structure) {
                    *x += rest;
                }
            }
        }
        Ok(Some(adjoint))
    }
}
