//! The smallest kick that leads from a motion to another one, against integration of its own by Runge and Kutta: just below it the motion
//! returns, just above it does not, and no kick at other phases that is a few percent smaller leads across.

use crate::common::models::{Structure, dense};
use crate::common::{harmonics, omega_range, one_mass};
use hbvib::{
    Branch, Contact, ContactKind, FloquetOptions, ForcedOptions, Hooks, Kick, MatrixKind, Model, Polynomial,
    SolverOptions, Status, Waves, floquet, forced_response, smallest_kick,
};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// x″ = −g(x, v) + F cos(ωt + φ)
struct Oscillator {
    law: fn(f64, f64) -> f64,
    force: f64,
    omega: f64,
}

impl Oscillator {
    /// The state after a period with the forces at a phase.
    fn period(&self, phase: f64, [mut x, mut v]: [f64; 2]) -> [f64; 2] {
        const STEPS: usize = 60;
        let h = TAU / self.omega / STEPS as f64;
        for i in 0..STEPS {
            let t = i as f64 * h;
            let a = |t: f64, x: f64, v: f64| self.force * (self.omega * t + phase).cos() - (self.law)(x, v);
            let (k1, l1) = (v, a(t, x, v));
            let (k2, l2) = (v + 0.5 * h * l1, a(t + 0.5 * h, x + 0.5 * h * k1, v + 0.5 * h * l1));
            let (k3, l3) = (v + 0.5 * h * l2, a(t + 0.5 * h, x + 0.5 * h * k2, v + 0.5 * h * l2));
            let (k4, l4) = (v + h * l3, a(t + h, x + h * k3, v + h * l3));
            x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
            v += h / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4);
        }
        [x, v]
    }

    /// The motion that attracts from a start.
    fn attracted(&self, phase: f64, start: [f64; 2]) -> [f64; 2] {
        (0..500).fold(start, |z, _| self.period(phase, z))
    }

    /// Whether a kick of the motion that attracts from `near` leads to another one.
    fn leads_across(&self, phase: f64, near: [f64; 2], impulse: f64) -> bool {
        let lower = self.attracted(phase, near);
        let kicked = self.attracted(phase, [lower[0], lower[1] + impulse]);
        (kicked[0] - lower[0]).hypot(kicked[1] - lower[1]) > 0.1 * lower[0].hypot(lower[1])
    }
}

fn all(model: &Model, solver: &SolverOptions, range: (f64, f64), omega: f64, branches: usize) -> Branch {
    let range = ForcedOptions {
        at: &[omega],
        branches,
        ..omega_range(range.0, range.1)
    };
    forced_response(model, solver, &range, &mut Hooks::default()).unwrap()
}

fn check(oscillator: &Oscillator, near: impl Fn(f64) -> [f64; 2], kick: &Kick) {
    println!("{kick:?}");
    assert_eq!(kick.status, Status::Ok);
    assert!(kick.verified && kick.multiplier > 1.0);
    assert!((kick.returning / kick.impulse - 1.0).abs() < 2e-3 && kick.returning.abs() < kick.impulse.abs());
    assert!((kick.velocity / kick.impulse - 1.0).abs() < 1e-12);
    let phase = kick.phase;
    assert!(oscillator.leads_across(phase, near(phase), 1.003 * kick.impulse));
    assert!(!oscillator.leads_across(phase, near(phase), 0.996 * kick.impulse));
    for i in 0..24 {
        let phase = TAU * f64::from(i) / 24.0;
        for sign in [1.0, -1.0] {
            let impulse = sign * 0.97 * kick.impulse.abs();
            assert!(
                !oscillator.leads_across(phase, near(phase), impulse),
                "{phase} {impulse}"
            );
        }
    }
}

#[test]
fn a_kick_leads_from_the_sweep_to_the_detached_curve() {
    let damper = Polynomial::scalar(&[], &[0.0, 0.0, -0.05, 0.0, 0.012]).unwrap();
    let contact = Contact::between(0, None, ContactKind::Polynomial(damper));
    let model = one_mass(0.05, &contact, 0.015);
    let found = all(&model, &harmonics(9), (0.9, 1.1), 1.0, 2);
    let child = &found.children()[0];
    let lower = found.at(0)[0].point;
    let saddle = child
        .at(0)
        .iter()
        .min_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
        .unwrap();
    let kick = smallest_kick(
        &model,
        (&found, lower),
        (child, saddle.point),
        (0, 12),
        &mut Hooks::default(),
    )
    .unwrap();
    let oscillator = Oscillator {
        law: |x, v| x + 0.05 * v - 0.05 * v.powi(3) + 0.012 * v.powi(5),
        force: 0.015,
        omega: 1.0,
    };
    check(&oscillator, |_| [0.0, 0.0], &kick);
    // The multiplier of the saddle by shooting, from the data.
    assert!((kick.multiplier - 1.111_498_3).abs() < 1e-6);
    // The estimate is of first order only.
    assert!((kick.estimate / kick.impulse).abs() > 0.5 && (kick.estimate / kick.impulse).abs() < 1.5);
}

