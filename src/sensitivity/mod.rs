//! Derivatives of results by parameters of the model, with one adjoint solution for all parameters.
//!
//! With the equations R(u, p) = 0 and a result A(u, p) the adjoint λ solves (∂R/∂u)ᵀ λ = ∂A/∂u, and
//!
//! > dA/dp = ∂A/∂p − λᵀ ∂R/∂p.
//!
//! In terms of the whole structure, whose motion is x = Z⁻¹(F − Wᴴ f), the result depends on p through x alone. The
//! adjoint motion Λ = Z⁻ᴴ (Wᴴ λ + ∂A/∂x) then gives both terms at once:
//!
//! > dA/dp = Re Σ_h Λ_hᴴ (∂F_h/∂p − ∂Z_h/∂p x_h − Wᴴ ∂f_h/∂p).
//!
//! `parameter` lists the parameters, and `design` gives them values; `adjoint` has the result of an adjoint solution, `forced_point` and `mode_point` make
//! it; `contact_products` and `structure_products` are the terms of the sum; `total_derivative` adds them.

mod adjoint;
mod central_differences;
mod contact_products;
mod design;
mod extremum_point;
mod fold_point;
mod forced_point;
mod friction_work;
mod mode_point;
mod newton_factors;
mod one_sided;
mod parameter;
mod peak_point;
mod peak_shape;
mod peak_shift;
mod sampled_model;
mod structure_products;
mod total_derivative;
pub(crate) mod tracked;
mod tracked_response;

pub(crate) use adjoint::Adjoint;
pub(crate) use central_differences::central_differences;
pub(crate) use design::{by_value, design, design_with_bases};
pub(crate) use forced_point::ForcedPoint;
pub(crate) use friction_work::work_at_fixed_motion;
pub(crate) use mode_point::{ModePointAdjoint, ModeQuantity};
pub(crate) use one_sided::contact_at_onset;
pub use parameter::{Parameter, Reason};
pub(crate) use peak_point::peak_row;
pub(crate) use peak_shape::{is_corner, is_steep, stored_point};
pub(crate) use peak_shift::peak_shift;
pub(crate) use sampled_model::SampledModel;
pub(crate) use structure_products::WaveMatrices;
pub(crate) use total_derivative::TotalDerivative;
pub(crate) use tracked_response::{FollowedPoint, ResponsePoint, TrackedResponse};
