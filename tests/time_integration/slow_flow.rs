//! Run-ups by the slow flow of a nonlinear mode, against integration in time.

use crate::common::chains::rubbing_mass;
use crate::common::models::{self, dense, oscillator};
use crate::common::random;
use crate::common::{amplitude_range, at_dof, harmonics};
use hbvib::{
    Branch, Contact, Hooks, Interrupt, MatrixKind, MatrixView, ModeOptions, Model, RunUp, RunUpOptions, SolverOptions,
    Status, SweepOptions, nonlinear_mode, run_up, sweep,
};

/// Three masses on springs with one to three sliders.
fn chain(force: f64, contacts: usize) -> Model {
    let m = [1.0, 0.0, 0.0, 0.0, 1.2, 0.0, 0.0, 0.0, 0.8];
    let k = [3.0, -1.0, 0.0, -1.0, 2.0, -1.0, 0.0, -1.0, 1.5];
    let all = [
        Contact::jenkins(2, None, 0.2, 0.1, 1.0),
        Contact::jenkins(1, Some(0), 0.3, 0.1, 0.5),
        Contact::jenkins(1, None, 0.1, 0.1, 0.3),
    ];
    dense(&m, &k)
        .rayleigh(0.0, 0.02)
        .contacts(&all[..contacts])
        .force(2, 1, force)
        .build()
}

fn mode(model: &Model, harmonics: usize) -> Branch {
    let solver = at_dof(model.ndof() - 1, crate::common::harmonics(harmonics));
    let range = amplitude_range(-2.0, 0.8);
    nonlinear_mode(model, &solver, &range, &mut Hooks::default()).unwrap()
}

/// The run-up, the relative errors of it and of the slow flow alone, and the turns of the whole motion.
struct Compared {
    found: RunUp,
    error: f64,
    slow_flow: f64,
}

fn compared(
    (model, branch): (&Model, &Branch),
    (omega_start, omega_stop): (f64, f64),
    (rate, integrated_turns): (f64, usize),
) -> Compared {
    let options = RunUpOptions {
        omega_start,
        omega_stop,
        rate,
        integrated_turns,
        ..RunUpOptions::default()
    };
    let found = run_up(branch, model, &options, &Interrupt::none()).unwrap();
    let in_time = SweepOptions {
        omega_start,
        omega_stop,
        rate,
        dof: model.ndof() - 1,
        ..SweepOptions::default()
    };
    let truth = sweep(model, &in_time, &mut Hooks::default()).unwrap();
    assert!(found.turns.len().abs_diff(truth.turns.len()) <= 1);
    // The largest displacement lies in its turn.
    let highest = found.turns.iter().map(|turn| turn.amplitude).fold(0.0, f64::max);
    assert!(highest >= found.largest * (1.0 - 1e-9), "{highest} {}", found.largest);
    Compared {
        error: found.largest / truth.largest - 1.0,
        slow_flow: found.slow_flow / truth.largest - 1.0,
        found,
    }
}

/// Checks rates in both directions: the error told bounds the true one, and is small; the slow flow alone is near where the rate is small.
fn check(name: &str, model: &Model, harmonics: usize, (low, high): (f64, f64), (rates, near): (&[f64], f64)) {
    let branch = mode(model, harmonics);
    for &rate in rates {
        for ends in [(low, high), (high, low)] {
            let one = compared((model, &branch), ends, (rate, RunUpOptions::default().integrated_turns));
            let (found, error) = (&one.found, one.error);
            println!(
                "{name} {rate:.1e} from {:.2}: error {error:+.2e}, told {:.2e}, slow flow alone {:+.2e}, {} of {} turns integrated",
                ends.0,
                found.error,
                one.slow_flow,
                found.integrated,
                found.turns.len()
            );
            assert!(
                error.abs() <= found.error,
                "{name} {rate:e} from {}: error {error:.2e}, told {:.2e}",
                ends.0,
                found.error
            );
            assert!(
                found.integrated > 0 && found.error < 1e-3,
                "{name} {rate:e}: told {:.2e}",
                found.error
            );
            if rate <= 1e-4 {
                assert!(
                    one.slow_flow.abs() < near,
                    "{name} {rate:e}: the slow flow alone errs by {:.2e}",
                    one.slow_flow
                );
            }
        }
    }
}

/// The must of the slow flow alone at rates of 1e-4 and less.
const NEAR: f64 = 3e-3;

