//! Craig-Bampton reduction: the motion of kept degrees of freedom, the static motion that follows them, and natural modes with these
//! fixed.

use crate::build::Outcome;
use hbvib::linalg::factor::Factor;
use hbvib::linalg::sparse::Csc;
use hbvib::{ContactState, Interrupt, MatrixKind, MatrixView, Model, Part, Storage, Values};
use hbvib_io::{Matrices, Matrix, Symmetry};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Columns that are solved at a time.
const TOGETHER: usize = 32;

/// First number of modes.
const FIRST: usize = 20;

/// Entries of a reduced matrix below this share of its diagonal are rounding.
const ROUNDING: f64 = 1e-14;

/// The basis: columns of length n, those of the kept degrees of freedom first.
pub struct Basis {
    n: usize,
    kept: usize,
    columns: Vec<Vec<f64>>,
    /// Frequencies of the modes with the kept degrees of freedom fixed, Hz.
    pub fixed_hz: Vec<f64>,
    /// Rows of the interior, and its stiffness and mass.
    rows: Vec<usize>,
    inner: (Csc, Csc),
}

/// Number of modes, or the frequency up to which all are taken.
#[derive(Clone, Copy, Debug)]
pub enum Modes {
    Count(usize),
    UpTo(f64),
}

/// Real entries of a matrix, each with its mirror image.
pub struct Entries {
    all: Vec<(u32, u32, f64)>,
}

impl Entries {
    /// The entries of a matrix.
    ///
    /// # Errors
    /// A sentence with its name: a complex matrix.
    pub fn of(name: &str, a: &Matrix) -> Outcome<Self> {
        if a.is_complex {
            return Err(format!("the {name} is complex, needs a real matrix"));
        }
        let mut all = Vec::with_capacity(2 * a.entries());
        for (k, v) in a.values.iter().enumerate() {
            let (i, j) = (a.row[k], a.column[k]);
            all.push((i, j, *v));
            if i != j {
                match a.symmetry {
                    Symmetry::General => {}
                    Symmetry::Symmetric | Symmetry::Hermitian => all.push((j, i, *v)),
                    Symmetry::Skew => all.push((j, i, -v)),
                }
            }
        }
        Ok(Self { all })
    }

    fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        for (i, j, v) in &self.all {
            y[*i as usize] += v * x[*j as usize];
        }
        y
    }

    /// A x of a complex x.
    pub fn times_complex(&self, x: &[Complex64]) -> Vec<Complex64> {
        let mut y = vec![Complex64::ZERO; x.len()];
        for (i, j, v) in &self.all {
            y[*i as usize] += x[*j as usize] * *v;
        }
        y
    }

    /// xᴴ A x of a symmetric matrix.
    pub fn energy(&self, x: &[Complex64]) -> f64 {
        let y = self.times_complex(x);
        x.iter().zip(&y).map(|(x, y)| (x.conj() * y).re).sum::<f64>().max(0.0)
    }

    /// Entries between rows that have a number.
    fn within(&self, number: &[Option<usize>], n: usize) -> Outcome<Csc> {
        let of = |(i, j, v): &(u32, u32, f64)| Some((number[*i as usize]?, number[*j as usize]?, Complex64::from(*v)));
        Csc::from_triplets(n, n, self.all.iter().filter_map(of).collect()).map_err(|e| e.to_string())
    }
}

impl Basis {
    /// The basis of a stiffness and a mass, without modes; rows that are fixed have no motion.
    ///
    /// # Errors
    /// A sentence: complex matrices, an interior that the kept degrees of freedom do not hold; those of the library.
    pub fn new(found: &Matrices, kept: &[usize], fixed: &[usize]) -> Outcome<Self> {
        let (Some(k), Some(m)) = (&found.stiffness, &found.mass) else {
            return Err("needs stiffness and mass".into());
        };
        let n = k.rows;
        let (stiffness, mass) = (Entries::of("stiffness", k)?, Entries::of("mass", m)?);
        let mut inner: Vec<Option<usize>> = vec![Some(0); n];
        for row in kept.iter().chain(fixed) {
            *inner
                .get_mut(*row)
                .ok_or_else(|| format!("there is no degree of freedom {row}"))? = None;
        }
        let mut rows = Vec::new();
        for (row, number) in inner.iter_mut().enumerate().filter(|(_, number)| number.is_some()) {
            *number = Some(rows.len());
            rows.push(row);
        }
        if rows.is_empty() {
            return Err("all degrees of freedom are kept: there is nothing to reduce".into());
        }
        let inner = (stiffness.within(&inner, rows.len())?, mass.within(&inner, rows.len())?);
        let mut basis = Self {
            n,
            kept: kept.len(),
            columns: Vec::new(),
            fixed_hz: Vec::new(),
            rows,
            inner,
        };
        basis.constraint_modes(&stiffness, kept)?;
        Ok(basis)
    }

