//! The wheel as a plain model: all of its sectors with their contacts, springs and forces.
//!
//! Degree of freedom i of sector s (from 0) is s·n + i, contact c of it is s·m + c, with n degrees of freedom and m contacts
//! a sector. The right face of a sector with faces is moved by the left one of the next, and both are in the frame of their own
//! sector. Forces lag with the engine order, so that the wheel without mistuning moves as the wave of the sector
//! (Castanier & Pierre 2006, doi:10.2514/1.16345).

use crate::contact::Contact;
use crate::error::{Result, fail, try_push};
use crate::interrupt::Interrupt;
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;
use crate::linalg::sparse_storage::sparse::{Csc, Form, Symmetry};
use crate::model::excitation::Force;
use crate::model::matrices::aero::AeroForm;
use crate::model::matrices::degree_map::DegreeMap;
use crate::model::matrices::speed::SpeedLoad;
use crate::model::matrices::spring::Spring;
use crate::model::matrices::structure::{MAX_DOF, MatrixKind, Structure};
use crate::model::{Model, copy};
use num_complex::Complex64;

const CONTEXT: &str = "the wheel";

/// Difference of mirrored entries, relative to the largest, that a transform over diameters leaves.
/// Kind: rounding.
const TRANSFORM_ROUNDING: f64 = 1e-12;

const KINDS: [MatrixKind; 6] = [
    MatrixKind::Mass,
    MatrixKind::Damping,
    MatrixKind::Stiffness,
    MatrixKind::Structural,
    MatrixKind::Gyroscopic,
    MatrixKind::StiffnessSpeed2,
];

/// The whole wheel of a cyclic model as a plain one, a model for every analysis.
pub(crate) fn wheel(model: &Model) -> Result<Model> {
    let interrupt = Interrupt::none();
    check_axes(model)?;
    let (n, sectors) = (model.ndof(), model.structure().sectors());
    let mut wheel = Model::new(1)?;
    wheel.structure = whole(model.structure(), &interrupt)?;
    wheel.structure.sector = Some(model.sector_digest());
    for s in 0..sectors {
        for contact in model.contacts() {
            try_push(&mut wheel.contacts, placed(contact, s, n, sectors)?, CONTEXT)?;
        }
        for spring in model.springs() {
            let next = neighbour(s, spring.sector_offset, sectors);
            let spring = Spring {
                dof_a: spring.dof_a.map(|dof| s * n + dof),
                dof_b: spring.dof_b.map(|dof| next * n + dof),
                sector_offset: 0,
                ..*spring
            };
            try_push(&mut wheel.springs, spring, CONTEXT)?;
        }
        for load in model.speed_loads() {
            let load = SpeedLoad {
                contact: s * model.contacts().len() + load.contact,
                ..*load
            };
            try_push(&mut wheel.speed_loads, load, CONTEXT)?;
        }
        for force in model.excitation().forces() {
            let force = Force {
                dof: s * n + force.dof,
                value: force.value * model.structure().phase(force.harmonic, s as i64),
                ..*force
            };
            wheel.excitation.restore(n * sectors, force)?;
        }
    }
    Ok(wheel)
}

/// Refuses contacts with a sector whose Cartesian axes are turned: the side in that sector would need its own
/// direction.
fn check_axes(model: &Model) -> Result<()> {
    let Some(faces) = model.structure().degrees().faces() else {
        return Ok(());
    };
    let contacts = model.contacts().iter().enumerate();
    let contacts = contacts
        .filter(|(_, contact)| contact.dof_b.iter().any(Option::is_some))
        .map(|(i, contact)| ("contact", i, contact.sector_offset));
    let springs = model.springs().iter().enumerate();
    let springs = springs
        .filter(|(_, spring)| spring.dof_b.is_some())
        .map(|(i, spring)| ("spring", i, spring.sector_offset));
    for (what, i, offset) in contacts.chain(springs) {
        if faces.turn_of(offset).is_some() {
            return fail!(
                Unsupported,
                "the wheel of a sector whose {what} {i} has sector_offset = {offset} in a Cartesian frame, whose axes are \
                 turned there; use a cylindrical frame"
            );
        }
    }
    Ok(())
}

