//! Responses synthesised from a nonlinear mode against computed ones: how far the shortcut is from the
//! harmonic balance that it stands for.

mod common;

use common::{B2, BASE, Blisk, harmonics, sweep};
use hbvib::analysis::{nonlinear_mode, synthesise};
use hbvib::branch::Branch;
use hbvib::hooks::Hooks;
use hbvib::model::Model;
use hbvib::options::{ModeOptions, SolverOptions, SynthesisOptions};
use std::f64::consts::TAU;

fn mode(model: &Model, solver: &SolverOptions) -> Branch {
    let delta = Blisk::mu() * BASE.preload() / BASE.kt();
    let range = ModeOptions {
        log10_start: delta.log10() - 1.0,
        log10_stop: delta.log10() + 5.0,
        ..ModeOptions::default()
    };
    nonlinear_mode(model, solver, &range, &mut Hooks::default()).unwrap()
}

#[test]
fn synthesised_peaks_lie_near_the_computed_ones() {
    for h in [7, 63] {
        let solver = SolverOptions {
            response_dof: Some(B2),
            ..harmonics(h)
        };
        let model = BASE.sector();
        let mut undamped = model.try_clone().unwrap();
        undamped.set_rayleigh(0.0, 0.0).unwrap();
        for (with, branch) in [(false, mode(&model, &solver)), (true, mode(&undamped, &solver))] {
            for force in [0.2, 1.0, 2.0, 5.0, 20.0, 50.0] {
                let options = SynthesisOptions {
                    force_factor: force / 5.0,
                    model_damping: with,
                    ..SynthesisOptions::default()
                };
                let found = synthesise(&branch, &model, &options).unwrap();
                let forced = Blisk { force, ..BASE }.sector();
                let swept = sweep(&forced, &solver, 206.0 * TAU, 212.0 * TAU, &[]);
                println!("H {h} F {force} {} peaks {}", found.peaks.len(), swept.peaks().len());
                for (p, q) in found.peaks.iter().zip(swept.peaks()) {
                    println!(
                        "   amplitude {:.2e} frequency {:.2e} Hz {:?}",
                        p.at.response.norm() / q.amplitude - 1.0,
                        (p.at.omega - q.omega) / TAU,
                        p.validity
                    );
                }
            }
        }
    }
}
