//! Motion of the structure in one harmonic of a nonlinear mode from the modes of its wave, with its derivatives.
//!
//! With x = Φ ξ and E = BΦ (see [`crate::condense::wave_modes`]) Z_κ becomes
//!
//! > Φᴴ Z_κ Φ = diag(d) − Eᴴ e E,  d = 1 + c − s μ,  e = ck − i Im κ,
//!
//! c = i(νβ + η) and s = ν² − iνα at ν = hω. The artificial damping adds 2ihDω² to s (mass type), or −2ihD to c (stiffness
//! type). Its inverse is, with v = d⁻¹ r, by Woodbury's identity
//!
//! > v + d⁻¹ Eᴴ e (1 − E d⁻¹ Eᴴ e)⁻¹ E v.
//!
//! The derivatives follow from Z ∂x = −∂Z x, where Φᴴ ∂Z Φ = diag(∂d) − Eᴴ ∂e E.

use crate::condense::low_rank::Coefficients;
use crate::condense::modal_solution::{Pair, Solution};
use crate::condense::single_motion::{Coefficient, SingleMotion};
use crate::condense::sum_terms::Source;
use crate::condense::wave_modes::{NEAR_MODE, WaveModes};
use crate::condense::{Artificial, Condensed};
use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::expand;
use crate::linalg::lu::Lu;
use num_complex::Complex64;
use std::sync::Arc;

const CONTEXT: &str = "the modes of the structure";

/// A harmonic of a nonlinear mode.
pub(super) struct ModalMotion {
    modes: Arc<WaveModes>,
    number: f64,
    is_mass_type: bool,
    inverse: ModalInverse,
    /// ξ under a unit force of each contact, one after the other; that of the motion, and a derivative of it.
    columns: Vec<Complex64>,
    motion: Vec<Complex64>,
    change: Vec<Complex64>,
    /// The same in closed form, where one contact without springs allows it.
    single: Option<SingleMotion>,
}

/// (diag(d) − Eᴴ e E)⁻¹
struct ModalInverse {
    /// E, mode after mode.
    seen: Vec<Complex64>,
    coefficients: Coefficients,
    /// 1/d
    inverse: Vec<Complex64>,
    /// e
    entries: Vec<Complex64>,
    lu: Lu<Complex64>,
    forces: Vec<Complex64>,
}

