//! Options of the analyses and the one home of their defaults.

mod time;

pub use time::{SteadyMethod, TimeOptions, VerifyOptions};

use crate::error::{Result, fail};
use num_complex::Complex64;

/// Options that every analysis shares.
#[derive(Clone, Copy, Debug)]
pub struct SolverOptions {
    /// Relative error wanted, from which the harmonics of each point are chosen: of the complex fundamental of the
    /// response degree of freedom; in a nonlinear mode of the frequency and of the damping ratio, the latter over
    /// the largest met so far. `0`: exactly [`Self::harmonics`], whatever the error.
    pub tolerance: f64,
    /// Highest harmonic number H. Where the tolerance decides: the H to begin with.
    pub harmonics: usize,
    /// Cap on H where the tolerance decides, at least the highest harmonic that is forced. Points that would need
    /// more are kept, and the branch tells so by its status.
    pub max_harmonics: usize,
    /// `0`: exact stick-slip events. Otherwise every law is sampled at so many equidistant times
    /// per period, at least 2H + 1; where the tolerance decides, at least 8H are taken. Laws without events, and friction in one direction under
    /// a load that varies, are exact either way.
    pub samples: usize,
    /// First arc-length step in scaled unknowns; `0` chooses.
    pub step: f64,
    /// Smallest step before the branch is given up; `0` chooses.
    pub step_min: f64,
    /// Largest step; `0` chooses.
    pub step_max: f64,
    /// Residual, relative to the contact motion, at which a point counts as converged. A last
    /// Newton correction follows, so the solution is far closer than this.
    pub tol_residual: f64,
    /// Cap on Newton iterations per point.
    pub max_newton: usize,
    /// Cap on the number of accepted points.
    pub max_points: usize,
    /// Degree of freedom whose fundamental defines amplitude and peaks; `None`: the forced one
    /// that moves most at the lower end of the range, contacts at their reference stiffness. In a
    /// nonlinear mode its fundamental is the amplitude reported; `None`: that of the phase
    /// reference.
    pub response_dof: Option<usize>,
    /// Carry the mean and the even harmonics even where symmetry makes them zero.
    pub keep_even_harmonics: bool,
    /// Estimate the error of every stored point, see [`crate::error_estimate`]: the time of a solution with
    /// more harmonics at each of them. Where the tolerance decides it is estimated in any case.
    pub estimate_error: bool,
}

impl Default for SolverOptions {
    fn default() -> Self {
        Self {
            tolerance: 1e-3,
            harmonics: 9,
            max_harmonics: 511,
            samples: 0,
            step: 0.0,
            step_min: 0.0,
            step_max: 0.0,
            tol_residual: 1e-10,
            max_newton: 25,
            max_points: 20_000,
            response_dof: None,
            keep_even_harmonics: false,
            estimate_error: false,
        }
    }
}

/// Highest harmonic number that is accepted; beyond it index arithmetic and time are not sane.
pub const MAX_HARMONIC: usize = 100_000;

/// Most samples per period that are accepted.
pub const MAX_SAMPLES: usize = 1 << 24;

impl SolverOptions {
    /// The same with exactly the harmonics given, whatever the error.
    #[must_use]
    pub fn fixed(&self) -> Self {
        Self {
            tolerance: 0.0,
            ..*self
        }
    }

    /// Checks every field.
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

/// Options of a forced response over a range of frequency.
#[derive(Clone, Copy, Debug, Default)]
pub struct ForcedOptions<'a> {
    /// First angular frequency, rad per time unit, above zero.
    pub omega_start: f64,
    /// Last angular frequency; below the first for a downward sweep, equal to it for one point.
    pub omega_stop: f64,
    /// Angular frequencies within the range at which every solution on the branch is wanted.
    pub at: &'a [f64],
    /// Start values: complex, (H + 1) × ndof, harmonic by harmonic; `None`: the stuck solution.
    pub guess: Option<&'a [Complex64]>,
}

