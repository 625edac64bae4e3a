//! A matrix borrowed from the caller, and its checks.

use crate::error::{Error, Result, Status, fail, try_push};
use crate::linalg::sparse_storage::sorted_columns::GivenColumns;
use crate::linalg::sparse_storage::sparse::{Csc, Form, Symmetry};
use num_complex::Complex64;

/// Layout of the entries in memory.
#[derive(Clone, Copy, Debug)]
pub enum Storage<'a> {
    /// Dense, column after column, `ld` elements apart (`0`: packed).
    ColMajor {
        /// Leading dimension in elements, at least the number of rows.
        ld: usize,
    },
    /// Dense, row after row, `ld` elements apart (`0`: packed).
    RowMajor {
        /// Leading dimension in elements, at least the number of columns.
        ld: usize,
    },
    /// Compressed sparse columns; duplicates are summed.
    Csc {
        /// cols + 1 offsets, the first equal to the index base.
        col_ptr: &'a [i64],
        /// Row of each entry, counted from the index base.
        row_idx: &'a [i64],
    },
}

/// Numbers of a matrix, real or complex.
#[derive(Clone, Copy, Debug)]
pub enum Values<'a> {
    /// Real numbers.
    Real(&'a [f64]),
    /// Complex numbers.
    Complex(&'a [Complex64]),
}

impl Values<'_> {
    fn len(&self) -> usize {
        match self {
            Self::Real(v) => v.len(),
            Self::Complex(v) => v.len(),
        }
    }

    fn get(&self, i: usize) -> Complex64 {
        match self {
            Self::Real(v) => v[i].into(),
            Self::Complex(v) => v[i],
        }
    }
}

/// The part of the matrix that is given, and the symmetry of the whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// All entries of a symmetric or Hermitian matrix, whose symmetry is checked.
    Full,
    /// The lower triangle of a symmetric or Hermitian matrix; the upper one is not read.
    Lower,
    /// The upper triangle of a symmetric or Hermitian matrix; the lower one is not read.
    Upper,
    /// All entries of a matrix without any symmetry.
    General,
    /// All entries of a matrix with A = Aᵀ, real or complex, whose symmetry is checked.
    Symmetric,
    /// The lower triangle of a matrix with A = Aᵀ, real or complex; the upper one is not read.
    SymmetricLower,
    /// The upper triangle of a matrix with A = Aᵀ, real or complex; the lower one is not read.
    SymmetricUpper,
}

impl Part {
    /// Whether the entries below the diagonal are not read.
    fn skips_lower(self) -> bool {
        matches!(self, Self::Upper | Self::SymmetricUpper)
    }

    /// Whether the entries above the diagonal are not read.
    fn skips_upper(self) -> bool {
        matches!(self, Self::Lower | Self::SymmetricLower)
    }

    /// The symmetry that the caller promises.
    #[must_use]
    #[doc(hidden)]
    pub fn symmetry(self) -> Symmetry {
        match self {
            Self::Full | Self::Lower | Self::Upper => Symmetry::Hermitian,
            Self::General => Symmetry::None,
            Self::Symmetric | Self::SymmetricLower | Self::SymmetricUpper => Symmetry::Plain,
        }
    }
}

/// A borrowed matrix: its entries are copied, the reference is never kept.
///
/// ```
/// use hbvib::{MatrixKind, MatrixView, Model};
///
/// let mut model = Model::new(2)?;
/// model.set_matrix(MatrixKind::Stiffness, &MatrixView::dense(2, &[2.0, -1.0, -1.0, 2.0]))?;
/// assert!(model.set_matrix(MatrixKind::Mass, &MatrixView::dense(2, &[1.0, 0.5, 0.0, 1.0])).is_err()); // no symmetry
/// # Ok::<(), hbvib::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct MatrixView<'a> {
    /// Number of rows of the matrix.
    pub rows: usize,
    /// Number of columns of the matrix.
    pub cols: usize,
    /// Layout of the numbers in memory.
    pub storage: Storage<'a>,
    /// Numbers of the matrix.
    pub values: Values<'a>,
    /// Part of the matrix that is given.
    pub part: Part,
    /// Base of the indices of a sparse matrix and of those in error sentences, 0 or 1.
    pub index_base: usize,
}

