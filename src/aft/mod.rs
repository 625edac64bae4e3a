//! Alternating frequency-time evaluation of a contact law: harmonics of the motion in, harmonics
//! of the force and their Jacobian out.
//!
//! Laws on one relative motion have two ways, exact events ([`piecewise_exact`]) and equidistant samples
//! ([`piecewise_sampled`]), which end in the same assembly.
//! With pieces f = k·(x − x(r)) + o, the stiffness spectrum Sₙ = (1/2π)∫ k e^{−inτ} dτ and the
//! transforms gₕ = (2 − δ₀ₕ)/2π ∫ e^{−ihτ} dτ of each anchored piece,
//!
//! > ∂F/∂X = T(S) − Σ k g ⊗ c(r),  F = ∂F/∂X · X + Σ o g,
//!
//! because the force is continuous where pieces meet, so that moving events contribute nothing
//! (Petrov & Ewins 2003, doi:10.1115/1.1539868). T(S) maps Xₘ to Sₕ₋ₘ Xₘ + Sₕ₊ₘ conj(Xₘ). A smooth
//! law gives S at once, without pieces. Friction under a varying normal load has one such sum per
//! pair of directions; see [`varying_normal_load`]. The [`Evaluator`] selects the way by the form of the law.

mod evaluation;
mod evaluator;
pub mod hysteretic;
mod hysteretic_derivatives;
mod jacobian_assembly;
mod jacobian_block;
pub mod memoryless;
mod normal_force;
mod periodic_state;
pub mod piecewise_exact;
pub mod piecewise_sampled;
mod spectral;
mod toeplitz;
pub mod varying_normal_load;

pub use evaluation::Evaluation;
pub use evaluator::Evaluator;
