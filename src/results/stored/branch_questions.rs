//! Questions to a branch: fields that some branches have, and calls of the rooms that compute from its points.

use crate::error::{Result, Status, fail};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::model::saved::fingerprint::Use;
use crate::options::Response;
use crate::results::motions::point_energy::Energy;
use crate::results::motions::time_history::{ContactLoop, ContactSummary};
use crate::results::motions::{point_energy, point_harmonics, time_history};
use crate::results::stored::branch::Branch;
use crate::results::stored::limit_cycles::{LimitCycle, limit_cycles};
use crate::results::stored::mode_branch::{ModeData, ModeField, ModeInfo, ModePoint};
use crate::results::stored::parameter_branch::{HigherPeak, Optimum, Turn};
use crate::results::verdicts::unstable_directions;
use crate::results::verdicts::verdict::{Bifurcation, Stretch};
use crate::results::watched::response_series::ResponseSeries;
use crate::results::watched::{read_responses, responses};
use crate::results::{Descent, PointField, Searched};
use num_complex::Complex64;

// Errors of the points.
impl Branch {
    /// Number of error estimates that chose the harmonics of all points, those with stuck contacts not counted; 0
    /// if no tolerance chose.
    #[must_use]
    pub fn estimates(&self) -> usize {
        self.run.estimates
    }

    /// Aliasing check of laws that are sampled, at each point: the relative change of their forces with half the
    /// samples (twice as many, if half are too few). 0 where all laws are exact, NaN if a law failed in the check.
    /// It estimates the size of the error by sampling and is no bound of it.
    #[must_use]
    pub fn sampling_error(&self) -> &[f64] {
        &self.errors.sampling[..self.curve]
    }

    /// Estimated relative error of the response amplitude (in a nonlinear mode: of the frequency) by the harmonics
    /// left out, at each point. NaN where it is unknown, and everywhere unless a tolerance chooses the harmonics or
    /// [`SolverOptions::estimate_error`](crate::options::SolverOptions::estimate_error) requests it.
    #[must_use]
    pub fn error_estimate(&self) -> &[f64] {
        &self.errors.truncation[..self.curve]
    }

    /// Estimated relative error, as `error_estimate` has it, of one stored point, the special ones included; NaN at a
    /// fold, at whose frequency the solution is not isolated.
    #[must_use]
    pub fn error_estimate_at(&self, point: usize) -> Option<f64> {
        self.errors.truncation.get(point).copied()
    }

    /// Estimated relative error of the damping ratio of a nonlinear mode at each point; see
    /// [`Self::error_estimate`].
    #[must_use]
    pub fn damping_error_estimate(&self) -> &[f64] {
        &self.errors.damping[..self.curve]
    }

    /// Estimated relative error of the damping ratio at one stored point, the special ones included.
    #[must_use]
    pub fn damping_error_estimate_at(&self, point: usize) -> Option<f64> {
        self.errors.damping.get(point).copied()
    }
}

// Values of a nonlinear mode.
impl Branch {
    /// Linear mode from which the nonlinear mode starts; `None` for a forced response.
    #[must_use]
    pub fn mode(&self) -> Option<&ModeInfo> {
        self.mode.as_ref().map(|m| &m.info)
    }

    /// A field of the mode at each point of the curve; `None` for a forced response.
    #[must_use]
    pub fn mode_field(&self, field: ModeField) -> Option<&[f64]> {
        self.mode.as_ref().map(|m| &m.field(field)[..self.points()])
    }

    /// The mode's numbers at a stored point, special ones included.
    #[must_use]
    pub fn mode_at(&self, point: usize) -> Option<ModePoint> {
        self.mode.as_ref().and_then(|m| m.point(point))
    }

    /// Damping ratio at a stored point; 0 for a forced response.
    pub(crate) fn damping_at(&self, point: usize) -> f64 {
        self.mode_at(point).map_or(0.0, |p| p.damping_ratio)
    }

    pub(crate) fn mode_data(&self) -> Option<&ModeData> {
        self.mode.as_ref()
    }

    /// The limit cycles on a nonlinear mode, refined on the solution, in the order of the branch.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn limit_cycles(&self) -> Result<Vec<LimitCycle>> {
        limit_cycles(self)
    }
}

