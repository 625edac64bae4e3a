//! Maxima of a linear response between two neighbouring points of its grid.
//!
//! The cubic through the values and derivatives at both ends of the response freed of the poles next to the interval
//! ([`PolesBeside`]) tells where to look; solutions there decide.

use crate::continuation::Point;
use crate::continuation::special_points::SpecialPoint;
use crate::error::Result;
use crate::harmonics::discretised::Traceable;
use crate::results::SpecialKind;
use crate::roots::Bracket;
use crate::tracing::course::BranchTracer;
use crate::tracing::resonance_grid::PolesBeside;
use num_complex::Complex64;

/// Relative width of an interval that is rounding.
/// Kind: rounding.
pub(super) const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Parts of the cubic between two neighbours in which peaks are searched.
/// Kind: tuned; measured on: 700 random chains and dense matrices, all of whose maxima are known.
const PARTS: usize = 32;

/// Relative change of the amplitude over the distance of two neighbours whose sign the cubic does not tell for certain.
/// Kind: tuned; measured on: those models.
const UNCERTAIN: f64 = 0.25;

/// Its factor in the parts of a divided interval: the error of a cubic falls with the fourth power of the width.
/// Kind: tuned; measured on: those models.
const FINER: f64 = 0.1;

/// Solutions, one in the part that another has divided, that decide where maxima lie.
/// Kind: cap.
const MAX_DIVISIONS: usize = 8;

/// Largest number of evaluations of a root search.
/// Kind: cap.
const LINEAR_PEAKS_MAX_EVALUATIONS: usize = 100;

/// Records a special point with the harmonics that it requires; the stretch continues with its own harmonics.
pub(super) fn record_on_line(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    kind: SpecialKind,
    mut point: Point,
) -> Result<()> {
    let own = analysis.resolution();
    let mut at = own;
    while !tracer.record_special(analysis, kind, &point)? {
        let start = analysis.transfer(&point, at)?;
        let Some(found) = analysis.linear_at(&start, point.parameter(), tracer.interrupt)? else {
            // A point found with fewer harmonics is better than none.
            analysis.select(at)?;
            tracer.record_special_as_it_is(analysis, kind, &point)?;
            break;
        };
        (point, at) = (found, analysis.resolution());
    }
    analysis.select(own)
}

/// Records the maxima of the amplitude between two neighbours, as the response sees both. Where more than one maximum
/// or one beside a minimum may lie, a solution there divides the interval.
pub(super) fn find_peaks(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    kind: SpecialKind,
    low: &Point,
    high: &Point,
) -> Result<()> {
    let mut left = MAX_DIVISIONS;
    find_peaks_within(tracer, analysis, kind, [low, high], UNCERTAIN, &mut left)
}

fn find_peaks_within(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    kind: SpecialKind,
    [low, high]: [&Point; 2],
    uncertain: f64,
    left: &mut usize,
) -> Result<()> {
    let ends = [low, high].map(|p| (p.parameter(), growth(p)));
    let between = Between::new(low, high, tracer.poles_beside(ends[0].0, ends[1].0));
    let divide = if *left == 0 {
        None
    } else {
        between.doubtful(ends.map(|end| end.1), uncertain)
    };
    if let Some(share) = divide {
        let value = ends[0].0 + share * (ends[1].0 - ends[0].0);
        if let Some(point) = analysis.linear_at(low, value, tracer.interrupt)? {
            *left -= 1;
            let finer = FINER * uncertain;
            let resolution = analysis.resolution();
            let middle = match kind.response() {
                Some(response) => analysis.seen_by(response, (&point, resolution))?,
                None => point,
            };
            find_peaks_within(tracer, analysis, kind, [low, &middle], finer, left)?;
            return find_peaks_within(tracer, analysis, kind, [&middle, high], finer, left);
        }
    }
    if ends[0].1 > 0.0 && ends[1].1 <= 0.0 {
        find_peak(tracer, analysis, kind, low, ends)?;
    }
    Ok(())
}

/// Records the maximum between two values: the root of the derivative.
fn find_peak(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    kind: SpecialKind,
    from: &Point,
    ends: [(f64, f64); 2],
) -> Result<()> {
    let Some(peak) = stationary(tracer, analysis, kind, from, ends)? else {
        return Ok(());
    };
    record_on_line(tracer, analysis, kind, peak)
}

