//! Inputs that a response in time refuses, and how a caller stops it.

use crate::common::BASE;
use crate::common::models::{dense, oscillator};
use crate::common::refusal::{OMEGA, refused};
use hbvib::{
    Call, Contact, ContactKind, Hooks, MatrixKind, MatrixView, Model, Part, Progress, Status, SteadyMethod,
    TimeOptions, User, UserForce, time_response,
};
use num_complex::Complex64;
use std::sync::Arc;

fn options() -> TimeOptions<'static> {
    TimeOptions {
        omega: OMEGA,
        ..TimeOptions::default()
    }
}

#[test]
fn bad_options_are_refused_with_value_and_range() {
    let model = BASE.sector();
    let try_with = |options: TimeOptions<'_>| time_response(&model, &options, &mut Hooks::default());
    for (omega, status) in [
        (0.0, Status::Argument),
        (-1.0, Status::Argument),
        (f64::NAN, Status::NotFinite),
        (f64::INFINITY, Status::NotFinite),
    ] {
        let said = format!("omega = {omega}");
        refused(try_with(TimeOptions { omega, ..options() }), status, &[&said, "> 0"]);
    }
    for tolerance in [0.0, 1.0, -1e-9, f64::NAN] {
        refused(
            try_with(TimeOptions { tolerance, ..options() }),
            Status::Argument,
            &["tolerance =", "0 < tolerance < 1"],
        );
    }
    refused(
        try_with(TimeOptions {
            harmonics: usize::MAX,
            ..options()
        }),
        Status::Argument,
        &["harmonics =", "100000"],
    );
    refused(
        try_with(TimeOptions {
            samples: usize::MAX,
            ..options()
        }),
        Status::Argument,
        &["samples ="],
    );
    refused(
        try_with(TimeOptions {
            max_periods: 0,
            ..options()
        }),
        Status::Argument,
        &["max_periods = 0"],
    );
    for len in [0, 3, 5] {
        let start = vec![Complex64::ONE; len];
        refused(
            try_with(TimeOptions {
                start: Some(&start),
                ..options()
            }),
            Status::Dimension,
            &[&format!("start has {len}"), "ndof = 4"],
        );
    }
    let start = [
        Complex64::ONE,
        Complex64::new(0.0, f64::NAN),
        Complex64::ONE,
        Complex64::ONE,
    ];
    refused(
        try_with(TimeOptions {
            start: Some(&start),
            ..options()
        }),
        Status::NotFinite,
        &["start[1]"],
    );
}

fn two_masses(mass: &[f64; 4]) -> Model {
    dense(mass, &[2.0, -1.0, -1.0, 2.0]).force(0, 1, Complex64::ONE).build()
}

#[test]
fn motions_without_mass_and_complex_matrices_are_refused() {
    let try_on = |model: &Model| time_response(model, &options(), &mut Hooks::default());
    refused(
        try_on(&two_masses(&[1.0, 0.0, 0.0, 0.0])),
        Status::Unsupported,
        &["degree of freedom 1 has no mass"],
    );
    refused(
        try_on(&two_masses(&[1.0, 1.0, 1.0, 1.0])),
        Status::Unsupported,
        &["mass matrix is singular"],
    );
    let mut model = two_masses(&[1.0, 0.0, 0.0, 1.0]);
    let hysteretic = [
        Complex64::new(2.0, 0.02),
        Complex64::ZERO,
        Complex64::ZERO,
        Complex64::new(2.0, 0.02),
    ];
    let view = MatrixView::dense_complex(2, &hysteretic).part(Part::General);
    model.set_matrix(MatrixKind::Stiffness, &view).unwrap();
    refused(
        try_on(&model),
        Status::Unsupported,
        &["structural damping has no causal law in time", "viscous equivalent"],
    );
    let turning = [
        2.0.into(),
        Complex64::new(0.0, 0.02),
        Complex64::new(0.0, -0.02),
        2.0.into(),
    ];
    let view = MatrixView::dense_complex(2, &turning).part(Part::General);
    model.set_matrix(MatrixKind::Stiffness, &view).unwrap();
    refused(
        try_on(&model),
        Status::Unsupported,
        &["imaginary part 0.02", "complex matrices mean nothing in time"],
    );
}

