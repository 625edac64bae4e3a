//! The interrupt of a running call: every loop whose work grows with the input asks it, and tells it the phase.
//!
//! A check reads a flag of the caller and no clock, so that loops check at each panel, column or step. A stop is an
//! error with [`Status::StoppedByCaller`], which passes through every layer unchanged; the analysis at the top turns
//! it into the end of its result. Once requested, a stop stays: every later check fails too.

use crate::error::{Error, Result, Status};
use core::cell::Cell;

/// Phase of a running call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Checks of the model and its assembly.
    Setup = 0,
    /// Natural frequencies and mode shapes.
    Modes = 1,
    /// Condensation onto the contacts and tables of their flexibility.
    Condensation = 2,
    /// Search for the first point of a branch.
    FirstPoint = 3,
    /// Points of a branch, one after the other.
    Continuation = 4,
    /// Error estimate of a point.
    Estimate = 5,
    /// Integration in time.
    TimeIntegration = 6,
    /// Harmonics, energies and other results of solved motions.
    Results = 7,
    /// One factorisation of a sparse matrix by a library that cannot be stopped.
    Factorisation = 8,
}

/// The phase of a running call and its completed share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseReport {
    /// The phase.
    pub phase: Phase,
    /// Its completed share, 0 to 1; it starts again with each phase.
    pub share: f64,
}

/// Receiver of phase reports; `true` stops the call.
pub type PhaseSink<'a> = dyn Fn(&PhaseReport) -> bool + 'a;

/// Smallest increase of the share that is reported: at most a hundred reports per phase.
const REPORTED: f64 = 0.01;

/// Asked by every long loop whether the caller wants to stop; see the module.
pub struct Interrupt<'a> {
    cancelled: Option<&'a dyn Fn() -> bool>,
    sink: Option<&'a PhaseSink<'a>>,
    stopped: Cell<bool>,
    current: Cell<PhaseReport>,
    checks: Cell<u64>,
}

impl<'a> Interrupt<'a> {
    /// An interrupt with the caller's flag and receiver of phases.
    #[must_use]
    pub fn new(cancelled: Option<&'a dyn Fn() -> bool>, sink: Option<&'a PhaseSink<'a>>) -> Self {
        Self {
            cancelled,
            sink,
            stopped: Cell::new(false),
            current: Cell::new(PhaseReport {
                phase: Phase::Setup,
                share: f64::NEG_INFINITY,
            }),
            checks: Cell::new(0),
        }
    }

    /// An interrupt that never stops and reports nothing.
    #[must_use]
    pub fn none() -> Self {
        Self::new(None, None)
    }

    /// Checks whether the caller requested a stop.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    #[inline]
    pub fn check(&self) -> Result<()> {
        self.checks.set(self.checks.get() + 1);
        if self.stopped.get() || self.cancelled.is_some_and(|f| f()) {
            return Err(self.stop());
        }
        Ok(())
    }

    /// Whether a check has failed: the call is on its way back.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.stopped.get()
    }

    /// Number of checks made, a measure of work that does not depend on the machine.
    #[must_use]
    pub fn checks(&self) -> u64 {
        self.checks.get()
    }

    /// Checks, and reports the phase with its completed share: at its begin, and whenever the share has grown by a
    /// hundredth.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    pub fn phase(&self, phase: Phase, share: f64) -> Result<()> {
        self.check()?;
        let last = self.current.get();
        if phase == last.phase && share >= last.share && share < last.share + REPORTED {
            return Ok(());
        }
        self.report(PhaseReport { phase, share })
    }

    /// The same, `done` of `all` parts being complete.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    pub fn part(&self, phase: Phase, done: usize, all: usize) -> Result<()> {
        self.phase(phase, done as f64 / all.max(1) as f64)
    }

    /// Announces a factorisation that cannot be stopped, before it starts. The phase so far continues after it.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    pub fn announce_factorisation(&self) -> Result<()> {
        self.check()?;
        let before = self.current.get();
        let told = self.report(PhaseReport {
            phase: Phase::Factorisation,
            share: 0.0,
        });
        self.current.set(before);
        told
    }

    fn report(&self, report: PhaseReport) -> Result<()> {
        self.current.set(report);
        match self.sink {
            Some(sink) if sink(&report) => Err(self.stop()),
            _ => Ok(()),
        }
    }

    #[cold]
    fn stop(&self) -> Error {
        self.stopped.set(true);
        Error::new(
            Status::StoppedByCaller,
            format_args!("stopped by a hook or the cancel flag before there was a result"),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::cell::RefCell;

    #[test]
    fn a_stop_once_requested_stays() {
        let requested = Cell::new(true);
        let flag = || requested.get();
        let interrupt = Interrupt::new(Some(&flag), None);
        assert_eq!(interrupt.check().unwrap_err().status, Status::StoppedByCaller);
        requested.set(false);
        assert!(interrupt.check().is_err() && interrupt.phase(Phase::Modes, 0.5).is_err());
        assert!(interrupt.is_stopped() && interrupt.checks() == 3);
    }

    #[test]
    fn reports_are_limited_by_the_share_and_a_factorisation_is_always_announced() {
        let reports = RefCell::new(Vec::new());
        let sink = |report: &PhaseReport| {
            reports.borrow_mut().push(*report);
            false
        };
        let interrupt = Interrupt::new(None, Some(&sink));
        for i in 0..10_000 {
            interrupt.part(Phase::Condensation, i, 10_000).unwrap();
        }
        assert_eq!(reports.borrow().len(), 100);
        for _ in 0..3 {
            interrupt.announce_factorisation().unwrap();
        }
        interrupt.part(Phase::Condensation, 9_999, 10_000).unwrap();
        assert_eq!(reports.borrow().len(), 103);
        interrupt.phase(Phase::Estimate, 0.0).unwrap();
        interrupt.phase(Phase::Continuation, 0.3).unwrap();
        assert!((reports.borrow().last().unwrap().share - 0.3).abs() < 1e-15);
        assert_eq!(reports.borrow().len(), 105);
    }
}
