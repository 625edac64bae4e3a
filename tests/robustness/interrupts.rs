//! A caller may stop every analysis at any moment: it returns at once, with what it has found, and says so.
//!
//! Tests of the suite count the checks of the interrupt, which no busy machine changes; timings are printed. The test
//! with limits on them is run by tests/deep.sh.

use crate::common::models::{chain_stiffness, dense, diagonal, free_end};
use crate::common::stopping::{Analysis, Lateness, of_branch, of_call, random, stop_when};
use crate::common::{amplitude_range, at_dof, harmonics, laws, omega_range};
use hbvib::{
    Branch, Contact, ContactState, Flexibility, Hooks, Interrupt, ModeChoice, ModeOptions, Model, Phase, PhaseReport,
    Progress, Result, SolverOptions, Status, SteadyMethod, SynthesisOptions, TimeOptions, VerifyOptions,
    contact_evaluate_with, estimate_at_with, forced_residual_with, forced_response, nonlinear_mode, synthesise_with,
    time_response, verify,
};
use num_complex::Complex64;
use std::cell::RefCell;
use std::time::Duration;

/// A structure for all analyses: a chain with friction at its first masses, whose matrices are full or sparse.
struct Case {
    name: &'static str,
    model: Model,
    contacts: usize,
    /// First natural frequency, roughly.
    omega: f64,
}

impl Case {
    /// Unit masses and springs of `k`, fixed at one end and forced at the other.
    fn chain(name: &'static str, n: usize, contacts: usize, full: bool) -> Self {
        let k = 0.25 * (n * n) as f64;
        let mut mass = diagonal(&vec![1.0; n]);
        if full {
            // A full matrix of rank one hardly changes the modes.
            for (at, m) in mass.iter_mut().enumerate() {
                let wave = |i: usize| (i as f64 * 0.7).sin();
                *m += 1e-3 / n as f64 * wave(at / n) * wave(at % n);
            }
        }
        let mut model = dense(&mass, &chain_stiffness(&free_end(n, k)))
            .rayleigh(0.01, 1e-5)
            .build();
        for i in 0..contacts {
            let at = 1 + i * (n - 2) / contacts;
            model.add_contact(&Contact::jenkins(at, None, 0.5, 1.0, 0.02)).unwrap();
        }
        model.add_force(n - 1, 1, 1.0.into()).unwrap();
        // ω = 2 √k sin(π/(4 n + 2)) with k = n²/4.
        let omega = n as f64 * (std::f64::consts::PI / (4 * n + 2) as f64).sin();
        Self {
            name,
            model,
            contacts,
            omega,
        }
    }

    fn fixed(&self) -> SolverOptions {
        at_dof(self.model.ndof() - 1, harmonics(5))
    }

    fn forced(&self, solver: &SolverOptions, ends: (f64, f64), hooks: &mut Hooks<'_>) -> Result<Branch> {
        let range = omega_range(ends.0 * self.omega, ends.1 * self.omega);
        forced_response(&self.model, solver, &range, hooks)
    }

    fn mode(&self, hooks: &mut Hooks<'_>) -> Result<Branch> {
        let range = ModeOptions {
            choice: ModeChoice::Index(0),
            ..amplitude_range(-2.0, 1.0)
        };
        nonlinear_mode(&self.model, &self.fixed(), &range, hooks)
    }
}

