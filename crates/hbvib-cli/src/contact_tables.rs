//! Hysteresis loops and slip fractions of contacts as CSV, and the figures beside them.

use crate::build::{Names, Outcome};
use crate::contact_figures::{loops_figure, slip_figure};
use crate::files::Files;
use crate::job::{HysteresisPart, Job};
use crate::points::chosen;
use hbvib::{Branch, ContactLoop, Special, State};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Most times of a loop.
const MOST_SAMPLES: usize = 1_000_000;

/// Writes what the job names. A loop that cannot be evaluated at one point is told, and left out.
pub fn write(job: &Job, branch: &Branch, names: &Names, files: &mut Files<'_>) {
    let labels = labels(names);
    files.write(job.output.slip_csv.as_deref(), &|path| {
        slip_table(path, branch, &labels)
    });
    files.write(job.output.slip_figure.as_deref(), &|path| {
        slip_figure(path, branch, &labels)
    });
    for part in &job.output.hysteresis {
        let contact = match part.contact(names) {
            Ok(contact) => contact,
            Err(e) => {
                files.fail(e);
                continue;
            }
        };
        let points = chosen(branch, part.points);
        let mut loops = Vec::new();
        for &point in &points {
            match branch.contact_loop(point.point, contact, part.samples) {
                Ok(found) => loops.push((point, found)),
                Err(e) => files.fail(format!(
                    "[[output.hysteresis]], contact \"{}\", {:.6} Hz: {e}",
                    part.contact,
                    point.omega / TAU
                )),
            }
        }
        if loops.is_empty() && !points.is_empty() {
            continue;
        }
        files.write(part.csv.as_deref(), &|path| loops_table(path, &loops));
        files.write(part.figure.as_deref(), &|path| {
            loops_figure(path, &labels[contact], &loops)
        });
    }
}

impl HysteresisPart {
    /// Number of the contact in the model.
    ///
    /// # Errors
    /// A sentence: an unknown name, no such pair.
    pub fn contact(&self, names: &Names) -> Outcome<usize> {
        let Some((_, range)) = names.iter().find(|(name, _)| *name == self.contact) else {
            let known: Vec<&str> = names.iter().map(|(name, _)| name.as_str()).collect();
            return Err(format!(
                "[[output.hysteresis]]: contact = \"{}\" is none of {}",
                self.contact,
                known.join(", ")
            ));
        };
        if self.pair >= range.len() {
            return Err(format!(
                "[[output.hysteresis]]: pair = {}, needs 0 .. {} of contact \"{}\"",
                self.pair,
                range.len(),
                self.contact
            ));
        }
        if !(1..=MOST_SAMPLES).contains(&self.samples) {
            return Err(format!(
                "[[output.hysteresis]], contact \"{}\": samples = {}, needs 1 .. {MOST_SAMPLES}",
                self.contact, self.samples
            ));
        }
        Ok(range.start + self.pair)
    }
}

/// Name of each contact: that of its entry, with the number of the pair where there are several.
fn labels(names: &Names) -> Vec<String> {
    let of = |(name, range): &(String, std::ops::Range<usize>)| -> Vec<String> {
        match range.len() {
            1 => vec![name.clone()],
            pairs => (0..pairs).map(|pair| format!("{name}[{pair}]")).collect(),
        }
    };
    names.iter().flat_map(of).collect()
}

/// A row for each time of each point; motions and forces in all directions of the contact.
fn loops_table(path: &Path, loops: &[(Special, ContactLoop)]) -> Outcome<()> {
    let directions = loops.first().map_or(1, |(_, one)| one.directions);
    let mut text = String::from("frequency_hz,angle");
    for quantity in ["motion", "force"] {
        for d in 0..directions {
            let _ = write!(text, ",{quantity}_{d}");
        }
    }
    text += ",state\n";
    for (point, one) in loops {
        let rows = one
            .motion
            .chunks_exact(directions)
            .zip(one.force.chunks_exact(directions));
        for (j, ((motion, force), state)) in rows.zip(&one.state).enumerate() {
            let angle = TAU * j as f64 / one.state.len() as f64;
            let _ = write!(text, "{:.16e},{angle:.16e}", point.omega / TAU);
            for value in motion.iter().chain(force) {
                let _ = write!(text, ",{value:.16e}");
            }
            text += match state {
                State::Stick => ",stick\n",
                State::Slip => ",slip\n",
                State::Open => ",open\n",
            };
        }
    }
    fs::write(path, text).map_err(|e| e.to_string())
}

/// A row for each point of the curve, a column for each contact.
fn slip_table(path: &Path, branch: &Branch, labels: &[String]) -> Outcome<()> {
    let mut text = String::from("frequency_hz");
    for label in labels {
        let _ = write!(text, ",\"{}\"", label.replace('"', "\"\""));
    }
    text += "\n";
    for point in 0..branch.points() {
        let _ = write!(text, "{:.16e}", branch.omega()[point] / TAU);
        for slip in branch.slip_fraction_at(point).unwrap_or(&[]) {
            let _ = write!(text, ",{slip:.10e}");
        }
        text += "\n";
    }
    fs::write(path, text).map_err(|e| e.to_string())
}