#[test]
fn the_error_told_bounds_that_of_one_slider() {
    check("one slider", &rubbing_mass(0.05), 9, (0.85, 1.3), (&[2e-3], NEAR));
    check(
        "much slip",
        &rubbing_mass(0.12),
        9,
        (0.8, 1.3),
        (&[1e-2, 1e-3, 1e-4], NEAR),
    );
}

#[test]
fn the_error_told_bounds_that_of_a_chain() {
    check(
        "one slider of a chain",
        &chain(0.03, 1),
        5,
        (0.5, 1.0),
        (&[1e-2, 1e-3, 1e-4], NEAR),
    );
    check("three sliders", &chain(0.05, 3), 5, (0.5, 1.0), (&[2e-3], NEAR));
}

/// Only the turns around the largest displacement are integrated where the rate is small; without any the slow flow is told.
#[test]
fn a_slow_run_up_is_integrated_around_its_largest_displacement() {
    let model = rubbing_mass(0.05);
    let branch = mode(&model, 9);
    let one = compared((&model, &branch), (0.85, 1.3), (5e-5, 10_000));
    assert!(
        one.found.integrated < one.found.turns.len() / 2,
        "{}",
        one.found.integrated
    );
    assert!(one.error.abs() <= one.found.error && one.found.error < 1e-4);
    let alone = compared((&model, &branch), (0.85, 1.3), (5e-5, 0));
    assert_eq!(alone.found.integrated, 0);
    assert_eq!(alone.found.largest.to_bits(), one.found.slow_flow.to_bits());
    // Too few turns for two leads: the slow flow.
    let few = compared((&model, &branch), (0.85, 1.3), (5e-5, 20));
    assert_eq!(few.found.integrated, 0);
}

const RATES: [f64; 10] = [1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5];

/// Ten rates, in both directions, of the models with stored runs.
#[test]
#[ignore = "takes minutes; tests/deep.sh runs it"]
fn ten_rates_of_stored_models() {
    check("linear", &linear(0.05), 3, (0.8, 1.2), (&RATES, NEAR));
    check("one slider", &rubbing_mass(0.05), 15, (0.85, 1.3), (&RATES, NEAR));
    check("much slip", &rubbing_mass(0.12), 15, (0.8, 1.3), (&RATES, NEAR));
}

/// Ten rates, in both directions.
#[test]
#[ignore = "takes minutes; tests/deep.sh runs it"]
fn ten_rates_of_one_to_three_sliders() {
    check("one slider of a chain", &chain(0.03, 1), 15, (0.5, 1.0), (&RATES, NEAR));
    check("much slip of a chain", &chain(0.06, 1), 15, (0.5, 1.0), (&RATES, NEAR));
    check("two sliders", &chain(0.04, 2), 15, (0.5, 1.0), (&RATES, NEAR));
    check("three sliders", &chain(0.05, 3), 15, (0.5, 1.0), (&RATES, NEAR));
}

fn linear(force: f64) -> Model {
    let mut model = rubbing_mass(force);
    model.set_preload(0, 1e9).unwrap();
    let stiff = MatrixView::dense(1, &[0.8]);
    // The slider sticks for ever: a spring of 0.2 beside one of 0.8.
    model.set_matrix(MatrixKind::Stiffness, &stiff).unwrap();
    model
}

/// Numbers between 0 and 1 by a linear congruence (Knuth's MMIX).
struct Random(u64);

impl Random {
    fn next(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * random::unit(&mut self.0)
    }
}

/// A chain of one to four masses with one to three sliders.
fn random_model(random: &mut Random) -> Model {
    let n = 1 + random.next(0.0, 4.0) as usize;
    let (mass, mut springs): (Vec<_>, Vec<_>) = (0..n).map(|_| (random.next(0.5, 2.0), random.next(0.5, 2.0))).unzip();
    springs.push(0.0);
    let mut model = models::chain(&mass, &springs)
        .rayleigh(0.0, random.next(0.01, 0.05))
        .build();
    for _ in 0..=random.next(0.0, 3.0) as usize {
        let dof = random.next(0.0, n as f64) as usize;
        let other = random.next(0.0, n as f64) as usize;
        let (kt, limit) = (random.next(0.05, 0.3), random.next(0.02, 0.1));
        let to = (other != dof).then_some(other);
        model.add_contact(&Contact::jenkins(dof, to, kt, 1.0, limit)).unwrap();
    }
    model.add_force(n - 1, 1, random.next(0.02, 0.1).into()).unwrap();
    model
}

