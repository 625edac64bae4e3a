//! The five traits by which the tracer follows the branch of an analysis.

use crate::continuation::{Point, PointAt};
use crate::error::Result;
use crate::harmonics::Estimate;
use crate::harmonics::harmonic_levels::HarmonicLevels;
use crate::interrupt::Interrupt;
use crate::model::natural_modes::resonances::Resonance;
use crate::options::Range;
use crate::problem::Problem;
use crate::problem::gauges::Seen;
use crate::results::{Branch, SpecialKind, Verdict};

/// An estimate, with the one error that the tolerance bounds; NaN if unknown.
pub(crate) struct Assessment {
    pub error: f64,
    pub estimate: Estimate,
}

/// The equations of an analysis at its current resolution.
pub(crate) trait Discretised {
    /// The problem that is solved.
    fn problem(&mut self) -> &mut dyn Problem;

    /// The resolutions to choose from.
    fn levels(&self) -> &HarmonicLevels<'_>;

    /// Index of the current resolution.
    fn resolution(&self) -> usize;

    /// Makes a resolution the current one.
    fn select(&mut self, resolution: usize) -> Result<()>;

    /// Turns a point of the resolution `from` into the current harmonics; it need not be a solution there.
    fn transfer(&self, point: &Point, from: usize) -> Result<Point>;

    /// Turns a point of the resolution `from` into the current harmonics, with the motions of the corrected solution
    /// of its error estimate.
    fn transfer_corrected(&self, point: &Point, from: usize, estimate: &Estimate) -> Result<Point>;

    /// Solves near a point with the current harmonics, see [`crate::continuation::resolve`].
    fn resolve(&mut self, near: &Point, keep_parameter: bool, interrupt: &Interrupt<'_>) -> Result<Option<Point>>;

    /// Bounds the next estimate by half of the last one's work, after an estimate that told nothing: the next one is
    /// of the same motion with more harmonics.
    fn share_work(&mut self) {}

    /// Estimates the error of a solved point of the current resolution; `None` unless requested.
    fn estimate(&mut self, point: &Point) -> Result<Option<Assessment>>;

    /// A second, dearer estimate of a point whose error the first one left unknown; `None` where there is none, or it tells nothing.
    fn estimate_again(&mut self, _point: &Point) -> Result<Option<Assessment>> {
        Ok(None)
    }

    /// The share of the harmonics above half of the carried ones in the motion of a point, see
    /// [`crate::harmonics::estimate_spacing`].
    fn share_of_highest(&self, point: &Point) -> f64;

    /// Uses the last estimate for another point of the current resolution, its errors times a factor. `false` where
    /// the point must be estimated: where the caller requests every estimate, or nothing is nonlinear.
    fn take_over_estimate(&mut self, point: &Point, factor: f64) -> Result<bool>;
}

/// The linear parts of a curve: resonances and solutions with every contact in a linear state.
pub(crate) trait LinearParts {
    /// The resonances between two parameter values with the contacts in their linear state; `None` where they cannot
    /// be computed, or the response with linear contacts is not a rational function of the parameter.
    fn resonances(&mut self, _range: Range) -> Result<Option<Vec<Resonance>>> {
        Ok(None)
    }

    /// The solution at a parameter value with every contact in the linear state that it has at `near`, followed in the
    /// sense of the parameter; `None` if a contact leaves that state.
    fn linear_at(&mut self, _near: &Point, _parameter: f64, _interrupt: &Interrupt<'_>) -> Result<Option<Point>> {
        Ok(None)
    }

    /// Selects the most accurate evaluation for [`Self::linear_at`]; `false` if that is the ordinary one.
    fn set_accurate(&mut self, _accurate: bool) -> bool {
        false
    }

    /// Largest share of its linear range that a contact uses at a point.
    fn linear_share(&mut self, _point: &Point) -> Result<f64> {
        Ok(f64::NAN)
    }

    /// Whether every contact was linear at the last recorded point of the curve, and the analysis follows it as a
    /// linear response.
    fn is_linear(&self) -> bool {
        false
    }
}

/// Stability, branch points and other starts of a curve.
pub(crate) trait Judged {
    /// The observed amplitude at which the motion needs neither force nor artificial damping; `None` where there is no
    /// such motion.
    fn level_of_limit_cycles(&self) -> Option<f64> {
        None
    }

    /// Stability of a solved point of the current resolution; `None` unless requested.
    fn verdict(&mut self, _point: &Point) -> Result<Option<Verdict>> {
        Ok(None)
    }

    /// Whether branch points are sought by the sign of the equations, not by stability.
    fn seeks_branch_points(&self) -> bool {
        false
    }

    /// Whether a solution at any parameter may be sought as the first one was. For a nonlinear mode this could find
    /// another mode.
    fn may_start_anywhere(&self) -> bool {
        false
    }

    /// Stability of the last two points of the curve, in their order; only at the first call after the last one was
    /// recorded. `None` where stability is not computed.
    fn take_verdicts(&mut self) -> Option<(Verdict, Verdict)> {
        None
    }
}

/// Responses whose peaks and values are sought beside the observed amplitude.
pub(crate) trait Observed {
    /// Further responses whose peaks are sought.
    fn further_responses(&self) -> core::ops::Range<usize> {
        0..0
    }

    /// Whether peaks of the amplitude that the problem observes are sought.
    fn observes_peaks(&self) -> bool {
        true
    }

    /// A point of a resolution with amplitude and slope of a further response in place of the observed ones.
    fn seen_by(&mut self, _response: usize, (point, _resolution): PointAt<'_>) -> Result<Point> {
        point.try_clone()
    }

    /// Number of requested responses.
    fn responses(&self) -> usize {
        0
    }

    /// The value of a response at a point of a resolution; `None` where the response has no instant of an extreme.
    fn reading_of(&mut self, _response: usize, (_point, _resolution): PointAt<'_>) -> Result<Option<Seen>> {
        Ok(None)
    }
}

/// Storage of the points of an analysis.
pub(crate) trait Recorder {
    /// Records a solved point of the current resolution as the next one of the curve.
    fn record(&mut self, point: &Point) -> Result<()>;

    /// Solves a point beside the curve as accurately as possible, and leaves the problem evaluated at this point.
    fn sharpen(&mut self, kind: SpecialKind, point: &mut Point) -> Result<()>;

    /// Records a sharpened point beside the curve.
    fn record_special(&mut self, kind: SpecialKind, point: &Point) -> Result<()>;

    /// Factor by which more samples of the laws without exact events are required to meet the tolerance; 1 if none
    /// are.
    fn sampling_factor(&self) -> usize;

    /// The branch with the points that were recorded.
    fn branch(&self) -> &Branch;
}

/// An analysis that can be followed along its branch.
pub(crate) trait Traceable: Discretised + LinearParts + Judged + Observed + Recorder {}

impl<T: Discretised + LinearParts + Judged + Observed + Recorder> Traceable for T {}
