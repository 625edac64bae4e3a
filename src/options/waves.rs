//! The perturbations of which stability is computed.

use crate::error::{Result, fail};

/// Perturbations whose multipliers are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Waves {
    /// Those of the nodal diameters of the travelling wave itself.
    #[default]
    Wave,
    /// All of the wheel.
    Wheel,
}

impl Waves {
    /// Refuses all waves of a plain model, which has one alone. `name` is that of the option.
    ///
    /// # Errors
    /// `Argument`.
    pub(crate) fn check(self, name: &str, sectors: usize) -> Result<()> {
        if self == Self::Wheel && sectors == 1 {
            return fail!(
                Argument,
                "{name} = wheel, needs a cyclic model: a plain one, as that of all sectors, has all of its perturbations with {name} = wave"
            );
        }
        Ok(())
    }
}
