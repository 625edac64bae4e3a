//! The residual state of a job: places of sliders from a file, by themselves, from a load history and from vibrations.

use crate::building::built::Built;
use crate::building::built::Names;
use crate::job_file::job::Job;
use crate::job_file::job_residual::{ResidualPart, SliderPart};
use crate::outputs::files::Files;
use crate::outputs::npz::Npz;
use crate::texts::counted::counted;
use crate::texts::outcome::Outcome;
use hbvib::{
    Contact, Hooks, LoadHistory, Model, SolverOptions, StaticStep, Status, SteadyMethod, TimeOptions, static_history,
    time_response,
};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::Path;

/// Name of the array of places.
const PLACES: &str = "places";

/// Refuses what cannot be computed.
///
/// # Errors
/// A sentence.
pub fn check(job: &Job, part: &ResidualPart, built: &Built) -> Outcome<()> {
    given(job, part, built)
        .map(|_| ())
        .map_err(|e| format!("[residual]: {e}"))
}

/// Gives the model the residual state; returns what it tells.
///
/// # Errors
/// A sentence.
pub fn set(
    job: &Job,
    part: &ResidualPart,
    built: &mut Built,
    hooks: &mut Hooks<'_>,
    files: &mut Files<'_>,
) -> Outcome<String> {
    let said = |e: &dyn std::fmt::Display| format!("[residual]: {e}");
    built.model = given(job, part, built).map_err(|e| said(&e))?;
    let mut text = String::new();
    if !(part.factors.is_empty() && part.speeds.is_empty()) {
        let history = LoadHistory {
            factors: &part.factors,
            speeds: &part.speeds,
        };
        let steps = static_history(&built.model, &SolverOptions::default(), &history, &hooks.interrupt());
        let steps = steps.map_err(|e| said(&e))?;
        if let Some(last) = steps.last() {
            place(&mut built.model, &last.places).map_err(|e| said(&e))?;
        }
        let labels = built.labels();
        files.write(part.csv.as_deref(), &|path| {
            fs::write(path, table(part, &labels, &steps)).map_err(|e| e.to_string())
        });
        let _ = writeln!(text, "residual state of {}", counted(steps.len(), "static step"));
    }
    vibrate(part, &mut built.model, hooks, &mut text).map_err(|e| said(&e))?;
    let places: Vec<[f64; 2]> = built.model.contacts().iter().map(Contact::slider).collect();
    files.write(part.places_npz.as_deref(), &|path| write_places(path, &places));
    let placed = places.iter().filter(|place| place.iter().any(|x| *x != 0.0)).count();
    let _ = writeln!(text, "sliders of {} are placed", counted(placed, "contact"));
    Ok(text)
}

/// Vibrations one after the other, each from the motion and the places of the last one.
fn vibrate(part: &ResidualPart, model: &mut Model, hooks: &mut Hooks<'_>, text: &mut String) -> Outcome<()> {
    let mut last = Vec::new();
    for &hz in &part.vibration_hz {
        let options = TimeOptions {
            omega: TAU * hz,
            method: SteadyMethod::Marching,
            start: (!last.is_empty()).then_some(&last[..]),
            ..TimeOptions::default()
        };
        let found = time_response(model, &options, hooks).map_err(|e| format!("vibration_hz = {hz}: {e}"))?;
        if found.status != Status::Ok {
            return Err(format!("vibration_hz = {hz}: {}", found.status.sentence()));
        }
        for (contact, at) in found.places.iter().enumerate() {
            if sliders(model, contact) > 0 {
                model
                    .set_slider(contact, 0, *at)
                    .map_err(|e| format!("vibration_hz = {hz}: {e}"))?;
            }
        }
        let _ = writeln!(
            text,
            "residual state of the vibration at {hz} Hz after {}",
            counted(found.periods, "period")
        );
        last = found.harmonics;
    }
    Ok(())
}

