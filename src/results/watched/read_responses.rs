//! Responses of the stored points of any branch: of a forced response, a nonlinear mode, a result over a parameter.

use crate::condense::Condensed;
use crate::error::{Result, try_push, try_vec};
use crate::fourier::Reader;
use crate::interrupt::{Interrupt, Phase};
use crate::options::{Response, check_responses};
use crate::problem::gauges::{Gauge, Seen};
use crate::results::{Branch, Recovery, ResponseSeries, SeenWithError};
use num_complex::Complex64;

const CONTEXT: &str = "the responses";

/// Gauges of the responses on the condensed model of some points.
struct OnModel<'a> {
    condensed: &'a Condensed,
    gauges: Vec<Gauge>,
    reader: Reader,
    /// Packed signals of the gauges.
    signals: Vec<f64>,
    x: Vec<Complex64>,
}

impl<'a> OnModel<'a> {
    fn new(condensed: &'a Condensed, responses: &[Response<'_>], default: usize) -> Result<Self> {
        let mut gauges = Vec::new();
        for response in responses {
            try_push(&mut gauges, Gauge::new(condensed, response, default)?, CONTEXT)?;
        }
        let numbers = gauges.len().saturating_mul(condensed.set().packed_len());
        Ok(Self {
            condensed,
            gauges,
            reader: Reader::new(condensed.set())?,
            signals: try_vec(numbers, 0.0, CONTEXT)?,
            x: try_vec(condensed.ndof(), Complex64::ZERO, CONTEXT)?,
        })
    }

    /// Writes the signals of the selected point at the angular frequency ω.
    fn fill(&mut self, recovery: &mut Recovery<'_>, omega: f64) -> Result<()> {
        let (set, m) = (self.condensed.set(), self.condensed.set().packed_len());
        self.signals.fill(0.0);
        for (i, &number) in set.numbers().iter().enumerate() {
            if !self.gauges.iter().any(|gauge| gauge.reads(self.condensed, i)) {
                continue;
            }
            recovery.coordinates(i, &mut self.x)?;
            for (gauge, signal) in self.gauges.iter().zip(self.signals.chunks_exact_mut(m)) {
                set.set(signal, i, gauge.factor(number, omega).0 * gauge.along(i, &self.x));
            }
        }
        Ok(())
    }
}

/// Reads responses as [`Branch::read_responses`], and the caller may stop it.
pub(crate) fn read_responses_with(
    branch: &Branch,
    responses: &[Response<'_>],
    interrupt: &Interrupt<'_>,
) -> Result<Vec<ResponseSeries>> {
    check_responses(responses, branch.ndof(), branch.reduction().sectors)?;
    let mut found = Vec::new();
    for response in responses {
        let series = ResponseSeries::new(response, branch.run.response_dof, false)?;
        try_push(&mut found, series, CONTEXT)?;
    }
    if responses.is_empty() || branch.stored() == 0 {
        return Ok(found);
    }
    let mut recovery = Recovery::at(branch, 0, interrupt)?;
    let mut model = OnModel::new(branch.condensed_at(0), responses, branch.run.response_dof)?;
    for (point, &omega) in branch.table.omega.iter().enumerate() {
        interrupt.part(Phase::Results, point, branch.stored())?;
        recovery.go_to(branch, point)?;
        let condensed = branch.condensed_at(point);
        if !core::ptr::eq(condensed, model.condensed) {
            model = OnModel::new(condensed, responses, branch.run.response_dof)?;
        }
        model.fill(&mut recovery, omega)?;
        let set = condensed.set();
        let signals = model.signals.chunks_exact(set.packed_len());
        for ((series, response), signal) in found.iter_mut().zip(responses).zip(signals) {
            let mut reading = model.reader.read(set, response.measure, signal, interrupt)?;
            reading.instant /= set.base().max(1) as f64;
            let seen = Seen {
                reading,
                slope: f64::NAN,
                complex_slope: Complex64::ZERO,
                instants: [f64::NAN; 2],
                instant_rates: [f64::NAN; 2],
            };
            // The recovered motion has the caller's unit.
            series.push(&SeenWithError { seen, error: f64::NAN }, 1.0)?;
        }
    }
    Ok(found)
}
