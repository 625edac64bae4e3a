//! Memory: a Newton iteration after the first asks for none, counted by the allocator itself.
//!
//! The one allowance is what an accepted point keeps: the corrector returns its tangent as a new
//! vector, one allocation per solved point whatever the number of iterations, and the branch's
//! arrays grow with the points (not measured here).

mod common;

use crate::common::models::unit_chain;
use common::{BASE, harmonics};
use hbvib::internals::Evaluation;
use hbvib::internals::HarmonicBalance;
use hbvib::internals::HarmonicSet;
use hbvib::internals::HystereticEvaluator;
use hbvib::internals::Jacobian;
use hbvib::internals::Memoryless;
use hbvib::internals::MemorylessEvaluator;
use hbvib::internals::PlaneFrictionEvaluator;
use hbvib::internals::ScaledFriction3d;
use hbvib::internals::StaticState;
use hbvib::internals::StepControl;
use hbvib::internals::TanhFriction;
use hbvib::internals::balance;
use hbvib::internals::norm;
use hbvib::internals::{Condensed, Reference};
use hbvib::internals::{Corrector, Outcome};
use hbvib::internals::{Epmc, Gauge, LinearMode};
use hbvib::internals::{InitialGuess, Problem, Residual};
use hbvib::internals::{Metric, Settings};
use hbvib::{
    Call, Contact, DampingForm, Interrupt, MatrixKind, MatrixView, ModeChoice, Model, Polynomial, SolverOptions, User,
    UserForce,
};
use num_complex::Complex64;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Counts the allocations of each thread; tests run in threads of their own.
struct Counting;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    // A thread that is being torn down has no counter any more.
    let _ = COUNT.try_with(|c| c.set(c.get() + 1));
}

