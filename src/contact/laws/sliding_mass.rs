//! A rigid slider under a mass, over the force that pushes the mass.
//!
//! With α x the force on the mass of the exchanged motion, see [`crate::condense::blocks::exchange`], w its place and τ = ωt,
//!
//! > α w″ = α x − f,  |f| ≤ fc,  f = fc sgn w′ where w′ ≠ 0,
//!
//! so that f = α x while the mass sticks. Slip begins where |x| passes fc/α, and ends where the momentum is used up,
//!
//! > W(τ) = ∫ (±x − fc/α) dτ = 0,
//!
//! from the begin of the slip on. Between two times at which ±x passes fc/α, W is monotone, so that its first zero lies in a bracket.
//! There the mass sticks, or slips backwards at once where x is beyond the other limit. At each of these events w′ = 0: the mass has
//! forgotten all before, and a motion that has an event of the opposite sense half a turn after another one repeats itself.
//!
//! ## Late forces
//!
//! A stick of a finite stiffness takes a part of a ring of the harmonic h_r from one limit to the other. With θ from cos θ = (r − 1)/(r + 1)
//! and r = ∓αx/fc at the end of a slip it has the impulse of a force that stays at ±fc for
//!
//! > δ = g/h_r,  g = ((r + 1) sin θ − (r − 1) θ)/2,
//!
//! and is ∓fc then. The mass slips backwards from there on, with the momentum of that impulse. For r < 1, too, the force comes to the other
//! limit; there the momentum is soon used up, and has no effect in the end, so that δ may be smaller the less it counts. It vanishes with
//! r, which makes the force continuous.

use crate::contact::forms::contact_state::State;
use crate::contact::forms::law::{Form, Law, PackedMotion, PiecewiseLinear, SlidingEnds};
use crate::contact::forms::linearisation::Range;
use crate::contact::forms::piece::Piece;
use crate::error::{Result, fail};
use crate::fourier::{Extremum, HarmonicSet, VALUES_OF_A_CROSSING};
use crate::interrupt::Interrupt;
use slide_walk::{Event, SlideWalk, lateness};
use std::f64::consts::PI;

mod slide_walk;

/// Half turns that are followed until the motion repeats itself.
/// Kind: cap.
const MOST_HALF_TURNS: usize = 64;

/// Difference of two times of one event.
/// Kind: rounding.
const SAME_TIME: f64 = 1e-12;

/// Constants of a slider over the force on its mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlidingMass {
    /// α
    pub stiffness: f64,
    /// fc
    pub limit: f64,
    /// 1/(h_r ω), 0 for a rigid slider.
    pub late: f64,
}

impl SlidingMass {
    /// Exchanged motion at which slip begins.
    fn range(&self) -> f64 {
        self.limit / self.stiffness
    }

    /// A piece from an event to the time at which the force is that of the next one.
    fn push(&self, event: Event, next: Event, pieces: &mut Vec<Piece>) {
        if next.begin() > event.begin() {
            pieces.push(Piece {
                start: event.begin(),
                end: next.begin(),
                slope: if event.sign == 0.0 { self.stiffness } else { 0.0 },
                anchor: (event.sign != 0.0 && next.sign != 0.0).then_some(next.tau),
                offset: event.sign * self.limit,
            });
        }
    }
}

