//! Ends of slips that move with the motion: the derivative of the force of a slider that is a mass, [`SlidingEnds`].
//!
//! A slip of the sense ± from a on, with the stick stiffness α and the range r = fc/α, ends where V(b) = 0, V(τ) = ∫ (x ∓ r) dτ. A
//! change δx moves V by A = ∫ δx dτ, hence b by δb = −A/(x(b) ∓ r). Where a stick follows, the force jumps there from ±fc to α x(b),
//! which is an impulse
//!
//! > δf = α A δ(τ − b).
//!
//! Where slip reverses the force jumps to ∓fc at c = b + δ(q), q = ∓x(b)/r, so that
//!
//! > δf = ±2 α r δc δ(τ − c),  δc = δb + δ′(q) δq,  δq = ∓(δx(b) + x′(b) δb)/r,
//!
//! and the next slip, from b on, begins with the momentum A ∓ 2r δc. Without any stick the first slip of a half turn begins with that of
//! the last one, of opposite sign.
//!
//! The delay δ = ω λ(q) has a derivative by ω, too: δc has the term λ, and the momentum of the next slip follows.

use crate::aft::evaluation::Evaluation;
use crate::aft::jacobian_assembly::Assembly;
use crate::contact::forms::law::{PackedMotion, SlidingEnds};
use crate::contact::forms::piece::Piece;
use crate::error::{Result, try_vec};
use crate::fourier::{HarmonicSet, jet};
use crate::interrupt::Interrupt;
use num_complex::Complex64;
use std::f64::consts::PI;

/// Memory for the ends of slips under motions of a set of odd harmonics.
pub(super) struct MovedEnds {
    /// A as a row over the packed motion.
    row: Vec<f64>,
    /// ±2 r δc as such a row, or A.
    jump: Vec<f64>,
    /// The derivatives of A and of ±2 r δc by ω.
    by_omega: [f64; 2],
}

/// Whether a piece is a slip.
fn is_slip(piece: &Piece) -> bool {
    piece.slope == 0.0
}

impl MovedEnds {
    pub(super) fn new(set: &HarmonicSet) -> Result<Self> {
        let row = || try_vec(set.packed_len(), 0.0, "a contact Jacobian");
        Ok(Self {
            row: row()?,
            jump: row()?,
            by_omega: [0.0; 2],
        })
    }

    /// Adds the impulses at the ends of all slips among the pieces of half a turn.
    pub(super) fn add(
        &mut self,
        at: PackedMotion<'_>,
        (pieces, law): (&[Piece], &dyn SlidingEnds),
        assembly: &mut Assembly,
        out: &mut Evaluation,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let PackedMotion { set, motion, .. } = at;
        if !pieces.iter().any(is_slip) {
            return Ok(());
        }
        // A slip all the time is one piece, whose ends move.
        out.linear = false;
        if out.is_force_alone() {
            return Ok(());
        }
        self.forget();
        let begin = pieces.last().and_then(|last| last.anchor).map(|rest| rest - PI);
        if begin.is_some() {
            // With m the momentum at the end for none at the begin, and Π m₀ for m₀ alone: the first is −m/(1 + Π).
            let mut rest = begin;
            let mut all = 1.0;
            for piece in pieces {
                interrupt.check_before(motion.len() as u64)?;
                all *= self.follow(at, (rest, piece), law);
                rest = piece.anchor;
            }
            for a in self.row.iter_mut().chain(&mut self.by_omega[..1]) {
                *a /= -(1.0 + all);
            }
        }
        let mut rest = begin;
        for piece in pieces {
            interrupt.check_before(motion.len() as u64)?;
            self.follow(at, (rest, piece), law);
            if is_slip(piece) {
                let of_omega = self.by_omega[1];
                let fill = |g: &mut [f64]| impulse(set, piece.end, law.stiffness(), g);
                let g = assembly.add_change((motion, &self.jump), fill, out, interrupt)?;
                for (by_omega, g) in out.by_omega.iter_mut().zip(g).filter(|_| of_omega != 0.0) {
                    *by_omega += of_omega * g;
                }
            }
            rest = piece.anchor;
        }
        Ok(())
    }

    /// No momentum.
    fn forget(&mut self) {
        self.row.fill(0.0);
        self.by_omega[0] = 0.0;
    }

    /// Follows a stick, or a slip that begins at a time of rest or, after a stick, with its piece: leaves the momentum of the next slip,
    /// and the impulse over α. Returns the factor of the momentum at its begin.
    fn follow(
        &mut self,
        PackedMotion { set, motion, omega }: PackedMotion<'_>,
        (rest, piece): (Option<f64>, &Piece),
        law: &dyn SlidingEnds,
    ) -> f64 {
        if !is_slip(piece) {
            self.forget();
            return 0.0;
        }
        let end = piece.anchor.unwrap_or(piece.end);
        self.integrate(set, rest.unwrap_or(piece.start), end);
        if piece.anchor.is_none() {
            self.jump.copy_from_slice(&self.row);
            self.by_omega[1] = self.by_omega[0];
            self.forget();
            return 0.0;
        }
        // ±r
        let range = piece.offset / law.stiffness();
        let at = jet(set, motion, end);
        let [delay, slope] = law.delay(-at.x / range);
        let slope = omega * slope;
        // δb = −A/(x ∓ r), δc = (1 ∓ δ′ x′/r) δb ∓ δ′ δx/r
        let of_momentum = -(1.0 - slope * at.dx / range) / (at.x - range);
        set.basis(end, &mut self.jump);
        for (jump, a) in self.jump.iter_mut().zip(&mut self.row) {
            *jump = 2.0 * range * (of_momentum * *a - slope / range * *jump);
            *a -= *jump;
        }
        let [a, jump] = &mut self.by_omega;
        *jump = 2.0 * range * (of_momentum * *a + delay);
        *a -= *jump;
        1.0 - 2.0 * range * of_momentum
    }

    /// Adds ∫ δx dτ between two times.
    fn integrate(&mut self, set: &HarmonicSet, from: f64, to: f64) {
        let turns = [from, to].map(Complex64::cis);
        let steps = turns.map(|turn| if set.stride() == 2 { turn * turn } else { turn });
        let ([mut a, mut b], mut p) = (turns, 1.0);
        // x = Re Z e^{ipτ} for the packed parts of Z.
        for [re, im] in self.row.as_chunks_mut::<2>().0 {
            *re += (b.im - a.im) / p;
            *im += (b.re - a.re) / p;
            a *= steps[0];
            b *= steps[1];
            p += set.stride() as f64;
        }
    }
}

/// Packed harmonics of an impulse at a time, and of its mirror image half a turn later.
pub(super) fn impulse(set: &HarmonicSet, tau: f64, size: f64, g: &mut [f64]) {
    let mut turn = Complex64::cis(-tau);
    let step = if set.stride() == 2 { turn * turn } else { turn };
    let factor = 2.0 / PI * size;
    for [re, im] in g.as_chunks_mut::<2>().0 {
        (*re, *im) = (factor * turn.re, factor * turn.im);
        turn *= step;
    }
}
