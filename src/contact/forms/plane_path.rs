//! The path of the force of friction in a plane over one turn: pieces of stick, slip and opening.
//!
//! Tangential motions enter as the force of the spring without slider, u = kt·x, and the normal motion as the limit R = μN, so that
//! a path needs no other constants. In stick the force is affine in the motion. In slip it has the size R and turns by a differential
//! equation; a piece of slip holds its direction at the nodes of a collocation, [`crate::contact::forms::radau`].

use crate::contact::forms::contact_state::State;
use crate::contact::forms::radau::{RADAU_STAGES, RadauTables};
use crate::error::{Error, Result, try_vec};
use crate::fourier::HarmonicSet;
use crate::linalg::factors::lu::Lu;
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};

pub(crate) const CONTEXT: &str = "the path of a friction force";

/// Panels per turn and reduced harmonic: a force that turns in slip, times the highest harmonic, is integrated to
/// about 1e-11 over such panels.
/// Kind: tuned; measured on: not recorded.
const PANELS_PER_HARMONIC: f64 = 1.6;

/// Motion and limit at one time, with their derivatives by τ.
#[derive(Clone, Copy, Debug, Default)]
pub struct PlaneInstant {
    /// kt·x
    pub pull: [f64; 2],
    /// Its derivative.
    pub rate: [f64; 2],
    /// μN, negative where the sides are apart.
    pub limit: f64,
    /// Its derivative.
    pub limit_rate: f64,
}

/// Packed signals kt·x₁, kt·x₂ and R.
#[derive(Clone, Debug)]
pub struct PlaneMotion {
    set: HarmonicSet,
    signals: Vec<f64>,
}

impl PlaneMotion {
    /// The harmonics of the signals.
    pub fn set(&self) -> &HarmonicSet {
        &self.set
    }

    /// The i-th packed signal.
    pub fn signal(&self, i: usize) -> &[f64] {
        let m = self.set.packed_len();
        &self.signals[i * m..(i + 1) * m]
    }

    /// Motion and limit at τ. A constant limit stands in front of the signals where the mean is not carried.
    #[must_use]
    pub fn at(&self, constant: f64, tau: f64) -> PlaneInstant {
        let m = self.set.packed_len();
        let mean = usize::from(self.set.has_mean());
        let (mut value, mut slope) = ([0.0, 0.0, constant], [0.0; 3]);
        if mean == 1 {
            for (i, v) in value.iter_mut().enumerate() {
                *v += self.signals[i * m];
            }
        }
        let mut turn = Complex64::cis(tau);
        let stride = self.set.stride();
        let step = if stride == 2 { turn * turn } else { turn };
        let mut p = 1.0;
        for at in (mean..m).step_by(2) {
            for i in 0..3 {
                let (re, im) = (self.signals[i * m + at], self.signals[i * m + at + 1]);
                value[i] += re * turn.re - im * turn.im;
                slope[i] -= p * (re * turn.im + im * turn.re);
            }
            turn *= step;
            p += stride as f64;
        }
        PlaneInstant {
            pull: [value[0], value[1]],
            rate: [slope[0], slope[1]],
            limit: value[2],
            limit_rate: slope[2],
        }
    }
}

/// A piece of slip: the direction of the force at the nodes of a panel.
#[derive(Clone, Copy, Debug)]
pub struct SlipPanel {
    /// Angle of the force at the start.
    pub angle: f64,
    /// Angles at the nodes.
    pub angles: [f64; RADAU_STAGES],
    /// Unit vectors e of the force at the nodes.
    pub directions: [[f64; 2]; RADAU_STAGES],
    /// Limits R at the nodes.
    pub limits: [f64; RADAU_STAGES],
    /// e·u′ at the nodes.
    pub along: [f64; RADAU_STAGES],
    /// n·u′ at the nodes, n a quarter turn left of e: R θ′.
    pub across: [f64; RADAU_STAGES],
}

