//! A progress bar of one line on the terminal.
#![allow(dead_code, reason = "each example uses a part of this module")]

use std::io::{IsTerminal, Write};
use std::time::{Duration, Instant};

const WIDTH: usize = 30;
const INTERVAL: Duration = Duration::from_millis(100);

/// Progress of one stage of a program, shown on standard error.
///
/// The bar is drawn only if standard error is a terminal. In any case one line with the total and the elapsed time
/// remains when the stage ends.
#[derive(Debug)]
pub struct Bar {
    label: String,
    total: u64,
    start: Instant,
    drawn: Option<Instant>,
    visible: bool,
}

impl Bar {
    /// Starts a stage of `total` steps.
    pub fn new(label: impl Into<String>, total: u64) -> Self {
        let (start, visible) = (Instant::now(), std::io::stderr().is_terminal());
        let mut bar = Self {
            label: label.into(),
            total,
            start,
            drawn: None,
            visible,
        };
        bar.set(0.0);
        bar
    }

    /// Shows the completed fraction of the stage; values outside 0 to 1 are clamped.
    #[allow(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss
    )]
    pub fn set(&mut self, fraction: f64) {
        let recent = self.drawn.is_some_and(|drawn| drawn.elapsed() < INTERVAL);
        if !self.visible || (recent && fraction < 1.0) {
            return;
        }
        self.drawn = Some(Instant::now());
        let fraction = if fraction.is_nan() {
            0.0
        } else {
            fraction.clamp(0.0, 1.0)
        };
        let full = (fraction * WIDTH as f64) as usize;
        let (done, open) = ("#".repeat(full), "-".repeat(WIDTH - full));
        let steps = (fraction * self.total as f64).round();
        let seconds = self.start.elapsed().as_secs_f64();
        let left = if fraction > 0.0 && fraction < 1.0 && seconds > 1.0 {
            format!(", {:.0} s left", seconds * (1.0 - fraction) / fraction)
        } else {
            String::new()
        };
        let (label, total) = (&self.label, self.total);
        write_stderr(&format!("\r\x1b[K{label} [{done}{open}] {steps}/{total}{left}"));
    }

    /// Ends the stage and leaves a line with its total and the elapsed time.
    pub fn finish(self) {
        let clear = if self.visible { "\r\x1b[K" } else { "" };
        let seconds = self.start.elapsed().as_secs_f64();
        write_stderr(&format!("{clear}{}: {} in {seconds:.1} s\n", self.label, self.total));
    }
}

/// Writes to standard error; a closed standard error does not stop the program.
pub fn write_stderr(text: &str) {
    let mut stderr = std::io::stderr().lock();
    let _ = stderr.write_all(text.as_bytes()).and_then(|()| stderr.flush());
}
