//! Dampers under platforms by one call: against the same wedge by hand, stiffness matrices assembled by hand, closed forms of a
//! cylinder between planes while the speed rises and falls, and the wheel of a sector.

use crate::common::models::{self, Structure, diagonal, oscillator};
use crate::common::refusal::refused;
use crate::common::{all_harmonics, harmonics, relative_gap, solve_at, sweep};
use hbvib::{
    BandOf, BandOptions, Damper, DamperFace, Hooks, Interrupt, LoadHistory, MatrixKind, MatrixView, Model, Parameter,
    Quantity, SolverOptions, Speed, Status, band, freedom, sensitivity, static_history,
};
use num_complex::Complex64;
use std::f64::consts::{FRAC_PI_4, TAU};

fn blade() -> Model {
    oscillator(1.0, 1.0).damping(&[0.04]).build()
}

const WEDGE: [DamperFace; 2] = [face(None, -FRAC_PI_4, 0.6), face(Some(0), FRAC_PI_4, 0.15)];

const fn face(dof: Option<usize>, angle: f64, mu: f64) -> DamperFace {
    DamperFace {
        dofs: [dof, None, None],
        sector_offset: 0,
        angle,
        turn: 0.0,
        centre: [0.0; 3],
        width: 0.0,
        points: [1; 2],
        stiffness: [1.0, 1.5],
        mu,
        gap: 0.0,
    }
}

/// The wedge of `residual_band`, whose centrifugal force is 1 at the speed 2.
fn wedge() -> Model {
    let mut model = blade();
    let damper = Damper {
        mass: 0.01,
        inertia: [0.0, 0.0, 1e-5],
        orbit: 25.0,
        support: [1e-3, 0.0],
        support_damping: [4e-3, 0.0],
        faces: &WEDGE,
        ..Damper::default()
    };
    let place = model.add_damper(&damper).unwrap();
    assert_eq!((place.dofs, place.contacts), (1..4, 0..2));
    model.fix(&[3]).unwrap();
    model.set_speed(Speed::Fixed(2.0)).unwrap();
    model.add_force(0, 1, Complex64::new(0.02, 0.0)).unwrap();
    model
}

fn wedge_by_hand() -> Model {
    Structure::plain(3)
        .diagonals([&[1.0, 0.01, 0.01], &[0.04, 4e-3, 4e-3], &[1.0, 1e-3, 1e-3]])
        .contact(models::damper_face([1, 2], 1.0, None, [1.0, 1.5, 0.6]))
        .contact(models::damper_face([1, 2], -1.0, Some(0), [1.0, 1.5, 0.15]))
        .force(2, 0, 1.0)
        .force(0, 1, 0.02)
        .build()
}

#[test]
fn a_wedge_by_the_call_is_the_wedge_by_hand() {
    let (called, by_hand) = (wedge(), wedge_by_hand());
    let loaded = Model::load(&called.save().unwrap()).unwrap();
    let solver = harmonics(7);
    let bands = [&called, &by_hand, &loaded].map(|model| {
        let branch = sweep(model, &solver, 1.23, 1.27, &[]);
        let peak = branch.peaks()[0];
        assert_eq!(freedom(model, &branch, peak.point).unwrap().len(), 1);
        let options = BandOptions {
            of: BandOf::PeakAmplitude,
            ..BandOptions::default()
        };
        let found = band(model, &branch, peak.point, &solver, &options, &mut Hooks::default()).unwrap();
        [peak.omega, peak.amplitude, found.lower.value, found.upper.value]
    });
    println!("{bands:?}");
    for one in [bands[0], bands[2]] {
        for (a, b) in one.iter().zip(bands[1]) {
            assert!((a / b - 1.0).abs() < 1e-9);
        }
    }
}

/// Motion of a point of a rigid body by its translations and rotations, from the cross product of each column.
fn carried(point: [f64; 3]) -> [[f64; 6]; 3] {
    let [x, y, z] = point;
    [
        [1.0, 0.0, 0.0, 0.0, z, -y],
        [0.0, 1.0, 0.0, -z, 0.0, x],
        [0.0, 0.0, 1.0, y, -x, 0.0],
    ]
}

