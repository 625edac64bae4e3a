//! Force and Jacobian of a law on one relative motion from the pieces of its force; see [`crate::aft`].

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::aft::evaluation::{Evaluation, is_whole};
use crate::aft::jacobian_block::{add_stiffness, pack};
use crate::aft::toeplitz::Toeplitz;
use crate::contact::forms::contact_state::State;
use crate::contact::forms::piece::Piece;
use crate::error::{Result, try_vec};
use crate::fourier::{HarmonicSet, jet};
use crate::interrupt::Interrupt;
use crate::linalg::libraries::{Arch, Simd, WithSimd};
use num_complex::Complex64;

/// Number of products g ⊗ c per pass over the Jacobian, which at many harmonics exceeds the caches.
/// Kind: block.
const MOST_PENDING: usize = 4;

/// Numbers of a Jacobian that are written between two checks.
/// Kind: block.
const JACOBIAN_ASSEMBLY_NUMBERS_TOGETHER: usize = 1 << 22;

/// Collects the spectrum of the stiffness and the anchored pieces, then writes the [`Evaluation`].
pub(super) struct Assembly {
    arch: Arch,
    /// Stiffness spectrum Sₙ for n = 0 ..= 2·(highest reduced harmonic).
    pub(super) spectrum: Vec<Complex64>,
    toeplitz: Toeplitz,
    /// Packed transforms g of the pending pieces, and of the current piece.
    g: Vec<f64>,
    /// Packed bases c(r) at the anchors of the pending pieces, times −k.
    anchors: Vec<f64>,
    pending: usize,
    /// Whether the Jacobian already holds products of earlier passes.
    begun: bool,
}

impl Assembly {
    pub(super) fn new(set: &HarmonicSet) -> Result<Self> {
        let m = set.packed_len();
        let products = || try_vec(MOST_PENDING.saturating_mul(m), 0.0, "a contact force");
        Ok(Self {
            arch: Arch::new(),
            spectrum: try_vec(2 * set.highest_reduced() + 1, Complex64::ZERO, "a stiffness spectrum")?,
            toeplitz: Toeplitz::new(set)?,
            g: products()?,
            anchors: products()?,
            pending: 0,
            begun: false,
        })
    }

    /// Clears the results of the last evaluation except the Jacobian, which [`Self::finish`] writes.
    pub(super) fn start(&mut self, out: &mut Evaluation) {
        self.spectrum.fill(Complex64::ZERO);
        self.pending = 0;
        self.begun = false;
        out.clear_forces();
    }

    /// Adds a piece with its transforms tₙ = (1/2π)∫ e^{−inτ} dτ for the n of the spectrum, and with its anchor at
    /// the time `anchor`. Without a Jacobian the motion at the anchor is a constant of the piece.
    pub(super) fn add(
        &mut self,
        (set, motion): (&HarmonicSet, &[f64]),
        (piece, state): (&Piece, State),
        transform: &[Complex64],
        anchor: Option<f64>,
        out: &mut Evaluation,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        out.count(state, transform[0].re);
        add_stiffness(&mut self.spectrum, piece.slope, transform, set.stride());
        out.linear = anchor.is_none() && is_whole(transform[0].re);
        if piece.offset == 0.0 && anchor.is_none() {
            out.stuck = is_whole(transform[0].re);
            return Ok(());
        }
        if self.pending == MOST_PENDING {
            self.flush(out, interrupt)?;
        }
        let m = set.packed_len();
        let own = self.pending * m..(self.pending + 1) * m;
        let g = &mut self.g[own.clone()];
        pack(set, transform, g);
        let mut constant = piece.offset;
        let anchor = match anchor {
            Some(tau) if out.is_force_alone() => {
                constant -= piece.slope * jet(set, motion, tau).x;
                None
            }
            anchor => anchor,
        };
        for (o, g) in out.offset.iter_mut().zip(&*g) {
            *o += constant * g;
        }
        if let Some(tau) = anchor {
            let anchor = &mut self.anchors[own];
            set.basis(tau, anchor);
            for c in anchor {
                *c *= -piece.slope;
            }
            self.pending += 1;
        }
        Ok(())
    }

