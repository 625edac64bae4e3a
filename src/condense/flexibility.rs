//! Dynamic flexibility of one harmonic by factorisation: what the contacts and the response degree
//! of freedom feel of contact forces and excitation, with its derivative by frequency.
//!
//! With outputs R (rows of W, then the response degree of freedom) and inputs B (Wᴴ, then F), the
//! table is H = R Z_κ⁻¹ B and ∂H/∂ω = −R Z_κ⁻¹ Z′ Z_κ⁻¹ B, Z′ = −2h²ωM + ihC.

use super::Condensed;
use crate::error::{Result, try_vec};
use crate::linalg::lu::Lu;
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
    lu: Lu<Complex64>,
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
        Ok(Self {
            lu: Lu::new(n)?,
            response,
            columns: try_vec(n.saturating_mul(outputs), Complex64::ZERO, "the contact flexibility")?,
            rows: try_vec(n.saturating_mul(outputs), Complex64::ZERO, "the contact flexibility")?,
            product: try_vec(n, Complex64::ZERO, "the contact flexibility")?,
            table: Table::new(condensed.coordinates())?,
        })
    }

    /// Factors Z_κ of the i-th carried harmonic at `omega`.
    fn factor(&mut self, condensed: &Condensed, i: usize, omega: f64) -> Result<()> {
        let block = &condensed.blocks()[i];
        let n = condensed.ndof();
        let hw = block.number as f64 * omega;
        let z = self.lu.matrix();
        z.fill(Complex64::ZERO);
        block.stiffness.add_to_dense(Complex64::ONE, z);
        block.mass.add_to_dense((-hw * hw).into(), z);
        block.damping.add_to_dense(Complex64::new(0.0, hw), z);
        for (c, row) in block.rows.iter().enumerate() {
            let kappa = condensed.kappa(c, i);
            for &(p, a) in row.iter().flatten() {
                for &(q, b) in row.iter().flatten() {
                    z[q * n + p] += a.conj() * kappa * b;
                }
            }
        }
        self.lu
            .factor()
            .map_err(|e| e.at(format_args!("harmonic {} at angular frequency {omega}", block.number)))
    }

    /// Fills the columns Z⁻¹ B.
    fn solve_columns(&mut self, condensed: &Condensed, i: usize) {
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
        for column in self.columns.chunks_exact_mut(n) {
            self.lu.solve(column);
        }
    }

    /// Evaluates H and ∂H/∂ω of the i-th carried harmonic at `omega`.
    ///
    /// # Errors
    /// `Singular` naming the harmonic, at an undamped resonance that no contact feels.
    pub fn evaluate(&mut self, condensed: &Condensed, i: usize, omega: f64) -> Result<&Table> {
        self.factor(condensed, i, omega)?;
        self.solve_columns(condensed, i);
        let block = &condensed.blocks()[i];
        let n = condensed.ndof();
        let outputs = condensed.coordinates() + 1;
        let response: Row = [self.response.map(|dof| (dof, Complex64::ONE)), None];
        self.rows.fill(Complex64::ZERO);
        let rows = block.rows.iter().chain(core::iter::once(&response));
        for (column, row) in self.rows.chunks_exact_mut(n).zip(rows.clone()) {
            for &(p, a) in row.iter().flatten() {
                column[p] += a;
            }
            self.lu.solve_transposed(column);
        }
        let h = block.number as f64;
        for (j, column) in self.columns.chunks_exact(n).enumerate() {
            self.product.fill(Complex64::ZERO);
            block
                .mass
                .multiply_add((-2.0 * h * h * omega).into(), column, &mut self.product);
            block
                .damping
                .multiply_add(Complex64::new(0.0, h), column, &mut self.product);
            for (k, (row, solved)) in rows.clone().zip(self.rows.chunks_exact(n)).enumerate() {
                let at = j * outputs + k;
                self.table.value[at] = row.iter().flatten().map(|&(p, a)| a * column[p]).sum();
                let slope: Complex64 = solved.iter().zip(&self.product).map(|(a, b)| a * b).sum();
                self.table.slope[at] = -slope;
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
        self.lu.solve(x);
        Ok(())
    }
}
