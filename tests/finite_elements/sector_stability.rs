//! Stability of the finite-element sector with its 60 contacts, on modes and sliders.

use crate::common::harmonics;
use crate::sector::{Sector, Size};
use hbvib::{Floquet, FloquetOptions, Hooks, Waves, floquet};
use std::f64::consts::TAU;
use std::time::Instant;

/// The sector at 530 Hz, where all contacts slip.
fn stability(size: Size, force: f64, waves: Waves) -> Floquet {
    stability_on(size, force, (waves, None))
}

fn stability_on(size: Size, force: f64, (waves, modes): (Waves, Option<usize>)) -> Floquet {
    let folder = crate::common::programs::root().join("examples/data/fe");
    let model = Sector::read(&folder, size).unwrap().forced(force).unwrap();
    let solver = harmonics(9);
    let branch = crate::common::solve_at(&model, &solver, 530.0 * TAU);
    let begin = Instant::now();
    let options = FloquetOptions {
        waves,
        modes,
        ..FloquetOptions::default()
    };
    let found = floquet(&model, &branch, 0, &options, &mut Hooks::default()).unwrap();
    println!(
        "{} {waves:?}: {:.6} on {} modes, {:.1e} told, {:.1e} of any multiplier, point moved by {:.1e}, {:.1?}",
        size.name(),
        found.radius,
        found.modes,
        found.radius_error,
        found.modes_change,
        found.orbit_change,
        begin.elapsed()
    );
    found
}

#[test]
fn the_reduced_sector_with_all_contacts_has_a_verdict() {
    let found = stability(Size::Reduced, 2.0, Waves::Wave);
    assert_eq!((found.unstable, found.neutral), (0, 0));
    // tests/peers/sector_in_time.py: 0.993794 to 0.993800.
    assert!((found.radius - 0.993797).abs() < 2e-5, "{}", found.radius);
    // The verdict is certain: what the other modes may add is less than what is left to the unit circle.
    assert!(
        found.radius_error < 0.1 * (1.0 - found.radius),
        "{:.1e}",
        found.radius_error
    );
}

/// Ten times the force: the ring hardly follows the rim.
#[test]
fn a_sector_that_slips_throughout_has_a_verdict() {
    let found = stability(Size::Reduced, 20.0, Waves::Wave);
    assert_eq!(found.unstable, 0);
    assert!(found.orbit_change < 0.2);
}

#[test]
#[ignore = "a minute long, a good part of it the response; tests/deep.sh runs it"]
fn the_full_sector_and_the_wheel_have_a_verdict() {
    let reduced = stability(Size::Reduced, 2.0, Waves::Wave);
    // On twice as many modes the radius is another one by no more than is told.
    let more = stability_on(Size::Reduced, 2.0, (Waves::Wave, Some(2 * reduced.modes)));
    let off = (more.radius - reduced.radius).abs();
    assert!(off <= reduced.radius_error, "{off:.1e} of {:.1e}", reduced.radius_error);
    let full = stability(Size::Full, 2.0, Waves::Wave);
    assert_eq!(full.unstable, 0);
    assert!((full.radius - reduced.radius).abs() < 1e-6);
    // The ring, which slips everywhere, hardly decays where it turns as a whole.
    let wheel = stability(Size::Reduced, 2.0, Waves::Wheel);
    assert_eq!(wheel.unstable, 0);
    assert!(wheel.radius > 0.9999 && wheel.radius < 1.0);
}
