//! Stretches of a branch on which every contact is linear: the response is a rational function of the parameter, and is
//! solved at given values of it, without a step length.
//!
//! The values are placed by the resonances, see [`LinearGrid`]; peaks are the roots of the exact derivative of the
//! amplitude between them. A stretch ends where a contact leaves its linear state, which is located to rounding, or at
//! the end of the range.

use crate::continuation::bracket::Bracket;
use crate::continuation::special_points::SpecialPoint;
use crate::continuation::{Point, PointAt};
use crate::error::{Result, Status, try_push};
use crate::harmonics::discretised::Traceable;
use crate::hooks::{Hooks, LogLevel};
use crate::options::Range;
use crate::results::SpecialKind;
use crate::tracing::branch_tracer::{BranchTracer, Stretch, some_unless_lost};
use crate::tracing::resonance_grid::LinearGrid;

/// Outcome of the part of a stretch from a point to the next value.
enum Next {
    Reached(Point),
    /// The last point with linear contacts, and a parameter value beyond it at which some contact is not linear.
    Onset(Point, f64),
}

/// Share of its linear range above which the motion of a contact may have a maximum beyond it between two values.
/// Kind: tuned; measured on: not recorded.
const LINEAR_STRETCH_NEARLY: f64 = 0.7;

/// Evaluations of a search for such a maximum.
/// Kind: cap.
const GOLDEN_STEPS: usize = 16;

/// Ratio of the golden section.
/// Kind: fixed.
const LINEAR_STRETCH_GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Relative width of an interval that is rounding.
/// Kind: rounding.
const LINEAR_STRETCH_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Parts of the cubic between two neighbours in which peaks are searched.
/// Kind: tuned; measured on: not recorded.
const PARTS: usize = 8;

/// Relative change of the amplitude over the distance of two neighbours whose sign the cubic does not tell for certain.
/// Kind: tuned; measured on: not recorded.
const UNCERTAIN: f64 = 0.05;

/// Largest number of evaluations of a root search.
/// Kind: cap.
const LINEAR_STRETCH_MAX_EVALUATIONS: usize = 100;

/// Half width of the first bracket around an approximate root, relative to the parameter, and the factor by which it
/// widens.
/// Kind: tuned; measured on: not recorded.
const BRACKET: f64 = 1e-10;
const WIDENING: f64 = 100.0;

const CONTEXT: &str = "the linear response";

