//! The condensed model: matrices, forces and contact laws on the relative coordinates, per carried harmonic.

use crate::condense::blocks::contact_classes::ContactClasses;
use crate::condense::blocks::exchange::Exchange;
use crate::condense::blocks::harmonic_block::HarmonicBlock;
use crate::condense::blocks::tied_load::{LoadedLaw, TiedLoad};
use crate::condense::tuned_wheel::tuned_plan::TunedPlan;
use crate::contact::Law;
use crate::error::{Result, fail, try_copy, try_vec};
use crate::fourier::HarmonicSet;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::Model;
use crate::model::few_motions::reduced_wave::MotionRow;
use crate::model::matrices::degree_map::DegreeMap;
use crate::model::matrices::sector_motion::MOTION_TERMS;
use crate::model::matrices::structure::Structure;
use num_complex::Complex64;
use std::sync::Arc;

/// Rounding of a motion relative to its size.
/// Kind: rounding.
const CONDENSED_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The reference stiffness κ of the contacts. Solutions do not depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reference {
    /// κ = kt(1 + i)/2, and kt/2 for the mean: no pole lies on the real axis, with or without damping.
    Complex,
    /// κ = kt: stuck contacts are eliminated from Newton's equations. The poles are the resonances of the stuck
    /// structure, so that this is for damped structures. Springs are never eliminated.
    Stuck,
}

impl Reference {
    #[inline]
    pub(crate) fn kappa(self, stiffness: f64, number: usize) -> Complex64 {
        match self {
            Self::Stuck => stiffness.into(),
            Self::Complex if number == 0 => (0.5 * stiffness).into(),
            Self::Complex => Complex64::new(0.5 * stiffness, 0.5 * stiffness),
        }
    }
}

/// A contact law on its relative coordinates.
#[derive(Clone, Debug)]
pub struct AssembledLaw {
    /// The relative coordinates, one per direction of the law.
    pub coordinates: Vec<usize>,
    /// Index of the contact in the model.
    pub contact: usize,
    /// Normal direction of the contact, if its law has one.
    pub normal: Option<usize>,
    /// The law in the solver's units. Where the load depends on the frequency, it is the law of the reference load.
    pub law: Arc<dyn Law>,
    /// The normal load where it depends on the frequency, else `None`.
    pub load: Option<Box<TiedLoad>>,
}

impl AssembledLaw {
    /// The law at an angular frequency with the factor of its load.
    #[must_use]
    pub fn at(&self, omega: f64) -> LoadedLaw<'_> {
        match &self.load {
            None => LoadedLaw::plain(&*self.law),
            Some(load) => load.at(&*self.law, omega),
        }
    }
}

/// A model made ready for solving: harmonics chosen, contacts gathered on relative coordinates,
/// matrices per harmonic.
#[derive(Clone, Debug)]
pub struct Condensed {
    pub(crate) set: HarmonicSet,
    pub(crate) degrees: DegreeMap,
    /// Number of coordinates of a harmonic's matrices: degrees of freedom, or columns of the basis.
    pub(crate) order: usize,
    /// The structure on all its degrees of freedom where the matrices are on a basis, else `None`.
    pub(crate) structure: Option<Structure>,
    /// Estimated relative error of the flexibility on the basis; 0 without one.
    pub(crate) certificate: f64,
    pub(crate) length: f64,
    pub(crate) blocks: Vec<HarmonicBlock>,
    pub(crate) contacts: CondensedContacts,
    pub(crate) reference: Reference,
    pub(crate) wave: CondensedWave,
    /// Factor by which laws without exact events are sampled more finely than by default.
    pub(crate) refinement: usize,
}

/// Contacts and their linear state, one entry a relative motion where not said otherwise.
#[derive(Clone, Debug)]
pub struct CondensedContacts {
    /// Contact laws on their coordinates, shared by the condensed models of all resolutions.
    pub(crate) laws: Arc<Vec<AssembledLaw>>,
    /// Stiffness per coordinate: the sum of kt of its contacts, or more if one is a spring with growing stiffness.
    pub(crate) stiffness: Vec<f64>,
    /// Damping per coordinate: largest change of force per velocity, summed over its contacts.
    pub(crate) resistance: Vec<f64>,
    /// Stiffness per coordinate that defines κ: the contacts' stiffness, or less where contacts are near-rigid.
    pub(crate) reference_stiffness: Vec<f64>,
    /// Per coordinate the exchanged motion of its near-rigid slider, if it has one.
    pub(crate) exchanges: Vec<Option<Exchange>>,
    /// Per coordinate, whether all its laws can stick, as friction does.
    pub(crate) can_stick: Vec<bool>,
    pub(crate) preloaded: bool,
    /// Share of the reference stiffness that the fundamental takes, per coordinate.
    pub(crate) share: Vec<f64>,
    pub(crate) classes: ContactClasses,
}

