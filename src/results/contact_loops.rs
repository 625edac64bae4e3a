//! Loops of a contact over the period: motions and full forces of all its directions and its
//! state at any time, the work that it takes, the shares of slip and opening.
//!
//! Laws with events are followed exactly for the motion given, event by event, and no force is cut off at
//! the highest harmonic of the motion. Laws without memory are evaluated at the requested times, laws with
//! states are marched over a period that has these times among its samples. By Parseval the work per
//! cycle is
//!
//! > ∮ f·dy = π Σ h Im(Fₕ conj Yₕ), summed over the directions,
//!
//! over the harmonics of the motion, with F as the solution was found with it; friction in one direction
//! under a constant load has a sum of positive terms instead, see [`one_motion`].

pub mod from_samples;
pub mod one_motion;
mod period;
mod plane_motion;
pub mod two_motions;

use crate::aft::{Evaluation, Evaluator};
use crate::contact::contact_state::State;
use crate::contact::law::{Form, Law};
use crate::error::{Result, try_push, try_vec};
use crate::fourier::HarmonicSet;
use crate::fourier::{TurningPoints, jet};
use crate::interrupt::Interrupt;
use crate::results::contact_loops::one_motion::ScalarOrbit;
use crate::results::contact_loops::period::{CONTEXT, PeriodicMotion, extrema, range, time};
use crate::results::contact_loops::two_motions::CoupledOrbit;
use crate::results::signal_check::check_time;
use std::f64::consts::PI;

pub use period::{Account, Times};

/// Source of the force.
#[derive(Clone, Copy)]
enum Maker<'a> {
    Law(&'a dyn Law),
    /// A linear spring of this stiffness in every direction.
    Spring(f64),
}

/// A contact under a periodic motion; all quantities in the units of its law.
#[derive(Clone, Copy)]
pub struct Orbit<'a> {
    motion: PeriodicMotion<'a>,
    maker: Maker<'a>,
    samples: usize,
}

impl<'a> Orbit<'a> {
    /// `law` under a packed motion, one direction after the other, at an angular frequency. `samples` are
    /// those requested in the solution: 0 leaves their number to the law.
    #[must_use]
    pub fn new(set: &'a HarmonicSet, motion: &'a [f64], law: &'a dyn Law, omega: f64, samples: usize) -> Self {
        Self {
            motion: PeriodicMotion {
                set,
                packed: motion,
                directions: law.directions(),
                omega,
            },
            maker: Maker::Law(law),
            samples,
        }
    }

    /// A linear spring in each of some directions; stiffness 0 is without force.
    #[must_use]
    pub fn spring(set: &'a HarmonicSet, motion: &'a [f64], directions: usize, stiffness: f64) -> Self {
        Self {
            motion: PeriodicMotion {
                set,
                packed: motion,
                directions,
                omega: 0.0,
            },
            maker: Maker::Spring(stiffness),
            samples: 0,
        }
    }

    /// Relative motions d.
    #[must_use]
    pub fn directions(&self) -> usize {
        self.motion.directions
    }

