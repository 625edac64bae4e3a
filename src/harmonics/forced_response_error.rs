//! The error of a point of a forced response.

use crate::condense::blocks::more_harmonics;
use crate::condense::by_modes::modal_table::ModalTable;
use crate::condense::by_modes::wave_cache::SharedWaves;
use crate::condense::{Condensed, ModelCache, Resolution};
use crate::contact::Contact;
use crate::error::{Result, boxed, try_push};
use crate::fourier::Measure;
use crate::harmonics::carried_harmonics;
use crate::harmonics::cutoff_harmonic::SMALL_STRUCTURE;
use crate::harmonics::cutoff_harmonic::{self, CutoffHarmonic};
use crate::harmonics::doubling::Doubling;
use crate::harmonics::estimate::{CONTEXT, ESTIMATE_MARGIN, extended_options, or_unknown, relative};
use crate::harmonics::extended_newton::FirstStep;
use crate::harmonics::extended_system::ExtendedSystem;
use crate::harmonics::factored_harmonics::{factored, whole};
use crate::harmonics::jump_error::{OF_HALF, OF_JUMPS};
use crate::harmonics::kept_changes::KeptChanges;
use crate::harmonics::kept_ratio::KeptRatio;
use crate::harmonics::one_extension::{Extent, extend_once};
use crate::harmonics::resonant_harmonics::Sought;
use crate::harmonics::second_estimate::SecondEstimate;
use crate::harmonics::work::EVALUATIONS_OF_ESTIMATE;
use crate::harmonics::work::{OF_A_POINT, OF_A_START, Sizes, Work};
use crate::harmonics::{Corrected, Estimate, Solved};
use crate::interrupt::{Interrupt, Phase};
use crate::model::Model;
use crate::options::Range;
use crate::options::{Response, SolverOptions};
use crate::problem::harmonic_balance::HarmonicBalance;
use num_complex::Complex64;
use std::sync::Arc;

/// Flexibility tables by factorisation of a full matrix after which all modes of a structure are expected to pay: they cost about
/// 24 of them.
/// Kind: tuned; measured on: not recorded.
const FORCED_RESPONSE_ERROR_TABLES: usize = 4;

/// Multiple of the lowest harmonic to which a point is extended at least where that costs little: where a resonance is narrow, changes
/// by a few harmonics cancel each other.
/// Kind: tuned; measured on: chains of 6 to 300 masses at the onset of slip, damping ratios 1e-4 to 3e-2.
const FEW_HARMONICS: usize = 15;

/// Share of the work of an estimate that told nothing that one of the same motion with more harmonics may take.
/// Kind: tuned; measured on: not recorded.
const SHARED: f64 = 0.5;

/// Error over its estimate where the change from half the harmonics is not known.
/// Kind: tuned; measured on: random chains of `tests/robustness/near_rigid_chains.rs`.
const UNCHECKED: f64 = 2.0;

/// Extended problems that are kept for the next point.
/// Kind: tuned; measured on: not recorded.
const FORCED_RESPONSE_ERROR_MOST_KEPT: usize = 3;

/// Estimates the errors of points of one model, one after the other.
pub struct ForcedEstimator<'a> {
    model: &'a Model,
    options: SolverOptions,
    asked: Asked<'a>,
    cutoff: Option<CutoffHarmonic>,
    models: &'a ModelCache,
    interrupt: &'a Interrupt<'a>,
    /// Whether some estimate told nothing, for want of work.
    told_nothing: bool,
    /// Extended problems of the last estimates, with their slots in the cache.
    extended: Vec<(usize, Box<ExtendedSystem<HarmonicBalance<'a>>>)>,
    judged: Judged,
    shared: Shared<'a>,
    /// Whether the estimate at hand is a second one.
    second: SecondEstimate,
}

/// The response whose error is wanted, and where.
pub struct Asked<'a> {
    response: usize,
    /// Range of the frequencies of the points.
    range: Option<Range>,
    /// Whether all points have one frequency, so that no extended problem is kept.
    single: bool,
    /// The requested responses.
    responses: &'a [Response<'a>],
}