#[test]
fn a_kick_leads_from_the_upper_to_the_lower_motion_of_a_hardening_spring() {
    let model = one_mass(0.1, &Contact::cubic(0, None, 0.0, 0.1), 0.18);
    let omega = 1.101_766_436_4;
    let found = all(&model, &harmonics(7), (0.9, 1.3), omega, 0);
    let mut at: Vec<_> = found.at(0).to_vec();
    at.sort_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    assert_eq!(at.len(), 3, "{at:?}");
    let oscillator = Oscillator {
        law: |x, v| x + 0.1 * v + 0.1 * x.powi(3),
        force: 0.18,
        omega,
    };
    let (upper, saddle) = (at[2].point, at[1].point);
    let kick = smallest_kick(
        &model,
        (&found, upper),
        (&found, saddle),
        (0, 12),
        &mut Hooks::default(),
    )
    .unwrap();
    let mut x = vec![num_complex::Complex64::ZERO; found.harmonics() + 1];
    found.harmonics_at(upper, &mut x).unwrap();
    let near = |phase: f64| {
        let turn = |h: usize| x[h] * num_complex::Complex64::cis(h as f64 * phase);
        let numbers = 0..x.len();
        let velocity = |h: usize| -(h as f64) * omega * turn(h).im;
        [numbers.clone().map(|h| turn(h).re).sum(), numbers.map(velocity).sum()]
    };
    check(&oscillator, near, &kick);
}

#[test]
fn points_that_are_no_pair_are_refused() {
    let model = one_mass(0.1, &Contact::cubic(0, None, 0.0, 0.1), 0.18);
    let found = all(&model, &harmonics(3), (0.9, 1.3), 1.101_766_436_4, 0);
    let mut at: Vec<_> = found.at(0).to_vec();
    at.sort_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    let refused = |point: usize, saddle: usize, dof: usize, phases: usize, words: &str| {
        let e = smallest_kick(
            &model,
            (&found, point),
            (&found, saddle),
            (dof, phases),
            &mut Hooks::default(),
        )
        .unwrap_err();
        assert!(e.message().contains(words), "{}", e.message());
    };
    refused(at[0].point, at[2].point, 0, 8, "one unstable direction");
    refused(at[0].point, at[1].point, 1, 8, "dof = 1");
    refused(at[0].point, at[1].point, 0, 0, "phases = 0");
    refused(at[0].point, 0, 0, 8, "request it with `at`");
    refused(at[1].point, at[1].point, 0, 8, "one motion");
}

/// Two oscillators without connection, both in their unstable motion: two directions in which perturbations grow.
#[test]
fn a_saddle_with_two_unstable_directions_is_refused() {
    let unit = [1.0, 0.0, 0.0, 1.0];
    let damping = [0.05, 0.0, 0.0, 0.05];
    let mut model = dense(&unit, &unit).damping(&damping).build();
    for (dof, force) in [(0, 0.015), (1, 0.01866)] {
        let damper = Polynomial::scalar(&[], &[0.0, 0.0, -0.05, 0.0, 0.012]).unwrap();
        model
            .add_contact(&Contact::between(dof, None, ContactKind::Polynomial(damper)))
            .unwrap();
        model.add_force(dof, 1, force.into()).unwrap();
    }
    let at = |amplitudes: [f64; 2]| {
        // At the resonance the motion lags by a quarter of the period.
        let mut guess = vec![Complex64::new(0.0, 0.0); 4];
        for (z, a) in guess[2..].iter_mut().zip(amplitudes) {
            *z = Complex64::new(0.0, -a);
        }
        let range = ForcedOptions {
            guess: Some(&guess),
            ..omega_range(1.0, 1.0)
        };
        forced_response(&model, &harmonics(5), &range, &mut Hooks::default()).unwrap()
    };
    let (lower, one, two) = (at([0.325, 0.43]), at([1.166, 0.43]), at([1.166, 1.05]));
    let kick = |saddle: &Branch| smallest_kick(&model, (&lower, 0), (saddle, 0), (0, 8), &mut Hooks::default());
    assert!(kick(&one).unwrap().multiplier > 1.1);
    let e = kick(&two).unwrap_err();
    assert!(e.message().contains("another one has the modulus"), "{}", e.message());
}

