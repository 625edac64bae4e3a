//! Force and Jacobian of a law on one relative motion from the pieces of its force; see [`crate::aft`].

use crate::aft::evaluation::{Evaluation, is_whole};
use crate::aft::jacobian_block::{add_stiffness, apply, pack};
use crate::aft::toeplitz::Toeplitz;
use crate::contact::contact_state::State;
use crate::contact::piece::Piece;
use crate::error::{Result, try_vec};
use crate::fourier::HarmonicSet;
use num_complex::Complex64;

/// Number of products g ⊗ c per pass over the Jacobian, which at many harmonics exceeds the caches.
const MOST_PENDING: usize = 4;

/// Collects the spectrum and the anchored pieces, then writes the [`Evaluation`].
pub(super) struct Assembly {
    /// Sₙ for n = 0 ..= 2·(highest reduced harmonic).
    pub(super) spectrum: Vec<Complex64>,
    toeplitz: Toeplitz,
    /// Packed g of the pending pieces, and of the current piece.
    g: Vec<f64>,
    /// Packed bases c(r) at their anchors times −k.
    anchors: Vec<f64>,
    pending: usize,
    /// Zeros in place of a product if none is pending.
    zeros: Vec<f64>,
    /// Whether the Jacobian already holds products.
    begun: bool,
}

impl Assembly {
    pub(super) fn new(set: &HarmonicSet) -> Result<Self> {
        let m = set.packed_len();
        let products = || try_vec(MOST_PENDING.saturating_mul(m), 0.0, "a contact force");
        Ok(Self {
            spectrum: try_vec(2 * set.highest_reduced() + 1, Complex64::ZERO, "a stiffness spectrum")?,
            toeplitz: Toeplitz::new(set)?,
            g: products()?,
            anchors: products()?,
            pending: 0,
            zeros: try_vec(m, 0.0, "a contact force")?,
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
    /// the time `anchor`.
    pub(super) fn add(
        &mut self,
        set: &HarmonicSet,
        (piece, state): (&Piece, State),
        transform: &[Complex64],
        anchor: Option<f64>,
        out: &mut Evaluation,
    ) {
        out.count(state, transform[0].re);
        add_stiffness(&mut self.spectrum, piece.slope, transform);
        out.linear = anchor.is_none() && is_whole(transform[0].re);
        if piece.offset == 0.0 && anchor.is_none() {
            out.stuck = is_whole(transform[0].re);
            return;
        }
        if self.pending == MOST_PENDING {
            self.flush(out);
        }
        let m = set.packed_len();
        let own = self.pending * m..(self.pending + 1) * m;
        let g = &mut self.g[own.clone()];
        pack(set, transform, g);
        for (o, g) in out.offset.iter_mut().zip(&*g) {
            *o += piece.offset * g;
        }
        if let Some(tau) = anchor {
            let anchor = &mut self.anchors[own];
            set.basis(tau, anchor);
            for c in anchor {
                *c *= -piece.slope;
            }
            self.pending += 1;
        }
    }

    /// Adds the pending products to the Jacobian.
    fn flush(&mut self, out: &mut Evaluation) {
        if !self.begun {
            out.jacobian.fill(0.0);
        }
        let m = out.force.len().max(1);
        for (j, column) in out.jacobian.chunks_exact_mut(m).enumerate() {
            add_products(column, self.products(m, j));
        }
        self.begun = true;
        self.pending = 0;
    }

    /// The pending products of column `j`, as (cⱼ, g).
    fn products(&self, m: usize, j: usize) -> impl Iterator<Item = (f64, &[f64])> {
        let pairs = self.anchors.chunks_exact(m).zip(self.g.chunks_exact(m));
        pairs.take(self.pending).map(move |(c, g)| (c[j], g))
    }

    /// Writes the Jacobian, T(S) and the products, and the force.
    pub(super) fn finish(&mut self, set: &HarmonicSet, motion: &[f64], out: &mut Evaluation) {
        self.toeplitz.set(set, &self.spectrum);
        let m = motion.len().max(1);
        for (j, column) in out.jacobian.chunks_exact_mut(m).enumerate() {
            let of_stiffness = self.toeplitz.column(j);
            let [a, b] = of_stiffness.parts;
            let mean = m - a.len();
            let mut products = self.products(m, j);
            if self.begun {
                if mean == 1 {
                    column[0] += of_stiffness.mean;
                }
                for ((entry, a), b) in column[mean..].iter_mut().zip(a).zip(b) {
                    *entry += a + b;
                }
            } else {
                // Most motions stick from one turning point on in each half of the period.
                let (c, g) = products.next().unwrap_or((0.0, &self.zeros));
                if mean == 1 {
                    column[0] = of_stiffness.mean + c * g[0];
                }
                for (((entry, a), b), g) in column[mean..].iter_mut().zip(a).zip(b).zip(&g[mean..]) {
                    *entry = a + b + c * g;
                }
            }
            add_products(column, products);
        }
        apply(&out.jacobian, motion, &out.offset, &mut out.force);
    }
}

/// column += Σ cⱼ g
fn add_products<'g>(column: &mut [f64], products: impl Iterator<Item = (f64, &'g [f64])>) {
    for (c, g) in products {
        for (entry, g) in column.iter_mut().zip(g) {
            *entry += c * g;
        }
    }
}
