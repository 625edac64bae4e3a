//! Words that several tables of a job share: nodes, degrees of freedom, laws.

use schemars::JsonSchema;
use serde::Deserialize;

/// Law of a contact.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum KindName {
    Jenkins,
    #[serde(rename = "friction_2d")]
    Friction2d,
    #[serde(rename = "friction_3d")]
    Friction3d,
    Unilateral,
    Cubic,
    Regularised,
}

/// The number of a node in the files of the job, or its degrees of freedom in the directions of the law.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Node {
    Number(i64),
    Dofs(Vec<i64>),
}

/// Nodes, or the name of a set of the mesh, or names of several sets, as one of each body.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum NodeList {
    Set(String),
    Sets(Vec<String>),
    Nodes(Vec<Node>),
}

/// A degree of freedom of a side of a contact: its number, -1 for the ground, or its name as of a force.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum SideDof {
    Number(i64),
    Node(String),
}

/// A degree of freedom by its number from 0, or by node and direction from 1 as "12.3", where the name of a set of one node
/// may stand for the node: "TIP.3".
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum DofName {
    Number(usize),
    Node(String),
}

/// Contacts, forces and faces at degrees of freedom that the matrices do not have: these may be fixed, or follow others by a
/// constraint (MPC, TIE, rigid body) that the matrices contain.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum AbsentName {
    #[default]
    Refused,
    /// They do not move.
    Fixed,
}

/// A real number or [re, im].
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Amplitude {
    Real(f64),
    Complex([f64; 2]),
}
