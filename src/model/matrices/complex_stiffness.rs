//! Complex symmetric stiffness K(1 + iη), as finite-element programs write structural damping: its Hermitian part is the
//! stiffness of natural modes, the rest is the structural damping iD.

use crate::error::{Result, fail, try_push};
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;
use crate::linalg::sparse_storage::sparse::{Columns, Csc, Form, Symmetry};
use crate::model::Model;
use crate::model::matrices::blocks::Blocks;
use crate::model::matrices::structure::{MatrixKind, Structure};
use num_complex::Complex64;
use std::borrow::Cow;

/// Deviation from a symmetry, relative to the largest entry, that is rounding.
/// Kind: rounding.
const COMPLEX_STIFFNESS_ROUNDING: f64 = 1e-10;

/// The same of the loss of a stiffness from one loss factor.
/// Kind: rounding.
const PROPORTIONAL_LOSS: f64 = 1e-12;

/// Factors c with which the parts (A + Bᴴ)/2 and (A − Bᴴ)/2i of a matrix are written as cA + (cB)ᴴ.
const HERMITIAN_PART: Complex64 = Complex64::new(0.5, 0.0);
const LOSS: Complex64 = Complex64::new(0.0, -0.5);

/// Whether the stiffness is complex and symmetric but not Hermitian, so that its part that is not Hermitian
/// dissipates.
pub(crate) fn has_complex_stiffness(structure: &Structure) -> bool {
    let blocks = &structure.blocks[MatrixKind::Stiffness as usize];
    if structure.parts(MatrixKind::Stiffness).all(KeptMatrix::is_real) {
        return false;
    }
    let has = |a: &KeptMatrix, symmetry| a.worst_pair(symmetry).2 <= COMPLEX_STIFFNESS_ROUNDING * a.max_abs();
    if !blocks.diameters.is_empty() {
        let given = blocks.diameters.iter().enumerate();
        let mut lossy = given
            .filter_map(|(d, a)| a.as_ref().map(|a| (d, a)))
            .filter(|(_, a)| !has(a, Symmetry::Hermitian))
            .peekable();
        let own_mirror = |d: usize| (2 * d).is_multiple_of(structure.sectors());
        let is_transposed = |d: usize, a: &KeptMatrix| {
            let other = blocks.diameters.get((structure.sectors() - d) % structure.sectors());
            other.and_then(Option::as_ref).is_none_or(|b| are_transposed(a, b))
        };
        return lossy.peek().is_some()
            && lossy.all(|(d, a)| !a.is_real() && (!own_mirror(d) || has(a, Symmetry::Plain)) && is_transposed(d, a));
    }
    let coupled = |symmetry: Symmetry| match (&blocks.next, &blocks.previous) {
        (Some(next), Some(previous)) => {
            let limit = COMPLEX_STIFFNESS_ROUNDING * next.max_abs().max(previous.max_abs());
            let near = |a: &KeptMatrix, b: &KeptMatrix| {
                let entries = (0..a.order()).flat_map(|j| a.column(j).map(move |(i, v)| (i, j, v)));
                entries
                    .into_iter()
                    .all(|(i, j, v)| (v - symmetry.mirror(b.get(j, i))).norm() <= limit)
            };
            near(next, previous) && near(previous, next)
        }
        // The coupling to the previous sector is the transpose.
        (Some(next), None) => symmetry == Symmetry::Plain || next.is_real(),
        (None, previous) => previous.is_none(),
    };
    let ring = |symmetry| blocks.own.as_ref().is_none_or(|own| has(own, symmetry)) && coupled(symmetry);
    ring(Symmetry::Plain) && !ring(Symmetry::Hermitian)
}

/// Loss factor of the whole stiffness.
pub(crate) fn whole_loss_factor(structure: &Structure) -> Result<Option<f64>> {
    if !structure.has_complex_stiffness() {
        return Ok(Some(structure.loss_factor()));
    }
    let blocks = &structure.blocks[MatrixKind::Stiffness as usize];
    let (elastic, loss) = (of_blocks(blocks, HERMITIAN_PART)?, of_blocks(blocks, LOSS)?);
    let pairs = || elastic.parts().zip(loss.parts());
    let (mut product, mut square, mut largest) = (0.0, 0.0, 0.0_f64);
    for (h, l) in pairs() {
        largest = largest.max(l.max_abs());
        for j in 0..h.order() {
            for (i, v) in h.column(j) {
                product += (v.conj() * l.get(i, j)).re;
                square += v.norm_sqr();
            }
        }
    }
    if square == 0.0 {
        return Ok(None);
    }
    let eta = product / square;
    let limit = PROPORTIONAL_LOSS * largest;
    let is_share = pairs().all(|(h, l)| {
        (0..h.order()).all(|j| {
            h.column(j).all(|(i, v)| (l.get(i, j) - eta * v).norm() <= limit)
                && l.column(j).all(|(i, v)| (v - eta * h.get(i, j)).norm() <= limit)
        })
    });
    Ok(is_share.then_some(structure.loss_factor() + eta))
}

/// The stiffness of a wave without the loss that a complex stiffness contains.
pub(crate) fn elastic(structure: &Structure, stiffness: Csc) -> Result<Csc> {
    if stiffness.is_real() || !structure.has_complex_stiffness() {
        return Ok(stiffness);
    }
    combined(&stiffness, &stiffness, HERMITIAN_PART)
}

