//! A followed peak that vanishes, or is no longer the highest, is told; with a tolerance the optimum is that of converged
//! harmonics.

use crate::common::BASE;
use crate::design::{Design, Results, tight};
use hbvib::{
    Constant, Follow, Hooks, MatrixKind, MatrixView, Parameter, ParameterRange, Quantity, SolverOptions, Status,
    parameter_response,
};
use std::f64::consts::TAU;

/// Two masses with close natural frequencies, the second excited `force` times as strongly.
fn two_peaks(force: f64) -> Design {
    Design {
        forces: vec![(0, 1, 1.0.into()), (1, 1, force.into())],
        ..Design::plain(
            2,
            [
                vec![1.0, 0.0, 0.0, 1.0],
                vec![0.02, 0.0, 0.0, 0.02],
                vec![1.05, -0.05, -0.05, 1.05],
            ],
        )
    }
}

fn range(ends: (f64, f64), follow: Follow) -> ParameterRange<'static> {
    ParameterRange {
        start: ends.0,
        stop: ends.1,
        at: &[],
        follow,
        response: None,
    }
}

#[test]
fn peak_that_meets_a_minimum_has_its_status() {
    let design = two_peaks(0.0);
    let damping = Parameter::Factor {
        which: MatrixKind::Damping,
    };
    let model = design.model();
    let follow = range((1.0, 8.0), Follow::Peak(1.05));
    let found = parameter_response(&model, &tight(1), damping, &follow, &mut Hooks::default()).unwrap();
    assert_eq!(found.status(), Status::StoppedPeakVanished, "{:?}", found.parameter());
    let last = *found.parameter().unwrap().last().unwrap();
    let peaks = |factor: f64| {
        let mut other = design.clone();
        for c in &mut other.matrices[1] {
            *c *= factor;
        }
        let range = hbvib::ForcedOptions {
            omega_start: 0.94,
            omega_stop: 1.15,
            ..Default::default()
        };
        let branch = hbvib::forced_response(&other.model(), &tight(1), &range, &mut Hooks::default()).unwrap();
        branch.peaks().len()
    };
    println!("vanished after {last}");
    assert_eq!((peaks(0.98 * last), peaks(1.3 * last)), (2, 1));
    assert!(last > 2.0 && last < 5.0);
}

#[test]
fn higher_peak_is_told() {
    let design = two_peaks(0.9);
    // More mass on the second degree of freedom changes which of the peaks is higher.
    let added = [0.0, 0.0, 0.0, 1.0];
    let mass = Parameter::Direction {
        which: MatrixKind::Mass,
        direction: MatrixView::dense(2, &added),
    };
    let solver = tight(1);
    let model = design.model();
    for near in [1.0, 1.05] {
        let follow = range((-0.15, 0.15), Follow::Peak(near));
        let found = parameter_response(&model, &solver, mass, &follow, &mut Hooks::default()).unwrap();
        println!("{near}: {:?} {:?}", found.status(), found.higher_peaks());
        for point in [0, found.points() - 1] {
            let (p, amplitude) = (found.parameter().unwrap()[point], found.amplitude()[point]);
            let mut other = design.clone();
            other.matrices[0][3] += p;
            let (_, _, highest) = Results::Peak(0.8, 1.3).solve(&other.model(), &solver);
            assert_eq!(highest[0].0, Quantity::PeakAmplitude);
            let told = found.higher_peaks().iter().find(|peak| peak.point == point);
            if highest[0].1 > 1.0001 * amplitude {
                let told = told.unwrap();
                assert!((told.amplitude / highest[0].1 - 1.0).abs() < 1e-8);
                assert_eq!(told.parameter.to_bits(), p.to_bits());
            } else {
                assert!(told.is_none(), "{told:?}");
            }
        }
    }
}

#[test]
fn with_a_tolerance_the_optimum_is_that_of_converged_harmonics() {
    let model = Design::ring_damper(&BASE, 300.0).model();
    let preload = Parameter::Contact {
        constant: Constant::Preload,
        contact: Some(0),
    };
    let follow = range((430.0, 500.0), Follow::Peak(208.8 * TAU));
    let optimum = |solver: &SolverOptions| {
        let found = parameter_response(&model, solver, preload, &follow, &mut Hooks::default()).unwrap();
        println!(
            "{:?}: {} points, harmonics {:?}, optima {:?}",
            found.status(),
            found.points(),
            found.harmonics_used(),
            found.optima()
        );
        assert_eq!(found.status(), Status::Ok);
        let least = found.optima().iter().filter(|o| !o.is_maximum);
        *least.min_by(|a, b| a.amplitude.total_cmp(&b.amplitude)).unwrap()
    };
    let few = optimum(&tight(9));
    let chosen = optimum(&SolverOptions {
        tolerance: 1e-4,
        ..tight(9)
    });
    let many = optimum(&tight(63));
    assert!((few.parameter / many.parameter - 1.0).abs() > 0.03);
    assert!(
        (chosen.amplitude / many.amplitude - 1.0).abs() < 1e-4,
        "{chosen:?} {many:?}"
    );
    assert!(
        (chosen.parameter / many.parameter - 1.0).abs() < 0.005,
        "{chosen:?} {many:?}"
    );
}
