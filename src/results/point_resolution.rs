//! The harmonics that points of a branch were solved with: all the same, or more where a tolerance asked for them.

use crate::condense::Condensed;
use crate::error::{Result, fail, try_push};
use crate::results::Branch;
use std::sync::Arc;

/// A model condensed to some harmonics.
#[derive(Clone, Debug)]
pub struct Resolution {
    /// The model.
    pub condensed: Arc<Condensed>,
    /// Samples per period of laws that are sampled; 0: exact events.
    pub samples: usize,
}

impl Branch {
    /// Number of a level, which is kept if it is new.
    pub(super) fn level_of(&mut self, level: &Resolution) -> Result<usize> {
        let known = |kept: &Resolution| Arc::ptr_eq(&kept.condensed, &level.condensed);
        if let Some(found) = self.levels.iter().position(known) {
            return Ok(found);
        }
        try_push(&mut self.levels, level.clone(), "the branch")?;
        Ok(self.levels.len() - 1)
    }

    /// The carried harmonics of a stored point, which must exist.
    pub(super) fn carried_of(&self, point: usize) -> Result<&[usize]> {
        match self.carried_at(point) {
            Some(carried) => Ok(carried),
            None => fail!(
                Index,
                "point = {point}, needs 0 .. {} (points and special points)",
                self.stored()
            ),
        }
    }

    /// The condensed model of a stored point; that of the first where there is no such point.
    pub(crate) fn level_at(&self, point: usize) -> &Condensed {
        &self.levels[self.places.get(point).map_or(0, |p| p.level)].condensed
    }

    /// The condensed model of a stored point.
    pub(super) fn condensed_at(&self, point: usize) -> Option<&Condensed> {
        Some(&self.levels[self.places.get(point)?.level].condensed)
    }

    /// Samples per period of a stored point.
    pub(crate) fn samples_at(&self, point: usize) -> usize {
        self.levels[self.places.get(point).map_or(0, |p| p.level)].samples
    }

    /// Packed relative motions of a stored point, in the solver's units.
    pub(crate) fn motion_at(&self, point: usize) -> Option<&[f64]> {
        let condensed = self.condensed_at(point)?;
        let size = condensed.coordinates() * condensed.set().packed_len();
        let begin = self.places[point].motion;
        self.motion.get(begin..begin + size)
    }

    /// Which level a stored point has.
    pub(crate) fn level_number(&self, point: usize) -> usize {
        self.places.get(point).map_or(0, |p| p.level)
    }
}
