//! Adaptive implicit steps for smooth laws, which have no matrix exponential: collocation at eight Gauss nodes, of
//! order 16, A-stable, without numerical damping.
//!
//! The unknowns are the accelerations at the nodes: M aᵢ + C vᵢ + K xᵢ + f(xᵢ) = F(tᵢ) with
//! v = v₀ + hA a and x = x₀ + hc v₀ + h²A² a. The polynomial through them is the motion within the step, so
//! that events of other contacts are located as between linear pieces. Its highest Legendre coefficient
//! estimates the error and sets the step; see Hairer, Nørsett & Wanner, Solving Ordinary Differential
//! Equations I (1993), II.7, doi:10.1007/978-3-540-78862-1.

use crate::contact::forms::time_piece::TimePiece;
use crate::error::{Error, Result, Status, fail, try_vec};
use crate::linalg::factors::lu::Lu;
use crate::time_integration::gauss::{GAUSS_STAGES, GaussTables};
use crate::time_integration::smooth_laws::Smooth;
use crate::time_integration::step_polynomial::StepPolynomial;
use crate::time_integration::unrolled_structure::System;

/// Newton iterations of a step before it is halved.
/// Kind: cap.
const IMPLICIT_STEP_MOST_ITERATIONS: usize = 30;

/// Implicit steps, with their memory.
pub(super) struct Implicit {
    tables: GaussTables,
    lu: Lu<f64>,
    /// Accelerations at the nodes, node after node.
    accelerations: Vec<f64>,
    residual: Vec<f64>,
    smooth: Smooth,
    x: Vec<f64>,
    v: Vec<f64>,
    trial: f64,
    tolerance: f64,
    /// Largest displacement and velocity so far.
    largest: (f64, f64),
    /// Error of a callback at the last motion that it could not evaluate.
    refusal: Option<Error>,
}

impl Implicit {
    /// Memory for steps of `system` whose local error is `tolerance` of the largest motion.
    pub fn new(system: &System<'_>, tolerance: f64) -> Result<Self> {
        const CONTEXT: &str = "an implicit time step";
        let n = system.order();
        let all = n.saturating_mul(GAUSS_STAGES);
        Ok(Self {
            tables: GaussTables::new(),
            lu: Lu::new(all, 1)?,
            accelerations: try_vec(all, 0.0, CONTEXT)?,
            residual: try_vec(all, 0.0, CONTEXT)?,
            smooth: Smooth::new(system, GAUSS_STAGES)?,
            x: try_vec(n, 0.0, CONTEXT)?,
            v: try_vec(n, 0.0, CONTEXT)?,
            trial: 0.05 * system.lapse(),
            tolerance,
            largest: (0.0, 0.0),
            refusal: None,
        })
    }

    /// Fills `step` with the motion from (x, v) at time t over at most `longest`.
    #[allow(clippy::too_many_arguments)]
    pub fn step(
        &mut self,
        system: &System<'_>,
        pieces: &[TimePiece],
        x: &[f64],
        v: &[f64],
        t: f64,
        longest: f64,
        step: &mut StepPolynomial,
    ) -> Result<()> {
        let shortest = 1e-14 * system.lapse();
        loop {
            let h = self.trial.min(longest);
            if self.trial < shortest {
                if let Some(refusal) = self.refusal.take() {
                    return Err(refusal);
                }
                return fail!(
                    NoConvergence,
                    "the time step fell below {shortest:.1e} at time {t}: the motion grows beyond all bounds"
                );
            }
            match self.collocate(system, pieces, x, v, t, h) {
                Ok(true) => self.refusal = None,
                Ok(false) => {
                    self.refusal = None;
                    self.trial = 0.25 * h;
                    continue;
                }
                // Another motion may succeed.
                Err(e) if e.recoverable => {
                    self.refusal = Some(e);
                    self.trial = 0.25 * h;
                    continue;
                }
                Err(e) => return Err(e),
            }
            let error = self.interpolate(x, v, h, step);
            step.begin = t;
            // The error grows with h to the power of the last coefficient's number plus 2.
            let factor = 0.9 * (self.tolerance / error).powf(1.0 / (GAUSS_STAGES + 1) as f64);
            let next = h * factor.clamp(0.2, 2.0);
            if error <= self.tolerance {
                // A step that ends with the lapse does not shorten the next one.
                self.trial = if h < self.trial { next.max(self.trial) } else { next };
                return Ok(());
            }
            self.trial = next;
        }
    }

    /// Factors the matrix δᵢⱼM + h aᵢⱼCᵢ + h² (A²)ᵢⱼKᵢ, with the current tangents.
    fn factor(&mut self, system: &System<'_>, pieces: &[TimePiece], h: f64) -> Result<()> {
        let n = self.x.len();
        let all = n * GAUSS_STAGES;
        let tables = &self.tables;
        let matrix = self.lu.matrix();
        matrix.fill(0.0);
        for i in 0..GAUSS_STAGES {
            system.interrupt.check()?;
            system
                .matrices
                .inertia
                .each(|r, c, m| matrix[(i * n + c) * all + i * n + r] += m);
            for j in 0..GAUSS_STAGES {
                system.interrupt.check()?;
                let (once, twice) = (h * tables.once[i][j], h * h * tables.twice[i][j]);
                let mut add = |r: usize, c: usize, value: f64| matrix[(j * n + c) * all + i * n + r] += value;
                system.matrices.damping.each(|r, c, d| add(r, c, once * d));
                system.matrices.stiffness.each(|r, c, k| add(r, c, twice * k));
                for (element, piece) in system.elements.iter().zip(pieces) {
                    for (to, slopes) in element.rows.iter().zip(&piece.slope) {
                        for (from, slope) in element.rows.iter().zip(slopes).filter(|(_, slope)| **slope != 0.0) {
                            for &(r, a) in to.iter().flatten() {
                                for &(c, b) in from.iter().flatten() {
                                    add(r, c, twice * slope * a * b);
                                }
                            }
                        }
                    }
                }
                self.smooth
                    .each(system, i, |r, c, by_x, by_v| add(r, c, twice * by_x + once * by_v));
            }
        }
        self.lu.factor(system.interrupt)
    }

