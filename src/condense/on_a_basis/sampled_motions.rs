//! Samples of the motion of a wave under damping that is no combination of mass and stiffness: solutions at some frequencies.
//!
//! Images by such damping would double each block of a Krylov basis. Solutions next to the frequencies of the largest residuals, one
//! after the other, reach the same certificate with a tenth of the columns (a rational Krylov space whose points residuals choose:
//! Hesthaven, Rozza & Stamm 2016, doi:10.1007/978-3-319-22470-1, §3.2).

use crate::condense::on_a_basis::wave_matrices::{Assembled, Damping};
use crate::error::{Result, Status, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::factor::Factor;
use crate::linalg::iterative::block_krylov::SparseVector;
use crate::linalg::sparse_storage::sparse::{Columns, Csc, Form, aligned};
use crate::linalg::sparse_storage::triangle::Entry;
use num_complex::Complex64;

const CONTEXT: &str = "the reduced structure";

/// K, C and M of a wave on one pattern, with factors of their sums.
pub(crate) struct Samples {
    loss_factor: f64,
    factor: Factor,
    z: Csc,
    parts: [Vec<Complex64>; 3],
}

impl Samples {
    /// Memory for the matrices of a wave, with the loss factor of its stiffness, and `inputs` forces; `None` where its damping extends no
    /// basis.
    pub fn new(wave: &Assembled<'_>, loss_factor: f64, inputs: usize) -> Result<Option<Self>> {
        let Damping::General(damping) = &wave.damping else {
            return Ok(None);
        };
        let n = damping.columns();
        let none = Complex64::ZERO;
        let own = Csc::sum(n, &[&wave.stiffness, &wave.mass].map(|a| (none, a, Form::Plain)))?;
        let z = Csc::sum(n, &[&own, damping].map(|a| (none, a, Form::Plain)))?;
        Ok(Some(Self {
            loss_factor,
            factor: Factor::new(&z, inputs)?,
            parts: [
                aligned(&wave.stiffness, &z)?,
                aligned(damping, &z)?,
                aligned(&wave.mass, &z)?,
            ],
            z,
        }))
    }

    /// Motions under the forces `inputs` at the angular frequency ν, of real entries the parts in phase, then those out of phase; `None`
    /// at an undamped resonance.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn motions<T: Entry>(
        &mut self,
        nu: f64,
        inputs: &[SparseVector],
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Vec<T>>> {
        let n = self.z.cols.max(1);
        let [stiffness, damping, mass] = &self.parts;
        let lossy = Complex64::new(1.0, self.loss_factor * nu.signum());
        for (at, z) in self.z.values.iter_mut().enumerate() {
            *z = lossy * stiffness[at] + Complex64::new(0.0, nu) * damping[at] - nu * nu * mass[at];
        }
        let mut x = try_vec(n * inputs.len(), Complex64::ZERO, CONTEXT)?;
        for (column, input) in x.chunks_exact_mut(n).zip(inputs) {
            for &(p, force) in input {
                column[p] += force;
            }
        }
        let factored = self.factor.factor(&self.z, interrupt);
        match factored.and_then(|()| self.factor.solve(&mut x, false, interrupt)) {
            Ok(()) => {}
            Err(e) if e.status == Status::Singular => return Ok(None),
            Err(e) => return Err(e),
        }
        let mut motions = Vec::new();
        for z in &x {
            try_push(&mut motions, T::of(*z), CONTEXT)?;
        }
        for z in x.iter().filter(|_| !T::IS_COMPLEX) {
            try_push(&mut motions, T::of(z.im.into()), CONTEXT)?;
        }
        Ok(Some(motions))
    }
}
