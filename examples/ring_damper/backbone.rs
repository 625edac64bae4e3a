//! One nonlinear mode of the bladed disk, complete or refused: its points and their JSON.

use std::error::Error;
use std::f64::consts::TAU;

use hbvib::{
    Amplitude, Branch, DampingForm, Hooks, ModeChoice, ModeOptions, Progress, Result as Checked, SolverOptions, Status,
    nonlinear_mode,
};
use serde_json::{Map, Value};

use crate::json::number;
use crate::model::{CONTACT, DOFS, Parameters, REPORTED_DOFS, SECTORS};
use crate::response::{Harmonics, error_to_json, harmonics, harmonics_to_json, highest};

/// A requested mode over a range of slip: the peak of the fundamental of the relative motion of disk and ring, over
/// the motion at which the contact begins to slip.
#[derive(Clone, Debug)]
pub struct ModeRequest {
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
    /// Slips at which every passage is listed, in this order.
    pub at: Vec<f64>,
}

impl ModeRequest {
    /// Checks the range and the slips by the rules of the library.
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

    /// Slip at a value of the parameter; requested slips are returned exactly as given.
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
    /// Kinetic energy of a sector, largest over the period, J; T for masses in phase without higher harmonics.
    pub kinetic_peak: f64,
    /// Work of friction per cycle, J.
    pub dissipation: f64,
    /// Motion of all degrees of freedom.
    pub harmonics: Harmonics,
    /// Estimated relative error of the frequency, and error of the damping ratio; not finite where unknown.
    pub errors: (f64, f64),
}

impl Point {
    fn new(requested: &ModeRequest, branch: &Branch, number: usize, omega: f64) -> Result<Self, Box<dyn Error>> {
        let mode = branch.mode_at(number).ok_or("a point of the mode has no numbers")?;
        Ok(Self {
            slip: requested.slip(mode.log10_amplitude),
            modal_amplitude: mode.modal_amplitude,
            frequency: omega / TAU,
            damping_ratio: mode.damping_ratio,
            energy: mode.energy,
            kinetic_peak: branch.energy_at(number)?.kinetic_peak,
            dissipation: mode.friction_loss,
            harmonics: harmonics(branch, number, &REPORTED_DOFS)?,
            errors: branch
                .error_estimate_at(number)
                .zip(branch.damping_error_estimate_at(number))
                .unwrap_or((f64::NAN, f64::NAN)),
        })
    }

    /// The point as JSON, with errors if a largest damping ratio is given, to which that of the damping ratio is
    /// relative.
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
    /// Every passage of the requested slips, in the requested order.
    pub at: Vec<Point>,
    /// The largest maximum of the damping ratio inside the range, if there is one.
    pub max_damping: Option<Point>,
    /// Whether rounding kept the residual of a point above the tolerance of the solver.
    pub stalled: bool,
    /// Whether some point exceeds the tolerance.
    pub missed: bool,
    /// Whether a tolerance chose the harmonics.
    automatic: bool,
    /// All that the library returned.
    pub branch: Branch,
}

impl Backbone {
    /// Follows a mode and reports the completed share of the range.
    ///
    /// # Errors
    ///
    /// If the model or an option is refused, or the mode could not be followed to its end.
    pub fn follow(
        requested: &ModeRequest,
        solver: &SolverOptions,
        mut progress: impl FnMut(f64),
    ) -> Result<Self, Box<dyn Error>> {
        let model = requested.parameters.model()?;
        let at = requested.logarithms();
        let options = requested.options(&at);
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
            .map(|(i, &omega)| Point::new(requested, &branch, i, omega))
            .collect::<Result<_, _>>()?;
        let end = points.last().map_or(f64::NAN, |p| p.slip);
        if end.to_bits() != requested.to.to_bits() || !is_complete(branch.status()) {
            let reason = branch.status().name().to_string_lossy();
            return Err(format!("the mode ends at slip {end} ({reason}), before {}", requested.to).into());
        }
        let mut at = Vec::new();
        for (i, slip) in requested.at.iter().enumerate() {
            if branch.at(i).is_empty() {
                return Err(format!("no solution was found at slip {slip}").into());
            }
            for special in branch.at(i) {
                at.push(Point::new(requested, &branch, special.point, special.omega)?);
            }
        }
        let mut max_damping: Option<Point> = None;
        for peak in branch.peaks() {
            let peak = Point::new(requested, &branch, peak.point, peak.omega)?;
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
