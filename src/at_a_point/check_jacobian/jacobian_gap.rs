//! Comparison of one entry of the tangents with its difference quotient.

/// Derivative to which an entry belongs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tangent {
    /// Force by motion, ∂f/∂u.
    #[default]
    ForceByMotion,
    /// Force by velocity, ∂f/∂v.
    ForceByVelocity,
    /// Force by state, ∂f/∂z.
    ForceByState,
    /// State by the state before, ∂zⱼ/∂zⱼ₋₁.
    StateByState,
    /// State by the motion before, ∂zⱼ/∂uⱼ₋₁.
    StateByMotionBefore,
    /// State by the motion, ∂zⱼ/∂uⱼ.
    StateByMotion,
    /// State by the velocity before, ∂zⱼ/∂vⱼ₋₁.
    StateByVelocityBefore,
    /// State by the velocity, ∂zⱼ/∂vⱼ.
    StateByVelocity,
    /// State by the frequency, ∂zⱼ/∂ω.
    StateByFrequency,
}

/// The entry of the tangents with the largest deviation from its difference quotient.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JacobianGap {
    /// Largest deviation |given − difference| times the size of the perturbed variable, relative to the size of the
    /// result. Correct tangents of a smooth force stay below 1e-6.
    pub gap: f64,
    /// Derivative to which the entry belongs.
    pub tangent: Tangent,
    /// Index of the sample of the test motion.
    pub sample: usize,
    /// Row of the entry; for [`Tangent::ForceByState`] the index of the force.
    pub row: usize,
    /// Column of the entry; for [`Tangent::ForceByState`] the index of the perturbed state before the sample.
    pub column: usize,
    /// The caller's value; for [`Tangent::ForceByState`] the change of force that follows from it per change of this
    /// state.
    pub given: f64,
    /// The difference quotient with which the value is compared.
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
