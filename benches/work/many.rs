//! Rows of structures with many degrees of freedom or contacts.

use crate::calibration::Unit;
use crate::cpu_time::cpu_seconds;
use crate::plate::Plate;
use crate::{Row, Work};
use hbvib::{
    Contact, ContactState, ForcedOptions, Hooks, MatrixKind, MatrixView, Model, Result, SolverOptions, forced_response,
};

pub const ROWS: &[Row] = &[
    Row {
        name: "rod of 40, 10 sliders, H 3, an evaluation",
        unit: Unit::Lu11,
        stored: 116.0,
        run: || evaluation(&rod(40, 10)?, 39),
    },
    Row {
        name: "rod of 2,000, 10 sliders, H 3, an evaluation",
        unit: Unit::Lu11,
        stored: 88.4,
        run: || evaluation(&rod(2000, 10)?, 1999),
    },
    Row {
        name: "plate of 54, 10 sliders, H 3, an evaluation",
        unit: Unit::Lu11,
        stored: 53.7,
        run: || plate_evaluation([3, 2, 1]),
    },
    Row {
        name: "plate of 2,040, 10 sliders, H 3, an evaluation",
        unit: Unit::Lu11,
        stored: 123.0,
        run: || plate_evaluation([20, 16, 1]),
    },
    Row {
        name: "plate of 5,130, 20 sliders, H 3, whole response",
        unit: Unit::Faer(500),
        stored: 154.0,
        run: || {
            let plate = Plate::new([30, 18, 2]);
            let model = plate.with_sliders(20, 2e5, 0.05)?;
            let (branch, _) = about_first_mode(&model, plate.corner(), (20_000, 0.0))?;
            Ok(Work::whole(&branch))
        },
    },
    Row {
        name: "300 sliders on 1,000, H 3, most slipping, one of 40 points",
        unit: Unit::Faer(1000),
        stored: 1.46,
        run: || {
            let model = rod(1000, 300)?;
            let (branch, seconds) = about_first_mode(&model, 999, (40, 0.0))?;
            let per = (branch.points() as f64, "point");
            Ok(Work {
                seconds: Some(seconds),
                per,
                ..Work::whole(&branch)
            })
        },
    },
];

/// A rod of n equal masses, clamped at one end and forced at the other, with sliders to the ground.
pub fn rod(n: usize, sliders: usize) -> Result<Model> {
    let (mut m, mut k) = (vec![0.0; n * n], vec![0.0; n * n]);
    let spring = 1e6 * n as f64;
    for i in 0..n {
        m[i * n + i] = 1.0 / n as f64;
        k[i * n + i] = if i + 1 == n { spring } else { 2.0 * spring };
        if i > 0 {
            k[i * n + i - 1] = -spring;
            k[(i - 1) * n + i] = -spring;
        }
    }
    let mut model = Model::new(n)?;
    model.set_matrix(MatrixKind::Mass, &MatrixView::dense(n, &m))?;
    model.set_matrix(MatrixKind::Stiffness, &MatrixView::dense(n, &k))?;
    model.set_rayleigh(0.0, 1e-6)?;
    for s in 0..sliders {
        let dof = (s + 1) * n / sliders - 1;
        model.add_contact(&Contact::jenkins(
            dof,
            None,
            1e7 / sliders as f64,
            20.0 / sliders as f64,
            1.0,
        ))?;
    }
    model.add_force(n - 1, 1, 40.0.into())?;
    Ok(model)
}

/// A sweep over a tenth about the first resonance with stuck contacts, and its seconds without the modes.
pub fn about_first_mode(
    model: &Model,
    response: usize,
    (max_points, step_max): (usize, f64),
) -> Result<(hbvib::Branch, f64)> {
    let omega = model.lowest_modes(0, ContactState::Stuck, 1)?.omega[0];
    let solver = SolverOptions {
        harmonics: 3,
        tolerance: 0.0,
        response_dof: Some(response),
        max_points,
        step_max,
        ..SolverOptions::default()
    };
    let range = ForcedOptions {
        omega_start: 0.9 * omega,
        omega_stop: 1.1 * omega,
        ..ForcedOptions::default()
    };
    let begin = cpu_seconds();
    let branch = forced_response(model, &solver, &range, &mut Hooks::default())?;
    Ok((branch, cpu_seconds() - begin))
}

/// Largest step of the fine response, from which the iterations of one with default steps are taken off.
const FINE: f64 = 1e-3;

/// CPU time of an evaluation with its linear system, beyond preparation and first point: one at each point and after each
/// iteration.
fn evaluation(model: &Model, response: usize) -> Result<Work> {
    // The first call prepares the structure, which the model keeps.
    about_first_mode(model, response, (20_000, 0.0))?;
    let (coarse, before) = about_first_mode(model, response, (20_000, 0.0))?;
    let (fine, all) = about_first_mode(model, response, (20_000, FINE))?;
    let evaluations = |work: &Work| (work.points + work.iterations) as f64;
    let whole = Work::whole(&fine);
    let count = evaluations(&whole) - evaluations(&Work::whole(&coarse));
    Ok(Work {
        seconds: Some(all - before),
        per: (count, "evaluation"),
        ..whole
    })
}

fn plate_evaluation(elements: [usize; 3]) -> Result<Work> {
    let plate = Plate::new(elements);
    evaluation(&plate.with_sliders(10, 2e5, 0.05)?, plate.corner())
}
