//! Motion of the structure in one harmonic under contact forces alone, with its derivatives for Newton's method: by
//! the contact forces (the flexibility), by frequency and by damping ratio.
//!
//! x = −Z⁻¹ Wᴴ w, ∂x/∂w = −Z⁻¹ Wᴴ, ∂x/∂ω = −Z⁻¹ Z_ω x, ∂x/∂D = −Z⁻¹ Z_D x: from the modes of the wave for small structures, else by
//! factorisation.

use crate::condense::Condensed;
use crate::condense::dynamic_stiffness::{DynamicStiffness, Variable, add_slope_product};
use crate::condense::modal_motion::ModalMotion;
use crate::condense::modal_solution::Solution;
use crate::error::{Result, try_push, try_vec};
use crate::interrupt::Interrupt;
use num_complex::Complex64;

/// x and its derivatives in one harmonic.
pub struct Modal {
    dynamic: DynamicStiffness,
    /// Per harmonic the solution from modes, where it is used.
    from_modes: Vec<Option<FromModes>>,
    /// Z⁻¹ Wᴴ, column after column.
    columns: Vec<Complex64>,
    x: Vec<Complex64>,
    by_omega: Vec<Complex64>,
    by_damping: Vec<Complex64>,
    /// Relative motions of the contacts of each column, of x, ∂x/∂ω and ∂x/∂D.
    relative: Vec<Complex64>,
    /// The same from modes, to be compared with a factorisation.
    compared: Vec<Complex64>,
}

/// The solution of one harmonic from the modes of its wave.
struct FromModes {
    motion: ModalMotion,
    /// Whether it agreed with a factorisation.
    agrees: bool,
}

/// Largest relative deviation of a solution from modes.
const TOLERANCE: f64 = 1e-11;

const CONTEXT: &str = "the flexibility of a mode";

