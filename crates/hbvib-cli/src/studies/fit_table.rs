//! Columns of files with data of tests: CSV with names, vectors of MATLAB and NumPy files, functions and modes of universal files.

use crate::job_file::job_fit::{DataName, DataPart};
use crate::texts::outcome::Outcome;
use hbvib_io::{Function, Universal, read_number_arrays, read_universal};
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::path::Path;

/// Names that columns may have.
const NAMES: [&str; 12] = [
    "hz",
    "re",
    "im",
    "sigma",
    "amplitude",
    "damping",
    "sigma_hz",
    "sigma_damping",
    "log10_amplitude",
    "coherence",
    "time",
    "signal",
];

/// Columns with their names.
#[derive(Default)]
pub struct Table {
    columns: Vec<(String, Vec<f64>)>,
    pub rows: usize,
    /// Derivative by time that the signal of a universal file is: 0, 1 or 2.
    pub order: Option<i32>,
}

impl Table {
    /// Reads a file of any of the kinds.
    ///
    /// # Errors
    /// A sentence without the file.
    pub fn read(path: &Path, part: &DataPart) -> Outcome<Self> {
        let end = path.extension().and_then(|end| end.to_str()).unwrap_or_default();
        match end {
            "uff" | "unv" if part.kind == DataName::LinearMode => universal_mode(path, part),
            "uff" | "unv" if part.kind == DataName::Decay => universal_history(path, part),
            "uff" | "unv" => universal(path, part),
            "mat" | "npz" => arrays(path),
            _ => csv(path),
        }
    }

    /// A column, if the file has it.
    pub fn optional(&self, name: &str) -> Option<Vec<f64>> {
        let found = self.columns.iter().find(|(own, _)| own == name);
        found.map(|(_, values)| values.clone())
    }

    /// A column.
    ///
    /// # Errors
    /// A sentence.
    pub fn column(&self, name: &str) -> Outcome<Vec<f64>> {
        self.optional(name).ok_or_else(|| format!("has no column {name}"))
    }

    /// Refuses columns that have no meaning.
    ///
    /// # Errors
    /// A sentence with the column.
    pub fn used(&self) -> Outcome<()> {
        match self.columns.iter().find(|(name, _)| !NAMES.contains(&name.as_str())) {
            Some((name, _)) => Err(format!("has a column {name}, needs some of {}", NAMES.join(", "))),
            None => Ok(()),
        }
    }
}

fn csv(path: &Path) -> Outcome<Table> {
    let text = std::fs::read_to_string(path).map_err(|e| format!("cannot be read: {e}"))?;
    let mut table = Table::default();
    for (number, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let words: Vec<&str> = line.split(',').map(str::trim).collect();
        if table.columns.is_empty() {
            table.columns = words.iter().map(|word| ((*word).to_owned(), Vec::new())).collect();
            continue;
        }
        if words.len() != table.columns.len() {
            return Err(format!(
                "line {} has {} numbers, needs {} as the first",
                number + 1,
                words.len(),
                table.columns.len()
            ));
        }
        for ((name, values), word) in table.columns.iter_mut().zip(words) {
            let value: Result<f64, _> = word.parse();
            values.push(value.map_err(|_| format!("line {}: {name} = {word}, needs a number", number + 1))?);
        }
        table.rows += 1;
    }
    Ok(table)
}

/// Vectors of a MATLAB or NumPy file that have the names of columns; a complex `response` is re and im. Others are left out: such files
/// hold what else the test has.
fn arrays(path: &Path) -> Outcome<Table> {
    let mut table = Table::default();
    for array in read_number_arrays(path).map_err(|e| e.to_string())? {
        let is_vector = array.shape.iter().filter(|n| **n != 1).count() <= 1;
        let is_response = array.name == "response";
        if !is_vector || !(is_response || NAMES.contains(&array.name.as_str())) {
            continue;
        }
        if !table.columns.is_empty() && table.rows != array.real.len() {
            return Err(format!(
                "{} has {} numbers, needs {} as {}",
                array.name,
                array.real.len(),
                table.rows,
                table.columns[0].0
            ));
        }
        table.rows = array.real.len();
        if is_response {
            let mut imaginary = array.imaginary;
            imaginary.resize(table.rows, 0.0);
            table.columns.push(("re".into(), array.real));
            table.columns.push(("im".into(), imaginary));
        } else {
            table.columns.push((array.name, array.real));
        }
    }
    if table.columns.is_empty() {
        return Err(format!("has none of the vectors response, {}", NAMES.join(", ")));
    }
    Ok(table)
}

