//! Options of a forced response.

use crate::error::{Result, fail};
use crate::options::response::Response;
use crate::options::solver_options::{MAX_HARMONIC, SolverOptions};
use crate::options::tree_size::{check_tree, size_of_tree};
use num_complex::Complex64;

/// Width of a range, relative, that is rounding of its ends.
/// Kind: rounding.
const NARROWEST_RANGE: f64 = 1e-12;

/// Largest number of `branches`.
/// Kind: fixed.
const MOST_SOUGHT: usize = 4;

/// Options of a forced response over a range of frequency.
#[derive(Clone, Copy, Debug, Default)]
pub struct ForcedOptions<'a> {
    /// First angular frequency, rad per time unit, above zero.
    pub omega_start: f64,
    /// Last angular frequency; below the first for a downward sweep, equal to it for one point. It differs by more than 1e-12 of itself.
    pub omega_stop: f64,
    /// Angular frequencies within the range at which every solution on the branch is stored.
    pub at: &'a [f64],
    /// Initial guess: complex, (H + 1) × ndof, harmonic by harmonic, with an H of its own; `None`: the solution with stuck
    /// contacts. The motion at the contacts counts. Harmonics that forces and laws do not excite by themselves, as a
    /// subharmonic, a mean or even harmonics of a symmetric model, are carried where the guess has them.
    pub guess: Option<&'a [Complex64]>,
    /// Responses that are watched: the first one leads the amplitude and the peaks of the branch, and a tolerance holds for each. None:
    /// the fundamental of the response degree of freedom.
    pub responses: &'a [Response<'a>],
    /// Whether the tolerance holds for the responses in one norm, (Σ|error|²/Σ|response|²)^½, instead of for each by itself.
    pub together: bool,
    /// Further solutions that are sought: 0 none; 1 branches that branch off where the period doubles, a symmetry breaks, or at
    /// simple branch points; 2 detached curves along nonlinear modes, too; 3 those that peaks and folds lead to over the force, and
    /// subharmonic curves of the orders 2 and 3 by a net of starts, too; 4 solutions that deflation finds beside the response, too.
    /// From 1 on stability is computed along all of them.
    pub branches: usize,
    /// Largest number of generations of branches that branch off; 0: 3.
    pub branch_depth: usize,
    /// Largest number of branches beside the response; 0: 32.
    pub most_branches: usize,
}

impl ForcedOptions<'_> {
    /// Largest numbers of generations and of branches beside the response.
    pub(crate) fn size_of_tree(&self) -> (usize, usize) {
        size_of_tree(self.branch_depth, self.most_branches)
    }

    /// Checks range and requested frequencies.
    ///
    /// # Errors
    /// `Argument` or `NotFinite`, naming the field, its value and its range.
    pub fn check(&self) -> Result<()> {
        for (name, value) in [("omega_start", self.omega_start), ("omega_stop", self.omega_stop)] {
            if !value.is_finite() {
                return fail!(NotFinite, "{name} = {value}, needs a finite angular frequency > 0");
            }
            if value <= 0.0 {
                return fail!(Argument, "{name} = {value}, needs an angular frequency > 0");
            }
        }
        // A curve of a few roundings has no direction.
        let width = (self.omega_stop - self.omega_start).abs();
        if width > 0.0 && width <= NARROWEST_RANGE * self.omega_stop {
            return fail!(
                Argument,
                "omega_stop = {:?} is omega_start = {:?} but for rounding, needs to be equal to it, for one frequency, or farther away",
                self.omega_stop,
                self.omega_start
            );
        }
        check_tree(self.branches, MOST_SOUGHT, self.branch_depth, self.most_branches)?;
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
        Ok(())
    }

    /// Refuses a search for branches at a single frequency, where none can be followed.
    ///
    /// # Errors
    /// `Argument`.
    pub(crate) fn check_search(&self) -> Result<()> {
        if self.branches > 0 && self.omega_stop - self.omega_start == 0.0 {
            return fail!(
                Argument,
                "branches = {} at the single frequency omega_start = omega_stop = {}, needs 0 there: branches are followed over a range",
                self.branches,
                self.omega_start
            );
        }
        Ok(())
    }

    /// Checks the guess of a model of `ndof` degrees of freedom.
    ///
    /// # Errors
    /// `Argument`, `NotFinite` or `Dimension`, naming its value and its range.
    pub fn check_guess(&self, ndof: usize) -> Result<()> {
        if let Some(guess) = self.guess {
            let rows = guess.len() / ndof.max(1);
            if rows == 0 || rows * ndof != guess.len() || rows > MAX_HARMONIC + 1 {
                return fail!(
                    Dimension,
                    "guess has {} complex entries, needs (H + 1) * ndof = (H + 1) * {ndof}, H = 0 .. {MAX_HARMONIC}",
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

/// Refuses a guess that has relevant harmonics above those of the solver.
///
/// # Errors
/// `Argument`, naming the option.
pub(crate) fn check_highest(highest: usize, solver: &SolverOptions) -> Result<()> {
    let (name, most) = if solver.tolerance > 0.0 {
        ("max_harmonics", solver.max_harmonics)
    } else {
        ("harmonics", solver.harmonics)
    };
    if highest > most {
        return fail!(
            Argument,
            "guess has harmonic {highest}, but {name} = {most}; raise {name} to {highest}, or leave out what is above"
        );
    }
    Ok(())
}
