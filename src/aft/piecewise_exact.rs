//! Exact evaluation: turning points and slip times located, Fourier integrals in closed form.
//!
//! No law is named here: [`PiecewiseLinear::pieces`] returns intervals, and each contributes
//! ∫ₐᵇ e^{−inτ} dτ = (e^{−ina} − e^{−inb})/(in). For sets of odd harmonics half a turn suffices; the other half
//! repeats it with opposite sign and doubles every integral that is used.

use crate::aft::evaluation::Evaluation;
use crate::aft::jacobian_assembly::Assembly;
use crate::aft::moved_ends::MovedEnds;
use crate::contact::forms::law::{PackedMotion, PiecewiseLinear};
use crate::contact::forms::piece::Piece;
use crate::error::{Error, Result, try_vec};
use crate::fourier::HarmonicSet;
use crate::fourier::{Extremum, TurningPoints};
use crate::interrupt::Interrupt;
use crate::linalg::libraries::{Arch, Simd, WithSimd};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Tables and memory of the exact evaluation for one harmonic set.
pub struct Exact {
    turning_points: TurningPoints,
    extrema: Vec<Extremum>,
    pieces: Vec<Piece>,
    transform: Vec<Complex64>,
    assembly: Assembly,
    ends: MovedEnds,
}

impl Exact {
    /// Memory for motions of `set` under laws of up to `most_pieces` pieces.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(set: &HarmonicSet, most_pieces: usize) -> Result<Self> {
        let highest = set.highest_reduced();
        let assembly = Assembly::new(set)?;
        // x' has at most 2·highest roots per turn.
        let mut extrema = Vec::new();
        let mut pieces = Vec::new();
        extrema
            .try_reserve_exact(2 * highest + 4)
            .and_then(|()| pieces.try_reserve_exact(most_pieces))
            .map_err(|_| Error::out_of_memory("the pieces of a motion"))?;
        Ok(Self {
            turning_points: TurningPoints::new(set)?,
            extrema,
            pieces,
            transform: try_vec(2 * highest + 1, Complex64::ZERO, "a transform")?,
            assembly,
            ends: MovedEnds::new(set)?,
        })
    }

    /// Finds the turning points of a packed motion.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    pub fn prepare(&mut self, set: &HarmonicSet, motion: &[f64], interrupt: &Interrupt<'_>) -> Result<()> {
        self.turning_points.find(set, motion, &mut self.extrema, interrupt)
    }

    /// The pieces of the law evaluated last.
    #[must_use]
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Half the range of the prepared motion.
    #[must_use]
    pub fn half_range(&self, set: &HarmonicSet) -> f64 {
        let (low, high) = self
            .extrema
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), e| (l.min(e.x), h.max(e.x)));
        if self.extrema.is_empty() {
            0.0
        } else if set.is_odd() {
            high.max(-low)
        } else {
            0.5 * (high - low)
        }
    }

    /// Force and Jacobian of `law` for the prepared motion at an angular frequency; see [`crate::aft`].
    ///
    /// # Errors
    /// `StoppedByCaller`.
    pub fn evaluate(
        &mut self,
        law: &dyn PiecewiseLinear,
        PackedMotion { set, motion, omega }: PackedMotion<'_>,
        out: &mut Evaluation,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        self.pieces.clear();
        law.pieces_at(
            PackedMotion { set, motion, omega },
            &self.extrema,
            &mut self.pieces,
            interrupt,
        )?;
        self.assembly.start(out);
        let turn = TAU / set.stride() as f64;
        let ends = law.sliding_ends();
        for piece in &self.pieces {
            interrupt.check()?;
            // A piece without stiffness has no part in its spectrum, whose numbers go twice as far as those of the motion.
            let numbers = if piece.slope == 0.0 {
                set.highest_reduced() + 1
            } else {
                self.transform.len()
            };
            let found = &mut self.transform[..numbers];
            transform([piece.start, piece.end], turn.recip(), turn, found);
            let state = law.state(piece);
            self.assembly.add(
                (set, motion),
                (piece, state),
                &self.transform,
                piece.anchor.filter(|_| ends.is_none()),
                out,
                interrupt,
            )?;
        }
        if let Some(ends) = ends {
            let pieces = (&self.pieces[..], ends);
            self.ends.add(
                PackedMotion { set, motion, omega },
                pieces,
                &mut self.assembly,
                out,
                interrupt,
            )?;
        }
        interrupt.check()?;
        self.assembly.finish(set, motion, out, interrupt)
    }
}

