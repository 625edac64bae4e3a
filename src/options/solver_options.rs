//! Options of the solver, with their defaults and checks.

use crate::error::{Result, fail};
use crate::options::content::Content;
use crate::options::waves::Waves;

/// Method by which the flexibility of the structure at the contacts is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Flexibility {
    /// A basis for large structures where it is accurate, factors otherwise.
    #[default]
    Automatic,
    /// Complex LU factors of the dynamic stiffness of all degrees of freedom, at each frequency where they are
    /// needed.
    Direct,
    /// A block Krylov basis per nodal diameter from one real or Hermitian factorisation.
    Krylov,
}

/// Options that every analysis shares.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::struct_excessive_bools, reason = "each is an option of its own")]
pub struct SolverOptions {
    /// Requested relative error, from which the harmonics of each point are chosen. It applies to the complex
    /// fundamental of the response degree of freedom; in a nonlinear mode to the frequency and to the damping ratio,
    /// the latter relative to the largest one so far. `0`: exactly [`Self::harmonics`] are carried, whatever the
    /// error.
    pub tolerance: f64,
    /// Highest harmonic H; where the tolerance chooses the harmonics, the highest one of a second attempt at the
    /// first point.
    pub harmonics: usize,
    /// Largest H that the tolerance may choose, at least the highest forced harmonic. Points that would need more
    /// are kept, and the status of the branch reports them.
    pub max_harmonics: usize,
    /// Samples per period of the contact laws. `0`: exact stick-slip events. Otherwise every law is sampled at this
    /// number of equidistant times, at least 2H + 1; where the tolerance chooses the harmonics, at least 8H. Laws
    /// without events, and friction in one direction under a varying load, are exact either way.
    pub samples: usize,
    /// Factor of the samples that a law without exact events takes where [`Self::samples`] is 0, at least 1. With a
    /// tolerance an analysis raises it until the error of sampling is below the tolerance.
    pub refinement: usize,
    /// First arc-length step in scaled unknowns, between the smallest and the largest one where these are given; `0`: automatic.
    pub step: f64,
    /// Smallest step, below which the branch ends; `0`: automatic. An automatic largest step is never below it.
    pub step_min: f64,
    /// Largest step; `0`: automatic. Where every contact is linear, points lie at the resonances, and this is the largest share of
    /// the range between neighbours.
    pub step_max: f64,
    /// Residual, relative to the contact motion, at which a point counts as converged. A last Newton correction
    /// follows, so that the error of the solution is far below this value. Where short steps follow a smooth branch,
    /// the residual behind that correction counts, if a hundred times what is foreseen of it is below this value.
    pub tol_residual: f64,
    /// Largest number of Newton iterations per point.
    pub max_newton: usize,
    /// Largest number of accepted points.
    pub max_points: usize,
    /// Degree of freedom whose fundamental defines amplitude and peaks. `None`: the forced one that moves most at the
    /// lower end of the range, with the contacts at their reference stiffness. In a nonlinear mode its fundamental is
    /// the reported amplitude; `None`: the degree of freedom of the phase reference.
    pub response_dof: Option<usize>,
    /// Whether to carry the mean and the even harmonics even where symmetry makes them zero.
    pub keep_even_harmonics: bool,
    /// Whether to estimate the error of every stored point, by a few Newton steps with more harmonics. Each estimate
    /// costs about as much time as a solution with more harmonics. Where the tolerance chooses the harmonics, the
    /// error is estimated in any case.
    pub estimate_error: bool,
    /// Method by which the flexibility of the structure at the contacts of a forced response is computed.
    pub flexibility: Flexibility,
    /// Largest estimated relative error of the motion of the structure on a basis, up to which the basis grows.
    pub certificate: f64,
    /// Largest number of bytes for factors and bases of the structure, for the equations of a point, and for an estimate
    /// of its error, each by itself; `0`: no limit. A call that needs more is refused before it asks for them; where a
    /// tolerance chooses the harmonics, fewer are used, and an estimate that needs more is an unknown error.
    pub memory_limit: usize,
    /// Perturbations whose Floquet multipliers are computed at each point of a forced response; `None`: no stability.
    /// A nonlinear mode refuses this option.
    pub stability: Option<Waves>,
    /// Whether to compute the free sliders of each stored point of a forced response, with the derivatives of its
    /// amplitude by their places (see [`freedom`](crate::freedom())). A nonlinear mode refuses this option.
    pub freedom: bool,
    /// Sliders that have exchanged motions; an analysis sets it.
    pub exchange: Exchanged,
    /// Harmonics that are carried beyond those which forces and laws excite by themselves; an analysis with a guess sets it.
    pub content: Content,
}

