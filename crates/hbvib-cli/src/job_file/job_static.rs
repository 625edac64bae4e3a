//! The keys of a job on contacts in a static step of the finite-element program.

use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

/// Preload and gap of each pair from a static step, in place of those of the entry.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StaticPart {
    /// Field CONTACT of .frd, contact tables by node of .dat, or lines of node, pressure, gap and force with these names in the first
    /// line (.csv).
    pub file: PathBuf,
    #[serde(default)]
    pub missing: MissingName,
}

/// Pairs of which no node is in contact in the file.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum MissingName {
    #[default]
    Refused,
    /// They are too far apart to touch.
    LeftOut,
}
