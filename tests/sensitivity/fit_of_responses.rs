//! Fits to complex responses: a reference data set, and data that deceive.

use crate::common::models::dense;
use crate::common::{data, number};
use hbvib::{
    Constant, DataKind, FitData, FitOptions, Hooks, Loss, MatrixKind, Model, Parameter, SolverOptions, Status,
    Suspicion, Unknown, fit, predict,
};
use num_complex::Complex64;
use serde_json::Value;

/// Two masses, of which the first rubs on the ground, under a force of 1 on the second.
pub fn chain() -> Model {
    dense(&[1.0, 0.0, 0.0, 0.5], &[1.5, -0.5, -0.5, 0.5])
        .rayleigh(0.0, 0.01)
        .slider(0, 0.3, 0.15, 1.0)
        .force(1, 1, 1.0)
        .build()
}

pub const PARAMETERS: [Parameter<'static>; 4] = [
    Parameter::Contact {
        constant: Constant::Kt,
        contact: Some(0),
    },
    Parameter::Contact {
        constant: Constant::Mu,
        contact: Some(0),
    },
    Parameter::Factor {
        which: MatrixKind::Damping,
    },
    Parameter::Factor {
        which: MatrixKind::Stiffness,
    },
];

pub fn nine_harmonics() -> SolverOptions {
    SolverOptions {
        harmonics: 9,
        ..SolverOptions::default().fixed()
    }
}

/// Frequencies, values and standard deviations at one force.
#[derive(Clone)]
pub struct Measured {
    pub force: f64,
    pub omega: Vec<f64>,
    pub value: Vec<Complex64>,
    pub sigma: Vec<f64>,
}

impl Measured {
    pub fn set(&self) -> FitData<'_> {
        FitData {
            force_factor: self.force,
            response: hbvib::Response {
                dofs: &[1],
                ..Default::default()
            },
            x: &self.omega,
            value: &self.value,
            sigma: &self.sigma,
            ..FitData::default()
        }
    }
}

pub fn reference() -> (Vec<Measured>, f64) {
    let file = data("identify.json");
    let numbers = |v: &Value| v.as_array().unwrap().iter().map(number).collect::<Vec<_>>();
    let sets = file["data"].as_array().unwrap().iter().map(|set| Measured {
        force: number(&set["F"]),
        omega: numbers(&set["omega"]),
        value: numbers(&set["re"])
            .into_iter()
            .zip(numbers(&set["im"]))
            .map(|(re, im)| Complex64::new(re, im))
            .collect(),
        sigma: numbers(&set["sigma_abs"]),
    });
    (sets.collect(), number(&file["fit"]["chi2"]))
}

pub fn from_start(start: [f64; 4]) -> [Unknown; 4] {
    start.map(|start| Unknown {
        start: Some(start),
        ..Unknown::default()
    })
}

/// Values that lie off the truth by a third or more.
pub const AWAY: [f64; 4] = [0.5, 0.08, 2.0, 1.1];

