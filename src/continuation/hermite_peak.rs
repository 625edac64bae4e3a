//! A peak between solutions of a branch that has no fold among them, by Hermite interpolation over the parameter.
//!
//! With solutions v_i at p_i, their derivatives v_i′ by the parameter and the Lagrange polynomials l_i,
//!
//! > v(p) = Σ h_i v_i + k_i v_i′,  h_i = (1 − 2 l_i′(p_i)(p − p_i)) l_i²,  k_i = (p − p_i) l_i²,
//!
//! has the order of twice the number of solutions. The root of the derivative of its amplitude is solved once more; a solution that
//! is no peak is one more node. Where many responses have their peaks near each other, most take one evaluation.

use crate::continuation::Point;
use crate::continuation::corrector::Outcome;
use crate::continuation::special_points::Locator;
use crate::error::{Error, Result, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::problem::Problem;
use crate::roots::root;
use num_complex::Complex64;

const CONTEXT: &str = "the peak between solutions";

/// Most nodes of the interpolation, those next to the peak, and most solutions that are sought.
/// Kind: tuned; measured on: not recorded.
const MOST_NODES: usize = 4;
/// Most solutions that are sought at a peak.
/// Kind: cap.
const MOST_SOLUTIONS: usize = 4;

/// Distance of the peak from the last solution, over that of the ends and over the parameter.
/// Kind: rounding.
const CLOSE_BY: f64 = 1e-6;
const CLOSE_BY_PARAMETER: f64 = 1e-9;

/// Weights of a value and of its derivative, each with its first and its second derivative by the parameter.
#[derive(Clone, Copy, Default)]
struct Weights {
    value: (f64, f64, f64),
    slope: (f64, f64, f64),
}

/// Weights of all nodes at the parameter p; `places` are the parameters of the nodes.
fn weights(places: &[f64], p: f64, found: &mut [Weights]) {
    for (i, (&own, weights)) in places.iter().zip(found.iter_mut()).enumerate() {
        // l, dl/dp and d²l/dp², and dl/dp at the node.
        let (mut l, mut dl, mut ddl, mut at_node) = (1.0, 0.0, 0.0, 0.0);
        for (_, &other) in places.iter().enumerate().filter(|(m, _)| *m != i) {
            let width = own - other;
            ddl = (ddl * (p - other) + 2.0 * dl) / width;
            dl = (dl * (p - other) + l) / width;
            l *= (p - other) / width;
            at_node += 1.0 / width;
        }
        let (square, d_square, away) = (l * l, 2.0 * l * dl, p - own);
        let dd_square = 2.0 * (dl * dl + l * ddl);
        let (h, dh) = (1.0 - 2.0 * at_node * away, -2.0 * at_node);
        *weights = Weights {
            value: (
                h * square,
                h * d_square + dh * square,
                h * dd_square + 2.0 * dh * d_square,
            ),
            slope: (
                away * square,
                square + away * d_square,
                2.0 * d_square + away * dd_square,
            ),
        };
    }
}

/// Solutions next to a peak, used as nodes of the interpolation.
struct Nodes<'p> {
    points: Vec<&'p Point>,
    places: Vec<f64>,
    weights: Vec<Weights>,
    /// 1 where the parameter rises along the branch, else −1.
    sense: f64,
}

impl<'p> Nodes<'p> {
    /// The nodes next to the two that enclose a peak; `None` where the parameter turns among them.
    fn new(all: &'p [Point], between: (usize, usize)) -> Result<Option<Self>> {
        let (mut first, mut end) = (between.0, between.1 + 1);
        while end - first < MOST_NODES.min(all.len()) {
            // The next one on either side, the nearer first.
            let before = first
                .checked_sub(1)
                .map(|i| (all[i].parameter() - all[first].parameter()).abs());
            let after = all.get(end).map(|p| (p.parameter() - all[end - 1].parameter()).abs());
            match (before, after) {
                (Some(b), Some(a)) if a < b => end += 1,
                (Some(_), _) => first -= 1,
                (None, _) => end += 1,
            }
        }
        let chosen = &all[first..end];
        let rate = |p: &Point| p.tangent[p.tangent.len() - 1];
        let sense = (chosen[chosen.len() - 1].parameter() - chosen[0].parameter()).signum();
        let is_monotone = chosen
            .windows(2)
            .all(|w| (w[1].parameter() - w[0].parameter()) * sense > 0.0)
            && chosen.iter().all(|p| rate(p) * sense > 0.0);
        if !is_monotone {
            return Ok(None);
        }
        let (mut points, mut places) = (Vec::new(), Vec::new());
        for point in chosen {
            try_push(&mut points, point, CONTEXT)?;
            try_push(&mut places, point.parameter(), CONTEXT)?;
        }
        Ok(Some(Self {
            weights: try_vec(points.len(), Weights::default(), CONTEXT)?,
            points,
            places,
            sense,
        }))
    }

    /// Half the derivative of the squared amplitude along the branch at the parameter p, and its derivative by p.
    fn growth(&mut self, p: f64) -> (f64, f64) {
        weights(&self.places, p, &mut self.weights);
        let (mut z, mut dz, mut ddz) = (Complex64::ZERO, Complex64::ZERO, Complex64::ZERO);
        for (point, w) in self.points.iter().zip(&self.weights) {
            let by_parameter = point.slope / point.tangent[point.tangent.len() - 1];
            z += point.amplitude * w.value.0 + by_parameter * w.slope.0;
            dz += point.amplitude * w.value.1 + by_parameter * w.slope.1;
            ddz += point.amplitude * w.value.2 + by_parameter * w.slope.2;
        }
        let bend = dz.norm_sqr() + (z.conj() * ddz).re;
        (self.sense * (z.conj() * dz).re, self.sense * bend)
    }

