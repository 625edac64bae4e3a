//! The forced response as a [`Problem`]: unknown are the packed relative motions of the contacts,
//! the parameter is the angular frequency. In the start's homotopies it is ln s, where every law is
//! seen as s·f(y/s), or a factor on the forces that vibrate.
//!
//! R = y − y_lin + G(f(y) − κ y), ∂R/∂y = I + G(J − κ), ∂R/∂ω = −∂y_lin + ∂G (f − κ y) + G ∂f/∂ω.

mod newton_products;

use crate::condense::Condensed;
use crate::condense::frequency_cache::FrequencyCache;
use crate::error::{Result, try_vec};
use crate::linalg::norm;
use crate::problem::contact_forces::ContactForces;
pub use crate::problem::harmonic_balance::newton_products::packed_up_to;
use crate::problem::static_force::static_force;
use crate::problem::{InitialGuess, Linearisation, Problem, put};
use num_complex::Complex64;

/// What the parameter means.
#[derive(Clone, Copy, Debug)]
enum Parameter {
    Omega,
    /// ln of the factor by which the laws see a smaller amplitude, at a fixed frequency.
    Scale {
        omega: f64,
    },
    /// Factor on the forces that vibrate, at a fixed frequency; constant ones act in full.
    Load {
        omega: f64,
    },
}

/// The forced response of a condensed model.
pub struct HarmonicBalance<'a> {
    condensed: &'a Condensed,
    forces: ContactForces<'a>,
    tables: FrequencyCache,
    parameter: Parameter,
    /// Index of the observed harmonic among the carried ones.
    observed: usize,
    given: Option<Vec<f64>>,
    /// Whether the static solution is not zero, because a contact presses or a law pushes at rest.
    loaded_at_rest: bool,
    /// One number per coordinate, for a column of the Jacobian.
    sum: Vec<Complex64>,
    /// G as [`ContactForces::couple_all`] wants it.
    flexibility: Vec<Complex64>,
    /// One packed signal.
    change: Vec<f64>,
}

impl<'a> HarmonicBalance<'a> {
    /// A problem on `condensed` for frequencies in `range`, observing degree of freedom `response`
    /// in its lowest carried harmonic above zero. `samples` = 0 locates events exactly; `given` is
    /// a packed start.
    ///
    /// # Errors
    /// `OutOfMemory`; those of callbacks, which are asked for their force at rest.
    pub fn new(
        condensed: &'a Condensed,
        response: usize,
        range: (f64, f64),
        samples: usize,
        given: Option<Vec<f64>>,
    ) -> Result<Self> {
        const CONTEXT: &str = "the forced response";
        let set = condensed.set();
        let coordinates = condensed.coordinates();
        let flexibility = coordinates
            .saturating_mul(coordinates)
            .saturating_mul(set.numbers().len());
        let loaded_at_rest = condensed.is_preloaded() || static_force(condensed, range.0, samples)?.is_some();
        Ok(Self {
            condensed,
            forces: ContactForces::new(condensed, samples)?,
            tables: FrequencyCache::new(condensed, response, range)?,
            parameter: Parameter::Omega,
            observed: set.numbers().iter().position(|&h| h > 0).unwrap_or(0),
            given,
            loaded_at_rest,
            sum: try_vec(condensed.coordinates(), Complex64::ZERO, CONTEXT)?,
            flexibility: try_vec(flexibility, Complex64::ZERO, CONTEXT)?,
            change: try_vec(set.packed_len(), 0.0, CONTEXT)?,
        })
    }

    /// Share of the period that each law slips, at the point last evaluated.
    #[must_use]
    pub fn slip_fractions(&self) -> &[f64] {
        self.forces.slip_fractions()
    }

    /// How much sampling matters at a point; see [`ContactForces::sampling_error`].
    ///
    /// # Errors
    /// Those of callbacks that give up.
    pub fn sampling_error(&mut self, u: &[f64], omega: f64) -> Result<f64> {
        self.forces.sampling_error(u, omega)
    }

