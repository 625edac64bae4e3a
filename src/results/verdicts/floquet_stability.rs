//! Stability of one motion, from its Floquet multipliers.

use crate::contact::forms::time_piece::Grazing;
use crate::error::Status;
use crate::results::verdicts::floquet_multiplier::{Multiplier, MultiplierClass};
use crate::results::verdicts::verdict::VERDICT_UNIT;
use num_complex::Complex64;

/// Stability of a periodic motion.
#[derive(Clone, Debug)]
pub struct Floquet {
    /// Status: `Ok`, or `StoppedByCaller` and then without multipliers.
    pub status: Status,
    /// Multipliers of one period by falling modulus. All ordinary ones are NaN where the motion touches an event.
    pub multipliers: Vec<Multiplier>,
    /// Largest modulus of the ordinary multipliers; NaN where the motion touches an event.
    pub radius: f64,
    /// Number of ordinary multipliers outside the unit circle.
    pub unstable: usize,
    /// Number of multipliers that are 1 by construction, without the trivial one of an autonomous motion.
    pub neutral: usize,
    /// Angular frequency of the motion; equal to that of the point, unless no force drives it.
    pub omega: f64,
    /// Distance between the motion in time and the motion of the point, relative to the latter, in the harmonics 0 ..
    /// H of the branch; 0 without shooting.
    pub orbit_change: f64,
    /// Largest change of the motion over a period, relative to the largest displacement and velocity.
    pub residual: f64,
    /// The contact that touches an event without passing it, and the kind of event: derivatives differ on its two
    /// sides.
    pub grazing: Option<(usize, Grazing)>,
    /// Number of modes of each nodal diameter on which the motion and its perturbations were computed; 0: on all
    /// degrees of freedom.
    pub modes: usize,
    /// Largest change of a multiplier above half the radius from half as many modes; 0 on all degrees of freedom. NaN where
    /// `orbit_change` is above a fifth: two numbers of modes then bound nothing.
    pub modes_change: f64,
    /// Estimated error of the radius by the omitted modes, from the changes of those multipliers that may be as
    /// large; 0 on all degrees of freedom, NaN as `modes_change`.
    pub radius_error: f64,
}

impl Floquet {
    /// The result of a call that the caller stopped.
    pub(crate) fn stopped(omega: f64) -> Self {
        Self {
            status: Status::StoppedByCaller,
            multipliers: Vec::new(),
            radius: f64::NAN,
            unstable: 0,
            neutral: 0,
            omega,
            orbit_change: f64::NAN,
            residual: f64::INFINITY,
            grazing: None,
            modes: 0,
            modes_change: 0.0,
            radius_error: 0.0,
        }
    }

    /// Sorts the multipliers, and computes radius and numbers from them.
    pub(crate) fn of(mut multipliers: Vec<Multiplier>, grazing: Option<(usize, Grazing)>) -> Self {
        if grazing.is_some() {
            for m in multipliers.iter_mut().filter(|m| m.class == MultiplierClass::Ordinary) {
                m.value = Complex64::new(f64::NAN, f64::NAN);
            }
        }
        multipliers.sort_by(|a, b| b.value.norm().total_cmp(&a.value.norm()));
        let ordinary = || multipliers.iter().filter(|m| m.class == MultiplierClass::Ordinary);
        let neutral =
            |m: &&Multiplier| matches!(m.class, MultiplierClass::NeutralStuck | MultiplierClass::NeutralRigid);
        let radius = ordinary().fold(0.0_f64, |r, m| r.max(m.value.norm()));
        Self {
            status: Status::Ok,
            radius: if grazing.is_some() { f64::NAN } else { radius },
            unstable: ordinary().filter(|m| m.value.norm() > VERDICT_UNIT).count(),
            neutral: multipliers.iter().filter(neutral).count(),
            multipliers,
            omega: 0.0,
            orbit_change: 0.0,
            residual: 0.0,
            grazing,
            modes: 0,
            modes_change: 0.0,
            radius_error: 0.0,
        }
    }
}
