//! Friction in one direction under a normal load that varies, exactly: its tangential force from event to
//! event, its normal force from the normal motion at the time.

use crate::contact::forms::contact_state::State;
use crate::contact::forms::coupled_search::{CoupledSearch, piece_lists};
use crate::contact::forms::law::VaryingNormalLoad;
use crate::contact::forms::piece::CoupledPiece;
use crate::error::{Result, try_push};
use crate::fourier::HarmonicSet;
use crate::fourier::jet;
use crate::interrupt::Interrupt;
use crate::results::motions::contact_loops::period::CONTEXT;
use std::f64::consts::TAU;

/// Friction under a varying normal load, with its packed motions x before y.
pub struct CoupledOrbit<'a> {
    law: &'a dyn VaryingNormalLoad,
    /// Pieces of the tangential force; empty without friction.
    pieces: Vec<CoupledPiece>,
    /// Remembered part of each piece: at_x·x(r) + at_y·y(r) + constant.
    kept: Vec<f64>,
}

impl<'a> CoupledOrbit<'a> {
    /// Locates the events of `law`.
    ///
    /// # Errors
    /// `OutOfMemory`, `StoppedByCaller`.
    pub fn new(
        set: &HarmonicSet,
        motion: &[f64],
        law: &'a dyn VaryingNormalLoad,
        interrupt: &Interrupt<'_>,
    ) -> Result<Self> {
        let (mut normal, mut pieces) = piece_lists(set)?;
        let mut search = CoupledSearch::new(set)?;
        law.coupled_pieces(set, motion, &mut search, &mut normal, &mut pieces, interrupt)?;
        let (x, y) = motion.split_at(set.packed_len());
        let mut kept = Vec::new();
        for piece in &pieces {
            interrupt.check_before(motion.len() as u64)?;
            let remembered = piece
                .anchor
                .map_or(0.0, |r| piece.at_x * jet(set, x, r).x + piece.at_y * jet(set, y, r).x);
            try_push(&mut kept, remembered + piece.constant, CONTEXT)?;
        }
        Ok(Self { law, pieces, kept })
    }

    /// Tangential and normal force, and the state, at τ in [0, 2π), where the motions are x and y.
    #[must_use]
    pub fn at(&self, tau: f64, [x, y]: [f64; 2]) -> ([f64; 2], State) {
        let load = self.law.load_at(y);
        let Some(first) = self.pieces.first() else {
            return if load > 0.0 {
                ([0.0, -load], State::Stick)
            } else {
                ([0.0; 2], State::Open)
            };
        };
        // The pieces cover one turn from the first on.
        let within = tau - ((tau - first.start) / TAU).floor() * TAU;
        let at = self.pieces.partition_point(|p| p.start <= within).saturating_sub(1);
        let (piece, kept) = (&self.pieces[at], self.kept[at]);
        // At the times of closing and opening the load may be negative by rounding.
        let normal = if piece.state == State::Open || load <= 0.0 {
            0.0
        } else {
            -load
        };
        ([piece.of_x * x + piece.of_y * y + kept, normal], piece.state)
    }
}
