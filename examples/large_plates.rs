//! Forced response of large plates with sliders: CPU time and resident memory of each step.
//!
//! `cargo run --release --example large_plates -- [x y z [sliders [harmonics [automatic|direct|krylov [frequency
//! [memory_limit]]]]]]`, with the numbers of bricks along the edges of the plate. The sweep is about the frequency in Hz,
//! or about the first natural one.

#[path = "friction_patch/brick.rs"]
mod brick;
#[path = "support/plate.rs"]
mod plate;

use hbvib::{ContactState, Flexibility, ForcedOptions, Hooks, Result, SolverOptions, forced_response};
use plate::Plate;
use std::f64::consts::TAU;
use std::process::ExitCode;

/// Seconds of CPU time of this process, and its present and largest resident memory in MB.
fn used() -> (f64, f64, f64) {
    let read = |path: &str| std::fs::read_to_string(path).unwrap_or_default();
    let stat = read("/proc/self/stat");
    let fields: Vec<f64> = stat
        .rsplit(')')
        .next()
        .unwrap_or("")
        .split_whitespace()
        .skip(11)
        .take(2)
        .filter_map(|x| x.parse().ok())
        .collect();
    let status = read("/proc/self/status");
    let memory = |name: &str| {
        let line = status.lines().find(|line| line.starts_with(name));
        let number = line
            .and_then(|line| line.split_whitespace().nth(1))
            .and_then(|x| x.parse::<f64>().ok());
        number.unwrap_or(f64::NAN) / 1024.0
    };
    (fields.iter().sum::<f64>() / 100.0, memory("VmRSS:"), memory("VmHWM:"))
}

fn step(name: &str, last: &mut f64) {
    let (cpu, now, most) = used();
    println!(
        "{name:40} {:8.2} s CPU {now:8.0} MB, at most {most:8.0} MB",
        cpu - *last
    );
    *last = cpu;
}

fn run(arguments: &[String]) -> Result<()> {
    let number = |i: usize, default: usize| arguments.get(i).and_then(|x| x.parse().ok()).unwrap_or(default);
    let plate = Plate::new([number(0, 30), number(1, 18), number(2, 2)]);
    let (sliders, harmonics) = (number(3, 20), number(4, 3));
    let flexibility = match arguments.get(5).map(String::as_str) {
        Some("direct") => Flexibility::Direct,
        Some("krylov") => Flexibility::Krylov,
        _ => Flexibility::Automatic,
    };
    let mut last = 0.0;
    println!(
        "{} degrees of freedom, {sliders} sliders, H = {harmonics}",
        plate.ndof()
    );
    let model = plate.with_sliders(sliders, 2e5, 0.05)?;
    step("model", &mut last);
    let given = arguments.get(6).and_then(|x| x.parse::<f64>().ok());
    let omega = if let Some(frequency) = given {
        TAU * frequency
    } else {
        let modes = model.lowest_modes(0, ContactState::Stuck, 3)?;
        step("three natural modes", &mut last);
        println!("lowest frequency with stuck sliders {:.3} Hz", modes.omega[0] / TAU);
        modes.omega[0]
    };
    let solver = SolverOptions {
        tolerance: 0.0,
        harmonics,
        response_dof: Some(plate.corner()),
        flexibility,
        memory_limit: number(7, 0),
        ..SolverOptions::default()
    };
    for (name, from, to) in [
        ("sweep", 0.8, 1.2),
        ("the same sweep", 0.8, 1.2),
        ("sweep further up", 1.1, 1.4),
    ] {
        let range = ForcedOptions {
            omega_start: from * omega,
            omega_stop: to * omega,
            ..ForcedOptions::default()
        };
        let branch = forced_response(&model, &solver, &range, &mut Hooks::default())?;
        step(name, &mut last);
        let reduction = branch.reduction();
        println!(
            "  {} points, {} peaks, basis {}, certificate {:.1e}, largest amplitude {:.6e} m",
            branch.points(),
            branch.peaks().len(),
            reduction.basis,
            reduction.certificate,
            branch.amplitude().iter().fold(0.0_f64, |a, &b| a.max(b))
        );
    }
    Ok(())
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("{e}");
            ExitCode::FAILURE
        }
    }
}
