//! Alternating frequency-time evaluation of a contact law: from harmonics of the motion to harmonics of the force and
//! their Jacobian.
//!
//! Laws on one relative motion have two evaluations, exact events ([`piecewise_exact`]) and equidistant samples
//! ([`piecewise_sampled`]), which use the same assembly. With pieces f = k·(x − x(r)) + o, the stiffness spectrum
//! Sₙ = (1/2π)∫ k e^{−inτ} dτ and the transforms gₕ = (2 − δ₀ₕ)/2π ∫ e^{−ihτ} dτ of each anchored piece,
//!
//! > ∂F/∂X = T(S) − Σ k g ⊗ c(r),  F = ∂F/∂X · X + Σ o g,
//!
//! because the force is continuous where pieces meet, so that moving events contribute nothing (Petrov & Ewins 2003,
//! doi:10.1115/1.1539868). T(S) maps Xₘ to Sₕ₋ₘ Xₘ + Sₕ₊ₘ conj(Xₘ). For a smooth law S follows directly, without
//! pieces. Friction under a varying normal load has one such sum per pair of directions; see [`varying_normal_load`].
//! The [`Evaluator`] selects the evaluation by the form of the law.

mod evaluation;
mod evaluator;
pub mod hysteretic;
mod hysteretic_derivatives;
mod jacobian_assembly;
mod jacobian_block;
mod late_jumps;
pub mod memoryless;
mod moved_ends;
mod normal_force;
mod periodic_state;
pub mod piecewise_exact;
pub mod piecewise_sampled;
pub mod plane_friction;
mod spectral;
mod toeplitz;
pub mod varying_normal_load;

pub use evaluation::Evaluation;
pub use evaluator::Evaluator;
pub use late_jumps::late_jumps;
