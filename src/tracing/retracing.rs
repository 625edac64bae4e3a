//! A branch that comes back along its own points: detected by the last points, and turned round at the point where its
//! sense was lost.
//!
//! A point whose parameter lies back between two recorded ones is either beyond a fold, on another solution, or on the
//! curve that was recorded. Beyond a fold its distance to that curve is at least its distance to the point before it: with
//! p = −s² near a fold, a step from −x to y that comes back in p has y > x, and the recorded solution at its parameter
//! lies 2y > x + y away. Solving at the parameter of the point, from the cubic through the recorded ones, decides the rest.

use crate::continuation::arc_cubic::Cubic;
use crate::continuation::{Continuation, Metric, Point, PointAt, Settings};
use crate::error::{Error, Result, Status, try_copy, try_push, try_vec};
use crate::harmonics::discretised::Traceable;
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::roots::root;

const CONTEXT: &str = "the last points of the branch";

/// Number of recorded points before the last that are kept: steps grow by a small factor each.
/// Kind: tuned; measured on: not recorded.
const KEPT: usize = 5;

/// Distance of a point to the recorded curve, over that to the point before it, below which it may lie on the curve.
/// Kind: tuned; measured on: not recorded.
const RETRACING_CLOSE: f64 = 0.2;

/// Distance of two solutions that are one, over that step: at a corner the branch may come back at a small angle, so that
/// its two sides are close to each other. The second one is for points whose sense is that of the recorded curve: a branch
/// that comes back along its own points has the other one, unless rounding hides it.
/// Kind: tuned; measured on: not recorded.
const RETRACING_SAME: (f64, f64) = (1e-2, 1e-3);

/// The points recorded last, without a gap between them.
pub(super) struct RecentPoints {
    before: Vec<(Point, usize)>,
    last: (Point, usize),
    /// Whether the branch was turned round at the last point.
    turned: bool,
}

impl RecentPoints {
    /// Begins at a recorded point; also returns a continuation from this point.
    pub fn begin(settings: Settings, point: Point, resolution: usize) -> Result<(Self, Continuation)> {
        let continuation = Continuation::new(settings, point)?.leaving_surfaces();
        let recent = Self {
            before: Vec::new(),
            last: (continuation.current().try_clone()?, resolution),
            turned: false,
        };
        Ok((recent, continuation))
    }