/// Twelve models of a seed that was fixed before their errors were seen, ten rates relative to the square of their frequency.
#[test]
#[ignore = "takes minutes; tests/deep.sh runs it"]
fn ten_rates_of_random_models() {
    let mut random = Random(20_261_128);
    let mut folded = 0;
    for number in 0..12 {
        let model = random_model(&mut random);
        let solver = at_dof(model.ndof() - 1, harmonics(15));
        let range = amplitude_range(-3.0, 2.5);
        let branch = nonlinear_mode(&model, &solver, &range, &mut Hooks::default()).unwrap();
        let (low, high) = branch
            .omega()
            .iter()
            .fold((f64::INFINITY, 0.0_f64), |(low, high), &w| (low.min(w), high.max(w)));
        let rates: Vec<f64> = RATES.iter().map(|rate| rate * high * high).collect();
        let name = format!("model {number} of {} masses", model.ndof());
        if branch.status() != Status::Ok {
            // The mode of one model has a fold in its amplitude, beyond which no run-up is followed by it.
            let options = RunUpOptions {
                omega_start: 0.8 * low,
                omega_stop: 1.2 * high,
                rate: rates[0],
                ..RunUpOptions::default()
            };
            let refusal = run_up(&branch, &model, &options, &Interrupt::none()).unwrap_err();
            assert!(refusal.to_string().contains("the mode turns back"), "{name}: {refusal}");
            folded += 1;
            continue;
        }
        // The slow flow alone is told, not bounded, here.
        check_random(&name, (&model, &branch), (0.8 * low, 1.2 * high), &rates);
    }
    assert!(folded <= 1);
}

fn check_random(name: &str, of: (&Model, &Branch), (low, high): (f64, f64), rates: &[f64]) {
    let mut missed = 0;
    for &rate in rates {
        for ends in [(low, high), (high, low)] {
            let one = compared(of, ends, (rate, RunUpOptions::default().integrated_turns));
            let bounded = one.error.abs() <= one.found.error;
            missed += usize::from(!bounded);
            println!(
                "{name} {rate:.1e} from {:.2}: error {:+.2e}, told {:.2e}, slow flow alone {:+.2e}, {} of {} turns integrated{}",
                ends.0,
                one.error,
                one.found.error,
                one.slow_flow,
                one.found.integrated,
                one.found.turns.len(),
                if bounded { "" } else { " NOT BOUNDED" }
            );
        }
    }
    assert_eq!(
        missed,
        0,
        "{name}: {missed} of {} errors are larger than told",
        2 * rates.len()
    );
}

/// Sliders that rest at the begin of a run-up downwards keep their places there until the resonance moves them: leads begin with them.
#[test]
fn leads_keep_the_places_of_sliders_that_rest_before() {
    let mut random = Random(20_261_128);
    let model = (0..9).map(|_| random_model(&mut random)).last().unwrap();
    let solver = at_dof(1, harmonics(15));
    let range = amplitude_range(-3.0, 1.0);
    let branch = nonlinear_mode(&model, &solver, &range, &mut Hooks::default()).unwrap();
    // Without the places the error is ten times what was told.
    check_random("three sliders", (&model, &branch), (0.665, 1.147), &[1.83e-4]);
}

/// The memory of a slider is an effect of the first order: with it the error is much less than without.
#[test]
fn memory_of_the_slider_takes_the_first_order_away() {
    let model = rubbing_mass(0.12);
    let branch = mode(&model, 9);
    let one = compared((&model, &branch), (0.8, 1.3), (3e-4, 10_000));
    let without = one.found.without_memory * (1.0 + one.slow_flow) / one.found.slow_flow - 1.0;
    assert!(
        one.slow_flow.abs() < 3e-4 && without.abs() > 3e-3,
        "{:.2e} {without:.2e}",
        one.slow_flow
    );
}

/// Two or four equal masses on springs with sliders, forced at one mass; damping as 0.02 of the stiffness.
fn equal_masses(stiffness: &[f64], contacts: &[Contact], (dof, force): (usize, f64)) -> Model {
    let n = stiffness.len().isqrt();
    let mut mass = vec![0.0; n * n];
    mass.iter_mut().step_by(n + 1).for_each(|m| *m = 1.0);
    let mut model = Model::new(n).unwrap();
    model
        .set_matrix(MatrixKind::Mass, &MatrixView::dense(n, &mass))
        .unwrap();
    model
        .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(n, stiffness))
        .unwrap();
    model.set_rayleigh(0.0, 0.02).unwrap();
    for contact in contacts {
        model.add_contact(contact).unwrap();
    }
    model.add_force(dof, 1, force.into()).unwrap();
    model
}

