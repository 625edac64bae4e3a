//! Tables of a sweep by soft modes, which harmonics of all condensed models share.

use crate::condense::by_factors::flexibility::Table;
use crate::condense::by_modes::modal_table::{ModalTable, ModalWork};
use crate::condense::by_modes::soft_modes::{SoftModes, SoftWork};
use crate::condense::by_modes::soft_store::{Plan, SoftTables};
use crate::condense::by_modes::sum_terms::Source;
use crate::error::{Result, boxed, try_copy, try_push};
use crate::interrupt::Interrupt;
use crate::options::Range;
use num_complex::Complex64;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock, PoisonError};

const CONTEXT: &str = "the flexibility from soft modes";

impl ModalTable {
    /// Plans soft modes for the frequencies of a sweep.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn over(mut self, range: Range) -> Result<Self> {
        let (Source::Modes(modes), Some(plan)) = (self.rows.source(), Plan::new(&self, range)) else {
            return Ok(self);
        };
        let mut known = modes.soft.0.lock().unwrap_or_else(PoisonError::into_inner);
        let is_known = |tables: &&Arc<SoftTables>| tables.plan == plan && self.has_numbers_of(tables);
        let found = if let Some(found) = known.iter().find(is_known) {
            Arc::clone(found)
        } else {
            let mut excitations = try_copy(&self.force, CONTEXT)?;
            for u in &self.unbalance {
                try_push(&mut excitations, *u, CONTEXT)?;
            }
            let made = Arc::new(SoftTables {
                plan,
                left: self.rows.shared_left(),
                excitations,
                left_out: AtomicUsize::new(plan.tables),
                made: OnceLock::new(),
            });
            try_push(&mut known, Arc::clone(&made), CONTEXT)?;
            made
        };
        drop(known);
        self.soft = Some(found);
        Ok(self)
    }

    /// The soft modes, where they were made.
    pub(super) fn soft_modes(&self) -> Option<&SoftModes> {
        self.soft.as_ref()?.made.get()?.as_ref()
    }

    /// Index of the work space for the table of the i-th harmonic: soft modes have one for each, sums one for all unless kept.
    pub fn own_work(&self, keeps: bool, i: usize) -> usize {
        if keeps || self.soft_modes().is_some() { i } else { 0 }
    }

    /// Counts a table at `omega`, and makes soft modes where they have paid.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn count(&self, omega: f64, work: &mut ModalWork, interrupt: &Interrupt<'_>) -> Result<()> {
        let Some(soft) = &self.soft else {
            return Ok(());
        };
        if soft.made.get().is_some() || !soft.plan.covers(self.number * omega) {
            return Ok(());
        }
        let left = soft.left_out.load(Ordering::Relaxed);
        if left > 0 {
            soft.left_out.store(left - 1, Ordering::Relaxed);
            return Ok(());
        }
        let made = soft.plan.checked(self, omega, work, interrupt)?;
        soft.made.get_or_init(|| made);
        Ok(())
    }

    /// The table at `omega` by soft modes, without slopes: `false` near a resonance, where digits would be lost; `None` where these
    /// modes do not serve.
    ///
    /// # Errors
    /// Those of [`Self::evaluate`].
    pub(super) fn evaluate_by_soft(
        &self,
        omega: f64,
        work: &mut ModalWork,
        table: &mut Table,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<bool>> {
        let nu = self.number * omega;
        let (Some(soft), Source::Modes(modes)) = (self.soft_modes(), self.rows.source()) else {
            return Ok(None);
        };
        if !soft.covers(nu) {
            return Ok(None);
        }
        let at = self.denominator(omega);
        if !modes.is_clear(soft.first, nu, at.a, at.b) {
            return Ok(Some(false));
        }
        let known = match work.soft.take() {
            Some(known) if known.fits(soft) => known,
            _ => boxed(|| SoftWork::new(soft.sizes))?,
        };
        let own = work.soft.insert(known);
        let denominators = self.soft_denominators(soft.first, omega);
        soft.evaluate(self.number, nu, denominators, own, &mut table.value, interrupt)?;
        table.slope.fill(Complex64::ZERO);
        work.by_soft = true;
        Ok(Some(true))
    }

    /// Denominators d of the soft modes at `omega`.
    pub(super) fn soft_denominators(&self, first: usize, omega: f64) -> impl Iterator<Item = Complex64> {
        let (at, source) = (self.denominator(omega), self.rows.source());
        (first..source.len()).map(move |k| at.a - at.b * source.value(k))
    }

    /// ∂x/∂ω by soft modes, as [`Self::slope_along`], after [`Self::evaluate_by_soft`].
    pub(super) fn slope_by_soft(&self, omega: f64, work: &mut ModalWork, w: &[Complex64], change: &mut [Complex64]) {
        if let (Some(soft), Some(work)) = (self.soft_modes(), work.soft.as_deref_mut()) {
            let (at, source) = (self.denominator(omega), self.rows.source());
            let slopes = (soft.first..source.len()).map(|k| at.d_a - at.d_b * source.value(k));
            soft.slope_along(slopes, w, work, change);
        }
    }

    /// Whether soft modes were made for a harmonic with the same numbers.
    fn has_numbers_of(&self, soft: &SoftTables) -> bool {
        let left = self.rows.shared_left();
        let excitations = self.force.iter().chain(&self.unbalance);
        soft.excitations.len() == self.force.len() + self.unbalance.len()
            && soft.excitations.iter().eq(excitations)
            && (Arc::ptr_eq(&soft.left, &left) || soft.left == left)
    }
}

#[cfg(test)]
#[path = "soft_tables_tests.rs"]
mod tests;
