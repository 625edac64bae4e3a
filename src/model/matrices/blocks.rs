//! A matrix of a cyclic structure as its blocks between sectors, or per nodal diameter.

use crate::error::{Result, try_push};
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;

/// One of the matrices M, C, K, … in the form in which the caller gave it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Blocks {
    /// Block with the rows and columns of one sector.
    pub own: Option<KeptMatrix>,
    /// Block with the rows of sector s and the columns of s + 1.
    pub next: Option<KeptMatrix>,
    /// Block with the rows of sector s and the columns of s − 1; `None`: the transpose of `next`.
    pub previous: Option<KeptMatrix>,
    /// Matrices per nodal diameter by its residue modulo N, instead of blocks: 0 ..= N/2, or 0 .. N where one was given for a
    /// negative diameter.
    pub diameters: Vec<Option<KeptMatrix>>,
}

impl Blocks {
    /// All matrices that were given, in a fixed order.
    pub fn parts(&self) -> impl Iterator<Item = &KeptMatrix> {
        [&self.own, &self.next, &self.previous]
            .into_iter()
            .chain(&self.diameters)
            .flatten()
    }

    /// A copy that returns an error if memory is short.
    pub fn try_clone(&self) -> Result<Self> {
        let copy = |a: &Option<KeptMatrix>| a.as_ref().map(KeptMatrix::try_clone).transpose();
        let mut diameters = Vec::new();
        for a in &self.diameters {
            try_push(&mut diameters, copy(a)?, "the matrices per diameter")?;
        }
        Ok(Self {
            own: copy(&self.own)?,
            next: copy(&self.next)?,
            previous: copy(&self.previous)?,
            diameters,
        })
    }
}
