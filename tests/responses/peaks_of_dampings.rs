//! Peaks of linear structures of every size and damping, also under gyroscopic forces: against maxima of their closed form.

use crate::common::depth::some_of;
use crate::common::{at_dof, harmonics, omega_range};
use hbvib::{
    Contact, ForcedOptions, Hooks, MatrixKind, MatrixView, Measure, Model, Response, SolverOptions, Special, Speed,
    forced_response,
};
use num_complex::Complex64;
use std::f64::consts::PI;

/// A force that acts and a displacement that is watched.
const PLACES: (usize, usize) = (0, 2);

/// The degree of freedom of a slider that sticks, and its stiffness.
const SLIDER: (usize, f64) = (1, 0.7);

/// Springs of 1 between n masses of 1 and two walls.
fn springs(n: usize) -> Vec<f64> {
    let mut k = vec![0.0; n * n];
    for i in 0..n {
        k[i * (n + 1)] = 2.0;
        if i > 0 {
            k[i * n + i - 1] = -1.0;
            k[(i - 1) * n + i] = -1.0;
        }
    }
    k
}

fn natural(n: usize, k: usize) -> f64 {
    2.0 * (0.5 * PI * k as f64 / (n + 1) as f64).sin()
}

/// The modes of a chain, which are sines: natural frequencies, and shapes at some masses.
struct Modes {
    own: Vec<f64>,
    shapes: Vec<[f64; 3]>,
}

impl Modes {
    fn new(n: usize) -> Self {
        let shape =
            |k: usize, i: usize| (2.0 / (n + 1) as f64).sqrt() * (PI * (k * (i + 1)) as f64 / (n + 1) as f64).sin();
        Self {
            own: (1..=n).map(|k| natural(n, k)).collect(),
            shapes: (1..=n).map(|k| [0, 1, 2].map(|i| shape(k, i))).collect(),
        }
    }

    /// The sum over the modes from a force on one mass to another: 1/d(ω_k) for each.
    fn receptance(&self, (a, b): (usize, usize), dynamic: impl Fn(f64) -> Complex64) -> Complex64 {
        let modes = self.own.iter().zip(&self.shapes);
        modes.map(|(own, shape)| shape[a] * shape[b] / dynamic(*own)).sum()
    }
}

/// Maxima of a function between two frequencies; resonances are narrower than `width` nowhere.
fn maxima((low, high): (f64, f64), width: f64, amplitude: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let count = (4.0 * (high - low) / width).ceil() as usize;
    let place = |i: usize| low + (high - low) * i as f64 / count as f64;
    let values: Vec<f64> = (0..=count).map(|i| amplitude(place(i))).collect();
    let mut found = Vec::new();
    for i in 1..count {
        if values[i] > values[i - 1] && values[i] >= values[i + 1] {
            let (mut a, mut b) = (place(i - 1), place(i + 1));
            for _ in 0..60 {
                let (c, d) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
                if amplitude(c) < amplitude(d) { a = c } else { b = d }
            }
            found.push((0.5 * (a + b), amplitude(0.5 * (a + b))));
        }
    }
    found
}

/// Compares the peaks of a sweep in both directions with maxima.
fn check(model: &Model, range: (f64, f64), response: usize, right: &[(f64, f64)], what: &str) {
    let solver = at_dof(response, harmonics(1));
    for (from, to) in [range, (range.1, range.0)] {
        let sweep = omega_range(from, to);
        let branch = forced_response(model, &solver, &sweep, &mut Hooks::default()).unwrap();
        let mut found: Vec<(f64, f64)> = branch.peaks().iter().map(|p| (p.omega, p.amplitude)).collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert_eq!(
            found.len(),
            right.len(),
            "{what} from {from}: {found:?}, right {right:?}"
        );
        for (a, b) in found.iter().zip(right) {
            assert!((a.1 / b.1 - 1.0).abs() < 1e-8, "{what} from {from}: {a:?} {b:?}");
        }
    }
}

