//! Ends of a curve that was entered inside its range: where it closes, and where it comes back to the branch that it branches
//! off from.
//!
//! A curve that branches off from a solution with a symmetry leaves it in directions that the symmetric solution does not
//! have. It passes the symmetric branch where the motions in these directions change their sign: beyond lies its mirror image.

use crate::continuation::arc_cubic::Cubic;
use crate::continuation::arc_length::STRAIGHT;
use crate::continuation::{Metric, ONE_SOLUTION, Point, PointAt, Settings};
use crate::error::{Result, try_vec};
use crate::fourier::HarmonicSet;
use crate::harmonics::discretised::Traceable;
use crate::interrupt::Interrupt;
use crate::linalg::norm;

const CONTEXT: &str = "the end of a branch";

/// Points of the curve before it may close.
/// Kind: block.
const INNER_ENDS_LEAST: usize = 4;

/// Distance of the first point to an arc, over its chord, at which the curve closes there.
/// Kind: tuned; measured on: not recorded.
const INNER_ENDS_CLOSE: f64 = 0.1;

/// Corrections of the place on an arc.
/// Kind: cap.
const INNER_ENDS_CORRECTIONS: usize = 8;

/// The harmonics that a symmetric motion does not have: those whose number over `base` has this remainder modulo 2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Dropped {
    pub base: usize,
    pub remainder: usize,
}

impl Dropped {
    /// Whether a symmetric motion lacks this harmonic.
    pub fn has(self, number: usize) -> bool {
        number / self.base.max(1) % 2 == self.remainder
    }

    /// Inner product of two packed motions, over the harmonics that a symmetric motion lacks.
    pub fn dot(self, set: &HarmonicSet, a: &[f64], b: &[f64]) -> f64 {
        let m = set.packed_len().max(1);
        let pairs = a.chunks_exact(m).zip(b.chunks_exact(m));
        let numbers = || set.numbers().iter().enumerate().filter(|(_, h)| self.has(**h));
        pairs
            .flat_map(|(a, b)| numbers().map(move |(i, _)| (set.get(a, i) * set.get(b, i).conj()).re))
            .sum()
    }
}

/// End of a curve that was entered inside its range.
pub(crate) enum InnerEnd {
    /// The curve closes at its first point, given in the current resolution.
    Closed(Point),
    /// The curve passes the branch that it branches off from, at this parameter value.
    Merged(f64),
}

/// Data by which the ends of one curve are found.
pub(crate) struct InnerEnds {
    /// First point of the curve, with its resolution.
    first: (Point, usize),
    /// Harmonics that are zero on the branch from which the curve branches off; `None` if it branches off from none.
    dropped: Option<Dropped>,
}

impl InnerEnds {
    /// Prepares for the ends of a curve with this first point.
    pub fn new(first: &Point, resolution: usize, dropped: Option<Dropped>) -> Result<Self> {
        Ok(Self {
            first: (first.try_clone()?, resolution),
            dropped,
        })
    }

    /// The end of the curve, if any, between the point recorded last and the next one, of the current resolution.
    pub fn between(
        &self,
        analysis: &mut dyn Traceable,
        (last, resolution): PointAt<'_>,
        point: &Point,
        (settings, interrupt): (&Settings, &Interrupt<'_>),
    ) -> Result<Option<InnerEnd>> {
        let last = analysis.transfer(last, resolution)?;
        let n = point.unknowns().len();
        let current = analysis.resolution();
        if let Some(dropped) = self.dropped {
            let set = analysis.levels().at(current)?.condensed.set();
            let product = |a: &Point, b: &Point| dropped.dot(set, a.unknowns(), b.unknowns());
            let (before, across, after) = (product(&last, &last), product(&last, point), product(point, point));
            if across < 0.0 {
                let share = before.sqrt() / (before.sqrt() + after.sqrt());
                let at = last.parameter() + share * (point.parameter() - last.parameter());
                return Ok(Some(InnerEnd::Merged(at)));
            }
            if after.sqrt() <= ONE_SOLUTION * norm(point.unknowns()) {
                // Up to the branch the square of that part falls in proportion to the parameter.
                let slope = 2.0 * dropped.dot(set, last.unknowns(), &last.tangent[..n]);
                let at = last.parameter() - before * last.tangent[n] / slope;
                let (a, b) = (last.parameter(), point.parameter());
                let at = if at.is_finite() {
                    at.clamp(a.min(b), a.max(b))
                } else {
                    a
                };
                return Ok(Some(InnerEnd::Merged(at)));
            }
        }
        if analysis.branch().points() < INNER_ENDS_LEAST {
            return Ok(None);
        }
        let first = analysis.transfer(&self.first.0, self.first.1)?;
        let metric = Metric::along(norm(point.unknowns()), settings);
        if !passes(&first, (&last, point), metric, n)? {
            return Ok(None);
        }
        // The problem is to be evaluated at the point that is recorded.
        let found = analysis.resolve(&first, true, interrupt)?;
        Ok(found.map(InnerEnd::Closed))
    }
}

/// Whether an arc from `a` to `b` passes the point `first` in the direction of that point.
fn passes(first: &Point, (a, b): (&Point, &Point), metric: Metric, n: usize) -> Result<bool> {
    let mut chord = try_vec(n + 1, 0.0, CONTEXT)?;
    let mut way = try_vec(n + 1, 0.0, CONTEXT)?;
    for i in 0..=n {
        chord[i] = b.v[i] - a.v[i];
        way[i] = first.v[i] - a.v[i];
    }
    let square = metric.dot(&chord, &chord);
    let length = square.sqrt();
    let along = metric.dot(&first.tangent, &chord) / (metric.norm(&first.tangent) * length);
    let share = metric.dot(&way, &chord) / square;
    if !(along >= STRAIGHT && share > 0.0 && share <= 1.0) {
        return Ok(false);
    }
    let cubic = Cubic::new(a, b, metric);
    let mut v = try_vec(n + 1, 0.0, CONTEXT)?;
    let mut s = share;
    for _ in 0..INNER_ENDS_CORRECTIONS {
        cubic.place(s, &mut v);
        for i in 0..=n {
            way[i] = v[i] - a.v[i];
        }
        s = (s + share - metric.dot(&way, &chord) / square).clamp(0.0, 1.0);
    }
    Ok(metric.distance(&v, &first.v) <= INNER_ENDS_CLOSE * length)
}
