//! The largest damping ratio of a nonlinear mode over a parameter is that of a Jenkins element in closed form, and in the
//! ring damper that of backbones computed at single values.

use crate::common::{BASE, Blisk, amplitude_range};
use crate::design::{Design, tight};
use hbvib::{
    Branch, Constant, Contact, Follow, Hooks, MatrixKind, ModeChoice, ModeOptions, Parameter, ParameterRange,
    SolverOptions, Status, nonlinear_mode, parameter_response,
};
use std::f64::consts::{PI, TAU};

fn constant(constant: Constant) -> Parameter<'static> {
    Parameter::Contact {
        constant,
        contact: Some(0),
    }
}

fn tracked(design: &Design, parameter: Parameter<'_>, solver: &SolverOptions, ends: (f64, f64), omega: f64) -> Branch {
    let range = ParameterRange {
        start: ends.0,
        stop: ends.1,
        at: &[],
        follow: Follow::ModeMaxDamping {
            omega,
            log10_range: None,
        },
        response: None,
    };
    parameter_response(&design.model(), solver, parameter, &range, &mut Hooks::default()).unwrap()
}

/// A mass on a spring and a Jenkins element, at H = 1.
#[derive(Clone, Copy)]
struct Jenkins {
    mass: f64,
    damping: f64,
    stiffness: f64,
    kt: f64,
    limit: f64,
}

impl Jenkins {
    fn design(&self) -> Design {
        Design {
            contacts: vec![Contact::jenkins(0, None, self.kt, 0.5, self.limit / 0.5)],
            forces: vec![(0, 1, 1.0.into())],
            ..Design::plain(1, [vec![self.mass], vec![self.damping], vec![self.stiffness]])
        }
    }

    /// Damping ratio and angular frequency at an amplitude in units of that of the onset.
    fn at(&self, a: f64) -> (f64, f64) {
        let angle = (1.0 - 2.0 / a).acos();
        let stiffness = self.stiffness + self.kt / PI * (angle - 0.5 * (2.0 * angle).sin());
        let omega = (stiffness / self.mass).sqrt();
        let onset = self.limit / self.kt;
        let loss = 4.0 * self.limit * onset * (a - 1.0) + PI * self.damping * omega * (a * onset).powi(2);
        (loss / (TAU * stiffness * (a * onset).powi(2)), omega)
    }

    /// Largest damping ratio, its amplitude in units of that of the onset, and its frequency.
    fn largest(&self) -> (f64, f64, f64) {
        let (mut low, mut high) = (1.0 + 1e-9, 10.0);
        let golden = 0.5 * (5f64.sqrt() - 1.0);
        for _ in 0..200 {
            let (a, b) = (high - golden * (high - low), low + golden * (high - low));
            if self.at(a).0 > self.at(b).0 {
                high = b;
            } else {
                low = a;
            }
        }
        let a = 0.5 * (low + high);
        (self.at(a).0, a, self.at(a).1)
    }
}

#[test]
fn largest_damping_of_a_jenkins_element_is_that_in_closed_form() {
    let base = Jenkins {
        mass: 2.0,
        damping: 0.04,
        stiffness: 5.0,
        kt: 3.0,
        limit: 0.7,
    };
    let scaled = Jenkins {
        mass: 0.3,
        damping: 2.0,
        stiffness: 4e5,
        kt: 6e5,
        limit: 40.0,
    };
    for base in [base, scaled] {
        let near = ((base.stiffness + base.kt) / base.mass).sqrt();
        let design = base.design();
        let damping = Parameter::Factor {
            which: MatrixKind::Damping,
        };
        let mass = Parameter::Factor {
            which: MatrixKind::Mass,
        };
        let changed = |index: usize, p: f64| match index {
            0 => Jenkins { kt: p, ..base },
            1 => Jenkins { limit: 0.5 * p, ..base },
            2 => Jenkins {
                damping: p * base.damping,
                ..base
            },
            _ => Jenkins {
                mass: p * base.mass,
                ..base
            },
        };
        let cases = [
            (constant(Constant::Kt), (0.5 * base.kt, 3.0 * base.kt)),
            (constant(Constant::Preload), (2.0 * base.limit, 0.4 * base.limit)),
            (damping, (0.5, 4.0)),
            (mass, (0.8, 2.0)),
        ];
        for (index, (parameter, ends)) in cases.into_iter().enumerate() {
            let branch = tracked(&design, parameter, &tight(1), ends, near);
            assert_eq!(branch.status(), Status::Ok, "{parameter:?} {:?}", branch.parameter());
            let slopes = branch.d_damping().unwrap();
            for (i, &found) in slopes.iter().enumerate() {
                let p = branch.parameter().unwrap()[i];
                let jenkins = changed(index, p);
                let (largest, a, omega) = jenkins.largest();
                let mode = branch.mode_at(i).unwrap();
                assert!(
                    (mode.damping_ratio / largest - 1.0).abs() < 1e-10,
                    "{parameter:?} {p}: {}",
                    mode.damping_ratio
                );
                let onset = jenkins.limit / jenkins.kt * jenkins.mass.sqrt();
                assert!(
                    (10f64.powf(mode.log10_amplitude) / (a * onset) - 1.0).abs() < 1e-6,
                    "{parameter:?} {p}"
                );
                assert!((branch.omega()[i] / omega - 1.0).abs() < 1e-6);
                let h = 1e-4 * p;
                let slope = (changed(index, p + h).largest().0 - changed(index, p - h).largest().0) / (2.0 * h);
                assert!(
                    (found - slope).abs() * p < 1e-7 * largest,
                    "{parameter:?} {p}: {found} {slope}"
                );
            }
        }
    }
}

#[test]
fn largest_damping_of_the_ring_damper_is_that_of_single_backbones() {
    let heavy = Blisk {
        ring_mass: Some(0.05),
        engine_order: 4,
        ..BASE
    };
    for (case, near) in [(BASE, 208.8 * TAU), (heavy, 480.0 * TAU)] {
        let design = Design::ring_damper(&case, 300.0);
        let kt = design.contacts[0].constant(Constant::Kt);
        let solver = tight(5);
        let branch = tracked(&design, constant(Constant::Kt), &solver, (kt, 0.2 * kt), near);
        println!("{} points, {:?}", branch.points(), branch.d_damping());
        assert_eq!(branch.status(), Status::Ok);
        for i in [0, branch.points() / 2, branch.points() - 1] {
            let mut other = design.clone();
            other.contacts[0]
                .set(Constant::Kt, branch.parameter().unwrap()[i])
                .unwrap();
            let at = branch.mode_at(i).unwrap();
            let options = ModeOptions {
                choice: ModeChoice::Near(near),
                ..amplitude_range(at.log10_amplitude - 0.4, at.log10_amplitude + 0.4)
            };
            let backbone = nonlinear_mode(&other.model(), &solver, &options, &mut Hooks::default()).unwrap();
            let peak = backbone.peaks()[0];
            let expected = backbone.mode_at(peak.point).unwrap();
            assert!(
                (at.damping_ratio / expected.damping_ratio - 1.0).abs() < 1e-9,
                "{i}: {at:?} {expected:?}"
            );
            assert!((at.log10_amplitude - expected.log10_amplitude).abs() < 1e-5);
            assert!((branch.omega()[i] / peak.omega - 1.0).abs() < 1e-7);
        }
    }
}
