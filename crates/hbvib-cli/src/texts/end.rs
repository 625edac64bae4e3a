//! How a run ends: signals that stop it, and its exit code.

use crate::outputs::files::Files;
use crate::texts::events;
use crate::texts::outcome::Outcome;
use signal_hook::consts::{SIGINT, SIGTERM};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Exit code of an error: nothing was computed, or one of several analyses failed.
pub const FAILED: u8 = 1;

/// Exit code of a run that was stopped early and kept its points.
const STOPPED: u8 = 2;

/// Exit code of a run one of whose points is another solution than integration in time finds.
const DIFFERENT: u8 = 3;

/// Exit code of a run one of whose outputs was not made; the others were.
const UNWRITTEN: u8 = 4;

/// A flag that Ctrl-C, SIGTERM and a terminal that closes set, so that the run ends with what it has found.
///
/// # Errors
/// A sentence of the system.
pub fn stop_flag() -> Outcome<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    let set = |signal: i32, flag: &Arc<AtomicBool>| {
        let registered = signal_hook::flag::register(signal, Arc::clone(flag));
        registered.map(drop).map_err(|e| format!("signal {signal}: {e}"))
    };
    set(SIGINT, &stop)?;
    set(SIGTERM, &stop)?;
    #[cfg(unix)]
    {
        set(signal_hook::consts::SIGHUP, &stop)?;
        // A file beyond the limit of its size is an error of that file, and no end of the program.
        set(signal_hook::consts::SIGXFSZ, &Arc::new(AtomicBool::new(false)))?;
    }
    Ok(stop)
}

/// State of a run so far.
#[derive(Debug, Default)]
pub struct End {
    failed: bool,
    early: bool,
    /// A point is another solution than integration in time finds.
    pub differs: bool,
}

impl End {
    /// Whether the next part may run; told once where the run was stopped.
    pub fn goes_on(&mut self, stop: &AtomicBool) -> bool {
        let stopped = stop.load(Ordering::Relaxed);
        if stopped && !self.early {
            self.early("the run was stopped");
        }
        !stopped
    }

    /// The result of a part; an error is told, and is an early end where the caller stopped the run.
    pub fn take<T>(&mut self, outcome: Outcome<T>, stop: &AtomicBool) -> Option<T> {
        match outcome {
            Ok(found) => return Some(found),
            Err(sentence) if stop.load(Ordering::Relaxed) => self.early(&format!("the run was stopped: {sentence}")),
            Err(sentence) => {
                events::error(&sentence);
                self.failed = true;
            }
        }
        None
    }

    /// Tells an early end.
    pub fn early(&mut self, sentence: &str) {
        events::error(sentence);
        self.early = true;
    }

    /// The exit code: an error before an output that was not made, before an early end, before another solution.
    pub fn code(&self, files: &Files<'_>) -> u8 {
        if self.failed {
            FAILED
        } else if !files.complete() {
            UNWRITTEN
        } else if self.early {
            STOPPED
        } else if self.differs {
            DIFFERENT
        } else {
            0
        }
    }
}
