//! The parts of a job that are computed over a quantity: Campbell diagrams, curves over a parameter, maps, tornados, bands and wheels.

use crate::job_file::job_words::DofName;
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

/// Contacts of a linear analysis.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum StateName {
    #[default]
    Stuck,
    Free,
    /// About the static state under constant forces and preload.
    Static,
}

/// Natural frequencies over the speed of rotation, and where engine orders meet them; times are seconds.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CampbellPart {
    pub from_rpm: f64,
    pub to_rpm: f64,
    #[serde(default = "speeds")]
    pub points: usize,
    /// Number of modes.
    #[serde(default = "modes")]
    pub count: usize,
    #[serde(default = "first_order")]
    pub engine_orders: Vec<i64>,
    /// Signed nodal diameter of the curves: sector s + 1 lags by 2 pi d / N. That of the first engine order unless given.
    pub diameter: Option<i64>,
    #[serde(default)]
    pub contacts: StateName,
    pub csv: Option<PathBuf>,
    /// SVG or, where its name ends with .png, PNG.
    pub figure: Option<PathBuf>,
    /// Frequencies over nodal diameter with the engine orders (SAFE diagram).
    pub interference_figure: Option<PathBuf>,
    /// Speed of the interference figure; that of to_rpm unless given.
    pub interference_rpm: Option<f64>,
}

/// Quantity that is changed: constants of contacts and the speed have their own values, the others are factors, 1 in the
/// model.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum ParameterName {
    Force,
    Preload,
    Mu,
    Kt,
    Kn,
    Gap,
    Mass,
    Damping,
    Stiffness,
    /// The fixed speed of rotation, its own value.
    Speed,
}

/// Result that is followed.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum FollowName {
    /// The peak next to near_hz, within a tenth of it.
    #[default]
    Peak,
    /// The same, and beyond the value at which it vanishes the minimum that it meets.
    PeakThroughFolds,
    /// The amplitude at near_hz.
    Frequency,
    /// The fold next to near_hz, within a tenth of it.
    Fold,
    /// The largest damping ratio of the nonlinear mode whose linear mode with stuck contacts is next to near_hz.
    ModeMaxDamping,
}

/// A result over a parameter of the model.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudyPart {
    pub parameter: ParameterName,
    /// Number of the contact, from 0; all contacts that have the constant unless given.
    pub contact: Option<usize>,
    /// A mass, stiffness or damping on each of these degrees of freedom instead of a factor: its value is added.
    #[serde(default)]
    pub dofs: Vec<DofName>,
    pub from: f64,
    pub to: f64,
    #[serde(default)]
    pub follow: FollowName,
    pub near_hz: f64,
    /// A fixed highest harmonic, instead of a tolerance.
    pub harmonics: Option<usize>,
    pub tolerance: Option<f64>,
    pub response_dof: Option<DofName>,
    pub csv: Option<PathBuf>,
    /// SVG or, where its name ends with .png, PNG.
    pub figure: Option<PathBuf>,
}

/// Peaks of all pairs of two quantities' values.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MapPart {
    pub x: AxisPart,
    pub y: AxisPart,
    /// Range of frequency in which each pair has its highest peak.
    pub from_hz: f64,
    pub to_hz: f64,
    /// A fixed highest harmonic, instead of a tolerance.
    pub harmonics: Option<usize>,
    pub tolerance: Option<f64>,
    pub response_dof: Option<DofName>,
    /// All that the processor has unless given. The results do not depend on it.
    pub threads: Option<usize>,
    pub csv: Option<PathBuf>,
    pub npz: Option<PathBuf>,
    /// SVG or, where its name ends with .png, PNG.
    pub figure: Option<PathBuf>,
}

/// Values of one quantity of a map.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AxisPart {
    pub parameter: ParameterName,
    /// Number of the contact, from 0; all contacts that have the constant unless given.
    pub contact: Option<usize>,
    /// A mass, stiffness or damping on each of these degrees of freedom instead of a factor: its value is added.
    #[serde(default)]
    pub dofs: Vec<DofName>,
    pub from: f64,
    pub to: f64,
    #[serde(default = "values")]
    pub points: usize,
}

