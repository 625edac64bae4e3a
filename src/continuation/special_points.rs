//! Special points between two accepted points: folds, peaks and levels of the observed amplitude, and solutions at
//! given parameter values, each solved for and not interpolated.

use crate::continuation::arc_cubic::Cubic;
use crate::continuation::corrector::{Corrector, Outcome};
use crate::continuation::{Metric, Point, Settings};
use crate::error::{Result, try_copy, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::problem::Problem;
use crate::roots::{BRACKET_WIDTH, Bracket, root};

/// Special points that are searched for between two points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpecialPoint {
    /// A fold: the parameter turns, so that the tangent has no component along it.
    Fold,
    /// A peak: the observed amplitude is largest, d|z|/ds = 0, falling after.
    Peak,
    /// A level: the observed amplitude, a real number, has this value.
    Level(f64),
}

impl SpecialPoint {
    /// The function whose root is the special point. For a fold or a peak it is the derivative of the parameter or of
    /// the amplitude along the tangent, per `length` of the tangent; for a level, the amplitude minus the level.
    #[must_use]
    pub fn function(self, point: &Point, length: f64) -> f64 {
        match self {
            Self::Fold => point.tangent[point.tangent.len() - 1] / length,
            Self::Level(level) => point.amplitude.re - level,
            Self::Peak => {
                let z = point.amplitude;
                let size = z.norm();
                if size == 0.0 {
                    0.0
                } else {
                    (z.conj() / size * point.slope).re / length
                }
            }
        }
    }

    /// Integral of the function from one point to the next, if it is known.
    fn integral(self, a: &Point, b: &Point) -> Option<f64> {
        match self {
            Self::Fold => Some(b.parameter() - a.parameter()),
            Self::Peak => Some(b.amplitude.norm() - a.amplitude.norm()),
            Self::Level(_) => None,
        }
    }

    /// Whether the special point lies between two neighbouring points.
    #[must_use]
    pub fn between(self, a: &Point, b: &Point) -> bool {
        let (fa, fb) = (self.function(a, 1.0), self.function(b, 1.0));
        match self {
            Self::Fold => fa * fb < 0.0,
            Self::Level(_) => (fa < 0.0) != (fb < 0.0),
            Self::Peak => fa > 0.0 && fb <= 0.0,
        }
    }
}

/// Solves for points between accepted ones.
pub struct Locator {
    pub(super) corrector: Corrector,
    settings: Settings,
    pub(super) row: Vec<f64>,
    derivative: Vec<f64>,
    /// Position of the last solution on the same arc, and its distance from the cubic; empty if there is none.
    departed_at: f64,
    departure: Vec<f64>,
    /// Further response from which amplitudes are taken; `None`: the observed one.
    response: Option<usize>,
}

const CONTEXT: &str = "the search for special points";

/// Distance of the last place of a further response from the one before it.
/// Kind: tuned; measured on: not recorded.
const CLOSE_FOR_RESPONSES: f64 = 1e-5;

/// Maximum number of evaluations of one search.
/// Kind: cap.
const SPECIAL_POINTS_MAX_EVALUATIONS: usize = 60;

/// Maximum number of halvings of an arc in search of a parameter.
/// Kind: cap.
const SPECIAL_POINTS_MAX_HALVINGS: usize = 12;

/// Value of a function over the larger one at the ends that is that of a root.
/// Kind: tuned; measured on: not recorded.
const VANISHING: f64 = 1e-6;

