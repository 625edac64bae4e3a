//! The derivative of a contact force by a constant of its law, in terms of an evaluation of the force.
//!
//! Laws of friction are homogeneous: the force is f(s·x, s·N) = s·f(x, N) in motion and limit, and depends on kt and
//! kn through kt·x and kn·y alone. By Euler's theorem every derivative by a constant is then a combination of the force,
//! of products of its Jacobian J with the motion itself, and of the part of the force that the Jacobian does not give.
//! It has the exact events of that evaluation, and needs no other.

use crate::contact::forms::constants::Constant;

/// Factors of the parts of an evaluation whose sum is the derivative of a force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Combination {
    /// Factor of the motion in the direction of the force.
    pub motion: f64,
    /// Factor of J x over the tangential motions.
    pub by_tangential: f64,
    /// Factor of J y over the normal motion.
    pub by_normal: f64,
    /// Factor of J e, with a normal motion of 1 at all times.
    pub by_shift: f64,
    /// Factors of J e, with a motion of 1 along t1, t2 at all times.
    pub by_slider: [f64; 2],
    /// Factor of the force f.
    pub force: f64,
    /// Factor of f − J x − J y: zero while the contact sticks.
    pub offset: f64,
}

/// The derivative of the forces of a contact by a constant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ForceDerivative {
    /// Derivative of the forces along the tangential directions.
    pub tangential: Combination,
    /// Derivative of the force along the normal.
    pub normal: Combination,
    /// Whether the force begins to depend on the constant at its present value, zero: a derivative then exists on one
    /// side only.
    pub is_one_sided: bool,
}

impl ForceDerivative {
    /// A derivative that exists on one side only.
    pub const ONE_SIDED: Self = Self {
        tangential: Combination::ZERO,
        normal: Combination::ZERO,
        is_one_sided: true,
    };

    /// A force that does not depend on the constant.
    pub const ZERO: Self = Self {
        tangential: Combination::ZERO,
        normal: Combination::ZERO,
        is_one_sided: false,
    };

    /// The derivative of tangential forces alone.
    pub fn tangential(tangential: Combination) -> Self {
        Self {
            tangential,
            ..Self::ZERO
        }
    }

    /// The same by a constant that is a factor: `parts` over its value, on one side only where that is zero.
    pub fn by_factor(value: f64, parts: Combination) -> Self {
        if value == 0.0 {
            return Self::ONE_SIDED;
        }
        Self::tangential(parts.over(value))
    }

    /// The derivative of all forces of a contact whose normal load is max(N₀ − kn·(gap + y), 0), by N₀, kn or the gap:
    /// a change of the load is a change of the normal motion y.
    pub fn of_normal_load(constant: Constant, kn: f64, gap: f64) -> Self {
        let parts = match constant {
            Constant::Preload => Combination {
                by_shift: -1.0 / kn,
                ..Combination::ZERO
            },
            Constant::Gap => Combination {
                by_shift: 1.0,
                ..Combination::ZERO
            },
            Constant::Kn => Combination {
                by_normal: 1.0 / kn,
                by_shift: gap / kn,
                ..Combination::ZERO
            },
            _ => Combination::ZERO,
        };
        Self {
            tangential: parts,
            normal: parts,
            is_one_sided: false,
        }
    }
}

impl Combination {
    /// Nothing.
    pub const ZERO: Self = Self {
        motion: 0.0,
        by_tangential: 0.0,
        by_normal: 0.0,
        by_shift: 0.0,
        by_slider: [0.0; 2],
        force: 0.0,
        offset: 0.0,
    };

    /// J x over the tangential motions: the derivative by ln kt of friction.
    pub const BY_TANGENTIAL: Self = Self {
        by_tangential: 1.0,
        ..Self::ZERO
    };

    /// f − J x over the tangential motions: the derivative by ln μ of friction.
    pub const BY_LIMIT: Self = Self {
        by_normal: 1.0,
        offset: 1.0,
        ..Self::ZERO
    };

    /// The force itself: the derivative by the logarithm of a factor of it.
    pub const FORCE: Self = Self {
        force: 1.0,
        ..Self::ZERO
    };

    /// The motion: the derivative by the stiffness of a spring.
    pub const MOTION: Self = Self {
        motion: 1.0,
        ..Self::ZERO
    };

    /// −J e: the derivative by the place of the slider along t1 (0) or t2 (1).
    pub fn of_slider(k: usize) -> Self {
        let mut by_slider = [0.0; 2];
        by_slider[k.min(1)] = -1.0;
        Self {
            by_slider,
            ..Self::ZERO
        }
    }

    /// The sum of two sets of numbers.
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            motion: self.motion + other.motion,
            by_tangential: self.by_tangential + other.by_tangential,
            by_normal: self.by_normal + other.by_normal,
            by_shift: self.by_shift + other.by_shift,
            by_slider: [0, 1].map(|k| self.by_slider[k] + other.by_slider[k]),
            force: self.force + other.force,
            offset: self.offset + other.offset,
        }
    }

    /// Σ factor · part.
    pub fn times(&self, parts: &Self) -> f64 {
        self.motion * parts.motion
            + self.by_tangential * parts.by_tangential
            + self.by_normal * parts.by_normal
            + self.by_shift * parts.by_shift
            + self.by_slider[0] * parts.by_slider[0]
            + self.by_slider[1] * parts.by_slider[1]
            + self.force * parts.force
            + self.offset * parts.offset
    }

    fn over(self, value: f64) -> Self {
        Self {
            motion: self.motion / value,
            by_tangential: self.by_tangential / value,
            by_normal: self.by_normal / value,
            by_shift: self.by_shift / value,
            by_slider: self.by_slider.map(|x| x / value),
            force: self.force / value,
            offset: self.offset / value,
        }
    }
}