// Values over a parameter.
impl Branch {
    /// Value of the parameter at each point of the curve; `None` for a branch over frequency or amplitude.
    #[must_use]
    pub fn parameter(&self) -> Option<&[f64]> {
        self.parameter.as_ref().map(|data| &data.parameter[..self.points()])
    }

    /// Total derivative of the amplitude by the parameter at each point of the curve; NaN where there is none.
    #[must_use]
    pub fn d_amplitude(&self) -> Option<&[f64]> {
        self.parameter.as_ref().map(|data| &data.d_amplitude[..self.points()])
    }

    /// Total derivative of the largest damping ratio of a mode by the parameter at each point of the curve; NaN where a
    /// response is followed.
    #[must_use]
    pub fn d_damping(&self) -> Option<&[f64]> {
        self.parameter.as_ref().map(|data| &data.d_damping[..self.points()])
    }

    /// Total derivative of the largest damping ratio of a mode by the parameter at a stored point, the special ones
    /// included.
    #[must_use]
    pub fn d_damping_at(&self, point: usize) -> Option<f64> {
        self.parameter.as_ref()?.d_damping.get(point).copied()
    }

    /// Peaks that are higher than the followed one at its first point, its optima or its last point; none for other
    /// branches.
    #[must_use]
    pub fn higher_peaks(&self) -> &[HigherPeak] {
        self.parameter.as_ref().map_or(&[], |data| &data.higher)
    }

    /// Value of the parameter, and total derivative of the amplitude by it, at a stored point, the special ones
    /// included.
    #[must_use]
    pub fn parameter_at(&self, point: usize) -> Option<(f64, f64)> {
        let data = self.parameter.as_ref()?;
        data.parameter
            .get(point)
            .copied()
            .zip(data.d_amplitude.get(point).copied())
    }

    /// Minima and maxima of the amplitude, or of the largest damping ratio, over the parameter; none for other branches.
    #[must_use]
    pub fn optima(&self) -> &[Optimum] {
        self.parameter.as_ref().map_or(&[], |data| &data.optima)
    }

    /// Points at which the branch turns over the parameter; none for other branches, and for the largest damping ratio of a mode.
    #[must_use]
    pub fn turns(&self) -> &[Turn] {
        self.parameter.as_ref().map_or(&[], |data| &data.turns)
    }

    /// Refuses a branch whose points belong to several models.
    pub(crate) fn check_one_model(&self) -> Result<()> {
        if self.parameter.is_none() {
            return Ok(());
        }
        fail!(
            Argument,
            "each point of a branch over a parameter has a model of its own: solve at the value of the parameter"
        )
    }
}

// Free sliders.
impl Branch {
    /// Whether the free sliders of the points were requested.
    #[must_use]
    pub fn tells_freedom(&self) -> bool {
        self.freedom.is_some()
    }

    /// Number of free sliders at each point of the curve, as [`crate::freedom()`] lists them; NaN where it is
    /// unknown. Empty without the solver option `freedom`.
    #[must_use]
    pub fn free_sliders(&self) -> &[f64] {
        let all = self.freedom.as_ref().map_or(&[][..], |freedom| freedom.count());
        &all[..self.points().min(all.len())]
    }

    /// Derivatives of the amplitude of a stored point by the places of sliders at a fixed frequency, along t1 and t2 of each contact;
    /// NaN where a slider is not free. `None` for an unknown point, and without the solver option `freedom`.
    #[must_use]
    pub fn d_amplitude_by_place_at(&self, point: usize) -> Option<&[[f64; 2]]> {
        self.freedom.as_ref()?.of_point(point)
    }
}

// Branches beside this one.
impl Branch {
    /// Extent of the search for solutions beside this response; `None` where none were requested.
    #[must_use]
    pub fn searched(&self) -> Option<Searched> {
        self.family.searched
    }

    /// The branches that branch off from this one, and the detached curves beside it, as far as the option `branches` of
    /// [`crate::options::ForcedOptions`] sought them.
    #[must_use]
    pub fn children(&self) -> &[Self] {
        &self.family.children
    }

    /// Whether the caller stopped the branch or one of its children.
    pub(crate) fn was_stopped(&self) -> bool {
        self.status() == Status::StoppedByCaller || self.family.children.iter().any(Self::was_stopped)
    }

