//! Life of a job: wear of contacts, their loads and the amplitude over cycles.

use crate::building::built::Built;
use crate::building::solver::solver;
use crate::job_file::job_life::{LifePart, WornName};
use crate::outputs::files::Files;
use crate::outputs::line_chart::{Chart, Line};
use crate::studies::map::Written;
use crate::texts::counted::counted;
use crate::texts::outcome::Outcome;
use hbvib::{Duty, Hooks, Life, LifeFollow, LifeOptions, Status, Wear, life};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;

/// Contacts, static stiffness and duties of a part.
struct Described {
    wear: Vec<Wear>,
    /// Numbers or names of the contacts, as the job has them.
    labels: Vec<String>,
    stiffness: Vec<f64>,
    duties: Vec<Duty>,
}

/// Numbers of the contacts that wear, and how the job calls them.
fn contacts(part: &LifePart, built: &Built) -> Outcome<(Vec<usize>, Vec<String>)> {
    let count = built.model.contacts().len();
    let names = built.labels();
    let (mut numbers, mut labels) = (Vec::new(), Vec::new());
    for worn in &part.contacts {
        match worn {
            WornName::Number(number) if *number < count => {
                numbers.push(*number);
                labels.push(number.to_string());
            }
            WornName::Number(number) => {
                let count = counted(count, "contact");
                return Err(format!(
                    "[life] contacts: {number}, but the model has {count}, counted from 0"
                ));
            }
            WornName::Name(name) => {
                let Some((_, range)) = built.names.iter().find(|(known, _)| known == name) else {
                    let known: Vec<&str> = built.names.iter().map(|(known, _)| known.as_str()).collect();
                    return Err(format!("[life] contacts: \"{name}\" is none of {}", known.join(", ")));
                };
                numbers.extend(range.clone());
                labels.extend_from_slice(&names[range.clone()]);
            }
        }
    }
    Ok((numbers, labels))
}

fn described(part: &LifePart, built: &Built) -> Outcome<Described> {
    let (contacts, labels) = contacts(part, built)?;
    let n = contacts.len();
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
        wear: contacts.iter().map(wear).collect(),
        labels,
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
    described(part, built)?;
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
    let described = described(part, built)?;
    let solver = solver((part.harmonics, part.tolerance), part.response_dof.as_ref(), built).map_err(|e| said(&e))?;
    let found = life(&built.model, &solver, &options(part, &described), hooks).map_err(|e| said(&e))?;
    files.write(part.csv.as_deref(), &|path| {
        fs::write(path, table(&described.wear, &found)).map_err(|e| e.to_string())
    });
    files.write(part.figure.as_deref(), &|path| {
        figure(&described.labels, &found).write(path)
    });
    let mut text = format!(
        "life of {}: {:.6e} cycles in {}, amplitude {:.6e} when new, {:.6e} at the end, {:.6e} at most\n",
        counted(described.wear.len(), "contact"),
        found.reached,
        counted(found.solutions, "steady vibration"),
        found.ends.0,
        found.ends.1,
        found.largest.0
    );
    for event in &found.events {
        let worn = described.wear.iter().zip(&described.labels);
        let of = worn
            .filter(|(wear, _)| Some(wear.contact) == event.contact)
            .fold(String::new(), |text, (_, label)| text + " of contact " + label);
        let _ = writeln!(text, "  {:?}{of} at {:.6e} cycles", event.kind, event.cycles);
    }
    if let Some(reason) = &found.reason {
        let _ = writeln!(text, "  ended early: {reason}");
    }
    Ok((text, found.status != Status::Ok))
}

fn table(wear: &[Wear], found: &Life) -> String {
    let mut text = String::from("cycles,hz,amplitude");
    for Wear { contact, .. } in wear {
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

fn figure(labels: &[String], found: &Life) -> Chart {
    let line = |(i, label): (usize, &String)| Line {
        name: format!("contact {label}"),
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
        lines: labels.iter().enumerate().map(line).collect(),
    }
}