impl ModalMotion {
    /// The i-th carried harmonic of a condensed mode; `None` where its wave has no such modes.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(condensed: &Condensed, i: usize) -> Result<Option<Self>> {
        let block = &condensed.blocks()[i];
        let Some(Source::Modes(modes)) = &block.source else {
            return Ok(None);
        };
        let is_mass_type = matches!(block.artificial, Artificial::Mass);
        let (n, coordinates) = (condensed.ndof(), condensed.coordinates());
        let is_damped = modes.is_damped_by_stiffness() || !is_mass_type;
        let springs = if is_damped { &modes.springs } else { &[][..] };
        let coefficients = Coefficients::new(condensed, i, springs, is_damped)?;
        let order = coefficients.len();
        let mut seen = try_vec(order * n, Complex64::ZERO, CONTEXT)?;
        for (mode, shape) in modes.vectors.chunks_exact(n).enumerate() {
            let rows = block.rows.iter().chain(springs.iter().map(|(row, _)| row));
            for (to, row) in seen[mode * order..].iter_mut().zip(rows) {
                *to = row.along(shape);
            }
        }
        let single = if coordinates == 1 && order == 1 {
            Some(SingleMotion::new(&seen)?)
        } else {
            None
        };
        let zeros = |len| try_vec(len, Complex64::ZERO, CONTEXT);
        Ok(Some(Self {
            single,
            modes: Arc::clone(modes),
            number: block.number as f64,
            is_mass_type,
            inverse: ModalInverse {
                seen,
                coefficients,
                inverse: zeros(n)?,
                entries: zeros(order)?,
                lu: Lu::new(order, 1)?,
                forces: zeros(order)?,
            },
            columns: zeros(n * coordinates)?,
            motion: zeros(n)?,
            change: zeros(n)?,
        }))
    }

    /// Solves at frequency `omega` and damping ratio `damping` under the forces w; `false` so near a resonance of the
    /// structure with its reference stiffness that digits would be lost.
    ///
    /// # Errors
    /// `Singular`, `StoppedByCaller`.
    pub fn solve(
        &mut self,
        (omega, damping): (f64, f64),
        w: &[Complex64],
        to: Solution<'_>,
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let [at, by_omega, by_damping] = self.pairs(omega, damping);
        if let (Some(single), [w]) = (&mut self.single, w) {
            let coefficients = &self.inverse.coefficients;
            let of = |pair: Pair, e| Coefficient { pair, e };
            let at = of(at, coefficients.entry(0, at.c));
            let derivatives = [by_omega, by_damping].map(|by| of(by, coefficients.d_entry(0, by.c)));
            return Ok(single.solve(&self.modes, (at, self.number * omega), derivatives, *w, to));
        }
        if !self.inverse.set(at, &self.modes, self.number * omega, interrupt)? {
            return Ok(false);
        }
        let n = self.motion.len();
        let coordinates = w.len();
        let (of_columns, of_motions) = to.relative.split_at_mut(coordinates * coordinates);
        let mut of_motions = of_motions.chunks_exact_mut(coordinates.max(1));
        let mut relative = |inverse: &ModalInverse, xi: &[Complex64]| {
            if let Some(to) = of_motions.next() {
                inverse.relative(xi, to);
            }
        };
        let vectors = &self.modes.vectors;
        self.motion.fill(Complex64::ZERO);
        let columns = self
            .columns
            .chunks_exact_mut(n)
            .zip(of_columns.chunks_exact_mut(coordinates.max(1)));
        for (c, ((column, seen), w)) in columns.zip(w).enumerate() {
            self.inverse.unit_force(c, column);
            self.inverse.apply(column);
            self.inverse.relative(column, seen);
            for (x, z) in self.motion.iter_mut().zip(column.iter()) {
                *x -= z * w;
            }
        }
        if to.is_whole {
            for (xi, to) in self.columns.chunks_exact(n).zip(to.columns.chunks_exact_mut(n)) {
                expand(vectors, xi, to);
            }
        }
        relative(&self.inverse, &self.motion);
        expand(vectors, &self.motion, to.x);
        for (slope, to_whole) in [(by_omega, to.by_omega), (by_damping, to.by_damping)] {
            self.inverse
                .slope_product(slope, &self.modes.values, &self.motion, &mut self.change);
            self.inverse.apply(&mut self.change);
            relative(&self.inverse, &self.change);
            if to.is_whole {
                expand(vectors, &self.change, to_whole);
            }
        }
        Ok(true)
    }

    /// c and s, and their derivatives by ω and D.
    fn pairs(&self, omega: f64, damping: f64) -> [Pair; 3] {
        let (h, (alpha, beta)) = (self.number, self.modes.proportional);
        let nu = h * omega;
        let imaginary = |x: f64| Complex64::new(0.0, x);
        let (mass, stiffness) = if self.is_mass_type { (1.0, 0.0) } else { (0.0, 1.0) };
        [
            Pair {
                c: imaginary(nu * beta + self.modes.loss_factor - 2.0 * stiffness * h * damping),
                s: Complex64::new(nu * nu, 2.0 * mass * h * damping * omega * omega - nu * alpha),
            },
            Pair {
                c: imaginary(h * beta),
                s: Complex64::new(2.0 * h * nu, h * (4.0 * mass * damping * omega - alpha)),
            },
            Pair {
                c: imaginary(-2.0 * stiffness * h),
                s: imaginary(2.0 * mass * h * omega * omega),
            },
        ]
    }
}

