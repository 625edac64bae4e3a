//! The basis of a reduced model, by either method, and matrices on it. Kept degrees of freedom are coordinates of it.

use crate::reduction::craig_bampton::FixedInterface;
use crate::reduction::entries::Entries;
use crate::reduction::free_interface::FreeInterface;
use crate::reduction::pencil::Modes;
use crate::texts::arguments::MethodName;
use crate::texts::outcome::Outcome;
use hbvib::internals::Csc;
use hbvib_io::{Matrices, Matrix, Symmetry};
use num_complex::Complex64;

/// Entries of a reduced matrix below this share of its diagonal are rounding.
const ROUNDING: f64 = 1e-14;

/// The basis: columns of length n. Those of the kept degrees of freedom are first; each has a one in its own row and zeros in the rows
/// of the others, and columns of modes have zeros in all of these rows.
pub struct Basis {
    form: Form,
    kept: usize,
    columns: Vec<Vec<f64>>,
    /// Frequencies of the modes, Hz.
    pub mode_hz: Vec<f64>,
    /// Whether there are no more modes.
    pub is_complete: bool,
}

/// The parts of a basis that do not change with the number of modes.
enum Form {
    CraigBampton(FixedInterface),
    FreeInterface(FreeInterface),
}

impl Basis {
    /// The basis of a stiffness and a mass, without modes; rows that are fixed have no motion.
    ///
    /// # Errors
    /// A sentence: complex matrices, an interior that the kept degrees of freedom do not hold; those of the library.
    pub fn new(method: MethodName, found: &Matrices, kept: &[usize], fixed: &[usize]) -> Outcome<Self> {
        let (form, columns) = match method {
            MethodName::CraigBampton => {
                let (form, columns) = FixedInterface::new(found, kept, fixed)?;
                (Form::CraigBampton(form), columns)
            }
            MethodName::FreeInterface => (Form::FreeInterface(FreeInterface::new(found, kept, fixed)?), Vec::new()),
        };
        Ok(Self {
            form,
            kept: kept.len(),
            columns,
            mode_hz: Vec::new(),
            is_complete: false,
        })
    }

    /// Takes the lowest modes, in place of those before.
    ///
    /// # Errors
    /// Those of the library.
    pub fn set_modes(&mut self, modes: Modes) -> Outcome<()> {
        match &self.form {
            Form::CraigBampton(form) => {
                let found = form.modes(modes)?;
                self.columns.truncate(self.kept);
                self.columns.extend(found.columns);
                self.mode_hz = found.hertz;
                self.is_complete = found.is_complete;
            }
            Form::FreeInterface(form) => {
                let found = form.motions(modes)?;
                self.columns = found.columns;
                self.mode_hz = found.hertz;
                self.is_complete = found.is_complete;
            }
        }
        Ok(())
    }

    /// Number of kept degrees of freedom.
    pub fn kept(&self) -> usize {
        self.kept
    }

    /// Number of reduced coordinates.
    pub fn order(&self) -> usize {
        self.columns.len()
    }

    /// The transposed basis. A row of a kept degree of freedom has one entry.
    fn rows(&self) -> Csc {
        let n = self.columns.first().map_or(0, Vec::len);
        let mut rows = Csc {
            rows: self.order(),
            cols: n,
            col_ptr: vec![0],
            ..Csc::default()
        };
        for row in 0..n {
            for (k, column) in self.columns.iter().enumerate() {
                if column[row] != 0.0 {
                    rows.row_idx.push(k);
                    rows.values.push(Complex64::from(column[row]));
                }
            }
            rows.col_ptr.push(rows.values.len());
        }
        rows
    }

    /// A matrix on the basis.
    ///
    /// # Errors
    /// A sentence: a complex matrix.
    pub fn reduced(&self, name: &str, a: &Matrix) -> Outcome<Matrix> {
        let entries = Entries::of(name, a)?;
        let order = self.order();
        let symmetric = matches!(a.symmetry, Symmetry::Symmetric | Symmetry::Hermitian);
        let mut dense = vec![0.0; order * order];
        let rows = self.rows();
        let all: Vec<Option<usize>> = (0..rows.cols).map(Some).collect();
        let matrix = entries.within(&all, rows.cols)?;
        for (j, column) in self.columns.iter().enumerate() {
            let motion: Vec<Complex64> = column.iter().map(|x| Complex64::from(*x)).collect();
            let mut force = vec![Complex64::ZERO; rows.cols];
            matrix.multiply_add(Complex64::ONE, &motion, &mut force);
            let mut on_columns = vec![Complex64::ZERO; order];
            rows.multiply_add(Complex64::ONE, &force, &mut on_columns);
            for (i, force) in on_columns.iter().enumerate() {
                dense[i * order + j] = force.re;
            }
        }
        let mut reduced = Matrix {
            rows: order,
            columns: order,
            symmetry: if symmetric {
                Symmetry::Symmetric
            } else {
                Symmetry::General
            },
            row: Vec::new(),
            column: Vec::new(),
            values: Vec::new(),
            is_complex: false,
        };
        let scale = |i: usize| dense[i * order + i].abs();
        for i in 0..order {
            for j in 0..if symmetric { i + 1 } else { order } {
                let value = dense[i * order + j];
                if value.abs() > ROUNDING * (scale(i) * scale(j)).sqrt() || i == j {
                    reduced.row.push(i as u32);
                    reduced.column.push(j as u32);
                    reduced.values.push(value);
                }
            }
        }
        Ok(reduced)
    }
}
