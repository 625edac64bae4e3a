//! Damping of few directions beside αM + βK, dashpots and ratios of some modes: sums over modes, poles and bases respond as the factors of
//! single frequencies do, on both sides of each size at which the way changes, at first, last and requested points.

use crate::common::{at_dof, models, omega_range};
use crate::reduced_structures::{plate, point};
use hbvib::internals::FlexibilityWay::Modes;
use hbvib::{Flexibility, ForcedOptions, Hooks, MatrixKind, MatrixView, Model, SolverOptions, Speed, forced_response};

/// Damping of a plate.
#[derive(Clone, Copy, Debug)]
enum Damping {
    /// 0.02 K and dashpots at 3, at 40 and between 7 and 55.
    Dashpots,
    /// Ratios of the lowest 12 modes beside 0.02 K.
    Modes,
    /// 0.02 K, a force along a velocity at 11 and one of 20 by that of 90, which is no product L Lᴴ.
    Coupled,
    /// A dashpot of its own on each degree of freedom.
    Everywhere,
    /// None that couples modes but gyroscopic forces.
    Gyroscopic,
}

/// A damping of the i-th degree of freedom that is no multiple of its mass or stiffness.
fn dashpot(i: usize) -> f64 {
    1e-3 * (1 + 7 * i % 11) as f64
}

fn damped(side: usize, damping: Damping) -> Model {
    let mut model = plate(side, 3);
    let n = side * side;
    let mut c = vec![0.0; n * n];
    let mut add = |i: usize, j: usize, value: f64| c[j * n + i] += value;
    match damping {
        Damping::Dashpots => {
            add(3, 3, 0.3);
            add(40, 40, 0.2);
            for (i, j, sign) in [(7, 7, 1.0), (55, 55, 1.0), (7, 55, -1.0), (55, 7, -1.0)] {
                add(i, j, 0.4 * sign);
            }
        }
        Damping::Coupled => {
            add(11, 11, -0.01);
            add(20, 90, 0.05);
            add(90, 20, 0.05);
        }
        Damping::Gyroscopic => {}
        Damping::Everywhere => (0..n).for_each(|i| add(i, i, dashpot(i))),
        Damping::Modes => {
            let ratios: Vec<f64> = (0..12).map(|r| 0.01 + 0.002 * f64::from(r)).collect();
            model.set_modal_damping(&ratios).unwrap();
            return model;
        }
    }
    model
        .set_matrix(MatrixKind::Damping, &MatrixView::dense(n, &c))
        .unwrap();
    model
}

/// Compares the points of a sweep, with single frequencies by factors.
fn compare(side: usize, damping: Damping, solver: &SolverOptions) {
    compare_within(
        &damped(side, damping),
        [0.15, 0.163, 0.19, 0.2],
        solver,
        (side, damping),
    );
}

/// Compares points as above, from the first to the last of four frequencies, with the others requested.
fn compare_within(
    model: &Model,
    [low, at @ .., high]: [f64; 4],
    solver: &SolverOptions,
    (side, damping): (usize, Damping),
) {
    let range = ForcedOptions {
        at: &at,
        ..omega_range(low, high)
    };
    let branch = forced_response(model, solver, &range, &mut Hooks::default()).unwrap();
    let reduction = branch.reduction();
    let limit = 1e-10 + reduction.certificate;
    let mut points = vec![0, branch.points() - 1];
    points.extend((0..at.len()).map(|i| branch.at(i)[0].point));
    let direct = SolverOptions {
        flexibility: Flexibility::Direct,
        ..*solver
    };
    for at in points {
        let omega = branch.omega_at(at).unwrap();
        let (found, alone) = (branch.response_at(at).unwrap()[0], point(model, &direct, omega));
        let alone = alone.response_at(0).unwrap()[0];
        assert!(
            (found - alone).norm() < limit * alone.norm(),
            "{side}, {damping:?}, {omega}: {found} for {alone}"
        );
    }
}

