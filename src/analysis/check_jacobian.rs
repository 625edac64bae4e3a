//! The tangents of a law of the host against central differences on a test motion: where a solve does not
//! converge, a wrong one is the first suspect.

use crate::contact::ContactKind;
use crate::contact::marched::{March, Marched};
use crate::contact::pointwise::{Pointwise, Samples};
use crate::contact::user::User;
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
    /// The value that the host gave; for [`Tangent::ForceByState`] the change of force that follows
    /// from it per change of that state.
    pub given: f64,
    /// The difference quotient.
    pub difference: f64,
}

/// Samples of the test motion.
const SAMPLES: usize = 64;

const WHAT: &str = "the test of a Jacobian";

/// Step of a central difference relative to what is moved: its error, of second order, and rounding
/// meet at the cube root of the precision.
fn step_of(size: f64) -> f64 {
    f64::EPSILON.cbrt() * size
}

/// Compares all tangents of the law of the host that is contact `contact` with central differences, on a
/// built-in motion with a mean and the harmonics 1 and 3 whose directions reach about `amplitudes`, at
/// the angular frequency `omega`.
///
/// # Errors
/// `Index` for an unknown contact, `Argument` where it is none of the host's and for bad numbers,
/// `Dimension` for another number of amplitudes; those of the callback.
pub fn check_jacobian(model: &Model, contact: usize, omega: f64, amplitudes: &[f64]) -> Result<JacobianGap> {
    let Some(kept) = model.contacts().get(contact) else {
        return fail!(Index, "contact = {contact}, needs 0 .. {}", model.contacts().len());
    };
    let ContactKind::User(law) = &kept.kind else {
        return fail!(
            Argument,
            "contact {contact} is no law of the host; its tangents are the library's"
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
        let mut u = try_vec(SAMPLES.saturating_mul(d), 0.0, WHAT)?;
        let mut v = try_vec(if velocity { u.len() } else { 0 }, 0.0, WHAT)?;
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
            amplitudes: try_copy(amplitudes, WHAT)?,
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
            f: try_vec(signals, 0.0, WHAT)?,
            df_du: try_vec(signals.saturating_mul(d), 0.0, WHAT)?,
            df_dv: try_vec(motion.v.len().saturating_mul(d), 0.0, WHAT)?,
            scratch: try_vec(signals.saturating_mul(2), 0.0, WHAT)?,
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
    let mut sizes = try_vec(width, 0.0, WHAT)?;
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
    let (mut told, mut up, mut down) = (Told::new(motion)?, Told::new(motion)?, Told::new(motion)?);
    told.ask(law, motion.omega, &motion.u, &motion.v)?;
    let changed = sizes(&told.f, d)?;
    for of_velocity in [false, true] {
        if of_velocity && !law.velocity {
            continue;
        }
        for k in 0..d {
            let moved = motion.size(k, of_velocity);
            let h = step_of(moved);
            for (out, shift) in [(&mut up, h), (&mut down, -h)] {
                let (mut u, mut v) = (try_copy(&motion.u, WHAT)?, try_copy(&motion.v, WHAT)?);
                let signal = if of_velocity { &mut v } else { &mut u };
                signal.iter_mut().skip(k).step_by(d).for_each(|x| *x += shift);
                out.ask(law, motion.omega, &u, &v)?;
            }
            let block = if of_velocity { &told.df_dv } else { &told.df_du };
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
fn with_states(law: &User, motion: &Motion) -> Result<JacobianGap> {
    let (d, s) = (law.directions, law.states);
    let mut whole = March::new(d, s, SAMPLES)?;
    let mut start = try_vec(s, 0.0, WHAT)?;
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
        u: try_vec(2 * d, 0.0, WHAT)?,
        v: try_vec(if law.velocity { 2 * d } else { 0 }, 0.0, WHAT)?,
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
