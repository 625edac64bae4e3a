//! The derivatives of the steps of a law with states. A force at given states is what the change of the
//! states does not explain of its own.

use crate::analysis::check_jacobian::{CONTEXT, JacobianGap, Motion, SAMPLES, Tangent, sizes, step_of};
use crate::contact::law::Hysteretic;
use crate::contact::laws::user_law::User;
use crate::contact::march::March;
use crate::error::{Result, try_vec};

/// One step of a law with states: a period of two samples, of which the first is looked at and the second
/// lies before it. Its frequency gives the two the distance of the samples of the test motion.
struct Step {
    omega: f64,
    u: Vec<f64>,
    v: Vec<f64>,
    z0: Vec<f64>,
}

/// What is moved in a step.
#[derive(Clone, Copy)]
enum Moved {
    State(usize),
    /// Whether it is the motion before, and the direction.
    Motion(bool, usize),
    Velocity(bool, usize),
    Frequency,
}

impl Step {
    /// The number that is moved.
    fn place(&mut self, d: usize, moved: Moved) -> &mut f64 {
        let at = |before: bool, k: usize| if before { d + k } else { k };
        match moved {
            Moved::State(k) => &mut self.z0[k],
            Moved::Motion(before, k) => &mut self.u[at(before, k)],
            Moved::Velocity(before, k) => &mut self.v[at(before, k)],
            Moved::Frequency => &mut self.omega,
        }
    }

    fn ask(&self, law: &User, out: &mut March) -> Result<()> {
        law.march(self.omega, 2, &self.u, &self.v, &self.z0, out)
    }
}

/// Every step is moved by itself.
pub(super) fn with_states(law: &User, motion: &Motion) -> Result<JacobianGap> {
    let (d, s) = (law.directions, law.states);
    let mut whole = March::new(d, s, SAMPLES)?;
    let mut start = try_vec(s, 0.0, CONTEXT)?;
    // The second period has states that belong to the motion before.
    for _ in 0..2 {
        law.march(motion.omega, SAMPLES, &motion.u, &motion.v, &start, &mut whole)?;
        start.copy_from_slice(&whole.z[(SAMPLES - 1) * s..]);
    }
    let (force_sizes, mut state_sizes) = (sizes(&whole.f, d)?, sizes(&whole.z, s)?);
    // A state that nothing has moved yet may be of any size.
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
        step.ask(law, &mut at)?;
        let motions = (0..d).flat_map(|k| [Moved::Motion(true, k), Moved::Motion(false, k)]);
        let velocities =
            (0..if law.velocity { d } else { 0 }).flat_map(|k| [Moved::Velocity(true, k), Moved::Velocity(false, k)]);
        let all = (0..s).map(Moved::State).chain(motions).chain(velocities);
        for moved in all.chain([Moved::Frequency]) {
            let size = match moved {
                Moved::State(k) => state_sizes[k],
                Moved::Motion(_, k) => motion.size(k, false),
                Moved::Velocity(_, k) => motion.size(k, true),
                Moved::Frequency => step.omega,
            };
            let h = step_of(size);
            let kept = *step.place(d, moved);
            *step.place(d, moved) = kept + h;
            step.ask(law, &mut up)?;
            *step.place(d, moved) = kept - h;
            step.ask(law, &mut down)?;
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

/// A step with what was moved in it, and the steps to both sides.
struct Compared<'a, D: Fn(f64, f64) -> f64> {
    sample: usize,
    moved: Moved,
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
                Moved::State(k) => (Tangent::StateByState, k, at.dz_dz[row * s + k]),
                Moved::Motion(true, k) => (Tangent::StateByMotionBefore, k, at.dz_du_before[row * d + k]),
                Moved::Motion(false, k) => (Tangent::StateByMotion, k, at.dz_du[row * d + k]),
                Moved::Velocity(true, k) => (Tangent::StateByVelocityBefore, k, at.dz_dv_before[row * d + k]),
                Moved::Velocity(false, k) => (Tangent::StateByVelocity, k, at.dz_dv[row * d + k]),
                Moved::Frequency => (Tangent::StateByFrequency, 0, at.dz_domega[row]),
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
            worst.worse(self.size, *size, entry);
        }
    }

    /// The change of force that the states explain, and that at given states.
    fn forces(&self, sizes: &[f64], worst: &mut JacobianGap) {
        let at = self.marches.0;
        let (d, s) = (at.directions, at.states);
        for (row, size) in sizes.iter().enumerate() {
            let whole = (self.difference)(self.marches.1.f[row], self.marches.2.f[row]);
            let by_states: f64 = (0..s).map(|a| at.df_dz[row * s + a] * self.state_change(a)).sum();
            let (tangent, column, given, difference) = match self.moved {
                Moved::State(k) => (Tangent::ForceByState, k, by_states, whole),
                Moved::Motion(false, k) => (Tangent::ForceByMotion, k, at.df_du[row * d + k], whole - by_states),
                Moved::Velocity(false, k) => (Tangent::ForceByVelocity, k, at.df_dv[row * d + k], whole - by_states),
                Moved::Motion(true, _) | Moved::Velocity(true, _) | Moved::Frequency => continue,
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
            worst.worse(self.size, *size, entry);
        }
    }
}
