//! The harmonic balance as a problem of the continuation: its first guesses, the homotopies to its first point, and its limits.

use crate::error::{Result, Status, try_vec};
use crate::linalg::factors::lu::Lu;
use crate::linalg::newton::linear_system::Jacobian;
use crate::linalg::norm;
use crate::problem::gauges::Seen;
use crate::problem::harmonic_balance::HarmonicBalance;
use crate::problem::homotopy::{AlongPath, Path, PathHomotopy};
use crate::problem::parametric_problem::{End, Homotopy, InitialGuess, Problem, Residual};
use crate::problem::passed_resonance;
use crate::problem::residual_scale::Squares;
use num_complex::Complex64;

/// Size of a motion, relative to that under linear contacts, beyond which the forces keep less than four digits in
/// double precision.
/// Kind: rounding.
const FAR_MOTION: f64 = 1e12;

/// Residual, in units of the motion under linear contacts, above which the forces are unbalanced, even if it is small
/// against a large motion.
/// Kind: tuned; measured on: not recorded.
const UNBALANCED: f64 = 1e-2;

/// Least motion under linear contacts to which others are compared, in units of the largest motion of the structure: a contact
/// far from the forces, or between parts that move alike, vibrates less than its own static load moves it.
/// Kind: tuned; measured on: not recorded.
const LEAST_LINEAR_MOTION: f64 = 1e-6;

/// Stiffness of softened contacts over the reference stiffness, which is ten times that of the structure for near-rigid ones.
/// Kind: tuned; measured on: random chains of 3 to 7 masses with pressed `friction_3d`, kn/k 1e4 to 1e8.
const SOFTENED: f64 = 3.0;

impl AlongPath for HarmonicBalance<'_> {
    fn evaluate_along(&mut self, path: Path, omega: f64, u: &[f64], p: f64, out: &mut Residual) -> Result<()> {
        self.evaluate_at(u, omega, Some((path, p)), out)
    }

    fn observe_along(&self, path: Path, u: &[f64], direction: &[f64]) -> (Complex64, Complex64) {
        self.observe_at(u, direction, Some(path))
    }
}

impl Problem for HarmonicBalance<'_> {
    fn evaluate(&mut self, u: &[f64], p: f64, out: &mut Residual) -> Result<()> {
        self.evaluate_at(u, p, None, out)
    }

    fn observe(&self, u: &[f64], direction: &[f64]) -> (Complex64, Complex64) {
        self.observe_at(u, direction, None)
    }

    fn see(&mut self, response: usize, v: &[f64], direction: &[f64]) -> Result<Option<(Complex64, Complex64)>> {
        let Some(gauges) = &mut self.gauges else {
            return Ok(None);
        };
        gauges.read(v, direction, Some(response), &mut self.seen)?;
        Ok(self.seen.first().map(Seen::observed))
    }

    fn initial_guess(&mut self, kind: InitialGuess, p: f64, u: &mut [f64]) -> Result<bool> {
        match kind {
            InitialGuess::Given => {
                let Some(given) = &self.given else { return Ok(false) };
                u.copy_from_slice(given);
                Ok(true)
            }
            // With a preloaded contact the scaled laws have no solution at small motion: the load must grow.
            InitialGuess::Stuck if self.loaded_at_rest => Ok(false),
            InitialGuess::Stuck => {
                // At far smaller motions every law is linear: one Newton step from rest.
                u.fill(0.0);
                let mut at = Residual::new(u.len())?;
                self.evaluate_at(u, p, Some((Path::ScaledLaws, f64::INFINITY)), &mut at)?;
                let mut lu = Lu::new(u.len(), 1)?;
                let mut active = try_vec(u.len(), true, "the initial guess")?;
                self.fill(lu.matrix(), &mut active)?;
                match lu.factor(self.forces.interrupt()) {
                    Err(e) if e.status == Status::Singular => return Ok(false),
                    factored => factored?,
                }
                for (u, r) in u.iter_mut().zip(&at.values) {
                    *u = -r;
                }
                lu.solve(u);
                Ok(u.iter().all(|x| x.is_finite()))
            }
            InitialGuess::Reference => {
                self.tables
                    .tabulate(self.condensed, (p, false), self.forces.interrupt())?;
                let set = self.condensed.set();
                let m = set.packed_len();
                let coordinates = self.condensed.coordinates();
                for (i, table) in self.tables.current().iter().enumerate() {
                    for c in 0..coordinates {
                        let y = table.value[coordinates * (coordinates + 1) + c];
                        set.set(&mut u[c * m..(c + 1) * m], i, y);
                    }
                }
                Ok(true)
            }
        }
    }

    fn homotopy(&mut self, p: f64, u: &[f64]) -> Result<Option<Homotopy<'_>>> {
        if self.loaded_at_rest {
            return Ok(Some(PathHomotopy::between((0.0, 1.0), self, Path::GrowingLoad, p)));
        }
        let start = (1.01 * self.forces.linearisation_scale(u, p)?).ln();
        if !(start > 0.0 && start.is_finite()) {
            return Ok(None);
        }
        Ok(Some(PathHomotopy::between((start, 0.0), self, Path::ScaledLaws, p)))
    }

    fn softened_by(&self) -> Option<f64> {
        if !self.loaded_at_rest || self.condensed.has_exchanges() {
            return None;
        }
        let observed = self.observed;
        let ratio = |c: usize| SOFTENED * self.condensed.kappa(c, observed).norm() / self.condensed.stiffness(c);
        let near_rigid = (0..self.condensed.coordinates()).map(ratio).filter(|r| *r > 0.0);
        let least = near_rigid.fold(1.0, f64::min);
        (least < 1.0).then(|| least.ln())
    }

    fn soften(&mut self, ln_factor: f64) {
        self.forces.set_stiffening(ln_factor.exp());
    }

    fn stiffening(&mut self, ln_factor: f64, p: f64) -> Option<Homotopy<'_>> {
        Some(PathHomotopy::between((ln_factor, 0.0), self, Path::Stiffening, p))
    }

    /// Bounded solutions exist with damping, which absorbs the power of the forces. Without damping, resonances are
    /// the exception.
    fn is_bounded(&self) -> bool {
        true
    }

    fn is_far(&mut self, u: &[f64], p: f64, residual: f64) -> Result<bool> {
        let mut linear = try_vec(u.len(), 0.0, "the first point")?;
        match self.initial_guess(InitialGuess::Reference, p, &mut linear) {
            Err(e) if e.status == Status::StoppedByCaller => return Err(e),
            Ok(true) => {}
            _ => return Ok(false),
        }
        let size = |packed: &[f64]| Squares::of(self.condensed.set(), packed).size(Squares::default());
        let (far, linear) = (size(u), norm(&linear));
        let scale = linear.max(LEAST_LINEAR_MOTION);
        Ok(linear > 0.0 && (far > FAR_MOTION * scale || residual * far > UNBALANCED * scale))
    }

    fn has_kinks(&self) -> bool {
        self.forces.is_sampled()
    }

    fn resonance_between(&self, a: &End<'_>, b: &End<'_>, length: f64) -> Option<f64> {
        // Kinks seem to be resonances.
        if self.has_kinks() {
            return None;
        }
        passed_resonance::between(self.condensed.set(), a, b, length)
    }
}
