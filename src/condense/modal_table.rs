//! Flexibility table of one harmonic from the modes of its wave.
//!
//! With L and R the rows and columns of outputs and inputs in the modes and d the denominators of
//! [`crate::condense::wave_modes`], the table without the low-rank term is T′ = L d⁻¹ R. With it
//!
//! > T = T′ + c T′_B k X,  X = (1 − c G′ k)⁻¹ T′ᴮ,
//!
//! where T′_B are the columns and T′ᴮ the rows of B, and G′ is where they cross (Woodbury's identity; X are the rows of
//! B in T itself).

use crate::condense::Condensed;
use crate::condense::flexibility::Table;
use crate::condense::wave_modes::WaveModes;
use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::lu::Lu;
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use num_complex::Complex64;
use std::rc::Rc;

const CONTEXT: &str = "the flexibility from modes";

/// A harmonic with the modes of its wave.
pub struct ModalTable {
    modes: Rc<WaveModes>,
    number: f64,
    coordinates: usize,
    /// Rows of contacts, response and springs.
    rows: usize,
    /// rows × n and n × rows: Φ seen by the outputs, and the inputs seen by Φᴴ.
    left: Vec<Complex64>,
    right: Vec<Complex64>,
    /// R over the denominators.
    weighted: Vec<Complex64>,
    /// Stiffness of B: of the coordinates, then of the springs.
    stiffness: Vec<f64>,
    /// T′, rows × rows.
    plain: Vec<Complex64>,
    lu: Lu<Complex64>,
    /// X, one column for each contact and for the excitation.
    inner: Vec<Complex64>,
}

