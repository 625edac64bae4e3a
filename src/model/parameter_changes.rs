//! Changes of a model by the parameters of a design study: constants of contacts, matrices, forces.

use crate::contact::forms::constants::Constant;
use crate::error::{Result, fail};
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;
use crate::linalg::sparse_storage::matrix_view::MatrixView;
use crate::linalg::sparse_storage::sparse::{Csc, Form};
use crate::model::Model;
use crate::model::matrices::blocks::Blocks;
use crate::model::matrices::sector_matrices::{self, of_independent};
use crate::model::matrices::structure::{MatrixKind, Structure};
use num_complex::Complex64;

/// Places the slider of a friction contact before any motion along t1 (`direction` 0) or t2 (1).
pub(crate) fn set_slider(model: &mut Model, id: usize, direction: usize, place: f64) -> Result<()> {
    if direction > 1 {
        return fail!(Index, "direction = {direction}, needs 0 for t1 or 1 for t2");
    }
    model.set_constant(id, Constant::Slider(direction), place)
}

/// Multiplies all forces, unbalance included.
pub(crate) fn scale_forces(model: &mut Model, factor: f64) -> Result<()> {
    check_finite("force", factor)?;
    model.excitation.scale(factor);
    Ok(())
}

/// Multiplies the forces of the fundamental.
pub(crate) fn scale_fundamental(model: &mut Model, factor: f64) -> Result<()> {
    check_finite("force", factor)?;
    model.excitation.scale_harmonic(1, factor);
    Ok(())
}

/// Changes a constant of a contact.
pub(crate) fn set_constant(model: &mut Model, id: usize, constant: Constant, value: f64) -> Result<()> {
    let Some(contact) = model.contacts().get(id) else {
        return fail!(Index, "contact id = {id}, but the model has {}", model.contacts().len());
    };
    if contact.by_constant(constant).is_none() {
        return fail!(
            Unsupported,
            "{} of contact {id}, but that is a {}, which has none",
            constant.name(),
            contact.law_name()
        );
    }
    if let Constant::Slider(_) = constant {
        let changed = contact.clone().with(constant, value)?;
        changed.check_constants()?;
        if let Some(place) = model.contact_mut(id) {
            *place = changed;
        }
        return Ok(());
    }
    let load = model.speed_loads().iter().find(|load| load.contact == id).copied();
    if let (Constant::Preload, Some(load)) = (constant, &load) {
        return model.set_preload_at_speed(id, value, load.per_speed2);
    }
    let changed = contact.clone().with(constant, value)?;
    changed.check_constants()?;
    changed.check_stiffness()?;
    if let Some(place) = model.contact_mut(id) {
        *place = changed;
    }
    if load.is_some() {
        if constant == Constant::Gap {
            for load in model.speed_loads_mut().iter_mut().filter(|load| load.contact == id) {
                load.gap = value;
            }
        }
        model.apply_speed();
    }
    Ok(())
}

/// Adds a multiple of a matrix to the mass, damping or stiffness matrix, in a cyclic model to the sector's own block,
/// which is a part of the matrices of all nodal diameters.
pub(crate) fn add_direction(
    model: &mut Model,
    which: MatrixKind,
    direction: &MatrixView<'_>,
    factor: f64,
) -> Result<()> {
    check_finite(which.name(), factor)?;
    if factor == 0.0 {
        return Ok(());
    }
    add_to_structure(model.changed_structure(), which, direction, factor)
}

/// Multiplies the mass, damping or stiffness matrix with its couplings.
pub(crate) fn scale_matrix(model: &mut Model, which: MatrixKind, factor: f64) -> Result<()> {
    check_finite(which.name(), factor)?;
    if factor.to_bits() == 1.0_f64.to_bits() {
        return Ok(());
    }
    scale_structure(model.changed_structure(), which, factor)
}

/// A copy with its own list of reduced waves.
pub(crate) fn separate_clone(model: &Model) -> Result<Model> {
    let mut copy = model.try_clone()?;
    copy.kept = model.kept.separate()?;
    Ok(copy)
}

fn add_to_structure(
    structure: &mut Structure,
    which: MatrixKind,
    direction: &MatrixView<'_>,
    factor: f64,
) -> Result<()> {
    let given = direction.copy_in("direction", structure.degrees.given())?;
    let added = if structure.degrees.faces().is_some() {
        sector_matrices::blocks(&structure.degrees, &given, direction.part.symmetry())?
    } else {
        Blocks {
            own: Some(KeptMatrix::new(of_independent(&structure.degrees, given)?)?),
            ..Blocks::default()
        }
    };
    let n = structure.ndof();
    let blocks = structure.blocks_mut(which)?;
    if blocks.diameters.is_empty() {
        // A coupling to the previous sector that follows from that to the next one is added with it.
        let explicit = blocks.previous.is_some() || added.previous.is_some();
        if explicit && blocks.previous.is_none() {
            blocks.previous = transposed(n, blocks.next.as_ref())?;
        }
        let previous = match (&added.previous, explicit) {
            (None, true) => transposed(n, added.next.as_ref())?,
            (given, _) => given.as_ref().map(KeptMatrix::try_clone).transpose()?,
        };
        add(n, &mut blocks.own, added.own.as_ref(), factor)?;
        add(n, &mut blocks.next, added.next.as_ref(), factor)?;
        add(n, &mut blocks.previous, previous.as_ref(), factor)?;
    } else {
        for matrix in blocks.diameters.iter_mut().filter(|matrix| matrix.is_some()) {
            add(n, matrix, added.own.as_ref(), factor)?;
        }
    }
    Ok(())
}

fn scale_structure(structure: &mut Structure, which: MatrixKind, factor: f64) -> Result<()> {
    let blocks = structure.blocks_mut(which)?;
    let given = [&mut blocks.own, &mut blocks.next, &mut blocks.previous].into_iter();
    for matrix in given.chain(&mut blocks.diameters).flatten() {
        matrix.scale(factor);
    }
    if which == MatrixKind::Damping {
        structure.rayleigh = (structure.rayleigh.0 * factor, structure.rayleigh.1 * factor);
        for matrix in structure.modal_damping.iter_mut().flatten() {
            matrix.scale(factor);
        }
    }
    Ok(())
}

fn transposed(n: usize, matrix: Option<&KeptMatrix>) -> Result<Option<KeptMatrix>> {
    matrix
        .map(|a| KeptMatrix::new(Csc::sum(n, &[(Complex64::ONE, a, Form::Transposed)])?))
        .transpose()
}

/// to ← to + factor·a, for optional matrices of order n.
fn add(n: usize, to: &mut Option<KeptMatrix>, a: Option<&KeptMatrix>, factor: f64) -> Result<()> {
    let Some(a) = a else { return Ok(()) };
    let scaled = (factor.into(), a, Form::Plain);
    *to = Some(KeptMatrix::new(match to {
        Some(to) => Csc::sum(n, &[(Complex64::ONE, &*to, Form::Plain), scaled])?,
        None => Csc::sum(n, &[scaled])?,
    })?);
    Ok(())
}

fn check_finite(name: &str, value: f64) -> Result<()> {
    if value.is_finite() {
        return Ok(());
    }
    fail!(NotFinite, "{name} = {value}, needs a finite number")
}
