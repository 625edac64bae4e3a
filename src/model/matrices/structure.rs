//! The linear structure: sector blocks of mass, damping and stiffness, or their matrices per nodal
//! diameter.

use crate::error::{Result, fail, try_push};
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;
use crate::linalg::sparse_storage::matrix_view::{MatrixView, Part};
use crate::linalg::sparse_storage::sparse::{Csc, Form, Symmetry};
use crate::model::matrices::blocks::Blocks;
use crate::model::matrices::degree_map::DegreeMap;
use crate::model::matrices::influence::{AeroInfluence, FORMS};
use crate::model::matrices::sector_faces::{Faces, SectorDescription};
use crate::model::matrices::sector_matrices::{self, of_independent, restricted};
use crate::model::matrices::speed::Speed;
use crate::model::matrices::wave::Wave;
use crate::model::wheels::sector_digest::SectorDigest;
use num_complex::Complex64;
use std::sync::Arc;

/// Largest accepted number of degrees of freedom.
/// Kind: cap.
pub const MAX_DOF: usize = 1 << 31;

/// Largest accepted number of sectors.
/// Kind: cap.
pub const MAX_SECTORS: usize = 1 << 20;

/// Kind of a matrix of the structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MatrixKind {
    /// Mass matrix M.
    Mass = 0,
    /// Damping matrix C.
    Damping = 1,
    /// Stiffness matrix K.
    Stiffness = 2,
    /// Matrix D of the structural damping iD in harmonics above 0.
    Structural = 3,
    /// Skew-symmetric matrix G of the gyroscopic term ΩG ẋ.
    Gyroscopic = 4,
    /// Matrix K₁ of the stiffness K + Ω²K₁ at speed; negative where rotation softens the structure.
    StiffnessSpeed2 = 5,
}

/// Number of kinds of matrices.
/// Kind: fixed.
pub(crate) const KINDS: usize = 6;

impl MatrixKind {
    /// Name of the matrix in messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Mass => "mass",
            Self::Damping => "damping",
            Self::Stiffness => "stiffness",
            Self::Structural => "structural damping",
            Self::Gyroscopic => "gyroscopic",
            Self::StiffnessSpeed2 => "stiffness_speed2",
        }
    }
}

/// Matrices of a structure, plain (one sector) or cyclic.
#[derive(Clone, Debug)]
pub struct Structure {
    pub(crate) degrees: DegreeMap,
    pub(crate) sectors: usize,
    pub(crate) engine_order: i64,
    /// Blocks of each kind of matrix, shared with copies until one of them changes it.
    pub(crate) blocks: Arc<[Blocks; KINDS]>,
    pub(crate) rayleigh: (f64, f64),
    /// Loss factor η of the stiffness of the structure.
    pub(crate) loss_factor: f64,
    /// Whether the structural matrix contains the loss of a complex stiffness, whose backward waves are unknown where
    /// it is given per diameter.
    pub(crate) loss_of_stiffness: bool,
    /// Speed of rotation Ω.
    pub(crate) speed: Speed,
    /// Modal damping matrices by the residue of the nodal diameter; empty: none.
    pub(crate) modal_damping: Vec<Option<KeptMatrix>>,
    /// Number of sectors and engine order, where this is a whole wheel. Solvers may use its symmetry, but no result
    /// depends on this.
    pub(crate) wheel: Option<(usize, i64)>,
    /// Digest of the sector of which a whole wheel was made; `None` where it is not known, as from bytes of an
    /// earlier version.
    pub(crate) sector: Option<SectorDigest>,
    /// Aerodynamic influence per displacement and per velocity.
    aero: [Option<Arc<AeroInfluence>>; FORMS],
}

impl Structure {
    pub(crate) fn new(ndof: usize, sectors: usize) -> Result<Self> {
        if ndof == 0 || ndof > MAX_DOF {
            return fail!(Dimension, "ndof = {ndof}, needs 1 .. {MAX_DOF}");
        }
        if sectors == 0 || sectors > MAX_SECTORS {
            return fail!(Argument, "sectors = {sectors}, needs 1 .. {MAX_SECTORS}");
        }
        Ok(Self {
            degrees: DegreeMap::identity(ndof),
            sectors,
            engine_order: 0,
            blocks: Arc::default(),
            rayleigh: (0.0, 0.0),
            loss_factor: 0.0,
            loss_of_stiffness: false,
            speed: Speed::Fixed(0.0),
            modal_damping: Vec::new(),
            wheel: None,
            sector: None,
            aero: Default::default(),
        })
    }