    /// Origin of a branch that was found beside another one; `None` for a requested branch.
    #[must_use]
    pub fn descent(&self) -> Option<Descent> {
        self.family.descent
    }

    /// Number of periods of the parent in one period of this branch.
    pub(crate) fn periods(&self) -> usize {
        self.family.descent.map_or(1, |descent| descent.periods)
    }
}

// Stability.
impl Branch {
    /// Whether stability was requested.
    #[must_use]
    pub fn tells_stability(&self) -> bool {
        self.run.tells_stability
    }

    /// Largest modulus of the ordinary Floquet multipliers at each point of the curve; NaN where it is not known.
    /// Empty without the solver option `stability`.
    #[must_use]
    pub fn floquet_radius(&self) -> &[f64] {
        &self.stability.floquet_radius[..self.points().min(self.stability.floquet_radius.len())]
    }

    /// Number of ordinary Floquet multipliers outside the unit circle at each point of the curve, as
    /// [`Self::floquet_radius`].
    #[must_use]
    pub fn unstable_directions(&self) -> &[f64] {
        &self.stability.unstable_directions[..self.points().min(self.stability.unstable_directions.len())]
    }

    /// The bifurcations in the order of the branch: its folds and, with the solver option `stability`, those where a
    /// multiplier passes the unit circle. The branch of a nonlinear mode has the branch points of its curve, where they were sought.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn bifurcations(&self) -> Result<Vec<Bifurcation>> {
        unstable_directions::bifurcations(self)
    }

    /// The curve for a plot, in stretches of constant stability that meet at bifurcations, or at a point of the
    /// curve. Without stability there is one stretch.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn stretches(&self) -> Result<Vec<Stretch>> {
        unstable_directions::stretches(self)
    }
}

// Responses.
impl Branch {
    /// The responses that were requested in the options, in their order.
    #[must_use]
    pub fn responses(&self) -> &[ResponseSeries] {
        &self.responses
    }

    /// Whether the error of a point is the one of the norm of all responses.
    pub(crate) fn together(&self) -> bool {
        self.run.together
    }

    /// Index of the response with the largest error at a stored point, in the norm of the tolerance; `None` where no
    /// error is known.
    #[must_use]
    pub fn leading_response(&self, point: usize) -> Option<usize> {
        responses::leading_response(self, point)
    }

