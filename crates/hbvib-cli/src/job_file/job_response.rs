//! The table `[[response]]` of a job.

use crate::job_file::job_words::DofName;
use schemars::JsonSchema;
use serde::Deserialize;

/// A response of [forced]: a weighted sum of degrees of freedom, and what is read from it over a period.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ResponsePart {
    pub dofs: Vec<DofName>,
    /// One for each of the dofs; none: 1 each.
    #[serde(default)]
    pub weights: Vec<f64>,
    #[serde(default)]
    pub measure: MeasureName,
    /// Number of the harmonic of the measure "harmonic".
    pub harmonic: Option<usize>,
    #[serde(default)]
    pub sector: usize,
    #[serde(default)]
    pub component: ComponentName,
}

/// The number that is read from a response.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum MeasureName {
    #[default]
    Fundamental,
    Harmonic,
    Peak,
    Rms,
    Range,
}

/// The derivative by time that a response sees.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ComponentName {
    #[default]
    Displacement,
    Velocity,
    Acceleration,
}
