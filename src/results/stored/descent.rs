//! Where a branch comes from, and what was sought beside one.

use crate::results::verdicts::verdict::BifurcationKind;

/// Where a branch comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Descent {
    /// The bifurcation of the parent from which it branches off, by its place in [`crate::results::Branch::bifurcations`]; `None`: a detached
    /// curve.
    pub bifurcation: Option<usize>,
    /// The kind of that bifurcation.
    pub kind: Option<BifurcationKind>,
    /// Periods of the parent in one of its own. Its frequencies are those of the parent over this number.
    pub periods: usize,
    /// Frequency, its own, at which it comes back to its parent; NaN where it does not.
    pub merges_at: f64,
    /// The nonlinear mode along which a detached curve was found, by its number among the linear ones.
    pub mode: Option<usize>,
    /// Factor of all forces at which a detached curve is born, and the one at which it merges with what lies below, as its mode
    /// predicts them, or where a curve over the force turns; NaN where there is no such force.
    pub born_at_force: f64,
    /// The same.
    pub merges_at_force: f64,
    /// Order n of the n:1 internal resonance beyond whose tongue a curve of a nonlinear mode lies; 0 otherwise.
    pub internal_resonance: usize,
}

impl Descent {
    /// That of a curve that comes back to its parent at a frequency.
    pub(crate) fn merging_at(merges_at: f64) -> Self {
        Self {
            merges_at,
            ..Self::default()
        }
    }
}

impl Default for Descent {
    fn default() -> Self {
        Self {
            bifurcation: None,
            kind: None,
            periods: 1,
            merges_at: f64::NAN,
            mode: None,
            born_at_force: f64::NAN,
            merges_at_force: f64::NAN,
            internal_resonance: 0,
        }
    }
}

/// The solutions beside a response that were sought. No list is complete: one that is not sought this way is not found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Searched {
    /// Bifurcations of all branches at which another one branches off, generations within the depth.
    pub bifurcations: usize,
    /// Bifurcations, and sides of them, from which no branch was found.
    pub lost: usize,
    /// Bifurcations that were left because the largest number of branches was reached, or whose generation is beyond the depth.
    pub left: usize,
    /// Nonlinear modes along which detached curves were sought, and those that could not be followed through their range.
    pub modes: usize,
    /// The same.
    pub incomplete_modes: usize,
    /// Range of the modal amplitude.
    pub amplitudes: (f64, f64),
    /// Resonances that the modes predict.
    pub resonances: usize,
    /// Those near which no solution was found.
    pub lost_resonances: usize,
    /// Nets of starts of subharmonic curves.
    pub starts: usize,
    /// Curves of peaks and folds over the force, and those that ended early.
    pub force_curves: usize,
    /// The same.
    pub incomplete_force_curves: usize,
    /// Solutions on these curves at the force itself, beside those that they begin at.
    pub crossings: usize,
    /// Points of the response beside which deflation sought solutions, and curves that it found.
    pub deflations: usize,
    /// The same.
    pub deflated: usize,
}
