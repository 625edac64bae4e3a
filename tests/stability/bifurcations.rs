//! Where a multiplier leaves the unit circle, the motion that integration in time settles on changes.

use crate::common::{all_harmonics, harmonics, one_mass, solve_at};
use crate::{multipliers, ordinary};
use hbvib::{Contact, ContactKind, Hooks, Model, Polynomial, Status, SteadyMethod, TimeOptions, Waves, time_response};
use num_complex::Complex64;

/// The largest multiplier at a frequency, and whether marching from near the point settles on a motion of the same
/// period.
fn settles(model: &Model, omega: f64) -> (Complex64, bool) {
    let branch = solve_at(model, &harmonics(40), omega);
    let found = multipliers(model, &branch, 0, Waves::Wave);
    let start: Vec<Complex64> = all_harmonics(&branch, 0).iter().map(|x| 1.01 * x).collect();
    let options = TimeOptions {
        omega,
        method: SteadyMethod::Marching,
        tolerance: 1e-8,
        max_periods: 1500,
        start: Some(&start),
        ..TimeOptions::default()
    };
    let settled = match time_response(model, &options, &mut Hooks::default()) {
        Ok(_) => true,
        Err(e) if e.status == Status::NoConvergence => false,
        Err(e) => panic!("{e}"),
    };
    let mu = ordinary(&found)[0];
    println!("omega = {omega}: {mu}, settles {settled}");
    assert_eq!(settled, found.unstable == 0);
    (mu, settled)
}

/// A mass against a stop doubles its period where a multiplier passes −1.
#[test]
fn a_mass_against_a_stop_doubles_its_period() {
    let model = one_mass(0.05, &Contact::unilateral(Some(0), None, 10.0, 0.0), 1.0);
    let (before, settled) = settles(&model, 2.3);
    assert!(settled && before.norm() < 1.0);
    let (after, settled) = settles(&model, 2.6);
    assert!(!settled && after.re < -1.0 && after.im.abs() < 1e-9);
}

/// A forced oscillator of van der Pol leaves the frequency of its force where a pair passes the unit circle.
#[test]
fn a_forced_self_excited_oscillator_leaves_the_frequency_of_its_force() {
    let damper = Polynomial::scalar(&[], &[-0.2, 0.0, 0.2]).unwrap();
    let model = one_mass(0.0, &Contact::between(0, None, ContactKind::Polynomial(damper)), 0.2);
    let (before, settled) = settles(&model, 1.1);
    assert!(settled && before.norm() < 1.0);
    let (after, settled) = settles(&model, 1.3);
    assert!(!settled && after.norm() > 1.0 && after.im.abs() > 1e-3);
}