// SAFETY: every call is passed on unchanged to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        unsafe { System.dealloc(memory, layout) }
    }
    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        unsafe { System.realloc(memory, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations that `work` makes.
fn allocations<T>(work: impl FnOnce() -> T) -> (usize, T) {
    let before = COUNT.get();
    let result = work();
    (COUNT.get() - before, result)
}

/// Every way of evaluating: exact events with a table of sines and with a transform, and samples.
const WAYS: [(usize, usize); 5] = [(1, 0), (9, 0), (63, 0), (9, 64), (9, 1024)];

fn options(highest: usize, samples: usize) -> SolverOptions {
    SolverOptions {
        samples,
        ..harmonics(highest)
    }
}

#[test]
fn the_counter_counts() {
    let (count, v) = allocations(|| vec![1.0_f64; 100]);
    assert_eq!((count, v.len()), (1, 100));
}

#[test]
fn an_evaluation_allocates_nothing() {
    no_evaluation_allocates(&BASE.sector());
}

#[test]
fn an_evaluation_of_a_cubic_spring_allocates_nothing() {
    let mut model = BASE.sector();
    for dof in [2, 3] {
        model.add_contact(&Contact::cubic(dof, None, 1e6, 1e17)).unwrap();
    }
    no_evaluation_allocates(&model);
}

fn no_evaluation_allocates(model: &Model) {
    for (highest, samples) in WAYS {
        let options = options(highest, samples);
        let omega = TAU * 208.85;
        let condensed = Condensed::new(model, &options, omega, &Interrupt::none()).unwrap();
        let interrupt = Interrupt::none();
        let mut problem = HarmonicBalance::new(&condensed, 0, (1.0, 1.0).into(), samples, None, &interrupt).unwrap();
        let n = problem.size();
        let mut u = vec![0.0; n];
        let mut at = Residual::new(n).unwrap();
        let (mut matrix, mut active) = (vec![0.0; n * n], vec![true; n]);
        assert!(problem.initial_guess(InitialGuess::Stuck, omega, &mut u).unwrap());
        problem.evaluate(&u, omega, &mut at).unwrap();
        for (name, factor) in [("the same", 1.0), ("another", 1.001)] {
            let (count, ()) = allocations(|| {
                for k in 0..5 {
                    // The motion changes too: other turning points, other slips.
                    u[k % n] *= 1.5;
                    let factor = 1.0 + (factor - 1.0) * f64::from(k as u32 + 1);
                    problem.evaluate(&u, omega * factor, &mut at).unwrap();
                    problem.fill(&mut matrix, &mut active).unwrap();
                }
            });
            assert_eq!(
                count, 0,
                "H = {highest}, {samples} samples: 5 evaluations at {name} frequency"
            );
        }
        let direction = vec![1.0; n + 1];
        let (count, _) = allocations(|| problem.observe(&u, &direction));
        assert_eq!(count, 0, "observing the amplitude");
    }
}

#[test]
fn the_energy_balance_of_a_point_allocates_nothing() {
    let condensed = Condensed::new(&BASE.sector(), &options(9, 0), TAU * 208.85, &Interrupt::none()).unwrap();
    let x = vec![Complex64::ONE; condensed.set().numbers().len() * condensed.ndof()];
    let packed = vec![1.0; condensed.coordinates() * condensed.set().packed_len()];
    let (count, found) = allocations(|| balance(&condensed, 1300.0, &x, &packed, &packed));
    assert_eq!(count, 0);
    assert!(found.twice_mean_kinetic > 0.0 && found.structural_loss > 0.0);
}

#[test]
fn an_evaluation_of_a_mode_allocates_nothing() {
    let model = BASE.sector();
    let start = model.select_mode(ModeChoice::Index(0)).unwrap();
    for form in [DampingForm::Mass, DampingForm::Stiffness] {
        let damped = model.damped_mode(&start, form).unwrap();
        let gauge = Gauge {
            contact: None,
            reference_dof: 0,
        };
        for ((highest, samples), loaded) in WAYS.into_iter().flat_map(|way| [(way, false), (way, true)]) {
            let options = options(highest, samples);
            let (condensed, _) =
                Condensed::for_mode(&model, &options, (form, loaded), &damped.shape, &Interrupt::none()).unwrap();
            let still = |n: usize| {
                if loaded {
                    vec![0.1 * condensed.length(); n]
                } else {
                    Vec::new()
                }
            };
            let linear = LinearMode {
                omega: damped.omega,
                damping: damped.damping,
                shape: damped.shape.clone(),
                rest: StaticState {
                    motion: still(condensed.coordinates()),
                    structure: still(condensed.ndof()),
                    ..StaticState::default()
                },
            };
            let interrupt = Interrupt::none();
            let mut problem = Epmc::new(&condensed, &gauge, &linear, samples, &interrupt).unwrap();
            let n = problem.size();
            let mut u = vec![0.0; n];
            let mut at = Residual::new(n).unwrap();
            let (mut matrix, mut active) = (vec![0.0; n * n], vec![true; n]);
            assert!(problem.initial_guess(InitialGuess::Stuck, 0.0, &mut u).unwrap());
            let (onset, _) = problem.linear_up_to(0.0).unwrap();
            // The first evaluation may lay out memory.
            problem.evaluate(&u, onset + 1.0, &mut at).unwrap();
            let (count, ()) = allocations(|| {
                for k in 0..5 {
                    // The motion changes too: other turning points, other slips.
                    u[k % n] *= 1.5;
                    problem.evaluate(&u, onset + 0.5 * k as f64, &mut at).unwrap();
                    problem.fill(&mut matrix, &mut active).unwrap();
                }
            });
            assert_eq!(count, 0, "{form:?}, H = {highest}, {samples} samples");
            let direction = vec![1.0; n + 1];
            let (count, _) = allocations(|| problem.observe(&u, &direction));
            assert_eq!(count, 0, "observing the damping ratio");
        }
    }
}

#[test]
fn many_contacts_along_a_sweep_allocate_only_where_a_panel_is_laid() {
    // A chain of 48 masses, each rubbing on the ground: the flexibility is interpolated, contacts
    // that stick drop out of Newton's equations.
    let n = 48;
    let model = unit_chain(n)
        .contacts((0..n).map(|i| Contact::jenkins(i, None, 0.5, 0.1, 1.0)))
        .rayleigh(0.0, 0.02)
        .force(0, 1, 1.0)
        .build();
    let options = options(3, 0);
    let condensed = Condensed::new(&model, &options, 0.8, &Interrupt::none()).unwrap();
    assert_eq!(condensed.reference(), Reference::Stuck);
    let interrupt = Interrupt::none();
    let mut problem = HarmonicBalance::new(&condensed, 0, (0.8, 0.9).into(), 0, None, &interrupt).unwrap();
    let size = problem.size();
    let mut v = vec![0.0; size + 1];
    assert!(problem.initial_guess(InitialGuess::Stuck, 0.8, &mut v[..size]).unwrap());
    let settings = Settings {
        start: 0.8,
        end: 0.9,
        tolerance: options.tol_residual,
        max_iterations: 50,
        steps: StepControl::new(0.0, 0.0, 0.0),
    };
    let metric = Metric::along(norm(&v[..size]), &settings);
    let mut row = vec![0.0; size + 1];
    row[size] = 1.0;
    let mut corrector = Corrector::new(size, settings.tolerance, settings.max_iterations).unwrap();
    let mut iterations = 0;
    for (k, omega) in [0.8, 0.801, 0.802, 0.803].into_iter().enumerate() {
        v[size] = omega;
        let (count, outcome) = allocations(|| {
            corrector
                .correct(&mut problem, &mut v, &row, metric, true, &Interrupt::none())
                .unwrap()
        });
        let Outcome::Converged(corrected) = outcome else {
            panic!("no solution at {omega}");
        };
        let slipping = problem.slip_fractions().iter().filter(|s| **s > 0.0).count();
        assert!(slipping > 0 && slipping < n, "{slipping} contacts slip");
        iterations += corrected.iterations;
        assert!(k == 0 || count <= 1, "{count} allocations at {omega}");
    }
    assert!(iterations > 8, "{iterations} iterations");
}

#[test]
fn newton_iterations_allocate_nothing_but_the_tangent_that_a_point_keeps() {
    let model = BASE.sector();
    for (highest, samples) in WAYS {
        let options = options(highest, samples);
        let omega = TAU * 208.85;
        let condensed = Condensed::new(&model, &options, omega, &Interrupt::none()).unwrap();
        let interrupt = Interrupt::none();
        let mut problem = HarmonicBalance::new(&condensed, 0, (1.0, 1.0).into(), samples, None, &interrupt).unwrap();
        let n = problem.size();
        let mut v = vec![0.0; n + 1];
        assert!(problem.initial_guess(InitialGuess::Stuck, omega, &mut v[..n]).unwrap());
        v[n] = omega;
        let settings = Settings {
            start: omega,
            end: 1.05 * omega,
            tolerance: options.tol_residual,
            max_iterations: 50,
            steps: StepControl::new(0.0, 0.0, 0.0),
        };
        let metric = Metric::along(norm(&v[..n]), &settings);
        let mut row = vec![0.0; n + 1];
        row[n] = 1.0;
        let mut corrector = Corrector::new(n, settings.tolerance, settings.max_iterations).unwrap();
        // From the stuck start, damped; then again from a disturbed point at the same and at other
        // frequencies, plain and damped.
        let mut iterations = 0;
        for (factor, damped) in [(1.0, true), (1.0, true), (1.0, false), (1.0005, true), (0.9995, true)] {
            for x in &mut v[..n] {
                *x *= 1.001;
            }
            v[n] = factor * omega;
            let (count, outcome) = allocations(|| {
                corrector
                    .correct(&mut problem, &mut v, &row, metric, damped, &Interrupt::none())
                    .unwrap()
            });
            let Outcome::Converged(corrected) = outcome else {
                panic!("H = {highest}, {samples} samples: not converged");
            };
            iterations += corrected.iterations;
            assert!(
                count <= 1,
                "H = {highest}, {samples} samples: {count} allocations in {} iterations",
                corrected.iterations
            );
        }
        assert!(iterations >= 5, "only {iterations} iterations were seen");
    }
}

#[test]
fn evaluating_laws_without_memory_asks_for_none() {
    let laws: [(&str, Box<dyn Memoryless>); 3] = [
        (
            "polynomial",
            Box::new(Polynomial::tensors(2, &[], &[0.3; 8], &[-0.2; 16]).unwrap()),
        ),
        ("tanh", Box::new(TanhFriction::new(0.7, 0.4).unwrap())),
        ("callback", Box::new(User::new(Arc::new(Drag), 2, 0).unwrap())),
    ];
    for (name, law) in laws {
        // By a table of sines and by a fast transform.
        for highest in [3, 63] {
            let set = HarmonicSet::all(highest).unwrap();
            let motion = vec![0.1; law.directions() * set.packed_len()];
            let mut out = Evaluation::new(&set, law.directions()).unwrap();
            let mut evaluator = MemorylessEvaluator::new(&set, &*law, law.samples(set.highest_reduced(), 0)).unwrap();
            let evaluation = || {
                evaluator
                    .evaluate(&*law, &set, (1.1, &motion), &mut out, &Interrupt::none())
                    .unwrap();
            };
            let (count, ()) = allocations(evaluation);
            assert_eq!(count, 0, "{name}, H = {highest}");
        }
    }
}

/// A damper told by a callback.
struct Drag;

impl UserForce for Drag {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        call.f.copy_from_slice(call.v);
        for (k, slope) in call.df_dv.iter_mut().enumerate() {
            *slope = f64::from(u8::from(k % 4 == 0 || k % 4 == 3));
        }
        0
    }
}

/// A creep told by a callback: z follows u.
struct Creep;

impl UserForce for Creep {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        let mut z = call.states.z0[0];
        for j in 0..call.samples {
            z += 0.1 * (call.u[j] - z);
            call.states.z[j] = z;
            call.states.dz_dz[j] = 0.9;
            call.states.dz_du[j] = 0.1;
            call.f[j] = call.u[j] - z;
            call.df_du[j] = 1.0;
            call.states.df_dz[j] = -1.0;
        }
        0
    }
}

