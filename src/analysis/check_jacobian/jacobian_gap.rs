//! The entry of the tangents that is farthest from its difference quotient.

/// Which derivative an entry belongs to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tangent {
    /// ∂f/∂u
    #[default]
    ForceByMotion,
    /// ∂f/∂v
    ForceByVelocity,
    /// ∂f/∂z
    ForceByState,
    /// ∂zⱼ/∂zⱼ₋₁
    StateByState,
    /// ∂zⱼ/∂uⱼ₋₁
    StateByMotionBefore,
    /// ∂zⱼ/∂uⱼ
    StateByMotion,
    /// ∂zⱼ/∂vⱼ₋₁
    StateByVelocityBefore,
    /// ∂zⱼ/∂vⱼ
    StateByVelocity,
    /// ∂zⱼ/∂ω
    StateByFrequency,
}

/// The entry of the tangents that lies farthest from its difference quotient.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JacobianGap {
    /// |given − difference| times the size of what was moved, relative to the size of what it moves.
    /// Right tangents of a smooth force stay below 1e-6.
    pub gap: f64,
    /// The derivative.
    pub tangent: Tangent,
    /// Sample of the test motion.
    pub sample: usize,
    /// Row of the entry; for [`Tangent::ForceByState`] the force.
    pub row: usize,
    /// Its column; for [`Tangent::ForceByState`] the state before the sample that was moved.
    pub column: usize,
    /// The value that the caller gave; for [`Tangent::ForceByState`] the change of force that follows
    /// from it per change of that state.
    pub given: f64,
    /// The difference quotient.
    pub difference: f64,
}

impl JacobianGap {
    /// Keeps `entry`, whose difference moved something of size `moved` and changed something of size
    /// `changed`, where it is the worst so far.
    pub(super) fn worse(&mut self, moved: f64, changed: f64, entry: Self) {
        let (given, difference) = (moved * entry.given, moved * entry.difference);
        let distance = (given - difference).abs();
        let size = changed.max(given.abs()).max(difference.abs());
        let gap = if distance == 0.0 { 0.0 } else { distance / size };
        // What overflowed is as wrong as can be.
        let gap = if gap.is_nan() { f64::INFINITY } else { gap };
        if gap > self.gap {
            *self = Self { gap, ..entry };
        }
    }
}