/// While nothing slips and all points stay closed the contacts are springs, whose matrix is assembled here point by point.
#[test]
fn a_damper_that_sticks_is_a_matrix_of_springs() {
    const N: usize = 9;
    let (mass, radius, length) = (0.2, 0.3, 0.8);
    let angles = [-0.5, 0.8];
    let turn = 0.35;
    let mut model = Structure::plain(3)
        .diagonals([&[1.0, 1.2, 0.9], &[0.05, 0.04, 0.03], &[2.0, 3.0, 2.5]])
        .build();
    let (across, roll) = (
        mass * (3.0 * radius * radius + length * length) / 12.0,
        0.5 * mass * radius * radius,
    );
    let inertia = [1.0, 1.2, 0.9, mass, mass, mass, across, across, roll];
    let mut linear = Structure::plain(N)
        .mass(&diagonal(&inertia))
        .damping(&diagonal(&[0.05, 0.04, 0.03, 0.01, 0.01, 0.01, 0.0, 0.0, 0.0]))
        .build();
    let mut k = [[0.0; N]; N];
    for (i, value) in [2.0, 3.0, 2.5].into_iter().enumerate() {
        k[i][i] = value;
    }
    let faces = [0, 1].map(|i| DamperFace {
        dofs: if i == 0 { [None; 3] } else { [0, 1, 2].map(Some) },
        angle: angles[i],
        turn: if i == 1 { turn } else { 0.0 },
        points: [1, 3],
        stiffness: [1.5, 2.1],
        mu: 1e3,
        ..DamperFace::default()
    });
    for (i, face) in faces.iter().enumerate() {
        let (s, c) = face.angle.sin_cos();
        let axes = [([c, -s, 0.0], 0.5), ([0.0, 0.0, 1.0], 0.5), ([s, c, 0.0], 0.7)];
        for j in 0..3 {
            let at = [radius * s, radius * c, length * (f64::from(j) - 1.0) / 3.0];
            let body = carried(at);
            for (axis, stiffness) in axes {
                let mut row = [0.0; N];
                for (component, moved) in axis.iter().zip(body) {
                    for (r, b) in row[3..].iter_mut().zip(moved) {
                        *r += component * b;
                    }
                }
                if i == 1 {
                    // x' of the turned axes is (cos turn, sin turn) in those of the damper.
                    let (st, ct) = turn.sin_cos();
                    row[0] = -(axis[0] * ct + axis[1] * st);
                    row[1] = -(axis[1] * ct - axis[0] * st);
                    row[2] = -axis[2];
                }
                for (a, k) in row.iter().zip(&mut k) {
                    for (b, k) in row.iter().zip(k) {
                        *k += stiffness * a * b;
                    }
                }
            }
        }
    }
    linear
        .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(N, k.as_flattened()))
        .unwrap();
    let damper = Damper {
        motions: 6,
        mass,
        radius,
        length,
        orbit: 50.0,
        support_damping: [0.01, 0.0],
        faces: &faces,
        ..Damper::default()
    };
    let place = model.add_damper(&damper).unwrap();
    assert_eq!((place.dofs, place.contacts), (3..9, 0..6));
    model.set_speed(Speed::Fixed(1.0)).unwrap();
    let mut gaps = [0.0; 2];
    for (dof, value) in [
        (0, Complex64::new(0.3, 0.1)),
        (7, Complex64::new(0.02, 0.0)),
        (4, Complex64::new(0.1, 0.0)),
    ] {
        model.add_force(dof, 1, value).unwrap();
        linear.add_force(dof, 1, value).unwrap();
    }
    linear.add_force(4, 0, Complex64::new(10.0, 0.0)).unwrap();
    for (gap, omega) in gaps.iter_mut().zip([0.9, 2.3]) {
        let [x, y] = [&model, &linear].map(|model| all_harmonics(&solve_at(model, &harmonics(1), omega), 0));
        *gap = relative_gap(&x, &y);
    }
    println!("{gaps:?}");
    assert!(gaps.iter().all(|gap| *gap < 1e-10), "{gaps:?}");
}

