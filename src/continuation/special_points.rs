//! Special points between two accepted points: folds, peaks and levels of the observed amplitude, and solutions at
//! given parameter values, each solved for and not interpolated.

use crate::continuation::corrector::{Corrector, Outcome};
use crate::continuation::predictor::Cubic;
use crate::continuation::{Metric, Point, Settings};
use crate::error::{Result, try_copy, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::problem::Problem;

/// Special points that are searched for between two points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpecialPoint {
    /// The parameter turns: the tangent has no component along it.
    Fold,
    /// The observed amplitude is largest: d|z|/ds = 0, falling after.
    Peak,
    /// The observed amplitude, a real number, has this value.
    Level(f64),
}

impl SpecialPoint {
    /// The function whose root is the special point: the derivative of the parameter or of the amplitude along the
    /// tangent, over a `length` of the tangent, or the amplitude above a level.
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

/// Bracket of a root on an arc from 0 to 1, narrowed by the Illinois variant of regula falsi.
pub struct Bracket {
    low: (f64, f64),
    high: (f64, f64),
    side: i32,
}

impl Bracket {
    /// The whole arc with the values at its ends, of different signs.
    #[must_use]
    pub fn new(low: f64, high: f64) -> Self {
        Self {
            low: (0.0, low),
            high: (1.0, high),
            side: 0,
        }
    }

    /// Its width.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.high.0 - self.low.0
    }

    /// The place where the root is expected.
    #[must_use]
    pub fn guess(&self) -> f64 {
        let (low, high) = (self.low, self.high);
        let s = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
        if s > low.0 && s < high.0 {
            s
        } else {
            0.5 * (low.0 + high.0)
        }
    }

    /// Takes the value at a place within over, and returns the distance to the end that it replaces.
    pub fn narrow(&mut self, s: f64, f: f64) -> f64 {
        let below = (f > 0.0) == (self.low.1 > 0.0);
        let (end, other, side) = if below {
            (&mut self.low, &mut self.high, -1)
        } else {
            (&mut self.high, &mut self.low, 1)
        };
        let moved = (s - end.0).abs();
        *end = (s, f);
        if self.side == side {
            other.1 *= 0.5;
        }
        self.side = side;
        moved
    }
}

/// Solves for points between accepted ones.
pub struct Locator {
    corrector: Corrector,
    settings: Settings,
    row: Vec<f64>,
    derivative: Vec<f64>,
}

const CONTEXT: &str = "the search for special points";

/// Maximum number of evaluations of one search.
const MAX_EVALUATIONS: usize = 60;

/// Maximum number of halvings of an arc in search of a parameter.
const MAX_HALVINGS: usize = 12;

/// Width of the bracket, as a share of the step, at which a special point counts as found.
const WIDTH: f64 = 1e-11;

impl Locator {
    /// Memory for `n` unknowns.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize, settings: Settings) -> Result<Self> {
        Ok(Self {
            corrector: Corrector::new(n, settings.tolerance, settings.max_iterations)?,
            settings,
            row: try_vec(n + 1, 0.0, CONTEXT)?,
            derivative: try_vec(n + 1, 0.0, CONTEXT)?,
        })
    }

    fn metric(&self, a: &Point, b: &Point) -> Metric {
        Metric::along(norm(a.unknowns()).max(norm(b.unknowns())), &self.settings)
    }

    /// The special point between `a` and `b`, by the Illinois variant of regula falsi on the arc.
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
        let metric = self.metric(a, b);
        let value = |point: &Point| kind.function(point, metric.norm(&point.tangent));
        let mut bracket = Bracket::new(value(a), value(b));
        let mut best: Option<Point> = None;
        if bracket.high.1 == 0.0 {
            return Ok(Some(b.try_clone()?));
        }
        for _ in 0..MAX_EVALUATIONS {
            let s = bracket.guess();
            let Some(point) = self.solve_between(problem, metric, (a, b), s, None, interrupt)? else {
                return Ok(best);
            };
            let f = value(&point);
            best = Some(point);
            if f == 0.0 || bracket.width() < WIDTH || bracket.narrow(s, f) < WIDTH {
                break;
            }
        }
        Ok(best)
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
        for _ in 0..MAX_HALVINGS {
            let (a, b) = (&arc.0, &arc.1);
            let metric = self.metric(a, b);
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

    /// Position on the arc from `a` to `b` at which the cubic has parameter `p`.
    fn where_at(&mut self, a: &Point, b: &Point, metric: Metric, p: f64) -> Result<f64> {
        let n = a.v.len() - 1;
        let cubic = Cubic::new(a, b, metric);
        let mut v = try_copy(&a.v, CONTEXT)?;
        let (mut low, mut high) = (0.0, 1.0);
        let rising = b.parameter() > a.parameter();
        for _ in 0..50 {
            let s = 0.5 * (low + high);
            cubic.at(s, &mut v, &mut self.derivative);
            if (v[n] < p) == rising {
                low = s;
            } else {
                high = s;
            }
        }
        Ok(0.5 * (low + high))
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
        let mut point = Point::new(v, corrected, 0.0);
        if metric.dot(&point.tangent, &self.derivative) < 0.0 {
            point.reverse();
        }
        Ok(Some(point))
    }
}
