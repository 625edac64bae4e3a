//! Digests of the tuned sector of a wheel, by which the wheel knows the model that it was made of.

use crate::error::{Result, fail};

/// A number for each part of a sector that a wheel is made of: equal for equal contents. Contacts, forces, the speed and damping by
/// numbers are not among them, as they may be changed on both sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SectorDigest {
    /// Degrees of freedom, sectors, faces, and what is fixed.
    pub degrees: u64,
    /// Mass and stiffness, and the matrices of rotation.
    pub matrices: u64,
    /// Matrices of damping, modal damping and the aerodynamic influence.
    pub damping: u64,
    /// Springs.
    pub springs: u64,
    /// Engine order of the forces.
    pub engine_order: i64,
}

/// Use of a sector beside its wheel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SectorUse {
    /// Patterns of mass and stiffness, and those of loads and forces.
    Pattern,
    /// Patterns of damping.
    DampingPattern,
    /// The response of the tuned wheel: all parts count.
    Tuned,
}

impl SectorDigest {
    /// Refuses a sector that is not the one of the wheel, naming the part that differs.
    ///
    /// # Errors
    /// `Argument`.
    pub fn check(&self, sector: &Self, used: SectorUse) -> Result<()> {
        let has_damping = used != SectorUse::Pattern;
        let is_tuned = used == SectorUse::Tuned;
        let parts = [
            ("degrees of freedom", self.degrees != sector.degrees),
            ("matrices", self.matrices != sector.matrices),
            ("damping", self.damping != sector.damping && has_damping),
            ("springs", self.springs != sector.springs && is_tuned),
            ("wave", self.engine_order != sector.engine_order && is_tuned),
        ];
        let Some((part, _)) = parts.iter().find(|(_, differs)| *differs) else {
            return Ok(());
        };
        fail!(
            Argument,
            "the sector has other {part} than the one that the wheel was made of; needs that model, or a wheel of this one"
        )
    }
}
