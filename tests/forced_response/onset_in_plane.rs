//! Sweeps over the onset of slip of a contact in the plane, where the circles that hold its slider at rest cease to meet. Its place goes
//! with the root of the distance in the frequency there, so that the branch has a corner that it reaches along the surface of the event.

use crate::common::models::{dense, diagonal, tridiagonal};
use crate::common::{harmonics, omega_range};
use hbvib::{Branch, Contact, ForcedOptions, Hooks, Model, Status, forced_response};
use num_complex::Complex64;

/// A chain of six masses with springs to the ground and damping 0.01 M + 0.02 K.
fn chain(mass: [f64; 6], stiffness: [f64; 6], between: [f64; 5]) -> Model {
    dense(&diagonal(&mass), &tridiagonal(&stiffness, &between))
        .rayleigh(0.01, 0.02)
        .build()
}

/// Two contacts under constant loads, with a static force.
fn model() -> Model {
    let mut under_load = chain(
        [1.402_318, 0.891_03, 0.979_02, 1.267_274, 1.111_047, 1.243_734],
        [0.974_782, 1.483_886, 2.462_577, 2.436_29, 2.567_203, 1.534_097],
        [-0.431_496, -0.778_571, -1.009_923, -0.600_208, -1.072_933],
    );
    for (a, b, kt, mu, load) in [
        (
            4,
            5,
            0.797_544_769_186_560_5,
            0.237_732_400_329_630_44,
            0.486_131_951_333_845,
        ),
        (
            2,
            0,
            1.102_332_982_540_171_5,
            0.571_549_268_383_481_2,
            0.193_944_423_890_934_25,
        ),
    ] {
        let contact = Contact::friction_3d([Some(a), Some(b), None], [None; 3], (kt, 0.0), mu, load);
        under_load.add_contact(&contact).unwrap();
    }
    let forces = [
        (2, -0.079_355_189_1, 0.081_944_200_5),
        (1, -0.042_242_712_2, 0.212_772_629_5),
    ];
    for (dof, re, im) in forces {
        under_load.add_force(dof, 1, Complex64::new(re, im)).unwrap();
    }
    under_load.add_force(3, 0, (-0.077_378_298_3).into()).unwrap();
    under_load
}

fn sweep(model: &Model, (omega_start, omega_stop): (f64, f64), at: &[f64]) -> Branch {
    let range = ForcedOptions {
        at,
        ..omega_range(omega_start, omega_stop)
    };
    forced_response(model, &harmonics(5), &range, &mut Hooks::default()).unwrap()
}

#[test]
fn sweeps_in_both_directions_go_over_the_onset_of_slip_and_agree() {
    let model = model();
    let at = [0.5, 0.7, 0.9, 1.1, 1.3, 1.5, 1.7, 1.9];
    let mut backward_at = at;
    backward_at.reverse();
    let up = sweep(&model, (0.4, 2.2), &at);
    let down = sweep(&model, (2.2, 0.4), &backward_at);
    for (branch, end) in [(&up, 2.2), (&down, 0.4)] {
        // Points at the corner itself are exact to the root of rounding.
        let status = branch.status();
        assert!([Status::Ok, Status::StoppedStalled].contains(&status), "{status:?}");
        assert_eq!(branch.omega().last(), Some(&end));
    }
    let motion = |branch: &Branch, omega: f64| {
        let point = (0..branch.stored()).find(|point| branch.omega_at(*point) == Some(omega));
        let point = point.unwrap_or_else(|| panic!("no point at {omega}"));
        branch.response_at(point).unwrap()[1]
    };
    for omega in at {
        let (up, down) = (motion(&up, omega), motion(&down, omega));
        assert!((up - down).norm() < 1e-6 * down.norm(), "{omega}: {up} {down}");
    }
}
