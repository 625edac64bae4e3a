//! Curves of a forced response without connection to the branch, by curves of its peaks and folds over the force.
//!
//! The peak of a response, the minimum on a detached curve and the peak of that are one curve over the force, which turns where the
//! detached curve merges with the response and where it is born ([`crate::sensitivity::extremum_point`]). Folds of one curve over the
//! force meet where it is born, or has merged ([`crate::sensitivity::fold_point`]). Wherever such a curve comes back to the force
//! itself, its solution is a start. No nonlinear mode is needed, and forces may act in any harmonic.

use crate::analysis::other_solutions::branch_switching::{Found, Tree};
use crate::analysis::other_solutions::detached_curves::tolerate;
use crate::analysis::over_parameter::parameter_range::{Follow, ParameterRange};
use crate::analysis::over_parameter::parameter_response::follow_from;
use crate::continuation::ONE_SOLUTION;
use crate::error::{Result, Status, try_push};
use crate::hooks::{Hooks, LogLevel};
use crate::options::SolverOptions;
use crate::results::{Branch, Descent, ParameterData, Recovery, Special, Turn};
use crate::sensitivity::{Parameter, ResponsePoint};
use num_complex::Complex64;

const CONTEXT: &str = "the curves over the force";

/// Factors of all forces between which peaks and folds are followed.
/// Kind: tuned; measured on: not recorded.
const OVER_FORCE_FACTORS: (f64, f64) = (0.1, 10.0);

/// Most peaks, the highest ones, and most folds that are followed, and most points of each curve.
/// Kind: cap.
const OVER_FORCE_MOST: (usize, usize) = (4, 8);
const OVER_FORCE_MOST_POINTS: usize = 400;

/// Unknowns of a point above which none is followed: its equations are dense, and are condensed at each evaluation.
/// Kind: cap.
const OVER_FORCE_MOST_UNKNOWNS: usize = 200;

/// A solution at the nominal force, with the nearest factors of the force at which its curve is born and merges.
struct Crossing {
    omega: f64,
    amplitude: f64,
    motion: Vec<Complex64>,
    born: f64,
    merges: f64,
}

