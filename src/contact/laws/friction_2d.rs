//! Elastic Coulomb friction in one tangential direction under a normal load that varies with the
//! normal motion and may vanish.
//!
//! With the relative motions x along the surface and y along its normal, side a minus side b, the
//! normal load is N = max(n₀ − kn·y, 0) and the normal force on y is −N. The tangential force is
//! f = kt·(x − w) with the slider at w: it sticks (w at rest) while |f| ≤ μN, slips with f = ±μN, and is
//! zero while the contact is open. At closing it begins from f = 0.
//!
//! In terms of s = kt·w the slider is a play between two moving bounds,
//!
//! > q₊ = kt·x − μN ≤ s ≤ q₋ = kt·x + μN,
//!
//! which meet where N = 0. A bound that moves against the slider drags it: slip in + direction while
//! q₊ rises, in − direction while q₋ falls. Where the contact is closed both bounds are, but for a
//! constant, the signals u± = kt·x ± μ·kn·y, of the same harmonics as the motion, so that slip ends at
//! turning points of u± and begins where u± passes a level. The walk along them is in `slider.rs`.
//!
//! The period map of the slider is s ↦ clamp(s), so any slip or opening makes it forget: a walk that
//! begins there has the periodic state at once. What never slips nor opens is a slider loaded slowly
//! from s = 0, dragged along just so far as its bounds need. See Petrov & Ewins, J. Turbomach. 125 (2003)
//! 364–371, doi:10.1115/1.1539868, for the friction element whose harmonics these are.

use crate::contact::contact_state::State;
use crate::contact::law::{Form, Law, Piece, PiecewiseLinear, Range};
use crate::contact::laws::friction_2d_slider::{Phase, Walk};
use crate::contact::laws::unilateral::Unilateral;
use crate::error::{Error, Result, try_vec};
use crate::fourier::HarmonicSet;
use crate::fourier::{Extremum, TurningPoints, jet};
use std::f64::consts::{PI, TAU};

/// Constants of friction under a varying normal load, all finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction2d {
    /// Tangential stiffness, at least 0; 0 is without tangential force.
    pub kt: f64,
    /// Normal stiffness, at least 0; 0 is a constant load.
    pub kn: f64,
    /// Friction coefficient, at least 0; 0 is without tangential force.
    pub mu: f64,
    /// n₀, the normal load at rest; negative: minus kn times the gap at rest.
    pub load: f64,
}

/// An interval on which the tangential force is
/// f(τ) = of_x·x(τ) + of_y·y(τ) + at_x·x(r) + at_y·y(r) + constant, with the anchor r.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoupledPiece {
    /// Begin of the interval.
    pub start: f64,
    /// End of the interval.
    pub end: f64,
    /// Tangent stiffness in the tangential motion.
    pub of_x: f64,
    /// Tangent stiffness in the normal motion.
    pub of_y: f64,
    /// The time r that the force remembers; `None`: at_x, at_y and moved_y are 0.
    pub anchor: Option<f64>,
    /// What the force remembers of x(r).
    pub at_x: f64,
    /// What the force remembers of y(r).
    pub at_y: f64,
    /// The constant part.
    pub constant: f64,
    /// Derivative of the force by y(r) beyond at_y. Where r is the time of closing, N(r) = 0, the
    /// normal motion moves it: dr = −dy(r)/y′(r), and −kt·x(r) changes by kt·x′(r)/y′(r)·dy(r). At other
    /// anchors, which are extrema of the remembered signal, this is 0.
    pub moved_y: f64,
    /// What the contact does.
    pub state: State,
}

/// One bound of the slider: its signal u and the turning points of it over a whole turn.
pub(super) struct Bound {
    pub(super) signal: Vec<f64>,
    pub(super) turning_points: Vec<Extremum>,
}

/// Memory for finding the pieces of motions with one harmonic set.
pub struct Scratch {
    search: TurningPoints,
    normal: Vec<Extremum>,
    bounds: [Bound; 2],
}

impl Scratch {
    /// Memory for motions of `set`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(set: &HarmonicSet) -> Result<Self> {
        let bound = || -> Result<Bound> {
            Ok(Bound {
                signal: try_vec(set.packed_len(), 0.0, "a motion")?,
                turning_points: try_reserve(2 * most_closings(set))?,
            })
        };
        Ok(Self {
            search: TurningPoints::new(set)?,
            normal: try_reserve(2 * most_closings(set))?,
            bounds: [bound()?, bound()?],
        })
    }
}

