//! Studies: many designs, speeds, lives and tests, each made of analyses.

pub mod batch;
pub mod campbell;
pub mod campbell_response;
pub mod design_peak;
pub mod fit;
pub mod further_threads;
pub mod interference;
pub mod mission;
pub(crate) mod mode_adjustment;
pub mod run_up;
pub mod wear;
pub mod wheel_identify;
pub mod wheel_peaks;

pub use crate::studies::campbell_response::campbell_response;
pub use crate::studies::design_peak::DesignPeak;
pub use crate::studies::fit::{
    DataKind, Fit, FitData, FitOptions, FitProfile, Loss, Profiled, Scale, Suspicion, Unknown, fit, fit_profile,
    predict,
};
pub use crate::studies::mission::mission;
pub use crate::studies::run_up::run_up;
pub use crate::studies::wear::life::{Life, LifeEventKind, life};
pub use crate::studies::wear::life_load::best_load_for_life;
pub use crate::studies::wheel_identify::{MeasuredModes, wheel_identify};
pub use crate::studies::wheel_peaks::{BladePeak, wheel_peaks};
