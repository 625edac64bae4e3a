//! Files with the motion of all nodes that a job names.

use crate::building::built::Built;
use crate::job_file::job::Job;
use crate::outputs::curve::Curve;
use crate::outputs::files::Files;
use crate::outputs::frd;
use crate::outputs::modal_coordinates;
use crate::outputs::modal_coordinates::Modes;
use crate::outputs::netcdf_response;
use crate::outputs::node_motion::Places;
use crate::outputs::points::shapes;
use crate::outputs::uff;
use crate::outputs::vtu_series;
use crate::texts::outcome::Outcome;

/// Refuses what cannot be written, before anything is computed.
///
/// # Errors
/// A sentence.
pub fn check(job: &Job, built: &Built) -> Outcome<()> {
    let output = &job.output;
    if output.motion.phases == 0 {
        return Err("[output.motion]: phases = 0, needs at least 1".into());
    }
    if output.motion.wheel && job.model.faces.is_none() {
        return Err("[output.motion]: wheel = true needs a sector with [model.faces], which have the axis".into());
    }
    for (name, path) in [("vtu", &output.vtu), ("frd", &output.frd)] {
        if path.is_some() {
            let outcome = Places::of(job, built).and_then(|places| places.needs_mesh());
            outcome.map_err(|e| format!("[output], {name}: {e}"))?;
        }
    }
    if let Some(part) = &output.modal {
        Modes::of(job, part, &built.nodes).map_err(|e| format!("[output.modal]: {e}"))?;
    }
    Ok(())
}

/// Writes them; one that cannot be made is told, and costs no other.
pub fn write(job: &Job, curve: &Curve<'_>, built: &Built, files: &mut Files<'_>) {
    let branch = curve.branch;
    let output = &job.output;
    let named = [&output.vtu, &output.uff, &output.netcdf, &output.frd];
    if named.into_iter().all(Option::is_none) && output.modal.is_none() {
        return;
    }
    let found = Places::of(job, built);
    let points = shapes(branch, output.motion.points);
    let places = found.as_ref().ok();
    files.write(output.netcdf.as_deref(), &|path| {
        netcdf_response::write(path, job, (built, places), curve)
    });
    files.write(output.uff.as_deref(), &|path| {
        uff::write(path, (built, places), curve, &points)
    });
    if let Some(part) = &output.modal {
        files.write(Some(&part.csv), &|path| {
            modal_coordinates::write(path, (job, part, built), (branch, &points))
        });
    }
    let needed = || -> Outcome<&Places> { found.as_ref().map_err(Clone::clone) };
    files.write(output.frd.as_deref(), &|path| {
        frd::write(path, (built, needed()?), branch, &points)
    });
    if let Some(list) = &output.vtu {
        let outcome = needed()
            .and_then(|places| vtu_series::write((list, &output.motion), (places, built), (branch, &points), files));
        if let Err(e) = outcome {
            files.fail(format!("{}: cannot be written: {e}", list.display()));
        }
    }
}