/// Every analysis of a case; `solved` is a branch with the first harmonics at one frequency, `mode` a short mode.
#[allow(clippy::too_many_lines, reason = "one list of all analyses")]
fn analyses<'a>(case: &'a Case, solved: &'a Branch, mode: &'a Branch) -> Vec<Analysis<'a>> {
    let n = case.model.ndof();
    let automatic = SolverOptions {
        tolerance: 1e-3,
        ..case.fixed()
    };
    let motion: Vec<Complex64> = (0..4 * n)
        .map(|k| Complex64::cis(k as f64) / (1 + k / n) as f64)
        .collect();
    let signal: Vec<Complex64> = (0..=400)
        .map(|h| Complex64::cis(f64::from(h)) / f64::from(1 + h * h))
        .collect();
    let time = TimeOptions {
        omega: case.omega,
        samples: 64,
        method: SteadyMethod::Shooting,
        max_periods: 1_000_000,
        ..TimeOptions::default()
    };
    vec![
        (
            "forced, fixed H",
            Box::new(|hooks| of_branch(case.forced(&case.fixed(), (0.8, 1.2), hooks))),
        ),
        (
            "forced, tolerance",
            Box::new(move |hooks| of_branch(case.forced(&automatic, (0.8, 1.2), hooks))),
        ),
        ("nonlinear mode", Box::new(|hooks| of_branch(case.mode(hooks)))),
        (
            "time response",
            Box::new(move |hooks| Ok(time_response(&case.model, &time, hooks)?.status)),
        ),
        (
            "verify",
            Box::new(|hooks| Ok(verify(&case.model, solved, 0, &VerifyOptions::default(), hooks)?.status)),
        ),
        (
            "linear modes, some",
            Box::new(|hooks| {
                let interrupt = hooks.interrupt();
                of_call(case.model.lowest_modes_with(0, ContactState::Stuck, 12, &interrupt))
            }),
        ),
        (
            "linear modes, half",
            Box::new(move |hooks| {
                let interrupt = hooks.interrupt();
                let half = (n / 2).min(300);
                of_call(case.model.lowest_modes_with(0, ContactState::Stuck, half, &interrupt))
            }),
        ),
        (
            "contact evaluate",
            Box::new(move |hooks| {
                let interrupt = hooks.interrupt();
                let law = Contact::jenkins(0, None, 1.0, 1.0, 0.3);
                let mut force = vec![Complex64::ZERO; signal.len()];
                let mut jacobian = vec![0.0; 4 * signal.len() * signal.len()];
                let at = (signal.len() - 1, 0, 1.0);
                let outcome = contact_evaluate_with(&law, at, &signal, &mut force, Some(&mut jacobian), &interrupt);
                let untouched = force.iter().all(|f| *f == Complex64::ZERO);
                assert_eq!(outcome.is_err(), untouched);
                of_call(outcome)
            }),
        ),
        (
            "forced residual",
            Box::new(move |hooks| {
                let interrupt = hooks.interrupt();
                let solver = SolverOptions {
                    harmonics: 3,
                    ..case.fixed()
                };
                let mut r = vec![Complex64::ONE; motion.len()];
                let receivers = (&mut r[..], None, None);
                let outcome = forced_residual_with(&case.model, &solver, case.omega, &motion, receivers, &interrupt);
                let untouched = r.iter().all(|r| *r == Complex64::ONE);
                assert_eq!(outcome.is_err(), untouched || r.iter().all(|r| r.is_nan()));
                of_call(outcome)
            }),
        ),
        (
            "error of a point",
            Box::new(|hooks| {
                let interrupt = hooks.interrupt();
                of_call(estimate_at_with(&case.model, &case.fixed(), solved, 0, &interrupt))
            }),
        ),
        (
            "results of a point",
            Box::new(|hooks| {
                let interrupt = hooks.interrupt();
                let mut x = vec![Complex64::ZERO; (solved.harmonics() + 1) * solved.ndof()];
                of_call((|| {
                    solved.harmonics_at_with(0, &mut x, &interrupt)?;
                    solved.energy_at_with(0, &interrupt)?;
                    solved.contact_loop_with(0, case.contacts / 2, 256, &interrupt)?;
                    solved.contact_summary_with(0, case.contacts / 2, &interrupt)
                })())
            }),
        ),
        (
            "synthesis",
            Box::new(|hooks| {
                let interrupt = hooks.interrupt();
                let options = SynthesisOptions::default();
                of_call(synthesise_with(mode, &case.model, &options, &interrupt))
            }),
        ),
    ]
}