    /// Reads responses at all stored points, whether or not the branch was computed with them: for a nonlinear mode,
    /// a result over a parameter, or further gauges of a forced response. They have no peaks and no errors. A
    /// response without degrees of freedom reads the response degree of freedom.
    ///
    /// # Errors
    /// Those of the responses, naming their numbers; those of [`Self::harmonics_at`].
    pub fn read_responses(&self, responses: &[Response<'_>]) -> Result<Vec<ResponseSeries>> {
        self.read_responses_with(responses, &Interrupt::none())
    }

    /// Reads responses as [`Self::read_responses`], and the caller may stop it.
    ///
    /// # Errors
    /// As [`Self::read_responses`]; `StoppedByCaller`.
    pub fn read_responses_with(
        &self,
        responses: &[Response<'_>],
        interrupt: &Interrupt<'_>,
    ) -> Result<Vec<ResponseSeries>> {
        read_responses::read_responses_with(self, responses, interrupt)
    }
}

// Motions and energy.
impl Branch {
    /// Energies and losses of a stored point.
    ///
    /// # Errors
    /// `Index` for an unknown point, `OutOfMemory`.
    pub fn energy_at(&self, point: usize) -> Result<Energy> {
        self.energy_at_with(point, &Interrupt::none())
    }

    /// Energies and losses as [`Self::energy_at`], and the caller may stop it.
    ///
    /// # Errors
    /// As [`Self::energy_at`]; `StoppedByCaller`.
    pub fn energy_at_with(&self, point: usize, interrupt: &Interrupt<'_>) -> Result<Energy> {
        point_energy::energy_at_with(self, point, interrupt)
    }

    /// Motion of a degree of freedom at a stored point, at ωt = 2πj/n for j = 0 .. n, in the
    /// caller's unit.
    ///
    /// # Errors
    /// `Index` for an unknown point or degree of freedom, `Dimension` for n outside 1 ..= 2²⁴,
    /// `OutOfMemory`; `Singular` at an undamped resonance that moves no contact.
    pub fn time_history(&self, point: usize, dof: usize, n: usize) -> Result<Vec<f64>> {
        self.time_history_with(point, dof, n, &Interrupt::none())
    }

    /// Motion over time as [`Self::time_history`], and the caller may stop it.
    ///
    /// # Errors
    /// As [`Self::time_history`]; `StoppedByCaller`.
    pub fn time_history_with(&self, point: usize, dof: usize, n: usize, interrupt: &Interrupt<'_>) -> Result<Vec<f64>> {
        time_history::time_history_with(self, point, dof, n, interrupt)
    }

    /// Relative motions, forces and state of a contact at a stored point, at ωt = 2πj/n for j = 0 .. n.
    ///
    /// The force is that of this contact alone, at the motion of the point. Friction in one direction and
    /// unilateral, tabulated and cubic springs are exact, even if the branch was computed by samples. A law of the
    /// caller is called with the n times, up to 16,384 at once; one with states is marched over them, which is refused where it
    /// would take more than 500 MB. Friction in a plane is evaluated step by step over a multiple of n
    /// samples, at least as many as in the solution. In a cyclic model the contact is that of sector 0. Contacts
    /// that are linear at any motion have no coordinate of their own, and the whole structure is recovered for
    /// them.
    ///
    /// # Errors
    /// As [`Self::time_history`], with `Index` for an unknown contact; `Callback` for a law of the caller that
    /// fails, `NoConvergence` where friction in a plane does not become periodic.
    pub fn contact_loop(&self, point: usize, contact: usize, n: usize) -> Result<ContactLoop> {
        self.contact_loop_with(point, contact, n, &Interrupt::none())
    }

    /// Loop of a contact as [`Self::contact_loop`], and the caller may stop it.
    ///
    /// # Errors
    /// As [`Self::contact_loop`]; `StoppedByCaller`.
    pub fn contact_loop_with(
        &self,
        point: usize,
        contact: usize,
        n: usize,
        interrupt: &Interrupt<'_>,
    ) -> Result<ContactLoop> {
        time_history::contact_loop_with(self, point, contact, n, interrupt)
    }

    /// One direction of [`Self::contact_loop`]. `wanted` selects motions, forces and states; what is not selected
    /// stays empty.
    ///
    /// # Errors
    /// As [`Self::contact_loop`], with `Index` for an unknown direction; `StoppedByCaller`.
    pub fn contact_loop_along(
        &self,
        (point, contact, direction): (usize, usize, usize),
        n: usize,
        wanted: [bool; 3],
        interrupt: &Interrupt<'_>,
    ) -> Result<ContactLoop> {
        time_history::contact_loop_along(self, (point, contact, direction), n, wanted, interrupt)
    }

    /// Work, shares of the period and ranges of a contact at a stored point; see [`Self::contact_loop`].
    ///
    /// Ranges are exact for the motion of the point, and so are work and shares of friction in one direction and of
    /// springs. Those of friction in a plane, and the work of laws of velocities or of several motions, are as
    /// accurate as the samples of the branch, like the branch itself. The work of all contacts sums to
    /// [`Energy::friction_loss`](crate::results::Energy::friction_loss), up to the error of sampling if laws that
    /// are exact here were sampled there, or if a law of the caller has a potential.
    ///
    /// # Errors
    /// As [`Self::contact_loop`].
    pub fn contact_summary(&self, point: usize, contact: usize) -> Result<ContactSummary> {
        self.contact_summary_with(point, contact, &Interrupt::none())
    }

    /// Summary of a contact as [`Self::contact_summary`], and the caller may stop it.
    ///
    /// # Errors
    /// As [`Self::contact_summary`]; `StoppedByCaller`.
    pub fn contact_summary_with(
        &self,
        point: usize,
        contact: usize,
        interrupt: &Interrupt<'_>,
    ) -> Result<ContactSummary> {
        time_history::contact_summary_with(self, point, contact, interrupt)
    }

    /// Number of relative motions of a contact in [`Self::contact_loop`].
    #[must_use]
    pub fn contact_directions(&self, contact: usize) -> Option<usize> {
        time_history::contact_directions(self, contact)
    }

    /// Harmonics 0 ..= H of all degrees of freedom at a stored point: (H + 1) × ndof, harmonic by
    /// harmonic, in the caller's unit of length.
    ///
    /// # Errors
    /// `Index` for an unknown point, `Dimension` for a buffer of another length, `OutOfMemory`.
    pub fn harmonics_at(&self, point: usize, x: &mut [Complex64]) -> Result<()> {
        self.harmonics_at_with(point, x, &Interrupt::none())
    }

    /// Harmonics as [`Self::harmonics_at`], and the caller may stop it.
    ///
    /// # Errors
    /// As [`Self::harmonics_at`]; `StoppedByCaller`.
    pub fn harmonics_at_with(&self, point: usize, x: &mut [Complex64], interrupt: &Interrupt<'_>) -> Result<()> {
        point_harmonics::harmonics_at_with(self, point, x, interrupt)
    }
}

// The model.
impl Branch {
    /// Refuses another model than that of the branch, for use with one of its points.
    ///
    /// # Errors
    /// `Argument`, naming what differs; a branch over a parameter.
    pub(crate) fn check_model(&self, model: &Model) -> Result<()> {
        self.check_one_model()?;
        self.check_size(model)?;
        let on_wave = self.family.origin.is_none_or(|origin| origin.on_wave);
        self.check_origin(
            model,
            if self.mode_data().is_some() {
                Use::Mode { on_wave }
            } else {
                Use::Response
            },
        )
    }

    /// Refuses another model than that of the branch, for a synthesis, which may have other vibrating forces and
    /// damping.
    pub(crate) fn check_model_of_synthesis(&self, model: &Model) -> Result<()> {
        self.check_origin(model, Use::Synthesis)
    }

    fn check_origin(&self, model: &Model, used: Use) -> Result<()> {
        match &self.family.origin {
            Some(origin) => origin.model.check(model, used),
            None => Ok(()),
        }
    }

    fn check_size(&self, model: &Model) -> Result<()> {
        let (ours, theirs) = (model.structure().sectors(), self.reduction().sectors);
        if model.ndof() != self.ndof() || model.contacts().len() != self.contacts() || ours != theirs {
            return fail!(
                Argument,
                "the branch has {} degrees of freedom, {theirs} sectors and {} contacts, the model {}, {ours} and {}: it is another one",
                self.ndof(),
                self.contacts(),
                model.ndof(),
                model.contacts().len()
            );
        }
        Ok(())
    }
}

// Fields by number.
impl Branch {
    /// A field of all stored points; `None` where the branch does not have it.
    pub(crate) fn stored_field(&self, field: PointField) -> Option<&[f64]> {
        let is_mode = self.mode.is_some();
        match field {
            PointField::Omega => Some(&self.table.omega),
            PointField::Amplitude => Some(&self.table.amplitude),
            PointField::Residual => Some(&self.table.residual),
            PointField::NewtonIterations => Some(&self.table.iterations),
            PointField::HarmonicsUsed => Some(&self.table.harmonics_used),
            PointField::SlipFraction => Some(&self.table.slip_fraction),
            PointField::SamplingError => Some(&self.errors.sampling),
            PointField::ErrorEstimate => Some(&self.errors.truncation),
            PointField::DampingErrorEstimate => is_mode.then_some(&self.errors.damping[..]),
            PointField::FloquetRadius => self.run.tells_stability.then_some(&self.stability.floquet_radius[..]),
            PointField::UnstableDirections => self
                .run
                .tells_stability
                .then_some(&self.stability.unstable_directions[..]),
            PointField::FreeSliders => self.freedom.as_ref().map(|freedom| freedom.count()),
            PointField::ByPlace => self.freedom.as_ref().map(|freedom| freedom.by_place().as_flattened()),
            PointField::Parameter => self.parameter.as_ref().map(|data| &data.parameter[..]),
            PointField::DAmplitude => self.parameter.as_ref().map(|data| &data.d_amplitude[..]),
            PointField::DDamping => self
                .parameter
                .as_ref()
                .filter(|_| is_mode)
                .map(|data| &data.d_damping[..]),
            PointField::Mode(field) => self.mode.as_ref().map(|data| data.field(field)),
        }
    }
}