/// scale·∫ₐᵇ e^{−inτ} dτ for all n. With odd harmonics and `turn` = π the piece represents its mirror image too; then
/// even n belong to the stiffness spectrum and odd n to g, and both double.
pub(super) fn transform([a, b]: [f64; 2], scale: f64, turn: f64, out: &mut [Complex64]) {
    let (mean, rest) = out.split_at_mut(1);
    mean[0] = (scale * (b - a)).into();
    // A whole turn has no harmonics but the mean. Odd n over half a turn would be used only by offsets of a clamped
    // slider, and an odd motion never clamps.
    if a == 0.0 && b >= turn {
        rest.fill(Complex64::ZERO);
        return;
    }
    // (e^{−ina} − e^{−inb})/(in) = e^{−inc}·2 sin(nd)/n about the middle c: relative accuracy for pieces however short,
    // which near-rigid contacts multiply by a large stiffness.
    let (middle, half) = (Complex64::cis(-0.5 * (a + b)), Complex64::cis(0.5 * (b - a)));
    Arch::new().dispatch(Harmonics(middle, half, 2.0 * scale, rest));
}

/// Powers side by side, none of which waits for another.
/// Kind: block.
const SIDE_BY_SIDE: usize = 4;

/// Computes zₙ = middleⁿ·(factor·Im halfⁿ/n) for n from 1 on.
struct Harmonics<'a>(Complex64, Complex64, f64, &'a mut [Complex64]);

/// Four complex numbers: all real parts, then all imaginary parts.
type Powers = [[f64; SIDE_BY_SIDE]; 2];

impl WithSimd for Harmonics<'_> {
    type Output = ();

    #[inline(always)]
    #[allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Self(middle, half, factor, to) = self;
        let ((mut of_middle, by_middle), (mut of_half, by_half)) = (powers(middle), powers(half));
        let mut number = [1.0, 2.0, 3.0, 4.0];
        let (blocks, last) = to.as_chunks_mut::<SIDE_BY_SIDE>();
        for to in blocks {
            *to = products(&of_middle, &of_half, factor, &number);
            multiply(&mut of_middle, by_middle);
            multiply(&mut of_half, by_half);
            number = number.map(|n| n + SIDE_BY_SIDE as f64);
        }
        let rest = products(&of_middle, &of_half, factor, &number);
        last.copy_from_slice(&rest[..last.len()]);
    }
}

/// Powers z, z², z³, z⁴; and z⁴ alone.
#[inline(always)]
#[allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]
fn powers(z: Complex64) -> (Powers, Complex64) {
    let square = z * z;
    let all = [z, square, square * z, square * square];
    ([all.map(|z| z.re), all.map(|z| z.im)], all[3])
}

#[inline(always)]
#[allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]
fn multiply([re, im]: &mut Powers, by: Complex64) {
    for (re, im) in re.iter_mut().zip(im) {
        (*re, *im) = (*re * by.re - *im * by.im, *re * by.im + *im * by.re);
    }
}

#[inline(always)]
#[allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]
fn products(
    [re, im]: &Powers,
    [_, sine]: &Powers,
    factor: f64,
    number: &[f64; SIDE_BY_SIDE],
) -> [Complex64; SIDE_BY_SIDE] {
    let mut to = [Complex64::ZERO; SIDE_BY_SIDE];
    for i in 0..SIDE_BY_SIDE {
        let factor = factor * sine[i] / number[i];
        to[i] = Complex64::new(re[i] * factor, im[i] * factor);
    }
    to
}
