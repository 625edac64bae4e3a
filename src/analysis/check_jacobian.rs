//! The tangents of a law of the caller against central differences on a test motion: where a solve does not
//! converge, a wrong one is the first suspect.

mod step_derivatives;

use crate::contact::law::Memoryless;
use crate::contact::laws::user_law::User;
use crate::contact::samples::Samples;
use crate::error::{Error, Result, fail, try_copy, try_vec};
use crate::model::Model;
use std::f64::consts::TAU;

/// Which derivative an entry belongs to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tangent {
    /// ∂f/∂u
    #[default]
    ForceByMotion,
    /// ∂f/∂v
    ForceByVelocity,
    /// ∂f/∂z
    ForceByState,
    /// ∂zⱼ/∂zⱼ₋₁
    StateByState,
    /// ∂zⱼ/∂uⱼ₋₁
    StateByMotionBefore,
    /// ∂zⱼ/∂uⱼ
    StateByMotion,
    /// ∂zⱼ/∂vⱼ₋₁
    StateByVelocityBefore,
    /// ∂zⱼ/∂vⱼ
    StateByVelocity,
    /// ∂zⱼ/∂ω
    StateByFrequency,
}

/// The entry of the tangents that lies farthest from its difference quotient.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JacobianGap {
    /// |given − difference| times the size of what was moved, relative to the size of what it moves.
    /// Right tangents of a smooth force stay below 1e-6.
    pub gap: f64,
    /// The derivative.
    pub tangent: Tangent,
    /// Sample of the test motion.
    pub sample: usize,
    /// Row of the entry; for [`Tangent::ForceByState`] the force.
    pub row: usize,
    /// Its column; for [`Tangent::ForceByState`] the state before the sample that was moved.
    pub column: usize,
    /// The value that the caller gave; for [`Tangent::ForceByState`] the change of force that follows
    /// from it per change of that state.
    pub given: f64,
    /// The difference quotient.
    pub difference: f64,
}

/// Samples of the test motion.
const SAMPLES: usize = 64;

const CONTEXT: &str = "the test of a Jacobian";

/// Step of a central difference relative to what is moved: its error, of second order, and rounding
/// meet at the cube root of the precision.
fn step_of(size: f64) -> f64 {
    f64::EPSILON.cbrt() * size
}

/// Compares all tangents of the law of the caller that is contact `contact` with central differences, on a
/// built-in motion with a mean and the harmonics 1 and 3 whose directions reach about `amplitudes`, at
/// the angular frequency `omega`.
///
/// # Errors
/// `Index` for an unknown contact, `Argument` where it is none of the caller's and for bad numbers,
/// `Dimension` for another number of amplitudes; those of the callback.
pub fn check_jacobian(model: &Model, contact: usize, omega: f64, amplitudes: &[f64]) -> Result<JacobianGap> {
    let Some(kept) = model.contacts().get(contact) else {
        return fail!(Index, "contact = {contact}, needs 0 .. {}", model.contacts().len());
    };
    let Some(law) = kept.kind.user() else {
        return fail!(
            Argument,
            "contact {contact} is no law of the caller; its tangents are the library's"
        );
    };
    if !(omega > 0.0 && omega.is_finite()) {
        return fail!(Argument, "omega = {omega}, needs a finite angular frequency > 0");
    }
    if amplitudes.len() != law.directions {
        return fail!(
            Dimension,
            "{} amplitudes, needs one for each of the {} motions of contact {contact}",
            amplitudes.len(),
            law.directions
        );
    }
    if let Some(k) = amplitudes.iter().position(|a| !(*a > 0.0 && a.is_finite())) {
        return fail!(
            Argument,
            "amplitude[{k}] = {}, needs a finite number > 0",
            amplitudes[k]
        );
    }
    let motion = Motion::new(omega, amplitudes, law.velocity)?;
    let found = if law.states == 0 {
        without_memory(law, &motion)
    } else {
        step_derivatives::with_states(law, &motion)
    };
    found.map_err(|e: Error| e.at(format_args!("contact {contact}")))
}

/// The test motion.
struct Motion {
    omega: f64,
    /// Motions and velocities, samples × d; no velocities for a force that does not feel them.
    u: Vec<f64>,
    v: Vec<f64>,
    /// Sizes of the motions.
    amplitudes: Vec<f64>,
}

