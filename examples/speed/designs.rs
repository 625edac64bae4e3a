//! Cost of a design of the ring damper in a batch, as a multiple of one LU factorisation of order 11 with a solution.

use crate::model;
use hbvib::{BatchOptions, Constant, Hooks, MatrixKind, MatrixView, Parameter, SolverOptions, Status, batch};
use nalgebra::{SMatrix, SVector};
use std::error::Error;
use std::f64::consts::TAU;
use std::hint::black_box;
use std::time::Instant;

/// Designs of one run.
const DESIGNS: usize = 300;

/// Runs; the quickest counts, and the quickest factorisation beside it.
const REPEATS: usize = 5;

/// Processor time of this thread so far, s, which others on the machine do not lengthen; the clock where the system does not
/// tell it.
fn processor(start: Instant) -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told
        .as_deref()
        .and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |ns| ns * 1e-9)
}

/// Time of one factorisation and solution, s.
fn lu11(start: Instant) -> f64 {
    // The system tells processor time in steps of some milliseconds.
    const COUNT: usize = 200_000;
    let a = SMatrix::<f64, 11, 11>::from_fn(|i, j| if i == j { 5.0 } else { 1.0 / (1 + i * 3 + j) as f64 });
    let b = SVector::<f64, 11>::from_element(1.0);
    let begin = processor(start);
    for _ in 0..COUNT {
        black_box(black_box(a).lu().solve(black_box(&b)));
    }
    (processor(start) - begin) / COUNT as f64
}

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
    let start = Instant::now();
    let mut least = (f64::INFINITY, f64::INFINITY);
    for _ in 0..REPEATS {
        let unit = lu11(start);
        let begin = processor(start);
        let found = batch(&model, &solver, &options, (&parameters, &values), &mut Hooks::default())?;
        let time = (processor(start) - begin) / DESIGNS as f64;
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