    /// The point recorded last, with its resolution.
    pub fn last(&self) -> PointAt<'_> {
        (&self.last.0, self.last.1)
    }

    /// Adds a recorded point with its resolution.
    pub fn push(&mut self, (point, resolution): PointAt<'_>) -> Result<()> {
        let next = if self.before.len() == KEPT {
            point.try_clone_into(self.before.remove(0).0)?
        } else {
            point.try_clone()?
        };
        let before = core::mem::replace(&mut self.last, (next, resolution));
        self.turned = false;
        try_push(&mut self.before, before, CONTEXT)
    }

    /// Continues at the end of a linear stretch, with the point before it in that stretch; `None` where the stretch
    /// ends at the last point.
    pub fn go_on(&mut self, (before, point): (Option<&Point>, &Point), resolution: usize) -> Result<()> {
        let Some(before) = before else {
            self.last = (point.try_clone()?, resolution);
            return Ok(());
        };
        self.before.clear();
        try_push(&mut self.before, (before.try_clone()?, resolution), CONTEXT)?;
        self.last = (point.try_clone()?, resolution);
        Ok(())
    }

    /// Whether a solution of the current resolution, found after the last point, lies on the curve through the stored
    /// points; and whether the problem was evaluated elsewhere to decide that.
    fn hold(
        &self,
        analysis: &mut dyn Traceable,
        point: &Point,
        settings: &Settings,
        interrupt: &Interrupt<'_>,
    ) -> Result<(bool, bool)> {
        let (last, resolution) = self.last();
        let Some((before, _)) = self.before.last() else {
            return Ok((false, false));
        };
        let p = point.parameter();
        if (p - last.parameter()) * (last.parameter() - before.parameter()) >= 0.0 {
            return Ok((false, false));
        }
        let ends = core::iter::once(&self.last).chain(self.before.iter().rev());
        let mut pairs = self.before.iter().rev().zip(ends);
        let Some((a, b)) = pairs.find(|(a, b)| (p - a.0.parameter()) * (p - b.0.parameter()) <= 0.0) else {
            return Ok((false, false));
        };
        let current = analysis.resolution();
        let keeps_sense = [a, b]
            .iter()
            .all(|at| at.1 == current && at.0.positive == point.positive);
        let same = if keeps_sense {
            RETRACING_SAME.1
        } else {
            RETRACING_SAME.0
        };
        let (a, b) = (analysis.transfer(&a.0, a.1)?, analysis.transfer(&b.0, b.1)?);
        let last = analysis.transfer(last, resolution)?;
        let metric = Metric::along(norm(point.unknowns()), settings);
        let near = Point {
            v: on_cubic(&a, &b, metric, p)?,
            tangent: try_copy(&point.tangent, CONTEXT)?,
            ..*point
        };
        if metric.distance(&near.v, &point.v) > RETRACING_CLOSE * metric.distance(&last.v, &point.v) {
            return Ok((false, false));
        }
        let Some(found) = analysis.resolve(&near, true, interrupt)? else {
            return Ok((false, true));
        };
        let step = metric.distance(&last.v, &point.v);
        Ok((metric.distance(&found.v, &point.v) <= same * step, true))
    }

    /// The last point, in the current resolution, with its sense corrected to lead away from the point before it.
    /// `None` where its sense was right, or is not found.
    fn turned_round(
        &self,
        analysis: &mut dyn Traceable,
        from: &Point,
        settings: &Settings,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Point>> {
        let Some((before, resolution)) = self.before.last() else {
            return Ok(None);
        };
        // A chord between points of one resolution: harmonics that only one of them has would hide its direction.
        let start = analysis.transfer(before, *resolution)?;
        let Some(before) = analysis.resolve(&start, true, interrupt)? else {
            return Ok(None);
        };
        let metric = Metric::along(norm(from.unknowns()), settings);
        let along = metric.dot(&from.v, &from.tangent) - metric.dot(&before.v, &from.tangent);
        if along >= 0.0 {
            return Ok(None);
        }
        let mut turned = from.try_clone()?;
        turned.reverse();
        Ok(Some(turned))
    }

    /// The given point, unless it lies on the curve recorded so far: then the branch continues in the other sense
    /// from the point before.
    pub fn mend(
        &mut self,
        analysis: &mut dyn Traceable,
        continuation: &mut Continuation,
        point: Point,
        (settings, interrupt): (&Settings, &Interrupt<'_>),
        hooks: &mut Hooks<'_>,
    ) -> Result<Option<Point>> {
        let (retraces, evaluated) = self.hold(analysis, &point, settings, interrupt)?;
        if !retraces {
            // The problem is to be evaluated at the point again.
            let again = if evaluated {
                analysis.resolve(&point, false, interrupt)?
            } else {
                None
            };
            return Ok(Some(again.unwrap_or(point)));
        }
        let from = match continuation.previous() {
            Some(from) if !self.turned => self.turned_round(analysis, from, settings, interrupt)?,
            _ => None,
        };
        let Some(from) = from else {
            return Err(came_back(point.parameter()));
        };
        hooks.log(
            LogLevel::Info,
            "the branch came back along its own points: its sense was corrected",
        );
        self.turned = true;
        continuation.go_on_from(None, from)?;
        Ok(None)
    }
}

/// The point on the cubic through `a` and `b` at a parameter value between theirs.
fn on_cubic(a: &Point, b: &Point, metric: Metric, p: f64) -> Result<Vec<f64>> {
    let cubic = Cubic::new(a, b, metric);
    let mut v = try_vec(a.v.len(), 0.0, CONTEXT)?;
    let mut derivative = try_vec(a.v.len(), 0.0, CONTEXT)?;
    let n = v.len() - 1;
    root((0.0, a.parameter() - p), (1.0, b.parameter() - p), |s| {
        cubic.at(s, &mut v, &mut derivative);
        Ok::<_, Error>(v[n] - p)
    })?;
    v[n] = p;
    Ok(v)
}

/// The error for a branch that could not be turned round.
fn came_back(parameter: f64) -> Error {
    Error::new(
        Status::NoConvergence,
        format_args!(
            "the branch came back along its own points at {parameter}, and was not found beyond them: it ends here"
        ),
    )
    .recoverable()
}
