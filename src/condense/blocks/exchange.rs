//! Exchanged motions: near-rigid sliders without their stick stiffness.
//!
//! A slider of a stick stiffness k, infinite if it is rigid, whose limit is constant, slips at the rate of the motion
//! y − f/k of its end, and only while its force is at the limit. With τ = ωt, any stiffness α > 0 and
//!
//! > α x = f + α d(y − f/k)/dτ,  f = min(max(α x, −fc), fc)
//!
//! says the same ([`crate::contact::laws::saturated`]), at every time and exactly. In harmonic h, with the flexibility G
//! of the structure,
//!
//! > x − s y_lin + (s G + s/k − 1/α) f(x) = 0,  s = ih,
//!
//! an equation of the same form as that of a motion, with the row of the coordinate times s and s/k − 1/α added to its
//! diagonal; its reference stiffness κ is 0. Cut off at H, y has a tail of harmonics where f jumps as slip ends, and a near-rigid spring
//! between them rings at every harmonic up to H: hundreds of events, no Newton's method that finds them, errors of
//! H⁻¹. Cut off at H, x acts as a damper α/ω on the harmonics above: nothing rings, and the equations have one solution at
//! any H, since the law and a structure that is passive are both monotone.
//!
//! The mean has s = 10⁻⁶ instead of 0: a slider that slips has lost its mean place, and one that never slipped keeps it.
//!
//! α only moves the truncation error. It is the geometric mean of 1/(h|G_h|) over a nominal number of harmonics of a mass that
//! has the flexibility of the structure in the last of them, the best relaxation of such an iteration (Peaceman & Rachford).

use num_complex::Complex64;

/// Share of its place that a slider in the mean of the motion loses in a turn.
/// Kind: rounding.
pub(crate) const CREEP: f64 = 1e-6;

/// Exchange of the motion y of one coordinate for x = f/α + d(y − f/k)/dτ, where f is the force of its slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exchange {
    /// α, the stiffness that defines the exchanged motion x.
    pub stiffness: f64,
    /// 1/k, the compliance of the stick stiffness k; 0 if the slider is rigid.
    pub(crate) compliance: f64,
    /// Angular frequency √(k/m) at which the stick stiffness k rings with the mass m of the structure at the contact.
    pub ring: f64,
}

impl Exchange {
    /// Factor s of the derivative d/dτ in harmonic `number`.
    pub(crate) fn rate(number: usize) -> Complex64 {
        if number == 0 {
            CREEP.into()
        } else {
            Complex64::new(0.0, number as f64)
        }
    }

    /// The motion y of the contact in harmonic `number`, from the exchanged motion x and the force f.
    pub(crate) fn motion(&self, number: usize, x: Complex64, f: Complex64) -> Complex64 {
        (x - f / self.stiffness) / Self::rate(number) + f * self.compliance
    }
}