const KT: f64 = 1.3;
const KN: f64 = 0.9;
const MU: f64 = 0.25;
const SUPPORT: f64 = 0.02;
const BETA: f64 = 0.9;

/// Outward motion and tangential force under the outward force f, which falls from `top`, or on the way up. On the way up both
/// planes slip: f = v(S + 2 K_n c(c + μ s)). On the way down they stick until the force is reversed.
fn closed_form(f: f64, top: f64) -> (f64, f64) {
    let (s, c) = BETA.sin_cos();
    let slip = |sign: f64, f: f64| f / (SUPPORT + 2.0 * KN * c * (c + sign * MU * s));
    let v_top = slip(1.0, top);
    if f >= top {
        let v = slip(1.0, f);
        return (v, MU * KN * c * v);
    }
    let v = v_top + (f - top) / (SUPPORT + 2.0 * (KN * c * c + KT * s * s));
    let t = MU * KN * c * v_top + KT * s * (v - v_top);
    if t > -MU * KN * c * v {
        (v, t)
    } else {
        let v = slip(-1.0, f);
        (v, -MU * KN * c * v)
    }
}

#[test]
fn a_cylinder_keeps_the_forces_of_the_speeds_that_it_has_had() {
    let speeds = [1.0, 1.5, 2.0, 1.95, 1.8, 1.2, 0.6];
    for motions in [3, 6] {
        let mut model = blade();
        let faces = [-BETA, BETA].map(|angle| DamperFace {
            angle,
            stiffness: [KT, KN],
            mu: MU,
            points: [1, 2],
            ..DamperFace::default()
        });
        let damper = Damper {
            motions,
            mass: 0.1,
            radius: 0.4,
            length: 1.0,
            orbit: 7.0,
            // The roll is free where both planes slip.
            support: [SUPPORT, 1e-2],
            faces: &faces,
            ..Damper::default()
        };
        let place = model.add_damper(&damper).unwrap();
        let history = LoadHistory {
            factors: &[],
            speeds: &speeds,
        };
        let steps = static_history(&model, &SolverOptions::default(), &history, &Interrupt::none()).unwrap();
        let per_face = place.contacts.len() / 2;
        let (mut stuck, mut reversed) = (0, 0);
        for (i, step) in steps.iter().enumerate() {
            let top = speeds[..=i].iter().fold(0.0_f64, |a, b| a.max(*b));
            let (v, t) = closed_form(0.7 * speeds[i] * speeds[i], 0.7 * top * top);
            println!("{}: {} {v}, {:?} {t}", speeds[i], step.motion[2], step.forces[0]);
            assert!((step.motion[2] / v - 1.0).abs() < 1e-9);
            for (id, force) in step.forces.iter().enumerate() {
                // t1 runs inward on the second plane.
                let sign = if id < per_face { 1.0 } else { -1.0 };
                assert!(
                    (sign * force[0] * per_face as f64 - t).abs() < 1e-9 * t.abs(),
                    "{force:?}"
                );
                assert!((force[2] * per_face as f64 + KN * BETA.cos() * v).abs() < 1e-9 * v);
            }
            let limit = MU * KN * BETA.cos() * v;
            stuck += usize::from(t.abs() < 0.999 * limit);
            reversed += usize::from(t < 0.0);
        }
        assert!(stuck > 0 && reversed > 0);
    }
}

/// A sector with a damper between its blade and that of the next sector.
fn sector() -> Model {
    let mut model = Structure::cyclic(1, 12)
        .matrices([&[1.0], &[0.02], &[1.0]])
        .wave(2)
        .build();
    let mut faces = WEDGE;
    faces[0].dofs = [Some(0), None, None];
    faces[1].sector_offset = 1;
    let damper = Damper {
        mass: 0.01,
        radius: 0.05,
        length: 0.2,
        orbit: 25.0,
        support: [1e-3, 1e-4],
        support_damping: [4e-3, 1e-5],
        faces: &faces,
        ..Damper::default()
    };
    let place = model.add_damper(&damper).unwrap();
    assert_eq!(place.dofs, 1..4);
    model.set_speed(Speed::Fixed(2.0)).unwrap();
    model.add_force(0, 1, Complex64::new(0.06, 0.0)).unwrap();
    model
}

