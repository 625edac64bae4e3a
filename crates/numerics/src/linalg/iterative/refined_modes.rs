//! All modes of an undamped wave, M φ = μ K φ, φᴴ K φ = 1, to the digits of the matrices.
//!
//! The pencil turned round gives the lowest modes, which matter most, with the smallest error: that of all μ is ε times the largest.
//! One step of the refinement of Ogita & Aishima (Jpn. J. Ind. Appl. Math. 35, 2018, doi:10.1007/s13160-018-0310-3) makes the others
//! as good. With X the modes, R = 1 − Xᴴ K X and S = Xᴴ M X,
//!
//! > μ_j ← S_jj/(1 − R_jj),  X ← X (1 + E),  E_ij = (S_ij + μ_j R_ij)/(μ_j − μ_i),  E_jj = R_jj/2,
//!
//! and E_ij = R_ij/2 for equal ones. The error is squared by each step. Products with K of motions that hardly strain a stiff structure
//! are made in twice the precision.

use crate::error::{Result, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::complex_products;
use crate::linalg::dense::complex_products::LOOPS_UP_TO;
use crate::linalg::dense::eigen::{self, Pairs};
use crate::linalg::dot;
use crate::linalg::exact_sums::quadratic::{self, ComplexSum, terms_of_moduli};
use crate::linalg::sparse_storage::sparse::Csc;
use crate::linalg::sparse_storage::triangle::Entry;
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use nalgebra::DMatrix;
use num_complex::Complex64;

const CONTEXT: &str = "the modes of the structure";

/// Terms of φᴴ K φ over its value from which a product with K is made in twice the precision.
/// Kind: tuned; measured on: not recorded.
const SOFT_TERMS: f64 = 100.0;

/// Relative distance of eigenvalues that count as equal, and the largest entry of E.
/// Kind: rounding.
const EQUAL_VALUES: f64 = 1e-9;
/// Largest entry of E.
/// Kind: tuned; measured on: not recorded.
const LARGEST_STEP: f64 = 0.1;

/// Entry of E above which a further step is made, and the most steps.
/// Kind: rounding.
const STEP_AGAIN: f64 = 1e-7;
/// Most such steps.
/// Kind: cap.
const MOST_STEPS: usize = 4;

/// Share of entries of a matrix, inverse, above which products by blocks are quicker than by its entries.
/// Kind: tuned; measured on: not recorded.
const MANY_ENTRIES: usize = 4;

/// Modes of a Hermitian pencil: μ, rising, and φ; `mass` is given on the pattern of K.
///
/// # Errors
/// As [`eigen::generalised`].
pub fn modes(stiffness: &Csc, mass: &[Complex64], interrupt: &Interrupt<'_>) -> Result<Pairs> {
    interrupt.check()?;
    let n = stiffness.rows;
    let (stiffness, mass) = &without_zeros(stiffness, mass)?;
    let (m, k) = (dense(stiffness, mass)?, dense(stiffness, &stiffness.values)?);
    let found = eigen::generalised(&m, &k, interrupt);
    // Beside a penalty soft motions look as if they had no stiffness: the steps show that they have.
    if !found.as_ref().is_ok_and(|pairs| pairs.values.len() == n)
        && let Some(mut pairs) = eigen::with_definite_mass(&m, &k, 0.0, interrupt)?
        && refine(stiffness, mass, &mut pairs, interrupt)?
    {
        return Ok(pairs);
    }
    let mut pairs = found?;
    if pairs.values.len() == n {
        refine(stiffness, mass, &mut pairs, interrupt)?;
    }
    Ok(pairs)
}

/// K and M on the pattern of their nonzero entries: modal damping makes the pattern full.
fn without_zeros(stiffness: &Csc, mass: &[Complex64]) -> Result<(Csc, Vec<Complex64>)> {
    let (mut pattern, mut masses) = (Csc::zero(stiffness.cols)?, Vec::new());
    for j in 0..stiffness.cols {
        let entries = stiffness.col_ptr[j]..stiffness.col_ptr[j + 1];
        for (at, &m) in entries.clone().zip(&mass[entries]) {
            let k = stiffness.values[at];
            if k != Complex64::ZERO || m != Complex64::ZERO {
                try_push(&mut pattern.row_idx, stiffness.row_idx[at], CONTEXT)?;
                try_push(&mut pattern.values, k, CONTEXT)?;
                try_push(&mut masses, m, CONTEXT)?;
            }
        }
        pattern.col_ptr[j + 1] = pattern.values.len();
    }
    Ok((pattern, masses))
}

/// Repeats the refinement step until it is small; `false` if it stays large. Real modes of real matrices take real
/// products, a quarter of the work.
fn refine(stiffness: &Csc, mass: &[Complex64], pairs: &mut Pairs, interrupt: &Interrupt<'_>) -> Result<bool> {
    let n = stiffness.rows;
    if n < 2 {
        return Ok(true);
    }
    let Pairs { values, vectors } = pairs;
    let x = vectors.as_mut_slice();
    let real = |of: &[Complex64]| of.iter().all(|z| z.im == 0.0);
    if n <= LOOPS_UP_TO || !(real(mass) && real(&stiffness.values) && real(x)) {
        let matrices = [mass, &stiffness.values];
        let by = Products {
            plain: complex_products::multiply,
            adjoint: complex_products::multiply_adjoint,
        };
        return steps((stiffness, matrices, by), values, x, interrupt);
    }
    let parts = |of: &[Complex64]| -> Result<Vec<f64>> {
        let mut found = try_vec(of.len(), 0.0, CONTEXT)?;
        for (to, z) in found.iter_mut().zip(of) {
            *to = z.re;
        }
        Ok(found)
    };
    let (m, k, mut own) = (parts(mass)?, parts(&stiffness.values)?, parts(x)?);
    let by = Products {
        plain: |a, b, c, n| real_product(square(a, n), square(b, n), c),
        adjoint: |a, b, c, n| real_product(square(a, n).transpose(), square(b, n), c),
    };
    let are_small = steps((stiffness, [&m, &k], by), values, &mut own, interrupt)?;
    for (to, x) in x.iter_mut().zip(own) {
        *to = x.into();
    }
    Ok(are_small)
}

/// Product of dense matrices with n rows: c ← A B, or Aᴴ B.
type Product<T> = fn(&[T], &[T], &mut [T], usize);

#[derive(Clone, Copy)]
struct Products<T> {
    plain: Product<T>,
    adjoint: Product<T>,
}

fn square(a: &[f64], n: usize) -> MatRef<'_, f64> {
    MatRef::from_column_major_slice(a, n, n)
}

