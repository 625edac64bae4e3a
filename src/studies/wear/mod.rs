//! The life of a machine whose contacts wear.

pub mod life;
pub(crate) mod life_checks;
pub(crate) mod life_length;
pub mod life_load;
pub(crate) mod life_step;
pub(crate) mod worn_state;