impl ForcedOptions<'_> {
    /// Checks range, requested frequencies and guess (against `(harmonics + 1) * ndof`).
    ///
    /// # Errors
    /// `Argument`, `NotFinite` or `Dimension`, naming the field, its value and its range.
    pub fn check(&self, guess_len: usize) -> Result<()> {
        for (name, value) in [("omega_start", self.omega_start), ("omega_stop", self.omega_stop)] {
            if !value.is_finite() {
                return fail!(NotFinite, "{name} = {value}, needs a finite angular frequency > 0");
            }
            if value <= 0.0 {
                return fail!(Argument, "{name} = {value}, needs an angular frequency > 0");
            }
        }
        let (low, high) = (
            self.omega_start.min(self.omega_stop),
            self.omega_start.max(self.omega_stop),
        );
        for (i, &w) in self.at.iter().enumerate() {
            if !w.is_finite() {
                return fail!(NotFinite, "at[{i}] = {w}, needs a finite angular frequency");
            }
            if w < low || w > high {
                return fail!(Argument, "at[{i}] = {w}, needs a frequency within {low} .. {high}");
            }
        }
        if let Some(guess) = self.guess {
            if guess.len() != guess_len {
                return fail!(
                    Dimension,
                    "guess has {} complex entries, needs (harmonics+1)*ndof = {guess_len}",
                    guess.len()
                );
            }
            if let Some(i) = guess.iter().position(|z| !z.is_finite()) {
                return fail!(NotFinite, "guess[{i}] is not finite");
            }
        }
        Ok(())
    }
}

/// Artificial damping that makes the motion of a damped structure periodic, D its damping ratio.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DampingForm {
    /// The term −2Dω M ẋ.
    #[default]
    Mass,
    /// The term −ζ K ẋ, D = ζω/2, K the structure's own stiffness without springs and contacts.
    Stiffness,
}

/// Which linear mode, contacts stuck, a nonlinear mode starts from.
#[derive(Clone, Copy, Debug)]
pub enum ModeChoice<'a> {
    /// The number of the mode, from 0 by rising frequency.
    Index(usize),
    /// The mode nearest to this angular frequency, rad per time unit, above zero.
    Near(f64),
    /// The mode most alike this shape: ndof complex numbers of one sector, of any size.
    Shape(&'a [Complex64]),
}

impl ModeChoice<'_> {
    /// Checks the choice for a model of `ndof` degrees of freedom (per sector).
    ///
    /// # Errors
    /// `Argument`, `NotFinite` or `Dimension`, naming the field, its value and its range.
    pub fn check(&self, ndof: usize) -> Result<()> {
        match *self {
            Self::Near(omega) if !omega.is_finite() => {
                fail!(NotFinite, "near_omega = {omega}, needs a finite angular frequency > 0")
            }
            Self::Near(omega) if omega <= 0.0 => {
                fail!(Argument, "near_omega = {omega}, needs an angular frequency > 0")
            }
            Self::Index(_) | Self::Near(_) => Ok(()),
            Self::Shape(shape) => {
                if shape.len() != ndof {
                    return fail!(
                        Dimension,
                        "shape has {} complex entries, needs ndof = {ndof}",
                        shape.len()
                    );
                }
                if let Some(i) = shape.iter().position(|z| !z.is_finite()) {
                    return fail!(NotFinite, "shape[{i}] is not finite");
                }
                if shape.iter().all(|&z| z == Complex64::ZERO) {
                    return fail!(Argument, "shape is zero, needs a motion");
                }
                Ok(())
            }
        }
    }
}

/// What the amplitude of a mode measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Amplitude {
    /// sqrt(X₁ᴴ M X₁) of the fundamental, over one sector: length times square root of mass.
    Modal,
    /// |Y₁|, the peak of the fundamental of the relative motion of this contact: length.
    Contact(usize),
}

/// Options of a nonlinear mode over a range of amplitude.
#[derive(Clone, Copy, Debug)]
pub struct ModeOptions<'a> {
    /// The linear mode, contacts stuck, that it starts from.
    pub choice: ModeChoice<'a>,
    /// `None`: the wave of the model's engine order. `Some(d)`: the forward wave of nodal diameter d.
    pub diameter: Option<usize>,
    /// What the amplitude measures.
    pub amplitude: Amplitude,
    /// log10 of the first amplitude, in the caller's units.
    pub log10_start: f64,
    /// log10 of the last amplitude, above the first.
    pub log10_stop: f64,
    /// log10 of the amplitudes within the range at which every solution on the branch is wanted.
    pub at: &'a [f64],
    /// Form of the artificial damping.
    pub damping_form: DampingForm,
    /// Degree of freedom that fixes the phase: its fundamental is real. `None`: the one that moves
    /// most in the linear mode.
    pub reference_dof: Option<usize>,
}

