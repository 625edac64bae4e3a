//! Flexibility table of one harmonic from the modes or poles of its wave.
//!
//! With L and R the rows of outputs and inputs in the modes and d the denominators of [`crate::condense::by_modes::modal_rows`], the table is
//! T′ = L d⁻¹ Rᴴ, the excitation in place of the response among the inputs, and the low-rank term of `condense::low_rank`.

use crate::condense::Condensed;
use crate::condense::by_factors::flexibility::Table;
use crate::condense::by_modes::low_rank::{Coefficients, LowRank, Plain};
use crate::condense::by_modes::modal_rows::ModalRows;
use crate::condense::by_modes::single_contact::{Denominators, SingleContact};
use crate::condense::by_modes::soft_modes::SoftWork;
use crate::condense::by_modes::soft_store::SoftTables;
use crate::condense::by_modes::sum_terms::{Denominator, Frequency, Source};
use crate::condense::by_modes::wave_modes::{NEAR_ALONE, NEAR_RESONANCE};
use crate::error::{Result, boxed, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::complex_columns;
use num_complex::Complex64;
use std::sync::Arc;

const CONTEXT: &str = "the flexibility from modes";

/// Flexibility table of one harmonic from the modes or poles of its wave.
pub struct ModalTable {
    pub(crate) rows: Arc<ModalRows>,
    pub(super) number: f64,
    pub(crate) coefficients: Coefficients,
    /// Product of the excitation with the adjoint shapes, and that of the forces which grow with ω², over ω²; empty
    /// without such forces.
    pub(super) force: Vec<Complex64>,
    pub(super) unbalance: Vec<Complex64>,
    /// Closed sums for one contact without springs, where the harmonic has no more; else `None`.
    single: Option<SingleContact>,
    /// The soft modes by which tables in the range of a sweep are made.
    pub(super) soft: Option<Arc<SoftTables>>,
}

/// Work space for the tables of one structure, one after the other; made when a table first needs it.
#[derive(Default)]
pub struct ModalWork {
    pub(crate) sums: Option<Box<Work>>,
    /// That of soft modes, and whether the last table was made by these.
    pub(super) soft: Option<Box<SoftWork>>,
    pub(super) by_soft: bool,
}

pub(crate) struct Work {
    /// 1/d and −∂d/d², one number per mode.
    pub inverse: Vec<Complex64>,
    slopes: Vec<Complex64>,
    /// Memory for Rᴴ weighted by 1/d or by −∂d/d².
    weighted: Vec<Complex64>,
    /// Table T′ from modes, rows × rows.
    pub plain: Vec<Complex64>,
    /// Slope ∂T′, made when all slopes are first requested.
    d_plain: Vec<Complex64>,
    pub low_rank: LowRank,
    /// Memory: one number per mode, per row, and per row of B.
    pub of_modes: [Vec<Complex64>; 2],
    pub of_rows: [Vec<Complex64>; 4],
    pub of_springs: Vec<Complex64>,
    /// Numbers of the columns of contacts and excitation.
    pub of_columns: Vec<Complex64>,
}

impl ModalWork {
    fn of(&mut self, table: &ModalTable) -> Result<&mut Work> {
        let known = match self.sums.take() {
            Some(known) if known.fits(table) => known,
            _ => boxed(|| Work::new(table))?,
        };
        Ok(self.sums.insert(known))
    }
}

impl Work {
    fn new(table: &ModalTable) -> Result<Self> {
        let (rows, n) = (table.rows.count(), table.rows.terms());
        let zeros = |len| try_vec(len, Complex64::ZERO, CONTEXT);
        Ok(Self {
            inverse: zeros(n)?,
            slopes: zeros(n)?,
            weighted: zeros(rows * (n + 1) + n)?,
            plain: zeros(rows * rows)?,
            d_plain: Vec::new(),
            low_rank: LowRank::new(table.rows.coordinates(), table.coefficients.len())?,
            of_modes: [zeros(n)?, zeros(n)?],
            of_rows: [zeros(rows)?, zeros(rows)?, zeros(rows)?, zeros(rows)?],
            of_springs: zeros(table.coefficients.len())?,
            of_columns: zeros(table.rows.coordinates() + 1)?,
        })
    }

    /// Whether this work space fits a table: waves may differ in the number of their modes.
    fn fits(&self, table: &ModalTable) -> bool {
        self.inverse.len() == table.rows.terms() && self.low_rank.order() == table.coefficients.len()
    }
}

impl ModalTable {
    /// The table of the i-th carried harmonic from the rows of its wave.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new((condensed, i): (&Condensed, usize), rows: Arc<ModalRows>) -> Result<Self> {
        let block = &condensed.blocks()[i];
        let force = rows.forced(&block.load.force)?;
        let unbalance = rows.forced(block.load.unbalance.as_deref().unwrap_or(&[]))?;
        let beside = (rows.springs(), rows.dampers().len());
        let coefficients = Coefficients::new(condensed, i, beside, rows.source().is_damped_by_stiffness())?;
        let single = match rows.source() {
            Source::Modes(modes) if condensed.coordinates() == 1 && rows.count() == 2 && unbalance.is_empty() => {
                Some(SingleContact::new(&modes.values, rows.left(), &force)?)
            }
            _ => None,
        };
        Ok(Self {
            number: block.number as f64,
            coefficients,
            force,
            unbalance,
            single,
            soft: None,
            rows,
        })
    }

    /// Evaluates H at `omega`, and ∂H/∂ω if `slopes`; without these, [`Self::slope_along`] gives the derivative along
    /// a motion. Returns `false` so near a resonance of the structure with stuck contacts that digits would be lost.
    ///
    /// # Errors
    /// `Singular` at an undamped resonance; `StoppedByCaller`.
    pub fn evaluate(
        &self,
        (omega, slopes): (f64, bool),
        work: &mut ModalWork,
        table: &mut Table,
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        if !slopes && let Some(is_clear) = self.evaluate_by_soft(omega, work, table, interrupt)? {
            if is_clear {
                check_finite(&table.value, omega)?;
            }
            return Ok(is_clear);
        }
        self.evaluate_by_sums(omega, slopes, work, table, interrupt)
    }

    /// As [`Self::evaluate`], by sums over all modes.
    pub(super) fn evaluate_by_sums(
        &self,
        omega: f64,
        slopes: bool,
        work: &mut ModalWork,
        table: &mut Table,
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let at = self.denominator(omega);
        let nu = self.number * omega;
        let near = if self.rows.coordinates() == 0 {
            NEAR_ALONE
        } else {
            NEAR_RESONANCE
        };
        let frequency = at.frequency();
        let is_clear = if let Some(single) = &self.single {
            let by = Denominators {
                at: frequency,
                s: at.b,
                d_s: at.d_b,
                nu,
                least: NEAR_RESONANCE,
            };
            let of = &self.coefficients;
            single.evaluate(by, (of.entry(0, frequency.at), of.d_entry(0, frequency.slope)), table)
        } else {
            work.by_soft = false;
            let work = work.of(self)?;
            let is_clear = self
                .rows
                .source()
                .invert((at, nu, near), &mut work.inverse, &mut work.slopes);
            if is_clear {
                interrupt.check_before((4 * work.weighted.len() * self.rows.count()) as u64)?;
                self.sum(work, (at, omega), slopes)?;
                self.complete(work, (frequency, slopes), table, interrupt)?;
            }
            is_clear
        };
        if is_clear {
            check_finite(&table.value, omega)?;
        }
        Ok(is_clear)
    }

    /// The column of the excitation in H and in ∂H/∂ω at `omega`; the others become zero. Returns `false` as
    /// [`Self::evaluate`] does.
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    pub fn evaluate_excited(
        &self,
        omega: f64,
        work: &mut ModalWork,
        table: &mut Table,
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let (rows, coordinates) = (self.rows.count(), self.rows.coordinates());
        let (at, nu) = (self.denominator(omega), self.number * omega);
        let first = coordinates * (coordinates + 1);
        if let Some(is_clear) = self.evaluate_by_soft(omega, work, table, interrupt)? {
            if is_clear {
                table.value[..first].fill(Complex64::ZERO);
                self.slope_along(omega, work, &[], &mut table.slope[first..]);
                check_finite(&table.value[first..], omega)?;
            }
            return Ok(is_clear);
        }
        work.by_soft = false;
        let of_work = work.of(self)?;
        let memory = (&mut of_work.inverse, &mut of_work.slopes);
        let is_clear = self.rows.source().invert((at, nu, NEAR_RESONANCE), memory.0, memory.1);
        if !is_clear {
            return Ok(false);
        }
        if self.coefficients.counts {
            interrupt.check_before((4 * of_work.weighted.len() * rows) as u64)?;
            self.sum(of_work, (at, omega), false)?;
        } else {
            self.excite(of_work, omega, false);
        }
        table.value.fill(Complex64::ZERO);
        table.slope.fill(Complex64::ZERO);
        let column = &mut table.value[first..];
        column.copy_from_slice(&of_work.plain[coordinates * rows..][..=coordinates]);
        let plain = Plain {
            value: &of_work.plain,
            slope: &[],
            rows,
        };
        of_work
            .low_rank
            .add_excited(&self.coefficients, &plain, at.frequency(), column, interrupt)?;
        self.slope_along(omega, work, &[], &mut table.slope[first..]);
        check_finite(&table.value[first..], omega)?;
        Ok(true)
    }

    pub(crate) fn denominator(&self, omega: f64) -> Denominator {
        self.rows.source().denominator(self.number, omega)
    }

    /// Computes T′, and ∂T′ if `slopes`.
    fn sum(&self, work: &mut Work, (at, omega): (Denominator, f64), slopes: bool) -> Result<()> {
        if slopes && work.d_plain.is_empty() {
            work.d_plain = try_vec(work.plain.len(), Complex64::ZERO, CONTEXT)?;
        }
        let slope = slopes.then_some(&mut work.d_plain[..]);
        let soft = self.rows.add_stiff(at, &mut work.plain, slope)?;
        self.rows.add(soft, &work.inverse, &mut work.weighted, &mut work.plain);
        if slopes {
            self.rows.add(soft, &work.slopes, &mut work.weighted, &mut work.d_plain);
        }
        self.excite(work, omega, slopes);
        Ok(())
    }

    /// The excitation seen by the k-th adjoint shape, and its derivative by ω.
    pub(crate) fn excitation(&self, k: usize, omega: f64) -> [Complex64; 2] {
        let part = |of: &[Complex64]| of.get(k).copied().unwrap_or_default();
        let unbalance = part(&self.unbalance);
        [part(&self.force) + unbalance * (omega * omega), 2.0 * omega * unbalance]
    }

    /// Computes the column of the excitation by a sum over all modes.
    fn excite(&self, work: &mut Work, omega: f64, slopes: bool) {
        let (rows, from) = (self.rows.count(), self.rows.coordinates() * self.rows.count());
        let value = &mut work.plain[from..from + rows];
        value.fill(Complex64::ZERO);
        if slopes {
            work.d_plain[from..from + rows].fill(Complex64::ZERO);
        }
        if self.force.is_empty() && self.unbalance.is_empty() {
            return;
        }
        let n = self.rows.terms();
        let (weights, memory) = work.weighted.split_at_mut(n);
        for (k, (weight, inverse)) in weights.iter_mut().zip(&work.inverse).enumerate() {
            *weight = self.excitation(k, omega)[0] * inverse;
        }
        complex_columns::multiply(self.rows.left(), rows, weights, value, &mut memory[..rows]);
        if !slopes {
            return;
        }
        let factors = work.inverse.iter().zip(&work.slopes);
        for (k, (weight, (inverse, d_inverse))) in weights.iter_mut().zip(factors).enumerate() {
            let [force, rate] = self.excitation(k, omega);
            *weight = force * d_inverse + rate * inverse;
        }
        let slope = &mut work.d_plain[from..from + rows];
        complex_columns::multiply(self.rows.left(), rows, weights, slope, &mut memory[..rows]);
    }

    /// Completes the table: T′ plus the low-rank term.
    fn complete(
        &self,
        work: &mut Work,
        (at, slopes): (Frequency, bool),
        table: &mut Table,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let (rows, outputs) = (self.rows.count(), self.rows.coordinates() + 1);
        let of = |plain: &[Complex64], to: &mut [Complex64]| {
            for (to, from) in to.chunks_exact_mut(outputs).zip(plain.chunks_exact(rows)) {
                to.copy_from_slice(&from[..outputs]);
            }
        };
        of(&work.plain, &mut table.value);
        if slopes {
            of(&work.d_plain, &mut table.slope);
        } else {
            table.slope.fill(Complex64::ZERO);
        }
        let plain = Plain {
            value: &work.plain,
            slope: &work.d_plain,
            rows,
        };
        work.low_rank
            .add(&self.coefficients, &plain, (at, slopes), table, interrupt)
    }
}

fn check_finite(values: &[Complex64], omega: f64) -> Result<()> {
    // 0·x is 0 for finite numbers alone; a sum of them has no branches.
    if values.iter().map(|z| 0.0 * z.re + 0.0 * z.im).sum::<f64>() == 0.0 {
        return Ok(());
    }
    crate::error::fail!(
        Singular,
        "the structure resonates without damping at angular frequency {omega}"
    )
}

#[cfg(test)]
#[path = "modal_table_tests.rs"]
mod tests;
