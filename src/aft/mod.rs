//! Alternating frequency-time evaluation of a contact law: harmonics of the motion in, harmonics
//! of the force and their Jacobian out.
//!
//! Both ways of integrating, [`exact`] events and [`sampled`] times, end in the same assembly.
//! With pieces f = k·(x − x(r)) + o, the stiffness spectrum Sₙ = (1/2π)∫ k e^{−inτ} dτ and the
//! transforms gₕ = (2 − δ₀ₕ)/2π ∫ e^{−ihτ} dτ of each anchored piece,
//!
//! > ∂F/∂X = T(S) − Σ k g ⊗ c(r),  F = ∂F/∂X · X + Σ o g,
//!
//! because the force is continuous where pieces meet, so that moving events contribute nothing
//! (Petrov & Ewins 2003, doi:10.1115/1.1539868). T(S) maps Xₘ to Sₕ₋ₘ Xₘ + Sₕ₊ₘ conj(Xₘ). A smooth
//! law gives S at once, without pieces. Friction under a varying normal load has one such sum per
//! pair of directions; see [`coupled`].

pub mod hysteretic;
mod hysteretic_derivatives;
mod jacobian_assembly;
mod jacobian_block;
pub mod memoryless;
mod normal_force;
mod periodic_state;
pub mod piecewise_exact;
pub mod piecewise_sampled;
mod spectral;
mod toeplitz;
pub mod varying_normal_load;

use crate::aft::hysteretic::HystereticEvaluator;
use crate::aft::jacobian_assembly::Assembly;
use crate::aft::jacobian_block::{Block, add_stiffness, apply, pack};
use crate::aft::memoryless::MemorylessEvaluator;
use crate::aft::varying_normal_load::Coupled;
use crate::contact::contact_state::State;
use crate::contact::{Form, Law};
use crate::error::{Result, fail, try_push, try_vec};
use crate::fourier::HarmonicSet;

/// Ways of evaluating laws, with their tables.
pub struct Evaluator {
    /// Laws on one relative motion.
    scalar: Scalar,
    smooth: Assembly,
    /// Friction under a varying normal load.
    coupled: Option<Box<Coupled>>,
    /// Laws with states, by their directions, states and samples.
    marched: Vec<HystereticEvaluator>,
    /// Laws without memory, by their directions and samples.
    pointwise: Vec<MemorylessEvaluator>,
    sampling: Sampling,
}

/// How many samples laws are given that have no exact events.
#[derive(Clone, Copy)]
struct Sampling {
    /// Samples asked for; 0 for what suits the law.
    asked: usize,
    /// Whether to take half of them, or twice as many where half are too few.
    other: bool,
}

impl Sampling {
    fn of(self, samples: usize, highest: usize) -> usize {
        match samples / 2 {
            _ if !self.other => samples,
            half if half > 2 * highest => half,
            _ => samples.saturating_mul(2),
        }
    }
}

/// Way of evaluating laws on one relative motion.
enum Scalar {
    /// Events located, integrals in closed form.
    Exact(Box<piecewise_exact::Exact>),
    /// Equidistant samples.
    Sampled(Box<piecewise_sampled::Sampled>),
}

/// Harmonics of a contact force and what belongs to them, all in packed form, one direction of the law
/// after the other.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// Directions d of the relative motion; m is the packed length of one signal.
    pub directions: usize,
    /// F, d·m numbers.
    pub force: Vec<f64>,
    /// ∂F/∂X, (d·m)², column-major.
    pub jacobian: Vec<f64>,
    /// F − ∂F/∂X · X, the derivative by ln s of s·F(X/s), the law as seen at a motion s times smaller.
    pub offset: Vec<f64>,
    /// ∂F/∂ω at fixed X; zero unless the law knows velocities.
    pub by_omega: Vec<f64>,
    /// Share of the period that is spent slipping, 0 for a stuck contact.
    pub slip_fraction: f64,
    /// Share of the period that is spent open.
    pub open_fraction: f64,
    /// Whether the contact sticks through the period: one piece without anchor, F = kt·X (and closed
    /// throughout, where the normal load varies). Never so for a smooth law.
    pub stuck: bool,
}

impl Evaluation {
    /// Memory for the signals of `set` in a number of directions.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(set: &HarmonicSet, directions: usize) -> Result<Self> {
        let m = set.packed_len().saturating_mul(directions);
        Ok(Self {
            directions,
            force: try_vec(m, 0.0, "a contact force")?,
            jacobian: try_vec(m.saturating_mul(m), 0.0, "a contact Jacobian")?,
            offset: try_vec(m, 0.0, "a contact force")?,
            by_omega: try_vec(m, 0.0, "a contact force")?,
            slip_fraction: 0.0,
            open_fraction: 0.0,
            stuck: false,
        })
    }

    /// Counts a share of the period that is spent in a state.
    fn count(&mut self, state: State, share: f64) {
        match state {
            State::Stick => {}
            State::Slip => self.slip_fraction += share,
            State::Open => self.open_fraction += share,
        }
    }

    /// Clears what the last evaluation left.
    fn clear(&mut self) {
        self.jacobian.fill(0.0);
        self.clear_forces();
    }

    /// The same, but for the Jacobian.
    fn clear_forces(&mut self) {
        self.offset.fill(0.0);
        self.by_omega.fill(0.0);
        self.slip_fraction = 0.0;
        self.open_fraction = 0.0;
        self.stuck = false;
    }
}