    /// What [`Problem::evaluate`] finds, without the Jacobian, for which `out` needs no memory.
    ///
    /// # Errors
    /// As there.
    pub fn evaluate_residual(&mut self, u: &[f64], p: f64, out: &mut Linearisation) -> Result<()> {
        let omega = match self.parameter {
            Parameter::Omega => {
                self.forces.set_scale(1.0);
                p
            }
            Parameter::Scale { omega } => {
                self.forces.set_scale(p.exp());
                omega
            }
            Parameter::Load { omega } => {
                self.forces.set_scale(1.0);
                omega
            }
        };
        self.tables.tabulate(self.condensed, omega)?;
        self.forces.evaluate(u, omega)?;
        let set = self.condensed.set();
        let m = set.packed_len();
        let coordinates = self.condensed.coordinates();
        let outputs = coordinates + 1;
        out.residual.copy_from_slice(u);
        out.d_parameter.fill(0.0);
        let mut linear = 0.0_f64;
        for (i, table) in self.tables.current().iter().enumerate() {
            let at = set.offset(i);
            let mean = set.numbers()[i] == 0;
            for row in 0..coordinates {
                let r = row * m + at;
                let y_lin = table.value[coordinates * outputs + row];
                linear += y_lin.norm_sqr();
                match self.parameter {
                    Parameter::Omega => {
                        put(&mut out.residual, r, mean, -y_lin);
                        put(&mut out.d_parameter, r, mean, -table.slope[coordinates * outputs + row]);
                    }
                    Parameter::Load { .. } if !mean => {
                        put(&mut out.residual, r, mean, -p * y_lin);
                        put(&mut out.d_parameter, r, mean, -y_lin);
                    }
                    Parameter::Scale { .. } | Parameter::Load { .. } => put(&mut out.residual, r, mean, -y_lin),
                }
            }
            for column in 0..coordinates {
                if self.forces.is_inactive(column) {
                    continue;
                }
                let w = self.forces.minus_reference(u, column, i);
                let (eased, by_omega) = (self.forces.d_ln_scale(column, i), self.forces.by_omega(column, i));
                for row in 0..coordinates {
                    let r = row * m + at;
                    let g = table.value[column * outputs + row];
                    put(&mut out.residual, r, mean, g * w);
                    match self.parameter {
                        Parameter::Omega => {
                            let slope = table.slope[column * outputs + row] * w + g * by_omega;
                            put(&mut out.d_parameter, r, mean, slope);
                        }
                        Parameter::Scale { .. } => put(&mut out.d_parameter, r, mean, g * eased),
                        Parameter::Load { .. } => {}
                    }
                }
            }
        }
        out.scale = norm(u) + linear.sqrt();
        Ok(())
    }

    /// ∂R/∂y = I + G (∂f/∂y − κ); what no force feels that counts keeps the column of the identity.
    fn assemble(&mut self, out: &mut Linearisation) {
        let set = self.condensed.set();
        let (m, harmonics) = (set.packed_len(), set.numbers().len());
        let coordinates = self.condensed.coordinates();
        let n = out.residual.len();
        self.forces.mark_active(&mut out.active);
        if out.active.contains(&true) {
            for (i, table) in self.tables.current().iter().enumerate() {
                let forces = table.value.chunks_exact(coordinates + 1).take(coordinates);
                for (force, column) in forces.enumerate() {
                    let first = force * coordinates * harmonics + i;
                    let to = self.flexibility[first..].iter_mut().step_by(harmonics);
                    for (to, g) in to.zip(&column[..coordinates]) {
                        *to = *g;
                    }
                }
            }
        }
        for (k, column) in out.jacobian.chunks_exact_mut(n.max(1)).enumerate() {
            column.fill(0.0);
            column[k] = 1.0;
            if out.active[k] {
                self.forces
                    .couple_all((k / m, k % m), &self.flexibility, &mut self.change, column);
            }
        }
    }

    /// Contact force minus κ y in the i-th carried harmonic of each coordinate, at the point last
    /// evaluated.
    pub fn contact_force(&self, u: &[f64], i: usize, w: &mut [Complex64]) {
        for (c, w) in w.iter_mut().enumerate() {
            *w = self.forces.minus_reference(u, c, i);
        }
    }