#[test]
fn the_reference_has_its_least_chi2_and_the_covariance_of_differences() {
    let (sets, wanted) = reference();
    let data: Vec<_> = sets.iter().map(Measured::set).collect();
    let model = chain();
    let solve = |start: [f64; 4], options: &FitOptions| {
        fit(
            &model,
            (&PARAMETERS, &from_start(start)),
            &data,
            &nine_harmonics(),
            options,
            &mut Hooks::default(),
        )
    };
    let found = solve(AWAY, &FitOptions::default()).unwrap();
    println!("{} iterations, theta {:?}", found.iterations, found.theta);
    assert_eq!(found.status, Status::Ok);
    assert!((found.chi2 / wanted - 1.0).abs() < 1e-12, "{} {wanted}", found.chi2);
    assert_eq!((found.data, found.degrees_of_freedom), (90, 86));
    for (k, truth) in [0.3, 0.15, 1.0, 1.0].into_iter().enumerate() {
        assert!((found.theta[k] - truth).abs() < 3.0 * found.covariance[5 * k].sqrt());
    }
    let near = solve([0.3, 0.15, 1.0, 1.0], &FitOptions::default()).unwrap();
    for (a, b) in found.theta.iter().zip(&near.theta) {
        assert!((a / b - 1.0).abs() < 1e-8, "{a} {b}");
    }
    // Differences of predicted data give the matrix of the covariance.
    let at = |theta: &[f64]| {
        let mut all = Vec::new();
        for set in &data {
            let moved = (theta, &[0.0; 16][..]);
            all.extend(
                predict(
                    &model,
                    &PARAMETERS,
                    moved,
                    set,
                    &nine_harmonics(),
                    &mut Hooks::default(),
                )
                .unwrap()
                .values,
            );
        }
        all
    };
    let sigma: Vec<f64> = sets
        .iter()
        .flat_map(|s| s.sigma.iter().flat_map(|s| [s / 2f64.sqrt(); 2]))
        .collect();
    let mut columns = Vec::new();
    for k in 0..4 {
        let central = |h: f64| {
            let moved = |sign: f64| {
                let mut theta = found.theta.clone();
                theta[k] *= 1.0 + sign * h;
                at(&theta)
            };
            let (a, b) = (moved(1.0), moved(-1.0));
            let step = 2.0 * h * found.theta[k];
            a.iter().zip(b).map(|(a, b)| (a - b) / step).collect::<Vec<_>>()
        };
        let (near, far) = (central(1e-5), central(2e-5));
        columns.push(
            near.iter()
                .zip(far)
                .zip(&sigma)
                .map(|((n, f), s)| (4.0 * n - f) / 3.0 / s)
                .collect::<Vec<f64>>(),
        );
    }
    // (JᵀJ) C = 1
    for i in 0..4 {
        for j in 0..4 {
            let product: f64 = (0..4)
                .map(|k| {
                    columns[i].iter().zip(&columns[k]).map(|(a, b)| a * b).sum::<f64>() * found.covariance[4 * k + j]
                })
                .sum();
            let unit = (found.covariance[4 * j + j] / found.covariance[4 * i + i]).sqrt();
            assert!(
                (product / unit - f64::from(u8::from(i == j))).abs() < 1e-4,
                "{i} {j}: {product}"
            );
        }
    }
    // At the minimum the gradient is zero.
    for (column, k) in columns.iter().zip(0..) {
        let gradient: f64 = column.iter().zip(&found.residuals).map(|(a, r)| a * r).sum();
        assert!(
            (gradient * found.covariance[5 * k].sqrt()).abs() < 1e-4,
            "{k}: {gradient}"
        );
    }
}

/// The same data three times have three times the loss, the same least place and a third of the covariance; so many are searched by a share
/// of them first, and end by a step without an evaluation.
#[test]
fn many_data_have_the_least_place_of_few() {
    let (sets, wanted) = reference();
    let once: Vec<_> = sets.iter().map(Measured::set).collect();
    let thrice = [&once[..], &once[..], &once[..]].concat();
    let model = chain();
    let unknowns = from_start([0.33, 0.14, 1.2, 1.01]);
    let solve = |data: &[FitData<'_>]| {
        let given = (&PARAMETERS[..], &unknowns[..]);
        fit(
            &model,
            given,
            data,
            &nine_harmonics(),
            &FitOptions::default(),
            &mut Hooks::default(),
        )
        .unwrap()
    };
    let (few, many) = (solve(&once), solve(&thrice));
    assert_eq!(many.status, Status::Ok);
    assert!((many.chi2 / (3.0 * wanted) - 1.0).abs() < 1e-9, "{}", many.chi2);
    for k in 0..4 {
        let deviation = few.covariance[5 * k].sqrt();
        let off = (many.theta[k] - few.theta[k]) / deviation;
        assert!(off.abs() < 1e-5, "{k}: {off}");
        let ratio = 3.0 * many.covariance[5 * k] / few.covariance[5 * k];
        assert!((ratio - 1.0).abs() < 1e-4, "{k}: {ratio}");
    }
}

