//! Methods of a model whose bodies stand in the rooms of their subjects: a list of one-line calls.

use crate::byte_stream::{ByteReader, ByteWriter};
use crate::contact::Contact;
use crate::contact::forms::constants::Constant;
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;
use crate::linalg::sparse_storage::matrix_view::MatrixView;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::damper::{Damper, DamperPlace};
use crate::model::matrices::influence::{AeroForm, AeroInfluence};
use crate::model::matrices::speed::Speed;
use crate::model::matrices::spring::Row;
use crate::model::matrices::structure::MatrixKind;
use crate::model::matrices::wave::Wave;
use crate::model::matrices::{aero, complex_stiffness, modal_damping, rotation, spring_stiffness};
use crate::model::natural_modes::damped_mode::DampedMode;
use crate::model::natural_modes::linear_modes::{ContactState, LinearModes, Pencil, linear_modes};
use crate::model::natural_modes::mode_selection::SelectedMode;
use crate::model::natural_modes::resonances::{Resonance, resonances};
use crate::model::natural_modes::{damped_mode, linear_modes, mode_selection, resonances, slip_capacity};
use crate::model::saved::contents::Block;
use crate::model::saved::fingerprint::{Fingerprint, fingerprint};
use crate::model::saved::{contents, fingerprint, saved_model};
use crate::model::wheels::blade_modes::BladeModes;
use crate::model::wheels::mistuning::Mistuning;
use crate::model::wheels::sector_digest::{SectorDigest, SectorUse};
use crate::model::wheels::wheel::wheel;
use crate::model::wheels::{blade_modes, mistuning};
use crate::model::{Model, damper, longer_period, parameter_changes};
use crate::options::{DampingForm, ModeChoice, Range};
use num_complex::Complex64;
use std::borrow::Cow;

// Matrices and damping.
impl Model {
    /// Adds a damper under platforms: a rigid body whose motions are new degrees of freedom after all others, with
    /// the contacts of its faces and its centrifugal force. Matrices that are set later have the new size. In a
    /// cyclic model each sector has one. Rayleigh damping applies to its mass and support as well.
    ///
    /// # Errors
    /// `Argument`, `NotFinite` or `Index`, naming the field; `Dimension` for too many degrees of freedom. Nothing has then changed.
    pub fn add_damper(&mut self, damper: &Damper<'_>) -> Result<DamperPlace> {
        damper::add_damper(self, damper)
    }

    /// Damps the lowest natural modes of each nodal diameter by given ratios ζ, in the order of rising frequency;
    /// these modes are without contacts but with springs. It replaces an earlier call; without ratios it removes the
    /// modal damping. The matrices of mass and stiffness, springs and fixed degrees of freedom must be complete.
    ///
    /// # Errors
    /// `NotFinite` or `Argument` for a ratio out of range or without a mode; `Unsupported` for more than 2000 degrees
    /// of freedom; those of [`Self::lowest_modes`]. The model is then unchanged.
    pub fn set_modal_damping(&mut self, ratios: &[f64]) -> Result<()> {
        self.set_modal_damping_with(ratios, &Interrupt::none())
    }

    /// Sets modal damping as `set_modal_damping` does, and the caller may stop it.
    ///
    /// # Errors
    /// As [`Self::set_modal_damping`]; `StoppedByCaller`.
    pub fn set_modal_damping_with(&mut self, ratios: &[f64], interrupt: &Interrupt<'_>) -> Result<()> {
        modal_damping::set_modal_damping_with(self, ratios, interrupt)
    }

