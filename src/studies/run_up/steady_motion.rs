//! The largest displacement of the steady resonance, in the measure in which a run-up tells its own.

use crate::analysis::synthesis::SynthesisPoint;
use crate::error::{Result, Status, try_vec};
use crate::studies::run_up::mode_table::{ModeTable, Place};
use crate::studies::run_up::other_modes::OtherModes;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Displacements that are looked at in a period. Chosen: the parabola through three of them finds a maximum of ten harmonics to 1e-5.
/// Kind: tuned; measured on: nothing, it is chosen.
const STEADY_MOTION_LOOKS: usize = 256;

/// Largest displacement within a period of the steady motion at a resonance, with the mean, all harmonics of the mode and the other modes;
/// NaN where the table does not reach its amplitude.
pub(super) fn largest_steady(table: &ModeTable, others: &OtherModes, at: &SynthesisPoint) -> Result<f64> {
    let mut place = Place::default();
    match table.find(at.modal_amplitude, &mut place) {
        Err(e) if e.status == Status::OutOfMemory => return Err(e),
        Err(_) => return Ok(f64::NAN),
        Ok(()) => {}
    }
    let oscillator = table.oscillator(&place);
    let q = oscillator.force / oscillator.stiffness(at.omega);
    let direction = if q.norm() > 0.0 { q / q.norm() } else { Complex64::ONE };
    let beside = others.motion(0, at.omega, 0.0).0;
    let mut powers = try_vec(table.harmonics, Complex64::ONE, "the steady motion of a run-up")?;
    let mut displacement = |look: usize| {
        let turn = Complex64::cis(TAU * look as f64 / STEADY_MOTION_LOOKS as f64);
        let mut power = Complex64::ONE;
        for p in &mut powers {
            *p = power;
            power *= turn * direction;
        }
        table.value(&place, 0, &powers).0 + (beside * turn).re
    };
    let mut largest = 0.0_f64;
    let mut last = [displacement(0), displacement(1)];
    for look in 2..STEADY_MOTION_LOOKS + 2 {
        let next = displacement(look);
        let [before, here] = last;
        largest = largest.max(here.abs());
        let curvature = before - 2.0 * here + next;
        if here.abs() >= before.abs() && here.abs() >= next.abs() && curvature != 0.0 {
            let vertex = here - (next - before).powi(2) / (8.0 * curvature);
            largest = largest.max(vertex.abs());
        }
        last = [here, next];
    }
    Ok(largest)
}
