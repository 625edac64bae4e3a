//! The interrupt of a running call: every loop whose work grows with the input asks it, and tells it the phase.
//!
//! A check reads a flag of the caller and no clock, so that loops check at each panel, column or step. A stop is an
//! error with [`Status::StoppedByCaller`], which passes through every layer unchanged; the analysis at the top turns
//! it into the end of its result. Once requested, a stop stays: every later check fails too.

use crate::error::{Error, Result, Status, reserved, try_vec};
use crate::shortage;
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
    /// Integration of motions in time.
    TimeIntegration = 6,
    /// Harmonics, energies and other results of solved motions.
    Results = 7,
    /// A single factorisation of a sparse matrix, by a library that cannot be stopped.
    Factorisation = 8,
}

/// The phase of a running call and its completed share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseReport {
    /// Phase of the call.
    pub phase: Phase,
    /// Completed share of the phase, 0 to 1; it starts again with each phase.
    pub share: f64,
}

/// Receiver of phase reports; `true` stops the call.
pub type PhaseSink<'a> = dyn Fn(&PhaseReport) -> bool + 'a;

/// Smallest increase of the share that is reported.
/// Kind: block.
const REPORTED: f64 = 0.01;

/// Operations after which the phase is reported again, whatever its share: some ten milliseconds, so that a caller whose
/// receiver looks for signals sees them in time.
/// Kind: block.
const BETWEEN_REPORTS: u64 = 20_000_000;

/// Operations that a check without a number stands for.
/// Kind: block.
const OF_ONE_CHECK: u64 = 10_000;

/// Zeros written between two checks.
/// Kind: block.
const ZEROS_TOGETHER: usize = 1 << 20;

/// Asked by every long loop whether the caller wants to stop; see the module.
pub struct Interrupt<'a> {
    cancelled: Option<&'a dyn Fn() -> bool>,
    sink: Option<&'a PhaseSink<'a>>,
    stopped: Cell<bool>,
    current: Cell<PhaseReport>,
    checks: Cell<u64>,
    /// Largest number of operations between two checks so far.
    largest: Cell<u64>,
    /// Number of operations since the last report.
    work: Cell<u64>,
    /// Number of operations since the call began.
    operations: Cell<u64>,
}

