//! Digests of the tuned sector of a wheel, by which the wheel knows the model that it was made of.

use crate::error::{Result, fail};

/// Digests of the parts of the sector of which a wheel is made: equal for equal contents. Contacts, forces, the speed
/// and damping by numbers are left out, as they may be changed on both sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SectorDigest {
    /// Digest of degrees of freedom, sectors, faces, and fixed degrees of freedom.
    pub degrees: u64,
    /// Digest of mass and stiffness, and the matrices of rotation.
    pub matrices: u64,
    /// Digest of the matrices of damping, modal damping and the aerodynamic influence.
    pub damping: u64,
    /// Digest of the springs.
    pub springs: u64,
    /// Engine order of the forces.
    pub engine_order: i64,
}

/// How a sector is used together with its wheel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SectorUse {
    /// For patterns of mass, stiffness, loads and forces.
    Pattern,
    /// For patterns of damping.
    DampingPattern,
    /// For the response of the tuned wheel: all parts count.
    Tuned,
}

impl SectorDigest {
    /// Refuses a sector other than the one of the wheel, and names the part that differs.
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
