//! The unilateral spring: pressed when the gap is closed, without force when it is open.
//!
//! The closing of the contact is −x, the motion of side b over that of side a. The normal force is
//! N = max(k·(−x − g), 0), pushing the sides apart, which is f = −N on x; a negative gap g is a
//! preload −k·g at rest. The law has no memory: with the indicator of the closed times as
//! stiffness spectrum, F = k·T(S)·X + k·g·ĝ (Petrov & Ewins 2004, doi:10.1115/1.1644557, treat it
//! as the normal part of a friction contact).

use crate::contact::forms::constants::{Constant, Role, clearance, load, named_constants, needs_stiffness};
use crate::contact::forms::contact_state::State;
use crate::contact::forms::force_derivative::ForceDerivative;
use crate::contact::forms::law::{ContactLaw, EventLaw, Form, Law, LawInTime, PiecewiseLinear};
use crate::contact::forms::linearisation::Range;
use crate::contact::forms::onset::Onset;
use crate::contact::forms::piece::Piece;
use crate::contact::forms::time_piece::{Instant, Mode, TimePiece, Zeros, margin_of_level};
use crate::error::Result;
use crate::fourier::HarmonicSet;
use crate::fourier::{Extremum, VALUES_OF_A_CROSSING, crossing};
use crate::interrupt::Interrupt;
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::sync::Arc;

/// A unilateral spring in the caller's units: N = max(preload + kn·(closing − gap), 0), where closing is the motion of side b
/// over that of side a.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Unilateral {
    /// Stiffness while it is closed, force per length, at least 0.
    pub kn: f64,
    /// Normal load at rest where the gap is 0, force, at least 0.
    pub preload: f64,
    /// Closing at which a spring without preload begins to press, of any sign.
    pub gap: f64,
}

named_constants!(Unilateral, 2, Kn => kn, Preload => preload, Gap => gap);

impl Unilateral {
    fn clearance(&self) -> f64 {
        clearance(self.kn, self.preload, self.gap)
    }
}

impl ContactLaw for Unilateral {
    fn name(&self) -> &'static str {
        "unilateral spring"
    }

    fn places(&self) -> &'static [usize] {
        &[2]
    }

    fn check_stiffness(&self) -> Result<()> {
        needs_stiffness(Constant::Kn, self.kn)
    }

    fn role(&self) -> Role {
        if self.kn == 0.0 { Role::Inert } else { Role::Active }
    }

    fn stiffness_at_small_motion(&self, _k: usize, _l: usize) -> f64 {
        if self.clearance() < 0.0 { self.kn } else { 0.0 }
    }

    fn stiffness(&self, _k: usize) -> f64 {
        self.kn
    }

    fn is_spring(&self) -> bool {
        false
    }

    fn is_preloaded(&self) -> bool {
        self.kn > 0.0 && load(self.kn, self.preload, self.gap) >= 0.0
    }

    fn by_constant(&self, constant: Constant) -> Option<ForceDerivative> {
        match constant {
            Constant::Preload | Constant::Gap | Constant::Kn if self.kn == 0.0 => Some(ForceDerivative::ONE_SIDED),
            Constant::Preload | Constant::Gap | Constant::Kn => {
                Some(ForceDerivative::of_normal_load(constant, self.kn, self.gap))
            }
            _ => None,
        }
    }

    fn normal_load(&self, y: f64) -> f64 {
        match self.role() {
            Role::Active => (self.kn * (-y - self.clearance())).max(0.0),
            Role::Inert | Role::Spring => 0.0,
        }
    }

    fn law(&self, length: f64) -> Result<Arc<dyn Law>> {
        Ok(Arc::new(ScaledUnilateral {
            stiffness: self.kn,
            gap: self.clearance() / length,
        }))
    }

    fn in_time(&self) -> Result<LawInTime> {
        Ok(LawInTime::events(ScaledUnilateral {
            stiffness: self.kn,
            gap: self.clearance(),
        }))
    }
}

/// A unilateral spring in the units of a solver, its preload a part of the gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaledUnilateral {
    /// k
    pub stiffness: f64,
    /// g, of either sign
    pub gap: f64,
}

