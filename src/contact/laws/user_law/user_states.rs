//! A law of the caller with internal states: one callback per march.
//!
//! States have the caller's units. Motions x = L·x̂ and forces f = L·f̂ change their unit by the
//! same length L, so that ∂f/∂u and ∂f/∂v stay, ∂z/∂û = L·∂z/∂u, and ∂f̂/∂z = ∂f/∂z / L.

use crate::contact::forms::law::Hysteretic;
use crate::contact::forms::march::March;
use crate::contact::forms::samples::automatic_samples;
use crate::contact::laws::user_law::{Call, States, User, check_block, check_filled};
use crate::error::Result;

/// Finer sampling than a law without memory gets: steps of states are of second order at best.
/// Kind: tuned; measured on: not recorded.
const USER_STATES_REFINEMENT: usize = 4;

impl Hysteretic for User {
    fn states(&self) -> usize {
        self.states
    }

    fn uses_velocity(&self) -> bool {
        self.velocity
    }

    fn samples(&self, highest: usize, requested: usize) -> usize {
        self.samples_for(
            requested,
            automatic_samples(highest).saturating_mul(USER_STATES_REFINEMENT),
        )
    }

    fn march(&self, omega: f64, samples: usize, u: &[f64], v: &[f64], z0: &[f64], out: &mut March) -> Result<()> {
        let (n, d, s) = (samples, self.directions, self.states);
        let (u, v) = (&u[..n * d], &v[..if self.velocity { n * d } else { 0 }]);
        self.take_motion(u, v, &mut out.scratch)?;
        out.clear(n);
        let felt = v.len() * s;
        let (f, z) = (&mut out.f[..n * d], &mut out.z[..n * s]);
        f.fill(f64::NAN);
        z.fill(f64::NAN);
        let (own_u, own_v) = out.scratch.split_at(n * d);
        let mut call = Call {
            omega,
            samples,
            directions: d,
            u: own_u,
            v: &own_v[..v.len()],
            f,
            df_du: &mut out.df_du[..n * d * d],
            df_dv: &mut out.df_dv[..v.len() * d],
            states: States {
                count: s,
                z0,
                z,
                dz_dz: &mut out.dz.z[..n * s * s],
                dz_du_before: &mut out.dz.u_before[..n * s * d],
                dz_du: &mut out.dz.u[..n * s * d],
                dz_dv_before: &mut out.dz.v_before[..felt],
                dz_dv: &mut out.dz.v[..felt],
                dz_domega: &mut out.dz.omega[..n * s],
                df_dz: &mut out.df_dz[..n * d * s],
            },
        };
        self.ask(&mut call)?;
        let states = call.states;
        check_filled("z", states.z, s)?;
        check_filled("dz_domega", states.dz_domega, s)?;
        for (name, values, size) in [
            ("df_du", &*call.df_du, (d, d)),
            ("df_dv", &*call.df_dv, (d, d)),
            ("dz_dz", &*states.dz_dz, (s, s)),
            ("dz_du_before", &*states.dz_du_before, (s, d)),
            ("dz_du", &*states.dz_du, (s, d)),
            ("dz_dv_before", &*states.dz_dv_before, (s, d)),
            ("dz_dv", &*states.dz_dv, (s, d)),
            ("df_dz", &*states.df_dz, (d, s)),
        ] {
            check_block(name, values, size)?;
        }
        for by_motion in [states.dz_du_before, states.dz_du, states.dz_dv_before, states.dz_dv] {
            for entry in by_motion {
                *entry *= self.length;
            }
        }
        for entry in states.df_dz {
            *entry /= self.length;
        }
        self.take_forces(call.f)
    }
}
