//! Rows of chains of masses: their size, all their resonances, penalties, near-rigid contacts.

use crate::calibration::Unit;
use crate::many::{about_first_mode, rod};
use crate::{Row, Work};
use hbvib::{Contact, ForcedOptions, Hooks, MatrixKind, MatrixView, Model, Result, SolverOptions, forced_response};
use std::f64::consts::TAU;

macro_rules! point {
    ($name:literal, $n:literal, $stored:literal) => {
        Row {
            name: $name,
            unit: Unit::Lu11,
            stored: $stored,
            run: || point($n),
        }
    };
}

pub const ROWS: &[Row] = &[
    point!("rod of 32, 1 slider, H 3, a point", 32, 161.0),
    point!("rod of 101, 1 slider, H 3, a point", 101, 173.0),
    point!("rod of 390, 1 slider, H 3, a point", 390, 223.0),
    point!("rod of 610, 1 slider, H 3, a point", 610, 245.0),
    Row {
        name: "linear chain of 101, all resonances",
        unit: Unit::Lu11,
        stored: 70_300.0,
        run: || linear(101),
    },
    Row {
        name: "chain of 90, 8 sliders, H 3, one of 100 points",
        unit: Unit::Lu11,
        stored: 523.0,
        run: || sliding(90),
    },
    Row {
        name: "chain of 200, 20 sliders, H 3, one of 100 points",
        unit: Unit::Lu11,
        stored: 1_470.0,
        run: || sliding(200),
    },
    Row {
        name: "chain of 100, 1 slider, H 3, start of a narrow sweep",
        unit: Unit::Lu11,
        stored: 10_800.0,
        run: narrow,
    },
    Row {
        name: "chain of 12, a mass split by 1e8 k, H 5, a point",
        unit: Unit::Lu11,
        stored: 42.8,
        run: penalty,
    },
    Row {
        name: "chain of 8, kt/k 3e4, tolerance 1e-3, 0.55 rad/s",
        unit: Unit::Lu11,
        stored: 250.0,
        run: || near_rigid((0.55, 0.55)),
    },
    Row {
        name: "chain of 8, kt/k 3e4, tolerance 1e-3, mild sweep",
        unit: Unit::Lu11,
        stored: 4_300.0,
        run: || near_rigid((0.3, 0.5505)),
    },
];

/// Masses 1 between springs k, both ends held, with damping αM + βK.
fn chain(springs: &[f64], (alpha, beta): (f64, f64)) -> Result<Model> {
    let n = springs.len() - 1;
    let (mut m, mut k) = (vec![0.0; n * n], vec![0.0; n * n]);
    for i in 0..n {
        m[i * n + i] = 1.0;
        k[i * n + i] = springs[i] + springs[i + 1];
        if i > 0 {
            k[i * n + i - 1] = -springs[i];
            k[(i - 1) * n + i] = -springs[i];
        }
    }
    let mut model = Model::new(n)?;
    model.set_matrix(MatrixKind::Mass, &MatrixView::dense(n, &m))?;
    model.set_matrix(MatrixKind::Stiffness, &MatrixView::dense(n, &k))?;
    model.set_rayleigh(alpha, beta)?;
    Ok(model)
}

/// A response over a range of frequencies.
fn response(model: &Model, solver: &SolverOptions, (start, stop): (f64, f64)) -> Result<Work> {
    let range = ForcedOptions {
        omega_start: start,
        omega_stop: stop,
        ..ForcedOptions::default()
    };
    let branch = forced_response(model, solver, &range, &mut Hooks::default())?;
    Ok(Work::whole(&branch))
}

fn per_point(mut work: Work) -> Work {
    work.per = (work.points as f64, "point");
    work
}

fn point(n: usize) -> Result<Work> {
    let (branch, seconds) = about_first_mode(&rod(n, 1)?, n - 1, (20_000, 0.0))?;
    let work = Work {
        seconds: Some(seconds),
        ..Work::whole(&branch)
    };
    Ok(per_point(work))
}

fn linear(n: usize) -> Result<Work> {
    let mut model = chain(&vec![1e4; n + 1], (0.0, 1e-5))?;
    model.add_force(0, 1, 1.0.into())?;
    let solver = SolverOptions {
        harmonics: 1,
        response_dof: Some(n - 1),
        tolerance: 0.0,
        ..SolverOptions::default()
    };
    response(&model, &solver, (1.0, 201.0))
}

fn sliding(n: usize) -> Result<Work> {
    let mut model = chain(&vec![1e4; n + 1], (0.0, 1e-6))?;
    for dof in (5..n - 20).step_by(9) {
        model.add_contact(&Contact::jenkins(dof, None, 1e4, 0.9, 1.0))?;
    }
    model.add_force(20, 1, 50.0.into())?;
    let solver = SolverOptions {
        harmonics: 3,
        response_dof: Some(20),
        tolerance: 0.0,
        max_points: 100,
        ..SolverOptions::default()
    };
    Ok(per_point(response(&model, &solver, (TAU, 195.0))?))
}

/// The first point of a sweep about one of a hundred resonances: mostly the preparation.
fn narrow() -> Result<Work> {
    let mut model = chain(&[1e4; 101], (0.0, 1e-6))?;
    model.add_contact(&Contact::jenkins(50, None, 1e4, 0.9, 1.0))?;
    model.add_force(2, 1, 5.0.into())?;
    let solver = SolverOptions {
        harmonics: 3,
        response_dof: Some(2),
        tolerance: 0.0,
        max_points: 1,
        ..SolverOptions::default()
    };
    response(&model, &solver, (6.16, 6.28))
}

fn penalty() -> Result<Work> {
    let mut springs = vec![1e4; 14];
    springs[6] *= 1e8;
    let mut model = chain(&springs, (0.5, 0.0))?;
    model.add_contact(&Contact::jenkins(11, None, 1e4, 1.0, 1.0))?;
    model.add_force(0, 1, 5.0.into())?;
    let solver = SolverOptions {
        harmonics: 5,
        response_dof: Some(0),
        tolerance: 0.0,
        ..SolverOptions::default()
    };
    Ok(per_point(response(&model, &solver, (10.0, 40.0))?))
}

fn near_rigid(range: (f64, f64)) -> Result<Work> {
    let mut model = chain(&[1.0; 9], (0.02, 0.0))?;
    model.add_contact(&Contact::jenkins(4, None, 3e4, 0.3, 1.0))?;
    model.add_force(0, 1, 0.2.into())?;
    let solver = SolverOptions {
        response_dof: Some(0),
        tolerance: 1e-3,
        ..SolverOptions::default()
    };
    response(&model, &solver, range)
}
