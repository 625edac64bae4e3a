//! Block Krylov basis of a large structure about one definite matrix A = K + σM.
//!
//! From the columns A⁻¹B on, each block is the part of A⁻¹M V (and A⁻¹C V, where damping C is no combination of K and M)
//! that the blocks before do not hold. The basis is orthonormal in the inner product of A, which massless degrees of
//! freedom do not upset. r blocks match 2r moments of Bᴴ(K − ν²M)⁻¹B about ν² = −σ (Su & Craig 1991,
//! doi:10.2514/3.20636; Bai 2002, doi:10.1016/S0168-9274(02)00116-2).
//!
//! With Galerkin coefficients q the residual of A⁻¹Z V q = A⁻¹b lies in the part E of the last images that the basis does
//! not hold, so that its norm at any frequency follows from the Gram matrix EᴴAE. A block of combinations of E alone leaves the rest
//! of E, which stays beside the images of that block.

use crate::error::{Error, Result, try_copy, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::exact_sums::compensated_product::Rows;
use crate::linalg::factors::cholesky::Cholesky;
use crate::linalg::iterative::orthonormal_block::{adjoint_product, norms, orthonormalise, orthonormalise_again};
use crate::linalg::sparse_storage::sparse::Csc;
use crate::linalg::sparse_storage::triangle::{Entry, Triangle};
use crate::linalg::sparse_storage::triangle_product::multiply;
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use num_complex::Complex64;

const CONTEXT: &str = "the reduced structure";

/// A sparse vector: row and value of each entry.
pub type SparseVector = Vec<(usize, Complex64)>;

/// Modulus |xᴴ y| of the product of two columns.
fn energy<T: Entry>(x: &[T], y: &[T]) -> f64 {
    let product = |(x, y): (&T, &T)| x.complex().conj() * y.complex();
    x.iter().zip(y).map(product).sum::<Complex64>().norm()
}

/// A growing basis, orthonormal in the inner product of A = K + σM.
pub struct BlockKrylov<T> {
    factor: Cholesky<T>,
    /// K, σ and M of A = K + σM. They are kept apart because their sum would round the digits in which M exceeds K
    /// for the smallest motions.
    stiffness: Triangle<T>,
    shift: f64,
    mass: Triangle<T>,
    /// Damping matrix C, if its images extend the basis, too.
    damping: Option<Csc>,
    n: usize,
    /// Columns of the basis, n numbers each.
    basis: Vec<T>,
    /// First column whose image the basis may lack.
    last: usize,
    /// Per operator the reduced matrix Vᴴ O V, column after column, of the current order.
    reduced: Vec<Vec<Complex64>>,
    /// Parts of the images, of the columns from `last` on, that are not in the basis: n numbers per column, operator
    /// after operator.
    rest: Vec<T>,
    /// Norms of the images of the columns from `last` on.
    sizes: Vec<f64>,
    /// Gram matrix of the parts of images in `rest`, in the inner product of A.
    gram: Vec<Complex64>,
}

impl<T: Entry> BlockKrylov<T> {
    /// An empty basis about A = K + σM, whose factors are given.
    #[must_use]
    pub fn new(
        factor: Cholesky<T>,
        (stiffness, shift, mass): (Triangle<T>, f64, Triangle<T>),
        damping: Option<Csc>,
    ) -> Self {
        let n = mass.n;
        let reduced = (0..=usize::from(damping.is_some())).map(|_| Vec::new()).collect();
        Self {
            factor,
            stiffness,
            shift,
            mass,
            damping,
            n,
            basis: Vec::new(),
            last: 0,
            reduced,
            rest: Vec::new(),
            sizes: Vec::new(),
            gram: Vec::new(),
        }
    }

    /// Number of columns of the basis.
    #[must_use]
    pub fn order(&self) -> usize {
        self.basis.len() / self.n.max(1)
    }

    /// First column whose image the basis may lack: the first one of the last block that took all candidates.
    #[must_use]
    pub fn last(&self) -> usize {
        self.last
    }

    /// Largest number of columns of the next block.
    #[must_use]
    pub fn next_columns(&self) -> usize {
        self.rest.len() / self.n.max(1)
    }

    /// Reduced matrix Vᴴ O V of an operator, mass or damping, column after column.
    #[must_use]
    pub fn reduced(&self, operator: usize) -> &[Complex64] {
        &self.reduced[operator]
    }

    /// Gram matrix EᴴAE of those parts E of the images, of the columns from [`Self::last`] on, that are not in the
    /// basis; operator after operator.
    #[must_use]
    pub fn gram(&self) -> &[Complex64] {
        &self.gram
    }

    /// The factor of A, whose memory may serve another matrix while nothing is solved.
    pub fn factor(&mut self) -> &mut Cholesky<T> {
        &mut self.factor
    }

    /// The lower triangle of K + σM for another σ.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn shifted(&self, sigma: f64, interrupt: &Interrupt<'_>) -> Result<Triangle<T>> {
        Triangle::sum(&self.stiffness, (sigma, &self.mass), interrupt)
    }

    /// Takes the basis out, column after column. [`Self::give_basis`] must return it before further blocks are added.
    pub fn take_basis(&mut self) -> Vec<T> {
        core::mem::take(&mut self.basis)
    }

    /// Returns the basis that was taken.
    pub fn give_basis(&mut self, basis: Vec<T>) {
        self.basis = basis;
    }

    /// Rounding error of solutions, as far as it leads out of the basis: the largest part in the norm of A, relative,
    /// for solutions that would be the motions V z of the coordinates `probes`, one after the other. Errors within
    /// the basis do not matter.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn rounding_of_solutions(&mut self, probes: &[Complex64], interrupt: &Interrupt<'_>) -> Result<f64> {
        let mut worst = 0.0_f64;
        let mut force = try_vec(self.n, T::NONE, CONTEXT)?;
        for probe in probes.chunks_exact(self.order().max(1)) {
            let motion = self.motion(probe)?;
            self.weigh_exactly(&motion, &mut force, interrupt)?;
            let size = energy(&motion, &force);
            let mut found = try_copy(&force, CONTEXT)?;
            self.factor.solve(&mut found, interrupt)?;
            for (x, v) in found.iter_mut().zip(&motion) {
                x.add_product(v.scaled(-1.0), T::of(Complex64::ONE));
            }
            // Twice: the error within the basis is far larger.
            for _ in 0..2 {
                self.weigh_exactly(&found, &mut force, interrupt)?;
                self.project(&mut found, &force, interrupt)?;
            }
            self.weigh(&found, &mut force, interrupt)?;
            if size > 0.0 {
                worst = worst.max((energy(&found, &force) / size).sqrt());
            }
        }
        Ok(worst)
    }

    /// y ← A x for columns of n numbers.
    fn weigh(&self, x: &[T], y: &mut [T], interrupt: &Interrupt<'_>) -> Result<()> {
        multiply(&[(1.0, &self.stiffness), (self.shift, &self.mass)], x, y, interrupt)
    }

    /// y ← A x for one column, rounded once.
    fn weigh_exactly(&self, x: &[T], y: &mut [T], interrupt: &Interrupt<'_>) -> Result<()> {
        let mut rows = Rows::new(self.n)?;
        rows.add(&self.stiffness, x, interrupt)?;
        let mut shifted = try_copy(x, CONTEXT)?;
        for x in &mut shifted {
            *x = x.scaled(self.shift);
        }
        rows.add(&self.mass, &shifted, interrupt)?;
        rows.rounded(y);
        Ok(())
    }

    /// y ← M x or C x, or their adjoints, for columns of n numbers.
    fn image(&self, operator: usize, adjoint: bool, x: &[T], y: &mut [T], interrupt: &Interrupt<'_>) -> Result<()> {
        let a = match &self.damping {
            Some(damping) if operator > 0 => damping,
            _ => return multiply(&[(1.0, &self.mass)], x, y, interrupt),
        };
        for (x, y) in x.chunks_exact(a.rows).zip(y.chunks_exact_mut(a.rows)) {
            interrupt.check_before(2 * a.values.len() as u64)?;
            y.fill(T::NONE);
            for j in 0..a.cols {
                for (i, v) in a.column(j) {
                    if adjoint {
                        y[j].add_product(T::of(v.conj()), x[i]);
                    } else {
                        y[i].add_product(T::of(v), x[j]);
                    }
                }
            }
        }
        Ok(())
    }

    /// Products Dᴴ V with the vectors D: for each column of V one number per vector.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn seen_by(&self, vectors: &[SparseVector]) -> Result<Vec<Complex64>> {
        let mut seen = Vec::new();
        for column in self.basis.chunks_exact(self.n.max(1)) {
            for vector in vectors {
                let sum = vector.iter().map(|&(p, z)| z.conj() * column[p].complex()).sum();
                try_push(&mut seen, sum, CONTEXT)?;
            }
        }
        Ok(seen)
    }

    /// Motion V z of coordinates z.
    fn motion(&self, z: &[Complex64]) -> Result<Vec<T>> {
        let mut motion = try_vec(self.n, T::NONE, CONTEXT)?;
        for (column, &z) in self.basis.chunks_exact(self.n.max(1)).zip(z) {
            for (x, v) in motion.iter_mut().zip(column) {
                x.add_product(*v, T::of(z));
            }
        }
        Ok(motion)
    }

    /// Products Vᴴ A V z for coordinates z, one column after the other, with products by A rounded once. Plain
    /// products, with which the basis is orthonormal, lose the smallest stiffness in the largest.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn products(&self, coordinates: &[Complex64], interrupt: &Interrupt<'_>) -> Result<Vec<Complex64>> {
        let (n, order) = (self.n.max(1), self.order().max(1));
        let mut forces = try_vec(coordinates.len() / order * n, T::NONE, CONTEXT)?;
        for (force, z) in forces.chunks_exact_mut(n).zip(coordinates.chunks_exact(order)) {
            self.weigh_exactly(&self.motion(z)?, force, interrupt)?;
        }
        let mut products = try_vec(coordinates.len(), T::NONE, CONTEXT)?;
        interrupt.check_before((4 * order * forces.len()) as u64)?;
        adjoint_product(&self.basis, &forces, n, &mut products);
        let mut found = try_vec(coordinates.len(), Complex64::ZERO, CONTEXT)?;
        for (found, product) in found.iter_mut().zip(products) {
            *found = product.complex();
        }
        Ok(found)
    }

    /// Makes the first block, A⁻¹ times the given vectors. Address space for `blocks` blocks of this size is reserved
    /// where possible: a basis that moves when it grows leaves holes, which remain resident.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn start(&mut self, inputs: &[SparseVector], blocks: usize, interrupt: &Interrupt<'_>) -> Result<()> {
        let n = self.n;
        // Without it every block asks for its own.
        let _not_needed = self
            .basis
            .try_reserve_exact(inputs.len().saturating_mul(n).saturating_mul(blocks));
        let mut b = try_vec(inputs.len().saturating_mul(n), T::NONE, CONTEXT)?;
        for (column, input) in b.chunks_exact_mut(n.max(1)).zip(inputs) {
            for &(p, x) in input {
                column[p].add_product(T::of(x), T::of(Complex64::ONE));
            }
        }
        let mut block = try_copy(&b, CONTEXT)?;
        self.factor.solve(&mut block, interrupt)?;
        let sizes = norms(&block, &b, n);
        drop(b);
        self.absorb(block, &sizes, interrupt)
    }

    /// Adds one more block; `false` where the basis already holds all images.
    ///
    /// # Errors
    /// As [`Self::start`].
    pub fn grow(&mut self, interrupt: &Interrupt<'_>) -> Result<bool> {
        let before = self.order();
        let candidates = core::mem::take(&mut self.rest);
        let sizes = core::mem::take(&mut self.sizes);
        self.absorb(candidates, &sizes, interrupt)?;
        Ok(self.order() > before)
    }

    /// Whether a block may consist of some combinations of the candidates only: there is one operator.
    #[must_use]
    pub fn can_choose(&self) -> bool {
        self.damping.is_none()
    }

    /// Adds a block of the combinations E W of the candidates E, for the columns of W; `false` where it adds nothing.
    /// The remaining candidates belong to the next block.
    ///
    /// # Errors
    /// As [`Self::start`].
    pub fn grow_by(&mut self, choice: &[Complex64], interrupt: &Interrupt<'_>) -> Result<bool> {
        let n = self.n.max(1);
        let (first, candidates) = (self.order(), self.next_columns());
        let columns = choice.len() / candidates.max(1);
        let mut weights = try_vec(choice.len(), T::NONE, CONTEXT)?;
        for (to, from) in weights.iter_mut().zip(choice) {
            *to = T::of(*from);
        }
        let mut block = try_vec(n * columns, T::NONE, CONTEXT)?;
        interrupt.check_before((4 * candidates * block.len()) as u64)?;
        matmul(
            MatMut::from_column_major_slice_mut(&mut block, n, columns),
            Accum::Replace,
            MatRef::from_column_major_slice(&self.rest, n, candidates),
            MatRef::from_column_major_slice(&weights, candidates, columns),
            T::of(Complex64::ONE),
            Par::Seq,
        );
        let mut weighted = try_vec(block.len(), T::NONE, CONTEXT)?;
        for _ in 0..2 {
            self.weigh(&block, &mut weighted, interrupt)?;
            self.project(&mut block, &weighted, interrupt)?;
            self.weigh(&block, &mut weighted, interrupt)?;
            if !orthonormalise_again(&mut block, &weighted, n, interrupt)? {
                return Ok(false);
            }
        }
        self.weigh(&block, &mut weighted, interrupt)?;
        remove_part(&mut self.rest, &block, &weighted, n, interrupt)?;
        self.append(&block)?;
        drop((block, weighted));
        self.images(first, interrupt)?;
        Ok(true)
    }

    /// Adds the parts of other motions, n numbers each, that the basis does not hold; `false` where it holds them all. Rests of all
    /// columns stay candidates where no block was added by its images before.
    ///
    /// # Errors
    /// As [`Self::start`].
    pub fn add(&mut self, mut block: Vec<T>, interrupt: &Interrupt<'_>) -> Result<bool> {
        let (n, first) = (self.n, self.order());
        let mut weighted = try_vec(block.len(), T::NONE, CONTEXT)?;
        self.weigh(&block, &mut weighted, interrupt)?;
        let sizes = norms(&block, &weighted, n);
        self.project(&mut block, &weighted, interrupt)?;
        self.append_new(block, &sizes, interrupt)?;
        let new = &self.basis[first * n..];
        if new.is_empty() {
            return Ok(false);
        }
        let mut weighted = try_vec(new.len(), T::NONE, CONTEXT)?;
        self.weigh(new, &mut weighted, interrupt)?;
        remove_part(&mut self.rest, new, &weighted, n, interrupt)?;
        self.images(first, interrupt)?;
        Ok(true)
    }

    fn append(&mut self, block: &[T]) -> Result<()> {
        self.basis
            .try_reserve_exact(block.len())
            .map_err(|_| Error::out_of_memory(CONTEXT))?;
        self.basis.extend_from_slice(block);
        Ok(())
    }

    /// Appends the part of the candidates that is not in the basis, and computes the images of the new block; `sizes`
    /// are those of the images from which the candidates came.
    fn absorb(&mut self, block: Vec<T>, sizes: &[f64], interrupt: &Interrupt<'_>) -> Result<()> {
        let first = self.order();
        self.append_new(block, sizes, interrupt)?;
        self.last = first;
        self.images(first, interrupt)
    }

    /// Appends the directions of a block, orthogonal to the basis but for rounding, that are more than rounding of `sizes`.
    fn append_new(&mut self, mut block: Vec<T>, sizes: &[f64], interrupt: &Interrupt<'_>) -> Result<()> {
        let n = self.n;
        let first = self.order();
        let mut weighted = try_vec(block.len(), T::NONE, CONTEXT)?;
        self.weigh(&block, &mut weighted, interrupt)?;
        let kept = orthonormalise(&mut block, &mut weighted, n, sizes, interrupt)?;
        block.truncate(kept * n);
        weighted.truncate(kept * n);
        // The rest of a small part has lost the digits by which it was small.
        self.weigh(&block, &mut weighted, interrupt)?;
        if first > 0 {
            self.project(&mut block, &weighted, interrupt)?;
            self.weigh(&block, &mut weighted, interrupt)?;
        }
        if !orthonormalise_again(&mut block, &weighted, n, interrupt)? {
            let sizes = try_vec(kept, 1.0, CONTEXT)?;
            let kept = orthonormalise(&mut block, &mut weighted, n, &sizes, interrupt)?;
            block.truncate(kept * n);
        }
        self.append(&block)
    }

    /// Computes the images of the columns from `first` on, and adds them to the remaining parts of earlier ones.
    fn images(&mut self, first: usize, interrupt: &Interrupt<'_>) -> Result<()> {
        let n = self.n;
        let order = self.order();
        let new = order - first;
        let block = &self.basis[first * n..];
        let count = self.reduced.len();
        let mut rest = try_vec(block.len() * count, T::NONE, CONTEXT)?;
        let mut product = try_vec(order * new, T::NONE, CONTEXT)?;
        let mut coefficients = try_vec(order * new * count, T::NONE, CONTEXT)?;
        for (o, image) in rest.chunks_exact_mut(block.len().max(1)).enumerate() {
            let mut reduced = try_vec(order * order, Complex64::ZERO, CONTEXT)?;
            for (to, from) in reduced
                .chunks_exact_mut(order)
                .zip(self.reduced[o].chunks_exact(first.max(1)))
            {
                to[..first].copy_from_slice(from);
            }
            self.image(o, false, block, image, interrupt)?;
            adjoint_product(&self.basis, image, n, &mut product);
            for (to, from) in reduced[first * order..].iter_mut().zip(&product) {
                *to = from.complex();
            }
            for (to, from) in coefficients[o * order * new..].iter_mut().zip(&product) {
                *to = from.scaled(-1.0);
            }
            if o > 0 {
                let mut back = try_vec(block.len(), T::NONE, CONTEXT)?;
                self.image(o, true, block, &mut back, interrupt)?;
                adjoint_product(&self.basis, &back, n, &mut product);
            }
            for j in 0..first {
                for i in first..order {
                    reduced[j * order + i] = product[(i - first) * order + j].complex().conj();
                }
            }
            self.reduced[o] = reduced;
        }
        let mut weighted = try_copy(&rest, CONTEXT)?;
        self.factor.solve(&mut rest, interrupt)?;
        let known = core::mem::take(&mut self.sizes);
        self.sizes = interleaved(&known, &norms(&rest, &weighted, n), count)?;
        // VᴴA A⁻¹O V = VᴴO V: the part in the basis needs no other product.
        interrupt.check_before((4 * order * rest.len()) as u64)?;
        matmul(
            MatMut::from_column_major_slice_mut(&mut rest, n, new * count),
            Accum::Add,
            MatRef::from_column_major_slice(&self.basis, n, order),
            MatRef::from_column_major_slice(&coefficients, order, new * count),
            T::of(Complex64::ONE),
            Par::Seq,
        );
        let before = self.rest.len();
        if before > 0 {
            let known = core::mem::take(&mut self.rest);
            rest = interleaved(&known, &rest, count)?;
            // The rest has become small beside the images, whose products with it are rounded by their own size.
            weighted = try_vec(rest.len(), T::NONE, CONTEXT)?;
            self.weigh(&rest, &mut weighted, interrupt)?;
        }
        let columns = rest.len() / n.max(1);
        let mut gram = try_vec(columns * columns, T::NONE, CONTEXT)?;
        // EᴴA V = 0, so that EᴴA E = EᴴA A⁻¹O V.
        adjoint_product(&rest, &weighted, n, &mut gram);
        self.gram.clear();
        self.gram.extend(gram.iter().map(|z| z.complex()));
        self.rest = rest;
        Ok(())
    }

    /// block ← block − V Vᴴ A block, the part outside of the basis.
    fn project(&self, block: &mut [T], weighted: &[T], interrupt: &Interrupt<'_>) -> Result<()> {
        let (n, order) = (self.n, self.order());
        let columns = block.len() / n.max(1);
        if order == 0 || columns == 0 {
            return Ok(());
        }
        let mut c = try_vec(order * columns, T::NONE, CONTEXT)?;
        interrupt.check_before((4 * order * block.len()) as u64)?;
        adjoint_product(&self.basis, weighted, n, &mut c);
        for x in &mut c {
            *x = x.scaled(-1.0);
        }
        interrupt.check()?;
        matmul(
            MatMut::from_column_major_slice_mut(block, n, columns),
            Accum::Add,
            MatRef::from_column_major_slice(&self.basis, n, order),
            MatRef::from_column_major_slice(&c, order, columns),
            T::of(Complex64::ONE),
            Par::Seq,
        );
        Ok(())
    }
}

