//! The model: a structure with its contacts, springs and forces.

use crate::contact::Contact;
use crate::contact::described::iwan::Iwan;
use crate::contact::described::patch::Patch;
use crate::contact::described::relative_motion::Direction;
use crate::contact::forms::constants::Constant;
use crate::error::{Error, Result, fail, try_copy, try_extend, try_push, try_room};
use crate::linalg::sparse_storage::matrix_view::MatrixView;
use crate::model::excitation::Excitation;
use crate::model::few_motions::reduced_wave::KeptWaves;
use crate::model::matrices::sector_faces::SectorDescription;
use crate::model::matrices::speed::{Speed, SpeedLoad};
use crate::model::matrices::spring::Spring;
use crate::model::matrices::structure::{MatrixKind, Structure};
use num_complex::Complex64;

/// Name of the memory in an error.
const CONTACTS: &str = "the contacts";

/// A copy of a contact that returns an error if memory is short.
pub(crate) fn copy(contact: &Contact) -> Result<Contact> {
    Ok(Contact {
        kind: contact.kind.clone(),
        dofs: try_copy(&contact.dofs, CONTACTS)?,
        ..*contact
    })
}

/// A structure with its contacts and forces: M ẍ + (C + ΩG) ẋ + (K + Ω²K₁) x + f_nl = f_ex.
///
/// Cyclic models describe one of N equal sectors; sector s + 1 lags behind sector s by the phase
/// 2π·EO/N per harmonic, where EO is the engine order of the wave.
#[derive(Clone, Debug)]
pub struct Model {
    pub(super) structure: Structure,
    /// Reduced waves that were prepared for these matrices.
    pub(super) kept: KeptWaves,
    pub(super) contacts: Vec<Contact>,
    pub(super) springs: Vec<Spring>,
    pub(super) excitation: Excitation,
    /// Normal loads that depend on the speed.
    pub(super) speed_loads: Vec<SpeedLoad>,
}

impl Model {
    /// A plain structure of `ndof` degrees of freedom, all matrices zero.
    ///
    /// # Errors
    /// `Dimension` unless 1 ≤ ndof ≤ [`MAX_DOF`](crate::model::matrices::structure::MAX_DOF).
    pub fn new(ndof: usize) -> Result<Self> {
        Self::cyclic(ndof, 1)
    }

    /// A cyclic model with `ndof` degrees of freedom a sector and `sectors` sectors, under engine order 0.
    ///
    /// # Errors
    /// `Dimension` for `ndof`, `Argument` for `sectors` out of range.
    pub fn cyclic(ndof: usize, sectors: usize) -> Result<Self> {
        Ok(Self {
            structure: Structure::new(ndof, sectors)?,
            kept: KeptWaves::default(),
            contacts: Vec::new(),
            springs: Vec::new(),
            excitation: Excitation::default(),
            speed_loads: Vec::new(),
        })
    }

    /// A sector as a finite-element program writes it, with degrees of freedom on both faces. Matrices, contacts,
    /// forces and results keep the numbering of the sector; its couplings follow from its matrices.
    ///
    /// # Errors
    /// `Dimension`, `Index`, `NotFinite` or `Argument`, naming the pair or degree of freedom: faces of different
    /// sizes, a degree of freedom in both or twice in one, a pair that is fixed on one side only, a node on the
    /// axis, coordinates that contradict the sense or the number of sectors.
    pub fn sector(sector: &SectorDescription<'_>) -> Result<Self> {
        Ok(Self {
            structure: Structure::of_sector(sector)?,
            kept: KeptWaves::default(),
            contacts: Vec::new(),
            springs: Vec::new(),
            excitation: Excitation::default(),
            speed_loads: Vec::new(),
        })
    }

    /// Fixes degrees of freedom: they no longer move, whatever matrices, contacts and forces say. The numbering is
    /// kept. Images of each other on the two faces of a sector must be fixed together.
    ///
    /// # Errors
    /// `Index`; `Argument` for a pair of the faces that is fixed on one side only, if all degrees of freedom were
    /// fixed, or for a contact or spring both of whose sides were. Nothing has then changed.
    pub fn fix(&mut self, dofs: &[usize]) -> Result<()> {
        let new = self.structure.fixing(dofs)?;
        let old = core::mem::replace(&mut self.structure, new);
        let checked = self
            .contacts
            .iter()
            .enumerate()
            .try_for_each(|(i, c)| self.check_contact(c).map_err(|e| e.at(format_args!("contact {i}"))))
            .and_then(|()| {
                let mut springs = self.springs.iter().enumerate();
                springs.try_for_each(|(i, s)| self.check_spring(s).map_err(|e| e.at(format_args!("spring {i}"))))
            });
        if checked.is_err() {
            self.structure = old;
        } else {
            self.kept = KeptWaves::default();
        }
        checked
    }

