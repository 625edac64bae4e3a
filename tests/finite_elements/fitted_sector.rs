//! Five parameters of a finite-element sector with 60 friction contacts from 200 complex points at two forces.

use crate::sector::{Sector, Size};
use hbvib::model::structure::MatrixKind;
use hbvib::{Constant, FitData, FitOptions, Hooks, Parameter, Response, SolverOptions, Unknown, fit, predict};
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::path::Path;
use std::time::Instant;

#[test]
#[ignore = "minutes of processor time; tests/deep.sh runs it"]
fn has_its_parameters_back() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/data/fe");
    let sector = Sector::read(&folder, Size::Reduced).unwrap();
    let model = sector.forced(1.0).unwrap();
    let all = |constant| Parameter::Contact {
        constant,
        contact: None,
    };
    let factor = |which| Parameter::Factor { which };
    let parameters = [
        all(Constant::Kt),
        all(Constant::Mu),
        factor(MatrixKind::Damping),
        factor(MatrixKind::Stiffness),
        Parameter::Force,
    ];
    let first = &model.contacts()[0];
    let truth = [first.kt, first.mu, 1.2, 1.01, 1.05];
    let solver = SolverOptions {
        harmonics: 5,
        response_dof: Some(sector.size.tip()),
        ..SolverOptions::default().fixed()
    };
    let dofs = [sector.size.tip()];
    let omega: Vec<f64> = (0..100).map(|i| TAU * (510.0 + 0.45 * f64::from(i))).collect();
    let nothing = [0.0; 25];
    let sets = [5.0, 100.0].map(|force_factor| FitData {
        force_factor,
        response: Response {
            dofs: &dofs,
            ..Response::default()
        },
        x: &omega,
        ..FitData::default()
    });
    let values = sets.map(|set| {
        let exact = predict(
            &model,
            &parameters,
            (&truth, &nothing),
            &set,
            &solver,
            &mut Hooks::default(),
        )
        .unwrap();
        let complex = exact.values.chunks_exact(2).map(|x| Complex64::new(x[0], x[1]));
        complex.collect::<Vec<_>>()
    });
    let sigmas = [0, 1].map(|k: usize| values[k].iter().map(|x| 0.01 * x.norm()).collect::<Vec<_>>());
    let data = [0, 1].map(|k: usize| FitData {
        value: &values[k],
        sigma: &sigmas[k],
        ..sets[k]
    });
    let unknowns = [1.2, 0.8, 0.9, 1.0, 1.0]
        .iter()
        .zip(truth)
        .enumerate()
        .map(|(k, (share, truth))| Unknown {
            start: Some(if k < 2 { share * truth } else { *share }),
            ..Unknown::default()
        });
    let unknowns: Vec<Unknown> = unknowns.collect();
    let begin = Instant::now();
    let found = fit(
        &model,
        (&parameters, &unknowns),
        &data,
        &solver,
        &FitOptions::default(),
        &mut Hooks::default(),
    )
    .unwrap();
    println!(
        "{} iterations, {:.1} s, chi2 {:.1e}, {} contacts slip, relative deviations {:?}",
        found.iterations,
        begin.elapsed().as_secs_f64(),
        found.chi2,
        found.slips.iter().filter(|slips| **slips).count(),
        (0..5)
            .map(|k| found.covariance[6 * k].sqrt() / found.theta[k])
            .collect::<Vec<_>>()
    );
    for (found, truth) in found.theta.iter().zip(truth) {
        assert!((found / truth - 1.0).abs() < 1e-4, "{found} {truth}");
    }
}
