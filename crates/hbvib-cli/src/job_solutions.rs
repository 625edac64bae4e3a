//! The part of a job on solutions that the sweep does not show.

use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

/// Solutions that the sweep of [forced] does not show.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolutionsPart {
    /// 1: branches of the double period and of broken symmetry; 2: detached curves, too.
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
}

fn all() -> usize {
    2
}