fn with_matrix(model: &mut Model, kind: MatrixKind, values: &[f64]) {
    let n = model.ndof();
    model.set_matrix(kind, &MatrixView::dense(n, values)).unwrap();
}

/// A chain with hysteretic or viscous damping, alone and with a slider that sticks, on both sides of every change of method.
#[test]
fn every_size_and_damping_has_every_peak() {
    for &n in some_of(&[5, 33, 101, 150][..], &[5, 33, 99, 101, 150, 400, 620]) {
        let loss = 0.01;
        let modes = Modes::new(n);
        let range = (
            0.4 * natural(n, 1),
            0.5 * (natural(n, 5.min(n - 1)) + natural(n, 6.min(n))),
        );
        for damping in ["loss factor", "structural", "viscous"] {
            for sticks in [false, true] {
                let mut model = Model::new(n).unwrap();
                let k = springs(n);
                let mass: Vec<f64> = (0..n * n).map(|i| f64::from(u8::from(i % (n + 1) == 0))).collect();
                with_matrix(&mut model, MatrixKind::Mass, &mass);
                with_matrix(&mut model, MatrixKind::Stiffness, &k);
                // The viscous damping has the same ratio at the first resonance.
                let beta = loss / natural(n, 5.min(n));
                match damping {
                    "loss factor" => model.set_loss_factor(loss).unwrap(),
                    "structural" => {
                        let part: Vec<f64> = k.iter().map(|k| loss * k).collect();
                        with_matrix(&mut model, MatrixKind::Structural, &part);
                    }
                    _ => model.set_rayleigh(0.0, beta).unwrap(),
                }
                if sticks {
                    model
                        .add_contact(&Contact::jenkins(SLIDER.0, None, SLIDER.1, 1.0, 1e9))
                        .unwrap();
                }
                model.add_force(PLACES.0, 1, 1.0.into()).unwrap();
                let amplitude = |omega: f64| {
                    let dynamic = |own: f64| {
                        let ratio = if damping == "viscous" { beta * omega } else { loss };
                        Complex64::new(own * own - omega * omega, own * own * ratio)
                    };
                    let of = |a, b| modes.receptance((a, b), dynamic);
                    let direct = of(PLACES.0, PLACES.1);
                    if !sticks {
                        return direct.norm();
                    }
                    let through = of(PLACES.0, SLIDER.0) * of(SLIDER.0, PLACES.1) * SLIDER.1;
                    (direct - through / (1.0 + SLIDER.1 * of(SLIDER.0, SLIDER.0))).norm()
                };
                let width = 0.25 * loss * natural(n, 1);
                let right = maxima(range, width, amplitude);
                assert!(right.len() >= 2, "{n} {damping}: {}", right.len());
                check(
                    &model,
                    range,
                    PLACES.1,
                    &right,
                    &format!("{n} masses, {damping}, {sticks}"),
                );
            }
        }
    }
}