/// Frequency and damping ratio of a mode of a universal file.
fn universal_mode(path: &Path, part: &DataPart) -> Outcome<Table> {
    const NORMAL: i64 = 2;
    const COMPLEX: [i64; 2] = [3, 7];
    let all = read_universal(path).map_err(|e| e.to_string())?;
    let number = |integers: &[i64]| integers.get(1).copied();
    let is_wanted = |shape: &&hbvib_io::Shape| {
        (shape.analysis == NORMAL || COMPLEX.contains(&shape.analysis))
            && part
                .test_mode
                .is_none_or(|wanted| number(&shape.integers) == Some(wanted))
    };
    let Some(shape) = all.shapes.iter().find(is_wanted) else {
        return Err("has no mode (data set 55) of this number".into());
    };
    let real = |k: usize| shape.reals.get(k).copied().unwrap_or(0.0);
    let (hz, damping) = if shape.analysis == NORMAL {
        (real(0), real(2))
    } else {
        let size = real(0).hypot(real(1));
        (size / TAU, -real(0) / size)
    };
    Ok(Table {
        columns: vec![("hz".into(), vec![hz]), ("damping".into(), vec![damping])],
        rows: 1,
        order: None,
    })
}

/// The coherence at the same node and direction, where a file has it.
fn coherence_of(all: &Universal, function: &Function) -> Option<Vec<f64>> {
    const COHERENCE: i64 = 6;
    let is_its = |other: &&Function| {
        other.kind == COHERENCE
            && (other.response.0, other.response.1.abs()) == (function.response.0, function.response.1.abs())
            && other.abscissa == function.abscissa
    };
    let found = all.functions.iter().find(is_its)?;
    Some(found.values.iter().map(|(re, _)| *re).collect())
}

/// The derivative by time that the values of a function are.
fn order_of(function: &Function) -> Outcome<i32> {
    const VELOCITY: i64 = 11;
    const ACCELERATION: i64 = 12;
    match function.quantity {
        // Files that do not tell mean displacements, as Python's reader takes them.
        0 | 8 => Ok(0),
        VELOCITY => Ok(1),
        ACCELERATION => Ok(2),
        other => Err(format!(
            "the function has values of type {other} (data set 58, ninth line), needs 8 (displacement), 11 (velocity) or 12 (acceleration)"
        )),
    }
}

/// Whether a function is at the node and in the direction that a part names.
fn is_named(function: &Function, part: &DataPart) -> bool {
    part.node.is_none_or(|node| function.response.0 == node)
        && part.direction.is_none_or(|direction| function.response.1 == direction)
}

/// A history of a universal file.
fn universal_history(path: &Path, part: &DataPart) -> Outcome<Table> {
    const HISTORY: i64 = 1;
    let all = read_universal(path).map_err(|e| e.to_string())?;
    let is_wanted = |function: &&Function| function.kind == HISTORY && is_named(function, part);
    let Some(function) = all.functions.iter().find(is_wanted) else {
        return Err("has no history (data set 58 of type 1) at this node and direction".into());
    };
    let signal: Vec<f64> = function.values.iter().map(|(re, _)| *re).collect();
    Ok(Table {
        rows: signal.len(),
        order: Some(order_of(function)?),
        columns: vec![("time".into(), function.abscissa.clone()), ("signal".into(), signal)],
    })
}

/// The function of a universal file as displacements along the positive axes: times the force of the test where it is a frequency
/// response, and over iω for each order of a velocity or an acceleration.
fn universal(path: &Path, part: &DataPart) -> Outcome<Table> {
    const FREQUENCY_RESPONSE: i64 = 4;
    let all = read_universal(path).map_err(|e| e.to_string())?;
    // A coherence is no response.
    let is_wanted = |function: &&Function| function.kind != 6 && is_named(function, part);
    let Some(function) = all.functions.iter().find(is_wanted) else {
        return Err("has no function (data set 58) at this node and direction".into());
    };
    let order = order_of(function)?;
    let sense = |(_, direction): (i64, i64)| if direction < 0 { -1.0 } else { 1.0 };
    let mut factor = sense(function.response);
    if function.kind == FREQUENCY_RESPONSE {
        factor *= part.frf_force * sense(function.reference);
    }
    if order > 0 && function.abscissa.contains(&0.0) {
        return Err(
            "has a velocity or an acceleration at 0 Hz, which tells no displacement; leave that line out".into(),
        );
    }
    let values: Vec<Complex64> = function
        .abscissa
        .iter()
        .zip(&function.values)
        .map(|(hz, (re, im))| factor * Complex64::new(*re, *im) / Complex64::new(0.0, TAU * hz).powi(order))
        .collect();
    let mut columns = vec![
        ("hz".into(), function.abscissa.clone()),
        ("re".into(), values.iter().map(|z| z.re).collect()),
        ("im".into(), values.iter().map(|z| z.im).collect()),
        ("amplitude".into(), values.iter().map(|z| z.norm()).collect()),
    ];
    if let Some(coherence) = coherence_of(&all, function) {
        columns.push(("coherence".into(), coherence));
    }
    Ok(Table {
        columns,
        rows: values.len(),
        order: None,
    })
}