    /// The model whose stiffness has natural modes: a complex symmetric stiffness as its Hermitian part and structural
    /// damping. Its equations are the same.
    ///
    /// # Errors
    /// `Unsupported` where the structural matrix has another form; `OutOfMemory`.
    #[doc(hidden)]
    pub fn with_separate_loss(&self) -> Result<Cow<'_, Self>> {
        complex_stiffness::with_separate_loss(self)
    }

    /// Springs of the model and `stuck` contacts in a wave: row of force, row of motion, and stiffness of each.
    #[doc(hidden)]
    pub fn spring_rows<'c>(
        &self,
        wave: Wave,
        stuck: impl Iterator<Item = &'c Contact>,
    ) -> Result<Vec<(Row, Row, f64)>> {
        spring_stiffness::spring_rows(self, wave, stuck)
    }

    /// Stiffness K of a wave, with Ω²K₁ at a fixed speed, aerodynamic forces per displacement, the springs of the
    /// model, and the `stuck` contacts as springs.
    ///
    /// # Errors
    /// Those of [`Structure::wave_matrix`](crate::model::matrices::structure::Structure::wave_matrix).
    #[doc(hidden)]
    pub fn sprung_stiffness<'c>(&self, wave: Wave, stuck: impl Iterator<Item = &'c Contact>) -> Result<Csc> {
        spring_stiffness::sprung_stiffness(self, wave, stuck)
    }

    /// Stiffness of a wave as `sprung_stiffness` has it, with the stiffness that a function has for each contact.
    ///
    /// # Errors
    /// As [`Self::sprung_stiffness`].
    pub(crate) fn stiffness_with<'c, T: Copy>(
        &self,
        wave: Wave,
        contacts: impl Iterator<Item = (T, &'c Contact)>,
        stiffness: impl Fn(T, usize, usize) -> f64,
    ) -> Result<Csc> {
        spring_stiffness::stiffness_with(self, wave, contacts, stiffness)
    }

    /// Sets forces on a sector that follow the motion of its neighbours: with f on the right-hand side,
    /// f_i = Σ_k Σ_j c(k, i, j)·x_j of the sector at the distance `offsets[k]`, or of velocities. `coefficients` has a
    /// square matrix over `dofs` for each offset, row after row. A later call of the same form replaces an earlier one;
    /// empty lists remove it. Complex coefficients act on harmonics above 0; the mean has the real part, and time
    /// integration refuses them. [`Self::linear_modes`] leave the influence out.
    ///
    /// # Errors
    /// `Unsupported` for a plain structure; `Index`, `Argument`, `Dimension` or `NotFinite`, naming the entry.
    pub fn set_aero(
        &mut self,
        dofs: &[usize],
        coefficients: &[Complex64],
        offsets: &[i64],
        form: AeroForm,
    ) -> Result<()> {
        aero::set_aero(self, dofs, coefficients, offsets, form)
    }

    /// The aerodynamic influence of a form; `None` if the model has none.
    #[must_use]
    pub fn aero(&self, form: AeroForm) -> Option<&AeroInfluence> {
        self.structure().aero()[form as usize].as_deref()
    }

    pub(crate) fn save_aero(&self, out: &mut ByteWriter<'_>) {
        aero::save_aero(self, out);
    }

    pub(crate) fn load_aero(&mut self, input: &mut ByteReader<'_>) -> Result<()> {
        aero::load_aero(self, input)
    }
}

// Rotation.
impl Model {
    /// Sets the speed of rotation: C + ΩG, K + Ω²K₁ and the loads N₀ + cΩ² follow.
    ///
    /// # Errors
    /// `NotFinite`; `Argument` where a load that decreases with the speed is tied to the frequency.
    pub fn set_speed(&mut self, speed: Speed) -> Result<()> {
        rotation::set_speed(self, speed)
    }

    /// The speed of rotation.
    #[must_use]
    pub fn speed(&self) -> Speed {
        self.structure().speed
    }

    /// Sets the normal load of a contact at speed Ω to preload + per_speed2·Ω². A ring damper of mass m at the radius
    /// R has per_speed2 = mR.
    ///
    /// # Errors
    /// As [`Self::set_preload`], for the load at Ω = 0 and the one at a fixed speed; `NotFinite` or `Argument` for
    /// `per_speed2`.
    pub fn set_preload_at_speed(&mut self, id: usize, preload: f64, per_speed2: f64) -> Result<()> {
        rotation::set_preload_at_speed(self, id, preload, per_speed2)
    }

