//! Special points of a branch: located between two neighbours that were recorded, sharpened and recorded.

use crate::continuation::special_points::{Locator, SpecialPoint};
use crate::continuation::{Point, PointAt};
use crate::error::{Result, Status};
use crate::harmonics::discretised::Traceable;
use crate::problem::Problem;
use crate::results::SpecialKind;
use crate::tracing::branch_tracer::BranchTracer;

impl BranchTracer<'_> {
    /// Locates folds, other bifurcations, peaks, limit cycles and requested parameter values between two neighbours.
    // Out of line: its points do not lie on the stack under a step.
    #[inline(never)]
    pub(super) fn locate_special(
        &mut self,
        analysis: &mut dyn Traceable,
        a: PointAt<'_>,
        b: PointAt<'_>,
        last: bool,
    ) -> Result<()> {
        analysis.select(a.1.max(b.1))?;
        let interrupt = self.interrupt;
        if analysis.observes_peaks() {
            self.find_peaks_between(analysis, a, b)?;
        }
        self.find_peaks_of_responses(analysis, a, b)?;
        self.find_kinks_of_responses(analysis, a, b)?;
        if let Some(level) = analysis.level_of_limit_cycles().map(SpecialPoint::Level)
            && level.between(a.0, b.0)
        {
            analysis.select(a.1.max(b.1))?;
            let kind = SpecialKind::LimitCycle { slope: f64::NAN };
            self.find(analysis, kind, a, b, |locator, problem, a, b| {
                locator.locate(problem, level, a, b, interrupt)
            })?;
        }
        // A peak may have required more harmonics; a fold is located with those of its neighbours.
        analysis.select(a.1.max(b.1))?;
        let fold = if SpecialPoint::Fold.between(a.0, b.0) {
            self.find(analysis, SpecialKind::Fold, a, b, |locator, problem, a, b| {
                locator.locate(problem, SpecialPoint::Fold, a, b, interrupt)
            })?
        } else {
            None
        };
        if let Some((fold, resolution)) = &fold {
            self.folds.note((fold, *resolution), a, b)?;
        }
        let turn = fold.as_ref().map(|(fold, resolution)| (fold, *resolution));
        self.find_bifurcations(analysis, a, b, turn)?;
        self.find_branch_point(analysis, a, b)?;
        if let Some((fold, resolution)) = &fold {
            self.find_requested(analysis, a, (fold, *resolution), false)?;
            self.find_requested(analysis, (fold, *resolution), b, last)
        } else {
            self.find_requested(analysis, a, b, last)
        }
    }

    /// Searches between two neighbours and records the point that is found, with the harmonics that it requires.
    pub(super) fn find(
        &mut self,
        analysis: &mut dyn Traceable,
        kind: SpecialKind,
        a: PointAt<'_>,
        b: PointAt<'_>,
        search: impl Fn(&mut Locator, &mut dyn Problem, &Point, &Point) -> Result<Option<Point>>,
    ) -> Result<Option<(Point, usize)>> {
        let mut found: Option<(Point, usize)> = None;
        loop {
            let resolution = analysis.resolution();
            let (a, b) = (analysis.transfer(a.0, a.1)?, analysis.transfer(b.0, b.1)?);
            let locator = Locator::new(a.unknowns().len(), self.course.settings)?;
            let mut locator = locator.with_response(kind.response());
            let Some(point) = search(&mut locator, analysis.problem(), &a, &b)? else {
                // A point found with fewer harmonics is better than none.
                if let Some((point, resolution)) = &found {
                    analysis.select(*resolution)?;
                    self.record_special_as_it_is(analysis, kind, point)?;
                }
                return Ok(found);
            };
            if self.record_special(analysis, kind, &point)? {
                return Ok(Some((point, resolution)));
            }
            found = Some((point, resolution));
        }
    }

    /// Sharpens and records a special point; `false` if it requires more harmonics, which are then current.
    pub fn record_special(&mut self, analysis: &mut dyn Traceable, kind: SpecialKind, point: &Point) -> Result<bool> {
        let mut point = point.try_clone()?;
        analysis.sharpen(kind, &mut point)?;
        // Each of many responses has peaks; their errors are those of the points beside them.
        let is_further = kind.response().is_some_and(|response| response > 0);
        if !is_further && !self.controller.meets_tolerance(analysis, kind, &point)? {
            return Ok(false);
        }
        self.record_sharpened(analysis, kind, &point)?;
        Ok(true)
    }

    /// Records a special point with the harmonics with which it was located, whatever its error.
    pub(super) fn record_special_as_it_is(
        &mut self,
        analysis: &mut dyn Traceable,
        kind: SpecialKind,
        point: &Point,
    ) -> Result<()> {
        let mut point = point.try_clone()?;
        analysis.sharpen(kind, &mut point)?;
        self.record_sharpened(analysis, kind, &point)
    }

    /// Records a range that is a single point.
    pub(super) fn record_single(&mut self, analysis: &mut dyn Traceable, point: &Point) -> Result<Status> {
        let end = self.course.settings.end;
        for (i, p) in self.course.at.iter().enumerate() {
            if p.to_bits() == end.to_bits() {
                // The harmonics are those that it required, or with which it could be found.
                self.record_special_as_it_is(analysis, SpecialKind::At(i), point)?;
            }
        }
        Ok(Status::Ok)
    }

    fn record_sharpened(&mut self, analysis: &mut dyn Traceable, kind: SpecialKind, point: &Point) -> Result<()> {
        analysis.record_special(kind, point)?;
        self.controller.note_special(kind);
        Ok(())
    }
}
