//! The error of a point of a nonlinear mode, including those of its frequency and damping ratio.

use crate::condense::wave_cache::SharedWaves;
use crate::condense::{Condensed, ModelCache, Resolution};
use crate::error::{Result, boxed, try_vec};
use crate::error_estimate::cutoff_harmonic::{self, CutoffHarmonic};
use crate::error_estimate::estimate::{
    CONTEXT, ROUNDING, SHARE, extended_options, has_converged_tail, omits_nothing, or_unknown, relative, tail,
};
use crate::error_estimate::extended_newton::{FirstStep, extend};
use crate::error_estimate::extended_system::ExtendedSystem;
use crate::error_estimate::factored_harmonics::{factored, whole};
use crate::error_estimate::work::{OF_A_START, Sizes, Work};
use crate::error_estimate::{Corrected, Estimate, Solved};
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::linear_system::Jacobian;
use crate::linalg::norm;
use crate::model::Model;
use crate::options::{DampingForm, SolverOptions};
use crate::problem::epmc::{Epmc, Gauge, LinearMode};
use num_complex::Complex64;
use std::sync::Arc;

/// Evaluations, each with a product, for which the work must suffice.
const EVALUATIONS: f64 = 6.0;

/// Relative error of the damping ratio below which its last change need not be small against its whole change: along
/// a backbone the latter passes through zero.
const NEGLIGIBLE: f64 = 1e-3;

/// Damping ratio below which a mode has none but round-off, so that errors are not relative to it.
pub const NO_DAMPING: f64 = 1e-8;

/// Estimates the errors of points of one nonlinear mode, one after the other.
pub struct ModeEstimator<'a> {
    model: &'a Model,
    options: SolverOptions,
    form: DampingForm,
    linear: &'a LinearMode,
    gauge: &'a Gauge,
    response: usize,
    interrupt: &'a Interrupt<'a>,
    models: &'a ModelCache,
    waves: &'a SharedWaves,
    cutoff: Option<CutoffHarmonic>,
    /// The problem extended last, with its slot in the cache.
    extended: Option<(usize, Box<ExtendedSystem<Epmc<'a>>>)>,
}