    /// Harmonics of the response degree of freedom at the point last evaluated, in the order in
    /// which they are carried.
    pub fn response(&self, u: &[f64], x: &mut [Complex64]) {
        for (i, (x, table)) in x.iter_mut().zip(self.tables.current()).enumerate() {
            let coordinates = self.condensed.coordinates();
            let outputs = coordinates + 1;
            *x = table.value[coordinates * outputs + coordinates];
            for c in 0..coordinates {
                *x -= table.value[c * outputs + coordinates] * self.forces.minus_reference(u, c, i);
            }
        }
    }
}

impl Problem for HarmonicBalance<'_> {
    fn size(&self) -> usize {
        self.condensed.coordinates() * self.condensed.set().packed_len()
    }

    fn evaluate(&mut self, u: &[f64], p: f64, out: &mut Linearisation) -> Result<()> {
        self.evaluate_residual(u, p, out)?;
        self.assemble(out);
        Ok(())
    }

    fn observe(&self, u: &[f64], direction: &[f64]) -> (Complex64, Complex64) {
        let coordinates = self.condensed.coordinates();
        let outputs = coordinates + 1;
        let i = self.observed;
        let table = &self.tables.current()[i];
        let along_p = direction[u.len()];
        let rate = |z: Complex64| match self.parameter {
            Parameter::Omega => z * along_p,
            Parameter::Scale { .. } | Parameter::Load { .. } => Complex64::ZERO,
        };
        let excited = coordinates * outputs + coordinates;
        let mut z = table.value[excited];
        let mut dz = rate(table.slope[excited]);
        for c in (0..coordinates).filter(|&c| !self.forces.is_inactive(c)) {
            let w = self.forces.minus_reference(u, c, i);
            let g = table.value[c * outputs + coordinates];
            let mut dw = self.forces.along(direction, c, i);
            dw += match self.parameter {
                Parameter::Omega => self.forces.by_omega(c, i) * along_p,
                Parameter::Scale { .. } => self.forces.d_ln_scale(c, i) * along_p,
                Parameter::Load { .. } => Complex64::ZERO,
            };
            z -= g * w;
            dz -= g * dw + rate(table.slope[c * outputs + coordinates]) * w;
        }
        (z, dz)
    }

    fn start(&mut self, kind: InitialGuess, p: f64, u: &mut [f64]) -> Result<bool> {
        match kind {
            InitialGuess::Given => {
                let Some(given) = &self.given else { return Ok(false) };
                u.copy_from_slice(given);
                Ok(true)
            }
            // What presses at rest has no solution of the form that scales: the load must grow.
            InitialGuess::Stuck if self.loaded_at_rest => Ok(false),
            InitialGuess::Stuck => {
                // At motions far smaller every law is linear: one Newton step from rest.
                u.fill(0.0);
                let mut at = Linearisation::new(u.len())?;
                self.parameter = Parameter::Scale { omega: p };
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
            InitialGuess::Reference => {
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

    fn begin_homotopy(&mut self, p: f64, u: &[f64]) -> Result<Option<(f64, f64)>> {
        if self.loaded_at_rest {
            self.parameter = Parameter::Load { omega: p };
            return Ok(Some((0.0, 1.0)));
        }
        let start = (1.01 * self.forces.linearisation_scale(u, p)?).ln();
        if !(start > 0.0 && start.is_finite()) {
            return Ok(None);
        }
        self.parameter = Parameter::Scale { omega: p };
        Ok(Some((start, 0.0)))
    }

    fn end_homotopy(&mut self) {
        self.parameter = Parameter::Omega;
        self.forces.set_scale(1.0);
    }

    /// Where damping takes the power of the forces; without it resonances are the exception.
    fn is_bounded(&self) -> bool {
        true
    }

    fn set_pointwise(&mut self, pointwise: bool) {
        self.tables.set_pointwise(pointwise);
    }
}
