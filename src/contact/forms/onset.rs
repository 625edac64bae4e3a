//! Amplitudes at which a law ceases to be linear when it vibrates about a static motion.

use crate::roots;
use num_complex::Complex64;
use std::convert::Infallible;
use std::f64::consts::{PI, TAU};

/// Factors a of a vibration y₀ + a·Re(Y e^{iτ}) at which something begins; infinite where it never does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Onset {
    /// The law is linear up to this factor: 0 where it is not linear at any.
    pub linear: f64,
    /// Slip begins in each period, if the law is linear up to there; infinite also where it begins later. A slider
    /// that is dragged along on one side alone sticks again: the mean of its force has changed.
    pub slip: f64,
    /// A contact that presses at rest opens.
    pub lift_off: f64,
}

/// Relative difference of factors that count as equal.
/// Kind: rounding.
const BOTH: f64 = 1e-9;

/// Points of the period between which the earliest slip in a plane is sought.
/// Kind: tuned; measured on: not recorded.
const ONSET_POINTS: usize = 256;

/// Width, as a phase, at which the place of the earliest slip is found.
/// Kind: rounding.
const ONSET_WIDTH: f64 = 1e-14;

impl Onset {
    /// A law that is linear at every motion.
    pub const NEVER: Self = Self {
        linear: f64::INFINITY,
        slip: f64::INFINITY,
        lift_off: f64::INFINITY,
    };

    /// A law without slip and opening that is linear at no vibration, as smooth laws are.
    pub const SMOOTH: Self = Self {
        linear: 0.0,
        ..Self::NEVER
    };

    /// A unilateral spring whose closing over its clearance at rest is `pressed`, negative where it is open.
    pub fn of_closing(pressed: f64, motion: Complex64) -> Self {
        let passes = first(pressed.abs(), motion.norm());
        Self {
            linear: passes,
            slip: f64::INFINITY,
            lift_off: if pressed >= 0.0 { passes } else { f64::INFINITY },
        }
    }

    /// The same law with a slider that is dragged from a factor on in one direction, and at another in the opposite
    /// one.
    pub fn with_slider(self, [one, other]: [f64; 2]) -> Self {
        let dragged = one.min(other);
        let on_both_sides = (one - other).abs() <= BOTH * dragged;
        Self {
            linear: self.linear.min(dragged),
            slip: if on_both_sides { dragged } else { f64::INFINITY },
            ..self
        }
    }

    /// The onset of several laws.
    pub fn earliest(self, other: Self) -> Self {
        Self {
            linear: self.linear.min(other.linear),
            slip: self.slip.min(other.slip),
            lift_off: self.lift_off.min(other.lift_off),
        }
    }
}

/// Factor at which a vibration of size `motion` takes up `room`.
fn first(room: f64, motion: f64) -> f64 {
    if motion == 0.0 {
        f64::INFINITY
    } else {
        room.max(0.0) / motion
    }
}

/// Factors of f = μN and f = −μN for friction f = kt·x in one direction under the load N = N₀ − kn·y: at the static
/// force `force` and limit μN₀, for a vibration of the force kt·X and of the limit −μkn·Y.
pub fn slider_in_line(force: f64, limit: f64, of_force: Complex64, of_limit: Complex64) -> [f64; 2] {
    [
        first(limit - force, (of_force + of_limit).norm()),
        first(limit + force, (of_force - of_limit).norm()),
    ]
}

/// The same in a plane: the least a over the period with |f₀ + a f(τ)| = μN₀ − a·μkn·y(τ), and that half a period
/// later.
pub fn slider_in_plane(force: [f64; 2], limit: f64, of_force: [Complex64; 2], of_limit: Complex64) -> [f64; 2] {
    let at = |tau: f64| {
        let turn = Complex64::cis(tau);
        let vibrating = of_force.map(|f| (f * turn).re);
        let falls = (of_limit * turn).re;
        // |f₀ + a f|² = (L − a l)²
        let square = vibrating[0] * vibrating[0] + vibrating[1] * vibrating[1] - falls * falls;
        let half = force[0] * vibrating[0] + force[1] * vibrating[1] + limit * falls;
        let room = (limit * limit - force[0] * force[0] - force[1] * force[1]).max(0.0);
        // square·a² + 2 half·a − room = 0, the least positive root without cancellation.
        let root = (half * half + square * room).max(0.0).sqrt();
        if half + root > 0.0 {
            room / (half + root)
        } else {
            f64::INFINITY
        }
    };
    let step = TAU / ONSET_POINTS as f64;
    let mut least = (f64::INFINITY, 0.0);
    for j in 0..ONSET_POINTS {
        let a = at(j as f64 * step);
        if a < least.0 {
            least = (a, j as f64 * step);
        }
    }
    let tau = roots::least([least.1 - step, least.1 + step], ONSET_WIDTH, |tau| {
        Ok::<_, Infallible>(at(tau))
    })
    .unwrap_or(least.1);
    [least.0.min(at(tau)), at(tau + PI)]
}
