//! Static states along a load history, against closed forms: a cylinder on two inclined planes that a centrifugal force presses between
//! them, up and down; and the residual force that a response then has.

use crate::common::models::{Structure, dense, oscillator};
use crate::common::{harmonics, solve_at};
use hbvib::{
    Constant, Contact, ContactKind, Frame, Friction2d, Friction3d, Hooks, Interrupt, LoadHistory, Model, SolverOptions,
    Speed, SteadyMethod, TimeOptions, freedom, static_history, time_response,
};
use num_complex::Complex64;

const KT: f64 = 1.3;
const KN: f64 = 0.9;
const MU: f64 = 0.25;
const SUPPORT: f64 = 0.02;
/// Inclination of the planes against the direction along the platform.
const BETA: f64 = 0.9;

/// The cylinder, along the platform, outward and, if `across`, along its axis.
fn cylinder(kind: &ContactKind, across: bool) -> Model {
    let n = 2 + usize::from(across);
    let mut model = Structure::plain(n)
        .diagonals([&vec![0.1; n], &vec![0.01; n], &vec![SUPPORT; n]])
        .build();
    let (s, c) = BETA.sin_cos();
    for side in [1.0, -1.0] {
        let contact = Contact {
            frame: Some(Frame::new([side * s, -c, 0.0], Some([side * c, s, 0.0])).unwrap()),
            ..Contact::of_sides(kind.clone(), [Some(0), Some(1), across.then_some(2)], [None; 3])
        };
        let contact = [(Constant::Kt, KT), (Constant::Kn, KN), (Constant::Mu, MU)]
            .into_iter()
            .fold(contact, |contact, (constant, value)| {
                contact.with(constant, value).unwrap()
            });
        model.add_contact(&contact).unwrap();
    }
    model.add_force(1, 0, Complex64::new(1.0, 0.0)).unwrap();
    model
}

/// Outward displacement and tangential force of each plane under the force, as its size goes through turning points.
fn closed_form(turns: &[f64]) -> (f64, f64) {
    let (s, c) = BETA.sin_cos();
    let (stick, limit) = (KT * s, MU * KN * c);
    assert!(stick > limit, "the contacts slip from the start");
    let with_slip = |sign: f64| SUPPORT + 2.0 * KN * c * (c + sign * MU * s);
    let (mut v, mut f, mut from) = (0.0, 0.0, 0.0);
    for &to in turns {
        let sign = if to > from { 1.0 } else { -1.0 };
        // Slip begins where f + stick (w - v) = sign limit w.
        let slip = (f - stick * v) / (sign * limit - stick);
        let force = |v: f64, f: f64| SUPPORT * v + 2.0 * (c * KN * c * v + s * f);
        if sign * (to - force(slip, sign * limit * slip)) > 0.0 {
            v = to / with_slip(sign);
            f = sign * limit * v;
        } else {
            let w = (to - 2.0 * s * (f - stick * v)) / (SUPPORT + 2.0 * (KN * c * c + s * stick));
            (v, f) = (w, f + stick * (w - v));
        }
        from = to;
    }
    (v, f)
}

#[test]
fn a_cylinder_between_planes_keeps_the_force_of_its_speeds() {
    // Squares of speeds: up, down into stick, down into reversed slip, up again, further up.
    let squares = [2.0, 1.6, 0.7, 0.9, 3.0, 0.1];
    for (kind, across) in [
        (ContactKind::Friction2d(Friction2d::default()), false),
        (ContactKind::Friction3d(Friction3d::default()), true),
    ] {
        let model = cylinder(&kind, across);
        let history = LoadHistory {
            factors: &squares,
            speeds: &[],
        };
        let steps = static_history(&model, &SolverOptions::default(), &history, &Interrupt::none()).unwrap();
        let mut reversed = 0;
        for (i, step) in steps.iter().enumerate() {
            let (v, f) = closed_form(&squares[..=i]);
            println!("{}: {} {v}, {:?} {f}", squares[i], step.motion[1], step.forces);
            assert!((step.motion[1] / v - 1.0).abs() < 1e-9);
            for (force, place) in step.forces.iter().zip(&step.places) {
                assert!((force[0] - f).abs() < 1e-9 * f.abs());
                assert!((force[2] + KN * BETA.cos() * v).abs() < 1e-9 * v);
                assert!((KT * (BETA.sin() * v - place[0]) - f).abs() < 1e-9 * f.abs());
            }
            reversed += usize::from(f < 0.0);
        }
        assert!(reversed > 0);
    }
}