impl<'a> Interrupt<'a> {
    /// An interrupt with the caller's flag and receiver of phases.
    #[must_use]
    #[inline]
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
            largest: Cell::new(0),
            work: Cell::new(0),
            operations: Cell::new(0),
        }
    }

    /// An interrupt that never stops and reports nothing.
    #[must_use]
    #[inline]
    pub fn none() -> Self {
        Self::new(None, None)
    }

    /// Checks whether the caller requested a stop.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    #[inline]
    pub fn check(&self) -> Result<()> {
        self.check_before(OF_ONE_CHECK)
    }

    /// Checks for a stop before about this many operations, during which there is no check.
    ///
    /// # Errors
    /// `StoppedByCaller`; `OutOfMemory` where a request was served from the reserve of the allocator.
    #[inline]
    pub fn check_before(&self, operations: u64) -> Result<()> {
        self.checks.set(self.checks.get() + 1);
        if self.stopped.get() || self.cancelled.is_some_and(|f| f()) {
            return Err(self.stop());
        }
        if shortage::is_noted() {
            return Err(Error::out_of_memory("the running call"));
        }
        self.largest.set(self.largest.get().max(operations));
        self.count(operations);
        let work = self.work.get().saturating_add(operations);
        self.work.set(work);
        if work < BETWEEN_REPORTS {
            return Ok(());
        }
        self.report(self.current.get())
    }

    /// Whether a check has failed: the call must then return.
    #[must_use]
    #[inline]
    pub fn is_stopped(&self) -> bool {
        self.stopped.get()
    }

    /// Largest number of operations so far without a check.
    #[must_use]
    #[inline]
    pub fn largest(&self) -> u64 {
        self.largest.get()
    }

    /// Number of checks made, a measure of work that does not depend on the machine.
    #[must_use]
    #[inline]
    pub fn checks(&self) -> u64 {
        self.checks.get()
    }

    /// Counts operations of a loop that is too short for a check of its own.
    #[inline]
    pub fn count(&self, operations: u64) {
        self.operations.set(self.operations.get().saturating_add(operations));
    }

    /// Number of operations so far, those of [`Self::check_before`] and [`Self::count`]: the work of the call, which does not depend on
    /// the machine. It serves to compare, and is no exact number: a check without a number stands for ten thousand.
    #[must_use]
    #[inline]
    pub fn operations(&self) -> u64 {
        self.operations.get()
    }

    /// Checks for a stop, and reports the phase with its completed share: at its beginning, whenever the share has
    /// grown by a hundredth, and after some ten million operations.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    #[inline]
    pub fn phase(&self, phase: Phase, share: f64) -> Result<()> {
        self.check()?;
        let last = self.current.get();
        if phase == last.phase && share >= last.share && share < last.share + REPORTED {
            return Ok(());
        }
        self.report(PhaseReport { phase, share })
    }

    /// Checks for a stop and reports the phase, with `done` of `all` parts complete.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    #[inline]
    pub fn part(&self, phase: Phase, done: usize, all: usize) -> Result<()> {
        self.phase(phase, done as f64 / all.max(1) as f64)
    }

    /// Announces a factorisation that cannot be stopped, before it starts. The current phase continues after it.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    #[inline]
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

    /// A large array of zeros, which the system maps to memory as they are written, with checks for a stop between
    /// its parts.
    ///
    /// # Errors
    /// `OutOfMemory` naming `what`, `StoppedByCaller`.
    #[inline]
    pub fn zeros(&self, len: usize, what: &str) -> Result<Vec<f64>> {
        let mut values = try_vec(0, 0.0, what)?;
        reserved(&values.try_reserve_exact(len), what)?;
        while values.len() < len {
            let part = (len - values.len()).min(ZEROS_TOGETHER);
            self.check_before(part as u64)?;
            values.resize(values.len() + part, 0.0);
        }
        Ok(values)
    }

    #[inline]
    fn report(&self, report: PhaseReport) -> Result<()> {
        self.current.set(report);
        self.work.set(0);
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
        let within = BETWEEN_REPORTS / OF_ONE_CHECK;
        assert!((100..=100 + 10_000 / within as usize).contains(&reports.borrow().len()));
        reports.borrow_mut().clear();
        for _ in 0..3 {
            interrupt.announce_factorisation().unwrap();
        }
        interrupt.part(Phase::Condensation, 9_999, 10_000).unwrap();
        assert_eq!(reports.borrow().len(), 3);
        interrupt.phase(Phase::Estimate, 0.0).unwrap();
        interrupt.phase(Phase::Continuation, 0.3).unwrap();
        assert!((reports.borrow().last().unwrap().share - 0.3).abs() < 1e-15);
        assert_eq!(reports.borrow().len(), 5);
        // A long loop within one part is reported by its work.
        for _ in 0..10 {
            interrupt.check_before(BETWEEN_REPORTS / 2).unwrap();
        }
        assert_eq!(reports.borrow().len(), 10);
        assert_eq!(interrupt.largest(), BETWEEN_REPORTS / 2);
    }

    #[test]
    fn operations_are_counted_with_a_check_and_without() {
        let interrupt = Interrupt::none();
        interrupt.check().unwrap();
        interrupt.check_before(5).unwrap();
        interrupt.count(7);
        assert_eq!(interrupt.operations(), OF_ONE_CHECK + 12);
        // A report begins its own count anew, and leaves that of the call.
        interrupt.check_before(2 * BETWEEN_REPORTS).unwrap();
        assert_eq!(interrupt.operations(), OF_ONE_CHECK + 12 + 2 * BETWEEN_REPORTS);
        assert_eq!(interrupt.checks(), 3);
    }
}
