//! A contact followed over the period, a slice of times after the other, so that memory does not grow with their number.

use crate::contact::forms::contact_state::State;
use crate::contact::forms::law::{Form, Law};
use crate::error::{Result, boxed, try_room};
use crate::fourier::jet;
use crate::interrupt::Interrupt;
use crate::results::motions::contact_loops::from_samples::{CalledForces, MarchedForces};
use crate::results::motions::contact_loops::one_motion::ScalarOrbit;
use crate::results::motions::contact_loops::period::{CONTEXT, PeriodicMotion, Times, time};
use crate::results::motions::contact_loops::plane_motion::PlaneOrbit;
use crate::results::motions::contact_loops::two_motions::CoupledOrbit;
use crate::results::motions::signal_check::check_time;

/// Times of a slice.
/// Kind: block.
const SLICE: usize = 1 << 14;

/// A contact under a periodic motion at n times, with its events located and its states found.
pub struct Follower<'a> {
    motion: PeriodicMotion<'a>,
    /// Packed motion of the contact itself, where the law has an exchanged motion; else `None`.
    actual: Option<&'a [f64]>,
    n: usize,
    way: Way<'a>,
}

/// How the force is computed at the times.
enum Way<'a> {
    /// A linear spring of this stiffness in every direction.
    Spring(f64),
    Scalar(ScalarOrbit<'a>),
    Coupled(CoupledOrbit<'a>),
    Plane(Box<PlaneOrbit<'a>>),
    CalledForces(CalledForces<'a>),
    MarchedForces(MarchedForces),
}

impl<'a> Follower<'a> {
    /// A linear spring at n times.
    pub(super) fn of_spring(motion: PeriodicMotion<'a>, n: usize, stiffness: f64) -> Self {
        let way = Way::Spring(stiffness);
        Self {
            motion,
            actual: None,
            n,
            way,
        }
    }

    /// Follows a law at n times; `samples` is the number requested in the solution.
    ///
    /// # Errors
    /// `OutOfMemory`; those of callbacks; `NoConvergence` for a law whose states do not become periodic; `StoppedByCaller`.
    pub(super) fn of_law(
        motion: PeriodicMotion<'a>,
        actual: Option<&'a [f64]>,
        n: usize,
        law: &'a dyn Law,
        samples: usize,
        interrupt: &Interrupt<'_>,
    ) -> Result<Self> {
        let PeriodicMotion { set, packed, .. } = motion;
        let way = match law.form() {
            Form::PiecewiseLinear(_) | Form::Spectral(_) => Way::Scalar(ScalarOrbit::new(motion, law, interrupt)?),
            Form::VaryingNormalLoad(law) => Way::Coupled(CoupledOrbit::new(set, packed, law, interrupt)?),
            Form::PlaneFriction(law) => Way::Plane(boxed(|| PlaneOrbit::new(&motion, law, interrupt))?),
            Form::Hysteretic(law) => Way::MarchedForces(MarchedForces::new(&motion, n, (law, samples), interrupt)?),
            Form::Memoryless(law) => Way::CalledForces(CalledForces::new(law, SLICE.min(n))?),
        };
        Ok(Self { motion, actual, n, way })
    }

    /// Calls `take` with one slice of the times after the other.
    ///
    /// # Errors
    /// `OutOfMemory`, `StoppedByCaller`, and those of a law of the caller.
    pub fn each(&mut self, interrupt: &Interrupt<'_>, mut take: impl FnMut(&Times)) -> Result<()> {
        let (d, most) = (self.motion.directions, SLICE.min(self.n));
        let mut slice = Times {
            motion: try_room(most.saturating_mul(d), CONTEXT)?,
            force: try_room(most.saturating_mul(d), CONTEXT)?,
            state: try_room(most, CONTEXT)?,
        };
        for first in (0..self.n).step_by(SLICE) {
            let count = SLICE.min(self.n - first);
            slice.motion.resize(count * d, 0.0);
            slice.force.clear();
            slice.force.resize(count * d, 0.0);
            slice.state.clear();
            slice.state.resize(count, State::Stick);
            self.fill(first, &mut slice, interrupt)?;
            take(&slice);
        }
        Ok(())
    }

    /// Fills a slice with motions, forces and states, from time number `first` of n on.
    fn fill(&mut self, first: usize, out: &mut Times, interrupt: &Interrupt<'_>) -> Result<()> {
        let PeriodicMotion { set, directions: d, .. } = self.motion;
        let n = self.n;
        for (j, row) in (first..).zip(out.motion.chunks_exact_mut(d.max(1))) {
            check_time(interrupt, j, set)?;
            let tau = time(set, j, n);
            for (k, x) in row.iter_mut().enumerate() {
                *x = jet(set, self.motion.signal(k), tau).x;
            }
        }
        match &mut self.way {
            Way::Spring(stiffness) => {
                for (f, x) in out.force.iter_mut().zip(&out.motion) {
                    *f = *stiffness * x;
                }
            }
            Way::Scalar(orbit) => {
                let rows = out.force.iter_mut().zip(&mut out.state).zip(&out.motion);
                for (j, ((force, state), x)) in (first..).zip(rows) {
                    check_time(interrupt, j, set)?;
                    (*force, *state) = orbit.at(time(set, j, n), *x);
                }
            }
            Way::Coupled(orbit) => {
                let rows = out.force.chunks_exact_mut(2).zip(&mut out.state);
                for (j, ((force, state), x)) in (first..).zip(rows.zip(out.motion.chunks_exact(2))) {
                    check_time(interrupt, j, set)?;
                    let found = orbit.at(time(set, j, n), [x[0], x[1]]);
                    force.copy_from_slice(&found.0);
                    *state = found.1;
                }
            }
            Way::Plane(orbit) => {
                let rows = out.force.chunks_exact_mut(d).zip(&mut out.state);
                for (j, ((force, state), x)) in (first..).zip(rows.zip(out.motion.chunks_exact(d))) {
                    check_time(interrupt, j, set)?;
                    *state = orbit.at(time(set, j, n), x, force);
                }
            }
            Way::MarchedForces(orbit) => orbit.copy(&self.motion, (first, n), out),
            Way::CalledForces(law) => law.fill(&self.motion, (first, n), out, interrupt)?,
        }
        if let Some(actual) = self.actual {
            for (j, x) in (first..).zip(&mut out.motion) {
                check_time(interrupt, j, set)?;
                *x = jet(set, actual, time(set, j, n)).x;
            }
        }
        Ok(())
    }
}
