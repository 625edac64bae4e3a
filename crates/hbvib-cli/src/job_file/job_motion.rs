//! The keys of a job on files with the motion of all nodes, and on units.

use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

/// Points of the curve whose motion is written.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum ShapesName {
    /// The highest peak, or the highest point where there is no peak.
    #[default]
    HighestPeak,
    Peaks,
    /// The solutions at at_hz.
    Requested,
    /// Every point of the curve.
    All,
}

/// Motion in vtu, frd and the shapes of uff.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotionPart {
    #[serde(default)]
    pub points: ShapesName,
    /// Times of a period in vtu.
    #[serde(default = "phases")]
    pub phases: usize,
    /// All sectors in vtu, each with the phase of the wave.
    #[serde(default)]
    pub wheel: bool,
}

impl Default for MotionPart {
    fn default() -> Self {
        Self {
            points: ShapesName::default(),
            phases: phases(),
            wheel: false,
        }
    }
}

/// The motion in coordinates of modes of the finite-element program.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModalPart {
    /// Modes: shapes (55) of a universal file, by node; or an .npz with the array shapes, a row for each mode in the order of the
    /// matrices.
    pub modes: PathBuf,
    /// Coordinates of each mode in each harmonic, and the share of the motion that the modes lack, CSV.
    pub csv: PathBuf,
}

/// Names of the units of the matrices, for the outputs.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UnitsPart {
    pub length: Option<String>,
}

fn phases() -> usize {
    24
}