/// Replaces a complex symmetric stiffness by its Hermitian part and adds the rest to the structural matrix.
fn separate_complex_stiffness(structure: &mut Structure) -> Result<()> {
    let stiffness = structure.blocks[MatrixKind::Stiffness as usize].try_clone()?;
    let structural = structure.blocks[MatrixKind::Structural as usize].try_clone()?;
    let is_given = structure.parts(MatrixKind::Structural).next().is_some();
    if is_given && stiffness.diameters.is_empty() != structural.diameters.is_empty() {
        return fail!(
            Unsupported,
            "modes need a complex symmetric stiffness and the structural damping in one form, both as blocks of sectors or both \
             per nodal diameter; give all of the loss as structural damping"
        );
    }
    *structure.blocks_mut(MatrixKind::Stiffness)? = of_blocks(&stiffness, HERMITIAN_PART)?;
    let loss = of_blocks(&stiffness, LOSS)?;
    *structure.blocks_mut(MatrixKind::Structural)? = added(structure.ndof(), &loss, &structural)?;
    structure.loss_of_stiffness = true;
    Ok(())
}

/// The model whose stiffness has natural modes.
#[doc(hidden)]
pub(crate) fn with_separate_loss(model: &Model) -> Result<Cow<'_, Model>> {
    if !model.structure().has_complex_stiffness() {
        return Ok(Cow::Borrowed(model));
    }
    let mut model = model.try_clone()?;
    separate_complex_stiffness(model.structure_mut())?;
    Ok(Cow::Owned(model))
}

/// Splits all blocks of a matrix. The split block to the previous sector is the mirror of the one to the next sector.
fn of_blocks(given: &Blocks, factor: Complex64) -> Result<Blocks> {
    let split = |a: &KeptMatrix, mirror: &KeptMatrix| KeptMatrix::new(combined(a, mirror, factor)?);
    let own = given.own.as_ref().map(|own| split(own, own)).transpose()?;
    let (mut next, mut previous) = (None, None);
    if let Some(after) = &given.next {
        let before = match &given.previous {
            Some(before) => before.try_clone()?,
            None => transposed(after)?,
        };
        next = Some(split(after, &before)?);
        if given.previous.is_some() {
            previous = Some(split(&before, after)?);
        }
    }
    let mut diameters = Vec::new();
    for a in &given.diameters {
        let a = a.as_ref().map(|a| split(a, a)).transpose()?;
        try_push(&mut diameters, a, "the matrices per diameter")?;
    }
    Ok(Blocks {
        own,
        next,
        previous,
        diameters,
    })
}

/// Computes cA + (cB)ᴴ, where B is the mirror block of A, which is A itself on the diagonal.
fn combined<A: Columns>(a: &A, mirror: &A, factor: Complex64) -> Result<Csc> {
    let n = a.columns();
    let mirrored = Csc::sum(n, &[(Complex64::ONE, mirror, Form::Transposed)])?;
    let scaled = Csc::sum(n, &[(factor, a, Form::Plain)])?;
    Csc::sum(
        n,
        &[
            (Complex64::ONE, &scaled, Form::Plain),
            (factor.conj(), &mirrored, Form::Conjugated),
        ],
    )
}

/// Whether two matrices are transposes of each other.
fn are_transposed(a: &KeptMatrix, b: &KeptMatrix) -> bool {
    let limit = COMPLEX_STIFFNESS_ROUNDING * a.max_abs().max(b.max_abs());
    let is_mirror = |a: &KeptMatrix, b: &KeptMatrix| {
        let mut columns = 0..a.order();
        columns.all(|j| a.column(j).all(|(i, v)| (v - b.get(j, i)).norm() <= limit))
    };
    is_mirror(a, b) && is_mirror(b, a)
}

fn transposed(a: &KeptMatrix) -> Result<KeptMatrix> {
    KeptMatrix::new(Csc::sum(a.order(), &[(Complex64::ONE, a, Form::Transposed)])?)
}

fn added(n: usize, loss: &Blocks, given: &Blocks) -> Result<Blocks> {
    let sum = |a: &Option<KeptMatrix>, b: &Option<KeptMatrix>| -> Result<Option<KeptMatrix>> {
        match (a, b) {
            (None, None) => Ok(None),
            (Some(a), None) | (None, Some(a)) => a.try_clone().map(Some),
            (Some(a), Some(b)) => {
                let terms = [a, b].map(|a| (Complex64::ONE, a, Form::Plain));
                KeptMatrix::new(Csc::sum(n, &terms)?).map(Some)
            }
        }
    };
    // Without a matrix of its own, the coupling to the previous sector is the transpose of that to the next.
    let previous = if loss.previous.is_some() || given.previous.is_some() {
        sum(&before(loss)?, &before(given)?)?
    } else {
        None
    };
    let mut diameters = Vec::new();
    for (d, a) in loss.diameters.iter().enumerate() {
        let b = given.diameters.get(d).unwrap_or(&None);
        try_push(&mut diameters, sum(a, b)?, "the matrices per diameter")?;
    }
    Ok(Blocks {
        own: sum(&loss.own, &given.own)?,
        next: sum(&loss.next, &given.next)?,
        previous,
        diameters,
    })
}

/// The coupling block to the previous sector.
fn before(blocks: &Blocks) -> Result<Option<KeptMatrix>> {
    match (&blocks.previous, &blocks.next) {
        (Some(previous), _) => previous.try_clone().map(Some),
        (None, Some(next)) => transposed(next).map(Some),
        (None, None) => Ok(None),
    }
}
