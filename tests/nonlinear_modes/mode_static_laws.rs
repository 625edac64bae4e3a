//! Nonlinear modes about the static state with every other law that carries a mean force: the balance of forces with
//! the laws written here once more, and the forced response to the force that does the work of the artificial damping.

use crate::common::depth::some_of;
use crate::common::mode_cases::{damping, follow, harmonic};
use crate::common::{all_harmonics, amplitude_range, harmonics, laws::Plate, relative_gap};
use crate::mode_about_static::{answer, balancing, mass_of_three, pressed};
use hbvib::{
    Branch, Call, Constant, Contact, ContactKind, Frame, Iwan, ModeChoice, ModeOptions, Monomial, Patch, Polynomial,
    SolverOptions, Table, User, UserForce,
};
use nalgebra::{Matrix3, Vector3};
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Places or velocities of the three masses.
type Motion = [f64; 3];

/// Force of all contacts on the structure at one sample, from its states, motion and velocity; the states start at zero
/// and are marched over the samples.
type Force = Box<dyn Fn(&mut [f64], Motion, Motion) -> Motion>;

struct Case {
    name: &'static str,
    contacts: Vec<Contact>,
    constant: [f64; 3],
    index: usize,
    /// Samples of the library's sampled laws, 0 for those that have exact events.
    samples: usize,
    states: usize,
    /// `None`: a law whose march in small steps is too coarse; the forced response alone is compared.
    force: Option<Force>,
}

/// Elastic Coulomb friction, marched: the slider's place is the state.
fn slide(slider: &mut f64, y: f64, kt: f64, limit: f64) -> f64 {
    let f = (kt * (y - *slider)).clamp(-limit, limit);
    *slider = y - f / kt;
    f
}

/// The Jenkins contact that makes the elastic cases lose energy, on mass 0.
const RUBBING: (f64, f64) = (1.0, 0.3);

fn rubbing() -> Contact {
    Contact::jenkins(0, None, RUBBING.0, 1.0, RUBBING.1)
}

fn rub(slider: &mut f64, x: Motion) -> f64 {
    slide(slider, x[0], RUBBING.0, RUBBING.1)
}

const DISPLACEMENTS: [f64; 4] = [-0.5, -0.1, 0.2, 0.6];
/// The table has a force at rest: 0.05 at zero.
const FORCES: [f64; 4] = [-1.4, -0.05, 0.25, 0.5];

fn tabulated(y: f64) -> f64 {
    let k = (0..2).filter(|&k| y > DISPLACEMENTS[k + 1]).count();
    let slope = (FORCES[k + 1] - FORCES[k]) / (DISPLACEMENTS[k + 1] - DISPLACEMENTS[k]);
    FORCES[k] + slope * (y - DISPLACEMENTS[k])
}

const SPRING: [f64; 3] = [0.5, 0.6, 0.4];
const DAMPER: [f64; 3] = [0.02, 0.01, 0.05];

fn power_series(coefficients: &[f64], y: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| (sum + c) * y)
}

/// Springs and dampers that couple the masses 0 and 2.
fn coupled() -> Polynomial {
    let term = |direction, coefficient, displacements: &'static [u32], velocities: &'static [u32]| Monomial {
        direction,
        coefficient,
        displacements,
        velocities,
    };
    let terms = [
        term(0, 0.4, &[1, 2], &[]),
        term(0, 0.1, &[0, 0], &[1, 0]),
        term(1, 0.4, &[2, 1], &[]),
        term(1, 0.3, &[0, 2], &[]),
        term(1, 0.2, &[0, 0], &[0, 3]),
    ];
    Polynomial::new(2, &terms).unwrap()
}

fn couple(x: Motion, v: Motion) -> Motion {
    let (a, b) = (x[0], x[2]);
    [
        0.4 * a * b * b + 0.1 * v[0],
        0.0,
        0.4 * a * a * b + 0.3 * b * b + 0.2 * v[2].powi(3),
    ]
}

/// f = 0.3 u + 0.2 u³ + z with the state of a damper behind a spring, z' = 0.6 u' − z/2: the exact decay between samples, in
/// which the motion is a step.
struct Maxwell;

impl Maxwell {
    fn decay(omega: f64, samples: usize) -> f64 {
        (-0.5 * TAU / (omega * samples as f64)).exp()
    }

    fn step(z: f64, (before, u): (f64, f64), decay: f64) -> f64 {
        decay * z + 0.6 * (u - before)
    }

