//! Stiffness and mass of the rows of a model that move in a reduction, and their lowest natural modes.

use crate::reduction::entries::Entries;
use crate::texts::outcome::Outcome;
use hbvib::internals::Csc;
use hbvib::internals::Factor;
use hbvib::{ContactState, Interrupt, LinearModes, MatrixKind, MatrixView, Model, Part, Storage, Values};
use hbvib_io::Matrices;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Columns that are solved at a time.
pub const TOGETHER: usize = 32;

/// First number of modes.
const FIRST: usize = 20;

/// Number of modes, or the frequency up to which all are taken.
#[derive(Clone, Copy, Debug)]
pub enum Modes {
    Count(usize),
    UpTo(f64),
}

/// A matrix, factored for [`TOGETHER`] right-hand sides at a time.
///
/// # Errors
/// Those of the library: a matrix that is singular.
pub fn factored(a: &Csc) -> Result<Factor, hbvib::Error> {
    let mut factor = Factor::new(a, TOGETHER)?;
    factor.factor(a, &Interrupt::none())?;
    Ok(factor)
}

/// The matrices between rows that move.
pub struct Pencil {
    n: usize,
    /// Rows that move, of the n of the model.
    pub rows: Vec<usize>,
    pub stiffness: Csc,
    pub mass: Csc,
}

impl Pencil {
    /// The rows of a model but some.
    ///
    /// # Errors
    /// A sentence: complex or missing matrices, a row that is not there; those of the library.
    pub fn without<'a>(still: impl Iterator<Item = &'a usize>, found: &Matrices) -> Outcome<Self> {
        let (Some(k), Some(m)) = (&found.stiffness, &found.mass) else {
            return Err("needs stiffness and mass".into());
        };
        let n = k.rows;
        let mut numbers: Vec<Option<usize>> = vec![Some(0); n];
        for row in still {
            *numbers
                .get_mut(*row)
                .ok_or_else(|| format!("there is no degree of freedom {row}"))? = None;
        }
        let mut rows = Vec::new();
        for (row, number) in numbers.iter_mut().enumerate().filter(|(_, number)| number.is_some()) {
            *number = Some(rows.len());
            rows.push(row);
        }
        Ok(Self {
            stiffness: Entries::of("stiffness", k)?.within(&numbers, rows.len())?,
            mass: Entries::of("mass", m)?.within(&numbers, rows.len())?,
            n,
            rows,
        })
    }

    /// Number of rows that move.
    pub fn order(&self) -> usize {
        self.rows.len()
    }

    /// The motion of all n rows.
    pub fn spread(&self, motion: &[Complex64]) -> Vec<f64> {
        let mut column = vec![0.0; self.n];
        for (at, x) in self.rows.iter().zip(motion) {
            column[*at] = x.re;
        }
        column
    }

    /// The lowest modes, and how many of them are asked for: the first mode above a frequency shows that none below is missing.
    ///
    /// # Errors
    /// Those of the library.
    pub fn lowest(&self, modes: Modes) -> Outcome<(LinearModes, usize)> {
        let said = |e: hbvib::Error| e.to_string();
        let order = self.order();
        let mut count = match modes {
            Modes::Count(count) => count,
            Modes::UpTo(_) => FIRST,
        }
        .min(order);
        if count == 0 {
            let none = LinearModes {
                omega: Vec::new(),
                shapes: Vec::new(),
            };
            return Ok((none, 0));
        }
        let mut model = Model::new(order).map_err(said)?;
        for (kind, a) in [(MatrixKind::Stiffness, &self.stiffness), (MatrixKind::Mass, &self.mass)] {
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
        loop {
            let found = model.lowest_modes(0, ContactState::Free, count).map_err(said)?;
            let below = match modes {
                Modes::Count(_) => found.omega.len(),
                Modes::UpTo(hertz) => found.omega.iter().filter(|w| **w <= TAU * hertz).count(),
            };
            let is_enough = matches!(modes, Modes::Count(_)) || below < found.omega.len();
            if is_enough || count == order || found.omega.len() < count {
                return Ok((found, below));
            }
            count = (2 * count).min(order);
        }
    }
}