/// A root of the amplitude's derivative between two values.
fn stationary(
    tracer: &BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    kind: SpecialKind,
    near: &Point,
    [low, high]: [(f64, f64); 2],
) -> Result<Option<Point>> {
    let width = high.0 - low.0;
    let mut bracket = Bracket::new(low.1, high.1);
    let mut best = None;
    for _ in 0..LINEAR_PEAKS_MAX_EVALUATIONS {
        let (share, is_last) = (bracket.guess(), bracket.is_last());
        let at = low.0 + share * width;
        let rounding = ROUNDING * at.abs();
        // A root at an end of the bracket is solved there.
        let is_inside = low.0 < at && at < high.0;
        if best.is_some() && (bracket.width() * width <= rounding || !is_inside) {
            break;
        }
        let Some(point) = analysis.linear_at(near, at, tracer.interrupt)? else {
            break;
        };
        let slope = growth_of(analysis, kind, &point)?;
        best = Some(point);
        if slope == 0.0 || is_last || bracket.narrow(share, slope) * width <= rounding {
            break;
        }
    }
    Ok(best)
}

/// A response between two values: the cubic of q z, from its values and derivatives at both.
struct Between {
    poles: PolesBeside,
    /// Coefficients of q z by powers of the share s of the interval.
    coefficients: [Complex64; 4],
}

impl Between {
    fn new(low: &Point, high: &Point, poles: PolesBeside) -> Self {
        // q z and d(q z)/ds.
        let [(wa, da), (wb, db)] = [(low, 0.0), (high, 1.0)].map(|(point, s)| {
            let (q, dq) = poles.factor(s);
            let slope = point.slope * (poles.width / point.tangent[point.tangent.len() - 1]);
            (q * point.amplitude, q * slope + dq * point.amplitude)
        });
        let difference = wb - wa;
        Self {
            poles,
            coefficients: [wa, da, difference * 3.0 - da * 2.0 - db, da + db - difference * 2.0],
        }
    }

    /// A share of the interval at which a solution decides whether a maximum lies within it, from the derivatives at both
    /// ends: beyond a maximum that has a minimum beside it, or where the derivative comes near a further change of sign.
    fn doubtful(&self, ends: [f64; 2], uncertain: f64) -> Option<f64> {
        let mut near = None;
        // The number of maxima, and the first part boundary beyond one.
        let (mut maxima, mut beyond) = (0, None);
        // The derivatives at the last two boundaries, and |z|² at the last.
        let (first, mut size) = self.growth(0.0);
        let mut last = [f64::NAN, first];
        for i in 1..=PARTS {
            let (slope, next_size) = self.growth(i as f64 / PARTS as f64);
            if last[1] > 0.0 && slope <= 0.0 {
                maxima += 1;
                beyond.get_or_insert(i.min(PARTS - 1));
            }
            let is_least = [last[0], slope]
                .iter()
                .all(|x| x * last[1] > 0.0 && x.abs() >= last[1].abs());
            if is_least && last[1].abs() < uncertain * size {
                near = Some(i - 1);
            }
            last = [last[1], slope];
            size = next_size;
        }
        let is_single = ends[0] > 0.0 && ends[1] <= 0.0 && maxima == 1;
        let part = beyond.filter(|_| !is_single).or(near);
        part.map(|i| i as f64 / PARTS as f64)
    }

    /// ½ d|z|²/ds and |z|².
    fn growth(&self, s: f64) -> (f64, f64) {
        let [c0, c1, c2, c3] = self.coefficients;
        let w = c0 + (c1 + (c2 + c3 * s) * s) * s;
        let dw = c1 + (c2 * 2.0 + c3 * (3.0 * s)) * s;
        let (q, dq) = self.poles.factor(s);
        let z = w / q;
        let dz = (dw - z * dq) / q;
        ((z.conj() * dz).re, z.norm_sqr())
    }
}

/// d|z|/dp of the response whose peak is sought.
fn growth_of(analysis: &mut dyn Traceable, kind: SpecialKind, point: &Point) -> Result<f64> {
    let resolution = analysis.resolution();
    Ok(match kind.response() {
        Some(response) => growth(&analysis.seen_by(response, (point, resolution))?),
        None => growth(point),
    })
}

/// d|z|/dp of the observed amplitude.
fn growth(point: &Point) -> f64 {
    SpecialPoint::Peak.function(point, point.tangent[point.tangent.len() - 1])
}