/// How often a normal motion can close a contact in a turn, with room for what rounding makes of
/// touching; a signal has at most twice as many turning points.
fn most_closings(set: &HarmonicSet) -> usize {
    set.highest_reduced() + 2
}

fn try_reserve<T>(count: usize) -> Result<Vec<T>> {
    let mut v = Vec::new();
    v.try_reserve_exact(count)
        .map_err(|_| Error::out_of_memory("the pieces of a motion"))?;
    Ok(v)
}

/// Empty lists with memory for the normal and tangential pieces of any motion of `set`.
///
/// # Errors
/// `OutOfMemory`.
pub fn piece_lists(set: &HarmonicSet) -> Result<(Vec<Piece>, Vec<CoupledPiece>)> {
    let closings = most_closings(set);
    // One stick and one slip at most between neighbours of the turning points of both bounds and the ends of
    // the closed times, and the open times.
    Ok((
        try_reserve(4 * closings)?,
        try_reserve(2 * (4 * closings + 2 * closings) + closings)?,
    ))
}

/// Whether the contact is closed on a piece of its normal force.
#[must_use]
pub fn is_closed(piece: &Piece) -> bool {
    piece.slope != 0.0 || piece.offset != 0.0
}

impl Law for Friction2d {
    fn directions(&self) -> usize {
        2
    }

    fn is_odd(&self) -> bool {
        false
    }

    fn form(&self) -> Form<'_> {
        Form::Coupled(self)
    }

    /// With an open gap at rest: the closing over the gap.
    fn linearisation_scale(&self, ranges: &[Range], _reference: f64) -> f64 {
        self.kn * (ranges[1].half - ranges[1].mean).max(0.0) / -self.load
    }
}

impl Friction2d {
    /// Finds the exact pieces of the normal force (slope −∂N/∂y) and of the tangential force over one
    /// turn. `motion` is the packed x, then the packed y. The tangential pieces begin anywhere in the
    /// turn and follow each other without a gap; without friction (kt or mu is 0) there are none.
    pub fn pieces(
        &self,
        set: &HarmonicSet,
        motion: &[f64],
        scratch: &mut Scratch,
        normal: &mut Vec<Piece>,
        tangential: &mut Vec<CoupledPiece>,
    ) {
        normal.clear();
        tangential.clear();
        let (x, y) = motion.split_at(set.packed_len());
        self.normal_pieces(set, y, scratch, normal);
        if self.kt == 0.0 || self.mu == 0.0 {
            return;
        }
        for (bound, sign) in scratch.bounds.iter_mut().zip([1.0, -1.0]) {
            for ((u, x), y) in bound.signal.iter_mut().zip(x).zip(y) {
                *u = self.kt * x + sign * (self.mu * self.kn) * y;
            }
            find(&mut scratch.search, set, &bound.signal, &mut bound.turning_points);
        }
        let mut walk = Walk {
            law: self,
            set,
            motion: (x, y),
            bounds: &scratch.bounds,
            pieces: tangential,
        };
        match normal.as_slice() {
            [only] if is_closed(only) => self.always_closed(&mut walk),
            pieces => closed_times(pieces, &mut walk),
        }
    }

    fn normal_pieces(&self, set: &HarmonicSet, y: &[f64], scratch: &mut Scratch, pieces: &mut Vec<Piece>) {
        if self.kn == 0.0 {
            pieces.push(Piece {
                start: 0.0,
                end: TAU,
                slope: 0.0,
                anchor: None,
                offset: if self.load > 0.0 { -self.load } else { 0.0 },
            });
            return;
        }
        find(&mut scratch.search, set, y, &mut scratch.normal);
        let spring = Unilateral {
            stiffness: self.kn,
            gap: -self.load / self.kn,
        };
        spring.pieces(set, y, &scratch.normal, pieces);
        for piece in pieces.iter_mut().filter(|p| p.slope != 0.0) {
            // As it is, not by way of the gap.
            piece.offset = -self.load;
        }
    }

