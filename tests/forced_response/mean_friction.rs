//! A body that hardly anything but friction holds: the mean of the friction turns it until its weak support balances that, at
//! a distance of many vibrations. The balance is that of the truth: force of the support against the mean of the law's force.

use crate::common::models::Structure;
use crate::common::{all_harmonics, harmonics, solve_at};
use hbvib::{Contact, Model, contact_evaluate};
use num_complex::Complex64;

/// Two bodies that move along the contact and across it; the second has the support `hold` along it. The static load
/// presses them together without a motion.
fn driven(hold: f64, contact: &Contact) -> Model {
    Structure::plain(4)
        .diagonals([&[1.0, 1.0, 0.3, 0.3], &[0.01, 0.01, 0.0, 0.01], &[1.0, 1.2, hold, 2.0]])
        .contact(contact)
        .force(0, 1, 0.5)
        .force(1, 1, Complex64::new(0.0, 0.3))
        .force(1, 0, 0.3)
        .force(3, 0, -0.3)
        .build()
}

#[test]
fn the_mean_of_friction_is_balanced_however_weak_the_support() {
    let contact = Contact::friction_2d([Some(0), Some(1)], [Some(2), Some(3)], (1.0, 1.0), 0.4, 0.3);
    for hold in [1e-9, 1e-6, 1e-3, 0.1] {
        let model = driven(hold, &contact);
        for (omega, h) in [(0.9, 1), (1.5, 1), (0.9, 5), (1.5, 5)] {
            let branch = solve_at(&model, &harmonics(h), omega);
            let x = all_harmonics(&branch, 0);
            let relative = |a: usize, b: usize| (0..=h).map(move |k| (4 * k + a, 4 * k + b));
            let motion: Vec<Complex64> = relative(0, 2).chain(relative(1, 3)).map(|(a, b)| x[a] - x[b]).collect();
            let mut force = vec![Complex64::ZERO; motion.len()];
            contact_evaluate(&contact, h, 0, omega, &motion, &mut force, None).unwrap();
            let (friction, support) = (force[0].re, hold * x[2].re);
            let vibration = motion[1].norm();
            println!(
                "support {hold:e}, {omega}, H = {h}: moved by {:.1e} vibrations",
                x[2].re / vibration
            );
            assert!(x[2].re.abs() > 0.01 * vibration, "friction moves the body");
            // The rounding of a motion so far away.
            let tolerance = 1e-6 * support.abs() + 1e-14 * x[2].re.abs();
            assert!(
                (friction - support).abs() < tolerance,
                "{hold:e}, {omega}, {h}: {friction} {support}"
            );
        }
    }
}