    /// Sets the static normal load that wear has left to a contact. A negative load opens a gap where the law has a
    /// normal stiffness, and is zero elsewhere. A load that follows a fixed speed becomes constant.
    ///
    /// # Errors
    /// As [`Self::set_preload`].
    pub(crate) fn set_worn_load(&mut self, id: usize, load: f64) -> Result<()> {
        rotation::set_worn_load(self, id, load)
    }

    /// Adds the force of an unbalance m·e that rotates with the frequency ω of the response: m_e ω² cos(ωt + phase) on
    /// `dof_x`, m_e ω² sin(ωt + phase) on `dof_y`.
    ///
    /// # Errors
    /// `Index`, `Argument` or `NotFinite`, naming the argument.
    pub fn add_unbalance(&mut self, dof_x: usize, dof_y: usize, m_e: f64, phase: f64) -> Result<()> {
        rotation::add_unbalance(self, dof_x, dof_y, m_e, phase)
    }

    /// Adds the constant force `mass_radius`·Ω² on a degree of freedom: the centrifugal force of a mass on a radius.
    ///
    /// # Errors
    /// `Index` or `NotFinite`, naming the argument.
    pub fn add_centrifugal(&mut self, dof: usize, mass_radius: f64) -> Result<()> {
        rotation::add_centrifugal(self, dof, mass_radius)
    }

    /// Sets contacts whose load depends on the speed to the load at the present speed; with a speed tied to the
    /// frequency, to a positive load that represents all.
    pub(crate) fn apply_speed(&mut self) {
        rotation::apply_speed(self);
    }

    /// Derivative ∂ln|N|/∂ω of a normal load that is tied to the frequency.
    pub(crate) fn growth_of_load(&self, contact: usize, omega: f64) -> Option<f64> {
        rotation::growth_of_load(self, contact, omega)
    }

    /// Whether anything but the inertia and the damping forces depends on the frequency of the response.
    #[must_use]
    pub fn depends_on_frequency(&self) -> bool {
        rotation::depends_on_frequency(self)
    }

    /// The model at one frequency of the response: its speed is fixed, unbalances are forces.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn at_frequency(&self, omega: f64) -> Result<Cow<'_, Self>> {
        rotation::at_frequency(self, omega)
    }
}

// Natural modes.
impl Model {
    /// The `count` lowest undamped natural modes; see [`Self::linear_modes`]. Large structures are
    /// treated by shift-invert Lanczos.
    ///
    /// # Errors
    /// As [`Self::linear_modes`]; `Argument` for a count of 0.
    pub fn lowest_modes(&self, diameter: i64, contacts: ContactState<'_>, count: usize) -> Result<LinearModes> {
        self.lowest_modes_with(diameter, contacts, count, &Interrupt::none())
    }

    /// Computes modes as [`Self::lowest_modes`], and the caller may stop it.
    ///
    /// # Errors
    /// As [`Self::lowest_modes`]; `StoppedByCaller`.
    pub fn lowest_modes_with(
        &self,
        diameter: i64,
        contacts: ContactState<'_>,
        count: usize,
        interrupt: &Interrupt<'_>,
    ) -> Result<LinearModes> {
        linear_modes::lowest_modes_with(self, diameter, contacts, count, interrupt)
    }

