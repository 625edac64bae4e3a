//! The condensed model: matrices, forces and contact laws on the relative coordinates, per carried harmonic.

use crate::condense::contact_classes::ContactClasses;
use crate::condense::harmonic_block::HarmonicBlock;
use crate::contact::Law;
use crate::fourier::HarmonicSet;
use num_complex::Complex64;
use std::sync::Arc;

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
pub struct AssembledLaw {
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
    pub(super) laws: Vec<AssembledLaw>,
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

impl Condensed {
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
    pub fn laws(&self) -> &[AssembledLaw] {
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
}