#[test]
fn laws_that_are_not_integrated_are_refused_by_name() {
    let mut model = two_masses(&[1.0, 0.0, 0.0, 1.0]);
    model.add_contact(&Contact::jenkins(0, None, 1.0, 0.3, 1.0)).unwrap();
    let plane = Contact::friction_3d([Some(0), Some(1), None], [None; 3], (1.0, 0.0), 0.3, 1.0);
    model.add_contact(&plane).unwrap();
    refused(
        time_response(&model, &options(), &mut Hooks::default()),
        Status::Unsupported,
        &["contact 1", "friction in a plane"],
    );
    let mut model = two_masses(&[1.0, 0.0, 0.0, 1.0]);
    let user = User {
        states: 1,
        ..User::new(Arc::new(NotAsked), 1, 0).unwrap()
    };
    let law = Contact::between(0, None, ContactKind::User(user));
    model.add_contact(&law).unwrap();
    refused(
        time_response(&model, &options(), &mut Hooks::default()),
        Status::Unsupported,
        &["contact 0", "states"],
    );
}

/// A law of the caller with states, refused before it is asked.
struct NotAsked;

impl UserForce for NotAsked {
    fn evaluate(&self, _: &mut Call<'_>) -> i32 {
        -1
    }
}

/// An undamped oscillator at its resonance, held by friction up to a force of 4 μN₀/π alone.
fn at_resonance(force: f64) -> Model {
    oscillator(1.0, 1.0).slider(0, 1.0, 1.0, 0.3).force(0, 1, force).build()
}

#[test]
fn a_motion_without_steady_state_is_told() {
    for method in [SteadyMethod::Shooting, SteadyMethod::Marching] {
        let options = TimeOptions {
            omega: 1.0,
            method,
            max_periods: 300,
            ..TimeOptions::default()
        };
        refused(
            time_response(&at_resonance(0.4), &options, &mut Hooks::default()),
            Status::NoConvergence,
            &["max_periods = 300", "change"],
        );
    }
}

#[test]
fn a_host_stops_a_search_and_sees_its_progress() {
    let model = BASE.sector();
    let mut seen = Vec::new();
    let mut progress = |p: &Progress| {
        seen.push(*p);
        seen.len() == 3
    };
    let mut hooks = Hooks {
        progress: Some(&mut progress),
        ..Hooks::default()
    };
    let options = TimeOptions {
        method: SteadyMethod::Marching,
        samples: 5,
        ..options()
    };
    let found = time_response(&model, &options, &mut hooks).unwrap();
    assert_eq!(found.status, Status::StoppedByCaller);
    assert_eq!((found.harmonics.len(), found.samples.len()), (40, 20));
    assert_eq!(seen.iter().map(|p| p.point).collect::<Vec<_>>(), [1, 2, 3]);
    assert!(
        seen.iter()
            .all(|p| p.parameter.to_bits() == OMEGA.to_bits() && p.residual > options.tolerance)
    );

    let cancelled = || true;
    let mut hooks = Hooks {
        cancelled: Some(&cancelled),
        ..Hooks::default()
    };
    let found = time_response(&model, &options, &mut hooks).unwrap();
    assert_eq!(found.status, Status::StoppedByCaller);
}

#[test]
fn a_model_at_rest_stays_there() {
    let mut model = BASE.sector();
    model.clear_forces();
    let found = time_response(&model, &options(), &mut Hooks::default()).unwrap();
    assert_eq!(found.status, Status::Ok);
    assert!(found.harmonics.iter().all(|x| *x == Complex64::ZERO));
    assert_eq!(found.events, 0);
}
