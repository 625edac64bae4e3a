//! The static state of a model under constant forces and preload, about which a nonlinear mode vibrates.

use crate::error::{Result, try_copy};
use crate::model::natural_modes::static_tangents::StaticTangents;

/// The static state under constant forces and preload. The default belongs to a model without these: zero motion.
#[derive(Clone, Debug, Default)]
pub struct StaticState {
    /// Motion of each relative coordinate, in the caller's unit; empty for zero motion.
    pub motion: Vec<f64>,
    /// Motion of all independent degrees of freedom, in the caller's unit; empty for zero motion.
    pub structure: Vec<f64>,
    /// Tangent stiffness of the contacts.
    pub tangents: StaticTangents,
}

impl StaticState {
    /// Whether constant forces or preload act.
    #[must_use]
    pub fn is_loaded(&self) -> bool {
        !self.structure.is_empty()
    }

    /// A copy in the unit `length`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn in_units(&self, length: f64) -> Result<Self> {
        let scaled = |values: &[f64]| -> Result<Vec<f64>> {
            let mut values = try_copy(values, "the static state")?;
            for x in &mut values {
                *x /= length;
            }
            Ok(values)
        };
        Ok(Self {
            motion: scaled(&self.motion)?,
            structure: scaled(&self.structure)?,
            tangents: self.tangents.try_clone()?,
        })
    }
}
