//! Slip capacity: the largest force that slipping contacts can balance at an undamped resonance. A force beyond it
//! has no bounded response.
//!
//! Let φ be a motion that the structure without its contacts does not resist at hω: φᴴ Z = 0 with Z = K − h²ω²M +
//! ihωC + iD. Projected on φ, harmonic h of the equation of motion, Z X + Wᴴ f = F, becomes, for any motion,
//!
//! > φᴴ F = Σ conj(w φ) f,
//!
//! the sum over the relative motions w of the contacts. A contact force that never exceeds L has no larger
//! harmonic than that of a square wave, 4L/π, and no larger mean than L. Where |φᴴ F| is above Σ |w φ| 4L/π
//! nothing bounded solves the equation, in time or in any number of harmonics.
//!
//! A frequency coincides with a resonance up to rounding only. With r = φᴴ Z and the excess e of the force over the
//! capacity, |r|·|X| ≥ e for any solution X. This lower bound of the motion decides whether the frequency is close
//! enough.

use crate::contact::Role;
use crate::error::{Result, Status, try_copy, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::exact_sums::quadratic::quadratic;
use crate::linalg::factors::factor::Factor;
use crate::linalg::sparse_storage::sparse::{Csc, Form};
use crate::model::Model;
use crate::model::matrices::spring::along;
use crate::model::matrices::structure::MatrixKind;
use crate::model::matrices::wave::Wave;
use crate::model::natural_modes::damped_mode::SHIFT_OFFSET;
use num_complex::Complex64;
use std::f64::consts::PI;

/// A motion that the structure without its contacts does not resist at a harmonic of the frequency.
#[derive(Clone, Debug)]
pub struct UnresistedMotion {
    /// Number h of the harmonic.
    pub harmonic: usize,
    /// The motion φ, its largest component of modulus 1.
    pub shape: Vec<Complex64>,
    /// Modulus |φᴴ F| of the force along φ.
    pub force: f64,
    /// Largest part of the force that the contacts can balance; infinite if one of them has an unbounded force.
    pub slip_capacity: f64,
    /// Lower bound of the motion of any solution, relative to the motion of the inertia alone under the force.
    pub growth: f64,
}

/// Number of steps of the inverse iteration, each of which gains the digits of [`SHIFT_OFFSET`].
/// Kind: cap.
const SLIP_CAPACITY_MAX_STEPS: usize = 6;

/// Rounding of the force and of the capacity, relative to the sizes of their terms.
/// Kind: rounding.
const SLIP_CAPACITY_ROUNDING: f64 = 1e-12;

/// Growth beyond which no motion is possible: it would require more digits of frequency and stiffness than exist.
/// Kind: cap.
const UNBOUNDED_GROWTH: f64 = 1e10;

const CONTEXT: &str = "the resonance";

impl UnresistedMotion {
    /// Whether no bounded motion balances the force.
    pub fn is_overloaded(&self) -> bool {
        self.growth >= UNBOUNDED_GROWTH
    }
}

/// The undamped resonance because of which the model has no bounded response at the angular frequency `omega`, if one
/// is found.
#[doc(hidden)]
pub(crate) fn overload(model: &Model, omega: f64, interrupt: &Interrupt<'_>) -> Result<Option<UnresistedMotion>> {
    let at_frequency = model.at_frequency(omega)?;
    let mut last = None;
    for force in model.excitation().forces() {
        if last == Some(force.harmonic) || force.value == Complex64::ZERO {
            continue;
        }
        last = Some(force.harmonic);
        let found = at_frequency.resonance(omega, force.harmonic, interrupt)?;
        if found.as_ref().is_some_and(UnresistedMotion::is_overloaded) {
            return Ok(found);
        }
    }
    Ok(None)
}

/// The motion nearest to the forced one that the structure without its contacts does not resist in `harmonic` of
/// `omega`.
#[doc(hidden)]
pub(crate) fn resonance(
    model: &Model,
    omega: f64,
    harmonic: usize,
    interrupt: &Interrupt<'_>,
) -> Result<Option<UnresistedMotion>> {
    interrupt.check()?;
    let n = model.structure().ndof();
    let structure = model.structure();
    let wave = Wave::Harmonic(harmonic);
    let springs = model.contacts().iter().filter(|c| c.role() == Role::Spring);
    let stiffness = model.sprung_stiffness(wave, springs)?;
    let damping = structure.wave_matrix(MatrixKind::Damping, harmonic)?;
    let structural = structure.wave_matrix(MatrixKind::Structural, harmonic)?;
    let mass = structure.wave_matrix(MatrixKind::Mass, harmonic)?;
    let w = harmonic as f64 * omega;
    let square = omega * omega * (harmonic.max(1) as f64).powi(2);
    let dynamic = |inertia: f64| {
        let terms = [
            (Complex64::ONE, &stiffness, Form::Plain),
            (Complex64::new(0.0, w), &damping, Form::Plain),
            (Complex64::I, &structural, Form::Plain),
            (inertia.into(), &mass, Form::Plain),
        ];
        Csc::sum(n, &terms)
    };
    let z = dynamic(-w * w)?;
    // The force itself is the starting vector: among repeated resonances it selects the motion on which it does
    // most work.
    let mut forces = try_vec(n, Complex64::ZERO, CONTEXT)?;
    model.add_forces_to(harmonic, 1.0, &mut forces);
    let Some(shape) = left_null(&dynamic(-w * w - SHIFT_OFFSET * square)?, &mass, &forces, interrupt)? else {
        return Ok(None);
    };
    let r = (0..n).map(|j| {
        let column = z.column(j).map(|(i, v)| shape[i].conj() * v);
        column.sum::<Complex64>().norm()
    });
    let resistance: f64 = r.sum();
    let work = |(x, f): (&Complex64, &Complex64)| x.conj() * f;
    let force = shape.iter().zip(&forces).map(work).sum::<Complex64>().norm();
    let size: f64 = shape.iter().zip(&forces).map(|z| work(z).norm()).sum();
    let slip_capacity = slip_capacity(model, harmonic, &shape);
    let excess = force - slip_capacity * (1.0 + SLIP_CAPACITY_ROUNDING) - SLIP_CAPACITY_ROUNDING * size;
    let inertia = square * quadratic(&mass, &shape);
    let growth = if excess > 0.0 && inertia > 0.0 {
        // Without any resistance the growth is infinite.
        excess / resistance * (inertia / force)
    } else {
        0.0
    };
    Ok(Some(UnresistedMotion {
        harmonic,
        shape,
        force,
        slip_capacity,
        growth,
    }))
}

/// Largest part of a force along the motion φ in a harmonic that the contacts can balance: Σ |w φ| 4L/π.
fn slip_capacity(model: &Model, harmonic: usize, shape: &[Complex64]) -> f64 {
    let wave = if harmonic == 0 { 1.0 } else { 4.0 / PI };
    let mut sum = 0.0;
    for contact in model.contacts().iter().filter(|c| c.role() == Role::Active) {
        for k in 0..contact.directions() {
            let motion = along(&model.structure().contact_row(contact, k, harmonic), shape).norm();
            // A contact without relative motion contributes nothing, whatever its force.
            if motion > 0.0 {
                sum += wave * contact.largest_force() * motion;
            }
        }
    }
    sum
}

/// Motion φ with φᴴ Z = 0 up to rounding, by inverse iteration φ ← S⁻ᴴ M φ from the force, with S = Z − ε M; the
/// limit does not depend on ε. `None` where the iteration finds none.
fn left_null(
    shifted: &Csc,
    mass: &Csc,
    force: &[Complex64],
    interrupt: &Interrupt<'_>,
) -> Result<Option<Vec<Complex64>>> {
    match iterate(shifted, mass, force, interrupt) {
        Err(e) if e.status == Status::Singular => Ok(None),
        outcome => outcome,
    }
}

fn iterate(
    shifted: &Csc,
    mass: &Csc,
    force: &[Complex64],
    interrupt: &Interrupt<'_>,
) -> Result<Option<Vec<Complex64>>> {
    let mut factor = Factor::new(shifted, 1)?;
    factor.factor(shifted, interrupt)?;
    let mut x = try_copy(force, CONTEXT)?;
    let mut load = try_vec(x.len(), Complex64::ZERO, CONTEXT)?;
    for i in 0..SLIP_CAPACITY_MAX_STEPS {
        if i > 0 {
            load.fill(Complex64::ZERO);
            mass.multiply_add(Complex64::ONE, &x, &mut load);
            x.copy_from_slice(&load);
        }
        // S⁻ᴴ b is the conjugate of S⁻ᵀ times the conjugate of b.
        for x in &mut x {
            *x = x.conj();
        }
        factor.solve(&mut x, true, interrupt)?;
        let largest = x.iter().fold(0.0_f64, |m, x| m.max(x.norm()));
        if largest == 0.0 {
            return Ok(None);
        }
        for x in &mut x {
            *x = x.conj() / largest;
        }
    }
    Ok(Some(x))
}
