//! Comparison of one entry of the tangents with its difference quotient.

/// Derivative to which an entry belongs.
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

/// The entry of the tangents with the largest deviation from its difference quotient.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JacobianGap {
    /// |given − difference| times the size of the perturbed variable, relative to the size of the result. Correct
    /// tangents of a smooth force stay below 1e-6.
    pub gap: f64,
    /// The derivative.
    pub tangent: Tangent,
    /// Sample of the test motion.
    pub sample: usize,
    /// Row of the entry; for [`Tangent::ForceByState`] the force.
    pub row: usize,
    /// Column of the entry; for [`Tangent::ForceByState`] the perturbed state before the sample.
    pub column: usize,
    /// The value of the caller; for [`Tangent::ForceByState`] the change of force that follows from it per change
    /// of that state.
    pub given: f64,
    /// The difference quotient.
    pub difference: f64,
}

impl JacobianGap {
    /// Keeps `entry` if its gap is the largest so far; its difference perturbed a variable of size `moved` and
    /// changed a result of size `changed`.
    pub(super) fn keep_worst(&mut self, moved: f64, changed: f64, entry: Self) {
        let (given, difference) = (moved * entry.given, moved * entry.difference);
        let distance = (given - difference).abs();
        let size = changed.max(given.abs()).max(difference.abs());
        let gap = if distance == 0.0 { 0.0 } else { distance / size };
        // An overflow counts as the largest gap.
        let gap = if gap.is_nan() { f64::INFINITY } else { gap };
        if gap > self.gap {
            *self = Self { gap, ..entry };
        }
    }
}
