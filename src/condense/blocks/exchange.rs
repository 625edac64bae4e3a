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
//! ## With a mass
//!
//! Where the structure has a mass m at the contact, seen by harmonics from H on, and motions have odd harmonics alone, the force on this
//! mass is a better unknown. With the place w = y − f/k of the slider and α = m ω₀²
//!
//! > α x = f + m ω² d²w/dτ²,
//!
//! so that the same equation holds with s = (ω/ω₀)² (ih)². The law is a mass that slides under the force α x, which is integrated from
//! event to event ([`crate::contact::laws::sliding_mass`]): it has all harmonics of the jumps of f. In x there is left what the
//! structure is besides that mass: with G_h → −1/(m h²ω²) it falls as h⁻³, where the rate falls as h⁻¹. The equations are exact for any
//! m; another one makes x fall slower.
//!
//! A stick of a finite stiffness rings at h_r = √(k/m)/ω. The law has the effect of a ring on the slip after it, as a delay of the force.
//! In the equations s/k would count it again, as a part (h/h_r)² of the jumps of f in the harmonic h. A stick alone has f = α x and y = f/k
//! with any s, so that s is free to leave this part out:
//!
//! > s = (ω/ω₀)² (ih)² / (1 − (1 − ρ) (h/h_r)²),  ρ = 1/(1 + (h/h_s)²)²,  h_s = h_r/10.
//!
//! Then s (G + 1/k) − 1/α → −ρ (h/h_r)²/α in the high harmonics of a mass: forces that slip have the compliance 1/k in what moves slowly,
//! and a contact that sticks has it in all harmonics. From half of a ring on no load acts and none resonates: there 1/k is 0.
//!
//! ## The mean
//!
//! The mean has s = 10⁻⁶ instead of 0: a slider that slips has lost its mean place, and one that never slipped keeps it.
//!
//! α only moves the truncation error. It is the geometric mean of 1/(h|G_h|) over a nominal number of harmonics of a mass that
//! has the flexibility of the structure in the last of them, the best relaxation of such an iteration (Peaceman & Rachford).

use num_complex::Complex64;

/// Share of its place that a slider in the mean of the motion loses in a turn.
/// Kind: rounding.
pub(crate) const CREEP: f64 = 1e-6;

/// Share of the harmonic of a ring up to which forces that slip move a mass by their compliance.
/// Kind: tuned; measured on: the chain of 8 masses of `tests/robustness/near_rigid.rs` with kt/k = 3e4.
const SOFT_BELOW_RING: f64 = 0.1;

/// Share of the harmonic of a ring from which a stick beside a mass is rigid.
/// Kind: fixed.
const RIGID_FROM_RING: f64 = 0.5;

/// Exchange of the motion y of one coordinate for x = f/α + d(y − f/k)/dτ, where f is the force of its slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exchange {
    /// α, the stiffness that defines the exchanged motion x.
    pub stiffness: f64,
    /// 1/k, the compliance of the stick stiffness k; 0 if the slider is rigid. See [`Self::compliance_in`].
    pub(crate) compliance: f64,
    /// Angular frequency √(k/m) at which the stick stiffness k rings with the mass m of the structure at the contact.
    pub ring: f64,
    /// ω₀, where the exchanged motion is the force on a mass α/ω₀²; `None`: it is a rate.
    pub mass_at: Option<f64>,
    /// Highest angular frequency of the points.
    pub(crate) fastest: f64,
}

impl Exchange {
    /// s of a harmonic at an angular frequency, and its derivative by that.
    pub(crate) fn rate(&self, number: usize, omega: f64) -> (Complex64, Complex64) {
        let h = number as f64;
        match self.mass_at {
            Some(at) => {
                let s = -(h * omega / at).powi(2);
                let left = 1.0 - self.counted_by_law(number, at) * (h * omega / self.ring).powi(2);
                ((s / left).into(), (2.0 * s / (omega * left * left)).into())
            }
            None if number == 0 => (CREEP.into(), Complex64::ZERO),
            None => (Complex64::new(0.0, h), Complex64::ZERO),
        }
    }

    /// Share of the compliance of a stick beside a mass whose effect on slips the law has.
    fn counted_by_law(&self, number: usize, at: f64) -> f64 {
        if self.is_rigid_in(number) {
            return 0.0;
        }
        let h = number as f64 * at / (SOFT_BELOW_RING * self.ring);
        1.0 - (1.0 + h * h).powi(-2)
    }

    /// Whether a stick beside a mass is rigid in a harmonic, as it would ring.
    fn is_rigid_in(&self, number: usize) -> bool {
        self.mass_at.is_some() && number as f64 * self.fastest >= RIGID_FROM_RING * self.ring
    }

    /// Compliance of the stick stiffness in a harmonic.
    pub(crate) fn compliance_in(&self, number: usize) -> f64 {
        if self.is_rigid_in(number) { 0.0 } else { self.compliance }
    }

    /// The motion y in a harmonic, where the exchanged one is x and the force f.
    pub(crate) fn motion(&self, (number, omega): (usize, f64), x: Complex64, f: Complex64) -> Complex64 {
        (x - f / self.stiffness) / self.rate(number, omega).0 + f * self.compliance_in(number)
    }
}
