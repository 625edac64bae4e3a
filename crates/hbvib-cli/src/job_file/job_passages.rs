//! The parts of a job for passages through a resonance: run-ups and missions of a nonlinear mode.

use crate::job_file::job_words::DofName;
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

/// The nonlinear mode of a passage.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PassedMode {
    #[serde(default)]
    pub index: usize,
    /// Amplitudes up to beyond that of the resonance.
    pub log10_from: f64,
    pub log10_to: f64,
    /// A fixed highest harmonic, instead of a tolerance.
    pub harmonics: Option<usize>,
    pub tolerance: Option<f64>,
    pub response_dof: Option<DofName>,
}

/// A run-up through a resonance by the slow flow of a mode; times are seconds.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RunUpPart {
    pub mode: PassedMode,
    /// First frequency of the forces.
    pub from_hz: f64,
    /// Last one, below the first for a run-down.
    pub to_hz: f64,
    /// Change of the frequency per second, above zero.
    pub hz_per_s: f64,
    pub csv: Option<PathBuf>,
    /// SVG or, where its name ends with .png, PNG.
    pub figure: Option<PathBuf>,
}

/// A mode over a mission, speed against time.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MissionPart {
    pub mode: PassedMode,
    /// Rising times in seconds.
    pub seconds: Vec<f64>,
    /// Speeds at these times, straight between them.
    pub rpm: Vec<f64>,
    /// Frequency of the forces over that of the rotation.
    #[serde(default = "order")]
    pub engine_order: f64,
    /// Rising amplitudes between which cycles are counted.
    #[serde(default)]
    pub edges: Vec<f64>,
    /// Stress amplitudes per modal amplitude.
    #[serde(default)]
    pub stresses: Vec<f64>,
    pub woehler: Option<WoehlerPart>,
    /// Passages.
    pub csv: Option<PathBuf>,
    /// Cycles of each class of amplitudes.
    pub spectrum_csv: Option<PathBuf>,
    /// Amplitude over time. SVG or, where its name ends with .png, PNG.
    pub figure: Option<PathBuf>,
}

/// A Woehler line: stress amplitude and cycles of its knee, and its slopes.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WoehlerPart {
    pub stress: f64,
    pub cycles: f64,
    pub slope: f64,
    /// Slope below the knee; 0: no damage there.
    #[serde(default)]
    pub slope_below: f64,
}

fn order() -> f64 {
    1.0
}
