//! Data of a nonlinear mode beside the points that every branch has.

use crate::error::{Error, Result, try_copy, try_extend, try_push};
use crate::model::natural_modes::repeated_modes::Multiple;
use crate::options::Amplitude;
use crate::options::Range;
use crate::problem::epmc::{Gauge, LinearMode};
use std::f64::consts::PI;

/// Linear mode from which a nonlinear mode starts, and its normalisation.
#[derive(Clone, Debug)]
pub struct ModeInfo {
    /// Index of the linear mode, from 0 by rising frequency with stuck contacts.
    pub index: usize,
    /// Angular frequency of the linear mode without damping.
    pub omega: f64,
    /// Number of linear modes with this frequency.
    pub multiplicity: usize,
    /// Rule that chose one of the modes of this frequency.
    pub multiple: Multiple,
    /// Degree of freedom whose fundamental is real.
    pub reference_dof: usize,
    /// Waves per turn of the fundamental: the signed engine order of the computation.
    pub engine_order: i64,
    /// Quantity whose log₁₀ is the parameter of the branch.
    pub amplitude: Amplitude,
    /// log₁₀ of the amplitude up to which all contacts stick; −∞ if a law is never linear.
    pub linear_up_to: f64,
    /// log₁₀ of the amplitude at which the first contact slips: ∞ if none does on the branch, −∞ if one does at every
    /// amplitude, or at the first point and at which amplitude it began is not known.
    pub slip_from: f64,
    /// log₁₀ of the amplitude at which the first statically pressed contact lifts off, with the special values of
    /// `slip_from`.
    pub lift_off_from: f64,
    /// Natural frequencies of the wave with stuck contacts, as far as they were found.
    pub stuck: Vec<f64>,
    /// Natural frequencies of the wave with the contacts removed, as far as they were found.
    pub free: Vec<f64>,
}

/// Numbers of one point of a mode, in the caller's units; energies are of one sector.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ModePoint {
    /// Parameter of the mode: log₁₀ of the amplitude.
    pub log10_amplitude: f64,
    /// Modal amplitude (X₁ᴴ M X₁)^½ of one sector.
    pub modal_amplitude: f64,
    /// Damping ratio D of the mode.
    pub damping_ratio: f64,
    /// Energy T = Σ ½(hω)² X_hᴴ M X_h, twice the mean kinetic energy.
    pub energy: f64,
    /// Share of the fundamental in this energy.
    pub fundamental_share: f64,
    /// Work of friction per cycle.
    pub friction_loss: f64,
    /// Work per cycle of the damping of the structure.
    pub structural_loss: f64,
    /// Mass-weighted assurance |X₁ᴴ M Y₁|²/(X₁ᴴMX₁·Y₁ᴴMY₁) with the previous point; 1 for the first.
    pub assurance: f64,
}

impl ModePoint {
    /// Damping ratio by the energy balance: all losses over 4πT. With artificial damping of mass form this equals the
    /// damping ratio, whatever the number of harmonics.
    #[must_use]
    pub fn energy_damping_ratio(&self) -> f64 {
        (self.friction_loss + self.structural_loss) / (4.0 * PI * self.energy)
    }
}

/// Data of a nonlinear mode in a branch.
#[derive(Debug)]
pub(crate) struct ModeData {
    pub info: ModeInfo,
    pub linear: LinearMode,
    pub gauge: Gauge,
    /// Range of log₁₀ of the amplitude.
    pub range: Range,
    /// The values of all stored points, one array for each field, so that fields can be borrowed.
    fields: [Vec<f64>; FIELDS],
    /// State of each point of the curve: unknowns and parameter, then the tangent.
    states: Vec<f64>,
    /// Index in `states` at which the state of each point begins.
    begins: Vec<usize>,
    /// State of each branch point, in the order of the bifurcations: unknowns with parameter, and direction of the
    /// curve.
    branch_points: Vec<[Vec<f64>; 2]>,
}