/// A branch of one point, and a mode of a few, of a case.
fn solved(case: &Case) -> (Branch, Branch) {
    let branch = case.forced(&case.fixed(), (0.9, 0.9), &mut Hooks::default()).unwrap();
    let mut points = 0;
    let mut few = |_: &Progress| {
        points += 1;
        points == 4
    };
    let mut hooks = Hooks {
        progress: Some(&mut few),
        ..Hooks::default()
    };
    (branch, case.mode(&mut hooks).unwrap())
}

/// Checks to which a run of the suite is followed.
const FOLLOWED: u64 = 2_500;

#[test]
fn every_analysis_returns_from_any_check_with_what_it_has() {
    let mut state = 0x5eed;
    for case in [Case::chain("full", 120, 6, true), Case::chain("sparse", 300, 6, false)] {
        let (branch, mode) = solved(&case);
        for analysis in analyses(&case, &branch, &mode) {
            let whole = stop_when(&analysis, |checks, _| checks > FOLLOWED);
            // The modes of a real matrix of 120 degrees of freedom are a few products.
            let least = if ["contact evaluate", "linear modes, half"].contains(&analysis.0) {
                3
            } else {
                10
            };
            assert!(whole.checks > least, "{}: {} checks", analysis.0, whole.checks);
            let mut latest = Duration::ZERO;
            for k in 0..3 {
                // At the first check too.
                let at = if k == 0 {
                    1
                } else {
                    1 + (random(&mut state) * (whole.checks - 1) as f64) as u64
                };
                let run = stop_when(&analysis, |checks, _| checks == at);
                assert_eq!((run.status, run.checks), (Status::StoppedByCaller, at));
                latest = latest.max(run.late.unwrap());
            }
            println!(
                "{:7} {:19} {:6} checks, widest gap {:8.2?}, back after {:8.2?} at most",
                case.name, analysis.0, whole.checks, whole.widest, latest
            );
        }
    }
}

/// Operations between two checks: some ten milliseconds.
const MOST_OPERATIONS: u64 = 200_000_000;

