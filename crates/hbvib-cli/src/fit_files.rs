//! Files with data of tests: CSV with named columns, and functions of universal files.

use crate::build::{Built, Outcome};
use crate::job_fit::{DataName, DataPart};
use hbvib::{DataKind, FitData, Response};
use hbvib_io::read_universal;
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::path::Path;

/// Data of a set, in memory of their own.
pub struct Data {
    kind: DataKind,
    force: f64,
    dofs: Vec<usize>,
    mode: usize,
    range: Option<(f64, f64)>,
    pub x: Vec<f64>,
    pub value: Vec<Complex64>,
    sigma: Vec<f64>,
    second_sigma: Vec<f64>,
}

impl Data {
    /// Reads a set.
    ///
    /// # Errors
    /// A sentence with the file.
    pub fn read(part: &DataPart, built: &Built, folder: &Path) -> Outcome<Self> {
        let path = folder.join(&part.file);
        let said = |e: String| format!("{}: {e}", path.display());
        let is_universal = path.extension().is_some_and(|end| end == "uff" || end == "unv");
        let mut table = if is_universal {
            universal(&path, part).map_err(said)?
        } else {
            csv(&path).map_err(said)?
        };
        let rows = table.rows;
        if rows == 0 {
            return Err(said("holds no data".into()));
        }
        let range = match (part.from_hz, part.to_hz) {
            (Some(from), Some(to)) => Some((TAU * from, TAU * to)),
            (None, None) => None,
            _ => return Err("from_hz and to_hz: needs both or none".into()),
        };
        let mut found = Self {
            kind: match part.kind {
                DataName::Response => DataKind::Response,
                DataName::Amplitude => DataKind::Amplitude,
                DataName::Peak => DataKind::Peak,
                DataName::Backbone => DataKind::Backbone,
                DataName::LinearMode => DataKind::LinearMode,
            },
            force: part.force,
            dofs: Vec::new(),
            mode: part.mode,
            range,
            x: vec![0.0; rows],
            value: Vec::new(),
            sigma: Vec::new(),
            second_sigma: Vec::new(),
        };
        if let Some(name) = &part.dof {
            found.dofs.push(built.nodes.dof(name).map_err(|e| format!("dof: {e}"))?);
        }
        let hz = table.column("hz").map_err(said)?;
        let omega: Vec<f64> = hz.iter().map(|hz| TAU * hz).collect();
        let (first, second, sigma, scale) = match part.kind {
            DataName::Response => (table.column("re"), table.column("im"), "sigma", 1.0),
            DataName::Amplitude => (table.column("amplitude"), Ok(vec![0.0; rows]), "sigma", 1.0),
            DataName::Peak => (table.column("amplitude"), Ok(omega.clone()), "sigma", 1.0),
            DataName::Backbone | DataName::LinearMode => {
                let damping = table.optional("damping").unwrap_or_else(|| vec![0.0; rows]);
                (Ok(omega.clone()), Ok(damping), "sigma_hz", TAU)
            }
        };
        match part.kind {
            DataName::Backbone => found.x = table.column("log10_amplitude").map_err(said)?,
            DataName::LinearMode => {}
            _ => found.x = omega,
        }
        let (first, second) = (first.map_err(said)?, second.map_err(said)?);
        found.value = first
            .into_iter()
            .zip(second)
            .map(|(re, im)| Complex64::new(re, im))
            .collect();
        let size = |z: &Complex64| {
            if part.kind == DataName::Response {
                z.norm()
            } else {
                z.re.abs()
            }
        };
        found.sigma = match (table.optional(sigma), part.sigma) {
            (Some(column), _) => column.into_iter().map(|s| scale * s).collect(),
            (None, Some(relative)) => found.value.iter().map(|z| relative * size(z)).collect(),
            (None, None) => return Err(said(format!("has no column {sigma}: needs it, or the key sigma"))),
        };
        let (of_second, scale) = match part.kind {
            DataName::Peak => (table.optional("sigma_hz"), TAU),
            DataName::Backbone | DataName::LinearMode => (table.optional("sigma_damping"), 1.0),
            _ => (None, 1.0),
        };
        found.second_sigma = of_second.unwrap_or_default().into_iter().map(|s| scale * s).collect();
        table
            .used(&[
                "hz",
                "re",
                "im",
                "sigma",
                "amplitude",
                "damping",
                "sigma_hz",
                "sigma_damping",
                "log10_amplitude",
            ])
            .map_err(said)?;
        Ok(found)
    }

    /// The set as the library takes it.
    pub fn set(&self) -> FitData<'_> {
        FitData {
            kind: self.kind,
            force_factor: self.force,
            response: Response {
                dofs: &self.dofs,
                ..Response::default()
            },
            mode: self.mode,
            range: self.range,
            x: &self.x,
            value: &self.value,
            sigma: &self.sigma,
            second_sigma: &self.second_sigma,
        }
    }

    /// Size of a datum or of a value of the model, for figures; `None` for modes.
    pub fn size(&self, first: f64, second: f64) -> Option<f64> {
        match self.kind {
            DataKind::Response => Some(first.hypot(second)),
            DataKind::Amplitude => Some(first),
            _ => None,
        }
    }
}

/// Columns with their names.
#[derive(Default)]
struct Table {
    columns: Vec<(String, Vec<f64>)>,
    rows: usize,
}

impl Table {
    fn optional(&mut self, name: &str) -> Option<Vec<f64>> {
        let found = self.columns.iter().find(|(own, _)| own == name);
        found.map(|(_, values)| values.clone())
    }

    fn column(&mut self, name: &str) -> Outcome<Vec<f64>> {
        self.optional(name).ok_or_else(|| format!("has no column {name}"))
    }

    /// Refuses columns that have no meaning.
    fn used(&self, known: &[&str]) -> Outcome<()> {
        match self.columns.iter().find(|(name, _)| !known.contains(&name.as_str())) {
            Some((name, _)) => Err(format!("has a column {name}, needs some of {}", known.join(", "))),
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

/// The function of a universal file as displacements along the positive axes: times the force of the test where it is a frequency
/// response, and over iω for each order of a velocity or an acceleration.
fn universal(path: &Path, part: &DataPart) -> Outcome<Table> {
    const FREQUENCY_RESPONSE: i64 = 4;
    const VELOCITY: i64 = 11;
    const ACCELERATION: i64 = 12;
    let all = read_universal(path).map_err(|e| e.to_string())?;
    let is_wanted = |function: &&hbvib_io::Function| {
        part.node.is_none_or(|node| function.response.0 == node)
            && part.direction.is_none_or(|direction| function.response.1 == direction)
    };
    let Some(function) = all.functions.iter().find(is_wanted) else {
        return Err("has no function (data set 58) at this node and direction".into());
    };
    let order = match function.quantity {
        // Files that do not tell mean displacements, as Python's reader takes them.
        0 | 8 => 0,
        VELOCITY => 1,
        ACCELERATION => 2,
        other => {
            return Err(format!(
                "the function has values of type {other} (data set 58, ninth line), needs 8 (displacement), 11 (velocity) or 12 (acceleration)"
            ));
        }
    };
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
    Ok(Table {
        columns: vec![
            ("hz".into(), function.abscissa.clone()),
            ("re".into(), values.iter().map(|z| z.re).collect()),
            ("im".into(), values.iter().map(|z| z.im).collect()),
            ("amplitude".into(), values.iter().map(|z| z.norm()).collect()),
        ],
        rows: values.len(),
    })
}
