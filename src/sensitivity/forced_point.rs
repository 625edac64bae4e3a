//! The adjoint of the amplitude |X| of the response degree of freedom in a forced response at one frequency.
//!
//! One transposed solution of Newton's matrix, and one of the structure per harmonic.

use crate::condense::by_factors::dynamic_stiffness::DampedFrequency;
use crate::condense::by_factors::flexibility::Workspace;
use crate::condense::by_factors::near_rigid_motion;
use crate::condense::{Condensed, HarmonicBlock};
use crate::error::{Result, Status, boxed, fail, try_copy, try_push, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;
use crate::linalg::dot;
use crate::linalg::newton::linear_system::Jacobian;
use crate::model::few_motions::reduced_wave::MotionRow;
use crate::options::Range;
use crate::options::Response;
use crate::problem::gauges::{Derivatives, Gauges};
use crate::problem::harmonic_balance::HarmonicBalance;
use crate::problem::{Problem, Residual};
use crate::sensitivity::adjoint::{Adjoint, CONTEXT};
use crate::sensitivity::newton_factors::NewtonFactors;
use num_complex::Complex64;

/// The equations of a forced response near one solution.
pub(crate) struct ForcedPoint<'a> {
    pub(super) condensed: &'a Condensed,
    pub(super) interrupt: &'a Interrupt<'a>,
    pub(super) problem: HarmonicBalance<'a>,
    workspace: Workspace,
    /// Newton's matrix, with its factors, at the point linearised last.
    pub(super) system: NewtonFactors,
    at: Residual,
    response: MotionRow,
    /// Contact forces w = f − κ y of one harmonic.
    w: Vec<Complex64>,
    /// Load ∂F/∂ω − ∂Z/∂ω x − Wᴴ ∂f/∂ω, harmonic after harmonic.
    by_omega: Vec<Complex64>,
    /// A response in place of the amplitude, with its derivatives at the point linearised last; `None`: the
    /// amplitude.
    watched: Option<(Box<Gauges<'a>>, Option<Derivatives>)>,
    samples: usize,
}

/// A result A − λᵀR whose adjoint motion is requested.
struct Wanted<'b> {
    /// Amplitude in the result; 0: the result is −λᵀR alone.
    amplitude: Complex64,
    lambda: &'b [f64],
    /// Derivatives of the watched response that takes the place of the amplitude.
    watched: Option<&'b Derivatives>,
}

impl Wanted<'_> {
    /// Writes the load of the adjoint motion in the i-th carried harmonic.
    fn fill(&self, (block, set, i): (&HarmonicBlock, &HarmonicSet, usize), field: &mut [Complex64]) {
        let (m, n) = (set.packed_len(), field.len());
        field.fill(Complex64::ZERO);
        for (c, row) in block.motions.rows.iter().enumerate() {
            let of_row = set.get(&self.lambda[c * m..(c + 1) * m], i);
            for &(p, a) in row.terms() {
                field[p] += a.conj() * of_row;
            }
        }
        if let Some(of) = self.watched.filter(|_| self.amplitude != Complex64::ZERO) {
            for (z, g) in field.iter_mut().zip(&of.by_motion[i * n..(i + 1) * n]) {
                *z += g;
            }
        }
    }
}

impl<'a> ForcedPoint<'a> {
    /// The equations of `condensed` near `omega` with response degree of freedom `response`; `samples` as in the
    /// solution.
    ///
    /// # Errors
    /// Those of the model and of callbacks; `OutOfMemory`; `StoppedByCaller`.
    pub fn new(
        condensed: &'a Condensed,
        response: usize,
        samples: usize,
        omega: f64,
        interrupt: &'a Interrupt<'a>,
    ) -> Result<Self> {
        Self::over(condensed, response, samples, omega.into(), interrupt)
    }

