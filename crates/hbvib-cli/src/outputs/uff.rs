//! Universal files (UFF): nodes (2411), responses over frequency (58) and shapes at points of the curve (55).

use crate::building::built::Built;
use crate::outputs::curve::Curve;
use crate::outputs::node_motion::{Places, harmonics};
use crate::texts::outcome::Outcome;
use hbvib::Special;
use hbvib_io::{Function, Shape, Universal, UniversalNode, write_universal};
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::path::Path;

/// Writes nodes, the response degree of freedom in each harmonic, and the shapes of points. Without names of nodes there are no nodes
/// and shapes, and the response has its degree of freedom as node 1 + its number.
///
/// # Errors
/// Those of the system and of the library.
pub fn write(
    path: &Path,
    (built, places): (&Built, Option<&Places>),
    curve: &Curve<'_>,
    points: &[Special],
) -> Outcome<()> {
    let mut all = Universal::default();
    if let Some(places) = places.filter(|places| !places.at.is_empty()) {
        let nodes = places.numbers.iter().zip(&places.at);
        all.nodes.extend(nodes.map(|(number, position)| UniversalNode {
            number: *number,
            position: *position,
        }));
    }
    all.functions = responses(built, curve)?;
    for special in places.map_or(&[][..], |_| points) {
        let Some(places) = places else { break };
        for (h, x) in harmonics(places, curve.branch, special.point)?.iter().enumerate() {
            if x.iter().flatten().any(|z| *z != Complex64::ZERO) {
                all.shapes.push(shape(places, (h, x), special));
            }
        }
    }
    write_universal(path, &all).map_err(|e| e.to_string())
}

/// The response degree of freedom in each harmonic that it has, complex over frequency.
fn responses(built: &Built, curve: &Curve<'_>) -> Outcome<Vec<Function>> {
    let (dof, omega, ndof) = (curve.branch.response_dof(), curve.omega(), curve.branch.ndof());
    let name = built.nodes.name_of(dof);
    let response = match name.split_once('.') {
        Some((node, direction)) => (node.parse().unwrap_or(0), direction.parse().unwrap_or(0)),
        None => (dof as i64 + 1, 0),
    };
    let mut all: Vec<Vec<(f64, f64)>> = vec![Vec::new(); curve.rows()];
    let mut x = Vec::new();
    for point in 0..curve.points() {
        curve.harmonics_at(point, &mut x)?;
        for (h, of) in all.iter_mut().enumerate() {
            let z = x[h * ndof + dof];
            of.push((z.re, z.im));
        }
    }
    let moves = |values: &[(f64, f64)]| values.iter().any(|value| *value != (0.0, 0.0));
    let with_motion = all.into_iter().enumerate().filter(|(_, values)| moves(values));
    Ok(with_motion
        .map(|(h, values)| Function {
            text: vec![
                format!("hbvib: response {name}, harmonic {h}"),
                "complex amplitude over the frequency of the excitation".into(),
            ],
            // A spectrum.
            kind: 12,
            response,
            reference: (0, 0),
            // Displacements.
            quantity: 8,
            abscissa: omega.iter().map(|omega| omega / TAU).collect(),
            values,
        })
        .collect())
}

/// A harmonic of all nodes at one point.
fn shape(places: &Places, (h, x): (usize, &[[Complex64; 3]]), special: &Special) -> Shape {
    let hertz = special.omega / TAU;
    let moving = (0..x.len()).filter(|i| places.moves(*i));
    Shape {
        text: vec![
            format!("hbvib: motion in harmonic {h}"),
            format!("{hertz:.9} Hz, amplitude of the response {:.6e}", special.amplitude),
        ],
        // A frequency response.
        analysis: 5,
        integers: vec![1, h as i64],
        reals: vec![hertz],
        nodes: moving.clone().map(|i| places.numbers[i]).collect(),
        per_node: 3,
        values: moving.flat_map(|i| x[i]).map(|z| (z.re, z.im)).collect(),
    }
}
