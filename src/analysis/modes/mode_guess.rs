//! A guess for the first point of a nonlinear mode, as unknowns of its equations: the motion about the static state per unit of
//! amplitude, with the phase of the mode, and its frequency and damping ratio.

use crate::analysis::forced::forced_discretised::relative_motion;
use crate::condense::Resolution;
use crate::condense::by_factors::dynamic_stiffness::DampedFrequency;
use crate::error::{Result, fail, try_copy, try_push, try_vec};
use crate::model::matrices::spring::along;
use crate::options::ModeGuess;
use crate::problem::epmc::{Epmc, Gauge, LinearMode};
use num_complex::Complex64;

const CONTEXT: &str = "the guess";

/// The guess as unknowns of the equations at a resolution.
///
/// # Errors
/// `Argument` where the guess does not move what measures amplitude and phase; `OutOfMemory`.
pub(crate) fn unknowns(
    resolution: &Resolution,
    (linear, gauge): (&LinearMode, &Gauge),
    guess: &ModeGuess<'_>,
) -> Result<Vec<f64>> {
    let condensed = &resolution.condensed;
    let degrees = condensed.degrees();
    let given = degrees.given();
    let mut first = try_vec(degrees.independent(), Complex64::ZERO, CONTEXT)?;
    degrees.restrict(&guess.motion[given..2 * given], &mut first);
    let amplitude = amplitude(condensed.blocks().iter().find(|b| b.number == 1), gauge, &first)?;
    let reference = first[gauge.reference_dof];
    if amplitude == 0.0 || reference == Complex64::ZERO {
        return fail!(
            Argument,
            "guess: its fundamental has amplitude {amplitude}, and {} at the reference of the phase: needs a motion of both",
            reference.norm()
        );
    }
    let turn = reference.conj() / reference.norm();
    let mut turned = try_copy(guess.motion, CONTEXT)?;
    for (h, row) in turned.chunks_exact_mut(given).enumerate() {
        let factor = turn.powu(h as u32) / amplitude;
        for z in row {
            *z *= if h == 0 { (1.0 / amplitude).into() } else { factor };
        }
    }
    let mut u = relative_motion(resolution, &turned)?;
    let set = condensed.set();
    if set.has_mean() {
        let rest = linear.rest.in_units(condensed.length())?;
        for (y, rest) in u.iter_mut().step_by(set.packed_len()).zip(&rest.motion) {
            *y -= rest / amplitude;
        }
    }
    for _ in 0..2 {
        try_push(&mut u, 0.0, CONTEXT)?;
    }
    Epmc::set_frequency_and_damping(linear, DampedFrequency::new(guess.omega, guess.damping_ratio), &mut u);
    Ok(u)
}

/// Amplitude of a mode, as its normalisation defines it, from the fundamental of all degrees of freedom.
fn amplitude(block: Option<&crate::condense::HarmonicBlock>, gauge: &Gauge, first: &[Complex64]) -> Result<f64> {
    if let Some(row) = &gauge.contact {
        return Ok(along(row, first).norm());
    }
    let Some(block) = block else {
        return fail!(Internal, "a nonlinear mode has no fundamental");
    };
    let mut weighted = try_vec(first.len(), Complex64::ZERO, CONTEXT)?;
    block.multiply_mass(first, &mut weighted);
    let square: f64 = first.iter().zip(&weighted).map(|(x, w)| (x.conj() * w).re).sum();
    Ok(square.max(0.0).sqrt())
}
