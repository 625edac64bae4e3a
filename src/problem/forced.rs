//! The forced response as a [`Problem`]: unknown are the packed relative motions of the contacts,
//! the parameter is the angular frequency (in the start's homotopy: the logarithm of a factor on
//! all slip limits).
//!
//! R = y − y_lin + G(f(y) − κ y), ∂R/∂y = I + G(J − κ), ∂R/∂ω = −∂y_lin + ∂G (f − κ y), and in the
//! homotopy ∂R/∂λ = G fc ∂f/∂fc.

use super::{Linearisation, Problem, Start};
use crate::aft::{Evaluation, Evaluator};
use crate::condense::tables::Tables;
use crate::condense::{Condensed, Reference};
use crate::contact::Law;
use crate::error::{Result, try_push, try_vec};
use crate::linalg::norm;
use num_complex::Complex64;

/// Added to the diagonal of the means in Newton's matrix, not in the residual. A slipping contact
/// does not resist a mean motion; where nothing else does, as for a ring free to turn, the mean is
/// indeterminate and the matrix singular. With the floor it stays where it started.
const MEAN_FLOOR: f64 = 1e-8;

/// What the parameter means.
#[derive(Clone, Copy, Debug)]
enum Parameter {
    Omega,
    /// ln of the factor on the slip limits, at a fixed frequency.
    Ease {
        omega: f64,
    },
}

/// The forced response of a condensed model.
pub struct Forced<'a> {
    condensed: &'a Condensed,
    evaluator: Evaluator,
    tables: Tables,
    parameter: Parameter,
    factor: f64,
    laws: Vec<Law>,
    law: Evaluation,
    /// Per coordinate: sums over its laws, and whether all of them stick.
    sums: Vec<Evaluation>,
    stuck: Vec<bool>,
    slip_fractions: Vec<f64>,
    /// Index of the observed harmonic among the carried ones.
    observed: usize,
    given: Option<Vec<f64>>,
}

impl<'a> Forced<'a> {
    /// A problem on `condensed` for frequencies in `range`, observing degree of freedom `response`
    /// in its lowest carried harmonic above zero. `samples` = 0 locates events exactly; `given` is
    /// a packed start.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(
        condensed: &'a Condensed,
        response: usize,
        range: (f64, f64),
        samples: usize,
        given: Option<Vec<f64>>,
    ) -> Result<Self> {
        let set = condensed.set();
        let coordinates = condensed.coordinates();
        let mut sums = Vec::new();
        for _ in 0..coordinates {
            try_push(&mut sums, Evaluation::new(set)?, "the contact forces")?;
        }
        let mut laws = Vec::new();
        for placed in condensed.laws() {
            try_push(&mut laws, placed.law, "the contacts")?;
        }
        let nonlinear = coordinates > 0;
        Ok(Self {
            condensed,
            // A linear problem has no contact to evaluate, and its harmonics need not be a comb.
            evaluator: Evaluator::new(&comb(condensed)?, if nonlinear { samples } else { 0 })?,
            tables: Tables::new(condensed, response, range)?,
            parameter: Parameter::Omega,
            factor: 1.0,
            slip_fractions: try_vec(laws.len(), 0.0, "the contacts")?,
            laws,
            law: Evaluation::new(&comb(condensed)?)?,
            sums,
            stuck: try_vec(coordinates, false, "the contacts")?,
            observed: set.numbers().iter().position(|&h| h > 0).unwrap_or(0),
            given,
        })
    }

    /// Share of the period that each law slips, at the point last evaluated.
    #[must_use]
    pub fn slip_fractions(&self) -> &[f64] {
        &self.slip_fractions
    }

    /// Contact force minus κ y in the i-th carried harmonic of each coordinate, at the point last
    /// evaluated.
    pub fn contact_force(&self, u: &[f64], i: usize, w: &mut [Complex64]) {
        for (c, w) in w.iter_mut().enumerate() {
            *w = self.force_minus_reference(u, c, i);
        }
    }

    fn force_minus_reference(&self, u: &[f64], coordinate: usize, i: usize) -> Complex64 {
        let set = self.condensed.set();
        let m = set.packed_len();
        let y = set.get(&u[coordinate * m..(coordinate + 1) * m], i);
        set.get(&self.sums[coordinate].force, i) - self.condensed.kappa(coordinate, i) * y
    }

    /// Harmonics of the response degree of freedom at the point last evaluated, in the order in
    /// which they are carried.
    pub fn response(&self, u: &[f64], x: &mut [Complex64]) {
        for (i, (x, table)) in x.iter_mut().zip(self.tables.current()).enumerate() {
            let coordinates = self.condensed.coordinates();
            let outputs = coordinates + 1;
            *x = table.value[coordinates * outputs + coordinates];
            for c in 0..coordinates {
                *x -= table.value[c * outputs + coordinates] * self.force_minus_reference(u, c, i);
            }
        }
    }

    /// Evaluates all laws at the packed motions `u`.
    fn evaluate_laws(&mut self, u: &[f64]) {
        let set = self.condensed.set();
        let m = set.packed_len();
        for sum in &mut self.sums {
            sum.force.fill(0.0);
            sum.jacobian.fill(0.0);
            sum.offset.fill(0.0);
        }
        self.stuck.fill(true);
        let mut prepared = usize::MAX;
        for (k, placed) in self.condensed.laws().iter().enumerate() {
            let c = placed.coordinate;
            let motion = &u[c * m..(c + 1) * m];
            if prepared != c {
                self.evaluator.prepare(set, motion);
                prepared = c;
            }
            self.evaluator.evaluate(&self.laws[k], set, motion, &mut self.law);
            self.slip_fractions[k] = self.law.slip_fraction;
            self.stuck[c] &= self.law.stuck;
            let sum = &mut self.sums[c];
            add(&mut sum.force, &self.law.force);
            add(&mut sum.jacobian, &self.law.jacobian);
            add(&mut sum.offset, &self.law.offset);
        }
    }

    /// Whether a coordinate sticks and its reference stiffness is that of the stuck contact.
    fn drops_out(&self, coordinate: usize) -> bool {
        self.stuck[coordinate] && self.condensed.reference() == Reference::Stuck
    }

    fn ease(&mut self, factor: f64) {
        if self.factor.to_bits() == factor.to_bits() {
            return;
        }
        self.factor = factor;
        for (law, placed) in self.laws.iter_mut().zip(self.condensed.laws()) {
            *law = placed.law.eased(factor);
        }
    }
}

