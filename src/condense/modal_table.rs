//! Flexibility table of one harmonic from the modes of its wave.
//!
//! With L and R the rows and columns of outputs and inputs in the modes and d the denominators of
//! [`crate::condense::wave_modes`], the table without the low-rank term is T′ = L d⁻¹ R. With
//! Z_κ = (1 + c) K_κ − (ν² − iνα) M − Bᴴ e B and e = ck − i Im κ
//!
//! > T = T′ + T′_B e X,  X = (1 − G′ e)⁻¹ T′ᴮ,
//!
//! where T′_B are the columns and T′ᴮ the rows of B, and G′ is where they cross (Woodbury's identity; X are the rows of
//! B in T itself). By the frequency
//!
//! > ∂T = ∂T′ + ∂T′_B e X + T′_B (∂e X + e ∂X),  ∂X = (1 − G′ e)⁻¹ (∂T′ᴮ + (∂G′ e + G′ ∂e) X).

use crate::condense::Condensed;
use crate::condense::flexibility::Table;
use crate::condense::wave_modes::WaveModes;
use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::lu::Lu;
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use num_complex::Complex64;
use std::sync::Arc;

const CONTEXT: &str = "the flexibility from modes";

/// Relative size of a denominator below which a mode hides the others: T′ then has so many digits less.
const NEAR_RESONANCE: f64 = 1e-4;

/// Multiplications up to which plain loops are quicker than the blocked product.
const SMALL_PRODUCT: usize = 4096;

/// A harmonic with the modes of its wave.
pub struct ModalTable {
    modes: Arc<WaveModes>,
    number: f64,
    coordinates: usize,
    /// Rows of contacts, response and springs.
    rows: usize,
    /// Mode after mode, one number a row: Φ seen by the outputs, and the inputs seen by Φᴴ.
    left: Vec<Complex64>,
    right: Vec<Complex64>,
    /// 1/d, and −∂d/d².
    inverse: Vec<Complex64>,
    slopes: Vec<Complex64>,
    /// R times one of them.
    weighted: Vec<Complex64>,
    /// Stiffness of B: of the coordinates, then of the springs; and Im κ, 0 for springs.
    stiffness: Vec<f64>,
    imaginary: Vec<f64>,
    /// T′ and ∂T′, rows × rows.
    plain: Vec<Complex64>,
    d_plain: Vec<Complex64>,
    lu: Lu<Complex64>,
    /// X, e X and ∂(e X), one column for each contact and for the excitation.
    inner: Vec<Complex64>,
    force: Vec<Complex64>,
    d_force: Vec<Complex64>,
}

