//! Matrices on the independent degrees of freedom: K₀ = T₀ᵀ K T₀ + T₁ᵀ K T₁, K₁ = T₀ᵀ K T₁, K₋₁ = T₁ᵀ K T₀.

use crate::error::{Error, Result};
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;
use crate::linalg::sparse_storage::sparse::{Columns, Csc, Form, Symmetry};
use crate::model::matrices::blocks::Blocks;
use crate::model::matrices::degree_map::DegreeMap;
use num_complex::Complex64;

const CONTEXT: &str = "the matrices of the sector";

/// Entries of a matrix: row, column and value.
pub(crate) type Entries = Vec<(usize, usize, Complex64)>;

/// The blocks of a sector matrix. The own block has exactly the symmetry of the matrix.
pub(crate) fn blocks(map: &DegreeMap, a: &Csc, symmetry: Symmetry) -> Result<Blocks> {
    // A block per pair of sectors: rows and columns in the same one, in this and the next, in the next and this.
    let which = |row: i64, column: i64| match (row, column) {
        (0, 1) => 1,
        (1, 0) => 2,
        _ => 0,
    };
    let mut counts = [0; 3];
    visit(map, a, |(row, _), (column, _), _| counts[which(row, column)] += 1);
    let mut entries: [Entries; 3] = Default::default();
    for (entries, &count) in entries.iter_mut().zip(&counts) {
        entries
            .try_reserve_exact(count)
            .map_err(|_| Error::out_of_memory(CONTEXT))?;
    }
    let mut complex = false;
    let has_mirror = matches!(symmetry, Symmetry::Hermitian | Symmetry::Plain);
    visit(map, a, |(row, p), (column, q), v| {
        let block = which(row, column);
        complex |= v.im != 0.0;
        // One triangle decides, so that rounding leaves the block symmetric.
        if !(has_mirror && (block == 2 || (block == 0 && p > q))) {
            entries[block].push((p, q, v));
        }
    });
    let n = map.independent();
    let [own, next, previous] = entries;
    let own = Csc::from_triplets(n, n, own)?;
    let own = if has_mirror { mirrored(&own, symmetry)? } else { own };
    let next = Csc::from_triplets(n, n, next)?;
    let previous = match symmetry {
        Symmetry::None | Symmetry::Skew => Some(Csc::from_triplets(n, n, previous)?),
        Symmetry::Hermitian if complex => Some(adjoint(&next)?),
        // The transpose of the coupling to the next sector.
        Symmetry::Hermitian | Symmetry::Plain => None,
    };
    let coupled = map.faces().is_some();
    let kept = |a: Option<Csc>| a.filter(|_| coupled).map(KeptMatrix::new).transpose();
    Ok(Blocks {
        own: Some(KeptMatrix::new(own)?),
        next: kept(Some(next))?,
        previous: kept(previous)?,
        diameters: Vec::new(),
    })
}

/// Entries of a matrix that is given on all degrees of freedom of sector 0, over the independent ones of this sector
/// and, after these, of the next sector.
pub(crate) fn of_both_sectors(map: &DegreeMap, a: &Csc) -> Result<Entries> {
    let n = map.independent();
    let mut count = 0;
    visit(map, a, |_, _, _| count += 1);
    let mut entries = Entries::new();
    entries
        .try_reserve_exact(count)
        .map_err(|_| Error::out_of_memory(CONTEXT))?;
    let place = |(sector, p): (i64, usize)| p + if sector == 0 { 0 } else { n };
    visit(map, a, |row, column, v| entries.push((place(row), place(column), v)));
    Ok(entries)
}

/// Calls `take` for each term with (sector, number) of its row and column, and its value.
fn visit(map: &DegreeMap, a: &Csc, mut take: impl FnMut((i64, usize), (i64, usize), Complex64)) {
    for j in 0..a.cols {
        let (column, terms) = map.image(j);
        for (q, d) in terms {
            for (i, v) in a.column(j) {
                let (row, terms) = map.image(i);
                for (p, c) in terms {
                    take((row, p), (column, q), v * (c * d));
                }
            }
        }
    }
}

/// The full Hermitian or symmetric matrix, from its upper triangle.
fn mirrored(upper: &Csc, symmetry: Symmetry) -> Result<Csc> {
    let n = upper.cols;
    let mut entries = Vec::new();
    let count = 2 * upper.values.len();
    entries
        .try_reserve_exact(count)
        .map_err(|_| Error::out_of_memory(CONTEXT))?;
    for j in 0..n {
        for (i, v) in upper.column(j) {
            match symmetry {
                Symmetry::Hermitian if i == j => entries.push((i, j, v.re.into())),
                _ if i == j => entries.push((i, j, v)),
                _ => entries.extend([(i, j, v), (j, i, symmetry.mirror(v))]),
            }
        }
    }
    Csc::from_triplets(n, n, entries)
}

/// Adjoint matrix Aᴴ.
fn adjoint(a: &Csc) -> Result<Csc> {
    let mut transposed = Csc::sum(a.rows, &[(Complex64::ONE, a, Form::Transposed)])?;
    for v in &mut transposed.values {
        *v = v.conj();
    }
    Ok(transposed)
}

/// Rows and columns of a matrix on the independent degrees of freedom of `old` that are independent in `new`, too.
pub(crate) fn restricted(old: &DegreeMap, new: &DegreeMap, a: &impl Columns) -> Result<Csc> {
    let n = new.independent();
    let number = |p: usize| new.number(old.origin(p));
    let mut entries = Vec::new();
    entries
        .try_reserve_exact(a.stored())
        .map_err(|_| Error::out_of_memory(CONTEXT))?;
    for j in 0..a.columns() {
        let Some(column) = number(j) else { continue };
        a.visit(j, |i, v| entries.extend(number(i).map(|row| (row, column, v))));
    }
    Csc::from_triplets(n, n, entries)
}

/// Rows and columns of the independent degrees of freedom, from a matrix on all degrees of freedom.
pub(crate) fn of_independent(map: &DegreeMap, a: Csc) -> Result<Csc> {
    if map.is_identity() {
        return Ok(a);
    }
    restricted(&DegreeMap::identity(map.given()), map, &a)
}
