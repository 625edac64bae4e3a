//! The result of evaluating a law: harmonics of its force, their Jacobian, and shares of the period.

use crate::contact::forms::contact_state::State;
use crate::error::{Result, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;

/// Harmonics of a contact force and their derivatives, all in packed form, one direction of the law after the other.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// Number d of directions of the relative motion; m is the packed length of one signal.
    pub directions: usize,
    /// Harmonics F of the force, d·m numbers.
    pub force: Vec<f64>,
    /// ∂F/∂X, (d·m)², column-major; empty where only the force is requested.
    pub jacobian: Vec<f64>,
    /// F − ∂F/∂X · X, the derivative by ln s of s·F(X/s), the law at a motion s times smaller; work space without a Jacobian.
    pub offset: Vec<f64>,
    /// ∂F/∂ω at fixed X; zero unless the law depends on velocities, and without a Jacobian.
    pub by_omega: Vec<f64>,
    /// Share of the period in slip, 0 for a stuck contact.
    pub slip_fraction: f64,
    /// Share of the period in which the contact is open.
    pub open_fraction: f64,
    /// Whether the contact sticks through the period: one piece without anchor, F = kt·X (and closed throughout,
    /// where the normal load varies). Always `false` for a smooth law.
    pub stuck: bool,
    /// Whether the force is an affine function of the motion near it: the contact sticks, is open or is closed through
    /// the period. Always `false` for a smooth law.
    pub linear: bool,
}

impl Evaluation {
    /// Memory for the signals of `set` in a number of directions.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(set: &HarmonicSet, directions: usize) -> Result<Self> {
        let m = set.packed_len().saturating_mul(directions);
        let jacobian = try_vec(m.saturating_mul(m), 0.0, "a contact Jacobian")?;
        Ok(Self {
            jacobian,
            ..Self::without_jacobian(m, directions)?
        })
    }

    /// Memory for the force alone: its evaluation forms no Jacobian.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn force_alone(set: &HarmonicSet, directions: usize) -> Result<Self> {
        Self::without_jacobian(set.packed_len().saturating_mul(directions), directions)
    }

    /// Whether the force alone is evaluated.
    pub(super) fn is_force_alone(&self) -> bool {
        self.jacobian.len() < self.force.len()
    }

    fn without_jacobian(m: usize, directions: usize) -> Result<Self> {
        Ok(Self {
            directions,
            force: try_vec(m, 0.0, "a contact force")?,
            jacobian: Vec::new(),
            offset: try_vec(m, 0.0, "a contact force")?,
            by_omega: try_vec(m, 0.0, "a contact force")?,
            slip_fraction: 0.0,
            open_fraction: 0.0,
            stuck: false,
            linear: false,
        })
    }

    /// Memory as `new` allocates it; the caller may stop the call.
    ///
    /// # Errors
    /// `OutOfMemory`, `StoppedByCaller`.
    pub fn interruptible(set: &HarmonicSet, directions: usize, interrupt: &Interrupt<'_>) -> Result<Self> {
        let m = set.packed_len().saturating_mul(directions);
        let jacobian = interrupt.zeros(m.saturating_mul(m), "a contact Jacobian")?;
        Ok(Self {
            jacobian,
            ..Self::without_jacobian(m, directions)?
        })
    }

    /// Adds a share of the period to that of slip or separation. Rounding never leads to a sum above 1.
    pub(super) fn count(&mut self, state: State, share: f64) {
        match state {
            State::Stick => {}
            State::Slip => self.slip_fraction = (self.slip_fraction + share).min(1.0),
            State::Open => self.open_fraction = (self.open_fraction + share).min(1.0),
        }
    }

    /// Clears the results of the last evaluation.
    pub(super) fn clear(&mut self) {
        self.jacobian.fill(0.0);
        self.clear_forces();
    }

    /// Clears all results but the Jacobian.
    pub(super) fn clear_forces(&mut self) {
        self.offset.fill(0.0);
        self.by_omega.fill(0.0);
        self.slip_fraction = 0.0;
        self.open_fraction = 0.0;
        self.stuck = false;
        self.linear = false;
    }
}

/// Whether a share of the period is the whole period, up to round-off.
pub(super) fn is_whole(share: f64) -> bool {
    share > 1.0 - 1e-12
}
