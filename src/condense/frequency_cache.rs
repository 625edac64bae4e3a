//! The flexibility tables of all carried harmonics at a frequency: sums over modes or poles where a sweep has them, by
//! factorisation elsewhere.

use crate::condense::by_factors::flexibility::{Slopes, Table, Workspace};
use crate::condense::by_modes::modal_rows::ModalRows;
use crate::condense::by_modes::modal_table::{ModalTable, ModalWork};
use crate::condense::by_modes::mode_flexibility::BEYOND_ITS_ERROR;
use crate::condense::{Condensed, FlexibilityWay};
use crate::error::{Result, try_copy, try_push, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::options::Range;
use num_complex::Complex64;
use std::sync::Arc;

/// Degrees of freedom up to which tables at a single frequency, where no branch uses slopes, have them: they take little time.
/// Kind: tuned; measured on: not recorded.
const SLOPES_AT_ONE_UP_TO: usize = 100;

/// Relative error of sums, and of their slopes, which lead steps and change no solution.
/// Kind: rounding.
const FREQUENCY_CACHE_TOLERANCE: f64 = 1e-11;
const OF_SLOPES: f64 = 1e-9;

const CONTEXT: &str = "the contact flexibility";

/// Coordinates up to which all slopes are made by factorisation. The residual needs them along one motion only, which takes a further
/// factorisation, and they take three quarters of the work where contacts are many.
/// Kind: tuned; measured on: not recorded.
const ALL_SLOPES_UP_TO: usize = 64;

/// The same for sums over modes, whose slopes along one motion take products with vectors alone.
/// Kind: tuned; measured on: not recorded.
const ALL_MODAL_SLOPES_UP_TO: usize = 8;

/// Coordinates from which a table from modes is made of its last column alone where no contact acts on the motion. A wheel
/// of 24 contacts, all of which stick over most of its range, takes a twentieth of the time there. Tables by factorisation
/// are always made so there: a harmonic without force then needs no factors at all.
/// Kind: tuned; measured on: a wheel of 24 contacts.
const EXCITED_ALONE_FROM: usize = 8;

/// Flexibility tables of all carried harmonics at one frequency.
pub struct FrequencyCache {
    workspace: Workspace,
    current: Vec<Table>,
    of_modes: ModalTables,
    /// How the table of the lowest vibrating harmonic is made along a sweep, as reported to the caller.
    told: FlexibilityWay,
    /// Per harmonic, whether its table is made and independent of the frequency.
    constant: Vec<bool>,
    /// Per harmonic, whether its table lacks slopes (a table by factorisation still has those of the response); and
    /// whether it is from modes.
    lacks_slopes: Vec<bool>,
    is_modal: Vec<bool>,
    /// Frequency of the current tables, and whether they have the columns of the contacts.
    tabulated: Option<(f64, bool)>,
    /// Whether tables by factorisation have slopes.
    has_slopes: bool,
}

/// Tables from modes.
pub struct ModalTables {
    /// Per harmonic the table from modes or poles, where it is used.
    tables: Vec<Option<ModalTable>>,
    /// Work space of the tables from modes: one for all, or one for each where slopes along a motion follow.
    work: Vec<ModalWork>,
    /// Whether the tables from modes have slopes.
    slopes: bool,
}

impl FrequencyCache {
    /// Tables for a sweep over `range` = (start, end), with `response` as the last row.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn new(condensed: &Condensed, response: usize, range: Range, interrupt: &Interrupt<'_>) -> Result<Self> {
        let coordinates = condensed.coordinates();
        let sweep = !range.is_single();
        let mut workspace = Workspace::new(condensed, Some(response))?;
        let mut tables = Vec::new();
        let (mut modal, mut constant) = (Vec::new(), Vec::new());
        let mut told = None;
        let count = condensed.blocks().len();
        let mut waves = Vec::new();
        let mut modal_work = Vec::new();
        for _ in 0..count.max(1) {
            try_push(&mut modal_work, ModalWork::default(), CONTEXT)?;
        }
        for i in 0..count {
            interrupt.part(Phase::Condensation, i, count)?;
            try_push(&mut tables, Table::new(coordinates)?, CONTEXT)?;
            try_push(&mut constant, false, CONTEXT)?;
            let from_modes = if sweep {
                let known = (&mut waves, &mut modal_work[0], &mut workspace);
                of_wave((condensed, i, response), range, known, interrupt)?
            } else {
                None
            };
            if condensed.blocks()[i].number > 0 && told.is_none() {
                told = Some(match (condensed.blocks()[i].flexibility_way(), &from_modes) {
                    _ if !sweep => FlexibilityWay::SingleFrequency,
                    (FlexibilityWay::Modes | FlexibilityWay::Poles, None) => FlexibilityWay::Disagreement,
                    (known, _) => known,
                });
            }
            try_push(&mut modal, from_modes, CONTEXT)?;
        }
        Ok(Self {
            workspace,
            current: tables,
            of_modes: ModalTables {
                tables: modal,
                work: modal_work,
                slopes: true,
            },
            told: told.unwrap_or_default(),
            lacks_slopes: try_vec(constant.len(), false, CONTEXT)?,
            is_modal: try_vec(constant.len(), false, CONTEXT)?,
            constant,
            tabulated: None,
            has_slopes: sweep || condensed.ndof() <= SLOPES_AT_ONE_UP_TO,
        })
    }

    /// How the table of the lowest vibrating harmonic is made along a sweep, and why so.
    pub fn flexibility_way(&self) -> FlexibilityWay {
        self.told
    }

    /// Uses the given tables from modes, without slopes, as exactly as an error estimate needs them.
    pub fn set_modes(&mut self, modal: Vec<Option<ModalTable>>) {
        self.of_modes.tables = modal;
        self.of_modes.slopes = false;
        self.tabulated = None;
    }

    /// Whether tables are made from modes for an error estimate.
    pub fn has_modes(&self) -> bool {
        !self.of_modes.slopes
    }

    /// The tables made last.
    pub fn current(&self) -> &[Table] {
        &self.current
    }

    /// Whether the table of some harmonic lacks slopes.
    pub fn lacks_slopes(&self) -> bool {
        self.lacks_slopes.contains(&true)
    }

    /// Whether that of the i-th harmonic lacks slopes, but for those of the response.
    pub fn lacks_slopes_of(&self, i: usize) -> bool {
        self.lacks_slopes[i]
    }

    /// Whether that of the i-th harmonic lacks those of the response too, which are then found along a motion with the others.
    pub fn lacks_slopes_of_response(&self, i: usize) -> bool {
        self.lacks_slopes[i] && self.is_modal[i]
    }

    /// Derivative by the frequency of the motions of the i-th harmonic under constant contact forces, where its table
    /// lacks slopes. `contact_force` is as in [`Workspace::recover`].
    ///
    /// # Errors
    /// Those of [`Workspace::evaluate`].
    pub fn slope_along(
        &mut self,
        condensed: &Condensed,
        i: usize,
        contact_force: &[Complex64],
        change: &mut [Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let Some((omega, ..)) = self.tabulated.filter(|_| self.lacks_slopes[i]) else {
            return Ok(());
        };
        if let Some(Some(modal)) = self.of_modes.tables.get(i).filter(|_| self.is_modal[i]) {
            modal.slope_along(omega, &mut self.of_modes.work[i], contact_force, change);
            return Ok(());
        }
        self.workspace
            .slope_along(condensed, (i, omega), contact_force, change, interrupt)
    }

    /// Angular frequency of the current tables; `None` before the first ones.
    pub fn frequency(&self) -> Option<f64> {
        self.tabulated.map(|(omega, ..)| omega)
    }

    /// Makes the tables at `omega`, unless they are current. Without `contacts`, where no contact acts on the motion,
    /// the columns of the contacts may stay zero.
    ///
    /// # Errors
    /// Those of [`Workspace::evaluate`].
    pub fn tabulate(
        &mut self,
        condensed: &Condensed,
        (omega, contacts): (f64, bool),
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let alone = !contacts && self.excited_alone_takes_less(condensed) && !condensed.has_exchanges();
        let is_current = |whole| self.tabulated == Some((omega, whole));
        if is_current(true) || (alone && is_current(false)) {
            return Ok(());
        }
        self.tabulated = None;
        if alone {
            return self.tabulate_excited(condensed, omega, interrupt);
        }
        let may_lack = !condensed.has_exchanges();
        let keeps = self.of_modes.slopes && has_slopes_along(condensed);
        let of_modes = self.of_modes.slopes && !keeps;
        let workspace = &mut self.workspace;
        for (i, table) in self.current.iter_mut().enumerate() {
            if self.constant[i] {
                continue;
            }
            let block = &condensed.blocks()[i];
            if let Some(Some(modal)) = self.of_modes.tables.get(i).filter(|_| !of_modes) {
                modal.count(omega, &mut self.of_modes.work[if keeps { i } else { 0 }], interrupt)?;
            }
            if let Some(Some(modal)) = self.of_modes.tables.get(i)
                && let work = &mut self.of_modes.work[modal.own_work(keeps, i)]
                && modal.evaluate((omega, of_modes), work, table, interrupt)?
            {
                (self.lacks_slopes[i], self.is_modal[i]) = (keeps, true);
                if !may_lack {
                    condensed.exchange(i, omega, table);
                }
                continue;
            }
            interrupt.check()?;
            let slopes = match self.has_slopes {
                false => Slopes::None,
                true if may_lack
                    && (condensed.coordinates() > ALL_SLOPES_UP_TO
                        || condensed.tuned().is_some()
                        || workspace.solves_side_by_side(condensed)?) =>
                {
                    Slopes::OfResponse
                }
                true => Slopes::All,
            };
            (self.lacks_slopes[i], self.is_modal[i]) = (slopes == Slopes::OfResponse, false);
            workspace.tabulate(condensed, (i, omega), slopes, interrupt)?;
            workspace.exchange_table(table);
            condensed.exchange(i, omega, table);
            self.constant[i] = block.number == 0 && block.matrices.tied.is_none();
        }
        self.tabulated = Some((omega, true));
        Ok(())
    }

    /// Whether tables without the columns of the contacts save more than is lost where these are needed after all.
    fn excited_alone_takes_less(&self, condensed: &Condensed) -> bool {
        let by_factors = || self.of_modes.tables.iter().all(Option::is_none);
        let coordinates = condensed.coordinates();
        coordinates >= EXCITED_ALONE_FROM || (coordinates > 0 && by_factors())
    }

    /// Makes the tables with the column of the excitation alone: by sums where these are accurate, else by
    /// factorisation.
    fn tabulate_excited(&mut self, condensed: &Condensed, omega: f64, interrupt: &Interrupt<'_>) -> Result<()> {
        for (i, table) in self.current.iter_mut().enumerate() {
            if self.constant[i] {
                continue;
            }
            interrupt.check()?;
            (self.lacks_slopes[i], self.is_modal[i]) = (false, false);
            if !condensed.blocks()[i].has_force() {
                table.value.fill(Complex64::ZERO);
                table.slope.fill(Complex64::ZERO);
                continue;
            }
            if let Some(Some(modal)) = self.of_modes.tables.get(i)
                && let work = &mut self.of_modes.work[modal.own_work(false, i)]
                && modal.evaluate_excited(omega, work, table, interrupt)?
            {
                continue;
            }
            self.workspace
                .tabulate_excited(condensed, (i, omega), table, interrupt)?;
        }
        self.tabulated = Some((omega, false));
        Ok(())
    }
}

/// The table of the i-th carried harmonic from the modes of its wave, where these exist and agree with a
/// factorisation at both ends of the range; at one end, where an earlier harmonic of the wave has agreed.
fn of_wave(
    (condensed, i, response): (&Condensed, usize, usize),
    range: Range,
    (waves, work, workspace): (&mut Vec<Arc<ModalRows>>, &mut ModalWork, &mut Workspace),
    interrupt: &Interrupt<'_>,
) -> Result<Option<ModalTable>> {
    let Range { start, stop: end } = range;
    let Some(source) = &condensed.blocks()[i].source else {
        return Ok(None);
    };
    let before = waves.len();
    let rows = ModalRows::shared((condensed, i, response), source.clone(), waves)?;
    let is_known = waves.len() == before;
    let modal = ModalTable::new((condensed, i), rows)?.over(range)?;
    let mut table = Table::new(condensed.coordinates())?;
    // The slope is made of the same modes: once shows that it is right.
    let mut checks_slope = true;
    for omega in [start, end].into_iter().skip(usize::from(is_known)) {
        let memory = (&mut *work, &mut *workspace, &mut table);
        if !agreement(&modal, (condensed, i, omega), &mut checks_slope, memory, interrupt)? {
            return Ok(None);
        }
    }
    Ok(Some(modal))
}

/// Whether tables from modes have slopes only along a motion.
fn has_slopes_along(condensed: &Condensed) -> bool {
    !condensed.has_exchanges() && condensed.coordinates() > ALL_MODAL_SLOPES_UP_TO
}

/// Whether the slopes along a motion of a table from modes, evaluated last, agree with those by factorisation at a
/// frequency.
fn agree_along(
    modal: &ModalTable,
    (condensed, i, omega): (&Condensed, usize, f64),
    (work, workspace): (&mut ModalWork, &mut Workspace),
    interrupt: &Interrupt<'_>,
) -> Result<bool> {
    let coordinates = condensed.coordinates();
    let mut forces = Vec::new();
    for c in 0..coordinates {
        // Forces of all phases move every mode.
        try_push(&mut forces, Complex64::cis(c as f64), CONTEXT)?;
    }
    let zeros = || try_vec(coordinates + 1, Complex64::ZERO, CONTEXT);
    let (mut by_modes, mut exact) = (zeros()?, zeros()?);
    modal.slope_along(omega, work, &forces, &mut by_modes);
    workspace.slope_along(condensed, (i, omega), &forces, &mut exact, interrupt)?;
    Ok(worst_column(&by_modes, &exact, coordinates + 1).1 <= OF_SLOPES)
}

/// Whether a table from modes agrees with the factorisation at a frequency, with its slope where that is to be checked; no
/// further slope is checked then.
fn agreement(
    modal: &ModalTable,
    (condensed, i, omega): (&Condensed, usize, f64),
    checks_slope: &mut bool,
    (work, workspace, table): (&mut ModalWork, &mut Workspace, &mut Table),
    interrupt: &Interrupt<'_>,
) -> Result<bool> {
    let outputs = condensed.coordinates() + 1;
    if *checks_slope && has_slopes_along(condensed) {
        if !modal.evaluate((omega, false), work, table, interrupt)? {
            return Ok(true);
        }
        // Where they do not agree along a motion, the whole table shows which is right.
        *checks_slope = !agree_along(modal, (condensed, i, omega), (work, workspace), interrupt)?;
    }
    if !modal.evaluate((omega, *checks_slope), work, table, interrupt)? {
        return Ok(true);
    }
    let exact = workspace.evaluate(condensed, i, omega, *checks_slope, interrupt)?;
    let parts = [(&table.value, &exact.value), (&table.slope, &exact.slope)];
    let checked = if core::mem::replace(checks_slope, false) { 2 } else { 1 };
    let allowed = [FREQUENCY_CACHE_TOLERANCE, OF_SLOPES];
    let mut off = Vec::new();
    for (part, (by_modes, exact)) in parts.into_iter().take(checked).enumerate() {
        let (column, deviation) = worst_column(by_modes, exact, outputs);
        // A factorisation of a stiff structure may be no better: that column shows.
        if deviation.is_nan() || deviation > allowed[part] {
            let of_column = column * outputs..(column + 1) * outputs;
            try_push(&mut off, (part, column, try_copy(&exact[of_column], CONTEXT)?), CONTEXT)?;
        }
    }
    for (part, column, factorised) in off {
        let refined = workspace.refined_column((condensed, i, column), omega, part == 1, interrupt)?;
        let by_modes = [&table.value, &table.slope][part];
        let of_factors = worst_column(&factorised, &refined[part], outputs).1;
        let of_modes = worst_column(
            &by_modes[column * outputs..(column + 1) * outputs],
            &refined[part],
            outputs,
        )
        .1;
        if !(of_modes <= allowed[part].max(BEYOND_ITS_ERROR * of_factors) && of_factors.is_finite()) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Index of the column with the largest relative deviation between two tables of `outputs` rows, and the deviation.
fn worst_column(a: &[Complex64], b: &[Complex64], outputs: usize) -> (usize, f64) {
    let mut largest = (0, 0.0_f64);
    for (k, (a, b)) in a.chunks_exact(outputs).zip(b.chunks_exact(outputs)).enumerate() {
        let off: f64 = a.iter().zip(b).map(|(a, b)| (a - b).norm_sqr()).sum();
        let size: f64 = b.iter().map(Complex64::norm_sqr).sum();
        if off.is_nan() || (off > 0.0 && size == 0.0) {
            return (k, f64::INFINITY);
        }
        if off > 0.0 && (off / size).sqrt() > largest.1 {
            largest = (k, (off / size).sqrt());
        }
    }
    largest
}

#[cfg(test)]
#[path = "frequency_cache_tests.rs"]
mod tests;
