//! The traits of contact laws: the questions of a model, of a solver and of an integration in time.
//!
//! A [`ContactLaw`] is a law as the caller describes it, with its constants; it tells its role in a model and
//! makes the [`Law`] that a solver evaluates, in the solver's units. A law maps the motion of its relative
//! coordinates to its force. How Fourier coefficients and Jacobian follow is the same for all laws of a
//! [`Form`] and lives in [`crate::aft`], which knows no law by name. In time a law is an [`EventLaw`], linear
//! between events, or smooth.

use crate::contact::forms::constants::{Constant, Role};
use crate::contact::forms::contact_state::State;
use crate::contact::forms::coupled_search::CoupledSearch;
use crate::contact::forms::force_derivative::ForceDerivative;
use crate::contact::forms::linearisation::Range;
use crate::contact::forms::march::March;
use crate::contact::forms::onset::Onset;
use crate::contact::forms::piece::{CoupledPiece, Piece};
use crate::contact::forms::plane_path::PlanePath;
use crate::contact::forms::samples::Samples;
use crate::contact::forms::time_piece::{Instant, Mode, TimePiece, Zeros};
use crate::error::Result;
use crate::fourier::{Extremum, HarmonicSet};
use crate::interrupt::Interrupt;
use core::fmt::Debug;
use num_complex::Complex64;
use std::sync::Arc;

/// A relative motion over harmonics, at an angular frequency.
#[derive(Clone, Copy)]
pub struct PackedMotion<'a> {
    /// Carried harmonics.
    pub set: &'a HarmonicSet,
    /// Packed coefficients of the motion.
    pub motion: &'a [f64],
    /// Angular frequency ω of the response.
    pub omega: f64,
}

/// A law as the caller describes it, its constants in the caller's units.
pub trait ContactLaw {
    /// Name of a contact of this law in messages, "cubic spring".
    fn name(&self) -> &'static str;

    /// Checks between the constants, beyond signs and unused ones.
    ///
    /// # Errors
    /// `NotFinite` or `Argument`, naming the constant, its value and its range.
    fn check(&self) -> Result<()> {
        Ok(())
    }

    /// Checks that the law has a force at some motion, if its stiffness is the reason why not.
    ///
    /// # Errors
    /// `Argument`, naming the constant.
    fn check_stiffness(&self) -> Result<()> {
        Ok(())
    }

    /// Directions (t1, t2, n as 0, 1, 2) in which the law acts, in the order of its motions.
    fn places(&self) -> &'static [usize] {
        &[0]
    }

    /// Number of motions of a law that may act over a list of degrees of freedom; `None` for others.
    fn motions(&self) -> Option<usize> {
        None
    }

    /// Role that the constants give the contact.
    fn role(&self) -> Role {
        Role::Active
    }

    /// Stiffness of the force in the k-th direction by the l-th motion at small motion; 0 where it is open at
    /// rest or unknown.
    fn stiffness_at_small_motion(&self, k: usize, l: usize) -> f64;

    /// Largest stiffness along the k-th motion, but for terms that grow with the motion.
    fn stiffness(&self, k: usize) -> f64;

    /// Largest change of the force by the relative velocity, N s/m; 0 for a law of the motion alone or of the caller.
    fn resistance(&self) -> f64 {
        0.0
    }

    /// Whether the stiffness may grow beyond [`Self::stiffness`], or that be zero.
    fn is_spring(&self) -> bool {
        true
    }

    /// A bound of the force in each direction over all motions; infinite where there is none.
    fn largest_force(&self) -> f64 {
        f64::INFINITY
    }

    /// Whether the force is homogeneous of degree 1 in motion and normal load, as for friction with a stick stiffness;
    /// if not, it is proportional to the load.
    fn load_scales_motion(&self) -> bool {
        true
    }

    /// The derivative of the force by a constant of the law; `None` for a constant that it does not have.
    fn by_constant(&self, constant: Constant) -> Option<ForceDerivative> {
        let _ = constant;
        None
    }

    /// Whether a constant may be infinite: a normal load under which the contact sticks for ever, or a stick stiffness of rigid Coulomb
    /// friction.
    fn may_be_infinite(&self, constant: Constant) -> bool {
        let _ = constant;
        false
    }

    /// Whether the constants make sense per unit of area.
    fn is_per_area(&self) -> bool {
        true
    }

    /// Whether the contact loads the structure without vibration.
    fn is_preloaded(&self) -> bool {
        false
    }

    /// Normal load at the relative motion y along the normal; 0 without normal load.
    fn normal_load(&self, y: f64) -> f64 {
        let _ = y;
        0.0
    }

    /// The law, with lengths in units of `length` and forces in units of `length` times the caller's
    /// stiffness.
    ///
    /// # Errors
    /// Those of the constants.
    fn law(&self, length: f64) -> Result<Arc<dyn Law>>;

    /// The same force over the exchanged motion of [`crate::condense::blocks::exchange`] with its stiffness; `None` where the law is
    /// no slider under a constant load. `late`: over the force on the mass at the contact, where the
    /// stick rings at the angular frequency 1/`late`, over the base of the harmonics; else over the rate.
    fn exchanged(&self, (stiffness, late): (f64, Option<f64>), length: f64) -> Option<Arc<dyn Law>> {
        let _ = (stiffness, late, length);
        None
    }

    /// The law of an active contact in an integration in time, in the caller's units.
    ///
    /// # Errors
    /// `Unsupported` for laws that cannot be integrated in time.
    fn in_time(&self) -> Result<LawInTime>;
}