/// Deviations from symmetry up to this share of the largest entry are rounding and are removed by averaging.
/// Kind: rounding.
const SYMMETRY_TOLERANCE: f64 = 1e-10;

impl<'a> MatrixView<'a> {
    /// A packed dense real column-major matrix of order `n`, symmetry checked.
    #[must_use]
    pub fn dense(n: usize, values: &'a [f64]) -> Self {
        Self {
            rows: n,
            cols: n,
            storage: Storage::ColMajor { ld: 0 },
            values: Values::Real(values),
            part: Part::Full,
            index_base: 0,
        }
    }

    /// A packed dense complex column-major matrix of order `n`, Hermitian symmetry checked.
    #[must_use]
    pub fn dense_complex(n: usize, values: &'a [Complex64]) -> Self {
        Self {
            values: Values::Complex(values),
            ..Self::dense(n, &[])
        }
    }

    /// The view of a matrix of which another [`Part`] is given.
    #[must_use]
    pub fn part(mut self, part: Part) -> Self {
        self.part = part;
        self
    }

    /// Checks the view and copies it; `name` ("stiffness") begins every error sentence, `order` is the required
    /// number of rows and columns.
    ///
    /// # Errors
    /// `Dimension`, `Index`, `NotFinite`, `NotHermitian` or `OutOfMemory`, naming the place.
    #[doc(hidden)]
    pub fn copy_in(&self, name: &str, order: usize) -> Result<Csc> {
        let a = self.entries(name, order, self.part.symmetry())?;
        match self.part {
            Part::Full | Part::Symmetric => self.symmetrised(name, a),
            Part::Lower | Part::Upper => self.with_real_diagonal(name, a),
            Part::General | Part::SymmetricLower | Part::SymmetricUpper => Ok(a),
        }
    }

    /// Checks and copies a skew-symmetric (complex: skew-Hermitian) matrix as `copy_in` does. It is given in full,
    /// and then checked, or by one triangle.
    ///
    /// # Errors
    /// As [`Self::copy_in`].
    #[doc(hidden)]
    pub fn copy_in_skew(&self, name: &str, order: usize) -> Result<Csc> {
        if self.part.symmetry() == Symmetry::Plain {
            return fail!(
                NotHermitian,
                "{name} must be skew-symmetric, A = -A^T, but was passed as SYMMETRIC"
            );
        }
        let a = self.entries(name, order, Symmetry::Skew)?;
        let (i, j, gap) = a.worst_pair(Symmetry::Skew);
        let largest = a.max_abs();
        if gap > SYMMETRY_TOLERANCE * largest {
            let base = self.index_base;
            return fail!(
                NotHermitian,
                "{name} must be skew-symmetric, A = -A^T, but the sum of {name}[{},{}] and its mirror is {gap:.3e}, \
                 {:.1e} of the largest entry",
                i + base,
                j + base,
                gap / largest
            );
        }
        if gap == 0.0 {
            return Ok(a);
        }
        let transposed = Csc::sum(a.rows, &[(Complex64::ONE, &a, Form::Transposed)])?;
        let half = Complex64::new(0.5, 0.0);
        Csc::sum(
            a.rows,
            &[(half, &a, Form::Plain), (-half, &transposed, Form::Conjugated)],
        )
    }

    fn entries(&self, name: &str, order: usize, symmetry: Symmetry) -> Result<Csc> {
        if self.rows != order || self.cols != order {
            return fail!(
                Dimension,
                "{name} is {} x {}, needs {order} x {order}",
                self.rows,
                self.cols
            );
        }
        let entries = match self.storage {
            Storage::ColMajor { ld } => self.dense_entries(name, ld, false, symmetry)?,
            Storage::RowMajor { ld } => self.dense_entries(name, ld, true, symmetry)?,
            Storage::Csc { col_ptr, row_idx } => {
                self.check_columns(name, col_ptr, row_idx)?;
                let columns = GivenColumns {
                    order,
                    col_ptr,
                    row_idx,
                    index_base: self.index_base as i64,
                };
                let one_triangle = self.part.skips_lower() || self.part.skips_upper();
                let keep = |i, j| !self.skips(i, j);
                if let Some(a) = columns.assembled(|k| self.values.get(k), keep, one_triangle.then_some(symmetry))? {
                    return Ok(a);
                }
                self.sparse_entries(name, col_ptr, row_idx, symmetry)?
            }
        };
        Csc::from_triplets(order, order, entries)
    }

