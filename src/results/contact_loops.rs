//! What happens inside a contact over the period: motions and full forces of all its directions and its
//! state at any time, the work that it takes, how long it slips or is open.
//!
//! Laws with events are followed exactly for the motion given, event by event, and no force is cut off at
//! the highest harmonic of the motion. Laws without memory are asked at the times wanted, laws with
//! states are marched over a period that has these times among its samples. By Parseval the work per
//! cycle is
//!
//! > ∮ f·dy = π Σ h Im(Fₕ conj Yₕ), summed over the directions,
//!
//! over the harmonics of the motion, with F as the solution was found with it; friction in one direction
//! under a constant load has a sum of positive terms instead, see [`scalar`].

pub mod from_samples;
pub mod one_motion;
pub mod two_motions;

use crate::aft::{Evaluation, Evaluator};
use crate::contact::contact_state::State;
use crate::contact::law::{Form, Law};
use crate::error::{Result, try_push, try_vec};
use crate::fourier::HarmonicSet;
use crate::fourier::{Extremum, TurningPoints, jet};
use crate::results::contact_loops::one_motion::ScalarOrbit;
use crate::results::contact_loops::two_motions::CoupledOrbit;
use std::f64::consts::{PI, TAU};

const CONTEXT: &str = "the loop of a contact";

/// What makes the force.
#[derive(Clone, Copy)]
enum Maker<'a> {
    Law(&'a dyn Law),
    /// A linear spring of that stiffness in every direction.
    Spring(f64),
}

/// A contact under a periodic motion; all quantities in the units of its law.
#[derive(Clone, Copy)]
pub struct Orbit<'a> {
    set: &'a HarmonicSet,
    /// d·m numbers, one direction after the other.
    motion: &'a [f64],
    directions: usize,
    maker: Maker<'a>,
    omega: f64,
    samples: usize,
}

/// A contact at ωt = 2πj/n, j = 0 .. n.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Times {
    /// Motions, n × d.
    pub motion: Vec<f64>,
    /// Forces, n × d.
    pub force: Vec<f64>,
    /// What the contact does, n.
    pub state: Vec<State>,
}

/// A contact over the whole period.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Account {
    /// Work per cycle that it takes from the motion.
    pub work: f64,
    /// Share of the period that it slips.
    pub slip: f64,
    /// Share of the period that it is open.
    pub open: f64,
}

impl<'a> Orbit<'a> {
    /// `law` under a packed motion, one direction after the other, at an angular frequency. `samples` are
    /// those asked for in the solution: 0 leaves their number to the law.
    #[must_use]
    pub fn new(set: &'a HarmonicSet, motion: &'a [f64], law: &'a dyn Law, omega: f64, samples: usize) -> Self {
        Self {
            set,
            motion,
            directions: law.directions(),
            maker: Maker::Law(law),
            omega,
            samples,
        }
    }

    /// A linear spring in each of some directions; stiffness 0 is without force.
    #[must_use]
    pub fn spring(set: &'a HarmonicSet, motion: &'a [f64], directions: usize, stiffness: f64) -> Self {
        Self {
            set,
            motion,
            directions,
            maker: Maker::Spring(stiffness),
            omega: 0.0,
            samples: 0,
        }
    }

    /// Relative motions d.
    #[must_use]
    pub fn directions(&self) -> usize {
        self.directions
    }

