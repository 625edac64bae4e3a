//! The first point of a curve that is entered inside its range: at a known motion, or beside a bifurcation.
//!
//! At a bifurcation the motions u* + ε φ along the null vector φ of the Jacobian are solutions to first order. The point beside
//! it has a given ε, and the frequency is unknown: [J r; φᵀ 0] is regular where the branch itself is singular. From there the
//! arc length leads on, away from the bifurcation (Allgower & Georg, Introduction to Numerical Continuation Methods, 2003,
//! §8, doi:10.1137/1.9780898719154).

use crate::analysis::forced::deflation::Deflation;
use crate::analysis::forced::forced_discretised::ForcedDiscretised;
use crate::analysis::forced::known_curve::lies_on;
use crate::analysis::forced::phase_direction::phase_direction;
use crate::analysis::forced::start_net::Net;
use crate::continuation::{Metric, ONE_SOLUTION, Point, Settings};
use crate::error::{Result, fail, try_copy, try_push, try_vec};
use crate::fourier::HarmonicSet;
use crate::harmonics::discretised::Discretised;
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::options::Content;
use crate::results::Branch;
use crate::tracing::inner_ends::Dropped;
use core::cell::Cell;
use num_complex::Complex64;
use std::sync::Arc;

const CONTEXT: &str = "the start of a branch";

/// Distances from a bifurcation or a branch point, as shares of the motion, in the order in which they are tried.
/// Kind: tuned; measured on: not recorded.
pub(crate) const DISTANCES: [f64; 6] = [1e-2, 3e-3, 3e-2, 1e-3, 1e-1, 3e-4];

/// Share of the motion in harmonics that it does not have.
/// Kind: rounding.
const ABSENT: f64 = 1e-8;

/// Eigenvalue over the smallest one among the harmonics that a motion does not have, below which another symmetry breaks.
/// Kind: tuned; measured on: not recorded.
const OTHER_SYMMETRY: f64 = 0.1;

/// Entry of a curve inside its range, near the guess of its options.
pub(crate) struct Inside<'k> {
    /// Frequency of the guess.
    pub omega: f64,
    /// Harmonics to carry beside those of forces and laws.
    pub content: Content,
    /// Sense along the null vector in which the curve leaves a bifurcation; `None`: the guess lies on the curve.
    pub leaves: Option<f64>,
    /// Branches of the same period on which the curve may lie already.
    pub known: &'k [&'k Branch],
    /// Number of periods of the force in one period of the curve.
    pub periods: usize,
    /// Outcome of the entry.
    pub entry: Cell<Entry>,
    /// Motions to add to the guess, with the amplitudes and phases of a net; `None`: the guess alone.
    pub net: Option<&'k Net<'k>>,
    /// Deflation, where the guess is a known solution and others are sought beside it.
    pub deflation: Option<Deflation>,
}

/// The first point, oriented along the curve; and the harmonics that the curve has but the branch that it leaves has
/// not.
pub(crate) struct Entered {
    pub point: Point,
    pub dropped: Option<Dropped>,
}

/// Outcome of the search for a first point inside the range.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) enum Entry {
    /// No point was found.
    #[default]
    Nothing,
    /// The point lies on a known curve.
    Known,
    /// The curve is followed; with the harmonics that the branch that it leaves does not have.
    Followed(Option<Dropped>),
}

impl Inside<'_> {
    /// Finds the first point of a curve that is not known yet.
    ///
    /// # Errors
    /// `NoConvergence` where none is found, or it is known; those of the problem.
    pub fn enter(
        &self,
        response: &mut ForcedDiscretised<'_>,
        guess: &[f64],
        settings: &Settings,
        interrupt: &Interrupt<'_>,
    ) -> Result<Entered> {
        let Some(entered) = self.first_point(response, guess, settings, interrupt)? else {
            return fail!(
                NoConvergence,
                "no point was found on the curve that branches off, or near the given motion, at {}",
                self.omega
            );
        };
        for known in self.known {
            if lies_on(response, known, &entered.point, self.periods, interrupt)? {
                self.entry.set(Entry::Known);
                return fail!(NoConvergence, "the curve at {} is known", self.omega);
            }
        }
        self.entry.set(Entry::Followed(entered.dropped));
        Ok(entered)
    }

    fn first_point(
        &self,
        response: &mut ForcedDiscretised<'_>,
        guess: &[f64],
        settings: &Settings,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Entered>> {
        let n = guess.len();
        let mut start = Point {
            v: try_vec(n + 1, self.omega, CONTEXT)?,
            tangent: try_vec(n + 1, 0.0, CONTEXT)?,
            amplitude: Complex64::ZERO,
            slope: Complex64::ZERO,
            residual: f64::INFINITY,
            iterations: 0,
            step: 0.0,
            stalled: false,
            positive: true,
        };
        start.v[..n].copy_from_slice(guess);
        start.tangent[n] = 1.0;
        if let Some(net) = self.net {
            let point = net.first_solution(response, &start, (self.known, self.periods), interrupt)?;
            return Ok(point.map(|point| Entered { point, dropped: None }));
        }
        if self.deflation.is_some() {
            let point = Deflation::first_solution(response, &start, self.known, self.periods, interrupt)?;
            return Ok(point.map(|point| Entered { point, dropped: None }));
        }
        let level = response.resolution();
        let to = Arc::clone(&response.levels().at(level)?.condensed);
        let set = to.set();
        let (low, high) = (settings.start.min(settings.end), settings.start.max(settings.end));
        let is_inside = |point: &Point| (low..=high).contains(&point.parameter());
        let Some(sense) = self.leaves else {
            let by_phase = phase_direction(set, guess)?;
            let mut point = response.resolve(&start, true, interrupt)?;
            if point.is_none() {
                start.tangent = by_phase;
                point = response.resolve(&start, false, interrupt)?;
            }
            return Ok(point.filter(is_inside).map(|point| Entered { point, dropped: None }));
        };
        let symmetric = dropped(set, guess, ABSENT);
        let seek = |first: &[f64]| response.null_direction(&start, first, interrupt);
        let Some((null, dropped)) = null_vector(set, n, 0, symmetric, seek)? else {
            return Ok(None);
        };
        start.tangent = null;
        for t in &mut start.tangent {
            *t *= sense;
        }
        let size = norm(guess);
        for distance in DISTANCES {
            let mut near = start.try_clone()?;
            for (v, t) in near.v[..n].iter_mut().zip(&start.tangent) {
                *v += distance * size * t;
            }
            let Some(mut point) = response.resolve(&near, false, interrupt)? else {
                continue;
            };
            let u = point.unknowns();
            let fell_back = |dropped: Dropped| dropped.dot(set, u, u).sqrt() <= ONE_SOLUTION * norm(u);
            if !is_inside(&point) || dropped.is_some_and(fell_back) {
                continue;
            }
            let metric = Metric::along(norm(point.unknowns()), settings);
            if metric.dot(&point.tangent, &start.tangent) < 0.0 {
                point.reverse();
            }
            return Ok(Some(Entered { point, dropped }));
        }
        Ok(None)
    }
}