/// How sectors move relative to each other.
#[derive(Clone, Debug)]
pub struct CondensedWave {
    pub(crate) sectors: usize,
    pub(crate) in_step: usize,
    /// Number of sectors and engine order where the structure is a whole wheel, else `None`.
    pub(crate) wheel: Option<(usize, i64)>,
    /// The whole wheel as a tuned one with differences of low rank, where it is factorised in that way, else `None`.
    pub(crate) tuned: Option<Arc<TunedPlan>>,
}

impl Condensed {
    /// A copy of this condensed model with other blocks, one for each harmonic of `set`.
    pub(crate) fn with_blocks(&self, set: HarmonicSet, blocks: Vec<HarmonicBlock>) -> Result<Self> {
        const CONTEXT: &str = "the matrices per harmonic";
        Ok(Self {
            set,
            degrees: self.degrees.clone(),
            blocks,
            structure: self.structure.as_ref().map(Structure::try_clone).transpose()?,
            contacts: CondensedContacts {
                laws: Arc::clone(&self.contacts.laws),
                stiffness: try_copy(&self.contacts.stiffness, CONTEXT)?,
                resistance: try_copy(&self.contacts.resistance, CONTEXT)?,
                reference_stiffness: try_copy(&self.contacts.reference_stiffness, CONTEXT)?,
                exchanges: try_copy(&self.contacts.exchanges, CONTEXT)?,
                can_stick: try_copy(&self.contacts.can_stick, CONTEXT)?,
                share: try_copy(&self.contacts.share, CONTEXT)?,
                classes: self.contacts.classes.clone(),
                ..self.contacts
            },
            wave: self.wave.clone(),
            ..*self
        })
    }

    /// Takes the laws of some contacts from a model that differs from the condensed one in their friction coefficients and the places
    /// of their sliders alone: no matrix depends on these.
    ///
    /// # Errors
    /// Those of the laws; `Internal` where another condensed model shares them.
    pub fn renew_laws(&mut self, model: &Model, contacts: &[usize]) -> Result<()> {
        let length = self.length;
        let Some(laws) = Arc::get_mut(&mut self.contacts.laws) else {
            return fail!(Internal, "the laws of a condensed model are shared");
        };
        for own in laws.iter_mut().filter(|own| contacts.contains(&own.contact)) {
            own.law = model.contacts()[own.contact].law(length)?;
        }
        Ok(())
    }

    /// The set of carried harmonics.
    #[must_use]
    #[inline]
    pub fn set(&self) -> &HarmonicSet {
        &self.set
    }

    /// Number of coordinates of a harmonic's matrices: the independent degrees of freedom of the structure (one
    /// sector), or the columns of its basis.
    #[must_use]
    #[inline]
    pub fn ndof(&self) -> usize {
        self.order
    }

    /// The structure whose matrices are on a basis; `None` where all its degrees of freedom are kept.
    #[must_use]
    pub fn structure(&self) -> Option<&Structure> {
        self.structure.as_ref()
    }

    /// Whether the matrices are on a basis.
    #[must_use]
    pub fn is_reduced(&self) -> bool {
        self.structure.is_some()
    }

