//! Rows of the reduced finite-element sector with its 60 contacts of friction: responses, and the nonlinear mode.

use crate::calibration::Unit;
use crate::sector::{Sector, Size};
use crate::{Row, Work};
use hbvib::{
    Error, ForcedOptions, Hooks, ModeChoice, ModeOptions, Model, Result, SolverOptions, Status, forced_response,
    nonlinear_mode,
};
use std::f64::consts::TAU;
use std::path::Path;

pub const ROWS: &[Row] = &[
    Row {
        name: "FE sector, 60 contacts, 100 to 1,500 Hz, H 1, an iteration",
        unit: Unit::Faer(500),
        stored: 0.40,
        run: || response((100.0, 1500.0), (1, 0.0)),
    },
    Row {
        name: "FE sector, 60 contacts, 100 to 1,500 Hz, H 3, an iteration",
        unit: Unit::Faer(500),
        stored: 0.68,
        run: || response((100.0, 1500.0), (3, 0.0)),
    },
    Row {
        name: "FE sector, 60 contacts, 510 to 560 Hz, tolerance 1e-2",
        unit: Unit::Faer(500),
        stored: 1_630.0,
        run: || {
            let work = response((510.0, 560.0), (1, 1e-2))?;
            Ok(Work {
                per: (1.0, "all"),
                ..work
            })
        },
    },
    Row {
        name: "mode of the FE sector, six decades, H 1",
        unit: Unit::Faer(500),
        stored: 400.0,
        run: || mode((-8.0, -2.0), 1),
    },
    Row {
        name: "mode of the FE sector where it begins to slide, H 9",
        unit: Unit::Faer(500),
        stored: 2_140.0,
        run: || mode((-4.0, -3.7), 9),
    },
];

/// The sector with a force of 2 N, and the degree of freedom of its tip.
fn sector() -> Result<(Model, usize)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/data/fe");
    let sector =
        Sector::read(&folder, Size::Reduced).map_err(|text| Error::new(Status::Argument, format_args!("{text}")))?;
    Ok((sector.forced(2.0)?, sector.size.tip()))
}

fn solver((harmonics, tolerance): (usize, f64), tip: usize) -> SolverOptions {
    SolverOptions {
        harmonics,
        tolerance,
        response_dof: Some(tip),
        ..SolverOptions::default()
    }
}

fn response((from, to): (f64, f64), accuracy: (usize, f64)) -> Result<Work> {
    let (model, tip) = sector()?;
    let range = ForcedOptions {
        omega_start: from * TAU,
        omega_stop: to * TAU,
        ..ForcedOptions::default()
    };
    let begin = crate::cpu_seconds();
    let branch = forced_response(&model, &solver(accuracy, tip), &range, &mut Hooks::default())?;
    let work = Work::whole(&branch);
    Ok(Work {
        seconds: Some(crate::cpu_seconds() - begin),
        per: (work.iterations as f64, "iteration"),
        ..work
    })
}

fn mode((from, to): (f64, f64), harmonics: usize) -> Result<Work> {
    let (model, tip) = sector()?;
    let range = ModeOptions {
        choice: ModeChoice::Near(530.0 * TAU),
        log10_start: from,
        log10_stop: to,
        ..ModeOptions::default()
    };
    let begin = crate::cpu_seconds();
    let branch = nonlinear_mode(&model, &solver((harmonics, 0.0), tip), &range, &mut Hooks::default())?;
    Ok(Work {
        seconds: Some(crate::cpu_seconds() - begin),
        ..Work::whole(&branch)
    })
}
