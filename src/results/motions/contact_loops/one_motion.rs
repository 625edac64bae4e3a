//! Laws on one relative motion, exactly: their pieces from event to event, or their closed form.
//!
//! A slider stores f²/2k, the same at the begin and the end of every stick between slips, so that its
//! work per cycle is that of the slips: Σ f·Δx, a sum of positive terms.

use crate::contact::forms::contact_state::State;
use crate::contact::forms::law::{Form, Law, PackedMotion};
use crate::contact::forms::piece::Piece;
use crate::error::{Error, Result, try_push};
use crate::fourier::HarmonicSet;
use crate::fourier::{TurningPoints, jet};
use crate::interrupt::Interrupt;
use crate::results::motions::contact_loops::period::{Account, CONTEXT, PeriodicMotion, extrema};
use std::f64::consts::{PI, TAU};

/// A law of the form `PiecewiseLinear` or `Spectral` under a packed motion.
pub struct ScalarOrbit<'a> {
    set: &'a HarmonicSet,
    motion: &'a [f64],
    law: &'a dyn Law,
    pieces: Vec<Piece>,
    /// Motion x at the anchor of each piece; 0 without an anchor.
    anchors: Vec<f64>,
}

impl<'a> ScalarOrbit<'a> {
    /// Locates the events of `law` under a motion of one direction, if it has any.
    ///
    /// # Errors
    /// `OutOfMemory`, `StoppedByCaller`.
    pub fn new(at: PeriodicMotion<'a>, law: &'a dyn Law, interrupt: &Interrupt<'_>) -> Result<Self> {
        let PeriodicMotion {
            set,
            packed: motion,
            omega,
            ..
        } = at;
        let (mut pieces, mut anchors) = (Vec::new(), Vec::new());
        if let Form::PiecewiseLinear(law) = law.form() {
            let mut turning_points = extrema(set)?;
            TurningPoints::new(set)?.find(set, motion, &mut turning_points, interrupt)?;
            pieces
                .try_reserve(law.most_pieces(set.highest_reduced()))
                .map_err(|_| Error::out_of_memory(CONTEXT))?;
            law.pieces_at(
                PackedMotion { set, motion, omega },
                &turning_points,
                &mut pieces,
                interrupt,
            )?;
        }
        for piece in &pieces {
            interrupt.check_before(motion.len() as u64)?;
            let x = piece.anchor.map_or(0.0, |tau| jet(set, motion, tau).x);
            try_push(&mut anchors, x, CONTEXT)?;
        }
        Ok(Self {
            set,
            motion,
            law,
            pieces,
            anchors,
        })
    }

    /// Force and state at τ in [0, 2π), where the motion is x.
    #[must_use]
    pub fn at(&self, tau: f64, x: f64) -> (f64, State) {
        let known = match self.law.form() {
            Form::PiecewiseLinear(law) => law.at(x),
            Form::Spectral(law) => Some((law.at(x), State::Stick)),
            Form::Memoryless(_) | Form::VaryingNormalLoad(_) | Form::PlaneFriction(_) | Form::Hysteretic(_) => None,
        };
        known.unwrap_or_else(|| self.remembered(tau, x))
    }

    /// Force and state of a law with memory.
    fn remembered(&self, tau: f64, motion: f64) -> (f64, State) {
        let Some(first) = self.pieces.first() else {
            return (0.0, State::Stick);
        };
        // The pieces cover one turn from the first on, or half a turn whose mirror image follows.
        let turn = self.turn();
        let turns = -((tau - first.start) / turn).floor();
        let within = tau + turns * turn;
        let mirrored = self.set.is_odd() && turns.rem_euclid(2.0) != 0.0;
        let sign = if mirrored { -1.0 } else { 1.0 };
        let at = self.pieces.partition_point(|p| p.start <= within).saturating_sub(1);
        let (piece, anchor) = (&self.pieces[at], self.anchors[at]);
        let force = piece.slope * (motion - sign * anchor) + sign * piece.offset;
        (force, self.state(piece))
    }

    fn state(&self, piece: &Piece) -> State {
        match self.law.form() {
            Form::PiecewiseLinear(law) => law.state(piece),
            Form::Spectral(_)
            | Form::Memoryless(_)
            | Form::VaryingNormalLoad(_)
            | Form::PlaneFriction(_)
            | Form::Hysteretic(_) => State::Stick,
        }
    }

    /// Length of the time that the pieces cover.
    fn turn(&self) -> f64 {
        if self.set.is_odd() { PI } else { TAU }
    }

    /// Work, never negative: 0 for laws without memory and for contacts that do not slip. Shares as far as
    /// the law has states.
    pub fn account(&self) -> Account {
        Account {
            work: self.work(),
            slip: self.share(State::Slip),
            open: self.share(State::Open),
        }
    }

    fn work(&self) -> f64 {
        let x = |tau| jet(self.set, self.motion, tau).x;
        let slips = self.pieces.iter().filter(|p| self.state(p) == State::Slip);
        let work = slips
            .map(|p| p.offset * (x(p.end) - x(p.start)))
            .fold(0.0, |a, b| a + b);
        // The motion repeats `base` times in a period.
        work * self.set.base() as f64 * if self.set.is_odd() { 2.0 } else { 1.0 }
    }

    fn share(&self, state: State) -> f64 {
        let inside = self.pieces.iter().filter(|p| self.state(p) == state);
        inside.map(|p| p.end - p.start).fold(0.0, |a, b| a + b) / self.turn()
    }
}
