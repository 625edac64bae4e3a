//! A branch whose sense is lost on purpose at a change of harmonics: it is turned round, or ends with the reason.

use super::follow;
use crate::analysis::forced::forced_discretised::ForcedDiscretised;
use crate::condense::by_modes::wave_cache::SharedWaves;
use crate::contact::Contact;
use crate::continuation::Point;
use crate::continuation::step_control::Detail;
use crate::error::{Result, Status};
use crate::harmonics::Estimate;
use crate::harmonics::discretised::{Assessment, Discretised, Judged, LinearParts, Observed, Recorder};
use crate::harmonics::harmonic_levels::HarmonicLevels;
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::Interrupt;
use crate::linalg::sparse_storage::matrix_view::MatrixView;
use crate::model::Model;
use crate::model::matrices::structure::MatrixKind;
use crate::model::natural_modes::resonances::Resonance;
use crate::options::Range;
use crate::options::{ForcedOptions, SolverOptions};
use crate::problem::Problem;
use crate::results::{Branch, SpecialKind};

/// Test equations of a forced response that reverse the sense of one resolved point.
struct Misled<'a, 'b> {
    response: &'a mut ForcedDiscretised<'b>,
    /// Number of points of the branch after which the sense of the next resolved point is reversed.
    at: usize,
    /// Number of solutions that are found after this, before all others are refused.
    found_then: usize,
    reversed: bool,
}

impl Discretised for Misled<'_, '_> {
    fn problem(&mut self) -> &mut dyn Problem {
        self.response.problem()
    }

    fn levels(&self) -> &HarmonicLevels<'_> {
        self.response.levels()
    }

    fn resolution(&self) -> usize {
        self.response.resolution()
    }

    fn select(&mut self, resolution: usize) -> Result<()> {
        self.response.select(resolution)
    }

    fn transfer(&self, point: &Point, from: usize) -> Result<Point> {
        self.response.transfer(point, from)
    }

    fn transfer_corrected(&self, point: &Point, from: usize, estimate: &Estimate) -> Result<Point> {
        self.response.transfer_corrected(point, from, estimate)
    }

    fn resolve(&mut self, near: &Point, keep_parameter: bool, interrupt: &Interrupt<'_>) -> Result<Option<Point>> {
        let found = self.response.resolve(near, keep_parameter, interrupt)?;
        if self.reversed {
            if self.found_then == 0 {
                return Ok(None);
            }
            self.found_then -= 1;
            return Ok(found);
        }
        self.reversed = found.is_some() && keep_parameter && self.branch().points() >= self.at;
        Ok(found.map(|mut point| {
            if self.reversed {
                point.reverse();
            }
            point
        }))
    }

    fn estimate(&mut self, point: &Point) -> Result<Option<Assessment>> {
        self.response.estimate(point)
    }

    fn share_of_highest(&self, point: &Point) -> f64 {
        self.response.share_of_highest(point)
    }

    fn take_over_estimate(&mut self, point: &Point, factor: f64) -> Result<bool> {
        self.response.take_over_estimate(point, factor)
    }
}

impl LinearParts for Misled<'_, '_> {
    fn resonances(&mut self, range: Range) -> Result<Option<Vec<Resonance>>> {
        self.response.resonances(range)
    }

    fn linear_at(&mut self, near: &Point, parameter: f64, interrupt: &Interrupt<'_>) -> Result<Option<Point>> {
        self.response.linear_at(near, parameter, interrupt)
    }

    fn set_accurate(&mut self, accurate: bool) -> bool {
        self.response.set_accurate(accurate)
    }

    fn linear_share(&mut self, point: &Point) -> Result<f64> {
        self.response.linear_share(point)
    }

    fn is_linear(&self) -> bool {
        self.response.is_linear()
    }
}

impl Judged for Misled<'_, '_> {}

impl Observed for Misled<'_, '_> {}

impl Recorder for Misled<'_, '_> {
    fn record(&mut self, point: &Point) -> Result<()> {
        self.response.record(point)
    }

