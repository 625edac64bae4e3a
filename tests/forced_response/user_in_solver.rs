//! Forces of the caller inside the analyses: equal to the library's own laws, with states, with a force at
//! rest, with wrong tangents.

use crate::common::models::dense;
use crate::common::{amplitude_range, at_dof, harmonics, omega_range};
use hbvib::{
    Branch, Call, Contact, ContactKind, ForcedOptions, Hooks, ModeOptions, Model, Polynomial, Result, SolverOptions,
    Status, Tangent, User, UserForce, check_jacobian, forced_response, nonlinear_mode,
};
use num_complex::Complex64;
use std::f64::consts::PI;
use std::sync::Arc;

/// Two masses on springs; the contact acts on the second.
fn model(contact: &Contact, constant: f64) -> Model {
    let (m, k) = ([1.0, 0.0, 0.0, 0.5], [3.0, -1.0, -1.0, 2.0]);
    let mut model = dense(&m, &k).rayleigh(0.02, 0.01).force(0, 1, 0.1).build();
    if constant != 0.0 {
        model.add_force(1, 0, Complex64::new(constant, 0.0)).unwrap();
    }
    model.add_contact(contact).unwrap();
    model
}

const AT: [f64; 5] = [1.1, 1.4, 1.47, 1.6, 2.0];

fn respond(model: &Model, solver: &SolverOptions) -> Result<Branch> {
    let range = ForcedOptions {
        at: &AT,
        ..omega_range(1.0, 2.4)
    };
    let solver = at_dof(1, *solver);
    forced_response(model, &solver, &range, &mut Hooks::default())
}

/// Largest difference of two branches at the frequencies asked for, in all harmonics, relative to the
/// largest one.
fn apart(a: &Branch, b: &Branch) -> f64 {
    assert_eq!((a.status(), b.status()), (Status::Ok, Status::Ok));
    let harmonics = |branch: &Branch, point: usize| {
        let mut x = vec![Complex64::ZERO; (branch.harmonics() + 1) * branch.ndof()];
        branch.harmonics_at(point, &mut x).unwrap();
        x
    };
    let mut worst = 0.0_f64;
    for i in 0..AT.len() {
        assert!(!a.at(i).is_empty() && a.at(i).len() == b.at(i).len());
        for (p, q) in a.at(i).iter().zip(b.at(i)) {
            let (x, y) = (harmonics(a, p.point), harmonics(b, q.point));
            let size = x.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
            let gap = x.iter().zip(&y).fold(0.0_f64, |m, (x, y)| m.max((x - y).norm()));
            worst = worst.max(gap / size);
        }
    }
    worst
}

fn over(law: User) -> Contact {
    Contact::over(vec![1], ContactKind::User(law))
}

/// f = at_rest + u + 0.8 u³ + 0.1 u² v with lengths and forces in a unit, and tangents times a factor.
struct Curved {
    static_force: f64,
    tangents: f64,
    unit: f64,
}

const RIGHT: Curved = Curved {
    static_force: 0.0,
    tangents: 1.0,
    unit: 1.0,
};

impl UserForce for Curved {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        for j in 0..call.samples {
            let (u, v) = (call.u[j] / self.unit, call.v[j] / self.unit);
            assert!(u.is_finite() && v.is_finite());
            call.f[j] = self.static_force + self.unit * (u + 0.8 * u * u * u + 0.1 * u * u * v);
            call.df_du[j] = self.tangents * (1.0 + 2.4 * u * u + 0.2 * u * v);
            call.df_dv[j] = self.tangents * 0.1 * u * u;
        }
        0
    }
}

fn curved(force: Curved, odd: bool) -> User {
    User {
        odd,
        ..User::new(Arc::new(force), 1, 0).unwrap()
    }
}

/// The same as the library's own.
fn polynomial() -> Contact {
    use hbvib::Monomial;
    let term = |coefficient, displacements: &'static [u32], velocities: &'static [u32]| Monomial {
        direction: 0,
        coefficient,
        displacements,
        velocities,
    };
    let law = Polynomial::new(1, &[term(1.0, &[1], &[]), term(0.8, &[3], &[]), term(0.1, &[2], &[1])]).unwrap();
    Contact::over(vec![1], ContactKind::Polynomial(law))
}

