//! A basis of perturbations, carried through a lapse of the motion.
//!
//! Without an event the equations of perturbations remain the same: their series may be longer than the steps of the
//! motion, so that intervals with the same tangents are carried as one.

use crate::contact::forms::time_piece::{Grazing, TimePiece};
use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::time_integration::variation::{Interval, Variation};
use crate::time_integration::variational_equations::{Number, VariationalEquations, VariationalRow};
use crate::time_integration::variational_step::VariationalStep;

const CONTEXT: &str = "the perturbations";

/// A basis of perturbations (δx, δv, δw), sliders w last, as columns.
pub(crate) struct PerturbationBasis<'s, T> {
    interrupt: &'s Interrupt<'s>,
    equations: VariationalEquations<T>,
    step: VariationalStep<T>,
    /// Perturbations, column after column.
    pub columns: Vec<T>,
    /// Total length of the intervals with equal tangents through which the perturbations are still to be carried.
    waiting: f64,
    pieces: Vec<TimePiece>,
}

impl<'s, T: Number> PerturbationBasis<'s, T> {
    /// Memory for a full basis; `elements`: number of elements of the structure in time; `smooth`: some law has no
    /// events.
    ///
    /// # Errors
    /// `OutOfMemory`, `StoppedByCaller`.
    pub fn new(
        equations: VariationalEquations<T>,
        elements: usize,
        smooth: bool,
        interrupt: &'s Interrupt<'s>,
    ) -> Result<Self> {
        let states = equations.states();
        interrupt.check()?;
        Ok(Self {
            interrupt,
            step: VariationalStep::new(&equations, smooth)?,
            equations,
            columns: try_vec(states.saturating_mul(states), T::NONE, CONTEXT)?,
            waiting: 0.0,
            pieces: try_vec(elements, TimePiece::default(), CONTEXT)?,
        })
    }

    /// Sets the perturbations to the identity, before a lapse.
    pub fn begin(&mut self) {
        let states = self.equations.states();
        self.columns.fill(T::NONE);
        for i in 0..states {
            self.columns[i * states + i] = T::one();
        }
        self.waiting = 0.0;
    }

    /// Number of states of a perturbation.
    pub fn states(&self) -> usize {
        self.equations.states()
    }

    /// Carries the perturbations through the intervals that are still waiting.
    fn catch_up(&mut self) -> Result<()> {
        let length = core::mem::replace(&mut self.waiting, 0.0);
        if length == 0.0 {
            return Ok(());
        }
        let interval = Interval {
            pieces: &self.pieces,
            length,
            collocation: None,
        };
        self.step
            .carry(&mut self.equations, &interval, &mut self.columns, self.interrupt)
    }
}

impl<T: Number> Variation for PerturbationBasis<'_, T> {
    fn advance(&mut self, interval: &Interval<'_>) -> Result<()> {
        if interval.collocation.is_some() {
            return self
                .step
                .carry(&mut self.equations, interval, &mut self.columns, self.interrupt);
        }
        let same = |(a, b): (&TimePiece, &TimePiece)| a.slope == b.slope && a.memory.to_bits() == b.memory.to_bits();
        if self.waiting > 0.0 && !self.pieces.iter().zip(interval.pieces).all(same) {
            self.catch_up()?;
        }
        if self.waiting == 0.0 {
            self.pieces.copy_from_slice(interval.pieces);
        }
        self.waiting += interval.length;
        Ok(())
    }

    fn couple(&mut self, element: usize, share: f64) -> Result<()> {
        self.catch_up()?;
        let Ok(found) = self.equations.elements.binary_search_by_key(&element, |e| e.source) else {
            return Ok(());
        };
        let e = &self.equations.elements[found];
        let Some(slider) = e.slider else { return Ok(()) };
        let at = 2 * self.equations.order + slider;
        for column in self.columns.chunks_exact_mut(self.equations.states()) {
            let mut w = along(&e.rows[0], column);
            if let Some(normal) = e.rows.get(1)
                && share != 0.0
            {
                w += along(normal, column).scaled(share);
            }
            column[at] = w;
        }
        Ok(())
    }

    fn end(&mut self) -> Result<()> {
        self.catch_up()
    }

    fn graze(&mut self, _: usize, _: Grazing) {}
}

/// Relative motion r·x that the row reads.
fn along<T: Number>(row: &VariationalRow<T>, x: &[T]) -> T {
    row.iter().flatten().fold(T::NONE, |sum, &(dof, a)| sum + a * x[dof])
}
