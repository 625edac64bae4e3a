//! Folds followed over a parameter are those of Duffing's equation in closed form, cusps included, and those of fine
//! sweeps of a model with a stop.

use crate::common::omega_range;
use crate::design::{Design, tight};
use hbvib::{
    Branch, Contact, Follow, ForcedOptions, Hooks, MatrixKind, Parameter, ParameterRange, SolverOptions, Status,
    forced_response, parameter_response,
};

/// Mass 1, with ((k − ω² + ¾κz)² + c²ω²) z = F² for z = A² at H = 1.
struct Duffing {
    damping: f64,
    stiffness: f64,
    cubic: f64,
}

impl Duffing {
    fn design(&self) -> Design {
        Design {
            contacts: vec![Contact::cubic(0, None, 0.0, self.cubic)],
            forces: vec![(0, 1, 1.0.into())],
            ..Design::plain(1, [vec![1.0], vec![self.damping], vec![self.stiffness]])
        }
    }

    /// A² of both folds at a frequency, the smaller first.
    fn folds(&self, omega: f64) -> [f64; 2] {
        let (d, c) = (self.stiffness - omega * omega, self.damping * omega);
        let (a, b) = (27.0 / 16.0 * self.cubic * self.cubic, 3.0 * self.cubic * d);
        let root = (b * b - 4.0 * a * (d * d + c * c)).sqrt();
        let sum = -b;
        let [low, high] = [(sum - root) / (2.0 * a), (sum + root) / (2.0 * a)];
        [low, high]
    }

    fn force(&self, omega: f64, z: f64) -> f64 {
        let d = self.stiffness - omega * omega + 0.75 * self.cubic * z;
        (z * (d * d + (self.damping * omega).powi(2))).sqrt()
    }
}

fn tracked(design: &Design, parameter: Parameter<'_>, solver: &SolverOptions, ends: (f64, f64), near: f64) -> Branch {
    let range = ParameterRange {
        start: ends.0,
        stop: ends.1,
        at: &[],
        follow: Follow::Fold(near),
        response: None,
    };
    parameter_response(&design.model(), solver, parameter, &range, &mut Hooks::default()).unwrap()
}

#[test]
fn folds_of_duffing_over_the_force_are_those_in_closed_form() {
    for duffing in [
        Duffing {
            damping: 0.05,
            stiffness: 1.0,
            cubic: 1.0,
        },
        Duffing {
            damping: 40.0,
            stiffness: 1e6,
            cubic: 3e11,
        },
    ] {
        let force = duffing.stiffness.sqrt() * duffing.damping * 0.5 * (duffing.stiffness / duffing.cubic).sqrt();
        let mut design = duffing.design();
        design.forces[0].2 = force.into();
        let found = forced_response(
            &design.model(),
            &tight(1),
            &ForcedOptions {
                omega_start: 0.5 * duffing.stiffness.sqrt(),
                omega_stop: 1.6 * duffing.stiffness.sqrt(),
                ..ForcedOptions::default()
            },
            &mut Hooks::default(),
        )
        .unwrap();
        let [_, lower] = found.folds() else {
            panic!("{:?}", found.folds())
        };
        let branch = tracked(&design, Parameter::Force, &tight(1), (1.0, 3.0), lower.omega);
        assert_eq!(branch.status(), Status::Ok);
        assert!(branch.points() > 4);
        let slopes = branch.d_amplitude().unwrap();
        for (i, &slope) in slopes.iter().enumerate() {
            let (omega, p, amplitude) = (branch.omega()[i], branch.parameter().unwrap()[i], branch.amplitude()[i]);
            let folds = duffing.folds(omega);
            let side = usize::from((folds[1] / amplitude.powi(2) - 1.0).abs() < 0.01);
            let at = |omega: f64| {
                (
                    duffing.folds(omega)[side].sqrt(),
                    duffing.force(omega, duffing.folds(omega)[side]),
                )
            };
            assert!((amplitude / at(omega).0 - 1.0).abs() < 1e-8, "{p}: {amplitude}");
            assert!((p * force / at(omega).1 - 1.0).abs() < 1e-8, "{p}");
            let h = 1e-5 * omega;
            let expected = (at(omega + h).0 - at(omega - h).0) / (at(omega + h).1 - at(omega - h).1) * force;
            assert!((slope / expected - 1.0).abs() < 1e-6, "{p}: {slope} {expected}");
        }
    }
}