    /// Packed motion in the k-th direction.
    fn signal(&self, k: usize) -> &'a [f64] {
        let m = self.set.packed_len();
        &self.motion[k * m..(k + 1) * m]
    }

    /// The contact at n times.
    ///
    /// # Errors
    /// `OutOfMemory`; those of callbacks; `NoConvergence` for a law whose states do not become periodic.
    pub fn times(&self, n: usize) -> Result<Times> {
        let (set, d) = (self.set, self.directions);
        let mut out = Times {
            motion: try_vec(n.saturating_mul(d), 0.0, CONTEXT)?,
            force: try_vec(n.saturating_mul(d), 0.0, CONTEXT)?,
            state: try_vec(n, State::Stick, CONTEXT)?,
        };
        for (j, row) in out.motion.chunks_exact_mut(d.max(1)).enumerate() {
            let tau = time(set, j, n);
            for (k, x) in row.iter_mut().enumerate() {
                *x = jet(set, self.signal(k), tau).x;
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
                let orbit = ScalarOrbit::new(set, self.motion, law)?;
                let rows = out.force.iter_mut().zip(&mut out.state).zip(&out.motion);
                for (j, ((force, state), x)) in rows.enumerate() {
                    (*force, *state) = orbit.at(time(set, j, n), *x);
                }
            }
            Form::Coupled(law) => {
                let orbit = CoupledOrbit::new(set, self.motion, law)?;
                let rows = out.force.chunks_exact_mut(2).zip(&mut out.state);
                for (j, ((force, state), x)) in rows.zip(out.motion.chunks_exact(2)).enumerate() {
                    let found = orbit.at(time(set, j, n), [x[0], x[1]]);
                    force.copy_from_slice(&found.0);
                    *state = found.1;
                }
            }
            Form::Hysteretic(law) => from_samples::marched(self, law, &mut out)?,
            Form::Memoryless(law) => from_samples::pointwise(self, law, &mut out)?,
        }
        Ok(out)
    }

    /// Work and shares of the period. The work of laws that cannot dissipate, and of friction that does not
    /// slip, is exactly 0.
    ///
    /// # Errors
    /// As [`Self::times`].
    pub fn account(&self) -> Result<Account> {
        let Maker::Law(law) = self.maker else {
            return Ok(Account::default());
        };
        match law.form() {
            Form::PiecewiseLinear(_) | Form::Spectral(_) => Ok(ScalarOrbit::new(self.set, self.motion, law)?.account()),
            // A force that follows from one motion alone has a potential.
            Form::Memoryless(law) if law.directions() == 1 && !law.uses_velocity() => Ok(Account::default()),
            Form::Memoryless(_) | Form::Coupled(_) | Form::Hysteretic(_) => self.evaluated(law),
        }
    }

    /// Work and shares of the law as the solution knows it.
    fn evaluated(&self, law: &dyn Law) -> Result<Account> {
        let set = self.set;
        let mut found = Evaluation::new(set, self.directions)?;
        let mut evaluator = Evaluator::new(set, self.samples, std::iter::once(law))?;
        evaluator.evaluate(law, set, self.motion, self.omega, &mut found)?;
        let (slip, open) = (found.slip_fraction, found.open_fraction);
        let takes_nothing = match law.form() {
            // What sticks stores, and a contact that opens has slipped before, as its limit fell to zero.
            Form::Coupled(_) => slip == 0.0,
            Form::Hysteretic(law) => law.sticks() && slip == 0.0 && open == 0.0,
            _ => false,
        };
        let mut work = 0.0;
        if !takes_nothing {
            let m = set.packed_len().max(1);
            for (force, motion) in found.force.chunks_exact(m).zip(self.motion.chunks_exact(m)) {
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
    /// `OutOfMemory`.
    pub fn ranges(&self) -> Result<Vec<(f64, f64)>> {
        let mut search = TurningPoints::new(self.set)?;
        let mut extrema = extrema(self.set)?;
        let mut ranges = Vec::new();
        for k in 0..self.directions {
            search.find(self.set, self.signal(k), &mut extrema);
            try_push(&mut ranges, range(self.set, self.signal(k), &extrema), CONTEXT)?;
        }
        Ok(ranges)
    }
}

/// Sample j of n over the period, as a sample of the turn of τ, which is shorter where only multiples of a
/// harmonic are carried. Whole numbers cost no digit.
fn sample(set: &HarmonicSet, j: usize, n: usize) -> usize {
    (set.base() as u128 * j as u128 % n.max(1) as u128) as usize
}

/// Its τ in [0, 2π).
fn time(set: &HarmonicSet, j: usize, n: usize) -> f64 {
    TAU * sample(set, j, n) as f64 / n.max(1) as f64
}

/// An empty list with memory for the turning points of any motion: x' has at most 2·highest roots per turn, and
/// rounding may split some.
fn extrema(set: &HarmonicSet) -> Result<Vec<Extremum>> {
    let mut found = Vec::new();
    found
        .try_reserve(2 * set.highest_reduced() + 4)
        .map_err(|_| crate::error::Error::out_of_memory(CONTEXT))?;
    Ok(found)
}

/// Smallest and largest value of a signal with the given turning points.
fn range(set: &HarmonicSet, signal: &[f64], extrema: &[Extremum]) -> (f64, f64) {
    if extrema.is_empty() {
        let mean = if set.has_mean() { signal[0] } else { 0.0 };
        return (mean, mean);
    }
    let low = extrema.iter().map(|e| e.x).fold(f64::INFINITY, f64::min);
    let high = extrema.iter().map(|e| e.x).fold(f64::NEG_INFINITY, f64::max);
    if set.is_odd() {
        // The other half of the turn is the mirror image of the one that was scanned.
        let largest = high.max(-low);
        return (-largest, largest);
    }
    (low, high)
}
