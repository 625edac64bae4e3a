//! State of every contact of the patch at a resonance: maps over the patch, and hysteresis loops.

use std::io::Write;
use std::path::Path;

use hbvib::results::ContactSummary;

use crate::beam::{Beam, Spot};
use crate::csv::write_csv;
use crate::figures::Outcome;
use crate::plot::{Figure, Series, Style};
use crate::response::Response;

/// Number of times of a loop.
const TIMES: usize = 512;

/// Number of classes of a map, more than six, so that their colours form a scale.
const CLASSES: usize = 8;

/// A mapped quantity: name of its file, title, unit, and its value for a contact.
type Quantity = (
    &'static str,
    &'static str,
    &'static str,
    fn(&ContactSummary, &Spot) -> f64,
);

const QUANTITIES: [Quantity; 5] = [
    ("slip", "Share of the period that the contacts slip", "%", |c, _| {
        100.0 * c.slip_share
    }),
    ("open", "Share of the period that the contacts are open", "%", |c, _| {
        100.0 * c.open_share
    }),
    ("pressure_min", "Smallest pressure over the period", "kPa", |c, s| {
        1e-3 * c.load_min / s.area
    }),
    ("pressure_max", "Largest pressure over the period", "kPa", |c, s| {
        1e-3 * c.load_max / s.area
    }),
    ("work", "Dissipated work per cycle and area", "mJ/m²", |c, s| {
        1e3 * c.work / s.area
    }),
];

/// Maps, a table and loops at the peak of a response.
pub fn draw(beam: &Beam, response: &Response, force: f64, folder: &Path, screen: &mut impl Write) -> Outcome {
    let (branch, point) = (&response.branch, response.peak.number);
    let spots = beam.spots();
    let mut contacts = Vec::new();
    for contact in 0..spots.len() {
        contacts.push(branch.contact_summary(point, contact)?);
    }
    let header = [
        "x_m",
        "z_m",
        "area_m2",
        "slip_share",
        "open_share",
        "load_min_N",
        "load_max_N",
        "work_J",
    ];
    let rows: Vec<Vec<f64>> = contacts
        .iter()
        .zip(&spots)
        .map(|(c, s)| {
            vec![
                s.x,
                s.z,
                s.area,
                c.slip_share,
                c.open_share,
                c.load_min,
                c.load_max,
                c.work,
            ]
        })
        .collect();
    write_csv(folder.join("contacts.csv"), &header, &rows)?;
    for (name, title, unit, of) in QUANTITIES {
        let values: Vec<f64> = contacts.iter().zip(&spots).map(|(c, s)| of(c, s)).collect();
        writeln!(
            screen,
            "  {title} [{unit}]; rows across the beam, from the clamp to the free end"
        )?;
        for row in values.chunks(beam.elements[2] + 1) {
            for value in row {
                write!(screen, "{value:>9.2}")?;
            }
            writeln!(screen)?;
        }
        let series = classes(&values, &spots);
        // A map needs more than one class.
        if series.len() > 1 {
            let figure = Figure {
                title: format!("{title}, {force} N at {:.1} Hz", response.peak.frequency),
                x_label: "Position along the beam [mm]".into(),
                y_label: "Position across [mm]".into(),
                legend_title: unit.into(),
                series,
                ..Figure::default()
            };
            figure.save(&folder.join(format!("map_{name}")))?;
        }
    }
    loops(beam, response, force, folder)
}

/// The nodes by classes of their values, evenly spaced from the smallest to the largest.
fn classes(values: &[f64], spots: &[Spot]) -> Vec<Series> {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let width = (largest - least) / CLASSES as f64;
    if width <= 1e-9 * largest.abs() {
        return Vec::new();
    }
    let class = |value: f64| (((value - least) / width) as usize).min(CLASSES - 1);
    let one = |k: usize| {
        let inside = values.iter().zip(spots).filter(|(v, _)| class(**v) == k);
        let points = inside.map(|(_, s)| (1e3 * s.x, 1e3 * s.z)).collect();
        let from = least + width * k as f64;
        Series::new(format!("{from:.1} to {:.1}", from + width), Style::Tiles, points)
    };
    (0..CLASSES).map(one).collect()
}

/// Friction across the beam against motion across, per area, for the corners and the middle of the patch.
fn loops(beam: &Beam, response: &Response, force: f64, folder: &Path) -> Outcome {
    let (branch, point) = (&response.branch, response.peak.number);
    let spots = beam.spots();
    let (across, all) = (beam.elements[2] + 1, spots.len());
    let mut series = Vec::new();
    let mut rows = Vec::new();
    for (label, contact) in [
        ("corner to the clamp", 0),
        ("middle", all / across / 2 * across + across / 2),
        ("corner at the free end, z < 0", all - across),
        ("corner at the free end, z > 0", all - 1),
    ] {
        let area = spots[contact].area;
        let found = branch.contact_loop(point, contact, TIMES)?;
        let times = found.motion.chunks_exact(found.directions);
        let mut points = Vec::new();
        for (motion, force) in times.zip(found.force.chunks_exact(found.directions)) {
            points.push((1e6 * motion[0], 1e-3 * force[0] / area));
            rows.push([&[contact as f64], motion, force].concat());
        }
        points.extend(points.first().copied());
        series.push(Series::new(label, Style::Line, points));
    }
    let header = [
        "contact",
        "motion_z_m",
        "motion_x_m",
        "motion_y_m",
        "force_z_N",
        "force_x_N",
        "force_y_N",
    ];
    write_csv(folder.join("loops.csv"), &header, &rows)?;
    let figure = Figure {
        title: format!(
            "Hysteresis across the beam, {force} N at {:.1} Hz",
            response.peak.frequency
        ),
        x_label: "Motion across [µm]".into(),
        y_label: "Friction across [kPa]".into(),
        legend_title: "Contact".into(),
        series,
        ..Figure::default()
    };
    figure.save(&folder.join("loops"))
}
