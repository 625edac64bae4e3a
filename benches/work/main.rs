//! Cost of the library's work as multiples of a factorisation that is measured beside it: `cargo bench`.
//!
//! Every row is a ratio of CPU time. Its unit is one LU factorisation of order 11 with a solution (nalgebra) for small
//! structures, one of order 500 or 1000 (faer) for large ones. The unit is measured before and after the row; where the two
//! differ by more than a tenth, other programs disturbed the row, and it is measured again, at last dropped.
//!
//! With arguments, rows are run whose names contain one of them: `cargo bench --bench work -- "case B"`.

mod blade_and_ring;
#[path = "../../examples/friction_patch/brick.rs"]
mod brick;
mod calibration;
mod counting;
#[path = "../../examples/support/cpu_time.rs"]
mod cpu_time;
mod many;
#[path = "../../examples/ring_damper/model.rs"]
#[allow(dead_code, reason = "only the model is used here")]
mod model;
#[path = "../../examples/support/plate.rs"]
mod plate;
mod small;

use calibration::Unit;
use cpu_time::cpu_seconds;
use hbvib::{Branch, Result};
use std::process::ExitCode;

/// One row: what is run, and in what unit it is told.
struct Row {
    name: &'static str,
    unit: Unit,
    run: fn() -> Result<Work>,
}

/// What a run did.
struct Work {
    points: usize,
    iterations: usize,
    /// Part of the CPU time that is told; `None`: all of it.
    seconds: Option<f64>,
    /// What the time is divided by: 1, points or iterations.
    per: (f64, &'static str),
}

impl Work {
    /// The whole of a branch.
    fn whole(branch: &Branch) -> Self {
        Self {
            points: branch.points(),
            iterations: branch.newton_iterations().iter().sum::<f64>() as usize,
            seconds: None,
            per: (1.0, "all"),
        }
    }
}

/// Largest relative difference of the units before and after a row.
const DRIFT: f64 = 0.1;

/// Shortest CPU time of a stretch of repetitions, s; most repetitions in a stretch, and stretches of quick rows, of which the
/// quickest counts.
const LEAST: f64 = 0.05;
const MOST: usize = 400;
const STRETCHES: usize = 6;

/// Attempts to measure a row without disturbance.
const ATTEMPTS: usize = 8;

/// Repetitions of a row.
struct Stretch {
    count: usize,
    /// CPU time and requests for memory of one.
    seconds: f64,
    allocations: usize,
    work: Work,
}

/// Repeats a row until the stretch is long enough.
fn stretch(row: &Row) -> Result<Stretch> {
    let (begin, allocations) = (cpu_seconds(), counting::count());
    let (mut own, mut count) = (0.0, 0);
    loop {
        let start = cpu_seconds();
        let work = (row.run)()?;
        own += work.seconds.unwrap_or_else(|| cpu_seconds() - start);
        count += 1;
        if cpu_seconds() - begin > LEAST || count == MOST {
            return Ok(Stretch {
                count,
                seconds: own / count as f64,
                allocations: (counting::count() - allocations) / count,
                work,
            });
        }
    }
}

/// Prints one row.
fn measure(row: &Row) -> Result<()> {
    let mut shown = f64::INFINITY;
    let mut told = None;
    for _ in 0..ATTEMPTS {
        let before = row.unit.seconds();
        let mut least = stretch(row)?;
        for _ in 1..if least.seconds * least.count as f64 > 1.0 {
            1
        } else {
            STRETCHES
        } {
            let next = stretch(row)?;
            if next.seconds < least.seconds {
                least = next;
            }
        }
        let after = row.unit.seconds();
        shown = (before / after).max(after / before) - 1.0;
        if shown <= DRIFT {
            let unit = 0.5 * (before + after);
            told = Some((
                least.seconds / least.work.per.0 / unit,
                unit,
                least.allocations,
                least.work,
            ));
            break;
        }
    }
    let Some((ratio, unit, allocations, work)) = told else {
        println!("{:58} dropped: the unit drifted by {:.0} %", row.name, 100.0 * shown);
        return Ok(());
    };
    let of = |count: usize| count as f64 / work.points.max(1) as f64;
    println!(
        "{:58} {ratio:9.4} {:8} of {:9.3e} s, per {:9} {:5} points, {:5.2} iterations and {:6.1} allocations a point",
        row.name,
        row.unit.name(),
        unit,
        work.per.1,
        work.points,
        of(work.iterations),
        of(allocations),
    );
    Ok(())
}

fn main() -> ExitCode {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let rows = small::ROWS.iter().chain(blade_and_ring::ROWS).chain(many::ROWS);
    for row in rows.filter(|row| wanted.is_empty() || wanted.iter().any(|w| row.name.contains(w.as_str()))) {
        if let Err(e) = measure(row) {
            eprintln!("{}: {e}", row.name);
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}
