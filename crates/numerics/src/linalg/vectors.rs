//! Products and norms of plain vectors.

use crate::error::{Result, try_vec};
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use num_complex::Complex64;
use pulp::{Arch, Simd, WithSimd};

/// Inner product aᴴ b.
#[must_use]
#[inline]
pub fn inner(a: &[Complex64], b: &[Complex64]) -> Complex64 {
    a.iter().zip(b).map(|(a, b)| a.conj() * b).sum()
}

/// Inner product aᴴ b in four partial sums, which the processor adds in parallel.
#[must_use]
#[inline]
pub fn inner_in_parts(a: &[Complex64], b: &[Complex64]) -> Complex64 {
    let mut sums = [Complex64::ZERO; 4];
    let (left, right) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest = inner(left.remainder(), right.remainder());
    for (a, b) in left.zip(right) {
        for ((s, a), b) in sums.iter_mut().zip(a).zip(b) {
            *s += a.conj() * b;
        }
    }
    sums.iter().sum::<Complex64>() + rest
}

/// Share of a vector that is left after its components are removed, from which that need not be repeated: once leaves rounding of the
/// size of the vector before, relative to it after (Giraud & Langou 2002, doi:10.1093/imanum/22.4.521).
/// Kind: rounding.
pub const ENOUGH_LEFT: f64 = 0.5;

/// v ← v − part q.
#[inline]
pub fn remove(v: &mut [Complex64], q: &[Complex64], part: Complex64) {
    for (v, q) in v.iter_mut().zip(q) {
        *v -= part * q;
    }
}

/// Product Σ aⱼ bⱼ in eight partial sums, which the processor adds in parallel.
#[must_use]
#[inline(always)]
#[allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (left, right) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = left.remainder().iter().zip(right.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in left.zip(right) {
        for ((s, a), b) in sums.iter_mut().zip(a).zip(b) {
            *s += a * b;
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// Sum of squares above which those that are lost below the smallest number are rounding.
/// Kind: rounding.
pub const SAFE_SQUARES: f64 = 1e-280;

/// Euclidean norm that neither overflows nor underflows.
#[must_use]
#[inline]
pub fn norm(v: &[f64]) -> f64 {
    let squares = v.iter().map(|x| x * x).sum::<f64>();
    // Neither an overflow nor squares lost below the smallest number.
    if squares > SAFE_SQUARES && squares < f64::INFINITY {
        return squares.sqrt();
    }
    let largest = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if largest == 0.0 || !largest.is_finite() {
        return if v.iter().any(|x| x.is_nan()) {
            f64::NAN
        } else {
            largest
        };
    }
    largest * v.iter().map(|x| (x / largest).powi(2)).sum::<f64>().sqrt()
}

/// The power of two nearest below `x`, for scaling without rounding; 1 where `x` is 0 or not finite.
#[must_use]
#[inline]
pub fn power_of_two(x: f64) -> f64 {
    if x > 0.0 && x.is_finite() {
        x.log2().floor().clamp(-1020.0, 1020.0).exp2()
    } else {
        1.0
    }
}

/// Multiplications up to which a product with the transpose of a matrix is one of plain loops. faer copies the matrix then, and
/// takes 128 KiB of stack for the copy.
/// Kind: tuned; measured on: not recorded.
pub const COPIED_UP_TO: usize = 16 * 16 * 16;

/// Computes a product of matrices so large that the memory for packing them, which each thread keeps, exists
/// afterwards.
///
/// # Errors
/// `OutOfMemory` for the matrices.
#[inline]
pub fn first_product() -> Result<()> {
    /// Order of the matrices, above which products keep memory.
    /// Kind: tuned; measured on: not recorded.
    const ORDER: usize = 40;
    let mut out = try_vec(ORDER * ORDER, 0.0_f64, "a product")?;
    let one = try_vec(ORDER * ORDER, 1.0_f64, "a product")?;
    matmul(
        MatMut::from_column_major_slice_mut(&mut out, ORDER, ORDER),
        Accum::Add,
        MatRef::from_column_major_slice(&one, ORDER, ORDER),
        MatRef::from_column_major_slice(&one, ORDER, ORDER),
        1.0,
        Par::Seq,
    );
    Ok(())
}

/// x ← Φ ξ for a column-major Φ with `x.len()` rows.
#[inline]
pub fn expand(vectors: &[Complex64], xi: &[Complex64], x: &mut [Complex64]) {
    x.fill(Complex64::ZERO);
    for (shape, xi) in vectors.chunks_exact(x.len().max(1)).zip(xi) {
        for (x, shape) in x.iter_mut().zip(shape) {
            *x += shape * xi;
        }
    }
}

/// out ← out + factor·A x for a column-major A with `out.len()` rows.
#[inline]
pub fn add_product(factor: f64, a: &[f64], x: &[f64], out: &mut [f64]) {
    Arch::new().dispatch(Product(factor, a, x, out));
}

/// The arguments of [`add_product`].
struct Product<'a>(f64, &'a [f64], &'a [f64], &'a mut [f64]);