impl Locator {
    /// Memory for `n` unknowns.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize, settings: Settings) -> Result<Self> {
        // Points that need not be exact lead to special points that are solved once more where they are recorded.
        let tolerance = settings.steps.tolerance(settings.tolerance);
        Ok(Self {
            corrector: Corrector::new(n, tolerance, settings.max_iterations)?,
            settings,
            row: try_vec(n + 1, 0.0, CONTEXT)?,
            derivative: try_vec(n + 1, 0.0, CONTEXT)?,
            departed_at: 0.0,
            departure: try_vec(n + 1, 0.0, CONTEXT)?,
            response: None,
        })
    }

    /// Takes amplitudes from a further response of the problem; `None`: from the observed one.
    #[must_use]
    pub fn with_response(mut self, response: Option<usize>) -> Self {
        self.response = response;
        self
    }

    /// Whether the next position is the last one. For a further response, of which there may be many, it may be in
    /// error by 1e-9 of the arc, and the amplitude by the square.
    fn is_last(&self, bracket: &Bracket) -> bool {
        if self.response.is_some() {
            bracket.is_last_within(CLOSE_FOR_RESPONSES)
        } else {
            bracket.is_last()
        }
    }

    pub(super) fn metric(&self, a: &Point, b: &Point) -> Metric {
        Metric::along(norm(a.unknowns()).max(norm(b.unknowns())), &self.settings)
    }

    /// The special point between `a` and `b`, as a root along the arc.
    ///
    /// # Errors
    /// Those of the problem; `StoppedByCaller`.
    pub fn locate(
        &mut self,
        problem: &mut dyn Problem,
        kind: SpecialPoint,
        a: &Point,
        b: &Point,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Point>> {
        let mut found = None;
        for &margin in self.settings.steps.margins() {
            let (point, is_root) = self.search(problem, kind, margin, (a, b), interrupt)?;
            found = point.or(found);
            if is_root {
                break;
            }
        }
        Ok(found)
    }

    /// Searches for the special point on an arc that is extended by `margin` at an end near the root, since inexact
    /// ends may lie on its other side. Also returns whether the function vanishes at the point found.
    fn search(
        &mut self,
        problem: &mut dyn Problem,
        kind: SpecialPoint,
        margin: f64,
        (a, b): (&Point, &Point),
        interrupt: &Interrupt<'_>,
    ) -> Result<(Option<Point>, bool)> {
        let metric = self.metric(a, b);
        let value = |point: &Point| kind.function(point, metric.norm(&point.tangent));
        let mut ends = [(0.0, value(a)), (1.0, value(b))];
        if ends[1].1 == 0.0 {
            return Ok((Some(b.try_clone()?), true));
        }
        self.departure.clear();
        let expected = Bracket::between(ends[0], ends[1]).guess();
        for (end, s, is_near) in [
            (0, -margin, expected < margin),
            (1, 1.0 + margin, expected > 1.0 - margin),
        ] {
            if is_near && let Some(point) = self.solve_between(problem, metric, (a, b), s, None, interrupt)? {
                let f = value(&point);
                if (f > 0.0) == (ends[end].1 > 0.0) {
                    ends[end] = (s, f);
                }
            }
        }
        let mut bracket = Bracket::between(ends[0], ends[1]);
        let is_whole = ends.map(|end| end.0.to_bits()) == [0.0_f64, 1.0].map(f64::to_bits);
        if let Some(integral) = kind.integral(a, b).filter(|_| is_whole) {
            bracket = bracket.with_integral(integral / metric.distance(&a.v, &b.v));
        }
        let (mut best, mut last) = (None, f64::INFINITY);
        for _ in 0..SPECIAL_POINTS_MAX_EVALUATIONS {
            let (mut s, mut is_last) = (bracket.guess(), self.is_last(&bracket));
            let mut found = self.solve_between(problem, metric, (a, b), s, None, interrupt)?;
            if found.is_none() {
                // Beyond a corner interpolation, and the last departure, may lead away.
                self.departure.clear();
                (s, is_last) = (bracket.middle(), false);
                found = self.solve_between(problem, metric, (a, b), s, None, interrupt)?;
            }
            let Some(point) = found else { break };
            last = value(&point);
            best = Some(point);
            if is_last || last == 0.0 || bracket.width() < BRACKET_WIDTH || bracket.narrow(s, last) < BRACKET_WIDTH {
                break;
            }
        }
        let is_root = last.abs() <= VANISHING * ends[0].1.abs().max(ends[1].1.abs());
        Ok((best, is_root))
    }

    /// The solution at the share `s` of the arc from `a` to `b`; `None` if there is none near the cubic.
    ///
    /// # Errors
    /// Those of the problem; `StoppedByCaller`.
    pub fn between(
        &mut self,
        problem: &mut dyn Problem,
        (a, b): (&Point, &Point),
        s: f64,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Point>> {
        let metric = self.metric(a, b);
        self.departure.clear();
        self.solve_between(problem, metric, (a, b), s, None, interrupt)
    }

    /// The solution at parameter `p` between `a` and `b`, whose parameters enclose it without a fold in between.
    ///
    /// # Errors
    /// Those of the problem; `StoppedByCaller`.
    pub fn at_parameter(
        &mut self,
        problem: &mut dyn Problem,
        a: &Point,
        b: &Point,
        p: f64,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Point>> {
        for end in [a, b] {
            if end.parameter().to_bits() == p.to_bits() {
                return Ok(Some(end.try_clone()?));
            }
        }
        // Where the cubic is too poor a guess, a point of the branch near `p` halves the arc.
        let mut arc = (a.try_clone()?, b.try_clone()?);
        for _ in 0..SPECIAL_POINTS_MAX_HALVINGS {
            let (a, b) = (&arc.0, &arc.1);
            let metric = self.metric(a, b);
            self.departure.clear();
            let s = self.where_at(a, b, metric, p)?;
            if let Some(found) = self.solve_between(problem, metric, (a, b), s, Some(p), interrupt)? {
                return Ok(Some(found));
            }
            let Some(middle) = self.solve_between(problem, metric, (a, b), s.clamp(0.1, 0.9), None, interrupt)? else {
                return Ok(None);
            };
            let before = (middle.parameter() < p) == (b.parameter() > a.parameter());
            arc = if before { (middle, arc.1) } else { (arc.0, middle) };
        }
        Ok(None)
    }

    /// The solution at parameter `p` between `a` and `b`, found from the cubic through them; and the same point with the unknowns
    /// and the amplitude that the cubic has there. `None` where Newton's method leads from the cubic to no solution near it.
    ///
    /// # Errors
    /// Those of the problem; `StoppedByCaller`.
    pub fn beside_cubic(
        &mut self,
        problem: &mut dyn Problem,
        (a, b): (&Point, &Point),
        p: f64,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<(Point, Point)>> {
        let metric = self.metric(a, b);
        let s = self.where_at(a, b, metric, p)?;
        let cubic = Cubic::new(a, b, metric);
        let mut guess = try_copy(&a.v, CONTEXT)?;
        cubic.place(s, &mut guess);
        let Some(found) = self.solve_between(problem, metric, (a, b), s, Some(p), interrupt)? else {
            return Ok(None);
        };
        let expected = Point {
            v: guess,
            tangent: try_copy(&found.tangent, CONTEXT)?,
            amplitude: cubic.amplitude(s),
            ..found
        };
        Ok(Some((found, expected)))
    }

    /// Position on the arc from `a` to `b` at which the cubic has parameter `p`.
    fn where_at(&mut self, a: &Point, b: &Point, metric: Metric, p: f64) -> Result<f64> {
        let n = a.v.len() - 1;
        let cubic = Cubic::new(a, b, metric);
        let mut v = try_copy(&a.v, CONTEXT)?;
        let derivative = &mut self.derivative;
        root((0.0, a.parameter() - p), (1.0, b.parameter() - p), |s| {
            cubic.at(s, &mut v, derivative);
            Ok(v[n] - p)
        })
    }

    /// Solves in the plane across the cubic at s, or at a fixed parameter.
    fn solve_between(
        &mut self,
        problem: &mut dyn Problem,
        metric: Metric,
        (a, b): (&Point, &Point),
        s: f64,
        fixed: Option<f64>,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Point>> {
        let n = a.v.len() - 1;
        let cubic = Cubic::new(a, b, metric);
        let mut v = try_copy(&a.v, CONTEXT)?;
        cubic.at(s, &mut v, &mut self.derivative);
        if let Some(p) = fixed {
            v[n] = p;
            self.row.fill(0.0);
            self.row[n] = 1.0;
        } else {
            metric.unit(&self.derivative, &mut self.row);
        }
        let guess = try_copy(&v, CONTEXT)?;
        // The error of a cubic with these ends grows with s²(1 − s)².
        let error = |s: f64| (s * (1.0 - s)).powi(2);
        let ratio = error(s) / error(self.departed_at);
        if fixed.is_none() && ratio.is_finite() {
            for (v, d) in v.iter_mut().zip(&self.departure) {
                *v += ratio * d;
            }
        }
        let outcome = self
            .corrector
            .correct(problem, &mut v, &self.row, metric, true, interrupt)?;
        let Outcome::Converged(corrected) = outcome else {
            return Ok(None);
        };
        if metric.distance(&guess, &v) > cubic.chord {
            return Ok(None);
        }
        if let Some(p) = fixed {
            v[n] = p;
        }
        // At most n + 1 numbers, for which there is memory.
        self.departed_at = s;
        self.departure.clear();
        self.departure.extend(v.iter().zip(&guess).map(|(v, g)| v - g));
        let mut point = Point::new(v, corrected, 0.0);
        if metric.dot(&point.tangent, &self.derivative) < 0.0 {
            point.reverse();
        }
        self.see(problem, &mut point)?;
        Ok(Some(point))
    }

    /// Replaces the amplitude of a solved point by that of the further response.
    pub(super) fn see(&self, problem: &mut dyn Problem, point: &mut Point) -> Result<()> {
        if let Some(response) = self.response
            && let Some((amplitude, slope)) = problem.see(response, &point.v, &point.tangent)?
        {
            (point.amplitude, point.slope) = (amplitude, slope);
        }
        Ok(())
    }
}
