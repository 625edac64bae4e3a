//! Where a branch comes from, and what was sought beside one.

use crate::results::verdicts::verdict::BifurcationKind;

/// Origin of a branch that was found beside another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Descent {
    /// Index of the bifurcation, in [`crate::results::Branch::bifurcations`] of the parent, from which the branch
    /// starts; `None`: a detached curve.
    pub bifurcation: Option<usize>,
    /// Kind of this bifurcation.
    pub kind: Option<BifurcationKind>,
    /// Number of periods of the parent in one period of the branch. Its frequencies are those of the parent over this
    /// number.
    pub periods: usize,
    /// Frequency of the branch at which it comes back to its parent; NaN where it does not.
    pub merges_at: f64,
    /// Index, among the linear modes, of the nonlinear mode along which a detached curve was found; `None` without
    /// one.
    pub mode: Option<usize>,
    /// Factor of all forces at which a detached curve is born, as its mode predicts it, or where a curve over the
    /// force turns; NaN where there is no such force.
    pub born_at_force: f64,
    /// Factor of all forces at which a detached curve merges with the curve below, predicted likewise; NaN where
    /// there is no such force.
    pub merges_at_force: f64,
    /// Order n of the n:1 internal resonance beyond whose tongue a curve of a nonlinear mode lies; 0 otherwise.
    pub internal_resonance: usize,
}

impl Descent {
    /// Origin of a curve that comes back to its parent at a frequency.
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

/// Extent of the search for solutions beside a response. No list is complete: solutions that are not sought in these
/// ways are not found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Searched {
    /// Number of bifurcations of all branches at which another branch starts, of generations within the depth.
    pub bifurcations: usize,
    /// Number of bifurcations, or of sides of one, from which no branch was found.
    pub lost: usize,
    /// Number of bifurcations that were not followed because the largest number of branches was reached, or their
    /// generation is beyond the depth.
    pub left: usize,
    /// Number of nonlinear modes along which detached curves were sought.
    pub modes: usize,
    /// Number of these modes that could not be followed through their range.
    pub incomplete_modes: usize,
    /// Range of the modal amplitude in which detached curves were sought.
    pub amplitudes: (f64, f64),
    /// Number of resonances that the modes predict.
    pub resonances: usize,
    /// Number of predicted resonances near which no solution was found.
    pub lost_resonances: usize,
    /// Number of nets of starts for subharmonic curves.
    pub starts: usize,
    /// Number of curves of peaks and folds over the force.
    pub force_curves: usize,
    /// Number of these curves that ended early.
    pub incomplete_force_curves: usize,
    /// Number of solutions on these curves at the nominal force, besides those at which they start.
    pub crossings: usize,
    /// Number of points of the response beside which deflation sought solutions.
    pub deflations: usize,
    /// Number of curves that deflation found.
    pub deflated: usize,
}
