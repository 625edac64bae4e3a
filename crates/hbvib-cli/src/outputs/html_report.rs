//! The report of a run: one page of HTML with its figures inside, which needs no network.

use crate::building::built::Built;
use crate::building::responses;
use crate::job_file::job::{Job, PointsName};
use crate::meshes::mesh_picture;
use crate::outputs::contact_figures::{loops_svg, slip_svg};
use crate::outputs::curve::Curve;
use crate::outputs::files::Files;
use crate::outputs::line_chart::{Chart, Line};
use crate::outputs::node_motion::{ContactField, Places};
use crate::outputs::output;
use crate::outputs::points::chosen;
use crate::outputs::vtu::escaped;
use crate::texts::outcome::Outcome;
use hbvib::{Branch, Special};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;

/// Contacts whose hysteresis loops are drawn: those that take most work.
const LOOPS: usize = 3;

/// Rows of a table.
const ROWS: usize = 200;

/// Times of a loop.
const TIMES: usize = 256;

const STYLE: &str = "body{font-family:sans-serif;max-width:62em;margin:2em auto;padding:0 1em;color:#222}\
h1{font-size:1.5em}h2{font-size:1.2em;border-bottom:1px solid #ccc;margin-top:2em}\
table{border-collapse:collapse;margin:1em 0}td,th{border:1px solid #ccc;padding:.2em .6em;text-align:right}\
th{background:#f2f2f2}td:first-child,th:first-child{text-align:left}\
pre{background:#f7f7f7;padding:1em;white-space:pre-wrap}.warning{color:#a00}svg{max-width:100%;height:auto}";

/// Writes the report that a job names. A part that cannot be made says so in its place.
pub fn write(job: &Job, curve: &Curve<'_>, built: &Built, files: &mut Files<'_>) {
    files.write(job.output.report.as_deref(), &|path| {
        fs::write(path, page(job, curve, built)).map_err(|e| e.to_string())
    });
}

/// The page.
fn page(job: &Job, curve: &Curve<'_>, built: &Built) -> String {
    let (name, unit) = responses::amplitude(job);
    let (branch, unit) = (curve.branch, unit.map_or(String::new(), |unit| format!(", {unit}")));
    let mut text = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>hbvib report</title>\n<style>{STYLE}</style>\n</head>\n\
         <body>\n<h1>Steady-state response</h1>\n<p>hbvib {}</p>\n<h2>Summary</h2>\n<pre>{}</pre>\n",
        env!("CARGO_PKG_VERSION"),
        escaped(&output::summary(curve, &built.nodes))
    );
    part(&mut text, "Response", response(curve, &unit));
    let _ = writeln!(text, "<p>The amplitude is the {}.</p>", escaped(&name));
    text += &special(curve, &unit);
    let highest = chosen(branch, PointsName::HighestPeak).first().copied();
    if let (Some(at), true) = (highest, branch.contacts() > 0) {
        let hertz = at.omega / TAU;
        part(&mut text, "Slip of the contacts", slip_svg(curve, &built.labels()));
        part(
            &mut text,
            &format!("Contacts at {hertz:.6} Hz"),
            contacts(branch, built, at),
        );
        let picture = Places::of(job, built).and_then(|places| {
            places.needs_mesh()?;
            let field = ContactField::of(&places, built, branch, (at.point, 1))?;
            Ok(mesh_picture::svg(&places, &field))
        });
        // Without a mesh there is nothing to show.
        if let Ok(picture) = picture {
            part(
                &mut text,
                "Contacts on the mesh: pale where they stick, dark where they slip",
                Ok(picture),
            );
        }
    }
    text += "<h2>Model</h2>\n";
    for warning in &built.report.warnings {
        let _ = writeln!(text, "<p class=\"warning\">warning: {}</p>", escaped(warning));
    }
    text += "<ul>\n";
    for fact in &built.report.facts {
        let _ = writeln!(text, "<li>{}</li>", escaped(fact));
    }
    let _ = write!(
        text,
        "</ul>\n<h2>Job</h2>\n<pre>{}</pre>\n</body>\n</html>\n",
        escaped(&job.text)
    );
    text
}

