//! Dynamic flexibility of one harmonic by factorisation: what the contacts and the response degree
//! of freedom feel of contact forces and excitation, with its derivative by frequency.
//!
//! With outputs R (rows of W, then the response degree of freedom) and inputs B (Wᴴ, then F), the
//! table is H = R Z_κ⁻¹ B and ∂H/∂ω = −R Z_κ⁻¹ Z′ Z_κ⁻¹ B, Z′ = −2h²ωM + ihC.

use super::{Condensed, HarmonicBlock};
use crate::error::{Result, fail, try_push, try_vec};
use crate::linalg::factor::Factor;
use crate::linalg::sparse::Csc;
use crate::model::spring::Row;
use num_complex::Complex64;

/// H and ∂H/∂ω of one harmonic: (coordinates + 1)² tables, column-major. Column j < coordinates is
/// the unit force of contact j, the last one the excitation; the last row is the response degree
/// of freedom.
#[derive(Clone, Debug)]
pub struct Table {
    /// H
    pub value: Vec<Complex64>,
    /// ∂H/∂ω
    pub slope: Vec<Complex64>,
}

impl Table {
    /// Memory for `coordinates` contacts.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(coordinates: usize) -> Result<Self> {
        let size = (coordinates + 1).saturating_mul(coordinates + 1);
        Ok(Self {
            value: try_vec(size, Complex64::ZERO, "the contact flexibility")?,
            slope: try_vec(size, Complex64::ZERO, "the contact flexibility")?,
        })
    }
}

/// Memory for factorising Z_κ of one harmonic after the other.
pub struct Workspace {
    factor: Factor,
    /// Z_κ per harmonic.
    z: Vec<Csc>,
    response: Option<usize>,
    /// Z⁻¹ B, ndof rows.
    columns: Vec<Complex64>,
    /// Z⁻ᵀ Rᵀ, ndof rows.
    rows: Vec<Complex64>,
    product: Vec<Complex64>,
    table: Table,
}

