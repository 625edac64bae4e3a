//! The freedom of all points of a sweep, as columns of its branch: that of the call for each point, at hardly any work where nothing is
//! free.

use crate::common::models::dense;
use crate::common::{harmonics, omega_range, solve_at, sweep};
use crate::residual_band::{across, peak_wedge, wedge};
use hbvib::{
    Contact, ContactKind, Friction2d, Hooks, Model, Phase, PhaseReport, SolverOptions, Speed, Status, forced_response,
    freedom,
};

/// Models without any freedom, and ranges of frequency: contacts that slip, and the ring damper.
pub fn without_freedom() -> [(Model, f64, f64); 2] {
    let slipping = dense(&[1.0, 0.0, 0.0, 1.0], &[1.0, 0.0, 0.0, 1.0])
        .damping(&[0.05, 0.0, 0.0, 0.05])
        .slider(0, 1.0, 0.2, 1.0)
        .contact(Contact::jenkins(0, Some(1), 0.5, 0.2, 0.5))
        .force(0, 1, 0.6)
        .build();
    let turn = std::f64::consts::TAU;
    [
        (slipping, 0.8, 1.8),
        (crate::common::BASE.sector(), turn * 207.0, turn * 211.0),
    ]
}

/// With the option, each stored point has what the call has for it; where nothing is free, the sweep costs no more than before.
#[test]
fn a_sweep_has_the_freedom_of_each_of_its_points() {
    let solver = SolverOptions {
        freedom: true,
        ..harmonics(7)
    };
    let line = wedge([0.6, 0.2], 0.1, ContactKind::Friction2d(Friction2d::default()));
    for (model, from, to) in [(line, 0.95, 1.6), (across(0.1), 1.1, 1.4), (peak_wedge(), 1.23, 1.27)] {
        let branch = sweep(&model, &solver, from, to, &[]);
        assert!(branch.tells_freedom() && branch.free_sliders().len() == branch.points());
        for point in 0..branch.stored() {
            let free = freedom(&model, &branch, point).unwrap();
            let columns = branch.d_amplitude_by_place_at(point).unwrap();
            let told: Vec<(usize, usize, f64)> = columns
                .iter()
                .enumerate()
                .flat_map(|(contact, row)| [0, 1].map(|k| (contact, k, row[k])))
                .filter(|one| !one.2.is_nan())
                .collect();
            assert_eq!(told.len(), free.len());
            if let Some(count) = branch.free_sliders().get(point) {
                assert!((count - free.len() as f64).abs() < 1e-12);
            }
            let size = free.iter().map(|one| one.derivative.abs()).fold(1e-3, f64::max);
            for (one, (contact, k, derivative)) in free.iter().zip(told) {
                assert_eq!((one.contact, one.direction), (contact, k));
                assert!(
                    (derivative - one.derivative).abs() < 1e-8 * size,
                    "{derivative} {}",
                    one.derivative
                );
            }
        }
        assert!(branch.free_sliders().iter().any(|count| *count > 0.0));
        let without = sweep(&model, &harmonics(7), from, to, &[]);
        assert!(!without.tells_freedom() && without.d_amplitude_by_place_at(0).is_none());
        assert_eq!(
            branch.amplitude().iter().map(|a| a.to_bits()).collect::<Vec<_>>(),
            without.amplitude().iter().map(|a| a.to_bits()).collect::<Vec<_>>()
        );
    }
    for (model, from, to) in without_freedom() {
        let work = [false, true].map(|freedom| {
            let asked = std::cell::Cell::new(0_u64);
            let count = || {
                asked.set(asked.get() + 1);
                false
            };
            let mut hooks = Hooks {
                cancelled: Some(&count),
                ..Hooks::default()
            };
            let range = omega_range(from, to);
            let solver = SolverOptions {
                freedom,
                ..harmonics(9)
            };
            let branch = forced_response(&model, &solver, &range, &mut hooks).unwrap();
            assert!(branch.free_sliders().iter().all(|count| *count == 0.0));
            asked.get()
        });
        println!("{work:?}");
        assert!(20 * (work[1] - work[0]) < work[0]);
    }
}

/// A caller who stops while the freedom is computed has the curve, and the freedom of the points before.
#[test]
fn a_stop_in_the_freedom_leaves_the_curve() {
    let model = peak_wedge();
    let whole = sweep(&model, &harmonics(5), 1.23, 1.27, &[]);
    let solver = SolverOptions {
        freedom: true,
        ..harmonics(5)
    };
    let seen = std::cell::Cell::new(0);
    let phase = |report: &PhaseReport| {
        if report.phase == Phase::Results {
            seen.set(seen.get() + 1);
        }
        seen.get() > 3
    };
    let mut hooks = Hooks {
        phase: Some(&phase),
        ..Hooks::default()
    };
    let range = omega_range(1.23, 1.27);
    let branch = forced_response(&model, &solver, &range, &mut hooks).unwrap();
    assert_eq!(branch.status(), Status::StoppedByCaller);
    assert_eq!(branch.points(), whole.points());
    let known = branch.free_sliders().iter().take_while(|count| !count.is_nan()).count();
    assert!(known > 0 && known < branch.points());
    assert!(branch.free_sliders()[known..].iter().all(|count| count.is_nan()));
}

/// A contact whose load follows the frequency has the freedom that it has under the load of its speed.
#[test]
fn freedom_under_a_load_that_follows_the_frequency_is_that_of_its_speed() {
    let omega = 1.3;
    let solver = SolverOptions {
        freedom: true,
        ..harmonics(7)
    };
    let found = [Speed::PerOmega(0.5), Speed::Fixed(0.5 * omega)].map(|speed| {
        let mut model = wedge([0.6, 0.2], 0.1, ContactKind::Friction2d(Friction2d::default()));
        model.set_preload_at_speed(0, 0.05, 0.1).unwrap();
        model.set_speed(speed).unwrap();
        let branch = solve_at(&model, &solver, omega);
        let free = freedom(&model, &branch, 0).unwrap();
        assert_eq!(free.len(), 1);
        let column = branch.d_amplitude_by_place_at(0).unwrap()[0][0];
        [free[0].place, free[0].derivative, column]
    });
    println!("{found:?}");
    for (tied, fixed) in found[0].iter().zip(found[1]) {
        assert!((tied - fixed).abs() < 1e-8, "{found:?}");
    }
}
