//! The smallest kicks of a job: from each stable motion at a requested frequency across each unstable one.

use crate::building::built::Built;
use crate::job_file::job::Job;
use crate::job_file::job_solutions::KickPart;
use crate::outputs::files::Files;
use crate::studies::map::Written;
use crate::studies::solutions::places;
use crate::texts::outcome::Outcome;
use hbvib::{Branch, Error, FloquetOptions, Hooks, Kick, Model, Status, floquet, smallest_kick};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;

/// A motion at a requested frequency.
struct Motion<'b> {
    number: usize,
    branch: &'b Branch,
    point: usize,
    omega: f64,
    amplitude: f64,
    /// Unstable directions, where they are known.
    unstable: Option<usize>,
}

/// A kick with its frequency and the two motions between which it acts.
struct Found {
    hz: f64,
    from: (usize, f64),
    saddle: (usize, f64),
    kick: Kick,
}

/// Refuses what cannot be computed.
///
/// # Errors
/// A sentence.
pub fn check(job: &Job, built: &Built) -> Outcome<()> {
    let Some(part) = job.solutions.as_ref().and_then(|part| part.kick.as_ref()) else {
        return Ok(());
    };
    let dof = built
        .nodes
        .dof(&part.dof)
        .map_err(|e| format!("[solutions] kick: dof: {e}"))?;
    if dof >= built.model.ndof() {
        return Err(format!(
            "[solutions] kick: dof = {dof}, needs 0 .. {}",
            built.model.ndof()
        ));
    }
    if job.forced.as_ref().is_none_or(|forced| forced.at_hz.is_empty()) {
        return Err("[solutions] kick needs at_hz in [forced], the frequencies at which the machine runs".into());
    }
    if !(1..=10_000).contains(&part.phases) {
        return Err(format!("[solutions] kick: phases = {}, needs 1 .. 10000", part.phases));
    }
    Ok(())
}

/// The motions at the i-th requested frequency that have the period of the forces, each with its stability.
fn motions<'b>(model: &Model, branch: &'b Branch, i: usize, hooks: &mut Hooks<'_>) -> hbvib::Result<Vec<Motion<'b>>> {
    let mut found = Vec::new();
    for (number, place) in places(branch)
        .iter()
        .enumerate()
        .filter(|(_, place)| place.periods == 1)
    {
        for special in place.branch.at(i) {
            let floquet = floquet(model, place.branch, special.point, &FloquetOptions::default(), hooks)?;
            if floquet.status == Status::StoppedByCaller {
                return Err(Error::new(
                    Status::StoppedByCaller,
                    format_args!("the stability of the motions was not finished"),
                ));
            }
            found.push(Motion {
                number,
                branch: place.branch,
                point: special.point,
                omega: special.omega,
                amplitude: special.amplitude,
                unstable: (!floquet.radius.is_nan()).then_some(floquet.unstable),
            });
        }
    }
    Ok(found)
}

/// Computes and writes all kicks.
///
/// # Errors
/// A sentence.
pub fn write(
    (job, part): (&Job, &KickPart),
    built: &Built,
    branch: &Branch,
    hooks: &mut Hooks<'_>,
    files: &mut Files<'_>,
) -> Outcome<Written> {
    let dof = built.nodes.dof(&part.dof)?;
    let requests = job.forced.as_ref().map_or(0, |forced| forced.at_hz.len());
    let (mut all, mut text, mut early) = (Vec::new(), String::new(), false);
    'requests: for i in 0..requests {
        let motions = match motions(&built.model, branch, i, hooks) {
            Err(e) if e.status == Status::StoppedByCaller => {
                early = true;
                break;
            }
            found => found.map_err(|e| format!("[solutions] kick: {e}"))?,
        };
        let saddles: Vec<&Motion<'_>> = motions.iter().filter(|motion| motion.unstable == Some(1)).collect();
        let Some(first) = motions.first() else { continue };
        let hz = first.omega / TAU;
        if saddles.is_empty() {
            let _ = writeln!(
                text,
                "kick at {hz:.6} Hz: no motion with one unstable direction was found there"
            );
        }
        for from in motions.iter().filter(|motion| motion.unstable == Some(0)) {
            for saddle in &saddles {
                let kick = smallest_kick(
                    &built.model,
                    (from.branch, from.point),
                    (saddle.branch, saddle.point),
                    (dof, part.phases),
                    hooks,
                )
                .map_err(|e| format!("[solutions] kick at {hz:.6} Hz: {e}"))?;
                early = kick.status == Status::StoppedByCaller;
                let _ = writeln!(text, "{}", sentence(hz, (from, saddle), &kick));
                all.push(Found {
                    hz,
                    from: (from.number, from.amplitude),
                    saddle: (saddle.number, saddle.amplitude),
                    kick,
                });
                if early {
                    break 'requests;
                }
            }
        }
    }
    files.write(part.csv.as_deref(), &|path| {
        fs::write(path, rows(&all)).map_err(|e| e.to_string())
    });
    Ok((text, early))
}

fn sentence(hz: f64, (from, saddle): (&Motion<'_>, &Motion<'_>), kick: &Kick) -> String {
    let way = format!(
        "kick at {hz:.6} Hz from amplitude {:.6e} across {:.6e}",
        from.amplitude, saddle.amplitude
    );
    if kick.verified {
        format!(
            "{way}: {:.6e} leads across, {:.6e} returns, at phase {:.1} degrees",
            kick.impulse,
            kick.returning,
            kick.phase.to_degrees()
        )
    } else {
        format!("{way}: {:.6e} to first order, not verified", kick.estimate)
    }
}

fn rows(all: &[Found]) -> String {
    let mut text = String::from(
        "frequency_hz,branch,amplitude,saddle_branch,saddle_amplitude,impulse,returning,phase_deg,estimate,estimate_phase_deg,\
         velocity,multiplier,verified\n",
    );
    for found in all {
        let kick = &found.kick;
        let _ = writeln!(
            text,
            "{:.16e},{},{:.16e},{},{:.16e},{:.16e},{:.16e},{:.16e},{:.16e},{:.16e},{:.16e},{:.16e},{}",
            found.hz,
            found.from.0,
            found.from.1,
            found.saddle.0,
            found.saddle.1,
            kick.impulse,
            kick.returning,
            kick.phase.to_degrees(),
            kick.estimate,
            kick.estimate_phase.to_degrees(),
            kick.velocity,
            kick.multiplier,
            u8::from(kick.verified)
        );
    }
    text
}
