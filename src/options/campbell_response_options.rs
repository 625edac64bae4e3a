//! Options of resonances in a Campbell diagram.

use crate::error::{Result, fail};
use crate::options::SynthesisOptions;

/// Most factors on the forces in one call.
/// Kind: cap.
pub const CAMPBELL_MOST_FACTORS: usize = 100_000;

/// Options of resonances in a Campbell diagram.
#[derive(Clone, Copy, Debug)]
pub struct CampbellResponseOptions<'a> {
    /// Angular frequency of the forces over the speed of rotation, above zero: the engine order where the forces
    /// belong to one.
    pub engine_order: f64,
    /// Change of the speed per time in a passage, either sign; 0: none.
    pub acceleration: f64,
    /// Factors on the forces of the model, above zero; each has its own resonance.
    pub force_factors: &'a [f64],
    /// Further factor on the forces, and damping, as for a synthesised response; `compare` has no effect.
    pub synthesis: SynthesisOptions,
}

impl Default for CampbellResponseOptions<'_> {
    fn default() -> Self {
        Self {
            engine_order: 1.0,
            acceleration: 0.0,
            force_factors: &[1.0],
            synthesis: SynthesisOptions::default(),
        }
    }
}

impl CampbellResponseOptions<'_> {
    /// Checks the values of all options.
    ///
    /// # Errors
    /// `Argument`, `NotFinite` or `Dimension`, naming the field, its value and its range.
    pub fn check(&self) -> Result<()> {
        for (name, value) in [("engine_order", self.engine_order), ("acceleration", self.acceleration)] {
            if !value.is_finite() {
                return fail!(NotFinite, "{name} = {value}, needs a finite number");
            }
        }
        if self.engine_order <= 0.0 {
            return fail!(Argument, "engine_order = {}, needs a number > 0", self.engine_order);
        }
        if self.force_factors.is_empty() || self.force_factors.len() > CAMPBELL_MOST_FACTORS {
            return fail!(
                Dimension,
                "{} factors on the forces, needs 1 .. {CAMPBELL_MOST_FACTORS}",
                self.force_factors.len()
            );
        }
        for (i, factor) in self.force_factors.iter().enumerate() {
            if !(factor.is_finite() && *factor > 0.0) {
                return fail!(Argument, "force_factors[{i}] = {factor}, needs a finite number > 0");
            }
        }
        self.synthesis.check()
    }
}
