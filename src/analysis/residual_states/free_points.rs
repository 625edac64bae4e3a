//! The free sliders of points of a forced response: places of sliders that stick through the period and change the vibration.
//!
//! With the contacts held that stick, the motion is the same, and its derivatives are those on the side within the limits. The model
//! with held contacts is prepared once for all points at which the same ones stick; only the places of their sliders follow the point.

use crate::analysis::residual_states::held_sliders::HELD;
use crate::analysis::residual_states::stuck_contacts::{StuckSlider, keeps_force, stuck_contacts};
use crate::condense::Condensed;
use crate::contact::forms::constants::Constant;
use crate::error::{Result, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::model::Model;
use crate::model::matrices::speed::Speed;
use crate::options::Range;
use crate::options::{Exchanged, SolverOptions};
use crate::results::Branch;
use crate::sensitivity::{ForcedPoint, Parameter, SampledModel, TotalDerivative};

const CONTEXT: &str = "the freedom of a solution";

/// Vibration that a change of the place makes, over that change, which is rounding.
/// Kind: rounding.
const FREEDOM_ROUNDING: f64 = 1e-11;

/// Points of a forced response whose free sliders are requested.
pub(crate) struct FreePoints<'a> {
    model: &'a Model,
    branch: &'a Branch,
    solver: SolverOptions,
    /// First and last angular frequency of all points; `None`: each point has its own.
    sweep: Option<Range>,
    interrupt: &'a Interrupt<'a>,
    held: Option<HeldContacts>,
}

/// A model in which the contacts are held that stick at the points, condensed for one resolution.
struct HeldContacts {
    resolution: usize,
    contacts: Vec<usize>,
    model: Model,
    condensed: Condensed,
}

impl<'a> FreePoints<'a> {
    /// Prepares for points that have nothing in common.
    pub fn single(model: &'a Model, branch: &'a Branch, interrupt: &'a Interrupt<'a>) -> Self {
        Self {
            model,
            branch,
            solver: SolverOptions::default(),
            sweep: None,
            interrupt,
            held: None,
        }
    }

    /// Prepares for points of one sweep, with the options of its solver.
    pub fn along(
        model: &'a Model,
        branch: &'a Branch,
        solver: &SolverOptions,
        sweep: Range,
        interrupt: &'a Interrupt<'a>,
    ) -> Self {
        Self {
            solver: *solver,
            sweep: Some(sweep),
            ..Self::single(model, branch, interrupt)
        }
    }

    /// The free sliders of a stored point, each with the derivative of the amplitude by its place at a fixed
    /// frequency; empty where the solution of the point is unknown.
    ///
    /// # Errors
    /// Those of the model and of callbacks; `OutOfMemory`; `StoppedByCaller`.
    pub fn at(&mut self, point: usize) -> Result<Vec<(StuckSlider, f64)>> {
        let (model, branch) = (self.model, self.branch);
        let mut free = Vec::new();
        let Some((omega, motion)) = branch.omega_at(point).zip(branch.motion_at(point)) else {
            return Ok(free);
        };
        if !self.may_be_free(point) {
            return Ok(free);
        }
        let solution = SampledModel::at(branch, point);
        let SampledModel { condensed, samples } = solution;
        let at_frequency = model.at_frequency(omega)?;
        let stuck = stuck_contacts(&at_frequency, solution, motion, omega, self.interrupt)?;
        if !stuck.others_vibrate || stuck.sliders.is_empty() || condensed.has_exchanges() {
            return Ok(free);
        }
        self.hold(&at_frequency, &stuck.sliders, point)?;
        let Some(held) = &self.held else { return Ok(free) };
        let own = &held.condensed;
        let mut u = try_vec(own.unknowns(), 0.0, CONTEXT)?;
        own.set()
            .transfer(condensed.set(), motion, condensed.length() / own.length(), &mut u);
        let mut at = ForcedPoint::new(own, branch.response_dof(), samples, omega, self.interrupt)?;
        if let Some(first) = branch.responses().first().filter(|first| !first.response().is_plain()) {
            at = at.watching(&first.response(), branch.response_dof(), samples)?;
        }
        let Some(adjoint) = at.adjoint(&u, omega)? else {
            return Ok(free);
        };
        let held_at = held.model.at_frequency(omega)?;
        let (m, mean) = (own.set().packed_len(), usize::from(own.set().has_mean()));
        let held_solution = SampledModel {
            condensed: own,
            samples,
        };
        let mut total = TotalDerivative::new(&held.model, &held_at, held_solution, &adjoint, self.interrupt)?;
        for of_contact in stuck.sliders.chunk_by(|a, b| a.contact == b.contact) {
            let mut changes = false;
            for slider in of_contact {
                let change = at.by_slider(slider.coordinate, slider.stiffness, omega)?;
                let mut vibrations = change.chunks_exact(m.max(1)).map(|y| norm(&y[mean..]));
                changes |= vibrations.any(|y| y > FREEDOM_ROUNDING);
            }
            // In a plane the limit couples both directions.
            for slider in of_contact.iter().filter(|_| changes) {
                let parameter = Parameter::Contact {
                    constant: Constant::Slider(slider.direction),
                    contact: Some(slider.contact),
                };
                try_push(&mut free, (*slider, total.by(&parameter)?.0), CONTEXT)?;
            }
        }
        Ok(free)
    }

