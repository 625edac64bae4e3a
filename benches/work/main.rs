//! Cost of the library's work as multiples of a factorisation that is measured beside it: `cargo bench`.
//!
//! Every row is a ratio of CPU time. Its unit is one LU factorisation of order 11 with a solution (nalgebra) for small
//! structures, one of order 500 or 1000 (faer) for large ones. The unit is measured before and after the row; where the two
//! differ by more than a tenth, other programs disturbed the row, and it is measured again, at last dropped.
//!
//! A row has a stored ratio. One that stays more than 1.3 times as slow is refused: the bench ends with exit code 1. Ratios were
//! stored on a 2.6 GHz server with AVX-512; on processors of another kind they differ by some tens of percent, and `-- --tell`
//! measures without refusing. A row that has become quicker by a tenth is to be stored anew.
//!
//! With arguments, rows are run whose names contain one of them: `cargo bench --bench work -- "case B"`.

mod blade_and_ring;
#[path = "../../examples/friction_patch/brick.rs"]
mod brick;
mod calibration;
mod chains;
mod counting;
#[path = "../../examples/support/cpu_time.rs"]
mod cpu_time;
mod fe_sector;
mod many;
#[path = "../../examples/support/matrix_market.rs"]
mod matrix_market;
#[path = "../../examples/ring_damper/model.rs"]
#[allow(dead_code, reason = "only the model is used here")]
mod model;
#[path = "../../examples/support/plate.rs"]
mod plate;
#[path = "../../examples/fe_sector/sector.rs"]
mod sector;
mod small;
#[path = "../../examples/support/table.rs"]
mod table;

use calibration::Unit;
use cpu_time::cpu_seconds;
use hbvib::{Branch, Result};
use std::process::ExitCode;

/// One row: its name, its unit, its stored ratio, and the work.
struct Row {
    name: &'static str,
    unit: Unit,
    stored: f64,
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

/// Largest ratio to the stored one, and measurements of a row above it, of which the least counts.
const WORSE: f64 = 1.3;
const MEASUREMENTS: usize = 3;

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

/// Measures one row until it is not worse than stored, and prints it; returns its ratio to the stored one, if it was not dropped.
fn compare(row: &Row) -> Result<Option<f64>> {
    let mut least: Option<f64> = None;
    for _ in 0..MEASUREMENTS {
        if let Some(ratio) = measure(row)? {
            least = Some(least.map_or(ratio, |l| l.min(ratio)));
        }
        if least.is_some_and(|ratio| ratio <= WORSE) {
            break;
        }
    }
    Ok(least)
}

/// Measures and prints one row; returns its ratio to the stored one, if it was not dropped.
fn measure(row: &Row) -> Result<Option<f64>> {
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
        return Ok(None);
    };
    let of = |count: usize| count as f64 / work.points.max(1) as f64;
    println!(
        "{:58} {ratio:9.4} {:8} of {:9.3e} s, {:5.2} of stored, per {:9} {:5} points, {:5.2} iterations and {:6.1} allocations a point",
        row.name,
        row.unit.name(),
        unit,
        ratio / row.stored,
        work.per.1,
        work.points,
        of(work.iterations),
        of(allocations),
    );
    Ok(Some(ratio / row.stored))
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let refuses = !arguments.iter().any(|a| a == "--tell");
    let wanted: Vec<&String> = arguments.iter().filter(|a| !a.starts_with("--")).collect();
    let rows = small::ROWS
        .iter()
        .chain(blade_and_ring::ROWS)
        .chain(chains::ROWS)
        .chain(many::ROWS)
        .chain(fe_sector::ROWS);
    let mut refused = 0;
    for row in rows.filter(|row| wanted.is_empty() || wanted.iter().any(|w| row.name.contains(w.as_str()))) {
        match compare(row) {
            Ok(Some(ratio)) if ratio > WORSE => {
                eprintln!("{}: {ratio:.2} times the stored ratio, more than {WORSE}", row.name);
                refused += 1;
            }
            Ok(_) => {}
            Err(e) => {
                eprintln!("{}: {e}", row.name);
                refused += 1;
            }
        }
    }
    if refuses && refused > 0 {
        eprintln!("{refused} rows refused");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}
