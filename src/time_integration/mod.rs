//! Periodic responses by integration in time from event to event, without a harmonic series.

mod event_law;
mod event_loop;
mod frequency_sweep;
mod gauss;
mod harmonic_analysis;
mod implicit_step;
mod initial_state;
mod largest_motion;
mod linear_step;
mod periodic_response;
mod perturbation_basis;
mod perturbation_products;
mod sensitivity;
mod shooting;
mod smooth_laws;
mod step_polynomial;
mod unrolled_structure;
mod variation;
mod variational_equations;
mod variational_step;

pub use frequency_sweep::{FrequencySweep, SweepTurn, run_through};
pub use periodic_response::{TimeResponse, solve};

// The variational equations of the room `stability`.
pub(crate) use event_law::Element;
pub(crate) use event_loop::{EventLoop, GRAZING_SPEED, Observers, State};
pub(crate) use harmonic_analysis::HarmonicAnalysis;
pub(crate) use initial_state::{SLIDER_POINTS_PER_WAVE, state_of, state_of_sector};
pub(crate) use periodic_response::solve_disturbed;
pub(crate) use perturbation_basis::PerturbationBasis;
pub(crate) use sensitivity::Sensitivity;
pub(crate) use shooting::{Steady, SteadySearch, check_shooting};
pub(crate) use step_polynomial::{DEGREE, first_fall};
pub(crate) use unrolled_structure::{System, refuse_massless, refuse_structural_damping};
pub(crate) use variation::{Interval, Variation};
pub(crate) use variational_equations::{Number, VariationalElement, VariationalEquations};
