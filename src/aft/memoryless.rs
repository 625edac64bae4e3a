//! Evaluation of laws without memory: from samples of motion and velocity to harmonics of the force and their
//! derivatives.
//!
//! With the spectra Sᵘ and Sᵛ of the tangents ∂f/∂u and ∂f/∂v, and D the derivative by time, which multiplies Xₕ by
//! iωh,
//!
//! > ∂F/∂X = T(Sᵘ) + T(Sᵛ)·D,  ∂F/∂ω = T(Sᵛ)·(ihX),  offset = F − ∂F/∂X · X.
//!
//! Both are the exact derivatives of the sampled F, however few the samples, because the samples of a motion are
//! linear in its harmonics.

use crate::aft::evaluation::Evaluation;
use crate::aft::toeplitz::Toeplitz;
use crate::contact::forms::law::Memoryless;
use crate::contact::forms::samples::Samples;
use crate::error::{Result, fail, try_vec};
use crate::fourier::HarmonicSet;
use crate::fourier::transform::{Half, Lane, Transform};
use crate::interrupt::Interrupt;
use num_complex::Complex64;

/// Tables and memory for one law, or for several of equal directions and samples, on the motions of one harmonic set.
pub struct MemorylessEvaluator {
    directions: usize,
    velocity: bool,
    half_suffices: bool,
    /// Number of samples per period that was requested.
    requested: usize,
    transform: Transform,
    signals: SampledSignals,
    memory: TransformMemory,
    toeplitz: Toeplitz,
}

/// Motion, force and their derivatives at the samples.
pub struct SampledSignals {
    /// Motions and velocities at the samples, samples × d each.
    u: Vec<f64>,
    v: Vec<f64>,
    /// Forces at the samples, samples × d, and their tangents, samples × d × d.
    f: Vec<f64>,
    df_du: Vec<f64>,
    df_dv: Vec<f64>,
}

/// Memory of transforms.
pub struct TransformMemory {
    scratch: Vec<f64>,
    /// Harmonics 0 ..= 2·highest of the signal transformed last.
    spectrum: Vec<Complex64>,
    /// Harmonics ih·X of the derivative by the reduced time, d·m numbers.
    quadrature: Vec<f64>,
    /// Packed harmonics of one velocity, m numbers.
    packed: Vec<f64>,
    /// Operator T(Sᵛ) of one pair of directions, m × m.
    block: Vec<f64>,
}

impl MemorylessEvaluator {
    /// Memory for `law` on motions of `set` at `requested` samples per period or a few more.
    ///
    /// # Errors
    /// `Argument` for a law without directions, and for fewer samples than distinguish the harmonics; `OutOfMemory`.
    pub fn new(set: &HarmonicSet, law: &dyn Memoryless, requested: usize) -> Result<Self> {
        Self::with(set, law, requested, false)
    }

