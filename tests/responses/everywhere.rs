//! The same responses beside forced responses: read from modes and curves over a parameter, followed over a parameter, in batches and
//! in time, and several in one norm.

use crate::common::chains::{chain, chain_with, duffing};
use crate::common::{amplitude_range, omega_range};
use hbvib::{
    BatchOptions, Branch, Component, Constant, Follow, ForcedOptions, Hooks, Measure, Model, Parameter, ParameterRange,
    Response, SolverOptions, Status, VerifyOptions, batch, forced_response, nonlinear_mode, parameter_response,
    response_of, verify,
};
use num_complex::Complex64;

const KT: Parameter<'static> = Parameter::Contact {
    constant: Constant::Kt,
    contact: Some(0),
};

const MEASURES: [Measure; 5] = [
    Measure::Fundamental,
    Measure::Harmonic(3),
    Measure::Peak,
    Measure::Rms,
    Measure::Range,
];

fn of(measure: Measure, component: Component) -> Response<'static> {
    Response {
        measure,
        dofs: &[1, 3],
        weights: &[1.0, -0.5],
        component,
        ..Response::default()
    }
}

fn all() -> Vec<Response<'static>> {
    let components = [Component::Displacement, Component::Velocity, Component::Acceleration];
    let pairs = MEASURES.iter().flat_map(|m| components.map(|c| of(*m, c)));
    pairs.collect()
}

fn exactly(harmonics: usize) -> SolverOptions {
    crate::common::harmonics(harmonics)
}

