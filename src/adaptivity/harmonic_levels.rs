//! Numbers of harmonics that a run may solve with: one, or a harmonic levels of them between which a tolerance chooses.

use crate::condense::{Condensed, Reduction};
use crate::continuation::Point;
use crate::error::{Result, fail, try_push, try_vec};
use crate::error_estimate::affordable;
use crate::fourier::gcd;
use crate::model::Model;
use crate::options::{MAX_SAMPLES, SolverOptions};
use crate::results::Resolution;
use num_complex::Complex64;
use std::cell::OnceCell;
use std::sync::Arc;

const CONTEXT: &str = "the harmonics";

/// Ratio of neighbouring resolutions.
const RATIO: f64 = 1.25;

/// The same for structures so large that each resolution costs many factorisations.
const RATIO_LARGE: f64 = 2.0;

/// Degrees of freedom above which a structure is large.
const LARGE: usize = 32;

/// Unknowns above which no resolution is climbed: Newton's method factors dense matrices.
const MOST_UNKNOWNS: usize = 3000;

/// Unknowns above which the dense matrices of a resolution are not kept when it is left.
const MOST_KEPT: usize = 600;

/// Samples per harmonic where laws are sampled and the tolerance decides.
const SAMPLES_PER_HARMONIC: usize = 8;

/// Condenses the model to harmonics up to the one given.
type Condense<'m> = dyn Fn(usize) -> Result<Condensed> + 'm;

/// The resolutions, of which each is made when it is first asked for.
pub(crate) struct HarmonicLevels<'m> {
    numbers: Vec<usize>,
    levels: Vec<OnceCell<Resolution>>,
    samples: usize,
    automatic: bool,
    condense: Box<Condense<'m>>,
}

impl<'m> HarmonicLevels<'m> {
    /// The resolutions that the options ask for. `forced` are the harmonics in which forces act.
    ///
    /// # Errors
    /// `Argument` for a force above `max_harmonics`, `OutOfMemory`.
    pub fn new(
        model: &Model,
        options: &SolverOptions,
        forced: &[usize],
        condense: impl Fn(usize) -> Result<Condensed> + 'm,
    ) -> Result<Self> {
        let automatic = options.tolerance > 0.0;
        let mut harmonic_levels = Self {
            numbers: Vec::new(),
            levels: Vec::new(),
            samples: options.samples,
            automatic,
            condense: Box::new(condense),
        };
        if !automatic {
            harmonic_levels.add(options.harmonics)?;
            return Ok(harmonic_levels);
        }
        let most = options.max_harmonics;
        if let Some(h) = forced.iter().find(|&&h| h > most) {
            return fail!(
                Argument,
                "a force acts in harmonic {h}, but max_harmonics = {most}; raise max_harmonics to {h}"
            );
        }
        let ratio = if model.ndof() > LARGE { RATIO_LARGE } else { RATIO };
        let base = if options.keep_even_harmonics {
            1
        } else {
            forced.iter().fold(0, |g, &h| gcd(g, h)).max(1)
        };
        let least = forced.iter().copied().max().unwrap_or(0).max(1);
        // Reduced numbers are odd, so that each resolution has more than the one below where even ones are left out.
        let mut reduced = least.div_ceil(base);
        harmonic_levels.add(least)?;
        loop {
            reduced = (reduced + 2).max(((reduced as f64 * ratio) as usize) | 1);
            if reduced * base > most {
                break;
            }
            harmonic_levels.add(reduced * base)?;
        }
        let top = most / base * base;
        if harmonic_levels.numbers.last().is_some_and(|&h| h + base < top) {
            harmonic_levels.add(top)?;
        }
        Ok(harmonic_levels)
    }

    fn add(&mut self, highest: usize) -> Result<()> {
        try_push(&mut self.numbers, highest, CONTEXT)?;
        try_push(&mut self.levels, OnceCell::new(), CONTEXT)
    }

    /// Whether a tolerance chooses the resolution.
    pub fn is_automatic(&self) -> bool {
        self.automatic
    }

    /// The resolution to begin with: as many harmonics as `harmonics` says, fewer where the harmonic levels ends before.
    pub fn first(&self, harmonics: usize) -> usize {
        self.numbers.iter().rposition(|&h| h <= harmonics).unwrap_or(0)
    }

    /// The lowest resolution with all harmonics up to h, the last that is affordable where there is none.
    pub fn resolution_with(&self, h: usize) -> usize {
        let last = self.last();
        self.numbers[..last].partition_point(|&n| n < h)
    }

    /// The lowest resolution with at least half as many harmonics as one.
    pub fn resolution_of_half(&self, resolution: usize) -> usize {
        self.numbers.partition_point(|&n| 2 * n < self.numbers[resolution])
    }

