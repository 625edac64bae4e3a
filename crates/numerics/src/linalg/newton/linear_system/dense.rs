//! The dense backend: all of J, factored by LU with the columns of the identity eliminated.

use crate::error::{Result, Status, boxed, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::add_product;
use crate::linalg::factors::small_lu;
use crate::linalg::newton::bordered::{Bordered, Parts};
use crate::linalg::newton::linear_system::continuum::Completed;
use crate::linalg::newton::linear_system::{Border, Jacobian, LinearSystem};
use num_complex::Complex64;

/// Unknowns from which factors by terms of low rank are tried.
/// Kind: tuned; measured on: matrices of 80 and 96 unknowns, and one slider with 64 odd harmonics.
const NEAR_FROM: usize = 80;

/// Largest relative error that the refinement of a solution by such factors leaves: rounding, as behind factors of the whole matrix.
/// Kind: rounding.
const REFINED: f64 = 1e-12;

/// A bordered system with a dense matrix.
pub struct DenseSystem {
    factors: Bordered,
    matrix: Vec<f64>,
    active: Vec<bool>,
    column: Vec<f64>,
    /// Matrix and column of the last two updates, one after the other, the newest first, where the matrix is small.
    before: [Vec<f64>; 2],
    scales: (f64, f64),
    row: Vec<f64>,
    scaled: Vec<f64>,
    completed: Option<Box<Completed>>,
    /// Diagonal of factors by terms of low rank, and whether the matrix is that which was factored last.
    diagonal: Vec<Complex64>,
    is_current: bool,
}

impl DenseSystem {
    /// Memory for `n` unknowns and one parameter.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize) -> Result<Self> {
        const CONTEXT: &str = "the linear system";
        let pairs = if n >= NEAR_FROM && n.is_multiple_of(2) {
            n / 2
        } else {
            0
        };
        let kept = if n < small_lu::SMALL_LU_LARGEST { n * (n + 1) } else { 0 };
        Ok(Self {
            factors: Bordered::new(n)?,
            matrix: try_vec(n.saturating_mul(n), 0.0, CONTEXT)?,
            active: try_vec(n, true, CONTEXT)?,
            column: try_vec(n, 0.0, CONTEXT)?,
            before: [try_vec(kept, 0.0, CONTEXT)?, try_vec(kept, 0.0, CONTEXT)?],
            scales: (1.0, 1.0),
            row: try_vec(n + 1, 0.0, CONTEXT)?,
            scaled: try_vec(n + 1, 0.0, CONTEXT)?,
            completed: None,
            diagonal: try_vec(pairs, Complex64::ZERO, CONTEXT)?,
            is_current: false,
        })
    }

    /// Memory of the matrix and of the marks of its columns, for a caller that fills in a block itself.
    pub(super) fn memory(&mut self) -> (&mut [f64], &mut [bool]) {
        (&mut self.matrix, &mut self.active)
    }

    /// Sets column, units and row of the border, for a caller that fills in a block itself.
    pub(super) fn set_border(
        &mut self,
        column: impl Iterator<Item = f64>,
        scales: (f64, f64),
        row: impl Iterator<Item = f64>,
    ) {
        for (to, from) in self.column.iter_mut().zip(column) {
            *to = from;
        }
        for (to, from) in self.row.iter_mut().zip(row) {
            *to = from;
        }
        self.scales = scales;
    }

    /// Unit of the unknowns, by which their columns are scaled.
    pub(super) fn unit(&self) -> f64 {
        self.scales.0
    }

    /// Factors the matrix in memory.
    ///
    /// # Errors
    /// `Singular`; `StoppedByCaller`.
    pub(super) fn factor_memory(&mut self, interrupt: &Interrupt<'_>) -> Result<()> {
        self.factors.factor(
            &self.matrix,
            &self.column,
            &self.active,
            self.scales,
            &self.row,
            interrupt,
        )
    }

    /// Factors the matrix by terms of low rank where that is quicker.
    fn factor_near(&mut self, jacobian: &mut dyn Jacobian, interrupt: &Interrupt<'_>) -> Result<bool> {
        if self.diagonal.is_empty() || self.active.contains(&false) || !jacobian.near_diagonal(&mut self.diagonal) {
            return Ok(false);
        }
        let matrix = Parts {
            jacobian: &self.matrix,
            column: &self.column,
            active: &self.active,
            scales: self.scales,
            row: &self.row,
        };
        self.factors.factor_near(&matrix, &self.diagonal, interrupt)
    }

    /// Solves in place with factors by terms of low rank, refined by the matrix, or with factors of the whole matrix instead.
    fn solve_near(&mut self, b: &mut [f64], interrupt: &Interrupt<'_>) -> Result<bool> {
        if !self.is_current {
            return Ok(false);
        }
        let matrix = Parts {
            jacobian: &self.matrix,
            column: &self.column,
            active: &self.active,
            scales: self.scales,
            row: &self.row,
        };
        if self.factors.refine(&matrix, REFINED, b) {
            return Ok(true);
        }
        match self.factor_memory(interrupt) {
            Err(e) if e.status == Status::Singular => return Ok(false),
            factored => factored?,
        }
        self.factors.solve(b);
        Ok(true)
    }

    /// Solves in place with the factors.
    pub(super) fn solve_by_factors(&mut self, b: &mut [f64]) {
        self.factors.solve(b);
    }
}