/// The structure of all sectors, with its matrices.
fn whole(structure: &Structure, interrupt: &Interrupt<'_>) -> Result<Structure> {
    let sectors = structure.sectors();
    if sectors == 1 {
        return fail!(
            Unsupported,
            "a plain structure has no sectors to make a wheel of; use a cyclic model"
        );
    }
    let given = structure.degrees().given();
    let Some(ndof) = given.checked_mul(sectors).filter(|&all| all <= MAX_DOF) else {
        return fail!(
            Dimension,
            "a wheel of {sectors} sectors with {given} degrees of freedom, needs at most {MAX_DOF} in all"
        );
    };
    let mut wheel = Structure::new(ndof, 1)?;
    if let Some(fixed) = structure.degrees().fixed() {
        let mut all = Vec::new();
        for _ in 0..sectors {
            for &fixed in fixed {
                try_push(&mut all, fixed, CONTEXT)?;
            }
        }
        wheel.degrees = match structure.degrees().faces() {
            None => DegreeMap::new(all, None)?,
            Some(faces) => DegreeMap::of_wheel(all, faces.try_clone()?, given)?,
        };
    }
    let aero_stiffness = structure.has_aero_stiffness();
    if aero_stiffness && (structure.rayleigh.1 != 0.0 || structure.loss_factor != 0.0) {
        return fail!(
            Unsupported,
            "the wheel of a sector with aerodynamic forces per displacement and damping by its stiffness; give the \
             damping matrix"
        );
    }
    let ring = structure.around_ring()?;
    for kind in KINDS {
        if let Some(a) = all_around(&ring, kind, interrupt)? {
            wheel.blocks_mut(kind)?.own = Some(KeptMatrix::new(a)?);
        }
    }
    wheel.wheel = Some((sectors, structure.engine_order));
    wheel.rayleigh = structure.rayleigh;
    wheel.loss_factor = structure.loss_factor;
    wheel.loss_of_stiffness = structure.loss_of_stiffness;
    wheel.speed = structure.speed;
    Ok(wheel)
}

/// A copy whose wave repeats only after all sectors.
pub(crate) fn around_ring(structure: &Structure) -> Result<Structure> {
    let mut ring = structure.try_clone()?;
    ring.engine_order = 1;
    Ok(ring)
}

/// A matrix of all sectors of [`Structure::around_ring`] with its aerodynamic and modal parts; `None` where it is zero.
fn all_around(structure: &Structure, kind: MatrixKind, interrupt: &Interrupt<'_>) -> Result<Option<Csc>> {
    let n = structure.ndof() * structure.sectors();
    let mut parts = Vec::new();
    if structure.has(kind) {
        let a = structure.given_around(kind, interrupt)?;
        let per_diameter = !structure.blocks[kind as usize].diameters.is_empty();
        let a = if per_diameter {
            symmetrised(a, TRANSFORM_ROUNDING)?
        } else {
            a
        };
        try_push(&mut parts, a, CONTEXT)?;
    }
    let form = match kind {
        MatrixKind::Damping => Some(AeroForm::Velocity),
        MatrixKind::Stiffness => Some(AeroForm::Displacement),
        _ => None,
    };
    if let Some(form) = form
        && let Some(a) = structure.aero_around(form, interrupt)?
    {
        try_push(&mut parts, a, CONTEXT)?;
    }
    if kind == MatrixKind::Damping && structure.has_modal_damping() {
        let a = structure.blocks_of_waves(Structure::modal_damping_of_diameter, interrupt)?;
        try_push(&mut parts, symmetrised(a, TRANSFORM_ROUNDING)?, CONTEXT)?;
    }
    let mut terms = Vec::new();
    for a in &parts {
        try_push(&mut terms, (Complex64::ONE, a, Form::Plain), CONTEXT)?;
    }
    Ok(match parts.len() {
        0 => None,
        _ => Some(Csc::sum(n, &terms)?),
    })
}

/// The matrix made exactly symmetric, where only `rounding`, relative to its largest entry, keeps it from being so.
pub(crate) fn symmetrised(a: Csc, rounding: f64) -> Result<Csc> {
    let (_, _, gap) = a.worst_pair(Symmetry::Plain);
    if gap > rounding * a.max_abs() {
        return Ok(a);
    }
    let half = Complex64::new(0.5, 0.0);
    Csc::sum(a.cols, &[(half, &a, Form::Plain), (half, &a, Form::Transposed)])
}

/// Index of the sector at a distance from sector s.
fn neighbour(s: usize, offset: i64, sectors: usize) -> usize {
    (s as i128 + i128::from(offset)).rem_euclid(sectors as i128) as usize
}

/// Copy of a contact for sector s of the wheel.
fn placed(contact: &Contact, s: usize, n: usize, sectors: usize) -> Result<Contact> {
    let next = neighbour(s, contact.sector_offset, sectors);
    let mut placed = copy(contact)?;
    placed.dof_a = contact.dof_a.map(|dof| dof.map(|dof| s * n + dof));
    placed.dof_b = contact.dof_b.map(|dof| dof.map(|dof| next * n + dof));
    placed.sector_offset = 0;
    for dof in &mut placed.dofs {
        *dof += s * n;
    }
    let rotations = placed.rigid.iter_mut().flat_map(|rigid| &mut rigid.rotations);
    for dof in rotations.flatten() {
        *dof += s * n;
    }
    Ok(placed)
}
