//! The motions that a basis needs most: the leading directions of the residuals that its certificate has found.
//!
//! The residuals E X of many forces, with the Gram matrix G = EᴴAE of the images that the basis lacks, have the singular values and
//! directions of XᴴGX = U Λ Uᴴ in the norm of A: the columns of E X U Λ^{-1/2}. They fall by many powers of ten, so that a part of E is
//! enough (residuals choose the basis of a reduced-basis method in the same way: Hesthaven, Rozza & Stamm 2016,
//! doi:10.1007/978-3-319-22470-1, §3.2).

use crate::error::{Result, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::complex_products::{multiply, multiply_adjoint};
use crate::linalg::dense::hermitian;
use crate::linalg::sparse_storage::triangle::Entry;
use num_complex::Complex64;

const CONTEXT: &str = "the reduced structure";

/// Residual over its limit that directions are left out for.
/// Kind: tuned; measured on: not recorded.
const LEFT_OUT: f64 = 0.3;

/// Share of the candidates from which all of them are taken.
/// Kind: tuned; measured on: not recorded.
const NEARLY_ALL: f64 = 0.75;

/// Eigenvalue over the largest one that is rounding.
/// Kind: rounding.
const RESIDUAL_DIRECTIONS_ROUNDING: f64 = 1e-13;

/// Combinations W of the candidates, column after column, such that every residual is below a share of `limit` without its part along
/// them, but at least `least`; `None` where that takes nearly all candidates, or there are no residuals. `gram` is G, `residuals` are the
/// columns of X.
///
/// # Errors
/// `OutOfMemory`, `NoConvergence`; `StoppedByCaller`.
pub(crate) fn residual_directions<T: Entry>(
    gram: &[Complex64],
    residuals: &[Complex64],
    (limit, least): (f64, usize),
    interrupt: &Interrupt<'_>,
) -> Result<Option<Vec<Complex64>>> {
    let candidates = gram.len().isqrt();
    if candidates == 0 || residuals.is_empty() {
        return Ok(None);
    }
    let mut x = Vec::new();
    for part in 0..if T::IS_COMPLEX { 1 } else { 2 } {
        for z in residuals {
            // Real directions have both parts as columns.
            let own = match (T::IS_COMPLEX, part) {
                (true, _) => *z,
                (false, 0) => z.re.into(),
                (false, _) => z.im.into(),
            };
            try_push(&mut x, own, CONTEXT)?;
        }
    }
    let columns = x.len() / candidates;
    interrupt.check_before((8 * candidates * columns * (candidates + columns)) as u64)?;
    let mut image = try_vec(x.len(), Complex64::ZERO, CONTEXT)?;
    multiply(gram, &x, &mut image, candidates);
    let mut a = try_vec(columns * columns, Complex64::ZERO, CONTEXT)?;
    multiply_adjoint(&x, &image, &mut a, candidates);
    for j in 0..columns {
        for i in 0..=j {
            let mean = 0.5 * (a[j * columns + i] + a[i * columns + j].conj());
            a[j * columns + i] = mean;
            a[i * columns + j] = mean.conj();
        }
    }
    let (values, vectors) = hermitian::eigen(&mut a, columns, interrupt)?;
    let Some(&largest) = values.last().filter(|value| **value > 0.0) else {
        return Ok(None);
    };
    let count = needed((&values, &vectors), (LEFT_OUT * limit).powi(2))?.max(least);
    let real = values
        .iter()
        .rev()
        .take_while(|&&value| value > RESIDUAL_DIRECTIONS_ROUNDING * largest)
        .count();
    let count = count.min(real);
    if count as f64 > NEARLY_ALL * candidates as f64 {
        return Ok(None);
    }
    let mut turn = Vec::new();
    for k in (columns - count..columns).rev() {
        let scale = values[k].sqrt().recip();
        for z in &vectors[k * columns..(k + 1) * columns] {
            try_push(&mut turn, z * scale, CONTEXT)?;
        }
    }
    let mut choice = try_vec(candidates * count, Complex64::ZERO, CONTEXT)?;
    multiply(&x, &turn, &mut choice, candidates);
    Ok(Some(choice))
}

/// Number of leading directions without whose part the square of no residual exceeds `allowed`; eigenvalues rise.
fn needed((values, vectors): (&[f64], &[Complex64]), allowed: f64) -> Result<usize> {
    let columns = values.len();
    let mut left = try_vec(columns, 0.0, CONTEXT)?;
    for (k, value) in values.iter().enumerate() {
        for (left, u) in left.iter_mut().zip(&vectors[k * columns..(k + 1) * columns]) {
            *left += value.max(0.0) * u.norm_sqr();
            if *left > allowed {
                return Ok(columns - k);
            }
        }
    }
    Ok(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CANDIDATES: usize = 60;
    const FORCES: usize = 25;
    const LIMIT: f64 = 1e-6;

    fn number(k: usize) -> Complex64 {
        Complex64::new((1.3 * k as f64).sin(), (0.7 * (k * k) as f64).cos())
    }

    /// Images that are orthogonal and become small, of forces whose residuals have them all: what is left of these.
    fn check<T: Entry>() {
        let size = |i: usize| 10.0_f64.powf(-(i as f64) / 5.0);
        let mut gram = vec![Complex64::ZERO; CANDIDATES * CANDIDATES];
        for i in 0..CANDIDATES {
            gram[i * CANDIDATES + i] = (size(i) * size(i)).into();
        }
        let x: Vec<Complex64> = (0..CANDIDATES * FORCES).map(number).collect();
        let none = Interrupt::none();
        let choice = residual_directions::<T>(&gram, &x, (LIMIT, 3), &none).unwrap().unwrap();
        let images = |z: &[Complex64]| -> Vec<Complex64> { z.iter().enumerate().map(|(i, z)| size(i) * z).collect() };
        let chosen: Vec<Vec<Complex64>> = choice.chunks(CANDIDATES).map(images).collect();
        assert!(chosen.len() >= 20 && chosen.len() <= 45, "{}", chosen.len());
        assert!(T::IS_COMPLEX || choice.iter().all(|z| z.im == 0.0));
        let along = |u: &[Complex64], r: &[Complex64]| u.iter().zip(r).map(|(u, r)| u.conj() * r).sum::<Complex64>();
        for (i, u) in chosen.iter().enumerate() {
            for (j, v) in chosen.iter().enumerate() {
                let exact = f64::from(u8::from(i == j));
                assert!((along(u, v) - exact).norm() < 1e-2, "{i}, {j}: {}", along(u, v));
            }
        }
        for x in x.chunks(CANDIDATES) {
            let mut rest = images(x);
            // More than once: the directions are orthonormal to a few digits.
            for _ in 0..8 {
                for u in &chosen {
                    let part = along(u, &rest);
                    for (r, u) in rest.iter_mut().zip(u) {
                        *r -= part * u;
                    }
                }
            }
            let left = along(&rest, &rest).re.sqrt();
            assert!(left <= LEFT_OUT * LIMIT * 1.01, "{left:e}");
        }
    }

    #[test]
    fn without_the_chosen_directions_residuals_are_below_their_limit() {
        check::<Complex64>();
        check::<f64>();
    }

    #[test]
    fn nearly_all_candidates_and_no_residuals_leave_no_choice() {
        let (n, none) = (40, Interrupt::none());
        let mut gram = vec![Complex64::ZERO; n * n];
        for i in 0..n {
            gram[i * n + i] = Complex64::ONE;
        }
        let x: Vec<Complex64> = (0..n * n).map(number).collect();
        let all = residual_directions::<Complex64>(&gram, &x, (1e-8, 2), &none).unwrap();
        assert!(all.is_none());
        assert!(
            residual_directions::<Complex64>(&gram, &[], (1e-8, 2), &none)
                .unwrap()
                .is_none()
        );
    }
}
