//! Stability of the finite-element sector with its 60 contacts, on modes and sliders.

use crate::sector::{Sector, Size};
use hbvib::Floquet;
use hbvib::analysis::floquet;
use hbvib::hooks::Hooks;
use hbvib::options::{FloquetOptions, SolverOptions, Waves};
use std::f64::consts::TAU;
use std::time::Instant;

/// The sector under 2 N at 530 Hz, where all contacts slip.
fn stability(size: Size, waves: Waves) -> Floquet {
    let folder = crate::common::programs::root().join("examples/data/fe");
    let model = Sector::read(&folder, size).unwrap().forced(2.0).unwrap();
    let solver = SolverOptions {
        harmonics: 9,
        tolerance: 0.0,
        ..SolverOptions::default()
    };
    let branch = crate::common::solve_at(&model, &solver, 530.0 * TAU);
    let begin = Instant::now();
    let options = FloquetOptions {
        waves,
        ..FloquetOptions::default()
    };
    let found = floquet(&model, &branch, 0, &options, &mut Hooks::default()).unwrap();
    println!(
        "{} {waves:?}: {:.6} on {} modes, {:.1e} told, point moved by {:.1e}, {:.1?}",
        size.name(),
        found.radius,
        found.modes,
        found.modes_change,
        found.orbit_change,
        begin.elapsed()
    );
    found
}

#[test]
fn the_reduced_sector_with_all_contacts_has_a_verdict() {
    let found = stability(Size::Reduced, Waves::Wave);
    assert_eq!((found.unstable, found.neutral), (0, 0));
    assert!((found.radius - 0.9938).abs() < 1e-4, "{}", found.radius);
}

#[test]
#[ignore = "half a minute long, most of it the response; tests/deep.sh runs it"]
fn the_full_sector_and_the_wheel_have_a_verdict() {
    let reduced = stability(Size::Reduced, Waves::Wave);
    let full = stability(Size::Full, Waves::Wave);
    assert_eq!(full.unstable, 0);
    assert!((full.radius - reduced.radius).abs() < 1e-6);
    // The ring, which slips everywhere, hardly decays where it turns as a whole.
    let wheel = stability(Size::Reduced, Waves::Wheel);
    assert_eq!(wheel.unstable, 0);
    assert!(wheel.radius > 0.9999 && wheel.radius < 1.0);
}
