//! Laws of the caller for random models: one without memory, one with a state.

use hbvib::{Call, UserForce};

/// A softening spring with a drag that grows with the square of the speed:
/// f = k·a·asinh(u/a) + c·v·√(1 + (v/v₀)²).
pub struct Drag {
    pub stiffness: f64,
    pub length: f64,
    pub damping: f64,
    pub speed: f64,
}

impl UserForce for Drag {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        let (k, a, c) = (self.stiffness, self.length, self.damping);
        for j in 0..call.samples {
            let (u, v) = (call.u[j] / a, call.v[j] / self.speed);
            let root = (1.0 + v * v).sqrt();
            call.f[j] = k * a * u.asinh() + c * call.v[j] * root;
            call.df_du[j] = k / (1.0 + u * u).sqrt();
            call.df_dv[j] = c * (root + v * v / root);
        }
        0
    }
}

/// Friction with a force that follows the path u (Dahl): dz/du = 1 − sign(u̇) z/a, f = k·z, by the trapezoidal rule.
pub struct Dahl {
    pub stiffness: f64,
    /// Limit of the state.
    pub length: f64,
}

impl UserForce for Dahl {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        let mut z = call.states.z0[0];
        let mut before = call.u[call.samples - 1];
        for j in 0..call.samples {
            let du = call.u[j] - before;
            let half = 0.5 * du.abs() / self.length;
            let next = (z * (1.0 - half) + du) / (1.0 + half);
            let slope = (1.0 - du.signum() * 0.5 * (z + next) / self.length) / (1.0 + half);
            call.states.dz_dz[j] = (1.0 - half) / (1.0 + half);
            call.states.dz_du[j] = slope;
            call.states.dz_du_before[j] = -slope;
            call.states.df_dz[j] = self.stiffness;
            call.states.z[j] = next;
            call.f[j] = self.stiffness * next;
            (z, before) = (next, call.u[j]);
        }
        0
    }
}
