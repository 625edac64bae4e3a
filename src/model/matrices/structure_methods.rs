//! Methods of a structure whose bodies stand in the rooms of their subjects: a list of one-line calls.

use crate::byte_stream::{ByteReader, ByteWriter};
use crate::contact::Contact;
use crate::contact::described::relative_motion::Direction;
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::linalg::sparse_storage::matrix_view::MatrixView;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::few_motions::on_modes;
use crate::model::matrices::influence::AeroForm;
use crate::model::matrices::sector_matrices::Entries;
use crate::model::matrices::sector_motion::{Key, SectorMotion};
use crate::model::matrices::spring::{Row, Spring};
use crate::model::matrices::structure::{MatrixKind, Structure};
use crate::model::matrices::wave::Wave;
use crate::model::matrices::wave_matrix::WaveMatrix;
use crate::model::matrices::{aero, complex_stiffness, sector_motion, senses, wave_matrix};
use crate::model::saved::saved_structure;
use crate::model::wheels::mistuning::BladeProperty;
use crate::model::wheels::{full_wheel, mistuning, wheel};

// Waves and diameters.
impl Structure {
    /// The signed nodal diameter −N/2 < d ≤ N/2 of a wave of `waves` waves per turn, in which sector s + 1 lags by 2πd/N.
    pub fn signed_diameter(&self, waves: i64) -> i64 {
        senses::signed_diameter(self, waves)
    }

    /// The signed nodal diameters −N/2 < d ≤ N/2 of all waves, rising.
    pub fn all_diameters(&self) -> impl Iterator<Item = i64> + use<> {
        senses::all_diameters(self)
    }

    /// Refuses nodal diameters other than 0 for a plain structure; a wheel has waves of any number, modulo N.
    ///
    /// # Errors
    /// `Argument`.
    pub(crate) fn check_diameter(&self, diameter: i64) -> Result<()> {
        senses::check_diameter(self, diameter)
    }

    /// The nodal diameter 0 ..= N/2 of a wave of `waves` waves per turn; `true` if it travels against the sense in
    /// which sector s + 1 lags.
    pub fn fold(&self, waves: i64) -> (usize, bool) {
        senses::fold(self, waves)
    }

    /// Whether the matrices of the wave −d are the conjugates of those of the wave d: all blocks are real, and no
    /// matrix was given for a negative diameter.
    pub(crate) fn has_conjugate_waves(&self) -> bool {
        senses::has_conjugate_waves(self)
    }

    /// Whether the matrices of a nodal diameter, given by its residue, follow from what the caller gave.
    pub(crate) fn has_diameter(&self, residue: usize) -> bool {
        senses::has_diameter(self, residue)
    }

    /// Whether the modes of a wave −d, given by its residue, do not follow from those of d: M or K has complex blocks
    /// between sectors, or its own matrices for −d.
    pub(crate) fn has_own_sense(&self, residue: usize) -> bool {
        senses::has_own_sense(self, residue)
    }

    /// Refuses matrices of d and −d that are not conjugate, since no real structure has such.
    ///
    /// # Errors
    /// `Unsupported`.
    pub(crate) fn check_senses(&self) -> Result<()> {
        senses::check_senses(self)
    }

    /// Matrix of one kind for a harmonic, or its complex conjugate, without a copy where possible; see
    /// [`Self::wave_matrix`].
    ///
    /// # Errors
    /// As [`Self::wave_matrix`].
    pub fn matrix_of_wave(&self, which: MatrixKind, harmonic: usize, conjugated: bool) -> Result<WaveMatrix<'_>> {
        wave_matrix::matrix_of_wave(self, which, harmonic, conjugated)
    }

    /// The nodal diameter of a harmonic; `true` if it travels against the sense in which sector s + 1 lags.
    pub(crate) fn wave_of(&self, harmonic: usize) -> (usize, bool) {
        on_modes::wave_of(self, harmonic)
    }
}

// Motions.
impl Structure {
    /// Relative motion in the k-th direction of a contact.
    pub fn contact_motion(&self, contact: &Contact, k: usize) -> SectorMotion {
        sector_motion::contact_motion(self, contact, k)
    }

    /// Relative motion of a spring.
    pub fn spring_motion(&self, spring: &Spring) -> SectorMotion {
        sector_motion::spring_motion(self, spring)
    }

    /// Row of a relative motion in a wave.
    pub fn row(&self, motion: &SectorMotion, wave: Wave) -> Row {
        sector_motion::row(self, motion, wave)
    }

    /// Row of the k-th relative motion of a contact in a harmonic.
    pub fn contact_row(&self, contact: &Contact, k: usize, harmonic: usize) -> Row {
        self.row(&self.contact_motion(contact, k), Wave::Harmonic(harmonic))
    }

    /// A key that distinguishes different relative motions, and orders them.
    #[must_use]
    pub fn key(&self, motion: &SectorMotion) -> Key {
        sector_motion::key(self, motion)
    }

    /// Refuses relative motions that have no meaning with these faces or fixed degrees of freedom.
    pub(crate) fn check_motion(
        &self,
        what: &str,
        direction: &Direction,
        sector_offset: i64,
        node_b: Option<[Option<usize>; 3]>,
    ) -> Result<()> {
        sector_motion::check_motion(self, what, direction, sector_offset, node_b)
    }
}

