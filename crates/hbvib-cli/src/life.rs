//! Life of a job: wear of contacts, their loads and the amplitude over cycles.

use crate::build::{Built, Outcome};
use crate::counted::counted;
use crate::files::Files;
use crate::job_life::LifePart;
use crate::line_chart::{Chart, Line};
use crate::map::Written;
use crate::solver::solver;
use hbvib::{Duty, Hooks, Life, LifeFollow, LifeOptions, Status, Wear, life};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;

/// Contacts, static stiffness and duties of a part.
struct Described {
    wear: Vec<Wear>,
    stiffness: Vec<f64>,
    duties: Vec<Duty>,
}

fn described(part: &LifePart) -> Outcome<Described> {
    let n = part.contacts.len();
    let duties = match (part.hz, part.from_hz, part.to_hz) {
        (Some(hz), None, None) => vec![Duty {
            omega: TAU * hz,
            force: 1.0,
            share: 1.0,
        }],
        (None, Some(_), Some(_)) => Vec::new(),
        _ => return Err("[life]: needs either hz, or from_hz and to_hz".into()),
    };
    let mut stiffness = Vec::new();
    if let Some(own) = part.stiffness {
        stiffness = vec![0.0; n * n];
        stiffness.iter_mut().step_by(n + 1).for_each(|s| *s = own);
    }
    let wear = |&contact| Wear {
        contact,
        rate: part.rate,
        area: part.area,
    };
    Ok(Described {
        wear: part.contacts.iter().map(wear).collect(),
        stiffness,
        duties,
    })
}

fn options<'a>(part: &'a LifePart, described: &'a Described) -> LifeOptions<'a> {
    LifeOptions {
        wear: &described.wear,
        stiffness: &described.stiffness,
        follow: match (part.from_hz, part.to_hz) {
            (Some(from), Some(to)) => LifeFollow::Peak {
                omega_start: TAU * from,
                omega_stop: TAU * to,
            },
            _ => LifeFollow::Duties(&described.duties),
        },
        cycles: &part.cycles,
        tolerance: part.accuracy,
        limit: part.limit,
        ..LifeOptions::default()
    }
}

/// Refuses what cannot be computed.
///
/// # Errors
/// A sentence.
pub fn check(part: &LifePart, built: &Built) -> Outcome<()> {
    described(part)?;
    if let Some(contact) = part.contacts.iter().find(|&&k| k >= built.model.contacts().len()) {
        let count = counted(built.model.contacts().len(), "contact");
        return Err(format!("[life] contacts: {contact}, but the model has {count}"));
    }
    solver((part.harmonics, part.tolerance), part.response_dof.as_ref(), built)
        .map(|_| ())
        .map_err(|e| format!("[life]: {e}"))
}

/// Computes and writes a life.
///
/// # Errors
/// A sentence.
pub fn write(part: &LifePart, built: &Built, hooks: &mut Hooks<'_>, files: &mut Files<'_>) -> Outcome<Written> {
    let said = |e: &dyn std::fmt::Display| format!("[life]: {e}");
    let described = described(part)?;
    let solver = solver((part.harmonics, part.tolerance), part.response_dof.as_ref(), built).map_err(|e| said(&e))?;
    let found = life(&built.model, &solver, &options(part, &described), hooks).map_err(|e| said(&e))?;
    files.write(part.csv.as_deref(), &|path| {
        fs::write(path, table(part, &found)).map_err(|e| e.to_string())
    });
    files.write(part.figure.as_deref(), &|path| figure(part, &found).write(path));
    let mut text = format!(
        "life of {}: {:.6e} cycles in {}, amplitude {:.6e} when new, {:.6e} at the end, {:.6e} at most\n",
        counted(part.contacts.len(), "contact"),
        found.reached,
        counted(found.solutions, "steady vibration"),
        found.ends.0,
        found.ends.1,
        found.largest.0
    );
    for event in &found.events {
        let of = event
            .contact
            .map_or(String::new(), |contact| format!(" of contact {contact}"));
        let _ = writeln!(text, "  {:?}{of} at {:.6e} cycles", event.kind, event.cycles);
    }
    if let Some(reason) = &found.reason {
        let _ = writeln!(text, "  ended early: {reason}");
    }
    Ok((text, found.status != Status::Ok))
}

fn table(part: &LifePart, found: &Life) -> String {
    let mut text = String::from("cycles,hz,amplitude");
    for contact in &part.contacts {
        let _ = write!(text, ",depth_{contact},load_{contact},work_{contact}");
    }
    text.push('\n');
    for point in &found.points {
        let _ = write!(
            text,
            "{:.16e},{:.16e},{:.16e}",
            point.cycles,
            point.omega / TAU,
            point.amplitude
        );
        for ((depth, load), work) in point.depths.iter().zip(&point.loads).zip(&point.works) {
            let _ = write!(text, ",{depth:.16e},{load:.16e},{work:.16e}");
        }
        text.push('\n');
    }
    text
}

fn figure(part: &LifePart, found: &Life) -> Chart {
    let line = |(i, contact): (usize, &usize)| Line {
        name: format!("contact {contact}"),
        points: found
            .points
            .iter()
            .map(|point| (point.cycles, point.loads[i]))
            .collect(),
        marked: Vec::new(),
    };
    Chart {
        title: "normal loads over the life".into(),
        x_label: "cycles".into(),
        y_label: "normal load".into(),
        log_x: false,
        log_y: false,
        markers: true,
        lines: part.contacts.iter().enumerate().map(line).collect(),
    }
}
