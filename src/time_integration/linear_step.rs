//! Steps of a structure that is linear between events: the Taylor series of the exact propagator.
//!
//! Between events z′ = A z + g(t) with constant A and harmonic g, whose solution is a matrix exponential. Its series
//! is summed in the displacements alone, xₖ being their Taylor coefficients:
//! (k + 1)(k + 2) M x_{k+2} = F_k − (k + 1) C x_{k+1} − K x_k − f_k, with f_k = slope·y_k of the relative motions y
//! for k > 0. The length h of the step, |A|h of about 2, keeps the last terms below round-off; a step is then exact,
//! and a polynomial as well (Moler & Van Loan 2003, doi:10.1137/S00361445024180, method 1 with short steps; Jorba &
//! Zou 2005, doi:10.1080/10586458.2005.10128904, for the choice of h).

use crate::contact::forms::time_piece::TimePiece;
use crate::error::{Result, fail, try_vec};
use crate::time_integration::step_polynomial::{DEGREE, StepPolynomial};
use crate::time_integration::unrolled_structure::System;
use num_complex::Complex64;

/// Share of the largest term below which the last terms of a step must be.
/// Kind: rounding.
const LINEAR_STEP_NEGLIGIBLE: f64 = 1e-18;

/// Rounds of shortening a step whose largest terms shrink with it.
/// Kind: cap.
const LINEAR_STEP_ROUNDS: usize = 100;

/// Size of a term from which on the next ones may overflow.
/// Kind: rounding.
const LINEAR_STEP_OVERFLOW: f64 = 1e200;

/// Steps by Taylor series, with their memory.
pub(super) struct Taylor {
    force: Vec<f64>,
    turning: Vec<Complex64>,
    /// Values of `turning` for the term before.
    before: Vec<Complex64>,
    /// Length of the step to try next.
    trial: f64,
}

impl Taylor {
    /// Memory for steps of `system`.
    pub fn new(system: &System<'_>) -> Result<Self> {
        const CONTEXT: &str = "a time step";
        let n = system.order();
        Ok(Self {
            force: try_vec(n, 0.0, CONTEXT)?,
            turning: try_vec(system.loads.len(), Complex64::ZERO, CONTEXT)?,
            before: try_vec(system.loads.len(), Complex64::ZERO, CONTEXT)?,
            trial: 0.1 * system.lapse(),
        })
    }

    /// Fills `step` with the motion from (x, v) at time t over at most `longest`.
    #[allow(clippy::too_many_arguments)]
    pub fn step(
        &mut self,
        system: &mut System<'_>,
        pieces: &[TimePiece],
        x: &[f64],
        v: &[f64],
        t: f64,
        longest: f64,
        step: &mut StepPolynomial,
    ) -> Result<()> {
        let n = x.len();
        loop {
            let h = self.trial.min(longest);
            step.begin = t;
            step.length = h;
            step.degree = DEGREE;
            step.coefficients[..n].copy_from_slice(x);
            for (c, v) in step.coefficients[n..2 * n].iter_mut().zip(v) {
                *c = h * v;
            }
            for (turning, load) in self.turning.iter_mut().zip(&system.loads) {
                *turning = load.value * system.turn(load.harmonic, t);
            }
            self.before.fill(Complex64::ZERO);
            for k in 0..=DEGREE - 2 {
                system.interrupt.check_before(system.operations())?;
                self.next_term(system, pieces, k, h, step)?;
            }
            let ratio = Self::ratio(step);
            if ratio > 0.0 {
                // A step that ends with the lapse does not shorten the next one.
                let shortened = h < self.trial && ratio >= 1.0;
                self.trial = (h * ratio.min(2.0)).max(if shortened { self.trial } else { 0.0 });
                if ratio < 1.0 {
                    step.rescale(ratio);
                }
                return Ok(());
            }
            // The step is so long that its terms overflow.
            self.trial = 1e-3 * h;
            if self.trial < f64::MIN_POSITIVE {
                return fail!(NoConvergence, "the motion in time grows beyond all bounds");
            }
        }
    }

    /// Computes the term x_{k+2} from x_k and x_{k+1}.
    fn next_term(
        &mut self,
        system: &mut System<'_>,
        pieces: &[TimePiece],
        k: usize,
        h: f64,
        step: &mut StepPolynomial,
    ) -> Result<()> {
        let n = self.force.len();
        let f = &mut self.force;
        f.fill(0.0);
        if system.omega_rate == 0.0 {
            for (turning, load) in self.turning.iter_mut().zip(&system.loads) {
                f[load.dof] += turning.re;
                *turning *= Complex64::I * (load.harmonic as f64 * system.omega * h / (k + 1) as f64);
            }
        } else {
            // From c′ = ihφ′c with φ′ = ω + ω′t: (k + 1) c_{k+1} = ih (φ′₀ c_k + ω′ c_{k−1}), times the length of the step.
            let omega = system.omega + system.omega_rate * step.begin;
            for ((turning, before), load) in self.turning.iter_mut().zip(&mut self.before).zip(&system.loads) {
                f[load.dof] += turning.re;
                let factor = Complex64::I * (load.harmonic as f64 * h / (k + 1) as f64);
                let next = factor * (omega * *turning + system.omega_rate * h * *before);
                *before = *turning;
                *turning = next;
            }
        }
        let (low, high) = step.coefficients.split_at_mut((k + 1) * n);
        let this = &low[k * n..];
        let (next, new) = high.split_at_mut(n);
        system.matrices.stiffness.multiply_add(-1.0, this, f);
        system.matrices.damping.multiply_add(-((k + 1) as f64) / h, next, f);
        for (e, piece) in system.elements.iter().zip(pieces) {
            let force = if k == 0 {
                piece.force
            } else {
                piece.along(e.relative(this))
            };
            e.push(-1.0, force, f);
        }
        // A step that is too long overflows, and is shortened.
        if f.iter().all(|f| f.abs() < LINEAR_STEP_OVERFLOW) {
            system.accelerate(f)?;
        } else {
            f.fill(f64::NAN);
        }
        let scale = h * h / ((k + 1) * (k + 2)) as f64;
        for (new, f) in new.iter_mut().zip(f.iter()) {
            *new = scale * f;
        }
        Ok(())
    }

    /// Factor on the length at which the last two terms are negligible against the largest of the
    /// shortened step; 0 where they overflow.
    fn ratio(step: &StepPolynomial) -> f64 {
        let mut sizes = [0.0_f64; DEGREE + 1];
        for (k, size) in sizes.iter_mut().enumerate() {
            if step.term(k).iter().any(|c| !c.is_finite()) {
                return 0.0;
            }
            *size = step.term(k).iter().fold(0.0, |m, c| m.max(c.abs()));
        }
        let mut ratio = f64::INFINITY;
        // The largest term shrinks with the step, but by a far lower power than the last.
        for _ in 0..LINEAR_STEP_ROUNDS {
            let mut largest = 0.0_f64;
            let mut power = 1.0;
            for size in sizes {
                largest = largest.max(size * power);
                power *= ratio.min(1.0);
            }
            let before = ratio;
            for k in [DEGREE - 1, DEGREE] {
                if sizes[k] > 0.0 {
                    ratio = ratio.min((LINEAR_STEP_NEGLIGIBLE * largest / sizes[k]).powf(1.0 / k as f64));
                }
            }
            if ratio > 0.9 * before {
                break;
            }
        }
        ratio
    }
}