impl ScaledUnilateral {
    fn push(&self, start: f64, end: f64, closed: bool, pieces: &mut Vec<Piece>) {
        if end <= start {
            return;
        }
        let (slope, offset) = if closed {
            (self.stiffness, self.stiffness * self.gap)
        } else {
            (0.0, 0.0)
        };
        pieces.push(Piece {
            start,
            end,
            slope,
            anchor: None,
            offset,
        });
    }
}

impl Law for ScaledUnilateral {
    fn is_odd(&self) -> bool {
        false
    }

    fn form(&self) -> Form<'_> {
        Form::PiecewiseLinear(self)
    }

    fn linearisation_scale(&self, ranges: &[Range], _reference: f64) -> f64 {
        (ranges[0].half - ranges[0].mean).max(0.0) / self.gap
    }

    fn onset(&self, rest: &[f64], motion: &[Complex64]) -> Onset {
        Onset::of_closing(-rest[0] - self.gap, motion[0])
    }
}

impl PiecewiseLinear for ScaledUnilateral {
    fn pieces(
        &self,
        set: &HarmonicSet,
        motion: &[f64],
        turning_points: &[Extremum],
        pieces: &mut Vec<Piece>,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let level = -self.gap;
        let Some(first) = turning_points.first() else {
            let rest = if set.has_mean() { motion[0] } else { 0.0 };
            self.push(0.0, TAU, rest < level, pieces);
            return Ok(());
        };
        // From one turning point to the next the motion passes the level once at most.
        let mut start = first.tau;
        let mut closed = first.x < level;
        for (i, from) in turning_points.iter().enumerate() {
            let mut to = turning_points[(i + 1) % turning_points.len()];
            if i + 1 == turning_points.len() {
                to.tau += TAU;
            }
            if (to.x < level) != closed {
                interrupt.check_before((VALUES_OF_A_CROSSING * motion.len()) as u64)?;
                let at = crossing(set, motion, from.tau, to.tau, from.x, to.x, level);
                self.push(start, at, closed, pieces);
                start = at;
                closed = !closed;
            }
        }
        self.push(start, first.tau + TAU, closed, pieces);
        Ok(())
    }

    fn sampled_pieces(&self, samples: &[f64], pieces: &mut Vec<Piece>) {
        let closed = |x: f64| x < -self.gap;
        let mut start = 0;
        for j in 1..=samples.len() {
            if j == samples.len() || closed(samples[j]) != closed(samples[start]) {
                self.push(start as f64, j as f64, closed(samples[start]), pieces);
                start = j;
            }
        }
    }

    fn state(&self, piece: &Piece) -> State {
        if piece.slope == 0.0 { State::Open } else { State::Stick }
    }

    fn at(&self, x: f64) -> Option<(f64, State)> {
        Some(if x < -self.gap {
            (self.stiffness * (x + self.gap), State::Stick)
        } else {
            (0.0, State::Open)
        })
    }
}

/// Open or closed, f = k·(x + g) where that is negative.
impl EventLaw for ScaledUnilateral {
    fn begin(&self, at: &Instant, _e: &mut f64) -> (Mode, Option<Mode>) {
        let closed = at.motion[0] < -self.gap;
        (if closed { Mode::Closed } else { Mode::Open }, None)
    }

    fn piece(&self, mode: Mode, motion: [f64; 2], _e: f64) -> TimePiece {
        if mode == Mode::Closed {
            TimePiece::line(self.stiffness, self.stiffness * (motion[0] + self.gap), motion)
        } else {
            TimePiece::line(0.0, 0.0, motion)
        }
    }

    fn margins(&self, _mode: Mode) -> usize {
        1
    }

    /// The distance while it is open, the compression while closed.
    fn margin(&self, mode: Mode, _which: usize, _e: f64, x: &[f64], _y: &[f64], margin: &mut [f64]) {
        let sign = if mode == Mode::Closed { -1.0 } else { 1.0 };
        margin_of_level(sign, -self.gap, x, margin);
    }

    fn leave(&self, mode: Mode, _which: usize, _at: &Instant, _e: &mut f64) -> (Mode, Zeros) {
        let after = if mode == Mode::Closed { Mode::Open } else { Mode::Closed };
        (after, [1, 0, 0])
    }
}