impl Evaluator {
    /// Tables for motions of `set` under `laws`; `samples` = 0 locates events exactly where the law has
    /// them.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new<'l>(set: &HarmonicSet, samples: usize, laws: impl Iterator<Item = &'l dyn Law>) -> Result<Self> {
        Self::with(
            set,
            Sampling {
                asked: samples,
                other: false,
            },
            laws,
        )
    }

    /// The same with half as many samples, or twice as many where half are too few: what the sampling
    /// of [`Self::new`] is checked against.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn otherwise<'l>(set: &HarmonicSet, samples: usize, laws: impl Iterator<Item = &'l dyn Law>) -> Result<Self> {
        Self::with(
            set,
            Sampling {
                asked: samples,
                other: true,
            },
            laws,
        )
    }

    fn with<'l>(set: &HarmonicSet, sampling: Sampling, laws: impl Iterator<Item = &'l dyn Law>) -> Result<Self> {
        let highest = set.highest_reduced();
        let mut pointwise: Vec<MemorylessEvaluator> = Vec::new();
        let mut most_pieces = 0;
        let mut coupled = None;
        let mut marched: Vec<HystereticEvaluator> = Vec::new();
        for law in laws {
            match law.form() {
                Form::PiecewiseLinear(law) => most_pieces = law.most_pieces(highest).max(most_pieces),
                Form::Coupled(_) if coupled.is_none() => coupled = Some(Box::new(Coupled::new(set)?)),
                Form::Coupled(_) | Form::Spectral(_) => {}
                Form::Hysteretic(law) => {
                    let wanted = sampling.of(law.samples(highest, sampling.asked), highest);
                    if !marched.iter().any(|way| way.suits(law, wanted)) {
                        let way = HystereticEvaluator::new(set, law, wanted)?;
                        try_push(&mut marched, way, "the contact laws")?;
                    }
                }
                Form::Memoryless(law) => {
                    let wanted = sampling.of(law.samples(highest, sampling.asked), highest);
                    if !pointwise.iter().any(|way| way.suits(law, wanted)) {
                        let way = MemorylessEvaluator::new(set, law, wanted)?;
                        try_push(&mut pointwise, way, "the contact laws")?;
                    }
                }
            }
        }
        Ok(Self {
            scalar: if sampling.asked == 0 {
                Scalar::Exact(Box::new(piecewise_exact::Exact::new(set, most_pieces)?))
            } else {
                let samples = sampling.of(sampling.asked, highest);
                Scalar::Sampled(Box::new(piecewise_sampled::Sampled::new(set, samples)?))
            },
            smooth: Assembly::new(set)?,
            coupled,
            marched,
            pointwise,
            sampling,
        })
    }

    /// Takes the packed motion of one relative coordinate in: its turning points or samples serve every
    /// law on the coordinate alone.
    pub fn prepare(&mut self, set: &HarmonicSet, motion: &[f64]) {
        match &mut self.scalar {
            Scalar::Exact(way) => way.prepare(set, motion),
            Scalar::Sampled(way) => way.prepare(set, motion),
        }
    }

    /// Force and Jacobian of `law` at packed motions, one direction after the other, and an angular
    /// frequency. A law of one direction needs its motion prepared.
    ///
    /// # Errors
    /// Those of callbacks.
    pub fn evaluate(
        &mut self,
        law: &dyn Law,
        set: &HarmonicSet,
        motion: &[f64],
        omega: f64,
        out: &mut Evaluation,
    ) -> Result<()> {
        match (law.form(), &mut self.scalar) {
            (Form::Spectral(law), _) => self.smooth.spectral(law, set, motion, out),
            (Form::PiecewiseLinear(law), Scalar::Exact(way)) => way.evaluate(law, set, motion, out),
            (Form::PiecewiseLinear(law), Scalar::Sampled(way)) => way.evaluate(law, set, motion, out),
            (Form::Coupled(law), _) => {
                let Some(way) = &mut self.coupled else {
                    return fail!(Internal, "no memory for the pieces of a contact law");
                };
                way.evaluate(law, set, motion, out);
            }
            (Form::Hysteretic(law), _) => {
                let highest = set.highest_reduced();
                let wanted = self.sampling.of(law.samples(highest, self.sampling.asked), highest);
                let Some(way) = self.marched.iter_mut().find(|way| way.suits(law, wanted)) else {
                    return fail!(Internal, "no memory for the march of a contact law");
                };
                return way.evaluate(law, omega, motion, out);
            }
            (Form::Memoryless(law), _) => {
                let highest = set.highest_reduced();
                let wanted = self.sampling.of(law.samples(highest, self.sampling.asked), highest);
                let Some(way) = self.pointwise.iter_mut().find(|way| way.suits(law, wanted)) else {
                    return fail!(Internal, "no memory for the samples of a contact law");
                };
                return way.evaluate(law, set, omega, motion, out);
            }
        }
        Ok(())
    }

    /// Whether the force of `law` is wrong by its sampling.
    #[must_use]
    pub fn samples(&self, law: &dyn Law) -> bool {
        match law.form() {
            Form::PiecewiseLinear(_) => self.sampling.asked > 0,
            Form::Spectral(_) | Form::Coupled(_) => false,
            Form::Hysteretic(_) => true,
            Form::Memoryless(law) => !law.is_alias_free(),
        }
    }

    /// Half the range (max − min)/2 of the motion that was prepared.
    #[must_use]
    pub fn half_range(&self, set: &HarmonicSet) -> f64 {
        match &self.scalar {
            Scalar::Exact(way) => way.half_range(set),
            Scalar::Sampled(way) => way.half_range(),
        }
    }
}

/// Whether a share of the period is all of it, but for rounding.
fn is_whole(share: f64) -> bool {
    share > 1.0 - 1e-12
}