    /// A Hermitian matrix from one triangle, whose diagonal must be real up to rounding.
    fn with_real_diagonal(&self, name: &str, mut a: Csc) -> Result<Csc> {
        let allowed = SYMMETRY_TOLERANCE * a.max_abs();
        for j in 0..a.cols {
            for at in a.col_ptr[j]..a.col_ptr[j + 1] {
                if a.row_idx[at] != j {
                    continue;
                }
                if a.values[at].im.abs() > allowed {
                    let (lower, symmetric) = if self.part == Part::Lower {
                        ("LOWER", "SYMMETRIC_LOWER")
                    } else {
                        ("UPPER", "SYMMETRIC_UPPER")
                    };
                    let i = j + self.index_base;
                    return fail!(
                        NotHermitian,
                        "{name}[{i},{i}] has the imaginary part {:.3e}: {lower} is a triangle of a Hermitian matrix, \
                         whose diagonal is real; say {symmetric} if the matrix is complex symmetric",
                        a.values[at].im
                    );
                }
                a.values[at].im = 0.0;
            }
        }
        Ok(a)
    }

    fn dense_entries(
        &self,
        name: &str,
        ld: usize,
        row_major: bool,
        symmetry: Symmetry,
    ) -> Result<Vec<(usize, usize, Complex64)>> {
        let (inner, outer) = if row_major {
            (self.cols, self.rows)
        } else {
            (self.rows, self.cols)
        };
        let ld = if ld == 0 { inner } else { ld };
        if ld < inner {
            return fail!(Dimension, "{name}: leading dimension = {ld}, needs at least {inner}");
        }
        let needed = outer
            .checked_sub(1)
            .and_then(|o| o.checked_mul(ld))
            .and_then(|o| o.checked_add(inner))
            .unwrap_or(if outer == 0 { 0 } else { usize::MAX });
        if self.values.len() < needed {
            return fail!(Dimension, "{name} has {} entries, needs {needed}", self.values.len());
        }
        let mut entries = Vec::new();
        for o in 0..outer {
            for k in 0..inner {
                let (i, j) = if row_major { (o, k) } else { (k, o) };
                self.take(name, (i, j, self.values.get(o * ld + k)), symmetry, &mut entries)?;
            }
        }
        Ok(entries)
    }

    /// Checks the lengths and bounds of compressed columns.
    fn check_columns(&self, name: &str, col_ptr: &[i64], row_idx: &[i64]) -> Result<()> {
        let base = self.index_base as i64;
        if col_ptr.len() != self.cols + 1 {
            return fail!(
                Dimension,
                "{name}: col_ptr has {} entries, needs cols + 1 = {}",
                col_ptr.len(),
                self.cols + 1
            );
        }
        if col_ptr[0] != base {
            return fail!(
                Index,
                "{name}: col_ptr[0] = {}, needs the index base {base}",
                col_ptr[0]
            );
        }
        if let Some(j) = (0..self.cols).find(|&j| col_ptr[j + 1] < col_ptr[j]) {
            return fail!(
                Index,
                "{name}: col_ptr[{}] = {} is below col_ptr[{j}] = {}",
                j + 1,
                col_ptr[j + 1],
                col_ptr[j]
            );
        }
        let count = col_ptr[self.cols] - base;
        if usize::try_from(count).ok() != Some(row_idx.len()) || row_idx.len() != self.values.len() {
            return fail!(
                Dimension,
                "{name}: col_ptr ends at {count} entries, but there are {} row indices and {} values",
                row_idx.len(),
                self.values.len()
            );
        }
        Ok(())
    }

    fn sparse_entries(
        &self,
        name: &str,
        col_ptr: &[i64],
        row_idx: &[i64],
        symmetry: Symmetry,
    ) -> Result<Vec<(usize, usize, Complex64)>> {
        let base = self.index_base as i64;
        let mut entries = Vec::new();
        for j in 0..self.cols {
            let range = (col_ptr[j] - base) as usize..(col_ptr[j + 1] - base) as usize;
            for (k, &given) in range.clone().zip(&row_idx[range]) {
                // This wraps for the lowest i64 only, and then to a row that no matrix has.
                let row = given.wrapping_sub(base);
                if row < 0 || row >= self.rows as i64 {
                    return fail!(
                        Index,
                        "{name}: row_idx[{k}] = {given}, needs {base} .. {}",
                        self.rows as i64 - 1 + base
                    );
                }
                self.take(name, (row as usize, j, self.values.get(k)), symmetry, &mut entries)?;
            }
        }
        Ok(entries)
    }