    fn force(u: f64, z: f64) -> f64 {
        0.3 * u + 0.2 * u.powi(3) + z
    }
}

impl UserForce for Maxwell {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        let n = call.samples;
        let decay = Self::decay(call.omega, n);
        let (mut z, mut before) = (call.states.z0[0], call.u[n - 1]);
        for j in 0..n {
            let u = call.u[j];
            call.states.dz_domega[j] = -decay.ln() / call.omega * decay * z;
            z = Self::step(z, (before, u), decay);
            call.states.z[j] = z;
            (call.states.dz_dz[j], call.states.df_dz[j]) = (decay, 1.0);
            (call.states.dz_du[j], call.states.dz_du_before[j]) = (0.6, -0.6);
            call.f[j] = Self::force(u, z);
            call.df_du[j] = 0.3 + 0.6 * u * u;
            before = u;
        }
        0
    }
}

/// Samples of the forces with states: as many here as there, for the samples are part of the law.
const MARCHED: usize = 512;

fn user(force: impl UserForce + 'static, directions: usize, states: usize) -> ContactKind {
    let samples = if states > 0 { MARCHED } else { 0 };
    ContactKind::User(User {
        states,
        velocity: states == 0,
        ..User::new(Arc::new(force), directions, samples).unwrap()
    })
}

const NORMALS: [[f64; 3]; 3] = [[0.0, 0.0, 1.0], [0.0, 0.6, 0.8], [0.0, 0.0, 1.0]];
const AREAS: [f64; 3] = [0.5, 0.3, 0.4];
const PRESSURES: [f64; 3] = [1.4, 2.0, 0.0];
const GAPS: [f64; 3] = [0.0, 0.0, 0.3];

/// Three pairs between a node that moves along x, y, z by the masses 0, 2, 1 and the ground.
fn patch(law: &Contact) -> Vec<Contact> {
    let patch = Patch {
        law,
        dof_a: &[[Some(0), Some(2), Some(1)]; 3],
        dof_b: None,
        normal: &NORMALS,
        tangent: Some(&[[1.0, 0.0, 0.0]; 3]),
        area: &AREAS,
        pressure: Some(&PRESSURES),
        gap: Some(&GAPS),
    };
    patch.contacts().unwrap()
}

/// A law of the patch per unit of area.
fn per_area(law: Contact) -> Contact {
    Contact {
        frame: Some(Frame::new([0.0, 0.0, 1.0], Some([1.0, 0.0, 0.0])).unwrap()),
        ..law
    }
}

/// Force of the patch with friction along x alone under the load of each pair.
fn press(sliders: &mut [f64], x: Motion) -> Motion {
    let mut sum = [0.0; 3];
    for (i, slider) in sliders.iter_mut().enumerate() {
        let [_, ny, nz] = NORMALS[i];
        let closing = -(ny * x[2] + nz * x[1]);
        let (kt, kn) = (2.0 * AREAS[i], 3.0 * AREAS[i]);
        let load = (PRESSURES[i] * AREAS[i] + kn * (closing - GAPS[i])).max(0.0);
        let friction = slide(slider, x[0], kt, 0.4 * load);
        sum[0] += friction;
        sum[2] -= ny * load;
        sum[1] -= nz * load;
    }
    sum
}

fn joint() -> Vec<Contact> {
    let iwan = Iwan {
        slip_force: 0.8,
        stiffness: 1.6,
        chi: -0.4,
        beta: 0.5,
    };
    iwan.elements(&rubbing(), 9).unwrap()
}

fn case(name: &'static str, contacts: Vec<Contact>, constant: [f64; 3], states: usize, force: Option<Force>) -> Case {
    Case {
        name,
        contacts,
        constant,
        index: usize::from(name.starts_with("Iwan") || name.ends_with("one motion")),
        samples: 0,
        states,
        force,
    }
}

