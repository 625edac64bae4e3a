//! A matrix of a cyclic structure as its blocks between sectors, or per nodal diameter.

use crate::error::{Result, try_push};
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;

/// One of M, C, K in the form in which it was given.
#[derive(Clone, Debug, Default)]
pub(crate) struct Blocks {
    /// Rows and columns of the same sector.
    pub own: Option<KeptMatrix>,
    /// Rows of sector s, columns of s + 1.
    pub next: Option<KeptMatrix>,
    /// Rows of sector s, columns of s − 1; `None`: the transpose of `next`.
    pub previous: Option<KeptMatrix>,
    /// Matrices per nodal diameter by its residue modulo N, instead of blocks: 0 ..= N/2, or 0 .. N where one was given for a
    /// negative diameter.
    pub diameters: Vec<Option<KeptMatrix>>,
}

impl Blocks {
    /// The matrices that were given, in one order.
    pub fn parts(&self) -> impl Iterator<Item = &KeptMatrix> {
        [&self.own, &self.next, &self.previous]
            .into_iter()
            .chain(&self.diameters)
            .flatten()
    }

    /// A copy, allocated fallibly.
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
