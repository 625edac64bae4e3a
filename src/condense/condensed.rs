//! Exact condensation of the linear degrees of freedom onto the relative motions of the contacts.
//!
//! With y = W x and any reference stiffness κ, harmonic h of M ẍ + C ẋ + K x + Wᴴ f = F obeys
//!
//! > y_h − y_lin,h + G_h (f_h − κ y_h) = 0,  G = W Z_κ⁻¹ Wᴴ,  y_lin = W Z_κ⁻¹ F,
//! > Z_κ = K − h²ω²M + ihωC + Wᴴ κ W,
//!
//! exactly. κ = kt(1 + i)/2 (kt/2 for the mean) keeps every pole off the real axis for modes that
//! move the contact, so that neither the free nor the stuck resonances of an undamped structure
//! are singular. The whole motion follows as x = Z_κ⁻¹(F − Wᴴ(f − κ y)).

use crate::condense::contact_classes::ContactClasses;
use crate::condense::flexibility::Workspace;
use crate::condense::harmonic_block::harmonic_block;
pub use crate::condense::harmonic_block::{Artificial, HarmonicBlock};
use crate::condense::relative_coordinates::{AssembledLaw, gather, give, raise_for_springs};
use crate::contact::{Contact, Law};
use crate::error::{Result, try_push, try_vec};
use crate::fourier::HarmonicSet;
use crate::linalg::power_of_two;
use crate::model::Model;
use crate::model::spring::along;
use crate::model::structure::MatrixKind;
use crate::options::{DampingForm, SolverOptions};
use num_complex::Complex64;
use std::sync::Arc;

/// Unknowns above which it pays to look at the contacts from the stuck structure.
pub(super) const STUCK_ABOVE: usize = 64;

/// The reference stiffness κ of the contacts. Solutions do not depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reference {
    /// kt(1 + i)/2, kt/2 for the mean: no pole on the real axis, damped structure or not.
    Complex,
    /// kt: contacts that stick drop out of Newton's method. The poles are the resonances of the
    /// stuck structure, so this is for damped structures. Springs never drop out.
    Stuck,
}

impl Reference {
    pub(super) fn kappa(self, stiffness: f64, number: usize) -> Complex64 {
        match self {
            Self::Stuck => stiffness.into(),
            Self::Complex if number == 0 => (0.5 * stiffness).into(),
            Self::Complex => Complex64::new(0.5 * stiffness, 0.5 * stiffness),
        }
    }
}

/// A law on its relative coordinates.
#[derive(Clone, Debug)]
pub struct UncondensedLaw {
    /// The relative coordinates, one per direction of the law.
    pub coordinates: Vec<usize>,
    /// Number of the contact in the model.
    pub contact: usize,
    /// Which direction of the law is its normal, if it has one.
    pub normal: Option<usize>,
    /// The law in the solver's units.
    pub law: Arc<dyn Law>,
}

/// A model made ready for solving: harmonics chosen, contacts gathered on relative coordinates,
/// matrices per harmonic.
#[derive(Clone, Debug)]
pub struct Condensed {
    pub(super) set: HarmonicSet,
    pub(super) ndof: usize,
    pub(super) length: f64,
    pub(super) blocks: Vec<HarmonicBlock>,
    pub(super) laws: Vec<UncondensedLaw>,
    /// Stiffness per coordinate from which κ is made: the sum of kt of its contacts, or more where
    /// one is a spring whose stiffness grows.
    pub(super) stiffness: Vec<f64>,
    /// Whether all laws of a coordinate may stick, as friction does.
    pub(super) drops: Vec<bool>,
    pub(super) preloaded: bool,
    pub(super) reference: Reference,
    /// Share of the reference stiffness that the fundamental takes, per coordinate.
    pub(super) share: Vec<f64>,
    pub(super) contact_classes: ContactClasses,
    pub(super) sectors: usize,
    pub(super) in_step: usize,
}

/// What the condensation removed from the problem, for the user to see.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reduction {
    /// Sectors of the wheel; all but one are removed.
    pub sectors: usize,
    /// Degrees of freedom of one sector.
    pub degrees_of_freedom: usize,
    /// Relative coordinates that remain of them.
    pub coordinates: usize,
    /// Contacts in the model.
    pub contacts: usize,
    /// Contacts that became linear springs (infinite slip limit, no cubic term).
    pub never_slipping: usize,
    /// Contacts without force (no stiffness, or no slip limit).
    pub inert: usize,
    /// Highest harmonic number of which the points tell: that asked for or, where a tolerance decided, the highest
    /// that one of them carries.
    pub harmonics_asked: usize,
    /// Harmonics carried, where most are.
    pub harmonics_carried: usize,
    /// Whether the mean is carried.
    pub mean_carried: bool,
    /// Whether the even harmonics were left out because law and forcing are odd.
    pub even_removed: bool,
    /// Real unknowns of the nonlinear problem, where there are most.
    pub unknowns: usize,
    /// Rigid-body modes of the mean motion that contacts alone hold; 0 where the mean is not carried.
    pub held_by_contacts: usize,
}