    /// Whether the caller gave any damping.
    pub fn is_damped(&self) -> bool {
        self.rayleigh != (0.0, 0.0)
            || self.parts(MatrixKind::Damping).any(|a| !a.is_empty())
            || !self.modal_damping.is_empty()
            || self.has_structural_damping()
            || self.has_complex_stiffness()
            || self.has_aero()
    }

    /// Whether the caller gave damping without a causal law: a loss factor or a structural matrix.
    pub fn has_structural_damping(&self) -> bool {
        self.loss_factor != 0.0 || self.has_structural_matrix()
    }

    /// Whether the caller gave a structural matrix.
    pub fn has_structural_matrix(&self) -> bool {
        self.parts(MatrixKind::Structural).any(|a| !a.is_empty())
    }

    /// Whether the matrices depend on a speed that is not zero.
    pub fn is_rotating(&self) -> bool {
        self.is_gyroscopic()
            || (!matches!(self.speed, Speed::Fixed(0.0) | Speed::PerOmega(0.0))
                && self.parts(MatrixKind::StiffnessSpeed2).any(|a| !a.is_empty()))
    }

    /// Whether gyroscopic forces act.
    pub fn is_gyroscopic(&self) -> bool {
        !matches!(self.speed, Speed::Fixed(0.0) | Speed::PerOmega(0.0))
            && self.parts(MatrixKind::Gyroscopic).any(|a| !a.is_empty())
    }

    /// Whether gyroscopic forces act at a speed that does not follow the frequency of harmonic `h`.
    ///
    /// # Errors
    /// As [`Self::tied_to_frequency`].
    pub fn has_gyroscopic_modes(&self, h: usize) -> Result<bool> {
        Ok(self.is_gyroscopic() && self.tied_to_frequency(Wave::Harmonic(h))?.is_none())
    }

    /// Whether the caller gave damping ratios of modes.
    pub fn has_modal_damping(&self) -> bool {
        !self.modal_damping.is_empty()
    }

    /// Loss factor of the stiffness of the structure.
    pub fn loss_factor(&self) -> f64 {
        self.loss_factor
    }

    /// Whether the caller gave a matrix of this kind, in any form.
    pub fn has(&self, kind: MatrixKind) -> bool {
        self.parts(kind).next().is_some()
    }

    /// The given blocks of a matrix of one kind.
    pub(crate) fn parts(&self, kind: MatrixKind) -> impl Iterator<Item = &KeptMatrix> {
        self.blocks[kind as usize].parts()
    }