    /// All undamped natural modes of the signed nodal diameter `diameter`, modulo N (0 for a plain structure): the
    /// wave in which sector s + 1 lags by 2π·diameter/N. With gyroscopic forces or complex blocks the wave of
    /// −`diameter` has other modes; otherwise it has the same frequencies and the conjugate shapes. Motion without
    /// mass has no mode, so that a singular mass matrix gives fewer modes than degrees of freedom. Dense algebra is
    /// meant for up to a few hundred degrees of freedom; [`Self::lowest_modes`] serves larger structures.
    ///
    /// # Errors
    /// `Argument` for a diameter of a plain structure, `NotHermitian` when K or M is not, and those of
    /// [`eigen::generalised`](crate::linalg::dense::eigen::generalised).
    pub fn linear_modes(&self, diameter: i64, contacts: ContactState<'_>) -> Result<LinearModes> {
        linear_modes(self, diameter, contacts)
    }

    /// Whether the undamped waves of −d have the frequencies of those of d, and the conjugate shapes.
    #[must_use]
    pub fn has_equal_senses(&self) -> bool {
        self.structure().has_conjugate_waves() && !self.structure().is_gyroscopic()
    }

    /// Natural frequencies of harmonic `h`, ascending, 0 for motions that grow; `None` where they cannot be computed,
    /// as where K or M is not Hermitian.
    pub(crate) fn natural_frequencies(
        &self,
        h: usize,
        contacts: ContactState<'_>,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Vec<f64>>> {
        linear_modes::natural_frequencies(self, h, contacts, interrupt)
    }

    /// Number of motions of a nodal diameter that neither structure nor springs resist: modes whose frequency without
    /// contacts is zero, up to rounding, or that grow. At most six are counted for a large structure. 0 for a
    /// structure whose stiffness is not Hermitian, where the number is not known.
    ///
    /// # Errors
    /// `OutOfMemory`, and those of the eigensolvers; `StoppedByCaller`.
    pub fn rigid_modes(&self, diameter: i64, interrupt: &Interrupt<'_>) -> Result<usize> {
        linear_modes::rigid_modes(self, diameter, interrupt)
    }

    /// K of a wave with the springs, and with the contacts removed or stuck.
    ///
    /// # Errors
    /// As [`Self::sprung_stiffness`].
    #[doc(hidden)]
    pub fn stiffness_at_small_motion(&self, wave: Wave, contacts: ContactState<'_>) -> Result<Csc> {
        linear_modes::stiffness_at_small_motion(self, wave, contacts)
    }

    /// K and M of a wave, checked, without aerodynamic forces.
    pub(crate) fn pencil(&self, wave: Wave, contacts: ContactState<'_>) -> Result<Pencil> {
        linear_modes::pencil(self, wave, contacts)
    }

    /// The mode of the damped structure with stuck contacts that continues `start`, a mode of
    /// [`Self::select_mode`]. Without damping it is `start`, and D is exactly 0.
    ///
    /// A mixture of modes of equal frequency is kept if it is also a mode of the damped structure.
    ///
    /// # Errors
    /// `NoConvergence` where the damping is so strong that no mode is reached; `Singular` where
    /// artificial damping of the stiffness type does not act on the mode; `Dimension` for a shape
    /// of another length; `OutOfMemory`.
    #[doc(hidden)]
    pub fn damped_mode(&self, start: &SelectedMode, form: DampingForm) -> Result<DampedMode> {
        self.damped_mode_with(start, ContactState::Stuck, form, &Interrupt::none())
    }

    /// Continues a mode as [`Self::damped_mode`], with contacts stuck or linearised about a static state, and the
    /// caller may stop it.
    ///
    /// # Errors
    /// As [`Self::damped_mode`]; `StoppedByCaller`.
    #[doc(hidden)]
    pub fn damped_mode_with(
        &self,
        start: &SelectedMode,
        contacts: ContactState<'_>,
        form: DampingForm,
        interrupt: &Interrupt<'_>,
    ) -> Result<DampedMode> {
        damped_mode::damped_mode_with(self, start, contacts, form, interrupt)
    }