    /// A motion that never opens the contact. It slips where the bounds, each over the whole turn, leave
    /// no room for a slider at rest, and then the highest q₊ drags the slider: below it the slider was
    /// when the lowest q₋ had passed, and only q₊ has moved it up since.
    fn always_closed(&self, walk: &mut Walk<'_>) {
        let [upper, lower] = walk.bounds;
        let limit = self.mu * self.load;
        let highest = walk.extreme(upper, 1.0);
        let lowest = walk.extreme(lower, -1.0);
        let room = (lowest.x + limit) - (highest.x - limit);
        if room < 0.0 && !upper.turning_points.is_empty() {
            walk.run([highest.tau, highest.tau + TAU], Phase::slip(0, highest.tau));
            return;
        }
        let dragged = if highest.x > limit {
            Some((1.0, highest.tau))
        } else if lowest.x < -limit {
            Some((-1.0, lowest.tau))
        } else {
            None
        };
        let mut piece = dragged.map_or(self.stick(), |(sign, tau)| self.stick_after_slip(sign, tau));
        (piece.start, piece.end) = (0.0, TAU);
        walk.pieces.push(piece);
    }

    /// Stick of a slider at s = 0.
    pub(super) fn stick(&self) -> CoupledPiece {
        CoupledPiece { of_x: self.kt, ..OPEN }.doing(State::Stick)
    }

    /// Stick after a slip of the given sign that ended at the time r: s = q±(r).
    pub(super) fn stick_after_slip(&self, sign: f64, r: f64) -> CoupledPiece {
        CoupledPiece {
            anchor: Some(r),
            at_x: -self.kt,
            at_y: -sign * self.mu * self.kn,
            constant: sign * self.mu * self.load,
            ..self.stick()
        }
    }

    /// Stick from the time r of closing: s = kt·x(r).
    pub(super) fn stick_after_closing(&self, r: f64, moved_y: f64) -> CoupledPiece {
        CoupledPiece {
            anchor: Some(r),
            at_x: -self.kt,
            moved_y,
            ..self.stick()
        }
    }

    /// Slip of the given sign, f = ±μN.
    pub(super) fn slip(&self, sign: f64) -> CoupledPiece {
        CoupledPiece {
            of_y: -sign * self.mu * self.kn,
            constant: sign * self.mu * self.load,
            ..OPEN
        }
        .doing(State::Slip)
    }
}

/// A piece without force.
const OPEN: CoupledPiece = CoupledPiece {
    start: 0.0,
    end: 0.0,
    of_x: 0.0,
    of_y: 0.0,
    anchor: None,
    at_x: 0.0,
    at_y: 0.0,
    constant: 0.0,
    moved_y: 0.0,
    state: State::Open,
};

impl CoupledPiece {
    const fn doing(self, state: State) -> Self {
        Self { state, ..self }
    }
}

/// Reversals over a whole turn, also for sets of odd harmonics: a varying load has no such symmetry.
fn find(search: &mut TurningPoints, set: &HarmonicSet, signal: &[f64], found: &mut Vec<Extremum>) {
    search.find(set, signal, found);
    if set.is_odd() {
        for i in 0..found.len() {
            let Extremum { tau, x } = found[i];
            found.push(Extremum { tau: tau + PI, x: -x });
        }
    }
}

/// Walks every closed time from its closing on; the open times between them carry no force.
fn closed_times(normal: &[Piece], walk: &mut Walk<'_>) {
    let closed_ends = [normal.first(), normal.last()].map(|p| p.is_some_and(is_closed));
    // The turn of the normal pieces begins anywhere; a closed time that it cuts is one all the same.
    let cut = closed_ends == [true, true] && normal.len() > 1;
    for (i, piece) in normal.iter().enumerate().skip(usize::from(cut)) {
        let end = if cut && i + 1 == normal.len() {
            normal[0].end + TAU
        } else {
            piece.end
        };
        if is_closed(piece) {
            let phase = walk.closing(piece.start);
            walk.run([piece.start, end], phase);
        } else {
            walk.push(OPEN, piece.start, end);
        }
    }
}

impl Walk<'_> {
    /// The highest (sign 1) or lowest (−1) value of a bound's signal.
    fn extreme(&self, bound: &Bound, sign: f64) -> Extremum {
        let still = Extremum {
            tau: 0.0,
            x: jet(self.set, &bound.signal, 0.0).x,
        };
        let first = bound.turning_points.first().copied().unwrap_or(still);
        let further = |best: Extremum, e: &Extremum| if sign * (e.x - best.x) > 0.0 { *e } else { best };
        bound.turning_points.iter().fold(first, further)
    }
}
