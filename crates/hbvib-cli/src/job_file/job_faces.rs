//! The keys of a job on the faces of a sector.

use crate::job_file::job_words::NodeList;
use schemars::JsonSchema;
use serde::Deserialize;

/// Faces of a sector.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FacesPart {
    /// Nodes of model.mesh, in any order, or the degrees of freedom of each node, -1 where one is missing, with entry i
    /// of right the image of entry i of left.
    pub left: NodeList,
    pub right: NodeList,
    #[serde(default)]
    pub frame: FrameName,
    #[serde(default = "z")]
    pub axis: [f64; 3],
    #[serde(default = "forward")]
    pub direction: i64,
    /// Largest distance between a node and the image of its partner, in the unit of the mesh.
    pub tolerance: Option<f64>,
    #[serde(default)]
    pub matching: MatchingName,
    /// Positions where degrees of freedom name the nodes.
    pub left_coordinates: Option<Vec<[f64; 3]>>,
    pub right_coordinates: Option<Vec<[f64; 3]>>,
}

/// Frame of the faces.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum FrameName {
    #[default]
    Cartesian,
    Cylindrical,
}

/// How nodes of both faces belong together.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum MatchingName {
    /// Each node has an image on the other face.
    #[default]
    Nodes,
    /// Nodes of the finer face follow the faces of the other one, whose mesh may be another.
    Projected,
}

fn z() -> [f64; 3] {
    [0.0, 0.0, 1.0]
}

fn forward() -> i64 {
    1
}
