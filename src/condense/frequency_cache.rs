//! The flexibility tables of all carried harmonics at a frequency: by factorisation for small structures or a
//! single frequency; along a sweep from modes for small structures, interpolated for others.

use crate::condense::Condensed;
use crate::condense::flexibility::{Table, Workspace};
use crate::condense::frequency_interpolation::FrequencyInterpolation;
use crate::condense::modal_rows::ModalRows;
use crate::condense::modal_table::{ModalTable, ModalWork};
use crate::condense::resonance_poles;
use crate::condense::shared_tables::SharedTables;
use crate::condense::single_contact_lanes::SingleContactLanes;
use crate::condense::table_layout::{deviation, is_symmetric};
use crate::condense::wave_cache::ALL_UP_TO;
use crate::error::{Result, boxed, try_copy, try_push};
use crate::interrupt::{Interrupt, Phase};
use core::ops::RangeInclusive;
use std::sync::Arc;

/// Degrees of freedom above which a sweep interpolates, and the same where a contact is near-rigid: the error of interpolated
/// tables, relative to the largest flexibility of a panel, would leave more forces out of balance than rounding does.
const INTERPOLATE_ABOVE: usize = 32;
const INTERPOLATE_ABOVE_IF_RIGID: usize = 200;

/// Relative error of interpolated tables, and of tables from modes.
const TOLERANCE: f64 = 1e-11;

/// Degrees of freedom up to which sums over modes of many contacts take less time than interpolation between them.
const SUMS_UP_TO: usize = 100;

/// Numbers of relative motions with which sums over modes are interpolated: with fewer the sums take no longer, with more the
/// tables would take too much memory.
const INTERPOLATED: RangeInclusive<usize> = 8..=96;

/// Most resonances in their range: with more the panels are so many that they take more time than the sums.
const MOST_RESONANCES: usize = 8;

/// Relative error of a column of an interpolated sum that shows that it must not be used.
const CLOSE: f64 = 1e-4;

/// Frequencies without a panel at which sums over modes are made before they are interpolated: a panel takes about as many.
const POINTWISE: usize = 10;

/// Relative error of a slope by factorisation over that of its table.
const SLOPE: f64 = 10.0;

/// Tables of all carried harmonics.
pub struct FrequencyCache<'a> {
    workspace: Workspace,
    response: usize,
    current: Vec<Table>,
    /// Per harmonic, whether a sweep interpolates its table.
    interpolated: Vec<bool>,
    /// Interpolated tables over the range of the sweep.
    tables: Tables<'a>,
    range: (f64, f64),
    /// Per harmonic the table from modes, where it is used.
    modal: Vec<Option<ModalTable>>,
    modal_work: ModalWork,
    /// The same tables of all harmonics at once, where each is from modes of a single contact.
    lanes: Option<SingleContactLanes>,
    /// Whether the tables from modes have slopes.
    modal_slopes: bool,
    /// Whether a sweep uses other tables than those by factorisation.
    is_quicker: bool,
    /// Per harmonic, whether its table is made and depends on no frequency.
    constant: Vec<bool>,
    /// Frequency of the current tables, and how they were made.
    tabulated: Option<(f64, Way)>,
    way: Way,
    /// Where sums over modes are interpolated: how, with memory of a sample.
    estimates: Option<(EstimateTables<'a>, Table)>,
}

/// Interpolated tables for estimates of errors over a range of frequency.
#[derive(Clone, Copy)]
pub struct EstimateTables<'a> {
    /// Start and end of the range.
    pub range: (f64, f64),
    /// Tables of the solutions over this range, which serve where there are such.
    pub solved: &'a SharedTables,
    /// The others.
    pub estimated: &'a SharedTables,
    /// Relative error of these.
    pub tolerance: f64,
}

/// Interpolated tables of this cache alone, or those that it shares with others.
enum Tables<'a> {
    Own(SharedTables),
    Shared(&'a SharedTables),
}

impl Tables<'_> {
    fn get(&self) -> &SharedTables {
        match self {
            Self::Own(tables) => tables,
            Self::Shared(tables) => tables,
        }
    }
}

/// How tables are made.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    /// From modes or by interpolation, where there are such.
    Quick,
    /// By factorisation, without slopes if these are expensive.
    Pointwise,
    /// By factorisation, with slopes.
    Factorised,
}

