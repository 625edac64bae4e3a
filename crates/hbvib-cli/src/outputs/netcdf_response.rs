//! A response as NetCDF: all harmonics of all points by node and direction, with positions and units, for xarray, scipy and MATLAB.

use crate::building::built::Built;
use crate::building::responses;
use crate::job_file::job::Job;
use crate::outputs::curve::Curve;
use crate::outputs::netcdf::{Dataset, Kind, Numbers, UNLIMITED};
use crate::outputs::node_motion::Places;
use crate::texts::outcome::Outcome;
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::path::Path;

/// Unit where the job names none.
const MODEL: &str = "unit of the model";

/// Numbers of a variable.
type Of<'a> = Box<dyn Fn(Option<usize>, &[Complex64]) -> Numbers + 'a>;

/// Writes all points of a branch. Rows without names of nodes are numbered.
///
/// # Errors
/// A sentence.
pub fn write(path: &Path, job: &Job, (built, places): (&Built, Option<&Places>), curve: &Curve<'_>) -> Outcome<()> {
    let branch = curve.branch;
    let (omega, height, used) = (curve.omega(), curve.amplitude(), curve.harmonics_used());
    let length = job.output.units.length.as_deref().unwrap_or(MODEL);
    let mut data = Dataset::default();
    data.attribute("title", "Steady-state response, all harmonics");
    data.attribute("source", concat!("hbvib ", env!("CARGO_PKG_VERSION")));
    let mut convention =
        "x(t) = Re sum_h (displacement_real + i displacement_imag) exp(i h 2 pi frequency t)".to_owned();
    if branch.reduction().sectors > 1 {
        convention += ", of sector 0; in harmonic h sector s + 1 lags sector s by h 2 pi engine_order / sectors";
    }
    data.attribute("convention", &convention);
    data.attribute("response_dof", &built.nodes.name_of(branch.response_dof()));
    let point = data.dimension("point", UNLIMITED);
    let harmonic = data.dimension("harmonic", curve.rows());
    let mut of: Vec<Of<'_>> = Vec::new();
    let frequency = [("units", "Hz"), ("long_name", "frequency of the excitation")];
    data.variable("frequency", Kind::Real, &[point], &frequency);
    of.push(Box::new(|p, _| one(omega[p.unwrap_or(0)] / TAU)));
    let (long_name, unit) = responses::amplitude(job);
    let amplitude = [("units", unit.as_deref().unwrap_or(MODEL)), ("long_name", &long_name)];
    data.variable("amplitude", Kind::Real, &[point], &amplitude);
    of.push(Box::new(|p, _| one(height[p.unwrap_or(0)])));
    data.variable("harmonics_used", Kind::Real, &[point], &[("units", "1")]);
    of.push(Box::new(|p, _| one(used[p.unwrap_or(0)])));
    data.variable("harmonic", Kind::Integer, &[harmonic], &[("units", "1")]);
    of.push(Box::new(|_, _| Numbers::Integers((0..curve.rows() as i32).collect())));
    if branch.contacts() > 0 {
        contacts(&mut data, &mut of, built, (curve, point));
    }
    let mut motion = vec![point, harmonic];
    match places {
        Some(places) => motion.extend(nodes(&mut data, &mut of, places, length)),
        None => motion.push(data.dimension("dof", branch.ndof())),
    }
    for (name, part) in [
        ("displacement_real", (|z| z.re) as fn(Complex64) -> f64),
        ("displacement_imag", |z| z.im),
    ] {
        data.variable(
            name,
            Kind::Real,
            &motion,
            &[("units", length), ("coordinates", "frequency")],
        );
        of.push(Box::new(move |_, x| {
            let all: Vec<f64> = match places {
                Some(places) => x
                    .chunks_exact(branch.ndof())
                    .flat_map(|x| places.motion(x))
                    .flat_map(|u| u.map(part))
                    .collect(),
                None => x.iter().map(|z| part(*z)).collect(),
            };
            Numbers::Reals(all)
        }));
    }
    let mut x = Vec::new();
    let mut current = None;
    data.write(path, curve.points(), &mut |variable, record| {
        if record.is_some() && record != current {
            current = record;
            curve.harmonics_at(record.unwrap_or(0), &mut x)?;
        }
        Ok(of[variable](record, &x))
    })
}

fn one(value: f64) -> Numbers {
    Numbers::Reals(vec![value])
}

/// Adds the slip share of each contact and the names of the contacts.
fn contacts<'a>(data: &mut Dataset, of: &mut Vec<Of<'a>>, built: &'a Built, (curve, point): (&'a Curve<'a>, usize)) {
    let contact = data.dimension("contact", curve.branch.contacts());
    let labels = built.labels();
    let width = labels.iter().map(String::len).max().unwrap_or(0).max(1);
    let letters = data.dimension("letters", width);
    data.variable("contact_name", Kind::Text, &[contact, letters], &[]);
    of.push(Box::new(move |_, _| {
        let padded = labels.iter().flat_map(|label| {
            let mut bytes = label.clone().into_bytes();
            bytes.resize(width, 0);
            bytes
        });
        Numbers::Text(padded.collect())
    }));
    let slip = [
        ("units", "1"),
        ("long_name", "share of the period in which the contact slips"),
    ];
    data.variable("slip_fraction", Kind::Real, &[point, contact], &slip);
    of.push(Box::new(move |p, _| {
        Numbers::Reals(curve.slip(p.unwrap_or(0)).to_vec())
    }));
}

/// Adds nodes, directions and positions; returns their dimensions.
fn nodes<'a>(data: &mut Dataset, of: &mut Vec<Of<'a>>, places: &'a Places, length: &str) -> [usize; 2] {
    let node = data.dimension("node", places.numbers.len());
    let direction = data.dimension("direction", 3);
    // Numbers beyond 32 bits are whole reals.
    let small: Option<Vec<i32>> = places.numbers.iter().map(|n| i32::try_from(*n).ok()).collect();
    let kind = if small.is_some() { Kind::Integer } else { Kind::Real };
    data.variable(
        "node",
        kind,
        &[node],
        &[("long_name", "number of the node in the mesh")],
    );
    of.push(Box::new(move |_, _| match &small {
        Some(small) => Numbers::Integers(small.clone()),
        None => Numbers::Reals(places.numbers.iter().map(|n| *n as f64).collect()),
    }));
    let single = data.dimension("letter", 1);
    data.variable(
        "direction",
        Kind::Text,
        &[direction, single],
        &[("long_name", "direction of the motion")],
    );
    of.push(Box::new(|_, _| Numbers::Text(b"xyz".to_vec())));
    data.variable(
        "has_rows",
        Kind::Integer,
        &[node],
        &[("long_name", "0: fixed, or follows others by a constraint")],
    );
    of.push(Box::new(|_, _| {
        Numbers::Integers((0..places.numbers.len()).map(|i| places.moves(i).into()).collect())
    }));
    if !places.at.is_empty() {
        for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
            data.variable(name, Kind::Real, &[node], &[("units", length)]);
            of.push(Box::new(move |_, _| {
                Numbers::Reals(places.at.iter().map(|x| x[k]).collect())
            }));
        }
    }
    [node, direction]
}
