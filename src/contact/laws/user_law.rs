//! A law of the caller: a callback that evaluates one period at a time, or one time for an integration in
//! time.
//!
//! A force without memory is evaluated sample by sample; one with internal states is marched over them, and
//! returns the derivatives of its steps as well. It receives motions and velocities in the caller's units
//! and returns forces and tangents. Its results are checked: a code other than 0, and numbers
//! that are not finite, become errors that keep the code, name the place, and are recoverable where another
//! motion may succeed.

mod user_states;

use crate::byte_stream::ByteWriter;
use crate::contact::forms::constants::LawData;
use crate::contact::forms::law::{ContactLaw, Form, Law, LawInTime, Memoryless};
use crate::contact::forms::linearisation::Range;
use crate::contact::forms::samples::{Samples, automatic_samples};
use crate::error::{Error, Result, Status, fail};
use std::fmt;
use std::sync::Arc;

/// A force of the caller.
pub trait UserForce: Send + Sync {
    /// Fills the forces and tangents of a call, and the states and derivatives of its steps where it has
    /// any. The same motion must always have the same force. Returns 0 when done; a number above 0 when it cannot
    /// at this motion (the solver may try a smaller step); one below 0 when it never will.
    fn evaluate(&self, call: &mut Call<'_>) -> i32;

    /// A number that tells this force from others; 0, which all have by default, tells nothing.
    #[doc(hidden)]
    fn identity(&self) -> u64 {
        0
    }
}

/// One period, sample after sample; within a sample direction after direction. All quantities are
/// in the caller's units.
#[derive(Debug)]
pub struct Call<'a> {
    /// Angular frequency of the period 2π/omega: the times are 2π/(omega·N) apart. A force may need it
    /// as the time step of its states, in no other way.
    pub omega: f64,
    /// Equidistant times N of the period, the first at 0. With states it may be 2; integration in time
    /// asks about 1, any time.
    pub samples: usize,
    /// Relative motions d.
    pub directions: usize,
    /// Relative motions, N × d.
    pub u: &'a [f64],
    /// Their velocities du/dt, N × d; empty for a force without velocities.
    pub v: &'a [f64],
    /// Forces, N × d, each to be written: they are NaN before the call.
    pub f: &'a mut [f64],
    /// ∂fᵢ/∂uⱼ at the same time and given states, N × d × d, the row i in one piece; 0 before the call.
    pub df_du: &'a mut [f64],
    /// ∂fᵢ/∂vⱼ likewise; empty for a force without velocities.
    pub df_dv: &'a mut [f64],
    /// Data of the internal states; empty without them.
    pub states: States<'a>,
}

/// The internal states of one period, zⱼ = Z(zⱼ₋₁, motion at j − 1 and j), sample after sample. Before
/// the first sample lies the last, with its motion.
#[derive(Debug, Default)]
pub struct States<'a> {
    /// Number of states s. Where nothing moves and nothing has moved before, they are zero. Their units
    /// are the caller's; their sizes should be alike, for they count as periodic together.
    pub count: usize,
    /// States before the first sample, s.
    pub z0: &'a [f64],
    /// States at each sample, N × s, each to be written: they are NaN before the call.
    pub z: &'a mut [f64],
    /// ∂zⱼ/∂zⱼ₋₁, N × s × s, rows in one piece; like all that follow 0 before the call.
    pub dz_dz: &'a mut [f64],
    /// ∂zⱼ/∂uⱼ₋₁, N × s × d.
    pub dz_du_before: &'a mut [f64],
    /// ∂zⱼ/∂uⱼ, N × s × d.
    pub dz_du: &'a mut [f64],
    /// ∂zⱼ/∂vⱼ₋₁, N × s × d; empty for a force without velocities.
    pub dz_dv_before: &'a mut [f64],
    /// ∂zⱼ/∂vⱼ, likewise.
    pub dz_dv: &'a mut [f64],
    /// ∂zⱼ/∂omega, N × s, where the time step enters.
    pub dz_domega: &'a mut [f64],
    /// ∂fⱼ/∂zⱼ, N × d × s.
    pub df_dz: &'a mut [f64],
}

/// A callback as a law.
#[derive(Clone)]
pub struct User {
    /// The callback.
    pub force: Arc<dyn UserForce>,
    /// Relative motions d, at least 1.
    pub directions: usize,
    /// Internal states s, 0 for a force without memory.
    pub states: usize,
    /// Whether the force depends on velocities.
    pub velocity: bool,
    /// Whether f(−u, −v) = −f(u, v), as the caller states: then even harmonics may be left out.
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
            states: 0,
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

    /// The motions `own` in the caller's units, from those of the solver. The callback is never called with a
    /// motion that is not a number.
    pub(crate) fn take_motion(&self, u: &[f64], v: &[f64], own: &mut [f64]) -> Result<()> {
        for (own, x) in own.iter_mut().zip(u.iter().chain(v)) {
            *own = self.length * x;
            if !own.is_finite() {
                let message = format_args!("a motion of the force callback is {own}, needs a finite number");
                return Err(Error::new(Status::NotFinite, message).recoverable());
            }
        }
        Ok(())
    }

    /// Calls the caller and checks its code.
    pub(crate) fn ask(&self, call: &mut Call<'_>) -> Result<()> {
        let code = self.force.evaluate(call);
        if code == 0 {
            return Ok(());
        }
        let verdict = if code > 0 {
            "it cannot at this motion"
        } else {
            "it gives up"
        };
        let message = format_args!("the force callback returned {code}: {verdict}");
        Err(Error::from_callback(code, message))
    }

