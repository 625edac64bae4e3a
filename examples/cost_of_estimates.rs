//! Cost of the error estimate, in milliseconds: for the bladed disk with its ring damper, beside the points that are
//! estimated and beside what the harmonics of the estimate would cost themselves; and for chains with many contacts.
//!
//!     cargo run --release --example cost_of_estimates

use std::error::Error;
use std::f64::consts::PI;
use std::time::Instant;

use hbvib::{
    Branch, Contact, ForcedOptions, Hooks, MatrixKind, MatrixView, Model, SolverOptions, Spring, estimate_at,
    forced_response,
};

use model::{B2, Parameters};

#[allow(dead_code, reason = "the model is needed here, its modes are not")]
#[path = "ring_damper/model.rs"]
mod model;

/// The resonance of the bladed disk, rad/s, and a frequency near its peak.
const RANGE: (f64, f64) = (1309.5, 1314.5);
const OMEGA: f64 = 1312.0;

fn main() -> Result<(), Box<dyn Error>> {
    bladed_disk()?;
    println!();
    chains()
}

/// Options with a fixed highest harmonic.
fn fixed(harmonics: usize) -> SolverOptions {
    SolverOptions {
        harmonics,
        tolerance: 0.0,
        ..SolverOptions::default()
    }
}

fn respond(model: &Model, solver: &SolverOptions, (from, to): (f64, f64)) -> hbvib::Result<Branch> {
    let range = ForcedOptions {
        omega_start: from,
        omega_stop: to,
        ..ForcedOptions::default()
    };
    forced_response(model, solver, &range, &mut Hooks::default())
}

/// Wall time of something that is repeated for 0.3 s, in milliseconds.
fn milliseconds<T>(mut work: impl FnMut() -> hbvib::Result<T>) -> hbvib::Result<f64> {
    let started = Instant::now();
    let mut times = 0;
    while started.elapsed().as_secs_f64() < 0.3 {
        work()?;
        times += 1;
    }
    Ok(1e3 * started.elapsed().as_secs_f64() / f64::from(times))
}

fn bladed_disk() -> Result<(), Box<dyn Error>> {
    let model = Parameters::default().model()?;
    println!(
        "bladed disk, ms      |       a point      |      an estimate      | at the H of the estimate\n\
         \x20  H  points  iter. |  alone   estimated |  alone  steps  its H  |  iteration   cold start   at H"
    );
    for highest in [3, 9, 31, 63] {
        let plain = SolverOptions {
            response_dof: Some(B2),
            ..fixed(highest)
        };
        let estimated = SolverOptions {
            estimate_error: true,
            ..plain
        };
        let branch = respond(&model, &estimated, RANGE)?;
        let points = branch.points() as f64;
        let iterations = branch.newton_iterations().iter().sum::<f64>() / points;
        let without = milliseconds(|| respond(&model, &plain, RANGE))? / points;
        let with = milliseconds(|| respond(&model, &estimated, RANGE))? / points;
        let one = respond(&model, &plain, (OMEGA, OMEGA))?;
        let found = estimate_at(&model, &plain, &one, 0)?;
        let alone = milliseconds(|| estimate_at(&model, &plain, &one, 0))?;
        let extended = SolverOptions {
            harmonics: found.harmonics,
            ..plain
        };
        let there = respond(&model, &extended, RANGE)?;
        let iteration =
            milliseconds(|| respond(&model, &extended, RANGE))? / there.newton_iterations().iter().sum::<f64>();
        let cold = milliseconds(|| respond(&model, &extended, (OMEGA, OMEGA)))?;
        let own = milliseconds(|| respond(&model, &plain, (OMEGA, OMEGA)))?;
        println!(
            "{highest:5}  {points:6}  {iterations:5.1} | {without:6.3}      {with:6.3} | {alone:6.3}  {:5}  {:5}  | \
             {iteration:10.3}   {cold:10.3} {own:6.3}",
            found.steps, found.harmonics
        );
    }
    Ok(())
}

/// Masses on springs in a row, the first one held; some of them rub on the ground.
fn chain(masses: usize, contacts: usize) -> hbvib::Result<Model> {
    let mut mass = vec![0.0; masses * masses];
    for i in 0..masses {
        mass[i * masses + i] = 1.0;
    }
    let mut model = Model::new(masses)?;
    model.set_matrix(MatrixKind::Mass, &MatrixView::dense(masses, &mass))?;
    mass.fill(0.0);
    model.set_matrix(MatrixKind::Stiffness, &MatrixView::dense(masses, &mass))?;
    for i in 0..masses {
        model.add_spring(&Spring {
            dof_a: Some(i),
            dof_b: i.checked_sub(1),
            sector_offset: 0,
            stiffness: 4.0,
        })?;
    }
    model.set_rayleigh(0.01, 0.002)?;
    for c in 0..contacts {
        let at = masses - 1 - c * (masses / contacts);
        model.add_contact(&Contact::jenkins(at, None, 1.0, 0.3, 0.2 + 0.1 * c as f64))?;
    }
    model.add_force(masses - 1, 1, 0.5.into())?;
    Ok(model)
}

fn chains() -> Result<(), Box<dyn Error>> {
    println!("chains, ms\ncontacts    H  points  unknown  an iteration  an estimate");
    for (masses, contacts) in [(20, 10), (60, 30)] {
        let lowest = 4.0 * (PI / (4 * masses + 2) as f64).sin();
        let model = chain(masses, contacts)?;
        for highest in [3, 9, 31] {
            let timed = |estimate_error| -> hbvib::Result<(Branch, f64)> {
                let solver = SolverOptions {
                    estimate_error,
                    ..fixed(highest)
                };
                let started = Instant::now();
                let branch = respond(&model, &solver, (0.95 * lowest, 1.05 * lowest))?;
                Ok((branch, 1e3 * started.elapsed().as_secs_f64()))
            };
            let ((plain, without), (estimated, with)) = (timed(false)?, timed(true)?);
            let points = plain.points();
            let iterations: f64 = plain.newton_iterations().iter().sum();
            let unknown = estimated.error_estimate().iter().filter(|x| x.is_nan()).count();
            println!(
                "{contacts:8}  {highest:3}  {points:6}  {unknown:7}  {:12.2}  {:11.2}",
                without / iterations,
                (with - without) / points as f64
            );
        }
    }
    Ok(())
}
