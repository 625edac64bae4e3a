//! The evaluator of laws: selects the evaluation by the form of the law.

use crate::aft::evaluation::Evaluation;
use crate::aft::hysteretic::HystereticEvaluator;
use crate::aft::jacobian_assembly::Assembly;
use crate::aft::memoryless::MemorylessEvaluator;
use crate::aft::piecewise_exact::Exact;
use crate::aft::piecewise_sampled::Sampled;
use crate::aft::plane_friction::PlaneFrictionEvaluator;
use crate::aft::varying_normal_load::VaryingNormalLoadEvaluator;
use crate::contact::forms::law::{Form, Law, PackedMotion};
use crate::error::{Result, boxed, fail, try_push};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;

/// Adds a part made by `make`. It is a function of its own so that the parts use a small stack one after the other.
#[inline(never)]
fn added<T>(parts: &mut Vec<T>, make: impl FnOnce() -> Result<T>) -> Result<()> {
    try_push(parts, make()?, "the contact laws")
}

/// Evaluators of laws, with their tables.
pub struct Evaluator {
    /// Laws on one relative motion.
    scalar: Scalar,
    smooth: Assembly,
    /// Evaluator of friction under a varying normal load, if some law needs it.
    varying_load: Option<Box<VaryingNormalLoadEvaluator>>,
    /// Evaluators of friction in a plane, under constant and under varying loads.
    plane: Vec<PlaneFrictionEvaluator>,
    /// Evaluators of laws with states: one for each number of directions, states and samples.
    hysteretic: Vec<HystereticEvaluator>,
    /// Evaluators of laws without memory: one for each number of directions and samples.
    memoryless: Vec<MemorylessEvaluator>,
    sampling: Sampling,
}

/// Number of samples per period for laws without exact events.
#[derive(Clone, Copy)]
struct Sampling {
    /// Number of samples that the caller requests; 0 selects the law's own number.
    requested: usize,
    /// Factor by which the law's own number is multiplied.
    refinement: usize,
    /// Whether to use half as many samples instead, or twice as many where half are too few.
    other: bool,
}

impl Sampling {
    /// The sampling that a law has by itself or by request.
    fn of_law(requested: usize, refinement: usize) -> Self {
        Self {
            requested,
            refinement,
            other: false,
        }
    }

    fn of(self, samples: usize, highest: usize) -> usize {
        let factor = if self.requested == 0 { self.refinement } else { 1 };
        let samples = samples.saturating_mul(factor);
        match samples / 2 {
            _ if !self.other => samples,
            half if half > 2 * highest => half,
            _ => samples.saturating_mul(2),
        }
    }
}

/// Evaluation of laws with one relative motion.
enum Scalar {
    /// Events are located, integrals are in closed form.
    Exact(Box<Exact>),
    /// The law is evaluated at equidistant times.
    Sampled(Box<Sampled>),
}

