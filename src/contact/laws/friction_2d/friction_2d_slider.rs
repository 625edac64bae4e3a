//! The walk of a friction slider between its two moving bounds, from one event to the next.
//!
//! See [`crate::contact::laws::friction_2d`] for the bounds. Between neighbouring turning points of the two
//! signals both bounds are monotone and q₊ ≤ q₋, so at most one event lies there: where the bound that comes
//! towards a slider at rest is beyond it at the end of the interval, slip begins at the one time
//! that it passes; and slip ends where the bound that drags the slider turns back.

use crate::contact::forms::contact_state::State;
use crate::contact::forms::coupled_search::Bound;
use crate::contact::forms::piece::CoupledPiece;
use crate::error::Result;
use crate::fourier::HarmonicSet;
use crate::fourier::{Extremum, VALUES_OF_A_CROSSING, crossing, jet};
use crate::interrupt::Interrupt;
use std::f64::consts::TAU;

/// Constants of the slider: those of friction under a varying normal load.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Play {
    pub(crate) kt: f64,
    pub(crate) kn: f64,
    pub(crate) mu: f64,
    pub(crate) load: f64,
    /// s before any motion.
    pub(crate) slider: f64,
}

impl Play {
    /// Stick of a slider that has not moved.
    pub(crate) fn stick_from_start(&self) -> CoupledPiece {
        CoupledPiece {
            constant: if self.slider == 0.0 { 0.0 } else { -self.slider },
            ..self.stick()
        }
    }

    /// Stick of a slider at s = 0.
    pub(crate) fn stick(&self) -> CoupledPiece {
        CoupledPiece {
            of_x: self.kt,
            state: State::Stick,
            ..CoupledPiece::OPEN
        }
    }

    /// Stick after a slip of the given sign that ended at the time r: s = q±(r).
    pub(crate) fn stick_after_slip(&self, sign: f64, r: f64) -> CoupledPiece {
        CoupledPiece {
            anchor: Some(r),
            at_x: -self.kt,
            at_y: -sign * self.mu * self.kn,
            constant: sign * self.mu * self.load,
            ..self.stick()
        }
    }

    /// Stick from the time r of closing: s = kt·x(r).
    fn stick_after_closing(&self, r: f64, moved_y: f64) -> CoupledPiece {
        CoupledPiece {
            anchor: Some(r),
            at_x: -self.kt,
            moved_y,
            ..self.stick()
        }
    }

    /// Slip of the given sign, f = ±μN.
    fn slip(&self, sign: f64) -> CoupledPiece {
        CoupledPiece {
            of_y: -sign * self.mu * self.kn,
            constant: sign * self.mu * self.load,
            state: State::Slip,
            ..CoupledPiece::OPEN
        }
    }
}

/// Direction in which each bound drags the slider.
/// Kind: fixed.
const SIGNS: [f64; 2] = [1.0, -1.0];

/// Phase of the slider since the time `piece.start` or `start`.
pub(crate) enum Phase {
    /// Dragged by a bound.
    Slip { side: usize, start: f64 },
    /// At rest at s, with the piece that began.
    Stick { s: f64, piece: CoupledPiece },
}

impl Phase {
    /// Slip with the bound `side` (0: upwards) from a time on.
    pub(crate) fn slip(side: usize, start: f64) -> Self {
        Self::Slip { side, start }
    }
}

/// A walk that writes pieces.
pub(crate) struct SliderWalk<'a> {
    pub(crate) play: Play,
    pub(crate) set: &'a HarmonicSet,
    /// Packed x and y.
    pub(crate) motion: (&'a [f64], &'a [f64]),
    pub(crate) bounds: &'a [Bound; 2],
    pub(crate) pieces: &'a mut Vec<CoupledPiece>,
}

/// A time with the values of the signals of both bounds.
#[derive(Clone, Copy)]
struct Instant {
    tau: f64,
    u: [f64; 2],
}

