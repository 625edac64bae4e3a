//! One measured mode of a mistuned wheel: its data as linear functions of the pattern.
//!
//! The mode x = V p of frequency ω obeys g = (diag λ + K(δ) − ω² (I + M(δ))) p = 0, and shows y = H p + noise and z = ω + noise. Around an
//! estimate, those dp and dω that reach D dp + c dω + B dδ = −g with the least weighted residuals e solve
//!
//! ```text
//! [ HᵀH/s²   0     D ] [dp]   [ Hᵀ(y − Hp)/s² ]
//! [ 0        1/σ²  cᵀ] [dω] = [ (z − ω)/σ²    ]
//! [ D        c    −R ] [ μ]   [ −g − B dδ     ]
//! ```
//!
//! with a residual Rμ of the conditions, whose covariance R is that of the products of errors, which linear conditions leave out
//! (`condition_noise`): without it two modes of one frequency would be taken as not coupled at all. So e is a linear function of dδ, and
//! the least squares over all modes are the adjustment of observations with conditions (Helmert; Pope 1972), which sees the noise of the
//! shapes also where they multiply the unknowns.

use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::lu::Lu;
use crate::studies::condition_noise::{ConditionNoise, ModeErrors};

const CONTEXT: &str = "a measured mode";

/// Departure of a tuned mode from the equations, relative to λ, that a first estimate of the shape allows for: mistuning of some
/// per cent. It decides the start alone.
/// Kind: tuned; measured on: not recorded.
const FIRST_DEPARTURE: f64 = 0.1;

/// Matrices of the wheel over its tuned modes, in units in which frequencies are about 1.
pub(crate) struct Reduced {
    pub modes: usize,
    pub sectors: usize,
    pub squares: Vec<f64>,
    pub of_mass: bool,
    /// Matrices A_s over the tuned modes, one for each sector.
    pub matrices: Vec<f64>,
    /// Motions of the measured points in the tuned modes, column-major.
    pub rows: Vec<f64>,
}

impl Reduced {
    pub fn points(&self) -> usize {
        self.rows.len() / self.modes
    }

    /// Matrix Σ δ_s A_s of a pattern δ.
    pub fn of_pattern(&self, delta: &[f64]) -> Result<Vec<f64>> {
        let m = self.modes;
        let mut sum = try_vec(m * m, 0.0, CONTEXT)?;
        for (a, &delta) in self.matrices.chunks_exact(m * m).zip(delta) {
            for (sum, a) in sum.iter_mut().zip(a) {
                *sum += delta * a;
            }
        }
        Ok(sum)
    }

    /// Matrices of the independent parts of the pattern, one after the other; `lower` is the Cholesky factor of its
    /// covariance.
    pub fn of_parts(&self, lower: &[f64]) -> Result<Vec<f64>> {
        let mut parts = try_vec(self.matrices.len(), 0.0, CONTEXT)?;
        for (part, column) in parts
            .chunks_exact_mut(self.modes * self.modes)
            .zip(lower.chunks_exact(self.sectors))
        {
            part.copy_from_slice(&self.of_pattern(column)?);
        }
        Ok(parts)
    }

    fn shown(&self, p: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for (column, &p) in self.rows.chunks_exact(self.points()).zip(p) {
            for (out, row) in out.iter_mut().zip(column) {
                *out += p * row;
            }
        }
    }

    /// Product Hᵀ y with the motions H of the measured points.
    fn seen(&self, y: &[f64], out: &mut [f64]) {
        for (column, out) in self.rows.chunks_exact(self.points()).zip(out) {
            *out = column.iter().zip(y).map(|(h, y)| h * y).sum();
        }
    }

    /// Adds factor · HᵀH to the upper left corner of a column-major matrix.
    fn add_seen(&self, factor: f64, matrix: &mut [f64], order: usize) {
        for (j, of_j) in self.rows.chunks_exact(self.points()).enumerate() {
            for (i, of_i) in self.rows.chunks_exact(self.points()).enumerate() {
                let product: f64 = of_i.iter().zip(of_j).map(|(a, b)| a * b).sum();
                matrix[order * j + i] += factor * product;
            }
        }
    }
}

/// A measured mode, with the estimate of its motion and frequency.
pub(crate) struct Observed {
    pub frequency: f64,
    pub of_frequency: f64,
    pub shape: Vec<f64>,
    pub of_shape: f64,
    p: Vec<f64>,
    omega: f64,
    /// Steps dp, dω for dδ = 0; then their derivatives by each δ.
    steps: Vec<f64>,
    noise: ConditionNoise,
}

