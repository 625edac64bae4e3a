//! Laws that are evaluated at times only: those without memory at the requested times, those with states by a
//! march.

use crate::aft::hysteretic::HystereticEvaluator;
use crate::condense::blocks::memory_limit::{beyond, mega};
use crate::contact::forms::law::{Hysteretic, Memoryless};
use crate::contact::forms::samples::Samples;
use crate::error::{Result, try_copy, try_vec};
use crate::fourier::jet;
use crate::interrupt::Interrupt;
use crate::results::motions::contact_loops::period::{CONTEXT, PeriodicMotion, Times, sample, time};
use crate::results::motions::signal_check::check_time;

/// Bytes that a march may take.
/// Kind: cap.
const MOST_OF_A_MARCH: usize = 500 << 20;

/// A law without memory, evaluated at many times in one call.
pub(super) struct CalledForces<'a> {
    law: &'a dyn Memoryless,
    v: Vec<f64>,
    df_du: Vec<f64>,
    df_dv: Vec<f64>,
    scratch: Vec<f64>,
}

impl<'a> CalledForces<'a> {
    /// Memory for at most `most` times in one call.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(law: &'a dyn Memoryless, most: usize) -> Result<Self> {
        let memory = |size: usize| try_vec(most.saturating_mul(size), 0.0, CONTEXT);
        let (d, feels) = (law.directions(), usize::from(law.uses_velocity()));
        Ok(Self {
            law,
            v: memory(feels * d)?,
            df_du: memory(d * d)?,
            df_dv: memory(feels * d * d)?,
            scratch: memory(2 * d)?,
        })
    }

    /// Computes the forces at the motions in `out`, whose times begin with number `first` of n, in one call.
    ///
    /// # Errors
    /// `StoppedByCaller` and those of the law.
    pub fn fill(
        &mut self,
        motion: &PeriodicMotion<'_>,
        (first, n): (usize, usize),
        out: &mut Times,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let (count, d) = (out.state.len(), motion.directions);
        let feels = usize::from(self.law.uses_velocity());
        let v = &mut self.v[..feels * count * d];
        // τ runs `base` times as fast as ωt.
        let rate = motion.set.base() as f64 * motion.omega;
        for (j, row) in (first..).zip(v.chunks_exact_mut(d.max(1))) {
            check_time(interrupt, j, motion.set)?;
            let tau = time(motion.set, j, n);
            for (k, v) in row.iter_mut().enumerate() {
                *v = rate * jet(motion.set, motion.signal(k), tau).dx;
            }
        }
        let (df_du, df_dv) = (
            &mut self.df_du[..count * d * d],
            &mut self.df_dv[..feels * count * d * d],
        );
        df_du.fill(0.0);
        df_dv.fill(0.0);
        let samples = Samples {
            f: &mut out.force,
            df_du,
            df_dv,
            scratch: &mut self.scratch[..2 * count * d],
        };
        self.law.evaluate(motion.omega, count, &out.motion, v, samples)
    }
}

/// Forces of a law with states, marched over a multiple of the n times with at least as many samples as the law takes
/// in the solution.
pub(super) struct MarchedForces {
    /// Forces at the samples, d numbers a sample.
    forces: Vec<f64>,
    stride: usize,
}

impl MarchedForces {
    /// Marches the law over the period; `requested` is the number of samples of the solution.
    ///
    /// # Errors
    /// `OutOfMemory`, also where the march of so many times would take more than 500 MB; those of the law, `NoConvergence` when
    /// its states do not become periodic; `StoppedByCaller`.
    pub fn new(
        motion: &PeriodicMotion<'_>,
        n: usize,
        (law, requested): (&dyn Hysteretic, usize),
        interrupt: &Interrupt<'_>,
    ) -> Result<Self> {
        let highest = motion.set.highest_reduced();
        let least = law.samples(highest, requested).max(2 * highest + 1).max(2);
        let stride = least.div_ceil(n.max(1));
        let (samples, each) = (stride.saturating_mul(n), of_a_sample(motion, law));
        if samples.saturating_mul(each) > MOST_OF_A_MARCH && stride == 1 {
            return Err(beyond(format_args!(
                "n = {n} times of a law of the caller with states need a march of {} MB, more than the {} MB that a loop may take; \
                 needs n <= {}",
                mega(samples.saturating_mul(each)),
                mega(MOST_OF_A_MARCH),
                (MOST_OF_A_MARCH / each).max(least)
            )));
        }
        let mut way = HystereticEvaluator::force_alone(motion.set, law, samples)?;
        way.find_periodic_states(law, motion.omega, motion.packed, interrupt)?;
        Ok(Self {
            forces: try_copy(&way.march().f, CONTEXT)?,
            stride,
        })
    }

    /// Copies the forces of a slice that begins at the time `first` of n.
    pub fn copy(&self, motion: &PeriodicMotion<'_>, (first, n): (usize, usize), out: &mut Times) {
        let d = motion.directions;
        for (j, force) in (first..).zip(out.force.chunks_exact_mut(d.max(1))) {
            let at = self.stride * sample(motion.set, j, n);
            force.copy_from_slice(&self.forces[at * d..(at + 1) * d]);
        }
    }
}

/// Bytes of a march for each of its samples: basis of the motion and its derivative, motion, velocity, and results of
/// the law.
fn of_a_sample(motion: &PeriodicMotion<'_>, law: &dyn Hysteretic) -> usize {
    let (d, s, m) = (motion.directions, law.states(), motion.set.packed_len());
    let signals = (m + d) * (1 + usize::from(law.uses_velocity())) + 2;
    8 * (signals + 4 * d + 2 * s + s * s + 5 * s * d + 2 * d * d)
}
