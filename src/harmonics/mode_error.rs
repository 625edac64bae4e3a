//! The error of a point of a nonlinear mode, including those of its frequency and damping ratio.

use crate::condense::by_factors::dynamic_stiffness::DampedFrequency;
use crate::condense::by_modes::wave_cache::SharedWaves;
use crate::condense::{Condensed, ModelCache, Resolution};
use crate::error::{Result, boxed, try_copy, try_push, try_vec};
use crate::harmonics::carried_harmonics;
use crate::harmonics::cutoff_harmonic::{self, CutoffHarmonic};
use crate::harmonics::estimate::{
    CONTEXT, ESTIMATE_ROUNDING, ESTIMATE_SHARE, extended_options, has_converged_tail, omits_nothing, or_unknown,
    relative, tail,
};
use crate::harmonics::extended_newton::{FirstStep, extend};
use crate::harmonics::extended_system::ExtendedSystem;
use crate::harmonics::factored_harmonics::{factored, whole};
use crate::harmonics::mode_doubling::{ModeRatios, ModeSeries};
use crate::harmonics::resonant_harmonics::Sought;
use crate::harmonics::work::EVALUATIONS_OF_ESTIMATE;
use crate::harmonics::work::{OF_A_START, Sizes, Work};
use crate::harmonics::{Corrected, Estimate, Solved};
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::newton::linear_system::Jacobian;
use crate::linalg::norm;
use crate::model::Model;
use crate::options::{DampingForm, SolverOptions};
use crate::problem::epmc::{Epmc, Gauge, LinearMode};
use num_complex::Complex64;
use std::sync::Arc;

/// Extended problems that are kept for the next point.
/// Kind: cap.
const MODE_ERROR_MOST_KEPT: usize = 3;

/// Change of frequency or damping ratio, relative to the tolerance, that does not matter.
/// Kind: tuned; measured on: not recorded.
const NEGLIGIBLE_CHANGE: f64 = 0.1;

/// Relative error of the damping ratio below which its last change need not be small against its whole change: along
/// a backbone the latter passes through zero.
/// Kind: tuned; measured on: not recorded.
const MODE_ERROR_NEGLIGIBLE: f64 = 1e-3;

/// Size of a harmonic over the rounding of its residual, up to which it is rounding as well.
/// Kind: rounding.
const HIDDEN: f64 = 10.0;

/// Damping ratio below which a mode has none but round-off, so that errors are not relative to it.
/// Kind: rounding.
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
    /// Extended problems of the last estimates, with their slots in the cache.
    extended: Vec<(usize, Box<ExtendedSystem<Epmc<'a>>>)>,
    ratios: ModeRatios,
}

/// State of a point of a mode beside its motions.
#[derive(Clone, Copy)]
pub struct ModeState {
    /// log₁₀ of the amplitude.
    pub log10_amplitude: f64,
    /// Damping ratio of the mode.
    pub damping: f64,
    /// Size to which the error of the damping ratio is relative.
    pub damping_unit: f64,
}

/// One extension of a point, and its purpose.
#[derive(Clone, Copy)]
struct Stage {
    /// Highest harmonic of the extended problem.
    highest: usize,
    /// Whether the structure may be compliant beyond the highest harmonic, where the problem would be too large.
    short: bool,
    /// Whether this is one of several extensions, each of which ends once frequency and damping ratio have converged.
    by_doubling: bool,
}

