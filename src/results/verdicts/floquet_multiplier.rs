//! Floquet multipliers with their reasons.

use num_complex::Complex64;

/// Reason why a multiplier has its value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MultiplierClass {
    /// No known reason: the multiplier decides about stability.
    Ordinary,
    /// The multiplier is zero, because a slider that slips forgets its place.
    Memory,
    /// The multiplier is one, because the slider of a contact that always sticks stays where it is put.
    NeutralStuck,
    /// The multiplier is one, because a rigid motion takes all sliders along.
    NeutralRigid,
    /// The multiplier is one, because an autonomous motion may begin at any time.
    Trivial,
}

/// A multiplier of one period of the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Multiplier {
    /// Value μ of the multiplier.
    pub value: Complex64,
    /// Reason why the multiplier has this value.
    pub class: MultiplierClass,
}