/// Without the memory a slow run-up is that with it, at each degree of freedom, and a passage of a Campbell diagram, which has the
/// fundamental of the mode alone: other modes of several masses move the sliders, which is no memory.
#[test]
fn without_memory_is_near_the_slow_flow_of_several_masses() {
    let two = equal_masses(
        &[2.0, -1.0, -1.0, 1.0],
        &[Contact::jenkins(0, None, 0.7, 1.0, 0.05)],
        (0, 0.25),
    );
    let k = [
        2.0, -1.0, 0.0, 0.0, -1.0, 2.0, -1.0, 0.0, 0.0, -1.0, 2.0, -1.0, 0.0, 0.0, -1.0, 1.0,
    ];
    let sliders = [
        Contact::jenkins(1, None, 0.6, 1.0, 0.05),
        Contact::jenkins(3, Some(2), 0.5, 1.0, 0.04),
    ];
    let four = equal_masses(&k, &sliders, (3, 0.02));
    // The last number is what the other modes are worth: they stick in the slow flow, and follow the mode's shape without the memory.
    for (name, model, (start, stop), modal, allowed) in [
        ("two masses", two, (0.5, 0.8), 1.8, 5e-3),
        ("one slider of three masses", chain(0.06, 1), (0.5, 1.0), 0.8, 5e-3),
        ("three sliders of three masses", chain(0.05, 3), (0.5, 1.0), 0.8, 5e-3),
        ("four masses", four, (0.25, 0.55), 0.2, 2e-2),
    ] {
        let last = model.ndof() - 1;
        let solver = SolverOptions {
            harmonics: 5,
            response_dof: Some(last),
            tolerance: 0.0,
            ..SolverOptions::default()
        };
        let range = ModeOptions {
            log10_start: -2.0,
            log10_stop: modal,
            ..ModeOptions::default()
        };
        let branch = nonlinear_mode(&model, &solver, &range, &mut Hooks::default()).unwrap();
        let rate = 1e-4;
        for dof in 0..=last {
            let options = RunUpOptions {
                omega_start: start,
                omega_stop: stop,
                rate,
                dof: Some(dof),
                integrated_turns: 0,
                ..RunUpOptions::default()
            };
            let found = run_up(&branch, &model, &options, &Interrupt::none()).unwrap();
            let ratio = found.without_memory / found.slow_flow;
            println!("{name}, {dof}: {ratio}");
            assert!((ratio - 1.0).abs() < allowed, "{name}, {dof}: {ratio}");
            assert!((found.largest - found.slow_flow).abs() < f64::EPSILON);
            if dof == last {
                let passage = hbvib::CampbellResponseOptions {
                    force_factors: &[1.0],
                    engine_order: 1.0,
                    acceleration: rate,
                    ..hbvib::CampbellResponseOptions::default()
                };
                let passed = hbvib::campbell_response(&branch, &model, &passage, &Interrupt::none()).unwrap()[0].passed;
                println!("{name}: {} and {passed} of a passage", found.without_memory);
                // Harmonics and the other modes, which the passage leaves out.
                assert!((found.without_memory / passed - 1.0).abs() < 1.5e-2, "{name}: {passed}");
            }
        }
    }
}

#[test]
fn bad_run_ups_are_refused() {
    let model = rubbing_mass(0.05);
    let branch = mode(&model, 1);
    let options = RunUpOptions {
        omega_start: 0.9,
        omega_stop: 1.1,
        rate: 1e-2,
        ..RunUpOptions::default()
    };
    let refused = |model: &Model, options: RunUpOptions, status: Status, words: &str| {
        let error = run_up(&branch, model, &options, &Interrupt::none()).unwrap_err();
        assert_eq!(error.status, status, "{error}");
        assert!(error.to_string().contains(words), "{error}");
    };
    let at = |rate: f64| RunUpOptions { rate, ..options };
    refused(&model, at(0.0), Status::Argument, "rate = 0");
    refused(&model, at(1e-12), Status::Argument, "turns");
    for (rate, word) in [(1e300, "rate = 1e300"), (1e-300, "rate = 1e-300")] {
        refused(&model, at(rate), Status::Argument, word);
        let error = run_up(&branch, &model, &at(rate), &Interrupt::none()).unwrap_err();
        assert!(error.to_string().len() < 200, "{error}");
    }
    let one_place = RunUpOptions {
        omega_stop: 0.9,
        ..options
    };
    refused(&model, one_place, Status::Argument, "omega_start = omega_stop = 0.9");
    refused(&model, at(f64::NAN), Status::NotFinite, "rate");
    refused(
        &model,
        RunUpOptions {
            dof: Some(1),
            ..options
        },
        Status::Index,
        "dof = 1",
    );
    refused(&rubbing_mass(9.0), at(1e-4), Status::Argument, "larger amplitude");
    let mut quiet = rubbing_mass(0.05);
    quiet.clear_forces();
    refused(&quiet, options, Status::Argument, "no force");
    let stopped = || true;
    let interrupt = Interrupt::new(Some(&stopped), None);
    let error = run_up(&branch, &model, &options, &interrupt).unwrap_err();
    assert_eq!(error.status, Status::StoppedByCaller);
}

