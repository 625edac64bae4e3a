//! Laws that know times only: those without memory at the times wanted, those with states by a march.

use crate::aft::hysteretic::HystereticEvaluator;
use crate::contact::hysteretic_law::Hysteretic;
use crate::contact::memoryless_law::{Memoryless, Samples};
use crate::error::{Result, try_vec};
use crate::fourier::jet;
use crate::results::contact_loops::{CONTEXT, Orbit, Times, sample, time};

/// Forces of a law without memory at the motions in `out`, asked for in one call.
///
/// # Errors
/// `OutOfMemory` and those of the law.
pub fn pointwise(orbit: &Orbit<'_>, law: &dyn Memoryless, out: &mut Times) -> Result<()> {
    let (n, d) = (out.state.len(), orbit.directions);
    let memory = |size: usize| try_vec(size, 0.0, CONTEXT);
    let tangents = out.motion.len().saturating_mul(d);
    let feels = usize::from(law.uses_velocity());
    let mut v = memory(feels * out.motion.len())?;
    // τ runs `base` times as fast as ωt.
    let rate = orbit.set.base() as f64 * orbit.omega;
    for (j, row) in v.chunks_exact_mut(d.max(1)).enumerate() {
        let tau = time(orbit.set, j, n);
        for (k, v) in row.iter_mut().enumerate() {
            *v = rate * jet(orbit.set, orbit.signal(k), tau).dx;
        }
    }
    let samples = Samples {
        f: &mut out.force,
        df_du: &mut memory(tangents)?,
        df_dv: &mut memory(feels * tangents)?,
        scratch: &mut memory(out.motion.len().saturating_mul(2))?,
    };
    law.evaluate(orbit.omega, n, &out.motion, &v, samples)
}

/// Forces and states of a law with states, marched over a multiple of the n times that is no less than
/// the samples which the law takes by itself.
///
/// # Errors
/// `OutOfMemory`, those of the law, `NoConvergence` when its states do not become periodic.
pub fn marched(orbit: &Orbit<'_>, law: &dyn Hysteretic, out: &mut Times) -> Result<()> {
    let (n, d) = (out.state.len(), orbit.directions);
    let highest = orbit.set.highest_reduced();
    let least = law.samples(highest, orbit.samples).max(2 * highest + 1).max(2);
    let stride = least.div_ceil(n.max(1));
    let mut way = HystereticEvaluator::new(orbit.set, law, stride.saturating_mul(n))?;
    way.coarsen_or_refine(law, orbit.omega, orbit.motion)?;
    let march = way.march();
    for (j, (force, state)) in out.force.chunks_exact_mut(d.max(1)).zip(&mut out.state).enumerate() {
        let at = stride * sample(orbit.set, j, n);
        force.copy_from_slice(&march.f[at * d..(at + 1) * d]);
        *state = march.state[at];
    }
    Ok(())
}
