//! Exact evaluation of friction under a varying normal load: two directions, x along the surface and y along its
//! normal.
//!
//! The tangential force consists of pieces f = a·x + b·y + a_r·x(r) + b_r·y(r) + o, see [`CoupledPiece`], so that
//! with the spectra S of a and b
//!
//! > ∂Fₜ/∂X = T(Sᵃ) + Σ a_r g ⊗ c(r),  ∂Fₜ/∂Y = T(Sᵇ) + Σ (b_r + m) g ⊗ c(r),
//!
//! where m·dy(r) is the contribution of a time of closing r that moves with the normal motion. The normal
//! force is that of a unilateral spring and does not depend on x. m belongs to the derivative alone,
//! so Fₜ = ∂Fₜ/∂X · X + ∂Fₜ/∂Y · Y + Σ (o − m·y(r)) g.

use crate::aft::evaluation::{Evaluation, is_whole};
use crate::aft::jacobian_block::{Block, add_stiffness, apply, pack};
use crate::aft::piecewise_exact::transform;
use crate::aft::toeplitz::Toeplitz;
use crate::contact::forms::contact_state::State;
use crate::contact::forms::coupled_search::{CoupledSearch, piece_lists};
use crate::contact::forms::law::VaryingNormalLoad;
use crate::contact::forms::piece::{CoupledPiece, Piece};
use crate::error::{Result, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Tables and memory of the evaluation for one harmonic set.
pub struct VaryingNormalLoadEvaluator {
    search: CoupledSearch,
    normal: Vec<Piece>,
    tangential: Vec<CoupledPiece>,
    transform: Vec<Complex64>,
    /// Spectra of ∂Fₜ/∂X, ∂Fₜ/∂Y and ∂Fₙ/∂Y.
    spectra: [Vec<Complex64>; 3],
    toeplitz: Toeplitz,
    g: Vec<f64>,
    anchor: Vec<f64>,
}

/// Directions of force and motion of each spectrum.
/// Kind: fixed.
const VARYING_NORMAL_LOAD_BLOCKS: [[usize; 2]; 3] = [[0, 0], [0, 1], [1, 1]];

impl VaryingNormalLoadEvaluator {
    /// Memory for motions of `set`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(set: &HarmonicSet) -> Result<Self> {
        let (normal, tangential) = piece_lists(set)?;
        let spectrum = || try_vec(2 * set.highest_reduced() + 1, Complex64::ZERO, "a stiffness spectrum");
        Ok(Self {
            search: CoupledSearch::new(set)?,
            normal,
            tangential,
            transform: spectrum()?,
            spectra: [spectrum()?, spectrum()?, spectrum()?],
            toeplitz: Toeplitz::new(set)?,
            g: try_vec(set.packed_len(), 0.0, "a contact force")?,
            anchor: try_vec(set.packed_len(), 0.0, "a contact force")?,
        })
    }

    /// The pieces of the tangential force at the motion evaluated last.
    #[must_use]
    pub fn tangential(&self) -> &[CoupledPiece] {
        &self.tangential
    }

    /// The pieces of the normal force at the motion evaluated last.
    #[must_use]
    pub fn normal(&self) -> &[Piece] {
        &self.normal
    }

    /// Force and Jacobian of `law` at the packed tangential motion x, followed by the packed normal motion y; `out`
    /// has two directions.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    pub fn evaluate(
        &mut self,
        law: &dyn VaryingNormalLoad,
        set: &HarmonicSet,
        motion: &[f64],
        out: &mut Evaluation,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        interrupt.check()?;
        let (normal, tangential) = (&mut self.normal, &mut self.tangential);
        law.coupled_pieces(set, motion, &mut self.search, normal, tangential, interrupt)?;
        out.clear();
        for spectrum in &mut self.spectra {
            spectrum.fill(Complex64::ZERO);
        }
        self.add_normal(set, out, interrupt)?;
        self.add_tangential(set, motion, out, interrupt)?;
        let m = set.packed_len();
        for (spectrum, place) in self.spectra.iter().zip(VARYING_NORMAL_LOAD_BLOCKS) {
            interrupt.check_before((m * m) as u64)?;
            self.toeplitz.set(set, spectrum);
            if out.is_force_alone() {
                let [i, j] = place.map(|direction| direction * m);
                // The offset has all constants by now.
                self.toeplitz
                    .add_product(&motion[j..], &mut out.offset[i..], interrupt)?;
            } else {
                Block::new(&mut out.jacobian, 2, m, place).add_toeplitz(&self.toeplitz);
            }
        }
        if out.is_force_alone() {
            out.force.copy_from_slice(&out.offset);
            return Ok(());
        }
        apply(&out.jacobian, motion, &out.offset, &mut out.force);
        Ok(())
    }

    fn add_normal(&mut self, set: &HarmonicSet, out: &mut Evaluation, interrupt: &Interrupt<'_>) -> Result<()> {
        let m = set.packed_len();
        for piece in &self.normal {
            interrupt.check_before((8 * m) as u64)?;
            transform([piece.start, piece.end], TAU.recip(), TAU, &mut self.transform);
            if !piece.is_closed() {
                out.open_fraction += self.transform[0].re;
                continue;
            }
            add_stiffness(&mut self.spectra[2], piece.slope, &self.transform, 1);
            pack(set, &self.transform, &mut self.g);
            for (o, g) in out.offset[m..].iter_mut().zip(&self.g) {
                *o += piece.offset * g;
            }
        }
        Ok(())
    }

    fn add_tangential(
        &mut self,
        set: &HarmonicSet,
        motion: &[f64],
        out: &mut Evaluation,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let m = set.packed_len();
        let of_products = if out.is_force_alone() { m } else { m * m };
        for piece in &self.tangential {
            interrupt.check_before((4 * of_products) as u64)?;
            if piece.state == State::Open {
                continue;
            }
            transform([piece.start, piece.end], TAU.recip(), TAU, &mut self.transform);
            let share = self.transform[0].re;
            out.count(piece.state, share);
            out.linear = piece.state == State::Stick && piece.anchor.is_none() && is_whole(share);
            out.stuck = out.linear && piece.constant == 0.0;
            let [by_x, by_y, _] = &mut self.spectra;
            add_stiffness(by_x, piece.of_x, &self.transform, 1);
            add_stiffness(by_y, piece.of_y, &self.transform, 1);
            pack(set, &self.transform, &mut self.g);
            let mut constant = piece.constant;
            if let Some(r) = piece.anchor {
                set.basis(r, &mut self.anchor);
                let by_y = piece.at_y + piece.moved_y;
                let there = |x: &[f64]| self.anchor.iter().zip(x).map(|(c, x)| c * x).sum::<f64>();
                let y = there(&motion[m..]);
                if out.is_force_alone() {
                    constant += piece.at_x * there(motion) + piece.at_y * y;
                } else {
                    for (j, factor) in [piece.at_x, by_y].into_iter().enumerate() {
                        Block::new(&mut out.jacobian, 2, m, [0, j]).add_product(factor, &self.g, &self.anchor);
                    }
                    constant -= piece.moved_y * y;
                }
            }
            for (o, g) in out.offset[..m].iter_mut().zip(&self.g) {
                *o += constant * g;
            }
        }
        Ok(())
    }
}
