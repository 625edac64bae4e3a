//! Going on from a response that a run before has stored.
//!
//! The run begins again at a stored point beyond which the curve does not come back: behind it the stored points are kept, and all
//! others are computed anew. Whether the curve comes back is known afterwards; then the run begins again further ahead.

use crate::building::built::Built;
use crate::job_file::job::{ForcedPart, Job};
use crate::outputs::curve::Before;
use crate::outputs::stored_response::Stored;
use crate::texts::events;
use crate::texts::outcome::Outcome;
use hbvib::{Branch, Status};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Relative difference of an amplitude at the point where a run goes on, from which it is that of another model.
const OTHER: f64 = 1e-2;

/// Relative difference of two equal frequencies.
const SAME: f64 = 1e-9;

/// Begin of a run: its frequency in Hz, its requests, and a guess.
pub struct Begin<'a> {
    pub from_hz: f64,
    pub at_hz: Vec<f64>,
    pub guess: Option<&'a [Complex64]>,
}

/// The stored response that a job names.
///
/// # Errors
/// A sentence: a file that cannot be read, or is that of another model or range.
pub fn stored(job: &Job, built: &Built) -> Outcome<Option<Stored>> {
    let (Some(part), Some(forced)) = (&job.restart, &job.forced) else {
        return Ok(None);
    };
    let said = |e: String| format!("[restart]: {}: {e}", part.from.display());
    let stored = Stored::read(&job.path(&part.from)).map_err(|e| format!("[restart]: {e}"))?;
    if stored.ndof != built.model.ndof() {
        return Err(said(format!(
            "has {} degrees of freedom, and the model {}: it is that of another job",
            stored.ndof,
            built.model.ndof()
        )));
    }
    if stored.responses() != job.response.len() {
        return Err(said(format!(
            "has {} responses, and the job {}",
            stored.responses(),
            job.response.len()
        )));
    }
    let first = stored.omega.first().ok_or_else(|| said("has no point".into()))? / TAU;
    if (first - forced.from_hz).abs() > SAME * forced.from_hz {
        return Err(said(format!(
            "begins at {first} Hz, and [forced] at {} Hz",
            forced.from_hz
        )));
    }
    Ok(Some(stored))
}

/// Goes on from a stored response; returns the new branch, and the points that are kept before it.
///
/// # Errors
/// Those of the run; a model whose amplitude is another one.
pub fn go_on(
    part: &ForcedPart,
    stored: Stored,
    solve: &mut dyn FnMut(&Begin<'_>) -> Outcome<Branch>,
) -> Outcome<(Branch, Before)> {
    let sense = (part.to_hz - part.from_hz).signum();
    let mut kept = forward(&stored.omega, sense, stored.omega.len());
    loop {
        let omega = stored.omega[kept];
        // The first point is that of the job, to the last bit.
        let from_hz = if kept == 0 { part.from_hz } else { omega / TAU };
        let ahead = |hertz: f64| sense * (hertz - from_hz) >= 0.0;
        let requests: Vec<usize> = (0..part.at_hz.len()).filter(|i| ahead(part.at_hz[*i])).collect();
        let branch = solve(&Begin {
            from_hz,
            at_hz: requests.iter().map(|i| part.at_hz[*i]).collect(),
            guess: Some(stored.harmonics_at(kept)),
        })?;
        let comes_back = kept > 0 && comes_back(&branch);
        if let (false, Some(amplitude)) = (comes_back, branch.amplitude().first()) {
            let before = stored.amplitude[kept];
            if (amplitude - before).abs() > OTHER * before.abs() {
                return Err(format!(
                    "[restart]: the amplitude at {from_hz:.6} Hz is {amplitude:.6e}, and was {before:.6e}: the model is another one"
                ));
            }
        }
        if !comes_back {
            return Ok((branch, Before { stored, kept, requests }));
        }
        let next = halfway(&stored.omega, sense, kept);
        events::line(
            "log",
            serde_json::json!({
                "level": "info",
                "message": format!("the curve comes back to {from_hz:.6} Hz: the run goes on from {:.6} Hz", stored.omega[next] / TAU),
            }),
        );
        kept = next;
    }
}

/// Whether a branch has left its range at its start, or has come back to it.
fn comes_back(branch: &Branch) -> bool {
    let omega = &branch.omega()[..branch.points()];
    let Some((first, rest)) = omega.split_first() else {
        return false;
    };
    let back = rest.iter().any(|w| (w - first).abs() <= SAME * first);
    back || branch.status() == Status::StoppedLeftRange
}

/// The last point before `end` at which the curve goes on in its sense.
fn forward(omega: &[f64], sense: f64, end: usize) -> usize {
    (1..end)
        .rev()
        .find(|p| sense * (omega[*p] - omega[p - 1]) > 0.0)
        .unwrap_or(0)
}

/// A point before another one, half as far from the start.
fn halfway(omega: &[f64], sense: f64, kept: usize) -> usize {
    let half = 0.5 * (omega[0] + omega[kept]);
    let end = (1..kept)
        .rev()
        .find(|p| sense * (omega[*p] - half) <= 0.0)
        .map_or(0, |p| p + 1);
    forward(omega, sense, end)
}

#[cfg(test)]
mod tests {
    use super::{forward, halfway};

    #[test]
    fn a_run_goes_on_where_the_curve_goes_forward() {
        let omega = [1.0, 2.0, 4.0, 6.0, 5.0, 3.0];
        assert_eq!(forward(&omega, 1.0, 6), 3);
        assert_eq!(halfway(&omega, 1.0, 3), 1);
        assert_eq!(halfway(&omega, 1.0, 1), 0);
        assert_eq!(forward(&[5.0, 4.0, 4.5], -1.0, 3), 1);
        assert_eq!(forward(&[5.0], 1.0, 1), 0);
    }
}