// Aerodynamic forces and complex stiffness.
impl Structure {
    /// Whether aerodynamic forces act.
    pub fn has_aero(&self) -> bool {
        self.aero().iter().any(Option::is_some)
    }

    /// Whether aerodynamic forces per displacement act.
    pub fn has_aero_stiffness(&self) -> bool {
        self.aero()[AeroForm::Displacement as usize].is_some()
    }

    /// The matrix −A(d) of the influence on the left-hand side, for the residue d of a wave; `None` without influence.
    pub(crate) fn aero_matrix(&self, form: AeroForm, residue: usize, real: bool) -> Result<Option<Csc>> {
        aero::aero_matrix(self, form, residue, real)
    }

    /// The influence between the sectors of [`Self::repeating_sectors`], on the left-hand side.
    ///
    /// # Errors
    /// `Unsupported` for complex coefficients.
    pub(crate) fn aero_around(&self, form: AeroForm, interrupt: &Interrupt<'_>) -> Result<Option<Csc>> {
        aero::aero_around(self, form, interrupt)
    }

    /// Whether the stiffness is complex and symmetric but not Hermitian, so that its part that is not Hermitian
    /// dissipates. Matrices per nodal diameter show the symmetry in diameters that are their own mirror, and where
    /// the matrix of −d was given: it is then the transpose, whereas with real sectors without symmetry it is the
    /// conjugate.
    pub fn has_complex_stiffness(&self) -> bool {
        complex_stiffness::has_complex_stiffness(self)
    }

    /// Loss factor of the whole stiffness: the given one, plus η of a complex stiffness H(1 + iη) with Hermitian H.
    /// `None` where a complex stiffness dissipates in another form.
    pub fn whole_loss_factor(&self) -> Result<Option<f64>> {
        complex_stiffness::whole_loss_factor(self)
    }

    /// The stiffness of a wave without the loss that a complex stiffness contains.
    pub(crate) fn elastic(&self, stiffness: Csc) -> Result<Csc> {
        complex_stiffness::elastic(self, stiffness)
    }
}

// Wheels.
impl Structure {
    /// Number of sectors after which the wave repeats, in space: N / gcd(EO, N). 1 for a plain
    /// structure.
    pub fn repeating_sectors(&self) -> usize {
        self.in_step()
    }

    /// The number j of sectors, below n = [`Self::repeating_sectors`], after which the motion is delayed by the n-th
    /// part of the period: x_{s+j}(t + T/n) = x_s(t). It solves j·EO/g = 1 modulo n.
    pub fn sectors_per_part(&self) -> usize {
        full_wheel::sectors_per_part(self)
    }

    /// M, C or K of [`Self::repeating_sectors`] sectors closed to a ring, sector after sector; the damping includes
    /// Rayleigh and modal damping and ΩG, the stiffness Ω²K₁; aerodynamic forces are in both.
    ///
    /// # Errors
    /// `Unsupported` for complex matrices, which have no meaning in time; `Argument` when a nodal diameter was not
    /// given; `OutOfMemory`, `StoppedByCaller`.
    pub fn unrolled(&self, which: MatrixKind, interrupt: &Interrupt<'_>) -> Result<Csc> {
        full_wheel::unrolled(self, which, interrupt)
    }

    /// One matrix as the caller gave it, without derived parts, for the sectors of the ring.
    pub(crate) fn given_around(&self, which: MatrixKind, interrupt: &Interrupt<'_>) -> Result<Csc> {
        full_wheel::given_around(self, which, interrupt)
    }

    /// The blocks of a ring from the matrices of its waves: with A(φ) = Σ Bⱼ e^{−ijφ} the block that
    /// couples a sector to the j-th after it is Bⱼ = 1/n Σ_d A(2πd/n) e^{+2πijd/n}.
    pub(crate) fn blocks_of_waves(
        &self,
        wave: impl Fn(&Self, usize) -> Result<Csc>,
        interrupt: &Interrupt<'_>,
    ) -> Result<Csc> {
        full_wheel::blocks_of_waves(self, wave, interrupt)
    }

    /// A copy whose wave repeats only after all sectors.
    pub(crate) fn around_ring(&self) -> Result<Self> {
        wheel::around_ring(self)
    }

    /// Entries of a matrix that the caller gives for a sector.
    pub(crate) fn of_direction(&self, kind: MatrixKind, direction: &MatrixView<'_>) -> Result<Entries> {
        mistuning::of_direction(self, kind, direction)
    }

    /// The matrix of a property of the blade of sector 0 over the degrees of freedom of the wheel.
    pub(crate) fn of_blade(&self, property: BladeProperty, dofs: &[usize]) -> Result<(MatrixKind, Entries)> {
        mistuning::of_blade(self, property, dofs)
    }
}

// Changes of parameters and bytes.
impl Structure {
    /// Writes the structure as bytes.
    pub(crate) fn save_to(&self, out: &mut ByteWriter<'_>) {
        saved_structure::save_to(self, out);
    }

    /// Reads a structure from bytes.
    ///
    /// # Errors
    /// `Argument` for bytes that are no structure, and those of [`Structure::new`] and of the faces of a sector.
    pub(crate) fn load_from(input: &mut ByteReader<'_>) -> Result<Self> {
        saved_structure::load_from(input)
    }
}
