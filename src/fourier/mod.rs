//! Real Fourier series: the carried harmonics and their packing, values and roots, transforms.

mod harmonic_set;
mod series;
pub mod transform;

pub use harmonic_set::{HarmonicSet, gcd};
pub use series::{Extremum, Jet, TurningPoints, crossing, jet};
