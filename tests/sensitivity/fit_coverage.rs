//! Intervals of 95 % from fits to many noisy data sets contain the truth as often as they claim.

use crate::common::models;
use crate::common::{BASE, BETA, one_mass};
use crate::design::Design;
use hbvib::{
    Constant, Contact, FitData, FitOptions, Hooks, MatrixKind, Model, Parameter, Response, SolverOptions, Unknown, fit,
    predict,
};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Noisy data sets of each system.
const SETS: usize = 200;

/// Numbers of the normal distribution, from a sequence of its own (xorshift, Marsaglia 2003) by the method of Box and Muller.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (TAU * self.uniform()).cos()
    }
}

/// A system with the truth of its parameters, and the tests: factors on the force, and frequencies.
struct Case<'a> {
    name: &'a str,
    model: Model,
    parameters: Vec<Parameter<'a>>,
    truth: Vec<f64>,
    dof: usize,
    forces: Vec<f64>,
    omega: Vec<f64>,
}

fn constant(constant: Constant, contact: usize) -> Parameter<'static> {
    Parameter::Contact {
        constant,
        contact: Some(contact),
    }
}

const DAMPING: Parameter<'static> = Parameter::Factor {
    which: MatrixKind::Damping,
};

fn between(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..n).map(|i| from + (to - from) * i as f64 / (n - 1) as f64).collect()
}

fn oscillator() -> Case<'static> {
    Case {
        name: "oscillator",
        model: one_mass(0.04, &Contact::jenkins(0, None, 1.0, 0.3, 1.0), 1.0),
        parameters: vec![constant(Constant::Kt, 0), constant(Constant::Mu, 0), DAMPING],
        truth: vec![1.0, 0.3, 1.0],
        dof: 0,
        forces: vec![0.05, 0.2, 0.4],
        omega: between(1.05, 1.5, 10),
    }
}

fn chain() -> Case<'static> {
    let dense = |values: &[f64]| values.to_vec();
    let m = dense(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    let k = dense(&[2.0, -1.0, 0.0, -1.0, 2.0, -1.0, 0.0, -1.0, 1.0]);
    let model = models::dense(&m, &k)
        .rayleigh(0.0, 0.03)
        .slider(0, 0.6, 0.1, 1.0)
        .slider(1, 0.3, 0.2, 1.0)
        .force(2, 1, 1.0)
        .build();
    Case {
        name: "chain with two contacts",
        model,
        parameters: vec![
            constant(Constant::Kt, 0),
            constant(Constant::Mu, 0),
            constant(Constant::Kt, 1),
            constant(Constant::Mu, 1),
            DAMPING,
        ],
        truth: vec![0.6, 0.1, 0.3, 0.2, 1.0],
        dof: 2,
        forces: vec![0.02, 0.08, 0.2],
        omega: between(0.42, 0.66, 12),
    }
}

fn ring() -> Case<'static> {
    let design = Design::ring_damper(&BASE, 300.0);
    let _ = BETA;
    Case {
        name: "sector with a ring",
        truth: vec![design.contacts[0].constant(Constant::Kt), 300.0, 1.0],
        model: design.model(),
        parameters: vec![constant(Constant::Kt, 0), constant(Constant::Preload, 0), DAMPING],
        dof: 0,
        forces: vec![0.1, 1.0, 5.0],
        omega: between(205.0 * TAU, 213.0 * TAU, 12),
    }
}

/// Shares of the intervals that contain the truth, one for each parameter.
fn coverage(case: &Case<'_>) -> Vec<f64> {
    let solver = SolverOptions {
        harmonics: 9,
        response_dof: Some(case.dof),
        ..SolverOptions::default().fixed()
    };
    let p = case.truth.len();
    let nothing = vec![0.0; p * p];
    let dofs = [case.dof];
    let response = Response {
        dofs: &dofs,
        ..Response::default()
    };
    let exact: Vec<Vec<Complex64>> = case
        .forces
        .iter()
        .map(|&force_factor| {
            let wanted = FitData {
                force_factor,
                response,
                x: &case.omega,
                ..FitData::default()
            };
            let found = predict(
                &case.model,
                &case.parameters,
                (&case.truth, &nothing),
                &wanted,
                &solver,
                &mut Hooks::default(),
            );
            found
                .unwrap()
                .values
                .chunks_exact(2)
                .map(|x| Complex64::new(x[0], x[1]))
                .collect()
        })
        .collect();
    let mut noise = Noise(0x9e37_79b9_7f4a_7c15);
    let mut within = vec![0_usize; p];
    let mut chi2 = 0.0;
    for _ in 0..SETS {
        let mut sigmas = Vec::new();
        let mut values = Vec::new();
        for of_force in &exact {
            let sigma: Vec<f64> = of_force.iter().map(|x| 0.02 * x.norm()).collect();
            let noisy = |(x, s): (&Complex64, &f64)| {
                let part = s / 2f64.sqrt();
                x + Complex64::new(part * noise.normal(), part * noise.normal())
            };
            values.push(of_force.iter().zip(&sigma).map(noisy).collect::<Vec<_>>());
            sigmas.push(sigma);
        }
        let data: Vec<FitData<'_>> = (0..exact.len())
            .map(|k| FitData {
                force_factor: case.forces[k],
                response,
                x: &case.omega,
                value: &values[k],
                sigma: &sigmas[k],
                ..FitData::default()
            })
            .collect();
        let unknowns: Vec<Unknown> = case
            .truth
            .iter()
            .map(|x| Unknown {
                start: Some(1.1 * x),
                ..Unknown::default()
            })
            .collect();
        let found = fit(
            &case.model,
            (&case.parameters, &unknowns),
            &data,
            &solver,
            &FitOptions::default(),
            &mut Hooks::default(),
        );
        let found = found.unwrap();
        chi2 += found.chi2 / found.degrees_of_freedom as f64 / SETS as f64;
        for (k, within) in within.iter_mut().enumerate() {
            let deviation = found.covariance[k * p + k].sqrt();
            *within += usize::from((found.theta[k] - case.truth[k]).abs() < 1.96 * deviation);
        }
    }
    let shares: Vec<f64> = within.iter().map(|n| *n as f64 / SETS as f64).collect();
    println!("{}: {shares:?}, mean chi2 over degrees of freedom {chi2:.3}", case.name);
    shares
}

#[test]
#[ignore = "a minute of processor time; tests/deep.sh runs it"]
fn intervals_contain_the_truth_as_often_as_they_claim() {
    for case in [oscillator(), chain(), ring()] {
        for share in coverage(&case) {
            assert!((0.9..=0.99).contains(&share), "{}: {share}", case.name);
        }
    }
}
