//! Exact evaluation of friction in a plane under a normal load that may vary: harmonics of the force and their derivatives along the
//! path from event to event.
//!
//! With u = kt·x, the limit R = a + b·y and the path of [`crate::contact::forms::plane_path`], a stick from the time r has f = u − u(r) + f(r),
//! and slip f = R e, so that with the spectra S of kt in stick and Eᵢ of eᵢ in slip
//!
//! > F = T(S) X + b T(E) Y + Σ (f(r) − u(r)) g + a ê.
//!
//! The derivative has the same Toeplitz blocks and the derivatives of f(r) and of the angle θ of slip; moving events contribute nothing,
//! because the force is continuous. Over a panel of slip with nodes j, Runge–Kutta matrix A and quadrature weights V,
//!
//! > (1 − hAD) δθ = δθ₀ + hA E δX,  δF = V (1 − hAD)⁻¹ (δθ₀ + hA E δX),
//!
//! where D = −e·u′/R and E is the derivative of θ′ by the motion. At an onset of slip δθ = n·δf/R, at its end δf = R n δθ + e δR. A
//! closing at τ moves by −δR/R′: δf = −u′(τ) times that in stick, and in slip along u′ at the angle φ, with a = |u′|/R′,
//! δθ = n·δu′/|u′| − φ′/(1 + a) δR/R′. The force at the start of the turn is the one that returns after it, which gives its derivative.

mod plane_sensitivity;
mod slip_session;