fn add(sum: &mut [f64], term: &[f64]) {
    for (s, t) in sum.iter_mut().zip(term) {
        *s += t;
    }
}

/// The harmonic set for evaluating laws; a stand-in where there are none.
fn comb(condensed: &Condensed) -> Result<crate::harmonics::HarmonicSet> {
    if condensed.coordinates() == 0 {
        crate::harmonics::HarmonicSet::all(0)
    } else {
        Ok(condensed.set().clone())
    }
}

impl Problem for Forced<'_> {
    fn size(&self) -> usize {
        self.condensed.coordinates() * self.condensed.set().packed_len()
    }

    fn evaluate(&mut self, u: &[f64], p: f64, out: &mut Linearisation) -> Result<()> {
        let omega = match self.parameter {
            Parameter::Omega => {
                self.ease(1.0);
                p
            }
            Parameter::Ease { omega } => {
                self.ease(p.exp());
                omega
            }
        };
        self.tables.tabulate(self.condensed, omega)?;
        self.evaluate_laws(u);
        let set = self.condensed.set();
        let (m, n) = (set.packed_len(), u.len());
        let coordinates = self.condensed.coordinates();
        let outputs = coordinates + 1;
        out.residual.copy_from_slice(u);
        out.d_parameter.fill(0.0);
        out.jacobian.fill(0.0);
        for k in 0..n {
            out.jacobian[k * n + k] = 1.0;
        }
        let mut linear = 0.0_f64;
        for (i, table) in self.tables.current().iter().enumerate() {
            let at = set.offset(i);
            let mean = set.numbers()[i] == 0;
            for row in 0..coordinates {
                let r = row * m + at;
                let y_lin = table.value[coordinates * outputs + row];
                linear += y_lin.norm_sqr();
                put(&mut out.residual, r, mean, -y_lin);
                if matches!(self.parameter, Parameter::Omega) {
                    put(&mut out.d_parameter, r, mean, -table.slope[coordinates * outputs + row]);
                }
            }
            for column in 0..coordinates {
                if self.drops_out(column) {
                    // f = κ y: nothing couples back.
                    continue;
                }
                let w = self.force_minus_reference(u, column, i);
                let eased = set.get(&self.sums[column].offset, i);
                let kappa = self.condensed.kappa(column, i);
                for row in 0..coordinates {
                    let r = row * m + at;
                    let g = table.value[column * outputs + row];
                    put(&mut out.residual, r, mean, g * w);
                    match self.parameter {
                        Parameter::Omega => {
                            put(&mut out.d_parameter, r, mean, table.slope[column * outputs + row] * w);
                        }
                        Parameter::Ease { .. } => put(&mut out.d_parameter, r, mean, g * eased),
                    }
                    let gk = g * kappa;
                    for q in 0..m {
                        let j = &self.sums[column].jacobian[q * m..(q + 1) * m];
                        let target = &mut out.jacobian[(column * m + q) * n..];
                        if mean {
                            target[r] += g.re * j[at];
                        } else {
                            let dz = g * Complex64::new(j[at], j[at + 1]);
                            target[r] += dz.re;
                            target[r + 1] += dz.im;
                        }
                    }
                    let diagonal = (column * m + at) * n + r;
                    out.jacobian[diagonal] -= gk.re;
                    if mean && row == column {
                        out.jacobian[diagonal] += MEAN_FLOOR;
                    }
                    if !mean {
                        out.jacobian[diagonal + 1] -= gk.im;
                        out.jacobian[diagonal + n] += gk.im;
                        out.jacobian[diagonal + n + 1] -= gk.re;
                    }
                }
            }
        }
        for column in 0..coordinates {
            out.active[column * m..(column + 1) * m].fill(!self.drops_out(column));
        }
        out.scale = norm(u) + linear.sqrt();
        Ok(())
    }

    fn observe(&self, u: &[f64], direction: &[f64]) -> (Complex64, Complex64) {
        let set = self.condensed.set();
        let m = set.packed_len();
        let coordinates = self.condensed.coordinates();
        let outputs = coordinates + 1;
        let i = self.observed;
        let table = &self.tables.current()[i];
        let at = set.offset(i);
        let along_p = direction[u.len()];
        let rate = |z: Complex64| match self.parameter {
            Parameter::Omega => z * along_p,
            Parameter::Ease { .. } => Complex64::ZERO,
        };
        let excited = coordinates * outputs + coordinates;
        let mut z = table.value[excited];
        let mut dz = rate(table.slope[excited]);
        for c in (0..coordinates).filter(|&c| !self.drops_out(c)) {
            let w = self.force_minus_reference(u, c, i);
            let g = table.value[c * outputs + coordinates];
            let sum = &self.sums[c];
            let du = &direction[c * m..(c + 1) * m];
            let mut dw = -self.condensed.kappa(c, i) * set.get(du, i);
            for (column, d) in sum.jacobian.chunks_exact(m).zip(du) {
                dw += match set.numbers()[i] {
                    0 => Complex64::new(column[at], 0.0),
                    _ => Complex64::new(column[at], column[at + 1]),
                } * d;
            }
            if matches!(self.parameter, Parameter::Ease { .. }) {
                dw += set.get(&sum.offset, i) * along_p;
            }
            z -= g * w;
            dz -= g * dw + rate(table.slope[c * outputs + coordinates]) * w;
        }
        (z, dz)
    }

    fn start(&mut self, kind: Start, p: f64, u: &mut [f64]) -> Result<bool> {
        match kind {
            Start::Given => {
                let Some(given) = &self.given else { return Ok(false) };
                u.copy_from_slice(given);
                Ok(true)
            }
            Start::Stuck => {
                // With infinite slip limits the problem is linear: one Newton step from rest.
                u.fill(0.0);
                let mut at = Linearisation::new(u.len())?;
                self.parameter = Parameter::Ease { omega: p };
                let evaluated = self.evaluate(u, f64::INFINITY, &mut at);
                self.parameter = Parameter::Omega;
                evaluated?;
                let mut lu = crate::linalg::lu::Lu::new(u.len(), 1)?;
                lu.matrix().copy_from_slice(&at.jacobian);
                if lu.factor().is_err() {
                    return Ok(false);
                }
                for (u, r) in u.iter_mut().zip(&at.residual) {
                    *u = -r;
                }
                lu.solve(u);
                Ok(u.iter().all(|x| x.is_finite()))
            }
            Start::Reference => {
                self.tables.tabulate(self.condensed, p)?;
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

    fn begin_homotopy(&mut self, p: f64, u: &[f64]) -> Option<f64> {
        let set = self.condensed.set();
        let m = set.packed_len();
        let mut largest = 0.0_f64;
        for placed in self.condensed.laws() {
            let c = placed.coordinate;
            let motion = &u[c * m..(c + 1) * m];
            self.evaluator.prepare(set, motion);
            let mean = if set.has_mean() { motion[0] } else { 0.0 };
            let (range, reference) = (self.evaluator.half_range(set), self.condensed.stiffness(c));
            largest = largest.max(placed.law.sticking_factor(range, mean, reference));
        }
        let start = (1.01 * largest).ln();
        if !(start > 0.0 && start.is_finite()) {
            return None;
        }
        self.parameter = Parameter::Ease { omega: p };
        Some(start)
    }

    fn end_homotopy(&mut self) {
        self.parameter = Parameter::Omega;
        self.ease(1.0);
    }

    fn set_pointwise(&mut self, pointwise: bool) {
        self.tables.set_pointwise(pointwise);
    }
}

/// Adds a complex number (the real part alone for the mean) at position `r` of a packed vector.
fn put(packed: &mut [f64], r: usize, mean: bool, z: Complex64) {
    packed[r] += z.re;
    if !mean {
        packed[r + 1] += z.im;
    }
}