impl<'a> ModeEstimator<'a> {
    /// An estimator for points of the mode that starts from `linear`, on the wave of the model's engine order, with
    /// the response degree of freedom `response`.
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
            extended: Vec::new(),
            ratios: ModeRatios::default(),
        }
    }

    /// The estimate at a solved point; not certified if it could not be made.
    ///
    /// # Errors
    /// Those of callbacks that give up; `StoppedByCaller`.
    pub fn at(&mut self, solved: &Solved<'_>, state: ModeState) -> Result<Estimate> {
        self.interrupt.phase(Phase::Estimate, 0.0)?;
        if solved.is_linear(self.interrupt)? {
            return solved.exact(state.damping);
        }
        let found = self.extend(solved, state);
        or_unknown(found, solved, state.damping)
    }

    /// A resolution with at least the harmonics up to `highest`, and its slot; `None` where there is none.
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

    fn extend(&mut self, solved: &Solved<'_>, state: ModeState) -> Result<Option<Estimate>> {
        let set = solved.condensed.set();
        let sizes = Sizes::new(solved.condensed, self.options.samples);
        let work = Work::of_point(&sizes, solved.iterations.max(OF_A_START), self.options.memory_limit);
        let most = self.affordable(solved, &work);
        let own = set.numbers().last().copied().unwrap_or(0);
        let least = carried_harmonics::carried_from(set, 2 * own + 1);
        if least > most {
            return solved.unknown(state.damping, true).map(Some);
        }
        if self.cutoff.is_none() {
            let waves = least.max(cutoff_harmonic::all_waves(solved.condensed));
            let Some((_, resolution)) = self.model_with(waves)? else {
                return solved.unknown(state.damping, true).map(Some);
            };
            self.cutoff = Some(CutoffHarmonic::new(
                Arc::clone(&resolution.condensed),
                solved.condensed,
                self.interrupt,
            )?);
        }
        let Some(cutoff) = &mut self.cutoff else {
            return Ok(None);
        };
        let sought = Sought { own, from: least, most };
        let highest = cutoff.at(solved.omega, sought, self.interrupt)?;
        let short = highest >= most;
        let samples = extended_options(&self.options, highest).samples;
        if highest > least && !Sizes::extended(solved.condensed, highest, samples).is_cheap(&work) {
            return self.extend_by_doubling(solved, state, (least, highest, short), work);
        }
        let stage = Stage {
            highest,
            short,
            by_doubling: false,
        };
        Ok(self.extend_to(solved, None, state, stage, work)?.0)
    }

    /// Highest harmonic to which the allowed work can extend a point.
    fn affordable(&self, solved: &Solved<'_>, work: &Work) -> usize {
        work.highest(
            (solved.condensed, usize::MAX),
            &self.options,
            EVALUATIONS_OF_ESTIMATE,
            |sizes| sizes.evaluation() + sizes.product(0.0, sizes.packed()),
        )
    }

    /// Extends to twice the harmonics, to four times, and on, until the cut-off harmonic is reached or the next
    /// changes of frequency and damping ratio, predicted by the last two, are small shares of the whole ones. Where
    /// the structure is compliant in many harmonics, frequency and damping ratio need few of them.
    #[inline(never)]
    fn extend_by_doubling(
        &mut self,
        solved: &Solved<'_>,
        state: ModeState,
        (least, core, short): (usize, usize, bool),
        mut work: Work,
    ) -> Result<Option<Estimate>> {
        let mut highest = least;
        let mut series = ModeSeries::new(
            DampedFrequency::new(solved.omega, state.damping),
            state.damping_unit,
            self.options.tolerance,
        )?;
        let mut last: Option<Estimate> = None;
        loop {
            let stage = Stage {
                highest,
                short: false,
                by_doubling: true,
            };
            let from = last.as_ref().map(|estimate| &estimate.corrected);
            let (found, left) = self.extend_to(solved, from, state, stage, work)?;
            work = left;
            let Some(mut found) = found.filter(|found| found.certified) else {
                return Ok(last.filter(|_| series.suffices()).map(|last| series.completed(last)));
            };
            series.add(&found);
            found.steps += last.as_ref().map_or(0, |last| last.steps);
            if highest >= core && !short {
                return Ok(Some(found));
            }
            if last.is_none()
                && let Some(scaled) = series.scaled(&mut self.ratios, least, &found)
            {
                return Ok(Some(scaled));
            }
            if series.is_harmless() || (series.extensions() > 1 && series.has_settled()) {
                series.note(&mut self.ratios, least);
                return Ok(Some(series.completed(found)));
            }
            let next = carried_harmonics::carried_from(solved.condensed.set(), 2 * highest + 1);
            let next = if short { next } else { next.min(core) };
            let ends = next > self.affordable(solved, &work);
            if ends && series.suffices() {
                series.note(&mut self.ratios, least);
                return Ok(Some(series.completed(found)));
            }
            if ends {
                return solved.unknown(state.damping, false).map(Some);
            }
            if series.misses() {
                return Ok(Some(series.completed(found)));
            }
            highest = next;
            last = Some(found);
        }
    }

    /// Extends a point, from a solution with fewer harmonics or from the point itself. Returns the work that is left.
    fn extend_to(
        &mut self,
        solved: &Solved<'_>,
        from: Option<&Corrected>,
        state: ModeState,
        stage: Stage,
        mut work: Work,
    ) -> Result<(Option<Estimate>, Work)> {
        let Some((slot, resolution)) = self.model_with(stage.highest)? else {
            return Ok((Some(solved.unknown(state.damping, true)?), work));
        };
        let condensed = &*resolution.condensed;
        let mut sizes = Sizes::new(condensed, resolution.samples);
        if condensed.blocks().iter().any(|block| block.source.is_some()) {
            sizes = sizes.with_modes(condensed);
        }
        if !work.spend(sizes.flexibility()) {
            return Ok((None, work));
        }
        let compliant = condensed.set().numbers().len();
        let stalled = self.kept(slot).is_some_and(|kept| self.extended[kept].1.stalled);
        let all = if stalled { whole(&sizes, &work) } else { None };
        let chosen = all.unwrap_or_else(|| factored(&sizes, compliant, &work));
        let mut system = if let Some(kept) = self.kept(slot) {
            let (_, mut system) = self.extended.swap_remove(kept);
            system.set_point(state.log10_amplitude, chosen, work)?;
            system
        } else {
            let (linear, gauge, interrupt) = (self.linear, self.gauge, self.interrupt);
            let problem = boxed(|| Epmc::new(condensed, gauge, linear, resolution.samples, interrupt))?;
            boxed(|| ExtendedSystem::iterative(*problem, state.log10_amplitude, chosen, (sizes, work)))?
        };
        let mut found = self.extended_with(&mut system, condensed, (solved, from), state, stage);
        let mut left = system.work();
        if system.stalled
            && !stalled
            && let Some(all) = whole(&sizes, &left)
        {
            system.set_point(state.log10_amplitude, all, left)?;
            found = self.extended_with(&mut system, condensed, (solved, from), state, stage);
            left = system.work();
        }
        while self.extended.len() >= MODE_ERROR_MOST_KEPT
            || (!self.extended.is_empty()
                && !left.fits(system.bytes() + self.extended.iter().map(|k| k.1.bytes()).sum::<f64>()))
        {
            self.extended.remove(0);
        }
        try_push(&mut self.extended, (slot, system), CONTEXT)?;
        Ok((found?, left))
    }

    /// Index of the kept extended problem of a slot.
    fn kept(&self, slot: usize) -> Option<usize> {
        self.extended.iter().position(|(kept, _)| *kept == slot)
    }

    fn extended_with(
        &self,
        system: &mut ExtendedSystem<Epmc<'a>>,
        condensed: &Condensed,
        (solved, from): (&Solved<'_>, Option<&Corrected>),
        state: ModeState,
        stage: Stage,
    ) -> Result<Option<Estimate>> {
        let (p, damping, short) = (state.log10_amplitude, state.damping, stage.short);
        let set = condensed.set();
        let highest = set.numbers().last().copied().unwrap_or(0);
        let n = system.problem.size();
        let a = 10f64.powf(p);
        let mut point = solved.extended(condensed, n, 1.0 / a)?;
        Epmc::set_frequency_and_damping(self.linear, DampedFrequency::new(solved.omega, damping), &mut point);
        let mut start = try_copy(&point, CONTEXT)?;
        if let Some(from) = from {
            let unit = a * condensed.length();
            set.transfer(&from.set, &from.motion, 1.0 / unit, &mut start[..n - 2]);
            Epmc::set_frequency_and_damping(self.linear, DampedFrequency::new(from.omega, from.damping), &mut start);
        }
        if !system.evaluate(&start)? {
            return Ok(None);
        }
        // Forces count from the static ones, whose rounding hides those of a small vibration.
        let rounding = system.at.rounding;
        let residual = (&system.at.values[..n - 2], system.at.scale, rounding);
        if omits_nothing(residual, set, solved.condensed.set(), self.options.tol_residual) {
            let mut exact = solved.exact(damping)?;
            exact
                .corrected
                .drop_rounding(HIDDEN * rounding * a * condensed.length());
            return Ok(Some(exact));
        }
        system.measure_by_point(from.is_some());
        let most = ESTIMATE_SHARE * NEGLIGIBLE_CHANGE * self.options.tolerance;
        let of_damping = |u: &[f64]| Epmc::damping_of_change(u).abs();
        let enough = |_: &Epmc<'_>, _: &[f64], change: &[f64], next: &[f64]| {
            let (moved, last) = (norm(&change[..n - 2]), norm(&next[..n - 2]));
            let (changed, left) = (of_damping(change), of_damping(&next[..n]));
            if stage.by_doubling {
                let of_frequency = |u: &[f64]| Epmc::frequency_of_change(u).abs();
                let (moved, last) = (of_frequency(&change[..n]), of_frequency(&next[..n]));
                return (last <= ESTIMATE_SHARE * moved || last <= most.max(ESTIMATE_ROUNDING))
                    && (left <= ESTIMATE_SHARE * changed
                        || left
                            <= (most * state.damping_unit).max(ESTIMATE_SHARE * MODE_ERROR_NEGLIGIBLE * NO_DAMPING));
            }
            (last <= ESTIMATE_SHARE * moved || last <= rounding.max(ESTIMATE_ROUNDING * norm(&start)))
                && (left <= ESTIMATE_SHARE * changed
                    || left <= ESTIMATE_SHARE * MODE_ERROR_NEGLIGIBLE * damping.abs().max(NO_DAMPING))
        };
        let Some(extended) = extend(system, (&start, &start), enough, FirstStep::Checked, self.interrupt)? else {
            return Ok(None);
        };
        let z = extended.corrected()?;
        let [two, one] = [&z, &extended.at].map(|u| Epmc::frequency_and_damping(self.linear, u));
        let unit = a * condensed.length();
        let row = condensed.motion_row(set.fundamental(), self.response)?;
        let response = |shape: &[Complex64]| row.along(shape) * unit;
        let before = response(system.problem.fundamental());
        // One of several extensions tells frequency and damping ratio; the response may lack the last step.
        let response = if stage.by_doubling {
            before
        } else {
            if !system.evaluate(&z)? {
                return Ok(None);
            }
            response(system.problem.fundamental())
        };
        let motion = &z[..n - 2];
        let size = norm(motion);
        let mut change = try_vec(n - 2, 0.0, CONTEXT)?;
        for ((c, z), s) in change.iter_mut().zip(motion).zip(&point) {
            *c = z - s;
        }
        let change = norm(&change) / size;
        let tail = tail(set, solved.condensed.set(), (motion, &[]))?;
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
            responses: Vec::new(),
            frequency: known(((two.omega - solved.omega).abs() + (two.omega - one.omega).abs()) / two.omega),
            damping: known((two.damping - damping).abs() + (two.damping - one.damping).abs()),
            harmonics: highest,
            steps: extended.steps,
            change,
            tail,
            corrected: Corrected {
                set: set.try_clone()?,
                motion: packed,
                response,
                watched: Vec::new(),
                omega: two.omega,
                damping: two.damping,
                rates: Vec::new(),
            },
        }))
    }
}