/// A part with its title, or the reason why it is not there.
fn part(text: &mut String, title: &str, content: Outcome<String>) {
    let _ = writeln!(text, "<h2>{}</h2>", escaped(title));
    match content {
        Ok(content) => *text += &content,
        Err(e) => {
            let _ = writeln!(text, "<p class=\"warning\">could not be made: {}</p>", escaped(&e));
        }
    }
}

/// Amplitude over frequency, with the peaks.
fn response(curve: &Curve<'_>, unit: &str) -> Outcome<String> {
    let place = |[omega, amplitude]: &[f64; 2]| (omega / TAU, *amplitude);
    let points = curve.omega().into_iter().zip(curve.amplitude());
    let chart = Chart {
        title: String::new(),
        x_label: "frequency, Hz".into(),
        y_label: format!("amplitude{unit}"),
        log_x: false,
        log_y: false,
        markers: true,
        lines: vec![Line {
            name: "response".into(),
            points: points.map(|(omega, amplitude)| (omega / TAU, amplitude)).collect(),
            marked: curve.special(false).iter().map(place).collect(),
        }],
    };
    chart.svg()
}

/// Peaks, folds and requested solutions.
fn special(curve: &Curve<'_>, unit: &str) -> String {
    let mut text = format!(
        "<table>\n<tr><th>point</th><th>frequency, Hz</th><th>amplitude{}</th></tr>\n",
        escaped(unit)
    );
    let requested: Vec<[f64; 2]> = curve.requested().iter().map(|row| [row[1], row[2]]).collect();
    let all = [
        ("peak", curve.special(false)),
        ("fold", curve.special(true)),
        ("requested", requested),
    ];
    let rows = all.iter().flat_map(|(name, of)| of.iter().map(move |row| (name, row)));
    for (name, [omega, amplitude]) in rows.take(ROWS) {
        let _ = writeln!(
            text,
            "<tr><td>{name}</td><td>{:.6}</td><td>{amplitude:.6e}</td></tr>",
            omega / TAU
        );
    }
    text + "</table>\n"
}

/// A table of all contacts at a point, and loops of those that take most work.
fn contacts(branch: &Branch, built: &Built, at: Special) -> Outcome<String> {
    let labels = built.labels();
    let mut rows = Vec::new();
    for (id, label) in labels.iter().enumerate() {
        let found = branch
            .contact_summary(at.point, id)
            .map_err(|e| format!("contact {label}: {e}"))?;
        rows.push((id, label, found));
    }
    rows.sort_by(|a, b| b.2.work.abs().total_cmp(&a.2.work.abs()));
    let mut text = String::from(
        "<table>\n<tr><th>contact</th><th>work of a cycle</th><th>slip share</th><th>open share</th><th>smallest load</th>\
         <th>largest load</th></tr>\n",
    );
    for (_, label, found) in rows.iter().take(ROWS) {
        let _ = writeln!(
            text,
            "<tr><td>{}</td><td>{:.4e}</td><td>{:.4}</td><td>{:.4}</td><td>{:.4e}</td><td>{:.4e}</td></tr>",
            escaped(label),
            found.work,
            found.slip_share,
            found.open_share,
            found.load_min,
            found.load_max
        );
    }
    text += "</table>\n";
    if rows.len() > ROWS {
        let _ = writeln!(text, "<p>{} contacts in all; these take most work.</p>", rows.len());
    }
    for (id, label, _) in rows.iter().take(LOOPS) {
        let one = branch.contact_loop(at.point, *id, TIMES).map_err(|e| e.to_string())?;
        text += &loops_svg(label, &[(at, one)])?;
    }
    Ok(text)
}