impl Workspace {
    /// Memory for a condensed model and its response degree of freedom.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(condensed: &Condensed, response: Option<usize>) -> Result<Self> {
        let n = condensed.ndof();
        let outputs = condensed.coordinates() + 1;
        let mut z = Vec::new();
        for block in condensed.blocks() {
            try_push(&mut z, block.reference.clone(), "the dynamic stiffness")?;
        }
        let Some(first) = condensed.blocks().first() else {
            return fail!(Internal, "no harmonic is carried");
        };
        Ok(Self {
            factor: Factor::new(&first.reference, outputs)?,
            z,
            response,
            columns: try_vec(n.saturating_mul(outputs), Complex64::ZERO, "the contact flexibility")?,
            rows: Vec::new(),
            product: try_vec(n, Complex64::ZERO, "the contact flexibility")?,
            table: Table::new(condensed.coordinates())?,
        })
    }

    /// Factors Z_κ of the i-th carried harmonic at `omega`.
    fn factor(&mut self, condensed: &Condensed, i: usize, omega: f64) -> Result<()> {
        self.factor_at(condensed, i, omega.into())
    }

    /// The same at a complex frequency.
    fn factor_at(&mut self, condensed: &Condensed, i: usize, omega: Complex64) -> Result<()> {
        let block = &condensed.blocks()[i];
        let hw = block.number as f64 * omega;
        let (ihw, hw2) = (Complex64::I * hw, hw * hw);
        let z = &mut self.z[i];
        let terms = block.reference.values.iter().zip(&block.damping).zip(&block.mass);
        for (z, ((k, c), m)) in z.values.iter_mut().zip(terms) {
            *z = k + ihw * c - hw2 * m;
        }
        self.factor.factor(z).map_err(|e| at_harmonic(e, block, omega.re))
    }

    /// right ← Z⁻¹ Z′ right and left ← Z⁻ᵀ Z′ᵀ left at a complex frequency, each scaled to size 1.
    pub(super) fn inverse_step(
        &mut self,
        condensed: &Condensed,
        i: usize,
        omega: Complex64,
        left: &mut [Complex64],
        right: &mut [Complex64],
    ) -> Result<()> {
        self.factor_at(condensed, i, omega)?;
        let block = &condensed.blocks()[i];
        let h = block.number as f64;
        let pattern = &block.reference;
        for (v, transposed) in [(right, false), (left, true)] {
            self.product.fill(Complex64::ZERO);
            for j in 0..v.len() {
                for at in pattern.col_ptr[j]..pattern.col_ptr[j + 1] {
                    let k = pattern.row_idx[at];
                    let (to, from) = if transposed { (j, k) } else { (k, j) };
                    self.product[to] += entry(block, at, h, omega, true) * v[from];
                }
            }
            v.copy_from_slice(&self.product);
            self.factor.solve(v, transposed)?;
            let size = v.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
            for z in v.iter_mut() {
                *z /= size;
            }
        }
        Ok(())
    }

    /// Fills the columns Z⁻¹ B.
    fn solve_columns(&mut self, condensed: &Condensed, i: usize, omega: f64) -> Result<()> {
        let block = &condensed.blocks()[i];
        let n = condensed.ndof();
        let coordinates = condensed.coordinates();
        self.columns.fill(Complex64::ZERO);
        for (column, row) in self.columns.chunks_exact_mut(n).zip(&block.rows) {
            for &(p, a) in row.iter().flatten() {
                column[p] += a.conj();
            }
        }
        self.columns[coordinates * n..].copy_from_slice(&block.force);
        self.factor
            .solve(&mut self.columns, false)
            .map_err(|e| at_harmonic(e, block, omega))
    }

    /// Evaluates H of the i-th carried harmonic at `omega`, and ∂H/∂ω where `slopes` are wanted.
    ///
    /// # Errors
    /// `Singular` naming the harmonic, at an undamped resonance that no contact feels.
    pub fn evaluate(&mut self, condensed: &Condensed, i: usize, omega: f64, slopes: bool) -> Result<&Table> {
        self.factor(condensed, i, omega)?;
        self.solve_columns(condensed, i, omega)?;
        let block = &condensed.blocks()[i];
        let n = condensed.ndof();
        let outputs = condensed.coordinates() + 1;
        let response: Row = [self.response.map(|dof| (dof, Complex64::ONE)), None];
        let rows = block.rows.iter().chain(core::iter::once(&response));
        for (column, table) in self
            .columns
            .chunks_exact(n)
            .zip(self.table.value.chunks_exact_mut(outputs))
        {
            for (value, row) in table.iter_mut().zip(rows.clone()) {
                *value = row.iter().flatten().map(|&(p, a)| a * column[p]).sum();
            }
        }
        if !slopes {
            self.table.slope.fill(Complex64::ZERO);
            return Ok(&self.table);
        }
        if self.rows.is_empty() {
            self.rows = try_vec(self.columns.len(), Complex64::ZERO, "the contact flexibility")?;
        }
        self.rows.fill(Complex64::ZERO);
        for (column, row) in self.rows.chunks_exact_mut(n).zip(rows) {
            for &(p, a) in row.iter().flatten() {
                column[p] += a;
            }
        }
        self.factor
            .solve(&mut self.rows, true)
            .map_err(|e| at_harmonic(e, block, omega))?;
        let h = block.number as f64;
        for (column, table) in self
            .columns
            .chunks_exact(n)
            .zip(self.table.slope.chunks_exact_mut(outputs))
        {
            self.product.fill(Complex64::ZERO);
            let pattern = &block.reference;
            for (j, &x) in column.iter().enumerate() {
                for at in pattern.col_ptr[j]..pattern.col_ptr[j + 1] {
                    let (c, m) = (block.damping[at], block.mass[at]);
                    let slope = Complex64::new(-h * c.im, h * c.re) - 2.0 * h * h * omega * m;
                    self.product[pattern.row_idx[at]] += slope * x;
                }
            }
            for (slope, solved) in table.iter_mut().zip(self.rows.chunks_exact(n)) {
                let sum: Complex64 = solved.iter().zip(&self.product).map(|(a, b)| a * b).sum();
                *slope = -sum;
            }
        }
        Ok(&self.table)
    }

    /// Largest motion of a degree of freedom under the excitation, after [`Self::evaluate`].
    #[must_use]
    pub fn largest_motion(&self) -> f64 {
        let n = self.product.len();
        let excited = &self.columns[self.columns.len() - n..];
        excited.iter().fold(0.0, |m, z| m.max(z.norm()))
    }

    /// Motion of all degrees of freedom in the i-th carried harmonic, x = Z_κ⁻¹(F − Wᴴ w), where
    /// `contact_force` holds w = f − κ y per coordinate.
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    pub fn recover(
        &mut self,
        condensed: &Condensed,
        i: usize,
        omega: f64,
        contact_force: &[Complex64],
        x: &mut [Complex64],
    ) -> Result<()> {
        self.factor(condensed, i, omega)?;
        let block = &condensed.blocks()[i];
        x.copy_from_slice(&block.force);
        for (row, w) in block.rows.iter().zip(contact_force) {
            for &(p, a) in row.iter().flatten() {
                x[p] -= a.conj() * w;
            }
        }
        self.factor.solve(x, false).map_err(|e| at_harmonic(e, block, omega))
    }
}

/// left·Z right, or left·(∂Z/∂ω) right, at a complex frequency; nothing is conjugated.
pub(super) fn product(
    condensed: &Condensed,
    i: usize,
    omega: Complex64,
    left: &[Complex64],
    right: &[Complex64],
    slope: bool,
) -> Complex64 {
    let block = &condensed.blocks()[i];
    let h = block.number as f64;
    let mut sum = Complex64::ZERO;
    let pattern = &block.reference;
    for (j, x) in right.iter().enumerate() {
        for at in pattern.col_ptr[j]..pattern.col_ptr[j + 1] {
            sum += left[pattern.row_idx[at]] * entry(block, at, h, omega, slope) * x;
        }
    }
    sum
}

/// An entry of Z_κ or of ∂Z/∂ω.
fn entry(block: &HarmonicBlock, at: usize, h: f64, omega: Complex64, slope: bool) -> Complex64 {
    let (c, m) = (block.damping[at], block.mass[at]);
    if slope {
        Complex64::I * h * c - 2.0 * h * h * omega * m
    } else {
        block.reference.values[at] + Complex64::I * h * omega * c - h * h * omega * omega * m
    }
}

fn at_harmonic(e: crate::error::Error, block: &HarmonicBlock, omega: f64) -> crate::error::Error {
    e.at(format_args!("harmonic {} at angular frequency {omega}", block.number))
}
