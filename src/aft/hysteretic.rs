//! Harmonics of a law with states, marched over samples: periodic states, force, and the exact derivative of the
//! discrete force.
//!
//! The states at the start of the period are those that return after it. They follow by Newton's method from the
//! virgin ones, loaded from rest straight to the motion of the last sample, so that the result depends on the motion
//! alone. If a law keeps states to which it was marched, these are taken. With the basis bⱼ at sample j the
//! derivatives of the states follow from those of the steps,
//! > Sⱼ = Aⱼ Sⱼ₋₁ + Bⱼ⁻ bⱼ₋₁ + Bⱼ bⱼ,  ∂F/∂X = Σ w ⊗ bⱼ ⊗ (∂f/∂z Sⱼ + ∂f/∂u bⱼ)
//!
//! (velocities alike), starting with the derivative of the periodic start; see periodic_state.rs. Force and
//! derivative are those of the sampled law: as accurate as the samples, but exact as a pair.

use crate::aft::evaluation::Evaluation;
use crate::aft::hysteretic_derivatives::{Sensitivity, Signals};
use crate::aft::periodic_state::{ReturnMap, largest};
use crate::contact::forms::law::Hysteretic;
use crate::contact::forms::march::March;
use crate::error::{Error, Result, Status, boxed, fail, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;

/// Largest number of marches that may end in a step of Newton's method.
/// Kind: cap.
const NEWTON_MARCHES: usize = 100;

/// Largest number of marches; those beyond [`NEWTON_MARCHES`] start where the previous march ended.
/// Kind: cap.
const MARCHES: usize = 300;

/// Tables and memory for marching one law over motions of one harmonic set.
pub struct HystereticEvaluator {
    states: usize,
    /// Common divisor g of the numbers of the carried harmonics.
    base: f64,
    signals: Signals,
    load: NormalLoad,
    march: Box<March>,
    map: ReturnMap,
    /// Memory for derivatives; `None` where the force alone is evaluated.
    sensitivity: Option<Sensitivity>,
    /// Initial states of each march.
    starts: Vec<f64>,
    /// For each march, whether the next start follows from Newton's method.
    by_newton: Vec<bool>,
    step: Vec<f64>,
    marches: usize,
}

/// Weights of samples, and the motions that load a contact.
pub struct NormalLoad {
    /// Fourier weights of the numbers of a packed signal.
    weights: Vec<f64>,
    /// Motion and velocity of a straight load from zero, as two samples of a period: the loaded one, then zero.
    u: Vec<f64>,
    v: Vec<f64>,
}

impl HystereticEvaluator {
    /// Tables and memory for `law` at `samples` samples per period of motions of `set`.
    ///
    /// # Errors
    /// `Argument` for too few samples; `OutOfMemory`.
    pub fn new(set: &HarmonicSet, law: &dyn Hysteretic, samples: usize) -> Result<Self> {
        Self::with(set, law, samples, false)
    }

    /// Tables and memory for the force alone.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn force_alone(set: &HarmonicSet, law: &dyn Hysteretic, samples: usize) -> Result<Self> {
        Self::with(set, law, samples, true)
    }

    fn with(set: &HarmonicSet, law: &dyn Hysteretic, samples: usize, force_alone: bool) -> Result<Self> {
        let least = (2 * set.highest_reduced() + 1).max(2);
        if samples < least {
            return fail!(
                Argument,
                "samples = {samples}, needs at least {least} for the harmonics carried"
            );
        }
        let (d, s) = (law.directions(), law.states());
        let memory = |size: usize| try_vec(size, 0.0, "a march over samples");
        let mean = usize::from(set.has_mean());
        let mut weights = try_vec(set.packed_len(), 2.0 / samples as f64, "a march over samples")?;
        weights[..mean].fill(1.0 / samples as f64);
        Ok(Self {
            states: s,
            base: set.base() as f64,
            signals: Signals::new(set, d, law.uses_velocity(), samples)?,
            load: NormalLoad {
                weights,
                u: memory(2 * d)?,
                v: memory(if law.uses_velocity() { 2 * d } else { 0 })?,
            },
            march: boxed(|| March::new(d, s, samples))?,
            map: ReturnMap::new(s)?,
            sensitivity: if force_alone {
                None
            } else {
                Some(Sensitivity::new(d, s, set.packed_len())?)
            },
            starts: memory(s.saturating_mul(MARCHES))?,
            by_newton: try_vec(MARCHES, false, "a march over samples")?,
            step: memory(s)?,
            marches: 0,
        })
    }

    /// Whether the memory suits `law` at this number of samples.
    pub fn suits(&self, law: &dyn Hysteretic, samples: usize) -> bool {
        self.signals.directions == law.directions()
            && self.states == law.states()
            && self.load.v.is_empty() != law.uses_velocity()
            && self.signals.samples == samples
    }

    /// The march of the last evaluation: forces and states at the samples.
    #[must_use]
    pub fn march(&self) -> &March {
        &self.march
    }

    /// Number of marches with which the last evaluation found its periodic states.
    #[must_use]
    pub fn marches(&self) -> usize {
        self.marches
    }

    /// Force, Jacobian and derivative by ω of `law` at the circular frequency `omega` > 0 for a packed motion, one
    /// direction after the other. `law` has the directions and states of the one for which memory was allocated.
    ///
    /// # Errors
    /// Those of the law; `NoConvergence` if its states do not become periodic, `NotFinite` if they do not stay
    /// finite; `StoppedByCaller`.
    pub fn evaluate(
        &mut self,
        law: &dyn Hysteretic,
        omega: f64,
        motion: &[f64],
        out: &mut Evaluation,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        self.find_periodic_states(law, omega, motion, interrupt)?;
        let omega = self.base * omega;
        for sums in [&mut out.force, &mut out.jacobian, &mut out.by_omega] {
            sums.fill(0.0);
        }
        if !out.is_force_alone() {
            self.differentiate(law, omega, interrupt)?;
        }
        self.signals.add_forces(&self.march, out);
        if let Some(sensitivity) = self.sensitivity.as_mut().filter(|_| !out.is_force_alone()) {
            sensitivity.add_to(&self.signals, out);
        }
        self.finish(motion, out);
        (out.slip_fraction, out.open_fraction) = (0.0, 0.0);
        (out.stuck, out.linear) = (false, false);
        Ok(())
    }

    /// Finds the periodic states alone, the first step of [`Self::evaluate`]; [`Self::march`] then has the forces and
    /// states.
    ///
    /// # Errors
    /// Those of [`Self::evaluate`].
    pub fn find_periodic_states(
        &mut self,
        law: &dyn Hysteretic,
        omega: f64,
        motion: &[f64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        // The period of the law is 2π/(gω), that of the set.
        let omega = self.base * omega;
        self.signals.fill(omega, motion);
        self.find_period(law, omega, interrupt)
    }

    /// Multiplies the Fourier sums by their weights, and computes the offset.
    fn finish(&self, motion: &[f64], out: &mut Evaluation) {
        let weigh = |sums: &mut [f64]| {
            for signal in sums.chunks_exact_mut(self.load.weights.len().max(1)) {
                for (value, weight) in signal.iter_mut().zip(&self.load.weights) {
                    *value *= weight;
                }
            }
        };
        weigh(&mut out.force);
        weigh(&mut out.by_omega);
        out.by_omega.iter_mut().for_each(|f| *f *= self.base);
        out.offset.copy_from_slice(&out.force);
        for (column, x) in out.jacobian.chunks_exact_mut(motion.len().max(1)).zip(motion) {
            weigh(column);
            for (o, j) in out.offset.iter_mut().zip(column) {
                *o -= *j * x;
            }
        }
    }

    /// Marches through one period from the states `starts[k]`.
    fn march_from(&mut self, law: &dyn Hysteretic, omega: f64, k: usize) -> Result<()> {
        let z0 = &self.starts[k * self.states..(k + 1) * self.states];
        let Signals { samples, u, v, .. } = &self.signals;
        law.march(omega, *samples, u, v, z0, &mut self.march)
    }

    /// Loads the law in its virgin state from zero straight to the motion of the last sample, which gives the first
    /// start and its derivative.
    fn load(&mut self, law: &dyn Hysteretic, omega: f64) -> Result<()> {
        let Signals {
            samples,
            directions,
            u,
            v,
            ..
        } = &self.signals;
        let last = (samples - 1) * directions;
        self.load.u[..*directions].copy_from_slice(&u[last..]);
        if !v.is_empty() {
            self.load.v[..*directions].copy_from_slice(&v[last..]);
        }
        self.step.fill(0.0);
        law.march(omega, 2, &self.load.u, &self.load.v, &self.step, &mut self.march)?;
        self.starts[..self.states].copy_from_slice(&self.march.z[..self.states]);
        if let Some(sensitivity) = &mut self.sensitivity {
            sensitivity.load(&self.march, &self.signals, omega);
        }
        Ok(())
    }

    /// Finds initial states that return after one period.
    ///
    /// If a law keeps a state to which slip led, this state lies on the border of those without slip; its place there
    /// depends on the slip of the earlier marches, which a step of Newton's method does not follow. The law is then
    /// marched from the load on, if that takes no more than [`MARCHES`].
    fn find_period(&mut self, law: &dyn Hysteretic, omega: f64, interrupt: &Interrupt<'_>) -> Result<()> {
        self.load(law, omega)?;
        let mut defect = self.search(law, omega, (NEWTON_MARCHES, MARCHES), interrupt)?;
        let guessed = self.by_newton[..self.marches - 1].contains(&true);
        if defect == 0.0 && self.map.has_kept && guessed && self.search(law, omega, (0, MARCHES), interrupt)? > 0.0 {
            defect = self.search(law, omega, (NEWTON_MARCHES, MARCHES), interrupt)?;
        }
        if defect > 0.0 {
            return Err(Error::new(
                Status::NoConvergence,
                format_args!(
                    "the states did not return after {MARCHES} periods (difference {defect:.1e}); raise samples"
                ),
            )
            .recoverable());
        }
        Ok(())
    }

    /// Marches from the first start until the states return up to round-off, with Newton's method up to the march
    /// `newton_until`. Returns the difference of the states over the last march, 0 if they return.
    fn search(
        &mut self,
        law: &dyn Hysteretic,
        omega: f64,
        (newton_until, most): (usize, usize),
        interrupt: &Interrupt<'_>,
    ) -> Result<f64> {
        let (s, n) = (self.states, self.signals.samples);
        let tolerance = f64::EPSILON * (64.0 + 4.0 * (n as f64).sqrt());
        let mut before = f64::INFINITY;
        for k in 0..most {
            interrupt.check()?;
            self.march_from(law, omega, k)?;
            let end = &self.march.z[(n - 1) * s..n * s];
            for ((step, end), start) in self.step.iter_mut().zip(end).zip(&self.starts[k * s..]) {
                *step = end - start;
            }
            let defect = largest(&self.step);
            if !defect.is_finite() {
                let message = format_args!("the states are not finite after a period");
                return Err(Error::new(Status::NotFinite, message).recoverable());
            }
            self.marches = k + 1;
            if defect <= tolerance * largest(&self.march.z[..n * s]) {
                self.map.form(&self.march, n, interrupt)?;
                return Ok(0.0);
            }
            if k + 1 == most {
                return Ok(defect);
            }
            // Newton's method starts after two marches, in which slip may end; a defect that grew needs a plain
            // march.
            let mut by_newton = k > 0 && k < newton_until && defect < before;
            before = defect;
            if by_newton {
                self.map.form(&self.march, n, interrupt)?;
                by_newton = self.map.is_regular;
            }
            if by_newton {
                self.map.solve(&mut self.step);
                by_newton = self.step.iter().all(|x| x.is_finite());
            }
            self.by_newton[k] = by_newton;
            let (starts, next) = self.starts.split_at_mut((k + 1) * s);
            for (i, next) in next[..s].iter_mut().enumerate() {
                *next = if by_newton {
                    starts[k * s + i] + self.step[i]
                } else {
                    self.march.z[(n - 1) * s + i]
                };
            }
        }
        Ok(0.0)
    }

    /// Computes the derivatives of the force by the motion and by ω, the effect on the periodic start included. Only
    /// where a start is kept in part does it depend on the earlier marches; their derivatives are then followed from
    /// the load on.
    fn differentiate(&mut self, law: &dyn Hysteretic, omega: f64, interrupt: &Interrupt<'_>) -> Result<()> {
        let last = self.marches - 1;
        let Some(mut sensitivity) = self.sensitivity.take() else {
            return Ok(());
        };
        let followed = self.follow(&mut sensitivity, last, (law, omega), interrupt);
        self.sensitivity = Some(sensitivity);
        followed
    }

    /// Follows the derivatives of the starts up to march number `last`, into `sensitivity`.
    fn follow(
        &mut self,
        sensitivity: &mut Sensitivity,
        last: usize,
        (law, omega): (&dyn Hysteretic, f64),
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        if self.map.has_kept && last > 0 {
            for k in 0..last {
                interrupt.check()?;
                self.march_from(law, omega, k)?;
                sensitivity.pass(&self.march, &self.signals, omega, false, interrupt)?;
                if self.by_newton[k] {
                    self.map.form(&self.march, self.signals.samples, interrupt)?;
                    sensitivity.periodic(&self.map);
                } else {
                    sensitivity.onward();
                }
            }
            self.march_from(law, omega, last)?;
            self.map.form(&self.march, self.signals.samples, interrupt)?;
        }
        sensitivity.pass(&self.march, &self.signals, omega, true, interrupt)?;
        if self.map.is_regular {
            sensitivity.periodic(&self.map);
        } else {
            sensitivity.onward();
        }
        Ok(())
    }
}