/// Number of fields of a [`ModePoint`].
/// Kind: fixed.
const FIELDS: usize = 8;

impl ModeData {
    pub fn new(info: ModeInfo, linear: LinearMode, gauge: Gauge, range: Range) -> Self {
        Self {
            info,
            linear,
            gauge,
            range,
            fields: Default::default(),
            states: Vec::new(),
            begins: Vec::new(),
            branch_points: Vec::new(),
        }
    }

    /// Stores a point, or nothing if memory is exhausted.
    pub fn push(&mut self, point: ModePoint) -> Result<()> {
        const CONTEXT: &str = "the points of the mode";
        for field in &mut self.fields {
            field.try_reserve(1).map_err(|_| Error::out_of_memory(CONTEXT))?;
        }
        let values = [
            point.log10_amplitude,
            point.modal_amplitude,
            point.damping_ratio,
            point.energy,
            point.friction_loss,
            point.structural_loss,
            point.assurance,
            point.fundamental_share,
        ];
        for (field, value) in self.fields.iter_mut().zip(values) {
            field.push(value);
        }
        Ok(())
    }

    /// Stores the state of a point of the curve.
    pub fn push_state(&mut self, v: &[f64], tangent: &[f64]) -> Result<()> {
        try_push(&mut self.begins, self.states.len(), "the points of the mode")?;
        try_extend(&mut self.states, v, "the points of the mode")?;
        try_extend(&mut self.states, tangent, "the points of the mode")
    }

    /// Unknowns with parameter, and tangent, of a point of the curve.
    pub fn state(&self, point: usize) -> Option<(&[f64], &[f64])> {
        let begin = *self.begins.get(point)?;
        let end = self.begins.get(point + 1).copied().unwrap_or(self.states.len());
        let both = self.states.get(begin..end)?;
        Some(both.split_at(both.len() / 2))
    }

    /// Stores the state of a branch point.
    pub fn push_branch_point(&mut self, v: &[f64], tangent: &[f64]) -> Result<()> {
        const CONTEXT: &str = "the branch points of the mode";
        let state = [try_copy(v, CONTEXT)?, try_copy(tangent, CONTEXT)?];
        try_push(&mut self.branch_points, state, CONTEXT)
    }

    /// Unknowns with parameter, and direction of the curve, of the branch point with an index.
    pub fn branch_point(&self, number: usize) -> Option<(&[f64], &[f64])> {
        let [v, tangent] = self.branch_points.get(number)?;
        Some((v, tangent))
    }

    /// Values of a field at all stored points.
    pub fn field(&self, field: ModeField) -> &[f64] {
        &self.fields[field as usize]
    }

    /// All values of a stored point.
    pub fn point(&self, point: usize) -> Option<ModePoint> {
        let at = |field: ModeField| self.fields[field as usize].get(point).copied();
        Some(ModePoint {
            log10_amplitude: at(ModeField::Log10Amplitude)?,
            modal_amplitude: at(ModeField::ModalAmplitude)?,
            damping_ratio: at(ModeField::DampingRatio)?,
            energy: at(ModeField::Energy)?,
            fundamental_share: at(ModeField::FundamentalShare)?,
            friction_loss: at(ModeField::FrictionLoss)?,
            structural_loss: at(ModeField::StructuralLoss)?,
            assurance: at(ModeField::Assurance)?,
        })
    }
}

/// Field of the values of a nonlinear mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModeField {
    /// [`ModePoint::log10_amplitude`]
    Log10Amplitude,
    /// [`ModePoint::modal_amplitude`]
    ModalAmplitude,
    /// [`ModePoint::damping_ratio`]
    DampingRatio,
    /// [`ModePoint::energy`]
    Energy,
    /// [`ModePoint::friction_loss`]
    FrictionLoss,
    /// [`ModePoint::structural_loss`]
    StructuralLoss,
    /// [`ModePoint::assurance`]
    Assurance,
    /// [`ModePoint::fundamental_share`]
    FundamentalShare,
}
