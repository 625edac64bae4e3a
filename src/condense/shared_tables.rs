//! Interpolated flexibilities that the condensed models of one run share: those with more harmonics have the tables of the
//! harmonics that they have in common with others.

use crate::condense::Condensed;
use crate::condense::flexibility::Table;
use crate::condense::frequency_interpolation::FrequencyInterpolation;
use crate::condense::modal_rows::ModalRows;
use crate::condense::modal_table::ModalTable;
use crate::condense::resonance_poles::KnownModes;
use crate::condense::wave_modes::WaveModes;
use crate::error::{Result, try_push, try_room};
use core::cell::Cell;
use num_complex::Complex64;
use std::sync::Arc;

const CONTEXT: &str = "the interpolated flexibility";

/// Tables of the harmonics met so far, over one range of frequency and with one row of the response.
#[derive(Default)]
pub struct SharedTables {
    kept: Cell<Kept>,
}

#[derive(Default)]
struct Kept {
    tables: Vec<KeptTable>,
    waves: KeptWaves,
}

/// Modes of the waves.
#[derive(Default)]
pub(super) struct KeptWaves {
    /// Undamped modes from which resonances are sought.
    pub modes: KnownModes,
    /// All modes as contacts see them.
    pub rows: Vec<Arc<ModalRows>>,
}

/// Interpolation of one harmonic.
pub(super) struct KeptTable {
    number: usize,
    length: f64,
    /// Reference stiffness of the relative motions.
    kappa: Vec<Complex64>,
    /// Frequencies at which the table was requested before there was an interpolation.
    pub requests: usize,
    pub interpolation: Option<FrequencyInterpolation>,
    /// The table from modes, where its samples are sums over them.
    pub modal: Option<Box<ModalTable>>,
    /// Whether it is not exact somewhere, so that the table is made at each frequency.
    pub rejected: bool,
}

impl SharedTables {
    /// Calls `with` with the table of the i-th carried harmonic of a condensed model.
    ///
    /// # Errors
    /// `OutOfMemory`, and those of `with`.
    pub(super) fn with<T>(
        &self,
        condensed: &Condensed,
        i: usize,
        with: impl FnOnce(&mut KeptTable, &mut KeptWaves) -> Result<T>,
    ) -> Result<T> {
        let mut kept = self.kept.take();
        let found = kept
            .of(condensed, i)
            .and_then(|at| with(&mut kept.tables[at], &mut kept.waves));
        self.kept.set(kept);
        found
    }

    /// The rows of the modes of a wave, as [`ModalRows::shared`].
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn rows(&self, at: (&Condensed, usize, usize), modes: &Arc<WaveModes>) -> Result<Arc<ModalRows>> {
        let mut kept = self.kept.take();
        let rows = ModalRows::shared(at, modes, &mut kept.waves.rows);
        self.kept.set(kept);
        rows
    }

    /// Interpolates the table of the i-th carried harmonic at a frequency, without its slope; `false` where no panel is known.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub(super) fn known(&self, condensed: &Condensed, i: usize, omega: f64, table: &mut Table) -> Result<bool> {
        self.with(condensed, i, |kept, _| {
            let interpolation = kept.interpolation.as_mut();
            Ok(interpolation.is_some_and(|known| known.evaluate_known((omega, false), table)))
        })
    }
}