    /// The contact at n times.
    ///
    /// # Errors
    /// `OutOfMemory`; those of callbacks; `NoConvergence` for a law whose states do not become periodic.
    pub fn times(&self, n: usize, interrupt: &Interrupt<'_>) -> Result<Times> {
        let PeriodicMotion {
            set,
            packed,
            directions,
            ..
        } = self.motion;
        let d = directions;
        let mut out = Times {
            motion: try_vec(n.saturating_mul(d), 0.0, CONTEXT)?,
            force: try_vec(n.saturating_mul(d), 0.0, CONTEXT)?,
            state: try_vec(n, State::Stick, CONTEXT)?,
        };
        for (j, row) in out.motion.chunks_exact_mut(d.max(1)).enumerate() {
            check_time(interrupt, j, set)?;
            let tau = time(set, j, n);
            for (k, x) in row.iter_mut().enumerate() {
                *x = jet(set, self.motion.signal(k), tau).x;
            }
        }
        let law = match self.maker {
            Maker::Law(law) => law,
            Maker::Spring(stiffness) => {
                for (f, x) in out.force.iter_mut().zip(&out.motion) {
                    *f = stiffness * x;
                }
                return Ok(out);
            }
        };
        match law.form() {
            Form::PiecewiseLinear(_) | Form::Spectral(_) => {
                let orbit = ScalarOrbit::new(set, packed, law, interrupt)?;
                let rows = out.force.iter_mut().zip(&mut out.state).zip(&out.motion);
                for (j, ((force, state), x)) in rows.enumerate() {
                    check_time(interrupt, j, set)?;
                    (*force, *state) = orbit.at(time(set, j, n), *x);
                }
            }
            Form::VaryingNormalLoad(law) => {
                let orbit = CoupledOrbit::new(set, packed, law, interrupt)?;
                let rows = out.force.chunks_exact_mut(2).zip(&mut out.state);
                for (j, ((force, state), x)) in rows.zip(out.motion.chunks_exact(2)).enumerate() {
                    check_time(interrupt, j, set)?;
                    let found = orbit.at(time(set, j, n), [x[0], x[1]]);
                    force.copy_from_slice(&found.0);
                    *state = found.1;
                }
            }
            Form::PlaneFriction(law) => plane_motion::followed(&self.motion, law, &mut out, interrupt)?,
            Form::Hysteretic(law) => from_samples::marched(&self.motion, law, self.samples, &mut out, interrupt)?,
            Form::Memoryless(law) => from_samples::pointwise(&self.motion, law, &mut out, interrupt)?,
        }
        Ok(out)
    }

    /// Work and shares of the period. The work of laws that cannot dissipate, and of friction that does not
    /// slip, is exactly 0.
    ///
    /// # Errors
    /// As [`Self::times`].
    pub fn account(&self, interrupt: &Interrupt<'_>) -> Result<Account> {
        let Maker::Law(law) = self.maker else {
            return Ok(Account::default());
        };
        let PeriodicMotion { set, packed, .. } = self.motion;
        match law.form() {
            Form::PiecewiseLinear(_) | Form::Spectral(_) => {
                Ok(ScalarOrbit::new(set, packed, law, interrupt)?.account())
            }
            // A force that follows from one motion alone has a potential.
            Form::Memoryless(law) if law.directions() == 1 && !law.uses_velocity() => Ok(Account::default()),
            Form::Memoryless(_) | Form::VaryingNormalLoad(_) | Form::PlaneFriction(_) | Form::Hysteretic(_) => {
                self.evaluated(law, interrupt)
            }
        }
    }

    /// Work and shares of the law as evaluated in the solution.
    fn evaluated(&self, law: &dyn Law, interrupt: &Interrupt<'_>) -> Result<Account> {
        let PeriodicMotion {
            set,
            packed,
            directions,
            omega,
        } = self.motion;
        let mut found = Evaluation::new(set, directions)?;
        let mut evaluator = Evaluator::new(set, self.samples, std::iter::once(law))?;
        evaluator.evaluate(law, set, packed, omega, &mut found, interrupt)?;
        let (slip, open) = (found.slip_fraction, found.open_fraction);
        let takes_nothing = match law.form() {
            // Stick stores work, and a contact that opens has slipped before, as its limit fell to zero.
            Form::VaryingNormalLoad(_) | Form::PlaneFriction(_) => slip == 0.0,
            _ => false,
        };
        let mut work = 0.0;
        if !takes_nothing {
            let m = set.packed_len().max(1);
            for (force, motion) in found.force.chunks_exact(m).zip(packed.chunks_exact(m)) {
                for (i, &h) in set.numbers().iter().enumerate() {
                    work += PI * h as f64 * (set.get(force, i) * set.get(motion, i).conj()).im;
                }
            }
        }
        Ok(Account { work, slip, open })
    }

    /// Smallest and largest motion in every direction, exactly.
    ///
    /// # Errors
    /// `OutOfMemory`, `StoppedByCaller`.
    pub fn ranges(&self, interrupt: &Interrupt<'_>) -> Result<Vec<(f64, f64)>> {
        let PeriodicMotion { set, directions, .. } = self.motion;
        let mut search = TurningPoints::new(set)?;
        let mut extrema = extrema(set)?;
        let mut ranges = Vec::new();
        for k in 0..directions {
            search.find(set, self.motion.signal(k), &mut extrema, interrupt)?;
            try_push(&mut ranges, range(set, self.motion.signal(k), &extrema), CONTEXT)?;
        }
        Ok(ranges)
    }
}