    /// Motion of all independent degrees of freedom in the i-th carried harmonic, from the motion `q` of its
    /// coordinates.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn expand(&self, i: usize, q: &[Complex64], x: &mut [Complex64]) -> Result<()> {
        if let Some(view) = &self.blocks[i].view {
            return view.expand(q, x);
        }
        x.copy_from_slice(q);
        Ok(())
    }

    /// The map from the degrees of freedom of the caller to the independent ones.
    #[must_use]
    pub fn degrees(&self) -> &DegreeMap {
        &self.degrees
    }

    /// Row of the motion of one of the caller's degrees of freedom in the i-th carried harmonic.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn motion_row(&self, i: usize, dof: usize) -> Result<MotionRow> {
        let (sector, terms) = self.degrees.image(dof);
        let turn = if sector == 0 {
            Complex64::ONE
        } else {
            self.blocks[i].next
        };
        let mut row = [None; MOTION_TERMS];
        for (entry, (dof, c)) in row.iter_mut().zip(terms) {
            *entry = Some((dof, turn * c));
        }
        self.blocks[i].row(&row)
    }

    /// Largest motion of a degree of freedom in the i-th carried harmonic.
    pub(crate) fn largest(&self, i: usize, q: &[Complex64]) -> Result<f64> {
        let largest = |x: &[Complex64]| x.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
        if !self.is_reduced() {
            return Ok(largest(q));
        }
        let mut x = try_vec(
            self.degrees.independent(),
            Complex64::ZERO,
            "the motion of the structure",
        )?;
        self.expand(i, q, &mut x)?;
        Ok(largest(&x))
    }

    /// Estimated relative error of the motion of the structure on a basis; 0 where all its degrees of freedom are kept.
    #[must_use]
    pub fn certificate(&self) -> f64 {
        self.certificate
    }

    /// Unit of all lengths in the solver, in the caller's unit.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Matrices, forces and rows per carried harmonic.
    #[must_use]
    #[inline]
    pub fn blocks(&self) -> &[HarmonicBlock] {
        &self.blocks
    }

    /// The contact laws on their coordinates, in the order of the contacts.
    #[must_use]
    #[inline]
    pub fn laws(&self) -> &[AssembledLaw] {
        &self.contacts.laws
    }

    /// Number of relative coordinates.
    #[must_use]
    #[inline]
    pub fn coordinates(&self) -> usize {
        self.contacts.stiffness.len()
    }

    /// Number of unknowns: the packed relative motions.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        self.coordinates() * self.set.packed_len()
    }

    /// Number of contacts in the model, the removed ones included.
    #[must_use]
    pub fn contacts(&self) -> usize {
        self.contacts.classes.contacts().len()
    }

    /// The contacts of the model at the time of its condensation.
    #[must_use]
    pub fn contact_classes(&self) -> &ContactClasses {
        &self.contacts.classes
    }

    /// Sectors of the wheel; 1 for a plain structure.
    #[must_use]
    pub fn sectors(&self) -> usize {
        self.wave.sectors
    }

    /// Number of sectors and engine order of the forces, where the structure is a whole wheel.
    #[must_use]
    pub fn wheel(&self) -> Option<(usize, i64)> {
        self.wave.wheel
    }

    /// The whole wheel as a tuned one with differences of low rank, where it is factorised in that way, else `None`.
    pub(crate) fn tuned(&self) -> Option<&Arc<TunedPlan>> {
        self.wave.tuned.as_ref()
    }

    /// Step m between the harmonics in which all sectors move alike: these are the multiples of m.
    #[must_use]
    pub fn in_step(&self) -> usize {
        self.wave.in_step
    }

    /// Reference stiffness κ of a coordinate in the i-th carried harmonic.
    #[must_use]
    #[inline]
    pub fn kappa(&self, coordinate: usize, i: usize) -> Complex64 {
        let number = self.blocks[i].number;
        let share = if number == 1 {
            self.contacts.share[coordinate]
        } else {
            1.0
        };
        self.reference
            .kappa(self.contacts.reference_stiffness[coordinate], number)
            * share
    }

    /// K_κ of the i-th carried harmonic without structural damping, with the real part of κ.
    pub(crate) fn stiffness_with_real_kappa(&self, i: usize) -> Result<Csc> {
        let block = &self.blocks[i];
        let mut reference = block.matrices.reference.try_clone()?;
        reference.values.copy_from_slice(&block.matrices.stiffness);
        for (c, row) in block.motions.rows.iter().enumerate() {
            let kappa = self.kappa(c, i).re;
            for &(q, b) in row.terms() {
                for &(p, a) in row.terms() {
                    reference.add_stored(p, q, a.conj() * kappa * b);
                }
            }
        }
        Ok(reference)
    }

    /// Stiffness of the contacts of a coordinate.
    #[must_use]
    #[inline]
    pub fn stiffness(&self, coordinate: usize) -> f64 {
        self.contacts.stiffness[coordinate]
    }

    /// Largest force of the contacts of a coordinate over its motion at the angular frequency `nu`: stiffness +
    /// ν·damping.
    pub(crate) fn impedance(&self, coordinate: usize, nu: f64) -> f64 {
        self.contacts.stiffness[coordinate] + nu * self.contacts.resistance[coordinate]
    }

    /// Rounding error of the force of a coordinate over the size of its motion if its contacts are near-rigid,
    /// otherwise 0.
    #[must_use]
    #[inline]
    pub fn rounding(&self, coordinate: usize) -> f64 {
        if self.is_near_rigid(coordinate) {
            CONDENSED_ROUNDING * self.contacts.stiffness[coordinate]
        } else {
            0.0
        }
    }

    /// Whether the contacts of a coordinate are so stiff that κ is below their stiffness.
    #[must_use]
    #[inline]
    pub fn is_near_rigid(&self, coordinate: usize) -> bool {
        self.contacts.reference_stiffness[coordinate] < self.contacts.stiffness[coordinate]
            && self.contacts.exchanges[coordinate].is_none()
    }

    /// Whether a coordinate is eliminated from Newton's equations in its stuck or closed state.
    ///
    /// Its reference stiffness is then that of the contact.
    #[must_use]
    #[inline]
    pub fn may_be_eliminated(&self, coordinate: usize) -> bool {
        self.contacts.can_stick[coordinate]
            && self.reference == Reference::Stuck
            && self.contacts.reference_stiffness[coordinate] >= self.contacts.stiffness[coordinate]
    }

    /// Whether a contact has a static force, so that the static solution is not zero.
    #[must_use]
    pub fn is_preloaded(&self) -> bool {
        self.contacts.preloaded
    }

    /// Factor by which laws without exact events are sampled more finely than by default.
    #[must_use]
    pub fn refinement(&self) -> usize {
        self.refinement
    }

    /// The chosen reference stiffness.
    #[must_use]
    pub fn reference(&self) -> Reference {
        self.reference
    }
}