impl ModalTable {
    /// The table of the i-th carried harmonic with degree of freedom `response` as the last row.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(condensed: &Condensed, i: usize, response: usize, modes: Rc<WaveModes>) -> Result<Self> {
        let block = &condensed.blocks()[i];
        let (n, coordinates) = (condensed.ndof(), condensed.coordinates());
        // Without damping by stiffness the low-rank term vanishes.
        let springs = if modes.is_damped_by_stiffness() {
            &modes.springs
        } else {
            &[][..]
        };
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
            for (r, l) in column.iter().enumerate() {
                right[r * n + mode] = l.conj();
            }
            right[coordinates * n + mode] = crate::linalg::inner(shape, &block.force);
        }
        let mut stiffness = try_vec(coordinates + springs.len(), 0.0, CONTEXT)?;
        for (c, k) in stiffness.iter_mut().take(coordinates).enumerate() {
            *k = condensed.kappa(c, i).re;
        }
        for (k, (_, spring)) in stiffness[coordinates..].iter_mut().zip(springs) {
            *k = *spring;
        }
        let low_rank = if modes.is_damped_by_stiffness() {
            stiffness.len()
        } else {
            0
        };
        Ok(Self {
            number: block.number as f64,
            coordinates,
            rows,
            left,
            right,
            weighted: try_vec(rows * n, Complex64::ZERO, CONTEXT)?,
            plain: try_vec(rows * rows, Complex64::ZERO, CONTEXT)?,
            lu: Lu::new(low_rank, outputs)?,
            inner: try_vec(low_rank * outputs, Complex64::ZERO, CONTEXT)?,
            stiffness,
            modes,
        })
    }

    /// Evaluates H at `omega`; its slope is left as zero.
    ///
    /// # Errors
    /// `Singular` at an undamped resonance; `StoppedByCaller`.
    pub fn evaluate(&mut self, omega: f64, table: &mut Table, interrupt: &Interrupt<'_>) -> Result<()> {
        let n = self.modes.values.len();
        let (rows, coordinates) = (self.rows, self.coordinates);
        let outputs = coordinates + 1;
        let (alpha, beta) = self.modes.proportional;
        let frequency = self.number * omega;
        let c = Complex64::new(0.0, frequency * beta + self.modes.loss_factor);
        let inertia = Complex64::new(frequency * frequency, -frequency * alpha);
        for (to, from) in self.weighted.chunks_exact_mut(n).zip(self.right.chunks_exact(n)) {
            for ((to, from), mu) in to.iter_mut().zip(from).zip(&self.modes.values) {
                *to = from / (1.0 + c - inertia * mu);
            }
        }
        multiply((&self.left, rows, n), &self.weighted, &mut self.plain);
        table.slope.fill(Complex64::ZERO);
        for (to, from) in table.value.chunks_exact_mut(outputs).zip(self.plain.chunks_exact(rows)) {
            to.copy_from_slice(&from[..outputs]);
        }
        let order = self.lu.order();
        if order == 0 {
            return check_finite(&table.value, omega);
        }
        // Position of the rows of B in T′: the response lies between contacts and springs.
        let at = |b: usize| if b < coordinates { b } else { b + 1 };
        let a = self.lu.matrix();
        for (q, column) in a.chunks_exact_mut(order).enumerate() {
            let factor = -c * self.stiffness[q];
            for (p, to) in column.iter_mut().enumerate() {
                *to = factor * self.plain[at(q) * rows + at(p)];
            }
            column[q] += 1.0;
        }
        self.lu.factor(interrupt)?;
        for (to, from) in self.inner.chunks_exact_mut(order).zip(self.plain.chunks_exact(rows)) {
            for (p, to) in to.iter_mut().enumerate() {
                *to = from[at(p)];
            }
        }
        self.lu.solve_columns(&mut self.inner, false, interrupt)?;
        for x in self.inner.chunks_exact_mut(order) {
            for (x, k) in x.iter_mut().zip(&self.stiffness) {
                *x *= c * k;
            }
        }
        // The columns of B, without those of the excitation.
        for (x, to) in self
            .inner
            .chunks_exact(order)
            .zip(table.value.chunks_exact_mut(outputs))
        {
            for (q, x) in x.iter().enumerate() {
                for (to, from) in to.iter_mut().zip(&self.plain[at(q) * rows..]) {
                    *to += from * x;
                }
            }
        }
        check_finite(&table.value, omega)
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

/// out = A B with `rows` × `n` numbers in A.
fn multiply((a, rows, n): (&[Complex64], usize, usize), b: &[Complex64], out: &mut [Complex64]) {
    let columns = out.len() / rows.max(1);
    matmul(
        MatMut::from_column_major_slice_mut(out, rows, columns),
        Accum::Replace,
        MatRef::from_column_major_slice(a, rows, n),
        MatRef::from_column_major_slice(b, n, columns),
        Complex64::ONE,
        Par::Seq,
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::condense::flexibility::Workspace;
    use crate::condense::wave_modes::WaveCache;
    use crate::condense::{Condensed, Reference};
    use crate::contact::Contact;
    use crate::linalg::matrix_view::MatrixView;
    use crate::model::Model;
    use crate::model::spring::Spring;
    use crate::model::structure::MatrixKind;
    use crate::options::SolverOptions;

    const N: usize = 9;

    /// A chain with uneven masses and springs, on a wheel where `sectors` is more than 1.
    fn chain(sectors: usize, (alpha, beta): (f64, f64)) -> Model {
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
        model.add_force(8, 1, Complex64::new(0.7, -0.2)).unwrap();
        model
    }

    fn condensed(model: &Model, reference: Reference) -> Condensed {
        let options = SolverOptions {
            harmonics: 7,
            ..SolverOptions::default()
        };
        Condensed::with_reference(model, &options, 1.3, Some(reference), &Interrupt::none()).unwrap()
    }

    #[test]
    fn tables_from_modes_are_those_by_factorisation() {
        for sectors in [1, 24] {
            for (damping, loss_factor) in [
                ((0.0, 1e-3), 0.0),
                ((0.02, 0.0), 0.0),
                ((0.03, 4e-2), 0.0),
                ((0.0, 1e-6), 0.0),
                ((0.0, 0.0), 0.03),
                ((0.03, 4e-2), 0.2),
            ] {
                let mut model = chain(sectors, damping);
                model.set_loss_factor(loss_factor).unwrap();
                let condensed = condensed(&model, Reference::Stuck);
                let mut cache = WaveCache::default();
                let mut direct = Workspace::new(&condensed, Some(4)).unwrap();
                for i in 0..condensed.blocks().len() {
                    let modes = cache.of(&model, &condensed, i, &Interrupt::none()).unwrap().unwrap();
                    let mut by_modes = ModalTable::new(&condensed, i, 4, modes).unwrap();
                    let mut table = Table::new(condensed.coordinates()).unwrap();
                    for omega in [0.05, 0.4, 1.0, 1.3, 2.7, 9.0] {
                        by_modes.evaluate(omega, &mut table, &Interrupt::none()).unwrap();
                        let exact = direct
                            .evaluate(&condensed, i, omega, false, &Interrupt::none())
                            .unwrap();
                        let size = |z: &[Complex64]| z.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
                        let off: Vec<Complex64> = table.value.iter().zip(&exact.value).map(|(a, b)| a - b).collect();
                        assert!(
                            size(&off) <= 1e-10 * size(&exact.value),
                            "{sectors} sectors, {damping:?}, {loss_factor}, block {i} at {omega}: {:e}",
                            size(&off) / size(&exact.value)
                        );
                    }
                }
                let waves = if sectors == 1 { 1 } else { 4 };
                assert_eq!(cache.count(), waves, "{sectors} sectors");
            }
        }
    }

    #[test]
    fn other_damping_and_a_complex_reference_have_no_such_modes() {
        let mut model = chain(1, (0.0, 0.0));
        let mut dashpot = vec![0.0; N * N];
        dashpot[0] = 0.1;
        model
            .set_matrix(MatrixKind::Damping, &MatrixView::dense(N, &dashpot))
            .unwrap();
        let mut cache = WaveCache::default();
        let stuck = condensed(&model, Reference::Stuck);
        assert!(cache.of(&model, &stuck, 0, &Interrupt::none()).unwrap().is_none());
        assert!(cache.is_refused());
        let model = chain(1, (0.0, 1e-3));
        let mut structural = chain(1, (0.0, 1e-3));
        structural
            .set_matrix(MatrixKind::Structural, &MatrixView::dense(N, &dashpot))
            .unwrap();
        let stuck = condensed(&structural, Reference::Stuck);
        let mut cache = WaveCache::default();
        assert!(cache.of(&structural, &stuck, 0, &Interrupt::none()).unwrap().is_none());
        let complex = condensed(&model, Reference::Complex);
        let mut cache = WaveCache::default();
        assert!(cache.of(&model, &complex, 0, &Interrupt::none()).unwrap().is_none());
        assert!(!cache.is_refused());
    }
}
