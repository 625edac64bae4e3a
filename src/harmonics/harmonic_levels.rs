//! The numbers of harmonics available to a run: one, or a rising list from which a tolerance selects.

use crate::condense::by_modes::wave_cache::have_modes;
use crate::condense::{Condensed, ModelCache, Resolution};
use crate::error::{Result, fail, try_push};
use crate::fourier::{HarmonicSet, gcd};
use crate::harmonics::cutoff_harmonic::SMALL_STRUCTURE;
use crate::harmonics::{affordable, allow_point, is_allowed};
use crate::model::Model;
use crate::options::{MAX_SAMPLES, SolverOptions};
use std::sync::Arc;

const CONTEXT: &str = "the harmonics";

/// Ratio of neighbouring levels.
/// Kind: tuned; measured on: not recorded.
const HARMONIC_LEVELS_RATIO: f64 = 1.25;

/// Unknowns above which no level is refined: Newton's method factors dense matrices.
/// Kind: cap.
const MOST_UNKNOWNS: usize = 3000;

/// Unknowns up to which the work of a point hardly depends on their number.
/// Kind: tuned; measured on: not recorded.
const HARMONIC_LEVELS_SMALL: usize = 32;

/// Motions of contacts from which on a harmonic makes Newton's matrix so much larger that fewer of them pay, although the structure has
/// modes and its factors cost nothing.
/// Kind: tuned; measured on: a finite-element sector with 60 contacts, a cantilever with 10.
const COSTLY_FROM: usize = 32;

/// Samples per harmonic where laws are sampled and the tolerance decides.
/// Kind: tuned; measured on: not recorded.
const SAMPLES_PER_HARMONIC: usize = 8;

/// A function that condenses the model to the harmonics up to a given one, reusing a condensed model with fewer where
/// there is one.
type Condense<'m> = dyn Fn(usize, Option<&Condensed>) -> Result<Condensed> + 'm;

/// Levels: rising numbers of harmonics. The model is condensed at a level when this is first requested.
pub(crate) struct HarmonicLevels<'m> {
    models: ModelCache,
    samples: usize,
    automatic: bool,
    /// Whether a harmonic costs many factorisations or large matrices.
    costly: bool,
    /// Bytes that the equations of a level may need; 0: no limit.
    memory_limit: usize,
    condense: Box<Condense<'m>>,
}

impl<'m> HarmonicLevels<'m> {
    /// The levels that the options request. `forced` are the harmonics in which forces act.
    ///
    /// # Errors
    /// `Argument` for a force above `max_harmonics`, `OutOfMemory`.
    pub fn new(
        model: &Model,
        options: &SolverOptions,
        forced: &[usize],
        condense: impl Fn(usize, Option<&Condensed>) -> Result<Condensed> + 'm,
    ) -> Result<Self> {
        let automatic = options.tolerance > 0.0;
        let costly = automatic && model.ndof() > SMALL_STRUCTURE && !have_modes(model)?;
        let numbers = if automatic {
            automatic_numbers(options, forced)?
        } else {
            let mut one = Vec::new();
            try_push(&mut one, options.harmonics, CONTEXT)?;
            one
        };
        Ok(Self {
            models: ModelCache::new(numbers.into_iter())?,
            samples: options.samples,
            automatic,
            costly,
            memory_limit: options.memory_limit,
            condense: Box::new(condense),
        })
    }

    /// Whether a tolerance selects the level.
    pub fn is_automatic(&self) -> bool {
        self.automatic
    }

    /// Whether a harmonic costs much: many factorisations, many unknowns, or with exchanged motions, which need a hundred and more, full
    /// matrices.
    pub fn are_costly(&self) -> bool {
        let known = self.models.any();
        self.costly
            || known
                .is_some_and(|known| known.condensed.has_exchanges() || known.condensed.coordinates() >= COSTLY_FROM)
    }

    /// Number of levels available.
    pub fn count(&self) -> usize {
        self.models.slots()
    }

    /// Initial level, with the harmonics up to `harmonics`, or the last one if the levels end before.
    pub fn first(&self, harmonics: usize) -> usize {
        self.models.numbers().rposition(|h| h <= harmonics).unwrap_or(0)
    }

