//! The parts of a job on residual forces: the state that contacts have before the analyses, and the band of a nonlinear mode.

use crate::job_file::job_passages::PassedMode;
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

/// The state in which assembly and earlier loads have left contacts with friction. All analyses begin from it; its parts act one after
/// the other.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ResidualPart {
    /// NPZ file with places of sliders: contacts x 2 for t1 and t2, or steps x contacts x 2, of which the last step counts.
    pub npz: Option<PathBuf>,
    /// Places of single sliders.
    #[serde(default)]
    pub slider: Vec<SliderPart>,
    /// A load history from there: factors of the constant forces at each step, straight between them.
    #[serde(default)]
    pub factors: Vec<f64>,
    /// Its speeds of rotation at each step, rad per time unit, beside the factors or alone.
    #[serde(default)]
    pub speeds: Vec<f64>,
    /// Then vibrations at these frequencies one after the other, integrated in time until each repeats.
    #[serde(default)]
    pub vibration_hz: Vec<f64>,
    /// Steps of the load history: places and forces of each contact.
    pub csv: Option<PathBuf>,
    /// The places from which the analyses begin.
    pub places_npz: Option<PathBuf>,
}

/// The place of a slider.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SliderPart {
    /// Name of the [[contact]] or [[damper]], or its number, from 1, as text.
    pub contact: String,
    /// Number of the pair, from 0; all pairs unless given.
    pub pair: Option<usize>,
    /// Along t1, or along t1 and t2: a contact that sticks through the period has the force kt (motion - place).
    pub place: Vec<f64>,
}

/// Damping ratio and frequency of a nonlinear mode over the forces that sticking contacts may keep.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModeBandPart {
    pub mode: PassedMode,
    /// Amplitudes, equally far apart in log10, at which the band is computed.
    #[serde(default = "points")]
    pub points: usize,
    /// Numbers of the contacts whose force is free, from 0; all unless given.
    #[serde(default)]
    pub contacts: Vec<usize>,
    pub csv: Option<PathBuf>,
    /// SVG or, where its name ends with .png, PNG.
    pub figure: Option<PathBuf>,
}

fn points() -> usize {
    9
}
