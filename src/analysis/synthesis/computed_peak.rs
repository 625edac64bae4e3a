//! The computed resonance next to a synthesised one: the forced response with the harmonics of the mode, from the
//! motion of the mode.

use crate::analysis::forced::phase_direction::phase_direction;
use crate::analysis::synthesis::oscillator::{Load, State};
use crate::condense::Condensed;
use crate::condense::blocks::under_force::under_force;
use crate::continuation::corrector::{Corrector, Outcome};
use crate::continuation::special_points::{Locator, SpecialPoint};
use crate::continuation::step_control::StepControl;
use crate::continuation::{Advance, Continuation, Metric, Point, Settings};
use crate::error::{Result, Status, try_copy, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::options::Range;
use crate::problem::Problem;
use crate::problem::harmonic_balance::HarmonicBalance;
use num_complex::Complex64;

const CONTEXT: &str = "the computed resonance";

/// Half-power bandwidths on either side of the resonance within which the computed one is sought.
/// Kind: tuned; measured on: not recorded.
const BANDWIDTHS: f64 = 8.0;

/// Half-power bandwidths within which the motion with the phase of the resonance is of the same resonance. Several modes may have
/// a motion of this phase.
/// Kind: tuned; measured on: not recorded.
const COMPUTED_PEAK_NEAR: f64 = 0.5;

/// Most points of the response on the way to its peak.
/// Kind: cap.
const COMPUTED_PEAK_MOST_POINTS: usize = 100;

/// Largest step over the range of frequency: a sixth of the half-power bandwidth.
/// Kind: tuned; measured on: not recorded.
const COMPUTED_PEAK_STEP: f64 = 0.01;

/// A synthesised resonance, with the motion of the mode at that amplitude.
pub(crate) struct AtPeak<'a> {
    pub state: &'a State,
    /// Angular frequency of the force.
    pub omega: f64,
    /// The condensed mode, the samples of its laws, and the packed total motion in its units.
    pub condensed: &'a Condensed,
    pub samples: usize,
    pub motion: &'a [f64],
    /// Degree of freedom whose amplitudes are compared, in the caller's numbering.
    pub response_dof: usize,
}

/// Ratio of the synthesised amplitude to that of the computed resonance next to it, minus 1; NaN if none was found.
///
/// # Errors
/// `OutOfMemory`; those of callbacks that give up; `StoppedByCaller`.
pub(super) fn error(
    peak: &AtPeak<'_>,
    load: &Load,
    damping: impl Fn(usize) -> Result<Option<Csc>>,
    interrupt: &Interrupt<'_>,
) -> Result<f64> {
    match computed(peak, load, damping, interrupt) {
        Ok(Some(amplitude)) => Ok(peak.state.response.norm() / amplitude - 1.0),
        Ok(None) => Ok(f64::NAN),
        Err(e) if e.recoverable || matches!(e.status, Status::Singular | Status::NoConvergence) => Ok(f64::NAN),
        Err(e) => Err(e),
    }
}

fn computed(
    peak: &AtPeak<'_>,
    load: &Load,
    damping: impl Fn(usize) -> Result<Option<Csc>>,
    interrupt: &Interrupt<'_>,
) -> Result<Option<f64>> {
    let (state, omega) = (peak.state, peak.omega);
    let bandwidth = 2.0 * state.damping * omega;
    let width = BANDWIDTHS * bandwidth;
    if !(width > 0.0 && omega > 0.0) {
        return Ok(None);
    }
    let forced = under_force(peak.condensed, &load.force, damping, 2.0 * load.ratio * state.omega)?;
    let range = Range::new((omega - width).max(0.1 * omega), omega + width);
    let mut problem = HarmonicBalance::new(&forced, peak.response_dof, range, peak.samples, None, interrupt)?;
    let n = forced.unknowns();
    let settings = |range: Range| Settings {
        start: range.start,
        end: range.stop,
        tolerance: 1e-9,
        max_iterations: 25,
        steps: StepControl::new(0.0, 0.0, COMPUTED_PEAK_STEP),
    };
    let v = turned(peak, n)?;
    let near = Point {
        tangent: phase_direction(peak.condensed.set(), &v[..n])?,
        v,
        amplitude: Complex64::ZERO,
        slope: Complex64::ZERO,
        residual: 0.0,
        iterations: 0,
        step: 0.0,
        stalled: false,
        positive: true,
    };
    let upwards = settings(range);
    let mut corrector = Corrector::new(n, upwards.tolerance, upwards.max_iterations)?;
    let mut first = None;
    for keep_parameter in [false, true] {
        if first.is_none() {
            first = solve(&mut problem, &mut corrector, &upwards, &near, keep_parameter, interrupt)?;
            first = first.filter(|first| (first.parameter() - omega).abs() <= COMPUTED_PEAK_NEAR * bandwidth);
        }
    }
    let Some(first) = first else { return Ok(None) };
    // Towards the frequency to which the amplitude rises.
    let rising = SpecialPoint::Peak.function(&first, 1.0) * first.tangent[n];
    let settings = if rising >= 0.0 {
        upwards
    } else {
        settings(Range::new(range.stop, range.start))
    };
    let mut before = first.try_clone()?;
    let mut continuation = Continuation::new(settings, first)?;
    if (settings.end - settings.start) * before.tangent[n] < 0.0 {
        before.reverse();
    }
    for _ in 0..COMPUTED_PEAK_MOST_POINTS {
        let (Advance::Accepted { point, .. } | Advance::LeftAtStart { point }) =
            continuation.advance(&mut problem, interrupt)?
        else {
            break;
        };
        if SpecialPoint::Peak.between(&before, &point) {
            let mut locator = Locator::new(n, settings)?;
            let found = locator.locate(&mut problem, SpecialPoint::Peak, &before, &point, interrupt)?;
            return Ok(found.map(|p| p.amplitude.norm() * forced.length()));
        }
        before = point;
    }
    Ok(None)
}

/// Solves by Newton's method from the motion of the mode, at its frequency or at its phase. Contacts far from where
/// the force acts may move otherwise than in the mode, so that the solution need not be near.
fn solve(
    problem: &mut dyn Problem,
    corrector: &mut Corrector,
    settings: &Settings,
    near: &Point,
    keep_frequency: bool,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Point>> {
    let n = near.unknowns().len();
    let metric = Metric::along(norm(near.unknowns()), settings);
    let mut row = try_vec(n + 1, 0.0, CONTEXT)?;
    if keep_frequency {
        row[n] = 1.0;
    } else {
        metric.unit(&near.tangent, &mut row);
    }
    let mut v = try_copy(&near.v, CONTEXT)?;
    Ok(
        match corrector.correct(problem, &mut v, &row, metric, true, interrupt)? {
            Outcome::Converged(corrected) => Some(Point::new(v, corrected, 0.0)),
            Outcome::Failed => None,
        },
    )
}

/// The motion of the mode with the phase that the force gives it, followed by the frequency.
fn turned(peak: &AtPeak<'_>, n: usize) -> Result<Vec<f64>> {
    let set = peak.condensed.set();
    let turn = peak.state.turn(peak.omega);
    let mut v = try_copy(&peak.motion[..n], CONTEXT)?;
    for y in v.chunks_exact_mut(set.packed_len().max(1)) {
        for (i, &h) in set.numbers().iter().enumerate() {
            let z = set.get(y, i) * turn.powu(h as u32);
            set.set(y, i, z);
        }
    }
    try_push(&mut v, peak.omega, CONTEXT)?;
    Ok(v)
}
