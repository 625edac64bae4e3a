//! The end of a correction without an evaluation, foreseen from the corrections before.
//!
//! Near a solution Newton's method leaves of the relative residual r₀, and of the step s₀ over the motion,
//!
//! > r₁ ≤ q r₀²,  s₁ ≤ p s₀²
//!
//! (Deuflhard, Newton Methods for Nonlinear Problems, 2004, §2.1 and §2.2), where p and q hardly change from one point of a branch
//! to the next. They are measured wherever a first step is followed by an evaluation, or between two iterations of one correction,
//! whose second step is then foreseen. Where both bounds, with a margin, are within the tolerance, the point behind the step is a
//! solution, and need not be evaluated: residuals alone are small far from solutions, too, where a resonance has little damping.
//! Where contacts begin to slip or to lift off, the matrix changes with the square root of the motion, and r₁ with r₀ to the power
//! 3/2: residuals from which a step is foreseen are small enough for that, too.

use core::array::from_fn;

/// Margin of the bounds.
/// Kind: tuned; measured on: not recorded.
const CONTRACTION_MARGIN: f64 = 100.0;

/// Margin of the residual r₀ to the power 3/2 that the onset of a slip within the step would leave.
/// Kind: tuned; measured on: one slider with 5 and with 64 odd harmonics.
const ONSET_MARGIN: f64 = 10.0;

/// Ends in a row that are foreseen, after which the contraction is measured again.
/// Kind: tuned; measured on: not recorded.
const MOST_FORESEEN: usize = 20;

/// From what the end of a correction may be foreseen.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Foresight {
    /// It is evaluated.
    None,
    /// From two of its own iterations: its tangent is as exact as the last of them is near.
    WithinCorrection,
    /// From the corrections before, on the same smooth branch.
    AlongBranch,
}

/// Relative residual, and length of the Newton step from this point over the motion.
pub(super) type Sizes = [f64; 2];

/// Contraction rates of Newton's method along a branch, by which the end of a correction is foreseen.
#[derive(Clone, Copy)]
pub(super) struct Contraction {
    /// Rates q and p as measured last.
    rates: Sizes,
    /// Number of ends foreseen since the last measurement.
    foreseen: usize,
}

impl Contraction {
    /// Rates before anything was measured: infinite.
    pub const UNKNOWN: Self = Self {
        rates: [f64::INFINITY; 2],
        foreseen: 0,
    };

    /// Measures the rates from the sizes before and after a step.
    pub fn measure(&mut self, before: Sizes, behind: Sizes) {
        *self = Self::between(before, behind);
    }

    /// The contraction by a step, from the sizes before and after it.
    pub fn between(before: Sizes, behind: Sizes) -> Self {
        Self {
            rates: from_fn(|i| behind[i] / (before[i] * before[i])),
            foreseen: 0,
        }
    }

    /// Bound of the residual after a step that leaves a share `left` of the sizes; `None` where the residual, or the step that
    /// would follow, may exceed the tolerance.
    pub fn foresee_within(&self, sizes: Sizes, left: f64, tolerance: f64) -> Option<f64> {
        let bounds: Sizes = from_fn(|i| (CONTRACTION_MARGIN * self.rates[i].max(1.0) * sizes[i] + left) * sizes[i]);
        // A comparison with NaN is false.
        let is_known =
            bounds.iter().all(|bound| *bound <= tolerance) && ONSET_MARGIN * sizes[0] * sizes[0].sqrt() <= tolerance;
        is_known.then_some(bounds[0])
    }

