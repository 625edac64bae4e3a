//! The derivatives of the steps of a law with states. The tangents of the force at given states account for the
//! part of its change that does not follow from the change of the states.

use crate::at_a_point::check_jacobian::jacobian_gap::{JacobianGap, Tangent};
use crate::at_a_point::check_jacobian::test_motion::{CONTEXT, Motion, SAMPLES, sizes, step_of};
use crate::contact::forms::law::Hysteretic;
use crate::contact::forms::march::March;
use crate::contact::laws::User;
use crate::error::{Result, try_vec};

/// One step of a law with states, as a period of two samples: the first one is compared, the second is the one before
/// it. The frequency gives them the distance of the samples of the test motion.
struct Step {
    omega: f64,
    u: Vec<f64>,
    v: Vec<f64>,
    z0: Vec<f64>,
}

/// Perturbed variable of a step.
#[derive(Clone, Copy)]
enum Perturbed {
    State(usize),
    /// A motion: `true` for the one before, and its direction.
    Motion(bool, usize),
    Velocity(bool, usize),
    Frequency,
}

impl Step {
    /// The number of the step that is perturbed.
    fn place(&mut self, d: usize, moved: Perturbed) -> &mut f64 {
        let at = |before: bool, k: usize| if before { d + k } else { k };
        match moved {
            Perturbed::State(k) => &mut self.z0[k],
            Perturbed::Motion(before, k) => &mut self.u[at(before, k)],
            Perturbed::Velocity(before, k) => &mut self.v[at(before, k)],
            Perturbed::Frequency => &mut self.omega,
        }
    }

    fn evaluate(&self, law: &User, out: &mut March) -> Result<()> {
        law.march(self.omega, 2, &self.u, &self.v, &self.z0, out)
    }
}

/// Compares the tangents of a law with states. Every step is perturbed separately.
pub(super) fn with_states(law: &User, motion: &Motion) -> Result<JacobianGap> {
    let (d, s) = (law.directions, law.states);
    let mut whole = March::new(d, s, SAMPLES)?;
    let mut start = try_vec(s, 0.0, CONTEXT)?;
    // The states of the second period belong to the motion before them.
    for _ in 0..2 {
        law.march(motion.omega, SAMPLES, &motion.u, &motion.v, &start, &mut whole)?;
        start.copy_from_slice(&whole.z[(SAMPLES - 1) * s..]);
    }
    let (force_sizes, mut state_sizes) = (sizes(&whole.f, d)?, sizes(&whole.z, s)?);
    // The size of a state that is zero everywhere is unknown; one is assumed.
    state_sizes.iter_mut().filter(|z| **z == 0.0).for_each(|z| *z = 1.0);
    let (mut at, mut up, mut down) = (March::new(d, s, 2)?, March::new(d, s, 2)?, March::new(d, s, 2)?);
    let mut step = Step {
        omega: motion.omega * SAMPLES as f64 / 2.0,
        u: try_vec(2 * d, 0.0, CONTEXT)?,
        v: try_vec(if law.velocity { 2 * d } else { 0 }, 0.0, CONTEXT)?,
        z0: start,
    };
    let mut worst = JacobianGap::default();
    for j in 0..SAMPLES {
        let before = (j + SAMPLES - 1) % SAMPLES;
        for (own, signal) in [(&mut step.u, &motion.u), (&mut step.v, &motion.v)] {
            if !own.is_empty() {
                own[..d].copy_from_slice(&signal[j * d..(j + 1) * d]);
                own[d..].copy_from_slice(&signal[before * d..(before + 1) * d]);
            }
        }
        step.z0.copy_from_slice(&whole.z[before * s..(before + 1) * s]);
        step.evaluate(law, &mut at)?;
        let motions = (0..d).flat_map(|k| [Perturbed::Motion(true, k), Perturbed::Motion(false, k)]);
        let velocities = (0..if law.velocity { d } else { 0 })
            .flat_map(|k| [Perturbed::Velocity(true, k), Perturbed::Velocity(false, k)]);
        let all = (0..s).map(Perturbed::State).chain(motions).chain(velocities);
        for moved in all.chain([Perturbed::Frequency]) {
            let size = match moved {
                Perturbed::State(k) => state_sizes[k],
                Perturbed::Motion(_, k) => motion.size(k, false),
                Perturbed::Velocity(_, k) => motion.size(k, true),
                Perturbed::Frequency => step.omega,
            };
            let h = step_of(size);
            let kept = *step.place(d, moved);
            *step.place(d, moved) = kept + h;
            step.evaluate(law, &mut up)?;
            *step.place(d, moved) = kept - h;
            step.evaluate(law, &mut down)?;
            *step.place(d, moved) = kept;
            let compared = Compared {
                sample: j,
                moved,
                size,
                difference: |a: f64, b: f64| (a - b) / (2.0 * h),
                marches: (&at, &up, &down),
            };
            compared.states(&state_sizes, &mut worst);
            compared.forces(&force_sizes, &mut worst);
        }
    }
    Ok(worst)
}

