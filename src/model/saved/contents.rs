//! Contents of a model, read back: blocks of its matrices, normal loads as they were given.

use crate::contact::forms::constants::Constant;
use crate::error::{Result, fail};
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;
use crate::model::Model;
use crate::model::matrices::structure::MatrixKind;

/// A block of a matrix, by the sector of its columns relative to the sector of its rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Block {
    /// Rows and columns of one sector; for a plain structure the whole matrix.
    Own,
    /// Rows of one sector and columns of the next one.
    Next,
    /// Rows of one sector and columns of the previous one, where this is not the transpose of [`Self::Next`].
    Previous,
}

/// A block of a matrix over the independent degrees of freedom.
#[doc(hidden)]
pub(crate) fn block(model: &Model, kind: MatrixKind, block: Block) -> Result<Option<&KeptMatrix>> {
    let blocks = &model.structure().blocks[kind as usize];
    if !blocks.diameters.is_empty() {
        return fail!(
            Unsupported,
            "the {} matrix was given per nodal diameter: it has no sector blocks",
            kind.name()
        );
    }
    Ok(match block {
        Block::Own => &blocks.own,
        Block::Next => &blocks.next,
        Block::Previous => &blocks.previous,
    }
    .as_ref())
}

/// Normal load N₀, coefficient c of its growth N₀ + cΩ², and gap of a contact, as they were given.
pub(crate) fn given_load(model: &Model, id: usize) -> Option<(f64, f64, f64)> {
    let contact = model.contacts().get(id)?;
    let at_speed = model.speed_loads().iter().find(|load| load.contact == id);
    Some(at_speed.map_or(
        (
            contact.constant(Constant::Preload),
            0.0,
            contact.constant(Constant::Gap),
        ),
        |load| (load.preload, load.per_speed2, load.gap),
    ))
}
