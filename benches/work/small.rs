//! Rows of small structures: the ring damper, from the matrices to the branch.

use crate::calibration::Unit;
use crate::model::{B2, Parameters};
use crate::{Row, Work};
use hbvib::{
    Branch, Error, ForcedOptions, Hooks, ModeChoice, ModeOptions, Result, SolverOptions, Status, Waves,
    forced_response, nonlinear_mode,
};
use std::f64::consts::TAU;

pub const ROWS: &[Row] = &[
    Row {
        name: "case B, 20 N, H 9, about 200 points",
        unit: Unit::Lu11,
        stored: 2_440.0,
        run: || Ok(Work::whole(&case_b(9, 8.2e-3, 20_000)?)),
    },
    Row {
        name: "case B, 20 N, H 9, default steps",
        unit: Unit::Lu11,
        stored: 1_240.0,
        run: || Ok(Work::whole(&case_b(9, 0.0, 20_000)?)),
    },
    Row {
        name: "case B, 20 N, H 127, all",
        unit: Unit::Lu11,
        stored: 36_000.0,
        run: || Ok(Work::whole(&case_b(127, 0.0, 20_000)?)),
    },
    Row {
        name: "case B, 20 N, H 127, first point",
        unit: Unit::Lu11,
        stored: 2_840.0,
        run: || Ok(Work::whole(&case_b(127, 0.0, 1)?)),
    },
    Row {
        name: "ring damper, backbone, H 9, about 64 points",
        unit: Unit::Lu11,
        stored: 2_490.0,
        run: backbone,
    },
    Row {
        name: "ring damper, 5 N, tolerance 1e-3, 205 to 213 Hz",
        unit: Unit::Lu11,
        stored: 94_100.0,
        run: tolerance,
    },
    Row {
        name: "ring damper, 5 N, H 9, 206 to 211 Hz",
        unit: Unit::Lu11,
        stored: 4_740.0,
        run: || with_stability(None),
    },
    Row {
        name: "the same with the stability of the wave",
        unit: Unit::Lu11,
        stored: 260_000.0,
        run: || with_stability(Some(Waves::Wave)),
    },
    Row {
        name: "the same with the stability of the wheel",
        unit: Unit::Lu11,
        stored: 439_000.0,
        run: || with_stability(Some(Waves::Wheel)),
    },
];

fn ring_damper(parameters: Parameters) -> Result<hbvib::Model> {
    parameters
        .model()
        .map_err(|e| Error::new(Status::Internal, format_args!("{e}")))
}

/// Case B: engine order 2, slip limit 5 N, force at the blade tip, over a tenth about the resonance.
fn case_b(harmonics: usize, step_max: f64, max_points: usize) -> Result<Branch> {
    let mut parameters = Parameters {
        force: 20.0,
        tip_only: true,
        beta: 2e-6,
        ..Parameters::default()
    };
    // The load of 5 N/0.3 that presses the ring follows from the speed.
    parameters.rpm *= (5.0 / 0.3 / parameters.normal_load()).sqrt();
    let solver = SolverOptions {
        harmonics,
        tolerance: 0.0,
        response_dof: Some(B2),
        step_max,
        max_points,
        ..SolverOptions::default()
    };
    let range = ForcedOptions {
        omega_start: 1187.306,
        omega_stop: 1451.152,
        ..ForcedOptions::default()
    };
    forced_response(&ring_damper(parameters)?, &solver, &range, &mut Hooks::default())
}

fn backbone() -> Result<Work> {
    let solver = SolverOptions {
        harmonics: 9,
        tolerance: 0.0,
        step_max: 0.021,
        ..SolverOptions::default()
    };
    let options = ModeOptions {
        choice: ModeChoice::Index(0),
        log10_start: -7.0,
        log10_stop: -1.0,
        ..ModeOptions::default()
    };
    let model = ring_damper(Parameters::default())?;
    let branch = nonlinear_mode(&model, &solver, &options, &mut Hooks::default())?;
    Ok(Work::whole(&branch))
}

fn with_stability(stability: Option<Waves>) -> Result<Work> {
    let solver = SolverOptions {
        harmonics: 9,
        tolerance: 0.0,
        response_dof: Some(B2),
        stability,
        ..SolverOptions::default()
    };
    let range = ForcedOptions {
        omega_start: 206.0 * TAU,
        omega_stop: 211.0 * TAU,
        ..ForcedOptions::default()
    };
    let model = ring_damper(Parameters::default())?;
    let branch = forced_response(&model, &solver, &range, &mut Hooks::default())?;
    Ok(Work::whole(&branch))
}

fn tolerance() -> Result<Work> {
    let solver = SolverOptions {
        response_dof: Some(B2),
        ..SolverOptions::default()
    };
    let range = ForcedOptions {
        omega_start: 205.0 * TAU,
        omega_stop: 213.0 * TAU,
        ..ForcedOptions::default()
    };
    let model = ring_damper(Parameters::default())?;
    let branch = forced_response(&model, &solver, &range, &mut Hooks::default())?;
    Ok(Work::whole(&branch))
}
