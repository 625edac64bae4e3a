//! Callbacks that a caller attaches to a running solve: progress, cancellation, log.

use crate::interrupt::{Interrupt, PhaseSink};

/// State of a solve, reported at each accepted point.
#[derive(Clone, Copy, Debug, Default)]
pub struct Progress {
    /// Number of points accepted so far, this one included.
    pub point: usize,
    /// The continuation parameter: angular frequency in rad per time unit, in a nonlinear mode
    /// log₁₀ of the amplitude.
    pub parameter: f64,
    /// Amplitude of the response degree of freedom (fundamental, peak).
    pub amplitude: f64,
    /// Relative residual of the accepted point.
    pub residual: f64,
    /// Arc length of the step to this point, in scaled unknowns.
    pub step: f64,
    /// Completed share of the parameter range, 0 to 1.
    pub fraction_done: f64,
    /// Newton iterations of the point.
    pub newton_iterations: usize,
}

/// Severity of a log line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LogLevel {
    /// Something that the user should check.
    Warn = 1,
    /// A step of the method.
    Info = 2,
    /// Detail for debugging.
    Debug = 3,
}

/// Receiver of log lines.
pub type LogSink<'a> = dyn FnMut(LogLevel, &str) + 'a;

/// Callbacks of the caller. The library never prints; without hooks a solve has no output.
///
/// ```
/// # use hbvib::{Contact, ForcedOptions, MatrixKind, MatrixView, Model, SolverOptions, forced_response};
/// use hbvib::{Hooks, Progress, Status};
///
/// # let mut model = Model::new(1)?;
/// # model.set_matrix(MatrixKind::Mass, &MatrixView::dense(1, &[1.0]))?;
/// # model.set_matrix(MatrixKind::Stiffness, &MatrixView::dense(1, &[1.0]))?;
/// # model.set_rayleigh(0.0, 0.02)?;
/// # model.add_contact(&Contact::jenkins(0, None, 1.0, 0.3, 1.0))?;
/// # model.add_force(0, 1, 0.2.into())?;
/// let mut watch = |state: &Progress| state.point >= 9; // true stops at the tenth point
/// let mut hooks = Hooks { progress: Some(&mut watch), ..Hooks::default() };
/// let range = ForcedOptions { omega_start: 0.8, omega_stop: 1.6, ..ForcedOptions::default() };
/// let branch = forced_response(&model, &SolverOptions::default(), &range, &mut hooks)?;
/// assert_eq!(branch.status(), Status::StoppedByCaller);
/// # Ok::<(), hbvib::Error>(())
/// ```
#[derive(Default)]
pub struct Hooks<'a> {
    /// Called at each accepted point; `true` stops the solve and keeps the points so far.
    pub progress: Option<&'a mut dyn FnMut(&Progress) -> bool>,
    /// Called often, in every long loop; `true` stops the call and keeps the points so far.
    pub cancelled: Option<&'a dyn Fn() -> bool>,
    /// Called at the begin of each phase and each hundredth of it, set-up included; `true` stops the call.
    pub phase: Option<&'a PhaseSink<'a>>,
    /// Receives log lines.
    pub log: Option<&'a mut LogSink<'a>>,
}

impl<'a> Hooks<'a> {
    /// The interrupt of one call.
    #[must_use]
    pub fn interrupt(&self) -> Interrupt<'a> {
        Interrupt::new(self.cancelled, self.phase)
    }

    /// Hooks of a solve within the call: it can be stopped as the call can, and reports neither points nor log lines.
    pub(crate) fn quiet(&self) -> Self {
        Self {
            cancelled: self.cancelled,
            phase: self.phase,
            ..Self::default()
        }
    }

    /// Reports a point; `true` when the caller requests a stop.
    pub fn report(&mut self, progress: &Progress) -> bool {
        self.progress.as_mut().is_some_and(|f| f(progress))
    }

    /// Passes a log line on.
    pub fn log(&mut self, level: LogLevel, message: &str) {
        if let Some(f) = self.log.as_mut() {
            f(level, message);
        }
    }
}
