//! The part of a job on solutions that the sweep does not show.

use crate::job_file::job_words::DofName;
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

/// Solutions that the sweep of [forced] does not show, or curves that branch off from that of [mode].
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolutionsPart {
    /// 1: branches of the double period and of broken symmetry; 2: detached curves, too; 3: those over the force and subharmonic curves of
    /// the orders 2 and 3, too; 4: those that deflation finds, too. Beside [mode] any of them seeks curves of branch points and those
    /// beyond tongues.
    #[serde(default = "all")]
    pub branches: usize,
    /// Most generations of branches; 0: 3.
    #[serde(default)]
    pub depth: usize,
    /// Most branches; 0: 32.
    #[serde(default)]
    pub most: usize,
    pub csv: Option<PathBuf>,
    /// SVG or, where its name ends with .png, PNG.
    pub figure: Option<PathBuf>,
    pub kick: Option<KickPart>,
}

/// The smallest impulse that leads from each stable motion at at_hz of [forced] across each unstable one.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KickPart {
    /// Where the impulse acts.
    pub dof: DofName,
    /// Times in a period at which it is tried, before those around the best are.
    #[serde(default = "phases")]
    pub phases: usize,
    pub csv: Option<PathBuf>,
}

fn phases() -> usize {
    16
}

fn all() -> usize {
    2
}