impl<'a> ModeEstimator<'a> {
    /// For points of the mode that starts from `linear`, on the wave of the model's engine order, observing
    /// degree of freedom `response`.
    #[must_use]
    pub fn new(
        (model, options): (&'a Model, &SolverOptions),
        form: DampingForm,
        (linear, gauge): (&'a LinearMode, &'a Gauge),
        response: usize,
        (models, waves): (&'a ModelCache, &'a SharedWaves),
        interrupt: &'a Interrupt<'a>,
    ) -> Self {
        Self {
            model,
            options: *options,
            form,
            linear,
            gauge,
            response,
            interrupt,
            models,
            waves,
            cutoff: None,
            extended: None,
        }
    }

    /// The estimate at a solved point of this log₁₀ amplitude and damping ratio; not certified if it could not be
    /// made.
    ///
    /// # Errors
    /// Those of callbacks that give up; `StoppedByCaller`.
    pub fn at(&mut self, solved: &Solved<'_>, log10_amplitude: f64, damping: f64) -> Result<Estimate> {
        self.interrupt.phase(Phase::Estimate, 0.0)?;
        if solved.is_linear(self.interrupt)? {
            return solved.exact(damping);
        }
        let found = self.extend(solved, log10_amplitude, damping);
        or_unknown(found, solved, damping)
    }

    /// The model with harmonics up to one at least, and its slot; `None` where there is none.
    fn model_with(&self, highest: usize) -> Result<Option<(usize, &'a Resolution)>> {
        let slot = self.models.slot_with(highest);
        if slot == self.models.slots() {
            return Ok(None);
        }
        let resolution = self.models.model(slot, |highest| {
            let options = extended_options(&self.options, highest);
            let form = (self.form, self.linear.rest.is_loaded());
            let (condensed, _) = Condensed::for_mode(self.model, &options, form, &self.linear.shape, self.interrupt)?;
            let condensed = self.waves.attach(self.model, condensed, self.interrupt)?;
            let carried = condensed.set().numbers().last().copied().unwrap_or(0);
            Ok(Resolution {
                samples: extended_options(&self.options, carried).samples,
                condensed: Arc::new(condensed),
            })
        })?;
        Ok(Some((slot, resolution)))
    }

    fn extend(&mut self, solved: &Solved<'_>, log10_amplitude: f64, damping: f64) -> Result<Option<Estimate>> {
        let set = solved.condensed.set();
        let own = set.numbers().last().copied().unwrap_or(0);
        let sizes = Sizes::new(solved.condensed, self.options.samples);
        let work = Work::of_point(&sizes, solved.iterations.max(OF_A_START), self.options.memory_limit);
        let most = work.highest((solved.condensed, usize::MAX), &self.options, EVALUATIONS, |sizes| {
            sizes.evaluation() + sizes.product(0.0, sizes.packed())
        });
        let least = cutoff_harmonic::carried_from(set, 2 * own + 1);
        if least > most {
            return solved.unknown(damping, true).map(Some);
        }
        if self.cutoff.is_none() {
            let waves = least.max(cutoff_harmonic::all_waves(solved.condensed));
            let Some((_, resolution)) = self.model_with(waves)? else {
                return solved.unknown(damping, true).map(Some);
            };
            self.cutoff = Some(CutoffHarmonic::new(Arc::clone(&resolution.condensed), self.interrupt)?);
        }
        let Some(cutoff) = &mut self.cutoff else {
            return Ok(None);
        };
        let highest = cutoff.at(solved.omega, least, most, self.interrupt)?;
        let Some((slot, resolution)) = self.model_with(highest)? else {
            return solved.unknown(damping, true).map(Some);
        };
        let parameters = (log10_amplitude, damping);
        let mut found = self.on((slot, resolution), solved, parameters, (highest >= most, work), false)?;
        if found.is_none() && self.extended.as_ref().is_some_and(|(_, system)| system.stalled) {
            found = self.on((slot, resolution), solved, parameters, (highest >= most, work), true)?;
        }
        Ok(found)
    }

    /// The extended problem of a slot at an amplitude, with the work that it may take.
    fn system(
        &mut self,
        (slot, resolution): (usize, &'a Resolution),
        p: f64,
        work: Work,
        is_whole: bool,
    ) -> Result<Option<Box<ExtendedSystem<Epmc<'a>>>>> {
        let condensed = &*resolution.condensed;
        let sizes = Sizes::new(condensed, resolution.samples);
        let factored = if is_whole {
            match whole(&sizes, &work) {
                Some(all) => all,
                None => return Ok(None),
            }
        } else {
            factored(&sizes, condensed.set().numbers().len(), &work)
        };
        if let Some((known, mut system)) = self.extended.take().filter(|(known, _)| *known == slot) {
            debug_assert_eq!(known, slot);
            system.set_point(p, factored, work)?;
            return Ok(Some(system));
        }
        let (linear, gauge, interrupt) = (self.linear, self.gauge, self.interrupt);
        let problem = boxed(|| Epmc::new(condensed, gauge, linear, resolution.samples, interrupt))?;
        boxed(|| ExtendedSystem::iterative(*problem, p, factored, (sizes, work))).map(Some)
    }

    fn on(
        &mut self,
        (slot, resolution): (usize, &'a Resolution),
        solved: &Solved<'_>,
        (p, damping): (f64, f64),
        (short, work): (bool, Work),
        is_whole: bool,
    ) -> Result<Option<Estimate>> {
        let Some(mut system) = self.system((slot, resolution), p, work, is_whole)? else {
            return Ok(None);
        };
        let found = self.extended_with(&mut system, &resolution.condensed, solved, (p, damping), short);
        self.extended = Some((slot, system));
        found
    }

    fn extended_with(
        &self,
        system: &mut ExtendedSystem<Epmc<'a>>,
        condensed: &Condensed,
        solved: &Solved<'_>,
        (p, damping): (f64, f64),
        short: bool,
    ) -> Result<Option<Estimate>> {
        let set = condensed.set();
        let highest = set.numbers().last().copied().unwrap_or(0);
        let n = system.problem.size();
        let a = 10f64.powf(p);
        let mut start = solved.extended(condensed, n, 1.0 / a)?;
        Epmc::set_frequency_and_damping(self.linear, (solved.omega, damping), &mut start);
        if !system.evaluate(&start)? {
            return Ok(None);
        }
        let residual = (&system.at.values[..n - 2], system.at.scale);
        if omits_nothing(residual, set, solved.condensed.set(), self.options.tol_residual) {
            return solved.exact(damping).map(Some);
        }
        system.measure_by_point(false);
        let of_damping = |u: &[f64]| Epmc::damping_of_change(u).abs();
        let enough = |_: &Epmc<'_>, _: &[f64], change: &[f64], next: &[f64]| {
            let (moved, last) = (norm(&change[..n - 2]), norm(&next[..n - 2]));
            let (changed, left) = (of_damping(change), of_damping(&next[..n]));
            (last <= SHARE * moved || last <= ROUNDING * norm(&start))
                && (left <= SHARE * changed || left <= SHARE * NEGLIGIBLE * damping.abs().max(NO_DAMPING))
        };
        let Some(extended) = extend(system, (&start, &start), enough, FirstStep::Checked, self.interrupt)? else {
            return Ok(None);
        };
        let z = extended.corrected()?;
        let (omega2, damping2) = Epmc::frequency_and_damping(self.linear, &z);
        let (omega1, damping1) = Epmc::frequency_and_damping(self.linear, &extended.at);
        let unit = a * condensed.length();
        let (i, dofs) = (set.fundamental(), condensed.ndof());
        let row = condensed.motion_row(i, self.response)?;
        let response = |shape: &[Complex64]| row.along(&shape[i * dofs..(i + 1) * dofs]) * unit;
        let before = response(system.problem.shape());
        if !system.evaluate(&z)? {
            return Ok(None);
        }
        let response = response(system.problem.shape());
        let motion = &z[..n - 2];
        let size = norm(motion);
        let mut change = try_vec(n - 2, 0.0, CONTEXT)?;
        for ((c, z), s) in change.iter_mut().zip(motion).zip(&start) {
            *c = z - s;
        }
        let change = norm(&change) / size;
        let tail = tail(set, solved.condensed.set(), motion)?;
        let certified = extended.certified && (!short || has_converged_tail(&tail, change));
        let known = |x: f64| if certified { x } else { f64::NAN };
        let next = (response - before).norm();
        let mut packed = try_vec(n - 2, 0.0, CONTEXT)?;
        for (to, y) in packed.iter_mut().zip(motion) {
            *to = y * unit;
        }
        Ok(Some(Estimate {
            certified,
            too_large: !certified && short,
            motion: known(change + norm(&extended.next[..n - 2]) / size),
            response: known(relative((response - solved.response).norm() + next, response)),
            frequency: known(((omega2 - solved.omega).abs() + (omega2 - omega1).abs()) / omega2),
            damping: known((damping2 - damping).abs() + (damping2 - damping1).abs()),
            harmonics: highest,
            steps: extended.steps,
            change,
            tail,
            corrected: Corrected {
                set: set.try_clone()?,
                motion: packed,
                response,
                omega: omega2,
                damping: damping2,
            },
        }))
    }
}
