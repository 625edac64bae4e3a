//! Exact condensation of the linear degrees of freedom onto the relative motions of the contacts.
//!
//! With y = W x and any reference stiffness κ, harmonic h of M ẍ + C ẋ + K x + Wᴴ f = F satisfies
//!
//! > y_h − y_lin,h + G_h (f_h − κ y_h) = 0,  G = W Z_κ⁻¹ Wᴴ,  y_lin = W Z_κ⁻¹ F,
//! > Z_κ = K − h²ω²M + ihωC + Wᴴ κ W,
//!
//! exactly. With κ = kt(1 + i)/2 (kt/2 for the mean) no mode that moves the contact has a pole on the real axis, so
//! that neither the free nor the stuck resonances of an undamped structure are singular. The whole motion follows
//! as x = Z_κ⁻¹(F − Wᴴ(f − κ y)).

use crate::condense::blocks::condensed::{AssembledLaw, Condensed, CondensedContacts, CondensedWave, Reference};
use crate::condense::blocks::contact_classes::ContactClasses;
use crate::condense::blocks::flexibility_way::FlexibilityWay;
use crate::condense::blocks::memory_limit::within_for_contacts;
use crate::condense::blocks::reference_stiffness::{raise_for_springs, reference_stiffness, structural_stiffness};
use crate::condense::blocks::relative_coordinates::{AssembledDirection, assign_coordinates, relative_share};
use crate::condense::blocks::tied_load::TiedLoad;
use crate::condense::by_factors::exchanged_motions::{check_rigid, select_exchanged};
use crate::condense::by_factors::flexibility::Workspace;
use crate::condense::by_modes::wave_cache::WaveCache;
use crate::condense::chosen_blocks::{Chosen, chosen_blocks};
use crate::condense::on_a_basis::basis_outlook::SweepTables;
use crate::condense::on_a_basis::wave_reduction::Request;
use crate::contact::Contact;
use crate::error::{Result, Status, boxed, try_copy, try_push, try_room, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;
use crate::linalg::factors::inertia::eigenvalues_below;
use crate::linalg::power_of_two;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::Model;
use crate::options::Range;
use crate::options::{Content, DampingForm, Exchanged, Flexibility, SolverOptions};
use num_complex::Complex64;
use std::sync::Arc;

/// Number of unknowns above which the stuck structure is the quicker reference.
/// Kind: tuned; measured on: not recorded.
const STUCK_ABOVE: usize = 64;

impl Condensed {
    /// Condenses a model under its forces for a range of frequency, with the motion scaled for its start.
    ///
    /// # Errors
    /// `Argument` for a force beyond the carried harmonics, `Unsupported` or `Argument` for missing
    /// matrices, `Singular` when the start frequency is an undamped resonance, `OutOfMemory`;
    /// `StoppedByCaller`.
    pub fn new(
        model: &Model,
        options: &SolverOptions,
        sweep: impl Into<Range>,
        interrupt: &Interrupt<'_>,
    ) -> Result<Self> {
        Self::with_reference(model, options, sweep, None, interrupt)
    }

    /// Condenses a model as `new` does, with a given reference stiffness, if any. With [`Reference::Stuck`] the
    /// response with stuck contacts is as accurate as without contacts, however small the damping.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_reference(
        model: &Model,
        options: &SolverOptions,
        sweep: impl Into<Range>,
        reference: Option<Reference>,
        interrupt: &Interrupt<'_>,
    ) -> Result<Self> {
        let sweep = sweep.into();
        let forced = forced_harmonics(model, options)?;
        let (mut condensed, assembled) =
            Self::unscaled(model, options, (&forced, sweep), (None, reference), interrupt)?;
        // A power of two near the largest motion of the linear structure, so that nothing over- or
        // underflows whatever the units.
        let unit = power_of_two(model.excitation().largest(sweep.start));
        let n = model.structure().ndof();
        for block in &mut condensed.blocks {
            if let Some(view) = &block.view {
                let mut force = try_vec(n, Complex64::ZERO, "the forces")?;
                model.add_forces_to(block.number, 1.0 / unit, &mut force);
                let force = view.force(&force)?;
                block.load.force[..force.len()].copy_from_slice(&force);
                continue;
            }
            model.add_forces_to(block.number, 1.0 / unit, &mut block.load.force);
            if model.excitation().has_unbalance_in(block.number) {
                let mut unbalance = try_vec(block.load.force.len(), Complex64::ZERO, "the forces")?;
                model.add_unbalance_to(block.number, 1.0 / unit, &mut unbalance);
                block.load.unbalance = Some(unbalance);
            }
        }
        let mut workspace = Workspace::new(&condensed, None)?;
        let mut motion = 0.0_f64;
        for (i, block) in condensed.blocks.iter().enumerate() {
            if block.has_force() {
                workspace.evaluate(&condensed, i, sweep.start, false, interrupt)?;
                motion = motion.max(condensed.largest(i, workspace.excited())?);
            }
        }
        condensed.set_exchanges(sweep, interrupt)?;
        let scale = power_of_two(motion);
        for block in &mut condensed.blocks {
            for f in block
                .load
                .force
                .iter_mut()
                .chain(block.load.unbalance.iter_mut().flatten())
            {
                *f /= scale;
            }
        }
        condensed.set_length(model, unit * scale, &assembled)?;
        Ok(condensed)
    }

    /// Whether the stuck reference was chosen although a complex one would be quicker: for linear responses.
    fn serves_linear_responses(&self) -> bool {
        self.reference == Reference::Stuck && self.coordinates() * self.set.packed_len() <= STUCK_ABOVE
    }

    /// The tables that a sweep over a range, where that is known, makes: linear responses need the column of the excitation alone, of
    /// the harmonics with force.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub(crate) fn tables_of_sweep(&self, range: Option<Range>, interrupt: &Interrupt<'_>) -> Result<SweepTables> {
        let resonances = match range {
            Some(range) => self.resonances_within(range, interrupt)?,
            None => 0,
        };
        let (harmonics, contacts) = if self.serves_linear_responses() {
            (self.blocks.iter().filter(|block| block.has_force()).count(), 0)
        } else {
            (self.blocks.len(), self.coordinates())
        };
        let modal = self.blocks.iter().filter_map(|block| block.matrices.modal.as_ref());
        Ok(SweepTables {
            harmonics,
            contacts,
            damped_modes: modal.map(|directions| directions.len()).max().unwrap_or(0),
            resonances,
        })
    }

    /// Number of natural frequencies of the lowest harmonic with a force in a range, without damping; 0 where they cannot be counted.
    fn resonances_within(&self, range: Range, interrupt: &Interrupt<'_>) -> Result<usize> {
        let Some(block) = self.blocks.iter().find(|block| block.number > 0 && block.has_force()) else {
            return Ok(0);
        };
        let on_pattern = |values: &[Complex64]| -> Result<Csc> {
            let mut matrix = block.matrices.reference.try_clone()?;
            matrix.values.copy_from_slice(values);
            Ok(matrix)
        };
        let (k, m) = (
            on_pattern(&block.matrices.stiffness)?,
            on_pattern(&block.matrices.mass)?,
        );
        let real = k.is_real() && m.is_real();
        let below = |omega: f64| {
            let nu = block.number as f64 * omega;
            Ok(eigenvalues_below(&k, (nu * nu, &m), real, interrupt)?.map_or(0, |below| below.count))
        };
        Ok(below(range.start)?.abs_diff(below(range.stop)?))
    }

    /// Attaches the modes or poles of each wave that has such: the flexibility is then a sum over them.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn attach_modes(&mut self, model: &Model, waves: &mut WaveCache, interrupt: &Interrupt<'_>) -> Result<()> {
        // The small motion of a near-rigid contact is lost in the rounding of modes.
        let is_near_rigid = (0..self.coordinates()).any(|c| self.is_near_rigid(c));
        for i in 0..self.blocks.len() {
            if self.wave.tuned.is_some() {
                self.blocks[i].without_source = FlexibilityWay::TunedWheel;
                continue;
            }
            if is_near_rigid {
                self.blocks[i].without_source = FlexibilityWay::NearRigid;
                continue;
            }
            match waves.of(model, self, i, interrupt)? {
                Ok(source) => self.blocks[i].source = Some(source),
                Err(reason) => self.blocks[i].without_source = reason,
            }
        }
        Ok(())
    }

    /// Condenses a model for its static state under constant forces and preload. The unit of lengths is near the
    /// largest motion under the forces, with every contact at its reference stiffness, or of the compression by the
    /// preload.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn for_static(model: &Model, options: &SolverOptions, interrupt: &Interrupt<'_>) -> Result<Self> {
        let options = SolverOptions {
            harmonics: 0,
            // Nothing vibrates, whatever harmonics the motion about it has.
            content: Content::default(),
            // A basis is good at the frequencies of a sweep.
            flexibility: Flexibility::Direct,
            ..*options
        };
        let (mut condensed, assembled) = Self::unscaled(model, &options, (&[0], 0.0.into()), (None, None), interrupt)?;
        condensed.add_constant_forces(model, 1.0);
        let mut workspace = Workspace::new(&condensed, None)?;
        let evaluated = workspace.evaluate(&condensed, 0, 0.0, false, interrupt).map(|_| ());
        let mut motion = match evaluated {
            // The solution will tell.
            Err(e) if e.status == Status::Singular => 0.0,
            evaluated => {
                evaluated?;
                condensed.largest(0, workspace.excited())?
            }
        };
        for at in &assembled {
            let contact = &model.contacts()[at.contact];
            let stiffness = contact.stiffness(at.direction);
            if contact.normal_direction() == Some(at.direction) && stiffness > 0.0 {
                motion = motion.max(contact.normal_load(0.0) / stiffness);
            }
            motion = contact.slider().iter().fold(motion, |m, place| m.max(place.abs()));
        }
        let length = power_of_two(motion);
        for f in condensed.blocks.iter_mut().flat_map(|block| &mut block.load.force) {
            *f /= length;
        }
        condensed.set_length(model, length, &assembled)?;
        Ok(condensed)
    }

    /// Adds the constant forces of a model, scaled by the unit `length`.
    fn add_constant_forces(&mut self, model: &Model, length: f64) {
        for block in self.blocks.iter_mut().filter(|b| b.number == 0) {
            model.add_forces_to(0, 1.0 / length, &mut block.load.force);
        }
    }

    /// Condenses a model without its vibrating forces for a nonlinear mode with artificial damping of the given form,
    /// starting from a linear mode of the given shape; `loaded` if constant forces or preload act, so that the mean is
    /// carried with all harmonics. Also returns the largest relative motion of that shape at an active contact, which
    /// sets the unit of lengths.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn for_mode(
        model: &Model,
        options: &SolverOptions,
        (form, loaded): (DampingForm, bool),
        shape: &[Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<(Self, f64)> {
        let forced: &[usize] = if loaded { &[0, 1] } else { &[1] };
        // A mode has a linear frequency, so that the stiffness of the structure alone sets the scale.
        let (mut condensed, assembled) = Self::unscaled(
            model,
            options,
            (forced, 0.0.into()),
            (Some((form, shape)), None),
            interrupt,
        )?;
        let fundamental = condensed.blocks.iter().find(|b| b.number == 1);
        let rows = fundamental.map_or(&[][..], |b| &b.motions.rows);
        let motion = rows.iter().fold(0.0_f64, |m, row| m.max(row.along(shape).norm()));
        let length = power_of_two(motion);
        if loaded {
            condensed.add_constant_forces(model, length);
        }
        condensed.set_length(model, length, &assembled)?;
        Ok((condensed, motion))
    }

    /// An empty condensed model without harmonics, for the branch of a run that was stopped before the condensation.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn without_harmonics(model: &Model) -> Result<Self> {
        Ok(Self {
            set: HarmonicSet::all(0)?,
            degrees: model.structure().degrees().clone(),
            order: model.structure().ndof(),
            structure: None,
            certificate: 0.0,
            length: 1.0,
            blocks: Vec::new(),
            contacts: CondensedContacts {
                laws: Arc::default(),
                stiffness: Vec::new(),
                resistance: Vec::new(),
                reference_stiffness: Vec::new(),
                exchanges: Vec::new(),
                can_stick: Vec::new(),
                preloaded: false,
                share: Vec::new(),
                classes: ContactClasses::new(model)?,
            },
            reference: Reference::Complex,
            wave: CondensedWave {
                sectors: model.structure().sectors(),
                in_step: model.structure().in_step(),
                wheel: model.structure().whole_wheel(),
                tuned: None,
            },
            refinement: 1,
        })
    }

    /// The condensed model without its scale of lengths: no forces and no laws yet; the start of the sweep
    /// sets the size of inertia. Also returns the coordinates of the active contacts.
    pub(super) fn unscaled(
        model: &Model,
        options: &SolverOptions,
        (forced, sweep): (&[usize], Range),
        (mode, reference): (Option<(DampingForm, &[Complex64])>, Option<Reference>),
        interrupt: &Interrupt<'_>,
    ) -> Result<(Self, Vec<AssembledDirection>)> {
        model.check_matrices(mode.is_some())?;
        within_for_contacts(options.memory_limit, model)?;
        let contact_classes = ContactClasses::new(model)?;
        let active = &contact_classes.active;
        let set = carried(model, options, forced, active)?;
        let (assembled, representatives) = assign_coordinates(model, active, interrupt)?;
        let mut can_stick = try_vec(representatives.len(), true, "the contacts")?;
        let mut stiffness = try_vec(representatives.len(), 0.0, "the contacts")?;
        let mut resistance = try_vec(representatives.len(), 0.0, "the contacts")?;
        for at in &assembled {
            let contact = &model.contacts()[at.contact];
            stiffness[at.coordinate] += contact.stiffness(at.direction);
            resistance[at.coordinate] += contact.resistance();
            can_stick[at.coordinate] &= contact.may_stick();
        }
        let structural = structural_stiffness(
            model,
            sweep.start,
            &set,
            &contact_classes.never_slipping,
            &assembled,
            representatives.len(),
        )?;
        raise_for_springs(model, &assembled, &structural, &mut stiffness);
        let mut reference_stiffness = reference_stiffness(&stiffness, &structural)?;
        let mut exchanges = try_vec(representatives.len(), None, "the contacts")?;
        if options.exchange != Exchanged::None && mode.is_none() {
            select_exchanged(
                model,
                options.exchange,
                &assembled,
                (&stiffness, &mut reference_stiffness),
                &mut exchanges,
            )?;
        }
        check_rigid(model, &assembled, &exchanges)?;
        // A mode is a resonance of the stuck structure while its contacts stick.
        let reference = match (reference, mode) {
            (Some(given), _) => given,
            (None, Some(_)) => Reference::Complex,
            (None, None) => quicker_reference(model, representatives.len() * set.packed_len()),
        };
        let mut share = try_vec(representatives.len(), 1.0, "the contacts")?;
        if let Some((_, shape)) = mode {
            for (c, share) in share.iter_mut().enumerate() {
                let of_contact = relative_share(model, representatives[c], shape);
                // A reference below the stiffness of the contact is a share of it already.
                *share = (of_contact * (stiffness[c] / reference_stiffness[c].max(f64::MIN_POSITIVE))).min(1.0);
            }
        }
        let kappa = |c: usize, number: usize| {
            reference.kappa(reference_stiffness[c], number) * if number == 1 { share[c] } else { 1.0 }
        };
        let request = Request {
            model,
            options,
            numbers: set.numbers(),
            contacts: (&contact_classes, &representatives),
            sweep,
            loss_factor: model.structure().whole_loss_factor()?,
        };
        let Chosen {
            blocks,
            certificate,
            tuned,
        } = chosen_blocks(&request, mode.map(|(form, _)| form), kappa, interrupt)?;
        let is_reduced = blocks.iter().any(|block| block.view.is_some());
        let condensed = Self {
            set,
            degrees: model.structure().degrees().clone(),
            order: blocks
                .first()
                .map_or(model.structure().ndof(), |block| block.matrices.reference.rows),
            structure: is_reduced.then(|| model.structure().clone()),
            certificate,
            length: 1.0,
            blocks,
            contacts: CondensedContacts {
                laws: Arc::default(),
                stiffness,
                resistance,
                reference_stiffness,
                exchanges,
                can_stick,
                preloaded: model.contacts().iter().any(Contact::is_preloaded),
                share,
                classes: contact_classes,
            },
            reference,
            wave: CondensedWave {
                sectors: model.structure().sectors(),
                in_step: model.structure().in_step(),
                wheel: model.structure().whole_wheel(),
                tuned,
            },
            refinement: options.refinement,
        };
        Ok((condensed, assembled))
    }

    /// Sets the unit of lengths, and the laws in this unit.
    pub(super) fn set_length(&mut self, model: &Model, length: f64, assembled: &[AssembledDirection]) -> Result<()> {
        const CONTEXT: &str = "the contacts";
        self.length = length;
        let contacts = assembled.chunk_by(|a, b| a.contact == b.contact).count();
        let mut laws = try_room(contacts, CONTEXT)?;
        for one in assembled.chunk_by(|a, b| a.contact == b.contact) {
            let mut coordinates = Vec::new();
            for at in one {
                try_push(&mut coordinates, at.coordinate, CONTEXT)?;
            }
            let contact = one[0].contact;
            let exchange = self.contacts.exchanges[one[0].coordinate];
            let base = self.set.base() as f64;
            let exchanged = exchange.and_then(|e| {
                let late = e.mass_at.map(|_| base / e.ring);
                model.contacts()[contact].exchanged((e.stiffness, late), length)
            });
            let assembled = AssembledLaw {
                coordinates,
                contact,
                normal: model.contacts()[contact].normal_direction(),
                law: match exchanged {
                    Some(law) => law,
                    None => model.contacts()[contact].law(length)?,
                },
                load: match TiedLoad::of(model, contact, length)? {
                    Some(load) => Some(boxed(|| Ok(load))?),
                    None => None,
                },
            };
            laws.push(assembled);
        }
        self.contacts.laws = Arc::new(laws);
        Ok(())
    }
}