    /// Adds degrees of freedom without matrices after all others.
    pub(super) fn extend(&mut self, count: usize) -> Result<()> {
        self.structure = self.structure.extended(count)?;
        self.kept = KeptWaves::default();
        Ok(())
    }

    /// The structure, to change its matrices; reduced waves that were prepared for the old ones are dropped.
    pub(super) fn changed_structure(&mut self) -> &mut Structure {
        self.kept = KeptWaves::default();
        &mut self.structure
    }

    /// Reduced waves that were prepared for the matrices of the model.
    pub(crate) fn kept(&self) -> &KeptWaves {
        &self.kept
    }

    /// A copy, allocated fallibly. The matrices are shared until one of the models changes them.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn try_clone(&self) -> Result<Self> {
        let mut contacts = try_room(self.contacts.len(), CONTACTS)?;
        for contact in &self.contacts {
            contacts.push(copy(contact)?);
        }
        let mut springs = Vec::new();
        try_extend(&mut springs, &self.springs, "the springs")?;
        Ok(Self {
            structure: self.structure.try_clone()?,
            kept: self.kept.clone(),
            contacts,
            springs,
            excitation: self.excitation.try_clone()?,
            speed_loads: try_copy(&self.speed_loads, CONTACTS)?,
        })
    }

    /// Sets the mass, damping, stiffness or structural matrix (of the sector itself), ndof × ndof. M must be symmetric or
    /// Hermitian; the others may be [`Part::General`](crate::linalg::sparse_storage::matrix_view::Part::General). Complex entries act
    /// on all harmonics above zero; the mean has the real part.
    ///
    /// # Errors
    /// Those of [`MatrixView::copy_in`]; `NotPositiveDefinite` for a negative diagonal mass.
    pub fn set_matrix(&mut self, which: MatrixKind, a: &MatrixView<'_>) -> Result<()> {
        self.changed_structure().set_own(which, a)
    }

    /// Adds α M + β K to the damping.
    ///
    /// # Errors
    /// `NotFinite`.
    pub fn set_rayleigh(&mut self, alpha_mass: f64, beta_stiffness: f64) -> Result<()> {
        self.changed_structure().set_rayleigh(alpha_mass, beta_stiffness)
    }

    /// Sets the loss factor η of structural damping iηK in all harmonics above 0: K is the stiffness of the structure,
    /// couplings and matrices per diameter included, springs and contacts not. 0 removes it.
    ///
    /// # Errors
    /// `NotFinite`; `Argument` if it is negative.
    pub fn set_loss_factor(&mut self, loss_factor: f64) -> Result<()> {
        self.structure.set_loss_factor(loss_factor)
    }

    /// Sets the coupling of a cyclic model's sector (rows) to the next one (columns). The coupling
    /// to the previous sector is its transpose unless [`Self::set_coupling_previous`] is called.
    ///
    /// # Errors
    /// As [`Self::set_matrix`]; `Unsupported` for a plain structure.
    pub fn set_coupling(&mut self, which: MatrixKind, to_next: &MatrixView<'_>) -> Result<()> {
        self.changed_structure().set_coupling(which, to_next)
    }

    /// Sets the coupling of the sector (rows) to the previous one (columns), for damping and
    /// stiffness without symmetry.
    ///
    /// # Errors
    /// As [`Self::set_coupling`].
    pub fn set_coupling_previous(&mut self, which: MatrixKind, to_previous: &MatrixView<'_>) -> Result<()> {
        self.changed_structure().set_coupling_previous(which, to_previous)
    }

    /// Sets the matrix of the wave in which sector s + 1 lags by 2π·diameter/N; `diameter` counts modulo N, and a
    /// negative one travels the other way. If only one sense of a wave was given, the other has the conjugate matrix.
    ///
    /// # Errors
    /// As [`Self::set_matrix`]; `Argument` for a diameter of a plain structure or a matrix that was given by sector blocks.
    pub fn set_diameter(&mut self, which: MatrixKind, diameter: i64, a: &MatrixView<'_>) -> Result<()> {
        self.changed_structure().set_diameter(which, diameter, a)
    }

    /// Sets the engine order of the wave, of any sign and size.
    pub fn set_wave(&mut self, engine_order: i64) {
        self.structure.set_wave(engine_order);
    }

    /// Adds a contact and returns its index. Equal contacts add up.
    ///
    /// # Errors
    /// `Index` for a degree of freedom out of range, `Argument` for a contact of a degree of
    /// freedom with itself or one that a list names twice, and those of [`Contact::check_constants`].
    pub fn add_contact(&mut self, contact: &Contact) -> Result<usize> {
        self.check_contact(contact)?;
        contact.check_stiffness()?;
        try_push(&mut self.contacts, copy(contact)?, CONTACTS)?;
        Ok(self.contacts.len() - 1)
    }

    /// Adds many contacts and returns the index of the first; the others follow in order. All are checked before any
    /// is added.
    ///
    /// # Errors
    /// As [`Self::add_contact`], naming the position in the list.
    pub fn add_contacts(&mut self, contacts: &[Contact]) -> Result<usize> {
        for (i, contact) in contacts.iter().enumerate() {
            self.check_contact(contact)
                .and_then(|()| contact.check_stiffness())
                .map_err(|e| e.at(format_args!("entry {i}")))?;
        }
        let first = self.room_for(contacts.len())?;
        for contact in contacts {
            match copy(contact) {
                Ok(copied) => self.contacts.push(copied),
                Err(e) => {
                    self.contacts.truncate(first);
                    return Err(e);
                }
            }
        }
        Ok(first)
    }

    /// Adds the node pairs of a patch as contacts with consecutive indices, and returns the first index. All are
    /// checked before any is added.
    ///
    /// # Errors
    /// Those of [`Patch::contacts`] and [`Self::add_contact`], naming the entry.
    pub fn add_patch(&mut self, patch: &Patch<'_>) -> Result<usize> {
        let contacts = patch.contacts()?;
        for (i, contact) in contacts.iter().enumerate() {
            self.check_contact(contact)
                .map_err(|e| e.at(format_args!("patch, entry {i}")))?;
        }
        self.append(contacts)
    }

    /// Adds checked contacts and returns the index of the first.
    fn append(&mut self, mut contacts: Vec<Contact>) -> Result<usize> {
        let first = self.room_for(contacts.len())?;
        self.contacts.append(&mut contacts);
        Ok(first)
    }

    /// Reserves memory for further contacts; returns the index of the first of them.
    fn room_for(&mut self, contacts: usize) -> Result<usize> {
        self.contacts
            .try_reserve(contacts)
            .map_err(|_| Error::out_of_memory(CONTACTS))?;
        Ok(self.contacts.len())
    }

    /// Adds an Iwan joint between the sides of `between` as `elements` Jenkins contacts with consecutive indices, and
    /// returns the first index.
    ///
    /// # Errors
    /// Those of [`Iwan::elements`] and [`Self::add_contact`].
    pub fn add_iwan(&mut self, between: &Contact, joint: &Iwan, elements: usize) -> Result<usize> {
        let sides = Direction::between(between.dof_a[0], between.dof_b[0]);
        self.check_sides("Iwan joint", &sides, between.sector_offset, None)?;
        self.add_contacts(&joint.elements(between, elements)?)
    }

    /// Adds a linear spring between two degrees of freedom, or one and the ground.
    ///
    /// # Errors
    /// As [`Self::add_contact`]; `NotFinite` for the stiffness, which may have any sign.
    pub fn add_spring(&mut self, spring: &Spring) -> Result<()> {
        self.add_springs(core::slice::from_ref(spring))
    }

    /// Adds many linear springs; all of them are checked before any is added.
    ///
    /// # Errors
    /// As [`Self::add_spring`], naming the position in the list; `Argument` after the modal damping was set.
    pub fn add_springs(&mut self, springs: &[Spring]) -> Result<()> {
        for (i, spring) in springs.iter().enumerate() {
            self.check_spring(spring).map_err(|e| e.at(format_args!("entry {i}")))?;
        }
        if !springs.is_empty() {
            self.structure.refuse_modal_damping("springs are added")?;
        }
        try_extend(&mut self.springs, springs, "the springs")
    }

    pub(super) fn check_spring(&self, spring: &Spring) -> Result<()> {
        if !spring.stiffness.is_finite() {
            return fail!(
                NotFinite,
                "spring: stiffness = {}, needs a finite number",
                spring.stiffness
            );
        }
        let sides = Direction::between(spring.dof_a, spring.dof_b);
        self.check_sides("spring", &sides, spring.sector_offset, None)
    }

    /// Changes the normal load of a contact, at any speed.
    ///
    /// # Errors
    /// `Index` for an unknown contact, `Argument` for one without normal load, else as
    /// [`Contact::check_constants`].
    pub fn set_preload(&mut self, id: usize, preload: f64) -> Result<()> {
        self.set_preload_at_speed(id, preload, 0.0)
    }

    /// Changes normal load and gap of a contact.
    pub(super) fn change_preload(&mut self, id: usize, preload: f64, gap: f64) -> Result<()> {
        let count = self.contacts.len();
        let Some(contact) = self.contacts.get_mut(id) else {
            return fail!(Index, "contact id = {id}, but the model has {count} contacts");
        };
        if let Some(kind) = contact.without_load() {
            return fail!(
                Argument,
                "preload of contact id = {id}, but that is a {kind}, which has none"
            );
        }
        let changed = contact
            .clone()
            .with(Constant::Preload, preload)?
            .with(Constant::Gap, gap)?;
        changed.check_constants()?;
        *contact = changed;
        Ok(())
    }

    /// Normal loads that depend on the speed.
    pub(crate) fn speed_loads(&self) -> &[SpeedLoad] {
        &self.speed_loads
    }

    pub(super) fn speed_loads_mut(&mut self) -> &mut Vec<SpeedLoad> {
        &mut self.speed_loads
    }

    pub(super) fn contact_mut(&mut self, id: usize) -> Option<&mut Contact> {
        self.contacts.get_mut(id)
    }

    pub(super) fn add_unbalance_forces(&mut self, forces: [(usize, Complex64); 2]) -> Result<()> {
        self.excitation.add_unbalance(forces)
    }

    pub(super) fn add_centrifugal_force(&mut self, dof: usize, mass_radius: f64) -> Result<()> {
        self.excitation.add_centrifugal(self.ndof(), dof, mass_radius)
    }

    pub(super) fn forces_at_speed(&mut self, speed: Speed) {
        self.excitation.follow_speed(speed);
    }

    pub(super) fn fix_unbalance(&mut self, omega: f64) {
        self.excitation.fix_unbalance(omega);
    }

    /// Adds the force Re(value·e^{i·harmonic·ωt}) on a degree of freedom (of sector 1; the others
    /// lag with the wave). Forces on one degree of freedom and harmonic add up.
    ///
    /// # Errors
    /// `Index`, `Argument` or `NotFinite`, naming the argument.
    pub fn add_force(&mut self, dof: usize, harmonic: usize, value: Complex64) -> Result<()> {
        self.excitation.add(self.ndof(), dof, harmonic, value)
    }

    /// Removes all forces of the model.
    pub fn clear_forces(&mut self) {
        self.excitation.clear();
    }

    /// Adds the forces of one harmonic, times `scale`, to a vector over the independent degrees of freedom. A force
    /// on the right face acts on the next sector; a force on a fixed degree of freedom has no effect.
    pub(crate) fn add_forces_to(&self, harmonic: usize, scale: f64, vector: &mut [Complex64]) {
        self.add_to(harmonic, scale, false, vector);
    }

    /// Adds the amplitudes over ω² of the forces of one harmonic that grow with ω², as `add_forces_to` does.
    pub(crate) fn add_unbalance_to(&self, harmonic: usize, scale: f64, vector: &mut [Complex64]) {
        self.add_to(harmonic, scale, true, vector);
    }

    fn add_to(&self, harmonic: usize, scale: f64, per_omega2: bool, vector: &mut [Complex64]) {
        let forces = self.excitation.forces().iter();
        for f in forces.filter(|f| f.harmonic == harmonic && f.per_omega2 == per_omega2) {
            let (sector, terms) = self.structure.degrees().image(f.dof);
            let value = f.value * scale * self.structure.phase(harmonic, -sector);
            for (dof, c) in terms {
                vector[dof] += value * c;
            }
        }
    }

    /// Number of degrees of freedom (of one sector), including fixed ones and both faces.
    #[must_use]
    pub fn ndof(&self) -> usize {
        self.structure.degrees().given()
    }

    /// The linear structure: matrices, degrees of freedom, speed.
    #[must_use]
    #[doc(hidden)]
    pub fn structure(&self) -> &Structure {
        &self.structure
    }

    /// The linear structure, for changes by the parts of a model.
    pub(super) fn structure_mut(&mut self) -> &mut Structure {
        &mut self.structure
    }

    /// The contacts in the order in which they were added.
    #[must_use]
    pub fn contacts(&self) -> &[Contact] {
        &self.contacts
    }

    /// The linear springs in the order in which they were added.
    #[must_use]
    pub fn springs(&self) -> &[Spring] {
        &self.springs
    }

    /// The forces on the model.
    #[must_use]
    #[doc(hidden)]
    pub fn excitation(&self) -> &Excitation {
        &self.excitation
    }
}
