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
#[doc(hidden)]
pub use hbvib_numerics::{error, fourier, interrupt, linalg, shortage};

#[doc(hidden)]
pub mod aft;
#[doc(hidden)]
pub mod analysis;
mod byte_stream;
#[doc(hidden)]
pub mod capi;
#[doc(hidden)]
pub mod condense;
#[doc(hidden)]
pub mod contact;
#[doc(hidden)]
pub mod continuation;
#[doc(hidden)]
pub mod harmonics;
#[doc(hidden)]
pub mod hooks;
#[doc(hidden)]
pub mod model;
#[doc(hidden)]
pub mod options;
#[doc(hidden)]
pub mod problem;
#[doc(hidden)]
pub mod results;
#[doc(hidden)]
pub mod sensitivity;
#[doc(hidden)]
pub mod stability;
#[doc(hidden)]
pub mod time_integration;
mod tracing;

// Models.
pub use contact::laws::iwan::Iwan;
pub use contact::laws::polynomial::{Monomial, Polynomial};
pub use contact::laws::table::Table;
pub use contact::laws::user_law::{Call, States, User, UserForce};
pub use contact::patch::Patch;
pub use contact::relative_motion::{Direction, Frame};
pub use contact::rigid_point::RigidPoint;
pub use contact::{Contact, ContactKind};
#[doc(inline)]
pub use linalg::matrix_view::{MatrixView, Part, Storage, Values};
pub use model::Model;
pub use model::aero::{AeroEntry, AeroForm, AeroInfluence};
pub use model::damper::{Damper, DamperFace, DamperPlace};
pub use model::linear_modes::{ContactState, LinearModes};
pub use model::mistuning::{BladeProperty, Mistuning};
pub use model::sector_faces::{SectorDescription, SectorFrame};
pub use model::speed::Speed;
pub use model::spring::Spring;
pub use model::structure::MatrixKind;

// Parameters.
pub use contact::force_derivative::Constant;
pub use sensitivity::{Parameter, Reason};

// Analyses.
pub use analysis::band::{Band, BandEnd, BandOf, BandOptions, BandState, band};
pub use analysis::band_curve::{BandPoint, band_curve};
pub use analysis::batch::{Batch, batch};
pub use analysis::campbell::{Campbell, Crossing, campbell};
pub use analysis::campbell_response::{CampbellResonance, campbell_response};
pub use analysis::check_jacobian::{JacobianGap, Tangent, check_jacobian};
pub use analysis::complex_sensitivity::{ComplexSensitivities, complex_sensitivity, complex_sensitivity_with};
pub use analysis::damped_modes::{DampedModes, damped_modes};
pub use analysis::design_peak::DesignPeak;
pub use analysis::fit::{
    DataKind, Fit, FitData, FitOptions, FitProfile, Loss, Prediction, Profiled, Scale, Suspicion, Unknown, fit,
    fit_profile, predict,
};
pub use analysis::floquet::floquet;
pub use analysis::forced_response::forced_response;
pub use analysis::freedom::{FreeSlider, freedom, freedom_with};
pub use analysis::harmonic_residual::{
    ResidualArrays, contact_evaluate, contact_evaluate_with, forced_residual, forced_residual_with,
};
pub use analysis::interference::{Interference, interference};
pub use analysis::life::{Life, LifeEvent, LifeEventKind, LifePoint, life};
pub use analysis::life_load::{BestLoad, best_load_for_life};
pub use analysis::linear_contacts::LinearContacts;
pub use analysis::mission::{Mission, MissionCrossing, mission};
pub use analysis::mode_band::{ModeBand, ModeBandOf, ModeBandState, mode_band};
pub use analysis::nonlinear_mode::nonlinear_mode;
pub use analysis::parameter_range::{Follow, ParameterRange};
pub use analysis::parameter_response::parameter_response;
pub use analysis::point_error::{estimate_at, estimate_at_with};
pub use analysis::response_of_motion::response_of;
pub use analysis::run_through::sweep;
pub use analysis::run_up::{RunUp, RunUpTurn, run_up};
pub use analysis::sensitivity_analysis::{Quantity, Sensitivities, sensitivity, sensitivity_with};
pub use analysis::smallest_kick::{Kick, smallest_kick};
pub use analysis::static_history::{LoadHistory, StaticStep, static_history};
pub use analysis::synthesis::{Synthesis, SynthesisPeak, SynthesisPoint, Validity, synthesise, synthesise_with};
pub use analysis::time_response::time_response;
pub use analysis::verify::{Verification, verify};
pub use analysis::wheel_identify::{IdentifiedPattern, MeasuredModes, wheel_identify};
pub use analysis::wheel_peaks::{BladePeak, WheelPeaks, wheel_peaks};
pub use hooks::{Hooks, LogLevel, LogSink, Progress};
#[doc(inline)]
pub use interrupt::{Interrupt, Phase, PhaseReport, PhaseSink};
pub use options::{
    Amplitude, BatchOptions, CampbellResponseOptions, Component, DampingForm, Duty, FloquetOptions, ForcedOptions,
    LifeFollow, LifeOptions, MissionOptions, ModeChoice, ModeOptions, Response, RunUpOptions, SolverOptions,
    SteadyMethod, SweepOptions, SynthesisOptions, TimeOptions, VerifyOptions, Waves, Wear, Woehler,
};

// Results.
pub use condense::Reduction;
pub use contact::contact_state::State;
pub use contact::time_piece::Grazing;
#[doc(inline)]
pub use error::{Error, Result, Status};
#[doc(inline)]
pub use fourier::{Measure, Reading};
pub use harmonics::{Corrected, Estimate};
pub use results::mode_branch::{ModeField, ModeInfo, ModePoint};
pub use results::{
    Bifurcation, BifurcationKind, Branch, ContactLoop, ContactSummary, Descent, Energy, Floquet, HigherPeak,
    LimitCycle, Multiplier, MultiplierClass, Optimum, ResponseSeries, Searched, Special, Stretch, Turn,
};
pub use time_integration::{FrequencySweep, SweepTurn, TimeResponse};

#[doc = include_str!("../docs/statuses.md")]
pub mod when_it_does_not_converge {}
