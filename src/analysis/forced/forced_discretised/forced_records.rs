//! The records of a forced response: points of the curve and points beside it, with their errors, responses and stability.

use crate::analysis::forced::forced_discretised::ForcedDiscretised;
use crate::analysis::forced::forced_equations::Equations;
use crate::continuation::Point;
use crate::continuation::resolve::resolve;
use crate::error::Result;
use crate::harmonics::discretised::Recorder;
use crate::problem::Problem;
use crate::results::{Branch, SpecialKind};

impl Recorder for ForcedDiscretised<'_> {
    fn record(&mut self, point: &Point) -> Result<()> {
        self.refresh(point)?;
        let error = self.error(point)?;
        self.recorder.note_error(error);
        let resolution = self.resolutions.index();
        self.responses.see(
            &mut self.resolutions.current.problem,
            (point, resolution),
            &self.errors.of_responses,
        )?;
        let record = self.resolutions.current.record(point, error, &self.responses.seen)?;
        self.recorder.record(&record, point.stalled)?;
        self.state.linear = self.resolutions.current.problem.forces().all_linear();
        let fine = if self.state.linear {
            None
        } else {
            self.fine_motion(point)?
        };
        if let Some(stability) = &mut self.verdicts.of_points {
            let resolution = self.resolutions.current.resolution;
            let verdict = stability.along(resolution, point, fine.as_deref(), self.state.linear)?;
            self.recorder.record_verdict(verdict)?;
        }
        self.resolutions.note_recorded();
        Ok(())
    }

    /// Solves the point once more at its frequency, to round-off. At a fold the solution at a fixed frequency is not isolated.
    fn sharpen(&mut self, kind: SpecialKind, point: &mut Point) -> Result<()> {
        self.state.stale = false;
        let Equations { problem, corrector, .. } = &mut *self.resolutions.current;
        let mut found = None;
        let accurate = self.linear_response.solved == Some(point.parameter());
        // The peaks of many responses are as exact as the sweep.
        let is_further = kind.response().is_some_and(|response| response > 0);
        if !kind.is_fold() && !accurate && !is_further {
            found = resolve(problem, corrector, &self.settings, point, true, self.interrupt)?;
        }
        if let Some(found) = found {
            point.v = found.v;
            point.amplitude = found.amplitude;
            point.residual = found.residual;
            return Ok(());
        }
        corrector.evaluate(problem, &point.v)?;
        if kind.response().is_some() {
            point.amplitude = problem.observe(point.unknowns(), &point.tangent).0;
        }
        Ok(())
    }

    fn record_special(&mut self, kind: SpecialKind, point: &Point) -> Result<()> {
        let mut error = f64::NAN;
        if kind.response().is_some_and(|response| response > 0) {
            // That of the point of the curve before it.
            error = self.estimator.as_ref().map_or(f64::NAN, |_| self.errors.last);
        } else if !kind.is_fold() {
            error = self.error(point)?;
            self.recorder.note_error(error);
        }
        let index = self.resolutions.index();
        let unknown = if kind.is_fold() {
            &[]
        } else {
            &self.errors.of_responses[..]
        };
        self.responses
            .see(&mut self.resolutions.current.problem, (point, index), unknown)?;
        let resolution = self.resolutions.current.resolution;
        let record = self.resolutions.current.record(point, error, &self.responses.seen)?;
        self.recorder.record_special(kind, resolution, &record, None)?;
        self.resolutions.note_recorded();
        Ok(())
    }

    fn sampling_factor(&self) -> usize {
        self.recorder.sampling_factor()
    }

    fn branch(&self) -> &Branch {
        self.recorder.branch()
    }
}
