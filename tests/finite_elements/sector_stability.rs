//! Stability of the finite-element sector with its 60 contacts.

use crate::sector::{Sector, Size};
use hbvib::analysis::floquet;
use hbvib::hooks::{Hooks, LogLevel};
use hbvib::options::{FloquetOptions, SolverOptions, Waves};
use std::f64::consts::TAU;
use std::time::Instant;

#[test]
#[ignore = "measures"]
fn cost() {
    let folder = crate::common::programs::root().join("examples/data/fe");
    let full = std::env::var("FULL").is_ok();
    let number = |name: &str, or: f64| std::env::var(name).map_or(or, |x| x.parse().unwrap());
    let sector = Sector::read(&folder, if full { Size::Full } else { Size::Reduced }).unwrap();
    let model = sector.forced(number("FORCE", 20.0)).unwrap();
    let solver = SolverOptions {
        harmonics: number("H", 9.0) as usize,
        tolerance: 0.0,
        ..SolverOptions::default()
    };
    let begin = Instant::now();
    let branch = crate::common::solve_at(&model, &solver, number("HZ", 530.0) * TAU);
    println!("response {:.2?}", begin.elapsed());
    let begin = Instant::now();
    let mut print = |_: LogLevel, text: &str| println!("{text} {:.1?}", begin.elapsed());
    let mut hooks = Hooks {
        log: Some(&mut print),
        ..Hooks::default()
    };
    let modes = std::env::var("MODES").ok().map(|x| x.parse().unwrap());
    let options = FloquetOptions {
        waves: if std::env::var("WHEEL").is_ok() {
            Waves::Wheel
        } else {
            Waves::Wave
        },
        modes,
        ..FloquetOptions::default()
    };
    match floquet(&model, &branch, 0, &options, &mut hooks) {
        Ok(found) => println!(
            "{} {} {} on {} modes, change {:.1e} orbit {:.1e} {:?}",
            found.radius,
            found.unstable,
            found.neutral,
            found.modes,
            found.modes_change,
            found.orbit_change,
            begin.elapsed()
        ),
        Err(e) => println!("{e} {:?}", begin.elapsed()),
    }
}
