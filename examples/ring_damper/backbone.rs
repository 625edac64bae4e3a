//! One nonlinear mode of the bladed disk, complete or refused: its points and their JSON.

use std::error::Error;
use std::f64::consts::TAU;

use hbvib::analysis::nonlinear_mode;
use hbvib::error::{Result as Checked, Status};
use hbvib::hooks::{Hooks, Progress};
use hbvib::options::{Amplitude, DampingForm, ModeChoice, ModeOptions, SolverOptions};
use hbvib::results::Branch;
use serde_json::{Map, Value};

use crate::json::number;
use crate::model::{CONTACT, DOFS, Parameters, SECTORS, WANTED};
use crate::response::{Harmonics, error_to_json, harmonics, harmonics_to_json, highest};

/// A mode that is wanted over a range of slip: the peak of the fundamental of the relative motion of
/// disk and ring, over the motion at which the contact begins to slip.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// The structure; its engine order is the nodal diameter of the mode.
    pub parameters: Parameters,
    /// Number of the mode from 1 by rising frequency, ring stuck.
    pub family: usize,
    /// Form of the artificial damping.
    pub damping: DampingForm,
    /// Slip at the first point.
    pub from: f64,
    /// Slip at the last point, above the first.
    pub to: f64,
    /// Slips at which every passage is wanted, in the order in which they are to be listed.
    pub at: Vec<f64>,
}

impl Wanted {
    /// Checks the range and the slips against what the library takes.
    ///
    /// # Errors
    ///
    /// As [`ModeOptions::check`].
    pub fn check(&self) -> Checked<()> {
        self.options(&self.logarithms()).check(DOFS.len(), 1, SECTORS)
    }

    /// The parameter of the library: log10 of the relative motion.
    fn logarithm(&self, slip: f64) -> f64 {
        (slip * self.parameters.slip_length()).log10()
    }

    fn logarithms(&self) -> Vec<f64> {
        self.at.iter().map(|&slip| self.logarithm(slip)).collect()
    }

    fn options<'a>(&self, at: &'a [f64]) -> ModeOptions<'a> {
        ModeOptions {
            choice: ModeChoice::Index(self.family - 1),
            amplitude: Amplitude::Contact(CONTACT),
            log10_start: self.logarithm(self.from),
            log10_stop: self.logarithm(self.to),
            at,
            damping_form: self.damping,
            ..ModeOptions::default()
        }
    }

    /// Slip at a value of the parameter; those that were asked for are given back as they were.
    fn slip(&self, log10: f64) -> f64 {
        let mut known = [self.from, self.to].into_iter().chain(self.at.iter().copied());
        known
            .find(|&slip| self.logarithm(slip).to_bits() == log10.to_bits())
            .unwrap_or_else(|| 10f64.powf(log10) / self.parameters.slip_length())
    }
}

/// A point of a mode. Amplitude and energies are those of one sector.
#[derive(Clone, Debug)]
pub struct Point {
    /// Fundamental of the relative motion over the motion at which the contact begins to slip.
    pub slip: f64,
    /// (X₁ᴴ M X₁)^½ of the fundamental, m·√kg.
    pub modal_amplitude: f64,
    /// Natural frequency, Hz.
    pub frequency: f64,
    /// Damping ratio D.
    pub damping_ratio: f64,
    /// T = Σ ½(pω)² X_pᴴ M X_p, twice the mean kinetic energy, J.
    pub energy: f64,
    /// Work of friction per cycle, J.
    pub dissipation: f64,
    /// Motion of all degrees of freedom.
    pub harmonics: Harmonics,
    /// Estimated relative error of the frequency, and error of the damping ratio; not finite where unknown.
    pub errors: (f64, f64),
}

impl Point {
    fn new(wanted: &Wanted, branch: &Branch, number: usize, omega: f64) -> Result<Self, Box<dyn Error>> {
        let mode = branch.mode_at(number).ok_or("a point of the mode has no numbers")?;
        Ok(Self {
            slip: wanted.slip(mode.log10_amplitude),
            modal_amplitude: mode.modal_amplitude,
            frequency: omega / TAU,
            damping_ratio: mode.damping_ratio,
            energy: mode.energy,
            dissipation: mode.friction_loss,
            harmonics: harmonics(branch, number, &WANTED)?,
            errors: branch
                .error_estimate_at(number)
                .zip(branch.damping_error_estimate_at(number))
                .unwrap_or((f64::NAN, f64::NAN)),
        })
    }