impl Tree<'_> {
    /// Adds the detached curves to which peaks and folds lead over the force, with their children, down to `depth`.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`; those of callbacks.
    pub fn add_over_force(&mut self, branch: &mut Branch, depth: usize, hooks: &mut Hooks<'_>) -> Result<()> {
        let unknowns = branch.motion_at(0).map_or(0, <[f64]>::len);
        if unknowns > OVER_FORCE_MOST_UNKNOWNS || self.solver.samples > 0 {
            hooks.log(
                LogLevel::Info,
                "peaks and folds are not followed over the force: too many unknowns, or sampled forces",
            );
            return Ok(());
        }
        for (kind, point) in starts(branch)? {
            let (low, high) = OVER_FORCE_FACTORS;
            for ends in [(low, high), (high, low)] {
                if self.left == 0 {
                    return Ok(());
                }
                self.searched.force_curves += 1;
                match self.crossings(branch, kind, point, ends, hooks) {
                    Ok(found) => {
                        // The curve begins at a known solution.
                        let is_first = |c: &Crossing| (c.omega - point.omega).abs() <= ONE_SOLUTION * point.omega;
                        for crossing in found.iter().skip_while(|c| is_first(c)) {
                            self.searched.crossings += 1;
                            self.add_crossing(branch, crossing, depth, hooks)?;
                        }
                    }
                    Err(e) => {
                        self.searched.incomplete_force_curves += 1;
                        tolerate(e, hooks)?;
                    }
                }
            }
        }
        Ok(())
    }

    /// The solutions at the nominal force on a curve over the force, followed from a peak or a fold of the branch
    /// towards the second of two factors.
    fn crossings(
        &mut self,
        branch: &Branch,
        kind: ResponsePoint,
        special: Special,
        (start, stop): (f64, f64),
        hooks: &mut Hooks<'_>,
    ) -> Result<Vec<Crossing>> {
        let range = ParameterRange {
            start,
            stop,
            at: &[1.0],
            follow: Follow::PeakThroughFolds(special.omega),
            response: None,
        };
        let solver = SolverOptions {
            stability: None,
            freedom: false,
            estimate_error: false,
            max_points: self.solver.max_points.min(OVER_FORCE_MOST_POINTS),
            step: 0.0,
            step_min: 0.0,
            step_max: 0.0,
            ..*self.solver
        };
        let models = (self.model, self.model, Parameter::Force);
        let mut data = ParameterData::default();
        let interrupt = hooks.interrupt();
        let mut quiet = hooks.quiet();
        let from = (branch, special.point, kind);
        let curve = follow_from(models, &solver, (&range, 1.0), from, &mut data, &mut quiet, &interrupt)?;
        if !matches!(curve.status(), Status::Ok | Status::StoppedLeftRange) {
            self.searched.incomplete_force_curves += 1;
        }
        let mut found = Vec::new();
        for at in curve.at(0) {
            let highest = curve.carried_at(at.point).and_then(|carried| carried.last().copied());
            let crossing = Crossing {
                omega: at.omega,
                amplitude: at.amplitude,
                motion: Recovery::at(&curve, at.point, &interrupt)?.all(highest.unwrap_or(1))?,
                born: nearest(data.turns(), at.point, false),
                merges: nearest(data.turns(), at.point, true),
            };
            try_push(&mut found, crossing, CONTEXT)?;
        }
        Ok(found)
    }

    /// Follows the curve through a solution, unless it is known. For a detached curve, birth and merging are
    /// reported.
    fn add_crossing(
        &mut self,
        branch: &mut Branch,
        crossing: &Crossing,
        depth: usize,
        hooks: &mut Hooks<'_>,
    ) -> Result<()> {
        let bound = ONE_SOLUTION.max(2.0 * self.solver.tolerance);
        let is_near = |a: f64, b: f64| (a - b).abs() <= bound * b.abs();
        for child in branch.children_mut() {
            let mut peaks = child.peaks().iter();
            let is_its = peaks.any(|p| is_near(p.omega, crossing.omega) && is_near(p.amplitude, crossing.amplitude));
            if let Some(descent) = child
                .descent()
                .filter(|descent| is_its && descent.bifurcation.is_none())
            {
                let known = |new: f64, old: f64| if new.is_nan() { old } else { new };
                child.set_descent(Descent {
                    born_at_force: known(crossing.born, descent.born_at_force),
                    merges_at_force: known(crossing.merges, descent.merges_at_force),
                    ..descent
                });
                return Ok(());
            }
        }
        let (low, high) = self.ends();
        if self.left == 0 || crossing.omega < low || crossing.omega > high {
            return Ok(());
        }
        let found = self.through(branch, (crossing.omega, &crossing.motion), hooks)?;
        let Found::Curve(mut found, _) = found else {
            return Ok(());
        };
        self.left -= 1;
        found.set_descent(Descent {
            born_at_force: crossing.born,
            merges_at_force: crossing.merges,
            ..Descent::default()
        });
        self.add(branch, found, (1, depth), hooks)
    }
}

/// The peaks of a branch, the highest first, and its folds, from which curves are followed.
fn starts(branch: &Branch) -> Result<Vec<(ResponsePoint, Special)>> {
    let mut peaks = Vec::new();
    for peak in branch.peaks() {
        try_push(&mut peaks, (ResponsePoint::Extremum, *peak), CONTEXT)?;
    }
    peaks.sort_by(|(_, a), (_, b)| b.amplitude.total_cmp(&a.amplitude));
    peaks.truncate(OVER_FORCE_MOST.0);
    for fold in branch.folds().iter().take(OVER_FORCE_MOST.1) {
        try_push(&mut peaks, (ResponsePoint::Fold, *fold), CONTEXT)?;
    }
    Ok(peaks)
}

/// Factor of the force at the turn of the given kind nearest to a point, by their positions along the curve; NaN
/// without such a turn.
fn nearest(turns: &[Turn], point: usize, is_maximum: bool) -> f64 {
    let of_kind = turns.iter().filter(|turn| turn.is_maximum == is_maximum);
    let nearest = of_kind.min_by_key(|turn| turn.point.abs_diff(point));
    nearest.map_or(f64::NAN, |turn| turn.parameter)
}