impl Motion {
    fn new(omega: f64, amplitudes: &[f64], velocity: bool) -> Result<Self> {
        let d = amplitudes.len();
        let mut u = try_vec(SAMPLES.saturating_mul(d), 0.0, CONTEXT)?;
        let mut v = try_vec(if velocity { u.len() } else { 0 }, 0.0, CONTEXT)?;
        for j in 0..SAMPLES {
            for (k, a) in amplitudes.iter().enumerate() {
                let tau = TAU * j as f64 / SAMPLES as f64 + 0.7 * k as f64;
                u[j * d + k] = a * (0.15 + 0.7 * tau.cos() + 0.25 * (3.0 * tau).sin());
                if velocity {
                    v[j * d + k] = omega * a * (-0.7 * tau.sin() + 0.75 * (3.0 * tau).cos());
                }
            }
        }
        Ok(Self {
            omega,
            u,
            v,
            amplitudes: try_copy(amplitudes, CONTEXT)?,
        })
    }

    /// The size of motion k, or of its velocity.
    fn size(&self, k: usize, of_velocity: bool) -> f64 {
        self.amplitudes[k] * if of_velocity { self.omega } else { 1.0 }
    }
}

impl JacobianGap {
    /// Keeps `entry`, whose difference moved something of size `moved` and changed something of size
    /// `changed`, where it is the worst so far.
    fn worse(&mut self, moved: f64, changed: f64, entry: Self) {
        let (given, difference) = (moved * entry.given, moved * entry.difference);
        let distance = (given - difference).abs();
        let size = changed.max(given.abs()).max(difference.abs());
        let gap = if distance == 0.0 { 0.0 } else { distance / size };
        // What overflowed is as wrong as can be.
        let gap = if gap.is_nan() { f64::INFINITY } else { gap };
        if gap > self.gap {
            *self = Self { gap, ..entry };
        }
    }
}

/// Force and tangents of a law without memory.
struct Told {
    f: Vec<f64>,
    df_du: Vec<f64>,
    df_dv: Vec<f64>,
    scratch: Vec<f64>,
}

impl Told {
    fn new(motion: &Motion) -> Result<Self> {
        let (signals, d) = (motion.u.len(), motion.amplitudes.len());
        Ok(Self {
            f: try_vec(signals, 0.0, CONTEXT)?,
            df_du: try_vec(signals.saturating_mul(d), 0.0, CONTEXT)?,
            df_dv: try_vec(motion.v.len().saturating_mul(d), 0.0, CONTEXT)?,
            scratch: try_vec(signals.saturating_mul(2), 0.0, CONTEXT)?,
        })
    }

    fn ask(&mut self, law: &User, omega: f64, u: &[f64], v: &[f64]) -> Result<()> {
        self.df_du.fill(0.0);
        self.df_dv.fill(0.0);
        let out = Samples {
            f: &mut self.f,
            df_du: &mut self.df_du,
            df_dv: &mut self.df_dv,
            scratch: &mut self.scratch,
        };
        law.evaluate(omega, SAMPLES, u, v, out)
    }
}

/// Largest magnitude of each of the `width` numbers of a sample.
fn sizes(values: &[f64], width: usize) -> Result<Vec<f64>> {
    let mut sizes = try_vec(width, 0.0, CONTEXT)?;
    for sample in values.chunks_exact(width) {
        for (size, x) in sizes.iter_mut().zip(sample) {
            *size = x.abs().max(*size);
        }
    }
    Ok(sizes)
}

/// Each direction is moved at all samples at once, so that a force which does not follow from its own time
/// alone shows too.
fn without_memory(law: &User, motion: &Motion) -> Result<JacobianGap> {
    let d = law.directions;
    let mut worst = JacobianGap::default();
    let (mut reported, mut up, mut down) = (Told::new(motion)?, Told::new(motion)?, Told::new(motion)?);
    reported.ask(law, motion.omega, &motion.u, &motion.v)?;
    let changed = sizes(&reported.f, d)?;
    for of_velocity in [false, true] {
        if of_velocity && !law.velocity {
            continue;
        }
        for k in 0..d {
            let moved = motion.size(k, of_velocity);
            let h = step_of(moved);
            for (out, shift) in [(&mut up, h), (&mut down, -h)] {
                let (mut u, mut v) = (try_copy(&motion.u, CONTEXT)?, try_copy(&motion.v, CONTEXT)?);
                let signal = if of_velocity { &mut v } else { &mut u };
                signal.iter_mut().skip(k).step_by(d).for_each(|x| *x += shift);
                out.ask(law, motion.omega, &u, &v)?;
            }
            let block = if of_velocity { &reported.df_dv } else { &reported.df_du };
            for (at, (a, b)) in up.f.iter().zip(&down.f).enumerate() {
                let entry = JacobianGap {
                    gap: 0.0,
                    tangent: if of_velocity {
                        Tangent::ForceByVelocity
                    } else {
                        Tangent::ForceByMotion
                    },
                    sample: at / d,
                    row: at % d,
                    column: k,
                    given: block[at * d + k],
                    difference: (a - b) / (2.0 * h),
                };
                worst.worse(moved, changed[at % d], entry);
            }
        }
    }
    Ok(worst)
}
