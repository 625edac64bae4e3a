//! The nonlinear mode of the bladed disk against the reference data: same-H solutions.

use crate::common::{BASE, Blisk, D, R, amplitude_range, data, harmonics, number};
use hbvib::{Branch, Hooks, ModeField, ModeOptions, Model, SolverOptions, Status, nonlinear_mode};
use num_complex::Complex64;

/// The blisk without structural damping.
fn undamped() -> Model {
    let mut model = BASE.sector();
    model.set_rayleigh(0.0, 0.0).unwrap();
    model
}

/// Slip limit over contact stiffness, the reference's unit of length.
fn delta() -> f64 {
    Blisk::mu() * BASE.preload() / BASE.kt()
}

fn follow(model: &Model, solver: &SolverOptions, range: &ModeOptions) -> Branch {
    let branch = nonlinear_mode(model, solver, range, &mut Hooks::default()).unwrap();
    assert_eq!(branch.status(), Status::Ok);
    branch
}

#[test]
fn frequency_and_damping_against_amplitude_agree_with_the_reference_at_equal_h() {
    let reference = data("nnm_base.json");
    let delta = delta();
    for h in [1, 3, 7] {
        let table = reference["H"][h.to_string()]["table"].as_array().unwrap();
        let at: Vec<f64> = table
            .iter()
            .map(|row| (number(&row["alpha"]) * delta).log10())
            .collect();
        let range = ModeOptions {
            at: &at,
            ..amplitude_range(delta.log10() + 1.0, delta.log10() + 7.0)
        };
        let branch = follow(&undamped(), &harmonics(h), &range);
        let largest = number(&reference["H"][h.to_string()]["D_max"]["D"]);
        let mut worst = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        for (i, row) in table.iter().enumerate() {
            let [special] = branch.at(i) else {
                panic!("H = {h}: {} solutions at alpha {}", branch.at(i).len(), row["alpha"]);
            };
            let point = branch.mode_at(special.point).unwrap();
            worst.0 = worst.0.max((special.omega / number(&row["omega"]) - 1.0).abs());
            worst.1 = worst.1.max((point.damping_ratio - number(&row["D"])).abs() / largest);
            let energy = point.energy / (delta * delta);
            worst.2 = worst.2.max((energy / number(&row["E2T"]) - 1.0).abs());
            let mut x = vec![Complex64::ZERO; (h + 1) * branch.ndof()];
            branch.harmonics_at(special.point, &mut x).unwrap();
            let w = (x[branch.ndof() + D] - x[branch.ndof() + R]).norm() / delta;
            worst.3 = worst.3.max((w / number(&row["a"]) - 1.0).abs());
        }
        println!("H {h}: {} points, worst {worst:?}", branch.points());
        assert!(
            worst.0 < 1e-9 && worst.1 < 1e-7 && worst.2 < 1e-9 && worst.3 < 1e-7,
            "{worst:?}"
        );
        let [peak] = branch.peaks() else {
            panic!("H = {h}: {} peaks", branch.peaks().len());
        };
        let point = branch.mode_at(peak.point).unwrap();
        let wanted = &reference["H"][h.to_string()]["D_max"];
        println!(
            "peak {} {}",
            point.damping_ratio / number(&wanted["D"]) - 1.0,
            peak.omega / number(&wanted["omega"]) - 1.0
        );
        assert!((point.damping_ratio / number(&wanted["D"]) - 1.0).abs() < 1e-9);
        let damping = branch.mode_field(ModeField::DampingRatio).unwrap();
        let assured = branch.mode_field(ModeField::Assurance).unwrap();
        println!("least assurance {:?}", assured.iter().fold(1.0_f64, |m, x| m.min(*x)));
        let its: f64 = branch.newton_iterations().iter().sum();
        println!("points {} its {its}", damping.len());
    }
}
