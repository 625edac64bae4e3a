//! Peaks of a response with a law that is sampled: those of many samples, and none on a slope.

use crate::common::models::oscillator;
use crate::common::options::{at_dof, harmonics, omega_range};
use hbvib::{Contact, Hooks, SolverOptions, forced_response};
use num_complex::Complex64;

#[test]
fn ripples_of_samples_are_no_peaks() {
    let friction = Contact::regularised(0, None, 0.3, 0.135, 0.0355);
    let model = oscillator(1.74588, 1.04284)
        .damping(&[0.03])
        .contact(&friction)
        .force(0, 1, Complex64::new(-0.20839, -0.08339))
        .force(0, 2, Complex64::new(0.56910, -1.34524))
        .build();
    let peaks = |samples: usize, highest: usize| -> Vec<[f64; 2]> {
        let options = SolverOptions {
            samples,
            ..at_dof(0, harmonics(highest))
        };
        let branch = forced_response(&model, &options, &omega_range(0.23, 1.1), &mut Hooks::default()).unwrap();
        branch.peaks().iter().map(|peak| [peak.omega, peak.amplitude]).collect()
    };
    for highest in [3, 9] {
        // With so many samples the slope has no ripple: between 0.36 and 0.40 it rises without a maximum.
        let exact = peaks(8192, highest);
        let found = peaks(0, highest);
        assert!(
            found.iter().all(|[omega, _]| !(0.36..0.40).contains(omega)),
            "{found:?}"
        );
        let high = |all: &[[f64; 2]]| {
            all.iter()
                .fold([0.0; 2], |most, peak| if peak[1] > most[1] { *peak } else { most })
        };
        let (a, b) = (high(&exact), high(&found));
        assert!(a[1] > 1.0, "{exact:?}");
        assert!(
            (a[0] - b[0]).abs() < 1e-3 && (a[1] - b[1]).abs() < 1e-3 * a[1],
            "{exact:?} {found:?}"
        );
    }
}