/// A step with its perturbed variable; and the steps perturbed to both sides.
struct Compared<'a, D: Fn(f64, f64) -> f64> {
    sample: usize,
    moved: Perturbed,
    size: f64,
    difference: D,
    marches: (&'a March, &'a March, &'a March),
}

impl<D: Fn(f64, f64) -> f64> Compared<'_, D> {
    fn state_change(&self, a: usize) -> f64 {
        (self.difference)(self.marches.1.z[a], self.marches.2.z[a])
    }

    fn states(&self, sizes: &[f64], worst: &mut JacobianGap) {
        let at = self.marches.0;
        let (d, s) = (at.directions, at.states);
        for (row, size) in sizes.iter().enumerate() {
            let (tangent, column, given) = match self.moved {
                Perturbed::State(k) => (Tangent::StateByState, k, at.dz.z[row * s + k]),
                Perturbed::Motion(true, k) => (Tangent::StateByMotionBefore, k, at.dz.u_before[row * d + k]),
                Perturbed::Motion(false, k) => (Tangent::StateByMotion, k, at.dz.u[row * d + k]),
                Perturbed::Velocity(true, k) => (Tangent::StateByVelocityBefore, k, at.dz.v_before[row * d + k]),
                Perturbed::Velocity(false, k) => (Tangent::StateByVelocity, k, at.dz.v[row * d + k]),
                Perturbed::Frequency => (Tangent::StateByFrequency, 0, at.dz.omega[row]),
            };
            let entry = JacobianGap {
                gap: 0.0,
                tangent,
                sample: self.sample,
                row,
                column,
                given,
                difference: self.state_change(row),
            };
            worst.keep_worst(self.size, *size, entry);
        }
    }

    /// Compares two changes of force: the one that follows from the states, and the one at given states.
    fn forces(&self, sizes: &[f64], worst: &mut JacobianGap) {
        let at = self.marches.0;
        let (d, s) = (at.directions, at.states);
        for (row, size) in sizes.iter().enumerate() {
            let whole = (self.difference)(self.marches.1.f[row], self.marches.2.f[row]);
            let by_states: f64 = (0..s).map(|a| at.df_dz[row * s + a] * self.state_change(a)).sum();
            let (tangent, column, given, difference) = match self.moved {
                Perturbed::State(k) => (Tangent::ForceByState, k, by_states, whole),
                Perturbed::Motion(false, k) => (Tangent::ForceByMotion, k, at.df_du[row * d + k], whole - by_states),
                Perturbed::Velocity(false, k) => {
                    (Tangent::ForceByVelocity, k, at.df_dv[row * d + k], whole - by_states)
                }
                Perturbed::Motion(true, _) | Perturbed::Velocity(true, _) | Perturbed::Frequency => continue,
            };
            let entry = JacobianGap {
                gap: 0.0,
                tangent,
                sample: self.sample,
                row,
                column,
                given,
                difference,
            };
            worst.keep_worst(self.size, *size, entry);
        }
    }
}