    /// Converts the forces to the solver's units.
    pub(crate) fn take_forces(&self, f: &mut [f64]) -> Result<()> {
        check_filled("f", f, self.directions)?;
        for f in &mut *f {
            *f /= self.length;
        }
        check_filled("f", f, self.directions)
    }

    /// Samples per period: those of this force alone, else those requested of all, else `automatic`.
    pub(crate) fn samples_for(&self, requested: usize, automatic: usize) -> usize {
        match (self.samples, requested) {
            (0, 0) => automatic,
            (0, n) | (n, _) => n,
        }
    }
}

/// Refuses values, `width` per sample, that the caller had to write and that are not finite. Another motion
/// may do: where a trial step was too long, forces overflow.
pub(crate) fn check_filled(name: &str, values: &[f64], width: usize) -> Result<()> {
    let Some(at) = values.iter().position(|x| !x.is_finite()) else {
        return Ok(());
    };
    let message = format_args!(
        "the force callback gave {name}[{},{}] = {}; it must write every one, finite",
        at / width,
        at % width,
        values[at]
    );
    Err(Error::new(Status::Callback, message).recoverable())
}

/// Refuses derivatives, blocks of some `rows` and `columns` per sample, that are not finite.
pub(crate) fn check_block(name: &str, values: &[f64], (rows, columns): (usize, usize)) -> Result<()> {
    let Some(at) = values.iter().position(|x| !x.is_finite()) else {
        return Ok(());
    };
    let message = format_args!(
        "the force callback gave {name}[{},{},{}] = {}, needs a finite number",
        at / (rows * columns),
        at / columns % rows,
        at % columns,
        values[at]
    );
    Err(Error::new(Status::Callback, message).recoverable())
}

impl LawData for User {
    fn number(&self) -> u8 {
        8
    }

    fn save_to(&self, _out: &mut ByteWriter<'_>) -> Result<()> {
        fail!(
            Unsupported,
            "a force of the caller is a function of its program, which cannot be saved"
        )
    }

    /// Writes what is known of the force.
    fn digest_to(&self, out: &mut ByteWriter<'_>) {
        for count in [self.directions, self.states, self.samples] {
            out.count(count);
        }
        out.bool(self.velocity);
        out.bool(self.odd);
        out.bytes(&self.force.identity().to_le_bytes());
    }
}

impl fmt::Debug for User {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("User")
            .field("directions", &self.directions)
            .field("states", &self.states)
            .field("velocity", &self.velocity)
            .field("odd", &self.odd)
            .field("length", &self.length)
            .field("samples", &self.samples)
            .finish_non_exhaustive()
    }
}

/// A law of unknown form counts as linear at motions this many times smaller.
/// Kind: tuned; measured on: not recorded.
const USER_LAW_FAR: f64 = 1e6;

impl ContactLaw for User {
    fn name(&self) -> &'static str {
        "law of the caller"
    }

    fn motions(&self) -> Option<usize> {
        Some(self.directions)
    }

    /// Not known: the callback is not called.
    fn stiffness_at_small_motion(&self, _k: usize, _l: usize) -> f64 {
        0.0
    }

    fn stiffness(&self, _k: usize) -> f64 {
        0.0
    }

    fn is_per_area(&self) -> bool {
        false
    }

    fn law(&self, length: f64) -> Result<Arc<dyn Law>> {
        Ok(Arc::new(self.in_units(length)))
    }

    fn in_time(&self) -> Result<LawInTime> {
        if self.states > 0 {
            return fail!(Unsupported, "a law of the caller with states is not integrated in time");
        }
        Ok(LawInTime::smooth(self.law(1.0)?))
    }
}

impl Law for User {
    fn directions(&self) -> usize {
        self.directions
    }

    fn is_odd(&self) -> bool {
        self.odd
    }

    fn form(&self) -> Form<'_> {
        if self.states == 0 {
            Form::Memoryless(self)
        } else {
            Form::Hysteretic(self)
        }
    }

    fn linearisation_scale(&self, _ranges: &[Range], _reference: f64) -> f64 {
        USER_LAW_FAR
    }

    fn has_known_linear_range(&self) -> bool {
        false
    }
}

impl Memoryless for User {
    fn uses_velocity(&self) -> bool {
        self.velocity
    }

    /// A callback always evaluates a whole period.
    fn half_period_suffices(&self) -> bool {
        false
    }

    fn samples(&self, highest: usize, requested: usize) -> usize {
        self.samples_for(requested, automatic_samples(highest))
    }

    fn evaluate(&self, omega: f64, samples: usize, u: &[f64], v: &[f64], out: Samples<'_>) -> Result<()> {
        self.take_motion(u, v, out.scratch)?;
        let (own_u, own_v) = out.scratch.split_at_mut(u.len());
        out.f.fill(f64::NAN);
        self.ask(&mut Call {
            omega,
            samples,
            directions: self.directions,
            u: own_u,
            v: &own_v[..v.len()],
            f: &mut *out.f,
            df_du: &mut *out.df_du,
            df_dv: &mut *out.df_dv,
            states: States::default(),
        })?;
        let d = self.directions;
        check_block("df_du", out.df_du, (d, d))?;
        check_block("df_dv", out.df_dv, (d, d))?;
        self.take_forces(out.f)
    }
}
