//! The perturbations of which stability is computed.

use crate::error::{Result, fail};

/// Perturbations whose Floquet multipliers are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Waves {
    /// Perturbations in the nodal diameters of the travelling wave itself.
    #[default]
    Wave,
    /// All perturbations of the wheel.
    Wheel,
}

impl Waves {
    /// Refuses all waves for a plain model, which has just one. `name` is the name of the option.
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
