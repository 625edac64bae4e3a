//! The free decay of a lightly damped structure, pressed and rubbing, integrated in time by other code, against its
//! nonlinear mode: the frequency and the loss per cycle at each amplitude.

use crate::common::harmonics;
use crate::common::mode_cases::{damping, follow};
use crate::common::models::dense;
use crate::common::{all_harmonics, amplitude_range};
use hbvib::{Contact, Model, SolverOptions};
use num_complex::Complex64;
use std::f64::consts::TAU;

const K: [f64; 4] = [1.0, 0.25, 0.25, 2.0];
const CONSTANT: [f64; 2] = [0.004, -0.01];
const KT: f64 = 0.03;
const KN: f64 = 0.1;
const MU: f64 = 0.4;
const PRELOAD: f64 = 0.1;

/// Steps per period of the integration.
const STEPS: f64 = 1500.0;

/// Cycles over which frequency and decay are measured.
const CYCLES: usize = 4;

fn model() -> Model {
    let contact = Contact::friction_2d([Some(0), Some(1)], [None; 2], (KT, KN), MU, PRELOAD);
    dense(&[1.0, 0.0, 0.0, 1.0], &K)
        .contact(&contact)
        .forces(CONSTANT.into_iter().enumerate().map(|(dof, f)| (dof, 0, f)))
        .build()
}

/// Place, velocity and slider.
#[derive(Clone, Copy)]
struct State {
    x: [f64; 2],
    v: [f64; 2],
    slider: f64,
}

impl State {
    fn acceleration(&mut self) -> [f64; 2] {
        let load = (PRELOAD - KN * self.x[1]).max(0.0);
        let friction = (KT * (self.x[0] - self.slider)).clamp(-MU * load, MU * load);
        self.slider = self.x[0] - friction / KT;
        let of_structure = |i: usize| CONSTANT[i] - K[i] * self.x[0] - K[2 + i] * self.x[1];
        [of_structure(0) - friction, of_structure(1) + load]
    }

    /// One step of the method of Störmer and Verlet under ẍ = a + c v.
    fn step(&mut self, a: &mut [f64; 2], dt: f64, c: f64) {
        for ((x, v), a) in self.x.iter_mut().zip(&mut self.v).zip(&*a) {
            *v += 0.5 * dt * (a + c * *v);
            *x += dt * *v;
        }
        *a = self.acceleration();
        for (v, a) in self.v.iter_mut().zip(&*a) {
            *v = (*v + 0.5 * dt * a) / (1.0 - 0.5 * dt * c);
        }
    }
}

/// Times of the largest displacements of the first mass and half the ranges of its motion, cycle after cycle.
fn decay(start: State, (omega, d): (f64, f64), cycles: usize) -> Vec<(f64, f64)> {
    let dt = TAU / omega / STEPS;
    let mut state = start;
    let mut a = state.acceleration();
    // A few cycles on the mode let the slider find its place.
    for _ in 0..(5.0 * STEPS) as usize {
        state.step(&mut a, dt, 2.0 * d * omega);
    }
    let (mut found, mut least, mut least_before) = (Vec::new(), f64::INFINITY, f64::NAN);
    let (mut before, mut t) = ([state.x[0]; 2], 0.0);
    while found.len() < cycles {
        state.step(&mut a, dt, 0.0);
        t += dt;
        let [b, c] = before;
        let x = state.x[0];
        least = least.min(x);
        if c > b && c >= x {
            // The parabola through three places.
            let (slope, bend) = (0.5 * (x - b), x - 2.0 * c + b);
            let most = c - 0.5 * slope * slope / bend;
            // Each largest displacement lies between two least ones.
            if let Some((_, range)) = found.last_mut() {
                *range = 0.5 * (*range - 0.5 * (least_before + least));
            }
            found.push((t - dt - dt * slope / bend, most));
            (least_before, least) = (least, f64::INFINITY);
        }
        before = [c, x];
    }
    found.pop();
    found
}

/// Motion of a degree of freedom at a phase from its harmonics; with its velocity over ω.
fn at_phase(x: &[Complex64], dof: usize, tau: f64) -> (f64, f64) {
    let mut sum = (0.0, 0.0);
    for (h, block) in x.chunks_exact(2).enumerate() {
        let z = block[dof] * Complex64::cis(h as f64 * tau);
        sum.0 += z.re;
        sum.1 -= h as f64 * z.im;
    }
    sum
}

#[test]
fn a_free_decay_about_the_static_state_has_frequency_and_damping_of_the_mode() {
    let range = amplitude_range(-1.0, 1.4);
    let solver = SolverOptions {
        step_max: 0.005,
        ..harmonics(15)
    };
    let branch = follow(&model(), &solver, &range);
    let info = branch.mode().unwrap();
    println!("slip from {}, lift-off from {}", info.slip_from, info.lift_off_from);
    assert!(info.slip_from < info.lift_off_from && info.lift_off_from < 1.0);
    let mut curve = Vec::new();
    for point in 0..branch.points() {
        let x = all_harmonics(&branch, point);
        let ends = (0..720).map(|j| at_phase(&x, 0, f64::from(j) * TAU / 720.0).0);
        let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        curve.push((0.5 * (high - low), branch.omega()[point], damping(&branch)[point]));
    }
    let most = curve.iter().fold(0.0_f64, |m, c| m.max(c.2));
    assert!(most < 5e-3, "D = {most}");
    let mut compared = 0;
    let mut worst = (0.0_f64, 0.0_f64);
    for amplitude in [3.0, 10.0] {
        let first = curve.iter().position(|c| c.0 > amplitude).unwrap();
        let x = all_harmonics(&branch, first);
        let (omega, d) = (branch.omega()[first], damping(&branch)[first]);
        let (at, rates) = ([0, 1].map(|dof| at_phase(&x, dof, 0.0)), omega);
        let start = State {
            x: at.map(|x| x.0),
            v: at.map(|x| x.1 * rates),
            slider: at[0].0,
        };
        let cycles = decay(start, (omega, d), 60);
        for k in (2..cycles.len() - CYCLES).step_by(CYCLES) {
            let ((t, a), (later, b), (_, middle)) = (cycles[k], cycles[k + CYCLES], cycles[k + CYCLES / 2]);
            let omega = TAU * CYCLES as f64 / (later - t);
            let d = (a / b).ln() / (TAU * CYCLES as f64);
            let Some(i) = curve.windows(2).position(|c| c[0].0 <= middle && middle < c[1].0) else {
                continue;
            };
            let share = (middle - curve[i].0) / (curve[i + 1].0 - curve[i].0);
            let between = |a: f64, b: f64| a + share * (b - a);
            let expected = (between(curve[i].1, curve[i + 1].1), between(curve[i].2, curve[i + 1].2));
            // Near the onset of slip damping changes by its own size within the cycles of one measurement.
            if expected.1 < 1e-3 {
                continue;
            }
            worst.0 = worst.0.max((omega / expected.0 - 1.0).abs());
            worst.1 = worst.1.max((d / expected.1 - 1.0).abs());
            compared += 1;
        }
    }
    println!(
        "{compared} amplitudes: ω {:.1e}, D {:.1e}, largest D {most:.1e}",
        worst.0, worst.1
    );
    assert!(compared >= 15 && worst.0 < 1e-4 && worst.1 < 0.05);
}
