//! A batch of designs: the highest peak of each, on threads of the call's own.
//!
//! A design is solved by itself, from nothing that another one has left behind, so that neither the number of threads
//! nor the order of the designs changes a bit of its results. Designs that change constants of contacts and forces alone
//! share the matrices of the structure, and the bases of large ones.

use crate::condense::Condensed;
use crate::condense::on_a_basis::wave_reduction::EXACT_UP_TO;
use crate::error::{Error, Result, Status, fail, try_push, try_vec};
use crate::hooks::{Hooks, Progress};
use crate::interrupt::{Interrupt, Phase};
use crate::model::Model;
use crate::options::{BatchOptions, SolverOptions};
use crate::results::Branch;
use crate::sensitivity::Parameter;
use crate::studies::design_peak::{DesignPeak, Solved, solve_design};
use crate::studies::further_threads::{Together, of_std};
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

const CONTEXT: &str = "the designs";

/// Time between two looks at the caller's flag while other threads work.
/// Kind: block.
const PAUSE: Duration = Duration::from_millis(2);

/// Checks of a design between two of the caller's hooks.
/// Kind: block.
const BATCH_BETWEEN_CHECKS: usize = 16;

/// A function that runs the work of a thread in the surroundings that the caller wants for it. It returns `false` if
/// this thread cannot work; the others then do it all.
pub type Surroundings<'a> = dyn Fn(&mut dyn FnMut()) -> bool + Sync + 'a;

/// Results of a batch of designs.
#[derive(Debug)]
pub struct Batch {
    peaks: Vec<DesignPeak>,
    branches: Vec<Option<Branch>>,
    status: Status,
    responses: usize,
}

impl Batch {
    /// The peak of each design, in the order of their values.
    #[must_use]
    pub fn peaks(&self) -> &[DesignPeak] {
        &self.peaks
    }

    /// Takes the branch of a design out of the batch, if branches were kept and the design has one.
    pub fn take_branch(&mut self, design: usize) -> Option<Branch> {
        self.branches.get_mut(design)?.take()
    }

    /// The branch of a design, if branches were kept and it has one.
    #[must_use]
    pub fn branch(&self, design: usize) -> Option<&Branch> {
        self.branches.get(design)?.as_ref()
    }

    /// Number of requested responses.
    #[must_use]
    pub fn responses(&self) -> usize {
        self.responses
    }

    /// Status: `Ok`, or `StoppedByCaller` where some designs were not solved.
    #[must_use]
    pub fn status(&self) -> Status {
        self.status
    }
}

/// Data that all threads share.
struct Work<'a> {
    model: &'a Model,
    solver: &'a SolverOptions,
    options: &'a BatchOptions<'a>,
    parameters: &'a [Parameter<'a>],
    values: &'a [f64],
    designs: usize,
    next: AtomicUsize,
    done: AtomicUsize,
    stop: AtomicBool,
}

/// Results of one thread: index and solution of each of its designs.
type Found = Vec<(usize, Solved)>;