#[test]
fn a_callback_with_states_is_asked_without_memory() {
    let set = HarmonicSet::all(5).unwrap();
    let law = User {
        states: 1,
        velocity: false,
        ..User::new(Arc::new(Creep), 1, 0).unwrap()
    };
    let motion: Vec<f64> = (0..11).map(|i| (0.7 + f64::from(i)).sin()).collect();
    let mut way = HystereticEvaluator::new(&set, &law, 256).unwrap();
    let mut out = Evaluation::new(&set, 1).unwrap();
    let (count, result) = allocations(|| way.evaluate(&law, 1.0, &motion, &mut out, &Interrupt::none()));
    result.unwrap();
    assert_eq!(count, 0);
    // A load that stays is crept away; the fundamental is filtered, Z = 0.1 X/(1 - 0.9 exp(-2 pi i/256)).
    assert!(out.force[0].abs() < 1e-12);
    let turn = Complex64::from_polar(1.0, -std::f64::consts::TAU / 256.0);
    let left = (1.0 - 0.1 / (1.0 - 0.9 * turn)) * set.get(&motion, 1);
    assert!((set.get(&out.force, 1) - left).norm() < 1e-12);
}

#[test]
fn a_law_marched_over_samples_asks_for_no_memory() {
    let set = HarmonicSet::all(5).unwrap();
    // With separation, with slip alone, and stuck.
    for load in [0.4, 4.0, 1e3] {
        let law = ScaledFriction3d {
            kt: 1.3,
            kn: 0.9,
            mu: 0.4,
            load,
            has_normal: true,
            slider: [0.0; 2],
        };
        let motion: Vec<f64> = (0..33).map(|i| (0.7 + f64::from(i)).sin()).collect();
        let mut way = PlaneFrictionEvaluator::new(&set, &law).unwrap();
        let mut out = Evaluation::new(&set, 3).unwrap();
        let (count, result) = allocations(|| way.evaluate(&law, &set, &motion, &mut out, &Interrupt::none()));
        result.unwrap();
        assert_eq!(count, 0, "load {load}");
        assert_eq!(out.open_fraction > 0.0, load < 1.0);
        assert_eq!((out.slip_fraction > 0.0, out.stuck), (load < 10.0, load > 10.0));
    }
}

