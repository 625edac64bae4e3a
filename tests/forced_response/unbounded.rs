//! Undamped resonances inside a range: the status tells those that the forces excite, and no others; and peaks beside rounding.

use crate::common::models::{Structure, chain, dense, oscillator, unit_chain};
use crate::common::options::{at_dof, harmonics, omega_range};
use hbvib::{Contact, Hooks, Model, Status, forced_response};

fn status(model: &Model, dof: usize) -> Status {
    let options = at_dof(dof, harmonics(1));
    let branch = forced_response(model, &options, &omega_range(0.5, 2.05), &mut Hooks::default()).unwrap();
    if branch.status() == Status::StoppedUnbounded {
        assert!(branch.reason().unwrap().to_string().contains("no bound"));
    }
    branch.status()
}

/// Three unit masses with dashpots; the middle one is the node of mode 2 at √2.
fn three(dashpots: [f64; 3]) -> Structure {
    let mut damping = [0.0; 9];
    for (i, c) in dashpots.into_iter().enumerate() {
        damping[4 * i] = c;
    }
    unit_chain(3).damping(&damping)
}

#[test]
fn an_undamped_resonance_that_is_excited_is_told() {
    for k in [0.7, 1.0, 1.5, 1.9, 2.7] {
        assert_eq!(
            status(&oscillator(1.0, k).force(0, 1, 1.0).build(), 0),
            Status::StoppedUnbounded,
            "{k}"
        );
    }
    let stuck = Contact::jenkins(0, None, 0.5, 0.3, f64::INFINITY);
    let held = oscillator(1.0, 1.0).contact(&stuck).force(0, 1, 1.0).build();
    assert_eq!(status(&held, 0), Status::StoppedUnbounded);
    assert_eq!(
        status(&three([0.0; 3]).force(0, 1, 1.0).build(), 0),
        Status::StoppedUnbounded
    );
    let at_node = three([0.0, 0.1, 0.0]).force(0, 1, 1.0).build();
    assert_eq!(status(&at_node, 0), Status::StoppedUnbounded);
    // A small part of the force in the undamped mode.
    let hardly = three([0.0, 0.1, 0.0]).force(1, 1, 1.0).force(0, 1, 1e-4).build();
    assert_eq!(status(&hardly, 0), Status::StoppedUnbounded);
    let long = chain(&[1.0; 130], &[1.0; 131]).force(0, 1, 1.0).build();
    assert_eq!(status(&long, 0), Status::StoppedUnbounded);
}

#[test]
fn an_undamped_resonance_without_force_is_passed() {
    let model = three([0.0, 0.1, 0.0]).force(1, 1, 1.0).build();
    assert_eq!(status(&model, 1), Status::Ok);
    let damped = three([0.01, 0.1, 0.01]).force(0, 1, 1.0).build();
    assert_eq!(status(&damped, 0), Status::Ok);
}

#[test]
fn peaks_of_hardly_damped_resonances_are_those_in_closed_form() {
    // In the modes of two equal masses C = βK leaves 1/(2ω · ½βω²) of half the force each.
    let k = [1.5, -0.5, -0.5, 1.5];
    for beta in [1e-4, 1e-6, 1e-7, 1e-8, 3e-9, 1e-9, 1e-10, 1e-11] {
        let model = dense(&[1.0, 0.0, 0.0, 1.0], &k)
            .rayleigh(0.0, beta)
            .force(0, 1, 1.0)
            .build();
        for [start, stop] in [[0.5, 2.0], [2.0, 0.5], [0.9, 1.6]] {
            let options = at_dof(0, harmonics(1));
            let branch = forced_response(&model, &options, &omega_range(start, stop), &mut Hooks::default()).unwrap();
            assert_eq!(branch.peaks().len(), 2, "{beta} {start}");
            for peak in branch.peaks() {
                let omega: f64 = if peak.omega < 1.2 { 1.0 } else { 2.0_f64.sqrt() };
                let exact = 0.5 / (beta * omega.powi(3));
                // A rounding of the frequency, over the half width.
                let bound = 1e-6 + (1e-15 / beta).powi(2) + 1e3 * beta;
                assert!((peak.amplitude / exact - 1.0).abs() < bound, "{beta}: {peak:?} {exact}");
            }
        }
    }
}