/// Ratios, changes and errors that earlier estimates told.
pub struct Judged {
    ratio: KeptRatio,
    changes: KeptChanges,
    /// Operations that the last estimate was allowed, and the limit for the next one.
    allowed: f64,
    most: f64,
}

/// Modes that estimates share with the response.
pub struct Shared<'a> {
    /// Modes of the waves; and the number of flexibility tables made so far.
    waves: &'a SharedWaves,
    tables: usize,
}

impl<'a> ForcedEstimator<'a> {
    /// An estimator for solutions of `model` with these options, which observe degree of freedom `response`.
    #[must_use]
    pub fn new(
        model: &'a Model,
        options: &SolverOptions,
        response: usize,
        (models, waves): (&'a ModelCache, &'a SharedWaves),
        interrupt: &'a Interrupt<'a>,
    ) -> Self {
        Self {
            model,
            options: *options,
            asked: Asked {
                response,
                range: None,
                single: false,
                responses: &[],
            },
            cutoff: None,
            models,
            interrupt,
            told_nothing: false,
            extended: Vec::new(),
            judged: Judged {
                ratio: KeptRatio::default(),
                changes: KeptChanges::default(),
                allowed: 0.0,
                most: f64::INFINITY,
            },
            shared: Shared { waves, tables: 0 },
            second: SecondEstimate::default(),
        }
    }