impl ModalInverse {
    /// Sets c and s; `false` where a denominator is small.
    fn set(&mut self, at: Pair, modes: &WaveModes, nu: f64, interrupt: &Interrupt<'_>) -> Result<bool> {
        if !modes.invert((at.c, at.s), (nu, NEAR_MODE), &mut self.inverse) {
            return Ok(false);
        }
        let order = self.entries.len();
        for (b, e) in self.entries.iter_mut().enumerate() {
            *e = self.coefficients.entry(b, at.c);
        }
        let matrix = self.lu.matrix();
        matrix.fill(Complex64::ZERO);
        for (seen, inverse) in self.seen.chunks_exact(order.max(1)).zip(&self.inverse) {
            for (column, q) in matrix.chunks_exact_mut(order).zip(seen) {
                let weighted = inverse * q.conj();
                for (to, p) in column.iter_mut().zip(seen) {
                    *to -= p * weighted;
                }
            }
        }
        for (q, (column, e)) in matrix.chunks_exact_mut(order.max(1)).zip(&self.entries).enumerate() {
            for to in column.iter_mut() {
                *to *= e;
            }
            column[q] += 1.0;
        }
        self.lu.factor(interrupt)?;
        Ok(true)
    }

    /// Eᴴ of a unit force of one coordinate.
    fn unit_force(&self, coordinate: usize, v: &mut [Complex64]) {
        for (to, seen) in v.iter_mut().zip(self.seen.chunks_exact(self.entries.len().max(1))) {
            *to = seen[coordinate].conj();
        }
    }

    /// Relative motions of the contacts, the first rows of E ξ.
    fn relative(&self, xi: &[Complex64], to: &mut [Complex64]) {
        to.fill(Complex64::ZERO);
        for (xi, seen) in xi.iter().zip(self.seen.chunks_exact(self.entries.len().max(1))) {
            for (to, seen) in to.iter_mut().zip(seen) {
                *to += seen * xi;
            }
        }
    }

    /// Solves in place.
    fn apply(&mut self, v: &mut [Complex64]) {
        let order = self.entries.len();
        self.forces.fill(Complex64::ZERO);
        for ((v, inverse), seen) in v
            .iter_mut()
            .zip(&self.inverse)
            .zip(self.seen.chunks_exact(order.max(1)))
        {
            *v *= inverse;
            for (to, seen) in self.forces.iter_mut().zip(seen) {
                *to += seen * *v;
            }
        }
        self.lu.solve(&mut self.forces);
        for (f, e) in self.forces.iter_mut().zip(&self.entries) {
            *f *= e;
        }
        for ((v, inverse), seen) in v
            .iter_mut()
            .zip(&self.inverse)
            .zip(self.seen.chunks_exact(order.max(1)))
        {
            let force: Complex64 = seen.iter().zip(&self.forces).map(|(seen, f)| seen.conj() * f).sum();
            *v += inverse * force;
        }
    }

    /// out = −(diag(∂d) − Eᴴ ∂e E) ξ
    fn slope_product(&mut self, slope: Pair, values: &[f64], xi: &[Complex64], out: &mut [Complex64]) {
        let order = self.entries.len();
        self.forces.fill(Complex64::ZERO);
        for (xi, seen) in xi.iter().zip(self.seen.chunks_exact(order.max(1))) {
            for (to, seen) in self.forces.iter_mut().zip(seen) {
                *to += seen * xi;
            }
        }
        for (b, f) in self.forces.iter_mut().enumerate() {
            *f *= self.coefficients.d_entry(b, slope.c);
        }
        for (k, (out, xi)) in out.iter_mut().zip(xi).enumerate() {
            let seen = &self.seen[k * order..(k + 1) * order];
            let force: Complex64 = seen.iter().zip(&self.forces).map(|(seen, f)| seen.conj() * f).sum();
            *out = force - (slope.c - slope.s * values[k]) * xi;
        }
    }
}
