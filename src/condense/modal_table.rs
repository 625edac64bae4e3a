//! Flexibility table of one harmonic from the modes of its wave.
//!
//! With L the rows of outputs in the modes and d the denominators of [`crate::condense::wave_modes`], the table is
//! T′ = L d⁻¹ Lᴴ, the excitation in place of the response among the inputs, and the low-rank term of `condense::low_rank`.

use crate::condense::Condensed;
use crate::condense::flexibility::Table;
use crate::condense::low_rank::{Coefficients, Frequency, LowRank, Plain};
use crate::condense::modal_rows::{ModalRows, terms_within};
use crate::condense::single_contact::{Denominators, SingleContact};
use crate::condense::wave_modes::{NEAR_RESONANCE, WaveModes};
use crate::error::{Result, boxed, try_push, try_vec};
use crate::interrupt::Interrupt;
use num_complex::Complex64;
use std::sync::Arc;

const CONTEXT: &str = "the flexibility from modes";

/// Iterations for a resonance: each makes its error some hundred times smaller.
const RESONANCE_ITERATIONS: usize = 3;

/// A harmonic with the modes of its wave.
pub struct ModalTable {
    rows: Arc<ModalRows>,
    number: f64,
    /// Terms of the series over stiff modes; none where all are summed.
    terms: usize,
    coefficients: Coefficients,
    /// The excitation seen by Φᴴ; none where there is none.
    force: Vec<Complex64>,
    /// The sums written out: one contact without springs.
    single: Option<SingleContact>,
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

/// Work space of the tables of one structure, for one after the other; made when the first needs it.
#[derive(Default)]
pub struct ModalWork(Option<Box<Work>>);

struct Work {
    /// 1/d, and −∂d/d².
    inverse: Vec<Complex64>,
    slopes: Vec<Complex64>,
    /// Lᴴ times one of them.
    weighted: Vec<Complex64>,
    /// T′ and ∂T′, rows × rows.
    plain: Vec<Complex64>,
    d_plain: Vec<Complex64>,
    low_rank: LowRank,
}

impl ModalWork {
    fn of(&mut self, table: &ModalTable) -> Result<&mut Work> {
        let known = match self.0.take() {
            Some(known) => known,
            None => boxed(|| Work::new(table))?,
        };
        Ok(self.0.insert(known))
    }
}

impl Work {
    fn new(table: &ModalTable) -> Result<Self> {
        let (rows, n) = (table.rows.count(), table.rows.modes().values.len());
        let zeros = |len| try_vec(len, Complex64::ZERO, CONTEXT);
        Ok(Self {
            inverse: zeros(n)?,
            slopes: zeros(n)?,
            weighted: zeros(rows * n)?,
            plain: zeros(rows * rows)?,
            d_plain: zeros(rows * rows)?,
            low_rank: LowRank::new(table.rows.coordinates(), table.coefficients.len())?,
        })
    }
}

impl ModalTable {
    /// The table of the i-th carried harmonic from the rows of its wave, within a relative tolerance, 0: as exact as numbers are.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new((condensed, i): (&Condensed, usize), rows: Arc<ModalRows>, tolerance: f64) -> Result<Self> {
        let block = &condensed.blocks()[i];
        let modes = rows.modes();
        let mut force = Vec::new();
        if block.force.iter().any(|f| *f != Complex64::ZERO) {
            for shape in modes.vectors.chunks_exact(condensed.ndof()) {
                try_push(&mut force, crate::linalg::inner(shape, &block.force), CONTEXT)?;
            }
        }
        let coefficients = Coefficients::new(condensed, i, rows.springs(), modes.is_damped_by_stiffness())?;
        let single = if condensed.coordinates() == 1 && rows.count() == 2 {
            Some(SingleContact::new(&modes.values, rows.left(), &force)?)
        } else {
            None
        };
        Ok(Self {
            number: block.number as f64,
            terms: terms_within(tolerance),
            coefficients,
            force,
            single,
            rows,
        })
    }

