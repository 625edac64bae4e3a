//! The result of an analysis: points along a branch, its peaks and folds, solutions at requested parameter values,
//! and the removed parts of the problem.

use crate::condense::Resolution;
use crate::condense::{Condensed, Reduction};
use crate::error::{Error, Result, Status, fail};
use crate::results::stored::branch_parts::{PointErrors, PointStability, PointTable, Run, SpecialLists};
use crate::results::stored::descent::{Descent, Searched};
use crate::results::stored::freedom_of_points::FreedomOfPoints;
use crate::results::stored::mode_branch::ModeData;
use crate::results::stored::origin::Origin;
use crate::results::stored::parameter_branch::ParameterData;
use crate::results::stored::special::Special;
use crate::results::watched::response_series::ResponseSeries;
use num_complex::Complex64;

/// A branch of solutions.
///
/// Points 0 .. [`Self::points`] form the curve in the order in which it was followed. Peaks, folds and the
/// requested solutions have the numbers after that.
#[derive(Debug)]
pub struct Branch {
    pub(crate) run: Run,
    /// The resolutions that points have.
    pub(crate) resolutions: Vec<Resolution>,
    /// Number of points on the curve.
    pub(crate) curve: usize,
    pub(crate) table: PointTable,
    pub(crate) errors: PointErrors,
    pub(crate) stability: PointStability,
    pub(crate) special: SpecialLists,
    /// The requested responses at the stored points.
    pub(crate) responses: Vec<ResponseSeries>,
    /// Free sliders of the stored points, with the solver option `freedom`; else `None`.
    pub(crate) freedom: Option<Box<FreedomOfPoints>>,
    pub(crate) mode: Option<ModeData>,
    pub(crate) parameter: Option<ParameterData>,
    pub(crate) family: Family,
}

/// Place of a branch among the branches that were found with it.
#[derive(Debug, Default)]
pub(crate) struct Family {
    pub(crate) origin: Option<Origin>,
    pub(crate) children: Vec<Branch>,
    pub(crate) descent: Option<Descent>,
    pub(crate) searched: Option<Searched>,
}

impl Branch {
    /// [`Status::Ok`] when the whole range was covered, else the reason why the branch ended early.
    #[must_use]
    pub fn status(&self) -> Status {
        self.run.status
    }

    /// The error that ended the branch early, where the status alone does not identify it: the failure of a
    /// callback, or a frequency without bounded solution.
    #[must_use]
    pub fn reason(&self) -> Option<&Error> {
        self.run.reason.as_ref()
    }

    /// Number of points on the curve.
    #[must_use]
    pub fn points(&self) -> usize {
        self.curve
    }

    /// Number of stored points, the special ones included.
    #[must_use]
    pub fn stored(&self) -> usize {
        self.table.omega.len()
    }

    /// Angular frequency of each point on the curve.
    #[must_use]
    pub fn omega(&self) -> &[f64] {
        &self.table.omega[..self.curve]
    }

    /// Angular frequency of one stored point, the special ones included.
    #[must_use]
    pub fn omega_at(&self, point: usize) -> Option<f64> {
        self.table.omega.get(point).copied()
    }

    /// Amplitude |X| of the response degree of freedom (fundamental, peak) at each point, or the measure of the first
    /// requested response.
    #[must_use]
    pub fn amplitude(&self) -> &[f64] {
        &self.table.amplitude[..self.curve]
    }

    /// Amplitude of a stored point; NaN where there is no such point.
    pub(crate) fn stored_amplitude(&self, point: usize) -> f64 {
        self.table.amplitude.get(point).copied().unwrap_or(f64::NAN)
    }

    /// Relative residual of each point, before a last Newton correction; or a bound of the residual after that
    /// correction, where it was foreseen.
    #[must_use]
    pub fn residual(&self) -> &[f64] {
        &self.table.residual[..self.curve]
    }

    /// Number of Newton iterations of each point.
    #[must_use]
    pub fn newton_iterations(&self) -> &[f64] {
        &self.table.iterations[..self.curve]
    }

    /// Highest harmonic number carried at each point.
    #[must_use]
    pub fn harmonics_used(&self) -> &[f64] {
        &self.table.harmonics_used[..self.curve]
    }

