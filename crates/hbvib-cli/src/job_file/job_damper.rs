//! The keys of a job on dampers under the platforms of blades.

use crate::job_file::job_words::SideDof;
use schemars::JsonSchema;
use serde::Deserialize;

/// A damper: a rigid body whose motions are degrees of freedom behind all others. Its axes are x along the wheel towards the next sector,
/// y outward and z along the axis of rotation.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DamperPart {
    /// Name for the outputs, of all its contacts.
    pub name: Option<String>,
    /// 3: motions along x and y and the roll about z, with contacts friction_2d; 6: all, with friction_3d.
    #[serde(default = "three")]
    pub motions: usize,
    pub mass: f64,
    /// Moments of inertia about x, y and z; zeros: those of a solid cylinder.
    #[serde(default)]
    pub inertia: [f64; 3],
    /// Radius of a cylinder, whose faces are lines; 0: faces have their centres and widths.
    #[serde(default)]
    pub radius: f64,
    /// Length along z, over which points are spread.
    #[serde(default)]
    pub length: f64,
    /// Distance of the centre of mass from the axis of rotation: the force mass orbit speed^2 acts outward.
    #[serde(default)]
    pub orbit: f64,
    /// Stiffness between the ground and each translation, and each rotation.
    #[serde(default)]
    pub support: [f64; 2],
    /// Damping constants of the same.
    #[serde(default)]
    pub support_damping: [f64; 2],
    /// Its faces on platforms.
    pub face: Vec<DamperFacePart>,
}

/// A face on a platform.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DamperFacePart {
    /// The platform along x, y and z of the damper: numbers or names as of a force, -1 for the ground.
    pub dofs: Vec<SideDof>,
    /// The platform belongs to that many sectors further.
    #[serde(default)]
    pub sector_offset: i64,
    /// Between the platform and x in radians, positive on the side of the next sector.
    pub angle: f64,
    /// Angle in radians by which the axes of dofs are turned about z.
    #[serde(default)]
    pub turn: f64,
    /// Middle of the face from the centre of mass; without effect on a cylinder.
    #[serde(default)]
    pub centre: [f64; 3],
    /// Width across z; without effect on a cylinder.
    #[serde(default)]
    pub width: f64,
    #[serde(default = "single")]
    pub points_across: usize,
    #[serde(default = "single")]
    pub points_along: usize,
    /// Tangential stiffness of the whole face.
    pub kt: f64,
    /// Normal stiffness of the whole face.
    pub kn: f64,
    pub mu: f64,
    #[serde(default)]
    pub gap: f64,
}

fn three() -> usize {
    3
}

fn single() -> usize {
    1
}
