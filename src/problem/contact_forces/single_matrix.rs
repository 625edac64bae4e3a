//! Newton's matrix of a single relative motion without a mean: I + G (∂f/∂y − κ), written at once.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::condense::by_factors::flexibility::Table;
use crate::error::Result;
use crate::linalg::libraries::{Simd, WithSimd};
use crate::problem::contact_forces::ContactForces;
use num_complex::Complex64;

/// Numbers of the matrix that are written between two checks.
/// Kind: block.
const SINGLE_MATRIX_NUMBERS_TOGETHER: usize = 1 << 16;

/// Fills in Newton's matrix, with memory for G of all harmonics; `false` where there are several relative motions
/// or a mean.
///
/// # Errors
/// `StoppedByCaller`.
pub(crate) fn fill_single(
    forces: &ContactForces<'_>,
    tables: &[Table],
    memory: &mut [Complex64],
    matrix: &mut [f64],
) -> Result<bool> {
    let set = forces.condensed.set();
    if forces.condensed.coordinates() != 1 || set.has_mean() {
        return Ok(false);
    }
    let Some((_, jacobian)) = forces.result.jacobians.of_motion(0).next() else {
        return Ok(false);
    };
    for (g, table) in memory.iter_mut().zip(tables) {
        *g = table.value[0];
    }
    let (m, g) = (set.packed_len(), &memory[..tables.len()]);
    // An even number of columns, those of whole harmonics.
    let together = (SINGLE_MATRIX_NUMBERS_TOGETHER / m).max(2) & !1;
    let blocks = matrix.chunks_mut(together * m).zip(jacobian.chunks(together * m));
    for (k, (matrix, jacobian)) in blocks.enumerate() {
        forces.interrupt.check()?;
        let first = k * together / 2;
        let kappa = |i: usize| forces.condensed.kappa(0, i);
        forces.arch.dispatch(Fill {
            g,
            first,
            jacobian,
            kappa,
            matrix,
        });
    }
    Ok(true)
}

/// Columns of the matrix, beginning with those of the harmonic `first`.
struct Fill<'a, K> {
    g: &'a [Complex64],
    first: usize,
    jacobian: &'a [f64],
    kappa: K,
    matrix: &'a mut [f64],
}

impl<K: Fn(usize) -> Complex64> WithSimd for Fill<'_, K> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        // With few harmonics most of the time would be spent around loops of unknown length.
        match self.g.len() {
            1 => self.write::<2>(),
            2 => self.write::<4>(),
            3 => self.write::<6>(),
            4 => self.write::<8>(),
            5 => self.write::<10>(),
            6 => self.write::<12>(),
            7 => self.write::<14>(),
            8 => self.write::<16>(),
            9 => self.write::<18>(),
            _ => self.write_any(),
        }
    }
}

impl<K: Fn(usize) -> Complex64> Fill<'_, K> {
    /// Writes the columns for N numbers, known at compile time.
    #[inline(always)]
    fn write<const N: usize>(self) {
        // With z′ the parts of z exchanged, g z = along·z + across·z′ number by number.
        let (mut along, mut across) = ([0.0; N], [0.0; N]);
        for (i, g) in self.g.iter().enumerate().take(N / 2) {
            (along[2 * i], along[2 * i + 1]) = (g.re, g.re);
            (across[2 * i], across[2 * i + 1]) = (-g.im, g.im);
        }
        let columns = self.matrix.as_chunks_mut::<N>().0.iter_mut();
        for (q, (column, from)) in columns.zip(self.jacobian.as_chunks::<N>().0).enumerate() {
            let (at, lost) = lost(self.first, q, &self.kappa);
            let mut z = *from;
            z[at] -= lost.re;
            z[at + 1] -= lost.im;
            let mut exchanged = [0.0; N];
            for i in 0..N {
                exchanged[i] = z[i ^ 1];
            }
            for i in 0..N {
                column[i] = along[i] * z[i] + across[i] * exchanged[i];
            }
            column[at + q % 2] += 1.0;
        }
    }

    /// Writes the columns for any number of harmonics.
    #[inline(always)]
    fn write_any(self) {
        let m = 2 * self.g.len();
        let columns = self.matrix.chunks_exact_mut(m).zip(self.jacobian.chunks_exact(m));
        for (q, (column, from)) in columns.enumerate() {
            let pairs = column.as_chunks_mut::<2>().0.iter_mut().zip(from.as_chunks::<2>().0);
            for ((x, z), g) in pairs.zip(self.g) {
                *x = [g.re * z[0] - g.im * z[1], g.re * z[1] + g.im * z[0]];
            }
            let (at, lost) = lost(self.first, q, &self.kappa);
            let own = self.g[at / 2] * (Complex64::new(from[at], from[at + 1]) - lost);
            (column[at], column[at + 1]) = (own.re, own.im);
            column[at + q % 2] += 1.0;
        }
    }
}

/// Row of column q that holds the harmonic of this column, counted from that of harmonic `first`; and κ times the
/// motion of the column, 1 or i.
#[inline(always)]
fn lost(first: usize, q: usize, kappa: impl Fn(usize) -> Complex64) -> (usize, Complex64) {
    let i = first + q / 2;
    let kappa = kappa(i);
    (
        2 * i,
        if q.is_multiple_of(2) {
            kappa
        } else {
            kappa * Complex64::I
        },
    )
}