#[test]
fn a_callback_that_is_a_polynomial_has_its_branch_and_its_mode() {
    let solver = SolverOptions::default().fixed();
    let (own, library) = (model(&over(curved(RIGHT, true)), 0.0), model(&polynomial(), 0.0));
    let (a, b) = (respond(&own, &solver).unwrap(), respond(&library, &solver).unwrap());
    println!("{} and {} points, apart {:.1e}", a.points(), b.points(), apart(&a, &b));
    assert!(apart(&a, &b) < 1e-10);
    assert_eq!(a.reduction(), b.reduction());

    let range = ModeOptions {
        at: &[-2.0, -0.5, 0.0],
        ..amplitude_range(-3.0, 0.3)
    };
    let [a, b] = [own, library].map(|m| nonlinear_mode(&m, &solver, &range, &mut Hooks::default()).unwrap());
    for i in 0..3 {
        let (p, q) = (a.at(i)[0], b.at(i)[0]);
        println!("mode: frequencies {} and {}", p.omega, q.omega);
        assert!((p.omega / q.omega - 1.0).abs() < 1e-9);
    }
}

#[test]
fn a_mode_does_not_depend_on_the_unit_of_its_amplitude() {
    let solver = harmonics(5);
    let frequencies = |log10: f64| {
        let force = Curved {
            unit: 10f64.powf(log10),
            ..RIGHT
        };
        let at = [-1.0 + log10, 0.0 + log10];
        let range = ModeOptions {
            at: &at,
            ..amplitude_range(-2.0 + log10, 0.3 + log10)
        };
        let model = model(&over(curved(force, true)), 0.0);
        let branch = nonlinear_mode(&model, &solver, &range, &mut Hooks::default()).unwrap();
        assert_eq!(branch.status(), Status::Ok);
        [0, 1].map(|i| branch.at(i)[0].omega)
    };
    let expected = frequencies(0.0);
    for log10 in [-12.0, -9.0, -6.0, 4.0, 9.0] {
        let found = frequencies(log10);
        println!("unit 1e{log10}: {found:?}, {expected:?}");
        for (a, b) in found.iter().zip(&expected) {
            assert!((a / b - 1.0).abs() < 1e-8);
        }
    }
}

/// Jenkins' slider, stepped from sample to sample: z is its force.
struct Slider {
    stiffness: f64,
    limit: f64,
}

impl UserForce for Slider {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        let n = call.samples;
        let mut z = call.states.z0[0];
        let mut before = call.u[n - 1];
        for j in 0..n {
            let trial = z + self.stiffness * (call.u[j] - before);
            let sticks = trial.abs() <= self.limit;
            z = trial.clamp(-self.limit, self.limit);
            call.f[j] = z;
            call.states.z[j] = z;
            call.states.df_dz[j] = 1.0;
            if sticks {
                call.states.dz_dz[j] = 1.0;
                call.states.dz_du[j] = self.stiffness;
                call.states.dz_du_before[j] = -self.stiffness;
            }
            before = call.u[j];
        }
        0
    }
}

fn slider(samples: usize) -> User {
    let force = Slider {
        stiffness: 1.0,
        limit: 0.05,
    };
    User {
        states: 1,
        velocity: false,
        odd: true,
        ..User::new(Arc::new(force), 1, samples).unwrap()
    }
}

#[test]
fn a_slider_with_a_state_responds_like_the_librarys_own() {
    let library = model(&Contact::jenkins(1, None, 1.0, 0.05, 1.0), 0.0);
    let solver = harmonics(5);
    let exact = respond(&library, &solver).unwrap();
    let mut errors = Vec::new();
    for samples in [128, 512, 2048] {
        let own = respond(&model(&over(slider(samples)), 0.0), &solver).unwrap();
        let sampled = SolverOptions { samples, ..solver };
        let same = apart(&respond(&library, &sampled).unwrap(), &own);
        errors.push(apart(&exact, &own));
        println!(
            "{samples} samples: from the sampled law {same:.1e}, from the exact {:.1e}",
            errors[errors.len() - 1]
        );
        assert!(same < 1e-9);
    }
    // Samples are the only error, and it falls with their square.
    assert!(errors[2] < errors[0] / 100.0 && errors[2] < 1e-5);
}

