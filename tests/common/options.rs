//! Options that most tests change alone: the highest harmonic, a range, the degree of freedom that is read.

use hbvib::{ForcedOptions, ModeOptions, SolverOptions};

/// Options with a highest harmonic; all others are defaults.
pub fn harmonics(highest: usize) -> SolverOptions {
    SolverOptions {
        harmonics: highest,
        tolerance: 0.0,
        ..SolverOptions::default()
    }
}

/// Options with the degree of freedom whose amplitude a branch has.
pub fn at_dof(dof: usize, solver: SolverOptions) -> SolverOptions {
    SolverOptions {
        response_dof: Some(dof),
        ..solver
    }
}

/// A forced response between two angular frequencies.
pub fn omega_range<'a>(omega_start: f64, omega_stop: f64) -> ForcedOptions<'a> {
    ForcedOptions {
        omega_start,
        omega_stop,
        ..ForcedOptions::default()
    }
}

/// A nonlinear mode between two decimal logarithms of the amplitude.
pub fn amplitude_range<'a>(log10_start: f64, log10_stop: f64) -> ModeOptions<'a> {
    ModeOptions {
        log10_start,
        log10_stop,
        ..ModeOptions::default()
    }
}