    /// The sliders of a stored point that stick through the period, for a point where none is free: another place,
    /// far from that of the point, may make a contact slip, open or close. Empty where all contacts have sliders
    /// under constant loads: then the velocities of all motions are equal, since the difference of two motions cannot
    /// grow.
    ///
    /// # Errors
    /// As [`Self::at`].
    pub fn stuck_at(&self, point: usize) -> Result<Vec<StuckSlider>> {
        let (model, branch) = (self.model, self.branch);
        let Some((omega, motion)) = branch.omega_at(point).zip(branch.motion_at(point)) else {
            return Ok(Vec::new());
        };
        let solution = SampledModel::at(branch, point);
        let condensed = solution.condensed;
        let contacts = model.contacts();
        let is_constant =
            |number: usize| keeps_force(&contacts[number]) && contacts[number].normal_direction().is_none();
        let are_constant = condensed.laws().iter().all(|law| is_constant(law.contact));
        if are_constant || !self.may_be_free(point) || condensed.has_exchanges() {
            return Ok(Vec::new());
        }
        let at_frequency = model.at_frequency(omega)?;
        let stuck = stuck_contacts(&at_frequency, solution, motion, omega, self.interrupt)?;
        Ok(stuck.sliders)
    }

    /// Whether the slip fractions allow free sliders: some contact sticks, and some other one slips or may open.
    fn may_be_free(&self, point: usize) -> bool {
        let Some(shares) = self.branch.slip_fraction_at(point) else {
            return false;
        };
        let contacts = self.model.contacts();
        let laws = self.branch.condensed_at(point).laws();
        let sticks = |contact: usize| keeps_force(&contacts[contact]) && shares[contact] == 0.0;
        let for_sure = |contact: usize| sticks(contact) && contacts[contact].normal_direction().is_none();
        laws.iter().any(|law| sticks(law.contact)) && !laws.iter().all(|law| for_sure(law.contact))
    }

    /// Makes a model in which the contacts of these sliders are held at their places.
    fn hold(&mut self, at_frequency: &Model, sliders: &[StuckSlider], point: usize) -> Result<()> {
        // Loads that follow the frequency are those of one point.
        let is_tied = matches!(self.model.speed(), Speed::PerOmega(_));
        let model = if is_tied { at_frequency } else { self.model };
        let sweep = self.sweep.filter(|_| !is_tied);
        let resolution = self.branch.resolution_index(point);
        let is_same = |held: &HeldContacts| {
            let same = sliders.chunk_by(|a, b| a.contact == b.contact).map(|of| of[0].contact);
            held.resolution == resolution && same.eq(held.contacts.iter().copied())
        };
        let known = self.held.take().filter(|held| sweep.is_some() && is_same(held));
        let mut held = match known {
            Some(held) => held,
            None => self.prepared(model, sweep, sliders, point, resolution)?,
        };
        for slider in sliders {
            held.model.set_slider(slider.contact, slider.direction, slider.place)?;
        }
        held.condensed.renew_laws(&held.model, &held.contacts)?;
        self.held = Some(held);
        Ok(())
    }

    fn prepared(
        &self,
        model: &Model,
        sweep: Option<Range>,
        sliders: &[StuckSlider],
        point: usize,
        resolution: usize,
    ) -> Result<HeldContacts> {
        let branch = self.branch;
        let mut held = model.separate_clone()?;
        let mut contacts = Vec::new();
        for of_contact in sliders.chunk_by(|a, b| a.contact == b.contact) {
            let contact = of_contact[0].contact;
            held.set_constant(
                contact,
                Constant::Mu,
                HELD * model.contacts()[contact].constant(Constant::Mu),
            )?;
            try_push(&mut contacts, contact, CONTEXT)?;
        }
        let condensed = branch.condensed_at(point);
        // The mean that a residual force moves may not be carried where the motion is symmetric.
        let options = SolverOptions {
            harmonics: condensed.set().numbers().last().copied().unwrap_or(1),
            keep_even_harmonics: true,
            samples: branch.samples_at(point),
            response_dof: Some(branch.response_dof()),
            refinement: condensed.refinement(),
            exchange: Exchanged::None,
            ..self.solver.fixed()
        };
        let omega = branch.omega_at(point).unwrap_or(f64::NAN);
        let sweep = sweep.unwrap_or(omega.into());
        let reference = Some(condensed.reference());
        let condensed = Condensed::with_reference(&held, &options, sweep, reference, self.interrupt)?;
        Ok(HeldContacts {
            resolution,
            contacts,
            model: held,
            condensed,
        })
    }
}
