//! Check of the tangents of a law of the caller against central differences on a test motion. A wrong tangent is a
//! frequent reason why a solve does not converge.

mod jacobian_gap;
mod step_derivatives;
mod test_motion;

pub use crate::at_a_point::check_jacobian::jacobian_gap::{JacobianGap, Tangent};
use crate::at_a_point::check_jacobian::step_derivatives::with_states;
use crate::at_a_point::check_jacobian::test_motion::{CONTEXT, Motion, SAMPLES, sizes, step_of};
use crate::contact::forms::law::Memoryless;
use crate::contact::forms::samples::Samples;
use crate::contact::laws::User;
use crate::error::{Error, Result, fail, try_copy, try_vec};
use crate::model::Model;

/// Compares all tangents of a caller's law, that of contact `contact`, with central differences. The motion is built
/// in: a mean and the harmonics 1 and 3, of about `amplitudes` in each direction, at the angular frequency `omega`.
///
/// # Errors
/// `Index` for an unknown contact, `Argument` for a contact that is no law of the caller and for numbers out of
/// range, `Dimension` for a wrong number of amplitudes; those of the callback.
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
        with_states(law, &motion)
    };
    found.map_err(|e: Error| e.at(format_args!("contact {contact}")))
}

/// Force and tangents of a law without memory.
struct ForceAndTangents {
    f: Vec<f64>,
    df_du: Vec<f64>,
    df_dv: Vec<f64>,
    scratch: Vec<f64>,
}

impl ForceAndTangents {
    fn new(motion: &Motion) -> Result<Self> {
        let (signals, d) = (motion.u.len(), motion.amplitudes.len());
        Ok(Self {
            f: try_vec(signals, 0.0, CONTEXT)?,
            df_du: try_vec(signals.saturating_mul(d), 0.0, CONTEXT)?,
            df_dv: try_vec(motion.v.len().saturating_mul(d), 0.0, CONTEXT)?,
            scratch: try_vec(signals.saturating_mul(2), 0.0, CONTEXT)?,
        })
    }

    fn evaluate(&mut self, law: &User, omega: f64, u: &[f64], v: &[f64]) -> Result<()> {
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

/// Compares the tangents of a law without memory. Each direction is perturbed at all samples at once, so that a force
/// that depends on other times is detected as well.
fn without_memory(law: &User, motion: &Motion) -> Result<JacobianGap> {
    let d = law.directions;
    let mut worst = JacobianGap::default();
    let (mut reported, mut up, mut down) = (
        ForceAndTangents::new(motion)?,
        ForceAndTangents::new(motion)?,
        ForceAndTangents::new(motion)?,
    );
    reported.evaluate(law, motion.omega, &motion.u, &motion.v)?;
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
                out.evaluate(law, motion.omega, &u, &v)?;
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
                worst.keep_worst(moved, changed[at % d], entry);
            }
        }
    }
    Ok(worst)
}
