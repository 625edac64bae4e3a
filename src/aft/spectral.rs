//! Laws without events: a force k·x + g(x) with g homogeneous of degree d, whose tangent has a known Fourier spectrum
//! S. Then
//!
//! > ∂F/∂X = k + T(S),  F = k X + T(S)·X/d,  F − ∂F/∂X · X = (1 − d)/d · T(S)·X
//!
//! by Euler's theorem on homogeneous functions, exactly for the carried harmonics: T(S) needs S up to twice the
//! highest of them. Nothing is sampled, even where samples are requested. See Krack & Gross, Harmonic Balance for
//! Nonlinear Vibration Problems (2019), doi:10.1007/978-3-030-14023-6, on polynomial forces.

use crate::aft::evaluation::Evaluation;
use crate::aft::jacobian_assembly::Assembly;
use crate::contact::forms::law::Spectral;
use crate::error::Result;
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;

impl Assembly {
    /// Evaluates a law without events, whose tangent has a known spectrum.
    pub(super) fn spectral(
        &mut self,
        law: &dyn Spectral,
        set: &HarmonicSet,
        motion: &[f64],
        out: &mut Evaluation,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        // The contact is never stuck, even at rest: its stiffness need not be that of the reference.
        self.start(out);
        law.spectrum(set, motion, &mut self.spectrum);
        self.finish(set, motion, out, interrupt)?;
        // The force holds T(S)·X at this point.
        let (linear, degree) = (law.linear(), law.degree());
        let m = motion.len();
        for (i, x) in motion.iter().enumerate() {
            let nonlinear = out.force[i] / degree;
            out.force[i] = linear * x + nonlinear;
            out.offset[i] = (1.0 - degree) * nonlinear;
            if let Some(own) = out.jacobian.get_mut(i * m + i) {
                *own += linear;
            }
        }
        Ok(())
    }
}