    /// Solves for the accelerations by Newton's method, with the tangents at the start of the step; `false` if it
    /// fails.
    fn collocate(
        &mut self,
        system: &System<'_>,
        pieces: &[TimePiece],
        x: &[f64],
        v: &[f64],
        t: f64,
        h: f64,
    ) -> Result<bool> {
        let n = x.len();
        self.smooth.evaluate(system, 0, x, v, &mut self.residual[..n])?;
        self.smooth.repeat();
        match self.factor(system, pieces, h) {
            Err(e) if e.status == Status::Singular => return Ok(false),
            factored => factored?,
        }
        self.accelerations.fill(0.0);
        let mut before = f64::INFINITY;
        for iteration in 0..IMPLICIT_STEP_MOST_ITERATIONS {
            self.evaluate(system, pieces, x, v, t, h)?;
            self.lu.solve(&mut self.residual);
            let (mut change, mut size) = (0.0_f64, 0.0_f64);
            for (a, r) in self.accelerations.iter_mut().zip(&self.residual) {
                *a -= r;
                change = change.max(r.abs());
                size = size.max(a.abs());
            }
            if !size.is_finite() || (iteration > 3 && change > before && change > 1e-8 * size) {
                return Ok(false);
            }
            if change <= 2.0 * f64::EPSILON * size || (change > 0.5 * before && change <= 1e-11 * size) {
                self.evaluate(system, pieces, x, v, t, h)?;
                return Ok(true);
            }
            before = change;
        }
        Ok(false)
    }

    /// Evaluates M a + C v + K x + f − F at the nodes, and the tangents of smooth laws at them.
    fn evaluate(
        &mut self,
        system: &System<'_>,
        pieces: &[TimePiece],
        x0: &[f64],
        v0: &[f64],
        t: f64,
        h: f64,
    ) -> Result<()> {
        let n = self.x.len();
        for i in 0..GAUSS_STAGES {
            system.interrupt.check_before(system.operations())?;
            let c = self.tables.nodes[i];
            for d in 0..n {
                let (mut once, mut twice) = (0.0, 0.0);
                for j in 0..GAUSS_STAGES {
                    let a = self.accelerations[j * n + d];
                    once += self.tables.once[i][j] * a;
                    twice += self.tables.twice[i][j] * a;
                }
                self.v[d] = v0[d] + h * once;
                self.x[d] = x0[d] + h * (c * v0[d] + h * twice);
            }
            let r = &mut self.residual[i * n..(i + 1) * n];
            r.fill(0.0);
            system.load(t + c * h, r);
            for r in r.iter_mut() {
                *r = -*r;
            }
            system
                .matrices
                .inertia
                .multiply_add(1.0, &self.accelerations[i * n..(i + 1) * n], r);
            system.matrices.damping.multiply_add(1.0, &self.v, r);
            system.matrices.stiffness.multiply_add(1.0, &self.x, r);
            for (element, piece) in system.elements.iter().zip(pieces) {
                element.push(1.0, piece.at(element.relative(&self.x)), r);
            }
            self.smooth.evaluate(system, i, &self.x, &self.v, r)?;
        }
        Ok(())
    }

    /// Fills the polynomials of the step and returns its relative error.
    fn interpolate(&mut self, x: &[f64], v: &[f64], h: f64, step: &mut StepPolynomial) -> f64 {
        let n = x.len();
        step.length = h;
        step.degree = GAUSS_STAGES + 1;
        let c = &mut step.coefficients;
        c[..n].copy_from_slice(x);
        for (c, v) in c[n..2 * n].iter_mut().zip(v) {
            *c = h * v;
        }
        c[2 * n..(GAUSS_STAGES + 2) * n].fill(0.0);
        let mut last = 0.0_f64;
        for d in 0..n {
            for k in 0..GAUSS_STAGES {
                let sum = |k: usize| -> f64 {
                    (0..GAUSS_STAGES)
                        .map(|j| self.tables.legendre[k][j] * self.accelerations[j * n + d])
                        .sum()
                };
                let coefficient = sum(k);
                if k + 1 == GAUSS_STAGES {
                    last = last.max(coefficient.abs());
                }
                for m in 0..=k {
                    let scale = h * h / ((m + 1) * (m + 2)) as f64;
                    c[(m + 2) * n + d] += scale * self.tables.powers[k][m] * coefficient;
                }
            }
        }
        for (x, v) in x.iter().zip(v) {
            self.largest.0 = self.largest.0.max(x.abs());
            self.largest.1 = self.largest.1.max(v.abs());
        }
        // From rest the sizes follow from the step itself.
        step.at(1.0, &mut self.x, &mut self.v);
        for (x, v) in self.x.iter().zip(&self.v) {
            self.largest.0 = self.largest.0.max(x.abs());
            self.largest.1 = self.largest.1.max(v.abs());
        }
        // Each integration divides the last Legendre polynomial by about its number.
        let order = 2.0 * (GAUSS_STAGES - 1) as f64;
        let of = |error: f64, largest: f64| if error > 0.0 { error / largest } else { 0.0 };
        of(last * h / order, self.largest.1).max(of(last * (h / order).powi(2), self.largest.0))
    }

    /// The nodes of the last step, and the tangents of smooth laws at them.
    pub fn nodes(&self) -> (&GaussTables, &Smooth) {
        (&self.tables, &self.smooth)
    }
}