    /// Static motion of the interior under unit motions of the kept degrees of freedom.
    fn constraint_modes(&mut self, stiffness: &Entries, kept: &[usize]) -> Outcome<()> {
        let (inner, rows) = (&self.inner.0, &self.rows);
        let held = |e: hbvib::Error| format!("the interior is not held by the kept degrees of freedom: {e}");
        let none = Interrupt::none();
        let mut factor = Factor::new(inner, TOGETHER).map_err(|e| e.to_string())?;
        factor.factor(inner, &none).map_err(held)?;
        for some in kept.chunks(TOGETHER) {
            let mut load = Vec::with_capacity(some.len() * rows.len());
            for row in some {
                let mut unit = vec![0.0; self.n];
                unit[*row] = 1.0;
                let force = stiffness.times(&unit);
                load.extend(rows.iter().map(|row| Complex64::from(-force[*row])));
            }
            factor.solve(&mut load, false, &none).map_err(held)?;
            for (row, motion) in some.iter().zip(load.chunks_exact(rows.len())) {
                let mut column = vec![0.0; self.n];
                column[*row] = 1.0;
                for (at, x) in rows.iter().zip(motion) {
                    column[*at] = x.re;
                }
                self.columns.push(column);
            }
        }
        Ok(())
    }

    /// Takes the lowest modes with the kept degrees of freedom fixed, in place of those before.
    ///
    /// # Errors
    /// Those of the library.
    pub fn set_modes(&mut self, modes: Modes) -> Outcome<()> {
        self.columns.truncate(self.kept);
        self.fixed_hz.clear();
        let (rows, (k, m)) = (&self.rows, (&self.inner.0, &self.inner.1));
        let said = |e: hbvib::Error| format!("modes with fixed interface: {e}");
        let mut model = Model::new(rows.len()).map_err(said)?;
        for (kind, a) in [(MatrixKind::Stiffness, k), (MatrixKind::Mass, m)] {
            let whole = |all: &[usize]| all.iter().map(|n| *n as i64).collect::<Vec<i64>>();
            let (col_ptr, row_idx) = (whole(&a.col_ptr), whole(&a.row_idx));
            let values: Vec<f64> = a.values.iter().map(|v| v.re).collect();
            let view = MatrixView {
                rows: a.rows,
                cols: a.cols,
                storage: Storage::Csc {
                    col_ptr: &col_ptr,
                    row_idx: &row_idx,
                },
                values: Values::Real(&values),
                part: Part::Full,
                index_base: 0,
            };
            model.set_matrix(kind, &view).map_err(said)?;
        }
        let mut count = match modes {
            Modes::Count(count) => count,
            Modes::UpTo(_) => FIRST,
        }
        .min(rows.len());
        if count == 0 {
            return Ok(());
        }
        let (found, wanted) = loop {
            let found = model.lowest_modes(0, ContactState::Free, count).map_err(said)?;
            let Modes::UpTo(hertz) = modes else {
                break (found, count);
            };
            let below = found.omega.iter().filter(|w| **w <= TAU * hertz).count();
            // A mode above shows that none below is missing.
            if below < found.omega.len() || count == rows.len() || found.omega.len() < count {
                break (found, below);
            }
            count = (2 * count).min(rows.len());
        };
        for (omega, shape) in found
            .omega
            .iter()
            .zip(found.shapes.chunks_exact(rows.len()))
            .take(wanted)
        {
            let mut column = vec![0.0; self.n];
            for (at, x) in rows.iter().zip(shape) {
                column[*at] = x.re;
            }
            self.columns.push(column);
            self.fixed_hz.push(omega / TAU);
        }
        Ok(())
    }

    /// Number of degrees of freedom of the interior.
    pub fn interior(&self) -> usize {
        self.rows.len()
    }

    /// Number of reduced coordinates.
    pub fn order(&self) -> usize {
        self.columns.len()
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
        for (j, column) in self.columns.iter().enumerate() {
            let force = entries.times(column);
            // One triangle of a symmetric matrix is enough.
            let first = if symmetric { j } else { 0 };
            for (i, left) in self.columns.iter().enumerate().skip(first) {
                dense[i * order + j] = left.iter().zip(&force).map(|(x, f)| x * f).sum();
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

    /// Number of kept degrees of freedom.
    pub fn kept(&self) -> usize {
        self.kept
    }
}
