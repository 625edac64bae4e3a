//! Run-ups by the slow flow of a nonlinear mode, against integration in time.

use hbvib::{
    Branch, Contact, Hooks, Interrupt, MatrixKind, MatrixView, ModeOptions, Model, RunUp, RunUpOptions, SolverOptions,
    Status, SweepOptions, nonlinear_mode, run_up, sweep,
};

fn oscillator(force: f64) -> Model {
    let mut model = Model::new(1).unwrap();
    for (which, value) in [
        (MatrixKind::Mass, 1.0),
        (MatrixKind::Stiffness, 1.0),
        (MatrixKind::Damping, 0.02),
    ] {
        model.set_matrix(which, &MatrixView::dense(1, &[value])).unwrap();
    }
    model.add_contact(&Contact::jenkins(0, None, 0.2, 0.1, 1.0)).unwrap();
    model.add_force(0, 1, force.into()).unwrap();
    model
}

/// Three masses on springs with one to three sliders.
fn chain(force: f64, contacts: usize) -> Model {
    let mut model = Model::new(3).unwrap();
    let m = [1.0, 0.0, 0.0, 0.0, 1.2, 0.0, 0.0, 0.0, 0.8];
    let k = [3.0, -1.0, 0.0, -1.0, 2.0, -1.0, 0.0, -1.0, 1.5];
    model.set_matrix(MatrixKind::Mass, &MatrixView::dense(3, &m)).unwrap();
    model
        .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(3, &k))
        .unwrap();
    model.set_rayleigh(0.0, 0.02).unwrap();
    let all = [
        Contact::jenkins(2, None, 0.2, 0.1, 1.0),
        Contact::jenkins(1, Some(0), 0.3, 0.1, 0.5),
        Contact::jenkins(1, None, 0.1, 0.1, 0.3),
    ];
    for contact in &all[..contacts] {
        model.add_contact(contact).unwrap();
    }
    model.add_force(2, 1, force.into()).unwrap();
    model
}

fn mode(model: &Model, harmonics: usize) -> Branch {
    let solver = SolverOptions {
        harmonics,
        response_dof: Some(model.ndof() - 1),
        tolerance: 0.0,
        ..SolverOptions::default()
    };
    let range = ModeOptions {
        log10_start: -2.0,
        log10_stop: 0.8,
        ..ModeOptions::default()
    };
    nonlinear_mode(model, &solver, &range, &mut Hooks::default()).unwrap()
}

/// The run-up and its relative error.
fn compared(model: &Model, branch: &Branch, (omega_start, omega_stop): (f64, f64), rate: f64) -> (RunUp, f64) {
    let options = RunUpOptions {
        omega_start,
        omega_stop,
        rate,
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
    let error = found.largest / truth.largest - 1.0;
    (found, error)
}

/// Checks rates in both directions: the error told bounds the true one, which is small where the rate is.
fn check(name: &str, model: &Model, harmonics: usize, range: (f64, f64), rates: &[f64]) {
    let branch = mode(model, harmonics);
    for &rate in rates {
        for ends in [range, (range.1, range.0)] {
            let (found, error) = compared(model, &branch, ends, rate);
            println!(
                "{name} {rate:e} from {}: error {error:+.2e}, told {:.2e}, without memory {:+.2e}",
                ends.0,
                found.error,
                found.without_memory / found.largest - 1.0
            );
            assert!(
                error.abs() <= found.error,
                "{name} {rate:e} from {}: error {error:.2e}, told {:.2e}",
                ends.0,
                found.error
            );
            if rate <= 1e-4 {
                assert!(error.abs() < 3e-3, "{name} {rate:e}: {error:.2e}");
            }
        }
    }
}

#[test]
fn the_error_told_bounds_that_of_one_slider() {
    check("one slider", &oscillator(0.05), 9, (0.85, 1.3), &[2e-3]);
    check("much slip", &oscillator(0.12), 9, (0.8, 1.3), &[1e-2, 1e-3, 1e-4]);
}

#[test]
fn the_error_told_bounds_that_of_a_chain() {
    check("one slider of a chain", &chain(0.03, 1), 5, (0.5, 1.0), &[1e-2, 1e-3]);
    check("three sliders", &chain(0.05, 3), 5, (0.5, 1.0), &[2e-3]);
}

/// Ten rates, in both directions.
#[test]
#[ignore = "takes minutes; tests/deep.sh runs it"]
fn ten_rates_of_one_to_three_sliders() {
    let rates = [1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5];
    check("one slider", &oscillator(0.05), 15, (0.85, 1.3), &rates);
    check("much slip", &oscillator(0.12), 15, (0.8, 1.3), &rates);
    check("one slider of a chain", &chain(0.03, 1), 15, (0.5, 1.0), &rates);
    check("much slip of a chain", &chain(0.06, 1), 15, (0.5, 1.0), &rates);
    check("two sliders", &chain(0.04, 2), 15, (0.5, 1.0), &rates);
    check("three sliders", &chain(0.05, 3), 15, (0.5, 1.0), &rates);
}

/// The memory of a slider is an effect of the first order: with it the error is much less than without.
#[test]
fn memory_of_the_slider_takes_the_first_order_away() {
    let model = oscillator(0.12);
    let branch = mode(&model, 9);
    let (found, error) = compared(&model, &branch, (0.8, 1.3), 3e-4);
    let without = found.without_memory * (1.0 + error) / found.largest - 1.0;
    assert!(error.abs() < 3e-4 && without.abs() > 3e-3, "{error:.2e} {without:.2e}");
}

#[test]
fn bad_run_ups_are_refused() {
    let model = oscillator(0.05);
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
    refused(&oscillator(9.0), at(1e-4), Status::Argument, "larger amplitude");
    let mut quiet = oscillator(0.05);
    quiet.clear_forces();
    refused(&quiet, options, Status::Argument, "no force");
    let stopped = || true;
    let interrupt = Interrupt::new(Some(&stopped), None);
    let error = run_up(&branch, &model, &options, &interrupt).unwrap_err();
    assert_eq!(error.status, Status::StoppedByCaller);
}
