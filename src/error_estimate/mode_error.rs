//! The error of a point of a nonlinear mode, including those of its frequency and damping ratio.

use crate::condense::Condensed;
use crate::error::{Result, try_vec};
use crate::error_estimate::cutoff_harmonic::{self, CutoffHarmonic};
use crate::error_estimate::estimate::{
    CONTEXT, ROUNDING, SHARE, extended_options, has_converged_tail, omits_nothing, or_unknown, relative, tail,
};
use crate::error_estimate::extended_newton::{FirstStep, extend};
use crate::error_estimate::extended_system::ExtendedSystem;
use crate::error_estimate::work::{OF_A_START, Sizes, Work};
use crate::error_estimate::{Corrected, Estimate, Solved};
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::linear_system::Jacobian;
use crate::linalg::norm;
use crate::model::Model;
use crate::options::{DampingForm, SolverOptions};
use crate::problem::epmc::{Epmc, Gauge, LinearMode};
use num_complex::Complex64;
use std::sync::Arc;

/// Ratio of the harmonics of an extended model to those needed up to which the model is used again.
const SPARE: f64 = 1.25;

/// Newton iterations with the whole extended matrix for which the work must suffice.
const ITERATIONS: f64 = 3.0;

/// Relative error of the damping ratio below which its last change need not be small against its whole change: along
/// a backbone the latter passes through zero.
const NEGLIGIBLE: f64 = 1e-3;

/// Damping ratio below which a mode has none but round-off, so that errors are not relative to it.
pub const NO_DAMPING: f64 = 1e-8;

/// Estimates the errors of points of one nonlinear mode, one after the other.
pub struct ModeEstimator<'a> {
    model: &'a Model,
    options: SolverOptions,
    form: DampingForm,
    linear: &'a LinearMode,
    gauge: &'a Gauge,
    response: usize,
    interrupt: &'a Interrupt<'a>,
    cutoff: Option<CutoffHarmonic>,
    /// The extended model used last.
    extended: Option<Condensed>,
}

impl<'a> ModeEstimator<'a> {
    /// For points of the mode that starts from `linear`, on the wave of the model's engine order, observing
    /// degree of freedom `response`.
    #[must_use]
    pub fn new(
        model: &'a Model,
        options: &SolverOptions,
        form: DampingForm,
        (linear, gauge): (&'a LinearMode, &'a Gauge),
        response: usize,
        interrupt: &'a Interrupt<'a>,
    ) -> Self {
        Self {
            model,
            options: *options,
            form,
            linear,
            gauge,
            response,
            interrupt,
            cutoff: None,
            extended: None,
        }
    }

    /// The estimate at a solved point of this log₁₀ amplitude and damping ratio; not certified if it could not be
    /// made.
    ///
    /// # Errors
    /// Those of callbacks that give up; `StoppedByCaller`.
    pub fn at(&mut self, solved: &Solved<'_>, log10_amplitude: f64, damping: f64) -> Result<Estimate> {
        self.interrupt.phase(Phase::Estimate, 0.0)?;
        if solved.is_linear(self.interrupt)? {
            return solved.exact(damping);
        }
        let found = self.extend(solved, log10_amplitude, damping);
        or_unknown(found, solved, damping)
    }

    fn condensed(&self, highest: usize) -> Result<Condensed> {
        let options = extended_options(&self.options, highest);
        Ok(Condensed::for_mode(
            self.model,
            &options,
            (self.form, self.linear.rest.is_loaded()),
            &self.linear.shape,
            self.interrupt,
        )?
        .0)
    }

    fn extend(&mut self, solved: &Solved<'_>, log10_amplitude: f64, damping: f64) -> Result<Option<Estimate>> {
        let set = solved.condensed.set();
        let own = set.numbers().last().copied().unwrap_or(0);
        let sizes = Sizes::new(solved.condensed, self.options.samples);
        let work = Work::of_point(&sizes, solved.iterations.max(OF_A_START), self.options.memory_limit);
        let most = work.highest((solved.condensed, usize::MAX), &self.options, ITERATIONS, |sizes| {
            sizes.evaluation() + sizes.factors(sizes.packed(), 0.0)
        });
        let least = cutoff_harmonic::carried_from(set, 2 * own + 1);
        if least > most {
            return solved.unknown(damping, true).map(Some);
        }
        if self.cutoff.is_none() {
            let waves = least.max(cutoff_harmonic::all_waves(solved.condensed));
            self.cutoff = Some(CutoffHarmonic::new(Arc::new(self.condensed(waves)?), self.interrupt)?);
        }
        let Some(cutoff) = &mut self.cutoff else {
            return Ok(None);
        };
        let highest = cutoff.at(solved.omega, least, most, self.interrupt)?;
        let spare = (highest as f64 * SPARE) as usize;
        let carries = |c: &Condensed| c.set().numbers().last().is_some_and(|h| (highest..=spare).contains(h));
        if !self.extended.as_ref().is_some_and(carries) {
            self.extended = None;
        }
        let condensed = match self.extended.take() {
            Some(condensed) => condensed,
            None => self.condensed(highest)?,
        };
        let found = self.on(&condensed, solved, (log10_amplitude, damping), (highest >= most, work));
        self.extended = Some(condensed);
        found
    }