fn sweep(model: &Model, range: (f64, f64), responses: &[Response<'_>], solver: &SolverOptions) -> Branch {
    let range = ForcedOptions {
        responses,
        ..omega_range(range.0, range.1)
    };
    forced_response(model, solver, &range, &mut Hooks::default()).unwrap()
}

/// Compares what is read at all points of a branch with the same from their harmonics.
fn check_readings(branch: &Branch) {
    let responses = all();
    let read = branch.read_responses(&responses).unwrap();
    let mut x = vec![Complex64::ZERO; (branch.harmonics() + 1) * branch.ndof()];
    for point in 0..branch.stored() {
        branch.harmonics_at(point, &mut x).unwrap();
        for (read, response) in read.iter().zip(&responses) {
            let expected = response_of(response, branch.ndof(), branch.omega_at(point).unwrap(), &x).unwrap();
            let gap = (read.values()[point] - expected.value).abs();
            assert!(gap < 1e-12 * expected.value, "{response:?} at {point}: {gap:e}");
            assert_eq!(read.complex()[point].re.is_nan(), expected.complex.re.is_nan());
            assert!(read.errors()[point].is_nan() && read.peaks().is_empty());
        }
    }
}

#[test]
fn responses_of_any_branch_are_those_of_its_harmonics() {
    let model = chain(5, 0.4);
    let mode = amplitude_range(-1.5, 1.0);
    let mode = nonlinear_mode(&model, &exactly(5), &mode, &mut Hooks::default()).unwrap();
    assert!(mode.points() > 5);
    check_readings(&mode);
    let range = ParameterRange {
        start: 1.0,
        stop: 2.0,
        at: &[1.5],
        follow: Follow::Omega(0.6),
        response: None,
    };
    let curve = parameter_response(&model, &exactly(5), KT, &range, &mut Hooks::default()).unwrap();
    check_readings(&curve);
    // Those that a forced response watched are the same numbers.
    let branch = sweep(&model, (0.4, 0.9), &all(), &exactly(5));
    check_readings(&branch);
    for (read, own) in branch.read_responses(&all()).unwrap().iter().zip(branch.responses()) {
        // To the rounding of the largest.
        let most = own.values().iter().fold(0.0_f64, |most, b| most.max(*b));
        for (a, b) in read.values().iter().zip(own.values()) {
            assert!(
                (a - b).abs() < 1e-11 * b + 1e-16 * most,
                "{:?}: {a} {b}",
                own.response()
            );
        }
    }
}

/// The model with a value of its parameter, and the range that has the peak.
struct Family {
    model: fn(f64) -> Model,
    parameter: Parameter<'static>,
    range: (f64, f64),
    harmonics: usize,
}

const SLIDERS: Family = Family {
    model: |kt| chain_with(5, 0.0, [kt, 0.3, 1.0]),
    parameter: KT,
    range: (0.4, 0.7),
    harmonics: 3,
};

/// About a third of its resonance.
const SPRING: Family = Family {
    model: |force| duffing(0.06, 0.3, 0.6 * force),
    parameter: Parameter::Force,
    range: (0.3, 0.5),
    harmonics: 7,
};

#[test]
fn the_peak_of_a_response_is_followed_over_a_parameter() {
    for (family, start, stop, measure, component) in [
        (SPRING, 1.0, 1.2, Measure::Harmonic(3), Component::Displacement),
        (SPRING, 1.0, 1.2, Measure::Peak, Component::Velocity),
        (SLIDERS, 1.0, 1.5, Measure::Peak, Component::Displacement),
        (SLIDERS, 1.0, 1.5, Measure::Rms, Component::Velocity),
        (SLIDERS, 1.0, 1.5, Measure::Range, Component::Displacement),
    ] {
        let gauge = of(measure, component);
        let alone = (family.model)(start).ndof() == 1;
        let response = Response {
            dofs: if alone { &[0] } else { gauge.dofs },
            weights: if alone { &[] } else { gauge.weights },
            ..gauge
        };
        let solver = exactly(family.harmonics);
        let peak_at = |value: f64| {
            let branch = sweep(&(family.model)(value), family.range, &[response], &solver);
            let top = branch.peaks().iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
            top.map(|top| (top.omega, top.amplitude)).expect("a peak")
        };
        let at = [start + 0.2 * (stop - start), start + 0.8 * (stop - start)];
        let range = ParameterRange {
            start,
            stop,
            at: &at,
            follow: Follow::Peak(peak_at(start).0),
            response: Some(response),
        };
        // A factor on the forces is relative to the model that has it.
        let model = (family.model)(1.0);
        let found = parameter_response(&model, &solver, family.parameter, &range, &mut Hooks::default());
        let found = found.unwrap_or_else(|e| panic!("{measure:?} {component:?} from {:?}: {e}", peak_at(start)));
        assert_eq!(found.status(), Status::Ok, "{measure:?}");
        for (i, value) in at.iter().enumerate() {
            let (omega, amplitude) = peak_at(*value);
            let [one] = found.at(i) else {
                panic!("{measure:?}: {:?}", found.at(i))
            };
            assert!(
                (one.omega / omega - 1.0).abs() < 1e-6,
                "{measure:?}: {} {omega}",
                one.omega
            );
            assert!(
                (one.amplitude / amplitude - 1.0).abs() < 1e-9,
                "{measure:?}: {} {amplitude}",
                one.amplitude
            );
        }
        // The curve has its own slope at its end.
        let central = |step: f64| (peak_at(stop + step).1 - peak_at(stop - step).1) / (2.0 * step);
        let difference = (4.0 * central(2e-3) - central(4e-3)) / 3.0;
        let (told, amplitude) = (found.d_amplitude().unwrap(), found.amplitude());
        let (told, amplitude) = (told[told.len() - 1], amplitude[amplitude.len() - 1]);
        assert!(
            (told - difference).abs() < 1e-6 * (amplitude + difference.abs()),
            "{measure:?}: {told} {difference}"
        );
    }
}

#[test]
fn a_fold_followed_over_a_parameter_has_the_response_there() {
    let model = |force: f64| duffing(0.06, 0.3, 0.6 * force);
    for (measure, component) in [
        (Measure::Harmonic(3), Component::Displacement),
        (Measure::Peak, Component::Velocity),
        (Measure::Rms, Component::Acceleration),
    ] {
        let response = Response {
            dofs: &[0],
            weights: &[],
            ..of(measure, component)
        };
        let folds_at = |value: f64| {
            let branch = sweep(&model(value), (0.8, 3.0), &[response], &exactly(5));
            assert!(branch.folds().len() >= 2, "{:?}", branch.folds());
            branch
                .folds()
                .iter()
                .map(|fold| (fold.omega, fold.amplitude))
                .collect::<Vec<_>>()
        };
        for near in folds_at(1.0).into_iter().take(2) {
            let range = ParameterRange {
                start: 1.0,
                stop: 1.4,
                at: &[1.25],
                follow: Follow::Fold(near.0),
                response: Some(response),
            };
            let found = parameter_response(
                &model(1.0),
                &exactly(5),
                Parameter::Force,
                &range,
                &mut Hooks::default(),
            );
            let found = found.unwrap();
            assert_eq!(found.status(), Status::Ok, "{measure:?}");
            let first = (found.omega()[0] / near.0 - 1.0)
                .abs()
                .max((found.amplitude()[0] / near.1 - 1.0).abs());
            assert!(
                first < 1e-6,
                "{measure:?}: {near:?} {} {}",
                found.omega()[0],
                found.amplitude()[0]
            );
            let [one] = found.at(0) else {
                panic!("{measure:?}: {:?}", found.at(0))
            };
            let off = |fold: &(f64, f64)| (fold.0 / one.omega - 1.0).abs();
            let folds = folds_at(1.25);
            let nearest = folds.iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
            assert!(off(nearest) < 1e-8, "{measure:?}: {} {nearest:?}", one.omega);
            assert!(
                (one.amplitude / nearest.1 - 1.0).abs() < 1e-6,
                "{measure:?}: {} {nearest:?}",
                one.amplitude
            );
        }
    }
}

#[test]
fn a_response_over_a_parameter_meets_the_tolerance() {
    let response = of(Measure::Peak, Component::Acceleration);
    let range = ParameterRange {
        start: 1.0,
        stop: 1.2,
        at: &[],
        follow: Follow::Omega(0.6),
        response: Some(response),
    };
    let solver = SolverOptions {
        tolerance: 1e-2,
        ..SolverOptions::default()
    };
    let model = chain_with(5, 0.0, [1.0, 0.3, 1.0]);
    let found = parameter_response(&model, &solver, KT, &range, &mut Hooks::default()).unwrap();
    assert_eq!(found.status(), Status::Ok);
    for (kt, amplitude) in found.parameter().unwrap().iter().zip(found.amplitude()) {
        let exact = sweep(
            &chain_with(5, 0.0, [*kt, 0.3, 1.0]),
            (0.6, 0.6),
            &[response],
            &exactly(151),
        );
        let error = (amplitude / exact.amplitude()[0] - 1.0).abs();
        assert!(error < 1e-2, "{kt}: {error:e}");
    }
}

#[test]
fn a_batch_has_the_peaks_of_each_response() {
    let responses = [
        of(Measure::Rms, Component::Velocity),
        of(Measure::Harmonic(3), Component::Displacement),
    ];
    let options = BatchOptions {
        omega_start: 0.3,
        omega_stop: 0.9,
        threads: 2,
        responses: &responses,
        ..BatchOptions::default()
    };
    let values = [1.0, 1.3, 1.7];
    let model = chain(5, 0.0);
    let found = batch(&model, &exactly(3), &options, (&[KT], &values), &mut Hooks::default()).unwrap();
    assert_eq!(found.responses(), 2);
    for (peak, kt) in found.peaks().iter().zip(values) {
        let branch = sweep(&chain_with(5, 0.0, [kt, 0.3, 1.0]), (0.3, 0.9), &responses, &exactly(3));
        for (r, (amplitude, omega)) in peak.responses.iter().enumerate() {
            let peaks = branch.responses()[r].peaks().iter();
            let top = peaks.max_by(|a, b| a.amplitude.total_cmp(&b.amplitude)).unwrap();
            assert!((amplitude / top.amplitude - 1.0).abs() < 1e-12);
            assert!((omega / top.omega - 1.0).abs() < 1e-9);
        }
        assert_eq!(peak.responses[0].0.to_bits(), peak.amplitude.to_bits());
    }
}

#[test]
fn the_responses_of_a_point_are_verified_in_time() {
    // A smooth law: 25 harmonics are the whole motion.
    let model = duffing(0.06, 0.3, 0.6);
    let responses: Vec<Response<'_>> = all()
        .into_iter()
        .map(|one| Response {
            dofs: &[0],
            weights: &[],
            ..one
        })
        .collect();
    let branch = sweep(&model, (0.4, 0.4), &responses, &exactly(25));
    let found = verify(&model, &branch, 0, &VerifyOptions::default(), &mut Hooks::default()).unwrap();
    for (own, time) in branch.responses().iter().zip(&found.responses) {
        assert!(time.error < 1e-8, "{:?}: {:e}", own.response(), time.error);
        assert!((time.value / own.values()[0] - 1.0).abs() < 1e-8);
    }
    let worst = found.worst_response().unwrap();
    assert!(found.responses.iter().all(|of| of.error <= worst.1));
    // Three harmonics are not, and the third says so first.
    let coarse = sweep(&model, (0.4, 0.4), &responses, &exactly(3));
    let found = verify(&model, &coarse, 0, &VerifyOptions::default(), &mut Hooks::default()).unwrap();
    assert!(found.worst_response().unwrap().1 > 1e-3);
}

#[test]
fn one_norm_of_all_responses_meets_the_tolerance() {
    let dofs: Vec<[usize; 1]> = (0..6).map(|dof| [dof]).collect();
    let responses: Vec<_> = dofs
        .iter()
        .map(|dofs| Response {
            measure: Measure::Rms,
            dofs,
            component: Component::Acceleration,
            ..Response::default()
        })
        .collect();
    let tolerance = 1e-2;
    let solver = SolverOptions {
        tolerance,
        ..SolverOptions::default()
    };
    let model = chain(6, 0.4);
    let mut fewer = false;
    for omega in [0.42, 0.55, 0.7, 0.9] {
        let solve = |together: bool, solver: &SolverOptions| {
            let range = ForcedOptions {
                responses: &responses,
                together,
                ..omega_range(omega, omega)
            };
            forced_response(&model, solver, &range, &mut Hooks::default()).unwrap()
        };
        let (each, found, exact) = (solve(false, &solver), solve(true, &solver), solve(false, &exactly(151)));
        assert_eq!(found.status(), Status::Ok);
        let (mut error, mut told, mut size) = (0.0_f64, 0.0_f64, 0.0_f64);
        let mut leading = (0.0, 0);
        for (r, (found, exact)) in found.responses().iter().zip(exact.responses()).enumerate() {
            let (value, exact, own) = (found.values()[0], exact.values()[0], found.errors()[0]);
            error = error.hypot(value - exact);
            told = told.hypot(own * value);
            size = size.hypot(exact);
            if own * value > leading.0 {
                leading = (own * value, r);
            }
        }
        assert!(error / size < tolerance, "{omega}: {:e}", error / size);
        let estimate = found.error_estimate()[0];
        assert!(estimate <= tolerance);
        assert!(
            (told / size / estimate - 1.0).abs() < 0.1,
            "{omega}: {} {estimate}",
            told / size
        );
        assert_eq!(found.leading_response(0), Some(leading.1));
        assert!(found.harmonics_used()[0] <= each.harmonics_used()[0]);
        fewer |= found.harmonics_used()[0] < each.harmonics_used()[0];
    }
    assert!(fewer, "one norm asks for no fewer harmonics anywhere");
}