impl Condensed {
    /// Condenses a model under its forces, with the motion scaled for frequency `omega`.
    ///
    /// # Errors
    /// `Argument` for a force beyond the carried harmonics, `Unsupported` or `Argument` for missing
    /// matrices, `Singular` when the start frequency is an undamped resonance, `OutOfMemory`.
    pub fn new(model: &Model, options: &SolverOptions, omega: f64) -> Result<Self> {
        let mut forced = Vec::new();
        for force in model
            .excitation()
            .forces()
            .iter()
            .filter(|f| f.value != Complex64::ZERO)
        {
            try_push(&mut forced, force.harmonic, "the forces")?;
        }
        forced.sort_unstable();
        forced.dedup();
        if forced.is_empty() {
            // Without forces nothing moves; the fundamental carries the zero solution.
            forced.push(usize::from(options.harmonics > 0));
        }
        let (mut condensed, assembled) = Self::unscaled(model, options, &forced, omega, None)?;
        // A power of two near the largest motion of the linear structure, so that nothing over- or
        // underflows whatever the units.
        let largest = model
            .excitation()
            .forces()
            .iter()
            .fold(0.0_f64, |m, f| m.max(f.value.re.abs()).max(f.value.im.abs()));
        let unit = power_of_two(largest);
        for block in &mut condensed.blocks {
            model.excitation().add_to(block.number, 1.0 / unit, &mut block.force);
        }
        let mut workspace = Workspace::new(&condensed, None)?;
        let mut motion = 0.0_f64;
        for i in 0..condensed.blocks.len() {
            workspace.evaluate(&condensed, i, omega, false)?;
            motion = motion.max(workspace.largest_motion());
        }
        let scale = power_of_two(motion);
        for block in &mut condensed.blocks {
            for f in &mut block.force {
                *f /= scale;
            }
        }
        condensed.set_length(model, unit * scale, &assembled)?;
        Ok(condensed)
    }