    /// The equations for solutions at frequencies of a range, in which flexibilities are sums where the curve has
    /// them as sums.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn over(
        condensed: &'a Condensed,
        response: usize,
        samples: usize,
        range: Range,
        interrupt: &'a Interrupt<'a>,
    ) -> Result<Self> {
        let problem = HarmonicBalance::new(condensed, response, range, samples, None, interrupt)?;
        let n = problem.size();
        let dofs = condensed.ndof().saturating_mul(condensed.blocks().len());
        Ok(Self {
            condensed,
            interrupt,
            workspace: Workspace::new(condensed, None)?,
            system: NewtonFactors::new(n)?,
            at: Residual::new(n)?,
            response: condensed.motion_row(problem.observed(), response)?,
            w: try_vec(condensed.coordinates(), Complex64::ZERO, CONTEXT)?,
            by_omega: try_vec(dofs, Complex64::ZERO, CONTEXT)?,
            problem,
            watched: None,
            samples,
        })
    }

    /// Whether these equations are valid for another solution, too: same condensed model and samples.
    pub fn are_of(&self, condensed: &Condensed, samples: usize) -> bool {
        core::ptr::eq(self.condensed, condensed) && self.samples == samples
    }

    /// Differentiates a response in place of the amplitude; a response without degrees of freedom reads the `default`
    /// one.
    pub fn watching(mut self, response: &Response<'_>, default: usize, samples: usize) -> Result<Self> {
        let (condensed, interrupt) = (self.condensed, self.interrupt);
        let one = (core::slice::from_ref(response), default);
        let gauges = boxed(|| Gauges::new(condensed, one, samples, interrupt))?;
        self.watched = Some((gauges, None));
        Ok(self)
    }

    /// Evaluates the equations and Newton's matrix at `u`, and writes the derivative of the amplitude by the motions.
    fn linearise(&mut self, u: &[f64], omega: f64, gradient: &mut [f64]) -> Result<Complex64> {
        self.problem.evaluate(u, omega, &mut self.at)?;
        let system = &mut self.system;
        system.active.fill(true);
        self.problem.fill(&mut system.matrix, &mut system.active)?;
        if self.watched.is_some() {
            return self.response_gradient(u, omega, gradient);
        }
        Ok(self.problem.amplitude_gradient(u, gradient))
    }

    /// The response at the point evaluated last, and its derivative by the motions of the contacts.
    fn response_gradient(&mut self, u: &[f64], omega: f64, gradient: &mut [f64]) -> Result<Complex64> {
        gradient.fill(0.0);
        let Some((gauges, known)) = &mut self.watched else {
            return Ok(Complex64::ZERO);
        };
        let mut v = try_copy(u, CONTEXT)?;
        try_push(&mut v, omega, CONTEXT)?;
        let found = gauges.derivatives(&v, 0)?;
        let value = found.value;
        let n = self.condensed.ndof();
        for (i, block) in self.condensed.blocks().iter().enumerate() {
            let mut field = try_copy(&found.by_motion[i * n..(i + 1) * n], CONTEXT)?;
            if field.iter().all(|z| *z == Complex64::ZERO) {
                continue;
            }
            self.workspace
                .adjoint(self.condensed, i, omega, &mut field, self.interrupt)?;
            for (c, row) in block.motions.rows.iter().enumerate() {
                let g = -row.along(&field).conj();
                self.problem.forces().couple_scalar(i, (0, c), g, gradient, 1);
            }
        }
        *known = Some(found);
        Ok(value.into())
    }

    /// The adjoint of the amplitude at the solution `u`; `None` where Newton's matrix is singular, as in a fold.
    ///
    /// # Errors
    /// Those of the model and of callbacks; `OutOfMemory`; `StoppedByCaller`.
    pub fn adjoint(&mut self, u: &[f64], omega: f64) -> Result<Option<Adjoint>> {
        let mut lambda = try_vec(u.len(), 0.0, CONTEXT)?;
        let amplitude = self.linearise(u, omega, &mut lambda)?;
        match self.system.factor(self.interrupt) {
            Err(e) if e.status == Status::Singular => return Ok(None),
            factored => factored?,
        }
        self.system.solve_transposed(&mut lambda);
        let mut adjoint = self.of_lambda(u, omega, amplitude, &lambda)?;
        adjoint.lambda = lambda;
        Ok(Some(adjoint))
    }

    /// The complex amplitude of the watched response at the solution `u`; 0 where the motion does not have its harmonic.
    ///
    /// # Errors
    /// As [`Self::adjoint`].
    pub fn complex_amplitude(&mut self, u: &[f64], omega: f64) -> Result<Complex64> {
        self.problem.evaluate(u, omega, &mut self.at)?;
        let seen = self.observed_motion(u, omega)?;
        Ok(seen.map_or(Complex64::ZERO, |(_, _, amplitude)| amplitude * self.condensed.length()))
    }

    /// Index of the watched harmonic, with motion and amplitude, at the point evaluated last; the workspace then
    /// holds the factors of this harmonic.
    fn observed_motion(&mut self, u: &[f64], omega: f64) -> Result<Option<(usize, Vec<Complex64>, Complex64)>> {
        let condensed = self.condensed;
        let Some(i) = self.watched.as_ref().and_then(|(gauges, _)| gauges.harmonic(0)) else {
            return Ok(None);
        };
        let mut x = try_vec(condensed.ndof(), Complex64::ZERO, CONTEXT)?;
        self.recover(u, omega, i, &mut x)?;
        let amplitude = match &self.watched {
            Some((gauges, _)) => gauges.amplitude(0, (i, omega), &x),
            None => return fail!(Internal, "no response is watched"),
        };
        Ok(Some((i, x, amplitude)))
    }

    /// The motion of the i-th carried harmonic, in the unit of lengths, at the point evaluated last.
    fn recover(&mut self, u: &[f64], omega: f64, i: usize, x: &mut [Complex64]) -> Result<()> {
        let condensed = self.condensed;
        let (set, m) = (condensed.set(), condensed.set().packed_len());
        self.problem.contact_force(u, i, &mut self.w);
        self.workspace
            .recover(condensed, i, omega, &self.w, x, self.interrupt)?;
        for (c, y) in self.w.iter_mut().enumerate() {
            *y = set.get(&u[c * m..(c + 1) * m], i);
        }
        near_rigid_motion::correct(&mut self.workspace, condensed, (i, omega), &self.w, x, self.interrupt)
    }

    /// The complex amplitude of the watched response at the solution `u`, and the adjoints of its real and of its imaginary part, from
    /// one factorisation of Newton's matrix and one of each harmonic; `None` where Newton's matrix is singular.
    ///
    /// # Errors
    /// As [`Self::adjoint`].
    pub fn parts(&mut self, u: &[f64], omega: f64) -> Result<Option<(Complex64, [Adjoint; 2])>> {
        let condensed = self.condensed;
        self.problem.evaluate(u, omega, &mut self.at)?;
        self.system.active.fill(true);
        self.problem.fill(&mut self.system.matrix, &mut self.system.active)?;
        let seen = self.observed_motion(u, omega)?;
        let amplitude = seen.as_ref().map_or(Complex64::ZERO, |(_, _, amplitude)| *amplitude);
        let turns = [Complex64::ONE, Complex64::I];
        let mut lambdas = [Vec::new(), Vec::new()];
        let mut of_parts = [None, None];
        for ((turn, lambda), part) in turns.into_iter().zip(&mut lambdas).zip(&mut of_parts) {
            *lambda = try_vec(u.len(), 0.0, CONTEXT)?;
            let (Some((gauges, _)), Some(&(i, ..))) = (&self.watched, seen.as_ref()) else {
                continue;
            };
            let found = gauges.part(0, (i, omega), (turn, amplitude))?;
            let n = condensed.ndof();
            let mut field = try_copy(&found.by_motion[i * n..(i + 1) * n], CONTEXT)?;
            // The factors are those of the motion.
            self.workspace
                .adjoint_with_factors(condensed, i, omega, &mut field, self.interrupt)?;
            for (c, row) in condensed.blocks()[i].motions.rows.iter().enumerate() {
                let g = -row.along(&field).conj();
                self.problem.forces().couple_scalar(i, (0, c), g, lambda, 1);
            }
            *part = Some(found);
        }
        match self.system.factor(self.interrupt) {
            Err(e) if e.status == Status::Singular => return Ok(None),
            factored => factored?,
        }
        for lambda in &mut lambdas {
            self.system.solve_transposed(lambda);
        }
        let [of_real, of_imaginary] = &lambdas;
        let [by_real, by_imaginary] = &of_parts;
        let wanted = [(of_real, by_real), (of_imaginary, by_imaginary)].map(|(lambda, watched)| Wanted {
            // The derivatives of a part do not vanish with it.
            amplitude: Complex64::ONE,
            lambda,
            watched: watched.as_ref(),
        });
        let known = seen.as_ref().map(|(i, x, _)| (*i, &x[..]));
        let mut found = self.of_lambdas(u, omega, &wanted, known)?;
        let (Some(imaginary), Some(real)) = (found.pop(), found.pop()) else {
            return fail!(Internal, "an adjoint is missing");
        };
        Ok(Some((amplitude * condensed.length(), [real, imaginary])))
    }

    /// The derivatives of A − λᵀR by the motions and by ω, at a fixed λ.
    ///
    /// # Errors
    /// As [`Self::adjoint`].
    pub fn gradient(&mut self, u: &[f64], omega: f64, lambda: &[f64]) -> Result<Vec<f64>> {
        let n = u.len();
        let mut gradient = try_vec(n + 1, 0.0, CONTEXT)?;
        let amplitude = self.linearise(u, omega, &mut gradient[..n])?;
        for (g, column) in gradient.iter_mut().zip(self.system.matrix.chunks_exact(n.max(1))) {
            *g = self.condensed.length() * (*g - dot(column, lambda));
        }
        gradient[n] = self.of_lambda(u, omega, amplitude, lambda)?.by_omega;
        Ok(gradient)
    }

    /// The derivatives of −L wᵀR by the motions and by ω with the unit of lengths L, and the adjoint motion of w.
    ///
    /// # Errors
    /// As [`Self::adjoint`].
    pub fn residual_gradient(&mut self, u: &[f64], omega: f64, w: &[f64]) -> Result<(Vec<f64>, Adjoint)> {
        let n = u.len();
        let mut gradient = try_vec(n + 1, 0.0, CONTEXT)?;
        self.linearise(u, omega, &mut gradient[..n])?;
        for (g, column) in gradient.iter_mut().zip(self.system.matrix.chunks_exact(n.max(1))) {
            *g = -self.condensed.length() * dot(column, w);
        }
        let adjoint = self.of_lambda(u, omega, Complex64::ZERO, w)?;
        gradient[n] = adjoint.by_omega;
        Ok((gradient, adjoint))
    }

    /// Evaluates the equations at `u`; returns the derivative of the amplitude by the motions and the complex amplitude,
    /// both in the unit of lengths.
    ///
    /// # Errors
    /// As [`Self::adjoint`].
    pub fn amplitude(&mut self, u: &[f64], omega: f64) -> Result<(Vec<f64>, Complex64)> {
        let mut gradient = try_vec(u.len(), 0.0, CONTEXT)?;
        let amplitude = self.linearise(u, omega, &mut gradient)?;
        Ok((gradient, amplitude))
    }

    /// The adjoint motion of λ at the point linearised last, for the result A − λᵀR. With an amplitude of 0 the
    /// result is −λᵀR alone.
    ///
    /// # Errors
    /// As [`Self::adjoint`].
    pub fn of_lambda(&mut self, u: &[f64], omega: f64, amplitude: Complex64, lambda: &[f64]) -> Result<Adjoint> {
        let known = self.watched.as_mut().and_then(|(_, known)| known.take());
        let wanted = Wanted {
            amplitude,
            lambda,
            watched: known.as_ref(),
        };
        let found = self.of_lambdas(u, omega, &[wanted], None);
        if let Some((_, place)) = &mut self.watched {
            *place = known;
        }
        match found?.pop() {
            Some(adjoint) => Ok(adjoint),
            None => fail!(Internal, "an adjoint is missing"),
        }
    }

    /// Adjoint motions of several λ at one point, with one factorisation per harmonic. A harmonic whose factors and
    /// motion the workspace already holds comes first.
    fn of_lambdas(
        &mut self,
        u: &[f64],
        omega: f64,
        wanted: &[Wanted<'_>],
        known: Option<(usize, &[Complex64])>,
    ) -> Result<Vec<Adjoint>> {
        let condensed = self.condensed;
        let mut found = Vec::new();
        for _ in wanted {
            try_push(
                &mut found,
                Adjoint::new(condensed, DampedFrequency::new(omega, 0.0), try_copy(u, CONTEXT)?)?,
                CONTEXT,
            )?;
        }
        let set = condensed.set();
        let n = condensed.ndof();
        let length = condensed.length();
        let independent = condensed.degrees().independent();
        let mut x = try_vec(n, Complex64::ZERO, CONTEXT)?;
        let mut field = try_vec(n, Complex64::ZERO, CONTEXT)?;
        let first = known.map(|(i, _)| i);
        let others = (0..condensed.blocks().len()).filter(|i| Some(*i) != first);
        for i in first.into_iter().chain(others) {
            let block = &condensed.blocks()[i];
            match known {
                Some((own, motion)) if own == i => x.copy_from_slice(motion),
                _ => self.recover(u, omega, i, &mut x)?,
            }
            let load = &mut self.by_omega[i * n..(i + 1) * n];
            load.fill(Complex64::ZERO);
            self.workspace.add_frequency_slope(condensed, i, omega, &x, load);
            for z in load.iter_mut() {
                *z = -*z;
            }
            if let Some(unbalance) = &block.load.unbalance {
                for (z, f) in load.iter_mut().zip(unbalance) {
                    *z += 2.0 * omega * f;
                }
            }
            for (c, row) in block.motions.rows.iter().enumerate() {
                let of_law = self.problem.forces().by_omega(c, i);
                for &(p, a) in row.terms() {
                    load[p] -= a.conj() * of_law;
                }
            }
            for z in &mut x {
                *z *= length;
            }
            if block.number == 0 {
                for z in &mut x {
                    z.im = 0.0;
                }
            }
            for (one, adjoint) in wanted.iter().zip(&mut found) {
                one.fill((block, set, i), &mut field);
                if one.amplitude != Complex64::ZERO && self.watched.is_none() && i == self.problem.observed() {
                    let turn = one.amplitude / one.amplitude.norm();
                    for &(p, a) in self.response.terms() {
                        field[p] += a.conj() * turn;
                    }
                }
                // The factors are those of the motion.
                self.workspace
                    .adjoint_with_factors(condensed, i, omega, &mut field, self.interrupt)?;
                for (z, q) in field.iter().zip(&self.by_omega[i * n..(i + 1) * n]) {
                    adjoint.by_omega += length * (z.conj() * q).re;
                }
                if block.number == 0 {
                    for z in &mut field {
                        z.im = 0.0;
                    }
                }
                let range = i * independent..(i + 1) * independent;
                condensed.expand(i, &x, &mut adjoint.motion[range.clone()])?;
                condensed.expand(i, &field, &mut adjoint.field[range])?;
            }
        }
        for (one, adjoint) in wanted.iter().zip(&mut found) {
            let watched = one.watched.filter(|_| one.amplitude != Complex64::ZERO);
            adjoint.by_omega += length * watched.map_or(0.0, |of| of.by_omega);
            adjoint.amplitude = length * one.amplitude.norm();
        }
        Ok(found)
    }

    /// Writes the carried harmonics of the response degree of freedom at `u`; returns the share of the period that each
    /// law slips.
    ///
    /// # Errors
    /// As [`Self::adjoint`].
    pub fn response(&mut self, u: &[f64], omega: f64, x: &mut [Complex64]) -> Result<Vec<f64>> {
        self.problem.evaluate(u, omega, &mut self.at)?;
        self.problem.response(u, omega, x);
        try_copy(self.problem.slip_fractions(), CONTEXT)
    }

    /// Relative change of the contact forces at `u` with the number of samples; 0 where all laws are exact.
    ///
    /// # Errors
    /// Those of callbacks that give up.
    pub fn sampling_error(&mut self, u: &[f64], omega: f64) -> Result<f64> {
        self.problem.sampling_error(u, omega)
    }

    /// Newton's step at the point of which the adjoint was made last.
    pub fn newton_step(&mut self) -> Result<Vec<f64>> {
        let mut step = try_copy(&self.at.values, CONTEXT)?;
        for x in &mut step {
            *x = -*x;
        }
        self.system.solve(&mut step);
        Ok(step)
    }

    /// Change of the motions by the place of a slider that sticks through the period, with the stiffness of its
    /// spring along a coordinate, as under a constant load: at a fixed frequency, at the point of which the adjoint
    /// was made last.
    ///
    /// # Errors
    /// As [`Self::adjoint`].
    pub fn by_slider(&mut self, coordinate: usize, stiffness: f64, omega: f64) -> Result<Vec<f64>> {
        let condensed = self.condensed;
        let set = condensed.set();
        let m = set.packed_len();
        let mut change = try_vec(condensed.unknowns(), 0.0, CONTEXT)?;
        let mut moved = try_vec(condensed.ndof(), Complex64::ZERO, CONTEXT)?;
        let Some((i, block)) = condensed.blocks().iter().enumerate().find(|(_, b)| b.number == 0) else {
            return Ok(change);
        };
        for &(p, a) in block.motions.rows[coordinate].terms() {
            moved[p] += stiffness * a.conj();
        }
        self.workspace
            .motion_under(condensed, i, omega, &mut moved, self.interrupt)?;
        for (c, row) in block.motions.rows.iter().enumerate() {
            set.set(&mut change[c * m..(c + 1) * m], i, row.along(&moved));
        }
        self.system.solve(&mut change);
        Ok(change)
    }

    /// Unit of lengths of the motions.
    pub fn length(&self) -> f64 {
        self.condensed.length()
    }

    /// Residual at the point of which the adjoint was made last.
    pub fn residual(&self) -> &[f64] {
        &self.at.values
    }

    /// Size of motions to which the residual is relative.
    pub fn scale(&self) -> f64 {
        self.at.scale
    }

    /// Newton's matrix at the point linearised last, column-major.
    pub fn jacobian(&self) -> &[f64] {
        &self.system.matrix
    }

    /// ∂R/∂ω at the point of which the adjoint was made last.
    ///
    /// # Errors
    /// As [`Self::adjoint`].
    pub fn residual_by_omega(&mut self, omega: f64) -> Result<Vec<f64>> {
        let condensed = self.condensed;
        let set = condensed.set();
        let (m, n) = (set.packed_len(), condensed.ndof());
        let mut slope = try_vec(condensed.unknowns(), 0.0, CONTEXT)?;
        let mut moved = try_vec(n, Complex64::ZERO, CONTEXT)?;
        for (i, block) in condensed.blocks().iter().enumerate() {
            moved.copy_from_slice(&self.by_omega[i * n..(i + 1) * n]);
            self.workspace
                .motion_under(condensed, i, omega, &mut moved, self.interrupt)?;
            for (c, row) in block.motions.rows.iter().enumerate() {
                set.set(&mut slope[c * m..(c + 1) * m], i, -row.along(&moved));
            }
        }
        Ok(slope)
    }

    /// du/dω along the branch at the solution of which the adjoint was made last.
    ///
    /// # Errors
    /// As [`Self::adjoint`].
    pub fn tangent(&mut self, omega: f64) -> Result<Vec<f64>> {
        let mut tangent = self.residual_by_omega(omega)?;
        for t in &mut tangent {
            *t = -*t;
        }
        self.system.solve(&mut tangent);
        Ok(tangent)
    }
}
