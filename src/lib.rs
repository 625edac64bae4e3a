//! hbvib: steady-state vibration of structures with friction contacts, by harmonic balance.
//!
//! Mass, damping and stiffness matrices, contact data and forces go in; converged harmonics come out:
//!
//! > M ẍ + C ẋ + K x + f_contact(x, ẋ) = f_excitation(t),  x(t) = Re Σₕ Xₕ e^{ihωt},  h = 0 … H.
//!
//! # The algorithm
//!
//! 1. A [`Model`] holds one structure, or one sector of a wheel in a travelling wave, its contacts and its forces.
//! 2. Condensation keeps the relative motions y of the contacts alone: y − y_lin + G (f(y) − κ y) = 0 in each harmonic,
//!    with the dynamic flexibility G and any reference stiffness κ.
//! 3. Contact forces f(y) and their Jacobians are evaluated exactly: stick-slip events are located, Fourier integrals
//!    between them have a closed form. Laws without events are sampled.
//! 4. Newton's method solves for a first point; arc-length continuation predicts and corrects the next ones, and folds,
//!    peaks and requested values are solved for between them.
//! 5. Each point gets an error estimate from a few Newton steps with more harmonics, and as many harmonics as the
//!    tolerance requires.
//! 6. The [`Branch`] holds the points; motions of all degrees of freedom, energies and hysteresis loops follow from them.
//!
//! A [`nonlinear_mode`] (extended periodic motion concept, EPMC) replaces the forces by an artificial negative damping
//! and the frequency by the amplitude as the parameter. [`time_response`] and [`verify`] integrate in time from event to
//! event: the same periodic motions without harmonics.
//!
//! # Example
//!
//! A mass on a spring rubs against the ground; [`forced_response`] follows its response, [`Branch::peaks`] has the resonance.
//!
//! ```
//! use hbvib::{Contact, ForcedOptions, Hooks, MatrixKind, MatrixView, Model, SolverOptions, forced_response};
//!
//! let mut model = Model::new(1)?;
//! model.set_matrix(MatrixKind::Mass, &MatrixView::dense(1, &[1.0]))?;
//! model.set_matrix(MatrixKind::Stiffness, &MatrixView::dense(1, &[1.0]))?;
//! model.set_rayleigh(0.0, 0.02)?; // C = 0.02 K
//! model.add_contact(&Contact::jenkins(0, None, 1.0, 0.3, 1.0))?; // kt, mu, preload; None is the ground
//! model.add_force(0, 1, 0.2.into())?; // 0.2 cos ωt on degree of freedom 0
//! let range = ForcedOptions { omega_start: 0.8, omega_stop: 1.6, ..ForcedOptions::default() };
//! let branch = forced_response(&model, &SolverOptions::default(), &range, &mut Hooks::default())?;
//! assert!((branch.peaks()[0].omega - 1.2320).abs() < 1e-4);
//! # Ok::<(), hbvib::Error>(())
//! ```
//!
//! # Conventions
//!
//! Any consistent units; angular frequencies in rad per time unit; amplitudes are peak values. Engine order EO on N
//! sectors: sector s + 1 lags behind s by h·2π·EO/N in harmonic h. Degrees of freedom and contacts count from 0.
//!
//! The same functions are in the C header `include/hbvib.h`. The modules behind this page are not part of the public
//! interface.

#![deny(unsafe_code)]

// The numerics below, under the paths that they have in this crate.
use hbvib_numerics::{error, fourier, interrupt, linalg, roots, shortage};

mod aft;
mod analysis;
mod at_a_point;
mod byte_stream;
#[doc(hidden)]
pub mod capi;
mod condense;
mod contact;
mod continuation;
mod harmonics;
mod hooks;
#[doc(hidden)]
pub mod internals;
mod model;
mod options;
mod problem;
mod results;
mod sensitivity;
mod stability;
mod studies;
mod time_integration;
mod tracing;

// Models.
pub use contact::Contact;
pub use contact::described::iwan::Iwan;
pub use contact::described::patch::Patch;
pub use contact::described::relative_motion::{Direction, Frame};
pub use contact::described::rigid_point::RigidPoint;
pub use contact::laws::*;
#[doc(inline)]
pub use linalg::sparse_storage::matrix_view::{MatrixView, Part, Storage, Values};
pub use model::Model;
pub use model::damper::{Damper, DamperFace, DamperPlace};
pub use model::matrices::aero::{AeroEntry, AeroForm, AeroInfluence};
pub use model::matrices::sector_faces::{SectorDescription, SectorFrame};
pub use model::matrices::speed::Speed;
pub use model::matrices::spring::Spring;
pub use model::matrices::structure::MatrixKind;
pub use model::natural_modes::linear_modes::{ContactState, LinearModes};
pub use model::wheels::blade_modes::BladeModes;
pub use model::wheels::mistuning::{BladeProperty, Mistuning};

