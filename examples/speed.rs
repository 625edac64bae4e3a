//! Speed against error: the response of the ring damper at several H, with exact events and sampled.
//!
//! Prints for each way: points, Newton iterations, time of the sweep as a ratio to the default (H = 9, exact
//! events), and the error of the peak amplitude against H = 255. Times are minima over repeated sweeps, measured
//! alternately in one run: read them as ratios. With the argument `iteration` it prints the times of the parts of a
//! Newton iteration instead, with `designs` the cost of a design in a batch.

use hbvib::{Branch, ForcedOptions, Hooks, SolverOptions, forced_response};
use std::error::Error;
use std::f64::consts::TAU;
use std::time::Instant;

#[path = "support/cpu_time.rs"]
mod cpu_time;
#[path = "speed/designs.rs"]
mod designs;
#[path = "speed/iteration.rs"]
mod iteration;
#[path = "ring_damper/model.rs"]
#[allow(dead_code, reason = "only the response is used here")]
mod model;

/// (highest harmonic, samples per period; 0 = exact events)
const WAYS: [(usize, usize); 13] = [
    (1, 0),
    (3, 0),
    (5, 0),
    (9, 0),
    (15, 0),
    (31, 0),
    (63, 0),
    (127, 0),
    (255, 0),
    (9, 64),
    (9, 256),
    (9, 1024),
    (9, 4096),
];

/// Sweeps per way; the quickest counts.
const REPEATS: usize = 7;

fn sweep(force: f64, harmonics: usize, samples: usize) -> Result<(Branch, f64), Box<dyn Error>> {
    let parameters = model::Parameters {
        force,
        ..model::Parameters::default()
    };
    let model = parameters.model()?;
    let options = SolverOptions {
        harmonics,
        samples,
        response_dof: Some(model::B2),
        tolerance: 0.0,
        ..SolverOptions::default()
    };
    let range = ForcedOptions {
        omega_start: 207.0 * TAU,
        omega_stop: 211.0 * TAU,
        ..ForcedOptions::default()
    };
    let begin = Instant::now();
    let branch = forced_response(&model, &options, &range, &mut Hooks::default())?;
    Ok((branch, begin.elapsed().as_secs_f64()))
}

fn peak(branch: &Branch) -> f64 {
    branch.peaks().iter().fold(0.0, |m, p| p.amplitude.max(m))
}

fn main() -> Result<(), Box<dyn Error>> {
    match std::env::args().nth(1).as_deref() {
        Some("iteration") => return iteration::run(),
        Some("designs") => return designs::run(),
        _ => {}
    }
    for force in [1.0, 5.0, 20.0] {
        let truth = peak(&sweep(force, 255, 0)?.0);
        let mut times = [f64::INFINITY; WAYS.len()];
        let mut branches = Vec::new();
        for round in 0..REPEATS {
            for (time, (harmonics, samples)) in times.iter_mut().zip(WAYS) {
                if round > 1 && (harmonics > 31 || samples > 256) {
                    continue;
                }
                let (branch, seconds) = sweep(force, harmonics, samples)?;
                *time = time.min(seconds);
                if round == 0 {
                    branches.push(branch);
                }
            }
        }
        let default = times[3];
        println!("\nF = {force} N, 207 to 211 Hz");
        println!("  H    events   points  iterations  ms/point  time/default  peak error  at same H");
        let exact = peak(&branches[3]);
        for (((harmonics, samples), time), branch) in WAYS.iter().zip(times).zip(&branches) {
            let events = if *samples == 0 {
                "exact".into()
            } else {
                format!("N={samples}")
            };
            let iterations: f64 = branch.newton_iterations().iter().sum();
            let same = if *samples == 0 {
                String::new()
            } else {
                format!("{:.1e}", (peak(branch) / exact - 1.0).abs())
            };
            println!(
                "{harmonics:3}  {events:>8}  {:7}  {iterations:10}  {:8.4}  {:12.2}  {:10.1e}  {same:>9}",
                branch.points(),
                time * 1e3 / branch.points() as f64,
                time / default,
                (peak(branch) / truth - 1.0).abs(),
            );
        }
    }
    Ok(())
}
