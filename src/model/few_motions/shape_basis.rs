//! A basis of few shapes of one nodal diameter: static shapes of the degrees of freedom of the contacts, whose coordinates
//! are the motions of these, then modal ones, orthogonal to them and to each other with the mass.

use crate::error::{Result, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::inner;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::matrices::structure::MatrixKind;
use num_complex::Complex64;

const CONTEXT: &str = "the model on modes";

/// The shapes, column after column.
pub(crate) struct ShapeBasis {
    /// Number of independent degrees of freedom.
    n: usize,
    /// Number of static shapes.
    fixed: usize,
    /// Factor of the modal shapes: their modal mass is its square.
    scale: f64,
    columns: Vec<Complex64>,
}

impl ShapeBasis {
    pub(crate) fn new(n: usize, fixed: usize, scale: f64, columns: Vec<Complex64>) -> Self {
        Self {
            n,
            fixed,
            scale,
            columns,
        }
    }

    fn all(&self) -> impl Iterator<Item = &[Complex64]> {
        self.columns.chunks_exact(self.n)
    }

    /// Matrix M, C or K projected on the shapes.
    pub fn projected(&self, which: MatrixKind, a: &Csc, interrupt: &Interrupt<'_>) -> Result<Csc> {
        let order = self.columns.len() / self.n;
        let mut entries = Vec::new();
        for (j, column) in self.all().enumerate() {
            interrupt.check_before((a.values.len() + self.columns.len()) as u64)?;
            let image = a.times(column, CONTEXT)?;
            for (i, row) in self.all().enumerate() {
                let value = match which {
                    MatrixKind::Mass if i.max(j) >= self.fixed && i != j => Complex64::ZERO,
                    MatrixKind::Mass if i >= self.fixed => self.scale.powi(2).into(),
                    _ => inner(row, &image),
                };
                if value != Complex64::ZERO {
                    try_push(&mut entries, (i, j, value), CONTEXT)?;
                }
            }
        }
        Csc::from_triplets(order, order, entries)
    }

    /// Forces on the coordinates, from forces on the independent degrees of freedom; `backward`: for the conjugate
    /// wave.
    pub fn forces(&self, force: &[Complex64], backward: bool, out: &mut [Complex64]) {
        for (out, column) in out.iter_mut().zip(self.all()) {
            *out = if backward {
                column.iter().zip(force).map(|(t, f)| t * f).sum()
            } else {
                inner(column, force)
            };
        }
    }

    /// Coordinates of the motion, within the span of the shapes, that is nearest to a given motion; `held` lists the
    /// degrees of freedom of the contacts.
    pub fn coordinates(
        &self,
        (mass, held): (&Csc, &[usize]),
        motion: &[Complex64],
        backward: bool,
        out: &mut [Complex64],
    ) -> Result<()> {
        let turn = |z: Complex64| if backward { z.conj() } else { z };
        let mut turned = try_vec(self.n, Complex64::ZERO, CONTEXT)?;
        for (to, from) in turned.iter_mut().zip(motion) {
            *to = turn(*from);
        }
        let image = mass.times(&turned, CONTEXT)?;
        for (i, (out, column)) in out.iter_mut().zip(self.all()).enumerate() {
            *out = match held.get(i) {
                Some(&dof) => motion[dof],
                None => turn(inner(column, &image)) / self.scale.powi(2),
            };
        }
        Ok(())
    }

    /// Motion of the independent degrees of freedom, from the coordinates.
    pub fn motion(&self, coordinates: &[Complex64], backward: bool, out: &mut [Complex64]) {
        out.fill(Complex64::ZERO);
        for (x, column) in coordinates.iter().zip(self.all()) {
            for (out, t) in out.iter_mut().zip(column) {
                *out += if backward { t.conj() } else { *t } * x;
            }
        }
    }
}
