//! A result that is followed over a parameter, as the controller of the harmonics uses it: its equations at each resolution.

use crate::continuation::corrector::Corrector;
use crate::continuation::resolve::resolve;
use crate::continuation::{Point, Settings};
use crate::error::{Result, try_copy, try_vec};
use crate::fourier::HarmonicSet;
use crate::harmonics::discretised::{Assessment, Discretised};
use crate::harmonics::estimate_spacing::share_of_highest;
use crate::harmonics::harmonic_levels::HarmonicLevels;
use crate::harmonics::{Corrected, Estimate};
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::problem::Problem;
use crate::sensitivity::tracked::Tracked;
use num_complex::Complex64;

const CONTEXT: &str = "the harmonics";

/// A result over a parameter, with the levels of harmonics to choose from.
pub(crate) struct Followed<'a> {
    tracked: &'a mut dyn Tracked,
    levels: &'a HarmonicLevels<'a>,
    level: usize,
    settings: Settings,
    interrupt: &'a Interrupt<'a>,
    /// Error of the point estimated last, until it is read; NaN afterwards.
    estimated: f64,
}

impl<'a> Followed<'a> {
    /// A result whose problem has the harmonics of a level.
    pub fn new(
        tracked: &'a mut dyn Tracked,
        (levels, level): (&'a HarmonicLevels<'a>, usize),
        settings: Settings,
        interrupt: &'a Interrupt<'a>,
    ) -> Self {
        Self {
            tracked,
            levels,
            level,
            settings,
            interrupt,
            estimated: f64::NAN,
        }
    }

    /// The result that is followed over the parameter.
    pub fn tracked(&mut self) -> &mut dyn Tracked {
        self.tracked
    }

    /// Reads the error of the point estimated last, which is NaN afterwards.
    pub fn take_error(&mut self) -> f64 {
        core::mem::replace(&mut self.estimated, f64::NAN)
    }

    fn set(&self, level: usize) -> Result<&'a HarmonicSet> {
        Ok(self.levels.at(level)?.condensed.set())
    }

    /// The error of a point whose solution at a fixed frequency is not isolated, as in a fold: the difference from
    /// the solution with at least twice as many harmonics, more where the structure is compliant in these.
    fn compare(&mut self, point: &Point) -> Result<Assessment> {
        let from = self.level;
        let to = self.levels.level_of_double(from).min(self.levels.last());
        let mut found = None;
        if to > from {
            self.select(to)?;
            let start = self.transfer(point, from)?;
            let solved = self.resolve(&start, true, self.interrupt);
            self.select(from)?;
            found = solved?;
        }
        let own = self.set(from)?;
        let Some(better) = found else {
            return Ok(Assessment {
                error: f64::NAN,
                estimate: unknown(own, point, to == from),
            });
        };
        let set = self.set(to)?;
        let motions = set.packed_len() * (self.tracked.motions() / own.packed_len().max(1));
        let motion = &better.v[..motions];
        let all = norm(motion);
        let mut estimate = unknown(set, &better, false);
        estimate.corrected.motion = try_copy(motion, CONTEXT)?;
        for (i, &number) in set.numbers().iter().enumerate() {
            if own.numbers().binary_search(&number).is_err() {
                let signals = motion.chunks_exact(set.packed_len());
                let share = signals.map(|y| set.get(y, i).norm()).fold(0.0, f64::hypot) / all;
                crate::error::try_push(&mut estimate.tail, (number, share), CONTEXT)?;
            }
        }
        let error = (better.amplitude - point.amplitude).norm() / better.amplitude.norm();
        estimate.certified = true;
        estimate.response = error;
        Ok(Assessment { error, estimate })
    }
}

impl Discretised for Followed<'_> {
    fn problem(&mut self) -> &mut dyn Problem {
        self.tracked.problem()
    }

    fn levels(&self) -> &HarmonicLevels<'_> {
        self.levels
    }

    fn resolution(&self) -> usize {
        self.level
    }

    fn select(&mut self, resolution: usize) -> Result<()> {
        if resolution != self.level {
            let from = self.set(self.level)?;
            let to = self.levels.at(resolution)?;
            self.tracked.select(from, to, self.levels.highest(resolution))?;
            self.level = resolution;
        }
        Ok(())
    }

    fn transfer(&self, point: &Point, from: usize) -> Result<Point> {
        let (from, to) = (self.set(from)?, self.set(self.level)?);
        let motions = self.tracked.motions();
        let before = motions / to.packed_len().max(1) * from.packed_len();
        let moved = |v: &[f64]| -> Result<Vec<f64>> {
            let mut found = try_vec(motions + v.len() - before, 0.0, CONTEXT)?;
            to.transfer(from, &v[..before], 1.0, &mut found[..motions]);
            found[motions..].copy_from_slice(&v[before..]);
            Ok(found)
        };
        Ok(Point {
            v: moved(&point.v)?,
            tangent: moved(&point.tangent)?,
            ..*point
        })
    }

    fn transfer_corrected(&self, point: &Point, from: usize, estimate: &Estimate) -> Result<Point> {
        let mut start = self.transfer(point, from)?;
        if !estimate.corrected.omega.is_nan() {
            self.tracked
                .take_corrected(&estimate.corrected, self.set(self.level)?, &mut start.v);
        }
        Ok(start)
    }

    fn resolve(&mut self, near: &Point, keep_parameter: bool, interrupt: &Interrupt<'_>) -> Result<Option<Point>> {
        let settings = &self.settings;
        let mut corrector = Corrector::new(near.unknowns().len(), settings.tolerance, settings.max_iterations)?;
        let problem = self.tracked.problem();
        resolve(problem, &mut corrector, settings, near, keep_parameter, interrupt)
    }

    fn estimate(&mut self, point: &Point) -> Result<Option<Assessment>> {
        let found = match self.tracked.estimate(point)? {
            Some((error, estimate)) => Assessment { error, estimate },
            None => self.compare(point)?,
        };
        self.estimated = found.error;
        Ok(Some(found))
    }

    fn share_of_highest(&self, point: &Point) -> f64 {
        match self.set(self.level) {
            Ok(set) => share_of_highest(set, &point.unknowns()[..self.tracked.motions()]),
            Err(_) => f64::NAN,
        }
    }

    /// Always `false`: points over a parameter are few, and each is estimated.
    fn take_over_estimate(&mut self, _point: &Point, _factor: f64) -> Result<bool> {
        Ok(false)
    }
}

/// An estimate that tells nothing.
fn unknown(set: &HarmonicSet, point: &Point, too_large: bool) -> Estimate {
    Estimate {
        certified: false,
        too_large,
        motion: f64::NAN,
        response: f64::NAN,
        responses: Vec::new(),
        frequency: f64::NAN,
        damping: f64::NAN,
        harmonics: set.numbers().last().copied().unwrap_or(0),
        steps: point.iterations,
        change: f64::NAN,
        tail: Vec::new(),
        corrected: Corrected {
            set: set.clone(),
            motion: Vec::new(),
            response: Complex64::ZERO,
            watched: Vec::new(),
            omega: f64::NAN,
            damping: 0.0,
            rates: Vec::new(),
        },
    }
}
