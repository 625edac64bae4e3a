//! Stability of a motion, and kinds of bifurcations.
//!
//! Along a branch the number of unstable directions changes where a multiplier passes the unit circle: through 1 at a
//! fold or at a branch point, through −1 where the period doubles, as a pair of conjugates at a Neimark-Sacker
//! bifurcation.

use num_complex::Complex64;

/// Modulus up to which rounding may carry the multipliers of a motion that neither grows nor decays.
/// Kind: rounding.
pub const VERDICT_UNIT: f64 = 1.0 + 1e-9;

/// Share of a multiplier that an imaginary part may be by rounding.
/// Kind: rounding.
const VERDICT_REAL: f64 = 1e-6;

/// Stability of one motion.
#[derive(Clone, Debug, Default)]
pub(crate) struct Verdict {
    /// Ordinary multipliers by falling modulus; empty where stability is not known.
    pub multipliers: Vec<Complex64>,
    /// Largest modulus of these multipliers; NaN where it is not known.
    pub radius: f64,
    /// Number of these multipliers outside the unit circle; `None` where it is not known.
    pub unstable: Option<usize>,
    /// Whether the multipliers belong to the motion in time, not to a truncated one.
    pub in_time: bool,
}

impl Verdict {
    /// Stability that is not known.
    pub fn unknown() -> Self {
        Self {
            radius: f64::NAN,
            ..Self::default()
        }
    }

    /// Number of multipliers outside the unit circle that are not positive real numbers.
    pub fn oscillating(&self) -> usize {
        let outside = self.multipliers.iter().filter(|m| m.norm() > VERDICT_UNIT);
        outside.filter(|m| !is_positive(m)).count()
    }

    /// Growth ln |μ| of the multiplier with index `order` by falling modulus, and the multiplier; positive real
    /// numbers are left out if `without_positive`.
    pub fn growth(&self, order: usize, without_positive: bool) -> (f64, Complex64) {
        let mut counted = self
            .multipliers
            .iter()
            .filter(|m| !(without_positive && is_positive(m)));
        match counted.nth(order) {
            Some(m) if *m != Complex64::ZERO => (m.norm().ln(), *m),
            // Far inside the unit circle.
            _ => (-1.0, Complex64::ZERO),
        }
    }
}

fn is_positive(m: &Complex64) -> bool {
    m.re > 0.0 && m.im.abs() <= VERDICT_REAL * m.re
}

/// Kind of a bifurcation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BifurcationKind {
    /// The branch turns in frequency, a multiplier passes 1.
    Fold,
    /// A multiplier passes −1: a motion of twice the period branches off.
    PeriodDoubling,
    /// A pair of conjugate multipliers passes the unit circle: a motion with a second frequency branches off.
    NeimarkSacker,
    /// A multiplier passes 1 where the branch does not turn: another motion of the same period branches off.
    BranchPoint,
}

impl BifurcationKind {
    /// The kind for a multiplier on the unit circle, where the branch does not turn.
    pub(crate) fn of(multiplier: Complex64) -> Self {
        if is_positive(&multiplier) {
            Self::BranchPoint
        } else if is_positive(&-multiplier) {
            Self::PeriodDoubling
        } else {
            Self::NeimarkSacker
        }
    }
}

/// A bifurcation of a branch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bifurcation {
    /// Index of the stored point; it continues the numbering of the curve.
    pub point: usize,
    /// Angular frequency of the bifurcation.
    pub omega: f64,
    /// Amplitude of the response degree of freedom.
    pub amplitude: f64,
    /// Kind of the bifurcation.
    pub kind: BifurcationKind,
    /// Numbers of unstable directions before and after the bifurcation along the branch; `None` where they are not
    /// known.
    pub unstable: [Option<usize>; 2],
}

/// A part of a curve on which stability does not change.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// Whether the motions of the stretch are unstable.
    pub unstable: bool,
    /// Angular frequency and amplitude of each point of the stretch.
    pub points: Vec<(f64, f64)>,
}

/// A bifurcation with the number of points of the curve before it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Located {
    pub(crate) bifurcation: Bifurcation,
    pub(crate) after: usize,
}