#[test]
fn newton_iterations_with_contacts_of_several_directions_allocate_nothing() {
    // A chain of five bodies in space, springs of 1 to the next and to the ground along each axis. Three
    // rub in a plane with separation, two in one direction.
    let (bodies, n) = (5, 15);
    let mut model = Model::new(n).unwrap();
    let mut stiffness = vec![0.0; n * n];
    let mut mass = vec![0.0; n * n];
    for i in 0..n {
        mass[i * n + i] = 1.0;
        stiffness[i * n + i] = 2.5;
        if i >= 3 {
            stiffness[i * n + i - 3] = -1.0;
            stiffness[(i - 3) * n + i] = -1.0;
        }
    }
    for body in 0..bodies {
        let dof = |k: usize| Some(3 * body + k);
        let preload = [1e3, 1.0, 0.3, 1.0, 0.2][body];
        let contact = if body % 2 == 0 {
            Contact::friction_3d([dof(0), dof(1), dof(2)], [None; 3], (0.7, 0.9), 0.3, preload)
        } else {
            Contact::friction_2d([dof(0), dof(2)], [None; 2], (0.7, 0.9), 0.3, preload)
        };
        model.add_contact(&contact).unwrap();
        // The ground is what presses: a constant load holds the body to it.
        model.add_force(3 * body + 2, 0, (-preload).into()).unwrap();
    }
    for (kind, values) in [(MatrixKind::Mass, &mass), (MatrixKind::Stiffness, &stiffness)] {
        model.set_matrix(kind, &MatrixView::dense(n, values)).unwrap();
    }
    model.set_rayleigh(0.0, 0.05).unwrap();
    model.add_force(0, 1, 0.5.into()).unwrap();
    model.add_force(13, 1, 0.3.into()).unwrap();
    model.add_force(14, 1, Complex64::new(0.0, 0.4)).unwrap();
    let omega = 1.3;
    let options = options(5, 0);
    let condensed = Condensed::new(&model, &options, omega, &Interrupt::none()).unwrap();
    assert_eq!(condensed.reference(), Reference::Stuck);
    let interrupt = Interrupt::none();
    let mut problem = HarmonicBalance::new(&condensed, 0, (omega, 1.1 * omega).into(), 0, None, &interrupt).unwrap();
    let size = problem.size();
    let mut v = vec![0.0; size + 1];
    problem
        .initial_guess(InitialGuess::Reference, omega, &mut v[..size])
        .unwrap();
    let settings = Settings {
        start: omega,
        end: 1.1 * omega,
        tolerance: options.tol_residual,
        max_iterations: 60,
        steps: StepControl::new(0.0, 0.0, 0.0),
    };
    let metric = Metric::along(norm(&v[..size]), &settings);
    let mut row = vec![0.0; size + 1];
    row[size] = 1.0;
    let mut corrector = Corrector::new(size, settings.tolerance, settings.max_iterations).unwrap();
    let mut iterations = 0;
    for (k, factor) in [1.0, 1.0, 1.002, 1.004].into_iter().enumerate() {
        for x in &mut v[..size] {
            *x *= 1.01;
        }
        v[size] = factor * omega;
        let (count, outcome) = allocations(|| {
            corrector
                .correct(&mut problem, &mut v, &row, metric, true, &Interrupt::none())
                .unwrap()
        });
        let Outcome::Converged(corrected) = outcome else {
            panic!("no solution at {factor} of the frequency");
        };
        let slipping = problem.slip_fractions().iter().filter(|s| **s > 0.0).count();
        assert!(slipping > 0 && slipping < bodies, "{slipping} contacts slip");
        iterations += corrected.iterations;
        // The first factorisation lays out memory of its own.
        let found = corrected.iterations;
        assert!(k == 0 || count == 1, "{count} allocations in {found} iterations");
    }
    assert!(iterations > 8, "{iterations} iterations");
}
