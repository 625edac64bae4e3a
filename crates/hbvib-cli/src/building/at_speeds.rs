//! The stiffness over speed from matrices at two speeds: K(Ω) = K + Ω² K1.

use crate::job_file::job::{AtSpeedPart, Job};
use crate::texts::outcome::Outcome;
use hbvib_io::{Matrices, Matrix, Symmetry};
use std::collections::BTreeMap;

/// Difference of masses at both speeds over the largest entry, up to which they are the same.
const SAME: f64 = 1e-9;

/// Difference of the squares of both speeds over the larger one, below which rounding of the files shows.
const APART: f64 = 1e-3;

/// Matrices at rest, and K1, from those at two speeds.
///
/// # Errors
/// A sentence: other keys that name the same matrices, no two speeds, models that differ.
pub fn at_speeds(job: &Job) -> Outcome<(Matrices, Matrix)> {
    let model = &job.model;
    let [a, b] = &model.at_speed[..] else {
        return Err(format!("has {} speeds, needs two", model.at_speed.len()));
    };
    let [wa, wb] = [a, b].map(|part| part.speed * part.speed);
    if !(wa.is_finite() && wb.is_finite()) || (wb - wa).abs() <= APART * wa.max(wb) {
        return Err(format!(
            "speeds {} and {}: needs two of other magnitudes",
            a.speed, b.speed
        ));
    }
    for (key, named) in [
        ("matrices", model.matrices.is_some()),
        ("stiffness", model.stiffness.is_some()),
        ("mass", model.mass.is_some()),
        ("stiffness_speed2", model.stiffness_speed2.is_some()),
    ] {
        if named {
            return Err(format!("takes the place of {key}; needs one of them"));
        }
    }
    if model.speed.is_none() && model.speed_per_omega.is_none() {
        return Err("needs the speed of the model: speed or speed_per_omega in [model]".into());
    }
    let read = |part: &AtSpeedPart| hbvib_io::read(&job.path(&part.matrices)).map_err(|e| e.to_string());
    let (mut first, second) = (read(a)?, read(b)?);
    let names = (a.matrices.display(), b.matrices.display());
    if first.dofs != second.dofs {
        return Err(format!("{} and {} name other nodes and directions", names.0, names.1));
    }
    let (Some(ka), Some(kb), Some(ma), Some(mb)) = (&first.stiffness, &second.stiffness, &first.mass, &second.mass)
    else {
        return Err(format!("{} and {} need a stiffness and a mass each", names.0, names.1));
    };
    let gap = combined((ma, 1.0), (mb, -1.0)).map_err(|e| format!("mass: {e}"))?;
    let largest = |a: &Matrix| a.values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    if largest(&gap) > SAME * largest(ma) {
        return Err(format!("the masses of {} and {} differ", names.0, names.1));
    }
    let said = |e: String| format!("stiffness: {e}");
    let of_speed = combined((kb, 1.0 / (wb - wa)), (ka, -1.0 / (wb - wa))).map_err(said)?;
    let at_rest = combined((ka, wb / (wb - wa)), (kb, -wa / (wb - wa))).map_err(said)?;
    first.stiffness = Some(at_rest);
    Ok((first, of_speed))
}

/// A weighted sum of two real matrices.
fn combined((a, x): (&Matrix, f64), (b, y): (&Matrix, f64)) -> Outcome<Matrix> {
    if (a.rows, a.columns) != (b.rows, b.columns) {
        return Err(format!("{} x {} and {} x {}", a.rows, a.columns, b.rows, b.columns));
    }
    if a.is_complex || b.is_complex {
        return Err("is complex, needs a real one".into());
    }
    let symmetric = a.symmetry == Symmetry::Symmetric && b.symmetry == Symmetry::Symmetric;
    if !symmetric && (a.symmetry, b.symmetry) != (Symmetry::General, Symmetry::General) {
        return Err("is symmetric at one speed alone".into());
    }
    let mut sums: BTreeMap<(u32, u32), f64> = BTreeMap::new();
    for (of, weight) in [(a, x), (b, y)] {
        for ((row, column), value) in of.row.iter().zip(&of.column).zip(&of.values) {
            let place = if symmetric {
                (*row.max(column), *row.min(column))
            } else {
                (*row, *column)
            };
            *sums.entry(place).or_default() += weight * value;
        }
    }
    Ok(Matrix {
        rows: a.rows,
        columns: a.columns,
        symmetry: a.symmetry,
        row: sums.keys().map(|(row, _)| *row).collect(),
        column: sums.keys().map(|(_, column)| *column).collect(),
        values: sums.into_values().collect(),
        is_complex: false,
    })
}
