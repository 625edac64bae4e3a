//! Computes the modes of waves, each once; see [`crate::condense::by_modes::wave_modes`].

use crate::condense::blocks::harmonic_block::{Artificial, Values};
use crate::condense::by_modes::few_directions::few_directions;
use crate::condense::by_modes::modal_rows::ModalRows;
use crate::condense::by_modes::quadratic_poles;
use crate::condense::by_modes::soft_store::SoftStore;
use crate::condense::by_modes::sum_terms::Source;
use crate::condense::by_modes::wave_modes::{WaveModes, proportional};
use crate::condense::by_modes::wave_poles::WavePoles;
use crate::condense::on_a_basis::basis_outlook::{SweepTables, are_all_modes_quicker};
use crate::condense::{Condensed, FlexibilityWay, HarmonicBlock};
use crate::error::{Result, Status, try_copy, try_push};
use crate::interrupt::Interrupt;
use crate::linalg::dense::complex_products::LOOPS_UP_TO;
use crate::linalg::iterative::refined_modes;
use crate::linalg::sparse_storage::sparse::{Csc, Form};
use crate::model::Model;
use crate::model::few_motions::reduced_wave::MotionRow;
use crate::model::matrices::structure::MatrixKind;
use crate::model::matrices::wave::Wave;
use crate::options::Range;
use num_complex::Complex64;
use std::cell::Cell;
use std::sync::Arc;

/// Degrees of freedom up to which all modes are computed where other harmonics than those of one sweep may need them: they take as long as
/// three to twelve complex factorisations.
/// Kind: tuned; measured on: not recorded.
pub(crate) const ALL_UP_TO: usize = 600;

/// The same of one sweep with fixed harmonics.
/// Kind: tuned; measured on: chains of 99 to 219 with 1 to 30 contacts.
const ALL_OF_FEW_UP_TO: usize = 100;

/// The same of a structure on a basis, whose matrices are full, so that a factorisation at each frequency costs n³ as its modes do: a sweep
/// over a sector with 61 contacts in a plane has 736 to 920 coordinates.
/// Kind: tuned; measured on: not recorded.
const ALL_OF_BASIS_UP_TO: usize = 1_200;

/// The same where they take less time than the factors of a sweep, as of grids without a basis.
/// Kind: cap; their matrices are full, 64 MB
/// each.
const ALL_BESIDE_DEAR_FACTORS_UP_TO: usize = 2_000;

const CONTEXT: &str = "the modes of the structure";

/// Modes or poles of a wave, or the reason why it has none.
type Found = core::result::Result<Source, FlexibilityWay>;

/// Modes and poles of the waves computed so far.
#[derive(Default)]
pub struct WaveCache {
    waves: Vec<Arc<WaveModes>>,
    /// Matrices of blocks whose modes were requested, which other blocks may share.
    blocks: Vec<KnownBlock>,
    poles: Vec<Arc<WavePoles>>,
    /// Whether a wave without modes was met, so that others have none; the reason why a wave has no poles; and
    /// whether a wave has too many directions of damping beside αM + βK.
    has_no_modes: bool,
    without_poles: Option<FlexibilityWay>,
    has_many_dampers: bool,
    /// The range of the one sweep with the harmonics of its model that the modes serve; `None` where they serve more.
    sweep: Option<Range>,
}

/// Z_κ at zero frequency and M of a block, with the modes of its wave.
struct KnownBlock {
    reference: Arc<Csc>,
    mass: Values,
    modes: Arc<WaveModes>,
}

/// Waves of one model, and the rows of its contacts in them, shared by condensed models with different harmonics.
#[derive(Default)]
pub struct SharedWaves {
    waves: Cell<WaveCache>,
    rows: Cell<Vec<Arc<ModalRows>>>,
}

impl SharedWaves {
    /// Waves that serve one sweep over a range with the harmonics of its model alone, so that modes must take less time than its
    /// factors.
    pub fn of_one_sweep(range: Range) -> Self {
        let waves = WaveCache {
            sweep: Some(range),
            ..WaveCache::default()
        };
        Self {
            waves: Cell::new(waves),
            ..Self::default()
        }
    }

    /// The condensed model with the modes of its waves, as [`Condensed::attach_modes`].
    pub fn attach(&self, model: &Model, mut condensed: Condensed, interrupt: &Interrupt<'_>) -> Result<Condensed> {
        let mut waves = self.waves.take();
        let attached = condensed.attach_modes(model, &mut waves, interrupt);
        self.waves.set(waves);
        attached.map(|()| condensed)
    }

    /// The modes of the i-th carried harmonic, as [`WaveCache::of`].
    pub fn of(&self, model: &Model, condensed: &Condensed, i: usize, interrupt: &Interrupt<'_>) -> Result<Found> {
        let mut waves = self.waves.take();
        let found = waves.of(model, condensed, i, interrupt);
        self.waves.set(waves);
        found
    }

