//! Comparison of points of a forced response with integration in time.

use crate::job_file::job::{MethodName, VerifyPart};
use crate::outputs::files::Files;
use crate::outputs::points::chosen;
use crate::texts::counted::counted;
use crate::texts::outcome::Outcome;
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

/// Compares the points that the job names, until the caller stops. A point that cannot be compared is told, and left out.
///
/// # Errors
/// None to compare, or none that can be.
pub fn compare(
    part: &VerifyPart,
    (model, branch): (&Model, &Branch),
    hooks: &mut Hooks<'_>,
    files: &mut Files<'_>,
) -> Outcome<Comparisons> {
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
    let (mut compared, mut failed) = (Vec::new(), Vec::new());
    let mut complete = true;
    for point in points {
        let found = match verify(model, branch, point.point, &options, hooks) {
            Ok(found) => found,
            Err(e) => {
                failed.push(format!("[verify], {:.6} Hz: {e}", point.omega / TAU));
                continue;
            }
        };
        if found.status == Status::StoppedByCaller {
            complete = false;
            break;
        }
        compared.push((point, found));
    }
    if complete && compared.is_empty() {
        return Err(failed.swap_remove(0));
    }
    for sentence in failed {
        files.fail(sentence);
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
pub fn write(part: &VerifyPart, all: &[Compared], files: &mut Files<'_>) {
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
    files.write(part.csv.as_deref(), &|path| {
        fs::write(path, &text).map_err(|e| e.to_string())
    });
}
