//! Exact harmonics of the normal force of a law with states.
//!
//! Such a force has no memory: N = max(n₀ − kn·y, 0) has closings and openings that are located and integrals in
//! closed form, as under friction in one direction. Its harmonics are then a smooth function of the motion. Sampled
//! harmonics have a corner wherever a closing passes a sample, and a stiff contact causes so many of them that
//! Newton's method does not converge.

use crate::aft::evaluation::Evaluation;
use crate::aft::varying_normal_load::VaryingNormalLoadEvaluator;
use crate::contact::forms::law::VaryingNormalLoad;
use crate::contact::forms::piece::Piece;
use crate::error::Result;
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;

/// Tables and memory for normal forces.
pub(super) struct Normal {
    set: HarmonicSet,
    evaluator: VaryingNormalLoadEvaluator,
    /// Evaluation with a tangential direction without force, and the normal direction.
    found: Evaluation,
}

impl Normal {
    pub fn new(set: &HarmonicSet, force_alone: bool) -> Result<Self> {
        Ok(Self {
            set: set.try_clone()?,
            evaluator: VaryingNormalLoadEvaluator::new(set)?,
            found: if force_alone {
                Evaluation::force_alone(set, 2)?
            } else {
                Evaluation::new(set, 2)?
            },
        })
    }

    /// The pieces of the force evaluated last.
    pub fn pieces(&self) -> &[Piece] {
        self.evaluator.normal()
    }

    /// Share of the period without force at the last evaluation.
    pub fn open_fraction(&self) -> f64 {
        self.found.open_fraction
    }

    /// Writes force, Jacobian and offset for the last of the motions, which is the normal one.
    pub fn evaluate(
        &mut self,
        law: &dyn VaryingNormalLoad,
        motion: &[f64],
        out: &mut Evaluation,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let (n, m) = (motion.len(), self.set.packed_len());
        self.evaluator
            .evaluate(law, &self.set, &motion[n - 2 * m..], &mut self.found, interrupt)?;
        out.force[n - m..].copy_from_slice(&self.found.force[m..]);
        out.offset[n - m..].copy_from_slice(&self.found.offset[m..]);
        if out.is_force_alone() {
            return Ok(());
        }
        for k in 0..m {
            let column = &self.found.jacobian[(m + k) * 2 * m..][m..2 * m];
            out.jacobian[(n - m + k) * n..][n - m..n].copy_from_slice(column);
        }
        Ok(())
    }
}
