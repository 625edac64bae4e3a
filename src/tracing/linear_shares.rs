//! The largest share of its linear range that a contact uses between two neighbouring values of a linear response.
//!
//! The unknowns u of a linear response are sums over poles, so that |q|² u is smooth where q frees them of the poles next to the
//! interval ([`PolesBeside`]). The cubic through its values and derivatives at both ends foresees the largest share. One solution
//! shows by how much the cubic errs there, and since its error goes with s²(1 − s)² over the share s of the interval, everywhere. The
//! share is searched by solutions only if it may reach 1 within that error.

use crate::continuation::Point;
use crate::error::Result;
use crate::harmonics::discretised::Traceable;
use crate::linalg::norm;
use crate::roots::least;
use crate::tracing::course::BranchTracer;
use crate::tracing::resonance_grid::PolesBeside;

/// Share of its linear range above which the motion of a contact may have a maximum beyond it between two values.
/// Kind: tuned; measured on: not recorded.
const LINEAR_STRETCH_NEARLY: f64 = 0.7;

/// Width, over the distance of the two values, at which the place of such a maximum is found.
/// Kind: tuned; measured on: not recorded.
const FOUND_SHARE: f64 = 5e-4;

/// Least distance from both ends, over that of the two values, at which the error of the cubic is measured: next to an end there is none.
/// Kind: tuned; measured on: chains of 12 with three sliders whose largest share is known, 1e-9 to 0.3 below and above 1.
const MEASURED_FROM: f64 = 0.25;

/// Multiple of the error measured that is allowed for.
/// Kind: tuned; measured on: those chains.
const MEASURED_TIMES: f64 = 4.0;

/// The contacts between two values at which all are linear.
pub(super) enum Between {
    /// All are linear there, too.
    Linear,
    /// All are linear there, too, and another point than that at the later value was solved last.
    LinearAfterSearch,
    /// Not all are linear at this value.
    Beyond(f64),
}

/// Whether every contact is linear between two neighbouring points at which all are, by the cubic or by solutions.
pub(super) fn place_beyond(
    tracer: &BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    ends: [&Point; 2],
) -> Result<Between> {
    let [before, after] = ends.map(|point| analysis.linear_share(point));
    let largest = before?.max(after?);
    if largest.is_nan() || largest <= LINEAR_STRETCH_NEARLY {
        return Ok(Between::Linear);
    }
    let mut foreseen = Foreseen::new(tracer, ends)?;
    let (place, share) = foreseen.largest(analysis, 0.0)?;
    let measured = if share < 1.0 {
        place.clamp(MEASURED_FROM, 1.0 - MEASURED_FROM)
    } else {
        place
    };
    let value = foreseen.poles.at(measured);
    let Some(solved) = analysis.linear_at(ends[0], value, tracer.interrupt)? else {
        return Ok(Between::Beyond(value));
    };
    let error = foreseen.error(analysis, measured, &solved)?;
    let weight = measured * (1.0 - measured);
    let (_, share) = foreseen.largest(analysis, MEASURED_TIMES * error / (weight * weight))?;
    // Rounding of the foreseen motions may be no number.
    if share < 1.0 {
        return Ok(Between::LinearAfterSearch);
    }
    searched(tracer, analysis, ends)
}

/// The same by solutions alone.
fn searched(tracer: &BranchTracer<'_>, analysis: &mut dyn Traceable, ends: [&Point; 2]) -> Result<Between> {
    let [from, to] = ends.map(Point::parameter);
    let range = [from.min(to), from.max(to)];
    let mut beyond = None;
    let found = least(range, FOUND_SHARE * (range[1] - range[0]), |at| {
        match share_at(tracer, analysis, ends[0], at) {
            Ok(Some(share)) => Ok(-share),
            Ok(None) => {
                beyond = Some(at);
                Err(None)
            }
            Err(failed) => Err(Some(failed)),
        }
    });
    match (found, beyond) {
        (Err(Some(failed)), _) => Err(failed),
        (_, Some(at)) => Ok(Between::Beyond(at)),
        _ => Ok(Between::LinearAfterSearch),
    }
}