    /// Its numbers where it is one of a single contact without springs.
    pub(super) fn single(&self) -> Option<SinglePart<'_>> {
        let modes = self.modes();
        self.single.as_ref().map(|contact| SinglePart {
            contact,
            coefficients: &self.coefficients,
            number: self.number,
            proportional: modes.proportional,
            loss_factor: modes.loss_factor,
        })
    }

    /// The rows of its wave.
    #[must_use]
    pub fn rows(&self) -> Arc<ModalRows> {
        Arc::clone(&self.rows)
    }

    fn modes(&self) -> &WaveModes {
        self.rows.modes()
    }

    /// Evaluates H at `omega`, and ∂H/∂ω if `slopes`; `false` so near a resonance of the structure with stuck contacts that
    /// digits would be lost.
    ///
    /// # Errors
    /// `Singular` at an undamped resonance; `StoppedByCaller`.
    pub fn evaluate(
        &self,
        (omega, slopes): (f64, bool),
        work: &mut ModalWork,
        table: &mut Table,
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let at = self.frequency(omega);
        let inertia = self.inertia(omega);
        let nu = self.number * omega;
        let is_clear = if let Some(single) = &self.single {
            let (s, d_s) = inertia;
            let by = Denominators {
                at,
                s,
                d_s,
                nu,
                least: NEAR_RESONANCE,
            };
            let coefficients = &self.coefficients;
            single.evaluate(
                by,
                (coefficients.entry(0, at.c), coefficients.d_entry(0, at.d_c)),
                table,
            )
        } else {
            let work = work.of(self)?;
            let is_clear = self.denominators(work, at, inertia, nu);
            if is_clear {
                self.sum(work, (at, inertia.0), slopes)?;
                self.complete(work, (at, slopes), table, interrupt)?;
            }
            is_clear
        };
        if is_clear {
            check_finite(&table.value, omega)?;
        }
        Ok(is_clear)
    }

    /// Resonances of the structure with its reference stiffness between two frequencies: the complex ω at which
    ///
    /// > 1 + c − E_kk − Σ_{j≠k} E_kj E_jk/(1 + c − s μ_j − E_jj) = s μ_k,  E = Rᴴ e R,  s = ν² − iνα
    ///
    /// with the rows R of the low-rank term, to second order in it. Undamped frequencies begin an iteration.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn resonances(&self, (low, high): (f64, f64)) -> Result<Vec<Complex64>> {
        let mut found = Vec::new();
        for (k, mu) in self.modes().values.iter().enumerate().filter(|(_, mu)| **mu > 0.0) {
            let omega = mu.sqrt().recip() / self.number;
            if !(low..=high).contains(&omega) {
                continue;
            }
            let mut pole = Complex64::from(omega);
            for _ in 0..RESONANCE_ITERATIONS {
                pole = self.next_resonance(k, pole);
            }
            try_push(&mut found, pole, CONTEXT)?;
        }
        Ok(found)
    }

    /// The resonance of mode k from one near it.
    fn next_resonance(&self, k: usize, omega: Complex64) -> Complex64 {
        let modes = self.modes();
        let (alpha, beta) = modes.proportional;
        let nu = self.number * omega;
        let c = Complex64::I * (nu * beta + modes.loss_factor);
        let s = nu * nu - Complex64::I * nu * alpha;
        let of = &self.coefficients;
        let coupling = |i: usize, j: usize| -> Complex64 {
            let [left, right] = [i, j].map(|mode| self.rows.of_mode(mode));
            let of_row = |b: usize| of.entry(b, c) * left[of.row_of(b)].conj() * right[of.row_of(b)];
            (0..if of.counts { of.len() } else { 0 }).map(of_row).sum()
        };
        let mut stiffness = 1.0 + c - coupling(k, k);
        for (j, mu) in modes.values.iter().enumerate().filter(|(j, _)| *j != k) {
            stiffness -= coupling(k, j) * coupling(j, k) / (1.0 + c - s * mu - coupling(j, j));
        }
        (stiffness / modes.values[k] + Complex64::I * alpha * nu).sqrt() / self.number
    }

    /// c and ∂c/∂ω.
    fn frequency(&self, omega: f64) -> Frequency {
        let beta = self.modes().proportional.1;
        let (nu, by_omega) = (self.number * omega, self.number);
        Frequency {
            c: Complex64::new(0.0, nu * beta + self.modes().loss_factor),
            d_c: Complex64::new(0.0, by_omega * beta),
        }
    }

    /// ν² − iνα and its derivative by ω.
    fn inertia(&self, omega: f64) -> (Complex64, Complex64) {
        let alpha = self.modes().proportional.0;
        let nu = self.number * omega;
        let by_omega = self.number * Complex64::new(2.0 * nu, -alpha);
        (Complex64::new(nu * nu, -nu * alpha), by_omega)
    }

    /// 1/d and its derivative; `false` where a denominator is small.
    fn denominators(
        &self,
        work: &mut Work,
        at: Frequency,
        (inertia, d_inertia): (Complex64, Complex64),
        nu: f64,
    ) -> bool {
        let modes = self.modes();
        let is_clear = modes.invert((at.c, inertia), nu, &mut work.inverse);
        let slopes = work.slopes.iter_mut().zip(&work.inverse).zip(&modes.values);
        for ((slope, inverse), mu) in slopes {
            *slope = -(at.d_c - d_inertia * mu) * *inverse * *inverse;
        }
        is_clear
    }

    /// T′, and ∂T′ if `slopes`.
    fn sum(&self, work: &mut Work, (at, inertia): (Frequency, Complex64), slopes: bool) -> Result<()> {
        let stiffness = 1.0 + at.c;
        let soft = self
            .rows
            .add_stiff((inertia / stiffness, stiffness), self.terms, &mut work.plain)?;
        self.rows.add(soft, &work.inverse, &mut work.weighted, &mut work.plain);
        self.excite(&work.inverse, &mut work.plain);
        if slopes {
            work.d_plain.fill(Complex64::ZERO);
            self.rows.add(0, &work.slopes, &mut work.weighted, &mut work.d_plain);
            self.excite(&work.slopes, &mut work.d_plain);
        }
        Ok(())
    }

    /// The column of the excitation, from all modes.
    fn excite(&self, factors: &[Complex64], out: &mut [Complex64]) {
        let (rows, from) = (self.rows.count(), self.rows.coordinates() * self.rows.count());
        let column = &mut out[from..from + rows];
        column.fill(Complex64::ZERO);
        for ((left, force), factor) in self.rows.left().chunks_exact(rows).zip(&self.force).zip(factors) {
            let weighted = force * factor;
            for (out, left) in column.iter_mut().zip(left) {
                *out += left * weighted;
            }
        }
    }

    /// The table from T′ with the low-rank term.
    fn complete(
        &self,
        work: &mut Work,
        (at, slopes): (Frequency, bool),
        table: &mut Table,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let (rows, outputs) = (self.rows.count(), self.rows.coordinates() + 1);
        let of = |plain: &[Complex64], to: &mut [Complex64]| {
            for (to, from) in to.chunks_exact_mut(outputs).zip(plain.chunks_exact(rows)) {
                to.copy_from_slice(&from[..outputs]);
            }
        };
        of(&work.plain, &mut table.value);
        if slopes {
            of(&work.d_plain, &mut table.slope);
        } else {
            table.slope.fill(Complex64::ZERO);
        }
        let plain = Plain {
            value: &work.plain,
            slope: &work.d_plain,
            rows,
        };
        work.low_rank
            .add(&self.coefficients, &plain, (at, slopes), table, interrupt)
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

    fn table_of(condensed: &Condensed, i: usize, modes: Arc<WaveModes>) -> ModalTable {
        let rows = ModalRows::new((condensed, i, 4), modes).unwrap();
        ModalTable::new((condensed, i), Arc::new(rows), 0.0).unwrap()
    }

    #[test]
    fn tables_from_modes_are_those_by_factorisation() {
        for (sectors, reference) in [
            (1, Reference::Stuck),
            (24, Reference::Stuck),
            (8, Reference::Stuck),
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
                    let by_modes = table_of(&condensed, i, modes);
                    let mut work = ModalWork::default();
                    let mut table = Table::new(condensed.coordinates()).unwrap();
                    for omega in [0.05, 0.4, 1.0, 1.3, 2.7, 9.0] {
                        let found = by_modes.evaluate((omega, true), &mut work, &mut table, &Interrupt::none());
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
                // On eight sectors harmonics travel either way, with conjugate modes.
                let waves = match sectors {
                    1 => 1,
                    8 => 2,
                    _ => 4,
                };
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
                    let by_modes = table_of(&condensed, i, modes);
                    let mut work = ModalWork::default();
                    let mut table = Table::new(1).unwrap();
                    for omega in [0.05, 0.4, 1.3, 9.0] {
                        assert!(
                            by_modes
                                .evaluate((omega, true), &mut work, &mut table, &Interrupt::none())
                                .unwrap()
                        );
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
        let by_modes = table_of(&condensed, 0, modes);
        let mut work = ModalWork::default();
        let mut table = Table::new(condensed.coordinates()).unwrap();
        for (factor, clear) in [(1.0, false), (1.0 + 1e-5, false), (1.01, true)] {
            let found = by_modes.evaluate((factor * resonance, true), &mut work, &mut table, &Interrupt::none());
            assert_eq!(found.unwrap(), clear, "{factor}");
        }
    }
}