#[test]
fn no_step_of_a_large_structure_is_long() {
    // So many degrees of freedom that the condensation makes a basis.
    let case = Case::chain("full", 650, 8, true);
    let condensed = |interrupt: &Interrupt<'_>| {
        hbvib::internals::Condensed::new(&case.model, &case.fixed(), case.omega, interrupt).map(|_| ())
    };
    let modes = |interrupt: &Interrupt<'_>| {
        case.model
            .lowest_modes_with(0, ContactState::Stuck, 20, interrupt)
            .map(|_| ())
    };
    for (name, run) in [
        ("condensation", &condensed as &dyn Fn(&Interrupt<'_>) -> Result<()>),
        ("linear modes", &modes),
    ] {
        let interrupt = Interrupt::none();
        run(&interrupt).unwrap();
        println!(
            "{name}: {} checks, at most {} operations between them",
            interrupt.checks(),
            interrupt.largest()
        );
        assert!(
            interrupt.largest() <= MOST_OPERATIONS && interrupt.checks() > 50,
            "{name}"
        );
    }
}

/// A law of the caller is called for a whole period at a time, which is not interrupted; its harmonics and derivatives are.
#[test]
fn one_evaluation_of_a_law_with_many_harmonics_is_checked() {
    const HIGHEST: usize = 100;
    for case in laws::cases() {
        let directions = case.contact.directions();
        let signal = (0..directions * (HIGHEST + 1)).map(|i| {
            let h = i % (HIGHEST + 1);
            Complex64::cis(i as f64) / (1 + h * h) as f64
        });
        let signal: Vec<Complex64> = signal.collect();
        let mut force = vec![Complex64::ZERO; signal.len()];
        let mut jacobian = vec![0.0; 4 * signal.len() * signal.len()];
        let interrupt = Interrupt::none();
        let at = (HIGHEST, 0, case.omega);
        contact_evaluate_with(&case.contact, at, &signal, &mut force, Some(&mut jacobian), &interrupt).unwrap();
        println!(
            "{}: {} checks, at most {} operations between them",
            case.name,
            interrupt.checks(),
            interrupt.largest()
        );
        assert!(
            interrupt.checks() > 0 && interrupt.largest() <= MOST_OPERATIONS,
            "{}",
            case.name
        );
    }
}

#[test]
fn phases_are_reported_apart_from_points_and_may_stop_a_run() {
    let case = Case::chain("sparse", 300, 4, false);
    // A model keeps its basis: later calls would factor nothing.
    let solver = SolverOptions {
        tolerance: 1e-2,
        flexibility: Flexibility::Direct,
        ..case.fixed()
    };
    let reports = RefCell::new(Vec::new());
    let sink = |report: &PhaseReport| {
        reports.borrow_mut().push(*report);
        false
    };
    let mut points = 0;
    let mut count = |_: &Progress| {
        points += 1;
        false
    };
    let mut hooks = Hooks {
        progress: Some(&mut count),
        phase: Some(&sink),
        ..Hooks::default()
    };
    let branch = case.forced(&solver, (0.9, 1.1), &mut hooks).unwrap();
    assert_eq!(points, branch.points());
    let reports = reports.into_inner();
    let phases = [
        Phase::Setup,
        Phase::Condensation,
        Phase::FirstPoint,
        Phase::Continuation,
        Phase::Estimate,
        Phase::Factorisation,
    ];
    for phase in phases {
        assert!(reports.iter().any(|r| r.phase == phase), "{phase:?}");
    }
    assert_eq!(reports[0].phase, Phase::Setup);
    // Reports are limited by work: a sparse factorisation each, and a few for each point.
    let others = reports.iter().filter(|r| r.phase != Phase::Factorisation).count();
    println!(
        "{} points, {} reports, {others} of them no factorisation",
        points,
        reports.len()
    );
    assert!(others < 200 + 60 * points, "{others} reports for {points} points");
    for phase in phases {
        let stop = |report: &PhaseReport| report.phase == phase;
        let mut hooks = Hooks {
            phase: Some(&stop),
            ..Hooks::default()
        };
        let branch = case.forced(&solver, (0.9, 1.1), &mut hooks).unwrap();
        assert_eq!(branch.status(), Status::StoppedByCaller, "{phase:?}");
    }
}

#[test]
#[ignore = "minutes: limits on times, for tests/deep.sh"]
fn every_analysis_of_the_largest_models_returns_within_a_tenth_of_a_second() {
    let mut state = 0xd1ce;
    let mut all = Lateness::default();
    for case in [
        Case::chain("full", 600, 40, true),
        Case::chain("sparse", 2000, 20, false),
    ] {
        let (branch, mode) = solved(&case);
        for analysis in analyses(&case, &branch, &mode) {
            all.add(case.name, &analysis, 4, &mut state);
        }
    }
    all.check();
}

/// Samples, turning points and columns are checked as they are computed: no long stretch of one evaluation is without a check.
#[test]
fn samples_and_turning_points_of_many_harmonics_are_checked() {
    const HIGHEST: usize = 300;
    let law = Contact::jenkins(0, None, 1.0, 1.0, 0.01);
    let signal: Vec<Complex64> = (0..=HIGHEST)
        .map(|h| Complex64::cis((h * h) as f64) / (1 + h) as f64)
        .collect();
    let mut force = vec![Complex64::ZERO; signal.len()];
    for (samples, most, least) in [(0, 1_000_000, 1_000), (1 << 16, 3_000_000, 30)] {
        let interrupt = Interrupt::none();
        contact_evaluate_with(&law, (HIGHEST, samples, 1.0), &signal, &mut force, None, &interrupt).unwrap();
        let (checks, largest) = (interrupt.checks(), interrupt.largest());
        println!("{samples} samples: {checks} checks, at most {largest} operations between them");
        assert!(checks >= least && largest <= most, "{samples} samples");
    }
}
