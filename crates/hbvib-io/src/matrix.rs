//! Matrices as lists of entries.

use crate::Result;
use crate::lines::Lines;

/// Largest order: that of the models of hbvib.
const LARGEST: usize = 1 << 31;

/// Orders up to this need no file of a size.
const SMALL: usize = 1 << 20;

/// Relation of an entry to its mirror image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// All entries are listed.
    General,
    /// Each entry off the diagonal stands for its mirror image, too.
    Symmetric,
    /// Its mirror image is the conjugate.
    Hermitian,
    /// Its mirror image has the other sign.
    Skew,
}

/// A sparse matrix. Entries at the same place add up.
#[derive(Clone, Debug)]
pub struct Matrix {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Relation of entries to their mirror images.
    pub symmetry: Symmetry,
    /// Row of each entry, from 0.
    pub row: Vec<u32>,
    /// Column of each entry, from 0.
    pub column: Vec<u32>,
    /// Values, one number an entry, or two (real and imaginary part) if complex.
    pub values: Vec<f64>,
    /// Values have an imaginary part.
    pub is_complex: bool,
}

/// Node number and direction of a degree of freedom.
pub type Dof = (i64, i64);

/// Matrices of a file. A format that does not say what it holds has its matrix as stiffness.
#[derive(Clone, Debug, Default)]
pub struct Matrices {
    /// K
    pub stiffness: Option<Matrix>,
    /// M
    pub mass: Option<Matrix>,
    /// C
    pub damping: Option<Matrix>,
    /// D of structural damping iD
    pub structural: Option<Matrix>,
    /// Node and direction of each degree of freedom, 0 for a direction that the file does not name; empty if it names no nodes.
    pub dofs: Vec<Dof>,
    /// Names of matrices of the file that are none of these, and were left out.
    pub others: Vec<String>,
    /// Sentences on signs that the file is not whole, which [`report`](crate::report) has as warnings.
    pub doubts: Vec<String>,
}

impl Matrices {
    /// The matrices that are there, with their names.
    pub fn named(&self) -> impl Iterator<Item = (&'static str, &Matrix)> {
        let all = [
            ("stiffness", &self.stiffness),
            ("mass", &self.mass),
            ("damping", &self.damping),
            ("structural", &self.structural),
        ];
        all.into_iter().filter_map(|(name, a)| a.as_ref().map(|a| (name, a)))
    }
}

impl Matrix {
    /// A matrix without entries, and memory for `entries` of them.
    ///
    /// # Errors
    /// Sizes that the file cannot hold; memory.
    pub(crate) fn new(
        lines: &Lines,
        (rows, columns): (usize, usize),
        symmetry: Symmetry,
        (entries, is_complex): (usize, bool),
    ) -> Result<Self> {
        let most = LARGEST.min(SMALL.max(lines.length()));
        if rows > most || columns > most {
            return lines.fail(format_args!(
                "a matrix of {rows} x {columns} in a file of {} bytes, needs at most {most} rows and columns",
                lines.length()
            ));
        }
        if symmetry != Symmetry::General && rows != columns {
            return lines.fail(format_args!(
                "a symmetric matrix of {rows} x {columns}, needs a square one"
            ));
        }
        if entries > lines.length() {
            return lines.fail(format_args!("{entries} entries in a file of {} bytes", lines.length()));
        }
        let mut matrix = Self::empty((rows, columns), symmetry, is_complex);
        // A number and a separator are at least two bytes.
        let likely = entries.min(lines.length() / 4);
        let numbers = if is_complex { 2 * likely } else { likely };
        let reserved = matrix.row.try_reserve_exact(likely).is_ok()
            && matrix.column.try_reserve_exact(likely).is_ok()
            && matrix.values.try_reserve_exact(numbers).is_ok();
        if reserved {
            Ok(matrix)
        } else {
            lines.fail("no memory for the entries")
        }
    }

    /// A matrix without entries.
    pub(crate) fn empty((rows, columns): (usize, usize), symmetry: Symmetry, is_complex: bool) -> Self {
        Self {
            rows,
            columns,
            symmetry,
            row: Vec::new(),
            column: Vec::new(),
            values: Vec::new(),
            is_complex,
        }
    }

    /// Number of entries.
    #[must_use]
    pub fn entries(&self) -> usize {
        self.row.len()
    }

    /// Adds an entry. Zeros are kept out.
    ///
    /// # Errors
    /// Memory.
    pub(crate) fn push(&mut self, lines: &Lines, row: u32, column: u32, value: (f64, f64)) -> Result<()> {
        if self.add(row, column, value) {
            Ok(())
        } else {
            lines.fail("no memory for the entries")
        }
    }

    /// Adds an entry, unless it is zero; `false` without memory.
    pub(crate) fn add(&mut self, row: u32, column: u32, value: (f64, f64)) -> bool {
        if value == (0.0, 0.0) {
            return true;
        }
        let reserved =
            self.row.try_reserve(1).is_ok() && self.column.try_reserve(1).is_ok() && self.values.try_reserve(2).is_ok();
        if reserved {
            self.row.push(row);
            self.column.push(column);
            self.values.push(value.0);
            if self.is_complex {
                self.values.push(value.1);
            }
        }
        reserved
    }

    /// Whether some entry is listed at its place and at that of its mirror image.
    pub(crate) fn lists_mirror_images(&self) -> bool {
        let mut places: Vec<(u32, u32, bool)> = self
            .row
            .iter()
            .zip(&self.column)
            .filter(|(row, column)| row != column)
            .map(|(&row, &column)| (row.min(column), row.max(column), row < column))
            .collect();
        places.sort_unstable();
        places
            .windows(2)
            .any(|two| (two[0].0, two[0].1) == (two[1].0, two[1].1) && two[0].2 != two[1].2)
    }

    /// Frees what was reserved and not used.
    pub(crate) fn finished(mut self) -> Self {
        self.row.shrink_to_fit();
        self.column.shrink_to_fit();
        self.values.shrink_to_fit();
        self
    }
}