    /// Adds a change of the force of a packed spectrum `g` by the product of the motion with a row; the force itself has none. Returns
    /// the spectrum; no number for forces alone.
    pub(super) fn add_change(
        &mut self,
        (motion, row): (&[f64], &[f64]),
        fill: impl FnOnce(&mut [f64]),
        out: &mut Evaluation,
        interrupt: &Interrupt<'_>,
    ) -> Result<&[f64]> {
        if out.is_force_alone() {
            return Ok(&[]);
        }
        if self.pending == MOST_PENDING {
            self.flush(out, interrupt)?;
        }
        let m = row.len();
        let own = self.pending * m..(self.pending + 1) * m;
        let g = &mut self.g[own.clone()];
        fill(g);
        let by_motion: f64 = row.iter().zip(motion).map(|(a, b)| a * b).sum();
        for (o, g) in out.offset.iter_mut().zip(&*g) {
            *o -= by_motion * g;
        }
        self.anchors[own.clone()].copy_from_slice(row);
        self.pending += 1;
        Ok(&self.g[own])
    }

    /// Adds the pending products to the Jacobian.
    fn flush(&mut self, out: &mut Evaluation, interrupt: &Interrupt<'_>) -> Result<()> {
        let m = out.force.len().max(1);
        let together = columns_together(m);
        for (j, column) in out.jacobian.chunks_exact_mut(m).enumerate() {
            if j % together == together - 1 {
                interrupt.check_before((together * m) as u64)?;
            }
            if !self.begun {
                column.fill(0.0);
            }
            add_products(column, (&self.anchors, &self.g, self.pending), j);
        }
        self.begun = true;
        self.pending = 0;
        Ok(())
    }

    /// Writes the Jacobian, which is T(S) plus the products g ⊗ c, and the force.
    pub(super) fn finish(
        &mut self,
        set: &HarmonicSet,
        motion: &[f64],
        out: &mut Evaluation,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        self.toeplitz.set(set, &self.spectrum);
        out.force.copy_from_slice(&out.offset);
        if out.is_force_alone() {
            return self.toeplitz.add_product(motion, &mut out.force, interrupt);
        }
        let m = motion.len().max(1);
        let together = columns_together(m);
        for (k, jacobian) in out.jacobian.chunks_mut(together * m).enumerate() {
            if k > 0 {
                interrupt.check_before((together * m) as u64)?;
            }
            self.arch.dispatch(Columns {
                toeplitz: &self.toeplitz,
                products: (&self.anchors, &self.g, self.pending),
                begun: self.begun,
                first: k * together,
                motion,
                jacobian,
                force: &mut out.force,
            });
        }
        Ok(())
    }
}

/// Number of columns of m numbers that are written between two checks of the interrupt.
fn columns_together(m: usize) -> usize {
    (JACOBIAN_ASSEMBLY_NUMBERS_TOGETHER / m).max(1)
}

/// Packed anchors and transforms g of the products g ⊗ c, and the number of products.
type Products<'a> = (&'a [f64], &'a [f64], usize);

/// Some columns of the Jacobian, and the sum of their products with the motion; the force holds the offset at first.
struct Columns<'a> {
    toeplitz: &'a Toeplitz,
    products: Products<'a>,
    /// Whether the Jacobian already holds products of earlier passes.
    begun: bool,
    /// Index of the first column.
    first: usize,
    motion: &'a [f64],
    jacobian: &'a mut [f64],
    force: &'a mut [f64],
}