/// A response with the places that a history has left starts from its residual forces.
#[test]
fn a_response_after_a_history_has_its_residual_force() {
    let mut model = cylinder(&ContactKind::Friction2d(Friction2d::default()), false);
    let history = LoadHistory {
        factors: &[2.0, 1.0],
        speeds: &[],
    };
    let steps = static_history(&model, &SolverOptions::default(), &history, &Interrupt::none()).unwrap();
    let last = &steps[1];
    for (id, place) in last.places.iter().enumerate() {
        model.set_slider(id, 0, place[0]).unwrap();
    }
    // The response at hardly any vibration is the static state.
    model.add_force(0, 1, Complex64::new(1e-6, 0.0)).unwrap();
    let branch = solve_at(&model, &harmonics(1), 0.5);
    let mean = crate::common::all_harmonics(&branch, 0)[1].re;
    assert!((mean / last.motion[1] - 1.0).abs() < 1e-9);
    assert!(freedom(&model, &branch, 0).unwrap().is_empty(), "all contacts stick");
}

/// A preload m R Omega^2 that rises and falls under a constant pull.
#[test]
fn a_slider_under_a_load_of_the_speed_is_dragged_where_the_load_falls() {
    let mut model = oscillator(1.0, 1.0).slider(0, 1.0, 0.5, 0.0).build();
    model.set_preload_at_speed(0, 0.0, 1.0).unwrap();
    model.set_speed(Speed::Fixed(1.0)).unwrap();
    model.add_force(0, 0, Complex64::new(1.0, 0.0)).unwrap();
    let history = LoadHistory {
        factors: &[1.0, 1.0, 1.0, 1.0],
        speeds: &[2.0, 0.5, 1.5, 0.2],
    };
    let steps = static_history(&model, &SolverOptions::default(), &history, &Interrupt::none()).unwrap();
    // Stick at limits above 1/2 from the start; then limits 0.125, no change while it rises, 0.02.
    for (step, force) in steps.iter().zip([0.5, 0.125, 0.125, 0.02]) {
        assert!((step.forces[0][0] - force).abs() < 1e-11, "{:?}", step.forces);
        assert!((step.motion[0] - (1.0 - force)).abs() < 1e-11);
    }
}

#[test]
fn histories_that_are_none_are_refused_by_name() {
    let model = cylinder(&ContactKind::Friction2d(Friction2d::default()), false);
    let with = |factors: &[f64], speeds: &[f64]| {
        let history = LoadHistory { factors, speeds };
        static_history(&model, &SolverOptions::default(), &history, &Interrupt::none())
            .unwrap_err()
            .to_string()
    };
    assert!(with(&[], &[]).contains("0 steps"));
    assert!(with(&[1.0, 2.0], &[1.0]).contains("2 factors and 1 speeds"));
    assert!(with(&[f64::NAN], &[]).contains("factors[0] = NaN"));
}

/// A slider that a vibration drags until it sticks. Shooting finds the motion whose largest value is just at the limit; marching from rest
/// overshoots and drags it further. Harmonic balance from either place is the motion in time.
#[test]
fn integration_in_time_leaves_the_slider_where_the_vibration_has_dragged_it() {
    let model = oscillator(1.0, 1.0)
        .damping(&[0.1])
        .slider(0, 1.0, 0.3, 1.0)
        .force(0, 0, 0.6)
        .force(0, 1, 0.1)
        .build();
    let mut places = Vec::new();
    for method in [SteadyMethod::Shooting, SteadyMethod::Marching] {
        let options = TimeOptions {
            omega: 0.5,
            harmonics: 1,
            samples: 4000,
            method,
            ..TimeOptions::default()
        };
        let found = time_response(&model, &options, &mut Hooks::default()).unwrap();
        let place = found.places[0];
        let largest = found.samples.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b));
        let least = found.samples.iter().fold(f64::INFINITY, |a, b| a.min(*b));
        println!("{place} {least} .. {largest}");
        assert!(place > largest - 0.3 - 1e-6 && place < least + 0.3 + 1e-6);
        places.push((place, largest));
        let mut placed = model.try_clone().unwrap();
        placed.set_slider(0, 0, place).unwrap();
        let x = crate::common::all_harmonics(&solve_at(&placed, &harmonics(1), 0.5), 0);
        let gaps = [0, 1].map(|h| (x[h] - found.harmonics[h]).norm());
        assert!(gaps.iter().all(|gap| *gap < 1e-8), "{gaps:?}");
    }
    assert!((places[0].0 - (places[0].1 - 0.3)).abs() < 1e-6 && places[1].0 > places[0].0 + 0.1);
}

