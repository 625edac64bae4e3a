//! The iterative backend: products with J, preconditioned by the factors of the block between the unknowns that couple
//! strongly, and by the identity beyond it.
//!
//! GMRES iterates with K M⁻¹, where M holds the block and the units of the other unknowns. A block that is the whole
//! matrix is solved directly.

use crate::error::{Result, fail, try_vec};
use crate::linalg::gmres::gmres;
use crate::linalg::linear_system::dense::DenseSystem;
use crate::linalg::linear_system::{Border, Jacobian, LinearSystem, MatrixFree};

const CONTEXT: &str = "the linear system";

/// A bordered system that is solved by iteration.
pub struct KrylovSystem {
    block: DenseSystem,
    /// Length of a group of unknowns, and how many of its numbers are in the block.
    group: usize,
    part: usize,
    tolerance: f64,
    most_products: usize,
    column: Vec<f64>,
    scales: (f64, f64),
    row: Vec<f64>,
    /// Right side of the block, preconditioned vector, and its scaled unknowns.
    reduced: Vec<f64>,
    product: Vec<f64>,
    scaled: Vec<f64>,
}

impl KrylovSystem {
    /// Memory for `n` unknowns in groups, of each of which the first `part` numbers are in the block. A solution has
    /// this relative residual, or takes more products than `most_products` and fails.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize, (group, part): (usize, usize), tolerance: f64, most_products: usize) -> Result<Self> {
        let order = n / group.max(1) * part;
        Ok(Self {
            block: DenseSystem::new(order)?,
            group,
            part,
            tolerance,
            most_products,
            column: try_vec(n, 0.0, CONTEXT)?,
            scales: (1.0, 1.0),
            row: try_vec(n + 1, 0.0, CONTEXT)?,
            reduced: try_vec(order + 1, 0.0, CONTEXT)?,
            product: try_vec(n + 1, 0.0, CONTEXT)?,
            scaled: try_vec(n, 0.0, CONTEXT)?,
        })
    }

    /// Numbers of the block among those of all groups, the last one, of the parameter, included.
    fn of_block(v: &[f64], (group, part): (usize, usize)) -> impl Iterator<Item = f64> {
        let (u, p) = v.split_at(v.len() - 1);
        let inner = u
            .chunks_exact(group.max(1))
            .flat_map(move |y| y[..part].iter().copied());
        inner.chain(p.iter().copied())
    }

    /// v ← M⁻¹ v
    fn precondition(block: &mut DenseSystem, lengths: (usize, usize), reduced: &mut [f64], v: &mut [f64]) {
        for (to, from) in reduced.iter_mut().zip(Self::of_block(v, lengths)) {
            *to = from;
        }
        block.solve_by_factors(reduced);
        let (group, part) = lengths;
        let (n, unit) = (v.len() - 1, block.unit());
        let solved = reduced.chunks_exact(part.max(1));
        for (to, from) in v[..n].chunks_exact_mut(group.max(1)).zip(solved) {
            to[..part].copy_from_slice(&from[..part]);
            for weak in &mut to[part..] {
                *weak /= unit;
            }
        }
        v[n] = reduced[reduced.len() - 1];
    }

    /// Whether the block is the whole matrix.
    fn is_direct(&self) -> bool {
        self.group == self.part
    }
}

/// The products of a Jacobian.
fn operator(jacobian: &mut dyn Jacobian) -> Result<&mut dyn MatrixFree> {
    match jacobian.matrix_free() {
        Some(operator) => Ok(operator),
        None => fail!(Unsupported, "an iterative solution needs products with the Jacobian"),
    }
}

/// out = K x
fn product(
    jacobian: &mut dyn Jacobian,
    (column, scales, row): (&[f64], (f64, f64), &[f64]),
    scaled: &mut [f64],
    x: &[f64],
    out: &mut [f64],
) -> Result<()> {
    let n = column.len();
    for (s, x) in scaled.iter_mut().zip(x) {
        *s = scales.0 * x;
    }
    operator(jacobian)?.multiply(scaled, &mut out[..n])?;
    let along = scales.1 * x[n];
    for (out, c) in out.iter_mut().zip(column) {
        *out += c * along;
    }
    out[n] = row.iter().zip(x).map(|(t, x)| t * x).sum();
    Ok(())
}

impl LinearSystem for KrylovSystem {
    fn update(&mut self, jacobian: &mut dyn Jacobian, border: Border<'_>) -> Result<()> {
        self.column.copy_from_slice(border.column);
        self.row.copy_from_slice(border.row);
        self.scales = border.scales;
        let is_direct = self.is_direct();
        let operator = operator(jacobian)?;
        let (matrix, active) = self.block.memory();
        operator.fill_block(self.part, matrix, active)?;
        if !is_direct {
            operator.keep()?;
        }
        let lengths = (self.group, self.part);
        let groups = border.column.chunks_exact(self.group.max(1));
        let column = groups.flat_map(|y| y[..lengths.1].iter().copied());
        self.block
            .set_border(column, border.scales, Self::of_block(border.row, lengths));
        Ok(())
    }

    fn factor(&mut self) -> Result<()> {
        self.block.factor_memory()
    }

    fn solve(&mut self, jacobian: &mut dyn Jacobian, b: &mut [f64]) -> Result<bool> {
        let lengths = (self.group, self.part);
        let (block, reduced) = (&mut self.block, &mut self.reduced);
        if lengths.0 != lengths.1 {
            let border = (&self.column[..], self.scales, &self.row[..]);
            let (preconditioned, scaled) = (&mut self.product, &mut self.scaled);
            let solved = gmres(b, self.tolerance, self.most_products, |v, out| {
                preconditioned.copy_from_slice(v);
                Self::precondition(block, lengths, reduced, preconditioned);
                product(jacobian, border, scaled, preconditioned, out)
            })?;
            if !solved {
                return Ok(false);
            }
        }
        Self::precondition(block, lengths, reduced, b);
        Ok(true)
    }

    fn apply(&mut self, jacobian: &mut dyn Jacobian, x: &[f64], out: &mut [f64]) -> Result<()> {
        if self.is_direct() {
            return self.block.apply(jacobian, x, out);
        }
        let border = (&self.column[..], self.scales, &self.row[..]);
        product(jacobian, border, &mut self.scaled, x, out)
    }

    fn is_positive(&self) -> bool {
        self.block.is_positive()
    }
}
