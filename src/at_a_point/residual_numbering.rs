//! The residual of harmonic balance in the numbering of the caller.
//!
//! Rows of independent degrees of freedom hold the balance of forces; those of the others, fixed or on the right face
//! of a sector, hold x − T q = 0, the motion that the independent ones impose.

use crate::error::{Result, try_vec};
use crate::model::Model;
use num_complex::Complex64;

const CONTEXT: &str = "the residual of the independent degrees of freedom";

/// Receivers of a residual, its Jacobian and its derivative by ω, see
/// [`forced_residual`](crate::at_a_point::harmonic_residual::forced_residual).
pub type ResidualArrays<'a> = (&'a mut [Complex64], Option<&'a mut [f64]>, Option<&'a mut [Complex64]>);

/// Memory for the residual of the independent degrees of freedom.
pub(crate) struct Numbering {
    x: Vec<Complex64>,
    r: Vec<Complex64>,
    jacobian: Option<Vec<f64>>,
    d_omega: Option<Vec<Complex64>>,
}

impl Numbering {
    /// Memory for harmonics 0 ..= `highest`; `None` where all degrees of freedom are independent.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(model: &Model, highest: usize, jacobian: bool, d_omega: bool) -> Result<Option<Self>> {
        let degrees = model.structure().degrees();
        if degrees.is_identity() {
            return Ok(None);
        }
        let size = (highest + 1).saturating_mul(degrees.independent());
        let order = size.saturating_mul(2);
        let zeros = |n| try_vec(n, Complex64::ZERO, CONTEXT);
        Ok(Some(Self {
            x: zeros(size)?,
            r: zeros(size)?,
            jacobian: jacobian
                .then(|| try_vec(order.saturating_mul(order), 0.0, CONTEXT))
                .transpose()?,
            d_omega: d_omega.then(|| zeros(size)).transpose()?,
        }))
    }

    /// Evaluates the residual of the independent degrees of freedom by `evaluate`, and writes the residual of all
    /// degrees of freedom.
    ///
    /// # Errors
    /// Those of `evaluate`, which leaves the arrays of the caller untouched.
    pub fn residual(
        mut self,
        model: &Model,
        x: &[Complex64],
        (r, jacobian, d_omega): ResidualArrays<'_>,
        evaluate: impl FnOnce(&[Complex64], ResidualArrays<'_>) -> Result<()>,
    ) -> Result<()> {
        let degrees = model.structure().degrees();
        let (n, given) = (degrees.independent(), degrees.given());
        for (all, own) in x.chunks_exact(given).zip(self.x.chunks_exact_mut(n)) {
            degrees.restrict(all, own);
        }
        let arrays = (
            &mut self.r[..],
            self.jacobian.as_deref_mut(),
            self.d_omega.as_deref_mut(),
        );
        evaluate(&self.x, arrays)?;
        let origin = |i: usize| i / n * given + degrees.origin(i % n);
        r.copy_from_slice(x);
        for (h, r) in r.chunks_exact_mut(given).enumerate() {
            let next = model.structure().phase(h, 1);
            for (dof, r) in r.iter_mut().enumerate() {
                let (sector, terms) = degrees.image(dof);
                let turn = if sector == 0 { Complex64::ONE } else { next };
                *r -= terms.map(|(j, c)| turn * c * self.x[h * n + j]).sum::<Complex64>();
            }
        }
        for (i, v) in self.r.iter().enumerate() {
            r[origin(i)] = *v;
        }
        if let (Some(d), Some(own)) = (d_omega, &self.d_omega) {
            d.fill(Complex64::ZERO);
            for (i, v) in own.iter().enumerate() {
                d[origin(i)] = *v;
            }
        }
        if let (Some(j), Some(own)) = (jacobian, &self.jacobian) {
            let (order, small) = (2 * x.len(), 2 * self.x.len());
            let place = |i: usize| 2 * origin(i / 2) + i % 2;
            j.fill(0.0);
            for (column, values) in own.chunks_exact(small).enumerate() {
                for (row, v) in values.iter().enumerate() {
                    j[place(column) * order + place(row)] = *v;
                }
            }
            impose(model, given, j, order);
        }
        Ok(())
    }
}

/// Adds the rows x − T q of the dependent degrees of freedom to the Jacobian.
fn impose(model: &Model, given: usize, j: &mut [f64], order: usize) {
    let degrees = model.structure().degrees();
    for h in 0..order / 2 / given {
        let next = model.structure().phase(h, 1);
        for dof in (0..given).filter(|&dof| degrees.number(dof).is_none()) {
            let row = 2 * (h * given + dof);
            let mut add = |column: usize, v: Complex64| {
                let column = 2 * (h * given + column);
                j[column * order + row] += v.re;
                j[column * order + row + 1] += v.im;
                j[(column + 1) * order + row] -= v.im;
                j[(column + 1) * order + row + 1] += v.re;
            };
            add(dof, Complex64::ONE);
            let (sector, terms) = degrees.image(dof);
            let turn = if sector == 0 { Complex64::ONE } else { next };
            for (i, c) in terms {
                add(degrees.origin(i), -turn * c);
            }
        }
    }
}