impl SliderWalk<'_> {
    /// Phase of the slider from the time r of closing on, where s = kt·x(r). The bounds open by
    /// q±′ = kt·x′ ∓ μN′ with N′ = −kn·y′; it sticks if neither comes towards it.
    pub(crate) fn closing(&self, r: f64) -> Phase {
        let (x, y) = (jet(self.set, self.motion.0, r), jet(self.set, self.motion.1, r));
        let rate = self.play.kt * x.dx;
        if rate.abs() >= self.play.mu * self.play.kn * y.dx.abs() && rate != 0.0 {
            return Phase::slip(usize::from(rate < 0.0), r);
        }
        // Stick needs |kt·x′/y′| < μ·kn; where both rates vanish, the time of closing has no derivative.
        let moved_y = if y.dx == 0.0 { 0.0 } else { rate / y.dx };
        let piece = self.play.stick_after_closing(r, moved_y);
        Phase::Stick {
            s: self.play.kt * x.x,
            piece: CoupledPiece { start: r, ..piece },
        }
    }

    /// Walks over a time in which the contact is closed.
    pub(crate) fn run(&mut self, [begin, end]: [f64; 2], mut phase: Phase, interrupt: &Interrupt<'_>) -> Result<()> {
        let [upper, lower] = self.bounds;
        let mut cursors = [
            Cursor::after(&upper.turning_points, begin),
            Cursor::after(&lower.turning_points, begin),
        ];
        let mut from = self.instant(begin);
        while from.tau < end {
            interrupt.check_before((VALUES_OF_A_CROSSING * self.motion.0.len()) as u64)?;
            let to = self.instant(cursors.iter().fold(end, |t, c| t.min(c.tau())));
            let drags = [0, 1].map(|side| SIGNS[side] * cursors[side].rise() > 0.0);
            phase = self.advance(phase, from, to, drags);
            for cursor in &mut cursors {
                cursor.pass(to.tau);
            }
            from = to;
        }
        match phase {
            Phase::Slip { side, start } => self.push(self.play.slip(SIGNS[side]), start, end),
            Phase::Stick { piece, .. } => self.push(piece, piece.start, end),
        }
        Ok(())
    }

    fn instant(&self, tau: f64) -> Instant {
        let u = |side: usize| jet(self.set, &self.bounds[side].signal, tau).x;
        Instant { tau, u: [u(0), u(1)] }
    }

    /// One interval between turning points, with each bound moving in the direction that drags the slider, or not.
    fn advance(&mut self, phase: Phase, from: Instant, to: Instant, drags: [bool; 2]) -> Phase {
        // q± = u± ∓ μ·n₀.
        let limit = self.play.mu * self.play.load;
        let (s, piece) = match phase {
            Phase::Slip { side, .. } if drags[side] => return phase,
            Phase::Slip { side, start } => {
                let sign = SIGNS[side];
                self.push(self.play.slip(sign), start, from.tau);
                let piece = self.play.stick_after_slip(sign, from.tau);
                let start = from.tau;
                (from.u[side] - sign * limit, CoupledPiece { start, ..piece })
            }
            Phase::Stick { s, piece } => (s, piece),
        };
        for (side, sign) in SIGNS.into_iter().enumerate() {
            let level = s + sign * limit;
            if drags[side] && sign * (to.u[side] - level) > 0.0 {
                let start = if sign * (from.u[side] - level) >= 0.0 {
                    from.tau
                } else {
                    let signal = &self.bounds[side].signal;
                    crossing(self.set, signal, from.tau, to.tau, from.u[side], to.u[side], level)
                };
                self.push(piece, piece.start, start);
                return Phase::Slip { side, start };
            }
        }
        Phase::Stick { s, piece }
    }

    /// Stores a piece from `start` to `end`, unless it has no length.
    pub(crate) fn push(&mut self, piece: CoupledPiece, start: f64, end: f64) {
        if end > start {
            self.pieces.push(CoupledPiece { start, end, ..piece });
        }
    }
}

/// A place in the turning points of a signal, turn after turn.
struct Cursor<'a> {
    turning_points: &'a [Extremum],
    next: usize,
    turns: f64,
}

impl<'a> Cursor<'a> {
    /// Before the first turning point after a time.
    fn after(turning_points: &'a [Extremum], time: f64) -> Self {
        let mut cursor = Self {
            turning_points,
            next: 0,
            turns: 0.0,
        };
        cursor.pass(time);
        cursor
    }

    /// Time of the next turning point; infinite for a signal without any.
    fn tau(&self) -> f64 {
        self.turning_points
            .get(self.next)
            .map_or(f64::INFINITY, |e| e.tau + self.turns * TAU)
    }

    /// Passes the turning points up to a time.
    fn pass(&mut self, time: f64) {
        while self.tau() <= time {
            self.next += 1;
            if self.next == self.turning_points.len() {
                self.next = 0;
                self.turns += 1.0;
            }
        }
    }

    /// Rise from the last turning point to the next, 0 for a constant signal. Its sign is that of the slope, also in
    /// intervals so short that rounding hides the difference of the values at their ends.
    fn rise(&self) -> f64 {
        let count = self.turning_points.len();
        self.turning_points.get(self.next).map_or(0.0, |next| {
            next.x - self.turning_points[(self.next + count - 1) % count].x
        })
    }
}
