//! Derivatives of the state after a lapse by the initial state: (δx, δv, δe), with the stretches e of the sliders' springs.
//!
//! Within the lapse the places of the sliders δw = r·δx − δe replace δe, because they are constant while the sliders rest.

use crate::contact::forms::time_piece::Grazing;
use crate::error::{Result, try_push};
use crate::time_integration::event_law::{Row, along};
use crate::time_integration::perturbation_basis::PerturbationBasis;
use crate::time_integration::unrolled_structure::System;
use crate::time_integration::variation::{Interval, Variation};
use crate::time_integration::variational_equations::VariationalEquations;

/// Derivatives of the state after a lapse by the initial state, with memory to integrate them.
pub(crate) struct Sensitivity<'s> {
    basis: PerturbationBasis<'s, f64>,
    /// Row of the relative motion of each slider; `None` without a slider.
    rows: Vec<Option<Row>>,
    /// Index of the first stretch in a state.
    first: usize,
}

impl<'s> Sensitivity<'s> {
    /// Memory for the states of `system`.
    ///
    /// # Errors
    /// `OutOfMemory`, `StoppedByCaller`; `Unsupported` if the mass matrix is singular.
    pub fn new(system: &System<'s>) -> Result<Self> {
        let equations = VariationalEquations::of_system(system)?;
        let mut rows = Vec::new();
        for e in &system.elements {
            try_push(&mut rows, e.rows.first().copied(), "the monodromy matrix")?;
        }
        let smooth = !system.is_piecewise_linear();
        Ok(Self {
            basis: PerturbationBasis::new(equations, rows.len(), smooth, system.interrupt)?,
            rows,
            first: 2 * system.order(),
        })
    }

    /// Derivative of entry `to` of the state after the lapse by entry `from` of the initial state.
    pub fn by_initial(&self, from: usize, to: usize) -> f64 {
        self.basis.columns[from * self.basis.states() + to]
    }

    /// Sets the derivatives to the identity, before a lapse.
    pub fn begin(&mut self) -> &mut Self {
        self.basis.begin();
        self.exchange();
        self
    }

    /// Exchanges stretches and places of sliders; the step is the same in both directions: δw = r·δx − δe, δe = r·δx
    /// − δw.
    fn exchange(&mut self) {
        let states = self.basis.states();
        for column in self.basis.columns.chunks_exact_mut(states.max(1)) {
            for (i, row) in self.rows.iter().enumerate() {
                let motion = row.as_ref().map_or(0.0, |row| along(row, column));
                column[self.first + i] = motion - column[self.first + i];
            }
        }
    }
}

impl Variation for Sensitivity<'_> {
    fn advance(&mut self, interval: &Interval<'_>) -> Result<()> {
        self.basis.advance(interval)
    }

    fn couple(&mut self, element: usize, share: f64) -> Result<()> {
        self.basis.couple(element, share)
    }

    fn end(&mut self) -> Result<()> {
        self.basis.end()?;
        self.exchange();
        Ok(())
    }

    fn graze(&mut self, _: usize, _: Grazing) {}
}