#[test]
fn a_force_at_rest_is_a_constant_load() {
    let solver = SolverOptions::default().fixed();
    let loaded = Curved {
        static_force: 0.7,
        ..RIGHT
    };
    let a = respond(&model(&over(curved(loaded, false)), 0.0), &solver).unwrap();
    let b = respond(&model(&over(curved(RIGHT, false)), -0.7), &solver).unwrap();
    println!("apart {:.1e}", apart(&a, &b));
    assert!(apart(&a, &b) < 1e-9);
    // A load this large has no start near the unloaded structure.
    let heavy = Curved {
        static_force: -30.0,
        ..RIGHT
    };
    let a = respond(&model(&over(curved(heavy, false)), 0.0), &solver).unwrap();
    let b = respond(&model(&over(curved(RIGHT, false)), 30.0), &solver).unwrap();
    assert!(apart(&a, &b) < 1e-9);

    let loaded = || Curved {
        static_force: 0.7,
        ..RIGHT
    };
    let range = amplitude_range(-3.0, 0.0);
    // A mode counts from the static state under either load.
    let mode = |law: Curved, force: f64| {
        let mut own = model(&Contact::cubic(0, None, 0.0, 1.0), force);
        own.add_contact(&over(curved(law, false))).unwrap();
        nonlinear_mode(&own, &solver, &range, &mut Hooks::default()).unwrap()
    };
    let (own, outside) = (mode(loaded(), 0.0), mode(RIGHT, -0.7));
    let last = |branch: &Branch| *branch.omega().last().unwrap();
    assert!((last(&own) / last(&outside) - 1.0).abs() < 1e-9);
    let e = respond(&model(&over(curved(loaded(), true)), 0.0), &solver).unwrap_err();
    assert!(
        e.status == Status::Argument && e.message().contains("contact 0") && e.message().contains("odd"),
        "{e}"
    );
}

#[test]
fn wrong_tangents_never_give_a_wrong_result() {
    let solver = SolverOptions {
        max_points: 400,
        tolerance: 0.0,
        ..SolverOptions::default()
    };
    let right = respond(&model(&over(curved(RIGHT, true)), 0.0), &solver).unwrap();
    for tangents in [-1.0, 0.0, 0.5, 2.0, 10.0] {
        let wrong = Curved { tangents, ..RIGHT };
        match respond(&model(&over(curved(wrong, true)), 0.0), &solver) {
            Err(e) => {
                println!("tangents times {tangents}: {e}");
                assert_eq!(e.status, Status::NoConvergence);
            }
            // Where Newton's method gets along, the solution is the right one.
            Ok(found) if found.status() == Status::Ok => {
                println!("tangents times {tangents}: apart {:.1e}", apart(&right, &found));
                assert!(apart(&right, &found) < 1e-8);
            }
            Ok(found) => {
                println!(
                    "tangents times {tangents}: {:?} after {} points",
                    found.status(),
                    found.points()
                );
                let (short, many) = (Status::StoppedStepTooSmall, Status::StoppedMaxPoints);
                assert!(found.status() == short || found.status() == many);
                // The points there are solve the problem.
                assert!(found.residual().iter().all(|r| *r < 1e-8));
            }
        }
    }
}

/// Two motions and two states of rates, by the trapezoidal rule: z₁' = v₁ − z₁|z₁|v₂, z₂' = u₁ − z₂, with
/// one entry of one derivative wrong.
struct Rates {
    wrong: Option<(Tangent, usize, usize)>,
}

impl UserForce for Rates {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        let n = call.samples;
        let half = PI / (call.omega * n as f64);
        let states = &mut call.states;
        let mut z = [states.z0[0], states.z0[1]];
        let (u, v) = (call.u, call.v);
        for j in 0..n {
            let i = (j + n - 1) % n;
            // Explicit in the first state, so that no equation has to be solved.
            let drag = z[0] * z[0].abs();
            let (v1, v2) = (half * (v[2 * i] + v[2 * j]), half * (v[2 * i + 1] + v[2 * j + 1]));
            let pull = half * (u[2 * i] + u[2 * j]);
            let next = [z[0] + v1 - drag * v2, ((1.0 - half) * z[1] + pull) / (1.0 + half)];
            states.z[2 * j..2 * j + 2].copy_from_slice(&next);
            states.dz_dz[4 * j] = 1.0 - 2.0 * z[0].abs() * v2;
            states.dz_dz[4 * j + 3] = (1.0 - half) / (1.0 + half);
            for by_v in [&mut states.dz_dv_before, &mut states.dz_dv] {
                by_v[4 * j] = half;
                by_v[4 * j + 1] = -half * drag;
            }
            for by_u in [&mut states.dz_du_before, &mut states.dz_du] {
                by_u[4 * j + 2] = half / (1.0 + half);
            }
            states.dz_domega[2 * j] = -(v1 - drag * v2) / call.omega;
            states.dz_domega[2 * j + 1] = -(half * (-z[1] - next[1]) + pull) / (call.omega * (1.0 + half));
            let (f, u, v) = (
                &mut call.f[2 * j..2 * j + 2],
                &u[2 * j..2 * j + 2],
                &v[2 * j..2 * j + 2],
            );
            f[0] = next[0] * (1.0 + u[1] * u[1]) + 0.3 * v[0];
            f[1] = next[1].sin() + u[0] * v[1];
            states.df_dz[4 * j] = 1.0 + u[1] * u[1];
            states.df_dz[4 * j + 3] = next[1].cos();
            call.df_du[4 * j + 1] = 2.0 * next[0] * u[1];
            call.df_du[4 * j + 2] = v[1];
            call.df_dv[4 * j] = 0.3;
            call.df_dv[4 * j + 3] = u[0];
            z = next;
            if let Some((tangent, row, column)) = self.wrong {
                let block: &mut [f64] = match tangent {
                    Tangent::ForceByMotion => call.df_du,
                    Tangent::ForceByVelocity => call.df_dv,
                    Tangent::ForceByState => states.df_dz,
                    Tangent::StateByState => states.dz_dz,
                    Tangent::StateByMotionBefore => states.dz_du_before,
                    Tangent::StateByMotion => states.dz_du,
                    Tangent::StateByVelocityBefore => states.dz_dv_before,
                    Tangent::StateByVelocity => states.dz_dv,
                    Tangent::StateByFrequency => states.dz_domega,
                };
                let width = if tangent == Tangent::StateByFrequency { 1 } else { 2 };
                block[2 * width * j + width * row + column] *= -1.0;
            }
        }
        0
    }
}