impl Observed {
    /// A measured mode: frequency and shape, both scaled to size 1, with their standard deviations.
    pub fn new(
        (frequency, of_frequency): (f64, f64),
        (shape, of_shape): (Vec<f64>, f64),
        reduced: &Reduced,
    ) -> Result<Self> {
        let m = reduced.modes;
        let width = 2 * m + 1;
        Ok(Self {
            frequency,
            of_frequency,
            shape,
            of_shape,
            p: try_vec(m, 0.0, CONTEXT)?,
            omega: frequency,
            steps: try_vec(width * (reduced.sectors + 1), 0.0, CONTEXT)?,
            noise: ConditionNoise::equal(m, 2.0 * of_frequency * of_shape)?,
        })
    }

    /// Makes the first estimate: the motion that shows the measured shape and obeys the equations of the tuned wheel
    /// to some per cent.
    pub fn start(&mut self, reduced: &Reduced, interrupt: &Interrupt<'_>) -> Result<()> {
        let m = reduced.modes;
        let mut lu = Lu::new(m, 1)?;
        let matrix = lu.matrix();
        matrix.fill(0.0);
        reduced.add_seen(1.0, matrix, m);
        let size: f64 = (0..m).map(|i| matrix[i * m + i]).sum::<f64>() / m as f64;
        for (i, square) in reduced.squares.iter().enumerate() {
            let departure = (square / (self.frequency * self.frequency) - 1.0) / FIRST_DEPARTURE;
            matrix[i * m + i] += size * departure * departure;
        }
        lu.factor(interrupt)?;
        reduced.seen(&self.shape, &mut self.p);
        lu.solve(&mut self.p);
        Ok(())
    }

    /// Adds JᵀJ and Jᵀe of the weighted residuals e + J dδ to the normal equations, and returns Σ e².
    pub fn add_normal(
        &mut self,
        reduced: &Reduced,
        pattern: &[f64],
        lu: &mut Lu<f64>,
        (normal, right): (&mut [f64], &mut [f64]),
        interrupt: &Interrupt<'_>,
    ) -> Result<f64> {
        let (m, sectors, points) = (reduced.modes, reduced.sectors, reduced.points());
        let width = 2 * m + 1;
        let (of_frequency, of_shape) = (self.of_frequency.powi(-2), self.of_shape.powi(-2));
        let factor = self.factor_of_pattern(reduced);
        let d = self.assemble(reduced, pattern, lu)?;
        lu.factor(interrupt)?;
        // Right sides: the estimate, then the matrices of the sectors.
        let mut residual = try_vec(points, 0.0, CONTEXT)?;
        reduced.shown(&self.p, &mut residual);
        for (residual, y) in residual.iter_mut().zip(&self.shape) {
            *residual = y - *residual;
        }
        self.steps.fill(0.0);
        let (first, others) = self.steps.split_at_mut(width);
        reduced.seen(&residual, &mut first[..m]);
        for first in &mut first[..m] {
            *first *= of_shape;
        }
        first[m] = (self.frequency - self.omega) * of_frequency;
        add_product(-1.0, &d, &self.p, &mut first[m + 1..]);
        for (other, a) in others.chunks_exact_mut(width).zip(reduced.matrices.chunks_exact(m * m)) {
            add_product(-factor, a, &self.p, &mut other[m + 1..]);
        }
        lu.solve_columns(&mut self.steps, false, interrupt)?;
        // Residuals over their standard deviations, and their derivatives.
        let height = points + 1 + m;
        let mut columns = try_vec(height * (sectors + 1), 0.0, CONTEXT)?;
        for (column, step) in columns.chunks_exact_mut(height).zip(self.steps.chunks_exact(width)) {
            reduced.shown(&step[..m], &mut column[..points]);
            column[points] = step[m];
            for column in &mut column[..points] {
                *column /= -self.of_shape;
            }
            column[points] /= -self.of_frequency;
            self.noise.weighted(&step[m + 1..], &mut column[points + 1..]);
        }
        let (e, j) = columns.split_at_mut(height);
        for (e, residual) in e.iter_mut().zip(&residual) {
            *e += residual / self.of_shape;
        }
        e[points] += (self.frequency - self.omega) / self.of_frequency;
        for (a, left) in j.chunks_exact(height).enumerate() {
            right[a] += dot(left, e);
            for (b, other) in j.chunks_exact(height).enumerate() {
                normal[sectors * b + a] += dot(left, other);
            }
        }
        Ok(dot(e, e))
    }

    /// Factor of Σ δ_s A_s in the conditions: 1 of stiffness, −ω² of mass.
    fn factor_of_pattern(&self, reduced: &Reduced) -> f64 {
        if reduced.of_mass { -self.omega * self.omega } else { 1.0 }
    }

