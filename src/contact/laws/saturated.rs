//! The force of a Coulomb slider over its exchanged motion: f = min(max(k·x, −fc), fc).
//!
//! A slider with the stick stiffness kt, infinite if it is rigid, moves at the rate ẏ − ḟ/kt, and its force lies on the
//! side of that rate where it slips. With any k > 0 both follow from one number without memory,
//!
//! > k x = f + k (ẏ − ḟ/kt),  f = min(max(k x, −fc), fc),
//!
//! the resolvent of a maximal monotone operator; see Lacoste & Nacivet, J. Vib. Acoust. 125 (2003),
//! doi:10.1115/DETC2003/VIB-48397, who use it at the times of a sampled period. [`crate::condense::blocks::exchange`] has the
//! equations of x.

use crate::contact::forms::contact_state::State;
use crate::contact::forms::law::{Form, Law, PiecewiseLinear};
use crate::contact::forms::linearisation::Range;
use crate::contact::forms::piece::Piece;
use crate::error::Result;
use crate::fourier::{Extremum, HarmonicSet, VALUES_OF_A_CROSSING, crossing};
use crate::interrupt::Interrupt;
use std::f64::consts::{PI, TAU};

/// Constants of a slider over its exchanged motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saturated {
    /// k
    pub stiffness: f64,
    /// fc
    pub limit: f64,
}

/// Where the exchanged motion is: below, within or above the range in which the slider sticks.
type Side = i8;

impl Saturated {
    /// Exchanged motion at which slip begins.
    fn range(&self) -> f64 {
        self.limit / self.stiffness
    }

    fn side(&self, x: f64) -> Side {
        Side::from(x >= self.range()) - Side::from(x <= -self.range())
    }

    fn push(&self, start: f64, end: f64, side: Side, pieces: &mut Vec<Piece>) {
        if end <= start {
            return;
        }
        let (slope, offset) = match side {
            0 => (self.stiffness, 0.0),
            side => (0.0, f64::from(side) * self.limit),
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

impl Law for Saturated {
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

impl PiecewiseLinear for Saturated {
    fn pieces(
        &self,
        set: &HarmonicSet,
        motion: &[f64],
        turning_points: &[Extremum],
        pieces: &mut Vec<Piece>,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let turn = if set.is_odd() { PI } else { TAU };
        let Some(first) = turning_points.first() else {
            let rest = if set.has_mean() { motion[0] } else { 0.0 };
            self.push(0.0, turn, self.side(rest), pieces);
            return Ok(());
        };
        // The turn ends as it begins, with opposite sign half a turn later.
        let end = Extremum {
            tau: first.tau + turn,
            x: if set.is_odd() { -first.x } else { first.x },
        };
        let (mut start, mut side) = (first.tau, self.side(first.x));
        for (from, to) in turning_points.iter().zip(turning_points[1..].iter().chain(Some(&end))) {
            let goal = self.side(to.x);
            while side != goal {
                let rises = goal > side;
                // The lower end of the range is passed from below it or to below it.
                let is_lower = if rises { side < 0 } else { side == 0 };
                let level = if is_lower { -self.range() } else { self.range() };
                let tau = if (level - from.x) * (to.x - level) > 0.0 {
                    interrupt.check_before((VALUES_OF_A_CROSSING * motion.len()) as u64)?;
                    crossing(set, motion, from.tau, to.tau, from.x, to.x, level)
                } else if (from.x - level).abs() <= (to.x - level).abs() {
                    from.tau
                } else {
                    to.tau
                };
                self.push(start, tau, side, pieces);
                start = tau.max(start);
                side += if rises { 1 } else { -1 };
            }
        }
        self.push(start, end.tau, side, pieces);
        Ok(())
    }

    fn sampled_pieces(&self, samples: &[f64], pieces: &mut Vec<Piece>) {
        let mut start = 0;
        for j in 1..=samples.len() {
            let side = self.side(samples[start]);
            if j == samples.len() || self.side(samples[j]) != side {
                self.push(start as f64, j as f64, side, pieces);
                start = j;
            }
        }
    }

    fn state(&self, piece: &Piece) -> State {
        if piece.slope == 0.0 { State::Slip } else { State::Stick }
    }

    fn at(&self, x: f64) -> Option<(f64, State)> {
        let state = if self.side(x) == 0 { State::Stick } else { State::Slip };
        Some(((self.stiffness * x).clamp(-self.limit, self.limit), state))
    }
}

#[cfg(test)]
mod tests {
    use super::Saturated;
    use crate::contact::forms::law::PiecewiseLinear;
    use crate::fourier::{HarmonicSet, TurningPoints, jet};
    use crate::interrupt::Interrupt;
    use std::f64::consts::{PI, TAU};

    /// Pieces of motions that pass one end of the range, both within a rise, touch one, or stay, against values at many times.
    #[test]
    fn pieces_have_the_force_at_each_time() {
        let law = Saturated {
            stiffness: 2.0,
            limit: 1.0,
        };
        let odd = HarmonicSet::excited(&[1], 5, true, true, false).unwrap();
        let all = HarmonicSet::all(3).unwrap();
        let cases: [(&HarmonicSet, &[f64]); 7] = [
            (&odd, &[0.4, 0.0, 0.0, 0.0, 0.0, 0.0]),
            (&odd, &[0.9, 0.2, 0.0, 0.0, 0.0, 0.0]),
            (&odd, &[0.9, 0.2, -0.5, 0.3, 0.2, 0.1]),
            (&odd, &[0.5, 0.0, 0.0, 0.0, 0.0, 0.0]),
            (&all, &[0.45, 0.2, 0.1, 0.3, 0.0, 0.1, -0.2]),
            (&all, &[-0.9, 0.1, 0.1, 0.0, 0.0, 0.0, 0.0]),
            (&all, &[0.1, 3.0, 1.0, 0.0, 2.0, 0.5, 0.0]),
        ];
        for (set, motion) in cases {
            let (mut extrema, mut pieces) = (Vec::with_capacity(64), Vec::with_capacity(64));
            let none = Interrupt::none();
            let mut search = TurningPoints::new(set).unwrap();
            search.find(set, motion, &mut extrema, &none).unwrap();
            law.pieces(set, motion, &extrema, &mut pieces, &none).unwrap();
            let turn = if set.is_odd() { PI } else { TAU };
            let covered: f64 = pieces.iter().map(|p| p.end - p.start).sum();
            assert!((covered - turn).abs() < 1e-12, "{motion:?}: {covered}");
            for piece in &pieces {
                for share in [0.01, 0.3, 0.6, 0.99] {
                    let x = jet(set, motion, piece.start + share * (piece.end - piece.start)).x;
                    let (force, state) = law.at(x).unwrap();
                    assert!((piece.slope * x + piece.offset - force).abs() < 1e-9, "{motion:?}");
                    assert!(
                        state == law.state(piece) || (force.abs() - 1.0).abs() < 1e-9,
                        "{motion:?}"
                    );
                }
            }
        }
    }
}