    /// The highest resolution that is affordable.
    pub fn last(&self) -> usize {
        let known = self.levels.iter().find_map(OnceCell::get);
        let most = known.map_or(usize::MAX, |level| affordable(&level.condensed, MOST_UNKNOWNS));
        let below = self.numbers.partition_point(|&n| n <= most);
        below.max(1) - 1
    }

    /// A resolution.
    ///
    /// # Errors
    /// Those of condensing the model.
    pub fn level(&self, resolution: usize) -> Result<&Resolution> {
        let cell = &self.levels[resolution];
        if let Some(level) = cell.get() {
            return Ok(level);
        }
        let highest = self.numbers[resolution];
        let samples = match self.samples {
            n if n > 0 && self.automatic => n.max(SAMPLES_PER_HARMONIC * highest).min(MAX_SAMPLES),
            n => n,
        };
        let level = Resolution {
            condensed: Arc::new((self.condense)(highest)?),
            samples,
        };
        Ok(cell.get_or_init(|| level))
    }
}

/// What an analysis has made for the resolutions that it was on.
pub(crate) struct Resolutions<'a, R> {
    pub harmonic_levels: &'a HarmonicLevels<'a>,
    /// What belongs to the resolution at hand.
    pub here: R,
    others: Vec<Option<R>>,
    resolution: usize,
    /// The resolution with the most harmonics among the points kept.
    highest: usize,
}

impl<'a, R> Resolutions<'a, R> {
    /// On a first resolution.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(harmonic_levels: &'a HarmonicLevels<'a>, resolution: usize, here: R) -> Result<Self> {
        let mut others = Vec::new();
        for _ in &harmonic_levels.numbers {
            try_push(&mut others, None, CONTEXT)?;
        }
        Ok(Self {
            harmonic_levels,
            here,
            others,
            resolution,
            highest: resolution,
        })
    }

    /// The resolution at hand.
    pub fn resolution(&self) -> usize {
        self.resolution
    }

    /// Goes to another resolution, for which `make` is asked unless it is kept from before: what is small is.
    ///
    /// # Errors
    /// Those of condensing the model and of `make`.
    pub fn go_to(&mut self, resolution: usize, make: impl FnOnce(&'a Resolution) -> Result<R>) -> Result<()> {
        if resolution == self.resolution {
            return Ok(());
        }
        let there = match self.others[resolution].take() {
            Some(there) => there,
            None => make(self.harmonic_levels.level(resolution)?)?,
        };
        let keep = self.harmonic_levels.level(self.resolution)?.condensed.unknowns() <= MOST_KEPT;
        let left = core::mem::replace(&mut self.here, there);
        self.others[self.resolution] = keep.then_some(left);
        self.resolution = resolution;
        Ok(())
    }

    /// Notes that a point was kept on the resolution at hand.
    pub fn note_kept(&mut self) {
        self.highest = self.highest.max(self.resolution);
    }

    /// What was removed from the problem that has the most harmonics.
    ///
    /// # Errors
    /// Those of [`Condensed::reduction`].
    pub fn reduction(&self, model: &Model, solver: &SolverOptions) -> Result<Reduction> {
        self.harmonic_levels
            .level(self.highest)?
            .condensed
            .reduction(model, solver)
    }

    /// A point of another resolution in the harmonics at hand, see [`transferred_point`].
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn transfer(&self, point: &Point, from: usize, others: usize, scaled: bool) -> Result<Point> {
        let (from, to) = (
            self.harmonic_levels.level(from)?,
            self.harmonic_levels.level(self.resolution)?,
        );
        transferred_point(point, &from.condensed, &to.condensed, others, scaled)
    }
}

/// Unknowns, and the `others` numbers after the motions, in other harmonics; motions times a factor.
///
/// # Errors
/// `OutOfMemory`.
pub(crate) fn carried(from: &Condensed, to: &Condensed, v: &[f64], others: usize, factor: f64) -> Result<Vec<f64>> {
    let motions = to.unknowns();
    let mut found = try_vec(motions + others, 0.0, CONTEXT)?;
    let (motion, rest) = v.split_at(v.len() - others);
    to.set().transfer(from.set(), motion, factor, &mut found[..motions]);
    found[motions..].copy_from_slice(rest);
    Ok(found)
}

/// A point in other harmonics, of which it need not be a solution. `others` of its unknowns are no motions; the
/// parameter counts among them. `scaled` says whether the amplitude observed is a length.
///
/// # Errors
/// `OutOfMemory`.
fn transferred_point(point: &Point, from: &Condensed, to: &Condensed, others: usize, scaled: bool) -> Result<Point> {
    let factor = from.length() / to.length();
    let of_amplitude: Complex64 = if scaled { factor } else { 1.0 }.into();
    Ok(Point {
        v: carried(from, to, &point.v, others, factor)?,
        tangent: carried(from, to, &point.tangent, others, factor)?,
        amplitude: point.amplitude * of_amplitude,
        slope: point.slope * of_amplitude,
        ..*point
    })
}
