//! Energies and losses of a stored point.

use crate::error::{Result, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::results::motions::energy::{balance, peaks};
use crate::results::{Branch, Recovery};
use num_complex::Complex64;

/// Energies and losses of one point, in the caller's units. The potential energy is stored in the linear structure
/// with its springs and contacts that never slip; contacts that may slip are left out. In a nonlinear mode it counts
/// from the static state. For a plain structure the values per sector are those of the whole structure.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Sum Σ_{h>0} ½ (hω)² X_hᴴ M_h X_h over a sector, twice its mean kinetic energy.
    pub twice_mean_kinetic: f64,
    /// Kinetic energy of a sector, mean over the period.
    pub kinetic_mean: f64,
    /// Kinetic energy of a sector, largest over the period.
    pub kinetic_peak: f64,
    /// Potential energy of a sector, mean over the period.
    pub potential_mean: f64,
    /// Potential energy of a sector, largest over the period.
    pub potential_peak: f64,
    /// Kinetic energy of the wheel, mean over the period.
    pub wheel_kinetic_mean: f64,
    /// Kinetic energy of the wheel, largest over the period.
    pub wheel_kinetic_peak: f64,
    /// Potential energy of the wheel, mean over the period.
    pub wheel_potential_mean: f64,
    /// Potential energy of the wheel, largest over the period.
    pub wheel_potential_peak: f64,
    /// Work per cycle and sector that damping, and stiffness without symmetry, dissipate.
    pub structural_loss: f64,
    /// Work per cycle and sector of the contacts that may slip.
    pub friction_loss: f64,
}

/// Subtracts the static motion of a nonlinear mode, from which its potential energy counts, from a harmonic of the
/// independent degrees of freedom.
fn count_from_static(branch: &Branch, harmonic: usize, x: &mut [Complex64]) {
    if let Some(data) = branch.mode_data().filter(|_| harmonic == 0) {
        for (x, rest) in x.iter_mut().zip(&data.linear.rest.structure) {
            *x -= rest;
        }
    }
}

/// Energies and losses as [`Branch::energy_at`], and the caller may stop it.
pub(crate) fn energy_at_with(branch: &Branch, point: usize, interrupt: &Interrupt<'_>) -> Result<Energy> {
    const CONTEXT: &str = "the energies";
    let carried = branch.carried_of(point)?.len();
    let condensed = branch.condensed_at(point);
    let (n, length, omega) = (condensed.ndof(), condensed.length(), branch.table.omega[point]);
    let mut x = try_vec(carried.saturating_mul(n), Complex64::ZERO, CONTEXT)?;
    let mut recovery = Recovery::at(branch, point, interrupt)?;
    for (i, x) in x.chunks_exact_mut(n).enumerate() {
        interrupt.part(Phase::Results, i, carried)?;
        recovery.coordinates(i, x)?;
        count_from_static(branch, condensed.set().numbers()[i], x);
        // In the units of the solver, whose scale is a power of two and costs no digit.
        for z in x {
            *z /= length;
        }
    }
    let motion = branch.motion_at(point).unwrap_or(&[]);
    interrupt.check()?;
    let motion = condensed.relative_motion(motion, recovery.forces(), branch.table.omega[point])?;
    let balance = balance(condensed, omega, &x, recovery.forces(), &motion);
    let peaks = peaks(condensed, omega, &x, interrupt)?;
    let unit = |energy: f64| energy * length * length;
    let full_wheel = |energy: f64| unit(energy) * condensed.sectors() as f64;
    Ok(Energy {
        twice_mean_kinetic: unit(balance.twice_mean_kinetic),
        kinetic_mean: unit(0.5 * balance.twice_mean_kinetic),
        kinetic_peak: unit(peaks.kinetic),
        potential_mean: unit(balance.potential_mean),
        potential_peak: unit(peaks.potential),
        wheel_kinetic_mean: full_wheel(0.5 * balance.twice_mean_kinetic),
        wheel_kinetic_peak: unit(peaks.wheel_kinetic),
        wheel_potential_mean: full_wheel(balance.potential_mean),
        wheel_potential_peak: unit(peaks.wheel_potential),
        structural_loss: unit(balance.structural_loss),
        friction_loss: unit(balance.friction_loss),
    })
}