impl SlidingMass {
    /// Follows half a turn from an event on; `None` where the mass sticks for ever.
    fn half_turn(
        &self,
        walk: &mut SlideWalk<'_>,
        begin: Event,
        pieces: &mut Vec<Piece>,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<HalfTurn>> {
        let end = begin.tau + PI;
        let (mut last, mut by_begin, mut sticks) = (begin, 1.0, begin.sign == 0.0);
        let mut nearest: Option<(Event, f64)> = None;
        let next = loop {
            interrupt.check_before((VALUES_OF_A_CROSSING * walk.motion.len()) as u64)?;
            let Some(next) = walk.next(last) else { return Ok(None) };
            if last.sign == 0.0 {
                sticks = true;
            } else {
                by_begin *= walk.moved(last, next.tau);
            }
            let off = |e: Event| (e.tau - end).abs();
            if next.sign + begin.sign == 0.0 && nearest.is_none_or(|(known, _)| off(next) < off(known)) {
                nearest = Some((next, by_begin));
            }
            if next.tau >= end - SAME_TIME {
                break next;
            }
            self.push(last, next, pieces);
            last = next;
        };
        let repeated = Event {
            tau: end,
            sign: -begin.sign,
            ..begin
        };
        self.push(last, repeated, pieces);
        Ok(Some(HalfTurn { next, nearest, sticks }))
    }

    /// Follows half turns until one repeats itself, and leaves its pieces: returns the time by which the last one did not.
    fn follow_half_turns(
        &self,
        PackedMotion { set, motion, omega }: PackedMotion<'_>,
        turning_points: &[Extremum],
        pieces: &mut Vec<Piece>,
        interrupt: &Interrupt<'_>,
    ) -> Result<f64> {
        if !set.is_odd() {
            return fail!(Internal, "a sliding mass needs odd harmonics alone");
        }
        let mut walk = SlideWalk {
            set,
            motion,
            extrema: turning_points,
            at: 0,
            range: self.range(),
            late: self.late * omega,
        };
        let Some(mut begin) = walk.first_onset() else {
            self.push(Event::at(0.0, 0.0), Event::at(PI, 0.0), pieces);
            return Ok(0.0);
        };
        let mut apart = PI;
        for _ in 0..MOST_HALF_TURNS {
            pieces.clear();
            begin = walk.rebased(begin);
            let (end, from) = (begin.tau + PI, walk.at);
            let Some(followed) = self.half_turn(&mut walk, begin, pieces, interrupt)? else {
                return Ok(0.0);
            };
            let start = core::mem::replace(&mut begin, followed.next);
            let Some((event, by_begin)) = followed.nearest else {
                apart = PI;
                continue;
            };
            let off = event.tau - end;
            apart = off.abs();
            if apart <= SAME_TIME {
                return Ok(0.0);
            }
            // A mass that never sticks: Newton's method for the begin of a slip.
            let step = off / (1.0 - by_begin);
            if !followed.sticks && step.abs() < 0.5 * PI {
                begin = walk.moved_begin((start, from), step).unwrap_or(begin);
            }
        }
        // Where slips hardly begin, several half turns repeat themselves together; motions on the way to a solution need not at all.
        Ok(apart)
    }
}

/// Half a turn that was followed.
struct HalfTurn {
    /// The first event after it, or at its end.
    next: Event,
    /// The event of the opposite sense nearest to its end, with its derivative by the begin.
    nearest: Option<(Event, f64)>,
    /// Whether the mass sticks meanwhile.
    sticks: bool,
}

impl Law for SlidingMass {
    fn is_odd(&self) -> bool {
        true
    }

    fn form(&self) -> Form<'_> {
        Form::PiecewiseLinear(self)
    }

    fn linearisation_scale(&self, ranges: &[Range], _reference: f64) -> f64 {
        ranges[0].size() / self.range()
    }
}

impl PiecewiseLinear for SlidingMass {
    fn pieces(
        &self,
        set: &HarmonicSet,
        motion: &[f64],
        turning_points: &[Extremum],
        pieces: &mut Vec<Piece>,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        // Ever slower: no force is late.
        self.pieces_at(
            PackedMotion {
                set,
                motion,
                omega: 0.0,
            },
            turning_points,
            pieces,
            interrupt,
        )
    }

    fn pieces_at(
        &self,
        at: PackedMotion<'_>,
        turning_points: &[Extremum],
        pieces: &mut Vec<Piece>,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        self.follow(at, turning_points, pieces, interrupt).map(|_| ())
    }

    fn sampled_pieces(&self, samples: &[f64], pieces: &mut Vec<Piece>) {
        // The mass needs exact events: it is not selected beside samples.
        let [begin, end] = [0.0, samples.len() as f64].map(|tau| Event::at(tau, 0.0));
        self.push(begin, end, pieces);
    }

    fn state(&self, piece: &Piece) -> State {
        if piece.slope == 0.0 { State::Slip } else { State::Stick }
    }

    fn at(&self, _x: f64) -> Option<(f64, State)> {
        None
    }

    fn sliding_ends(&self) -> Option<&dyn SlidingEnds> {
        Some(self)
    }
}

impl SlidingEnds for SlidingMass {
    fn stiffness(&self) -> f64 {
        self.stiffness
    }

    fn delay(&self, r: f64) -> [f64; 2] {
        lateness(r).map(|g| self.late * g)
    }

    fn follow(
        &self,
        at: PackedMotion<'_>,
        turning_points: &[Extremum],
        pieces: &mut Vec<Piece>,
        interrupt: &Interrupt<'_>,
    ) -> Result<f64> {
        self.follow_half_turns(at, turning_points, pieces, interrupt)
    }
}

#[cfg(test)]
#[path = "sliding_mass_tests.rs"]
mod tests;
