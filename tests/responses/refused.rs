//! Responses that make no sense are refused by a sentence that names them.

use crate::common::chains::chain;
use crate::common::{at_dof, omega_range};
use hbvib::{Component, ForcedOptions, Hooks, Measure, Response, SolverOptions, forced_response};

#[test]
fn what_makes_no_sense_is_refused() {
    let model = chain(4, 0.0);
    let gauge = Response {
        dofs: &[1, 2],
        ..Response::default()
    };
    let cases = [
        (
            Response { dofs: &[4], ..gauge },
            "responses[0]: dofs has 4, needs 0 .. 3",
        ),
        (
            Response {
                weights: &[1.0],
                ..gauge
            },
            "responses[0]: weights has 1 numbers",
        ),
        (
            Response {
                weights: &[1.0, f64::NAN],
                ..gauge
            },
            "responses[0]: weights has NaN",
        ),
        (
            Response {
                weights: &[0.0, 0.0],
                ..gauge
            },
            "responses[0]: weights are all 0",
        ),
        (
            Response { sector: 1, ..gauge },
            "responses[0]: sector = 1, needs 0 .. 0",
        ),
        (
            Response {
                measure: Measure::Harmonic(0),
                component: Component::Velocity,
                ..gauge
            },
            "responses[0]: harmonic = 0, the mean, has no velocity",
        ),
    ];
    for (response, text) in cases {
        let responses = [response];
        let range = ForcedOptions {
            responses: &responses,
            ..omega_range(0.5, 0.6)
        };
        let e = forced_response(&model, &SolverOptions::default(), &range, &mut Hooks::default()).unwrap_err();
        assert!(e.to_string().contains(text), "{e}");
    }
    let responses = [Response {
        dofs: &[1],
        ..Response::default()
    }];
    let range = ForcedOptions {
        responses: &responses,
        ..omega_range(0.5, 0.6)
    };
    let solver = at_dof(2, SolverOptions::default());
    let e = forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap_err();
    assert!(
        e.to_string()
            .contains("response_dof = 2, but the first of the responses is that of 1"),
        "{e}"
    );
}
