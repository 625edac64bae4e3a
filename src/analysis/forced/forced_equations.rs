//! The equations of a forced response at one resolution, with what solves them.

use crate::continuation::corrector::Corrector;
use crate::continuation::resolve::solve_linear;
use crate::continuation::{Point, Settings};
use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::options::Range;
use crate::options::Response;
use crate::problem::harmonic_balance::HarmonicBalance;
use crate::results::{Record, Resolution, SeenWithError};
use num_complex::Complex64;

/// The equations of a forced response at one resolution, with their corrector.
pub(crate) struct Equations<'a> {
    pub resolution: &'a Resolution,
    pub problem: HarmonicBalance<'a>,
    pub corrector: Box<Corrector>,
    /// Response of each carried harmonic, as computed last.
    pub response: Vec<Complex64>,
}

impl<'a> Equations<'a> {
    /// The solution with linear contacts at a frequency; see `Discretised::linear_at`.
    pub fn linear_at(
        &mut self,
        settings: &Settings,
        (near, omega): (&Point, f64),
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Point>> {
        let Self { problem, corrector, .. } = self;
        let found = solve_linear(problem, corrector, settings, near, omega, interrupt);
        Ok(found?.filter(|_| problem.forces().all_linear()))
    }

    /// The equations over the range of the settings, with the further responses to read.
    pub fn new(
        resolution: &'a Resolution,
        settings: &Settings,
        (responses, response): (&[Response<'_>], usize),
        given: Option<Vec<f64>>,
        interrupt: &'a Interrupt<'a>,
    ) -> Result<Self> {
        let (condensed, samples) = (&*resolution.condensed, resolution.samples);
        let range = Range::new(settings.start, settings.end);
        let mut problem = HarmonicBalance::new(condensed, response, range, samples, given, interrupt)?;
        problem.watch((responses, response), samples)?;
        Ok(Self {
            corrector: Box::new(Corrector::new(
                problem.unknowns(),
                settings.tolerance,
                settings.max_iterations,
            )?),
            response: try_vec(condensed.blocks().len(), Complex64::ZERO, "the response")?,
            problem,
            resolution,
        })
    }

    /// The record of the point at which the problem was evaluated last.
    pub fn record<'b>(&'b mut self, point: &'b Point, error: f64, seen: &'b [SeenWithError]) -> Result<Record<'b>> {
        let (u, omega) = (point.unknowns(), point.parameter());
        self.problem.response(u, omega, &mut self.response);
        let sampling_error = self.problem.sampling_error(u, omega)?;
        Ok(Record {
            resolution: self.resolution,
            omega,
            motion: u,
            amplitude: point.amplitude,
            response: &self.response,
            residual: point.residual,
            iterations: point.iterations,
            slip_fractions: self.problem.slip_fractions(),
            sampling_error,
            errors: (error, f64::NAN),
            seen,
        })
    }
}