    /// The linear mode of the engine-order wave with stuck contacts that `choice` selects.
    ///
    /// Equal frequencies (within 1e-8, relative) do not determine the shape; see [`Multiple`]. [`ModeChoice::Near`]
    /// and [`ModeChoice::Shape`] treat them as one.
    ///
    /// # Errors
    /// Those of [`ModeChoice::check`]; `Index` for a mode that does not exist; `Argument` for a
    /// rigid-body or unstable mode, or a shape without mass; `NotHermitian`,
    /// `NotPositiveDefinite` for the matrices; `NoConvergence`, `Singular`, `OutOfMemory`.
    #[doc(hidden)]
    pub fn select_mode(&self, choice: ModeChoice<'_>) -> Result<SelectedMode> {
        self.select_mode_with(choice, ContactState::Stuck, &Interrupt::none())
    }

    /// Selects a mode as [`Self::select_mode`], with contacts stuck or linearised about a static state, and the
    /// caller may stop it.
    ///
    /// # Errors
    /// As [`Self::select_mode`]; `StoppedByCaller`.
    #[doc(hidden)]
    pub fn select_mode_with(
        &self,
        choice: ModeChoice<'_>,
        contacts: ContactState<'_>,
        interrupt: &Interrupt<'_>,
    ) -> Result<SelectedMode> {
        mode_selection::select_mode_with(self, choice, contacts, interrupt)
    }

    /// The resonances of all harmonics in which forces vibrate, see [`Self::resonances`].
    ///
    /// # Errors
    /// As [`Self::resonances`].
    #[doc(hidden)]
    pub fn forced_resonances(
        &self,
        range: Range,
        contacts: ContactState<'_>,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Vec<Resonance>>> {
        resonances::forced_resonances(self, range, contacts, interrupt)
    }

    /// The resonances of harmonic `h` between two excitation frequencies, ascending: natural frequencies over h, with
    /// the contacts in `contacts` and half widths from the damping. `None` where they cannot be had, as when there are
    /// too many of them.
    ///
    /// Modes are those of the Hermitian part of K; its skew part adds to the damping. With mass-normalised shapes Φ,
    /// poles are the eigenvalues of diag(ω) + ½i Φᴴ(C + Im K/ω)Φ, exact to first order in the damping.
    #[doc(hidden)]
    pub fn resonances(
        &self,
        h: usize,
        range: Range,
        contacts: ContactState<'_>,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Vec<Resonance>>> {
        resonances(self, h, range, contacts, interrupt)
    }

    /// The undamped resonance because of which the model has no bounded response at the angular frequency `omega`, if
    /// one is found.
    ///
    /// # Errors
    /// `OutOfMemory`, and those of [`Self::sprung_stiffness`]; `StoppedByCaller`.
    #[doc(hidden)]
    pub fn overload(&self, omega: f64, interrupt: &Interrupt<'_>) -> Result<Option<slip_capacity::UnresistedMotion>> {
        slip_capacity::overload(self, omega, interrupt)
    }

    /// The motion nearest to the forced one that the structure without its contacts does not resist in `harmonic` of
    /// `omega`; `None` where inverse iteration finds none.
    ///
    /// # Errors
    /// As [`Self::overload`].
    #[doc(hidden)]
    pub fn resonance(
        &self,
        omega: f64,
        harmonic: usize,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<slip_capacity::UnresistedMotion>> {
        slip_capacity::resonance(self, omega, harmonic, interrupt)
    }
}

// Wheels and other models.
impl Model {
    /// Mistunes a wheel by a value δ_s for each sector s; `sector` is the cyclic model of which [`Model::wheel`] made
    /// it. Changes of matrices refer to the cyclic model, and several calls add up; loads and forces are multiplied.
    ///
    /// # Errors
    /// `Dimension` for another number of sectors, or another model; `NotFinite`; `Index`; `Argument` or `Unsupported`,
    /// naming what is out of range. The wheel is then unchanged.
    pub fn mistune(&mut self, sector: &Self, what: &Mistuning<'_>, delta: &[f64]) -> Result<()> {
        mistuning::mistune(self, sector, what, delta)
    }