    /// Writes the matrix of the equations of an adjustment to `lu`, and returns its part D.
    fn assemble(&self, reduced: &Reduced, pattern: &[f64], lu: &mut Lu<f64>) -> Result<Vec<f64>> {
        let m = reduced.modes;
        let width = 2 * m + 1;
        let square = self.omega * self.omega;
        let factor = self.factor_of_pattern(reduced);
        let mut d = try_vec(m * m, 0.0, CONTEXT)?;
        for (d, a) in d.iter_mut().zip(pattern) {
            *d = factor * a;
        }
        let mut inertia = try_vec(m, 0.0, CONTEXT)?;
        inertia.copy_from_slice(&self.p);
        if reduced.of_mass {
            add_product(1.0, pattern, &self.p, &mut inertia);
        }
        for (i, lambda) in reduced.squares.iter().enumerate() {
            d[i * m + i] += lambda - square;
        }
        let matrix = lu.matrix();
        matrix.fill(0.0);
        reduced.add_seen(self.of_shape.powi(-2), matrix, width);
        matrix[width * m + m] = self.of_frequency.powi(-2);
        for j in 0..m {
            for i in 0..m {
                matrix[width * (m + 1 + j) + i] = d[m * j + i];
                matrix[width * j + m + 1 + i] = d[m * j + i];
            }
            let c = -2.0 * self.omega * inertia[j];
            matrix[width * (m + 1 + j) + m] = c;
            matrix[width * m + m + 1 + j] = c;
        }
        self.noise.subtract_from(matrix, width);
        Ok(d)
    }

    /// Sets the noise of the conditions to that of the remaining errors. `matrices` belong to the independent parts
    /// of the pattern, whose covariance has the Cholesky factor `lower`. The steps are those of the last normal
    /// equations.
    pub fn know_errors(
        &mut self,
        reduced: &Reduced,
        pattern: &[f64],
        (matrices, lower): (&[f64], &[f64]),
        lu: &mut Lu<f64>,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let (m, sectors) = (reduced.modes, reduced.sectors);
        let width = 2 * m + 1;
        // Covariance of p and ω for a known pattern: the first block of the inverse.
        self.assemble(reduced, pattern, lu)?;
        lu.factor(interrupt)?;
        let mut inverse = try_vec(width * (m + 1), 0.0, CONTEXT)?;
        for j in 0..=m {
            inverse[(width + 1) * j] = 1.0;
        }
        lu.solve_columns(&mut inverse, false, interrupt)?;
        // That by the pattern: derivatives by its independent parts.
        let mut parts = try_vec((m + 1) * sectors, 0.0, CONTEXT)?;
        let by_delta = &self.steps[width..];
        for (part, of_lower) in parts.chunks_exact_mut(m + 1).zip(lower.chunks_exact(sectors)) {
            for (step, l) in by_delta.chunks_exact(width).zip(of_lower) {
                for (part, step) in part.iter_mut().zip(step) {
                    *part += l * step;
                }
            }
        }
        let mut shape = try_vec(m * m, 0.0, CONTEXT)?;
        for (shape, column) in shape.chunks_exact_mut(m).zip(inverse.chunks_exact(width)) {
            shape.copy_from_slice(&column[..m]);
        }
        let mut by_pattern = try_vec(sectors, 0.0, CONTEXT)?;
        for (part, by_pattern) in parts.chunks_exact(m + 1).zip(&mut by_pattern) {
            for (shape, p) in shape.chunks_exact_mut(m).zip(part) {
                for (shape, q) in shape.iter_mut().zip(part) {
                    *shape += p * q;
                }
            }
            *by_pattern = 2.0 * self.omega * part[m];
        }
        let factor = self.factor_of_pattern(reduced);
        // R is even in B: the sign of the factor goes to the frequency.
        for by_pattern in &mut by_pattern {
            *by_pattern /= factor;
        }
        let errors = ModeErrors {
            shape: &shape,
            by_pattern: &by_pattern,
            own: (2.0 * self.omega / factor).powi(2) * inverse[width * m + m],
        };
        self.noise = ConditionNoise::of_products(m, matrices, &errors)?;
        self.noise.scale(factor.abs());
        Ok(())
    }

    /// Moves the estimate by the step that belongs to a change of the pattern.
    pub fn follow(&mut self, change: &[f64], reduced: &Reduced) {
        let m = reduced.modes;
        let width = 2 * m + 1;
        let (first, others) = self.steps.split_at(width);
        let mut add = |factor: f64, step: &[f64]| {
            for (p, step) in self.p.iter_mut().zip(step) {
                *p += factor * step;
            }
            self.omega += factor * step[m];
        };
        add(1.0, first);
        for (step, &change) in others.chunks_exact(width).zip(change) {
            add(change, step);
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Adds factor · A x of a column-major matrix A to `out`.
fn add_product(factor: f64, a: &[f64], x: &[f64], out: &mut [f64]) {
    for (column, x) in a.chunks_exact(x.len().max(1)).zip(x) {
        for (out, a) in out.iter_mut().zip(column) {
            *out += factor * a * x;
        }
    }
}