#[test]
fn dampers_of_a_wheel_move_as_the_wave_of_the_sector() {
    let sector = sector();
    let wheel = sector.wheel().unwrap();
    assert_eq!((wheel.ndof(), wheel.contacts().len()), (48, 24));
    let omega = 1.15;
    let [wave, whole] = [&sector, &wheel].map(|model| all_harmonics(&solve_at(model, &harmonics(3), omega), 0));
    let mut expected = Vec::new();
    for h in 0..=3 {
        for s in 0..12 {
            let lag = Complex64::from_polar(1.0, -TAU * f64::from(2 * h * s) / 12.0);
            expected.extend(wave[4 * h as usize..][..4].iter().map(|x| lag * x));
        }
    }
    let gap = relative_gap(&whole, &expected);
    println!("{gap:.1e}");
    assert!(gap < 1e-10, "{gap}");
}

#[test]
fn a_speed_that_follows_the_frequency_presses_as_the_fixed_one() {
    let mut model = wedge();
    let omega = 1.3;
    let amplitude = |model: &Model| solve_at(model, &harmonics(5), omega).amplitude()[0];
    let tied = {
        model.set_speed(Speed::PerOmega(1.5)).unwrap();
        amplitude(&model)
    };
    model.set_speed(Speed::Fixed(1.5 * omega)).unwrap();
    let fixed = amplitude(&model);
    assert!((tied / fixed - 1.0).abs() < 1e-10, "{tied} {fixed}");
    let branch = solve_at(&model, &harmonics(5), omega);
    let found = sensitivity(&model, &branch, 0, &[Parameter::Speed], Quantity::Amplitude).unwrap();
    let mut at = |speed: f64| {
        model.set_speed(Speed::Fixed(speed)).unwrap();
        amplitude(&model)
    };
    let step = 1e-4;
    let difference = (at(1.5 * omega + step) - at(1.5 * omega - step)) / (2.0 * step);
    println!("{:?} {difference}", found.values);
    assert!((found.values[0] / difference - 1.0).abs() < 1e-5);
}

#[test]
fn dampers_that_are_none_are_refused_by_name() {
    let good = Damper {
        mass: 0.01,
        radius: 0.1,
        length: 0.1,
        faces: &WEDGE,
        ..Damper::default()
    };
    let far = [face(Some(7), 0.3, 0.1)];
    let loose = [DamperFace {
        stiffness: [1.0, 0.0],
        ..WEDGE[0]
    }];
    let many = [DamperFace {
        points: [1, 0],
        ..WEDGE[0]
    }];
    for (damper, status, words) in [
        (Damper { motions: 4, ..good }, Status::Argument, "motions = 4"),
        (Damper { mass: 0.0, ..good }, Status::Argument, "mass = 0"),
        (
            Damper {
                orbit: f64::NAN,
                ..good
            },
            Status::NotFinite,
            "orbit",
        ),
        (Damper { length: -1.0, ..good }, Status::Argument, "length = -1"),
        (Damper { radius: 0.0, ..good }, Status::Argument, "inertia"),
        (Damper { faces: &[], ..good }, Status::Argument, "without faces"),
        (Damper { faces: &far, ..good }, Status::Index, "faces[0]"),
        (Damper { faces: &loose, ..good }, Status::Argument, "kn"),
        (
            Damper {
                motions: 6,
                faces: &many,
                ..good
            },
            Status::Argument,
            "points",
        ),
    ] {
        let mut model = blade();
        refused(model.add_damper(&damper), status, &[words]);
        assert_eq!((model.ndof(), model.contacts().len()), (1, 0));
    }
}