    /// Bound of the residual after a step; `None` where the residual, or the step that would follow, may exceed the
    /// tolerance.
    pub fn foresee(&mut self, sizes: Sizes, tolerance: f64) -> Option<f64> {
        let bound = self
            .foresee_within(sizes, 0.0, tolerance)
            .filter(|_| self.foreseen < MOST_FORESEEN);
        self.foreseen += usize::from(bound.is_some());
        bound
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::condense::Condensed;
    use crate::condense::test_chains::structure;
    use crate::contact::Contact;
    use crate::continuation::Metric;
    use crate::continuation::corrector::{Corrector, Outcome};
    use crate::interrupt::Interrupt;
    use crate::linalg::norm;
    use crate::model::Model;
    use crate::options::SolverOptions;
    use crate::problem::harmonic_balance::HarmonicBalance;

    const TOLERANCE: f64 = 1e-10;
    const METRIC: Metric = Metric { u: 1.0, p: 0.5 };

    /// Numbers of points of a branch, met from beside it, and of those that were foreseen.
    fn followed(model: &Model, samples: usize, foresight: Foresight) -> (usize, usize) {
        let is_within = foresight == Foresight::WithinCorrection;
        let interrupt = Interrupt::none();
        let options = SolverOptions {
            harmonics: 5,
            samples,
            ..SolverOptions::default()
        };
        let range = (0.1, 0.6);
        let condensed = Condensed::new(model, &options, range, &interrupt).unwrap();
        let mut problem = HarmonicBalance::new(&condensed, 8, range.into(), samples, None, &interrupt).unwrap();
        let n = problem.unknowns();
        let mut exact = Corrector::new(n, TOLERANCE, 30).unwrap();
        let mut quick = Corrector::new(n, TOLERANCE, 30).unwrap();
        quick.set_foresight(foresight);
        let mut row = vec![0.0; n + 1];
        row[n] = 1.0;
        let (mut v, mut met, mut foreseen) = (vec![0.0; n + 1], 0, 0);
        for k in 0..400_usize {
            v[n] = 0.1 + 0.00125 * k as f64;
            match exact
                .correct(&mut problem, &mut v, &row, METRIC, false, &interrupt)
                .unwrap()
            {
                Outcome::Converged(_) => {}
                Outcome::Failed => {
                    v.fill(0.0);
                    continue;
                }
            }
            let mut near = v.clone();
            let farthest = if is_within { -2 } else { -6 };
            let size = norm(&v[..n]) * 10.0_f64.powi(farthest - (k % 5) as i32);
            for (i, x) in near[..n].iter_mut().enumerate() {
                *x += size * ((i * 7 + k * 3) as f64).sin();
            }
            let known = quick.contraction;
            let (begin, steps) = (near.clone(), quick.steps_taken());
            let outcome = quick.correct(&mut problem, &mut near, &row, METRIC, false, &interrupt);
            let Outcome::Converged(found) = outcome.unwrap() else {
                assert!(is_within || quick.contraction.rates[0].is_infinite());
                continue;
            };
            assert!(found.residual <= TOLERANCE);
            met += 1;
            if quick.contraction.foreseen > known.foreseen {
                assert_eq!(found.iterations, 0);
                assert!(known.rates[0].is_finite() && known.foreseen < MOST_FORESEEN);
                foreseen += 1;
            }
            if is_within {
                let (mut other, steps) = (begin, quick.steps_taken() - steps);
                let of_exact = exact.steps_taken();
                let evaluated = exact.correct(&mut problem, &mut other, &row, METRIC, false, &interrupt);
                let Outcome::Converged(evaluated) = evaluated.unwrap() else {
                    panic!("{k}: no solution where every iteration is evaluated");
                };
                // A step whose end is foreseen is taken without an evaluation behind it, and counts all the same.
                assert_eq!(found.iterations, evaluated.iterations, "{k}");
                foreseen += usize::from(steps < exact.steps_taken() - of_exact);
                // Both are the same solution.
                let apart: Vec<f64> = near[..n].iter().zip(&other).map(|(a, b)| a - b).collect();
                assert!(norm(&apart) <= 1e-9 * norm(&other[..n]), "{k}");
            }
            exact.evaluate(&mut problem, &near).unwrap();
            assert!(exact.relative_residual() <= found.residual.max(1e-14), "{k}");
        }
        (met, foreseen)
    }

    #[test]
    fn residuals_behind_steps_are_within_their_bounds() {
        // The slider sticks under the largest load, and slips under the others.
        let sliders = [1.0, 0.3, 0.03].map(|preload| (Contact::jenkins(1, Some(4), 9.0, 0.3, preload), 2e-3));
        let stop = (Contact::unilateral(Some(1), Some(4), 9.0, 0.2), 2e-2);
        for (contact, damping) in sliders.into_iter().chain([stop]) {
            let mut model = structure(1, (0.0, damping));
            model.add_contact(&contact).unwrap();
            let (met, foreseen) = followed(&model, 0, Foresight::AlongBranch);
            assert!(foreseen > 100 && foreseen < met, "{foreseen} of {met}");
            assert_eq!(followed(&model, 64, Foresight::AlongBranch).1, 0);
        }
    }

    #[test]
    fn a_correction_foresees_its_own_end_where_a_slider_slips() {
        for preload in [0.3, 0.03, 0.003] {
            let mut model = structure(1, (0.0, 2e-3));
            model
                .add_contact(&Contact::jenkins(1, Some(4), 9.0, 0.3, preload))
                .unwrap();
            let (met, foreseen) = followed(&model, 0, Foresight::WithinCorrection);
            assert!(foreseen > 100 && foreseen < met, "{foreseen} of {met}");
            assert_eq!(followed(&model, 64, Foresight::WithinCorrection).1, 0);
        }
    }
}
