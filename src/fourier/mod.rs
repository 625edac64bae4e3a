//! Real Fourier series: the carried harmonics and their packing, values and roots, transforms.

mod harmonic_set;
mod series;
pub mod transform;
mod turning_points;

pub use harmonic_set::{HarmonicSet, gcd};
pub use series::{Jet, crossing, jet, safe_newton};
pub use turning_points::{Extremum, TurningPoints};
