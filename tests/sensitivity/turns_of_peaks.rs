//! The peak of an oscillator whose damping falls with the amplitude is one curve over the force. Its turns, and those of the folds, are
//! the forces at which the detached curve is born and merges, in closed form.

use crate::common::depth::some_of;
use crate::design::{Design, tight};
use hbvib::{
    Branch, Contact, ContactKind, Follow, Hooks, Parameter, ParameterRange, Polynomial, SolverOptions, Status, Turn,
    parameter_response,
};

/// Damper c₁v + c₃v³ + c₅v⁵ of an oscillator with m = k = 1.
const DAMPER: [f64; 5] = [0.05, 0.0, -0.05, 0.0, 0.012];
const FORCE: f64 = 0.015;

fn design() -> Design {
    let damper = Polynomial::scalar(&[], &[0.0, 0.0, DAMPER[2], 0.0, DAMPER[4]]).unwrap();
    Design {
        contacts: vec![Contact::between(0, None, ContactKind::Polynomial(damper))],
        forces: vec![(0, 1, FORCE.into())],
        ..Design::plain(1, [vec![1.0], vec![DAMPER[0]], vec![1.0]])
    }
}

fn over_force(solver: &SolverOptions, ends: (f64, f64), at: &[f64], follow: Follow) -> Branch {
    let range = ParameterRange {
        start: ends.0,
        stop: ends.1,
        at,
        follow,
        response: None,
    };
    parameter_response(
        &design().model(),
        solver,
        Parameter::Force,
        &range,
        &mut Hooks::default(),
    )
    .unwrap()
}

/// The force that resonates at an amplitude at H = 1, where the phase of the displacement is −90° at ω = 1.
fn force(a: f64) -> f64 {
    a * (DAMPER[0] + 0.75 * DAMPER[2] * a.powi(2) + 0.625 * DAMPER[4] * a.powi(4))
}

/// Forces of merging and birth: F′(a) = c₁ + 9/4 c₃ a² + 25/8 c₅ a⁴ = 0.
fn extrema() -> [(f64, f64); 2] {
    let (a, b, c) = (3.125 * DAMPER[4], 2.25 * DAMPER[2], DAMPER[0]);
    let root = (b * b - 4.0 * a * c).sqrt();
    [-1.0, 1.0].map(|sign| {
        let x = ((-b + sign * root) / (2.0 * a)).sqrt();
        (x, force(x))
    })
}

fn is_near(turn: &Turn, (a, f): (f64, f64)) -> bool {
    (FORCE * turn.parameter / f - 1.0).abs() < 1e-8 && (turn.amplitude / a - 1.0).abs() < 1e-4
}

#[test]
fn birth_and_merging_are_turns_of_one_curve() {
    let [merging, birth] = extrema();
    assert!((merging.1 - 0.023_468_97).abs() < 1e-8 && (birth.1 - 0.004_920_12).abs() < 1e-8);
    let found = over_force(&tight(1), (0.2, 2.0), &[1.0], Follow::PeakThroughFolds(1.0));
    println!("{:?} {} points: {:?}", found.status(), found.points(), found.turns());
    assert_eq!(found.status(), Status::Ok);
    let [first, second] = found.turns() else {
        panic!("{:?}", found.turns())
    };
    assert!(first.is_maximum && is_near(first, merging), "{first:?} {merging:?}");
    assert!(!second.is_maximum && is_near(second, birth), "{second:?} {birth:?}");
    for turn in [first, second] {
        assert!((turn.omega - 1.0).abs() < 1e-6, "{turn:?}");
        assert_eq!(
            found.parameter_at(turn.point).unwrap().0.to_bits(),
            turn.parameter.to_bits()
        );
    }
    // Every point is a solution in closed form, peaks and hollows.
    for (i, (a, p)) in found.amplitude().iter().zip(found.parameter().unwrap()).enumerate() {
        let omega = found.omega()[i];
        let damping = DAMPER[0] + 0.75 * DAMPER[2] * (a * omega).powi(2) + 0.625 * DAMPER[4] * (a * omega).powi(4);
        let sum = a * (1.0 - omega * omega).hypot(omega * damping);
        assert!((p * FORCE / sum - 1.0).abs() < 1e-8, "{a} {p}");
    }
    let at: Vec<f64> = found.at(0).iter().map(|special| special.amplitude).collect();
    assert_eq!(at.len(), 3, "{at:?}");
    for (a, expected) in at.iter().zip([0.325_3, 1.166_5, 1.823_6]) {
        assert!((a - expected).abs() < 1e-3, "{at:?}");
    }
}

#[test]
fn folds_alone_show_birth_and_merging() {
    let [merging, birth] = extrema();
    // Above the merging the curve has two folds on each side: those of the neck, and those of the upper motion.
    for (at, of) in [(1.0, merging), (0.96, birth)] {
        let found = over_force(&tight(1), (1.7, 0.2), &[], Follow::Fold(at));
        println!(
            "{at}: {:?} {} points: {:?}",
            found.status(),
            found.points(),
            found.turns()
        );
        let [turn] = found.turns() else {
            panic!("{:?}", found.turns())
        };
        assert!(is_near(turn, of) && !turn.is_maximum, "{turn:?} {of:?}");
        assert_eq!(found.status(), Status::StoppedLeftRange);
    }
}

#[test]
fn a_tolerance_carries_the_harmonics_of_the_turns() {
    let tolerance = some_of(1e-4, 1e-5);
    let solver = SolverOptions { tolerance, ..tight(1) };
    let turns = |solver: &SolverOptions| {
        let found = over_force(solver, (0.32, 1.58), &[], Follow::PeakThroughFolds(1.0));
        println!(
            "{:?} {} points, harmonics {:?}: {:?}",
            found.status(),
            found.points(),
            found.harmonics_used(),
            found.turns()
        );
        found.turns().iter().map(|turn| turn.parameter).collect::<Vec<f64>>()
    };
    let (chosen, many) = (turns(&solver), turns(&tight(5)));
    assert_eq!((chosen.len(), many.len()), (2, 2));
    for (chosen, many) in chosen.iter().zip(&many) {
        assert!((chosen / many - 1.0).abs() < tolerance, "{chosen} {many}");
    }
}