    /// A copy that shares the matrices, allocated fallibly.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn try_clone(&self) -> Result<Self> {
        let mut modal_damping = Vec::new();
        for a in &self.modal_damping {
            let copy = a.as_ref().map(KeptMatrix::try_clone).transpose()?;
            try_push(&mut modal_damping, copy, "the modal damping")?;
        }
        Ok(Self {
            degrees: self.degrees.clone(),
            blocks: Arc::clone(&self.blocks),
            modal_damping,
            aero: self.aero.clone(),
            ..*self
        })
    }

    /// The blocks of a matrix to be changed; copied first where others share them.
    pub(crate) fn blocks_mut(&mut self, which: MatrixKind) -> Result<&mut Blocks> {
        if Arc::get_mut(&mut self.blocks).is_none() {
            let mut blocks: [Blocks; KINDS] = Default::default();
            for (copy, own) in blocks.iter_mut().zip(self.blocks.iter()) {
                *copy = own.try_clone()?;
            }
            self.blocks = Arc::new(blocks);
        }
        match Arc::get_mut(&mut self.blocks) {
            Some(blocks) => Ok(&mut blocks[which as usize]),
            None => fail!(Internal, "the matrices of the structure are shared"),
        }
    }

    /// Number of sectors and engine order of the forces, where this is a whole wheel.
    pub fn whole_wheel(&self) -> Option<(usize, i64)> {
        self.wheel
    }

    /// Number of independent degrees of freedom of one sector, the order of its matrices.
    #[must_use]
    pub fn ndof(&self) -> usize {
        self.degrees.independent()
    }

    /// The map from the degrees of freedom of the caller to the independent ones.
    pub fn degrees(&self) -> &DegreeMap {
        &self.degrees
    }

    /// A structure of zero matrices with faces and fixed degrees of freedom.
    pub(crate) fn of_sector(sector: &SectorDescription<'_>) -> Result<Self> {
        let mut structure = Self::new(sector.ndof, sector.sectors)?;
        structure.engine_order = sector.engine_order;
        structure.degrees = DegreeMap::of_sector(sector.ndof, Faces::new(sector)?, sector.fixed)?;
        Ok(structure)
    }

    /// A copy of this structure with further degrees of freedom fixed.
    ///
    /// # Errors
    /// As [`DegreeMap::fixing`].
    pub(crate) fn fixing(&self, dofs: &[usize]) -> Result<Self> {
        self.refuse_modal_damping("degrees of freedom are fixed")?;
        let degrees = self.degrees.fixing(dofs)?;
        let keep = |a: &Option<KeptMatrix>| {
            let kept = |a| KeptMatrix::new(restricted(&self.degrees, &degrees, a)?);
            a.as_ref().map(kept).transpose()
        };
        let mut blocks: [Blocks; KINDS] = Default::default();
        for (new, old) in blocks.iter_mut().zip(self.blocks.iter()) {
            (new.own, new.next, new.previous) = (keep(&old.own)?, keep(&old.next)?, keep(&old.previous)?);
            for a in &old.diameters {
                try_push(&mut new.diameters, keep(a)?, "the matrices per diameter")?;
            }
        }
        Ok(Self {
            degrees,
            blocks: Arc::new(blocks),
            modal_damping: Vec::new(),
            aero: self.aero.clone(),
            ..*self
        })
    }

    /// A copy of this structure with `count` further degrees of freedom, without matrices, after all others.
    ///
    /// # Errors
    /// `Dimension` for too many; `OutOfMemory`.
    pub(crate) fn extended(&self, count: usize) -> Result<Self> {
        let given = self.degrees.given();
        if count > MAX_DOF - given {
            return fail!(
                Dimension,
                "ndof = {}, needs 1 .. {MAX_DOF}",
                given.saturating_add(count)
            );
        }
        let degrees = self.degrees.extended(count)?;
        let wider = |a: &Option<KeptMatrix>| -> Result<Option<KeptMatrix>> {
            let Some(a) = a else { return Ok(None) };
            let mut wide = a.expanded()?;
            let end = wide.values.len();
            for _ in 0..count {
                try_push(&mut wide.col_ptr, end, "the matrices")?;
            }
            (wide.rows, wide.cols) = (wide.rows + count, wide.cols + count);
            Ok(Some(KeptMatrix::new(wide)?))
        };
        let all = |list: &[Option<KeptMatrix>]| -> Result<Vec<Option<KeptMatrix>>> {
            let mut wide = Vec::new();
            for a in list {
                try_push(&mut wide, wider(a)?, "the matrices per diameter")?;
            }
            Ok(wide)
        };
        let mut blocks: [Blocks; KINDS] = Default::default();
        for (new, old) in blocks.iter_mut().zip(self.blocks.iter()) {
            (new.own, new.next, new.previous) = (wider(&old.own)?, wider(&old.next)?, wider(&old.previous)?);
            new.diameters = all(&old.diameters)?;
        }
        Ok(Self {
            degrees,
            blocks: Arc::new(blocks),
            modal_damping: all(&self.modal_damping)?,
            aero: self.aero.clone(),
            ..*self
        })
    }

    /// Aerodynamic influence by its form.
    pub(crate) fn aero(&self) -> &[Option<Arc<AeroInfluence>>; FORMS] {
        &self.aero
    }

    pub(crate) fn aero_mut(&mut self) -> &mut [Option<Arc<AeroInfluence>>; FORMS] {
        &mut self.aero
    }

    /// Number of sectors N; 1 for a plain structure.
    pub fn sectors(&self) -> usize {
        self.sectors
    }

    /// Engine order of the wave.
    pub fn engine_order(&self) -> i64 {
        self.engine_order
    }

    pub(crate) fn set_wave(&mut self, engine_order: i64) {
        self.engine_order = engine_order;
    }

    pub(crate) fn set_rayleigh(&mut self, alpha_mass: f64, beta_stiffness: f64) -> Result<()> {
        for (name, value) in [("alpha_mass", alpha_mass), ("beta_stiffness", beta_stiffness)] {
            if !value.is_finite() {
                return fail!(NotFinite, "Rayleigh damping: {name} = {value}, needs a finite number");
            }
        }
        self.rayleigh = (alpha_mass, beta_stiffness);
        Ok(())
    }

    pub(crate) fn set_loss_factor(&mut self, loss_factor: f64) -> Result<()> {
        if !loss_factor.is_finite() {
            return fail!(NotFinite, "loss_factor = {loss_factor}, needs a finite number >= 0");
        }
        if loss_factor < 0.0 {
            return fail!(
                Argument,
                "loss_factor = {loss_factor}, needs a number >= 0: positive dissipates"
            );
        }
        self.loss_factor = loss_factor;
        Ok(())
    }

    /// Refuses a change of data on which the modes of the modal damping depend.
    pub(crate) fn refuse_modal_damping(&self, change: &str) -> Result<()> {
        if self.modal_damping.is_empty() {
            return Ok(());
        }
        fail!(
            Argument,
            "{change} after the modal damping was set, whose modes depend on it: remove that (n = 0) or set it last"
        )
    }

    /// Refuses to set a matrix on which the modes of the modal damping depend.
    fn refuse_modal_matrix(&self, which: MatrixKind) -> Result<()> {
        match which {
            MatrixKind::Mass => self.refuse_modal_damping("mass is set"),
            MatrixKind::Stiffness => self.refuse_modal_damping("stiffness is set"),
            MatrixKind::Damping | MatrixKind::Structural | MatrixKind::Gyroscopic | MatrixKind::StiffnessSpeed2 => {
                Ok(())
            }
        }
    }

    pub(crate) fn set_own(&mut self, which: MatrixKind, a: &MatrixView<'_>) -> Result<()> {
        Self::refuse_general_mass(which, a)?;
        self.refuse_modal_matrix(which)?;
        self.refuse_diameters(which)?;
        let own = self.copied(which, a)?;
        Self::check_mass(which, a, &own)?;
        if which == MatrixKind::Mass
            && let Some(i) = (0..own.cols).find(|&i| own.get(i, i).re < 0.0)
        {
            return fail!(
                NotPositiveDefinite,
                "mass matrix is not positive semidefinite: mass[{},{}] = {}",
                i + a.index_base,
                i + a.index_base,
                own.get(i, i).re
            );
        }
        if self.degrees.faces().is_some() {
            let blocks = sector_matrices::blocks(&self.degrees, &own, Self::symmetry(which, a))?;
            *self.blocks_mut(which)? = blocks;
        } else {
            let own = KeptMatrix::new(of_independent(&self.degrees, own)?)?;
            self.blocks_mut(which)?.own = Some(own);
        }
        Ok(())
    }

    /// The matrix of a caller's view, after a check of its symmetry.
    fn copied(&self, which: MatrixKind, a: &MatrixView<'_>) -> Result<Csc> {
        if which == MatrixKind::Gyroscopic {
            return a.copy_in_skew(which.name(), self.degrees.given());
        }
        a.copy_in(which.name(), self.degrees.given())
    }

    fn symmetry(which: MatrixKind, a: &MatrixView<'_>) -> Symmetry {
        if which == MatrixKind::Gyroscopic {
            return Symmetry::Skew;
        }
        a.part.symmetry()
    }

    pub(crate) fn set_coupling(&mut self, which: MatrixKind, to_next: &MatrixView<'_>) -> Result<()> {
        let next = KeptMatrix::new(self.coupling(which, to_next)?)?;
        if which == MatrixKind::Gyroscopic {
            let previous = Csc::sum(next.order(), &[(-Complex64::ONE, &next, Form::Transposed)])?;
            self.blocks_mut(which)?.previous = Some(KeptMatrix::new(previous)?);
        }
        self.blocks_mut(which)?.next = Some(next);
        Ok(())
    }

    pub(crate) fn set_coupling_previous(&mut self, which: MatrixKind, to_previous: &MatrixView<'_>) -> Result<()> {
        if which == MatrixKind::Mass || which == MatrixKind::Gyroscopic {
            return fail!(
                Unsupported,
                "{} has a symmetry: its coupling to the previous sector follows from the next one",
                which.name()
            );
        }
        let previous = KeptMatrix::new(self.coupling(which, to_previous)?)?;
        self.blocks_mut(which)?.previous = Some(previous);
        Ok(())
    }

    /// Copies a coupling block, which is a general matrix whatever part the view declares.
    fn coupling(&self, which: MatrixKind, a: &MatrixView<'_>) -> Result<Csc> {
        if self.sectors == 1 {
            return fail!(
                Unsupported,
                "a plain structure has no neighbouring sector; use a cyclic model"
            );
        }
        self.refuse_modal_matrix(which)?;
        self.refuse_faces(which)?;
        self.refuse_diameters(which)?;
        let part = match a.part {
            Part::Full | Part::Symmetric => Part::General,
            other => other,
        };
        let given = a.part(part).copy_in(which.name(), self.degrees.given())?;
        of_independent(&self.degrees, given)
    }

    pub(crate) fn set_diameter(&mut self, which: MatrixKind, diameter: i64, a: &MatrixView<'_>) -> Result<()> {
        Self::refuse_general_mass(which, a)?;
        self.refuse_modal_matrix(which)?;
        self.check_diameter(diameter)?;
        let blocks = &self.blocks[which as usize];
        if blocks.own.is_some() || blocks.next.is_some() || blocks.previous.is_some() {
            return fail!(
                Argument,
                "{} was given by sector blocks; it cannot be given per nodal diameter too",
                which.name()
            );
        }
        self.refuse_faces(which)?;
        let matrix = self.copied(which, a)?;
        Self::check_mass(which, a, &matrix)?;
        let matrix = KeptMatrix::new(of_independent(&self.degrees, matrix)?)?;
        let residue = diameter.rem_euclid(self.sectors as i64) as usize;
        // Without negative diameters the list ends at N/2.
        let length = if residue > self.sectors / 2 {
            self.sectors
        } else {
            self.sectors / 2 + 1
        };
        let blocks = self.blocks_mut(which)?;
        while blocks.diameters.len() < length {
            try_push(&mut blocks.diameters, None, "the matrices per diameter")?;
        }
        blocks.diameters[residue] = Some(matrix);
        Ok(())
    }

    fn refuse_faces(&self, which: MatrixKind) -> Result<()> {
        if self.degrees.faces().is_none() {
            return Ok(());
        }
        fail!(
            Unsupported,
            "{} of a sector with faces: its couplings follow from the matrix of the sector, which is the only one to set",
            which.name()
        )
    }

    fn refuse_diameters(&self, which: MatrixKind) -> Result<()> {
        if self.blocks[which as usize].diameters.is_empty() {
            return Ok(());
        }
        fail!(
            Argument,
            "{} was given per nodal diameter; it cannot be given by sector blocks too",
            which.name()
        )
    }

    /// Refuses a symmetric mass matrix with complex entries.
    fn check_mass(which: MatrixKind, a: &MatrixView<'_>, copied: &Csc) -> Result<()> {
        if which == MatrixKind::Mass
            && a.part.symmetry() == Symmetry::Plain
            && copied.values.iter().any(|v| v.im != 0.0)
        {
            return fail!(
                NotHermitian,
                "mass must be real symmetric or Hermitian, but was passed as complex SYMMETRIC"
            );
        }
        Ok(())
    }

    fn refuse_general_mass(which: MatrixKind, a: &MatrixView<'_>) -> Result<()> {
        if which == MatrixKind::Mass && a.part == Part::General {
            return fail!(
                NotHermitian,
                "mass must be symmetric or Hermitian, but was passed as GENERAL"
            );
        }
        Ok(())
    }
}
