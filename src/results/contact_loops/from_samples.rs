//! Laws that are evaluated at times only: those without memory at the requested times, those with states by a
//! march.

use crate::aft::hysteretic::HystereticEvaluator;
use crate::contact::law::{Hysteretic, Memoryless};
use crate::contact::samples::Samples;
use crate::error::{Result, try_vec};
use crate::fourier::jet;
use crate::interrupt::Interrupt;
use crate::results::contact_loops::period::{CONTEXT, PeriodicMotion, Times, sample, time};
use crate::results::signal_check::check_time;

/// Forces of a law without memory at the motions in `out`, in one call.
///
/// # Errors
/// `OutOfMemory`, `StoppedByCaller` and those of the law.
pub(super) fn pointwise(
    motion: &PeriodicMotion<'_>,
    law: &dyn Memoryless,
    out: &mut Times,
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    let (n, d) = (out.state.len(), motion.directions);
    let memory = |size: usize| try_vec(size, 0.0, CONTEXT);
    let tangents = out.motion.len().saturating_mul(d);
    let feels = usize::from(law.uses_velocity());
    let mut v = memory(feels * out.motion.len())?;
    // τ runs `base` times as fast as ωt.
    let rate = motion.set.base() as f64 * motion.omega;
    for (j, row) in v.chunks_exact_mut(d.max(1)).enumerate() {
        check_time(interrupt, j, motion.set)?;
        let tau = time(motion.set, j, n);
        for (k, v) in row.iter_mut().enumerate() {
            *v = rate * jet(motion.set, motion.signal(k), tau).dx;
        }
    }
    let samples = Samples {
        f: &mut out.force,
        df_du: &mut memory(tangents)?,
        df_dv: &mut memory(feels * tangents)?,
        scratch: &mut memory(out.motion.len().saturating_mul(2))?,
    };
    law.evaluate(motion.omega, n, &out.motion, &v, samples)
}

/// Forces of a law with states, marched over a multiple of the n times that is no less than
/// the samples which the law takes in the solution, where `requested` were.
///
/// # Errors
/// `OutOfMemory`, those of the law, `NoConvergence` when its states do not become periodic.
pub(super) fn marched(
    motion: &PeriodicMotion<'_>,
    law: &dyn Hysteretic,
    requested: usize,
    out: &mut Times,
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    let (n, d) = (out.state.len(), motion.directions);
    let highest = motion.set.highest_reduced();
    let least = law.samples(highest, requested).max(2 * highest + 1).max(2);
    let stride = least.div_ceil(n.max(1));
    let mut way = HystereticEvaluator::new(motion.set, law, stride.saturating_mul(n))?;
    way.find_periodic_states(law, motion.omega, motion.packed, interrupt)?;
    let march = way.march();
    for (j, force) in out.force.chunks_exact_mut(d.max(1)).enumerate() {
        let at = stride * sample(motion.set, j, n);
        force.copy_from_slice(&march.f[at * d..(at + 1) * d]);
    }
    Ok(())
}