    /// Condenses a model without its forces for a nonlinear mode with artificial damping of the
    /// given form, starting from a linear mode of the given shape. Returns the largest relative
    /// motion of that shape at an active contact as well, in whose size lengths are measured.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn for_mode(
        model: &Model,
        options: &SolverOptions,
        form: DampingForm,
        shape: &[Complex64],
    ) -> Result<(Self, f64)> {
        // A mode has a linear frequency, so the structure holds its springs by stiffness.
        let (mut condensed, assembled) = Self::unscaled(model, options, &[1], 0.0, Some((form, shape)))?;
        let fundamental = condensed.blocks.iter().find(|b| b.number == 1);
        let rows = fundamental.map_or(&[][..], |b| &b.rows);
        let motion = rows.iter().fold(0.0_f64, |m, row| m.max(along(row, shape).norm()));
        condensed.set_length(model, power_of_two(motion), &assembled)?;
        Ok((condensed, motion))
    }

    /// All but the scale of lengths: no forces and no laws yet; `omega` tells the size of inertia. Returns the
    /// coordinates of the active contacts as well.
    pub(super) fn unscaled(
        model: &Model,
        options: &SolverOptions,
        forced: &[usize],
        omega: f64,
        mode: Option<(DampingForm, &[Complex64])>,
    ) -> Result<(Self, Vec<AssembledLaw>)> {
        let contact_classes = ContactClasses::new(model)?;
        let active = &contact_classes.active;
        let mut odd = true;
        for &i in active {
            odd &= model.contacts()[i].law(1.0)?.is_odd();
        }
        let set = HarmonicSet::excited(
            forced,
            options.harmonics,
            !active.is_empty(),
            odd,
            options.keep_even_harmonics,
        )?;
        let (assembled, representatives) = gather(model, active)?;
        let mut drops = try_vec(representatives.len(), true, "the contacts")?;
        let mut stiffness = try_vec(representatives.len(), 0.0, "the contacts")?;
        for at in &assembled {
            let contact = &model.contacts()[at.contact];
            stiffness[at.coordinate] += contact.stiffness(at.direction);
            drops[at.coordinate] &= contact.may_stick();
        }
        raise_for_springs(
            model,
            omega,
            &set,
            &contact_classes.never_slipping,
            &assembled,
            &mut stiffness,
        )?;
        let unknowns = representatives.len() * set.packed_len();
        // A mode is a resonance of the stuck structure while its contacts stick.
        let reference = if unknowns > STUCK_ABOVE && model.structure().is_damped() && mode.is_none() {
            Reference::Stuck
        } else {
            Reference::Complex
        };
        let mut share = try_vec(representatives.len(), 1.0, "the contacts")?;
        if let Some((_, shape)) = mode {
            for (share, &contact) in share.iter_mut().zip(&representatives) {
                *share = give(model, contact, shape);
            }
        }
        let mut blocks = Vec::new();
        for &number in set.numbers() {
            let kappa = |c: usize| reference.kappa(stiffness[c], number) * if number == 1 { share[c] } else { 1.0 };
            let mut block = harmonic_block(model, number, &contact_classes, &representatives, kappa)?;
            block.artificial = match mode {
                None => Artificial::None,
                Some((DampingForm::Mass, _)) => Artificial::Mass,
                Some((DampingForm::Stiffness, _)) => {
                    let structure = model.structure().wave_matrix(MatrixKind::Stiffness, number)?;
                    Artificial::Stiffness(structure.aligned(&block.reference)?)
                }
            };
            try_push(&mut blocks, block, "the matrices per harmonic")?;
        }
        let condensed = Self {
            set,
            ndof: model.ndof(),
            length: 1.0,
            blocks,
            laws: Vec::new(),
            stiffness,
            drops,
            preloaded: model.contacts().iter().any(Contact::is_preloaded),
            reference,
            share,
            contact_classes,
            sectors: model.structure().sectors(),
            in_step: model.structure().in_step(),
        };
        Ok((condensed, assembled))
    }

    /// Sets the unit of lengths, and the laws in it.
    pub(super) fn set_length(&mut self, model: &Model, length: f64, assembled: &[AssembledLaw]) -> Result<()> {
        const CONTEXT: &str = "the contacts";
        self.length = length;
        for one in assembled.chunk_by(|a, b| a.contact == b.contact) {
            let mut coordinates = Vec::new();
            for at in one {
                try_push(&mut coordinates, at.coordinate, CONTEXT)?;
            }
            let contact = one[0].contact;
            let assembled = UncondensedLaw {
                coordinates,
                contact,
                normal: model.contacts()[contact].normal_direction(),
                law: model.contacts()[contact].law(length)?,
            };
            try_push(&mut self.laws, assembled, CONTEXT)?;
        }
        Ok(())
    }

    /// The carried harmonics.
    #[must_use]
    pub fn set(&self) -> &HarmonicSet {
        &self.set
    }

    /// Degrees of freedom of the structure (one sector).
    #[must_use]
    pub fn ndof(&self) -> usize {
        self.ndof
    }

    /// Unit of all lengths in the solver, in the caller's unit.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Matrices, forces and rows per carried harmonic.
    #[must_use]
    pub fn blocks(&self) -> &[HarmonicBlock] {
        &self.blocks
    }

    /// The laws, in the order of the contacts.
    #[must_use]
    pub fn laws(&self) -> &[UncondensedLaw] {
        &self.laws
    }

    /// Number of relative coordinates.
    #[must_use]
    pub fn coordinates(&self) -> usize {
        self.stiffness.len()
    }

    /// Packed relative motions that are solved for.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        self.coordinates() * self.set.packed_len()
    }

    /// Number of contacts in the model, the removed ones included.
    #[must_use]
    pub fn contacts(&self) -> usize {
        self.contact_classes.contacts().len()
    }

    /// The contacts in the model, as they were.
    #[must_use]
    pub fn contact_classes(&self) -> &ContactClasses {
        &self.contact_classes
    }

    /// Sectors of the wheel; 1 for a plain structure.
    #[must_use]
    pub fn sectors(&self) -> usize {
        self.sectors
    }

    /// Harmonics in which all sectors move alike are the multiples of this number.
    #[must_use]
    pub fn in_step(&self) -> usize {
        self.in_step
    }

    /// Reference stiffness κ of a coordinate in the i-th carried harmonic.
    #[must_use]
    pub fn kappa(&self, coordinate: usize, i: usize) -> Complex64 {
        let number = self.blocks[i].number;
        let share = if number == 1 { self.share[coordinate] } else { 1.0 };
        self.reference.kappa(self.stiffness[coordinate], number) * share
    }

    /// Stiffness of a coordinate from which κ is made.
    #[must_use]
    pub fn stiffness(&self, coordinate: usize) -> f64 {
        self.stiffness[coordinate]
    }

    /// Whether a coordinate leaves Newton's equations while it sticks, or along a normal is closed: its
    /// reference stiffness is then that of the contact.
    #[must_use]
    pub fn may_be_eliminated(&self, coordinate: usize) -> bool {
        self.drops[coordinate] && self.reference == Reference::Stuck
    }

    /// Whether a contact presses at rest, so that the static solution is not zero.
    #[must_use]
    pub fn is_preloaded(&self) -> bool {
        self.preloaded
    }

    /// The reference stiffness that was chosen.
    #[must_use]
    pub fn reference(&self) -> Reference {
        self.reference
    }

    /// What was removed.
    ///
    /// # Errors
    /// Those of [`Model::rigid_modes`].
    pub fn reduction(&self, model: &Model, options: &SolverOptions) -> Result<Reduction> {
        let held_by_contacts = if self.set.has_mean() && self.coordinates() > 0 {
            model.rigid_modes(0)?
        } else {
            0
        };
        Ok(Reduction {
            sectors: model.structure().sectors(),
            degrees_of_freedom: self.ndof,
            coordinates: self.coordinates(),
            contacts: self.contacts(),
            never_slipping: self.contact_classes.never_slipping.len(),
            inert: self.contact_classes.inert(),
            harmonics_asked: options.harmonics,
            harmonics_carried: self.set.numbers().len(),
            mean_carried: self.set.has_mean(),
            even_removed: self.set.is_odd(),
            unknowns: self.unknowns(),
            held_by_contacts,
        })
    }
}
