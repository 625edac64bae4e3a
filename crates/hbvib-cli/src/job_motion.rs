//! The keys of a job on files with the motion of all nodes, and on units.

use schemars::JsonSchema;
use serde::Deserialize;

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

/// Names of the units of the matrices, for the outputs.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UnitsPart {
    pub length: Option<String>,
}

fn phases() -> usize {
    24
}