    fn sharpen(&mut self, kind: SpecialKind, point: &mut Point) -> Result<()> {
        self.response.sharpen(kind, point)
    }

    fn record_special(&mut self, kind: SpecialKind, point: &Point) -> Result<()> {
        self.response.record_special(kind, point)
    }

    fn sampling_factor(&self) -> usize {
        self.response.sampling_factor()
    }

    fn branch(&self) -> &Branch {
        self.response.branch()
    }
}

/// Three masses with two sliders, whose third natural frequency is three times the excited one.
fn model() -> Model {
    let stiffness = [2.2, -1.0, 0.0, -1.0, 2.1, -1.0, 0.0, -1.0, 1.3];
    let mut model = Model::new(3).unwrap();
    for (kind, values) in [
        (MatrixKind::Mass, [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]),
        (MatrixKind::Damping, stiffness.map(|k| 0.001 * k)),
        (MatrixKind::Stiffness, stiffness),
    ] {
        model.set_matrix(kind, &MatrixView::dense(3, &values)).unwrap();
    }
    model.add_contact(&Contact::jenkins(0, None, 0.3, 1.0, 0.1)).unwrap();
    model.add_contact(&Contact::jenkins(2, None, 0.2, 1.0, 0.05)).unwrap();
    model.add_force(0, 1, 0.2.into()).unwrap();
    model
}

/// The branch with the sense of a point reversed from the `at`-th on; and whether the log reports a correction.
fn misled(at: usize, found_then: usize, (from, to): (f64, f64)) -> (Branch, bool) {
    let range = ForcedOptions {
        omega_start: from,
        omega_stop: to,
        ..ForcedOptions::default()
    };
    let mut corrected = false;
    let mut log = |_: LogLevel, line: &str| corrected |= line.contains("its sense was corrected");
    let mut hooks = Hooks {
        log: Some(&mut log),
        ..Hooks::default()
    };
    let interrupt = Interrupt::none();
    let solver = SolverOptions {
        response_dof: Some(0),
        ..SolverOptions::default()
    };
    let branch = follow(
        &model(),
        &solver,
        (&range, Detail::Curve, None),
        (&SharedWaves::default(), &mut hooks),
        &interrupt,
        |tracer, response, first, hooks| {
            let mut misled = Misled {
                response,
                at,
                found_then,
                reversed: false,
            };
            tracer.trace(&mut misled, first, hooks)
        },
    );
    (*branch.unwrap().unwrap(), corrected)
}

#[test]
fn a_branch_that_comes_back_along_its_own_points_is_turned_round() {
    let mut all = 0;
    for range in [(0.5, 1.3), (1.3, 0.5)] {
        for at in (2..60).step_by(3) {
            let (branch, corrected) = misled(at, usize::MAX, range);
            all += usize::from(corrected);
            assert_eq!(branch.status(), Status::Ok, "{at}: {:?}", branch.reason());
            assert!(branch.folds().is_empty(), "{at}");
            let sense = range.1 - range.0;
            assert!(branch.omega().windows(2).all(|w| (w[1] - w[0]) * sense > 0.0), "{at}");
            let top = branch.peaks().iter().fold(0.0_f64, |m, p| m.max(p.amplitude));
            assert!((top - 0.8492).abs() < 1e-4, "{at}: {top}");
        }
    }
    println!("{all} branches turned round");
    assert!(all > 10, "{all}");
}

#[test]
fn a_branch_that_cannot_be_turned_round_ends_with_the_reason() {
    let mut all = 0;
    for at in (2..60).step_by(3) {
        let (branch, corrected) = misled(at, 1, (0.5, 1.3));
        assert!(branch.folds().is_empty() && !corrected, "{at}");
        let Some(reason) = branch.reason() else { continue };
        assert_eq!(branch.status(), Status::StoppedStepTooSmall);
        assert!(
            reason.message().contains("came back along its own points"),
            "{reason:?}"
        );
        all += 1;
    }
    assert!(all > 5, "{all}");
}
