//! Comparison of points of a forced response with integration in time.

use crate::build::Outcome;
use crate::counted::counted;
use crate::job::{Job, MethodName, VerifyPart};
use crate::output::place;
use crate::points::chosen;
use hbvib::{Branch, Hooks, Model, Special, Status, SteadyMethod, Verification, VerifyOptions, verify};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;

/// A point and its comparison.
pub type Compared = (Special, Verification);

/// Comparisons of a job.
pub struct Comparisons {
    pub compared: Vec<Compared>,
    /// False if the caller stopped before the last one.
    pub complete: bool,
}

/// Compares the points that the job names, until the caller stops.
///
/// # Errors
/// A sentence that names the frequency; none to compare.
pub fn compare(part: &VerifyPart, model: &Model, branch: &Branch, hooks: &mut Hooks<'_>) -> Outcome<Comparisons> {
    let defaults = VerifyOptions::default();
    let options = VerifyOptions {
        method: match part.method {
            MethodName::Shooting => SteadyMethod::Shooting,
            MethodName::Marching => SteadyMethod::Marching,
        },
        tolerance: part.tolerance.unwrap_or(defaults.tolerance),
        max_periods: part.max_periods.unwrap_or(defaults.max_periods),
        same_within: part.same_within.unwrap_or(defaults.same_within),
    };
    let points = chosen(branch, part.points);
    if points.is_empty() {
        return Err("[verify]: the branch has none of the named points".into());
    }
    let mut compared = Vec::new();
    let mut complete = true;
    for point in points {
        let found = verify(model, branch, point.point, &options, hooks)
            .map_err(|e| format!("[verify], {:.6} Hz: {e}", point.omega / TAU))?;
        if found.status == Status::StoppedByCaller {
            complete = false;
            break;
        }
        compared.push((point, found));
    }
    Ok(Comparisons { compared, complete })
}

/// Lines of the summary.
pub fn summary(all: &[Compared]) -> String {
    let mut text = String::new();
    for (point, found) in all {
        let _ = writeln!(
            text,
            "verify {:>14.6} Hz {:>14.6e} {}: response {:.2e}, motion {:.2e}, largest displacement {:.2e} off; {}{}",
            point.omega / TAU,
            point.amplitude,
            if found.same { "same" } else { "another solution" },
            found.response_error,
            found.distance,
            found.peak_error,
            counted(found.periods, "period"),
            if found.marched { ", marched" } else { "" }
        );
    }
    text
}

/// Writes the table of the comparisons, where the job names one.
///
/// # Errors
/// A sentence that names the file.
pub fn write(job: &Job, part: &VerifyPart, all: &[Compared]) -> Outcome<String> {
    let Some(path) = &part.csv else {
        return Ok(String::new());
    };
    let path = place(job, path)?;
    let mut text = String::from(
        "frequency_hz,amplitude,same,response_error,motion_error,above,distance,peak,peak_error,residual,periods,events,\
         marched\n",
    );
    for (point, found) in all {
        let _ = writeln!(
            text,
            "{:.16e},{:.16e},{},{:.6e},{:.6e},{:.6e},{:.6e},{:.16e},{:.6e},{:.6e},{},{},{}",
            point.omega / TAU,
            point.amplitude,
            u8::from(found.same),
            found.response_error,
            found.motion_error,
            found.above,
            found.distance,
            found.peak,
            found.peak_error,
            found.residual,
            found.periods,
            found.events,
            u8::from(found.marched)
        );
    }
    fs::write(&path, text).map_err(|e| format!("{}: cannot be written: {e}", path.display()))?;
    Ok(format!("wrote {}\n", path.display()))
}
