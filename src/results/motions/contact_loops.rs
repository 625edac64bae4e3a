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

mod follower;
mod from_samples;
pub mod one_motion;
mod period;
mod plane_motion;
pub mod two_motions;

use crate::aft::{Evaluation, Evaluator};
use crate::contact::forms::law::{Form, Law};
use crate::error::{Result, try_push};
use crate::fourier::{HarmonicSet, TurningPoints};
use crate::interrupt::Interrupt;
use crate::results::motions::contact_loops::follower::Follower;
use crate::results::motions::contact_loops::one_motion::ScalarOrbit;
use crate::results::motions::contact_loops::period::{CONTEXT, PeriodicMotion, extrema, range};
use std::f64::consts::PI;

pub use period::Account;

/// Law or spring that makes the force of a contact.
#[derive(Clone, Copy)]
enum Maker<'a> {
    Law(&'a dyn Law),
    /// A linear spring of this stiffness in every direction.
    Spring(f64),
}

/// A contact under a periodic motion, in the units of its law.
#[derive(Clone, Copy)]
pub struct Orbit<'a> {
    motion: PeriodicMotion<'a>,
    maker: Maker<'a>,
    samples: usize,
    /// Packed motion of the contact itself, where the law has an exchanged motion; else `None`.
    actual: Option<&'a [f64]>,
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
            actual: None,
        }
    }

    /// Adds the motion of the contact itself, where the law has an exchanged motion.
    pub fn moving(self, actual: &'a [f64]) -> Self {
        Self {
            actual: Some(actual),
            ..self
        }
    }

    /// A linear spring in each of some directions; stiffness 0 is without force.
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
            actual: None,
        }
    }

    /// Number d of relative motions of the contact.
    #[must_use]
    pub fn directions(&self) -> usize {
        self.motion.directions
    }

    /// Follows the contact over n times of the period, one slice after the other.
    ///
    /// # Errors
    /// `OutOfMemory`; those of callbacks; `NoConvergence` for a law whose states do not become periodic; `StoppedByCaller`.
    pub fn follow(&self, n: usize, interrupt: &Interrupt<'_>) -> Result<Follower<'a>> {
        match self.maker {
            Maker::Law(law) => Follower::of_law(self.motion, self.actual, n, law, self.samples, interrupt),
            Maker::Spring(stiffness) => Ok(Follower::of_spring(self.motion, n, stiffness)),
        }
    }

    /// Work and shares of the period. The work of laws that cannot dissipate, and of friction that does not
    /// slip, is exactly 0.
    ///
    /// # Errors
    /// As [`Self::follow`].
    pub fn account(&self, interrupt: &Interrupt<'_>) -> Result<Account> {
        let Maker::Law(law) = self.maker else {
            return Ok(Account::default());
        };
        match law.form() {
            Form::PiecewiseLinear(_) if self.actual.is_some() => {
                let shares = ScalarOrbit::new(self.motion, law, interrupt)?.account();
                let found = self.evaluated(law, interrupt)?;
                let work = if shares.slip == 0.0 { 0.0 } else { found.work };
                Ok(Account { work, ..shares })
            }
            Form::PiecewiseLinear(_) | Form::Spectral(_) => {
                Ok(ScalarOrbit::new(self.motion, law, interrupt)?.account())
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
        let mut found = Evaluation::force_alone(set, directions)?;
        let mut evaluator = Evaluator::force_alone(set, (self.samples, 1), std::iter::once(law))?;
        if directions == 1 {
            evaluator.prepare(set, packed, interrupt)?;
        }
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
            let motion = self.actual.unwrap_or(packed);
            for (force, motion) in found.force.chunks_exact(m).zip(motion.chunks_exact(m)) {
                for (i, &h) in set.numbers().iter().enumerate() {
                    work += PI * h as f64 * (set.get(force, i) * set.get(motion, i).conj()).im;
                }
            }
        }
        Ok(Account { work, slip, open })
    }

    /// Smallest and largest motion in every direction, exactly.
    pub fn ranges(&self, interrupt: &Interrupt<'_>) -> Result<Vec<(f64, f64)>> {
        let PeriodicMotion { set, directions, .. } = self.motion;
        let mut search = TurningPoints::new(set)?;
        let mut extrema = extrema(set)?;
        let mut ranges = Vec::new();
        for k in 0..directions {
            let signal = self.actual.unwrap_or(self.motion.signal(k));
            search.find(set, signal, &mut extrema, interrupt)?;
            try_push(&mut ranges, range(set, signal, &extrema), CONTEXT)?;
        }
        Ok(ranges)
    }
}