fn fixed(harmonics: usize) -> SolverOptions {
    at_dof(89, crate::common::harmonics(harmonics))
}

#[test]
fn dampers_of_few_directions_respond_as_by_factors() {
    for damping in [Damping::Dashpots, Damping::Modes, Damping::Coupled] {
        compare(10, damping, &fixed(3));
        compare(22, damping, &fixed(5));
        compare(26, damping, &fixed(1));
    }
}

/// Poles, factors and bases of samples.
#[test]
fn a_dashpot_on_each_mass_responds_as_by_factors() {
    for side in [10, 20, 22, 26] {
        compare(side, Damping::Everywhere, &fixed(3));
    }
    for n in [450, 610, 1100] {
        let mut c = vec![0.0; n * n];
        (0..n).for_each(|i| c[i * n + i] = dashpot(i));
        let lowest = std::f64::consts::PI / (n + 1) as f64;
        let model = models::unit_chain(n)
            .damping(&c)
            .slider(200, 1.0, 0.9, 1.0)
            .force(n / 3, 1, 0.1)
            .build();
        let frequencies = [0.8, 1.3, 2.0, 3.4].map(|factor| factor * lowest);
        compare_within(&model, frequencies, &fixed(3), (n, Damping::Everywhere));
    }
}

/// With a tolerance all modes are summed, so that estimates have them, where all poles take longer than factors or lose digits.
#[test]
fn dampers_of_few_directions_have_sums_for_estimates() {
    for (side, damping) in [
        (21, Damping::Modes),
        (21, Damping::Dashpots),
        (22, Damping::Dashpots),
        (25, Damping::Modes),
    ] {
        let model = damped(side, damping);
        let solver = SolverOptions {
            tolerance: 1e-2,
            response_dof: Some(89),
            ..SolverOptions::default()
        };
        let range = omega_range(0.15, 0.2);
        let branch = forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap();
        assert_eq!(branch.reduction().flexibility_way, Modes, "{side}");
        let last = branch.points() - 1;
        let direct = SolverOptions {
            flexibility: Flexibility::Direct,
            ..solver
        };
        let alone = point(&model, &direct, branch.omega_at(last).unwrap());
        let (found, alone) = (branch.response_at(last).unwrap()[0], alone.response_at(0).unwrap()[0]);
        assert!(
            (found - alone).norm() < 2e-2 * alone.norm(),
            "{side}: {found} for {alone}"
        );
    }
}

/// Gyroscopic forces on a chain, whose waves travel with other speeds than without: bases of samples, between their frequencies and at
/// the resonances of the first and the third harmonic.
#[test]
fn gyroscopic_forces_respond_as_by_factors() {
    for (n, flexibility) in [
        (33, Flexibility::Krylov),
        (101, Flexibility::Krylov),
        (200, Flexibility::Krylov),
        (610, Flexibility::Automatic),
        (1400, Flexibility::Automatic),
    ] {
        let mut g = vec![0.0; n * n];
        for i in 1..n {
            (g[i * n + i - 1], g[(i - 1) * n + i]) = (0.02, -0.02);
        }
        let lowest = std::f64::consts::PI / (n + 1) as f64;
        let mut model = models::unit_chain(n)
            .rayleigh(0.02 * lowest, 0.0)
            .slider(n / 2, 1.0, 0.9, 1.0)
            .force(n / 3, 1, 0.1)
            .build();
        model
            .set_matrix(MatrixKind::Gyroscopic, &MatrixView::dense(n, &g))
            .unwrap();
        model.set_speed(Speed::Fixed(1.0)).unwrap();
        let solver = SolverOptions {
            flexibility,
            ..at_dof(n / 4, crate::common::harmonics(3))
        };
        let frequencies = [0.8, 1.02, 1.97, 3.4].map(|factor| factor * lowest);
        compare_within(&model, frequencies, &solver, (n, Damping::Gyroscopic));
    }
}
