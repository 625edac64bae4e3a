//! Cost of a design of the ring damper in a batch, as a multiple of one LU factorisation of order 11 with a solution.

use crate::cpu_time::{cpu_seconds, lu11_seconds};
use crate::model;
use hbvib::{BatchOptions, Constant, Hooks, MatrixKind, MatrixView, Parameter, SolverOptions, Status, batch};
use std::error::Error;
use std::f64::consts::TAU;

/// Designs of one run.
const DESIGNS: usize = 300;

/// Runs; the quickest counts, and the quickest factorisation beside it.
const REPEATS: usize = 5;

/// Stiffness 2e7 .. 1e8 N/m, slip limit 0.02 .. 50 N and ring mass 5 .. 52 g at random, always the same.
fn values() -> Vec<f64> {
    let mut state = 20_u64;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..DESIGNS)
        .flat_map(|_| {
            [
                2e7 + 8e7 * random(),
                0.02 * 2500.0_f64.powf(random()) / 0.3,
                -0.025 + 0.047 * random(),
            ]
        })
        .collect()
}

pub fn run() -> Result<(), Box<dyn Error>> {
    let model = model::Parameters::default().model()?;
    let contact = |constant| Parameter::Contact {
        constant,
        contact: Some(model::CONTACT),
    };
    let mut ring = [0.0; 16];
    ring[15] = 1.0;
    let mass = Parameter::Direction {
        which: MatrixKind::Mass,
        direction: MatrixView::dense(4, &ring),
    };
    let parameters = [contact(Constant::Kt), contact(Constant::Preload), mass];
    let solver = SolverOptions {
        harmonics: 9,
        response_dof: Some(model::B2),
        tolerance: 0.0,
        ..SolverOptions::default()
    };
    let options = BatchOptions {
        omega_start: 205.0 * TAU,
        omega_stop: 213.0 * TAU,
        ..BatchOptions::default()
    };
    let values = values();
    let mut least = (f64::INFINITY, f64::INFINITY);
    for _ in 0..REPEATS {
        let unit = lu11_seconds();
        let begin = cpu_seconds();
        let found = batch(&model, &solver, &options, (&parameters, &values), &mut Hooks::default())?;
        let time = (cpu_seconds() - begin) / DESIGNS as f64;
        least = (least.0.min(unit), least.1.min(time));
        let failed = found.peaks().iter().filter(|peak| peak.status != Status::Ok).count();
        let points: usize = found.peaks().iter().map(|peak| peak.points).sum();
        println!(
            "{:6.0} LU11 a design: {:.1} µs, LU11 {:.0} ns; {:.1} points a design, {failed} without a peak",
            time / unit,
            time * 1e6,
            unit * 1e9,
            points as f64 / DESIGNS as f64
        );
    }
    println!("{:6.0} LU11 a design by the least times", least.1 / least.0);
    Ok(())
}