fn real_product(a: MatRef<'_, f64>, b: MatRef<'_, f64>, c: &mut [f64]) {
    let n = a.nrows();
    let c = MatMut::from_column_major_slice_mut(c, n, n);
    matmul(c, Accum::Replace, a, b, 1.0, Par::Seq);
}

fn steps<T: Entry>(
    (stiffness, matrices, by): (&Csc, [&[T]; 2], Products<T>),
    values: &mut [f64],
    x: &mut [T],
    interrupt: &Interrupt<'_>,
) -> Result<bool> {
    for _ in 0..MOST_STEPS {
        if step((stiffness, matrices, by), values, x, interrupt)? <= STEP_AGAIN {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The dense matrix with the given values at the entries of a pattern, zero elsewhere.
///
/// # Errors
/// `OutOfMemory`.
pub fn dense(pattern: &Csc, values: &[Complex64]) -> Result<DMatrix<Complex64>> {
    let n = pattern.rows;
    let mut a = try_vec(n * n, Complex64::ZERO, CONTEXT)?;
    for j in 0..n {
        for at in pattern.col_ptr[j]..pattern.col_ptr[j + 1] {
            a[j * n + pattern.row_idx[at]] = values[at];
        }
    }
    Ok(DMatrix::from_vec(n, n, a))
}

/// One refinement step with M and K on the pattern of the stiffness; returns the largest entry of E.
fn step<T: Entry>(
    (stiffness, [m, k], by): (&Csc, [&[T]; 2], Products<T>),
    values: &mut [f64],
    x: &mut [T],
    interrupt: &Interrupt<'_>,
) -> Result<f64> {
    let n = stiffness.rows;
    let zeros = || try_vec(n * n, T::NONE, CONTEXT);
    let (mut strained, mut moved) = (zeros()?, zeros()?);
    multiply((stiffness, by.plain), m, x, &mut moved, interrupt)?;
    multiply((stiffness, by.plain), k, x, &mut strained, interrupt)?;
    strain_soft_exactly(stiffness, x, &mut strained, interrupt)?;
    let (mut s, mut r) = (zeros()?, zeros()?);
    for (to, y) in [(&mut s, &moved), (&mut r, &strained)] {
        interrupt.check_before(8 * (n * n * n) as u64)?;
        (by.adjoint)(x, y, to, n);
    }
    // A soft motion has the more exact products, and is the later one: μ rises.
    for j in 0..n {
        values[j] = s[j * n + j].complex().re / r[j * n + j].complex().re;
        for i in 0..=j {
            let mut own = r[j * n + i].scaled(-1.0);
            if i == j {
                own.add_product(T::of(Complex64::ONE), T::of(Complex64::ONE));
            }
            r[j * n + i] = own;
            r[i * n + j] = own.conjugated();
            s[i * n + j] = s[j * n + i].conjugated();
        }
    }
    let mut largest = 0.0_f64;
    for j in 0..n {
        for i in 0..n {
            let at = j * n + i;
            let gap = values[j] - values[i];
            let half = r[at].scaled(0.5);
            let own = if gap.abs() > EQUAL_VALUES * values[i].abs().max(values[j].abs()) {
                let mut sum = s[at];
                sum.add_product(r[at], T::of(values[j].into()));
                sum.scaled(gap.recip())
            } else {
                half
            };
            // No small step: vectors of a group.
            moved[at] = if modulus(&own.complex()) <= LARGEST_STEP {
                own
            } else {
                half
            };
            largest = largest.max(modulus(&moved[at].complex()));
        }
    }
    (by.plain)(x, &moved, &mut strained, n);
    for (x, change) in x.iter_mut().zip(&strained) {
        x.add_product(*change, T::of(Complex64::ONE));
    }
    Ok(largest)
}

/// Recomputes products with K in twice the precision for motions that hardly strain the structure.
fn strain_soft_exactly<T: Entry>(
    stiffness: &Csc,
    x: &[T],
    strained: &mut [T],
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    let n = stiffness.rows;
    let mut sums = try_vec(n, ComplexSum::default(), CONTEXT)?;
    let mut whole = try_vec(n, Complex64::ZERO, CONTEXT)?;
    let terms = terms_of_all(stiffness, x, interrupt)?;
    for ((x, strained), terms) in x.chunks_exact(n).zip(strained.chunks_exact_mut(n)).zip(terms) {
        // φᴴ K φ is 1.
        if terms > SOFT_TERMS {
            interrupt.check_before(20 * stiffness.values.len() as u64)?;
            for (to, x) in whole.iter_mut().zip(x) {
                *to = x.complex();
            }
            sums.fill(ComplexSum::default());
            quadratic::product(stiffness, &stiffness.values, &whole, &mut sums);
            for (to, sum) in strained.iter_mut().zip(&sums) {
                *to = T::of(sum.total());
            }
        }
    }
    Ok(())
}

/// The sum of the moduli of the terms of φᴴ K φ for each motion; by blocks where most entries are there.
fn terms_of_all<T: Entry>(stiffness: &Csc, x: &[T], interrupt: &Interrupt<'_>) -> Result<Vec<f64>> {
    let n = stiffness.rows;
    let sizes = moduli(&stiffness.values)?;
    let mut found = try_vec(n, 0.0, CONTEXT)?;
    if n <= LOOPS_UP_TO || MANY_ENTRIES * sizes.len() <= n * n {
        let mut size = try_vec(n, 0.0, CONTEXT)?;
        for (found, x) in found.iter_mut().zip(x.chunks_exact(n)) {
            interrupt.check_before(2 * sizes.len() as u64)?;
            for (to, x) in size.iter_mut().zip(x) {
                *to = modulus(&x.complex());
            }
            *found = terms_of_moduli(stiffness, &sizes, &size);
        }
        return Ok(found);
    }
    let mut of_motions = try_vec(n * n, 0.0, CONTEXT)?;
    for (to, x) in of_motions.iter_mut().zip(x) {
        *to = modulus(&x.complex());
    }
    interrupt.check_before(2 * (n * n * n) as u64)?;
    let (mut of_stiffness, mut sums) = (try_vec(n * n, 0.0, CONTEXT)?, try_vec(n * n, 0.0, CONTEXT)?);
    for j in 0..n {
        for at in stiffness.col_ptr[j]..stiffness.col_ptr[j + 1] {
            of_stiffness[j * n + stiffness.row_idx[at]] = sizes[at];
        }
    }
    real_product(square(&of_stiffness, n), square(&of_motions, n), &mut sums);
    for (found, (size, sum)) in found
        .iter_mut()
        .zip(of_motions.chunks_exact(n).zip(sums.chunks_exact(n)))
    {
        *found = dot(size, sum);
    }
    Ok(found)
}

/// |z|, without care for numbers whose square is out of range.
fn modulus(z: &Complex64) -> f64 {
    z.norm_sqr().sqrt()
}

fn moduli(of: &[Complex64]) -> Result<Vec<f64>> {
    let mut found = try_vec(of.len(), 0.0, CONTEXT)?;
    for (to, z) in found.iter_mut().zip(of) {
        *to = modulus(z);
    }
    Ok(found)
}

/// Y ← A X for values on a pattern; A is treated as dense where most of its entries are present.
fn multiply<T: Entry>(
    (pattern, plain): (&Csc, Product<T>),
    values: &[T],
    x: &[T],
    y: &mut [T],
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    let n = pattern.rows;
    let entries = |j: usize| pattern.col_ptr[j]..pattern.col_ptr[j + 1];
    if MANY_ENTRIES * values.len() > n * n {
        interrupt.check_before(8 * (n * n * n) as u64)?;
        let mut whole = try_vec(n * n, T::NONE, CONTEXT)?;
        for j in 0..n {
            for at in entries(j) {
                whole[j * n + pattern.row_idx[at]] = values[at];
            }
        }
        plain(&whole, x, y, n);
        return Ok(());
    }
    y.fill(T::NONE);
    for (x, y) in x.chunks_exact(n).zip(y.chunks_exact_mut(n)) {
        interrupt.check_before(8 * values.len() as u64)?;
        for (j, x) in x.iter().enumerate() {
            for at in entries(j) {
                y[pattern.row_idx[at]].add_product(values[at], *x);
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frequencies_of_a_chain_are_those_in_closed_form() {
        // Unit masses and springs between walls: ω = 2 sin(jπ/2(n + 1)).
        let n = 200_usize;
        let entry = |i: usize, j: usize| [2.0, -1.0].get(i.abs_diff(j)).copied().unwrap_or(0.0);
        let mut triplets = Vec::new();
        for j in 0..n {
            for i in usize::saturating_sub(j, 1)..(j + 2).min(n) {
                triplets.push((i, j, Complex64::from(entry(i, j))));
            }
        }
        let stiffness = Csc::from_triplets(n, n, triplets).unwrap();
        let mass: Vec<Complex64> = (0..n)
            .flat_map(|j| {
                stiffness
                    .column(j)
                    .map(move |(i, _)| f64::from(u8::from(i == j)).into())
            })
            .collect();
        let pairs = modes(&stiffness, &mass, &Interrupt::none()).unwrap();
        for (k, mu) in pairs.values.iter().rev().enumerate() {
            let exact = 2.0 * (0.5 * (k + 1) as f64 * std::f64::consts::PI / (n + 1) as f64).sin();
            let off = (mu.sqrt().recip() / exact - 1.0).abs();
            assert!(off < 2e-14, "mode {k}: {off:e}");
        }
    }
}
