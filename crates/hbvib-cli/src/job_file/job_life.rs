//! The part of a job for wear over a life.

use crate::job_file::job_words::DofName;
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

/// Wear of contacts over the cycles of a life, at one frequency or at the highest peak of a range.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LifePart {
    /// Contacts that wear: names, each with all pairs of its entry, or numbers from 0.
    pub contacts: Vec<WornName>,
    /// Worn volume per work of friction.
    pub rate: f64,
    /// Area of each of these contacts.
    #[serde(default = "one")]
    pub area: f64,
    /// Static normal stiffness of each contact; its own one unless given.
    pub stiffness: Option<f64>,
    /// Rising cycles at which the state is written.
    pub cycles: Vec<f64>,
    /// Frequency of the vibration, instead of a range.
    pub hz: Option<f64>,
    /// Range of the peak that is followed.
    pub from_hz: Option<f64>,
    pub to_hz: Option<f64>,
    /// Error allowed of loads and amplitude.
    #[serde(default = "accuracy")]
    pub accuracy: f64,
    /// Amplitude whose crossing is told.
    #[serde(default)]
    pub limit: f64,
    /// A fixed highest harmonic, instead of a tolerance.
    pub harmonics: Option<usize>,
    pub tolerance: Option<f64>,
    pub response_dof: Option<DofName>,
    pub csv: Option<PathBuf>,
    /// Loads over the cycles. SVG or, where its name ends with .png, PNG.
    pub figure: Option<PathBuf>,
}

/// A contact by its name in the job, with all its pairs, or by its number from 0.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum WornName {
    Number(usize),
    Name(String),
}

fn one() -> f64 {
    1.0
}

fn accuracy() -> f64 {
    1e-4
}
