//! Floquet multipliers with their reasons.

use num_complex::Complex64;

/// Reason of a multiplier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MultiplierClass {
    /// Decides about stability.
    Ordinary,
    /// Zero, because a slider that slips forgets its place.
    Memory,
    /// One, because the slider of a contact that sticks for ever stays where it is put.
    NeutralStuck,
    /// One, because a rigid motion takes all sliders along.
    NeutralRigid,
    /// One, because an autonomous motion may begin at any time.
    Trivial,
}

/// A multiplier of one period of the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Multiplier {
    /// μ
    pub value: Complex64,
    /// Reason of it.
    pub class: MultiplierClass,
}