/// A run-up that ends short of the resonance of the stuck structure, whose slow flow is largest at a place where the motion is not: the
/// largest displacement is that of all turns.
#[test]
fn a_false_place_of_the_slow_flow_is_not_that_of_the_result() {
    for (kt, range, rate) in [(1.0, (0.6, 1.372), 1e-3), (2.0, (1.68, 0.6), 1e-3)] {
        let model = oscillator(1.0, 1.0)
            .damping(&[0.002])
            .slider(0, kt, 0.5, 1.0)
            .force(0, 1, 0.003)
            .build();
        let all = compared((&model, &mode(&model, 5)), range, (rate, 10_000));
        println!(
            "{:e} off, {:e} told, {} turns",
            all.error, all.found.error, all.found.integrated
        );
        assert!(all.error <= all.found.error, "{} {}", all.error, all.found.error);
    }
}

/// A damping ratio that is added to that of the mode acts as viscous damping 2dω₀ of the mode: of the linear oscillator, whose natural
/// frequency stays, the run-up is that with this damping.
#[test]
fn an_added_damping_ratio_is_that_of_the_mode() {
    let with = |damping: f64| {
        let mut model = oscillator(1.0, 1.0).damping(&[damping]).build();
        // Never slips: the natural frequency is that of both springs.
        model.add_contact(&Contact::jenkins(0, None, 0.44, 1.0, 1e6)).unwrap();
        model.add_force(0, 1, 0.05.into()).unwrap();
        model
    };
    let (light, damped) = (with(0.02), with(0.02 + 2.0 * 0.03 * 1.2));
    let options = RunUpOptions {
        omega_start: 1.0,
        omega_stop: 1.4,
        rate: 1e-3,
        synthesis: hbvib::SynthesisOptions {
            damping_ratio: 0.03,
            ..hbvib::SynthesisOptions::default()
        },
        ..RunUpOptions::default()
    };
    let found = run_up(&mode(&light, 3), &light, &options, &Interrupt::none()).unwrap();
    let truth = sweep(
        &damped,
        &SweepOptions {
            omega_start: 1.0,
            omega_stop: 1.4,
            rate: 1e-3,
            ..SweepOptions::default()
        },
        &mut Hooks::default(),
    )
    .unwrap();
    println!("{} {}", found.largest, truth.largest);
    assert!(
        (found.largest / truth.largest - 1.0).abs() < 1e-4,
        "{} {}",
        found.largest,
        truth.largest
    );
}

/// A displacement by a constant force is in the largest displacement and in that of the steady resonance: a slow run-up reaches it, not more. So
/// it does at a degree of freedom that is not that of the mode.
#[test]
fn a_slow_run_up_reaches_the_steady_displacement() {
    let mut pressed = rubbing_mass(0.05);
    pressed.add_force(0, 0, 0.4.into()).unwrap();
    let run = |model: &Model, range: (f64, f64), dof: Option<usize>| {
        let options = RunUpOptions {
            omega_start: range.0,
            omega_stop: range.1,
            rate: 5e-5,
            dof,
            ..RunUpOptions::default()
        };
        run_up(&mode(model, 9), model, &options, &Interrupt::none()).unwrap()
    };
    let chain = chain(0.03, 1);
    for (name, found) in [
        ("one mass", run(&rubbing_mass(0.05), (0.95, 1.2), None)),
        ("pressed", run(&pressed, (0.95, 1.2), None)),
        ("another degree of freedom", run(&chain, (0.7, 0.85), Some(0))),
    ] {
        println!("{name}: {} of {}", found.largest, found.steady);
        assert!((found.factor() - 1.0).abs() < 1e-2, "{name}: {}", found.factor());
    }
}
