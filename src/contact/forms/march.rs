//! Data of a march: forces, states and derivatives of a law with states at equidistant samples of a period.

use crate::error::{Result, try_vec};

/// Results of a march at each sample j: force, states, and the derivatives of the step that led to
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
    /// Derivatives of the states at the end of a step.
    pub dz: StateDerivatives,
    /// ∂fⱼ/∂zⱼ, d × s per sample.
    pub df_dz: Vec<f64>,
    /// ∂fⱼ/∂uⱼ at given zⱼ, d × d per sample.
    pub df_du: Vec<f64>,
    /// ∂fⱼ/∂vⱼ at given zⱼ, d × d per sample.
    pub df_dv: Vec<f64>,
    /// Memory for the law's own use, 2·d per sample.
    pub scratch: Vec<f64>,
}

/// Derivatives of the states at the end of a step.
#[derive(Clone, Debug)]
pub struct StateDerivatives {
    /// ∂zⱼ/∂zⱼ₋₁, s × s per sample.
    pub z: Vec<f64>,
    /// ∂zⱼ/∂uⱼ₋₁, s × d per sample.
    pub u_before: Vec<f64>,
    /// ∂zⱼ/∂uⱼ, s × d per sample.
    pub u: Vec<f64>,
    /// ∂zⱼ/∂vⱼ₋₁, s × d per sample.
    pub v_before: Vec<f64>,
    /// ∂zⱼ/∂vⱼ, s × d per sample.
    pub v: Vec<f64>,
    /// ∂zⱼ/∂ω at given motion, velocity and zⱼ₋₁, s per sample: the time step of a law that integrates
    /// a rate is 2π/(ω·samples).
    pub omega: Vec<f64>,
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
            dz: StateDerivatives {
                z: memory(s.saturating_mul(s))?,
                u_before: memory(s.saturating_mul(d))?,
                u: memory(s.saturating_mul(d))?,
                v_before: memory(s.saturating_mul(d))?,
                v: memory(s.saturating_mul(d))?,
                omega: memory(s)?,
            },
            df_dz: memory(d.saturating_mul(s))?,
            df_du: memory(d.saturating_mul(d))?,
            df_dv: memory(d.saturating_mul(d))?,
            scratch: memory(d.saturating_mul(2))?,
        })
    }

    /// Sets the first `samples` blocks to zero; a law then writes the entries that differ.
    pub fn clear(&mut self, samples: usize) {
        let (d, s) = (self.directions, self.states);
        for (values, size) in [
            (&mut self.f, d),
            (&mut self.z, s),
            (&mut self.dz.z, s * s),
            (&mut self.dz.u_before, s * d),
            (&mut self.dz.u, s * d),
            (&mut self.dz.v_before, s * d),
            (&mut self.dz.v, s * d),
            (&mut self.dz.omega, s),
            (&mut self.df_dz, d * s),
            (&mut self.df_du, d * d),
            (&mut self.df_dv, d * d),
        ] {
            values[..samples * size].fill(0.0);
        }
    }
}
