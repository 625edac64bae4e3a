//! Laws of the caller that claim to be odd, f(−u, −v) = −f(u, v), at the motion of a branch: even harmonics were left out because of it.

use crate::contact::forms::law::{Form, Law};
use crate::contact::forms::march::March;
use crate::contact::forms::samples::Samples;
use crate::error::{Error, Result, Status, try_vec};
use crate::fourier::jet;
use crate::model::Model;
use crate::results::Branch;
use std::f64::consts::TAU;

/// Difference of a force from the opposite one, over the largest force, that is rounding of a callback.
/// Kind: rounding.
const ODD_LAWS_ROUNDING: f64 = 1e-6;

const CONTEXT: &str = "the check of an odd force";

/// Refuses a branch whose laws of the caller are not as odd as they claim, at its point of the largest amplitude. A callback that
/// gives up at the check ends the branch, which keeps its points.
///
/// # Errors
/// `Argument`, naming the contact; `OutOfMemory`.
pub(crate) fn check(model: &Model, branch: &mut Branch) -> Result<()> {
    if matches!(branch.status(), Status::StoppedCallback | Status::StoppedByCaller) {
        return Ok(());
    }
    match compare(model, branch) {
        // The law cannot evaluate the opposite motion: nothing is known.
        Err(e) if e.recoverable => Ok(()),
        Err(e) if e.status == Status::Callback => {
            branch.set_ending(Status::StoppedCallback, Some(e), (false, false));
            Ok(())
        }
        compared => compared,
    }
}

fn compare(model: &Model, branch: &Branch) -> Result<()> {
    let is_claimed = |contact: usize| model.contacts()[contact].kind.user().is_some_and(|law| law.odd);
    let points = 0..branch.stored();
    let largest = points.max_by(|&a, &b| branch.stored_amplitude(a).total_cmp(&branch.stored_amplitude(b)));
    if !(0..model.contacts().len()).any(is_claimed) {
        return Ok(());
    }
    let Some((point, omega, motion)) =
        largest.and_then(|point| Some((point, branch.omega_at(point)?, branch.motion_at(point)?)))
    else {
        return Ok(());
    };
    let condensed = branch.condensed_at(point);
    let set = condensed.set();
    let m = set.packed_len();
    let rate = set.base() as f64 * omega;
    for assembled in condensed.laws().iter().filter(|law| is_claimed(law.contact)) {
        let d = assembled.coordinates.len();
        let (highest, requested) = (set.highest_reduced(), branch.samples_at(point));
        // As many times as in the solution.
        let times = match assembled.law.form() {
            Form::Memoryless(law) => law.samples(highest, requested),
            Form::Hysteretic(law) => law.samples(highest, requested),
            Form::PiecewiseLinear(_) | Form::Spectral(_) | Form::VaryingNormalLoad(_) | Form::PlaneFriction(_) => {
                continue;
            }
        };
        let (mut u, mut v) = (try_vec(times * d, 0.0, CONTEXT)?, try_vec(times * d, 0.0, CONTEXT)?);
        for (at, (u, v)) in u.iter_mut().zip(&mut v).enumerate() {
            let c = assembled.coordinates[at % d];
            let found = jet(set, &motion[c * m..(c + 1) * m], TAU * (at / d) as f64 / times as f64);
            (*u, *v) = (found.x, rate * found.dx);
        }
        let named = |e: Error| e.at(format_args!("contact {}", assembled.contact));
        let there = forces(&*assembled.law, omega, times, &u, &v).map_err(named)?;
        for x in u.iter_mut().chain(&mut v) {
            *x = -*x;
        }
        let opposite = forces(&*assembled.law, omega, times, &u, &v).map_err(named)?;
        let size = there.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
        for (at, (f, g)) in there.iter().zip(&opposite).enumerate() {
            if (f + g).abs() > ODD_LAWS_ROUNDING * size {
                let length = condensed.length();
                return Err(Error::new(
                    Status::Argument,
                    format_args!(
                        "contact {}: is_odd = 1, but the force along motion {} is {} at the motion {}, and {} at the opposite one; set \
                         is_odd = 0",
                        assembled.contact,
                        at % d,
                        f * length,
                        -u[at] * length,
                        g * length
                    ),
                ));
            }
        }
    }
    Ok(())
}

/// Forces of a law at some times of a motion; a law with states is loaded from zero.
fn forces(law: &dyn Law, omega: f64, times: usize, u: &[f64], v: &[f64]) -> Result<Vec<f64>> {
    let d = law.directions();
    let mut f = try_vec(u.len(), 0.0, CONTEXT)?;
    match law.form() {
        Form::Memoryless(law) => {
            let felt = if law.uses_velocity() { v } else { &[] };
            let samples = Samples {
                f: &mut f,
                df_du: &mut try_vec(u.len() * d, 0.0, CONTEXT)?,
                df_dv: &mut try_vec(felt.len() * d, 0.0, CONTEXT)?,
                scratch: &mut try_vec(2 * u.len(), 0.0, CONTEXT)?,
            };
            law.evaluate(omega, times, u, felt, samples)?;
        }
        Form::Hysteretic(law) => {
            let mut march = March::new(d, law.states(), times)?;
            let rest = try_vec(law.states(), 0.0, CONTEXT)?;
            law.march(omega, times, u, v, &rest, &mut march)?;
            f.copy_from_slice(&march.f[..u.len()]);
        }
        Form::PiecewiseLinear(_) | Form::Spectral(_) | Form::VaryingNormalLoad(_) | Form::PlaneFriction(_) => {}
    }
    Ok(f)
}