    /// The whole wheel of a cyclic model as a plain one, a model for every analysis: degree of freedom i of sector s is
    /// s·n + i, contact c is s·m + c. The engine order is in the phases of the forces. Forces of engine order e that belong
    /// to one speed are those in harmonic e under engine order 1.
    ///
    /// # Errors
    /// `Unsupported` for a plain model, complex aerodynamic coefficients, and contacts and springs with another sector whose axes
    /// are turned; `Argument` when a nodal diameter was not given; `Dimension` for a wheel that is too large; `OutOfMemory`.
    pub fn wheel(&self) -> Result<Self> {
        wheel(self)
    }

    /// Reduces a sector to the `modes` lowest cantilever modes of the blade `dofs`: modes with everything else held.
    /// `dofs` are all degrees of freedom of the blade except those of its root and those with contacts and springs;
    /// forces may act on them. The error is estimated for `families` tuned modes of each nodal diameter.
    ///
    /// # Errors
    /// `Index` or `Argument` for degrees of freedom that cannot be in a blade, naming them, and for numbers of modes; `Unsupported` for
    /// matrices of single diameters, modal damping, aerodynamic forces, and a stiffness that is not symmetric; `Singular` for a blade
    /// that is not held; `StoppedByCaller`.
    pub fn on_blade_modes(
        &self,
        dofs: &[usize],
        (modes, families): (usize, usize),
        interrupt: &Interrupt<'_>,
    ) -> Result<BladeModes> {
        blade_modes::on_blade_modes(self, dofs, (modes, families), interrupt)
    }

    /// A copy for motions with `periods` times the period: forces in harmonic h act in harmonic `periods`·h, while
    /// unbalances and a speed tied to the frequency are kept. The engine order is chosen such that the forces keep
    /// their wave.
    ///
    /// # Errors
    /// `Argument` for `periods` = 0, or above the highest harmonic number; `Unsupported` where no wave of the sectors has the
    /// longer period; `OutOfMemory`.
    pub fn with_longer_period(&self, periods: usize) -> Result<Self> {
        longer_period::with_longer_period(self, periods)
    }
}

// Changes of parameters.
impl Model {
    /// Places the slider of a friction contact before any motion along t1 (`direction` 0) or t2 (1): the residual state that
    /// an assembly or an earlier load has left. A contact that sticks through the period has the force kt·(x − place); a
    /// place from which its limit would drag it acts as the nearest one within. A contact that slips or opens in every
    /// period forgets it.
    ///
    /// # Errors
    /// `Index` for an unknown contact; `Unsupported` for a direction in which the contact has no slider, or an infinite
    /// preload; `NotFinite`.
    pub fn set_slider(&mut self, id: usize, direction: usize, place: f64) -> Result<()> {
        parameter_changes::set_slider(self, id, direction, place)
    }

    /// Multiplies all forces, unbalance included.
    ///
    /// # Errors
    /// `NotFinite`.
    pub(crate) fn scale_forces(&mut self, factor: f64) -> Result<()> {
        parameter_changes::scale_forces(self, factor)
    }

    /// Multiplies the forces of the fundamental.
    ///
    /// # Errors
    /// `NotFinite`.
    pub(crate) fn scale_fundamental(&mut self, factor: f64) -> Result<()> {
        parameter_changes::scale_fundamental(self, factor)
    }

    /// Changes a constant of a contact; for the normal load, its static value.
    ///
    /// # Errors
    /// `Index` for an unknown contact; `Unsupported` for a constant that the law does not have; those of
    /// [`crate::contact::Contact::check_constants`].
    pub(crate) fn set_constant(&mut self, id: usize, constant: Constant, value: f64) -> Result<()> {
        parameter_changes::set_constant(self, id, constant, value)
    }