#[test]
fn sticking_contacts_are_refused_in_words() {
    let (mut sets, _) = reference();
    sets.truncate(1);
    sets[0].force = 0.001;
    let truth = (&[0.3, 0.15][..], &[0.0; 4][..]);
    let exact = predict(
        &chain(),
        &PARAMETERS[..2],
        truth,
        &sets[0].set(),
        &nine_harmonics(),
        &mut Hooks::default(),
    );
    for (z, x) in sets[0].value.iter_mut().zip(exact.unwrap().values.chunks_exact(2)) {
        *z = Complex64::new(x[0], x[1]);
    }
    let data: Vec<_> = sets.iter().map(Measured::set).collect();
    let unknowns = from_start([0.28, 0.15, 1.0, 1.0]);
    let found = fit(
        &chain(),
        (&PARAMETERS[..2], &unknowns[..2]),
        &data,
        &nine_harmonics(),
        &FitOptions::default(),
        &mut Hooks::default(),
    );
    let e = found.err().unwrap();
    assert_eq!(e.status, Status::Singular);
    assert!(
        e.to_string().contains("mu of contact 0") && e.to_string().contains("only kt is seen"),
        "{e}"
    );
}

#[test]
fn friction_and_load_together_are_a_product() {
    let (sets, _) = reference();
    let data: Vec<_> = sets.iter().map(Measured::set).collect();
    let constant = |constant| Parameter::Contact {
        constant,
        contact: Some(0),
    };
    let parameters = [constant(Constant::Mu), constant(Constant::Preload)];
    let unknowns = [Unknown::default(); 2];
    let solver = nine_harmonics();
    let refused = fit(
        &chain(),
        (&parameters, &unknowns),
        &data,
        &solver,
        &FitOptions::default(),
        &mut Hooks::default(),
    );
    let e = refused.err().unwrap();
    assert!(
        e.to_string()
            .contains("only a combination of mu of contact 0 and preload of contact 0"),
        "{e}"
    );
    // What is known of one of them tells the other.
    let with_prior = [
        Unknown {
            prior: Some((0.2, 0.01)),
            ..Unknown::default()
        },
        Unknown::default(),
    ];
    let found = fit(
        &chain(),
        (&parameters, &with_prior),
        &data,
        &solver,
        &FitOptions::default(),
        &mut Hooks::default(),
    );
    let found = found.unwrap();
    assert!((found.theta[0] - 0.2).abs() < 1e-6 && (found.covariance[0].sqrt() / 0.01 - 1.0).abs() < 1e-6);
    assert!((found.theta[0] * found.theta[1] / 0.15 - 1.0).abs() < 0.05);
}

#[test]
fn an_outlier_moves_a_robust_fit_by_less_than_its_deviation() {
    let (mut sets, _) = reference();
    let solve = |sets: &[Measured], loss| {
        let data: Vec<_> = sets.iter().map(Measured::set).collect();
        let options = FitOptions {
            loss,
            ..FitOptions::default()
        };
        let unknowns = from_start([0.3, 0.15, 1.0, 1.0]);
        fit(
            &chain(),
            (&PARAMETERS, &unknowns),
            &data,
            &nine_harmonics(),
            &options,
            &mut Hooks::default(),
        )
        .unwrap()
    };
    let clean = solve(&sets, Loss::Square);
    let sigma = sets[1].sigma[5];
    sets[1].value[5] += Complex64::new(20.0 * sigma, 0.0);
    let (robust, square) = (solve(&sets, Loss::Huber(1.345)), solve(&sets, Loss::Square));
    let shift = |found: &hbvib::Fit| {
        let each = (0..4).map(|k| (found.theta[k] - clean.theta[k]).abs() / clean.covariance[5 * k].sqrt());
        each.fold(0.0, f64::max)
    };
    println!(
        "outlier: {} sigma robust, {} by squares",
        shift(&robust),
        shift(&square)
    );
    assert!(shift(&robust) < 1.0 && shift(&square) > 1.0);
    assert_eq!(robust.status, Status::Ok);
}