impl ModalTable {
    /// The table of the i-th carried harmonic with degree of freedom `response` as the last row.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(condensed: &Condensed, i: usize, response: usize, modes: Arc<WaveModes>) -> Result<Self> {
        let block = &condensed.blocks()[i];
        let (n, coordinates) = (condensed.ndof(), condensed.coordinates());
        // Without damping by stiffness that part of the low-rank term vanishes.
        let damped = modes.is_damped_by_stiffness();
        let springs = if damped { &modes.springs } else { &[][..] };
        let (outputs, rows) = (coordinates + 1, coordinates + 1 + springs.len());
        let mut left = try_vec(rows * n, Complex64::ZERO, CONTEXT)?;
        let mut right = try_vec(rows * n, Complex64::ZERO, CONTEXT)?;
        let observed = condensed.motion_row(i, response)?;
        for (mode, shape) in modes.vectors.chunks_exact(n).enumerate() {
            let column = &mut left[mode * rows..(mode + 1) * rows];
            for (to, row) in column.iter_mut().zip(&block.rows) {
                *to = row.along(shape);
            }
            column[coordinates] = observed.along(shape);
            for (to, (row, _)) in column[outputs..].iter_mut().zip(springs) {
                *to = row.along(shape);
            }
            let inputs = &mut right[mode * rows..(mode + 1) * rows];
            for (to, l) in inputs.iter_mut().zip(column) {
                *to = l.conj();
            }
            inputs[coordinates] = crate::linalg::inner(shape, &block.force);
        }
        let mut stiffness = try_vec(coordinates + springs.len(), 0.0, CONTEXT)?;
        let mut imaginary = try_vec(stiffness.len(), 0.0, CONTEXT)?;
        for (c, (k, im)) in stiffness.iter_mut().zip(&mut imaginary).take(coordinates).enumerate() {
            let kappa = condensed.kappa(c, i);
            (*k, *im) = (kappa.re, kappa.im);
        }
        for (k, (_, spring)) in stiffness[coordinates..].iter_mut().zip(springs) {
            *k = *spring;
        }
        let low_rank = if damped || imaginary.iter().any(|&im| im != 0.0) {
            stiffness.len()
        } else {
            0
        };
        let zeros = |len| try_vec(len, Complex64::ZERO, CONTEXT);
        Ok(Self {
            number: block.number as f64,
            coordinates,
            rows,
            left,
            right,
            inverse: zeros(n)?,
            slopes: zeros(n)?,
            weighted: zeros(rows * n)?,
            plain: zeros(rows * rows)?,
            d_plain: zeros(rows * rows)?,
            lu: Lu::new(low_rank, outputs)?,
            inner: zeros(low_rank * outputs)?,
            force: zeros(low_rank * outputs)?,
            d_force: zeros(low_rank * outputs)?,
            stiffness,
            imaginary,
            modes,
        })
    }

    /// Evaluates H at `omega`, and ∂H/∂ω if `slopes`; `false` so near a resonance of the structure with stuck contacts that
    /// digits would be lost.
    ///
    /// # Errors
    /// `Singular` at an undamped resonance; `StoppedByCaller`.
    pub fn evaluate(&mut self, omega: f64, slopes: bool, table: &mut Table, interrupt: &Interrupt<'_>) -> Result<bool> {
        let outputs = self.coordinates + 1;
        if !self.denominators(omega) {
            return Ok(false);
        }
        let (coefficient, d_coefficient) = self.coefficient(omega);
        if self.coordinates == 1 && self.rows == 2 && self.lu.order() == 1 {
            self.single(coefficient, d_coefficient, table);
            check_finite(&table.value, omega)?;
            return Ok(true);
        }
        self.sum(slopes);
        if self.lu.order() > 0 {
            self.solve_low_rank(coefficient, interrupt)?;
            if slopes {
                self.differentiate_low_rank(coefficient, d_coefficient, interrupt)?;
            }
        }
        let of = |plain: &[Complex64], to: &mut [Complex64]| {
            for (to, from) in to.chunks_exact_mut(outputs).zip(plain.chunks_exact(self.rows)) {
                to.copy_from_slice(&from[..outputs]);
            }
        };
        of(&self.plain, &mut table.value);
        self.add_columns(&self.plain, &self.force, &mut table.value);
        if slopes {
            of(&self.d_plain, &mut table.slope);
            self.add_columns(&self.d_plain, &self.force, &mut table.slope);
            self.add_columns(&self.plain, &self.d_force, &mut table.slope);
        } else {
            table.slope.fill(Complex64::ZERO);
        }
        check_finite(&table.value, omega)?;
        Ok(true)
    }

    /// The table of a single relative motion without springs, the same formulas written out: this is the inner loop of every
    /// response with one contact.
    fn single(&self, c: Complex64, d_c: Complex64, table: &mut Table) {
        // Columns: contact, excitation. Rows: contact, response.
        let mut t = [[Complex64::ZERO; 2]; 2];
        let mut d_t = t;
        let factors = self.inverse.iter().zip(&self.slopes);
        let modes = self.left.as_chunks::<2>().0.iter().zip(self.right.as_chunks::<2>().0);
        for ((left, right), (inverse, slope)) in modes.zip(factors) {
            for k in 0..2 {
                let (a, b) = (right[k] * inverse, right[k] * slope);
                for r in 0..2 {
                    t[k][r] += left[r] * a;
                    d_t[k][r] += left[r] * b;
                }
            }
        }
        let (e, d_e) = (self.low_rank(0, c), d_c * self.stiffness[0]);
        let pivot = (1.0 - t[0][0] * e).inv();
        let d_product = d_t[0][0] * e + t[0][0] * d_e;
        for k in 0..2 {
            let x = pivot * t[k][0];
            let d_x = pivot * (d_t[k][0] + d_product * x);
            let (force, d_force) = (e * x, e * d_x + d_e * x);
            for r in 0..2 {
                table.value[2 * k + r] = t[k][r] + t[0][r] * force;
                table.slope[2 * k + r] = d_t[k][r] + d_t[0][r] * force + t[0][r] * d_force;
            }
        }
    }

    /// c and ∂c/∂ω.
    fn coefficient(&self, omega: f64) -> (Complex64, Complex64) {
        let beta = self.modes.proportional.1;
        let (nu, by_omega) = (self.number * omega, self.number);
        (
            Complex64::new(0.0, nu * beta + self.modes.loss_factor),
            Complex64::new(0.0, by_omega * beta),
        )
    }

    /// 1/d and its derivative; `false` where a denominator is small.
    fn denominators(&mut self, omega: f64) -> bool {
        let alpha = self.modes.proportional.0;
        let nu = self.number * omega;
        let (c, d_c) = self.coefficient(omega);
        let inertia = Complex64::new(nu * nu, -nu * alpha);
        let d_inertia = self.number * Complex64::new(2.0 * nu, -alpha);
        let mut least = f64::INFINITY;
        let values = self.modes.values.iter();
        for ((inverse, slope), mu) in self.inverse.iter_mut().zip(&mut self.slopes).zip(values) {
            let d = 1.0 + c - inertia * mu;
            let size = 1.0 + nu * nu * mu.abs();
            least = least.min(d.norm_sqr() / (size * size));
            *inverse = d.inv();
            *slope = -(d_c - d_inertia * mu) * *inverse * *inverse;
        }
        least > NEAR_RESONANCE * NEAR_RESONANCE
    }

    /// T′, and ∂T′ if `slopes`.
    fn sum(&mut self, slopes: bool) {
        let rows = self.rows;
        let parts = [
            (&self.inverse, &mut self.plain, true),
            (&self.slopes, &mut self.d_plain, slopes),
        ];
        for (factors, out, _) in parts.into_iter().filter(|(_, _, wanted)| *wanted) {
            if out.len() * factors.len() <= SMALL_PRODUCT {
                add_modes((&self.left, &self.right, rows), factors, out);
                continue;
            }
            let modes = self.weighted.chunks_exact_mut(rows).zip(self.right.chunks_exact(rows));
            for ((to, from), factor) in modes.zip(factors) {
                for (to, from) in to.iter_mut().zip(from) {
                    *to = from * factor;
                }
            }
            matmul(
                MatMut::from_column_major_slice_mut(out, rows, rows),
                Accum::Replace,
                MatRef::from_column_major_slice(&self.left, rows, factors.len()),
                MatRef::from_row_major_slice(&self.weighted, factors.len(), rows),
                Complex64::ONE,
                Par::Seq,
            );
        }
    }

    /// Row of B number b in T′: the response lies between contacts and springs.
    fn row_of(&self, b: usize) -> usize {
        if b < self.coordinates { b } else { b + 1 }
    }

    /// e of row b of B.
    fn low_rank(&self, b: usize, coefficient: Complex64) -> Complex64 {
        coefficient * self.stiffness[b] - Complex64::I * self.imaginary[b]
    }

    /// X and e X
    fn solve_low_rank(&mut self, c: Complex64, interrupt: &Interrupt<'_>) -> Result<()> {
        let (order, rows) = (self.lu.order(), self.rows);
        for q in 0..order {
            let (e, from) = (self.low_rank(q, c), self.row_of(q) * rows);
            for p in 0..order {
                let entry = -e * self.plain[from + self.row_of(p)];
                self.lu.matrix()[q * order + p] = if p == q { entry + 1.0 } else { entry };
            }
        }
        self.lu.factor(interrupt)?;
        for (k, from) in self.plain.chunks_exact(rows).take(self.coordinates + 1).enumerate() {
            for p in 0..order {
                self.inner[k * order + p] = from[self.row_of(p)];
            }
        }
        self.lu.solve_columns(&mut self.inner, false, interrupt)?;
        for k in 0..=self.coordinates {
            for p in 0..order {
                self.force[k * order + p] = self.low_rank(p, c) * self.inner[k * order + p];
            }
        }
        Ok(())
    }

    /// ∂(e X), after [`Self::solve_low_rank`].
    fn differentiate_low_rank(&mut self, c: Complex64, d_c: Complex64, interrupt: &Interrupt<'_>) -> Result<()> {
        let (order, rows) = (self.lu.order(), self.rows);
        for k in 0..=self.coordinates {
            for p in 0..order {
                let mut sum = self.d_plain[k * rows + self.row_of(p)];
                for q in 0..order {
                    let at = self.row_of(q) * rows + self.row_of(p);
                    let d_e_x = d_c * self.stiffness[q] * self.inner[k * order + q];
                    sum += self.d_plain[at] * self.force[k * order + q] + self.plain[at] * d_e_x;
                }
                self.d_force[k * order + p] = sum;
            }
        }
        self.lu.solve_columns(&mut self.d_force, false, interrupt)?;
        for k in 0..=self.coordinates {
            for p in 0..order {
                let x = self.inner[k * order + p];
                let d_x = self.d_force[k * order + p];
                self.d_force[k * order + p] = self.low_rank(p, c) * d_x + d_c * self.stiffness[p] * x;
            }
        }
        Ok(())
    }

    /// table += T′_B X, without the column of the excitation in T′_B.
    fn add_columns(&self, plain: &[Complex64], x: &[Complex64], table: &mut [Complex64]) {
        let (order, outputs) = (self.lu.order(), self.coordinates + 1);
        if order == 0 {
            return;
        }
        for (x, to) in x.chunks_exact(order).zip(table.chunks_exact_mut(outputs)) {
            for (q, x) in x.iter().enumerate() {
                for (to, from) in to.iter_mut().zip(&plain[self.row_of(q) * self.rows..]) {
                    *to += from * x;
                }
            }
        }
    }
}