impl Modal {
    /// Memory for a condensed model.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(condensed: &Condensed) -> Result<Self> {
        let n = condensed.ndof();
        let coordinates = condensed.coordinates();
        let zeros = |len| try_vec(len, Complex64::ZERO, CONTEXT);
        let mut from_modes = Vec::new();
        for i in 0..condensed.blocks().len() {
            let motion = ModalMotion::new(condensed, i)?;
            let agrees = false;
            try_push(
                &mut from_modes,
                motion.map(|motion| FromModes { motion, agrees }),
                CONTEXT,
            )?;
        }
        Ok(Self {
            from_modes,
            dynamic: DynamicStiffness::new(condensed, coordinates.max(1))?,
            columns: zeros(n.saturating_mul(coordinates))?,
            x: zeros(n)?,
            by_omega: zeros(n)?,
            by_damping: zeros(n)?,
            relative: zeros(coordinates.saturating_mul(coordinates + 3))?,
            compared: zeros(coordinates.saturating_mul(coordinates + 3))?,
        })
    }

    /// Solves for the i-th carried harmonic at frequency `omega` and damping ratio `damping` under
    /// w = f − κ y. Beside x and the relative motions, those of all degrees of freedom are known for the fundamental alone.
    ///
    /// # Errors
    /// `Singular` naming the harmonic, at an undamped resonance that moves no contact; `StoppedByCaller`.
    pub fn solve(
        &mut self,
        condensed: &Condensed,
        i: usize,
        (omega, damping): (f64, f64),
        w: &[Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let rows = &condensed.blocks()[i].rows;
        if let Some(from_modes) = &mut self.from_modes[i] {
            let to = Solution {
                columns: &mut self.columns,
                x: &mut self.x,
                by_omega: &mut self.by_omega,
                by_damping: &mut self.by_damping,
                relative: &mut self.relative,
                is_whole: condensed.blocks()[i].number == 1,
            };
            if from_modes.motion.solve((omega, damping), w, to, interrupt)? {
                if from_modes.agrees {
                    return Ok(());
                }
                self.compared.copy_from_slice(&self.relative);
                self.factorised(condensed, i, (omega, damping), w, interrupt)?;
                self.compare(i, rows.len());
                return Ok(());
            }
        }
        self.factorised(condensed, i, (omega, damping), w, interrupt)
    }

    /// The same by factorisation.
    fn factorised(
        &mut self,
        condensed: &Condensed,
        i: usize,
        (omega, damping): (f64, f64),
        w: &[Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let n = self.x.len();
        let rows = &condensed.blocks()[i].rows;
        self.dynamic.factor(condensed, i, omega.into(), damping, interrupt)?;
        self.columns.fill(Complex64::ZERO);
        for (column, row) in self.columns.chunks_exact_mut(n).zip(rows) {
            for &(p, a) in row.terms() {
                column[p] += a.conj();
            }
        }
        self.dynamic
            .solve(condensed, i, omega, &mut self.columns, false, interrupt)?;
        self.x.fill(Complex64::ZERO);
        for (column, w) in self.columns.chunks_exact(n).zip(w) {
            for (x, z) in self.x.iter_mut().zip(column) {
                *x -= z * w;
            }
        }
        // On stiff structures Newton's method would not get below the rounding of an unrefined solution.
        self.by_damping.fill(Complex64::ZERO);
        for (row, w) in rows.iter().zip(w) {
            for &(p, a) in row.terms() {
                self.by_damping[p] -= a.conj() * w;
            }
        }
        self.dynamic
            .refine(condensed, i, (omega, damping), &self.by_damping, &mut self.x, interrupt)?;
        let at = (omega.into(), damping);
        for (derivative, by) in [
            (&mut self.by_omega, Variable::Omega),
            (&mut self.by_damping, Variable::Damping),
        ] {
            derivative.fill(Complex64::ZERO);
            add_slope_product(condensed, i, at, by, false, &self.x, derivative);
            self.dynamic.solve(condensed, i, omega, derivative, false, interrupt)?;
            for z in derivative.iter_mut() {
                *z = -*z;
            }
        }
        let others = [&self.x, &self.by_omega, &self.by_damping].map(Vec::as_slice);
        let motions = self.columns.chunks_exact(n).chain(others);
        for (to, motion) in self.relative.chunks_exact_mut(rows.len().max(1)).zip(motions) {
            for (to, row) in to.iter_mut().zip(rows) {
                *to = row.along(motion);
            }
        }
        Ok(())
    }

    /// Keeps the solution from modes of the i-th harmonic where it agrees with that by factorisation.
    fn compare(&mut self, i: usize, rows: usize) {
        let parts = self
            .compared
            .chunks_exact(rows.max(1))
            .zip(self.relative.chunks_exact(rows.max(1)));
        let agrees = parts.into_iter().all(|(a, b)| {
            let off: f64 = a.iter().zip(b).map(|(a, b)| (a - b).norm_sqr()).sum();
            let size: f64 = b.iter().map(Complex64::norm_sqr).sum();
            off <= TOLERANCE * TOLERANCE * size
        });
        match &mut self.from_modes[i] {
            Some(from_modes) if agrees => from_modes.agrees = true,
            disagreeing => *disagreeing = None,
        }
    }

    /// Relative motions of the contacts: of x, ∂x/∂ω and ∂x/∂D.
    #[must_use]
    pub fn relative(&self, row: usize) -> [Complex64; 3] {
        let rows = self.rows();
        [0, 1, 2].map(|k| self.relative[(rows + k) * rows + row])
    }

    /// Relative motions Z⁻¹ Wᴴ of the contacts under a force on one of them.
    #[must_use]
    pub fn relative_column(&self, coordinate: usize) -> &[Complex64] {
        let rows = self.rows();
        &self.relative[coordinate * rows..(coordinate + 1) * rows]
    }

    fn rows(&self) -> usize {
        self.columns.len() / self.x.len()
    }

    /// x
    #[must_use]
    pub fn x(&self) -> &[Complex64] {
        &self.x
    }

    /// ∂x/∂ω of the fundamental.
    #[must_use]
    pub fn by_omega(&self) -> &[Complex64] {
        &self.by_omega
    }

    /// ∂x/∂D of the fundamental.
    #[must_use]
    pub fn by_damping(&self) -> &[Complex64] {
        &self.by_damping
    }

    /// −∂x/∂w of one coordinate in the fundamental: Z⁻¹ Wᴴ.
    #[must_use]
    pub fn column(&self, coordinate: usize) -> &[Complex64] {
        let n = self.x.len();
        &self.columns[coordinate * n..(coordinate + 1) * n]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::condense::test_chains::{DAMPED, N, chain, structure};
    use crate::condense::wave_cache::SharedWaves;
    use crate::contact::Contact;
    use crate::options::{DampingForm, SolverOptions};

    fn off(a: &[Complex64], b: &[Complex64]) -> f64 {
        let norm = |z: &mut dyn Iterator<Item = Complex64>| z.map(|z| z.norm_sqr()).sum::<f64>().sqrt();
        norm(&mut a.iter().zip(b).map(|(a, b)| a - b)) / norm(&mut b.iter().copied())
    }

    #[test]
    fn solutions_from_modes_are_those_by_factorisation() {
        let shape: Vec<Complex64> = (0..N).map(|i| Complex64::new(1.0 + i as f64, 0.3)).collect();
        let options = SolverOptions {
            harmonics: 5,
            ..SolverOptions::default()
        };
        for (sectors, form) in [1, 24]
            .into_iter()
            .flat_map(|n| [(n, DampingForm::Mass), (n, DampingForm::Stiffness)])
        {
            // With several contacts, and with one.
            for ((damping, loss_factor), single) in DAMPED.into_iter().flat_map(|d| [(d, false), (d, true)]) {
                let mut model = if single {
                    let mut model = structure(sectors, damping);
                    model.add_contact(&Contact::jenkins(1, Some(4), 9.0, 0.3, 1.0)).unwrap();
                    model
                } else {
                    chain(sectors, damping)
                };
                model.set_loss_factor(loss_factor).unwrap();
                let form = (form, false);
                let (direct, _) = Condensed::for_mode(&model, &options, form, &shape, &Interrupt::none()).unwrap();
                let quick = SharedWaves::default()
                    .attach(&model, direct.clone(), &Interrupt::none())
                    .unwrap();
                assert!(quick.blocks().iter().all(|b| b.source.is_some()));
                let [mut by_modes, mut exact] = [&quick, &direct].map(|c| Modal::new(c).unwrap());
                let w: Vec<Complex64> = (0..direct.coordinates())
                    .map(|c| Complex64::new(1.0 - c as f64, 0.4))
                    .collect();
                for i in 0..direct.blocks().len() {
                    for at in [(0.05, 0.0), (0.4, 0.02), (1.3, -0.1), (2.7, 0.3), (9.0, 1e-4)] {
                        let solve = |modal: &mut Modal, c| modal.solve(c, i, at, &w, &Interrupt::none()).unwrap();
                        solve(&mut by_modes, &quick);
                        assert!(
                            by_modes.from_modes[i].as_ref().is_some_and(|m| m.agrees),
                            "{form:?}, {i}"
                        );
                        solve(&mut exact, &direct);
                        let case = format!("{sectors} sectors, {form:?}, {damping:?}, {loss_factor}, {i} at {at:?}");
                        assert!(off(by_modes.x(), exact.x()) <= 1e-10, "x, {case}");
                        assert!(
                            off(&by_modes.relative, &exact.relative) <= 1e-10,
                            "relative motion, {case}"
                        );
                        if direct.blocks()[i].number == 1 {
                            assert!(off(by_modes.by_omega(), exact.by_omega()) <= 1e-10, "by ω, {case}");
                            assert!(off(by_modes.by_damping(), exact.by_damping()) <= 1e-10, "by D, {case}");
                            assert!(off(&by_modes.columns, &exact.columns) <= 1e-10, "columns, {case}");
                        }
                    }
                }
            }
        }
    }
}
