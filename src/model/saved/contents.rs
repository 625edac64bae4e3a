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

impl Model {
    /// A block of a matrix over the independent degrees of freedom. `None` where it was not given: it is then zero,
    /// or for the block to the previous sector the transpose of the block to the next one.
    ///
    /// # Errors
    /// `Unsupported` for a matrix that was given per nodal diameter.
    #[doc(hidden)]
    pub fn block(&self, kind: MatrixKind, block: Block) -> Result<Option<&KeptMatrix>> {
        let blocks = &self.structure().blocks[kind as usize];
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

    /// Normal load N₀, coefficient c of its growth N₀ + cΩ², and gap of a contact, as they were given; `None` for an
    /// unknown contact.
    #[must_use]
    pub fn given_load(&self, id: usize) -> Option<(f64, f64, f64)> {
        let contact = self.contacts().get(id)?;
        let at_speed = self.speed_loads().iter().find(|load| load.contact == id);
        Some(at_speed.map_or(
            (
                contact.constant(Constant::Preload),
                0.0,
                contact.constant(Constant::Gap),
            ),
            |load| (load.preload, load.per_speed2, load.gap),
        ))
    }
}