    /// Share of the period that each contact slips: points × contacts, point after point. Time in the open state
    /// does not count: the value is 0 for a contact that only sticks or opens, for springs including unilateral
    /// ones, for laws without states and for contacts without force.
    #[must_use]
    pub fn slip_fraction(&self) -> &[f64] {
        &self.table.slip_fraction[..self.curve * self.contacts()]
    }

    /// Slip shares of one stored point, the special ones included.
    #[must_use]
    pub fn slip_fraction_at(&self, point: usize) -> Option<&[f64]> {
        let contacts = self.contacts();
        (point < self.stored()).then(|| &self.table.slip_fraction[point * contacts..(point + 1) * contacts])
    }

    /// Maxima of the amplitude, in a nonlinear mode of the damping ratio, refined on the solution.
    #[must_use]
    pub fn peaks(&self) -> &[Special] {
        &self.special.peaks
    }

    /// Turning points in frequency, in a nonlinear mode in amplitude, refined on the solution.
    #[must_use]
    pub fn folds(&self) -> &[Special] {
        &self.special.folds
    }

    /// Every solution found at the i-th requested frequency (in a nonlinear mode: amplitude).
    #[must_use]
    pub fn at(&self, i: usize) -> &[Special] {
        self.special.at.get(i).map_or(&[], Vec::as_slice)
    }

    /// Number of contacts in the model.
    #[must_use]
    pub fn contacts(&self) -> usize {
        self.resolutions[0].condensed.contacts()
    }

    /// Number of degrees of freedom (of one sector).
    #[must_use]
    pub fn ndof(&self) -> usize {
        self.resolutions[0].condensed.degrees().given()
    }

    /// Highest harmonic number H of the results: the requested one or, where a tolerance chose, the highest that a
    /// stored point carries.
    #[must_use]
    pub fn harmonics(&self) -> usize {
        self.run.harmonics
    }

    /// Carried harmonics of a stored point, by their numbers; all other harmonics are zero.
    #[must_use]
    pub fn carried_at(&self, point: usize) -> Option<&[usize]> {
        Some(self.resolution_at(point)?.condensed.set().numbers())
    }

    /// The response degree of freedom, which defines the amplitude.
    #[must_use]
    pub fn response_dof(&self) -> usize {
        self.run.response_dof
    }

    /// The parts of the problem that the condensation removed.
    #[must_use]
    pub fn reduction(&self) -> &Reduction {
        &self.run.reduction
    }

    /// Harmonics of the response degree of freedom at a stored point, one per number in [`Self::carried_at`]. They
    /// are stored, so that the whole structure need not be recovered.
    #[must_use]
    pub fn response_at(&self, point: usize) -> Option<&[Complex64]> {
        let place = self.table.places.get(point)?;
        let carried = self.carried_at(point)?.len();
        self.table.response.get(place.response..place.response + carried)
    }

    /// The carried harmonics of a stored point, which must exist.
    pub(crate) fn carried_of(&self, point: usize) -> Result<&[usize]> {
        match self.carried_at(point) {
            Some(carried) => Ok(carried),
            None => fail!(
                Index,
                "point = {point}, needs 0 .. {} (points and special points)",
                self.stored()
            ),
        }
    }

    /// Index of the resolution of a stored point; that of the first one where there is no such point.
    pub(crate) fn resolution_index(&self, point: usize) -> usize {
        self.table.places.get(point).map_or(0, |p| p.resolution)
    }

    /// The resolution with an index.
    pub(crate) fn numbered_resolution(&self, index: usize) -> &Resolution {
        &self.resolutions[index]
    }

    /// The resolution of a stored point.
    fn resolution_at(&self, point: usize) -> Option<&Resolution> {
        Some(&self.resolutions[self.table.places.get(point)?.resolution])
    }

    /// The condensed model of a stored point; the first one where there is no such point.
    pub(crate) fn condensed_at(&self, point: usize) -> &Condensed {
        &self.resolutions[self.resolution_index(point)].condensed
    }

    /// Samples per period of a stored point.
    pub(crate) fn samples_at(&self, point: usize) -> usize {
        self.resolutions[self.resolution_index(point)].samples
    }

    /// Packed relative motions of a stored point, in the solver's units.
    pub(crate) fn motion_at(&self, point: usize) -> Option<&[f64]> {
        let condensed = &self.resolution_at(point)?.condensed;
        let size = condensed.coordinates() * condensed.set().packed_len();
        let begin = self.table.places[point].motion;
        self.table.motion.get(begin..begin + size)
    }
}