// Parameters.
pub use contact::forms::constants::Constant;
pub use sensitivity::{Parameter, Reason};

// Analyses.
pub use analysis::forced::point_error::{estimate_at, estimate_at_with};
pub use analysis::forced_response::forced_response;
pub use analysis::in_time::run_through::sweep;
pub use analysis::in_time::time_response::time_response;
pub use analysis::in_time::verify::{Verification, verify};
pub use analysis::linear::damped_modes::{DampedModes, damped_modes};
pub use analysis::linear::linear_contacts::LinearContacts;
pub use analysis::linear::static_history::{LoadHistory, StaticStep, static_history};
pub use analysis::modes::nonlinear_mode::nonlinear_mode;
pub use analysis::over_parameter::parameter_range::{Follow, ParameterRange};
pub use analysis::over_parameter::parameter_response::parameter_response;
pub use analysis::perturbed::smallest_kick::{Kick, smallest_kick};
pub use analysis::residual_states::band::{Band, BandEnd, BandOf, BandOptions, BandState, band};
pub use analysis::residual_states::band_curve::{BandPoint, band_curve};
pub use analysis::residual_states::freedom::{FreeSlider, freedom, freedom_with};
pub use analysis::residual_states::mode_band::{ModeBand, ModeBandOf, ModeBandState, mode_band};
pub use analysis::synthesis::{Synthesis, SynthesisPeak, SynthesisPoint, Validity, synthesise, synthesise_with};
pub use at_a_point::check_jacobian::{JacobianGap, Tangent, check_jacobian};
pub use at_a_point::complex_sensitivity::{ComplexSensitivities, complex_sensitivity, complex_sensitivity_with};
pub use at_a_point::floquet::floquet;
pub use at_a_point::harmonic_residual::{
    ResidualArrays, contact_evaluate, contact_evaluate_with, forced_residual, forced_residual_with,
};
pub use at_a_point::response_of_motion::response_of;
pub use at_a_point::sensitivity_analysis::{Quantity, Sensitivities, sensitivity, sensitivity_with};
pub use hooks::{Hooks, LogLevel, LogSink, Progress};
#[doc(inline)]
pub use interrupt::{Interrupt, Phase, PhaseReport, PhaseSink};
pub use options::{
    Amplitude, BatchOptions, CampbellResponseOptions, Component, DampingForm, Duty, Flexibility, FloquetOptions,
    ForcedOptions, LifeFollow, LifeOptions, MissionOptions, ModeChoice, ModeGuess, ModeOptions, Response, RunUpOptions,
    SolverOptions, SteadyMethod, SweepOptions, SynthesisOptions, TimeOptions, VerifyOptions, Waves, Wear, Woehler,
};
pub use studies::batch::{Batch, batch};
pub use studies::campbell::{Campbell, Crossing, campbell};
pub use studies::campbell_response::{CampbellResonance, campbell_response};
pub use studies::design_peak::DesignPeak;
pub use studies::fit::{
    DataKind, Fit, FitData, FitOptions, FitProfile, Loss, Prediction, Profiled, Scale, Suspicion, Unknown, fit,
    fit_profile, predict,
};
pub use studies::interference::{Interference, interference};
pub use studies::mission::{Mission, MissionCrossing, mission};
pub use studies::run_up::{RunUp, RunUpTurn, run_up};
pub use studies::wear::life::{Life, LifeEvent, LifeEventKind, LifePoint, life};
pub use studies::wear::life_load::{BestLoad, best_load_for_life};
pub use studies::wheel_identify::{IdentifiedPattern, MeasuredModes, wheel_identify};
pub use studies::wheel_peaks::{BladePeak, WheelPeaks, wheel_peaks};

// Results.
pub use condense::Reduction;
pub use contact::forms::contact_state::State;
pub use contact::forms::time_piece::Grazing;
#[doc(inline)]
pub use error::{Error, Result, Status};
#[doc(inline)]
pub use fourier::{Measure, Reading};
pub use harmonics::{Corrected, Estimate};
pub use results::stored::mode_branch::{ModeField, ModeInfo, ModePoint};
pub use results::{
    Bifurcation, BifurcationKind, Branch, ContactLoop, ContactSummary, Descent, Energy, Floquet, HigherPeak,
    LimitCycle, Multiplier, MultiplierClass, Optimum, ResponseSeries, Searched, Special, Stretch, Turn,
};
pub use time_integration::{FrequencySweep, SweepTurn, TimeResponse};

#[doc = include_str!("../docs/statuses.md")]
pub mod when_it_does_not_converge {}
