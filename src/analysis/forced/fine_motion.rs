//! The motion of a point with more harmonics than it was solved with, from which shooting in time begins.
//!
//! A point with few harmonics may lie several per cent beside the motion in time, from where Newton's method in time needs many
//! lapses with all perturbations. The corrected solution of an error estimate is found at the contacts alone, and lies near.

use crate::condense::ModelCache;
use crate::condense::by_modes::wave_cache::SharedWaves;
use crate::error::{Result, boxed, try_vec};
use crate::harmonics::Solved;
use crate::harmonics::forced_response_error::ForcedEstimator;
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::options::Range;
use crate::options::SolverOptions;
use crate::results::Recovery;
use num_complex::Complex64;

/// States in time for each unknown of a point from which a correction takes less time than the lapses that it saves.
/// Kind: tuned; measured on: the
/// ring damper, 96 states and 10 unknowns, where it saves three quarters of them, and on chains of three masses with stops, 6 and 57,
/// where it takes twice as long as they do.
const STATES_FOR_EACH: usize = 2;

/// Corrected motions of the points of one forced response.
pub(crate) struct FineMotion<'a> {
    estimator: Box<ForcedEstimator<'a>>,
    models: &'a ModelCache,
    /// Number of displacements and velocities in time.
    states: usize,
    interrupt: &'a Interrupt<'a>,
}

impl<'a> FineMotion<'a> {
    /// Prepares for points of `model` in a range of frequencies, with the caches of the estimates.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(
        model: &'a Model,
        solver: &SolverOptions,
        (response, range): (usize, Range),
        (models, waves): (&'a ModelCache, &'a SharedWaves),
        interrupt: &'a Interrupt<'a>,
    ) -> Result<Self> {
        let estimator = || Ok(ForcedEstimator::new(model, solver, response, (models, waves), interrupt).over(range));
        Ok(Self {
            estimator: boxed(estimator)?,
            models,
            states: 2 * model.structure().ndof() * model.structure().repeating_sectors(),
            interrupt,
        })
    }

    /// The harmonics of all degrees of freedom at a point, with the correction of an error estimate; `None` where the
    /// estimate is not certified, or does not pay.
    ///
    /// # Errors
    /// Those of callbacks; `OutOfMemory`, `StoppedByCaller`.
    pub fn at(&mut self, solved: &Solved<'_>) -> Result<Option<Vec<Complex64>>> {
        if self.states < STATES_FOR_EACH * solved.motion.len() {
            return Ok(None);
        }
        let found = self.estimator.at(solved)?;
        let numbers = found.corrected.set.numbers();
        let highest = numbers.last().copied().unwrap_or(0);
        let Some(resolution) = self
            .models
            .made(highest)
            .filter(|made| found.certified && made.condensed.set().numbers() == numbers)
        else {
            return Ok(None);
        };
        let length = resolution.condensed.length();
        let mut motion = try_vec(found.corrected.motion.len(), 0.0, "a motion with more harmonics")?;
        for (to, from) in motion.iter_mut().zip(&found.corrected.motion) {
            *to = from / length;
        }
        let solution = (&motion[..], solved.omega, 0.0);
        Recovery::of(resolution, solution, self.interrupt)?
            .all(highest)
            .map(Some)
    }
}
