//! A model on few motions: the degrees of freedom on which contacts act, which remain as they are, and modes of the
//! structure with all contacts stuck, for each nodal diameter its own.
//!
//! Contacts keep their description, because their degrees of freedom are coordinates of the small model; its matrices
//! are those of the shapes, T(d)ᴴ A(d) T(d) for the diameter d, and so is its motion, x_s = Σ_d T(d) q_d e^{−2πids/N}.

use crate::contact::Role;
use crate::error::{Result, fail, try_copy, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;
use crate::linalg::sparse_storage::sparse::{Csc, Form, Symmetry};
use crate::model::Model;
use crate::model::excitation::Excitation;
use crate::model::few_motions::reduced_wave::KeptWaves;
use crate::model::few_motions::shape_basis::ShapeBasis;
use crate::model::few_motions::stuck_shapes::StuckShapes;
use crate::model::matrices::blocks::Blocks;
use crate::model::matrices::structure::{KINDS, MatrixKind, Structure};
use num_complex::Complex64;
use std::sync::Arc;

/// Deviation from a Hermitian matrix, relative to its largest entry, that is rounding.
/// Kind: rounding.
const ON_MODES_HERMITIAN: f64 = 1e-12;

const CONTEXT: &str = "the model on modes";

/// Shapes of all diameters of a wave or of the wheel.
pub(crate) struct ShapesOfWaves {
    /// Independent degrees of freedom of the contacts, ascending.
    pub held: Vec<usize>,
    /// Shapes by nodal diameter 0 ..= N/2; the waves of the other sense have the conjugate shapes. `None` where no
    /// perturbation has the diameter.
    shapes: Vec<Option<StuckShapes>>,
    /// Number of shapes of each diameter that come from forces, or modes in their place.
    loads: usize,
    /// Number of modes that were requested for each diameter.
    requested: usize,
}

/// A model reduced to its contacts' degrees of freedom and some modes.
pub(crate) struct OnModes {
    /// The reduced model, without forces.
    pub model: Model,
    of: Arc<ShapesOfWaves>,
    /// The shapes by nodal diameter.
    bases: Vec<Option<ShapeBasis>>,
}

impl ShapesOfWaves {
    /// Shapes with at most `modes` modes in each nodal diameter that is a multiple of `step`.
    ///
    /// # Errors
    /// As [`StuckShapes::new`].
    pub fn new(model: &Model, step: usize, modes: usize, interrupt: &Interrupt<'_>) -> Result<Self> {
        let structure = model.structure();
        structure.check_senses()?;
        let held = degrees_of_contacts(model)?;
        let forces = forces_of_waves(model)?;
        let of = |diameter: usize| {
            forces
                .iter()
                .filter(move |(d, _)| *d == diameter)
                .map(|(_, force)| force)
        };
        let count = |diameter: usize| of(diameter).count() * if is_own_mirror(structure, diameter) { 2 } else { 1 };
        let loads = (0..=structure.sectors() / 2).map(count).max().unwrap_or(0);
        let mut shapes = Vec::new();
        for diameter in 0..=structure.sectors() / 2 {
            let own = if diameter % step == 0 {
                let mut forces = Vec::new();
                for force in of(diameter) {
                    try_push(&mut forces, try_copy(force, CONTEXT)?, CONTEXT)?;
                }
                let all = modes + loads;
                Some(StuckShapes::new(
                    model,
                    diameter as i64,
                    (&held, &forces),
                    all,
                    interrupt,
                )?)
            } else {
                None
            };
            try_push(&mut shapes, own, CONTEXT)?;
        }
        // Contacts on all degrees of freedom leave no room for other shapes.
        let room = shapes.iter().flatten().map(StuckShapes::modes).min().unwrap_or(0);
        Ok(Self {
            held,
            shapes,
            loads: loads.min(room),
            requested: modes,
        })
    }

    fn all(&self) -> impl Iterator<Item = &StuckShapes> {
        self.shapes.iter().flatten()
    }

    /// Number of modes available for every diameter.
    pub fn modes(&self) -> usize {
        let least = self.all().map(StuckShapes::modes).min().unwrap_or(0);
        least.saturating_sub(self.loads)
    }

    /// Whether some diameter has no further modes.
    pub fn is_complete(&self) -> bool {
        self.modes() < self.requested
    }

    /// Largest number of modes of one diameter below an angular frequency.
    pub fn modes_below(&self, omega: f64) -> usize {
        let below = |shapes: &StuckShapes| shapes.omega.iter().filter(|&&x| x < omega).count();
        self.all().map(below).max().unwrap_or(0)
    }
}

/// Independent degrees of freedom on which contacts act, ascending.
pub(crate) fn degrees_of_contacts(model: &Model) -> Result<Vec<usize>> {
    let structure = model.structure();
    let mut moves = try_vec(structure.ndof(), false, CONTEXT)?;
    for contact in model.contacts().iter().filter(|c| c.role() != Role::Inert) {
        for k in 0..contact.directions() {
            for term in structure.contact_motion(contact, k).terms() {
                moves[term.dof] = true;
            }
        }
    }
    let mut held = Vec::new();
    for dof in (0..moves.len()).filter(|&dof| moves[dof]) {
        try_push(&mut held, dof, CONTEXT)?;
    }
    Ok(held)
}

/// Whether a wave is its own mirror image: its matrices and shapes are real.
fn is_own_mirror(structure: &Structure, diameter: usize) -> bool {
    (2 * diameter).is_multiple_of(structure.sectors())
}

/// Amplitudes of the forces on the independent degrees of freedom, with their harmonics.
pub(crate) fn forces_of_harmonics(model: &Model) -> Result<Vec<(usize, Vec<Complex64>)>> {
    let mut found: Vec<(usize, Vec<Complex64>)> = Vec::new();
    for f in model.excitation().forces() {
        if found.iter().any(|(harmonic, _)| *harmonic == f.harmonic) {
            continue;
        }
        let mut force = try_vec(model.structure().ndof(), Complex64::ZERO, CONTEXT)?;
        model.add_forces_to(f.harmonic, 1.0, &mut force);
        try_push(&mut found, (f.harmonic, force), CONTEXT)?;
    }
    Ok(found)
}

/// Amplitudes of the forces on the independent degrees of freedom, with their nodal diameters, for the wave in which
/// sector s + 1 lags.
fn forces_of_waves(model: &Model) -> Result<Vec<(usize, Vec<Complex64>)>> {
    let mut found = forces_of_harmonics(model)?;
    for (number, force) in &mut found {
        let (diameter, backward) = model.structure().wave_of(*number);
        *number = diameter;
        if backward {
            for z in force {
                *z = z.conj();
            }
        }
    }
    Ok(found)
}

impl OnModes {
    /// Reduces `model` to its contacts' degrees of freedom and the first `modes` modes of each diameter.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn new(model: &Model, of: &Arc<ShapesOfWaves>, modes: usize, interrupt: &Interrupt<'_>) -> Result<Self> {
        let order = of.held.len() + of.loads + modes;
        let largest = of.all().fold(0.0_f64, |m, shapes| m.max(shapes.largest()));
        let scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
        let mut bases = Vec::new();
        for shapes in &of.shapes {
            let modal = order - of.held.len();
            let own = |shapes: &StuckShapes| shapes.basis(&of.held, modal, scale, interrupt);
            try_push(&mut bases, shapes.as_ref().map(own).transpose()?, CONTEXT)?;
        }
        let plain = model.structure().sectors() == 1;
        let mut blocks: [Blocks; KINDS] = Default::default();
        for which in [MatrixKind::Mass, MatrixKind::Damping, MatrixKind::Stiffness] {
            let to = &mut blocks[which as usize];
            for (shapes, basis) in of.shapes.iter().zip(&bases) {
                let matrix = match (shapes, basis) {
                    (Some(shapes), Some(basis)) => Some(KeptMatrix::new(basis.projected(
                        which,
                        shapes.matrix(which),
                        interrupt,
                    )?)?),
                    _ => None,
                };
                if plain {
                    to.own = matrix;
                } else {
                    try_push(&mut to.diameters, matrix, CONTEXT)?;
                }
            }
            add_other_senses(&mut to.diameters, model.structure().sectors())?;
        }
        let mut small = model.try_clone()?;
        small.structure = on_shapes(&small.structure, &of.held, order, blocks)?;
        small.springs.clear();
        small.excitation = Excitation::default();
        small.kept = KeptWaves::default();
        Ok(Self {
            model: small,
            of: Arc::clone(of),
            bases,
        })
    }

    /// Number of modes used for each diameter.
    pub fn modes(&self) -> usize {
        self.model.structure().ndof() - self.of.held.len() - self.of.loads
    }

    /// Shapes and matrices for the nodal diameter of a harmonic; and whether the harmonic belongs to the conjugate
    /// wave.
    fn wave(&self, harmonic: usize) -> Result<(&ShapeBasis, &StuckShapes, bool)> {
        let structure = self.model.structure();
        let (diameter, backward) = structure.wave_of(harmonic);
        match (self.bases.get(diameter), self.of.shapes.get(diameter)) {
            (Some(Some(basis)), Some(Some(shapes))) => Ok((basis, shapes, backward)),
            _ => fail!(Internal, "no shapes of nodal diameter {diameter}"),
        }
    }

    /// The forces of `model` on the coordinates of this sector: each harmonic with the amplitudes of all coordinates.
    pub fn forces(&self, model: &Model) -> Result<Vec<(usize, Vec<Complex64>)>> {
        let mut found = forces_of_harmonics(model)?;
        for (harmonic, force) in &mut found {
            let (basis, _, backward) = self.wave(*harmonic)?;
            let mut own = try_vec(self.model.structure().ndof(), Complex64::ZERO, CONTEXT)?;
            basis.forces(force, backward, &mut own);
            *force = own;
        }
        Ok(found)
    }

    /// Turns harmonics of the independent degrees of freedom into those of the coordinates, harmonic by harmonic.
    pub fn coordinates(&self, n: usize, harmonics: &[Complex64]) -> Result<Vec<Complex64>> {
        let order = self.model.structure().ndof();
        let mut found = try_vec(harmonics.len() / n * order, Complex64::ZERO, CONTEXT)?;
        let rows = found.chunks_exact_mut(order).zip(harmonics.chunks_exact(n));
        for (h, (to, from)) in rows.enumerate() {
            let (basis, shapes, backward) = self.wave(h)?;
            let mass = shapes.matrix(MatrixKind::Mass);
            basis.coordinates((mass, &self.of.held), from, backward, to)?;
        }
        Ok(found)
    }

    /// Turns harmonics of the coordinates into those of the independent degrees of freedom.
    pub fn motion(&self, n: usize, coordinates: &[Complex64]) -> Result<Vec<Complex64>> {
        let order = self.model.structure().ndof();
        let mut found = try_vec(coordinates.len() / order * n, Complex64::ZERO, CONTEXT)?;
        let rows = found.chunks_exact_mut(n).zip(coordinates.chunks_exact(order));
        for (h, (to, from)) in rows.enumerate() {
            let (basis, _, backward) = self.wave(h)?;
            basis.motion(from, backward, to);
        }
        Ok(found)
    }
}