/// The force in a piece. A piece of slip is the largest and the most frequent: it is not put elsewhere.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::large_enum_variant)]
pub enum PlaneForce {
    /// None: the sides are apart.
    Open,
    /// force + u − u(start of the piece), of which both are given.
    Stick {
        /// Force at the start.
        force: [f64; 2],
        /// u at the start.
        pull: [f64; 2],
    },
    /// R in the direction of the panel.
    Slip(SlipPanel),
}

/// An interval of the path.
#[derive(Clone, Copy, Debug)]
pub struct PlanePiece {
    /// Begin of the interval.
    pub start: f64,
    /// End of the interval.
    pub end: f64,
    /// The force.
    pub force: PlaneForce,
    /// Whether the sides close at the begin: the force then starts from zero.
    pub closes: bool,
}

impl PlanePiece {
    /// The state of the contact.
    #[must_use]
    pub fn state(&self) -> State {
        match self.force {
            PlaneForce::Open => State::Open,
            PlaneForce::Stick { .. } => State::Stick,
            PlaneForce::Slip(_) => State::Slip,
        }
    }
}

/// A time at which the circle of the limit holds a slider that rests, with the derivatives of its place (in units of
/// u) by the pull there, rows first, and by the limit there.
#[derive(Clone, Copy, Debug)]
pub struct Hold {
    /// τ
    pub tau: f64,
    /// By u.
    pub by_pull: [[f64; 2]; 2],
    /// By R.
    pub by_limit: [f64; 2],
    /// The drift of the place with the time, where no other circle holds the slider.
    pub drift: Option<Drift>,
}

/// The move of a slider at rest along the circle that holds it, as the time of the contact moves.
#[derive(Clone, Copy, Debug)]
pub struct Drift {
    /// Derivative of the place by τ.
    pub place: [f64; 2],
    /// Derivative of τ by u.
    pub by_pull: [f64; 2],
    /// By u′.
    pub by_rate: [f64; 2],
    /// By R′.
    pub by_limit_rate: f64,
}

/// The reason why the force repeats after the turn.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::large_enum_variant)]
pub enum Repetition {
    /// The path starts without force: where the sides close, or they never touch.
    FromNothing,
    /// The contact sticks with its slider at rest at a place, virgin unless the limit holds it at some times.
    Rests([Option<Hold>; 2]),
    /// Slip brings the force at the start back.
    Returns,
}

/// The path of one contact, with the memory to find it.
pub struct PlanePath {
    /// Tables of the collocation.
    pub tables: RadauTables,
    /// The motion.
    pub motion: PlaneMotion,
    /// Limit where it does not follow from a motion.
    pub constant_limit: f64,
    /// Length of the turn: π where force and motion repeat after it with opposite sign.
    pub turn: f64,
    /// Panels of the turn.
    pub panels: usize,
    /// The motion at the nodes of all panels.
    pub grid: Vec<PlaneInstant>,
    /// The pieces, in order, over one turn from anywhere.
    pub pieces: Vec<PlanePiece>,
    /// The reason why the force repeats.
    pub repetition: Repetition,
    /// Times between the nodes at which a slider at rest comes close to its limit.
    pub(crate) moments: Vec<(f64, PlaneInstant)>,
    pub(crate) lu: Lu<f64>,
}