impl BranchTracer<'_> {
    /// Follows the branch from the point recorded last, at which every contact is linear. `None` if the analysis has
    /// no linear response.
    // Out of line: its points do not lie on the stack under a step.
    #[inline(never)]
    pub(super) fn follow_linear(
        &mut self,
        analysis: &mut dyn Traceable,
        (from, resolution): PointAt<'_>,
        hooks: &mut Hooks<'_>,
    ) -> Result<Option<Stretch>> {
        self.make_grid(analysis, hooks)?;
        let settings = self.course.settings;
        // Between points of a linear response only the parameter counts.
        let most = settings
            .steps
            .bound()
            .map_or(f64::INFINITY, |bound| bound * (settings.end - settings.start).abs());
        let rising = from.tangent[from.tangent.len() - 1] > 0.0;
        let mut here = analysis.transfer(from, resolution)?;
        loop {
            if analysis.branch().points() >= self.course.max_points {
                return Ok(Some(Stretch::Stopped(Status::StoppedMaxPoints)));
            }
            self.interrupt.check()?;
            let Some(grid) = &self.linear_grid else {
                return Ok(None);
            };
            let Some(value) = grid.after(here.parameter(), rising, most) else {
                return Ok(None);
            };
            let (point, onset) = match self.next_linear(analysis, &here, value)? {
                Next::Reached(point) => (point, None),
                Next::Onset(point, beyond) => {
                    let distance = (beyond - point.parameter()).abs();
                    (point, Some(distance))
                }
            };
            let end = [settings.end, settings.start]
                .into_iter()
                .find(|bound| bound.to_bits() == point.parameter().to_bits());
            let moved = point.parameter().to_bits() != here.parameter().to_bits();
            if moved {
                if some_unless_lost(analysis.record(&point))?.is_none() {
                    return Ok(Some(Stretch::Stopped(Status::StoppedStepTooSmall)));
                }
                let stop = self.report(analysis, hooks, &point);
                self.find_on_line(analysis, &here, &point, end.is_some(), hooks)?;
                if stop {
                    return Ok(Some(Stretch::Stopped(Status::StoppedByCaller)));
                }
            }
            if let Some(distance) = onset {
                return Ok(Some(Stretch::Onset {
                    before: moved.then_some(here),
                    point,
                    distance,
                }));
            }
            if let Some(bound) = end {
                let status = if bound.to_bits() == settings.end.to_bits() {
                    Status::Ok
                } else {
                    Status::StoppedLeftRange
                };
                return Ok(Some(Stretch::End(point, status)));
            }
            here = point;
        }
    }

    /// Computes the parameter values for all stretches of a branch, once.
    fn make_grid(&mut self, analysis: &mut dyn Traceable, hooks: &mut Hooks<'_>) -> Result<()> {
        if self.grid_requested {
            return Ok(());
        }
        self.grid_requested = true;
        let settings = self.course.settings;
        let range = Range::new(settings.start.min(settings.end), settings.start.max(settings.end));
        let Some(resonances) = analysis.resonances(range)? else {
            let reason = "natural frequencies are not known: linear contacts are followed like nonlinear ones";
            hooks.log(LogLevel::Info, reason);
            return Ok(());
        };
        self.linear_grid = Some(LinearGrid::new(&resonances, range)?);
        Ok(())
    }

    /// The linear response at `value`, or the last point before it at which every contact is linear.
    fn next_linear(&self, analysis: &mut dyn Traceable, here: &Point, value: f64) -> Result<Next> {
        let Some(point) = analysis.linear_at(here, value, self.interrupt)? else {
            return self.onset(analysis, here, value);
        };
        let shares = [here, &point].map(|p| analysis.linear_share(p));
        let [before, after] = shares;
        let largest = before?.max(after?);
        if largest.is_nan() || largest <= LINEAR_STRETCH_NEARLY {
            return Ok(Next::Reached(point));
        }
        // The share may have a maximum above 1 between two values.
        let (mut low, mut high) = (here.parameter(), value);
        let mut inner = [
            high - LINEAR_STRETCH_GOLDEN * (high - low),
            low + LINEAR_STRETCH_GOLDEN * (high - low),
        ];
        let mut found = [0.0; 2];
        for (at, share) in inner.iter().zip(&mut found) {
            match self.share_at(analysis, here, *at)? {
                Some(known) => *share = known,
                None => return self.onset(analysis, here, *at),
            }
        }
        for _ in 0..GOLDEN_STEPS {
            let left = found[0] > found[1];
            let at = if left {
                high = inner[1];
                inner[1] = inner[0];
                found[1] = found[0];
                inner[0] = high - LINEAR_STRETCH_GOLDEN * (high - low);
                inner[0]
            } else {
                low = inner[0];
                inner[0] = inner[1];
                found[0] = found[1];
                inner[1] = low + LINEAR_STRETCH_GOLDEN * (high - low);
                inner[1]
            };
            match self.share_at(analysis, here, at)? {
                Some(known) => found[usize::from(!left)] = known,
                None => return self.onset(analysis, here, at),
            }
        }
        // The problem must be evaluated at the point that is recorded next.
        Ok(match analysis.linear_at(here, value, self.interrupt)? {
            Some(point) => Next::Reached(point),
            None => Next::Onset(here.try_clone()?, value),
        })
    }

    /// Largest share of its linear range that a contact uses at a value; `None` if a contact leaves that range.
    fn share_at(&self, analysis: &mut dyn Traceable, here: &Point, value: f64) -> Result<Option<f64>> {
        match analysis.linear_at(here, value, self.interrupt)? {
            Some(point) => analysis.linear_share(&point).map(Some),
            None => Ok(None),
        }
    }

    /// The last point between `here` and a value beyond it at which every contact is linear, by bisection.
    fn onset(&self, analysis: &mut dyn Traceable, here: &Point, beyond: f64) -> Result<Next> {
        let mut inside = here.try_clone()?;
        let mut outside = beyond;
        while (outside - inside.parameter()).abs() > LINEAR_STRETCH_ROUNDING * outside.abs() {
            let middle = 0.5 * (inside.parameter() + outside);
            match analysis.linear_at(&inside, middle, self.interrupt)? {
                Some(point) => inside = point,
                None => outside = middle,
            }
        }
        Ok(Next::Onset(inside, beyond))
    }

    /// Records the peak and the requested solutions between two neighbours, `b` included if it is the last point.
    fn find_on_line(
        &mut self,
        analysis: &mut dyn Traceable,
        a: &Point,
        b: &Point,
        last: bool,
        hooks: &mut Hooks<'_>,
    ) -> Result<()> {
        let (pa, pb) = (a.parameter(), b.parameter());
        let (low, high) = if pa < pb { (a, b) } else { (b, a) };
        let undamped = self.linear_grid.iter().flat_map(|grid| &grid.undamped);
        let mut between = undamped.filter(|&&omega| low.parameter() < omega && omega < high.parameter());
        if let Some(omega) = between.next() {
            let text =
                format!("undamped resonance at {omega}: the response is unbounded, and no peak is recorded there");
            hooks.log(LogLevel::Warn, &text);
        } else {
            if analysis.observes_peaks() {
                self.find_peaks(analysis, SpecialKind::Peak, low, high)?;
            }
            let resolution = analysis.resolution();
            for response in analysis.further_responses() {
                let low = analysis.seen_by(response, (low, resolution))?;
                let high = analysis.seen_by(response, (high, resolution))?;
                self.find_peaks(analysis, SpecialKind::PeakOf(response), &low, &high)?;
            }
            self.find_kinks_of_responses(analysis, (a, resolution), (b, resolution))?;
        }
        for (i, &p) in self.course.at.iter().enumerate() {
            let inside = (pa <= p && p < pb) || (pb < p && p <= pa) || (last && p.to_bits() == pb.to_bits());
            if inside && let Some(point) = analysis.linear_at(a, p, self.interrupt)? {
                self.record_on_line(analysis, SpecialKind::At(i), point)?;
            }
        }
        Ok(())
    }

    /// Records a special point with the harmonics that it requires; the stretch continues with its own harmonics.
    fn record_on_line(&mut self, analysis: &mut dyn Traceable, kind: SpecialKind, mut point: Point) -> Result<()> {
        let own = analysis.resolution();
        let mut at = own;
        while !self.record_special(analysis, kind, &point)? {
            let start = analysis.transfer(&point, at)?;
            let Some(found) = analysis.linear_at(&start, point.parameter(), self.interrupt)? else {
                // A point found with fewer harmonics is better than none.
                analysis.select(at)?;
                self.record_special_as_it_is(analysis, kind, &point)?;
                break;
            };
            (point, at) = (found, analysis.resolution());
        }
        analysis.select(own)
    }

    /// Records the maxima of the amplitude between two neighbours. The maxima of the cubic through both show where
    /// there is more than one, or one beside a minimum.
    fn find_peaks(&mut self, analysis: &mut dyn Traceable, kind: SpecialKind, low: &Point, high: &Point) -> Result<()> {
        let ends = [low, high].map(|p| (p.parameter(), growth(p)));
        let [(from, begin), (to, end)] = ends;
        // The cubic's derivative in the parts, and its value nearest to a change of sign.
        let mut brackets = Vec::new();
        let mut before = ends[0];
        let mut nearest: Option<(f64, f64)> = None;
        for i in 1..PARTS {
            let s = i as f64 / PARTS as f64;
            let (slope, size) = predicted_growth(low, high, s);
            let here = (from + s * (to - from), slope);
            if before.1 > 0.0 && slope <= 0.0 {
                try_push(&mut brackets, [before, here], CONTEXT)?;
            }
            let against = slope * begin.signum();
            if against < UNCERTAIN * size && nearest.is_none_or(|(_, least)| against < least) {
                nearest = Some((here.0, against));
            }
            before = here;
        }
        if before.1 > 0.0 && end <= 0.0 {
            try_push(&mut brackets, [before, ends[1]], CONTEXT)?;
        }
        let single = begin > 0.0 && end <= 0.0;
        if single && brackets.len() <= 1 {
            return self.find_peak(analysis, kind, low, ends);
        }
        if brackets.is_empty()
            && (begin > 0.0) == (end > 0.0)
            && let Some((value, _)) = nearest
        {
            let middle = (value, f64::NAN);
            let bracket = if begin > 0.0 {
                [ends[0], middle]
            } else {
                [middle, ends[1]]
            };
            try_push(&mut brackets, bracket, CONTEXT)?;
        }
        // The cubic tells where to look; the derivatives there and at the ends tell between which of them a maximum lies.
        let mut before = ends[0];
        for (value, _) in brackets.into_iter().flatten().chain([ends[1]]) {
            let inside = value > from && value < to;
            let here = if value <= before.0 {
                continue;
            } else if !inside {
                ends[1]
            } else if let Some(point) = analysis.linear_at(low, value, self.interrupt)? {
                (value, growth_of(analysis, kind, &point)?)
            } else {
                continue;
            };
            if before.1 > 0.0 && here.1 <= 0.0 {
                self.find_peak(analysis, kind, low, [before, here])?;
            }
            before = here;
        }
        Ok(())
    }

    /// Records the maximum between two values: the root of the derivative, found fast and then accurately.
    fn find_peak(
        &mut self,
        analysis: &mut dyn Traceable,
        kind: SpecialKind,
        from: &Point,
        ends: [(f64, f64); 2],
    ) -> Result<()> {
        let Some(near) = self.stationary(analysis, kind, from, ends)? else {
            return Ok(());
        };
        // The first search has found the maximum to rounding where its evaluations are the most accurate ones.
        if !analysis.set_accurate(true) {
            analysis.set_accurate(false);
            return self.record_on_line(analysis, kind, near);
        }
        let accurate = self.stationary_near(analysis, kind, &near, (ends[0].0, ends[1].0));
        let recorded = accurate.and_then(|peak| {
            let peak = match peak {
                Some(peak) => Some(peak),
                None => analysis.linear_at(&near, near.parameter(), self.interrupt)?,
            };
            match peak {
                Some(peak) => self.record_on_line(analysis, kind, peak),
                None => Ok(()),
            }
        });
        analysis.set_accurate(false);
        recorded
    }

    /// Finds the maximum near a good approximation, from a bracket around it that is widened until it holds the root.
    fn stationary_near(
        &self,
        analysis: &mut dyn Traceable,
        kind: SpecialKind,
        near: &Point,
        (low, high): (f64, f64),
    ) -> Result<Option<Point>> {
        let at = near.parameter();
        let mut width = BRACKET * at.abs();
        while width < high - low {
            let values = [(at - width).max(low), (at + width).min(high)];
            let mut ends = [(0.0, 0.0); 2];
            for (end, value) in ends.iter_mut().zip(values) {
                let Some(point) = analysis.linear_at(near, value, self.interrupt)? else {
                    return Ok(None);
                };
                *end = (value, growth_of(analysis, kind, &point)?);
            }
            if ends[0].1 > 0.0 && ends[1].1 <= 0.0 {
                return self.stationary(analysis, kind, near, ends);
            }
            width *= WIDENING;
        }
        Ok(None)
    }

    /// A root of the amplitude's derivative between two values.
    fn stationary(
        &self,
        analysis: &mut dyn Traceable,
        kind: SpecialKind,
        near: &Point,
        [low, high]: [(f64, f64); 2],
    ) -> Result<Option<Point>> {
        let width = high.0 - low.0;
        let mut bracket = Bracket::new(low.1, high.1);
        let mut best = None;
        for _ in 0..LINEAR_STRETCH_MAX_EVALUATIONS {
            let (share, is_last) = (bracket.guess(), bracket.is_last());
            let at = low.0 + share * width;
            let rounding = LINEAR_STRETCH_ROUNDING * at.abs();
            if bracket.width() * width <= rounding || at <= low.0 || at >= high.0 {
                break;
            }
            let Some(point) = analysis.linear_at(near, at, self.interrupt)? else {
                break;
            };
            let slope = growth_of(analysis, kind, &point)?;
            best = Some(point);
            if slope == 0.0 || is_last || bracket.narrow(share, slope) * width <= rounding {
                break;
            }
        }
        Ok(best)
    }
}