    /// The rows of the contacts in the modes of a wave, as [`ModalRows::shared`].
    pub fn rows(&self, at: (&Condensed, usize, usize), source: Source) -> Result<Arc<ModalRows>> {
        let mut known = self.rows.take();
        let rows = ModalRows::shared(at, source, &mut known);
        self.rows.set(known);
        rows
    }

    /// Whether some wave has modes; `None` as long as no wave was asked for.
    pub fn some_have_modes(&self) -> Option<bool> {
        let waves = self.waves.take();
        let known = !waves.waves.is_empty() || !waves.poles.is_empty();
        let refused = waves.is_refused();
        self.waves.set(waves);
        (refused || known).then_some(known)
    }
}

impl WaveCache {
    /// Number of waves with modes.
    #[cfg(test)]
    pub(crate) fn count(&self) -> usize {
        self.waves.len()
    }

    /// Whether the waves of this model have neither modes nor poles.
    pub fn is_refused(&self) -> bool {
        self.has_no_modes && self.without_poles.is_some()
    }

    /// Modes of the i-th carried harmonic; its poles where damping couples the modes; or the reason why it has
    /// neither.
    pub fn of(&mut self, model: &Model, condensed: &Condensed, i: usize, interrupt: &Interrupt<'_>) -> Result<Found> {
        let block = &condensed.blocks()[i];
        if block.number == 0 {
            return Ok(Err(FlexibilityWay::SingleFrequency));
        }
        if !self.has_no_modes {
            if let Some(modes) = self.modes((model, condensed, i), false, interrupt)? {
                return Ok(Ok(Source::Modes(modes)));
            }
            self.has_no_modes = true;
        }
        // The search for poles may take more of the stack than the small thread of a small model has.
        if condensed.ndof() <= LOOPS_UP_TO {
            self.without_poles = Some(FlexibilityWay::Few);
        } else if !matches!(block.matrices.artificial, Artificial::None) {
            // Poles would follow the damping ratio of a nonlinear mode; directions of damping do not.
            if let Some(modes) = self.beside_dampers((model, condensed, i), interrupt)? {
                return Ok(Ok(Source::Modes(modes)));
            }
        }
        if let Some(reason) = self.without_poles {
            return self.with_dampers((model, condensed, i), reason, interrupt);
        }
        if let Some(poles) = self.poles.iter().find(|poles| quadratic_poles::are_of(poles, block)) {
            return Ok(Ok(Source::Poles(Arc::clone(poles))));
        }
        let poles = match quadratic_poles::poles(condensed, i, self.sweep, interrupt)? {
            Ok(poles) => Arc::new(poles),
            Err(reason) => {
                self.without_poles = Some(reason);
                return self.with_dampers((model, condensed, i), reason, interrupt);
            }
        };
        try_push(&mut self.poles, Arc::clone(&poles), CONTEXT)?;
        Ok(Ok(Source::Poles(poles)))
    }

    /// Modes of a harmonic without poles, together with the directions of its damping beside αM + βK; or the reason
    /// why it has none.
    fn with_dampers(
        &mut self,
        at: (&Model, &Condensed, usize),
        reason: FlexibilityWay,
        interrupt: &Interrupt<'_>,
    ) -> Result<Found> {
        if reason == FlexibilityWay::Few {
            return Ok(Err(reason));
        }
        let found = self.beside_dampers(at, interrupt)?;
        Ok(found.map(Source::Modes).ok_or(reason))
    }

