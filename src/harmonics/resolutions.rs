//! The equations of a run at the resolutions that it has used; one resolution is the current one.

use crate::condense::blocks::reduction;
use crate::condense::{Reduction, Resolution};
use crate::continuation::Point;
use crate::error::{Result, boxed, try_push};
use crate::harmonics::harmonic_levels::HarmonicLevels;
use crate::harmonics::transfer::transferred_point;
use crate::model::Model;
use crate::options::SolverOptions;

/// Unknowns above which the dense matrices of a resolution are not kept when it is left.
/// Kind: tuned; measured on: not recorded.
const RESOLUTIONS_MOST_KEPT: usize = 600;

/// Equations of type E, one for each resolution in use.
pub(crate) struct Resolutions<'a, E> {
    pub levels: &'a HarmonicLevels<'a>,
    /// Equations of the current resolution.
    pub current: Box<E>,
    others: Vec<Option<Box<E>>>,
    index: usize,
    /// Highest resolution, by its harmonics, among the points recorded.
    highest: usize,
}

impl<'a, E> Resolutions<'a, E> {
    /// Starts with the equations of a first resolution.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(levels: &'a HarmonicLevels<'a>, index: usize, current: Box<E>) -> Result<Self> {
        let mut others = Vec::new();
        for _ in 0..levels.count() {
            try_push(&mut others, None, "the resolutions")?;
        }
        Ok(Self {
            levels,
            current,
            others,
            index,
            highest: index,
        })
    }

    /// Index of the current resolution.
    pub fn index(&self) -> usize {
        self.index
    }

    /// Makes another resolution the current one. `make` creates its equations, unless they are stored, as small ones
    /// are.
    ///
    /// # Errors
    /// Those of condensing the model and of `make`.
    pub fn select(&mut self, index: usize, make: impl FnOnce(&'a Resolution) -> Result<E>) -> Result<()> {
        if index == self.index {
            return Ok(());
        }
        let selected = if let Some(kept) = self.others[index].take() {
            kept
        } else {
            let level = self.levels.at(index)?;
            boxed(|| make(level))?
        };
        let keep = self.levels.at(self.index)?.condensed.unknowns() <= RESOLUTIONS_MOST_KEPT;
        let left = core::mem::replace(&mut self.current, selected);
        self.others[self.index] = keep.then_some(left);
        self.index = index;
        Ok(())
    }

    /// Notes that a point of the current resolution was recorded.
    pub fn note_recorded(&mut self) {
        self.highest = self.highest.max(self.index);
    }

    /// The parts that the condensation removed, for the resolution with the most harmonics; `first` describes the
    /// initial resolution.
    ///
    /// # Errors
    /// Those of condensing the model.
    pub fn reduction(&self, model: &Model, solver: &SolverOptions, first: &Reduction) -> Result<Reduction> {
        let condensed = &self.levels.at(self.highest)?.condensed;
        Ok(reduction::reduction_with(
            condensed,
            model,
            solver,
            first.held_by_contacts,
        ))
    }

    /// A point of another resolution in the current harmonics, see [`transferred_point`].
    pub fn transfer(&self, point: &Point, from: usize, others: usize, is_length: bool) -> Result<Point> {
        let (from, to) = (self.levels.at(from)?, self.levels.at(self.index)?);
        transferred_point(point, &from.condensed, &to.condensed, others, is_length)
    }
}
