//! A law of the host: a callback that is asked for one period at a time, or by integration in time for one
//! time.
//!
//! It sees motions and velocities in the caller's units and answers with forces and tangents. What
//! it returns is checked: a code other than 0, and numbers that are not finite, become errors that
//! keep the code, name the place, and tell whether another motion may do.

use super::law::{Form, Law, Range};
use super::pointwise::{Pointwise, Samples, automatic_samples};
use crate::error::{Error, Result, Status, fail};
use std::fmt;
use std::sync::Arc;

/// A force of the host.
pub trait UserForce: Send + Sync {
    /// Fills the forces and tangents of a call. Returns 0 when done; a number above 0 when it cannot
    /// at this motion (the solver may try a smaller step); one below 0 when it never will.
    fn evaluate(&self, call: &mut Call<'_>) -> i32;
}

/// One period, sample after sample; within a sample direction after direction. All quantities are
/// in the caller's units.
#[derive(Debug)]
pub struct Call<'a> {
    /// Angular frequency of harmonic 1.
    pub omega: f64,
    /// Equidistant times N of the period, the first at 0; integration in time asks about 1, any time.
    pub samples: usize,
    /// Relative motions d.
    pub directions: usize,
    /// Relative motions, N × d.
    pub u: &'a [f64],
    /// Their velocities du/dt, N × d; empty for a force that does not feel them.
    pub v: &'a [f64],
    /// Forces, N × d, each to be written: they are NaN before the call.
    pub f: &'a mut [f64],
    /// ∂fᵢ/∂uⱼ at the same time, N × d × d, the row i in one piece; 0 before the call.
    pub df_du: &'a mut [f64],
    /// ∂fᵢ/∂vⱼ likewise; empty for a force that does not feel the velocity.
    pub df_dv: &'a mut [f64],
}

/// A callback as a law.
#[derive(Clone)]
pub struct User {
    /// The callback.
    pub force: Arc<dyn UserForce>,
    /// Relative motions d, at least 1.
    pub directions: usize,
    /// Whether the force depends on velocities.
    pub velocity: bool,
    /// Whether f(−u, −v) = −f(u, v), on the host's word: then even harmonics may be left out.
    pub odd: bool,
    /// The solver's unit of length in the caller's; forces have the same.
    pub length: f64,
    /// Samples per period, at least; 0 takes [`automatic_samples`].
    pub samples: usize,
}

impl User {
    /// A force of `directions` relative motions and their velocities, in the caller's units.
    ///
    /// # Errors
    /// `Argument` without a direction.
    pub fn new(force: Arc<dyn UserForce>, directions: usize, samples: usize) -> Result<Self> {
        if directions == 0 {
            return fail!(Argument, "callback: directions = 0, needs at least 1");
        }
        Ok(Self {
            force,
            directions,
            velocity: true,
            odd: false,
            length: 1.0,
            samples,
        })
    }

    /// The law in units of `length` of its present unit: x = length·x̂, f = length·f̂.
    #[must_use]
    pub fn in_units(&self, length: f64) -> Self {
        Self {
            length: self.length * length,
            ..self.clone()
        }
    }

    /// Refuses numbers that are not finite, naming sample and place.
    fn check(&self, out: &Samples<'_>) -> Result<()> {
        let d = self.directions;
        if let Some(at) = out.f.iter().position(|f| !f.is_finite()) {
            return Err(not_finite(format_args!(
                "the force callback gave f[{},{}] = {}; it must write every force, finite",
                at / d,
                at % d,
                out.f[at]
            )));
        }
        for (name, values) in [("df_du", &*out.df_du), ("df_dv", &*out.df_dv)] {
            if let Some(at) = values.iter().position(|f| !f.is_finite()) {
                return Err(not_finite(format_args!(
                    "the force callback gave {name}[{},{},{}] = {}, needs a finite number",
                    at / (d * d),
                    at / d % d,
                    at % d,
                    values[at]
                )));
            }
        }
        Ok(())
    }
}

/// Another motion may do: where a trial step was too long, forces overflow.
fn not_finite(message: fmt::Arguments<'_>) -> Error {
    Error::new(Status::Callback, message).recoverable()
}

impl fmt::Debug for User {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("User")
            .field("directions", &self.directions)
            .field("velocity", &self.velocity)
            .field("odd", &self.odd)
            .field("length", &self.length)
            .field("samples", &self.samples)
            .finish_non_exhaustive()
    }
}

/// A law of which nothing is known is taken for linear at motions this many times smaller.
const FAR: f64 = 1e6;

impl Law for User {
    fn directions(&self) -> usize {
        self.directions
    }

    fn is_odd(&self) -> bool {
        self.odd
    }

    fn form(&self) -> Form<'_> {
        Form::Pointwise(self)
    }

    fn sticking_factor(&self, _ranges: &[Range], _reference: f64) -> f64 {
        FAR
    }
}

impl Pointwise for User {
    fn uses_velocity(&self) -> bool {
        self.velocity
    }

    /// A callback is always asked for a whole period.
    fn half_period_suffices(&self) -> bool {
        false
    }

    fn samples(&self, highest: usize, asked: usize) -> usize {
        match (self.samples, asked) {
            (0, 0) => automatic_samples(highest),
            (0, n) | (n, _) => n,
        }
    }

    fn evaluate(&self, omega: f64, samples: usize, u: &[f64], v: &[f64], out: Samples<'_>) -> Result<()> {
        // No host is asked about a motion that is no number; the solver sees that the force is none.
        if u.iter().chain(v).any(|x| !x.is_finite()) {
            out.f.fill(f64::NAN);
            return Ok(());
        }
        let (own_u, own_v) = out.scratch.split_at_mut(u.len());
        let own_v = &mut own_v[..v.len()];
        for (own, x) in own_u.iter_mut().zip(u).chain(own_v.iter_mut().zip(v)) {
            *own = self.length * x;
        }
        out.f.fill(f64::NAN);
        let code = self.force.evaluate(&mut Call {
            omega,
            samples,
            directions: self.directions,
            u: own_u,
            v: own_v,
            f: out.f,
            df_du: out.df_du,
            df_dv: out.df_dv,
        });
        if code != 0 {
            let verdict = if code > 0 {
                "it cannot at this motion"
            } else {
                "it gives up"
            };
            return Err(Error::from_callback(
                code,
                format_args!("the force callback returned {code}: {verdict}"),
            ));
        }
        self.check(&out)?;
        for f in out.f {
            *f /= self.length;
        }
        Ok(())
    }
}