#[test]
fn differences_find_the_wrong_tangent_and_no_other() {
    let with = |force: Arc<dyn UserForce>, states: usize| {
        let law = User {
            states,
            ..User::new(force, 2, 0).unwrap()
        };
        let mut model = Model::new(3).unwrap();
        model
            .add_contact(&Contact::over(vec![2, 0], ContactKind::User(law)))
            .unwrap();
        check_jacobian(&model, 0, 1.3, &[0.8, 0.5]).unwrap()
    };
    let found = with(Arc::new(Rates { wrong: None }), 2);
    println!("{found:?}");
    assert!(found.gap < 1e-8);
    for (tangent, row, column) in [
        (Tangent::ForceByMotion, 0, 1),
        (Tangent::ForceByVelocity, 1, 1),
        (Tangent::StateByState, 1, 1),
        (Tangent::StateByMotionBefore, 1, 0),
        (Tangent::StateByMotion, 1, 0),
        (Tangent::StateByVelocityBefore, 0, 0),
        (Tangent::StateByVelocity, 0, 1),
        (Tangent::StateByFrequency, 1, 0),
    ] {
        let wrong = Some((tangent, row, column));
        let found = with(Arc::new(Rates { wrong }), 2);
        assert_eq!(
            (found.tangent, found.row, found.column),
            (tangent, row, column),
            "{found:?}"
        );
        // The sign is wrong: given and difference are opposite.
        assert!((found.given / found.difference + 1.0).abs() < 1e-5, "{found:?}");
        assert!(found.gap > 1e-3);
    }
    // A wrong derivative by a state shows in all that goes through the state.
    let wrong = Some((Tangent::ForceByState, 1, 1));
    let found = with(Arc::new(Rates { wrong }), 2);
    assert!(found.row == 1 && found.gap > 0.1, "{found:?}");

    // Without memory.
    let mut model = model(&over(curved(RIGHT, true)), 0.0);
    let found = check_jacobian(&model, 0, 2.0, &[1.5]).unwrap();
    println!("{found:?}");
    assert!(found.gap < 1e-8);
    let wrong = Curved { tangents: 2.0, ..RIGHT };
    model.add_contact(&over(curved(wrong, true))).unwrap();
    let found = check_jacobian(&model, 1, 2.0, &[1.5]).unwrap();
    assert!(found.tangent == Tangent::ForceByMotion && (found.given / found.difference - 2.0).abs() < 1e-6);
    for (contact, omega, amplitudes, status) in [
        (2, 2.0, &[1.5][..], Status::Index),
        (0, 0.0, &[1.5], Status::Argument),
        (0, 2.0, &[-1.0], Status::Argument),
        (0, 2.0, &[f64::NAN], Status::Argument),
        (0, 2.0, &[1.0, 1.0], Status::Dimension),
    ] {
        assert_eq!(
            check_jacobian(&model, contact, omega, amplitudes).unwrap_err().status,
            status
        );
    }
    let library = self::model(&polynomial(), 0.0);
    let e = check_jacobian(&library, 0, 2.0, &[1.0]).unwrap_err();
    assert!(e.status == Status::Argument && e.message().contains("no law of the caller"));
}