impl WithSimd for Columns<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        // With few harmonics most of the time would be spent in what is left over by vectors.
        match self.motion.len() {
            2 => self.write::<2>(),
            4 => self.write::<4>(),
            6 => self.write::<6>(),
            7 => self.write::<7>(),
            8 => self.write::<8>(),
            10 => self.write::<10>(),
            11 => self.write::<11>(),
            12 => self.write::<12>(),
            14 => self.write::<14>(),
            15 => self.write::<15>(),
            16 => self.write::<16>(),
            19 => self.write::<19>(),
            _ => self.write::<0>(),
        }
    }
}

impl Columns<'_> {
    /// Writes columns for signals of length N, known at compile time; 0: of any length.
    #[inline(always)]
    fn write<const N: usize>(mut self) {
        if N > 0 && N.is_multiple_of(2) && !self.begun && self.write_paired::<N>() {
            return;
        }
        let m = if N > 0 { N } else { self.motion.len() };
        let (anchors, g, count) = self.products;
        let (motion, force) = (&self.motion[..m], &mut self.force[..m]);
        for (j, column) in (self.first..).zip(self.jacobian.chunks_exact_mut(m.max(1))) {
            let of_stiffness = self.toeplitz.column(j);
            // An odd length has a mean.
            let mean = m % 2;
            let [a, b] = of_stiffness.parts.map(|part| &part[..m - mean]);
            let column = &mut column[..m];
            if !self.begun {
                column.fill(0.0);
            }
            // A column of known length is summed in registers.
            let mut registers = [0.0; N];
            let sum = if N > 0 {
                registers.copy_from_slice(column);
                &mut registers[..]
            } else {
                &mut column[..]
            };
            if mean == 1 {
                sum[0] += of_stiffness.mean;
            }
            for ((entry, a), b) in sum[mean..].iter_mut().zip(a).zip(b) {
                *entry += a + b;
            }
            for (c, g) in anchors.chunks_exact(m.max(1)).zip(g.chunks_exact(m.max(1))).take(count) {
                for (entry, g) in sum.iter_mut().zip(&g[..m]) {
                    *entry += c[j] * g;
                }
            }
            for (f, entry) in force.iter_mut().zip(&*sum) {
                *f += motion[j] * entry;
            }
            if N > 0 {
                column.copy_from_slice(&registers);
            }
        }
    }
}

impl Columns<'_> {
    /// Writes columns for signals of length N without a mean, where no products are held yet; `false` where the
    /// lengths differ.
    #[inline(always)]
    fn write_paired<const N: usize>(&mut self) -> bool {
        let (anchors, g, count) = self.products;
        let (anchors, g) = (anchors.as_chunks::<N>().0, g.as_chunks::<N>().0);
        let (Some(motion), Some(force)) = (self.motion.first_chunk::<N>(), self.force.first_chunk_mut::<N>()) else {
            return false;
        };
        let mut total = *force;
        for (j, column) in self.jacobian.as_chunks_mut::<N>().0.iter_mut().enumerate() {
            let [a, b] = self.toeplitz.column(j).parts;
            let (Some(a), Some(b)) = (a.first_chunk::<N>(), b.first_chunk::<N>()) else {
                return false;
            };
            let mut sum = [0.0; N];
            for i in 0..N {
                sum[i] = a[i] + b[i];
            }
            for k in 0..count {
                let (factor, g) = (anchors[k][j], &g[k]);
                for i in 0..N {
                    sum[i] += factor * g[i];
                }
            }
            for i in 0..N {
                total[i] += motion[j] * sum[i];
            }
            *column = sum;
        }
        *force = total;
        true
    }
}

/// column ← column + Σ cⱼ g over the products.
fn add_products(column: &mut [f64], (anchors, g, count): Products<'_>, j: usize) {
    let m = column.len().max(1);
    for (c, g) in anchors.chunks_exact(m).zip(g.chunks_exact(m)).take(count) {
        for (entry, g) in column.iter_mut().zip(g) {
            *entry += c[j] * g;
        }
    }
}
