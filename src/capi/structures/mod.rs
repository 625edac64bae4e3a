//! Matrices, models, cyclic structures, wheels.

pub(crate) mod cyclic;
pub(crate) mod cyclic_aero;
pub(crate) mod cyclic_faces;
pub(crate) mod cyclic_wheel;
pub(crate) mod matrices;
pub(crate) mod model;
pub(crate) mod model_contents;
pub(crate) mod model_damping;
pub(crate) mod model_rotation;
pub(crate) mod model_saved;
pub(crate) mod wheel_blade_modes;

pub use cyclic::*;
pub use cyclic_aero::*;
pub use cyclic_faces::*;
pub use cyclic_wheel::*;
pub use matrices::*;
pub use model::*;
pub use model_contents::*;
pub use model_damping::*;
pub use model_rotation::*;
pub use model_saved::*;
pub use wheel_blade_modes::*;
