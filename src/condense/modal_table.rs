//! Flexibility table of one harmonic from the modes of its wave.
//!
//! With L and R the rows and columns of outputs and inputs in the modes and d the denominators of
//! [`crate::condense::wave_modes`], the table is T′ = L d⁻¹ R, and the low-rank term of `condense::low_rank`.

use crate::condense::Condensed;
use crate::condense::flexibility::Table;
use crate::condense::low_rank::{Coefficients, Frequency, LowRank, Plain};
use crate::condense::single_contact::{Denominators, SingleContact};
use crate::condense::wave_modes::{NEAR_RESONANCE, WaveModes};
use crate::error::{Result, boxed, try_push, try_vec};
use crate::interrupt::Interrupt;
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use num_complex::Complex64;
use std::sync::Arc;

const CONTEXT: &str = "the flexibility from modes";

/// Multiplications up to which plain loops are quicker than the blocked product.
const SMALL_PRODUCT: usize = 4096;

/// A harmonic with the modes of its wave.
pub struct ModalTable {
    modes: Arc<WaveModes>,
    number: f64,
    sums: Sums,
}

/// How the sums over the modes are made.
enum Sums {
    /// Written out: one contact without springs.
    Single(SingleContact, Coefficients),
    Any(Box<General>),
}

/// The numbers of a table of one contact without springs.
pub struct SinglePart<'a> {
    pub contact: &'a SingleContact,
    pub coefficients: &'a Coefficients,
    pub number: f64,
    /// α and β
    pub proportional: (f64, f64),
    /// η
    pub loss_factor: f64,
}

/// Sums for any number of contacts and springs.
struct General {
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
    /// T′ and ∂T′, rows × rows.
    plain: Vec<Complex64>,
    d_plain: Vec<Complex64>,
    low_rank: LowRank,
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
        let coefficients = Coefficients::new(condensed, i, springs)?;
        let sums = if coordinates == 1 && rows == 2 {
            Sums::Single(SingleContact::new(&modes.values, &left, &right)?, coefficients)
        } else {
            let zeros = |len| try_vec(len, Complex64::ZERO, CONTEXT);
            let general = General {
                coordinates,
                rows,
                left,
                right,
                inverse: zeros(n)?,
                slopes: zeros(n)?,
                weighted: zeros(rows * n)?,
                plain: zeros(rows * rows)?,
                d_plain: zeros(rows * rows)?,
                low_rank: LowRank::new(coordinates, coefficients, damped)?,
            };
            Sums::Any(boxed(|| Ok(general))?)
        };
        Ok(Self {
            number: block.number as f64,
            sums,
            modes,
        })
    }

    /// The modes of its wave.
    #[must_use]
    pub fn modes(&self) -> Arc<WaveModes> {
        Arc::clone(&self.modes)
    }

    /// Its numbers where it is one of a single contact without springs.
    pub(super) fn single(&self) -> Option<SinglePart<'_>> {
        match &self.sums {
            Sums::Single(contact, coefficients) => Some(SinglePart {
                contact,
                coefficients,
                number: self.number,
                proportional: self.modes.proportional,
                loss_factor: self.modes.loss_factor,
            }),
            Sums::Any(_) => None,
        }
    }

    /// Evaluates H at `omega`, and ∂H/∂ω if `slopes`; `false` so near a resonance of the structure with stuck contacts that
    /// digits would be lost.
    ///
    /// # Errors
    /// `Singular` at an undamped resonance; `StoppedByCaller`.
    pub fn evaluate(&mut self, omega: f64, slopes: bool, table: &mut Table, interrupt: &Interrupt<'_>) -> Result<bool> {
        let at = self.frequency(omega);
        let inertia = self.inertia(omega);
        let nu = self.number * omega;
        let is_clear = match &mut self.sums {
            Sums::Single(single, coefficients) => {
                let (s, d_s) = inertia;
                let by = Denominators {
                    at,
                    s,
                    d_s,
                    nu,
                    least: NEAR_RESONANCE,
                };
                single.evaluate(
                    by,
                    (coefficients.entry(0, at.c), coefficients.d_entry(0, at.d_c)),
                    table,
                )
            }
            Sums::Any(general) => {
                let is_clear = general.denominators(&self.modes, at, inertia, nu);
                if is_clear {
                    general.evaluate(at, slopes, table, interrupt)?;
                }
                is_clear
            }
        };
        if is_clear {
            check_finite(&table.value, omega)?;
        }
        Ok(is_clear)
    }

    /// Resonances of the structure with its reference stiffness between two frequencies, to first order in the low-rank term:
    /// 1 + c − Σ e |b φ|² = (ν² − iνα) μ.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn resonances(&self, (low, high): (f64, f64)) -> Result<Vec<Complex64>> {
        let mut found = Vec::new();
        let Sums::Any(general) = &self.sums else {
            return Ok(found);
        };
        let modes = self.modes.values.iter().zip(general.left.chunks_exact(general.rows));
        for (mu, rows) in modes.filter(|(mu, _)| **mu > 0.0) {
            let omega = mu.sqrt().recip() / self.number;
            if !(low..=high).contains(&omega) {
                continue;
            }
            let at = self.frequency(omega);
            let low_rank = &general.low_rank;
            let of_row = |b: usize| low_rank.entry(b, at) * rows[low_rank.row_of(b)].norm_sqr();
            let stiffness = 1.0 + at.c - (0..low_rank.order()).map(of_row).sum::<Complex64>();
            let damping = Complex64::I * self.modes.proportional.0 * self.number * omega;
            try_push(&mut found, (stiffness / mu + damping).sqrt() / self.number, CONTEXT)?;
        }
        Ok(found)
    }

    /// c and ∂c/∂ω.
    fn frequency(&self, omega: f64) -> Frequency {
        let beta = self.modes.proportional.1;
        let (nu, by_omega) = (self.number * omega, self.number);
        Frequency {
            c: Complex64::new(0.0, nu * beta + self.modes.loss_factor),
            d_c: Complex64::new(0.0, by_omega * beta),
        }
    }

    /// ν² − iνα and its derivative by ω.
    fn inertia(&self, omega: f64) -> (Complex64, Complex64) {
        let alpha = self.modes.proportional.0;
        let nu = self.number * omega;
        let by_omega = self.number * Complex64::new(2.0 * nu, -alpha);
        (Complex64::new(nu * nu, -nu * alpha), by_omega)
    }
}