/// The settings with the range in the direction in which a point is followed.
pub(crate) fn in_sense_of(point: &Point, settings: Settings) -> Settings {
    let (low, high) = (settings.start.min(settings.end), settings.start.max(settings.end));
    let rises = point.tangent[point.tangent.len() - 1] >= 0.0;
    let (start, end) = if rises { (low, high) } else { (high, low) };
    Settings { start, end, ..settings }
}

/// The null vector of a motion that may have a symmetry; and the harmonics that the motion lacks, where the vector
/// lies in these alone. `None` where no iteration converges. Among motions without these harmonics another symmetry
/// may break: the smaller eigenvalue decides. There are `n` unknowns, the last `others` of which are no motions.
pub(crate) fn null_vector(
    set: &HarmonicSet,
    n: usize,
    others: usize,
    symmetric: Option<Dropped>,
    mut seek: impl FnMut(&[f64]) -> Result<Option<(Vec<f64>, f64)>>,
) -> Result<Option<(Vec<f64>, Option<Dropped>)>> {
    let mut among = |dropped| -> Result<Option<(Vec<f64>, f64)>> {
        let mut first = start_vector(set, n - others, dropped)?;
        for _ in 0..others {
            try_push(&mut first, 0.0, CONTEXT)?;
        }
        seek(&first)
    };
    let broken = match symmetric {
        Some(_) => among(symmetric)?,
        None => None,
    };
    // A curve of a longer period has its harmonics: along any other vector it would be the motion's own one.
    if symmetric.is_some_and(|dropped| dropped.remainder == 1) {
        return Ok(broken.map(|(null, _)| (null, symmetric)));
    }
    let least = match (broken, among(None)?) {
        (Some(broken), Some(any)) if any.1 < OTHER_SYMMETRY * broken.1 => any,
        (Some(broken), _) => broken,
        (None, Some(any)) => any,
        (None, None) => return Ok(None),
    };
    let (null, _) = least;
    let motion = &null[..n - others];
    let is_broken = |dropped: &Dropped| dropped.dot(set, motion, motion) > 0.5 * norm(&null).powi(2);
    let dropped = symmetric.filter(is_broken);
    Ok(Some((null, dropped)))
}

/// The harmonics that a motion of this set lacks, if these are all odd or all even multiples of its lowest one.
pub(crate) fn dropped(set: &HarmonicSet, motion: &[f64], absent: f64) -> Option<Dropped> {
    let all = norm(motion);
    [1, 0].into_iter().find_map(|remainder| {
        let dropped = Dropped {
            base: set.base(),
            remainder,
        };
        let has_some = set.numbers().iter().any(|h| dropped.has(*h));
        let part = dropped.dot(set, motion, motion).sqrt();
        (has_some && part <= absent * all).then_some(dropped)
    })
}

/// A start vector for the null vector, in the harmonics that the motion lacks, if any.
fn start_vector(set: &HarmonicSet, n: usize, dropped: Option<Dropped>) -> Result<Vec<f64>> {
    let mut start = try_vec(n, 0.0, CONTEXT)?;
    // Multiples of the golden section modulo 1: without a pattern that a model may have.
    for (i, x) in start.iter_mut().enumerate() {
        *x = ((i + 1) as f64 * 0.618_033_988_749_894_9).fract() - 0.5;
    }
    let Some(dropped) = dropped else {
        return Ok(start);
    };
    let all = try_copy(&start, CONTEXT)?;
    start.fill(0.0);
    let m = set.packed_len().max(1);
    for (to, from) in start.chunks_exact_mut(m).zip(all.chunks_exact(m)) {
        for (i, h) in set.numbers().iter().enumerate() {
            if dropped.has(*h) {
                set.set(to, i, set.get(from, i));
            }
        }
    }
    Ok(start)
}