    fn on(
        &self,
        condensed: &Condensed,
        solved: &Solved<'_>,
        (p, damping): (f64, f64),
        (short, work): (bool, Work),
    ) -> Result<Option<Estimate>> {
        let set = condensed.set();
        let highest = set.numbers().last().copied().unwrap_or(0);
        let samples = extended_options(&self.options, highest).samples;
        let problem = Epmc::new(condensed, self.gauge, self.linear, samples, self.interrupt)?;
        let n = problem.size();
        let mut system = ExtendedSystem::dense(problem, p, Sizes::new(condensed, samples), work)?;
        let a = 10f64.powf(p);
        let mut start = solved.extended(condensed, n, 1.0 / a)?;
        Epmc::set_frequency_and_damping(self.linear, (solved.omega, damping), &mut start);
        if !system.evaluate(&start)? {
            return Ok(None);
        }
        let residual = (&system.at.values[..n - 2], system.at.scale);
        if omits_nothing(residual, set, solved.condensed.set(), self.options.tol_residual) {
            return solved.exact(damping).map(Some);
        }
        let of_damping = |u: &[f64]| Epmc::damping_of_change(u).abs();
        let enough = |_: &Epmc<'_>, _: &[f64], change: &[f64], next: &[f64]| {
            let (moved, last) = (norm(&change[..n - 2]), norm(&next[..n - 2]));
            let (changed, left) = (of_damping(change), of_damping(&next[..n]));
            (last <= SHARE * moved || last <= ROUNDING * norm(&start))
                && (left <= SHARE * changed || left <= SHARE * NEGLIGIBLE * damping.abs().max(NO_DAMPING))
        };
        let Some(extended) = extend(
            &mut system,
            (&start, &start),
            enough,
            FirstStep::Checked,
            self.interrupt,
        )?
        else {
            return Ok(None);
        };
        let z = extended.corrected()?;
        let (omega2, damping2) = Epmc::frequency_and_damping(self.linear, &z);
        let (omega1, damping1) = Epmc::frequency_and_damping(self.linear, &extended.at);
        let unit = a * condensed.length();
        let (i, dofs) = (set.fundamental(), condensed.ndof());
        let row = condensed.motion_row(i, self.response)?;
        let response = |shape: &[Complex64]| row.along(&shape[i * dofs..(i + 1) * dofs]) * unit;
        let before = response(system.problem.shape());
        if !system.evaluate(&z)? {
            return Ok(None);
        }
        let response = response(system.problem.shape());
        let motion = &z[..n - 2];
        let size = norm(motion);
        let mut change = try_vec(n - 2, 0.0, CONTEXT)?;
        for ((c, z), s) in change.iter_mut().zip(motion).zip(&start) {
            *c = z - s;
        }
        let change = norm(&change) / size;
        let tail = tail(set, solved.condensed.set(), (motion, &[]))?;
        let certified = extended.certified && (!short || has_converged_tail(&tail, change));
        let known = |x: f64| if certified { x } else { f64::NAN };
        let next = (response - before).norm();
        let mut packed = try_vec(n - 2, 0.0, CONTEXT)?;
        for (to, y) in packed.iter_mut().zip(motion) {
            *to = y * unit;
        }
        Ok(Some(Estimate {
            certified,
            too_large: !certified && short,
            motion: known(change + norm(&extended.next[..n - 2]) / size),
            response: known(relative((response - solved.response).norm() + next, response)),
            frequency: known(((omega2 - solved.omega).abs() + (omega2 - omega1).abs()) / omega2),
            damping: known((damping2 - damping).abs() + (damping2 - damping1).abs()),
            harmonics: highest,
            steps: extended.steps,
            change,
            tail,
            corrected: Corrected {
                set: set.try_clone()?,
                motion: packed,
                response,
                omega: omega2,
                damping: damping2,
                rates: Vec::new(),
            },
        }))
    }
}
