//! A guess for the first point with many harmonics: solved with few of them, and transferred to more.
//!
//! Newton's method from small motion fails where contacts slip much, and a homotopy with many harmonics costs most of a
//! response. With as few harmonics as the forces have it costs little, and its solution, with the other harmonics zero, is a
//! good guess with twice as many, and so on.

use crate::condense::Condensed;
use crate::contact::Contact;
use crate::continuation::initial_point::{self, Effort, Way};
use crate::continuation::{Point, Settings};
use crate::error::{Result, Status};
use crate::harmonics::transfer::transferred;
use crate::interrupt::{Interrupt, Phase};
use crate::model::Model;
use crate::options::SolverOptions;
use crate::problem::InitialGuess;
use crate::problem::harmonic_balance::HarmonicBalance;

/// Highest harmonic up to which the first point is solved at once.
/// Kind: tuned; measured on: not recorded.
const COARSE_START_AT_ONCE: usize = 12;

/// Degrees of freedom above which another number of harmonics costs more than it saves.
/// Kind: tuned; measured on: not recorded.
const COARSE_START_LARGE: usize = 1000;

/// Bounds on points and iterations of a homotopy with few harmonics.
/// Kind: cap.
const COARSE_START_MOST: Effort = Effort {
    points: 200,
    iterations: usize::MAX,
    until: u64::MAX,
};

/// Share of the period that a contact slips above which Newton's method from small motion mostly fails.
/// Kind: tuned; measured on: not recorded.
const MUCH_SLIP: f64 = 0.5;

/// A solution with fewer harmonics.
pub(crate) struct CoarseStart {
    condensed: Condensed,
    v: Vec<f64>,
    /// Newton iterations so far, over all numbers of harmonics.
    iterations: usize,
}

impl CoarseStart {
    /// A solution at the start of `settings` with about half the harmonics of `solver`, and `response` observed;
    /// `forced` are the harmonics in which forces act. `None` where contacts hardly slip at the start or have more than
    /// friction under constant loads, few harmonics are requested, or nothing was found.
    ///
    /// # Errors
    /// Those of condensing the model; `StoppedByCaller`.
    pub fn new(
        model: &Model,
        solver: &SolverOptions,
        settings: &Settings,
        (forced, response): (&[usize], usize),
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Self>> {
        interrupt.phase(Phase::FirstPoint, 0.0)?;
        let least = forced.iter().copied().max().unwrap_or(0).max(1);
        let mut highest = least;
        let mut found: Option<Self> = None;
        // Springs with several solutions might lead to another one than with all harmonics.
        let is_friction = |contact: &Contact| contact.may_stick() && contact.normal_direction().is_none();
        let is_friction = model.contacts().iter().all(is_friction);
        if solver.harmonics <= COARSE_START_AT_ONCE.max(least) || model.ndof() > COARSE_START_LARGE || !is_friction {
            return Ok(None);
        }
        while 2 * highest <= solver.harmonics {
            let options = SolverOptions {
                harmonics: highest,
                ..*solver
            };
            let condensed = Condensed::new(model, &options, settings.start, interrupt)?;
            let given = found.as_ref().map(|below| below.at(&condensed)).transpose()?;
            let is_transferred = given.is_some();
            let at = settings.start.into();
            let mut problem = HarmonicBalance::new(&condensed, response, at, solver.samples, given, interrupt)?;
            let first = match initial_point::solve_within(&mut problem, settings, COARSE_START_MOST, interrupt) {
                Ok(first) => first,
                Err(e) if e.recoverable || matches!(e.status, Status::NoConvergence | Status::Singular) => {
                    return Ok(None);
                }
                Err(e) => return Err(e),
            };
            let slips = problem.slip_fractions().iter().any(|&share| share > MUCH_SLIP);
            if !is_transferred && !slips {
                return Ok(None);
            }
            drop(problem);
            found = Some(Self {
                condensed,
                iterations: found.map_or(0, |below| below.iterations) + first.point.iterations,
                v: first.point.v,
            });
            highest = 2 * highest + least;
        }
        Ok(found)
    }

    /// Adds the iterations to those of the first point, and sets the method that found it.
    pub fn count(&self, first: &mut Point, way: &mut Way) {
        first.iterations += self.iterations;
        if *way == Way::Newton(InitialGuess::Given) {
            *way = Way::Transferred;
        }
    }

    /// The packed motion of the solution in the harmonics of `to`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn at(&self, to: &Condensed) -> Result<Vec<f64>> {
        let factor = self.condensed.length() / to.length();
        let mut motion = transferred(&self.condensed, to, &self.v, 1, factor)?;
        motion.truncate(to.unknowns());
        Ok(motion)
    }
}
