//! Contents of a model, read back: blocks of its matrices, normal loads as they were given.

use crate::contact::constants::Constant;
use crate::error::{Result, fail};
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;
use crate::model::Model;
use crate::model::matrices::structure::MatrixKind;

/// A block of a matrix by the sectors of its columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Block {
    /// Rows and columns of the same sector: all of a plain structure.
    Own,
    /// Columns of the next sector.
    Next,
    /// Columns of the previous sector, where it is not the transpose of [`Self::Next`].
    Previous,
}

impl Model {
    /// A block of a matrix over the independent degrees of freedom; `None` where it was not given, and is zero (a block
    /// to the previous sector: the transpose of that to the next one).
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

    /// Normal load N₀ and its coefficient c of a contact under N₀ + cΩ², and its gap, as they were given; `None` for an
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
