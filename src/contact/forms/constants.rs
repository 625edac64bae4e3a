//! The constants of contact laws by name, in the caller's units.

use crate::byte_stream::ByteWriter;
use crate::error::{Result, fail};

/// A constant of a contact by its name; a law has some of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Constant {
    /// Normal load at rest.
    Preload,
    /// Friction coefficient.
    Mu,
    /// Tangential stiffness.
    Kt,
    /// Normal stiffness.
    Kn,
    /// Closing at which a contact without preload begins to press.
    Gap,
    /// Force per length cubed of a cubic spring.
    Cubic,
    /// Velocity at which regularised friction reaches 76 % (tanh 1) of its limit.
    Velocity,
    /// Place of the slider before any motion along t1 (0) or t2 (1).
    Slider(usize),
}

impl Constant {
    /// All constants but the places of sliders, in the order of saved contacts.
    pub(crate) const DESCRIBED: [Self; 7] = [
        Self::Kt,
        Self::Kn,
        Self::Mu,
        Self::Preload,
        Self::Gap,
        Self::Cubic,
        Self::Velocity,
    ];

    /// Name of the constant in the description of a contact.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Preload => "preload",
            Self::Mu => "mu",
            Self::Kt => "kt",
            Self::Kn => "kn",
            Self::Gap => "gap",
            Self::Cubic => "cubic",
            Self::Velocity => "velocity",
            Self::Slider(0) => "slider_t1",
            Self::Slider(_) => "slider_t2",
        }
    }

    /// Whether the constant may be below 0.
    #[must_use]
    pub fn has_any_sign(self) -> bool {
        matches!(self, Self::Gap | Self::Cubic | Self::Slider(_))
    }

    /// Whether the constant of a contact is proportional to its area.
    pub(crate) fn is_per_area(self) -> bool {
        matches!(self, Self::Kt | Self::Kn | Self::Preload | Self::Cubic)
    }
}

/// The data of a law, which a [`ContactKind`](crate::contact::ContactKind) carries: its constants by name, and its saved form.
pub trait LawData {
    /// Number of the law in saved models.
    fn number(&self) -> u8;

    /// A constant of the law; `None` for one that it does not have.
    fn constant(&self, constant: Constant) -> Option<f64> {
        let _ = constant;
        None
    }

    /// The place of a constant of the law; `None` for one that it does not have.
    fn constant_mut(&mut self, constant: Constant) -> Option<&mut f64> {
        let _ = constant;
        None
    }

    /// Writes what the law has beside constants that have names.
    ///
    /// # Errors
    /// `Unsupported` for a law of the caller.
    fn save_to(&self, out: &mut ByteWriter<'_>) -> Result<()> {
        let _ = out;
        Ok(())
    }

    /// Writes the same into a digest; a law of the caller what it tells of itself.
    fn digest_to(&self, out: &mut ByteWriter<'_>) {
        // Only a law of the caller cannot be saved.
        let _saved = self.save_to(out);
    }
}

/// Implements [`LawData`] for a law whose data are constants with names: its number in saved models, and the field of each constant.
macro_rules! named_constants {
    ($law:ident, $number:literal, $($constant:ident $(($k:literal))? => $field:ident $([$i:literal])?),+ $(,)?) => {
        impl $crate::contact::forms::constants::LawData for $law {
            fn number(&self) -> u8 {
                $number
            }

            fn constant(&self, constant: $crate::contact::forms::constants::Constant) -> Option<f64> {
                match constant {
                    $($crate::contact::forms::constants::Constant::$constant $(($k))? => Some(self.$field $([$i])?),)+
                    _ => None,
                }
            }

            fn constant_mut(&mut self, constant: $crate::contact::forms::constants::Constant) -> Option<&mut f64> {
                match constant {
                    $($crate::contact::forms::constants::Constant::$constant $(($k))? => Some(&mut self.$field $([$i])?),)+
                    _ => None,
                }
            }
        }
    };
}
pub(crate) use named_constants;

/// Slip limit μN₀; zero without friction under any load.
#[must_use]
pub fn slip_limit(mu: f64, preload: f64) -> f64 {
    if mu == 0.0 { 0.0 } else { mu * preload }
}

/// Closing at which a contact begins to press, the preload counted in; negative for one that presses at rest.
#[must_use]
pub fn clearance(kn: f64, preload: f64, gap: f64) -> f64 {
    if preload == 0.0 { gap } else { gap - preload / kn }
}

/// n₀ of a load N = max(n₀ − kn·y, 0) that varies; negative where a gap is open at rest.
#[must_use]
pub fn load(kn: f64, preload: f64, gap: f64) -> f64 {
    preload - kn * gap
}

/// Refuses a contact without the stiffness that its force needs.
///
/// # Errors
/// `Argument`, naming the constant.
pub fn needs_stiffness(constant: Constant, value: f64) -> Result<()> {
    if value == 0.0 {
        return fail!(
            Argument,
            "contact: {} = 0, needs a number > 0: without it the contact has no force",
            constant.name()
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
