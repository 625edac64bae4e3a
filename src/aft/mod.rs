//! Alternating frequency-time evaluation of a contact law: harmonics of the motion in, harmonics
//! of the force and their Jacobian out.
//!
//! Both ways of integrating, [`exact`] events and [`sampled`] times, end in the same assembly.
//! With pieces f = k·(x − x(r)) + o, the stiffness spectrum Sₙ = (1/2π)∫ k e^{−inτ} dτ and the
//! transforms gₕ = (2 − δ₀ₕ)/2π ∫ e^{−ihτ} dτ of each anchored piece,
//!
//! > ∂F/∂X = T(S) − Σ k g ⊗ c(r),  F = ∂F/∂X · X + Σ o g,
//!
//! because the force is continuous where pieces meet, so that moving events contribute nothing
//! (Petrov & Ewins 2003, doi:10.1115/1.1539868). T(S) maps Xₘ to Sₕ₋ₘ Xₘ + Sₕ₊ₘ conj(Xₘ). A smooth
//! law gives S at once, without pieces. Friction under a varying normal load has one such sum per
//! pair of directions; see [`coupled`].

mod block;
pub mod coupled;
pub mod exact;
pub mod sampled;
mod smooth;

use crate::contact::{Law, Piece};
use crate::error::{Result, try_vec};
use crate::harmonics::HarmonicSet;
use block::{Block, add_stiffness, apply, pack};
use num_complex::Complex64;

/// Way of evaluating laws, with its tables.
pub enum Evaluator {
    /// Events located, integrals in closed form.
    Exact(Box<exact::Exact>),
    /// Equidistant samples.
    Sampled(Box<sampled::Sampled>),
}

/// Harmonics of a contact force and what belongs to them, all in packed form, one direction after
/// the other.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// Directions of the motion, each with its force.
    pub directions: usize,
    /// F
    pub force: Vec<f64>,
    /// ∂F/∂X, column-major.
    pub jacobian: Vec<f64>,
    /// F − ∂F/∂X · X, the derivative of F by the logarithm of the factor in [`Law::eased`].
    pub offset: Vec<f64>,
    /// ∂F/∂ω at constant X; zero for forces that do not depend on the rate of the motion.
    pub by_omega: Vec<f64>,
    /// Share of the period that is spent slipping, 0 for a stuck contact. A unilateral spring, which
    /// does not slip, tells here the share that it is open.
    pub slip_fraction: f64,
    /// Share of the period that a contact of several directions is open.
    pub open_fraction: f64,
    /// Whether the contact sticks through the period: one piece without anchor, F = kt·X (and closed
    /// throughout, where the normal load varies). Never so for a smooth law.
    pub stuck: bool,
}

impl Evaluation {
    /// Memory for signals of `set` in `directions` directions.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(set: &HarmonicSet, directions: usize) -> Result<Self> {
        let m = directions.saturating_mul(set.packed_len());
        Ok(Self {
            directions,
            force: try_vec(m, 0.0, "a contact force")?,
            jacobian: try_vec(m.saturating_mul(m), 0.0, "a contact Jacobian")?,
            offset: try_vec(m, 0.0, "a contact force")?,
            by_omega: try_vec(m, 0.0, "a contact force")?,
            slip_fraction: 0.0,
            open_fraction: 0.0,
            stuck: false,
        })
    }

    /// Clears what the last evaluation left.
    fn clear(&mut self) {
        self.jacobian.fill(0.0);
        self.offset.fill(0.0);
        self.by_omega.fill(0.0);
        self.slip_fraction = 0.0;
        self.open_fraction = 0.0;
        self.stuck = false;
    }
}

impl Evaluator {
    /// Tables for motions of `set`; `samples` = 0 locates the events exactly.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(set: &HarmonicSet, samples: usize) -> Result<Self> {
        Ok(if samples == 0 {
            Self::Exact(Box::new(exact::Exact::new(set)?))
        } else {
            Self::Sampled(Box::new(sampled::Sampled::new(set, samples)?))
        })
    }

    /// Takes a packed motion in: its reversals or samples serve every law on the coordinate.
    pub fn prepare(&mut self, set: &HarmonicSet, motion: &[f64]) {
        match self {
            Self::Exact(way) => way.prepare(set, motion),
            Self::Sampled(way) => way.prepare(set, motion),
        }
    }

    /// Force and Jacobian of `law` for the motion that was prepared.
    pub fn evaluate(&mut self, law: &Law, set: &HarmonicSet, motion: &[f64], out: &mut Evaluation) {
        match self {
            Self::Exact(way) => way.evaluate(law, set, motion, out),
            Self::Sampled(way) => way.evaluate(law, set, motion, out),
        }
    }

    /// Half the range (max − min)/2 of the motion that was prepared.
    #[must_use]
    pub fn half_range(&self, set: &HarmonicSet) -> f64 {
        match self {
            Self::Exact(way) => way.half_range(set),
            Self::Sampled(way) => way.half_range(),
        }
    }
}

/// Collects the spectrum and the anchored pieces, then writes the [`Evaluation`].
struct Assembly {
    /// Sₙ for n = 0 ..= 2·(highest reduced harmonic).
    spectrum: Vec<Complex64>,
    /// Packed g of the piece at hand.
    g: Vec<f64>,
    /// Packed basis c(r) at the anchor of the piece at hand.
    anchor: Vec<f64>,
}

impl Assembly {
    fn new(set: &HarmonicSet) -> Result<Self> {
        let m = set.packed_len();
        Ok(Self {
            spectrum: try_vec(2 * set.highest_reduced() + 1, Complex64::ZERO, "a stiffness spectrum")?,
            g: try_vec(m, 0.0, "a contact force")?,
            anchor: try_vec(m, 0.0, "a contact force")?,
        })
    }

    /// Clears what the last evaluation left.
    fn start(&mut self, out: &mut Evaluation) {
        self.spectrum.fill(Complex64::ZERO);
        out.clear();
    }

    /// Adds a piece whose transforms tₙ = (1/2π)∫ e^{−inτ} dτ are given for the n of the
    /// spectrum, and whose anchor lies at the time `anchor`.
    fn add(
        &mut self,
        set: &HarmonicSet,
        piece: &Piece,
        transform: &[Complex64],
        anchor: Option<f64>,
        out: &mut Evaluation,
    ) {
        if piece.slope == 0.0 {
            out.slip_fraction += transform[0].re;
        }
        add_stiffness(&mut self.spectrum, piece.slope, transform);
        if piece.offset == 0.0 && anchor.is_none() {
            out.stuck = is_whole(transform[0].re);
            return;
        }
        pack(set, transform, &mut self.g);
        for (o, g) in out.offset.iter_mut().zip(&self.g) {
            *o += piece.offset * g;
        }
        if let Some(tau) = anchor {
            set.basis(tau, &mut self.anchor);
            Block::new(&mut out.jacobian, 1, self.g.len(), [0, 0]).add_product(-piece.slope, &self.g, &self.anchor);
        }
    }

    /// Adds T(S) to the Jacobian and forms the force.
    fn finish(&self, set: &HarmonicSet, motion: &[f64], out: &mut Evaluation) {
        Block::new(&mut out.jacobian, 1, motion.len(), [0, 0]).add_toeplitz(set, &self.spectrum);
        apply(&out.jacobian, motion, &out.offset, &mut out.force);
    }
}

/// Whether a share of the period is all of it, but for rounding.
fn is_whole(share: f64) -> bool {
    share > 1.0 - 1e-12
}
