//! Laws with states that are marched over equidistant samples of a period.
//!
//! A law of this kind knows no pieces: it gets the relative motions at all samples in one call and
//! steps its states zⱼ = Z(zⱼ₋₁, motion at j − 1 and j) from sample to sample, telling the derivative
//! of every step. What the states are at the start of the period, how they make it periodic and
//! what that means for harmonics is the matter of [`crate::aft::hysteretic`].

use crate::contact::contact_state::State;
use crate::contact::law::Law;
use crate::contact::laws::friction_2d::Friction2d;
use crate::error::{Result, try_vec};

/// A law with internal states over d directions. Where nothing moves and nothing has moved before,
/// the states are zero.
pub trait Hysteretic: Law {
    /// Number s of states.
    fn states(&self) -> usize;

    /// Whether velocities enter; if not, they need not be given.
    fn uses_velocity(&self) -> bool;

    /// Whether a march in which nothing slips and nothing is open has the force of a linear spring.
    fn sticks(&self) -> bool {
        false
    }

    /// Whether the law can stick through the period of the motion `u`, samples × d row-major. Where
    /// it can, any of many states may be periodic: the one that counts is then in `out`, and does not jump as the
    /// motion changes. A start that is nearly periodic is in `out` likewise; all of its first `samples`
    /// blocks are written.
    fn rest(&self, samples: usize, u: &[f64], out: &mut StuckState) -> Sticking {
        let _ = (samples, u, out);
        Sticking::Unknown
    }

    /// Whether the force along the last motion, a normal one, depends on that motion alone as that of this
    /// friction in one direction does: then its harmonics are exact, from located closings and openings.
    fn normal(&self) -> Option<Friction2d> {
        None
    }

    /// Samples per period for motions up to the reduced harmonic `highest`, where the caller asked for
    /// `asked`, or with 0 for what suits the law.
    fn samples(&self, highest: usize, asked: usize) -> usize;

    /// Marches once over `samples` equidistant times of the period 2π/`omega` and writes every entry
    /// of the first `samples` blocks of `out`.
    ///
    /// `u` and `v` hold the relative motions and their velocities, samples × d row-major; `v` is empty
    /// where [`Self::uses_velocity`] denies it. `z0` are the states before sample 0: those of the last
    /// sample of the period before, whose motion is that of the last sample.
    ///
    /// # Errors
    /// Those of the law.
    fn march(&self, omega: f64, samples: usize, u: &[f64], v: &[f64], z0: &[f64], out: &mut March) -> Result<()>;
}

/// Whether a law sticks through the period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sticking {
    /// The law does not know; what a march from rest leads to counts.
    Unknown,
    /// It does.
    Here,
    /// It slips, which makes it forget, so that it has one periodic state; not far from a known one.
    Nearly,
    /// Likewise, and nothing is known of the state.
    Nowhere,
}

/// The state of a law that sticks through the period, before sample 0.
#[derive(Clone, Debug)]
pub struct StuckState {
    /// States, s.
    pub z: Vec<f64>,
    /// Their derivatives by the motion at each sample, s × d per sample.
    pub dz_du: Vec<f64>,
    /// Whether nothing has ever slipped.
    pub virgin: bool,
}

impl StuckState {
    /// Memory for `samples` samples of a law with d directions and s states.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(directions: usize, states: usize, samples: usize) -> Result<Self> {
        let block = directions.saturating_mul(states);
        Ok(Self {
            z: try_vec(states, 0.0, "a march over samples")?,
            dz_du: try_vec(block.saturating_mul(samples), 0.0, "a march over samples")?,
            virgin: false,
        })
    }
}

/// What a march gives at each sample j: force, states, and the derivatives of the step that led to
/// it. Blocks are row-major and follow each other.
#[derive(Clone, Debug)]
pub struct March {
    /// Directions d.
    pub directions: usize,
    /// States s.
    pub states: usize,
    /// Forces, samples × d.
    pub f: Vec<f64>,
    /// States, samples × s.
    pub z: Vec<f64>,
    /// ∂zⱼ/∂zⱼ₋₁, s × s per sample.
    pub dz_dz: Vec<f64>,
    /// ∂zⱼ/∂uⱼ₋₁, s × d per sample.
    pub dz_du_before: Vec<f64>,
    /// ∂zⱼ/∂uⱼ, s × d per sample.
    pub dz_du: Vec<f64>,
    /// ∂zⱼ/∂vⱼ₋₁, s × d per sample.
    pub dz_dv_before: Vec<f64>,
    /// ∂zⱼ/∂vⱼ, s × d per sample.
    pub dz_dv: Vec<f64>,
    /// ∂zⱼ/∂ω at given motion, velocity and zⱼ₋₁, s per sample: the time step of a law that integrates
    /// a rate is 2π/(ω·samples).
    pub dz_domega: Vec<f64>,
    /// ∂fⱼ/∂zⱼ, d × s per sample.
    pub df_dz: Vec<f64>,
    /// ∂fⱼ/∂uⱼ at given zⱼ, d × d per sample.
    pub df_du: Vec<f64>,
    /// ∂fⱼ/∂vⱼ at given zⱼ, d × d per sample.
    pub df_dv: Vec<f64>,
    /// Share of the step before each sample that is spent slipping.
    pub slip: Vec<f64>,
    /// Share of the step before each sample that is spent open.
    pub open: Vec<f64>,
    /// What the contact does at each sample; a law without states in this sense always sticks.
    pub state: Vec<State>,
    /// Memory for the law's own use, 2·d per sample.
    pub scratch: Vec<f64>,
}

impl March {
    /// Memory for `samples` samples of a law with d directions and s states.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(directions: usize, states: usize, samples: usize) -> Result<Self> {
        let memory = |size: usize| try_vec(size.saturating_mul(samples), 0.0, "a march over samples");
        let (d, s) = (directions, states);
        Ok(Self {
            directions,
            states,
            f: memory(d)?,
            z: memory(s)?,
            dz_dz: memory(s.saturating_mul(s))?,
            dz_du_before: memory(s.saturating_mul(d))?,
            dz_du: memory(s.saturating_mul(d))?,
            dz_dv_before: memory(s.saturating_mul(d))?,
            dz_dv: memory(s.saturating_mul(d))?,
            dz_domega: memory(s)?,
            df_dz: memory(d.saturating_mul(s))?,
            df_du: memory(d.saturating_mul(d))?,
            df_dv: memory(d.saturating_mul(d))?,
            slip: memory(1)?,
            open: memory(1)?,
            state: try_vec(samples, State::Stick, "a march over samples")?,
            scratch: memory(d.saturating_mul(2))?,
        })
    }

    /// Sets the first `samples` blocks to zero, and to sticking; a law then writes what is not so.
    pub fn clear(&mut self, samples: usize) {
        let (d, s) = (self.directions, self.states);
        for (values, size) in [
            (&mut self.f, d),
            (&mut self.z, s),
            (&mut self.dz_dz, s * s),
            (&mut self.dz_du_before, s * d),
            (&mut self.dz_du, s * d),
            (&mut self.dz_dv_before, s * d),
            (&mut self.dz_dv, s * d),
            (&mut self.dz_domega, s),
            (&mut self.df_dz, d * s),
            (&mut self.df_du, d * d),
            (&mut self.df_dv, d * d),
            (&mut self.slip, 1),
            (&mut self.open, 1),
        ] {
            values[..samples * size].fill(0.0);
        }
        self.state[..samples].fill(State::Stick);
    }
}