    /// Interpolated unknowns and parameter at p.
    fn solution(&mut self, p: f64) -> Result<Vec<f64>> {
        weights(&self.places, p, &mut self.weights);
        let n = self.points[0].v.len();
        let mut v = try_vec(n, 0.0, CONTEXT)?;
        for (point, w) in self.points.iter().zip(&self.weights) {
            let slope = w.slope.0 / point.tangent[n - 1];
            for ((v, x), t) in v.iter_mut().zip(&point.v).zip(&point.tangent) {
                *v += w.value.0 * x + slope * t;
            }
        }
        v[n - 1] = p;
        Ok(v)
    }
}

impl Locator {
    /// The peak between the neighbours `between` of `nodes`; `None` where interpolation does not lead to it. `nodes`
    /// are solutions in the order of the branch, as the response sees them; further solutions are added to them.
    ///
    /// # Errors
    /// Those of the problem; `StoppedByCaller`.
    pub fn peak_on(
        &mut self,
        problem: &mut dyn Problem,
        nodes: &mut Vec<Point>,
        mut between: (usize, usize),
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Point>> {
        let ends = (nodes[between.0].parameter(), nodes[between.1].parameter());
        let width = ends.1 - ends.0;
        for _ in 0..MOST_SOLUTIONS {
            let Some(mut near) = Nodes::new(nodes, between)? else {
                return Ok(None);
            };
            let range = (nodes[between.0].parameter(), nodes[between.1].parameter());
            let [at_low, at_high] = [range.0, range.1].map(|p| near.growth(p).0);
            let p = root((range.0, at_low), (range.1, at_high), |p| {
                Ok::<_, Error>(near.growth(p).0)
            })?;
            let (_, bend) = near.growth(p);
            // At a corner within the range the polynomial bends more than the branch.
            let secant = (at_high - at_low) / (range.1 - range.0);
            let bend = bend.abs().min(secant.abs());
            let guess = near.solution(p)?;
            let sense = near.sense;
            let Some(point) = self.solved_at(problem, guess, &nodes[between.0], interrupt)? else {
                return Ok(None);
            };
            let rate = point.tangent[point.tangent.len() - 1];
            let growth = (point.amplitude.conj() * point.slope).re / rate * sense;
            if !(rate * sense > 0.0 && growth.is_finite()) {
                return Ok(None);
            }
            let close = (CLOSE_BY * width.abs()).min(CLOSE_BY_PARAMETER * p.abs());
            if growth.abs() <= close * bend {
                return Ok(Some(point));
            }
            let place = between.1;
            nodes.try_reserve(1).map_err(|_| Error::out_of_memory(CONTEXT))?;
            nodes.insert(place, point);
            between = if growth > 0.0 {
                (place, place + 1)
            } else {
                (place - 1, place)
            };
        }
        Ok(None)
    }

    /// Solves at the parameter of the guess `v`, along the direction of a neighbour.
    fn solved_at(
        &mut self,
        problem: &mut dyn Problem,
        mut v: Vec<f64>,
        neighbour: &Point,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Point>> {
        let n = v.len() - 1;
        let p = v[n];
        let metric = self.metric(neighbour, neighbour);
        self.row.fill(0.0);
        self.row[n] = 1.0;
        let corrected = self
            .corrector
            .correct(problem, &mut v, &self.row, metric, true, interrupt)?;
        let Outcome::Converged(corrected) = corrected else {
            return Ok(None);
        };
        v[n] = p;
        let mut point = Point::new(v, corrected, 0.0);
        if metric.dot(&point.tangent, &neighbour.tangent) < 0.0 {
            point.reverse();
        }
        self.see(problem, &mut point)?;
        Ok(Some(point))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolation_is_exact_for_polynomials_of_its_order() {
        let f = |p: f64| 1.0 + p * (2.0 - p * (0.5 + p * (0.3 - p * (1.1 - p * (0.7 + p * (0.2 - 0.4 * p))))));
        let df = |p: f64| (f(p + 1e-6) - f(p - 1e-6)) / 2e-6;
        let ddf = |p: f64| (f(p + 1e-3) - 2.0 * f(p) + f(p - 1e-3)) / 1e-6;
        let places = [0.3, 0.7, 0.8, 1.4];
        let mut found = [Weights::default(); 4];
        for p in [0.35, 0.75, 1.0, 1.4] {
            weights(&places, p, &mut found);
            let (mut value, mut slope, mut bend) = (0.0, 0.0, 0.0);
            for (own, w) in places.iter().zip(&found) {
                value += f(*own) * w.value.0 + df(*own) * w.slope.0;
                slope += f(*own) * w.value.1 + df(*own) * w.slope.1;
                bend += f(*own) * w.value.2 + df(*own) * w.slope.2;
            }
            assert!((value - f(p)).abs() < 1e-8 && (slope - df(p)).abs() < 1e-7, "{p}");
            assert!(
                (bend - ddf(p)).abs() < 1e-4 * ddf(p).abs().max(1.0),
                "{p}: {bend} for {}",
                ddf(p)
            );
        }
    }
}