    /// Adds requested responses, whose errors then count.
    pub fn watching(mut self, responses: &'a [Response<'a>]) -> Self {
        self.asked.responses = responses;
        self
    }

    /// Sets the range of frequency of the points. For a single frequency no extended problem is kept.
    #[must_use]
    pub fn over(mut self, range: Range) -> Self {
        self.asked.single = range.is_single();
        self.asked.range = (!self.asked.single).then_some(range);
        self
    }

    /// Limits the next estimate to half of the work that was allowed to the last one, which told nothing.
    pub fn share_work(&mut self) {
        self.judged.most = SHARED * self.judged.allowed;
    }

    /// The estimate at a solved point; not certified if it could not be made.
    ///
    /// # Errors
    /// Those of callbacks that give up; `StoppedByCaller`.
    pub fn at(&mut self, solved: &Solved<'_>) -> Result<Estimate> {
        self.interrupt.phase(Phase::Estimate, 0.0)?;
        if solved.is_linear(self.interrupt)? {
            return solved.exact(0.0);
        }
        let sizes = Sizes::new(solved.condensed, self.options.samples);
        let least = match (self.asked.single, self.told_nothing) {
            (false, _) => OF_A_START,
            (true, false) => OF_A_POINT.0,
            (true, true) => OF_A_POINT.1,
        };
        let iterations = self.second.iterations(solved.iterations.max(least));
        let mut work = Work::of_point(&sizes, iterations, self.options.memory_limit);
        work.limit(core::mem::replace(&mut self.judged.most, f64::INFINITY));
        self.judged.allowed = work.left();
        let found = self.extend(solved, work);
        let found = or_unknown(found, solved, 0.0)?;
        self.told_nothing |= !found.certified;
        Ok(found)
    }

    /// A second estimate at a point whose error the first one left unknown: see [`SecondEstimate`]. `None` where none is made: a single
    /// frequency has taken its share of work.
    ///
    /// # Errors
    /// As [`Self::at`].
    pub fn again(&mut self, solved: &Solved<'_>) -> Result<Option<Estimate>> {
        if self.asked.single || !self.second.is_due() {
            return Ok(None);
        }
        self.extended.clear();
        self.judged.changes = KeptChanges::default();
        self.judged.ratio = KeptRatio::default();
        for further in SecondEstimate::ALL {
            self.second.begin(further);
            let found = self.at(solved);
            self.second.end();
            let found = found?;
            if found.certified {
                self.second.note(true);
                return Ok(Some(found));
            }
            if found.too_large {
                break;
            }
        }
        self.second.note(false);
        Ok(None)
    }

    /// The harmonics to which a point is extended; `None` where the work does not suffice.
    #[inline(never)]
    fn extent(&mut self, solved: &Solved<'_>, work: &Work) -> Result<Option<Extent>> {
        let set = solved.condensed.set();
        let own = set.numbers().last().copied().unwrap_or(0);
        // The change of a harmonic that neither the point nor its extension carries is zero over zero.
        let watched = self.asked.responses.iter().map(|response| match response.measure {
            Measure::Harmonic(h) => carried_harmonics::carried_to(set, h),
            _ => 0,
        });
        let least = self.second.least(set, carried_harmonics::least_extension(set));
        let least = watched.fold(least, usize::max);
        // How a law of the caller resists the velocity is not known: the cut-off, which counts stiffness alone, may come too early.
        let reach = if self.model.contacts().iter().any(Contact::is_of_caller) {
            carried_harmonics::carried_from(set, 2 * least + 1)
        } else {
            least
        };
        let few = carried_harmonics::carried_from(set, FEW_HARMONICS * set.base());
        let samples = extended_options(&self.options, few).samples;
        // The jumps of exchanged motions have errors of their own: see `jump_error`.
        let may_reach = few > reach && !solved.condensed.has_exchanges();
        let reach = if may_reach && Sizes::extended(solved.condensed, few, samples).is_cheap(work) {
            few
        } else {
            reach
        };
        // With the cut-off known, bounds beyond it are not sought.
        let mut sought = Sought {
            own,
            from: set.base(),
            most: usize::MAX,
        };
        let known = self
            .cutoff
            .as_ref()
            .and_then(|cutoff| cutoff.known(solved.omega, sought));
        let enough = known.map_or(usize::MAX, |known| known.saturating_add(1).max(reach));
        let most = self.affordable(solved, work, enough);
        if least > most {
            return Ok(None);
        }
        if self.cutoff.is_none() {
            let waves = least.max(cutoff_harmonic::all_waves(solved.condensed));
            let Some(resolution) = self.model_with(waves, solved)? else {
                return Ok(None);
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
        sought.most = most;
        let mut core = match known {
            Some(known) => known.clamp(sought.from, most.max(sought.from)),
            None => cutoff.at(solved.omega, sought, self.interrupt)?,
        };
        if solved.condensed.has_exchanges() {
            // No harmonic is weak, and none beyond is left out of the estimate: see `jump_error`.
            core = core.max(least).min(most);
        }
        Ok(Some(Extent {
            core,
            highest: core.max(if reach <= most { reach } else { least }),
            least,
            first_step: if core <= own {
                FirstStep::Suffices
            } else {
                FirstStep::Checked
            },
            // Where motions have a mass, the law has all harmonics of the force.
            short: core >= most && !solved.condensed.has_masses(),
            by_doubling: false,
        }))
    }

    /// Highest harmonic to which the allowed work can extend a point; `enough` if it is higher.
    fn affordable(&self, solved: &Solved<'_>, work: &Work, enough: usize) -> usize {
        work.highest(
            (solved.condensed, enough),
            &self.options,
            EVALUATIONS_OF_ESTIMATE,
            |sizes| sizes.evaluation() + sizes.product(0.0, sizes.packed()),
        )
    }

    fn extend(&mut self, solved: &Solved<'_>, work: Work) -> Result<Option<Estimate>> {
        let Some(extent) = self.extent(solved, &work)? else {
            return solved.unknown(0.0, true).map(Some);
        };
        let samples = extended_options(&self.options, extent.core).samples;
        let core = Sizes::extended(solved.condensed, extent.core, samples);
        if extent.core > extent.least && !core.is_cheap(&work) {
            return self.extend_by_doubling(solved, extent, work);
        }
        let (found, left) = self.extend_to(solved, None, extent, work)?;
        match found {
            Some(found) if solved.condensed.has_exchanges() => self.with_half(solved, found, left),
            found => Ok(found),
        }
    }

    /// Estimate for a point with exchanged motions: `found`, or the change from half the harmonics where this tells a
    /// larger error.
    #[inline(never)]
    fn with_half(&mut self, solved: &Solved<'_>, mut found: Estimate, work: Work) -> Result<Option<Estimate>> {
        let tolerance = self.options.tolerance;
        let own = solved.condensed.set().numbers().last().copied().unwrap_or(0);
        let misses = tolerance > 0.0 && ESTIMATE_MARGIN * found.response > tolerance;
        let excited = solved.condensed.blocks().iter().filter(|block| block.has_force());
        let excited = excited.map(|block| block.number).max().unwrap_or(1);
        let slot = self.models.slot_with((own / 2).max(excited));
        if misses || !found.certified || slot >= self.models.slots() || self.models.highest(slot) >= own {
            return Ok(Some(found));
        }
        let half = self.models.highest(slot);
        let extent = Extent {
            core: half,
            highest: half,
            least: half,
            first_step: FirstStep::Checked,
            short: false,
            by_doubling: true,
        };
        let Some(of_half) = self
            .extend_to(solved, None, extent, work)?
            .0
            .filter(|half| half.certified)
        else {
            if !solved.condensed.has_masses() {
                return Ok(None);
            }
            // With half the harmonics a motion may be too far for the steps of an estimate.
            found.scale_response(UNCHECKED * found.response);
            return Ok(Some(found));
        };
        let change = |estimate: &Estimate| (estimate.corrected.response - solved.response).norm();
        let more = OF_HALF * change(&of_half) - OF_JUMPS * change(&found);
        let more = relative(more.max(0.0), found.corrected.response);
        found.response += more;
        for error in &mut found.responses {
            *error += more;
        }
        Ok(Some(found))
    }

    /// Extends to twice the harmonics, to four times, and on: up to the core, or until the next change of the response,
    /// as the last two predict it, is a small share of the whole. Where the structure is compliant in many harmonics
    /// the full core costs far more than the point, and the response needs few of them.
    ///
    /// The ratio of the whole change to that of the first extension changes little along a branch: it serves some of the
    /// following estimates with the same harmonics, which then take one extension each.
    #[inline(never)]
    fn extend_by_doubling(&mut self, solved: &Solved<'_>, extent: Extent, mut work: Work) -> Result<Option<Estimate>> {
        let mut highest = extent.least;
        let mut series = Doubling::new(observed(&solved.response, solved.watched), solved.together)?;
        let mut last: Option<Estimate> = None;
        loop {
            let stage = Extent {
                core: extent.core.min(highest),
                highest,
                // The first two extensions tell the error, a further one whether much of it is missing.
                first_step: if series.extensions() < 2 {
                    FirstStep::Checked
                } else {
                    FirstStep::SufficesRoughly
                },
                short: false,
                by_doubling: true,
                ..extent
            };
            let from = last.as_ref().map(|estimate| &estimate.corrected);
            let (found, left) = self.extend_to(solved, from, stage, work)?;
            work = left;
            let Some(mut found) = found.filter(|found| found.certified) else {
                return Ok(last.filter(|_| series.suffices()).map(|last| series.completed(last)));
            };
            series.add(observed(&found.corrected.response, &found.corrected.watched));
            found.steps += last.as_ref().map_or(0, |last| last.steps);
            if highest >= extent.core && !extent.short {
                return Ok(Some(found));
            }
            if let Some((ratio, sure)) = self.judged.ratio.at(extent.least).filter(|_| last.is_none()) {
                let scaled = series.scaled(ratio);
                if scaled <= sure * self.options.tolerance {
                    found.scale_response(scaled);
                    return Ok(Some(found));
                }
            }
            if series.is_harmless(self.options.tolerance) {
                if let Some(ratio) = series.bounded_ratio() {
                    self.judged.ratio.note(extent.least, ratio);
                }
                return Ok(Some(series.bounded(found)));
            }
            let next = carried_harmonics::carried_from(solved.condensed.set(), 2 * highest + 1);
            let next = if extent.short { next } else { next.min(extent.highest) };
            let ends = next > self.affordable(solved, &work, next);
            if series.has_settled() || (ends && series.suffices()) {
                self.judged.ratio.note(extent.least, series.ratio());
                return Ok(Some(series.completed(found)));
            }
            if ends {
                return solved.unknown(0.0, false).map(Some);
            }
            if series.misses(self.options.tolerance) {
                return Ok(Some(series.completed(found)));
            }
            highest = next;
            last = Some(found);
        }
    }

    /// Whether sums over modes pay: modes are known, or many tables were made.
    fn modes_pay(&mut self, condensed: &Condensed) -> bool {
        self.shared.tables += condensed.set().numbers().len();
        // Factors of a sparse matrix cost less, modes do not.
        let n = condensed.ndof();
        let stored = condensed
            .blocks()
            .first()
            .map_or(1, |block| block.matrices.reference.values.len());
        let pay = self.shared.tables > FORCED_RESPONSE_ERROR_TABLES * (n * n / stored.max(1));
        match self.shared.waves.some_have_modes() {
            // Few small factorisations cost no more.
            Some(known) => known && (pay || condensed.ndof() > SMALL_STRUCTURE),
            None => pay,
        }
    }

    /// The table of each harmonic from modes, where it has them.
    fn modal_tables(&mut self, condensed: &Condensed) -> Result<Vec<Option<ModalTable>>> {
        let mut tables: Vec<Option<ModalTable>> = Vec::new();
        for i in 0..condensed.blocks().len() {
            let modes = self.shared.waves.of(self.model, condensed, i, self.interrupt)?;
            let rows = modes.map(|modes| self.shared.waves.rows((condensed, i, self.asked.response), modes));
            let table = rows.ok().map(|rows| ModalTable::new((condensed, i), rows?));
            let table = table.map(|table| match self.asked.range {
                Some(range) => table?.over(range),
                None => table,
            });
            try_push(&mut tables, table.transpose()?, CONTEXT)?;
        }
        Ok(tables)
    }

    /// A resolution with at least the harmonics up to `highest`; `None` where there is none.
    fn model_with(&self, highest: usize, solved: &Solved<'_>) -> Result<Option<&'a Resolution>> {
        let slot = self.models.slot_with(highest);
        if slot == self.models.slots() {
            return Ok(None);
        }
        let resolution = self.models.model(slot, |highest| {
            let options = extended_options(&self.options, highest);
            // The model with the most harmonics below these shares most matrices.
            let own = solved.condensed.set().numbers().len();
            let below = self.models.below(slot).map(|below| &*below.condensed);
            let fewer = below
                .filter(|below| below.set().numbers().len() > own)
                .unwrap_or(solved.condensed);
            let shared = more_harmonics::with_more_harmonics(fewer, self.model, &options, self.interrupt)?;
            let condensed = if let Some(condensed) = shared {
                condensed
            } else {
                // One scale for all points, so that they share tables of one unit.
                let Range { start, stop } = self.asked.range.unwrap_or(solved.omega.into());
                // Exchanged motions are those of the whole range.
                let stop = if solved.condensed.has_exchanges() { stop } else { start };
                Condensed::new(self.model, &options, (start, stop), self.interrupt)?
            };
            let carried = condensed.set().numbers().last().copied().unwrap_or(0);
            Ok(Resolution {
                samples: extended_options(&self.options, carried).samples,
                condensed: Arc::new(condensed),
            })
        })?;
        Ok(Some(resolution))
    }

    /// Extends a point to the highest harmonic of an extent, from a solution with fewer of them or from the point itself.
    /// Returns the work that is left.
    fn extend_to(
        &mut self,
        solved: &Solved<'_>,
        from: Option<&Corrected>,
        extent: Extent,
        mut work: Work,
    ) -> Result<(Option<Estimate>, Work)> {
        let (slot, omega) = (self.models.slot_with(extent.highest), solved.omega);
        let Some(resolution) = self.model_with(extent.highest, solved)? else {
            return Ok((Some(solved.unknown(0.0, true)?), work));
        };
        let condensed = &*resolution.condensed;
        let set = condensed.set();
        let by_modes = self.modes_pay(condensed);
        let mut sizes = Sizes::new(condensed, resolution.samples);
        if by_modes {
            sizes = sizes.with_modes(condensed);
        }
        if !work.spend(sizes.flexibility()) {
            return Ok((None, work));
        }
        let compliant = set.numbers().partition_point(|&h| h <= extent.core);
        let kept = self.extended.iter().position(|(kept, _)| *kept == slot);
        let stalled = kept.is_some_and(|kept| self.extended[kept].1.stalled);
        // All harmonics of an exchanged motion couple with each other.
        let couples = stalled || self.second.is_at_hand() || condensed.has_exchanges();
        let all = if couples { whole(&sizes, &work) } else { None };
        let factored = all.unwrap_or_else(|| factored(&sizes, compliant, &work));
        let packed = sizes.packed().min(2.0 * factored.block as f64);
        let pairs = factored.each.saturating_sub(factored.block) as f64;
        self.forget_beside(slot, sizes.bytes(packed, pairs), &work);
        let kept = self.extended.iter().position(|(kept, _)| *kept == slot);
        let mut system = if let Some(kept) = kept {
            let (_, mut system) = self.extended.swap_remove(kept);
            system.set_point(omega, factored, work)?;
            system
        } else {
            let range = omega.into();
            let (response, samples, interrupt) = (self.asked.response, resolution.samples, self.interrupt);
            let mut problem = boxed(|| HarmonicBalance::new(condensed, response, range, samples, None, interrupt))?;
            problem.watch((self.asked.responses, response), samples)?;
            boxed(|| ExtendedSystem::iterative(*problem, omega, factored, (sizes, work)))?
        };
        system.is_monotone = condensed.has_exchanges();
        if by_modes && !system.problem.has_modes() {
            let modal = self.modal_tables(condensed)?;
            system.problem.set_modes(modal);
        }
        let tolerances = [self.options.tol_residual, self.options.tolerance];
        let interrupt = self.interrupt;
        let run = |system: &mut _, changes: &mut _| {
            let kept = (changes, tolerances);
            extend_once(system, condensed, (solved, from), (extent, slot), kept, interrupt)
        };
        let mut found = run(&mut system, &mut self.judged.changes);
        let mut left = system.work();
        if system.stalled
            && !stalled
            && let Some(all) = whole(&sizes, &left)
        {
            self.forget_beside(slot, sizes.bytes(sizes.packed(), 0.0), &left);
            system.set_point(omega, all, left)?;
            found = run(&mut system, &mut self.judged.changes);
            left = system.work();
        }
        if self.extended.len() == FORCED_RESPONSE_ERROR_MOST_KEPT {
            self.extended.remove(0);
        }
        try_push(&mut self.extended, (slot, system), CONTEXT)?;
        Ok((found?, left))
    }

    /// Drops the oldest extended problems that do not fit into the memory of an estimate together with one of
    /// `of_slot` bytes in a slot.
    fn forget_beside(&mut self, slot: usize, of_slot: f64, work: &Work) {
        if self.asked.single {
            self.extended.retain(|(kept, _)| *kept == slot);
        }
        let bytes = |(kept, system): &(usize, Box<ExtendedSystem<HarmonicBalance<'a>>>)| {
            if *kept == slot { 0.0 } else { system.bytes() }
        };
        while !work.fits(of_slot + self.extended.iter().map(bytes).sum::<f64>())
            && let Some(oldest) = self.extended.iter().position(|(kept, _)| *kept != slot)
        {
            self.extended.remove(oldest);
        }
    }
}

/// The numbers that doubling watches: the requested responses, or without these the one that every point has.
fn observed<'o>(response: &'o Complex64, watched: &'o [Complex64]) -> &'o [Complex64] {
    if watched.is_empty() {
        core::slice::from_ref(response)
    } else {
        watched
    }
}