/// Adds the matrices for the other sense of travel, which are the conjugates, where a matrix is not Hermitian:
/// otherwise it could be taken for a loss, whose matrix for the other sense is the transpose.
fn add_other_senses(diameters: &mut Vec<Option<KeptMatrix>>, sectors: usize) -> Result<()> {
    let has_symmetry = |a: &KeptMatrix| a.worst_pair(Symmetry::Hermitian).2 <= ON_MODES_HERMITIAN * a.max_abs();
    if diameters.iter().flatten().all(has_symmetry) {
        return Ok(());
    }
    for residue in sectors / 2 + 1..sectors {
        let of_mirror = |a: &KeptMatrix| {
            let terms = [(Complex64::ONE, a, Form::Conjugated)];
            KeptMatrix::new(Csc::sum(a.order(), &terms)?)
        };
        let other = diameters[sectors - residue].as_ref().map(of_mirror).transpose()?;
        try_push(diameters, other, CONTEXT)?;
    }
    Ok(())
}

/// A structure of the given order whose first degrees of freedom are those of `held`, with the given matrices,
/// which contain all damping and stiffness.
fn on_shapes(structure: &Structure, held: &[usize], order: usize, blocks: [Blocks; KINDS]) -> Result<Structure> {
    let mut small = Structure::new(order, structure.sectors())?;
    small.degrees = structure.degrees().retaining(held, order)?;
    small.engine_order = structure.engine_order();
    small.blocks = Arc::new(blocks);
    Ok(small)
}

/// The nodal diameter of a harmonic.
pub(crate) fn wave_of(structure: &Structure, harmonic: usize) -> (usize, bool) {
    let turns = i128::from(harmonic as u64) * i128::from(structure.engine_order());
    structure.fold(turns.rem_euclid(structure.sectors() as i128) as i64)
}