/// The lower and the upper curve of a response over the forces that sticking contacts may keep.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BandPart {
    /// Range of frequency.
    pub from_hz: f64,
    pub to_hz: f64,
    /// A fixed highest harmonic, instead of a tolerance.
    pub harmonics: Option<usize>,
    pub tolerance: Option<f64>,
    pub response_dof: Option<DofName>,
    /// Results that are bounded: the amplitude at each frequency, amplitude and frequency of the highest peak.
    #[serde(default = "curves_and_peak")]
    pub of: Vec<BandName>,
    /// Numbers of the contacts whose force is free, from 0; all unless given.
    #[serde(default)]
    pub contacts: Vec<usize>,
    /// Starts of the search where several sliders are free.
    pub starts: Option<usize>,
    pub csv: Option<PathBuf>,
    /// SVG or, where its name ends with .png, PNG.
    pub figure: Option<PathBuf>,
    /// Both ends of the bands of the peak: places of the free sliders.
    pub ends_csv: Option<PathBuf>,
    /// All places at the least amplitude of the peak, for npz of [residual].
    pub lower_npz: Option<PathBuf>,
    /// Those at the largest one.
    pub upper_npz: Option<PathBuf>,
}

/// Result that a band bounds.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum BandName {
    /// The amplitude at each frequency of the range: the lower and the upper curve.
    Amplitude,
    /// The amplitude of the highest peak.
    PeakAmplitude,
    /// The frequency of the highest peak.
    PeakHz,
}

/// Quantity that differs between the blades of a wheel.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum MistunedName {
    #[default]
    Stiffness,
    /// Frequencies of the clamped blade.
    Frequency,
    Mass,
    Damping,
    /// Normal loads of all contacts that have one.
    Preload,
    Force,
}

/// All blades of a mistuned wheel and the largest of them.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WheelPart {
    #[serde(default)]
    pub kind: MistunedName,
    /// Degrees of freedom of the blade of a sector; not for preload and force.
    #[serde(default)]
    pub dofs: Vec<DofName>,
    /// One number a sector: the quantity times 1 + that. Needed without `patterns`.
    #[serde(default)]
    pub pattern: Vec<f64>,
    /// File of many patterns, one a line.
    pub patterns: Option<PathBuf>,
    /// The largest blade of each of them.
    pub patterns_csv: Option<PathBuf>,
    /// Their amplification and its distribution. SVG or, where its name ends with .png, PNG.
    pub patterns_figure: Option<PathBuf>,
    /// Range of frequency.
    pub from_hz: f64,
    pub to_hz: f64,
    /// A fixed highest harmonic, instead of a tolerance.
    pub harmonics: Option<usize>,
    pub tolerance: Option<f64>,
    /// Degree of freedom of the sector that is watched on each blade.
    pub response_dof: Option<DofName>,
    pub csv: Option<PathBuf>,
    /// SVG or, where its name ends with .png, PNG.
    pub figure: Option<PathBuf>,
}

/// Changes of the highest peak by quantities, from its derivatives, the largest first.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TornadoPart {
    pub parameter: Vec<SpreadPart>,
    /// Range of frequency of the peak.
    pub from_hz: f64,
    pub to_hz: f64,
    /// A fixed highest harmonic, instead of a tolerance.
    pub harmonics: Option<usize>,
    pub tolerance: Option<f64>,
    pub response_dof: Option<DofName>,
    pub csv: Option<PathBuf>,
    /// SVG or, where its name ends with .png, PNG.
    pub figure: Option<PathBuf>,
}

/// A quantity and how far it spreads.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpreadPart {
    pub parameter: ParameterName,
    /// Number of the contact, from 0; all contacts that have the constant, which must be equal, unless given.
    pub contact: Option<usize>,
    /// A mass, stiffness or damping on each of these degrees of freedom instead of a factor.
    #[serde(default)]
    pub dofs: Vec<DofName>,
    /// Name for the outputs.
    pub name: Option<String>,
    /// Relative change.
    #[serde(default = "tenth")]
    pub spread: f64,
    /// Value that changes by this share; that of the model unless given. With dofs it is needed.
    pub value: Option<f64>,
}

fn curves_and_peak() -> Vec<BandName> {
    vec![BandName::Amplitude, BandName::PeakAmplitude]
}

fn speeds() -> usize {
    41
}

fn modes() -> usize {
    6
}

fn first_order() -> Vec<i64> {
    vec![1]
}

fn values() -> usize {
    21
}

fn tenth() -> f64 {
    0.1
}
