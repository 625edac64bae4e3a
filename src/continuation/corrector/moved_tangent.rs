//! The tangent at a point that is met as predicted.
//!
//! The matrix K belongs to the predicted point, from which Newton's last step s leads to the solution with another tangent: with a
//! right-hand side b it solves K x + R″(s, x) = b. A prediction from many points multiplies errors of their tangents by some
//! hundreds, so that the second term matters long before it is seen elsewhere. K changes by R″ along the branch, too: with the
//! derivative K′ by the place along the row, from the matrices at two points before, and a tangent whose product with the row is 1,
//!
//! > R″(s, x) ≈ K′ s
//!
//! up to a share that falls with the square of the steps.

use crate::continuation::Metric;
use core::array::from_fn;

/// Least share of the way between two points that leads along the row.
/// Kind: tuned; measured on: not recorded.
const MOVED_TANGENT_ALONG: f64 = 0.9;

/// Least ratio of the way between the two points before to that from the last one.
/// Kind: tuned; measured on: not recorded.
const APART: f64 = 0.1;

/// Largest step over the way from the last point: the branch may have had a corner there. Below the least one tangents are exact
/// enough to predict residuals far below those from which a step is foreseen.
/// Kind: tuned; measured on: not recorded.
const MOVED_TANGENT_SMALL: f64 = 1e-6;
const MOVED_TANGENT_NEGLIGIBLE: f64 = 1e-9;

/// Weights of the current matrix and of those at the two points before, given with their points, in the slope K′ of a step
/// whose length is given; `None` where they do not belong to one branch.
pub(super) fn slope_weights(
    [here, before, oldest]: &[Vec<f64>; 3],
    step: f64,
    metric: Metric,
    row: &[f64],
) -> Option<[f64; 3]> {
    let way = |from: &[f64], to: &[f64]| {
        let way = metric.along_row(from, to, row);
        (way > MOVED_TANGENT_ALONG * metric.distance(from, to)).then_some(way)
    };
    let is_small = |last: &f64| (MOVED_TANGENT_NEGLIGIBLE * last..=MOVED_TANGENT_SMALL * last).contains(&step);
    let last = way(before, here).filter(is_small)?;
    let slope = [1.0 / last, -1.0 / last, 0.0];
    let Some(first) = way(oldest, before).filter(|first| *first > APART * last) else {
        return Some(slope);
    };
    let (share, earlier) = (last / (last + first), [0.0, 1.0 / first, -1.0 / first]);
    Some(from_fn(|i| slope[i] + share * (slope[i] - earlier[i])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::condense::Condensed;
    use crate::condense::test_chains::structure;
    use crate::contact::Contact;
    use crate::continuation::corrector::{Corrector, Outcome};
    use crate::interrupt::Interrupt;
    use crate::linalg::norm;
    use crate::options::SolverOptions;
    use crate::problem::Problem;
    use crate::problem::harmonic_balance::HarmonicBalance;

    const METRIC: Metric = Metric { u: 1.0, p: 0.5 };

    fn corrected(
        corrector: &mut Corrector,
        problem: &mut dyn Problem,
        v: &mut [f64],
        row: &[f64],
    ) -> (usize, Vec<f64>) {
        match corrector
            .correct(problem, v, row, METRIC, false, &Interrupt::none())
            .unwrap()
        {
            Outcome::Converged(found) => (found.iterations, found.tangent),
            Outcome::Failed => panic!("no solution near {v:?}"),
        }
    }

    #[test]
    fn the_tangent_is_that_behind_the_last_step() {
        let interrupt = Interrupt::none();
        let mut model = structure(1, (0.0, 2e-2));
        model.add_contact(&Contact::jenkins(1, Some(4), 9.0, 0.3, 1.0)).unwrap();
        let options = SolverOptions {
            harmonics: 5,
            ..SolverOptions::default()
        };
        let range = (0.1, 0.6);
        let condensed = Condensed::new(&model, &options, range, &interrupt).unwrap();
        let mut problem = HarmonicBalance::new(&condensed, 8, range.into(), 0, None, &interrupt).unwrap();
        let n = problem.unknowns();
        // A loose tolerance, so that steps from points beside the branch are far above rounding.
        let (mut exact, mut quick) = (
            Corrector::new(n, 1e-10, 20).unwrap(),
            Corrector::new(n, 1e-6, 20).unwrap(),
        );
        let mut v = vec![0.0; n + 1];
        v[n] = 0.2;
        let mut row = vec![0.0; n + 1];
        row[n] = 1.0;
        let (_, mut tangent) = corrected(&mut exact, &mut problem, &mut v, &row);
        let (mut compared, mut gain) = (0, 0.0);
        for k in 0..200_usize {
            METRIC.unit(&tangent, &mut row);
            let step = 2e-3 * (1.5 + (k as f64).sin());
            METRIC.add(&mut v, step, &row);
            (_, tangent) = corrected(&mut exact, &mut problem, &mut v, &row);
            // Another tangent of the same plane, from a point beside the branch.
            let mut near = v.clone();
            let size = 3e-8 * norm(&v[..n]);
            for (i, x) in near[..n].iter_mut().enumerate() {
                *x += size * ((i * 7 + k * 3) as f64).sin();
            }
            let mut still = vec![0.0; n + 1];
            let moved = exact.direction_at(&mut problem, &near, &row, METRIC, &mut still, &interrupt);
            assert!(moved.unwrap().is_some());
            let (iterations, found) = corrected(&mut quick, &mut problem, &mut near, &row);
            let gap = |a: &[f64]| METRIC.distance(a, &tangent);
            if iterations == 0 && k > 2 && gap(&still) > 1e-9 {
                compared += 1;
                gain += (gap(&still) / gap(&found)).ln();
            }
        }
        assert!(compared > 50, "{compared}");
        let gain = (gain / f64::from(compared)).exp();
        assert!(gain > 10.0, "{gain}");
    }
}