fn cases() -> Vec<Case> {
    let place = |f: f64| [f, 0.0, 0.0];
    let elements: Vec<(f64, f64)> = joint()
        .iter()
        .map(|c| (c.constant(Constant::Kt), c.slip_limit()))
        .collect();
    let table = Table::new(&DISPLACEMENTS, &FORCES).unwrap();
    let series = Polynomial::scalar(&SPRING, &DAMPER).unwrap();
    let mut all = vec![
        case(
            "table",
            vec![rubbing(), Contact::between(2, None, ContactKind::Table(table))],
            [0.1, 0.0, 0.4],
            1,
            Some(Box::new(|s, x, _| [rub(&mut s[0], x), 0.0, tabulated(x[2])])),
        ),
        case(
            "polynomial of one motion",
            vec![Contact::between(0, Some(1), ContactKind::Polynomial(series))],
            [0.5, 0.0, 0.2],
            0,
            Some(Box::new(|_, x, v| {
                let f = power_series(&SPRING, x[0] - x[1]) + power_series(&DAMPER, v[0] - v[1]);
                [f, -f, 0.0]
            })),
        ),
        case(
            "polynomial of two motions",
            vec![Contact::over(vec![0, 2], ContactKind::Polynomial(coupled()))],
            [0.4, -0.2, 0.5],
            0,
            Some(Box::new(|_, x, v| couple(x, v))),
        ),
        case(
            "Iwan joint",
            joint(),
            [0.3, 0.0, -0.2],
            9,
            Some(Box::new(move |s, x, _| {
                let sliders = s.iter_mut().zip(&elements);
                place(sliders.map(|(s, &(kt, limit))| slide(s, x[0], kt, limit)).sum())
            })),
        ),
        case(
            "patch with friction along a line",
            patch(&per_area(Contact::friction_2d(
                [None; 2],
                [None; 2],
                (2.0, 3.0),
                0.4,
                0.0,
            ))),
            [0.1, 0.0, -0.1],
            3,
            Some(Box::new(|s, x, _| press(s, x))),
        ),
        case(
            "patch with friction in a plane",
            patch(&per_area(Contact::friction_3d(
                [None; 3],
                [None; 3],
                (2.0, 3.0),
                0.4,
                0.0,
            ))),
            [0.1, 0.0, -0.1],
            3,
            None,
        ),
    ];
    all.extend(sampled_cases());
    all
}

/// The laws that are sampled.
fn sampled_cases() -> Vec<Case> {
    let stop = Contact::unilateral(Some(1), None, 1.5, 0.0)
        .with(Constant::Preload, 0.4)
        .unwrap();
    let stopped = |x: Motion| -(0.4 - 1.5 * x[1]).max(0.0);
    vec![
        case(
            "regularised friction beside a pressed stop",
            vec![Contact::regularised(0, None, 0.3, 1.0, 0.8), stop],
            [0.3, -0.2, 0.1],
            0,
            Some(Box::new(move |_, x, v| [0.3 * (v[0] / 0.8).tanh(), stopped(x), 0.0])),
        ),
        Case {
            samples: 1024,
            ..case(
                "force of the caller",
                vec![Contact::over(vec![0, 2], user(Plate, 2, 0))],
                [0.4, 0.0, 0.3],
                0,
                Some(Box::new(|_, x, v| {
                    let [a, b] = Plate::force([x[0], x[2]], [v[0], v[2]]);
                    [a, 0.0, b]
                })),
            )
        },
        case(
            "force of the caller with states",
            vec![Contact::over(vec![0], user(Maxwell, 1, 1))],
            [0.6, 0.1, 0.0],
            2,
            Some(Box::new(|_, _, _| unreachable!("marched with its frequency"))),
        ),
    ]
}

/// x at a phase, and v/ω.
fn at_phase(x: &[Complex64], tau: f64) -> [Motion; 2] {
    let mut sum = [[0.0; 3]; 2];
    for (h, block) in x.chunks_exact(3).enumerate() {
        let turn = Complex64::cis(h as f64 * tau);
        for (dof, z) in block.iter().enumerate() {
            let z = z * turn;
            sum[0][dof] += z.re;
            sum[1][dof] -= h as f64 * z.im;
        }
    }
    sum
}