impl<'a> FrequencyCache<'a> {
    /// Tables for a sweep over `range` = (start, end), with `response` as the last row.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn new(condensed: &Condensed, response: usize, range: (f64, f64), interrupt: &Interrupt<'_>) -> Result<Self> {
        const CONTEXT: &str = "the contact flexibility";
        let coordinates = condensed.coordinates();
        let (start, end) = range;
        let sweep = start.to_bits() != end.to_bits();
        let mut workspace = Workspace::new(condensed, Some(response))?;
        let mut tables = Vec::new();
        let mut interpolated = Vec::new();
        let (mut modal, mut constant, mut is_quicker) = (Vec::new(), Vec::new(), false);
        let (mut waves, mut modal_work) = (Vec::new(), ModalWork::default());
        let count = condensed.blocks().len();
        let near_rigid = (0..coordinates).any(|c| condensed.is_near_rigid(c));
        let interpolate_above = if near_rigid {
            INTERPOLATE_ABOVE_IF_RIGID
        } else {
            INTERPOLATE_ABOVE
        };
        for i in 0..count {
            interrupt.part(Phase::Condensation, i, count)?;
            try_push(&mut tables, Table::new(coordinates)?, CONTEXT)?;
            try_push(&mut constant, false, CONTEXT)?;
            let from_modes = if sweep && sums_are_quicker(condensed) {
                let known = (&mut waves, &mut modal_work, &mut workspace);
                of_wave((condensed, i, response), range, known, interrupt)?
            } else {
                None
            };
            let interpolates = sweep && from_modes.is_none() && condensed.ndof() > interpolate_above;
            is_quicker |= from_modes.is_some() || interpolates;
            try_push(&mut modal, from_modes, CONTEXT)?;
            try_push(&mut interpolated, interpolates, CONTEXT)?;
        }
        Ok(Self {
            workspace,
            response,
            current: tables,
            interpolated,
            tables: Tables::Own(SharedTables::default()),
            range,
            lanes: SingleContactLanes::new(&modal)?,
            modal,
            modal_work,
            modal_slopes: true,
            is_quicker,
            constant,
            tabulated: None,
            estimates: None,
            // Without a sweep no slope is used.
            way: if !sweep && condensed.ndof() > INTERPOLATE_ABOVE {
                Way::Pointwise
            } else {
                Way::Quick
            },
        })
    }

    /// Selects tables by factorisation from now on, without slopes if these are expensive.
    pub fn set_pointwise(&mut self, pointwise: bool) {
        if self.is_quicker {
            self.way = if pointwise { Way::Pointwise } else { Way::Quick };
        }
    }

    /// Selects tables with slopes by factorisation from now on.
    pub fn set_factorised(&mut self, factorised: bool) {
        if self.is_quicker {
            self.way = if factorised { Way::Factorised } else { Way::Quick };
        }
    }

    /// Shares interpolated tables with other caches of the run, whose range and response are the same.
    pub fn share_tables(&mut self, tables: &'a SharedTables) {
        self.tables = Tables::Shared(tables);
    }

    /// Makes tables of the harmonics from modes where they are given, without slopes: from the first frequencies on interpolated
    /// over a range, if one is given, as exactly as an estimate of an error needs them.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn set_modes(
        &mut self,
        condensed: &Condensed,
        modal: Vec<Option<ModalTable>>,
        interpolated: Option<EstimateTables<'a>>,
    ) -> Result<()> {
        self.modal = modal;
        self.lanes = None;
        self.modal_slopes = false;
        self.tabulated = None;
        if let Some(tables) = interpolated.filter(|_| INTERPOLATED.contains(&condensed.coordinates())) {
            self.estimates = Some((tables, Table::new(condensed.coordinates())?));
        }
        Ok(())
    }

    /// Whether tables are made from modes.
    #[must_use]
    pub fn has_modes(&self) -> bool {
        !self.modal_slopes
    }

    /// The tables made last.
    #[must_use]
    pub fn current(&self) -> &[Table] {
        &self.current
    }

    /// Their frequency; `None` before the first ones.
    #[must_use]
    pub fn frequency(&self) -> Option<f64> {
        self.tabulated.map(|(omega, _)| omega)
    }

    /// Makes the tables at `omega`, unless they are current.
    ///
    /// # Errors
    /// Those of [`Workspace::evaluate`].
    pub fn tabulate(&mut self, condensed: &Condensed, omega: f64, interrupt: &Interrupt<'_>) -> Result<()> {
        if self.tabulated == Some((omega, self.way)) {
            return Ok(());
        }
        self.tabulated = None;
        if self.way == Way::Quick
            && let Some(lanes) = &self.lanes
            && lanes.evaluate(omega, &mut self.current)
        {
            self.tabulated = Some((omega, self.way));
            return Ok(());
        }
        let (workspace, work) = (&mut self.workspace, &mut self.modal_work);
        for (i, table) in self.current.iter_mut().enumerate() {
            if self.constant[i] {
                continue;
            }
            // With a single contact modes take less time than the check.
            if condensed.coordinates() > 1 {
                interrupt.check()?;
            }
            let block = &condensed.blocks()[i];
            let is_constant = block.number == 0 && block.tied.is_none();
            let is_quick = self.way == Way::Quick;
            let exactly = self.modal_slopes && !is_quick;
            let at = (condensed, i, omega);
            let shared = (self.tables.get(), self.range, self.response);
            if let Some(Some(modal)) = self.modal.get(i).filter(|_| !exactly) {
                if let Some((tables, sample)) = &mut self.estimates
                    && (tables.solved.known(condensed, i, omega, table)?
                        || interpolate_sums(tables, at, modal, (work, workspace, sample), table, interrupt)?)
                {
                    continue;
                }
                if modal.evaluate((omega, self.modal_slopes), work, table, interrupt)? {
                    continue;
                }
            }
            interrupt.check()?;
            let interpolates = self.interpolated[i] && is_quick && !is_constant;
            let done = interpolates && interpolate(shared, at, (work, workspace), table, interrupt)?;
            if !done {
                // A derived clone_from would allocate at each frequency.
                let slopes =
                    self.way != Way::Pointwise || matches!(self.modal.get(i), Some(Some(_)) if self.modal_slopes);
                let found = workspace.evaluate(condensed, i, omega, slopes, interrupt)?;
                table.value.copy_from_slice(&found.value);
                table.slope.copy_from_slice(&found.slope);
                self.constant[i] = is_constant;
            }
        }
        self.tabulated = Some((omega, self.way));
        Ok(())
    }
}