    /// Lowest level with all harmonics up to h, or the last affordable one if there is none.
    pub fn level_with(&self, h: usize) -> usize {
        self.models.slot_with(h).min(self.last())
    }

    /// Lowest level that carries the harmonics of `set`; with a fixed number of harmonics there is just one level.
    pub fn level_of(&self, set: &HarmonicSet) -> usize {
        self.level_with(set.numbers().last().copied().unwrap_or(0))
    }

    /// Highest harmonic that a level requests.
    pub fn highest(&self, level: usize) -> usize {
        self.models.highest(level)
    }

    /// Lowest level with about half as many harmonics as a given one.
    pub fn level_of_half(&self, level: usize) -> usize {
        self.models.slot_with(self.models.highest(level) / 2)
    }

    /// Lowest level with at least twice as many harmonics as a given one.
    pub fn level_of_double(&self, level: usize) -> usize {
        self.level_with(2 * self.models.highest(level))
    }

    /// Lowest level of a branch where something is nonlinear. With the forced harmonics alone nothing shows how the
    /// error changes, so that each point needs an estimate: this pays where the next level has many unknowns, and the
    /// estimates cost no factorisation.
    pub fn few(&self) -> usize {
        let pays = |known: &Resolution| affordable(&known.condensed, HARMONIC_LEVELS_SMALL) < self.models.highest(1);
        usize::from(self.costly || self.count() < 2 || !self.models.any().is_some_and(pays))
    }

    /// The highest affordable level.
    pub fn last(&self) -> usize {
        let Some(known) = self.models.any() else {
            return self.count() - 1;
        };
        let most = affordable(&known.condensed, MOST_UNKNOWNS).min(known.condensed.highest_below_rings());
        let fits = |n| is_allowed(self.memory_limit, &known.condensed, n, self.samples_up_to(n));
        let below = self.models.numbers().take_while(|&n| n <= most && fits(n)).count();
        below.max(1) - 1
    }

    /// Samples per period of the sampled laws with harmonics up to `highest`; 0 for exact events.
    fn samples_up_to(&self, highest: usize) -> usize {
        match self.samples {
            n if n > 0 && self.automatic => n.max(SAMPLES_PER_HARMONIC * highest).min(MAX_SAMPLES),
            n => n,
        }
    }

    /// The model condensed to the harmonics of a level.
    ///
    /// # Errors
    /// Those of condensing the model; `OutOfMemory` where its equations exceed the limit of the options.
    pub fn at(&self, level: usize) -> Result<&Resolution> {
        self.models.model(level, |highest| {
            let samples = self.samples_up_to(highest);
            let fewer = self.models.below(level).map(|known| &*known.condensed);
            let condensed = (self.condense)(highest, fewer)?;
            allow_point(self.memory_limit, &condensed, highest, samples)?;
            Ok(Resolution {
                condensed: Arc::new(condensed),
                samples,
            })
        })
    }
}

/// Rising numbers of harmonics from the highest forced one to `max_harmonics`.
fn automatic_numbers(options: &SolverOptions, forced: &[usize]) -> Result<Vec<usize>> {
    let most = options.max_harmonics;
    if let Some(h) = forced.iter().find(|&&h| h > most) {
        return fail!(
            Argument,
            "a force acts in harmonic {h}, but max_harmonics = {most}; raise max_harmonics to {h}"
        );
    }
    let base = if options.keep_even_harmonics {
        1
    } else {
        forced.iter().fold(options.content.base, |g, &h| gcd(g, h)).max(1)
    };
    let least = forced.iter().copied().max().unwrap_or(0).max(1);
    let mut numbers = Vec::new();
    // Reduced numbers are odd, so that each level has more than the one below where even harmonics are omitted.
    let mut reduced = least.div_ceil(base);
    try_push(&mut numbers, least, CONTEXT)?;
    loop {
        reduced = (reduced + 2).max(((reduced as f64 * HARMONIC_LEVELS_RATIO) as usize) | 1);
        if reduced * base > most {
            break;
        }
        try_push(&mut numbers, reduced * base, CONTEXT)?;
    }
    let top = most / base * base;
    if numbers.last().is_some_and(|&h| h + base < top) {
        try_push(&mut numbers, top, CONTEXT)?;
    }
    Ok(numbers)
}
