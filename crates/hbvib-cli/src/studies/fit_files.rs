//! Data of tests as the library takes them, from the columns of files.

use crate::building::built::Built;
use crate::job_file::job_fit::{DataName, DataPart};
use crate::studies::decay;
use crate::studies::fit_table::Table;
use crate::texts::outcome::Outcome;
use hbvib::{DataKind, FitData, Response};
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
        let table = Table::read(&path, part).map_err(said)?;
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
                DataName::Backbone | DataName::Decay => DataKind::Backbone,
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
        if part.kind == DataName::Decay {
            found.fill_with_decay(&table, part).map_err(said)?;
            return Ok(found);
        }
        let hz = table.column("hz").map_err(said)?;
        let omega: Vec<f64> = hz.iter().map(|hz| TAU * hz).collect();
        let (first, second, sigma, scale) = match part.kind {
            DataName::Response => (table.column("re"), table.column("im"), "sigma", 1.0),
            DataName::Amplitude => (table.column("amplitude"), Ok(vec![0.0; rows]), "sigma", 1.0),
            DataName::Peak => (table.column("amplitude"), Ok(omega.clone()), "sigma", 1.0),
            DataName::Backbone | DataName::LinearMode | DataName::Decay => {
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
        let coherence = table.optional("coherence");
        let is_response = matches!(part.kind, DataName::Response | DataName::Amplitude);
        found.sigma = match (table.optional(sigma), part.sigma, part.averages) {
            (Some(column), ..) => column.into_iter().map(|s| scale * s).collect(),
            (None, Some(relative), _) => found.value.iter().map(|z| relative * size(z)).collect(),
            (None, None, Some(averages)) if is_response => {
                let coherence = coherence.ok_or_else(|| said("has no coherence: needs it with averages".into()))?;
                let sizes: Vec<f64> = found.value.iter().map(size).collect();
                of_coherence(&sizes, &coherence, averages).map_err(said)?
            }
            (None, None, _) => {
                return Err(said(format!(
                    "has no column {sigma}: needs it, or the key sigma, or coherence and the key averages"
                )));
            }
        };
        let (of_second, scale) = match part.kind {
            DataName::Peak => (table.optional("sigma_hz"), TAU),
            DataName::Backbone | DataName::LinearMode => (table.optional("sigma_damping"), 1.0),
            _ => (None, 1.0),
        };
        found.second_sigma = of_second.unwrap_or_default().into_iter().map(|s| scale * s).collect();
        table.used().map_err(said)?;
        Ok(found)
    }

    /// The windows of a decay as data of a backbone.
    fn fill_with_decay(&mut self, table: &Table, part: &DataPart) -> Outcome<()> {
        if !(part.shape.is_finite() && part.shape != 0.0) {
            return Err(format!("shape = {}, needs a finite number other than 0", part.shape));
        }
        table.used()?;
        let order = part.component.or(table.order).unwrap_or(0);
        let windows = decay::windows(&table.column("time")?, &table.column("signal")?, (part.cycles, order))?;
        self.x = windows
            .iter()
            .map(|w| (w.amplitude / part.shape.abs()).log10())
            .collect();
        self.value = windows
            .iter()
            .map(|w| Complex64::new(w.omega[0], w.damping[0]))
            .collect();
        self.sigma = windows.iter().map(|w| w.omega[1]).collect();
        self.second_sigma = windows.iter().map(|w| w.damping[1]).collect();
        Ok(())
    }

    /// Whether each of the two numbers of a datum is one.
    pub fn counts(&self) -> [bool; 2] {
        let second = match self.kind {
            DataKind::Response => true,
            DataKind::Amplitude => false,
            _ => !self.second_sigma.is_empty(),
        };
        [true, second]
    }

    /// Whether the set is a backbone.
    pub fn is_backbone(&self) -> bool {
        self.kind == DataKind::Backbone
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

/// Standard deviations of |H| from its coherence γ² and the number of averages n, |H| ((1 − γ²)/(γ² n))^½ (Bendat & Piersol 2010, Random
/// Data, doi:10.1002/9781118032428, section 9.2).
fn of_coherence(sizes: &[f64], coherence: &[f64], averages: f64) -> Outcome<Vec<f64>> {
    if averages.is_nan() || averages <= 1.0 {
        return Err(format!("averages = {averages}, needs a number > 1"));
    }
    let one = |(i, (size, squared)): (usize, (&f64, &f64))| {
        if *squared > 0.0 && *squared < 1.0 {
            Ok(size * ((1.0 - squared) / (squared * averages)).sqrt())
        } else {
            Err(format!(
                "coherence = {squared} at value {}, needs 0 < coherence < 1",
                i + 1
            ))
        }
    };
    sizes.iter().zip(coherence).enumerate().map(one).collect()
}
