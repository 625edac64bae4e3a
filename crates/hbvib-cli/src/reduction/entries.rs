//! Real entries of the matrices of a file, and products with them.

use crate::texts::outcome::Outcome;
use hbvib::internals::Csc;
use hbvib_io::{Matrix, Symmetry};
use num_complex::Complex64;

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

    /// A x.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
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
    ///
    /// # Errors
    /// Those of the library.
    pub fn within(&self, number: &[Option<usize>], n: usize) -> Outcome<Csc> {
        let of = |(i, j, v): &(u32, u32, f64)| Some((number[*i as usize]?, number[*j as usize]?, Complex64::from(*v)));
        Csc::from_triplets(n, n, self.all.iter().filter_map(of).collect()).map_err(|e| e.to_string())
    }
}