/// Masses that move in a plane, with gyroscopic forces at a fixed speed: x + iy is a chain whose modes stay sines, forwards and
/// backwards.
#[test]
fn gyroscopic_structures_of_every_size_have_every_peak() {
    for &n in some_of(&[2, 20, 52][..], &[2, 5, 20, 49, 52, 200]) {
        let modes = Modes::new(n);
        for (gyroscopic, share) in [(0.05, 1.0), (0.6, 1.0), (0.6, 0.25)] {
            let order = 2 * n;
            let damping = 0.01 * natural(n, 1) * share;
            let mut model = Model::new(order).unwrap();
            let (k, mut stiffness) = (springs(n), vec![0.0; order * order]);
            let (mut mass, mut viscous, mut skew) = (stiffness.clone(), stiffness.clone(), stiffness.clone());
            for i in 0..n {
                for j in 0..n {
                    stiffness[i * order + j] = k[i * n + j];
                    stiffness[(n + i) * order + n + j] = k[i * n + j];
                }
                for dof in [i, n + i] {
                    mass[dof * (order + 1)] = 1.0;
                    viscous[dof * (order + 1)] = damping;
                }
                skew[i * order + n + i] = gyroscopic;
                skew[(n + i) * order + i] = -gyroscopic;
            }
            with_matrix(&mut model, MatrixKind::Mass, &mass);
            with_matrix(&mut model, MatrixKind::Stiffness, &stiffness);
            with_matrix(&mut model, MatrixKind::Damping, &viscous);
            with_matrix(&mut model, MatrixKind::Gyroscopic, &skew);
            model.set_speed(Speed::Fixed(1.0)).unwrap();
            model.add_force(PLACES.0, 1, 1.0.into()).unwrap();
            let response = 1.min(n - 1);
            let amplitude = |omega: f64| {
                let sense = |sign: f64| {
                    modes.receptance((PLACES.0, response), |own| {
                        Complex64::new(own * own - omega * omega + sign * gyroscopic * omega, damping * omega)
                    })
                };
                0.5 * (sense(1.0) + sense(-1.0)).norm()
            };
            // The lowest resonances of both senses.
            let shifted = |own: f64, sign: f64| {
                let half = 0.5 * gyroscopic;
                (own * own + half * half).sqrt() + sign * half
            };
            let range = (
                0.7 * shifted(natural(n, 1), -1.0),
                1.02 * shifted(natural(n, 1), 1.0).max(shifted(natural(n, 4.min(n)), -1.0)),
            );
            let right = maxima(range, 0.25 * damping, amplitude);
            assert!(right.len() >= 2, "{n} {gyroscopic}: {}", right.len());
            check(
                &model,
                range,
                response,
                &right,
                &format!("{n} masses in a plane, {gyroscopic}"),
            );
        }
    }
}

/// The second harmonic of a mass that neither touches the contact nor is coupled to it: its response is no unknown, and turns by half a
/// circle within one step.
#[test]
fn a_harmonic_that_no_contact_feels_has_its_peak() {
    let responses = [Response {
        measure: Measure::Harmonic(2),
        dofs: &[1],
        ..Response::default()
    }];
    for beta in [0.02, 0.005, 0.001] {
        for k in (0..some_of(12, 40)).map(|i| 1.2 + 10.8 * f64::from(i) / some_of(11.0, 39.0)) {
            let mut model = Model::new(2).unwrap();
            with_matrix(&mut model, MatrixKind::Mass, &[1.0, 0.0, 0.0, 1.0]);
            with_matrix(&mut model, MatrixKind::Stiffness, &[1.0, 0.0, 0.0, k]);
            model.set_rayleigh(0.0, beta).unwrap();
            model.add_contact(&Contact::cubic(0, None, 0.0, 0.01)).unwrap();
            model.add_force(0, 1, 0.05.into()).unwrap();
            model.add_force(1, 2, 0.5.into()).unwrap();
            // |k − s + i√s βk| is least where s = 4ω² is k − β²k²/2.
            let s = k - 0.5 * (beta * k).powi(2);
            let (omega, amplitude) = (0.5 * s.sqrt(), 0.5 / (k - s).hypot(s.sqrt() * beta * k));
            if !(0.45..2.3).contains(&omega) {
                continue;
            }
            for (omega_start, omega_stop) in [(0.4, 2.4), (2.4, 0.4)] {
                let range = ForcedOptions {
                    responses: &responses,
                    ..omega_range(omega_start, omega_stop)
                };
                let branch = forced_response(&model, &SolverOptions::default(), &range, &mut Hooks::default()).unwrap();
                let near = |peak: &&Special| (peak.omega - omega).abs() < 1e-6 * omega;
                let found = branch.peaks().iter().find(near).unwrap_or_else(|| {
                    panic!(
                        "{k}, {beta}, from {omega_start}: no peak {amplitude} at {omega}: {:?}",
                        branch.peaks()
                    )
                });
                assert!(
                    (found.amplitude - amplitude).abs() < 1e-8 * amplitude,
                    "{k} {beta}: {}",
                    found.amplitude
                );
            }
        }
    }
}
