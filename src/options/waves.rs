//! The perturbations of which stability is computed.

/// Perturbations whose multipliers are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Waves {
    /// Those of the nodal diameters of the travelling wave itself.
    #[default]
    Wave,
    /// All of the wheel.
    Wheel,
}
