//! What happens inside a contact over the period: its full force and its state at any time, the work
//! that it takes, how long it slips or is open.
//!
//! The law is evaluated exactly for the motion given, event by event, and its force is not cut off at
//! the highest harmonic of the motion. A slider stores f²/2k, the same at the begin and the end of
//! every stick between slips, so that its work per cycle is what the slips take: Σ f·Δx, a sum
//! of positive terms. By Parseval it equals π Σ h Im(Fₕ conj Xₕ) over the harmonics of the motion.

use crate::contact::law::{Form, Law, Piece};
use crate::contact::state::State;
use crate::error::{Error, Result, try_push};
use crate::fourier::{Extremum, Reversals, jet};
use crate::harmonics::HarmonicSet;
use std::f64::consts::{PI, TAU};

const WHAT: &str = "the loop of a contact";

/// A law under a periodic motion.
pub struct Orbit<'a> {
    set: &'a HarmonicSet,
    motion: &'a [f64],
    law: &'a dyn Law,
    extrema: Vec<Extremum>,
    pieces: Vec<Piece>,
    /// x at the anchor of each piece, 0 without one.
    anchors: Vec<f64>,
}

/// Motion, force and state at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// x
    pub motion: f64,
    /// f
    pub force: f64,
    /// What the contact does.
    pub state: State,
}

impl<'a> Orbit<'a> {
    /// Locates the events of `law` under a packed motion, both in the same units.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(set: &'a HarmonicSet, motion: &'a [f64], law: &'a dyn Law) -> Result<Self> {
        let highest = set.highest_reduced();
        let (mut extrema, mut pieces, mut anchors) = (Vec::new(), Vec::new(), Vec::new());
        // x' has at most 2·highest roots per turn, each the end of at most two pieces.
        extrema
            .try_reserve(2 * highest + 4)
            .and_then(|()| pieces.try_reserve(4 * highest + 8))
            .map_err(|_| Error::out_of_memory(WHAT))?;
        Reversals::new(set)?.find(set, motion, &mut extrema);
        if let Form::Pieces(law) = law.form() {
            law.pieces(set, motion, &extrema, &mut pieces);
        }
        for piece in &pieces {
            let x = piece.anchor.map_or(0.0, |tau| jet(set, motion, tau).x);
            try_push(&mut anchors, x, WHAT)?;
        }
        Ok(Self {
            set,
            motion,
            law,
            extrema,
            pieces,
            anchors,
        })
    }

    /// The contact at ωt = 2πj/n. The motion repeats within that turn where only multiples of a
    /// harmonic are carried.
    #[must_use]
    pub fn at(&self, j: usize, n: usize) -> Instant {
        // The angle is reduced in whole numbers, which cost no digit.
        let repeated = (self.set.base() as u128 * j as u128 % n.max(1) as u128) as f64;
        let tau = TAU * repeated / n.max(1) as f64;
        let motion = jet(self.set, self.motion, tau).x;
        let known = match self.law.form() {
            Form::Pieces(law) => law.at(motion),
            Form::Spectral(law) => Some((law.at(motion), State::Stick)),
            Form::Pointwise(_) | Form::Coupled(_) | Form::Marched(_) => None,
        };
        let (force, state) = known.unwrap_or_else(|| self.remembered(tau, motion));
        Instant { motion, force, state }
    }

    /// Force and state of a law with memory at τ in [0, 2π).
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
            Form::Pieces(law) => law.state(piece),
            Form::Spectral(_) | Form::Pointwise(_) | Form::Coupled(_) | Form::Marched(_) => State::Stick,
        }
    }

    /// Length of what the pieces cover.
    fn turn(&self) -> f64 {
        if self.set.is_odd() { PI } else { TAU }
    }

    /// Work per cycle that the law takes from the motion, never negative: 0 for laws without memory and
    /// for contacts that do not slip.
    #[must_use]
    pub fn work(&self) -> f64 {
        let x = |tau| jet(self.set, self.motion, tau).x;
        let slips = self.pieces.iter().filter(|p| self.state(p) == State::Slip);
        let work = slips
            .map(|p| p.offset * (x(p.end) - x(p.start)))
            .fold(0.0, |a, b| a + b);
        // The motion repeats `base` times in a period.
        work * self.set.base() as f64 * if self.set.is_odd() { 2.0 } else { 1.0 }
    }

    /// Share of the period in a state, as far as the law has states.
    #[must_use]
    pub fn share(&self, state: State) -> f64 {
        let inside = self.pieces.iter().filter(|p| self.state(p) == state);
        inside.map(|p| p.end - p.start).fold(0.0, |a, b| a + b) / self.turn()
    }

    /// Smallest and largest motion.
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        let mean = if self.set.has_mean() { self.motion[0] } else { 0.0 };
        if self.extrema.is_empty() {
            return (mean, mean);
        }
        let low = self.extrema.iter().map(|e| e.x).fold(f64::INFINITY, f64::min);
        let high = self.extrema.iter().map(|e| e.x).fold(f64::NEG_INFINITY, f64::max);
        if self.set.is_odd() {
            let largest = high.max(-low);
            return (-largest, largest);
        }
        (low, high)
    }
}
