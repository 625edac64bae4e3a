//! Constants of a contact in the caller's units, as its law reads them.

use crate::error::{Result, fail};

/// Constants of a contact; see [`Contact`](crate::contact::Contact) for their meaning.
#[derive(Clone, Copy, Debug)]
pub struct Constants {
    /// Stiffness at small motion.
    pub kt: f64,
    /// Normal stiffness.
    pub kn: f64,
    /// Friction coefficient.
    pub mu: f64,
    /// Normal load at rest.
    pub preload: f64,
    /// Closing at which a contact without preload begins to press.
    pub gap: f64,
    /// Force per length cubed.
    pub cubic: f64,
    /// Reference velocity of regularised friction.
    pub velocity: f64,
    /// Places of the sliders before any motion.
    pub slider: [f64; 2],
    /// Whether a side can move along n.
    pub has_normal: bool,
}

impl Constants {
    /// Slip limit μN₀; zero without friction under any load.
    #[must_use]
    pub fn slip_limit(&self) -> f64 {
        if self.mu == 0.0 { 0.0 } else { self.mu * self.preload }
    }

    /// Closing at which a contact begins to press, the preload counted in; negative for one that presses
    /// at rest.
    #[must_use]
    pub fn clearance(&self) -> f64 {
        if self.preload == 0.0 {
            self.gap
        } else {
            self.gap - self.preload / self.kn
        }
    }

    /// n₀ of a load N = max(n₀ − kn·y, 0) that varies; negative where a gap is open at rest.
    #[must_use]
    pub fn load(&self) -> f64 {
        self.preload - self.kn * self.gap
    }
}

/// Refuses a contact without the stiffness that its force needs.
///
/// # Errors
/// `Argument`, naming the constant.
pub fn needs_stiffness(name: &str, value: f64) -> Result<()> {
    if value == 0.0 {
        return fail!(
            Argument,
            "contact: {name} = 0, needs a number > 0: without it the contact has no force"
        );
    }
    Ok(())
}

/// The role of a contact in the equations of a solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Without force at any motion.
    Inert,
    /// A linear spring of stiffness kt at any motion.
    Spring,
    /// Nonlinear, with the stiffness of
    /// [`Contact::stiffness_at_small_motion`](crate::contact::Contact::stiffness_at_small_motion) at small
    /// motion.
    Active,
}
