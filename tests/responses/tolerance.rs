//! The tolerance holds for every response: errors against solutions with many more harmonics.

use crate::common::chains::chain;
use crate::common::models::unit_chain;
use crate::common::{harmonics, omega_range};
use hbvib::{ForcedOptions, Hooks, Measure, Response, SolverOptions, forced_response};

#[test]
fn the_estimate_of_each_response_bounds_its_error() {
    let dofs: Vec<[usize; 1]> = (0..6).map(|dof| [dof]).collect();
    let mut responses = Vec::new();
    for measure in [Measure::Fundamental, Measure::Peak, Measure::Rms, Measure::Range] {
        responses.extend(dofs.iter().map(|dofs| Response {
            measure,
            dofs,
            ..Response::default()
        }));
    }
    for (preload, tolerance) in [(0.0, 1e-2), (0.0, 1e-3), (0.4, 1e-3)] {
        let model = chain(6, preload);
        for omega in [0.42, 0.55, 0.7, 0.9] {
            let solve = |solver: SolverOptions| {
                let range = ForcedOptions {
                    responses: &responses,
                    ..omega_range(omega, omega)
                };
                forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap()
            };
            let found = solve(SolverOptions {
                tolerance,
                ..SolverOptions::default()
            });
            let exact = solve(harmonics(151));
            for ((found, exact), response) in found.responses().iter().zip(exact.responses()).zip(&responses) {
                let (value, exact) = (found.values()[0], exact.values()[0]);
                let error = (value / exact - 1.0).abs();
                let told = found.errors()[0];
                assert!(told <= tolerance, "{response:?} at {omega}: told {told:e}");
                assert!(error <= tolerance, "{response:?} at {omega}: {error:e}, told {told:e}");
                assert!(
                    error <= 3.0 * told + 0.05 * tolerance,
                    "{response:?} at {omega}: {error:e}, told {told:e}"
                );
            }
        }
    }
}

/// A harmonic far above those of the fundamental: the first extension of a point with one harmonic would carry three.
#[test]
fn a_watched_harmonic_is_not_zero_because_nothing_carries_it() {
    for n in [4, 8, 12] {
        let mut built = unit_chain(n).rayleigh(0.0, 0.03);
        for dof in 0..n {
            built = built.slider(dof, 1.0, 0.3, if dof % 3 == 0 { 1.0 } else { 50.0 });
        }
        let model = built.force(0, 1, 1.0).build();
        for (h, tolerance) in [(5, 1e-1), (5, 1e-3), (7, 1e-2), (7, 1e-3)] {
            let responses = [Response {
                measure: Measure::Harmonic(h),
                ..Response::default()
            }];
            let solve = |solver: SolverOptions| {
                let range = ForcedOptions {
                    responses: &responses,
                    ..omega_range(1.0, 1.0)
                };
                forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap()
            };
            let found = solve(SolverOptions {
                tolerance,
                ..SolverOptions::default()
            });
            let (value, exact) = (
                found.responses()[0].values()[0],
                solve(harmonics(61)).responses()[0].values()[0],
            );
            assert!(exact > 1e-6, "{n}, {h}: {exact:e}");
            assert!(
                (value - exact).abs() <= tolerance * exact,
                "{n}, {h}, {tolerance:e}: {value:e} for {exact:e}"
            );
        }
    }
}