const SECTORS: usize = 4;

/// Hardening oscillators in a ring, whose forces travel as a wave of one diameter: x_s″ = −x_s − 0.1 x_s′ − 0.1 x_s³ + 0.05 (x_{s−1} −
/// 2 x_s + x_{s+1}) + F cos(ωt − 2πs/N). Kicks each of them when its own forces have the phase 0, in the hundredth period of the motion
/// that attracts from `near`, and returns the largest motion of each sector in some periods after it.
fn amplitudes_after_kicks((force, omega): (f64, f64), near: Complex64, impulse: f64) -> [f64; SECTORS] {
    const STEPS: usize = 80;
    type Ring = [[f64; 2]; SECTORS];
    let h = TAU / omega / STEPS as f64;
    let lag = |s: usize| TAU * s as f64 / SECTORS as f64;
    let rate = |t: f64, z: &Ring| -> Ring {
        std::array::from_fn(|s| {
            let [x, v] = z[s];
            let sides = z[(s + SECTORS - 1) % SECTORS][0] + z[(s + 1) % SECTORS][0];
            let spring = x + 0.1 * x.powi(3) - 0.05 * (sides - 2.0 * x);
            [v, force * (omega * t - lag(s)).cos() - spring - 0.1 * v]
        })
    };
    let plus = |z: &Ring, k: &Ring, h: f64| -> Ring {
        std::array::from_fn(|s| [z[s][0] + h * k[s][0], z[s][1] + h * k[s][1]])
    };
    let mut z: Ring = std::array::from_fn(|s| {
        let turned = near * Complex64::cis(-lag(s));
        [turned.re, -omega * turned.im]
    });
    let mut largest = [0.0_f64; SECTORS];
    for step in 0..120 * STEPS {
        for (s, z) in z.iter_mut().enumerate() {
            if step == 100 * STEPS + s * STEPS / SECTORS {
                z[1] += impulse;
            }
        }
        let t = step as f64 * h;
        let k1 = rate(t, &z);
        let k2 = rate(t + 0.5 * h, &plus(&z, &k1, 0.5 * h));
        let k3 = rate(t + 0.5 * h, &plus(&z, &k2, 0.5 * h));
        let k4 = rate(t + h, &plus(&z, &k3, h));
        for (k, weight) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
            z = plus(&z, &k, weight * h / 6.0);
        }
        if step >= 110 * STEPS {
            for (largest, z) in largest.iter_mut().zip(&z) {
                *largest = largest.max(z[0].abs());
            }
        }
    }
    largest
}

/// Why kicks of waves are refused: even one that strikes each sector in its turn, at the same phase of its own forces, leaves a motion
/// that is no wave, and the saddle of the wave has unstable directions that are none.
#[test]
fn a_kicked_wave_is_no_wave_any_more() {
    let (force, omega) = (0.25, 1.185);
    let model = Structure::cyclic(1, SECTORS)
        .mass(&[1.0])
        .stiffness(&[1.1])
        .damping(&[0.1])
        .next(MatrixKind::Stiffness, &[-0.05])
        .contact(Contact::cubic(0, None, 0.0, 0.1))
        .wave(1)
        .force(0, 1, force)
        .build();
    let found = all(&model, &harmonics(7), (0.9, 1.5), omega, 0);
    let mut at: Vec<_> = found.at(0).to_vec();
    at.sort_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    let (lower, saddle) = (at[0].point, at[1].point);
    let points = ((&found, lower), (&found, saddle));
    let e = smallest_kick(&model, points.0, points.1, (0, 8), &mut Hooks::default()).unwrap_err();
    assert!(e.message().contains("no kick leaves a wave"), "{}", e.message());
    let mut x = vec![Complex64::ZERO; found.harmonics() + 1];
    found.harmonics_at(lower, &mut x).unwrap();
    let spread = |impulse: f64| {
        let sectors = amplitudes_after_kicks((force, omega), x[1], impulse);
        let [least, most] = [f64::min, f64::max].map(|f| sectors.into_iter().reduce(f).unwrap());
        println!("impulse {impulse}: {sectors:.4?}");
        most / least - 1.0
    };
    // Without a kick the integration is a wave, but for the times at which motions are sampled.
    assert!(spread(0.0) < 2e-3);
    assert!(spread(1.07) > 0.05);
    let options = FloquetOptions {
        waves: Waves::Wheel,
        ..FloquetOptions::default()
    };
    let stability = floquet(&model, &found, saddle, &options, &mut Hooks::default()).unwrap();
    assert_eq!(stability.unstable, 4);
}