#[test]
fn folds_meet_in_the_cusp_and_come_back_over_the_damping() {
    let duffing = Duffing {
        damping: 0.05,
        stiffness: 1.0,
        cubic: 1.0,
    };
    let mut design = duffing.design();
    design.forces[0].2 = 0.06.into();
    let damping = Parameter::Factor {
        which: MatrixKind::Damping,
    };
    let branch = tracked(&design, damping, &tight(1), (1.0, 4.0), 1.2);
    assert_eq!(branch.status(), Status::StoppedLeftRange, "{:?}", branch.parameter());
    let parameter = branch.parameter().unwrap();
    let mut sides = [0; 2];
    for (i, &p) in parameter.iter().enumerate() {
        let damped = Duffing {
            damping: 0.05 * p,
            ..duffing
        };
        let (omega, z) = (branch.omega()[i], branch.amplitude()[i].powi(2));
        let folds = damped.folds(omega);
        let side = usize::from((folds[1] - z).abs() < (folds[0] - z).abs());
        sides[side] += 1;
        // Near the cusp the two roots are close.
        let gap = (folds[1] - folds[0]) / z;
        assert!((folds[side] / z - 1.0).abs() < 1e-9 / gap, "{}: {}", p, folds[side] / z);
        assert!((damped.force(omega, z) / 0.06 - 1.0).abs() < 1e-9);
    }
    assert!(sides[0] > 2 && sides[1] > 2, "{sides:?}");
}

#[test]
fn folds_of_a_stop_are_those_of_fine_sweeps() {
    let design = |gap: f64| Design {
        contacts: vec![Contact::unilateral(None, Some(0), 3.0, gap)],
        forces: vec![(0, 1, 0.05.into())],
        ..Design::plain(
            2,
            [
                vec![1.0, 0.0, 0.0, 0.5],
                vec![0.03, -0.01, -0.01, 0.02],
                vec![1.5, -0.5, -0.5, 1.0],
            ],
        )
    };
    let gap = Parameter::Contact {
        constant: hbvib::Constant::Gap,
        contact: Some(0),
    };
    let solver = tight(7);
    let sweep = |gap: f64, near: f64| {
        let range = omega_range(0.9 * near, 1.1 * near);
        forced_response(&design(gap).model(), &solver, &range, &mut Hooks::default()).unwrap()
    };
    let first = sweep(0.5, 1.05);
    println!("folds {:?}", first.folds());
    let near = first.folds()[0].omega;
    let branch = tracked(&design(0.5), gap, &solver, (0.5, 0.3), near);
    println!("{:?}: {:?}", branch.status(), branch.parameter());
    assert_eq!(branch.status(), Status::Ok);
    for i in [0, branch.points() / 2, branch.points() - 1] {
        let (p, omega) = (branch.parameter().unwrap()[i], branch.omega()[i]);
        let swept = sweep(p, omega);
        let nearest = swept
            .folds()
            .iter()
            .min_by(|a, b| (a.omega - omega).abs().total_cmp(&(b.omega - omega).abs()))
            .unwrap();
        assert!((nearest.omega / omega - 1.0).abs() < 1e-8, "{p}: {nearest:?} {omega}");
        assert!(
            (nearest.amplitude / branch.amplitude()[i] - 1.0).abs() < 1e-5,
            "{p}: {nearest:?}"
        );
    }
    // The derivative is the slope of the curve.
    let (p, a) = (branch.parameter().unwrap(), branch.amplitude());
    for i in 1..branch.points() {
        let slope = (a[i] - a[i - 1]) / (p[i] - p[i - 1]);
        let mean = 0.5 * (branch.d_amplitude().unwrap()[i] + branch.d_amplitude().unwrap()[i - 1]);
        assert!((slope / mean - 1.0).abs() < 0.05, "{} {slope} {mean}", p[i]);
    }
}