    /// Adds a multiple of a matrix to the mass, damping or stiffness matrix, in a cyclic model to the sector's own
    /// block, which is a part of the matrices of all nodal diameters.
    ///
    /// # Errors
    /// Those of [`MatrixView::copy_in`]; `NotFinite`; `OutOfMemory`.
    pub(crate) fn add_direction(&mut self, which: MatrixKind, direction: &MatrixView<'_>, factor: f64) -> Result<()> {
        parameter_changes::add_direction(self, which, direction, factor)
    }

    /// Multiplies the mass, damping or stiffness matrix with its couplings; Rayleigh and modal damping are part of the
    /// damping.
    ///
    /// # Errors
    /// `NotFinite`; `OutOfMemory`.
    pub(crate) fn scale_matrix(&mut self, which: MatrixKind, factor: f64) -> Result<()> {
        parameter_changes::scale_matrix(self, which, factor)
    }

    /// A copy with its own list of reduced waves: waves prepared for it are not shared with others.
    pub(crate) fn separate_clone(&self) -> Result<Self> {
        parameter_changes::separate_clone(self)
    }
}

// Models as bytes.
impl Model {
    /// A block of a matrix over the independent degrees of freedom. `None` where it was not given: it is then zero,
    /// or for the block to the previous sector the transpose of the block to the next one.
    ///
    /// # Errors
    /// `Unsupported` for a matrix that was given per nodal diameter.
    #[doc(hidden)]
    pub fn block(&self, kind: MatrixKind, block: Block) -> Result<Option<&KeptMatrix>> {
        contents::block(self, kind, block)
    }

    /// Normal load N₀, coefficient c of its growth N₀ + cΩ², and gap of a contact, as they were given; `None` for an
    /// unknown contact.
    #[must_use]
    pub fn given_load(&self, id: usize) -> Option<(f64, f64, f64)> {
        contents::given_load(self, id)
    }

    /// The digest of a sector, for the wheel that is made of it.
    pub(crate) fn sector_digest(&self) -> SectorDigest {
        fingerprint::sector_digest(self)
    }

    /// Refuses a sector other than the one of which this wheel was made. A wheel loaded from bytes of an earlier
    /// version does not know its sector.
    ///
    /// # Errors
    /// `Argument`, naming the part that differs.
    pub(crate) fn check_sector(&self, sector: &Self, used: SectorUse) -> Result<()> {
        fingerprint::check_sector(self, sector, used)
    }

    /// The fingerprint of the model.
    pub(crate) fn fingerprint(&self) -> Fingerprint {
        fingerprint(self)
    }

    /// The model as bytes, for [`Model::load`].
    ///
    /// # Errors
    /// `Unsupported` for a model with a law of the caller, naming the contact; `OutOfMemory`.
    ///
    /// # Example
    /// ```
    /// use hbvib::Model;
    ///
    /// let model = Model::new(3)?;
    /// assert_eq!(Model::load(&model.save()?)?.ndof(), 3);
    /// # Ok::<(), hbvib::Error>(())
    /// ```
    pub fn save(&self) -> Result<Vec<u8>> {
        saved_model::save(self)
    }

    /// Writes the model into a buffer and returns its length in bytes. A buffer that is too short holds no model
    /// afterwards.
    ///
    /// # Errors
    /// `Unsupported` for a model with a law of the caller, naming the contact.
    pub fn save_into(&self, buffer: &mut [u8]) -> Result<usize> {
        saved_model::save_into(self, buffer)
    }

    /// The model from bytes that [`Model::save`] made. Memory is requested at most in proportion to the number of
    /// bytes, whatever they contain.
    ///
    /// # Errors
    /// `Argument` for bytes that are no saved model, or a damaged or incomplete one; `Unsupported` for one of a newer
    /// format; `OutOfMemory`.
    pub fn load(bytes: &[u8]) -> Result<Self> {
        saved_model::load(bytes)
    }
}
