//! Forces per degree of freedom and harmonic.

use crate::error::{Result, fail, try_extend, try_push};
use crate::model::matrices::speed::Speed;
use crate::options::MAX_HARMONIC;
use num_complex::Complex64;

/// A harmonic force Re(value·e^{i·harmonic·ωt}) on `dof`.
#[derive(Clone, Copy, Debug)]
pub struct Force {
    /// Degree of freedom on which the force acts.
    pub dof: usize,
    /// Harmonic number; 0 is a constant force.
    pub harmonic: usize,
    /// Complex amplitude (peak value); divided by ω² if [`Self::per_omega2`].
    pub value: Complex64,
    /// Whether the force is caused by an unbalance, and grows with the square of the frequency ω of the response.
    pub per_omega2: bool,
    /// Force over Ω² of a constant force that follows the speed of rotation; `value` is then the force at the present
    /// speed. 0 for other forces.
    pub per_speed2: f64,
}

impl Force {
    /// Amplitude at the angular frequency ω.
    #[must_use]
    pub fn at(&self, omega: f64) -> Complex64 {
        if self.per_omega2 {
            self.value * (omega * omega)
        } else {
            self.value
        }
    }
}

/// All forces on the degrees of freedom of a model.
#[derive(Clone, Debug, Default)]
pub struct Excitation {
    forces: Vec<Force>,
}

impl Excitation {
    /// Adds a force on a structure of `ndof` degrees of freedom.
    pub(super) fn add(&mut self, ndof: usize, dof: usize, harmonic: usize, value: Complex64) -> Result<()> {
        if dof >= ndof {
            return fail!(Index, "force: dof = {dof}, needs 0 .. {}", ndof - 1);
        }
        if harmonic > MAX_HARMONIC {
            return fail!(Argument, "force: harmonic = {harmonic}, needs 0 .. {MAX_HARMONIC}");
        }
        if !value.is_finite() {
            return fail!(NotFinite, "force: value = {} + {}i is not finite", value.re, value.im);
        }
        if harmonic == 0 && value.im != 0.0 {
            return fail!(Argument, "a constant force is real, but im = {}", value.im);
        }
        let force = Force {
            dof,
            harmonic,
            value,
            per_omega2: false,
            per_speed2: 0.0,
        };
        try_push(&mut self.forces, force, "the forces")
    }

    /// Adds the constant force c·Ω² on a degree of freedom; [`Self::follow_speed`] gives it its value.
    pub(super) fn add_centrifugal(&mut self, ndof: usize, dof: usize, per_speed2: f64) -> Result<()> {
        self.add(ndof, dof, 0, per_speed2.into())?;
        if let Some(last) = self.forces.last_mut() {
            (last.value, last.per_speed2) = (Complex64::ZERO, per_speed2);
        }
        Ok(())
    }

    /// Gives constant forces that follow the speed their value at it.
    pub(super) fn follow_speed(&mut self, speed: Speed) {
        for force in self.forces.iter_mut().filter(|force| force.per_speed2 != 0.0) {
            let (speed, tied) = match speed {
                Speed::Fixed(speed) => (speed, false),
                Speed::PerOmega(p) => (p, true),
            };
            force.value = (force.per_speed2 * speed * speed).into();
            force.per_omega2 = tied;
        }
    }

    /// Whether a constant force follows a speed.
    pub(crate) fn has_centrifugal(&self) -> bool {
        self.forces.iter().any(|force| force.per_speed2 != 0.0)
    }

    /// Adds a force again that was checked before it was saved.
    pub(super) fn restore(&mut self, ndof: usize, force: Force) -> Result<()> {
        self.add(ndof, force.dof, force.harmonic, force.value)?;
        if let Some(last) = self.forces.last_mut() {
            *last = force;
        }
        Ok(())
    }

    /// Reads, from saved data, the force over Ω² of each force.
    pub(super) fn load_centrifugal(&mut self, mut next: impl FnMut() -> Result<f64>) -> Result<()> {
        for (i, force) in self.forces.iter_mut().enumerate() {
            force.per_speed2 = next()?;
            if force.per_speed2 != 0.0 && force.harmonic != 0 {
                return fail!(
                    Argument,
                    "damaged: force {i} in harmonic {} follows the speed",
                    force.harmonic
                );
            }
        }
        Ok(())
    }

    /// Adds fundamental forces that grow with ω².
    pub(super) fn add_unbalance(&mut self, forces: [(usize, Complex64); 2]) -> Result<()> {
        let force = |(dof, value)| Force {
            dof,
            harmonic: 1,
            value,
            per_omega2: true,
            per_speed2: 0.0,
        };
        try_extend(&mut self.forces, &forces.map(force), "the forces")
    }

    /// Multiplies all forces by a factor.
    pub(super) fn scale(&mut self, factor: f64) {
        for force in &mut self.forces {
            force.value *= factor;
            force.per_speed2 *= factor;
        }
    }

    /// Multiplies the forces of one harmonic.
    pub(super) fn scale_harmonic(&mut self, harmonic: usize, factor: f64) {
        for force in self.forces.iter_mut().filter(|force| force.harmonic == harmonic) {
            force.value *= factor;
            force.per_speed2 *= factor;
        }
    }

    /// Multiplies each force by a factor of its degree of freedom.
    pub(super) fn scale_each(&mut self, factor: impl Fn(usize) -> f64) {
        for force in &mut self.forces {
            force.value *= factor(force.dof);
            force.per_speed2 *= factor(force.dof);
        }
    }

    /// Moves the forces to `periods` times their harmonic, for a fundamental frequency that is lower by this factor.
    pub(super) fn stretch(&mut self, periods: usize) -> Result<()> {
        for force in &self.forces {
            if force.harmonic.saturating_mul(periods) > MAX_HARMONIC {
                return fail!(
                    Argument,
                    "periods = {periods}, but a force acts in harmonic {}, and {MAX_HARMONIC} is the highest",
                    force.harmonic
                );
            }
        }
        let square = (periods * periods) as f64;
        for force in &mut self.forces {
            force.harmonic *= periods;
            if force.per_omega2 {
                force.value *= square;
            }
        }
        Ok(())
    }

    /// Turns unbalances into the forces of one frequency.
    pub(super) fn fix_unbalance(&mut self, omega: f64) {
        for force in &mut self.forces {
            force.value = force.at(omega);
            force.per_omega2 = false;
        }
    }

    /// Whether a force grows with ω².
    pub fn has_unbalance(&self) -> bool {
        self.forces.iter().any(|f| f.per_omega2 && f.value != Complex64::ZERO)
    }

    /// Whether a force in this harmonic grows with ω².
    pub fn has_unbalance_in(&self, harmonic: usize) -> bool {
        let mut own = self.forces.iter().filter(|f| f.harmonic == harmonic);
        own.any(|f| f.per_omega2 && f.value != Complex64::ZERO)
    }

    /// A copy that returns an error if memory is short.
    pub(super) fn try_clone(&self) -> Result<Self> {
        let mut copy = Self::default();
        try_extend(&mut copy.forces, &self.forces, "the forces")?;
        Ok(copy)
    }

    /// Removes all forces of the model.
    pub(super) fn clear(&mut self) {
        self.forces.clear();
    }

    /// Largest real or imaginary part of a force at an angular frequency.
    #[must_use]
    pub fn largest(&self, omega: f64) -> f64 {
        let values = self.forces.iter().map(|f| f.at(omega));
        values.fold(0.0, |m, f| m.max(f.re.abs()).max(f.im.abs()))
    }

    /// The forces in the order in which they were added.
    pub fn forces(&self) -> &[Force] {
        &self.forces
    }
}
