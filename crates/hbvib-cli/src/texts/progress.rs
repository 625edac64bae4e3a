//! Progress of an analysis: a bar on a terminal, lines of JSON where messages have that form. Both have the stage and the time that is
//! left before the first point, too.

use crate::texts::events;
use hbvib::{Hooks, LogLevel, Phase, PhaseReport, Progress};
use serde_json::json;
use std::cell::RefCell;
use std::io::{IsTerminal, Write, stderr};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Characters of a full bar.
const WIDTH: usize = 30;

/// Least time between two lines of one stage, s.
const BETWEEN: f64 = 0.1;

/// Share of the work from which the time that is left is told.
const TOLD: f64 = 0.01;

/// A bar on standard error, if that is a terminal. The line ends with the bar.
pub struct Bar {
    shown: bool,
    state: RefCell<State>,
}

struct State {
    stage: Option<Phase>,
    share: f64,
    /// Begin of the stage, of the points, and time of the last line.
    stage_since: Instant,
    points_since: Option<Instant>,
    last: Option<Instant>,
    points: usize,
    done: f64,
    drawn: usize,
}

impl Bar {
    pub fn new() -> Self {
        Self {
            shown: stderr().is_terminal() && !events::are_json(),
            state: RefCell::new(State {
                stage: None,
                share: 0.0,
                stage_since: Instant::now(),
                points_since: None,
                last: None,
                points: 0,
                done: 0.0,
                drawn: 0,
            }),
        }
    }

    /// A point was accepted.
    pub fn show(&self, progress: &Progress) {
        let mut state = self.state.borrow_mut();
        let since = *state.points_since.get_or_insert_with(Instant::now);
        state.points = progress.point;
        state.done = progress.fraction_done;
        let left = left(since.elapsed().as_secs_f64(), progress.fraction_done);
        events::line(
            "point",
            json!({
                "point": progress.point,
                "parameter": progress.parameter,
                "amplitude": progress.amplitude,
                "residual": progress.residual,
                "newton_iterations": progress.newton_iterations,
                "fraction_done": progress.fraction_done,
                "seconds_left": left,
            }),
        );
        self.draw(&mut state, left);
    }

    /// The analysis is in a stage; before the first point the bar is that of the stage.
    pub fn stage(&self, report: &PhaseReport) {
        let mut state = self.state.borrow_mut();
        let is_new = state.stage != Some(report.phase);
        if is_new {
            state.stage = Some(report.phase);
            state.stage_since = Instant::now();
        }
        state.share = report.share;
        let recent = state.last.is_some_and(|last| last.elapsed().as_secs_f64() < BETWEEN);
        if state.points_since.is_some() || (recent && !is_new) {
            return;
        }
        state.last = Some(Instant::now());
        let left = left(state.stage_since.elapsed().as_secs_f64(), report.share);
        let name = name(report.phase);
        events::line(
            "stage",
            json!({ "stage": name, "share": report.share, "seconds_left": left }),
        );
        self.draw(&mut state, left);
    }

    fn draw(&self, state: &mut State, left: Option<f64>) {
        if !self.shown {
            return;
        }
        let text = if state.points_since.is_some() {
            line(state.done, &format!("{} points", state.points), left)
        } else {
            line(state.share, state.stage.map_or("", name), left)
        };
        // Blanks cover the rest of a longer line.
        let _ = write!(stderr(), "\r{text:<0$}", state.drawn);
        state.drawn = text.len();
    }
}

/// Makes a call with a bar, that ends when the flag is set.
pub fn watched<R>(stop: &AtomicBool, call: impl FnOnce(&mut Hooks<'_>) -> R) -> R {
    let bar = Bar::new();
    let mut progress = |progress: &Progress| {
        bar.show(progress);
        false
    };
    let phase = |report: &PhaseReport| {
        bar.stage(report);
        false
    };
    let mut warnings: Vec<String> = Vec::new();
    let mut log = |level: LogLevel, message: &str| {
        let level = match level {
            LogLevel::Warn => {
                // As text they follow the bar.
                if !events::are_json() && !warnings.iter().any(|told| told == message) {
                    warnings.push(message.to_owned());
                }
                "warning"
            }
            LogLevel::Info => "info",
            LogLevel::Debug => "debug",
        };
        events::line("log", json!({ "level": level, "message": message }));
    };
    let cancelled = || stop.load(Ordering::Relaxed);
    let result = call(&mut Hooks {
        progress: Some(&mut progress),
        cancelled: Some(&cancelled),
        phase: Some(&phase),
        log: Some(&mut log),
    });
    drop(bar);
    for warning in &warnings {
        events::warning(warning);
    }
    result
}

impl Drop for Bar {
    fn drop(&mut self) {
        if self.shown {
            let _ = writeln!(stderr());
        }
    }
}

/// Seconds that are left at the speed so far.
fn left(elapsed: f64, done: f64) -> Option<f64> {
    (done >= TOLD).then(|| elapsed * (1.0 - done.min(1.0)) / done)
}

/// Name of a stage.
fn name(phase: Phase) -> &'static str {
    match phase {
        Phase::Setup => "set-up",
        Phase::Modes => "natural modes",
        Phase::Condensation => "condensation",
        Phase::FirstPoint => "first point",
        Phase::Continuation => "continuation",
        Phase::Estimate => "error estimate",
        Phase::TimeIntegration => "integration in time",
        Phase::Results => "results",
        Phase::Factorisation => "factorisation",
    }
}

fn line(done: f64, stage: &str, left: Option<f64>) -> String {
    let done = done.clamp(0.0, 1.0);
    let full = (done * WIDTH as f64).round() as usize;
    let left = left.map_or(String::new(), |left| format!(", {} left", clock(left)));
    format!(
        "[{}{}] {:3.0} %  {stage}{left}  ",
        "#".repeat(full),
        ".".repeat(WIDTH - full),
        100.0 * done
    )
}

/// A time as minutes and seconds, or with hours.
fn clock(seconds: f64) -> String {
    let all = seconds.max(0.0).round() as u64;
    let (hours, minutes, seconds) = (all / 3600, all / 60 % 60, all % 60);
    match hours {
        0 => format!("{minutes}:{seconds:02}"),
        _ => format!("{hours}:{minutes:02}:{seconds:02}"),
    }
}

#[cfg(test)]
mod tests {
    use super::{WIDTH, clock, left, line};

    #[test]
    fn the_bar_has_one_width() {
        for (done, full) in [
            (-1.0, 0),
            (0.0, 0),
            (0.5, WIDTH / 2),
            (1.0, WIDTH),
            (2.0, WIDTH),
            (f64::NAN, 0),
        ] {
            let bar = line(done, "7 points", None);
            assert_eq!(bar.matches('#').count(), full, "{bar}");
            assert_eq!(bar.find(']'), Some(WIDTH + 1), "{bar}");
        }
    }

    #[test]
    fn the_time_that_is_left_follows_the_speed_so_far() {
        assert_eq!(left(3.0, 0.25), Some(9.0));
        assert_eq!(left(3.0, 0.0), None);
        assert_eq!(left(3.0, f64::NAN), None);
        assert_eq!(
            (clock(9.4), clock(61.0), clock(7322.0)),
            ("0:09".into(), "1:01".into(), "2:02:02".into())
        );
        assert!(line(0.25, "condensation", Some(9.0)).contains("25 %  condensation, 0:09 left"));
    }
}
