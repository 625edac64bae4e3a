//! The flexibility tables of all carried harmonics at a frequency: by factorisation for small structures or a
//! single frequency, interpolated along a sweep otherwise.

use crate::condense::Condensed;
use crate::condense::flexibility::{Table, Workspace};
use crate::condense::frequency_interpolation::FrequencyInterpolation;
use crate::condense::modal_table::ModalTable;
use crate::condense::resonance_poles;
use crate::error::{Result, try_push};
use crate::interrupt::{Interrupt, Phase};

/// Degrees of freedom above which a sweep interpolates.
const INTERPOLATE_ABOVE: usize = 32;

/// Relative error of interpolated tables.
const TOLERANCE: f64 = 1e-11;

/// Tables of all carried harmonics.
pub struct FrequencyCache {
    workspace: Workspace,
    current: Vec<Table>,
    interpolations: Vec<FrequencyInterpolation>,
    /// Per harmonic the table from modes, where it is used; without slopes.
    modal: Vec<Option<ModalTable>>,
    /// Frequency of the current tables; `true` if they were made pointwise.
    tabulated: Option<(f64, bool)>,
    pointwise: bool,
    /// Whether interpolation is not used, and slopes are.
    factorised: bool,
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
        let count = condensed.blocks().len();
        for i in 0..count {
            interrupt.part(Phase::Condensation, i, count)?;
            try_push(&mut tables, Table::new(coordinates)?, CONTEXT)?;
            if sweep && condensed.ndof() > INTERPOLATE_ABOVE {
                let resonances = resonance_poles::near(condensed, &mut workspace, i, range, interrupt)?;
                let interpolation = FrequencyInterpolation::new(coordinates, range, resonances, TOLERANCE)?;
                try_push(&mut interpolations, interpolation, CONTEXT)?;
            }
        }
        Ok(Self {
            workspace,
            current: tables,
            interpolations,
            modal: Vec::new(),
            tabulated: None,
            // Without a sweep no slope is used.
            pointwise: !sweep && condensed.ndof() > INTERPOLATE_ABOVE,
            factorised: false,
        })
    }

    /// Selects tables by factorisation from now on, without slopes if these are expensive.
    pub fn set_pointwise(&mut self, pointwise: bool) {
        if !self.interpolations.is_empty() {
            self.pointwise = pointwise;
        }
    }

    /// Selects tables with slopes by factorisation from now on.
    pub fn set_factorised(&mut self, factorised: bool) {
        if self.factorised != factorised && !self.interpolations.is_empty() {
            self.factorised = factorised;
            self.tabulated = None;
        }
    }

    /// Makes tables of the harmonics from modes where they are given, without slopes.
    pub fn set_modes(&mut self, modal: Vec<Option<ModalTable>>) {
        self.modal = modal;
        self.tabulated = None;
    }

    /// Whether tables are made from modes.
    #[must_use]
    pub fn has_modes(&self) -> bool {
        !self.modal.is_empty()
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
        if self.tabulated == Some((omega, self.pointwise)) {
            return Ok(());
        }
        self.tabulated = None;
        let workspace = &mut self.workspace;
        for (i, table) in self.current.iter_mut().enumerate() {
            interrupt.check()?;
            if let Some(Some(modal)) = self.modal.get_mut(i) {
                modal.evaluate(omega, table, interrupt)?;
                continue;
            }
            let done = match self.interpolations.get_mut(i) {
                Some(interpolation) if !self.pointwise && !self.factorised => {
                    interpolation.evaluate(omega, table, |w, values| {
                        values.copy_from_slice(&workspace.evaluate(condensed, i, w, false, interrupt)?.value);
                        Ok(())
                    })?
                }
                _ => false,
            };
            if !done {
                // A derived clone_from would allocate at each frequency.
                let found = workspace.evaluate(condensed, i, omega, !self.pointwise, interrupt)?;
                table.value.copy_from_slice(&found.value);
                table.slope.copy_from_slice(&found.slope);
            }
        }
        self.tabulated = Some((omega, self.pointwise));
        Ok(())
    }
}
