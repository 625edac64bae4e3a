//! Stability of points, and bifurcations between them.

pub(crate) mod floquet_multiplier;
pub(crate) mod floquet_stability;
pub(crate) mod unstable_directions;
pub(crate) mod verdict;
