//! Arc-length continuation of R(u, p) = 0: predict, correct, accept. It uses problems and algebra, and no mechanics.

pub mod arc_cubic;
pub mod arc_length;
pub mod corrector;
mod curvature_circle;
mod hermite_peak;
mod history;
pub mod initial_point;
mod linear_resonance;
pub mod metric;
pub mod newton_homotopy;
pub mod point;
pub mod predictor;
pub mod resolve;
mod settings;
pub mod special_points;
pub mod step_control;

pub use arc_length::{Advance, Continuation};
pub use linear_resonance::LinearResonance;
pub use metric::Metric;
pub use point::{ONE_SOLUTION, Point, PointAt};
pub use settings::Settings;
