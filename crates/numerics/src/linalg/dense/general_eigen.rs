//! Eigenvalues and right eigenvectors of a dense matrix without symmetry: Hessenberg form, shifted QR iteration with deflation,
//! vectors by back substitution (Golub & Van Loan, Matrix Computations, 2013, §7). A real matrix takes a third of the time.

use crate::error::{Error, Result, check_memory, fail, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::complex_products;
use faer::diag::DiagMut;
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::evd::{ComputeEigenvectors, evd_cplx, evd_real, evd_scratch};
use faer::{MatMut, MatRef, Par, Spec};
use nalgebra::{DMatrix, Schur};
use num_complex::Complex64;

/// Error of vectors, over the largest entry of the matrix, that is more than rounding.
/// Kind: rounding.
const WRONG_VECTORS: f64 = 1e-9;

/// Order up to which a real matrix may be treated as a complex one.
/// Kind: tuned; measured on: not recorded.
const AS_COMPLEX_UP_TO: usize = 600;

/// Order up to which a host with a small stack may ask for eigenpairs.
/// Kind: tuned; measured on: rotors of 2 to 100 degrees of freedom, Schur's form of order 64 takes 10 ms.
const SMALL_STACK_UP_TO: usize = 64;

/// Iterations of Schur's form for each eigenvalue.
/// Kind: cap.
const SCHUR_ITERATIONS: usize = 200;

/// Square matrices that Schur's form holds at a time.
/// Kind: fixed.
const SCHUR_COPIES: usize = 6;

const CONTEXT: &str = "the eigenvalues of a matrix";

/// Eigenvalues, and vectors scaled to size 1, column after column.
pub struct Pairs {
    /// Eigenvalues λ.
    pub values: Vec<Complex64>,
    /// Vectors x with A x = λ x, column after column.
    pub vectors: Vec<Complex64>,
}

impl Pairs {
    /// Memory for n pairs.
    fn new(n: usize) -> Result<Self> {
        let zeros = |len| try_vec(len, Complex64::ZERO, CONTEXT);
        Ok(Self {
            values: zeros(n)?,
            vectors: zeros(n * n)?,
        })
    }

    /// Scales the vectors to size 1.
    fn scale(&mut self, n: usize) {
        for x in self.vectors.chunks_exact_mut(n.max(1)) {
            let size = x.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
            for z in x {
                *z /= size;
            }
        }
    }
}

/// Eigenpairs of the column-major matrix `a` of order n. The interrupt is checked before, not within. Large real matrices with pairs of
/// equal eigenvalues are refused.
///
/// # Errors
/// `NoConvergence`, `OutOfMemory`; `StoppedByCaller`.
pub fn eigen(a: &[Complex64], n: usize, interrupt: &Interrupt<'_>) -> Result<Pairs> {
    up_to(a, n, AS_COMPLEX_UP_TO, interrupt)
}

/// Eigenpairs as [`eigen`] finds them, whatever time a real matrix takes; of a small one on a small stack, of which products in blocks
/// take 90 kB.
///
/// # Errors
/// As [`eigen`].
pub fn eigen_of_any_order(a: &[Complex64], n: usize, interrupt: &Interrupt<'_>) -> Result<Pairs> {
    if n > SMALL_STACK_UP_TO {
        return up_to(a, n, usize::MAX, interrupt);
    }
    interrupt.check()?;
    let mut found = Pairs::new(n)?;
    if a.iter().all(|z| z.is_finite()) && by_schur(a, n, &mut found)? {
        found.scale(n);
        return Ok(found);
    }
    fail!(NoConvergence, "the eigenvalues of a matrix of order {n} were not found")
}

/// Eigenpairs, where a real matrix may be treated as a complex one up to an order.
fn up_to(a: &[Complex64], n: usize, as_complex: usize, interrupt: &Interrupt<'_>) -> Result<Pairs> {
    interrupt.check()?;
    if a.iter().any(|z| !z.is_finite()) {
        return fail!(NoConvergence, "a matrix of order {n} is not finite");
    }
    let mut found = Pairs::new(n)?;
    if n == 0 {
        return Ok(found);
    }
    let is_real = a.iter().all(|z| z.im == 0.0);
    // Where pairs of complex eigenvalues are equal, faer 0.24 returns wrong vectors of a real matrix.
    let done = is_real && of_real(a, n, &mut found)? && error(a, n, &found)? <= WRONG_VECTORS;
    let may_be_complex = !is_real || n <= as_complex;
    if !(done || may_be_complex && (of_complex(a, n, &mut found)? || by_schur(a, n, &mut found)?)) {
        return fail!(NoConvergence, "the eigenvalues of a matrix of order {n} were not found");
    }
    found.scale(n);
    Ok(found)
}

/// The eigenvalues alone. The interrupt is checked before, not within.
///
/// # Errors
/// As [`eigen`].
pub fn values(a: &[Complex64], n: usize, interrupt: &Interrupt<'_>) -> Result<Vec<Complex64>> {
    interrupt.check()?;
    let mut values = try_vec(n, Complex64::ZERO, CONTEXT)?;
    if n == 0 {
        return Ok(values);
    }
    let (no, by_default) = (ComputeEigenvectors::No, Spec::default());
    let mut scratch = memory(evd_scratch::<Complex64>(n, no, no, Par::Seq, by_default))?;
    let done = evd_cplx(
        MatRef::from_column_major_slice(a, n, n),
        DiagMut::from_slice_mut(&mut values),
        None,
        None,
        Par::Seq,
        MemStack::new(&mut scratch),
        by_default,
    );
    if done.is_err() || a.iter().any(|z| !z.is_finite()) {
        return fail!(NoConvergence, "the eigenvalues of a matrix of order {n} were not found");
    }
    Ok(values)
}

/// Error of eigenpairs: largest entry of A X − X Λ over that of A, for vectors of size 1.
fn error(a: &[Complex64], n: usize, pairs: &Pairs) -> Result<f64> {
    let mut product = try_vec(n * n, Complex64::ZERO, CONTEXT)?;
    complex_products::multiply(a, &pairs.vectors, &mut product, n);
    let largest = a.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
    let mut worst = 0.0_f64;
    let columns = product.chunks_exact(n).zip(pairs.vectors.chunks_exact(n));
    for ((y, x), value) in columns.zip(&pairs.values) {
        let size = x.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
        for (y, x) in y.iter().zip(x) {
            let off = (y - value * x).norm();
            if off.is_nan() {
                return Ok(f64::INFINITY);
            }
            worst = worst.max(off / size);
        }
    }
    Ok(worst / largest.max(f64::MIN_POSITIVE))
}

fn memory(need: StackReq) -> Result<MemBuffer> {
    MemBuffer::try_new(need).map_err(|_| Error::out_of_memory(CONTEXT))
}

fn of_complex(a: &[Complex64], n: usize, found: &mut Pairs) -> Result<bool> {
    let (no, yes, by_default) = (ComputeEigenvectors::No, ComputeEigenvectors::Yes, Spec::default());
    let mut scratch = memory(evd_scratch::<Complex64>(n, no, yes, Par::Seq, by_default))?;
    let done = evd_cplx(
        MatRef::from_column_major_slice(a, n, n),
        DiagMut::from_slice_mut(&mut found.values),
        None,
        Some(MatMut::from_column_major_slice_mut(&mut found.vectors, n, n)),
        Par::Seq,
        MemStack::new(&mut scratch),
        by_default,
    );
    Ok(done.is_ok())
}

/// Eigenpairs from Schur's form Q T Qᴴ: (T − t_jj) y = 0 by back substitution, where equal eigenvalues keep independent vectors. It takes
/// four times the time, for matrices on which the iteration of faer 0.24 ends without a result.
fn by_schur(a: &[Complex64], n: usize, found: &mut Pairs) -> Result<bool> {
    check_memory::<Complex64>((SCHUR_COPIES * n).saturating_mul(n), CONTEXT)?;
    let matrix = DMatrix::from_column_slice(n, n, a);
    let Some(schur) = Schur::try_new(matrix, f64::EPSILON, SCHUR_ITERATIONS * n) else {
        return Ok(false);
    };
    let (q, t) = schur.unpack();
    let least = f64::EPSILON * t.norm();
    let mut y = try_vec(n, Complex64::ZERO, CONTEXT)?;
    for (j, x) in found.vectors.chunks_exact_mut(n).enumerate() {
        let value = t[(j, j)];
        y[j] = Complex64::ONE;
        for i in (0..j).rev() {
            let sum: Complex64 = (i + 1..=j).map(|l| t[(i, l)] * y[l]).sum();
            let gap = t[(i, i)] - value;
            y[i] = -sum / if gap.norm() < least { least.into() } else { gap };
        }
        for (i, x) in x.iter_mut().enumerate() {
            *x = (0..=j).map(|l| q[(i, l)] * y[l]).sum();
        }
        found.values[j] = value;
    }
    Ok(true)
}

fn of_real(a: &[Complex64], n: usize, found: &mut Pairs) -> Result<bool> {
    let zeros = |len| try_vec(len, 0.0, CONTEXT);
    let (mut real, mut re, mut im, mut vectors) = (zeros(n * n)?, zeros(n)?, zeros(n)?, zeros(n * n)?);
    for (to, z) in real.iter_mut().zip(a) {
        *to = z.re;
    }
    let (no, yes, by_default) = (ComputeEigenvectors::No, ComputeEigenvectors::Yes, Spec::default());
    let mut scratch = memory(evd_scratch::<f64>(n, no, yes, Par::Seq, by_default))?;
    let done = evd_real(
        MatRef::from_column_major_slice(&real, n, n),
        DiagMut::from_slice_mut(&mut re),
        DiagMut::from_slice_mut(&mut im),
        None,
        Some(MatMut::from_column_major_slice_mut(&mut vectors, n, n)),
        Par::Seq,
        MemStack::new(&mut scratch),
        by_default,
    );
    if done.is_err() {
        return Ok(false);
    }
    let mut k = 0;
    while k < n {
        let column = |k: usize| &vectors[k * n..(k + 1) * n];
        if im[k] == 0.0 || k + 1 == n {
            found.values[k] = re[k].into();
            for (to, x) in found.vectors[k * n..].iter_mut().zip(column(k)) {
                *to = (*x).into();
            }
            k += 1;
            continue;
        }
        // Real and imaginary parts of a conjugate pair stand side by side.
        for (at, sign) in [(k, 1.0), (k + 1, -1.0)] {
            found.values[at] = Complex64::new(re[k], sign * im[k]);
            let parts = column(k).iter().zip(column(k + 1));
            for (to, (x, y)) in found.vectors[at * n..].iter_mut().zip(parts) {
                *to = Complex64::new(*x, sign * y);
            }
        }
        k += 2;
    }
    Ok(true)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries(n: usize, is_complex: bool) -> Vec<Complex64> {
        let entry = |k: usize| {
            let re = ((k * k + 3 * k) as f64 * 0.71).sin();
            let im = ((k * k + 7 * k) as f64 * 0.37).cos();
            Complex64::new(re, if is_complex { im } else { 0.0 })
        };
        (0..n * n).map(entry).collect()
    }

    #[test]
    fn pairs_satisfy_their_equation_and_add_up_to_the_trace() {
        for n in [1, 2, 7, 40, 130] {
            for is_complex in [false, true] {
                let a = entries(n, is_complex);
                let pairs = eigen(&a, n, &Interrupt::none()).unwrap();
                let trace: Complex64 = (0..n).map(|k| a[k * n + k]).sum();
                let sum: Complex64 = pairs.values.iter().sum();
                let alone = values(&a, n, &Interrupt::none()).unwrap();
                for value in &pairs.values {
                    let nearest = alone.iter().map(|z| (z - value).norm()).fold(f64::INFINITY, f64::min);
                    assert!(nearest < 1e-11 * n as f64, "{n} {is_complex}: {nearest:e}");
                }
                assert!((sum - trace).norm() < 1e-12 * n as f64, "{n}: {sum} {trace}");
                for (value, x) in pairs.values.iter().zip(pairs.vectors.chunks_exact(n)) {
                    let size: f64 = x.iter().map(Complex64::norm_sqr).sum();
                    assert!((size - 1.0).abs() < 1e-12);
                    for i in 0..n {
                        let product: Complex64 = (0..n).map(|j| a[j * n + i] * x[j]).sum();
                        assert!((product - value * x[i]).norm() < 1e-12 * n as f64, "{n} {is_complex}");
                    }
                }
            }
        }
    }

    #[test]
    fn pairs_of_two_equal_blocks_satisfy_their_equation() {
        for half in [2, 5, 20] {
            for is_complex in [false, true] {
                let (n, block) = (2 * half, entries(half, is_complex));
                let mut a = vec![Complex64::ZERO; n * n];
                for (k, z) in block.iter().enumerate() {
                    for from in [0, half] {
                        a[(from + k / half) * n + from + k % half] = *z;
                    }
                }
                // The matrix after a reflection 1 − 2 v vᵀ, which hides the blocks.
                let v: Vec<f64> = (0..n).map(|k| (1.3 * k as f64).sin() + 0.2).collect();
                let square: f64 = v.iter().map(|v| v * v).sum();
                for transposed in [false, true] {
                    for j in 0..n {
                        let at = |i: usize| if transposed { i * n + j } else { j * n + i };
                        let along: Complex64 = (0..n).map(|i| v[i] * a[at(i)]).sum();
                        for i in 0..n {
                            a[at(i)] -= 2.0 * v[i] / square * along;
                        }
                    }
                }
                let pairs = eigen(&a, n, &Interrupt::none()).unwrap();
                let mut worst = 0.0_f64;
                for (value, x) in pairs.values.iter().zip(pairs.vectors.chunks_exact(n)) {
                    for i in 0..n {
                        let product: Complex64 = (0..n).map(|j| a[j * n + i] * x[j]).sum();
                        worst = worst.max((product - value * x[i]).norm());
                    }
                }
                assert!(worst < 1e-12 * n as f64, "{half} {is_complex}: {worst:e}");
            }
        }
    }

    #[test]
    fn schur_s_form_has_the_same_pairs() {
        for n in [1, 2, 9, 60] {
            let a = entries(n, true);
            let mut found = Pairs {
                values: vec![Complex64::ZERO; n],
                vectors: vec![Complex64::ZERO; n * n],
            };
            assert!(by_schur(&a, n, &mut found).unwrap());
            assert!(error(&a, n, &found).unwrap() < 1e-12);
        }
    }

    #[test]
    fn a_matrix_with_a_number_that_is_none_is_an_error() {
        let a = [Complex64::new(f64::NAN, 0.0)];
        assert!(eigen(&a, 1, &Interrupt::none()).is_err());
    }
}