    /// Modes of a harmonic whose damping beside αM + βK has few directions; `None` where it has many.
    fn beside_dampers(
        &mut self,
        at: (&Model, &Condensed, usize),
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Arc<WaveModes>>> {
        if self.has_many_dampers {
            return Ok(None);
        }
        let found = self.modes(at, true, interrupt)?;
        self.has_many_dampers = found.is_none();
        Ok(found)
    }

    /// Modes of a harmonic; `None` where damping is not proportional, few further directions being allowed if
    /// `dampers`.
    fn modes(
        &mut self,
        (model, condensed, i): (&Model, &Condensed, usize),
        dampers: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Arc<WaveModes>>> {
        let block = &condensed.blocks()[i];
        let is_same = |known: &&KnownBlock| {
            Arc::ptr_eq(&known.reference, &block.matrices.reference) && Arc::ptr_eq(&known.mass, &block.matrices.mass)
        };
        if let Some(known) = self.blocks.iter().find(is_same) {
            return Ok(Some(Arc::clone(&known.modes)));
        }
        let found = self.find_by_values((model, condensed, i), dampers, interrupt)?;
        if let Some(modes) = &found {
            let known = KnownBlock {
                reference: Arc::clone(&block.matrices.reference),
                mass: Arc::clone(&block.matrices.mass),
                modes: Arc::clone(modes),
            };
            try_push(&mut self.blocks, known, CONTEXT)?;
        }
        Ok(found)
    }

    /// Modes of a block whose matrices share no memory with an earlier one, found by comparing values or computed.
    fn find_by_values(
        &mut self,
        (model, condensed, i): (&Model, &Condensed, usize),
        dampers: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Arc<WaveModes>>> {
        let block = &condensed.blocks()[i];
        let Some((reference, loss_factor)) = elastic_reference(model, condensed, i)? else {
            return Ok(None);
        };
        let is_known = |known: &&Arc<WaveModes>| known.is_of(&reference, &block.matrices.mass, block.next);
        if let Some(known) = self.waves.iter().find(is_known) {
            return Ok(Some(Arc::clone(known)));
        }
        let other = self
            .waves
            .iter()
            .find(|known| known.is_conjugate_of(&reference, &block.matrices.mass));
        if !self.may_have_all((model, condensed, i), &reference, interrupt)? {
            return Ok(None);
        }
        let at = (i, reference, loss_factor, dampers);
        let Some(found) = modes_of(model, condensed, at, other, interrupt)? else {
            return Ok(None);
        };
        let found = Arc::new(found);
        try_push(&mut self.waves, Arc::clone(&found), CONTEXT)?;
        Ok(Some(found))
    }

    /// Whether all modes of a harmonic with this K_κ may be computed: there are few, or they take less time than factors.
    fn may_have_all(
        &self,
        (model, condensed, i): (&Model, &Condensed, usize),
        reference: &Csc,
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let n = condensed.ndof();
        if has_other_terms(model) {
            return Ok(false);
        }
        if condensed.blocks()[i].view.is_some() {
            return Ok(n <= ALL_OF_BASIS_UP_TO);
        }
        let few = if self.sweep.is_some() {
            ALL_OF_FEW_UP_TO
        } else {
            ALL_UP_TO
        };
        if n <= few || n > ALL_BESIDE_DEAR_FACTORS_UP_TO {
            return Ok(n <= few);
        }
        are_all_modes_quicker(reference, condensed.tables_of_sweep(self.sweep, interrupt)?)
    }
}

/// Whether the flexibility of the waves of a structure is a sum over modes along a branch, unless a contact is near-rigid.
pub(crate) fn have_modes(model: &Model) -> Result<bool> {
    if model.structure().ndof() > ALL_UP_TO || has_other_terms(model) {
        return Ok(false);
    }
    let (_, [mass, stiffness, damping]) = on_one_pattern(model)?;
    Ok(proportional([&mass, &stiffness, &damping]).is_some())
}

/// Whether a sweep with at least this many harmonics and motions of contacts takes all modes of a structure that is larger than the
/// general limit for them.
pub(crate) fn are_all_modes_wanted(model: &Model, tables: SweepTables, interrupt: &Interrupt<'_>) -> Result<bool> {
    let n = model.structure().ndof();
    if n > ALL_BESIDE_DEAR_FACTORS_UP_TO || has_other_terms(model) || model.structure().whole_loss_factor()?.is_none() {
        return Ok(false);
    }
    let (pattern, [mass, stiffness, damping]) = on_one_pattern(model)?;
    if !are_all_modes_quicker(&pattern, tables)? {
        return Ok(false);
    }
    let matrices = [&mass[..], &stiffness, &damping];
    if proportional(matrices).is_some() {
        return Ok(true);
    }
    let few = few_directions(&pattern, matrices, model.structure().rayleigh, interrupt)?;
    Ok(few.is_some_and(|few| few.middle.is_none()))
}

/// M, K and C of a travelling wave on one pattern.
fn on_one_pattern(model: &Model) -> Result<(Csc, [Vec<Complex64>; 3])> {
    let structure = model.structure();
    let n = structure.ndof();
    let matrix = |kind| structure.wave_matrix(kind, 1);
    let (mass, stiffness) = (matrix(MatrixKind::Mass)?, matrix(MatrixKind::Stiffness)?);
    let damping = matrix(MatrixKind::Damping)?;
    let pattern = Csc::sum(
        n,
        &[&mass, &stiffness, &damping].map(|of| (Complex64::ZERO, of, Form::Plain)),
    )?;
    let aligned = |of: &Csc| of.aligned(&pattern);
    let values = [aligned(&mass)?, aligned(&stiffness)?, aligned(&damping)?];
    Ok((pattern, values))
}

/// Whether a structure has terms that modes do not contain: a structural damping matrix, aerodynamic forces or
/// rotation.
fn has_other_terms(model: &Model) -> bool {
    let structure = model.structure();
    structure.has_structural_matrix() || structure.has_aero() || structure.is_rotating()
}

/// K_κ with the real part of κ and without the loss in a complex stiffness, and the loss factor of all stiffness; `None` where the loss
/// has another form.
fn elastic_reference(model: &Model, condensed: &Condensed, i: usize) -> Result<Option<(Csc, f64)>> {
    let structure = model.structure();
    let mut reference = condensed.stiffness_with_real_kappa(i)?;
    let block = &condensed.blocks()[i];
    let Some(loss_factor) = structure.whole_loss_factor()? else {
        return Ok(None);
    };
    if structure.has_complex_stiffness() && block.view.is_none() {
        let given = structure
            .wave_matrix(MatrixKind::Stiffness, block.number)?
            .aligned(&reference)?;
        let elastic = block.own_stiffness(model)?;
        for ((k, given), elastic) in reference.values.iter_mut().zip(given).zip(elastic) {
            *k += elastic - given;
        }
    }
    Ok(Some((reference, loss_factor)))
}

/// Modes of the i-th carried harmonic with this K_κ, and with few directions of damping beside αM + βK if `few`;
/// conjugated from the modes of the wave that travels the other way, where these are known.
fn modes_of(
    model: &Model,
    condensed: &Condensed,
    (i, reference, loss_factor, few): (usize, Csc, f64, bool),
    other: Option<&Arc<WaveModes>>,
    interrupt: &Interrupt<'_>,
) -> Result<Option<WaveModes>> {
    let block = &condensed.blocks()[i];
    let n = condensed.ndof();
    let Some(springs) = springs(model, condensed, block)? else {
        return Ok(None);
    };
    let with_springs;
    let is_lossy = model.structure().has_complex_stiffness();
    let own = if springs.is_empty() && block.view.is_none() && !is_lossy {
        &block.matrices.stiffness
    } else {
        with_springs = block.own_stiffness(model)?;
        &with_springs
    };
    let matrices = [&block.matrices.mass[..], own, &block.matrices.damping];
    let modal = block.matrices.modal.as_deref().map_or(&[][..], |modal| modal);
    if !(few || modal.is_empty()) {
        return Ok(None);
    }
    let (proportional, dampers) = match proportional(matrices) {
        Some(found) => (found, Vec::new()),
        None if few => match few_directions(
            &block.matrices.reference,
            matrices,
            model.structure().rayleigh,
            interrupt,
        )? {
            Some(few) if few.middle.is_none() => (few.proportional, few.directions),
            _ => return Ok(None),
        },
        None => return Ok(None),
    };
    let mass = try_copy(&block.matrices.mass, CONTEXT)?;
    let (values, vectors) = if let Some(other) = other {
        let mut vectors = try_copy(&other.vectors, CONTEXT)?;
        for z in &mut vectors {
            *z = z.conj();
        }
        (try_copy(&other.values, CONTEXT)?, vectors)
    } else {
        match refined_modes::modes(&reference, &mass, interrupt) {
            Ok(pairs) if pairs.values.len() == n => (pairs.values, pairs.vectors.data.into()),
            Err(e) if matches!(e.status, Status::OutOfMemory | Status::StoppedByCaller) => return Err(e),
            _ => return Ok(None),
        }
    };
    let mut rows = Vec::new();
    for damper in dampers.iter().chain(modal) {
        try_push(&mut rows, MotionRow::adjoint(damper)?, CONTEXT)?;
    }
    Ok(Some(WaveModes {
        reference,
        mass,
        next: block.next,
        values,
        vectors,
        proportional,
        loss_factor,
        springs,
        dampers: rows,
        soft: SoftStore::default(),
    }))
}

/// Rows of the linear springs and stuck contacts with their stiffness; `None` where the stiffness of one couples its
/// directions.
fn springs(model: &Model, condensed: &Condensed, block: &HarmonicBlock) -> Result<Option<Vec<(MotionRow, f64)>>> {
    let (structure, number) = (model.structure(), block.number);
    let mut rows = Vec::new();
    for s in model.springs() {
        let row = block.row(&structure.row(&structure.spring_motion(s), Wave::Harmonic(number)))?;
        try_push(&mut rows, (row, s.stiffness), CONTEXT)?;
    }
    for &i in &condensed.contact_classes().never_slipping {
        let contact = &model.contacts()[i];
        for k in 0..contact.directions() {
            let couples = |&l: &usize| l != k && contact.stiffness_at_small_motion(k, l) != 0.0;
            if (0..contact.directions()).any(|l| couples(&l)) {
                return Ok(None);
            }
            let row = block.row(&structure.contact_row(contact, k, number))?;
            try_push(&mut rows, (row, contact.stiffness_at_small_motion(k, k)), CONTEXT)?;
        }
    }
    rows.retain(|(_, stiffness)| *stiffness != 0.0);
    Ok(Some(rows))
}