impl WithSimd for Product<'_> {
    type Output = ();

    #[inline(always)]
    #[allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Self(factor, a, x, out) = self;
        let rows = out.len();
        // With few rows most of the time would be spent around loops of unknown length.
        match rows {
            2 => return few_rows::<2>(factor, a, x, out),
            4 => return few_rows::<4>(factor, a, x, out),
            6 => return few_rows::<6>(factor, a, x, out),
            8 => return few_rows::<8>(factor, a, x, out),
            10 => return few_rows::<10>(factor, a, x, out),
            12 => return few_rows::<12>(factor, a, x, out),
            _ => {}
        }
        // Four columns at a time are summed before they are stored.
        let (fours, rest) = x.as_chunks::<4>();
        let (of_fours, of_rest) = a.split_at(4 * fours.len() * rows);
        for (columns, x) in of_fours.chunks_exact((4 * rows).max(1)).zip(fours) {
            let x = x.map(|x| factor * x);
            let (first, second) = columns.split_at(2 * rows);
            let ((a, b), (c, d)) = (first.split_at(rows), second.split_at(rows));
            let (blocks, last) = out.as_chunks_mut::<4>();
            let [(a, a_last), (b, b_last), (c, c_last), (d, d_last)] =
                [a, b, c, d].map(|column| column.as_chunks::<4>());
            for ((((out, a), b), c), d) in blocks.iter_mut().zip(a).zip(b).zip(c).zip(d) {
                for i in 0..4 {
                    out[i] += (a[i] * x[0] + b[i] * x[1]) + (c[i] * x[2] + d[i] * x[3]);
                }
            }
            for (i, out) in last.iter_mut().enumerate() {
                *out += (a_last[i] * x[0] + b_last[i] * x[1]) + (c_last[i] * x[2] + d_last[i] * x[3]);
            }
        }
        for (column, x) in of_rest.chunks_exact(rows.max(1)).zip(rest) {
            let x = factor * x;
            for (out, a) in out.iter_mut().zip(column) {
                *out += a * x;
            }
        }
    }
}

/// Adds the product for N rows, which are summed in registers.
#[inline(always)]
#[allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]
fn few_rows<const N: usize>(factor: f64, a: &[f64], x: &[f64], out: &mut [f64]) {
    let mut sum = [0.0; N];
    for (column, x) in a.as_chunks::<N>().0.iter().zip(x) {
        let x = factor * x;
        for i in 0..N {
            sum[i] += column[i] * x;
        }
    }
    for (out, sum) in out.iter_mut().zip(sum) {
        *out += sum;
    }
}

/// Adds Σⱼ aⱼ bⱼᵀ to the first `rows` numbers of each column of a column-major matrix. The rows aⱼ have `rows`
/// numbers; of the rows bⱼ, which are `apart`, the first `columns` are used, as many as the matrix has columns.
/// Columns of the matrix are `stride` apart.
#[inline]
pub fn add_outer_products_to(
    (a, rows): (&[f64], usize),
    (b, columns, apart): (&[f64], usize, usize),
    stride: usize,
    matrix: &mut [f64],
) {
    let count = a.len() / rows.max(1);
    matmul(
        MatMut::from_column_major_slice_with_stride_mut(matrix, rows, columns, stride),
        Accum::Add,
        MatRef::from_column_major_slice(a, rows, count),
        MatRef::from_row_major_slice_with_stride(b, count, columns, apart),
        1.0,
        Par::Seq,
    );
}

/// out ← out + Σⱼ aⱼ bⱼᵀ over `count` rows aⱼ of `rows` numbers and the first `columns` numbers of rows bⱼ that are
/// `stride` apart; `out` is column-major.
#[inline]
pub fn add_outer_products(
    (a, rows): (&[f64], usize),
    (b, columns, stride): (&[f64], usize, usize),
    count: usize,
    out: &mut [f64],
) {
    matmul(
        MatMut::from_column_major_slice_mut(out, rows, columns),
        Accum::Add,
        MatRef::from_column_major_slice(a, rows, count),
        MatRef::from_row_major_slice_with_stride(b, count, columns, stride),
        1.0,
        Par::Seq,
    );
}

/// outⱼ ← Aᵀ bⱼ for rows bⱼ and outⱼ; A has `columns` columns, each as long as a row bⱼ.
#[inline]
pub fn transposed_products(a: &[f64], columns: usize, b: &[f64], out: &mut [f64]) {
    let (length, count) = (a.len() / columns.max(1), out.len() / columns.max(1));
    if columns * length * count <= COPIED_UP_TO {
        for (out, b) in out.chunks_exact_mut(columns.max(1)).zip(b.chunks_exact(length.max(1))) {
            for (out, a) in out.iter_mut().zip(a.chunks_exact(length.max(1))) {
                *out = dot(a, b);
            }
        }
        return;
    }
    matmul(
        MatMut::from_column_major_slice_mut(out, columns, count),
        Accum::Replace,
        MatRef::from_row_major_slice(a, columns, length),
        MatRef::from_column_major_slice(b, length, count),
        1.0,
        Par::Seq,
    );
}
