//! Shapes of a nodal diameter for a model on few motions: the static shapes of the degrees of freedom on which contacts
//! act, and the lowest natural modes with all contacts stuck.
//!
//! A static shape has the value 1 at its own degree of freedom and 0 at those of the other contacts; modes are taken
//! without their static part, so that they leave all contacts unstrained, as in component mode synthesis (Craig &
//! Bampton 1968, doi:10.2514/3.4741). The space contains the modes of the stuck structure exactly, and the response of
//! the structure at rest to every force of the contacts. The shapes of the structure at rest under the forces of the model
//! come before the modes, as in the mode acceleration method.

use crate::error::{Result, check_memory, fail, try_copy, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::shifted_inverse::Inverse;
use crate::linalg::libraries::DMatrix;
use crate::linalg::sparse_storage::definite::resists_all_motion;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::linalg::{inner, remove};
use crate::model::Model;
use crate::model::few_motions::shape_basis::ShapeBasis;
use crate::model::matrices::structure::MatrixKind;
use crate::model::matrices::wave::Wave;
use crate::model::natural_modes::linear_modes::ContactState;
use num_complex::Complex64;

const CONTEXT: &str = "the modes of the stuck structure";

/// Norm of a mode without what shapes before it have in common with it, below which it is no new shape.
/// Kind: rounding.
const STUCK_SHAPES_DEPENDENT: f64 = 1e-6;

/// Shift of a structure that no stiffness holds, relative to its stiffness per mass, where its motion at rest is wanted.
/// Kind: tuned; measured on: not recorded.
pub(crate) const FREE_SHIFT: f64 = 1e-7;

/// Shapes of one nodal diameter, column after column.
pub(crate) struct StuckShapes {
    /// Number of independent degrees of freedom.
    n: usize,
    /// Static shapes, in the order of the contacts' degrees of freedom.
    fixed: Vec<Complex64>,
    /// Shapes under the forces of the model, then those from the modes in ascending order of frequency: orthonormal with
    /// the mass, without motion of the contacts.
    modal: Vec<Complex64>,
    mass: Csc,
    damping: Csc,
    stiffness: Csc,
    /// Natural angular frequencies of the modes found, ascending.
    pub omega: Vec<f64>,
}

impl StuckShapes {
    /// Computes the shapes of a nodal diameter, at most `modes` of them from forces and modes. `held` lists the
    /// independent degrees of freedom of the contacts, `forces` the amplitudes of the forces of this diameter.
    ///
    /// # Errors
    /// `NotHermitian` for a stiffness without modes; those of the eigensolvers; `OutOfMemory`; `StoppedByCaller`.
    pub fn new(
        model: &Model,
        diameter: i64,
        (held, forces): (&[usize], &[Vec<Complex64>]),
        modes: usize,
        interrupt: &Interrupt<'_>,
    ) -> Result<Self> {
        let structure = model.structure();
        let n = structure.ndof();
        let wave = Wave::Diameter(diameter);
        let mut pencil = model.pencil(wave, ContactState::Stuck)?;
        pencil.leave_out_gyroscopic();
        // Motions without any of the contacts are at most so many.
        let modes = modes.min(n - held.len());
        // A mode may be static to rounding, and has then no part of its own.
        let found = pencil.lowest((modes + held.len()).min(n), interrupt)?;
        let is_real = pencil.stiffness.is_real() && pencil.mass.is_real();
        let mut inverse = stiffness_factors(&pencil.stiffness, &pencil.mass, interrupt)?;
        let fixed = static_shapes(&mut inverse, n, held, interrupt)?;
        let mut shapes = Self {
            n,
            fixed,
            modal: Vec::new(),
            mass: structure.of_wave(MatrixKind::Mass, wave)?,
            damping: structure.of_wave(MatrixKind::Damping, wave)?,
            stiffness: model.stiffness_at_small_motion(wave, ContactState::Free)?,
            omega: found.omega,
        };
        for force in forces {
            let mut shape = try_copy(force, CONTEXT)?;
            inverse.solve(&mut shape, interrupt)?;
            let norm = inner(&shape, &shapes.mass.times(&shape, CONTEXT)?).re.max(0.0).sqrt();
            for z in &mut shape {
                *z /= norm.max(f64::MIN_POSITIVE);
            }
            shapes.add_mode(&shape, held, is_real, interrupt)?;
        }
        for shape in found.shapes.chunks_exact(n) {
            if shapes.modes() == modes {
                break;
            }
            shapes.add_mode(shape, held, is_real, interrupt)?;
        }
        shapes.modal.truncate(modes * n);
        shapes.omega.truncate(modes);
        Ok(shapes)
    }

    /// Number of shapes from modes.
    pub fn modes(&self) -> usize {
        self.modal.len() / self.n
    }

    /// Largest entry of the modal shapes.
    pub fn largest(&self) -> f64 {
        self.modal.iter().fold(0.0_f64, |m, z| m.max(z.norm()))
    }

    /// A basis of the first `modal` modal shapes, multiplied by `scale`, and of the static shapes made orthogonal to
    /// these.
    pub fn basis(&self, held: &[usize], modal: usize, scale: f64, interrupt: &Interrupt<'_>) -> Result<ShapeBasis> {
        let n = self.n;
        let modes = &self.modal[..modal * n];
        let mut columns = try_copy(&self.fixed, CONTEXT)?;
        for (i, x) in columns.chunks_exact_mut(n).enumerate() {
            interrupt.check_before(modes.len() as u64)?;
            for _ in 0..2 {
                let image = self.mass.times(x, CONTEXT)?;
                for column in modes.chunks_exact(n) {
                    remove(x, column, inner(column, &image));
                }
            }
            for (j, &dof) in held.iter().enumerate() {
                x[dof] = if i == j { Complex64::ONE } else { Complex64::ZERO };
            }
        }
        for z in modes {
            try_push(&mut columns, z * scale, CONTEXT)?;
        }
        Ok(ShapeBasis::new(n, held.len(), scale, columns))
    }

    /// Matrix M, C or K of this nodal diameter.
    pub fn matrix(&self, which: MatrixKind) -> &Csc {
        match which {
            MatrixKind::Mass => &self.mass,
            MatrixKind::Damping => &self.damping,
            _ => &self.stiffness,
        }
    }

    /// Appends the part of a mode that is not in the span of the shapes yet; for a real structure its real and
    /// imaginary parts.
    fn add_mode(
        &mut self,
        shape: &[Complex64],
        held: &[usize],
        is_real: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let mut unheld = try_vec(self.n, Complex64::ZERO, CONTEXT)?;
        unheld.copy_from_slice(shape);
        for (i, &dof) in held.iter().enumerate() {
            interrupt.check_before(self.n as u64)?;
            let value = shape[dof];
            for (u, t) in unheld.iter_mut().zip(&self.fixed[i * self.n..]) {
                *u -= value * t;
            }
        }
        for &dof in held {
            unheld[dof] = Complex64::ZERO;
        }
        if !is_real {
            return self.add_new(unheld);
        }
        for part in [|z: Complex64| z.re, |z: Complex64| z.im] {
            let mut real = try_vec(self.n, Complex64::ZERO, CONTEXT)?;
            for (real, z) in real.iter_mut().zip(&unheld) {
                *real = part(*z).into();
            }
            self.add_new(real)?;
        }
        Ok(())
    }

    fn add_new(&mut self, mut x: Vec<Complex64>) -> Result<()> {
        for _ in 0..2 {
            let image = self.mass.times(&x, CONTEXT)?;
            for column in self.modal.chunks_exact(self.n) {
                remove(&mut x, column, inner(column, &image));
            }
        }
        // Modes have norm 1.
        let norm = inner(&x, &self.mass.times(&x, CONTEXT)?).re.max(0.0).sqrt();
        if norm > STUCK_SHAPES_DEPENDENT {
            for z in x {
                try_push(&mut self.modal, z / norm, CONTEXT)?;
            }
        }
        Ok(())
    }
}

/// Factors of the stiffness, shifted where some motion has no stiffness.
fn stiffness_factors(k: &Csc, m: &Csc, interrupt: &Interrupt<'_>) -> Result<Inverse> {
    let diagonal = |a: &Csc| (0..k.rows).map(|i| a.get(i, i).re).sum::<f64>();
    let shift = if resists_all_motion(k, interrupt)? {
        0.0
    } else {
        FREE_SHIFT * diagonal(k) / diagonal(m).max(f64::MIN_POSITIVE)
    };
    Inverse::new(k, (shift, m), interrupt)
}

/// Static shapes of the structure: in each, one degree of freedom of the contacts is displaced and the others are
/// held.
fn static_shapes(inverse: &mut Inverse, n: usize, held: &[usize], interrupt: &Interrupt<'_>) -> Result<Vec<Complex64>> {
    let count = held.len();
    check_memory::<Complex64>(2 * n * count + 3 * count * count, CONTEXT)?;
    let mut compliance = DMatrix::<Complex64>::zeros(n, count);
    for (mut column, &dof) in compliance.column_iter_mut().zip(held) {
        column[dof] = Complex64::ONE;
        inverse.solve(column.as_mut_slice(), interrupt)?;
    }
    let own = DMatrix::from_fn(count, count, |i, j| compliance[(held[i], j)]);
    let Some(stiffness) = own.try_inverse() else {
        return fail!(Singular, "the static shapes of the contacts are not independent");
    };
    interrupt.check_before((n * count * count) as u64)?;
    let shapes = compliance * stiffness;
    let mut found = try_vec(n * count, Complex64::ZERO, CONTEXT)?;
    found.copy_from_slice(shapes.as_slice());
    Ok(found)
}