/// A structure without contacts, or with springs alone, follows its constant forces: K x = factor F.
#[test]
fn without_contacts_the_states_are_those_of_the_stiffness() {
    let stiffness = [3.0, -1.0, -1.0, 2.0];
    let model = dense(&[1.0, 0.0, 0.0, 1.0], &stiffness)
        .force(1, 0, 0.7)
        .force(0, 1, 5.0)
        .build();
    let states = |model: &Model| {
        let history = LoadHistory {
            factors: &[1.0, -2.0, 0.0],
            speeds: &[],
        };
        static_history(model, &SolverOptions::default(), &history, &Interrupt::none()).unwrap()
    };
    // K⁻¹ (0, 0.7) of the determinant 5, and with a spring of 2 at the second degree of freedom of 11.
    for (spring, right) in [(0.0, [0.14, 0.42]), (2.0, [0.7 / 11.0, 2.1 / 11.0])] {
        let mut model = model.try_clone().unwrap();
        if spring > 0.0 {
            model.add_contact(&Contact::cubic(1, None, spring, 0.0)).unwrap();
        }
        for (step, factor) in states(&model).iter().zip([1.0, -2.0, 0.0]) {
            for (x, right) in step.motion.iter().zip(right) {
                assert!((x - factor * right).abs() < 1e-14, "{:?} {factor} {right}", step.motion);
            }
            assert!(
                step.forces
                    .iter()
                    .all(|f| (f[0] - spring * step.motion[1]).abs() < 1e-14),
                "{:?}",
                step.forces
            );
        }
    }
}

/// A contact that closes on the way sticks where it has closed: its normal load rises faster than its force. In one step or in many.
#[test]
fn a_contact_that_closes_within_a_step_sticks_where_it_closes() {
    let (kt, kn, mu, gap) = (2.0, 5.0, 0.8, 0.3);
    let contact = Contact::friction_2d([Some(0), Some(1)], [None; 2], (kt, kn), mu, 0.0)
        .with(Constant::Gap, gap)
        .unwrap();
    // It closes against the ground, and the force along is half of that towards it.
    let one = [1.0, 0.0, 0.0, 1.0];
    let model = dense(&one, &one)
        .contact(&contact)
        .force(0, 0, 0.5)
        .force(1, 0, -1.0)
        .build();
    // Displacement along and place of the slider under the load f: closed from f = gap on, at the displacement gap/2.
    let exact = |f: f64| {
        let place = if f > gap { 0.5 * gap } else { 0.5 * f };
        let along = if f > gap {
            (0.5 * f + kt * place) / (1.0 + kt)
        } else {
            0.5 * f
        };
        (along, place)
    };
    for between in [1, 2, 7] {
        let turns = [0.1, 1.0, 0.2, 0.9];
        let mut factors = vec![turns[0]];
        for pair in turns.windows(2) {
            factors.extend((1..=between).map(|i| pair[0] + (pair[1] - pair[0]) * f64::from(i) / f64::from(between)));
        }
        let history = LoadHistory {
            factors: &factors,
            speeds: &[],
        };
        let steps = static_history(&model, &SolverOptions::default(), &history, &Interrupt::none()).unwrap();
        for (step, f) in steps.iter().zip(&factors) {
            let (along, place) = exact(*f);
            println!("{f} {} {along} {} {place}", step.motion[0], step.places[0][0]);
            assert!((step.motion[0] - along).abs() < 1e-7 && (step.places[0][0] - place).abs() < 1e-7);
        }
    }
}