impl General {
    /// 1/d and its derivative; `false` where a denominator is small.
    fn denominators(
        &mut self,
        modes: &WaveModes,
        at: Frequency,
        (inertia, d_inertia): (Complex64, Complex64),
        nu: f64,
    ) -> bool {
        let is_clear = modes.invert((at.c, inertia), nu, &mut self.inverse);
        let slopes = self.slopes.iter_mut().zip(&self.inverse).zip(&modes.values);
        for ((slope, inverse), mu) in slopes {
            *slope = -(at.d_c - d_inertia * mu) * *inverse * *inverse;
        }
        is_clear
    }

    /// The table from the denominators, and its slope if `slopes`.
    fn evaluate(&mut self, at: Frequency, slopes: bool, table: &mut Table, interrupt: &Interrupt<'_>) -> Result<()> {
        let outputs = self.coordinates + 1;
        self.sum(slopes);
        let of = |plain: &[Complex64], to: &mut [Complex64]| {
            for (to, from) in to.chunks_exact_mut(outputs).zip(plain.chunks_exact(self.rows)) {
                to.copy_from_slice(&from[..outputs]);
            }
        };
        of(&self.plain, &mut table.value);
        if slopes {
            of(&self.d_plain, &mut table.slope);
        } else {
            table.slope.fill(Complex64::ZERO);
        }
        let plain = Plain {
            value: &self.plain,
            slope: &self.d_plain,
            rows: self.rows,
        };
        self.low_rank.add(&plain, at, slopes, table, interrupt)
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
    use crate::condense::test_chains::{DAMPED, N, chain, structure};
    use crate::condense::wave_cache::WaveCache;
    use crate::condense::{Condensed, Reference};
    use crate::contact::Contact;
    use crate::linalg::matrix_view::MatrixView;
    use crate::model::Model;
    use crate::model::structure::MatrixKind;
    use crate::options::SolverOptions;

    fn condensed(model: &Model, reference: Reference) -> Condensed {
        let options = SolverOptions {
            harmonics: 7,
            ..SolverOptions::default()
        };
        Condensed::with_reference(model, &options, 1.3, Some(reference), &Interrupt::none()).unwrap()
    }

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
