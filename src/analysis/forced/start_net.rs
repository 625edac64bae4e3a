//! A net of starts: a motion in several amplitudes and phases beside a solution, from which subharmonic motions are sought.

use crate::analysis::forced::forced_discretised::ForcedDiscretised;
use crate::analysis::forced::known_curve::lies_on;
use crate::continuation::Point;
use crate::error::{Result, try_vec};
use crate::fourier::HarmonicSet;
use crate::harmonics::discretised::Discretised;
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::results::Branch;
use num_complex::Complex64;
use std::sync::Arc;

const CONTEXT: &str = "the start of a branch";

/// A motion that is added to a solution with several amplitudes and phases, as starts of a search.
pub(crate) struct Net<'n> {
    /// Order n of subharmonic motions: these have harmonics that are no multiples of n.
    pub order: usize,
    /// Motion to add: complex, (H + 1) × ndof, harmonic after harmonic.
    pub added: &'n [Complex64],
}

/// Amplitudes and number of phases of a net.
/// Kind: tuned; measured on: not recorded.
const START_NET_AMPLITUDES: [f64; 5] = [0.25, 0.5, 1.0, 2.0, 4.0];
const PHASES: usize = 8;

/// Share of a motion in the harmonics that another curve does not have, below which it lies on that curve.
/// Kind: tuned; measured on: not recorded.
pub(crate) const OWN_SHARE: f64 = 1e-3;

impl Net<'_> {
    /// The first solution at the frequency of the start that is subharmonic and lies on no known branch. The curve of
    /// a known branch may have several periods of the force in one of its own.
    ///
    /// # Errors
    /// Those of the problem.
    pub fn first_solution(
        &self,
        response: &mut ForcedDiscretised<'_>,
        start: &Point,
        (known, periods): (&[&Branch], usize),
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Point>> {
        let level = response.resolution();
        let to = Arc::clone(&response.levels().at(level)?.condensed);
        let set = to.set();
        let turned = |turn: Complex64| -> Result<Vec<f64>> {
            let mut motion = try_vec(self.added.len(), Complex64::ZERO, CONTEXT)?;
            for (x, added) in motion.iter_mut().zip(self.added) {
                *x = added * turn;
            }
            response.packed(&motion)
        };
        let axes = [turned(Complex64::ONE)?, turned(Complex64::I)?];
        for amplitude in START_NET_AMPLITUDES {
            for phase in 0..PHASES {
                // Shifted by a period of the force the motion is the same.
                let angle = core::f64::consts::TAU * phase as f64 / (PHASES * self.order) as f64;
                let (sine, cosine) = angle.sin_cos();
                let mut near = start.try_clone()?;
                for ((v, x), y) in near.v.iter_mut().zip(&axes[0]).zip(&axes[1]) {
                    *v += amplitude * (cosine * x + sine * y);
                }
                let Some(point) = response.solve_at(&near, interrupt)? else {
                    continue;
                };
                if subharmonic_share(set, point.unknowns(), self.order) < OWN_SHARE {
                    continue;
                }
                let mut is_known = false;
                for branch in known {
                    is_known |= lies_on(response, branch, &point, periods, interrupt)?;
                }
                if !is_known {
                    return Ok(Some(point));
                }
            }
        }
        Ok(None)
    }
}

/// Share of the harmonics of a motion that are no multiples of `order`.
fn subharmonic_share(set: &HarmonicSet, motion: &[f64], order: usize) -> f64 {
    let mut part = 0.0_f64;
    for y in motion.chunks_exact(set.packed_len().max(1)) {
        for (i, h) in set.numbers().iter().enumerate() {
            if h % order != 0 {
                part = part.hypot(set.get(y, i).norm());
            }
        }
    }
    part / norm(motion)
}