impl Kept {
    /// Index of the table of a harmonic in its unit of length and with its reference stiffness.
    fn of(&mut self, condensed: &Condensed, i: usize) -> Result<usize> {
        let (number, length) = (condensed.blocks()[i].number, condensed.length());
        let kappa = (0..condensed.coordinates()).map(|c| condensed.kappa(c, i));
        let is_same = |known: &KeptTable| {
            known.number == number
                && known.length.to_bits() == length.to_bits()
                && known.kappa.iter().copied().eq(kappa.clone())
        };
        if let Some(at) = self.tables.iter().position(is_same) {
            return Ok(at);
        }
        let mut new = KeptTable {
            number,
            length,
            kappa: try_room(condensed.coordinates(), CONTEXT)?,
            requests: 0,
            interpolation: None,
            modal: None,
            rejected: false,
        };
        new.kappa.extend(kappa);
        try_push(&mut self.tables, new, CONTEXT)?;
        Ok(self.tables.len() - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::SharedTables;
    use crate::condense::flexibility::Workspace;
    use crate::condense::frequency_cache::{EstimateTables, FrequencyCache};
    use crate::condense::frequency_interpolation::FrequencyInterpolation;
    use crate::condense::modal_rows::ModalRows;
    use crate::condense::modal_table::ModalTable;
    use crate::condense::wave_cache::WaveCache;
    use crate::condense::{Condensed, Reference};
    use crate::contact::Contact;
    use crate::interrupt::Interrupt;
    use crate::linalg::matrix_view::MatrixView;
    use crate::model::Model;
    use crate::model::structure::MatrixKind;
    use crate::options::SolverOptions;
    use num_complex::Complex64;

    const RESPONSE: usize = 3;

    /// A chain of `n` masses, on a wheel of nine sectors where `cyclic`, with twelve sliders against the ground.
    fn chain(n: usize, cyclic: bool, beta: f64) -> Model {
        let mut model = if cyclic {
            let mut wheel = Model::cyclic(n, 9).unwrap();
            wheel.set_wave(2);
            wheel
        } else {
            Model::new(n).unwrap()
        };
        let entry = |i: usize, j: usize, own: f64, beside: f64| match i.abs_diff(j) {
            0 => own + 0.1 * (i as f64).sin(),
            1 => beside,
            _ => 0.0,
        };
        let dense = |own, beside| -> Vec<f64> { (0..n * n).map(|k| entry(k % n, k / n, own, beside)).collect() };
        model
            .set_matrix(MatrixKind::Mass, &MatrixView::dense(n, &dense(1.0, 0.0)))
            .unwrap();
        model
            .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(n, &dense(2.3, -1.0)))
            .unwrap();
        if cyclic {
            let mut to_next = vec![0.0; n * n];
            (to_next[1], to_next[3 * n + 2]) = (-0.11, -0.07);
            model
                .set_coupling(MatrixKind::Stiffness, &MatrixView::dense(n, &to_next))
                .unwrap();
        }
        model.set_rayleigh(0.0, beta).unwrap();
        for i in 0..12 {
            model
                .add_contact(&Contact::jenkins(i, None, 0.2 + 0.1 * i as f64, 0.3, 1.0))
                .unwrap();
        }
        model.add_force(0, 1, Complex64::new(0.7, -0.2)).unwrap();
        model
    }

    fn condensed(model: &Model, harmonics: usize) -> Condensed {
        let options = SolverOptions {
            harmonics,
            ..SolverOptions::default()
        };
        Condensed::with_reference(model, &options, 0.5, Some(Reference::Stuck), &Interrupt::none()).unwrap()
    }

    /// Largest deviation of the tables of a cache from those by factorisation, relative to these.
    fn deviation(cache: &mut FrequencyCache<'_>, condensed: &Condensed, omega: f64) -> f64 {
        let interrupt = Interrupt::none();
        cache.tabulate(condensed, omega, &interrupt).unwrap();
        let mut direct = Workspace::new(condensed, Some(RESPONSE)).unwrap();
        let size = |z: &mut dyn Iterator<Item = Complex64>| z.map(|z| z.norm_sqr()).sum::<f64>().sqrt();
        let mut largest = 0.0_f64;
        for (i, table) in cache.current().iter().enumerate() {
            let exact = direct.evaluate(condensed, i, omega, false, &interrupt).unwrap();
            let mut off = table.value.iter().zip(&exact.value).map(|(a, b)| a - b);
            largest = largest.max(size(&mut off) / size(&mut exact.value.iter().copied()));
        }
        largest
    }

    /// The tables of all harmonics from modes.
    fn by_modes(model: &Model, condensed: &Condensed) -> Vec<Option<ModalTable>> {
        let (mut waves, mut known) = (WaveCache::default(), Vec::new());
        let table = |i| {
            let modes = waves.of(model, condensed, i, &Interrupt::none()).unwrap()?;
            let rows = ModalRows::shared((condensed, i, RESPONSE), &modes, &mut known);
            Some(ModalTable::new((condensed, i), rows.unwrap(), 0.0).unwrap())
        };
        (0..condensed.blocks().len()).map(table).collect()
    }

    /// Number of samples of the table of harmonic 1.
    fn samples(tables: &SharedTables, condensed: &Condensed) -> usize {
        let i = condensed.blocks().iter().position(|block| block.number == 1).unwrap();
        let count = tables.with(condensed, i, |kept, _| {
            Ok(kept
                .interpolation
                .as_ref()
                .map_or(0, FrequencyInterpolation::evaluations))
        });
        count.unwrap()
    }

    /// Sums over modes, interpolated from the seventh frequency on, over ranges with several resonances of each harmonic, with
    /// damping ratios from 1e-7 on: there a sample close to a resonance is a factorisation.
    #[test]
    fn interpolated_sums_are_the_tables_by_factorisation() {
        for (cyclic, beta) in [(false, 1e-2), (false, 1e-7), (true, 1e-3)] {
            let model = chain(20, cyclic, beta);
            let [tables, solved] = [(); 2].map(|()| SharedTables::default());
            let interpolated = EstimateTables {
                range: (0.5, 0.6),
                solved: &solved,
                estimated: &tables,
                tolerance: 1e-7,
            };
            let mut made = 0;
            for harmonics in [3, 7] {
                let condensed = condensed(&model, harmonics);
                let interrupt = Interrupt::none();
                let modal = by_modes(&model, &condensed);
                let mut cache = FrequencyCache::new(&condensed, RESPONSE, (0.5, 0.5), &interrupt).unwrap();
                cache.set_modes(&condensed, modal, Some(interpolated)).unwrap();
                // So many that each part of the range has its panel.
                for k in 0..160 {
                    let omega = 0.5 + 0.1 * f64::from(k * 7 % 160) / 160.0;
                    let off = deviation(&mut cache, &condensed, omega);
                    assert!(off < 1e-5, "{cyclic}, {beta}, H = {harmonics}, {omega}: {off:e}");
                }
                let now = samples(&tables, &condensed);
                assert!(now > 0 && (made == 0 || now == made), "{made} samples, then {now}");
                made = now;
            }
        }
    }

    #[test]
    fn estimates_use_the_tables_of_solutions() {
        let model = chain(40, true, 1e-3);
        let interrupt = Interrupt::none();
        let [solved, estimated] = [(); 2].map(|()| SharedTables::default());
        let (range, condensed) = ((0.5, 0.6), condensed(&model, 3));
        let mut sweep = FrequencyCache::new(&condensed, RESPONSE, range, &interrupt).unwrap();
        sweep.share_tables(&solved);
        let modal = by_modes(&model, &condensed);
        let mut cache = FrequencyCache::new(&condensed, RESPONSE, (0.5, 0.5), &interrupt).unwrap();
        let tables = EstimateTables {
            range,
            solved: &solved,
            estimated: &estimated,
            tolerance: 1e-5,
        };
        cache.set_modes(&condensed, modal, Some(tables)).unwrap();
        for k in 0..20 {
            let omega = 0.5 + 0.1 * f64::from(k) / 19.0;
            sweep.tabulate(&condensed, omega, &interrupt).unwrap();
            let off = deviation(&mut cache, &condensed, omega);
            assert!(off < 1e-9, "{omega}: {off:e}");
        }
        assert_eq!(samples(&estimated, &condensed), 0);
    }

    /// Models with more harmonics use the panels of those with fewer, and find them where they need others.
    #[test]
    fn models_of_one_run_share_interpolated_tables() {
        let model = chain(40, true, 1e-3);
        let interrupt = Interrupt::none();
        let tables = SharedTables::default();
        let range = (0.5, 0.6);
        let mut made = 0;
        for harmonics in [1, 5, 3] {
            let condensed = condensed(&model, harmonics);
            let mut cache = FrequencyCache::new(&condensed, RESPONSE, range, &interrupt).unwrap();
            cache.share_tables(&tables);
            for k in 0..20 {
                let omega = 0.5 + 0.1 * f64::from(k) / 19.0;
                let off = deviation(&mut cache, &condensed, omega);
                assert!(off < 1e-9, "H = {harmonics}, {omega}: {off:e}");
            }
            let now = samples(&tables, &condensed);
            assert!(now > 0 && (made == 0 || now == made), "{made} samples, then {now}");
            made = now;
        }
        // Other forces give another unit of length: nothing is shared.
        let mut other = chain(40, true, 1e-3);
        other.add_force(0, 1, Complex64::new(3e3, 0.0)).unwrap();
        assert_eq!(samples(&tables, &condensed(&other, 3)), 0);
    }
}
