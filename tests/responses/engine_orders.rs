//! Engine orders 2 and 3 in one run on one sector: each harmonic has its nodal diameter, and every blade is that of the whole wheel.

use crate::common::models::Structure;
use crate::common::{Wheel, omega_range};
use hbvib::{
    Branch, Component, Contact, ForcedOptions, Hooks, MatrixKind, Measure, Model, Response, SolverOptions, TimeOptions,
    VerifyOptions, forced_response, time_response, verify,
};

const FORCES: [(usize, f64); 2] = [(2, 0.05), (3, 0.04)];

/// Degrees of freedom of a sector, a blade on a disk, and sectors.
const NDOF: usize = 2;
const SECTORS: usize = 8;

const MASS: [f64; 4] = [1.0, 0.0, 0.0, 3.0];
const OWN: [f64; 4] = [1.0, -1.0, -1.0, 4.0];
const NEXT: [f64; 4] = [0.0, 0.0, 0.0, -1.0];

/// A wheel whose blades rub against the ground, under harmonics 2 and 3 of the speed of rotation, which travel forward or, with a sense
/// of −1, backward: one sector, and the whole as a plain structure.
fn models(sense: i64) -> (Model, Model) {
    let contact = Contact::jenkins(0, None, 0.6, 0.3, 0.2);
    let mut sector = Structure::cyclic(NDOF, SECTORS)
        .mass(&MASS)
        .stiffness(&OWN)
        .next(MatrixKind::Stiffness, &NEXT)
        .wave(sense)
        .contact(&contact)
        .build();
    let mut wheel = Wheel::new(NDOF, SECTORS);
    wheel.set(MatrixKind::Mass, &MASS, None, None);
    wheel.set(MatrixKind::Stiffness, &OWN, Some(&NEXT), None);
    wheel.add_contact(&contact);
    for (harmonic, force) in FORCES {
        sector.add_force(0, harmonic, force.into()).unwrap();
        wheel.add_force(0, harmonic, force.into(), sense);
    }
    for model in [&mut sector, &mut wheel.model] {
        model.set_rayleigh(0.0, 0.02).unwrap();
    }
    (sector, wheel.model)
}

fn solve(model: &Model, (start, stop): (f64, f64), responses: &[Response<'_>], solver: &SolverOptions) -> Branch {
    let range = ForcedOptions {
        responses,
        ..omega_range(start, stop)
    };
    forced_response(model, solver, &range, &mut Hooks::default()).unwrap()
}

fn exactly(harmonics: usize) -> SolverOptions {
    crate::common::harmonics(harmonics)
}

const MEASURES: [Measure; 5] = [
    Measure::Harmonic(2),
    Measure::Harmonic(3),
    Measure::Peak,
    Measure::Rms,
    Measure::Range,
];

#[test]
fn every_blade_is_that_of_the_whole_wheel() {
    every_blade(1);
    every_blade(-1);
}

fn every_blade(sense: i64) {
    let (sector, wheel) = models(sense);
    let sectors = [0, 1, 5, 7];
    let dofs: Vec<[usize; 1]> = sectors.iter().map(|s| [s * NDOF]).collect();
    let (mut of_sector, mut of_wheel) = (Vec::new(), Vec::new());
    for measure in MEASURES {
        for component in [Component::Displacement, Component::Acceleration] {
            for (s, dof) in sectors.iter().zip(&dofs) {
                let one = Response {
                    measure,
                    component,
                    ..Response::default()
                };
                of_sector.push(Response {
                    dofs: &[0],
                    sector: *s,
                    ..one
                });
                of_wheel.push(Response { dofs: dof, ..one });
            }
        }
    }
    // A third and a half of the resonances of the diameters 3 and 2 lie in this range.
    let mut slips = 0.0_f64;
    for omega in [0.25, 0.3, 0.34, 0.38, 0.45, 0.52] {
        let a = solve(&sector, (omega, omega), &of_sector, &exactly(7));
        let b = solve(&wheel, (omega, omega), &of_wheel, &exactly(7));
        slips = slips.max(a.slip_fraction()[0]);
        for ((a, b), response) in a.responses().iter().zip(b.responses()).zip(&of_sector) {
            let (x, y) = (a.values()[0], b.values()[0]);
            assert!((x - y).abs() < 1e-9 * y, "{response:?} at {omega}: {x} {y}");
            let (x, y) = (a.complex()[0], b.complex()[0]);
            if x.re.is_finite() {
                assert!((x - y).norm() < 1e-9 * y.norm(), "{response:?} at {omega}: {x} {y}");
            }
        }
    }
    assert!(slips > 0.0);
}

#[test]
fn the_response_by_itself_is_rms_and_no_point_is_rounding() {
    let (sector, _) = models(1);
    let branch = solve(&sector, (0.2, 0.6), &[], &SolverOptions::default());
    assert_eq!(branch.status(), hbvib::Status::Ok);
    assert_eq!(branch.responses().len(), 1);
    assert_eq!(branch.responses()[0].response().measure, Measure::Rms);
    let largest = branch.amplitude().iter().fold(0.0_f64, |m, x| m.max(*x));
    assert!(branch.amplitude().iter().all(|x| *x > 1e-2 * largest));
    // Both engine orders have a resonance, and the tolerance holds against integration in time at each.
    assert!(branch.peaks().len() >= 2, "{:?}", branch.peaks());
    for peak in branch.peaks() {
        let (options, mut hooks) = (VerifyOptions::default(), Hooks::default());
        let checked = verify(&sector, &branch, peak.point, &options, &mut hooks).unwrap();
        assert!(checked.same && checked.motion_error < 2e-3, "{}", checked.motion_error);
    }
}

#[test]
fn many_harmonics_are_the_whole_wheel_in_time() {
    let (sector, wheel) = models(1);
    let mut responses = Vec::new();
    for s in 0..SECTORS {
        for measure in MEASURES {
            responses.push(Response {
                measure,
                dofs: &[0],
                sector: s,
                ..Response::default()
            });
        }
    }
    for omega in [0.38, 0.45] {
        let options = TimeOptions {
            omega,
            harmonics: 3,
            samples: 8192,
            tolerance: 1e-13,
            ..TimeOptions::default()
        };
        let time = time_response(&wheel, &options, &mut Hooks::default()).unwrap();
        let branch = solve(&sector, (omega, omega), &responses, &exactly(383));
        assert!(branch.slip_fraction()[0] > 0.2);
        for (found, response) in branch.responses().iter().zip(&responses) {
            let blade = response.sector * NDOF;
            let gauge: Vec<f64> = time.samples.iter().skip(blade).step_by(time.ndof).copied().collect();
            let largest = |sign: f64| gauge.iter().fold(f64::NEG_INFINITY, |m, x| m.max(sign * x));
            // An extreme of the samples misses that of the motion by up to half a step of it.
            let (value, within) = match response.measure {
                Measure::Harmonic(h) => (time.harmonics[h * time.ndof + blade].norm(), 1e-9),
                Measure::Rms => ((gauge.iter().map(|x| x * x).sum::<f64>() / 8192.0).sqrt(), 1e-9),
                Measure::Peak => (largest(1.0).max(largest(-1.0)), 1e-6),
                _ => (largest(1.0) + largest(-1.0), 1e-6),
            };
            let error = (found.values()[0] / value - 1.0).abs();
            assert!(error < within, "{response:?} at {omega}: {error:e}");
        }
    }
}
