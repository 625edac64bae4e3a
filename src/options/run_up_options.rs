//! Options of a run-up by the slow flow of a nonlinear mode.

use crate::error::{Result, fail};
use crate::options::SynthesisOptions;
use crate::options::sweep_options::check_passage;
use std::f64::consts::TAU;

/// Most turns of the forces in a run-up by the slow flow; slower ones are steady.
/// Kind: cap.
pub const RUN_UP_MOST_TURNS: f64 = 2e5;

/// Default of the most turns of a run-up that are integrated in time.
/// Kind: cap; one to some seconds for a few masses.
pub const RUN_UP_INTEGRATED_TURNS: usize = 10_000;

/// Options of a run-up by the slow flow of a nonlinear mode.
#[derive(Clone, Copy, Debug)]
pub struct RunUpOptions {
    /// First angular frequency of the forces, rad per time unit, above zero.
    pub omega_start: f64,
    /// Last angular frequency of the forces; below the first for a run-down.
    pub omega_stop: f64,
    /// Rate |dω/dt| of the frequency, above zero.
    pub rate: f64,
    /// Degree of freedom whose displacement is observed; `None`: the response degree of freedom of the mode.
    pub dof: Option<usize>,
    /// Largest number of turns that are integrated in time around the largest displacement, which corrects the
    /// displacement and estimates its error; 0: none.
    pub integrated_turns: usize,
    /// Forces and damping, as for a synthesised response; `compare` has no effect. With a damping ratio nothing is integrated.
    pub synthesis: SynthesisOptions,
}

impl Default for RunUpOptions {
    fn default() -> Self {
        Self {
            omega_start: 0.0,
            omega_stop: 0.0,
            rate: 0.0,
            dof: None,
            integrated_turns: RUN_UP_INTEGRATED_TURNS,
            synthesis: SynthesisOptions::default(),
        }
    }
}

impl RunUpOptions {
    /// Number of turns of the forces within the run-up.
    #[must_use]
    pub fn turns(&self) -> f64 {
        (self.omega_stop.powi(2) - self.omega_start.powi(2)).abs() / (2.0 * TAU * self.rate)
    }

    /// Checks the values of all options for a model of `ndof` degrees of freedom.
    ///
    /// # Errors
    /// `Argument`, `NotFinite` or `Index`, naming the field, its value and its range.
    pub fn check(&self, ndof: usize) -> Result<()> {
        check_passage(self.omega_start, self.omega_stop, self.rate)?;
        if let Some(dof) = self.dof.filter(|&dof| dof >= ndof) {
            return fail!(Index, "dof = {dof}, needs 0 .. {}", ndof.saturating_sub(1));
        }
        let turns = self.turns();
        if !(1.0..=RUN_UP_MOST_TURNS).contains(&turns) {
            return fail!(
                Argument,
                "rate = {:e}: the run-up has {turns:.3e} turns of the forces, needs 1 .. {RUN_UP_MOST_TURNS:e}; a slower one is steady",
                self.rate
            );
        }
        self.synthesis.check()
    }
}