/// Harmonics of the contact forces on a motion, from samples of the second period.
fn contact_forces(case: &Case, law: &Force, x: &[Complex64], omega: f64) -> Vec<Complex64> {
    let marched = case.name.ends_with("states");
    let n = if marched { MARCHED } else { 1 << 17 };
    let motion: Vec<[Motion; 2]> = (0..n).map(|j| at_phase(x, TAU * j as f64 / n as f64)).collect();
    let mut states = vec![0.0; case.states];
    let mut forces = vec![[0.0; 3]; n];
    let decay = Maxwell::decay(omega, n);
    // The state of the damper decays within a few periods.
    for _ in 0..if marched { 60 } else { 3 } {
        for (j, (force, [u, v])) in forces.iter_mut().zip(&motion).enumerate() {
            if marched {
                let before = motion[(j + n - 1) % n][0][0];
                states[0] = Maxwell::step(states[0], (before, u[0]), decay);
                *force = [Maxwell::force(u[0], states[0]), 0.0, 0.0];
            } else {
                *force = law(&mut states, *u, v.map(|v| omega * v));
            }
        }
    }
    let mut sums = vec![Complex64::ZERO; x.len()];
    for (h, block) in sums.chunks_exact_mut(3).enumerate() {
        for (j, force) in forces.iter().enumerate() {
            let weight = if h == 0 { 1.0 } else { 2.0 } / n as f64;
            let turn = Complex64::cis(-TAU * ((h * j) % n) as f64 / n as f64) * weight;
            for (sum, f) in block.iter_mut().zip(force) {
                *sum += turn * f;
            }
        }
    }
    sums
}

/// The structure of the pressed models.
const STIFFNESS: [f64; 9] = [2.0, -0.4, 0.3, -0.4, 3.0, -0.5, 0.3, -0.5, 2.5];

/// Largest force that is not in balance at a point, over the largest of the structure in its harmonics above 0.
fn out_of_balance(case: &Case, branch: &Branch, point: usize) -> f64 {
    let Some(law) = &case.force else { return 0.0 };
    let stiffness = Matrix3::from_column_slice(&STIFFNESS).map(Complex64::from);
    let mass = Matrix3::from_diagonal(&Vector3::new(1.0, 1.4, 0.8)).map(Complex64::from);
    let x = all_harmonics(branch, point);
    let (omega, d) = (branch.omega()[point], damping(branch)[point]);
    let forces = contact_forces(case, law, &x, omega);
    let (mut off, mut size) = (0.0_f64, 0.0_f64);
    for (h, (x, f)) in x.chunks_exact(3).zip(forces.chunks_exact(3)).enumerate() {
        let hw = h as f64 * omega;
        let x = Vector3::from_column_slice(x);
        let mut r = stiffness * x + Vector3::from_column_slice(f);
        r += mass * x * Complex64::new(-hw * hw, -2.0 * d * omega * hw);
        if h == 0 {
            r -= Vector3::from_column_slice(&case.constant).map(Complex64::from);
        } else {
            size = size.max((stiffness * x).camax());
        }
        off = off.max(r.camax());
    }
    off / size
}

#[test]
fn modes_with_every_law_balance_its_force_and_are_forced_responses() {
    for (number, case) in cases().into_iter().enumerate() {
        let model = pressed(&case.contacts, case.constant);
        for h in [1, 5, 1].into_iter().skip(number % 2).take(some_of(1, 2)) {
            let solver = SolverOptions {
                samples: case.samples,
                tol_residual: if case.force.is_some() { 1e-12 } else { 1e-10 },
                ..harmonics(h)
            };
            let range = ModeOptions {
                choice: ModeChoice::Index(case.index),
                ..amplitude_range(-3.0, 0.5)
            };
            let branch = follow(&model, &solver, &range);
            let (mut gap, mut off, mut compared) = (0.0_f64, 0.0_f64, 0);
            let most = damping(&branch).iter().fold(0.0_f64, |m, d| m.max(*d));
            for point in (0..branch.points()).step_by(4) {
                // Without a loss the resonance is unbounded.
                if damping(&branch)[point] < 0.05 * most {
                    continue;
                }
                let guess = all_harmonics(&branch, point);
                let mean = harmonic(&branch, point, 0);
                assert!(mean.camax() > 1e-3, "no mean to speak of");
                let forces = balancing(&branch, point, mass_of_three);
                let found = answer(&model, &solver, branch.omega()[point], &forces, &guess);
                gap = gap.max(relative_gap(&found, &guess));
                gap = gap.max(relative_gap(&found[3..], &guess[3..]));
                off = off.max(out_of_balance(&case, &branch, point));
                compared += 1;
            }
            println!(
                "{}, H = {h}: response {gap:.1e}, balance {off:.1e} at {compared} points, D up to {most:.1e}",
                case.name
            );
            assert!(
                gap < 1e-9 && compared >= 3,
                "{}, H = {h}: {gap:e}, {compared}",
                case.name
            );
            assert!(off < 1e-9, "{}, H = {h}: {off:e}", case.name);
        }
    }
}