impl PlanePath {
    /// Memory for motions of `set`; with `halves` the path covers half a turn for a set of odd harmonics.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(set: &HarmonicSet, halves: bool) -> Result<Self> {
        let turn = if halves && set.is_odd() { PI } else { TAU };
        let highest = set.highest_reduced() as f64;
        let panels = (PANELS_PER_HARMONIC * highest * turn / TAU).ceil() as usize + 2;
        let (mut pieces, mut moments) = (Vec::new(), Vec::new());
        pieces
            .try_reserve(8 * panels + 64)
            .and_then(|()| moments.try_reserve(2 * panels + 16))
            .map_err(|_| Error::out_of_memory(CONTEXT))?;
        Ok(Self {
            tables: RadauTables::new(),
            motion: PlaneMotion {
                set: set.try_clone()?,
                signals: try_vec(set.packed_len().saturating_mul(3), 0.0, CONTEXT)?,
            },
            constant_limit: 0.0,
            turn,
            panels,
            grid: try_vec(panels.saturating_mul(RADAU_STAGES), PlaneInstant::default(), CONTEXT)?,
            pieces,
            repetition: Repetition::FromNothing,
            moments,
            lu: Lu::new(RADAU_STAGES, 1)?,
        })
    }

    /// Takes a packed motion x₁, x₂ and, where the limit depends on it, y: u = kt·(x − w) from the place w of the slider
    /// before any motion, R = a + b·y with `limit` = [a, b].
    pub fn load(&mut self, (kt, slider): (f64, [f64; 2]), limit: [f64; 2], motion: &[f64]) {
        let m = self.motion.set.packed_len();
        self.constant_limit = limit[0];
        let scales = [kt, kt, limit[1]];
        self.motion.signals.fill(0.0);
        for (signal, (x, scale)) in self
            .motion
            .signals
            .chunks_exact_mut(m.max(1))
            .zip(motion.chunks_exact(m.max(1)).zip(scales))
        {
            for (s, x) in signal.iter_mut().zip(x) {
                *s = scale * x;
            }
        }
        if self.motion.set.has_mean() {
            for (signal, w) in self.motion.signals.chunks_exact_mut(m.max(1)).zip(slider) {
                signal[0] -= kt * w;
            }
        }
        let spacing = self.spacing();
        for k in 0..self.panels {
            for (j, c) in self.tables.nodes.iter().enumerate() {
                self.grid[k * RADAU_STAGES + j] = self.motion.at(self.constant_limit, spacing * (k as f64 + c));
            }
        }
        self.pieces.clear();
    }

    /// Length of a panel.
    pub fn spacing(&self) -> f64 {
        self.turn / self.panels as f64
    }

    /// −1 where force and motion repeat with opposite sign after the turn, else 1.
    pub fn sign(&self) -> f64 {
        if self.turn < TAU { -1.0 } else { 1.0 }
    }

    /// The largest limit at the nodes; 0 where the sides are apart at all of them.
    pub fn largest_limit(&self) -> f64 {
        self.grid.iter().fold(0.0, |m, at| m.max(at.limit))
    }

    /// Motion and limit at τ.
    #[must_use]
    pub fn at(&self, tau: f64) -> PlaneInstant {
        self.motion.at(self.constant_limit, tau)
    }

    /// Tangential force and state at any τ.
    #[must_use]
    pub fn force(&self, tau: f64) -> ([f64; 2], State) {
        let Some(first) = self.pieces.first() else {
            return ([0.0; 2], State::Open);
        };
        let turns = ((tau - first.start) / self.turn).floor();
        let within = tau - turns * self.turn;
        let sign = if self.turn < TAU && turns.rem_euclid(2.0) != 0.0 {
            -1.0
        } else {
            1.0
        };
        let at = self.pieces.partition_point(|p| p.start <= within).saturating_sub(1);
        let piece = &self.pieces[at];
        let here = self.at(within);
        let force = match &piece.force {
            PlaneForce::Open => [0.0; 2],
            PlaneForce::Stick { force, pull } => core::array::from_fn(|i| force[i] + here.pull[i] - pull[i]),
            PlaneForce::Slip(panel) => {
                let share = (within - piece.start) / (piece.end - piece.start);
                let angle = self.tables.interpolate(&panel.points(), share.clamp(0.0, 1.0));
                [here.limit * angle.cos(), here.limit * angle.sin()]
            }
        };
        (force.map(|f| sign * f), piece.state())
    }
}

impl SlipPanel {
    /// Angles at the start and the nodes.
    #[must_use]
    pub fn points(&self) -> [f64; RADAU_STAGES + 1] {
        core::array::from_fn(|i| if i == 0 { self.angle } else { self.angles[i - 1] })
    }

    /// Angle at the end.
    pub fn end(&self) -> f64 {
        self.angles[RADAU_STAGES - 1]
    }
}
