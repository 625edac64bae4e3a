//! Runs of an analysis that are stopped at a check of their interrupt, and how late they return.

use crate::common::processor_time;
use hbvib::{Branch, Hooks, Phase, PhaseReport, Result, Status};
use std::cell::Cell;
use std::time::{Duration, Instant};

/// An analysis with its name.
pub type Analysis<'a> = (&'static str, Box<dyn Fn(&mut Hooks<'_>) -> Result<Status> + 'a>);

/// Status of a branch whose arrays agree with its points.
pub fn of_branch(branch: Result<Branch>) -> Result<Status> {
    let branch = branch?;
    let points = branch.points();
    assert_eq!(
        (branch.omega().len(), branch.amplitude().len(), branch.residual().len()),
        (points, points, points)
    );
    assert!(branch.omega().iter().chain(branch.amplitude()).all(|x| x.is_finite()));
    assert!(
        branch
            .peaks()
            .iter()
            .all(|p| p.point >= points && p.point < branch.stored())
    );
    Ok(branch.status())
}

/// Status of a call that has nothing to keep.
pub fn of_call<T>(outcome: Result<T>) -> Result<Status> {
    match outcome.map(drop) {
        Ok(()) => Ok(Status::Ok),
        Err(e) if e.status == Status::StoppedByCaller => Ok(e.status),
        Err(e) => Err(e),
    }
}

/// A run that is stopped: the checks until then, the time from the stop to the return, the widest gap between checks,
/// and the phase at the end.
pub struct Stopped {
    pub status: Status,
    pub checks: u64,
    pub late: Option<Duration>,
    pub widest: Duration,
    pub phase: Option<Phase>,
}

/// Runs an analysis and stops it at the first check at which `now(checks, elapsed)` says so.
pub fn stop_when(analysis: &Analysis<'_>, now: impl Fn(u64, Duration) -> bool) -> Stopped {
    let start = Instant::now();
    let begin = processor_time(start);
    let (checks, last, widest) = (Cell::new(0), Cell::new(begin), Cell::new(Duration::ZERO));
    let stopped: Cell<Option<Duration>> = Cell::new(None);
    let phase = Cell::new(None);
    let cancelled = || {
        assert!(stopped.get().is_none(), "{}: asked again after the stop", analysis.0);
        let time = processor_time(start);
        if phase.get() != Some(Phase::Factorisation) {
            widest.set(widest.get().max(time.saturating_sub(last.get())));
        }
        last.set(time);
        checks.set(checks.get() + 1);
        let stop = now(checks.get(), time.saturating_sub(begin));
        stopped.set(stop.then_some(time));
        stop
    };
    let sink = |report: &PhaseReport| {
        assert!(stopped.get().is_none(), "{}: reported after the stop", analysis.0);
        assert!(report.share >= 0.0 && report.share <= 1.0 + 1e-12, "{report:?}");
        phase.set(Some(report.phase));
        false
    };
    let mut hooks = Hooks {
        cancelled: Some(&cancelled),
        phase: Some(&sink),
        ..Hooks::default()
    };
    let status = (analysis.1)(&mut hooks).unwrap();
    let end = processor_time(start);
    let late = stopped.get().map(|at| end.saturating_sub(at));
    assert_eq!(
        status == Status::StoppedByCaller,
        late.is_some(),
        "{}: {status:?}",
        analysis.0
    );
    Stopped {
        status,
        checks: checks.get(),
        late,
        widest: widest.get(),
        phase: phase.get(),
    }
}

/// Numbers in 0 .. 1 (Marsaglia's xorshift, doi:10.18637/jss.v008.i14).
pub fn random(state: &mut u64) -> f64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}

/// Late returns among runs that are stopped at random times.
#[derive(Default)]
pub struct Lateness {
    pub runs: usize,
    pub slow: usize,
    /// The latest that no factorisation of another library explains.
    pub latest: Duration,
}

/// Time within which nearly all runs return, and all of them.
const LIMITS: [Duration; 2] = [Duration::from_millis(100), Duration::from_secs(1)];

/// Processor time up to which an analysis is followed.
const FOLLOWED: f64 = 4.0;

impl Lateness {
    /// Stops an analysis at random times, after it ran for a few seconds without a stop.
    pub fn add(&mut self, case: &str, analysis: &Analysis<'_>, stops: usize, state: &mut u64) {
        let begin = Instant::now();
        let start = processor_time(begin);
        stop_when(analysis, |_, elapsed| elapsed.as_secs_f64() > FOLLOWED);
        let whole = processor_time(begin).saturating_sub(start).as_secs_f64().min(FOLLOWED);
        for _ in 0..stops {
            let at = Duration::from_secs_f64(whole * random(state));
            let run = stop_when(analysis, |_, elapsed| elapsed >= at);
            // The check itself comes late by the gap since the last one.
            let late = run.late.unwrap_or_default() + run.widest;
            println!(
                "{case:7} {:19} stopped at {at:7.2?} in {:?}: back after {:7.2?}, widest gap {:7.2?}",
                analysis.0,
                run.phase,
                run.late.unwrap_or_default(),
                run.widest
            );
            self.runs += 1;
            if run.phase != Some(Phase::Factorisation) {
                self.latest = self.latest.max(late);
                self.slow += usize::from(late > LIMITS[0]);
            }
        }
    }

    /// Checks the limits.
    pub fn check(&self) {
        println!(
            "{} of {} runs later than {:?}, the latest {:.2?}",
            self.slow, self.runs, LIMITS[0], self.latest
        );
        assert!(self.latest < LIMITS[1] && 20 * self.slow <= self.runs);
    }
}