/// Largest share of its linear range that a contact uses at a value; `None` if a contact leaves that range.
fn share_at(tracer: &BranchTracer<'_>, analysis: &mut dyn Traceable, here: &Point, value: f64) -> Result<Option<f64>> {
    match analysis.linear_at(here, value, tracer.interrupt)? {
        Some(point) => analysis.linear_share(&point).map(Some),
        None => Ok(None),
    }
}

/// A linear response between two points by the cubic of |q|² u.
struct Foreseen<'p> {
    ends: [&'p Point; 2],
    poles: PolesBeside,
    /// The point foreseen last.
    point: Point,
}

impl<'p> Foreseen<'p> {
    fn new(tracer: &BranchTracer<'_>, ends: [&'p Point; 2]) -> Result<Self> {
        Ok(Self {
            ends,
            poles: tracer.poles_beside(ends[0].parameter(), ends[1].parameter()),
            point: ends[0].try_clone()?,
        })
    }

    /// Foresees the point at a share s of the interval.
    fn foresee(&mut self, s: f64) {
        let factor = |s| {
            let (q, dq) = self.poles.factor(s);
            (q.norm_sqr(), 2.0 * (q.conj() * dq).re)
        };
        let (whole, t) = (factor(s).0, 1.0 - s);
        // Weights of the values and derivatives of |q|² u at both ends, and from these of u and du/dp.
        let cubics = [
            [(1.0 + 2.0 * s) * t * t, s * t * t],
            [(1.0 + 2.0 * t) * s * s, -t * s * s],
        ];
        let mut weights = [[0.0; 2]; 2];
        for (e, point) in self.ends.iter().enumerate() {
            let (size, slope) = factor(e as f64);
            let along = self.poles.width / point.tangent[point.tangent.len() - 1];
            let [of_value, of_slope] = cubics[e];
            weights[e] = [
                (of_value * size + of_slope * slope) / whole,
                of_slope * size * along / whole,
            ];
        }
        let [a, b] = self.ends;
        let motions = a.v.iter().zip(&a.tangent).zip(b.v.iter().zip(&b.tangent));
        for (to, ((a, da), (b, db))) in self.point.v.iter_mut().zip(motions) {
            *to = weights[0][0] * a + weights[0][1] * da + weights[1][0] * b + weights[1][1] * db;
        }
        if let Some(parameter) = self.point.v.last_mut() {
            *parameter = self.poles.at(s);
        }
    }

    /// The place of the largest share that is foreseen, with an error of `error` s²(1 − s)² on top of it, and that share.
    fn largest(&mut self, analysis: &mut dyn Traceable, error: f64) -> Result<(f64, f64)> {
        let mut share = |s: f64| {
            self.foresee(s);
            let of_motion = analysis.linear_share(&self.point)?;
            Ok(of_motion + error * (s * (1.0 - s)).powi(2))
        };
        let place = least([0.0, 1.0], FOUND_SHARE, |s| share(s).map(|share| -share))?;
        Ok((place, share(place)?))
    }

    /// Error of the share that is foreseen at a place, and of the whole motion, whichever is larger, by the solution there.
    fn error(&mut self, analysis: &mut dyn Traceable, place: f64, solved: &Point) -> Result<f64> {
        self.foresee(place);
        let [found, exact] = [&self.point, solved].map(|point| analysis.linear_share(point));
        let exact = exact?;
        for (to, solved) in self.point.v.iter_mut().zip(solved.unknowns()) {
            *to -= solved;
        }
        let relative = norm(self.point.unknowns()) / norm(solved.unknowns());
        Ok((found? - exact).abs().max(exact * relative))
    }
}
