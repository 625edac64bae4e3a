//! The parts of a job that fit parameters to data of tests.

use crate::job_file::job_studies::ParameterName;
use crate::job_file::job_words::DofName;
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

/// Parameters of the model from data of tests, with their uncertainty.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FitPart {
    pub parameter: Vec<UnknownPart>,
    /// A fixed highest harmonic, instead of a tolerance.
    pub harmonics: Option<usize>,
    pub tolerance: Option<f64>,
    pub response_dof: Option<DofName>,
    /// Standard deviations beyond which a residual counts by its magnitude, 1.345 for example; unless given all count by their squares.
    pub huber: Option<f64>,
    /// Points from which the search begins.
    pub starts: Option<usize>,
    /// The covariance is multiplied by chi2 over the degrees of freedom.
    #[serde(default)]
    pub scale_covariance: bool,
    /// Data, values of the model and residuals, point by point.
    pub csv: Option<PathBuf>,
    /// All numbers of the fit.
    pub json: Option<PathBuf>,
    /// The text that is printed.
    pub report: Option<PathBuf>,
    /// Responses and amplitudes with the model, without any the frequencies of modes; SVG or, where its name ends with .png, PNG.
    pub figure: Option<PathBuf>,
    /// Residuals in standard deviations, datum after datum; SVG or PNG.
    pub residual_figure: Option<PathBuf>,
}

/// An unknown of the fit: constants of contacts and the speed have their own values, the others are factors, 1 in the model.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UnknownPart {
    pub parameter: ParameterName,
    /// Number of the contact, from 0; all contacts that have the constant unless given.
    pub contact: Option<usize>,
    /// A mass, stiffness or damping on each of these degrees of freedom instead of a factor: its value is added.
    #[serde(default)]
    pub dofs: Vec<DofName>,
    /// First value; that of the model unless given.
    pub start: Option<f64>,
    pub lower: Option<f64>,
    /// Equal to lower it fixes the value.
    pub upper: Option<f64>,
    /// Mean and standard deviation of what is known of it beside the data.
    pub prior: Option<[f64; 2]>,
    /// Number of an earlier unknown, from 0, which it follows in the ratio of their starts.
    pub tied_to: Option<usize>,
    /// Number of the data set, from 0, that alone has it, as each test its residual state; all have it unless given.
    pub data_set: Option<usize>,
}

/// Kind of data.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum DataName {
    /// Complex amplitudes: columns hz, re and im, or a complex response, and sigma of |X| or coherence; or a universal file.
    #[default]
    Response,
    /// Amplitudes: columns hz, amplitude, sigma.
    Amplitude,
    /// Peaks: columns hz, amplitude, sigma, and sigma_hz where the frequency is a datum.
    Peak,
    /// A nonlinear mode: columns log10_amplitude (modal), hz, sigma_hz, and damping with sigma_damping.
    Backbone,
    /// The mode in which all contacts stick: columns hz, sigma_hz, and damping with sigma_damping.
    LinearMode,
    /// A motion that dies away in one mode: columns time and signal at equal distances, or a history of a universal file. It becomes a
    /// backbone.
    Decay,
}

/// Data of one kind at one level of the force.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DataPart {
    #[serde(default)]
    pub kind: DataName,
    /// CSV with the names of its columns in the first line, .mat (save -v7) or .npz with vectors of these names, or a universal file
    /// (.uff, .unv): its functions, data set 58, or for linear_mode its modes, 55.
    pub file: PathBuf,
    /// Factor on the forces of the job.
    #[serde(default = "whole")]
    pub force: f64,
    /// Degree of freedom of the response; the response degree of freedom of [fit] unless given.
    pub dof: Option<DofName>,
    /// Number of the linear mode with stuck contacts, from 0.
    #[serde(default)]
    pub mode: usize,
    /// Standard deviation over each value, where the file has none.
    pub sigma: Option<f64>,
    /// Number of independent averages of a response whose file has its coherence: the standard deviations follow from both.
    pub averages: Option<f64>,
    /// Number of the mode in a universal file; its first one unless given.
    pub test_mode: Option<i64>,
    /// Periods of a window of a decay, which has one frequency and one damping ratio.
    #[serde(default = "five")]
    pub cycles: usize,
    /// 0: the signal of a decay is a displacement, 1: a velocity, 2: an acceleration; that of a universal file, or 0, unless given.
    pub component: Option<i32>,
    /// Motion of the sensor of a decay in the linear mode of modal mass 1: the modal amplitude is that of the sensor over it.
    #[serde(default = "whole")]
    pub shape: f64,
    /// Range that is followed, for peaks.
    pub from_hz: Option<f64>,
    pub to_hz: Option<f64>,
    /// Node and direction of the function of a universal file; its first function unless given.
    pub node: Option<i64>,
    pub direction: Option<i64>,
    /// Amplitude of the force of the test, by which a frequency response of a universal file is multiplied.
    #[serde(default = "whole")]
    pub frf_force: f64,
}

fn five() -> usize {
    5
}

fn whole() -> f64 {
    1.0
}
