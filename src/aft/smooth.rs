//! Laws without events: a force k·x + g(x) with g homogeneous of degree d, whose tangent has a
//! known Fourier spectrum S. Then
//!
//! > ∂F/∂X = k + T(S),  F = k X + T(S)·X/d,  F − ∂F/∂X · X = (1 − d)/d · T(S)·X
//!
//! by Euler's theorem on homogeneous functions, exactly for the carried harmonics: T(S) needs S up
//! to twice the highest of them. Nothing is sampled, whichever way of evaluating was chosen. See
//! Krack & Gross, Harmonic Balance for Nonlinear Vibration Problems (2019),
//! doi:10.1007/978-3-030-14023-6, on polynomial forces.

use super::{Assembly, Evaluation};
use crate::contact::Law;
use crate::harmonics::HarmonicSet;

impl Assembly {
    /// Evaluates `law` if it is smooth; `false`, and nothing is written, if it has events.
    pub(super) fn smooth(&mut self, law: &Law, set: &HarmonicSet, motion: &[f64], out: &mut Evaluation) -> bool {
        let Some(smooth) = law.nonlinear_spectrum(set, motion, &mut self.spectrum) else {
            return false;
        };
        // Never stuck, even an eased law that is linear by now: its stiffness need not be the reference's.
        out.clear();
        self.finish(set, motion, out);
        // The force now holds T(S)·X.
        let m = motion.len();
        for (i, x) in motion.iter().enumerate() {
            let nonlinear = out.force[i] / smooth.degree;
            out.force[i] = smooth.linear * x + nonlinear;
            out.offset[i] = (1.0 - smooth.degree) * nonlinear;
            out.jacobian[i * m + i] += smooth.linear;
        }
        true
    }
}
