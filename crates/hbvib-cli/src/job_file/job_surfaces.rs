//! The keys of a job on contacts between surfaces of the mesh.

use schemars::JsonSchema;
use serde::Deserialize;

/// Faces of the mesh between two sets of nodes, which need not match. kt, kn and cubic are given per area, preload is a pressure.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SurfacesPart {
    /// Sets of the mesh, or one: the side whose nodes have the contacts, best the one with the finer mesh.
    pub a: SetNames,
    /// Sets of the other side.
    pub b: SetNames,
    /// Largest distance between both sides.
    pub largest_distance: f64,
    #[serde(default)]
    pub method: SurfaceMethod,
    #[serde(default)]
    pub areas: AreasName,
    /// Adds the distance of both sides at each node to the gap.
    #[serde(default)]
    pub mesh_gaps: bool,
}

/// The name of a set, or several.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum SetNames {
    One(String),
    Several(Vec<String>),
}

impl SetNames {
    /// All names.
    pub fn all(&self) -> &[String] {
        match self {
            Self::One(name) => core::slice::from_ref(name),
            Self::Several(names) => names,
        }
    }
}

/// How the other side's motion at a node is averaged.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum SurfaceMethod {
    /// The nearest point of the other side.
    #[default]
    Nearest,
    /// Integrals over common parts of faces, which are exact for uniform pressures on both sides.
    Mortar,
}

/// Areas of nodes.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum AreasName {
    /// Integrals of shape functions, which are refused where they are negative.
    #[default]
    Consistent,
    /// Shares of a diagonal mass, for faces with eight nodes.
    Positive,
}
