//! The iterative backend: products with J, preconditioned by the factors of the block between the unknowns that couple
//! strongly, then by those of the mean coupling of each pair of numbers by itself, and by the identity beyond.
//!
//! GMRES iterates with K M⁻¹, where M holds the block, the pairs, and the units of the other unknowns. A block that is
//! the whole matrix is solved directly. A wheel has the waves of `sector_waves` instead; the terms of `rank_factors` serve where they
//! are few.

use crate::error::{Result, Status, boxed, fail, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::lu::Lu;
use crate::linalg::iterative::gmres::Gmres;
use crate::linalg::newton::linear_system::dense::DenseSystem;
use crate::linalg::newton::linear_system::rank_or_waves::RankOrWaves;
use crate::linalg::newton::linear_system::{Border, Jacobian, LinearSystem, MatrixFree, Ring};
use num_complex::Complex64;

const CONTEXT: &str = "the linear system";

/// Products beyond those with its own factors up to which a solution with the factors of an earlier matrix is quicker
/// than new factors.
/// Kind: tuned; measured on: not recorded.
const SPARED: usize = 12;

/// Unknowns from which terms of low rank are looked for.
/// Kind: tuned; measured on: a finite-element sector with 60 contacts at 5 to 16 harmonics.
const RANK_FROM: usize = 960;

/// Numbers of each motion from which they are: the base of the terms takes a matrix of all motions for each harmonic.
/// Kind: tuned; measured on: the same sector, and 300 sliders with three harmonics, for which they take twice the time.
const RANK_FROM_NUMBERS: usize = 16;

/// A bordered system that is solved by iteration.
pub struct KrylovSystem {
    block: DenseSystem,
    lengths: Lengths,
    pairs: Pairs,
    /// Factors in place of block and pairs, where they serve.
    other: Option<Box<RankOrWaves>>,
    memory: Gmres,
    most_products: usize,
    /// Number of products of the last solution.
    products: usize,
    /// Number of products per digit with the factors of the matrix itself; and whether the stored factors are those.
    of_own_factors: f64,
    are_own: bool,
    /// Whether det K M⁻¹ is positive, as the last solution showed.
    positive: bool,
    vectors: KrylovVectors,
    scales: (f64, f64),
}

/// Memory of products.
pub struct KrylovVectors {
    column: Vec<f64>,
    row: Vec<f64>,
    /// Right-hand side of the block, preconditioned vector, and scaled unknowns.
    reduced: Vec<f64>,
    product: Vec<f64>,
    scaled: Vec<f64>,
}

/// Division of the unknowns into groups, and of each group into parts.
#[derive(Clone, Copy, Debug)]
pub struct Lengths {
    /// Length of each group.
    pub group: usize,
    /// Number of the first numbers of each group that belong to the block.
    pub part: usize,
    /// End of the pairs, after the block, whose mean coupling is factored.
    pub middle: usize,
    /// Number of unknowns after the groups, which belong to the block.
    pub behind: usize,
}

impl Lengths {
    /// Lengths for a wheel, which has neither block nor pairs.
    pub(super) fn of_ring(group: usize) -> Self {
        Self {
            group,
            part: 0,
            middle: 0,
            behind: 0,
        }
    }

    /// Positions in a group of the pairs that are factored.
    fn pairs(self) -> impl Iterator<Item = usize> {
        (self.part..self.middle.saturating_sub(1)).step_by(2)
    }
}

/// Factors of the mean coupling of each pair, with memory for one pair.
struct Pairs {
    factors: Vec<Lu<Complex64>>,
    /// For each pair, whether its factors exist; for a singular matrix the identity is used.
    regular: Vec<bool>,
    b: Vec<Complex64>,
}

impl Pairs {
    fn new(groups: usize, lengths: Lengths) -> Result<Self> {
        let mut factors = Vec::new();
        for _ in lengths.pairs() {
            try_push(&mut factors, Lu::new(groups, 1)?, CONTEXT)?;
        }
        Ok(Self {
            regular: try_vec(factors.len(), false, CONTEXT)?,
            factors,
            b: try_vec(groups, Complex64::ZERO, CONTEXT)?,
        })
    }

    fn factor(&mut self, lengths: Lengths, operator: &mut dyn MatrixFree, interrupt: &Interrupt<'_>) -> Result<()> {
        let factors = self.factors.iter_mut().zip(&mut self.regular);
        for (at, (lu, regular)) in lengths.pairs().zip(factors) {
            interrupt.check()?;
            operator.fill_pair(at, lu.matrix());
            *regular = match lu.factor(interrupt) {
                Err(e) if e.status == Status::Singular => false,
                factored => factored.map(|()| true)?,
            };
        }
        Ok(())
    }

    fn solve(&mut self, lengths: Lengths, u: &mut [f64]) {
        let factors = self.factors.iter().zip(&self.regular);
        for (at, (lu, _)) in lengths.pairs().zip(factors).filter(|(_, (_, regular))| **regular) {
            for (b, x) in self.b.iter_mut().zip(u.chunks_exact(lengths.group)) {
                *b = Complex64::new(x[at], x[at + 1]);
            }
            lu.solve(&mut self.b);
            for (b, x) in self.b.iter().zip(u.chunks_exact_mut(lengths.group)) {
                (x[at], x[at + 1]) = (b.re, b.im);
            }
        }
    }
}

impl KrylovSystem {
    /// Memory for `n` unknowns, in groups of equal length and after these. A solution that takes more products than
    /// `most_products` fails.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize, lengths: Lengths, most_products: usize) -> Result<Self> {
        let groups = (n - lengths.behind) / lengths.group.max(1);
        let order = groups * lengths.part + lengths.behind;
        Ok(Self {
            block: DenseSystem::new(order)?,
            pairs: Pairs::new(groups, lengths)?,
            other: None,
            lengths,
            memory: Gmres::default(),
            most_products,
            products: 0,
            of_own_factors: 0.0,
            are_own: false,
            positive: true,
            vectors: KrylovVectors {
                column: try_vec(n, 0.0, CONTEXT)?,
                row: try_vec(n + 1, 0.0, CONTEXT)?,
                reduced: try_vec(order + 1, 0.0, CONTEXT)?,
                product: try_vec(n + 1, 0.0, CONTEXT)?,
                scaled: try_vec(n, 0.0, CONTEXT)?,
            },
            scales: (1.0, 1.0),
        })
    }

    /// Memory for `n` unknowns in the sectors of a wheel.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn of_ring(n: usize, (group, ring): (usize, Ring<'_>), most_products: usize) -> Result<Self> {
        Ok(Self {
            other: Some(boxed(|| RankOrWaves::of_wheel(n, group, ring))?),
            ..Self::new(n, Lengths::of_ring(group), most_products)?
        })
    }

    /// Numbers of v that belong to the block: in all groups, and after the groups; the last one, of the parameter,
    /// included.
    fn of_block(v: &[f64], lengths: Lengths) -> impl Iterator<Item = f64> {
        let (u, behind) = v.split_at(v.len() - 1 - lengths.behind);
        let inner = u
            .chunks_exact(lengths.group.max(1))
            .flat_map(move |y| y[..lengths.part].iter().copied());
        inner.chain(behind.iter().copied())
    }

    /// v ← M⁻¹ v with the preconditioner M.
    fn precondition(
        (block, pairs, other): (&mut DenseSystem, &mut Pairs, &mut Option<Box<RankOrWaves>>),
        jacobian: &mut dyn Jacobian,
        lengths: Lengths,
        reduced: &mut [f64],
        v: &mut [f64],
    ) -> Result<()> {
        if let Some(other) = other.as_mut().filter(|other| other.serve()) {
            return other.solve(operator(jacobian)?, v);
        }
        for (to, from) in reduced.iter_mut().zip(Self::of_block(v, lengths)) {
            *to = from;
        }
        block.solve_by_factors(reduced);
        let (unit, part) = (block.unit(), lengths.part);
        let (groups, behind) = v.split_at_mut(v.len() - 1 - lengths.behind);
        pairs.solve(lengths, groups);
        let solved = reduced.chunks_exact(part.max(1));
        for (to, from) in groups.chunks_exact_mut(lengths.group.max(1)).zip(solved) {
            to[..part].copy_from_slice(&from[..part]);
            for weak in &mut to[part..] {
                *weak /= unit;
            }
        }
        behind.copy_from_slice(&reduced[reduced.len() - behind.len()..]);
        Ok(())
    }

    /// Solves by GMRES with the last factors as preconditioner, in at most `most` products; `false` if it does not
    /// converge.
    fn iterate(
        &mut self,
        jacobian: &mut dyn Jacobian,
        tolerance: f64,
        most: usize,
        b: &mut [f64],
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        interrupt.check()?;
        let lengths = self.lengths;
        self.products = 0;
        self.positive = true;
        let is_direct = self.is_direct();
        let (factors, reduced) = (
            (&mut self.block, &mut self.pairs, &mut self.other),
            &mut self.vectors.reduced,
        );
        if !is_direct {
            let border = (&self.vectors.column[..], self.scales, &self.vectors.row[..]);
            let (preconditioned, scaled) = (&mut self.vectors.product, &mut self.vectors.scaled);
            let solved = self.memory.solve(b, tolerance, most, |v, out| {
                interrupt.check()?;
                interrupt.count((reduced.len() * reduced.len() / 2) as u64);
                preconditioned.copy_from_slice(v);
                let factors = (&mut *factors.0, &mut *factors.1, &mut *factors.2);
                Self::precondition(factors, jacobian, lengths, reduced, preconditioned)?;
                product(jacobian, border, scaled, preconditioned, out)
            })?;
            let Some(solved) = solved else {
                self.products = most;
                return Ok(false);
            };
            (self.products, self.positive) = (solved.products, solved.positive);
        }
        Self::precondition(factors, jacobian, lengths, reduced, b)?;
        Ok(true)
    }

    /// Fills the block of the matrix at the point of the Jacobian, with the border that was taken over last.
    fn fill_block(&mut self, jacobian: &mut dyn Jacobian) -> Result<()> {
        let (lengths, is_direct) = (self.lengths, self.is_direct());
        let (matrix, active) = self.block.memory();
        if is_direct {
            jacobian.fill(matrix, active)?;
        } else {
            operator(jacobian)?.fill_block(lengths.part, matrix, active)?;
        }
        let (groups, behind) = self.vectors.column.split_at(self.vectors.column.len() - lengths.behind);
        let groups = groups.chunks_exact(lengths.group.max(1));
        let column = groups.flat_map(|y| y[..lengths.part].iter().copied());
        let column = column.chain(behind.iter().copied());
        self.block
            .set_border(column, self.scales, Self::of_block(&self.vectors.row, lengths));
        Ok(())
    }

    /// Whether terms of low rank are to be looked for, and no memory for them was made yet.
    fn may_have_terms(&self, operator: &mut dyn MatrixFree) -> bool {
        self.other.is_none()
            && self.lengths.behind == 0
            && self.vectors.column.len() >= RANK_FROM
            && self.lengths.group >= RANK_FROM_NUMBERS
            && operator.forces().is_some()
    }

    /// Whether the block is the whole matrix.
    fn is_direct(&self) -> bool {
        self.lengths.group == self.lengths.part
    }
}

