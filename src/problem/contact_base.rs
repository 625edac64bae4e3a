//! The matrix of what each contact does for most of the period, which is solved harmonic by harmonic: it sticks with its stiffness s,
//! or slides without any.
//!
//! Newton's matrix J = 1 + G (∂f/∂y − κ) is then D + G F with
//!
//! > D = 1 + G (s − κ),  F = ∂f/∂y − s,
//!
//! where D couples no harmonics and F has a low rank: that of a slider in gross slip counts the short times for which it sticks. In the
//! mean s is κ, since nothing else may hold a contact there.

use crate::condense::Condensed;
use crate::condense::by_factors::flexibility::Table;
use crate::error::{Result, Status, try_push, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;
use crate::linalg::dense::complex_columns;
use crate::linalg::factors::lu::Lu;
use crate::problem::contact_forces::ContactForces;
use crate::problem::parametric_problem::put;
use num_complex::Complex64;

const CONTEXT: &str = "what contacts do for most of the period";

/// Share of the stiffness that a contact has on average from which on it counts as one that sticks.
/// Kind: fixed.
const MOSTLY: f64 = 0.5;

/// The matrix D of all harmonics, factored, and D⁻¹ G.
pub(super) struct ContactBase {
    /// Per coordinate, the stiffness s; `None` where s is κ.
    stiffness: Vec<Option<f64>>,
    /// Per carried harmonic the factors of D.
    factors: Vec<Lu<Complex64>>,
    /// D⁻¹ G, harmonic after harmonic, column after column.
    responses: Vec<Complex64>,
    /// Memory: numbers of one harmonic, twice more.
    memory: [Vec<Complex64>; 3],
}

impl ContactBase {
    /// Memory for a condensed model.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(condensed: &Condensed) -> Result<Self> {
        let (n, harmonics) = (condensed.coordinates(), condensed.set().numbers().len());
        let mut factors = Vec::new();
        for _ in 0..harmonics {
            try_push(&mut factors, Lu::new(n, n)?, CONTEXT)?;
        }
        let one = || try_vec(n, Complex64::ZERO, CONTEXT);
        Ok(Self {
            stiffness: try_vec(n, None, CONTEXT)?,
            factors,
            responses: try_vec(n.saturating_mul(n).saturating_mul(harmonics), Complex64::ZERO, CONTEXT)?,
            memory: [one()?, one()?, one()?],
        })
    }

    /// Chooses s by the Jacobians of the contacts evaluated last, and factors D; `false` where it is singular.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    pub fn factor(
        &mut self,
        condensed: &Condensed,
        forces: &ContactForces<'_>,
        tables: &[Table],
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let (set, n) = (condensed.set(), condensed.coordinates());
        let m = set.packed_len();
        for (c, stiffness) in self.stiffness.iter_mut().enumerate() {
            let own = forces.blocks_of_force(c).find(|(by, _)| *by == c);
            *stiffness = own.filter(|_| !forces.is_eliminated(c)).map(|(_, block)| {
                let mean = block.iter().step_by(m + 1).sum::<f64>() / m as f64;
                let stuck = condensed.contacts.stiffness[c];
                if mean > MOSTLY * stuck { stuck } else { 0.0 }
            });
        }
        let all = self
            .factors
            .iter_mut()
            .zip(self.responses.chunks_exact_mut((n * n).max(1)));
        for (i, ((lu, response), table)) in all.zip(tables).enumerate() {
            let mean = set.numbers()[i] == 0;
            let flexibility = table.value.chunks_exact(n + 1);
            for (to, from) in response.chunks_exact_mut(n).zip(flexibility) {
                to.copy_from_slice(&from[..n]);
            }
            for (c, (to, column)) in lu
                .matrix()
                .chunks_exact_mut(n)
                .zip(response.chunks_exact(n))
                .enumerate()
            {
                let s = self.stiffness[c].filter(|_| !mean);
                let change = s.map_or(Complex64::ZERO, |s| s - condensed.kappa(c, i));
                for (to, g) in to.iter_mut().zip(column) {
                    *to = g * change;
                }
                to[c] += if mean { 1.0 + forces.mean_floor(c) } else { 1.0 };
            }
            match lu.factor(interrupt) {
                Err(e) if e.status == Status::Singular => return Ok(false),
                factored => factored?,
            }
            lu.solve_columns(response, false, interrupt)?;
        }
        Ok(true)
    }

    /// The stiffness s of a force in the i-th carried harmonic.
    pub fn of(&self, condensed: &Condensed, force: usize, i: usize) -> Complex64 {
        match self.stiffness[force] {
            Some(s) if condensed.set().numbers()[i] > 0 => s.into(),
            _ => condensed.kappa(force, i),
        }
    }

    /// u ← D⁻¹ G w for the forces w of one coordinate.
    pub fn response_of(&self, set: &HarmonicSet, force: usize, w: &[f64], u: &mut [f64]) {
        let (m, n) = (set.packed_len(), self.stiffness.len());
        u.fill(0.0);
        for (i, response) in self.responses.chunks_exact(n * n).enumerate() {
            let (at, mean, z) = (set.offset(i), set.numbers()[i] == 0, set.get(w, i));
            for (u, g) in u.chunks_exact_mut(m).zip(&response[force * n..(force + 1) * n]) {
                put(u, at, mean, g * z);
            }
        }
    }

    /// u ← u − D⁻¹ G w.
    pub fn subtract_response(&mut self, set: &HarmonicSet, w: &[f64], u: &mut [f64]) {
        let (m, n) = (set.packed_len(), self.stiffness.len());
        let [z, sum, memory] = &mut self.memory;
        for (i, response) in self.responses.chunks_exact(n * n).enumerate() {
            let (at, mean) = (set.offset(i), set.numbers()[i] == 0);
            for (z, w) in z.iter_mut().zip(w.chunks_exact(m)) {
                *z = set.get(w, i);
            }
            complex_columns::multiply(response, n, z, sum, memory);
            for (u, sum) in u.chunks_exact_mut(m).zip(&*sum) {
                put(u, at, mean, -sum);
            }
        }
    }

    /// u ← D⁻¹ u.
    pub fn divide(&mut self, set: &HarmonicSet, u: &mut [f64]) {
        let m = set.packed_len();
        let z = &mut self.memory[0];
        for (i, lu) in self.factors.iter().enumerate() {
            for (z, u) in z.iter_mut().zip(u.chunks_exact(m)) {
                *z = set.get(u, i);
            }
            lu.solve(z);
            for (z, u) in z.iter().zip(u.chunks_exact_mut(m)) {
                set.set(u, i, *z);
            }
        }
    }
}
