//! A matrix of a wave, without a copy where it is one that the model keeps.

use crate::error::Result;
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;
use crate::linalg::sparse_storage::sparse::{Columns, Csc};
use crate::model::matrices::structure::{MatrixKind, Structure};
use num_complex::Complex64;

/// A matrix of a wave.
#[derive(Debug)]
pub enum WaveMatrix<'a> {
    /// The kept own block, for a structure with one sector or without coupling between sectors.
    Kept(&'a KeptMatrix),
    /// A matrix that was made for the wave.
    Made(Csc),
}

impl WaveMatrix<'_> {
    /// The matrix as compressed sparse columns, converted or moved.
    pub fn into_csc(self) -> Result<Csc> {
        match self {
            Self::Kept(a) => a.expanded(),
            Self::Made(a) => Ok(a),
        }
    }

    /// Whether every entry is real.
    pub fn is_real(&self) -> bool {
        match self {
            Self::Kept(a) => a.is_real(),
            Self::Made(a) => a.is_real(),
        }
    }

    /// Largest modulus of an entry.
    pub fn max_abs(&self) -> f64 {
        match self {
            Self::Kept(a) => a.max_abs(),
            Self::Made(a) => a.max_abs(),
        }
    }
}

impl Columns for WaveMatrix<'_> {
    fn columns(&self) -> usize {
        match self {
            Self::Kept(a) => a.columns(),
            Self::Made(a) => a.columns(),
        }
    }

    fn stored(&self) -> usize {
        match self {
            Self::Kept(a) => a.stored(),
            Self::Made(a) => a.stored(),
        }
    }

    fn visit(&self, j: usize, take: impl FnMut(usize, Complex64)) {
        match self {
            Self::Kept(a) => a.visit(j, take),
            Self::Made(a) => a.visit(j, take),
        }
    }

    fn get(&self, i: usize, j: usize) -> Complex64 {
        match self {
            Self::Kept(a) => Columns::get(*a, i, j),
            Self::Made(a) => a.get(i, j),
        }
    }
}

/// Matrix of one kind for a harmonic, or its complex conjugate, without a copy where possible.
pub(crate) fn matrix_of_wave(
    structure: &Structure,
    which: MatrixKind,
    harmonic: usize,
    conjugated: bool,
) -> Result<WaveMatrix<'_>> {
    let blocks = &structure.blocks[which as usize];
    let alone = blocks.next.is_none() && blocks.previous.is_none() && blocks.diameters.is_empty();
    // Other matrices have terms besides the one that was given.
    let as_given = matches!(which, MatrixKind::Mass | MatrixKind::Stiffness);
    if let Some(own) = &blocks.own
        && alone
        && as_given
        && own.is_real()
    {
        return Ok(WaveMatrix::Kept(own));
    }
    let mut made = structure.wave_matrix(which, harmonic)?;
    if conjugated {
        for v in &mut made.values {
            *v = v.conj();
        }
    }
    Ok(WaveMatrix::Made(made))
}
