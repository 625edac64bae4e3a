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

use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::complex_products::{self, multiply_adjoint};
use crate::linalg::eigen::{self, Pairs};
use crate::linalg::quadratic::{self, ComplexSum, terms_of_moduli};
use crate::linalg::sparse::Csc;
use nalgebra::DMatrix;
use num_complex::Complex64;

const CONTEXT: &str = "the modes of the structure";

/// Terms of φᴴ K φ over its value from which a product with K is made in twice the precision.
const SOFT_TERMS: f64 = 100.0;

/// Relative distance of eigenvalues that count as equal, and the largest entry of E.
const EQUAL_VALUES: f64 = 1e-9;
const LARGEST_STEP: f64 = 0.1;

/// Entry of E above which a further step is made, and the most steps.
const STEP_AGAIN: f64 = 1e-7;
const MOST_STEPS: usize = 4;

/// μ, rising, and φ of a Hermitian pencil, `mass` on the pattern of K.
///
/// # Errors
/// As [`eigen::generalised`].
pub(super) fn modes(stiffness: &Csc, mass: &[Complex64], interrupt: &Interrupt<'_>) -> Result<Pairs> {
    interrupt.check()?;
    let n = stiffness.rows;
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

/// Steps until they are small; whether they are.
fn refine(stiffness: &Csc, mass: &[Complex64], pairs: &mut Pairs, interrupt: &Interrupt<'_>) -> Result<bool> {
    if stiffness.rows < 2 {
        return Ok(true);
    }
    for _ in 0..MOST_STEPS {
        if step(stiffness, mass, pairs, interrupt)? <= STEP_AGAIN {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The dense matrix with these values at the entries of a pattern.
pub(super) fn dense(pattern: &Csc, values: &[Complex64]) -> Result<DMatrix<Complex64>> {
    let n = pattern.rows;
    let mut a = try_vec(n * n, Complex64::ZERO, CONTEXT)?;
    for j in 0..n {
        for at in pattern.col_ptr[j]..pattern.col_ptr[j + 1] {
            a[j * n + pattern.row_idx[at]] = values[at];
        }
    }
    Ok(DMatrix::from_vec(n, n, a))
}

/// One step; returns the largest entry of E.
fn step(stiffness: &Csc, mass: &[Complex64], pairs: &mut Pairs, interrupt: &Interrupt<'_>) -> Result<f64> {
    let n = stiffness.rows;
    let zeros = || try_vec(n * n, Complex64::ZERO, CONTEXT);
    let Pairs { values, vectors } = pairs;
    let x = vectors.as_mut_slice();
    let (mut strained, mut moved) = (zeros()?, zeros()?);
    let mut sums = try_vec(n, ComplexSum::default(), CONTEXT)?;
    let (sizes, mut size) = (moduli(&stiffness.values)?, try_vec(n, 0.0, CONTEXT)?);
    let is_full = stiffness.values.len() == n * n;
    if is_full {
        for (values, to) in [(mass, &mut moved), (&stiffness.values[..], &mut strained)] {
            interrupt.check_before(8 * (n * n * n) as u64)?;
            complex_products::multiply(values, x, to, n);
        }
    }
    let columns = strained.chunks_exact_mut(n).zip(moved.chunks_exact_mut(n));
    for (x, (strained, moved)) in x.chunks_exact(n).zip(columns) {
        interrupt.check_before(20 * stiffness.values.len() as u64)?;
        if !is_full {
            multiply(stiffness, mass, x, moved);
        }
        for (to, x) in size.iter_mut().zip(x) {
            *to = modulus(x);
        }
        // φᴴ K φ is 1.
        if terms_of_moduli(stiffness, &sizes, &size) > SOFT_TERMS {
            sums.fill(ComplexSum::default());
            quadratic::product(stiffness, &stiffness.values, x, &mut sums);
            for (to, sum) in strained.iter_mut().zip(&sums) {
                *to = sum.total();
            }
        } else if !is_full {
            multiply(stiffness, &stiffness.values, x, strained);
        }
    }
    let (mut s, mut r) = (zeros()?, zeros()?);
    for (to, y) in [(&mut s, &moved), (&mut r, &strained)] {
        interrupt.check_before(8 * (n * n * n) as u64)?;
        multiply_adjoint(x, y, to, n);
    }
    // A soft motion has the more exact products, and is the later one: μ rises.
    for j in 0..n {
        values[j] = s[j * n + j].re / r[j * n + j].re;
        for i in 0..=j {
            let own = if i == j { 1.0 } else { 0.0 };
            r[j * n + i] = own - r[j * n + i];
            r[i * n + j] = r[j * n + i].conj();
            s[i * n + j] = s[j * n + i].conj();
        }
    }
    let mut largest = 0.0_f64;
    for j in 0..n {
        for i in 0..n {
            let at = j * n + i;
            let gap = values[j] - values[i];
            let half = 0.5 * r[at];
            let own = if gap.abs() > EQUAL_VALUES * values[i].abs().max(values[j].abs()) {
                (s[at] + values[j] * r[at]) / gap
            } else {
                half
            };
            // No small step: vectors of a group.
            moved[at] = if own.norm() <= LARGEST_STEP { own } else { half };
            largest = largest.max(moved[at].norm());
        }
    }
    complex_products::multiply(x, &moved, &mut strained, n);
    for (x, change) in x.iter_mut().zip(&strained) {
        *x += change;
    }
    Ok(largest)
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

/// y ← A x for values on a pattern.
fn multiply(pattern: &Csc, values: &[Complex64], x: &[Complex64], y: &mut [Complex64]) {
    y.fill(Complex64::ZERO);
    for (j, x) in x.iter().enumerate() {
        for at in pattern.col_ptr[j]..pattern.col_ptr[j + 1] {
            y[pattern.row_idx[at]] += values[at] * x;
        }
    }
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