/// Harmonics in which forces act, by their indices.
pub(super) fn forced_harmonics(model: &Model, options: &SolverOptions) -> Result<Vec<usize>> {
    let mut forced = Vec::new();
    for force in model.acting_forces() {
        try_push(&mut forced, force.harmonic, "the forces")?;
    }
    forced.sort_unstable();
    forced.dedup();
    if forced.is_empty() {
        // Without forces the solution is zero, and the fundamental carries it.
        forced.push(usize::from(options.harmonics > 0));
    }
    Ok(forced)
}

/// The harmonics to carry, for forces in the harmonics `forced` and for the contacts `active`.
pub(super) fn carried(
    model: &Model,
    options: &SolverOptions,
    forced: &[usize],
    active: &[usize],
) -> Result<HarmonicSet> {
    let mut odd = true;
    for &i in active {
        odd &= model.contacts()[i].law(1.0)?.is_odd();
    }
    let (highest, keep_all) = (options.harmonics, options.keep_even_harmonics);
    let mut excited = try_copy(forced, "the forces")?;
    if !active.is_empty() {
        // A linear structure has no other solution.
        for number in options.content.numbers() {
            try_push(&mut excited, number, "the forces")?;
        }
    }
    let mut set = HarmonicSet::excited(&excited, highest, !active.is_empty(), odd, keep_all)?;
    if let Some(number) = model.watched_harmonic().filter(|h| forced.contains(h)) {
        set.watch(number);
    }
    Ok(set)
}

/// The reference stiffness with which a forced response of `unknowns` unknowns is quicker.
pub(super) fn quicker_reference(model: &Model, unknowns: usize) -> Reference {
    if unknowns > STUCK_ABOVE && model.structure().is_damped() {
        Reference::Stuck
    } else {
        Reference::Complex
    }
}