impl Work<'_> {
    /// Index of the next design to solve; `None` when all are taken or the batch is stopped.
    fn take(&self) -> Option<usize> {
        if self.stop.load(Ordering::Relaxed) {
            return None;
        }
        let design = self.next.fetch_add(1, Ordering::Relaxed);
        (design < self.designs).then_some(design)
    }

    /// Solves a design; `None` where the caller stopped it.
    fn solve(&self, design: usize, hooks: &mut Hooks<'_>) -> Option<Solved> {
        let p = self.parameters.len();
        let values = &self.values[design * p..(design + 1) * p];
        let solved = solve_design(self.model, self.solver, self.options, self.parameters, values, hooks);
        if solved.peak.status == Status::StoppedByCaller {
            self.stop.store(true, Ordering::Relaxed);
            return None;
        }
        self.done.fetch_add(1, Ordering::Relaxed);
        Some(solved)
    }

    /// Solves designs until none is left, without the caller's hooks.
    fn run(&self) -> Result<Found> {
        let stopped = || self.stop.load(Ordering::Relaxed);
        let mut found = Vec::new();
        while let Some(design) = self.take() {
            let mut hooks = Hooks {
                cancelled: Some(&stopped),
                ..Hooks::default()
            };
            if let Some(solved) = self.solve(design, &mut hooks) {
                try_push(&mut found, (design, solved), CONTEXT)
                    .inspect_err(|_| self.stop.store(true, Ordering::Relaxed))?;
            }
        }
        Ok(found)
    }

    /// Solves designs until none is left, in the thread of the caller, with its hooks.
    fn run_with(&self, hooks: &mut Hooks<'_>, interrupt: &Interrupt<'_>) -> Result<Found> {
        let mut found = Vec::new();
        while let Some(design) = self.take() {
            if self.watch(interrupt) {
                break;
            }
            let asked = Cell::new(0_usize);
            let cancelled = || {
                asked.set(asked.get() + 1);
                self.stop.load(Ordering::Relaxed)
                    || (asked.get().is_multiple_of(BATCH_BETWEEN_CHECKS) && interrupt.check().is_err())
            };
            let mut own = Hooks {
                cancelled: Some(&cancelled),
                ..Hooks::default()
            };
            let Some(solved) = self.solve(design, &mut own) else {
                break;
            };
            let peak = &solved.peak;
            let progress = Progress {
                point: self.done.load(Ordering::Relaxed),
                parameter: peak.omega,
                amplitude: peak.amplitude,
                fraction_done: self.share_done(),
                ..Progress::default()
            };
            try_push(&mut found, (design, solved), CONTEXT)
                .inspect_err(|_| self.stop.store(true, Ordering::Relaxed))?;
            if hooks.report(&progress) {
                self.stop.store(true, Ordering::Relaxed);
            }
        }
        Ok(found)
    }

    fn share_done(&self) -> f64 {
        self.done.load(Ordering::Relaxed) as f64 / self.designs.max(1) as f64
    }

    /// Asks the caller whether to stop, and passes a stop on to all threads.
    fn watch(&self, interrupt: &Interrupt<'_>) -> bool {
        let stopped = interrupt.phase(Phase::Continuation, self.share_done()).is_err();
        if stopped {
            self.stop.store(true, Ordering::Relaxed);
        }
        stopped
    }
}