    /// Memory for the force alone.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn force_alone(set: &HarmonicSet, law: &dyn Memoryless, requested: usize) -> Result<Self> {
        Self::with(set, law, requested, true)
    }

    fn with(set: &HarmonicSet, law: &dyn Memoryless, requested: usize, force_alone: bool) -> Result<Self> {
        let (d, m) = (law.directions(), set.packed_len());
        let highest = set.highest_reduced();
        if d == 0 {
            return fail!(Argument, "directions = 0 of a contact law, needs at least 1");
        }
        if requested <= 2 * highest {
            return fail!(
                Argument,
                "samples = {requested} of a contact law, needs at least {} for {highest} harmonics",
                2 * highest + 1
            );
        }
        let half = set.is_odd() && law.half_period_suffices();
        let transform = Transform::new(set, requested, half)?;
        let n = transform.held();
        let velocity = law.uses_velocity();
        let with_velocity = usize::from(velocity);
        let signals = n.saturating_mul(d);
        let tangents = signals.saturating_mul(d);
        let samples = |len: usize| try_vec(len, 0.0, "samples");
        Ok(Self {
            directions: d,
            velocity,
            half_suffices: law.half_period_suffices(),
            requested,
            transform,
            signals: SampledSignals {
                u: samples(signals)?,
                v: samples(with_velocity * signals)?,
                f: samples(signals)?,
                df_du: samples(tangents)?,
                df_dv: samples(with_velocity * tangents)?,
            },
            memory: TransformMemory {
                scratch: samples(signals.saturating_mul(2))?,
                spectrum: try_vec(2 * highest + 1, Complex64::ZERO, "a stiffness spectrum")?,
                quadrature: samples(with_velocity * d * m)?,
                packed: samples(with_velocity * m)?,
                block: if force_alone {
                    Vec::new()
                } else {
                    try_vec(with_velocity * m.saturating_mul(m), 0.0, "a contact Jacobian")?
                },
            },
            toeplitz: Toeplitz::new(set)?,
        })
    }

    /// Whether the memory suits `law` at this number of samples.
    pub fn suits(&self, law: &dyn Memoryless, requested: usize) -> bool {
        self.directions == law.directions()
            && self.velocity == law.uses_velocity()
            && self.half_suffices == law.half_period_suffices()
            && self.requested == requested
    }

    /// Force and derivatives of `law` at a motion, d·m numbers, direction after direction. `law` is the one for which
    /// memory was allocated, or the same in other units.
    ///
    /// # Errors
    /// Those of the law, `StoppedByCaller`; `out` is then invalid.
    pub fn evaluate(
        &mut self,
        law: &dyn Memoryless,
        set: &HarmonicSet,
        (omega, motion): (f64, &[f64]),
        out: &mut Evaluation,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        if motion.is_empty() {
            // The set has no harmonics.
            return Ok(());
        }
        self.sample(set, omega, motion, interrupt)?;
        for values in [&mut self.signals.f, &mut self.signals.df_du, &mut self.signals.df_dv] {
            values.fill(0.0);
        }
        let samples = Samples {
            f: &mut self.signals.f,
            df_du: &mut self.signals.df_du,
            df_dv: &mut self.signals.df_dv,
            scratch: &mut self.memory.scratch,
        };
        // The samples cover the period 2π/(gω) of the set.
        let own = set.base() as f64 * omega;
        interrupt.check()?;
        law.evaluate(own, self.transform.held(), &self.signals.u, &self.signals.v, samples)?;
        out.clear();
        self.forces(set, out);
        if out.is_force_alone() {
            return Ok(());
        }
        self.tangents(set, omega, out, interrupt)?;
        // F − J·X
        let order = out.force.len();
        out.offset.copy_from_slice(&out.force);
        for (column, x) in out.jacobian.chunks_exact(order).zip(motion) {
            for (o, j) in out.offset.iter_mut().zip(column) {
                *o -= j * x;
            }
        }
        Ok(())
    }

    /// Computes motions and velocities at the samples.
    fn sample(&mut self, set: &HarmonicSet, omega: f64, motion: &[f64], interrupt: &Interrupt<'_>) -> Result<()> {
        let m = set.packed_len();
        let step = self.directions;
        for first in 0..step {
            interrupt.check()?;
            let lane = Lane { first, step };
            let x = &motion[first * m..(first + 1) * m];
            self.transform.synthesise(set, x, &mut self.signals.u, lane);
            if !self.velocity {
                continue;
            }
            let quadrature = &mut self.memory.quadrature[first * m..(first + 1) * m];
            for (i, &h) in set.numbers().iter().enumerate() {
                let rotated = Complex64::I * h as f64 * set.get(x, i);
                set.set(quadrature, i, rotated);
            }
            for (v, q) in self.memory.packed.iter_mut().zip(&*quadrature) {
                *v = omega * q;
            }
            self.transform
                .synthesise(set, &self.memory.packed, &mut self.signals.v, lane);
        }
        Ok(())
    }

    /// Computes the packed harmonics of the forces.
    fn forces(&mut self, set: &HarmonicSet, out: &mut Evaluation) {
        let (m, step) = (set.packed_len(), self.directions);
        let harmonics = &mut self.memory.spectrum[..=set.highest_reduced()];
        let mean = usize::from(set.has_mean());
        for (first, force) in out.force.chunks_exact_mut(m).enumerate() {
            self.transform
                .analyse(&self.signals.f, Lane { first, step }, Half::Opposite, harmonics);
            if mean == 1 {
                force[0] = harmonics[0].re;
            }
            for (k, pair) in force[mean..].chunks_exact_mut(2).enumerate() {
                let z = 2.0 * harmonics[set.reduced(k)];
                pair[0] = z.re;
                pair[1] = z.im;
            }
        }
    }

    /// Computes the Jacobian and ∂F/∂ω, one pair of directions after the other.
    fn tangents(
        &mut self,
        set: &HarmonicSet,
        omega: f64,
        out: &mut Evaluation,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let (m, d) = (set.packed_len(), self.directions);
        let order = d * m;
        let step = d * d;
        for j in 0..d {
            for i in 0..d {
                interrupt.check_before((2 * m * m) as u64)?;
                let lane = Lane { first: i * d + j, step };
                let corner = j * m * order + i * m;
                self.transform
                    .analyse(&self.signals.df_du, lane, Half::Repeats, &mut self.memory.spectrum);
                self.toeplitz.set(set, &self.memory.spectrum);
                self.toeplitz.add(&mut out.jacobian[corner..], order);
                if !self.velocity {
                    continue;
                }
                self.transform
                    .analyse(&self.signals.df_dv, lane, Half::Repeats, &mut self.memory.spectrum);
                self.memory.block.fill(0.0);
                self.toeplitz.set(set, &self.memory.spectrum);
                self.toeplitz.add(&mut self.memory.block, m);
                let by_omega = &mut out.by_omega[i * m..(i + 1) * m];
                let quadrature = &self.memory.quadrature[j * m..(j + 1) * m];
                for (column, q) in self.memory.block.chunks_exact(m).zip(quadrature) {
                    for (b, t) in by_omega.iter_mut().zip(column) {
                        *b += t * q;
                    }
                }
                // T·D: D maps (Re, Im) to ωh·(−Im, Re), so its columns are those of T, exchanged.
                let mean = usize::from(set.has_mean());
                for (pair, &h) in set.numbers()[mean..].iter().enumerate() {
                    let rate = omega * h as f64;
                    let at = mean + 2 * pair;
                    let (re, im) = self.memory.block[at * m..(at + 2) * m].split_at(m);
                    for (shift, factor, source) in [(0, rate, im), (1, -rate, re)] {
                        let begin = corner + (at + shift) * order;
                        for (entry, t) in out.jacobian[begin..begin + m].iter_mut().zip(source) {
                            *entry += factor * t;
                        }
                    }
                }
            }
        }
        Ok(())
    }
}
