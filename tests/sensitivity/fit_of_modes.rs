//! Peaks, backbones and linear modes of a known model lead back to it.

use crate::common::{amplitude_range, at_dof, omega_range};
use crate::fit_of_responses::{AWAY, PARAMETERS, chain, from_start, nine_harmonics};
use hbvib::{DataKind, FitData, FitOptions, Hooks, ModeOptions, Response, fit, forced_response, nonlinear_mode};
use num_complex::Complex64;

#[test]
fn of_several_kinds_find_the_truth() {
    let model = chain();
    let solver = nine_harmonics();
    let log10 = [-1.5, -0.5, 0.0, 0.5];
    let range = ModeOptions {
        at: &log10,
        ..amplitude_range(log10[0], log10[3])
    };
    let mode = nonlinear_mode(&model, &solver, &range, &mut Hooks::default()).unwrap();
    let at = |i: usize| {
        let special = mode.at(i)[0];
        Complex64::new(special.omega, mode.mode_at(special.point).unwrap().damping_ratio)
    };
    let backbone: Vec<_> = (0..4).map(at).collect();
    let stuck = [at(0)];
    let mut louder = chain();
    louder.clear_forces();
    louder.add_force(1, 1, 0.05.into()).unwrap();
    let curve = omega_range(0.6, 0.9);
    let watching = at_dof(1, solver);
    let branch = forced_response(&louder, &watching, &curve, &mut Hooks::default()).unwrap();
    let peak = branch.peaks()[0];
    let peaks = [Complex64::new(peak.amplitude, peak.omega)];
    let (sigma, of_damping) = ([1e-3; 4], [1e-4; 4]);
    let data = [
        FitData {
            kind: DataKind::Backbone,
            x: &log10,
            value: &backbone,
            sigma: &sigma,
            second_sigma: &of_damping,
            ..FitData::default()
        },
        FitData {
            kind: DataKind::LinearMode,
            x: &[0.0],
            value: &stuck,
            sigma: &sigma[..1],
            second_sigma: &of_damping[..1],
            ..FitData::default()
        },
        FitData {
            kind: DataKind::Peak,
            force_factor: 0.05,
            response: Response {
                dofs: &[1],
                ..Response::default()
            },
            range: Some((0.55, 1.0)),
            x: &[peak.omega],
            value: &peaks,
            sigma: &[0.01],
            second_sigma: &[0.001],
            ..FitData::default()
        },
    ];
    let found = fit(
        &model,
        (&PARAMETERS, &from_start(AWAY)),
        &data,
        &solver,
        &FitOptions::default(),
        &mut Hooks::default(),
    );
    let found = found.unwrap();
    println!(
        "{:?}, chi2 {}, {} iterations",
        found.theta, found.chi2, found.iterations
    );
    assert_eq!(found.data, 12);
    assert!(found.chi2 < 1e-8);
    for (theta, truth) in found.theta.iter().zip([0.3, 0.15, 1.0, 1.0]) {
        assert!((theta / truth - 1.0).abs() < 1e-5, "{theta} {truth}");
    }
}