/// The highest peak of the response of `model` within a range of frequency, for each design: `values` holds the values of
/// the `parameters`, design after design. A design that fails is reported alone.
///
/// # Errors
/// Bad options and parameters; `Dimension` where the values are no whole number of designs; `Unsupported` for a model
/// with a law of the caller on several threads; `OutOfMemory`.
pub fn batch(
    model: &Model,
    solver: &SolverOptions,
    options: &BatchOptions<'_>,
    (parameters, values): (&[Parameter<'_>], &[f64]),
    hooks: &mut Hooks<'_>,
) -> Result<Batch> {
    let surroundings = |work: &mut dyn FnMut()| {
        work();
        true
    };
    batch_within(
        model,
        solver,
        options,
        (parameters, values),
        hooks,
        (&surroundings, of_std),
    )
}

/// Computes a batch as `batch` does, with threads that the caller's function `together` starts and that work within
/// its surroundings.
///
/// # Errors
/// As [`batch`].
pub fn batch_within(
    model: &Model,
    solver: &SolverOptions,
    options: &BatchOptions<'_>,
    (parameters, values): (&[Parameter<'_>], &[f64]),
    hooks: &mut Hooks<'_>,
    threads: (&Surroundings<'_>, Together),
) -> Result<Batch> {
    solver.check()?;
    options.check()?;
    model.check_response_dof(solver.response_dof)?;
    for (i, parameter) in parameters.iter().enumerate() {
        parameter
            .check(model)
            .map_err(|e| e.at(format_args!("parameter {i}")))?;
        if let Some(j) = parameters[..i]
            .iter()
            .position(|other| other.sets_the_same_as(parameter))
        {
            return fail!(
                Argument,
                "parameters {j} and {i} set the same number of the model: the last value would hold"
            );
        }
    }
    if parameters.is_empty() {
        return fail!(Dimension, "no parameters, needs at least one");
    }
    if values.len() % parameters.len() != 0 {
        return fail!(
            Dimension,
            "{} values of {} parameters are no whole number of designs",
            values.len(),
            parameters.len()
        );
    }
    if options.threads > 1 && model.contacts().iter().any(|contact| contact.kind.user().is_some()) {
        return fail!(
            Unsupported,
            "threads = {}, but a force of the caller is called on its own thread: needs 1",
            options.threads
        );
    }
    let designs = values.len() / parameters.len();
    let interrupt = hooks.interrupt();
    let mut batch = Batch {
        peaks: try_vec(designs, DesignPeak::not_solved(), CONTEXT)?,
        branches: Vec::new(),
        status: Status::Ok,
        responses: options.responses.len(),
    };
    if options.keep {
        batch
            .branches
            .try_reserve_exact(designs)
            .map_err(|_| Error::out_of_memory(CONTEXT))?;
        batch.branches.extend((0..designs).map(|_| None));
    }
    let base = model.separate_clone()?;
    if base.structure().ndof() > EXACT_UP_TO && parameters.iter().all(Parameter::keeps_structure) {
        // The basis of the matrices serves all designs. An error is that of each design.
        let sweep = (options.omega_start, options.omega_stop);
        if let Err(e) = Condensed::new(&base, solver, sweep, &interrupt)
            && e.status == Status::StoppedByCaller
        {
            batch.status = e.status;
            return Ok(batch);
        }
    }
    let work = Work {
        model: &base,
        solver,
        options,
        parameters,
        values,
        designs,
        next: AtomicUsize::new(0),
        done: AtomicUsize::new(0),
        stop: AtomicBool::new(false),
    };
    let outcomes = run(&work, hooks, &interrupt, threads);
    for found in outcomes? {
        for (design, solved) in found? {
            batch.peaks[design] = solved.peak;
            if let (Some(place), Some(branch)) = (batch.branches.get_mut(design), solved.branch) {
                *place = Some(branch);
            }
        }
    }
    if work.done.load(Ordering::Relaxed) < designs {
        batch.status = Status::StoppedByCaller;
    }
    Ok(batch)
}

/// Results of all threads, those of the caller's thread first. Where the system has no further thread, the existing
/// ones do the work.
fn run(
    work: &Work<'_>,
    hooks: &mut Hooks<'_>,
    interrupt: &Interrupt<'_>,
    (surroundings, together): (&Surroundings<'_>, Together),
) -> Result<Vec<Result<Found>>> {
    let others = work.options.threads.min(work.designs).saturating_sub(1);
    let (mut outcomes, mut places) = (Vec::new(), Vec::new());
    for reserved in [outcomes.try_reserve_exact(others + 1), places.try_reserve_exact(others)] {
        reserved.map_err(|_| Error::out_of_memory("the threads"))?;
    }
    places.extend((0..others).map(|_| Mutex::new(None)));
    let ended = AtomicUsize::new(0);
    let task = |number: usize| {
        let (mut outcome, mut works) = (Ok(Vec::new()), true);
        let lost = catch_unwind(AssertUnwindSafe(|| works = surroundings(&mut || outcome = work.run()))).is_err();
        // A thread that was lost, which no design causes, is told as such.
        if lost || !works {
            outcome = if lost {
                fail!(Internal, "a thread of the batch ended early")
            } else {
                Ok(Vec::new())
            };
        }
        if let Ok(mut place) = places[number].lock() {
            *place = Some(outcome);
        }
        ended.fetch_add(1, Ordering::Release);
    };
    together(others, &task, &mut |started| {
        outcomes.push(work.run_with(hooks, interrupt));
        while ended.load(Ordering::Acquire) < started {
            work.watch(interrupt);
            thread::sleep(PAUSE);
        }
    });
    outcomes.extend(places.into_iter().filter_map(|place| place.into_inner().ok().flatten()));
    Ok(outcomes)
}