/// The law of a contact.
pub trait Law: Debug + Send + Sync {
    /// Number of relative coordinates on which it acts.
    fn directions(&self) -> usize {
        1
    }

    /// Whether f(−x) = −f(x).
    fn is_odd(&self) -> bool;

    /// The way in which the law is evaluated.
    fn form(&self) -> Form<'_>;

    /// The factor s from which on s·f(x/s) is (nearly) linear, for motions of the given ranges: friction
    /// sticks, a polynomial term is small against the stiffness `reference`.
    fn linearisation_scale(&self, ranges: &[Range], reference: f64) -> f64;

    /// Factors of a vibration in the fundamental, one amplitude per direction, about the static motion `rest` at which
    /// the law slips, opens or ceases to be linear; as of a slider that was loaded slowly.
    fn onset(&self, rest: &[f64], motion: &[Complex64]) -> Onset {
        let _ = (rest, motion);
        Onset::SMOOTH
    }

    /// Whether [`Self::linearisation_scale`] is known for any motion; else it is a guess from the size of
    /// the motions that matter.
    fn has_known_linear_range(&self) -> bool {
        true
    }
}

/// The forms of laws.
pub enum Form<'a> {
    /// Intervals on which the force is affine in the one relative motion: exact.
    PiecewiseLinear(&'a dyn PiecewiseLinear),
    /// A spectrum of the stiffness on one relative motion: exact.
    Spectral(&'a dyn Spectral),
    /// Friction in one direction under a normal load that varies: exact.
    VaryingNormalLoad(&'a dyn VaryingNormalLoad),
    /// Friction in a plane, whose force turns in slip: exact.
    PlaneFriction(&'a dyn PlaneFriction),
    /// Force, states and the derivatives of their steps, marched over equidistant times.
    Hysteretic(&'a dyn Hysteretic),
    /// Force and tangents at equidistant times, without memory.
    Memoryless(&'a dyn Memoryless),
}

/// A law on one relative motion whose force is affine in it between events.
pub trait PiecewiseLinear {
    /// Exact pieces over one turn (half a turn for sets of odd harmonics) from the turning points of the
    /// motion.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    fn pieces(
        &self,
        set: &HarmonicSet,
        motion: &[f64],
        turning_points: &[Extremum],
        pieces: &mut Vec<Piece>,
        interrupt: &Interrupt<'_>,
    ) -> Result<()>;

    /// Pieces in sample numbers over one turn from equidistant samples of the motion.
    fn sampled_pieces(&self, samples: &[f64], pieces: &mut Vec<Piece>);

    /// A bound of the number of pieces for motions up to the reduced harmonic `highest`, whose derivative
    /// has at most 2·highest roots per turn.
    fn most_pieces(&self, highest: usize) -> usize {
        4 * highest + 8
    }

    /// [`Self::pieces`] at an angular frequency, of a law whose force depends on it.
    ///
    /// # Errors
    /// Those of [`Self::pieces`].
    fn pieces_at(
        &self,
        PackedMotion { set, motion, .. }: PackedMotion<'_>,
        turning_points: &[Extremum],
        pieces: &mut Vec<Piece>,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        self.pieces(set, motion, turning_points, pieces, interrupt)
    }

    /// State of the contact on a piece of it.
    fn state(&self, piece: &Piece) -> State;

    /// The ends of slips that move with the motion, see `SlidingEnds`; `None` for a law whose force is continuous.
    fn sliding_ends(&self) -> Option<&dyn SlidingEnds> {
        None
    }

    /// Force and state at the motion x of a law without memory; `None` for one with memory, whose
    /// force follows from its pieces.
    fn at(&self, x: f64) -> Option<(f64, State)>;
}

/// A slider whose slips end where the momentum ∫ (x − f/α) dτ from their begin on is used up. Where slip reverses, the anchor of the
/// piece is the time at which that is so, and its end that at which the force follows, after a delay.
pub trait SlidingEnds {
    /// α
    fn stiffness(&self) -> f64;

    /// Fills the pieces as [`PiecewiseLinear::pieces_at`] does, and returns the time by which their half turn does not repeat itself.
    ///
    /// # Errors
    /// Those of [`PiecewiseLinear::pieces`].
    fn follow(
        &self,
        at: PackedMotion<'_>,
        turning_points: &[Extremum],
        pieces: &mut Vec<Piece>,
        interrupt: &Interrupt<'_>,
    ) -> Result<f64>;

    /// Delay of the force over ω, where a slip ends with the motion −r times that at which slip begins, and its derivative by r.
    fn delay(&self, r: f64) -> [f64; 2];
}

/// A law without events on one relative motion: linear·x plus a term that is homogeneous in x, f(s·x) =
/// s^degree·f(x) for s > 0.
pub trait Spectral {
    /// Fills Sₙ = (1/2π)∫ s(x(τ)) e^{−inτ} dτ, n ≥ 0, of the tangent stiffness s of the homogeneous term.
    fn spectrum(&self, set: &HarmonicSet, motion: &[f64], spectrum: &mut [Complex64]);

    /// Stiffness of the linear term.
    fn linear(&self) -> f64;

    /// Degree of the other term.
    fn degree(&self) -> f64;

    /// Force at the motion x.
    fn at(&self, x: f64) -> f64;
}

/// A law on a tangential motion x and a normal motion y, in this order: friction under a normal load that
/// follows from y alone.
pub trait VaryingNormalLoad {
    /// Exact pieces of the normal force (slope −∂N/∂y) and of the tangential force over one turn. `motion` is
    /// the packed x, then the packed y. The tangential pieces begin anywhere in the turn and follow each
    /// other without a gap; without friction there are none.
    fn coupled_pieces(
        &self,
        set: &HarmonicSet,
        motion: &[f64],
        search: &mut CoupledSearch,
        normal: &mut Vec<Piece>,
        tangential: &mut Vec<CoupledPiece>,
        interrupt: &Interrupt<'_>,
    ) -> Result<()>;

    /// n₀ − kn·y: the normal load where it is positive; the contact is open where it is not.
    fn load_at(&self, y: f64) -> f64;
}

/// A law on two tangential motions and, if its load varies, a normal one: friction in a plane, with the spring kt of a
/// slider and the limit a + b·y of the tangential force.
pub trait PlaneFriction: Law {
    /// Finds the path of the tangential force over one turn of a packed motion. `normal` has the pieces of the normal
    /// force, none under a constant load.
    ///
    /// # Errors
    /// `NoConvergence` for a motion whose path cannot be followed; `StoppedByCaller`.
    fn path(&self, motion: &[f64], normal: &[Piece], path: &mut PlanePath, interrupt: &Interrupt<'_>) -> Result<()>;

    /// kt
    fn stiffness(&self) -> f64;

    /// Places of the slider before any motion.
    fn slider(&self) -> [f64; 2];

    /// a and b
    fn limit(&self) -> [f64; 2];

    /// The normal force, where the load varies.
    fn normal(&self) -> Option<&dyn VaryingNormalLoad>;
}

/// A law with internal states over d directions, stepped from sample to sample of a period. Where nothing
/// moves and nothing has moved before, the states are zero.
pub trait Hysteretic: Law {
    /// Number s of states.
    fn states(&self) -> usize;

    /// Whether the law depends on velocities; if not, they need not be given.
    fn uses_velocity(&self) -> bool;

    /// Samples per period for motions up to the reduced harmonic `highest`, where the caller requested
    /// `requested`, or with 0 the number that suits the law.
    fn samples(&self, highest: usize, requested: usize) -> usize;

    /// Marches once over `samples` equidistant times of the period 2π/`omega` and writes every entry
    /// of the first `samples` blocks of `out`.
    ///
    /// `u` and `v` hold the relative motions and their velocities, samples × d row-major; `v` is empty
    /// unless [`Self::uses_velocity`]. `z0` are the states before sample 0: those of the last
    /// sample of the period before, whose motion is that of the last sample.
    ///
    /// # Errors
    /// Those of the law.
    fn march(&self, omega: f64, samples: usize, u: &[f64], v: &[f64], z0: &[f64], out: &mut March) -> Result<()>;
}

/// A law f(u, v) of d relative motions u and their velocities v = du/dt at the same time. All quantities are in
/// the solver's units.
pub trait Memoryless: Law {
    /// Whether the force depends on v; if not, v and df_dv are empty.
    fn uses_velocity(&self) -> bool;

    /// Whether the law may be evaluated over half a period where motion and law are odd, so that the
    /// other half repeats the first with opposite sign.
    fn half_period_suffices(&self) -> bool {
        self.is_odd()
    }

    /// Samples per period that motions up to the reduced harmonic `highest` need; a fast transform may
    /// take a few more.
    fn samples(&self, highest: usize, requested: usize) -> usize;

    /// Whether these samples give the harmonics of the force without any error.
    fn is_alias_free(&self) -> bool {
        false
    }

    /// Force and tangents at given times, `samples` of them, for u and v that are stored like the
    /// force.
    ///
    /// # Errors
    /// Those of a callback.
    fn evaluate(&self, omega: f64, samples: usize, u: &[f64], v: &[f64], out: Samples<'_>) -> Result<()>;
}

/// The law of an active contact in time.
pub struct LawInTime {
    /// Stiffness of a linear part along the first motion.
    pub stiffness: f64,
    /// The first of the contact's motions on which the other part acts; the later ones follow.
    pub first: usize,
    /// The other part.
    pub part: TimePart,
}

/// A law in time, apart from a linear spring.
#[derive(Clone, Debug)]
pub enum TimePart {
    /// Linear between events.
    Events(Arc<dyn EventLaw>),
    /// Smooth, of the form [`Form::Memoryless`].
    Smooth(Arc<dyn Law>),
}

impl LawInTime {
    /// A law with events from its first motion on.
    pub fn events(law: impl EventLaw + 'static) -> Self {
        Self {
            stiffness: 0.0,
            first: 0,
            part: TimePart::Events(Arc::new(law)),
        }
    }

    /// A smooth law of the form [`Form::Memoryless`].
    pub fn smooth(law: Arc<dyn Law>) -> Self {
        Self {
            stiffness: 0.0,
            first: 0,
            part: TimePart::Smooth(law),
        }
    }
}

/// A law in time that is linear between events, on the motions x and, for friction under a load that varies,
/// y. Friction remembers the stretch e of its spring from the slider.
pub trait EventLaw: Debug + Send + Sync {
    /// The mode at a state, whose stretch comes within its range; then the mode, if any, in which the slider's
    /// place follows from the motion alone.
    fn begin(&self, at: &Instant, e: &mut f64) -> (Mode, Option<Mode>);

    /// The forces in a mode from a motion on, the spring of the slider stretched by e.
    fn piece(&self, mode: Mode, motion: [f64; 2], e: f64) -> TimePiece;

    /// Number of margins in a mode.
    fn margins(&self, mode: Mode) -> usize;

    /// Writes the polynomial of a margin, which is positive as long as the piece lasts, from those of the
    /// relative motions, all of one length.
    fn margin(&self, mode: Mode, which: usize, e: f64, x: &[f64], y: &[f64], margin: &mut [f64]);

    /// The mode after margin `which` has fallen to zero, and the zeros of the new margins.
    fn leave(&self, mode: Mode, which: usize, at: &Instant, e: &mut f64) -> (Mode, Zeros);

    /// The slider of a law with memory, part of the state.
    fn slider(&self) -> Option<&dyn SliderLaw> {
        None
    }
}

/// A slider in time, the memory of friction.
pub trait SliderLaw {
    /// The slider's place before any motion.
    fn start(&self) -> f64;

    /// The slider after any motion that ends at x and y, from w: the play operator.
    fn drag(&self, motion: [f64; 2], w: f64) -> f64;

    /// The stretch after x has grown by `growth` to where y is, within a piece.
    fn stretch(&self, mode: Mode, growth: f64, y: f64, e: &mut f64);

    /// The a of δw = δx + a·δy at the end of a mode in which the slider moves; `after`: the next mode.
    fn follows(&self, mode: Mode, after: Mode, rate: [f64; 2]) -> f64;
}
