//! The work per cycle that a contact takes at a solution, with its derivatives by the normal loads.
//!
//! With the harmonics y_h of the relative motions of a contact and f_h of its forces
//!
//! > E = π Σ_h h Im(f_h conj(y_h)) = Re Σ_h W_hᴴ f_h, W_h = iπh y_h.
//!
//! The derivative by the motions is −iπh f_h + (∂f/∂y)ᵀ W. One adjoint solution with it gives the derivatives by all parameters through
//! the motion, and W that by the load of the contact itself at a fixed motion.

use crate::condense::AssembledLaw;
use crate::contact::forms::constants::Constant;
use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dot;
use crate::model::Model;
use crate::sensitivity::adjoint::{Adjoint, CONTEXT};
use crate::sensitivity::contact_products::{ContactMotion, evaluate};
use crate::sensitivity::forced_point::ForcedPoint;
use crate::sensitivity::sampled_model::SampledModel;
use num_complex::Complex64;
use std::f64::consts::PI;

impl ForcedPoint<'_> {
    /// Work per cycle of one law, in the caller's units, and its adjoint, at the point of which the amplitude's
    /// adjoint was made last. The law is evaluated by itself, since others may act along the same relative motions.
    /// The total derivative of this adjoint by ω is the derivative of the work.
    ///
    /// # Errors
    /// As [`ForcedPoint::adjoint`].
    pub fn work(&mut self, u: &[f64], omega: f64, assembled: &AssembledLaw, samples: usize) -> Result<(f64, Adjoint)> {
        let condensed = self.condensed;
        let (set, length) = (condensed.set(), condensed.length());
        let m = set.packed_len();
        let at = &assembled.coordinates;
        let size = at.len().saturating_mul(m);
        let mut motion = try_vec(size, 0.0, CONTEXT)?;
        for (y, &c) in motion.chunks_exact_mut(m.max(1)).zip(at) {
            y.copy_from_slice(&self.problem.forces().motion()[c * m..(c + 1) * m]);
        }
        let solution = SampledModel { condensed, samples };
        let found = evaluate(&*assembled.law, solution, omega, &motion, self.interrupt)?;
        // W, and −iπh f.
        let (mut weight, mut own) = (try_vec(size, 0.0, CONTEXT)?, try_vec(size, 0.0, CONTEXT)?);
        for k in 0..at.len() {
            let here = k * m..(k + 1) * m;
            for (i, &number) in set.numbers().iter().enumerate() {
                if number == 0 {
                    continue;
                }
                let share = Complex64::new(0.0, PI * number as f64);
                set.set(&mut weight[here.clone()], i, share * set.get(&motion[here.clone()], i));
                set.set(
                    &mut own[here.clone()],
                    i,
                    -share * set.get(&found.force[here.clone()], i),
                );
            }
        }
        let work = dot(&weight, &found.force);
        let by_omega = dot(&weight, &found.by_omega);
        let mut lambda = try_vec(u.len(), 0.0, CONTEXT)?;
        for (q, column) in found.jacobian.chunks_exact(size.max(1)).enumerate() {
            lambda[at[q / m] * m + q % m] += own[q] + dot(column, &weight);
        }
        self.system.solve_transposed(&mut lambda);
        let mut adjoint = self.of_lambda(u, omega, Complex64::ZERO, &lambda)?;
        // The equations are in the unit of lengths, and a work in its square.
        for z in &mut adjoint.field {
            *z *= length;
        }
        adjoint.by_omega = length * (adjoint.by_omega + length * by_omega);
        Ok((length * length * work, adjoint))
    }
}

/// Derivative of the work of a contact by one of its constants at a fixed motion; 0 where its law does not have the
/// constant, or the derivative exists on one side only.
///
/// # Errors
/// Those of the law; `OutOfMemory`, `StoppedByCaller`.
pub(crate) fn work_at_fixed_motion(
    at_frequency: &Model,
    number: usize,
    constant: Constant,
    solution: SampledModel<'_>,
    adjoint: &Adjoint,
    interrupt: &Interrupt<'_>,
) -> Result<f64> {
    let contact = &at_frequency.contacts()[number];
    let Some(derivative) = contact.by_constant(constant).filter(|found| !found.is_one_sided) else {
        return Ok(0.0);
    };
    let condensed = solution.condensed;
    let (set, length) = (condensed.set(), condensed.length());
    let m = set.packed_len().max(1);
    let mut motion = ContactMotion::new(at_frequency, number, condensed, adjoint)?;
    for (field, y) in motion.field.chunks_exact_mut(m).zip(motion.motion.chunks_exact(m)) {
        for (i, &h) in set.numbers().iter().enumerate() {
            set.set(field, i, Complex64::new(0.0, PI * h as f64) * length * set.get(y, i));
        }
    }
    let products = motion.products(contact, solution, adjoint.omega, interrupt)?;
    Ok(products.with(&derivative))
}