/// Whether a sum over all modes at each frequency takes less time than an interpolation between such sums.
fn sums_are_quicker(condensed: &Condensed) -> bool {
    let (n, coordinates) = (condensed.ndof(), condensed.coordinates());
    n <= SUMS_UP_TO || (n <= ALL_UP_TO && coordinates < *INTERPOLATED.start())
}

/// Interpolates a table between factorisations, or sums over modes where these are known; `false` where that is not possible.
fn interpolate(
    (tables, range, response): (&SharedTables, (f64, f64), usize),
    (condensed, i, omega): (&Condensed, usize, f64),
    (work, workspace): (&mut ModalWork, &mut Workspace),
    table: &mut Table,
    interrupt: &Interrupt<'_>,
) -> Result<bool> {
    tables.with(condensed, i, |kept, waves| {
        let interpolation = match &mut kept.interpolation {
            Some(known) => known,
            none => {
                if let Some(modes) = &condensed.blocks()[i].modes {
                    let rows = ModalRows::shared((condensed, i, response), modes, &mut waves.rows)?;
                    let modal = ModalTable::new((condensed, i), rows, TOLERANCE)?;
                    let at = (condensed, i, omega);
                    if agrees(&modal, at, &mut false, (work, workspace, table), interrupt)? {
                        kept.modal = Some(boxed(|| Ok(modal))?);
                    }
                }
                let resonances = resonance_poles::near(condensed, workspace, i, range, &mut waves.modes, interrupt)?;
                none.insert(FrequencyInterpolation::new(
                    kind(condensed, i),
                    range,
                    resonances,
                    TOLERANCE,
                )?)
            }
        };
        let Some(modal) = &kept.modal else {
            return interpolation.evaluate((omega, true), table, |w, values| {
                values.copy_from_slice(&workspace.evaluate(condensed, i, w, false, interrupt)?.value);
                Ok(())
            });
        };
        // Only a new panel takes memory for samples.
        if interpolation.evaluate_known((omega, true), table) {
            return Ok(true);
        }
        let mut sample = Table::new(condensed.coordinates())?;
        interpolation.evaluate((omega, true), table, |w, values| {
            sample_by_modes(modal, (condensed, i, w), (work, workspace, &mut sample), interrupt)?;
            values.copy_from_slice(&sample.value);
            Ok(())
        })
    })
}