use crate::aft::evaluation::Evaluation;
use crate::aft::jacobian_block::{Block, add_stiffness, apply, pack};
use crate::aft::normal_force::Normal;
use crate::aft::piecewise_exact::transform;
use crate::aft::plane_friction::plane_sensitivity::PlaneSensitivity;
use crate::aft::toeplitz::Toeplitz;
use crate::contact::forms::contact_state::State;
use crate::contact::forms::law::PlaneFriction;
use crate::contact::forms::plane_path::{PlaneForce, PlanePath, PlanePiece, Repetition};
use crate::contact::forms::radau::RADAU_STAGES;
use crate::error::{Result, boxed, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;
use num_complex::Complex64;

const CONTEXT: &str = "friction in a plane";

/// Tables and memory of the evaluation for one harmonic set.
pub struct PlaneFrictionEvaluator {
    path: Box<PlanePath>,
    normal: Option<Normal>,
    transform: Vec<Complex64>,
    /// Spectra of the stiffness in stick, and of both components of the direction in slip.
    spectra: [Vec<Complex64>; 3],
    toeplitz: Toeplitz,
    g: Vec<f64>,
    /// Memory for derivatives; `None` where the force alone is evaluated.
    sensitivity: Option<Box<PlaneSensitivity>>,
}

impl PlaneFrictionEvaluator {
    /// Memory for motions of `set` under `law`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(set: &HarmonicSet, law: &dyn PlaneFriction) -> Result<Self> {
        Self::with(set, law, false)
    }

    /// Memory for the force alone.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn force_alone(set: &HarmonicSet, law: &dyn PlaneFriction) -> Result<Self> {
        Self::with(set, law, true)
    }

    fn with(set: &HarmonicSet, law: &dyn PlaneFriction, force_alone: bool) -> Result<Self> {
        let spectrum = || try_vec(2 * set.highest_reduced() + 1, Complex64::ZERO, CONTEXT);
        let has_normal = law.normal().is_some();
        Ok(Self {
            path: boxed(|| PlanePath::new(set, !has_normal))?,
            normal: law.normal().map(|_| Normal::new(set, force_alone)).transpose()?,
            transform: spectrum()?,
            spectra: [spectrum()?, spectrum()?, spectrum()?],
            toeplitz: Toeplitz::new(set)?,
            g: try_vec(set.packed_len(), 0.0, CONTEXT)?,
            sensitivity: if force_alone {
                None
            } else {
                Some(boxed(|| PlaneSensitivity::new(set, law.directions()))?)
            },
        })
    }

    /// Whether the memory suits `law`.
    pub fn suits(&self, law: &dyn PlaneFriction) -> bool {
        self.normal.is_some() == law.normal().is_some()
    }

    /// The path of the motion evaluated last.
    #[must_use]
    pub fn path(&self) -> &PlanePath {
        &self.path
    }

    /// Force and Jacobian of `law` at packed tangential motions x₁, x₂ and, if the law has a varying load, the normal
    /// motion y.
    ///
    /// # Errors
    /// `NoConvergence` for a motion whose path cannot be followed; `StoppedByCaller`.
    pub fn evaluate(
        &mut self,
        law: &dyn PlaneFriction,
        set: &HarmonicSet,
        motion: &[f64],
        out: &mut Evaluation,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        interrupt.check()?;
        out.clear();
        let mut pieces: &[_] = &[];
        if let (Some(normal), Some(law)) = (&mut self.normal, law.normal()) {
            normal.evaluate(law, motion, out, interrupt)?;
            pieces = normal.pieces();
            out.open_fraction = normal.open_fraction();
        }
        law.path(motion, pieces, &mut self.path, interrupt)?;
        self.add_forces(law, set, motion, out, interrupt)?;
        out.linear = matches!(self.path.repetition, Repetition::Rests([None, None]));
        out.stuck = out.linear && law.slider().iter().all(|w| *w == 0.0);
        let Some(sensitivity) = self.sensitivity.as_mut().filter(|_| !out.is_force_alone()) else {
            return Ok(());
        };
        sensitivity.add_to(law, &mut self.path, out, interrupt)?;
        let m = set.packed_len();
        let order = motion.len().max(1);
        out.offset[..2 * m].copy_from_slice(&out.force[..2 * m]);
        for (column, x) in out.jacobian.chunks_exact(order).zip(motion) {
            for (o, j) in out.offset[..2 * m].iter_mut().zip(column) {
                *o -= j * x;
            }
        }
        Ok(())
    }

    /// Adds the Toeplitz blocks of the Jacobian, and writes the force.
    fn add_forces(
        &mut self,
        law: &dyn PlaneFriction,
        set: &HarmonicSet,
        motion: &[f64],
        out: &mut Evaluation,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let (d, m, turn) = (out.directions, set.packed_len(), self.path.turn);
        let [constant, by_y] = law.limit();
        // The pull of a piece counts from the slider's place before any motion, the motion from zero.
        let of_slider = law.slider().map(|w| law.stiffness() * w);
        for spectrum in &mut self.spectra {
            spectrum.fill(Complex64::ZERO);
        }
        for piece in &self.path.pieces {
            interrupt.check_before((2 * m * RADAU_STAGES) as u64)?;
            if piece.state() == State::Slip {
                out.count(State::Slip, (piece.end - piece.start) / turn);
            }
            if let PlaneForce::Stick { force, pull } = piece.force {
                transform([piece.start, piece.end], turn.recip(), turn, &mut self.transform);
                add_stiffness(&mut self.spectra[0], law.stiffness(), &self.transform, 1);
                pack(set, &self.transform, &mut self.g);
                for (i, offset) in out.offset.chunks_exact_mut(m.max(1)).take(2).enumerate() {
                    for (o, g) in offset.iter_mut().zip(&self.g) {
                        *o += (force[i] - pull[i] - of_slider[i]) * g;
                    }
                }
            }
            let [_, first, second] = &mut self.spectra;
            add_directions(&self.path, piece, first, second);
        }
        for (i, offset) in out.offset.chunks_exact_mut(m.max(1)).take(2).enumerate() {
            pack(set, &self.spectra[1 + i], &mut self.g);
            for (o, g) in offset.iter_mut().zip(&self.g) {
                *o += constant * g;
            }
        }
        let blocks = [(0, [0, 0], 1.0), (0, [1, 1], 1.0), (1, [0, 2], by_y), (2, [1, 2], by_y)];
        for (spectrum, place, factor) in blocks.into_iter().filter(|(_, [_, j], _)| *j < d) {
            interrupt.check_before((m * m) as u64)?;
            if place != [1, 1] {
                self.spectra[spectrum].iter_mut().for_each(|s| *s *= factor);
                self.toeplitz.set(set, &self.spectra[spectrum]);
            }
            if out.is_force_alone() {
                let [i, j] = place.map(|direction| direction * m);
                self.toeplitz
                    .add_product(&motion[j..], &mut out.offset[i..], interrupt)?;
            } else {
                Block::new(&mut out.jacobian, d, m, place).add_toeplitz(&self.toeplitz);
            }
        }
        if out.is_force_alone() {
            out.force[..2 * m].copy_from_slice(&out.offset[..2 * m]);
            return Ok(());
        }
        apply(&out.jacobian, motion, &out.offset, &mut out.force);
        Ok(())
    }
}

/// Adds the transform (1/turn)∫ eᵢ e^{−inτ} dτ of both components of the slip direction over a piece of slip.
fn add_directions(path: &PlanePath, piece: &PlanePiece, first: &mut [Complex64], second: &mut [Complex64]) {
    let PlaneForce::Slip(panel) = &piece.force else {
        return;
    };
    let length = piece.end - piece.start;
    let weights = &path.tables.integrals[RADAU_STAGES - 1];
    for (j, e) in panel.directions.iter().enumerate() {
        let weight = weights[j] * length / path.turn;
        let step = Complex64::cis(-(piece.start + length * path.tables.nodes[j]));
        let mut turn = Complex64::new(weight, 0.0);
        for (first, second) in first.iter_mut().zip(second.iter_mut()) {
            *first += e[0] * turn;
            *second += e[1] * turn;
            turn *= step;
        }
    }
}
