//! The flexibility tables of all carried harmonics at a frequency: by factorisation for small structures or a
//! single frequency; along a sweep from modes for small structures, interpolated for others.

use crate::condense::flexibility::{Table, Workspace};
use crate::condense::frequency_interpolation::FrequencyInterpolation;
use crate::condense::modal_table::ModalTable;
use crate::condense::resonance_poles;
use crate::condense::table_layout::is_symmetric;
use crate::condense::{Condensed, HarmonicBlock};
use crate::error::{Result, try_copy, try_push};
use crate::interrupt::{Interrupt, Phase};
use num_complex::Complex64;
use std::sync::Arc;

/// Degrees of freedom above which a sweep interpolates.
const INTERPOLATE_ABOVE: usize = 32;

/// Relative error of interpolated tables, and of tables from modes.
const TOLERANCE: f64 = 1e-11;

/// Relative error of a slope by factorisation over that of its table.
const SLOPE: f64 = 10.0;

/// Tables of all carried harmonics.
pub struct FrequencyCache {
    workspace: Workspace,
    current: Vec<Table>,
    /// Per harmonic its interpolation, where it is used.
    interpolations: Vec<Option<FrequencyInterpolation>>,
    /// Per harmonic the table from modes, where it is used.
    modal: Vec<Option<ModalTable>>,
    /// Whether the tables from modes have slopes.
    modal_slopes: bool,
    /// Whether a sweep uses other tables than those by factorisation.
    is_quicker: bool,
    /// Per harmonic, whether its table is made and depends on no frequency.
    constant: Vec<bool>,
    /// Frequency of the current tables, and how they were made.
    tabulated: Option<(f64, Way)>,
    way: Way,
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

impl FrequencyCache {
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
        let mut interpolations = Vec::new();
        let (mut modal, mut constant, mut is_quicker) = (Vec::new(), Vec::new(), false);
        let count = condensed.blocks().len();
        for i in 0..count {
            interrupt.part(Phase::Condensation, i, count)?;
            try_push(&mut tables, Table::new(coordinates)?, CONTEXT)?;
            try_push(&mut constant, false, CONTEXT)?;
            let from_modes = if sweep {
                of_wave(condensed, i, response, (range, &mut workspace), interrupt)?
            } else {
                None
            };
            let interpolation = if sweep && from_modes.is_none() && condensed.ndof() > INTERPOLATE_ABOVE {
                let resonances = resonance_poles::near(condensed, &mut workspace, i, range, interrupt)?;
                let kind = (coordinates, is_symmetric(&condensed.blocks()[i]));
                Some(FrequencyInterpolation::new(kind, range, resonances, TOLERANCE)?)
            } else {
                None
            };
            is_quicker |= from_modes.is_some() || interpolation.is_some();
            try_push(&mut modal, from_modes, CONTEXT)?;
            try_push(&mut interpolations, interpolation, CONTEXT)?;
        }
        Ok(Self {
            workspace,
            current: tables,
            interpolations,
            modal,
            modal_slopes: true,
            is_quicker,
            constant,
            tabulated: None,
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

    /// Makes tables of the harmonics from modes where they are given, without slopes.
    pub fn set_modes(&mut self, modal: Vec<Option<ModalTable>>) {
        self.modal = modal;
        self.modal_slopes = false;
        self.tabulated = None;
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

    /// Makes the tables at `omega`, unless they are current.
    ///
    /// # Errors
    /// Those of [`Workspace::evaluate`].
    pub fn tabulate(&mut self, condensed: &Condensed, omega: f64, interrupt: &Interrupt<'_>) -> Result<()> {
        if self.tabulated == Some((omega, self.way)) {
            return Ok(());
        }
        self.tabulated = None;
        let workspace = &mut self.workspace;
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
            if let Some(Some(modal)) = self.modal.get_mut(i).filter(|_| !exactly)
                && modal.evaluate(omega, self.modal_slopes, table, interrupt)?
            {
                continue;
            }
            interrupt.check()?;
            let done = match self.interpolations.get_mut(i) {
                Some(Some(interpolation)) if is_quick && !is_constant => {
                    interpolation.evaluate(omega, table, |w, values| {
                        values.copy_from_slice(&workspace.evaluate(condensed, i, w, false, interrupt)?.value);
                        Ok(())
                    })?
                }
                _ => false,
            };
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

/// The table of the i-th carried harmonic from the modes of its wave, where it has them and they agree with a factorisation
/// at the ends of the range; at one, where an earlier harmonic of the wave has shown its modes to be right.
fn of_wave(
    condensed: &Condensed,
    i: usize,
    response: usize,
    ((start, end), workspace): ((f64, f64), &mut Workspace),
    interrupt: &Interrupt<'_>,
) -> Result<Option<ModalTable>> {
    let Some(modes) = &condensed.blocks()[i].modes else {
        return Ok(None);
    };
    let mut modal = ModalTable::new(condensed, i, response, Arc::clone(modes))?;
    let mut table = Table::new(condensed.coordinates())?;
    let outputs = condensed.coordinates() + 1;
    let shares = |block: &HarmonicBlock| block.modes.as_ref().is_some_and(|known| Arc::ptr_eq(known, modes));
    let is_known = condensed.blocks()[..i].iter().any(shares);
    // The slope is made of the same modes: once shows that it is right.
    let mut checks_slope = true;
    for omega in [start, end].into_iter().skip(usize::from(is_known)) {
        if !modal.evaluate(omega, true, &mut table, interrupt)? {
            continue;
        }
        let exact = workspace.evaluate(condensed, i, omega, checks_slope, interrupt)?;
        let slope = if checks_slope {
            deviation(&table.slope, &exact.slope, outputs)
        } else {
            0.0
        };
        let value = deviation(&table.value, &exact.value, outputs);
        checks_slope = false;
        if value.max(slope) <= TOLERANCE {
            continue;
        }
        if condensed.ndof() <= INTERPOLATE_ABOVE {
            return Ok(None);
        }
        // A factorisation of a stiff structure may be no better.
        let factorised = try_copy(&exact.value, "the contact flexibility")?;
        let refined = workspace.refined(condensed, i, omega, interrupt)?;
        let own = deviation(&factorised, refined, outputs);
        let by_modes = deviation(&table.value, refined, outputs);
        if by_modes > TOLERANCE.max(own) || slope > TOLERANCE.max(SLOPE * own) || !(slope + by_modes).is_finite() {
            return Ok(None);
        }
    }
    Ok(Some(modal))
}

/// Largest relative deviation of a column of a table from that of another one.
fn deviation(a: &[Complex64], b: &[Complex64], outputs: usize) -> f64 {
    let mut largest = 0.0_f64;
    for (a, b) in a.chunks_exact(outputs).zip(b.chunks_exact(outputs)) {
        let off: f64 = a.iter().zip(b).map(|(a, b)| (a - b).norm_sqr()).sum();
        let size: f64 = b.iter().map(Complex64::norm_sqr).sum();
        if off > 0.0 || off.is_nan() {
            largest = largest.max((off / size).sqrt());
            if off.is_nan() || size == 0.0 {
                return f64::INFINITY;
            }
        }
    }
    largest
}
