//! Options of a nonlinear mode.

use crate::error::{Result, fail};
use crate::options::solver_options::MAX_HARMONIC;
use crate::options::tree_size::{check_tree, size_of_tree};
use num_complex::Complex64;

/// Artificial damping that makes the motion of a damped structure periodic; D is its damping ratio.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DampingForm {
    /// Mass form: the term −2Dω M ẋ.
    #[default]
    Mass,
    /// Stiffness form: the term −ζ K ẋ with D = ζω/2, where K is the structure's stiffness without springs and
    /// contacts.
    Stiffness,
}

/// Linear mode with stuck contacts from which a nonlinear mode starts.
#[derive(Clone, Copy, Debug)]
pub enum ModeChoice<'a> {
    /// The index of the mode, from 0 by rising frequency.
    Index(usize),
    /// The mode nearest to this angular frequency, rad per time unit, above zero.
    Near(f64),
    /// The mode most similar to this shape: ndof complex numbers of one sector, at any scale.
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

/// A motion near which the first point of a nonlinear mode lies, such as a point of another mode or above an internal resonance.
#[derive(Clone, Copy, Debug)]
pub struct ModeGuess<'a> {
    /// Motion: complex, (H + 1) × ndof, harmonic by harmonic, with its own H, at least 1. Its amplitude and phase are
    /// adapted to those of the first point; harmonics that laws do not excite by themselves are carried where the
    /// guess has them.
    pub motion: &'a [Complex64],
    /// Angular frequency, rad per time unit, above zero.
    pub omega: f64,
    /// Damping ratio of the mode.
    pub damping_ratio: f64,
}

/// Quantity that measures the amplitude of a mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Amplitude {
    /// Modal amplitude sqrt(X₁ᴴ M X₁) of the fundamental, over one sector: length times square root of mass.
    Modal,
    /// Amplitude |Y₁| of the fundamental of this contact's relative motion: length.
    Contact(usize),
}

/// Options of a nonlinear mode over a range of amplitude.
#[derive(Clone, Copy, Debug)]
pub struct ModeOptions<'a> {
    /// Linear mode with stuck contacts from which the nonlinear mode starts.
    pub choice: ModeChoice<'a>,
    /// Wave of the mode. `None`: the wave of the model's engine order. `Some(d)`: the wave of the signed nodal
    /// diameter d, modulo N, in which sector s + 1 lags by 2πd/N.
    pub diameter: Option<i64>,
    /// Quantity that measures the amplitude.
    pub amplitude: Amplitude,
    /// log10 of the first amplitude, in the caller's units.
    pub log10_start: f64,
    /// log10 of the last amplitude, above the first.
    pub log10_stop: f64,
    /// log10 of the amplitudes within the range at which every solution on the branch is stored.
    pub at: &'a [f64],
    /// Form of the artificial damping.
    pub damping_form: DampingForm,
    /// Degree of freedom that fixes the phase: its fundamental is real. `None`: the one that moves
    /// most in the linear mode.
    pub reference_dof: Option<usize>,
    /// Motion near the first point; `None`: the mode starts as the linear mode at small amplitudes.
    pub guess: Option<ModeGuess<'a>>,
    /// Further curves that are sought: 0 none; 1 those that start at its branch points, with even harmonics carried
    /// along, and the one beyond a tongue of internal resonance. They become children of the branch.
    pub branches: usize,
    /// Largest number of generations of these curves; 0: 3.
    pub branch_depth: usize,
    /// Largest number of these curves; 0: 32.
    pub most_branches: usize,
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
            guess: None,
            branches: 0,
            branch_depth: 0,
            most_branches: 0,
        }
    }
}

/// Largest |log10| of an amplitude: its square must be a number, too.
/// Kind: cap.
const MAX_LOG10: f64 = 150.0;

impl ModeOptions<'_> {
    /// Largest numbers of generations and of curves beside the mode.
    pub(crate) fn size_of_tree(&self) -> (usize, usize) {
        size_of_tree(self.branch_depth, self.most_branches)
    }

    /// Checks the values of all options for a model with these numbers of degrees of freedom (per sector), contacts
    /// and sectors.
    ///
    /// # Errors
    /// `Argument`, `NotFinite`, `Dimension` or `Index`, naming the field, its value and its range.
    pub fn check(&self, ndof: usize, contacts: usize, sectors: usize) -> Result<()> {
        self.choice.check(ndof)?;
        if let Some(diameter) = self.diameter.filter(|&d| sectors == 1 && d != 0) {
            return fail!(
                Argument,
                "diameter = {diameter}, needs 0 .. 0: a plain structure has no nodal diameters"
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
        check_tree(self.branches, 1, self.branch_depth, self.most_branches)?;
        if let Some(guess) = &self.guess {
            let rows = guess.motion.len() / ndof.max(1);
            if rows < 2 || rows * ndof != guess.motion.len() || rows > MAX_HARMONIC + 1 {
                return fail!(
                    Dimension,
                    "guess has {} complex entries, needs (H + 1) * ndof = (H + 1) * {ndof}, H = 1 .. {MAX_HARMONIC}",
                    guess.motion.len()
                );
            }
            if let Some(i) = guess.motion.iter().position(|z| !z.is_finite()) {
                return fail!(NotFinite, "guess[{i}] is not finite");
            }
            if !(guess.omega > 0.0 && guess.omega.is_finite()) {
                return fail!(
                    Argument,
                    "guess_omega = {}, needs an angular frequency > 0",
                    guess.omega
                );
            }
            if !guess.damping_ratio.is_finite() {
                return fail!(
                    NotFinite,
                    "guess_damping = {}, needs a finite number",
                    guess.damping_ratio
                );
            }
        }
        if let Some(dof) = self.reference_dof.filter(|&d| d >= ndof) {
            return fail!(Index, "reference_dof = {dof}, needs 0 .. {}", ndof - 1);
        }
        Ok(())
    }
}
