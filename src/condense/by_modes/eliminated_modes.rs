//! Elimination of the stiff modes of a wave at the nodes of a range: the polynomials of [`crate::condense::by_modes::soft_modes`].

use crate::condense::by_factors::flexibility::Table;
use crate::condense::by_modes::modal_table::{ModalTable, ModalWork};
use crate::condense::by_modes::soft_modes::{SOFT_MODES_ENTRIES, SOFT_MODES_NODES, SoftModes, SoftSizes, SoftWork};
use crate::condense::by_modes::soft_store::Plan;
use crate::condense::by_modes::sum_terms::Source;
use crate::error::{Result, Status, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::complex_products;
use crate::linalg::factors::lu::Lu;
use crate::options::Range;
use num_complex::Complex64;
use std::cmp::Ordering;
use std::f64::consts::PI;

const CONTEXT: &str = "the flexibility from soft modes";

/// Frequency over the end of the range from which on a mode is eliminated: the polynomials converge as 18⁻ᵏ then.
/// Kind: fixed.
const BEYOND_RANGE: f64 = 5.0;

/// Least gain for which soft modes are taken, in operations.
/// Kind: tuned; measured on: a finite-element sector with 60 contacts, whose sums of polynomials wait for memory.
const SOFT_MODES_LEAST_GAIN: f64 = 2.0;

/// Modes that a table without elimination sums at least.
/// Kind: fixed.
const SUMMED: usize = 36;

/// Relative error of the columns of a table by soft modes.
/// Kind: rounding.
const SOFT_MODES_AGREE: f64 = 1e-12;

impl Plan {
    /// A plan for the frequencies ω of a range; `None` where elimination does not pay.
    pub fn new(table: &ModalTable, over: Range) -> Option<Self> {
        let rows = &table.rows;
        let Source::Modes(modes) = rows.source() else {
            return None;
        };
        let (order, outputs, n) = (table.coefficients.len(), rows.coordinates() + 1, rows.terms());
        let ends = [over.start, over.stop].map(|omega| table.number * omega);
        let range = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        if !table.coefficients.counts || range.0 <= 0.0 || range.0 >= range.1 || !range.1.is_finite() {
            return None;
        }
        let reach = BEYOND_RANGE * range.1;
        let first = modes.values.partition_point(|mu| mu.abs() * reach * reach <= 1.0);
        let sizes = SoftSizes {
            outputs,
            soft: n - first,
        };
        let factored = |order: usize, columns: usize| order * order * (order / 3 + columns);
        let exact = rows.count() * rows.count() * SUMMED.min(n) + factored(order, outputs);
        let own = sizes.soft * outputs * outputs + factored(sizes.soft, outputs) + SOFT_MODES_NODES * sizes.numbers();
        let of_node = rows.count() * rows.count() * first + factored(order, outputs + sizes.soft);
        if sizes.soft == 0 || SOFT_MODES_LEAST_GAIN * own as f64 > exact as f64 {
            return None;
        }
        Some(Self {
            number: table.number,
            range,
            first,
            tables: SOFT_MODES_NODES * of_node / (exact - own),
        })
    }

    /// Eliminates the stiff modes at the nodes of the range.
    ///
    /// # Errors
    /// `Singular`; `OutOfMemory`; `StoppedByCaller`.
    pub fn eliminate(&self, table: &ModalTable, interrupt: &Interrupt<'_>) -> Result<SoftModes> {
        let sizes = SoftSizes {
            outputs: table.rows.coordinates() + 1,
            soft: table.rows.terms() - self.first,
        };
        let numbers = sizes.numbers();
        let mut values = try_vec(SOFT_MODES_NODES * numbers, Complex64::ZERO, CONTEXT)?;
        let in_block = SOFT_MODES_ENTRIES * SOFT_MODES_NODES;
        let mut terms = try_vec(
            numbers.div_ceil(SOFT_MODES_ENTRIES) * in_block,
            Complex64::ZERO,
            CONTEXT,
        )?;
        let mut work = Elimination::new(table, self.first, sizes)?;
        let angle = |node: usize| PI * (node as f64 + 0.5) / SOFT_MODES_NODES as f64;
        let (middle, half) = (0.5 * (self.range.0 + self.range.1), 0.5 * (self.range.1 - self.range.0));
        for (node, of_node) in values.chunks_exact_mut(numbers).enumerate() {
            interrupt.check()?;
            work.at(table, middle + half * angle(node).cos(), of_node, interrupt)?;
        }
        let mut factors = [[0.0; SOFT_MODES_NODES]; SOFT_MODES_NODES];
        for (k, factors) in factors.iter_mut().enumerate() {
            let weight = if k == 0 { 1.0 } else { 2.0 } / SOFT_MODES_NODES as f64;
            for (node, factor) in factors.iter_mut().enumerate() {
                *factor = weight * (k as f64 * angle(node)).cos();
            }
        }
        for (at, block) in terms.chunks_exact_mut(in_block).enumerate() {
            for (term, factors) in block.chunks_exact_mut(SOFT_MODES_ENTRIES).zip(&factors) {
                for (of_node, factor) in values.chunks_exact(numbers).zip(factors) {
                    for (term, value) in term.iter_mut().zip(&of_node[at * SOFT_MODES_ENTRIES..]) {
                        *term += value * factor;
                    }
                }
            }
        }
        Ok(SoftModes {
            first: self.first,
            range: self.range,
            sizes,
            terms,
        })
    }

    /// Eliminates the stiff modes; `None` where tables at the ends of the range or at `omega` within it do not agree with sums over all
    /// modes.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn checked(
        &self,
        table: &ModalTable,
        omega: f64,
        work: &mut ModalWork,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<SoftModes>> {
        let Some(eliminated) = regular(self.eliminate(table, interrupt))? else {
            return Ok(None);
        };
        let outputs = eliminated.sizes.outputs;
        let [mut exact, mut found] = [Table::new(outputs - 1)?, Table::new(outputs - 1)?];
        let mut soft = SoftWork::new(eliminated.sizes)?;
        for omega in [self.range.0 / table.number, omega, self.range.1 / table.number] {
            let sums = table.evaluate_by_sums(omega, false, work, &mut exact, interrupt);
            if !regular(sums)?.unwrap_or(false) {
                continue;
            }
            let denominators = table.soft_denominators(self.first, omega);
            let made = eliminated.evaluate(
                table.number,
                table.number * omega,
                denominators,
                &mut soft,
                &mut found.value,
                interrupt,
            );
            let agrees = regular(made)?.is_some() && agree(&exact.value, &found.value, outputs);
            if !agrees {
                return Ok(None);
            }
        }
        Ok(Some(eliminated))
    }
}

/// The result, `None` where a matrix is singular.
fn regular<T>(result: Result<T>) -> Result<Option<T>> {
    match result {
        Err(e) if e.status == Status::Singular => Ok(None),
        other => other.map(Some),
    }
}

/// Whether the columns of two tables agree.
fn agree(exact: &[Complex64], found: &[Complex64], outputs: usize) -> bool {
    let size = |z: &[Complex64]| z.iter().map(Complex64::norm_sqr).sum::<f64>();
    exact
        .chunks_exact(outputs)
        .zip(found.chunks_exact(outputs))
        .all(|(a, b)| {
            let off: f64 = a.iter().zip(b).map(|(a, b)| (a - b).norm_sqr()).sum();
            off <= SOFT_MODES_AGREE * SOFT_MODES_AGREE * size(a)
        })
}

/// Memory of an elimination.
struct Elimination {
    first: usize,
    sizes: SoftSizes,
    /// Flexibility of the stiff modes between all rows, the excitation in place of the response; their 1/d; and memory of the sum.
    stiff: Vec<Complex64>,
    inverse: Vec<Complex64>,
    weighted: Vec<Complex64>,
    lu: Lu<Complex64>,
    /// Motions of the rows of B under contacts, excitation and soft modes, and the forces by them.
    inner: Vec<Complex64>,
    force: Vec<Complex64>,
    /// Rows of B in the adjoint soft modes; and products with them.
    adjoint: Vec<Complex64>,
    products: Vec<Complex64>,
}

impl Elimination {
    fn new(table: &ModalTable, first: usize, sizes: SoftSizes) -> Result<Self> {
        let (rows, of) = (&table.rows, &table.coefficients);
        let (order, columns) = (of.len(), sizes.outputs + sizes.soft);
        let zeros = |len| try_vec(len, Complex64::ZERO, CONTEXT);
        let mut adjoint = zeros(order * sizes.soft)?;
        let shapes = rows.adjoint().chunks_exact(rows.count()).skip(first);
        for (to, from) in adjoint.chunks_exact_mut(order).zip(shapes) {
            of.rows_of(from, to);
        }
        Ok(Self {
            first,
            sizes,
            stiff: zeros(rows.count() * rows.count())?,
            inverse: zeros(first)?,
            weighted: zeros(rows.count() * first)?,
            lu: Lu::new(order, columns)?,
            inner: zeros(order * columns)?,
            force: zeros(order * columns)?,
            adjoint,
            products: zeros(sizes.soft * columns)?,
        })
    }

    /// Fills in Q, V, W and S − d_s at ν.
    fn at(&mut self, table: &ModalTable, nu: f64, to: &mut [Complex64], interrupt: &Interrupt<'_>) -> Result<()> {
        let (rows, of) = (&table.rows, &table.coefficients);
        let (SoftSizes { outputs, soft }, order, count) = (self.sizes, of.len(), rows.count());
        let omega = nu / table.number;
        let at = table.denominator(omega);
        let e = |b: usize| of.entry(b, at.frequency().at);
        self.sum_stiff(table, omega);
        for (q, to) in self.lu.matrix().chunks_exact_mut(order).enumerate() {
            of.rows_of(&self.stiff[of.row_of(q) * count..][..count], to);
            for entry in to.iter_mut() {
                *entry *= -e(q);
            }
            to[q] += 1.0;
        }
        self.lu.factor(interrupt)?;
        let soft_rows = &rows.left()[self.first * count..];
        let seen = |k: usize| match k.checked_sub(outputs) {
            None => &self.stiff[k * count..(k + 1) * count],
            Some(mode) => &soft_rows[mode * count..(mode + 1) * count],
        };
        for (k, inner) in self.inner.chunks_exact_mut(order).enumerate() {
            of.rows_of(seen(k), inner);
        }
        self.lu.solve_columns(&mut self.inner, false, interrupt)?;
        let columns = self.force.chunks_exact_mut(order).zip(self.inner.chunks_exact(order));
        for (force, inner) in columns {
            for (b, (force, x)) in force.iter_mut().zip(inner).enumerate() {
                *force = e(b) * x;
            }
        }
        complex_products::multiply_adjoint(&self.adjoint, &self.force, &mut self.products, order);
        let (of_motions, of_modes) = to.split_at_mut(outputs * (outputs + soft));
        let columns = self.inner.chunks_exact(order).zip(self.force.chunks_exact(order));
        for (k, (to, (inner, force))) in of_motions.chunks_exact_mut(outputs).zip(columns).enumerate() {
            to[..outputs - 1].copy_from_slice(&inner[..outputs - 1]);
            let along = force.iter().enumerate();
            let along: Complex64 = along
                .map(|(b, f)| self.stiff[of.row_of(b) * count + outputs - 1] * f)
                .sum();
            to[outputs - 1] = seen(k)[outputs - 1] + along;
        }
        let products = self.products.chunks_exact(soft);
        for (k, (to, products)) in of_modes.chunks_exact_mut(soft).zip(products).enumerate() {
            for (mode, (to, product)) in to.iter_mut().zip(products).enumerate() {
                *to = match (k + 1).cmp(&outputs) {
                    Ordering::Less => rows.adjoint()[(self.first + mode) * count + k].conj() + product,
                    Ordering::Equal => table.excitation(self.first + mode, omega)[0] + product,
                    Ordering::Greater => -product,
                };
            }
        }
        Ok(())
    }

    /// Sums the stiff modes, with the column of the excitation.
    fn sum_stiff(&mut self, table: &ModalTable, omega: f64) {
        let (rows, at) = (&table.rows, table.denominator(omega));
        for (k, inverse) in self.inverse.iter_mut().enumerate() {
            *inverse = (at.a - at.b * rows.source().value(k)).inv();
        }
        self.stiff.fill(Complex64::ZERO);
        rows.add(0, &self.inverse, &mut self.weighted, &mut self.stiff);
        let count = rows.count();
        let column = &mut self.stiff[(self.sizes.outputs - 1) * count..][..count];
        column.fill(Complex64::ZERO);
        for (k, (shape, inverse)) in rows.left().chunks_exact(count).zip(&self.inverse).enumerate() {
            let weight = table.excitation(k, omega)[0] * inverse;
            for (to, shape) in column.iter_mut().zip(shape) {
                *to += shape * weight;
            }
        }
    }
}
