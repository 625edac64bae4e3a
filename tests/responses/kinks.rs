//! Kinks of a response, where another instant of the period takes the lead: found, with the derivatives of both sides.

use crate::common::chains::chain;
use crate::common::{harmonics, omega_range};
use hbvib::{
    Branch, Component, ForcedOptions, Hooks, Measure, Model, Parameter, Quantity, Response, SolverOptions,
    forced_response, sensitivity,
};
use num_complex::Complex64;

/// A chain with sliders under forces in harmonics 1 and 2, whose phases move apart as a resonance is passed.
fn two_orders(factor: f64) -> Model {
    let mut model = chain(5, 0.0);
    model.add_force(0, 1, (factor - 1.0).into()).unwrap();
    model.add_force(1, 2, Complex64::new(0.3, 0.9) * factor).unwrap();
    model
}

fn solve(model: &Model, range: (f64, f64), responses: &[Response<'_>], step_max: f64) -> Branch {
    let solver = SolverOptions {
        step_max,
        ..harmonics(5)
    };
    let range = ForcedOptions {
        responses,
        ..omega_range(range.0, range.1)
    };
    forced_response(model, &solver, &range, &mut Hooks::default()).unwrap()
}

#[test]
fn a_change_of_the_leading_instant_is_told_with_both_slopes() {
    let model = two_orders(1.0);
    let mut all = 0;
    for (measure, component) in [
        (Measure::Peak, Component::Displacement),
        (Measure::Peak, Component::Velocity),
        (Measure::Range, Component::Displacement),
        (Measure::Range, Component::Acceleration),
    ] {
        let responses = [Response {
            measure,
            dofs: &[2],
            component,
            ..Response::default()
        }];
        let branch = solve(&model, (0.3, 1.6), &responses, 0.0);
        let found = &branch.responses()[0];
        // A dense sweep shows the same ones: its instants jump between neighbours.
        let fine = solve(&model, (0.3, 1.6), &responses, 2e-3);
        let places: Vec<f64> = found.kinks().map(|(before, _)| before.omega).collect();
        let same: Vec<f64> = fine.responses()[0].kinks().map(|(before, _)| before.omega).collect();
        let has = |list: &[f64], at: f64| list.iter().any(|other| (other / at - 1.0).abs() < 1e-8);
        // Each is one: the slope by differences jumps up there, whatever the search of the dense sweep found.
        for at in &places {
            let value = |by: f64| solve(&model, (at * (1.0 + by), at * (1.0 + by)), &responses, 0.0).amplitude()[0];
            let slope = |sign: f64| (value(sign * 3e-6) - value(sign * 1e-6)) / (sign * 2e-6 * at);
            let (low, high) = (slope(-1.0), slope(1.0));
            assert!(high - low > 1e-3 * (low.abs() + high.abs()), "{at}: {low} {high}");
        }
        let seen = places.iter().filter(|at| has(&same, **at)).count();
        assert!(10 * seen >= 8 * places.len(), "{places:?} {same:?}");
        // An instant that leads and loses the lead within one step is not seen.
        let step = |at: f64| branch.omega().iter().filter(|omega| **omega < at).count();
        for at in same.iter().filter(|at| !has(&places, **at)) {
            let within = same.iter().filter(|other| step(**other) == step(*at)).count();
            assert!(within % 2 == 0, "{at}: {places:?} {same:?}");
        }
        for (before, after) in found.kinks() {
            all += 1;
            let (low, high) = (found.values()[before.point], found.values()[after.point]);
            assert!((low / high - 1.0).abs() < 1e-6);
            assert!((before.omega / after.omega - 1.0).abs() < 1e-7);
            let apart = (found.instants()[before.point] - found.instants()[after.point]).abs();
            assert!(measure == Measure::Range || apart > 0.05, "{apart}");
            // On each side the derivative by the forces is that of differences of solutions on that side.
            for (side, sign) in [(before, -1.0), (after, 1.0)] {
                let omega = side.omega * (1.0 + sign * 1e-4);
                let here = solve(&model, (omega, omega), &responses, 0.0);
                let parameters = [Parameter::Force];
                let of = Quantity::Response(0);
                let told = sensitivity(&model, &here, 0, &parameters, of).unwrap().values[0];
                let own = sensitivity(&model, &branch, side.point, &parameters, of)
                    .unwrap()
                    .values[0];
                let value = |factor: f64| solve(&two_orders(factor), (omega, omega), &responses, 0.0).amplitude()[0];
                let central = |step: f64| (value(1.0 + step) - value(1.0 - step)) / (2.0 * step);
                let difference = (4.0 * central(1e-5) - central(2e-5)) / 3.0;
                assert!(
                    (told - difference).abs() < 1e-7 * (told.abs() + here.amplitude()[0]),
                    "{told} {difference}"
                );
                // The side itself has the derivative of its neighbour.
                let omega = side.omega * (1.0 + sign * 1e-6);
                let beside = solve(&model, (omega, omega), &responses, 0.0);
                let told = sensitivity(&model, &beside, 0, &parameters, of).unwrap().values[0];
                assert!(
                    (own - told).abs() < 1e-3 * (told.abs() + beside.amplitude()[0]),
                    "{own} {told}"
                );
            }
        }
    }
    assert!(all >= 2, "{all} kinks");
}

#[test]
fn a_symmetric_motion_has_no_kinks() {
    // One harmonic alone, and a slider without preload: the largest and the smallest value are images of each other.
    let responses = [Response {
        measure: Measure::Peak,
        dofs: &[2],
        ..Response::default()
    }];
    for harmonics in [false, true] {
        let mut model = chain(5, 0.0);
        if harmonics {
            // A constant force that moves nothing that is seen breaks the symmetry of the harmonics alone.
            model.add_force(4, 0, 1e-13.into()).unwrap();
        }
        let branch = solve(&model, (0.3, 1.6), &responses, 0.0);
        assert_eq!(branch.responses()[0].kinks().len(), 0);
    }
}
