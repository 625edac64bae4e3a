//! Sampled evaluation: the law at N equidistant times per period, with Fourier sums instead of integrals. The force
//! is O(N⁻²) accurate, the Jacobian O(N⁻¹); it is used for cross-checks and for laws without exact events. Smooth
//! laws are not sampled: their harmonics are exact.

use crate::aft::evaluation::Evaluation;
use crate::aft::jacobian_assembly::Assembly;
use crate::contact::forms::law::PiecewiseLinear;
use crate::contact::forms::piece::Piece;
use crate::error::{Error, Result, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Products of samples and harmonics between two checks.
/// Kind: block.
const PRODUCTS_TOGETHER: usize = 1 << 20;

/// Tables and memory of the sampled evaluation for one harmonic set.
pub struct Sampled {
    /// Factors e^{−iτⱼ} at the samples.
    turns: Vec<Complex64>,
    basis: Vec<f64>,
    samples: Vec<f64>,
    pieces: Vec<Piece>,
    transform: Vec<Complex64>,
    assembly: Assembly,
}

impl Sampled {
    /// Memory for motions of `set` at `n` times.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(set: &HarmonicSet, n: usize) -> Result<Self> {
        let mut turns = try_vec(n, Complex64::ONE, "samples")?;
        for (j, z) in turns.iter_mut().enumerate() {
            *z = Complex64::cis(-TAU * j as f64 / n as f64);
        }
        let mut pieces = Vec::new();
        pieces
            .try_reserve_exact(n + 2)
            .map_err(|_| Error::out_of_memory("samples"))?;
        Ok(Self {
            turns,
            basis: try_vec(set.packed_len(), 0.0, "samples")?,
            samples: try_vec(n, 0.0, "samples")?,
            pieces,
            transform: try_vec(2 * set.highest_reduced() + 1, Complex64::ZERO, "a transform")?,
            assembly: Assembly::new(set)?,
        })
    }

    /// Samples a packed motion.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    pub fn prepare(&mut self, set: &HarmonicSet, motion: &[f64], interrupt: &Interrupt<'_>) -> Result<()> {
        let n = self.samples.len();
        let together = samples_together(motion.len());
        for j in 0..n {
            if j % together == 0 {
                interrupt.check_before((motion.len() * together.min(n)) as u64)?;
            }
            set.basis(TAU * j as f64 / n as f64, &mut self.basis);
            self.samples[j] = self.basis.iter().zip(motion).map(|(c, x)| c * x).sum();
        }
        Ok(())
    }

    /// Half the range of the samples of the prepared motion.
    #[must_use]
    pub fn half_range(&self) -> f64 {
        let high = self.samples.iter().fold(f64::NEG_INFINITY, |m, &x| m.max(x));
        let low = self.samples.iter().fold(f64::INFINITY, |m, &x| m.min(x));
        0.5 * (high - low)
    }

    /// Force and Jacobian of `law` for the prepared motion; see [`crate::aft`].
    ///
    /// # Errors
    /// `StoppedByCaller`.
    pub fn evaluate(
        &mut self,
        law: &dyn PiecewiseLinear,
        set: &HarmonicSet,
        motion: &[f64],
        out: &mut Evaluation,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        self.pieces.clear();
        law.sampled_pieces(&self.samples, &mut self.pieces);
        self.assembly.start(out);
        let n = self.samples.len();
        let harmonics = self.transform.len();
        let together = samples_together(harmonics);
        for piece in &self.pieces {
            interrupt.check_before(harmonics as u64)?;
            // (1/N) Σ e^{−inτⱼ} over the samples of the piece.
            self.transform.fill(Complex64::ZERO);
            for (k, j) in (piece.start as usize..piece.end as usize).enumerate() {
                if k % together == together - 1 {
                    interrupt.check_before((harmonics * together) as u64)?;
                }
                let turn = self.turns[j % n];
                let mut z = Complex64::ONE;
                for t in &mut self.transform {
                    *t += z;
                    z *= turn;
                }
            }
            for t in &mut self.transform {
                *t /= n as f64;
            }
            let anchor = piece.anchor.map(|j| TAU * j / n as f64);
            self.assembly.add(
                (set, motion),
                (piece, law.state(piece)),
                &self.transform,
                anchor,
                out,
                interrupt,
            )?;
        }
        interrupt.check()?;
        self.assembly.finish(set, motion, out, interrupt)
    }
}

/// Number of samples between two checks of the interrupt, where each takes `numbers` operations.
fn samples_together(numbers: usize) -> usize {
    (PRODUCTS_TOGETHER / numbers.max(1)).max(1)
}