impl Default for ModeOptions<'_> {
    fn default() -> Self {
        Self {
            choice: ModeChoice::Index(0),
            diameter: None,
            amplitude: Amplitude::Modal,
            log10_start: 0.0,
            log10_stop: 0.0,
            at: &[],
            damping_form: DampingForm::Mass,
            reference_dof: None,
        }
    }
}

/// Largest |log10| of an amplitude: its square must be a number, too.
const MAX_LOG10: f64 = 150.0;

impl ModeOptions<'_> {
    /// Checks every field for a model of `ndof` degrees of freedom (per sector), so many contacts and
    /// sectors.
    ///
    /// # Errors
    /// `Argument`, `NotFinite`, `Dimension` or `Index`, naming the field, its value and its range.
    pub fn check(&self, ndof: usize, contacts: usize, sectors: usize) -> Result<()> {
        self.choice.check(ndof)?;
        if let Some(diameter) = self.diameter.filter(|&d| d > sectors / 2) {
            return fail!(
                Argument,
                "diameter = {diameter}, needs 0 .. {} for {sectors} sectors",
                sectors / 2
            );
        }
        if let Amplitude::Contact(id) = self.amplitude
            && id >= contacts
        {
            return fail!(Index, "amplitude_contact = {id}, but the model has {contacts} contacts");
        }
        let (start, stop) = (self.log10_start, self.log10_stop);
        for (name, value) in [("log10_start", start), ("log10_stop", stop)] {
            if !value.is_finite() {
                return fail!(NotFinite, "{name} = {value}, needs a finite number");
            }
            if value.abs() > MAX_LOG10 {
                return fail!(Argument, "{name} = {value}, needs -{MAX_LOG10} .. {MAX_LOG10}");
            }
        }
        if start >= stop {
            return fail!(
                Argument,
                "amplitude range is empty or reversed: log10_start = {start}, log10_stop = {stop}, needs start < stop"
            );
        }
        for (i, &a) in self.at.iter().enumerate() {
            if !a.is_finite() {
                return fail!(NotFinite, "at[{i}] = {a}, needs a finite log10 of an amplitude");
            }
            if a < start || a > stop {
                return fail!(
                    Argument,
                    "at[{i}] = {a}, needs the log10 of an amplitude within {start} .. {stop}"
                );
            }
        }
        if let Some(dof) = self.reference_dof.filter(|&d| d >= ndof) {
            return fail!(Index, "reference_dof = {dof}, needs 0 .. {}", ndof - 1);
        }
        Ok(())
    }
}

/// Options of a response synthesised from a nonlinear mode.
#[derive(Clone, Copy, Debug)]
pub struct SynthesisOptions {
    /// Factor on all forces of the model.
    pub force_factor: f64,
    /// Damping ratio that is added to the mode's.
    pub damping_ratio: f64,
    /// Add the damping of the model's C, which is right for a mode that was computed without it.
    pub model_damping: bool,
}

impl Default for SynthesisOptions {
    fn default() -> Self {
        Self {
            force_factor: 1.0,
            damping_ratio: 0.0,
            model_damping: false,
        }
    }
}

impl SynthesisOptions {
    /// Checks every field.
    ///
    /// # Errors
    /// `NotFinite` or `Argument`, naming the field, its value and its range.
    pub fn check(&self) -> Result<()> {
        for (name, value) in [
            ("force_factor", self.force_factor),
            ("damping_ratio", self.damping_ratio),
        ] {
            if !value.is_finite() {
                return fail!(NotFinite, "{name} = {value}, needs a finite number");
            }
        }
        if self.force_factor <= 0.0 {
            return fail!(Argument, "force_factor = {}, needs a number > 0", self.force_factor);
        }
        if self.damping_ratio.abs() >= 1.0 {
            return fail!(
                Argument,
                "damping_ratio = {}, needs -1 < damping_ratio < 1",
                self.damping_ratio
            );
        }
        Ok(())
    }
}