/// The numbers of `count` operators one after the other: of each those known before, then the new ones.
fn interleaved<N: Copy>(known: &[N], new: &[N], count: usize) -> Result<Vec<N>> {
    let mut all = Vec::new();
    all.try_reserve_exact(known.len() + new.len())
        .map_err(|_| Error::out_of_memory(CONTEXT))?;
    let (of_known, of_new) = (known.len() / count, new.len() / count);
    for o in 0..count {
        all.extend_from_slice(&known[o * of_known..(o + 1) * of_known]);
        all.extend_from_slice(&new[o * of_new..(o + 1) * of_new]);
    }
    Ok(all)
}

/// x ← x − U Uᴴ A x for orthonormal columns U; A U is given.
fn remove_part<T: Entry>(x: &mut [T], unit: &[T], weighted: &[T], n: usize, interrupt: &Interrupt<'_>) -> Result<()> {
    let (own, columns) = (unit.len() / n.max(1), x.len() / n.max(1));
    let mut parts = try_vec(own * columns, T::NONE, CONTEXT)?;
    interrupt.check_before((8 * own * x.len()) as u64)?;
    adjoint_product(weighted, x, n, &mut parts);
    for part in &mut parts {
        *part = part.scaled(-1.0);
    }
    matmul(
        MatMut::from_column_major_slice_mut(x, n, columns),
        Accum::Add,
        MatRef::from_column_major_slice(unit, n, own),
        MatRef::from_column_major_slice(&parts, own, columns),
        T::of(Complex64::ONE),
        Par::Seq,
    );
    Ok(())
}