impl LinearSystem for DenseSystem {
    fn update(&mut self, jacobian: &mut dyn Jacobian, border: Border<'_>, interrupt: &Interrupt<'_>) -> Result<()> {
        interrupt.check()?;
        self.is_current = false;
        if !self.before[0].is_empty() {
            self.before.swap(0, 1);
            let (matrix, column) = self.before[0].split_at_mut(self.matrix.len());
            matrix.copy_from_slice(&self.matrix);
            column.copy_from_slice(&self.column);
        }
        jacobian.fill(&mut self.matrix, &mut self.active)?;
        self.column.copy_from_slice(border.column);
        self.row.copy_from_slice(border.row);
        self.scales = border.scales;
        Ok(())
    }

    fn factor(&mut self, jacobian: &mut dyn Jacobian, interrupt: &Interrupt<'_>) -> Result<()> {
        self.is_current = true;
        let has_continuum = jacobian.has_continuum();
        if !has_continuum && self.factor_near(jacobian, interrupt)? {
            return Ok(());
        }
        let factored = self.factor_memory(interrupt);
        if !has_continuum {
            return factored;
        }
        let factored = match factored {
            Err(e) if e.status != Status::Singular => return Err(e),
            factored => factored.is_ok(),
        };
        let mut completed = match self.completed.take() {
            Some(known) => known,
            None => boxed(|| Ok(Completed::default()))?,
        };
        let matrix = Parts {
            jacobian: &self.matrix,
            column: &self.column,
            active: &self.active,
            scales: self.scales,
            row: &self.row,
        };
        let outcome = completed.factor(&mut self.factors, &matrix, factored, interrupt);
        self.completed = Some(completed);
        outcome
    }

    fn solve(
        &mut self,
        _jacobian: &mut dyn Jacobian,
        _tolerance: f64,
        b: &mut [f64],
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        interrupt.check()?;
        interrupt.count((b.len() * b.len() / 2) as u64);
        if self.factors.is_near() {
            return self.solve_near(b, interrupt);
        }
        self.factors.solve(b);
        Ok(true)
    }

    fn apply(&mut self, _jacobian: &mut dyn Jacobian, x: &[f64], out: &mut [f64]) -> Result<()> {
        let n = self.column.len();
        for (s, x) in self.scaled.iter_mut().zip(x) {
            *s = self.scales.0 * x;
        }
        for (out, c) in out.iter_mut().zip(&self.column) {
            *out = c * (self.scales.1 * x[n]);
        }
        add_product(1.0, &self.matrix, &self.scaled[..n], &mut out[..n]);
        out[n] = self.row.iter().zip(x).map(|(t, x)| t * x).sum();
        Ok(())
    }

    fn apply_last(&mut self, [w, w1, w2]: [f64; 3], x: &[f64], out: &mut [f64]) -> bool {
        if self.before[0].is_empty() {
            return false;
        }
        let n = self.column.len();
        for (s, x) in self.scaled.iter_mut().zip(x) {
            *s = self.scales.0 * x;
        }
        self.scaled[n] = self.scales.1 * x[n];
        out.fill(0.0);
        let (unknowns, parameter) = self.scaled.split_at(n);
        add_product(w, &self.matrix, unknowns, &mut out[..n]);
        add_product(w, &self.column, parameter, &mut out[..n]);
        for (weight, kept) in [w1, w2].into_iter().zip(&self.before) {
            add_product(weight, kept, &self.scaled, &mut out[..n]);
        }
        true
    }

    fn solve_by_earlier_factors(
        &mut self,
        _jacobian: &mut dyn Jacobian,
        tolerance: f64,
        b: &mut [f64],
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        interrupt.check()?;
        let matrix = Parts {
            jacobian: &self.matrix,
            column: &self.column,
            active: &self.active,
            scales: self.scales,
            row: &self.row,
        };
        Ok(self.factors.refine(&matrix, tolerance, b))
    }

    fn is_positive(&self) -> bool {
        self.factors.is_positive()
    }
}