/// ½ d|z|²/ds and |z|² at s, for the cubic through two points of the amplitude z and their derivatives.
fn predicted_growth(a: &Point, b: &Point, s: f64) -> (f64, f64) {
    let width = b.parameter() - a.parameter();
    let slope = |p: &Point| p.slope * (width / p.tangent[p.tangent.len() - 1]);
    let (za, zb, da, db) = (a.amplitude, b.amplitude, slope(a), slope(b));
    let difference = zb - za;
    let (c2, c3) = (difference * 3.0 - da * 2.0 - db, da + db - difference * 2.0);
    let z = za + (da + (c2 + c3 * s) * s) * s;
    let dz = da + (c2 * 2.0 + c3 * (3.0 * s)) * s;
    ((z.conj() * dz).re, z.norm_sqr())
}

/// d|z|/dp of the response whose peak is sought.
fn growth_of(analysis: &mut dyn Traceable, kind: SpecialKind, point: &Point) -> Result<f64> {
    let resolution = analysis.resolution();
    Ok(match kind.response() {
        Some(response) => growth(&analysis.seen_by(response, (point, resolution))?),
        None => growth(point),
    })
}

/// d|z|/dp of the observed amplitude.
fn growth(point: &Point) -> f64 {
    SpecialPoint::Peak.function(point, point.tangent[point.tangent.len() - 1])
}