#[test]
fn other_units_are_suspected() {
    let (sets, _) = reference();
    let solve = |sets: &[Measured]| {
        let data: Vec<_> = sets.iter().map(Measured::set).collect();
        let unknowns = from_start([0.3, 0.15, 1.0, 1.0]);
        let few = FitOptions {
            max_iterations: 3,
            ..FitOptions::default()
        };
        fit(
            &chain(),
            (&PARAMETERS, &unknowns),
            &data,
            &nine_harmonics(),
            &few,
            &mut Hooks::default(),
        )
    };
    let mut millimetres = sets.clone();
    for set in &mut millimetres {
        set.value.iter_mut().for_each(|z| *z *= 1e3);
        set.sigma.iter_mut().for_each(|s| *s *= 1e3);
    }
    match solve(&millimetres) {
        Ok(found) => assert_eq!(found.suspicion, Suspicion::Response(1e3)),
        Err(e) => assert!(e.to_string().contains("are about 1e3 of the model's"), "{e}"),
    }
    let mut hertz = sets.clone();
    for set in &mut hertz {
        set.omega.iter_mut().for_each(|w| *w /= std::f64::consts::TAU);
    }
    // All points stick at frequencies that are too low, so that the fit is refused, with the reason.
    let e = solve(&hertz).err().unwrap();
    assert!(e.to_string().contains("look like hertz"), "{e}");
    assert_eq!(solve(&sets).unwrap().suspicion, Suspicion::None);
}

#[test]
fn bounds_ties_and_kinds_are_kept() {
    let (sets, _) = reference();
    let amplitudes: Vec<Measured> = sets
        .iter()
        .map(|set| Measured {
            value: set.value.iter().map(|z| z.norm().into()).collect(),
            ..set.clone()
        })
        .collect();
    let data: Vec<_> = amplitudes
        .iter()
        .map(|set| FitData {
            kind: DataKind::Amplitude,
            ..set.set()
        })
        .collect();
    let solver = nine_harmonics();
    let mut unknowns = from_start([0.3, 0.15, 1.0, 1.0]);
    let found = fit(
        &chain(),
        (&PARAMETERS, &unknowns),
        &data,
        &solver,
        &FitOptions::default(),
        &mut Hooks::default(),
    );
    let found = found.unwrap();
    assert_eq!(found.data, 45);
    for (theta, truth) in found.theta.iter().zip([0.3, 0.15, 1.0, 1.0]) {
        assert!((theta / truth - 1.0).abs() < 0.08);
    }
    unknowns[1].upper = Some(0.15);
    unknowns[1].lower = Some(0.15);
    unknowns[0].upper = Some(0.31);
    unknowns[0].start = Some(0.305);
    unknowns[0].lower = Some(0.305);
    unknowns[3].tied_to = Some(2);
    let bound = fit(
        &chain(),
        (&PARAMETERS, &unknowns),
        &data,
        &solver,
        &FitOptions::default(),
        &mut Hooks::default(),
    );
    let bound = bound.unwrap();
    assert!((0.305..=0.31).contains(&bound.theta[0]) && bound.theta[1].to_bits() == 0.15_f64.to_bits());
    assert!((bound.theta[2] - bound.theta[3]).abs() < 1e-15);
    assert_eq!(bound.free, 2);
    assert!(bound.chi2 > found.chi2 && bound.covariance[5] == 0.0);
}

/// The response of an undamped oscillator beside its resonance has the best damping at zero, where no point depends on a factor.
#[test]
fn damping_that_is_best_at_zero_is_told_as_such() {
    let damping = 0.02;
    let model = dense(&[1.0], &[1.0]).damping(&[damping]).force(0, 1, 1.0).build();
    let omega = [0.7, 0.8, 0.9, 0.95, 1.05, 1.1, 1.2];
    let value: Vec<_> = omega.iter().map(|w| Complex64::from(1.0 / (1.0 - w * w))).collect();
    let sigma: Vec<_> = value.iter().map(|x| 1e-2 * x.norm()).collect();
    let set = FitData {
        x: &omega,
        value: &value,
        sigma: &sigma,
        ..FitData::default()
    };
    let factor = [Parameter::Factor {
        which: MatrixKind::Damping,
    }];
    let found = fit(
        &model,
        (&factor, &[Unknown::default()]),
        &[set],
        &nine_harmonics(),
        &FitOptions::default(),
        &mut Hooks::default(),
    );
    let refused = found.unwrap_err();
    assert_eq!(refused.status, Status::Singular);
    assert!(refused.message().contains("at zero"), "{}", refused.message());
}
