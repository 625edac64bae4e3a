//! Options of a response synthesised from a nonlinear mode.

use crate::error::{Result, fail};

/// Options of a response synthesised from a nonlinear mode.
#[derive(Clone, Copy, Debug)]
pub struct SynthesisOptions {
    /// Factor on all forces of the model.
    pub force_factor: f64,
    /// Damping ratio that is added to the damping ratio of the mode.
    pub damping_ratio: f64,
    /// Whether to add the damping of the model's C, as is right for a mode that was computed without it.
    pub model_damping: bool,
    /// Whether to compute the resonance next to each synthesised one, which shows its error.
    pub compare: bool,
}

impl Default for SynthesisOptions {
    fn default() -> Self {
        Self {
            force_factor: 1.0,
            damping_ratio: 0.0,
            model_damping: false,
            compare: true,
        }
    }
}

impl SynthesisOptions {
    /// Checks the values of all options.
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