    /// Whether an entry lies in the triangle that is not read.
    fn skips(&self, i: usize, j: usize) -> bool {
        (self.part.skips_upper() && i < j) || (self.part.skips_lower() && i > j)
    }

    /// Stores an entry, and its mirror image where one triangle represents both.
    fn take(
        &self,
        name: &str,
        (i, j, v): (usize, usize, Complex64),
        symmetry: Symmetry,
        entries: &mut Vec<(usize, usize, Complex64)>,
    ) -> Result<()> {
        if self.skips(i, j) {
            return Ok(());
        }
        if !v.is_finite() {
            let what = if v.is_nan() { "NaN" } else { "infinite" };
            let base = self.index_base;
            return fail!(NotFinite, "{name}[{},{}] is {what}", i + base, j + base);
        }
        if v == Complex64::ZERO {
            return Ok(());
        }
        try_push(entries, (i, j, v), name)?;
        if i != j && (self.part.skips_lower() || self.part.skips_upper()) {
            try_push(entries, (j, i, symmetry.mirror(v)), name)?;
        }
        Ok(())
    }

    fn symmetrised(&self, name: &str, a: Csc) -> Result<Csc> {
        let symmetry = self.part.symmetry();
        let (i, j, gap) = a.worst_pair(symmetry);
        let largest = a.max_abs();
        if gap > SYMMETRY_TOLERANCE * largest {
            let one_triangle = a
                .col_ptr
                .windows(2)
                .enumerate()
                .all(|(j, range)| a.row_idx[range[0]..range[1]].iter().all(|&i| i <= j))
                || a.col_ptr
                    .windows(2)
                    .enumerate()
                    .all(|(j, range)| a.row_idx[range[0]..range[1]].iter().all(|&i| i >= j));
            let plain = symmetry == Symmetry::Plain;
            let is_complex_symmetric = || a.worst_pair(Symmetry::Plain).2 <= SYMMETRY_TOLERANCE * largest;
            // Twice a diagonal with loss is no rounding.
            let lossy_diagonal = || (0..a.cols).any(|j| a.get(j, j).im.abs() > SYMMETRY_TOLERANCE * largest);
            let hint = if one_triangle && (plain || lossy_diagonal()) {
                "; it looks like one triangle was passed: say SYMMETRIC_LOWER or SYMMETRIC_UPPER"
            } else if one_triangle {
                "; it looks like one triangle was passed: say LOWER or UPPER"
            } else if !plain && is_complex_symmetric() {
                "; the matrix is complex symmetric: say SYMMETRIC if that is meant, part=\"symmetric\" of set_matrix in Python"
            } else {
                "; say GENERAL if that is meant"
            };
            let base = self.index_base;
            if i == j {
                // The mirror image of an entry of the diagonal is its conjugate: what differs is the imaginary part, twice.
                return fail!(
                    NotHermitian,
                    "{name}[{0},{0}] has the imaginary part {1:.3e}, and the diagonal of a Hermitian matrix is real{hint}",
                    i + base,
                    a.get(i, i).im
                );
            }
            return Err(Error::new(
                Status::NotHermitian,
                format_args!(
                    "{name}[{},{}] and {name}[{},{}] differ by {gap:.3e}, {:.1e} of the largest entry{hint}",
                    i + base,
                    j + base,
                    j + base,
                    i + base,
                    gap / largest
                ),
            ));
        }
        if gap == 0.0 {
            return Ok(a);
        }
        // Average A and its mirror image, Aᵀ or Aᴴ = conj(Aᵀ).
        let transposed = Csc::sum(a.rows, &[(Complex64::ONE, &a, Form::Transposed)])?;
        let half = Complex64::new(0.5, 0.0);
        let form = if symmetry == Symmetry::Plain {
            Form::Plain
        } else {
            Form::Conjugated
        };
        Csc::sum(a.rows, &[(half, &a, Form::Plain), (half, &transposed, form)])
    }
}