/// Sliders under a constant load whose motions are exchanged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Exchanged {
    /// No sliders.
    #[default]
    None,
    /// Rigid sliders, which have no other equations.
    Rigid,
    /// Rigid and near-rigid sliders.
    NearRigid,
}

impl Default for SolverOptions {
    fn default() -> Self {
        Self {
            tolerance: 1e-3,
            harmonics: 9,
            max_harmonics: DEFAULT_MAX_HARMONICS,
            samples: 0,
            refinement: 1,
            step: 0.0,
            step_min: 0.0,
            step_max: 0.0,
            tol_residual: 1e-10,
            max_newton: 25,
            max_points: 20_000,
            response_dof: None,
            keep_even_harmonics: false,
            estimate_error: false,
            flexibility: Flexibility::Automatic,
            certificate: 1e-8,
            memory_limit: 0,
            stability: None,
            freedom: false,
            exchange: Exchanged::None,
            content: Content::default(),
        }
    }
}

/// Largest number of harmonics that a tolerance chooses by default.
/// Kind: fixed.
const DEFAULT_MAX_HARMONICS: usize = 511;

/// Highest harmonic number that is accepted; beyond it index arithmetic may overflow and run times are excessive.
/// Kind: cap.
pub const MAX_HARMONIC: usize = 100_000;

/// Largest factor of the samples of laws without exact events.
/// Kind: cap.
pub const MAX_REFINEMENT: usize = 64;

/// Largest accepted number of samples per period.
/// Kind: cap.
pub const MAX_SAMPLES: usize = 1 << 24;

impl SolverOptions {
    /// A copy of these options with exactly the given harmonics, whatever the error.
    #[must_use]
    pub fn fixed(&self) -> Self {
        Self {
            tolerance: 0.0,
            ..*self
        }
    }

    /// Checks the values of all options.
    ///
    /// # Errors
    /// [`Status::Argument`](crate::error::Status::Argument) naming the field, its value and its
    /// range.
    pub fn check(&self) -> Result<()> {
        if !(self.tolerance >= 0.0 && self.tolerance < 1.0) {
            return fail!(Argument, "tolerance = {}, needs 0 <= tolerance < 1", self.tolerance);
        }
        if self.harmonics > MAX_HARMONIC {
            return fail!(Argument, "harmonics = {}, needs 0 .. {MAX_HARMONIC}", self.harmonics);
        }
        if self.max_harmonics > MAX_HARMONIC {
            return fail!(
                Argument,
                "max_harmonics = {}, needs 0 .. {MAX_HARMONIC}",
                self.max_harmonics
            );
        }
        if self.refinement == 0 || self.refinement > MAX_REFINEMENT {
            return fail!(
                Argument,
                "refinement = {}, needs 1 .. {MAX_REFINEMENT}",
                self.refinement
            );
        }
        if self.samples > MAX_SAMPLES || (self.samples > 0 && self.samples < 2 * self.harmonics + 1) {
            return fail!(
                Argument,
                "samples = {}, needs 0 (exact events) or 2*harmonics+1 = {} .. {MAX_SAMPLES}",
                self.samples,
                2 * self.harmonics + 1
            );
        }
        for (name, value) in [
            ("step", self.step),
            ("step_min", self.step_min),
            ("step_max", self.step_max),
        ] {
            if !(value >= 0.0 && value.is_finite()) {
                return fail!(Argument, "{name} = {value}, needs a finite number >= 0 (0 = automatic)");
            }
        }
        if self.step_max > 0.0 && self.step_min > self.step_max {
            return fail!(
                Argument,
                "step_min = {} exceeds step_max = {}",
                self.step_min,
                self.step_max
            );
        }
        if self.step > 0.0 && (self.step < self.step_min || (self.step_max > 0.0 && self.step > self.step_max)) {
            return fail!(
                Argument,
                "step = {}, needs step_min = {} .. step_max = {} (0 = automatic)",
                self.step,
                self.step_min,
                self.step_max
            );
        }
        if self.tolerance == 0.0 && self.max_harmonics < self.harmonics && self.max_harmonics != DEFAULT_MAX_HARMONICS {
            return fail!(
                Argument,
                "max_harmonics = {} is below harmonics = {}, which tolerance = 0 selects",
                self.max_harmonics,
                self.harmonics
            );
        }
        if !(self.tol_residual > 0.0 && self.tol_residual < 1.0) {
            return fail!(
                Argument,
                "tol_residual = {}, needs 0 < tol_residual < 1",
                self.tol_residual
            );
        }
        if self.max_newton == 0 {
            return fail!(Argument, "max_newton = 0, needs at least 1");
        }
        if self.max_points == 0 {
            return fail!(Argument, "max_points = 0, needs at least 1");
        }
        Ok(())
    }
}
