//! What a caller may attach to a running solve: progress, cancellation, log.

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
    /// Arc length of the step that led here, in scaled unknowns.
    pub step: f64,
    /// Share of the parameter range done, 0 to 1.
    pub fraction_done: f64,
    /// Newton iterations that the point took.
    pub newton_iterations: usize,
}

/// Weight of a log line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LogLevel {
    /// Something the user should look at.
    Warn = 1,
    /// A step of the method.
    Info = 2,
    /// Detail for debugging.
    Debug = 3,
}

/// Receiver of log lines.
pub type LogSink<'a> = dyn FnMut(LogLevel, &str) + 'a;

/// Callbacks of the caller. Nothing is ever printed; without hooks a solve is silent.
#[derive(Default)]
pub struct Hooks<'a> {
    /// Called at each accepted point; `true` stops the solve and keeps the points so far.
    pub progress: Option<&'a mut dyn FnMut(&Progress) -> bool>,
    /// Asked at each Newton iteration; `true` stops the solve and keeps the points so far.
    pub cancelled: Option<&'a dyn Fn() -> bool>,
    /// Receives log lines.
    pub log: Option<&'a mut LogSink<'a>>,
}

impl Hooks<'_> {
    /// Reports a point; `true` when the caller wants to stop.
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