impl Evaluator {
    /// Tables for motions of `set` under `laws`; `samples` = 0 locates events exactly where the law has them.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new<'l>(set: &HarmonicSet, samples: usize, laws: impl Iterator<Item = &'l dyn Law>) -> Result<Self> {
        Self::refined(set, (samples, 1), laws)
    }

    /// An evaluator for forces alone, as [`Self::refined`] otherwise; its results go to an
    /// [`Evaluation::force_alone`].
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn force_alone<'l>(
        set: &HarmonicSet,
        samples: (usize, usize),
        laws: impl Iterator<Item = &'l dyn Law>,
    ) -> Result<Self> {
        Self::with(set, (Sampling::of_law(samples.0, samples.1), true), laws)
    }

    /// An evaluator as `new` makes it, with `refinement` times as many samples for laws without exact events where
    /// `samples` = 0.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn refined<'l>(
        set: &HarmonicSet,
        samples: (usize, usize),
        laws: impl Iterator<Item = &'l dyn Law>,
    ) -> Result<Self> {
        Self::with(set, (Sampling::of_law(samples.0, samples.1), false), laws)
    }

    /// An evaluator with half as many samples, or twice as many where half are too few: the reference for the
    /// sampling error of [`Self::refined`].
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn otherwise<'l>(
        set: &HarmonicSet,
        samples: (usize, usize),
        laws: impl Iterator<Item = &'l dyn Law>,
    ) -> Result<Self> {
        let sampling = Sampling {
            other: true,
            ..Sampling::of_law(samples.0, samples.1)
        };
        Self::with(set, (sampling, false), laws)
    }

    fn with<'l>(
        set: &HarmonicSet,
        (sampling, force_alone): (Sampling, bool),
        laws: impl Iterator<Item = &'l dyn Law>,
    ) -> Result<Self> {
        let highest = set.highest_reduced();
        let mut memoryless: Vec<MemorylessEvaluator> = Vec::new();
        let mut most_pieces = 0;
        let mut varying_load = None;
        let mut plane = Vec::new();
        let mut hysteretic: Vec<HystereticEvaluator> = Vec::new();
        for law in laws {
            match law.form() {
                Form::PiecewiseLinear(law) => most_pieces = law.most_pieces(highest).max(most_pieces),
                Form::VaryingNormalLoad(_) if varying_load.is_none() => {
                    varying_load = Some(boxed(|| VaryingNormalLoadEvaluator::new(set))?);
                }
                Form::VaryingNormalLoad(_) | Form::Spectral(_) => {}
                Form::PlaneFriction(law) => {
                    if !plane.iter().any(|e: &PlaneFrictionEvaluator| e.suits(law)) {
                        added(&mut plane, || {
                            if force_alone {
                                PlaneFrictionEvaluator::force_alone(set, law)
                            } else {
                                PlaneFrictionEvaluator::new(set, law)
                            }
                        })?;
                    }
                }
                Form::Hysteretic(law) => {
                    let requested = sampling.of(law.samples(highest, sampling.requested), highest);
                    if !hysteretic.iter().any(|e| e.suits(law, requested)) {
                        added(&mut hysteretic, || {
                            if force_alone {
                                HystereticEvaluator::force_alone(set, law, requested)
                            } else {
                                HystereticEvaluator::new(set, law, requested)
                            }
                        })?;
                    }
                }
                Form::Memoryless(law) => {
                    let requested = sampling.of(law.samples(highest, sampling.requested), highest);
                    if !memoryless.iter().any(|e| e.suits(law, requested)) {
                        added(&mut memoryless, || {
                            if force_alone {
                                MemorylessEvaluator::force_alone(set, law, requested)
                            } else {
                                MemorylessEvaluator::new(set, law, requested)
                            }
                        })?;
                    }
                }
            }
        }
        Ok(Self {
            scalar: if sampling.requested == 0 {
                Scalar::Exact(boxed(|| Exact::new(set, most_pieces))?)
            } else {
                let samples = sampling.of(sampling.requested, highest);
                Scalar::Sampled(boxed(|| Sampled::new(set, samples))?)
            },
            smooth: Assembly::new(set)?,
            varying_load,
            plane,
            hysteretic,
            memoryless,
            sampling,
        })
    }

    /// Finds the turning points, or the samples, of the packed motion of one relative coordinate, for every law on
    /// this coordinate alone.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    pub fn prepare(&mut self, set: &HarmonicSet, motion: &[f64], interrupt: &Interrupt<'_>) -> Result<()> {
        match &mut self.scalar {
            Scalar::Exact(evaluator) => evaluator.prepare(set, motion, interrupt),
            Scalar::Sampled(evaluator) => evaluator.prepare(set, motion, interrupt),
        }
    }

    /// Force and Jacobian of `law` at packed motions, one direction after the other, and an angular frequency. A law
    /// of one direction needs its motion prepared.
    ///
    /// # Errors
    /// Those of callbacks; `StoppedByCaller`.
    pub fn evaluate(
        &mut self,
        law: &dyn Law,
        set: &HarmonicSet,
        motion: &[f64],
        omega: f64,
        out: &mut Evaluation,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        match (law.form(), &mut self.scalar) {
            (Form::Spectral(law), _) => {
                let columns = if out.is_force_alone() { 1 } else { set.packed_len() };
                interrupt.check_before((set.packed_len() * columns) as u64)?;
                self.smooth.spectral(law, set, motion, out, interrupt)?;
            }
            (Form::PiecewiseLinear(law), Scalar::Exact(evaluator)) => {
                evaluator.evaluate(law, PackedMotion { set, motion, omega }, out, interrupt)?;
            }
            (Form::PiecewiseLinear(law), Scalar::Sampled(evaluator)) => {
                evaluator.evaluate(law, set, motion, out, interrupt)?;
            }
            (Form::VaryingNormalLoad(law), _) => {
                let Some(evaluator) = &mut self.varying_load else {
                    return fail!(Internal, "no memory for the pieces of a contact law");
                };
                evaluator.evaluate(law, set, motion, out, interrupt)?;
            }
            (Form::PlaneFriction(law), _) => {
                let Some(evaluator) = self.plane.iter_mut().find(|e| e.suits(law)) else {
                    return fail!(Internal, "no memory for the path of a contact law");
                };
                return evaluator.evaluate(law, set, motion, out, interrupt);
            }
            (Form::Hysteretic(law), _) => {
                let highest = set.highest_reduced();
                let requested = self.sampling.of(law.samples(highest, self.sampling.requested), highest);
                let Some(evaluator) = self.hysteretic.iter_mut().find(|e| e.suits(law, requested)) else {
                    return fail!(Internal, "no memory for the march of a contact law");
                };
                return evaluator.evaluate(law, omega, motion, out, interrupt);
            }
            (Form::Memoryless(law), _) => {
                let highest = set.highest_reduced();
                let requested = self.sampling.of(law.samples(highest, self.sampling.requested), highest);
                let Some(evaluator) = self.memoryless.iter_mut().find(|e| e.suits(law, requested)) else {
                    return fail!(Internal, "no memory for the samples of a contact law");
                };
                return evaluator.evaluate(law, set, (omega, motion), out, interrupt);
            }
        }
        Ok(())
    }

    /// Whether sampling leaves an error in the force of `law`.
    pub fn samples(&self, law: &dyn Law) -> bool {
        match law.form() {
            Form::PiecewiseLinear(_) => self.sampling.requested > 0,
            Form::Spectral(_) | Form::VaryingNormalLoad(_) | Form::PlaneFriction(_) => false,
            Form::Hysteretic(_) => true,
            Form::Memoryless(law) => !law.is_alias_free(),
        }
    }

    /// Samples per period at which `law` is evaluated on harmonics up to the reduced number `highest`, where the
    /// caller requests `requested` samples or, if 0, `refinement` times the law's own number; 0 where the law is
    /// exact.
    pub fn samples_of(law: &dyn Law, highest: usize, samples: (usize, usize)) -> usize {
        let sampling = Sampling::of_law(samples.0, samples.1);
        let requested = sampling.requested;
        match law.form() {
            Form::PiecewiseLinear(_) => requested,
            Form::Spectral(_) | Form::VaryingNormalLoad(_) | Form::PlaneFriction(_) => 0,
            Form::Hysteretic(law) => sampling.of(law.samples(highest, requested), highest),
            Form::Memoryless(law) => sampling.of(law.samples(highest, requested), highest),
        }
    }

    /// Half the range (max − min)/2 of the prepared motion.
    #[must_use]
    pub fn half_range(&self, set: &HarmonicSet) -> f64 {
        match &self.scalar {
            Scalar::Exact(evaluator) => evaluator.half_range(set),
            Scalar::Sampled(evaluator) => evaluator.half_range(),
        }
    }
}
