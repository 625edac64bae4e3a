//! Options of the analyses, each with its defaults and checks.

mod batch_options;
mod campbell_response_options;
pub(crate) mod content;
mod floquet_options;
mod forced_options;
mod life_options;
mod mission_options;
mod mode_options;
mod range;
mod response;
mod run_up_options;
mod solver_options;
mod sweep_options;
mod synthesis_options;
mod time_options;
mod tree_size;
mod waves;

pub use crate::fourier::Measure;
pub use batch_options::{BatchOptions, MOST_THREADS};
pub use campbell_response_options::CampbellResponseOptions;
pub use content::Content;
pub use floquet_options::FloquetOptions;
pub use forced_options::ForcedOptions;
pub(crate) use forced_options::check_highest;
pub use life_options::{Duty, LIFE_MOST_STEPS, LIFE_TOLERANCE, LifeFollow, LifeOptions, MOST_WORN, Wear};
pub use mission_options::{MissionOptions, Woehler};
pub use mode_options::{Amplitude, DampingForm, ModeChoice, ModeGuess, ModeOptions};
pub use range::Range;
pub(crate) use response::check_responses;
pub use response::{Component, Response};
pub use run_up_options::{RUN_UP_INTEGRATED_TURNS, RunUpOptions};
pub use solver_options::{Exchanged, Flexibility, MAX_HARMONIC, MAX_REFINEMENT, MAX_SAMPLES, SolverOptions};
pub use sweep_options::SweepOptions;
pub use synthesis_options::SynthesisOptions;
pub use time_options::{SteadyMethod, TimeOptions, VerifyOptions};
pub use waves::Waves;