/// The model with the places that the part names, before any history.
fn given(job: &Job, part: &ResidualPart, built: &Built) -> Outcome<Model> {
    let mut model = built.model.try_clone().map_err(|e| e.to_string())?;
    if let Some(path) = &part.npz {
        let path = job.path(path);
        let places = read_places(&path, model.contacts().len()).map_err(|e| format!("{}: {e}", path.display()))?;
        place(&mut model, &places)?;
    }
    for (i, slider) in part.slider.iter().enumerate() {
        let said = |e: &dyn std::fmt::Display| format!("slider {}: {e}", i + 1);
        for contact in contacts_of(slider, &built.names).map_err(|e| said(&e))? {
            for (direction, at) in slider.place.iter().enumerate() {
                model.set_slider(contact, direction, *at).map_err(|e| said(&e))?;
            }
        }
    }
    for (name, list) in [("vibration_hz", &part.vibration_hz)] {
        if let Some(hz) = list.iter().find(|hz| !(**hz > 0.0 && hz.is_finite())) {
            return Err(format!("{name} has {hz}, needs frequencies above zero"));
        }
    }
    if part.csv.is_some() && part.factors.is_empty() && part.speeds.is_empty() {
        return Err("csv has the steps of a load history: needs factors or speeds".into());
    }
    Ok(model)
}

fn contacts_of(slider: &SliderPart, names: &Names) -> Outcome<std::ops::Range<usize>> {
    let Some((_, range)) = names.iter().find(|(name, _)| *name == slider.contact) else {
        let known: Vec<&str> = names.iter().map(|(name, _)| name.as_str()).collect();
        return Err(format!(
            "contact = \"{}\" is none of {}",
            slider.contact,
            known.join(", ")
        ));
    };
    if !(1..=2).contains(&slider.place.len()) {
        return Err(format!(
            "place has {}, needs 1 or 2: along t1, or along t1 and t2",
            counted(slider.place.len(), "number")
        ));
    }
    match slider.pair {
        None => Ok(range.clone()),
        Some(pair) if pair < range.len() => Ok(range.start + pair..range.start + pair + 1),
        Some(pair) => Err(format!(
            "pair = {pair}, needs 0 .. {} of contact \"{}\"",
            range.len(),
            slider.contact
        )),
    }
}

/// Directions in which a contact has a slider.
fn sliders(model: &Model, contact: usize) -> usize {
    model.contacts()[contact].sliders()
}

fn place(model: &mut Model, places: &[[f64; 2]]) -> Outcome<()> {
    for (contact, of_contact) in places.iter().enumerate() {
        for (direction, at) in of_contact.iter().enumerate() {
            if direction < sliders(model, contact) {
                model
                    .set_slider(contact, direction, *at)
                    .map_err(|e| format!("contact {contact}: {e}"))?;
            } else if *at != 0.0 {
                return Err(format!(
                    "contact {contact} has the place {at} along t{}, where it has no slider",
                    direction + 1
                ));
            }
        }
    }
    Ok(())
}

fn read_places(path: &Path, contacts: usize) -> Outcome<Vec<[f64; 2]>> {
    let all = hbvib_io::read_number_arrays(path).map_err(|e| e.to_string())?;
    let Some(found) = all.iter().find(|array| array.name == PLACES) else {
        return Err(format!("has no array {PLACES}"));
    };
    let fits = matches!(found.shape[..], [n, 2] | [_, n, 2] if n == contacts);
    if !fits || !found.imaginary.is_empty() || found.real.len() < 2 * contacts {
        return Err(format!(
            "{PLACES} has the shape {:?}, needs ({contacts}, 2) or (steps, {contacts}, 2) real numbers",
            found.shape
        ));
    }
    let last = &found.real[found.real.len() - 2 * contacts..];
    Ok(last.chunks_exact(2).map(|row| [row[0], row[1]]).collect())
}

/// Writes places as the array that [`read_places`] reads.
///
/// # Errors
/// A sentence of the system.
pub fn write_places(path: &Path, places: &[[f64; 2]]) -> Outcome<()> {
    let said = |e: std::io::Error| e.to_string();
    let mut npz = Npz::new(BufWriter::new(File::create(path).map_err(said)?));
    npz.real(PLACES, &[places.len(), 2], places.as_flattened())
        .map_err(said)?;
    npz.finish().map_err(said)
}

/// A row for each step and contact.
fn table(part: &ResidualPart, labels: &[String], steps: &[StaticStep]) -> String {
    let mut text = String::from("step,factor,speed,contact,place_t1,place_t2,force_t1,force_t2,force_n\n");
    let number = |list: &[f64], i: usize| list.get(i).map_or(String::new(), |x| format!("{x:.16e}"));
    for (i, step) in steps.iter().enumerate() {
        for ((label, place), force) in labels.iter().zip(&step.places).zip(&step.forces) {
            let _ = write!(
                text,
                "{i},{},{},{label}",
                number(&part.factors, i),
                number(&part.speeds, i)
            );
            for x in place.iter().chain(force) {
                let _ = write!(text, ",{x:.16e}");
            }
            text.push('\n');
        }
    }
    text
}