/// The Jacobian as an operator with products.
fn operator(jacobian: &mut dyn Jacobian) -> Result<&mut dyn MatrixFree> {
    match jacobian.matrix_free() {
        Some(operator) => Ok(operator),
        None => fail!(Unsupported, "an iterative solution needs products with the Jacobian"),
    }
}

/// out ← K x.
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
    fn update(&mut self, jacobian: &mut dyn Jacobian, border: Border<'_>, interrupt: &Interrupt<'_>) -> Result<()> {
        self.vectors.column.copy_from_slice(border.column);
        self.vectors.row.copy_from_slice(border.row);
        self.scales = border.scales;
        self.are_own = false;
        interrupt.check()?;
        if let Some(other) = self.other.as_mut().filter(|other| other.serve()) {
            other.set_border(operator(jacobian)?, border)?;
            return operator(jacobian)?.keep();
        }
        if self.is_direct() {
            self.fill_block(jacobian)
        } else {
            // The block is filled where it is factored: most solutions are by earlier factors.
            operator(jacobian)?.keep()
        }
    }

    fn factor(&mut self, jacobian: &mut dyn Jacobian, interrupt: &Interrupt<'_>) -> Result<()> {
        self.are_own = true;
        if !self.is_direct() && self.may_have_terms(operator(jacobian)?) {
            let (n, group) = (self.vectors.column.len(), self.lengths.group);
            self.other = Some(boxed(|| RankOrWaves::of_groups(n, group))?);
        }
        if let Some(other) = &mut self.other {
            let border = Border {
                column: &self.vectors.column,
                scales: self.scales,
                row: &self.vectors.row,
            };
            if other.factor(operator(jacobian)?, interrupt)? {
                return other.set_border(operator(jacobian)?, border);
            }
        }
        if !self.is_direct() {
            self.fill_block(jacobian)?;
            self.pairs.factor(self.lengths, operator(jacobian)?, interrupt)?;
        }
        self.block.factor_memory(interrupt)
    }

    fn solve(
        &mut self,
        jacobian: &mut dyn Jacobian,
        tolerance: f64,
        b: &mut [f64],
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let solved = self.iterate(jacobian, tolerance, self.most_products, b, interrupt)?;
        if self.are_own {
            self.of_own_factors = self.products as f64 / -tolerance.log10();
        }
        Ok(solved)
    }

    fn solve_by_earlier_factors(
        &mut self,
        jacobian: &mut dyn Jacobian,
        tolerance: f64,
        b: &mut [f64],
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        if self.is_direct() {
            return Ok(false);
        }
        // An iteration converges linearly in the products.
        let digits = -tolerance.log10();
        let most = (self.of_own_factors * digits) as usize + SPARED;
        self.iterate(jacobian, tolerance, most.min(self.most_products), b, interrupt)
    }

    fn apply(&mut self, jacobian: &mut dyn Jacobian, x: &[f64], out: &mut [f64]) -> Result<()> {
        if self.is_direct() {
            return self.block.apply(jacobian, x, out);
        }
        let border = (&self.vectors.column[..], self.scales, &self.vectors.row[..]);
        product(jacobian, border, &mut self.vectors.scaled, x, out)
    }

    fn limit_products(&mut self, most: usize) {
        self.most_products = most;
    }

    fn products(&self) -> usize {
        self.products
    }

    /// Sign of det K = det M · det K M⁻¹. The determinant of a complex matrix that is treated as a real one is
    /// positive.
    fn is_positive(&self) -> bool {
        let factors = match self.other.as_ref().filter(|other| other.serve()) {
            Some(other) => other.is_positive(),
            None => self.block.is_positive(),
        };
        factors == self.positive
    }
}
