//! Real Fourier series: the carried harmonics and their packing, values and roots, transforms.

mod cubic_cell;
mod harmonic_set;
mod measured;
mod series;
pub mod transform;
mod turning_points;

pub use harmonic_set::{HarmonicSet, gcd};
pub use measured::{Measure, Reader, Reading};
pub use series::{Jet, VALUES_OF_A_CROSSING, crossing, integral, jet};
pub use turning_points::{Extremum, TurningPoints};