    /// With errors where a largest damping ratio is given, over which that of the damping ratio is told.
    fn to_json(&self, largest: Option<f64>) -> Result<Value, Box<dyn Error>> {
        let mut object = Map::new();
        for (name, value) in [
            ("slip", self.slip),
            ("modal_amplitude", self.modal_amplitude),
            ("frequency_hz", self.frequency),
            ("damping_ratio", self.damping_ratio),
            ("energy_j", self.energy),
            ("dissipation_j", self.dissipation),
        ] {
            object.insert(name.into(), number(value)?);
        }
        object.insert("harmonics".into(), harmonics_to_json(&self.harmonics, &DOFS)?);
        if let Some(largest) = largest {
            let (frequency, damping) = self.errors;
            let damping = if damping == 0.0 { 0.0 } else { damping / largest };
            object.insert("error_estimate_frequency".into(), error_to_json(frequency));
            object.insert("error_estimate_damping".into(), error_to_json(damping));
            object.insert("harmonics_used".into(), highest(&self.harmonics).into());
        }
        Ok(object.into())
    }
}

fn is_complete(status: Status) -> bool {
    matches!(
        status,
        Status::Ok | Status::StoppedStalled | Status::StoppedMaxHarmonics
    )
}

/// A mode over the whole of a range of slip.
#[derive(Debug)]
pub struct Backbone {
    /// From exactly the first slip to exactly the last.
    pub points: Vec<Point>,
    /// Every passage of the slips asked for, in the order asked.
    pub at: Vec<Point>,
    /// The largest maximum of the damping ratio inside the range, if there is one.
    pub max_damping: Option<Point>,
    /// Whether rounding kept the residual of a point above the solver's tolerance.
    pub stalled: bool,
    /// Whether some point misses the tolerance.
    pub missed: bool,
    /// Whether a tolerance chose the harmonics.
    automatic: bool,
    /// All that the library returned.
    pub branch: Branch,
}

impl Backbone {
    /// Follows a mode and reports the share of the range that is done.
    ///
    /// # Errors
    ///
    /// If the model or an option is refused, or the mode could not be followed to its end.
    pub fn follow(
        wanted: &Wanted,
        solver: &SolverOptions,
        mut progress: impl FnMut(f64),
    ) -> Result<Self, Box<dyn Error>> {
        let model = wanted.parameters.model()?;
        let at = wanted.logarithms();
        let options = wanted.options(&at);
        let mut report = |state: &Progress| {
            progress(state.fraction_done);
            false
        };
        let mut hooks = Hooks {
            progress: Some(&mut report),
            ..Hooks::default()
        };
        let branch = nonlinear_mode(&model, solver, &options, &mut hooks)?;
        let curve = branch.omega().iter().enumerate();
        let points: Vec<Point> = curve
            .map(|(i, &omega)| Point::new(wanted, &branch, i, omega))
            .collect::<Result<_, _>>()?;
        let end = points.last().map_or(f64::NAN, |p| p.slip);
        if end.to_bits() != wanted.to.to_bits() || !is_complete(branch.status()) {
            let reason = branch.status().name().to_string_lossy();
            return Err(format!("the mode ends at slip {end} ({reason}), before {}", wanted.to).into());
        }
        let mut at = Vec::new();
        for (i, slip) in wanted.at.iter().enumerate() {
            if branch.at(i).is_empty() {
                return Err(format!("no solution was found at slip {slip}").into());
            }
            for special in branch.at(i) {
                at.push(Point::new(wanted, &branch, special.point, special.omega)?);
            }
        }
        let mut max_damping: Option<Point> = None;
        for peak in branch.peaks() {
            let peak = Point::new(wanted, &branch, peak.point, peak.omega)?;
            if max_damping
                .as_ref()
                .is_none_or(|best| peak.damping_ratio > best.damping_ratio)
            {
                max_damping = Some(peak);
            }
        }
        Ok(Self {
            points,
            at,
            max_damping,
            stalled: branch.status() == Status::StoppedStalled,
            missed: branch.status() == Status::StoppedMaxHarmonics,
            automatic: solver.tolerance > 0.0,
            branch,
        })
    }

    /// The mode as JSON.
    ///
    /// # Errors
    ///
    /// If a number is not finite.
    pub fn to_json(&self) -> Result<Value, Box<dyn Error>> {
        let all = self.points.iter().chain(&self.at).chain(&self.max_damping);
        let maximum = all.map(|p| p.damping_ratio.abs()).fold(0.0, f64::max);
        let maximum = self.automatic.then_some(maximum);
        let list = |points: &[Point]| points.iter().map(|p| p.to_json(maximum)).collect::<Result<Vec<_>, _>>();
        let largest = self.max_damping.as_ref().map(|p| p.to_json(maximum)).transpose()?;
        let mut object = Map::new();
        object.insert("backbone".into(), list(&self.points)?.into());
        object.insert("at".into(), list(&self.at)?.into());
        object.insert("max_damping".into(), largest.unwrap_or(Value::Null));
        Ok(object.into())
    }
}