fn check_finite(values: &[Complex64], omega: f64) -> Result<()> {
    if values.iter().all(|z| z.is_finite()) {
        return Ok(());
    }
    crate::error::fail!(
        Singular,
        "the structure resonates without damping at angular frequency {omega}"
    )
}

/// out = Σ left ⊗ factor·right over the modes.
fn add_modes((left, right, rows): (&[Complex64], &[Complex64], usize), factors: &[Complex64], out: &mut [Complex64]) {
    out.fill(Complex64::ZERO);
    let modes = left.chunks_exact(rows).zip(right.chunks_exact(rows)).zip(factors);
    for ((left, right), factor) in modes {
        for (out, right) in out.chunks_exact_mut(rows).zip(right) {
            let weighted = right * factor;
            for (out, left) in out.iter_mut().zip(left) {
                *out += left * weighted;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::condense::flexibility::Workspace;
    use crate::condense::wave_cache::WaveCache;
    use crate::condense::{Condensed, Reference};
    use crate::contact::Contact;
    use crate::linalg::matrix_view::MatrixView;
    use crate::model::Model;
    use crate::model::spring::Spring;
    use crate::model::structure::MatrixKind;
    use crate::options::SolverOptions;

    const N: usize = 9;

    /// A chain with uneven masses and springs, on a wheel where `sectors` is more than 1, without contacts.
    fn structure(sectors: usize, (alpha, beta): (f64, f64)) -> Model {
        let mut model = if sectors > 1 {
            let mut wheel = Model::cyclic(N, sectors).unwrap();
            wheel.set_wave(2);
            wheel
        } else {
            Model::new(N).unwrap()
        };
        let (mut m, mut k) = (vec![0.0; N * N], vec![0.0; N * N]);
        for i in 0..N {
            m[i * N + i] = 1.0 + 0.3 * (i as f64).sin();
            k[i * N + i] += 0.2 + 0.1 * (2.0 * i as f64).cos();
            if i > 0 {
                let spring = 40.0 + 7.0 * (3.0 * i as f64).sin();
                k[i * N + i] += spring;
                k[(i - 1) * N + i - 1] += spring;
                k[i * N + i - 1] -= spring;
                k[(i - 1) * N + i] -= spring;
            }
        }
        model.set_matrix(MatrixKind::Mass, &MatrixView::dense(N, &m)).unwrap();
        model
            .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(N, &k))
            .unwrap();
        if sectors > 1 {
            let mut to_next = vec![0.0; N * N];
            (to_next[3], to_next[5 * N + 4]) = (-0.11, -0.07);
            model
                .set_coupling(MatrixKind::Stiffness, &MatrixView::dense(N, &to_next))
                .unwrap();
        }
        model.set_rayleigh(alpha, beta).unwrap();
        model.add_force(8, 1, Complex64::new(0.7, -0.2)).unwrap();
        model
    }

    /// The same with sliders, a stuck contact and a spring.
    fn chain(sectors: usize, damping: (f64, f64)) -> Model {
        let mut model = structure(sectors, damping);
        model.add_contact(&Contact::jenkins(1, Some(4), 9.0, 0.3, 1.0)).unwrap();
        model.add_contact(&Contact::jenkins(6, None, 25.0, 0.3, 1.0)).unwrap();
        let mut across = Contact::jenkins(2, Some(7), 4.0, 0.3, 1.0);
        across.sector_offset = i64::from(sectors > 1);
        model.add_contact(&across).unwrap();
        // One that never slips is a spring.
        model
            .add_contact(&Contact::jenkins(0, Some(8), 12.0, 0.3, f64::INFINITY))
            .unwrap();
        model
            .add_spring(&Spring {
                dof_a: Some(3),
                dof_b: Some(5),
                sector_offset: i64::from(sectors > 1),
                stiffness: 15.0,
            })
            .unwrap();
        model
    }

    fn condensed(model: &Model, reference: Reference) -> Condensed {
        let options = SolverOptions {
            harmonics: 7,
            ..SolverOptions::default()
        };
        Condensed::with_reference(model, &options, 1.3, Some(reference), &Interrupt::none()).unwrap()
    }

    /// Damping αM + βK and loss factor.
    const DAMPED: [((f64, f64), f64); 6] = [
        ((0.0, 1e-3), 0.0),
        ((0.02, 0.0), 0.0),
        ((0.03, 4e-2), 0.0),
        ((0.0, 1e-6), 0.0),
        ((0.0, 0.0), 0.03),
        ((0.03, 4e-2), 0.2),
    ];

    #[test]
    fn tables_from_modes_are_those_by_factorisation() {
        for (sectors, reference) in [
            (1, Reference::Stuck),
            (24, Reference::Stuck),
            (1, Reference::Complex),
            (24, Reference::Complex),
        ] {
            for (damping, loss_factor) in DAMPED {
                let mut model = chain(sectors, damping);
                model.set_loss_factor(loss_factor).unwrap();
                let condensed = condensed(&model, reference);
                let mut cache = WaveCache::default();
                let mut direct = Workspace::new(&condensed, Some(4)).unwrap();
                for i in 0..condensed.blocks().len() {
                    let modes = cache.of(&model, &condensed, i, &Interrupt::none()).unwrap().unwrap();
                    let mut by_modes = ModalTable::new(&condensed, i, 4, modes).unwrap();
                    let mut table = Table::new(condensed.coordinates()).unwrap();
                    for omega in [0.05, 0.4, 1.0, 1.3, 2.7, 9.0] {
                        let found = by_modes.evaluate(omega, true, &mut table, &Interrupt::none());
                        assert!(found.unwrap(), "{sectors} sectors, {damping:?}, block {i} at {omega}");
                        let exact = direct.evaluate(&condensed, i, omega, true, &Interrupt::none()).unwrap();
                        let size = |z: &[Complex64]| z.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
                        for (name, of_modes, exact) in [
                            ("H", &table.value, &exact.value),
                            ("its slope", &table.slope, &exact.slope),
                        ] {
                            let off: Vec<Complex64> = of_modes.iter().zip(exact).map(|(a, b)| a - b).collect();
                            assert!(
                                size(&off) <= 1e-10 * size(exact),
                                "{sectors} sectors, {damping:?}, {loss_factor}, {name} of block {i} at {omega}: {:e}",
                                size(&off) / size(exact)
                            );
                        }
                    }
                }
                let waves = if sectors == 1 { 1 } else { 4 };
                assert_eq!(cache.count(), waves, "{sectors} sectors");
            }
        }
    }

    #[test]
    fn the_table_of_a_single_contact_is_that_by_factorisation() {
        for (damping, loss_factor) in DAMPED {
            let mut model = structure(1, damping);
            model.add_contact(&Contact::jenkins(1, Some(4), 9.0, 0.3, 1.0)).unwrap();
            model.set_loss_factor(loss_factor).unwrap();
            for reference in [Reference::Stuck, Reference::Complex] {
                let condensed = condensed(&model, reference);
                let mut cache = WaveCache::default();
                let mut direct = Workspace::new(&condensed, Some(4)).unwrap();
                for i in 0..condensed.blocks().len() {
                    let modes = cache.of(&model, &condensed, i, &Interrupt::none()).unwrap().unwrap();
                    let mut by_modes = ModalTable::new(&condensed, i, 4, modes).unwrap();
                    let mut table = Table::new(1).unwrap();
                    for omega in [0.05, 0.4, 1.3, 9.0] {
                        assert!(by_modes.evaluate(omega, true, &mut table, &Interrupt::none()).unwrap());
                        let exact = direct.evaluate(&condensed, i, omega, true, &Interrupt::none()).unwrap();
                        for (a, b) in [(&table.value, &exact.value), (&table.slope, &exact.slope)] {
                            for (a, b) in a.iter().zip(b) {
                                assert!((a - b).norm() <= 1e-10 * b.norm(), "{damping:?}, {i}, {omega}: {a} {b}");
                            }
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn other_damping_has_no_such_modes() {
        let mut model = chain(1, (0.0, 0.0));
        let mut dashpot = vec![0.0; N * N];
        dashpot[0] = 0.1;
        model
            .set_matrix(MatrixKind::Damping, &MatrixView::dense(N, &dashpot))
            .unwrap();
        let mut structural = chain(1, (0.0, 1e-3));
        structural
            .set_matrix(MatrixKind::Structural, &MatrixView::dense(N, &dashpot))
            .unwrap();
        for model in [model, structural] {
            let mut cache = WaveCache::default();
            let stuck = condensed(&model, Reference::Stuck);
            assert!(cache.of(&model, &stuck, 0, &Interrupt::none()).unwrap().is_none());
            assert!(cache.is_refused());
        }
    }

    #[test]
    fn near_a_resonance_of_the_stuck_structure_nothing_is_told_that_lost_its_digits() {
        let model = chain(1, (0.0, 1e-7));
        let condensed = condensed(&model, Reference::Stuck);
        let mut cache = WaveCache::default();
        let modes = cache.of(&model, &condensed, 0, &Interrupt::none()).unwrap().unwrap();
        let resonance = modes.values.last().unwrap().sqrt().recip();
        let mut by_modes = ModalTable::new(&condensed, 0, 4, modes).unwrap();
        let mut table = Table::new(condensed.coordinates()).unwrap();
        for (factor, clear) in [(1.0, false), (1.0 + 1e-5, false), (1.01, true)] {
            let found = by_modes.evaluate(factor * resonance, true, &mut table, &Interrupt::none());
            assert_eq!(found.unwrap(), clear, "{factor}");
        }
    }
}