/// Interpolates a table between sums over modes, without slopes; `false` for the first frequencies, where the sums take less
/// time, and where it is not possible.
fn interpolate_sums(
    tables: &EstimateTables<'_>,
    (condensed, i, omega): (&Condensed, usize, f64),
    modal: &ModalTable,
    (work, workspace, sample): (&mut ModalWork, &mut Workspace, &mut Table),
    table: &mut Table,
    interrupt: &Interrupt<'_>,
) -> Result<bool> {
    let range = tables.range;
    tables.estimated.with(condensed, i, |kept, _| {
        if kept.rejected {
            return Ok(false);
        }
        let known = kept.interpolation.as_mut();
        if known.is_some_and(|known| known.evaluate_known((omega, false), table)) {
            return Ok(true);
        }
        kept.requests += 1;
        if kept.requests <= POINTWISE {
            return Ok(false);
        }
        kept.requests = 0;
        let interpolation = match &mut kept.interpolation {
            Some(known) => known,
            none => {
                let width = (range.1 - range.0).abs();
                let around = (range.0.min(range.1) - width, range.0.max(range.1) + width);
                let resonances = modal.resonances(around)?;
                if resonances.len() > MOST_RESONANCES {
                    kept.rejected = true;
                    return Ok(false);
                }
                let kind = kind(condensed, i);
                none.insert(FrequencyInterpolation::new(kind, range, resonances, tables.tolerance)?)
            }
        };
        let mut sum = |w: f64, sample: &mut Table| {
            let at = (condensed, i, w);
            sample_by_modes(modal, at, (&mut *work, &mut *workspace, sample), interrupt)
        };
        let sums = interpolation.evaluations();
        let mut done = interpolation.evaluate((omega, false), table, |w, values| {
            sum(w, sample)?;
            values.copy_from_slice(&sample.value);
            Ok(())
        })?;
        if done && interpolation.evaluations() > sums {
            // The error of a panel is relative to its largest tables.
            sum(omega, sample)?;
            done = deviation(&table.value, &sample.value, condensed.coordinates() + 1) <= CLOSE;
        }
        // Each further attempt would cost many sums.
        kept.rejected = !done;
        Ok(done)
    })
}

/// A sample of a table: the sum over modes, or by factorisation where that would lose digits.
fn sample_by_modes(
    modal: &ModalTable,
    (condensed, i, omega): (&Condensed, usize, f64),
    (work, workspace, sample): (&mut ModalWork, &mut Workspace, &mut Table),
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    if !modal.evaluate((omega, false), work, sample, interrupt)? {
        let found = workspace.evaluate(condensed, i, omega, false, interrupt)?;
        sample.value.copy_from_slice(&found.value);
    }
    Ok(())
}

/// Relative motions, and whether tables are symmetric.
fn kind(condensed: &Condensed, i: usize) -> (usize, bool) {
    (condensed.coordinates(), is_symmetric(&condensed.blocks()[i]))
}

/// The table of the i-th carried harmonic from the modes of its wave, where it has them and they agree with a factorisation
/// at the ends of the range; at one, where an earlier harmonic of the wave has shown its modes to be right.
fn of_wave(
    (condensed, i, response): (&Condensed, usize, usize),
    (start, end): (f64, f64),
    (waves, work, workspace): (&mut Vec<Arc<ModalRows>>, &mut ModalWork, &mut Workspace),
    interrupt: &Interrupt<'_>,
) -> Result<Option<ModalTable>> {
    let Some(modes) = &condensed.blocks()[i].modes else {
        return Ok(None);
    };
    let is_known = waves.iter().any(|known| known.are_of(modes));
    let rows = ModalRows::shared((condensed, i, response), modes, waves)?;
    let modal = ModalTable::new((condensed, i), rows, 0.0)?;
    let mut table = Table::new(condensed.coordinates())?;
    // The slope is made of the same modes: once shows that it is right.
    let mut checks_slope = true;
    for omega in [start, end].into_iter().skip(usize::from(is_known)) {
        let memory = (&mut *work, &mut *workspace, &mut table);
        if !agrees(&modal, (condensed, i, omega), &mut checks_slope, memory, interrupt)? {
            return Ok(None);
        }
    }
    Ok(Some(modal))
}

/// Whether a table from modes agrees with a factorisation at a frequency, in its slope too where that is to be checked: then
/// nothing more of it is.
fn agrees(
    modal: &ModalTable,
    (condensed, i, omega): (&Condensed, usize, f64),
    checks_slope: &mut bool,
    (work, workspace, table): (&mut ModalWork, &mut Workspace, &mut Table),
    interrupt: &Interrupt<'_>,
) -> Result<bool> {
    let outputs = condensed.coordinates() + 1;
    if !modal.evaluate((omega, *checks_slope), work, table, interrupt)? {
        return Ok(true);
    }
    let exact = workspace.evaluate(condensed, i, omega, *checks_slope, interrupt)?;
    let slope = if *checks_slope {
        deviation(&table.slope, &exact.slope, outputs)
    } else {
        0.0
    };
    let value = deviation(&table.value, &exact.value, outputs);
    *checks_slope = false;
    if value.max(slope) <= TOLERANCE {
        return Ok(true);
    }
    if condensed.ndof() <= INTERPOLATE_ABOVE {
        return Ok(false);
    }
    // A factorisation of a stiff structure may be no better.
    let factorised = try_copy(&exact.value, "the contact flexibility")?;
    let refined = workspace.refined(condensed, i, omega, interrupt)?;
    let own = deviation(&factorised, refined, outputs);
    let by_modes = deviation(&table.value, refined, outputs);
    let are_close = by_modes <= TOLERANCE.max(own) && slope <= TOLERANCE.max(SLOPE * own);
    Ok(are_close && (slope + by_modes).is_finite())
}
