//! Elastic Coulomb friction in one tangential direction under a normal load that varies with the
//! normal motion and may vanish.
//!
//! With the relative motions x along the surface and y along its normal, side a minus side b, the
//! normal load is N = max(n₀ − kn·y, 0) and the normal force on y is −N. The tangential force is
//! f = kt·(x − w) with the slider at w. The contact sticks (w at rest) while |f| ≤ μN, slips with f = ±μN, and
//! has no force while it is open. At closing it begins from f = 0.
//!
//! In terms of s = kt·w the slider is a play between two moving bounds,
//!
//! > q₊ = kt·x − μN ≤ s ≤ q₋ = kt·x + μN,
//!
//! which meet where N = 0. A bound that moves against the slider drags it: slip in + direction while
//! q₊ rises, in − direction while q₋ falls. Where the contact is closed both bounds are, but for a
//! constant, the signals u± = kt·x ± μ·kn·y, of the same harmonics as the motion, so that slip ends at
//! turning points of u± and begins where u± passes a level. The walk along them is in `friction_2d_slider.rs`.
//!
//! The period map of the slider is s ↦ clamp(s), so that the state after any slip or opening does not depend on
//! the state before: a walk that begins there has the periodic state at once. A slider that never slips nor
//! opens is loaded slowly from s = 0, or from the place where it was left, and dragged along just so far as its bounds need. See Petrov & Ewins,
//! J. Turbomach. 125 (2003) 364–371, doi:10.1115/1.1539868, for the friction element whose harmonics these are.

pub(crate) mod friction_2d_events;
mod friction_2d_slider;

use crate::contact::forms::constants::{Constant, LawData, Role, clearance, load, named_constants, needs_stiffness};
use crate::contact::forms::coupled_search::{Bound, CoupledSearch, find};
use crate::contact::forms::force_derivative::{Combination, ForceDerivative};
use crate::contact::forms::law::{ContactLaw, Form, Law, LawInTime, PiecewiseLinear, VaryingNormalLoad};
use crate::contact::forms::linearisation::Range;
use crate::contact::forms::onset::{Onset, slider_in_line};
use crate::contact::forms::piece::{CoupledPiece, Piece};
use crate::contact::laws::friction_2d::friction_2d_events::Slider;
use crate::contact::laws::friction_2d::friction_2d_slider::{Phase, Play, SliderWalk};
use crate::contact::laws::unilateral::ScaledUnilateral;
use crate::error::{Result, fail};
use crate::fourier::HarmonicSet;
use crate::fourier::{Extremum, jet};
use crate::interrupt::Interrupt;
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Friction in one tangential direction in the caller's units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Friction2d {
    /// Tangential stiffness, force per length, at least 0.
    pub kt: f64,
    /// Normal stiffness, force per length, above 0.
    pub kn: f64,
    /// Friction coefficient, at least 0.
    pub mu: f64,
    /// Normal load at rest where the gap is 0, force, at least 0.
    pub preload: f64,
    /// Closing at which a contact without preload begins to press, of any sign.
    pub gap: f64,
    /// Place of the slider before any motion.
    pub slider: f64,
}

named_constants!(
    Friction2d, 3, Kt => kt, Kn => kn, Mu => mu, Preload => preload, Gap => gap, Slider(0) => slider
);

impl Friction2d {
    /// n₀
    fn load(&self) -> f64 {
        load(self.kn, self.preload, self.gap)
    }
}

/// Refuses friction under a load that varies without a normal stiffness. Without any force, such as that of no
/// area, it needs none.
pub(super) fn check_normal_stiffness(kn: f64, kt: f64, preload: f64) -> Result<()> {
    if kn == 0.0 && (kt != 0.0 || preload != 0.0) {
        return fail!(
            Argument,
            "contact: kn = 0, needs a number > 0 for friction under a load that varies"
        );
    }
    Ok(())
}

/// The derivative of the forces of friction under a load that varies by one of its constants.
pub(super) fn under_varying_load(constant: Constant, law: &dyn LawData) -> Option<ForceDerivative> {
    let [kt, kn, mu, gap] =
        [Constant::Kt, Constant::Kn, Constant::Mu, Constant::Gap].map(|name| law.constant(name).unwrap_or(0.0));
    Some(match constant {
        Constant::Kt => ForceDerivative::by_factor(kt, Combination::BY_TANGENTIAL),
        Constant::Mu => ForceDerivative::by_factor(mu, Combination::BY_LIMIT),
        Constant::Preload | Constant::Kn | Constant::Gap if kn == 0.0 => ForceDerivative::ONE_SIDED,
        Constant::Preload | Constant::Kn | Constant::Gap => ForceDerivative::of_normal_load(constant, kn, gap),
        Constant::Slider(k) => ForceDerivative::tangential(Combination::of_slider(k)),
        Constant::Cubic | Constant::Velocity => return None,
    })
}

impl ContactLaw for Friction2d {
    fn name(&self) -> &'static str {
        "friction contact"
    }

    fn check(&self) -> Result<()> {
        check_normal_stiffness(self.kn, self.kt, self.preload)
    }

    fn places(&self) -> &'static [usize] {
        &[0, 2]
    }

    fn check_stiffness(&self) -> Result<()> {
        needs_stiffness(Constant::Kn, self.kn)
    }

    fn role(&self) -> Role {
        if self.kn == 0.0 { Role::Inert } else { Role::Active }
    }

    fn stiffness_at_small_motion(&self, k: usize, l: usize) -> f64 {
        if (self.mu == 0.0 && k == 0) || k != l || self.load() <= 0.0 {
            0.0
        } else {
            self.stiffness(k)
        }
    }

    fn stiffness(&self, k: usize) -> f64 {
        if k == 1 { self.kn } else { self.kt }
    }

    fn is_spring(&self) -> bool {
        false
    }

    fn is_preloaded(&self) -> bool {
        self.kn > 0.0 && self.load() >= 0.0
    }

    fn by_constant(&self, constant: Constant) -> Option<ForceDerivative> {
        if constant == Constant::Slider(1) {
            return None;
        }
        under_varying_load(constant, self)
    }

    fn normal_load(&self, y: f64) -> f64 {
        (self.load() - self.kn * y).max(0.0)
    }

    fn law(&self, length: f64) -> Result<Arc<dyn Law>> {
        Ok(Arc::new(ScaledFriction2d {
            kt: self.kt,
            kn: self.kn,
            mu: self.mu,
            load: self.load() / length,
            slider: self.slider / length,
        }))
    }

    /// A slider under a varying load; without friction a spring along the normal is left.
    fn in_time(&self) -> Result<LawInTime> {
        if self.kt == 0.0 || self.mu == 0.0 {
            let spring = ScaledUnilateral {
                stiffness: self.kn,
                gap: clearance(self.kn, self.preload, self.gap),
            };
            return Ok(LawInTime {
                first: 1,
                ..LawInTime::events(spring)
            });
        }
        let slider = Slider::under_varying_load(self.kt, self.kn, self.mu, self.load()).starting_at(self.slider);
        Ok(LawInTime::events(slider))
    }
}

/// Friction under a varying normal load in the units of a solver, all numbers finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaledFriction2d {
    /// Tangential stiffness, at least 0; 0 is without tangential force.
    pub kt: f64,
    /// Normal stiffness, at least 0; 0 is a constant load.
    pub kn: f64,
    /// Friction coefficient, at least 0; 0 is without tangential force.
    pub mu: f64,
    /// n₀, the normal load at rest; negative: minus kn times the gap at rest.
    pub load: f64,
    /// Place of the slider before any motion.
    pub slider: f64,
}

impl Law for ScaledFriction2d {
    fn directions(&self) -> usize {
        2
    }

    fn is_odd(&self) -> bool {
        false
    }

    fn form(&self) -> Form<'_> {
        Form::VaryingNormalLoad(self)
    }

    /// With an open gap at rest: the closing over the gap.
    fn linearisation_scale(&self, ranges: &[Range], _reference: f64) -> f64 {
        self.kn * (ranges[1].half - ranges[1].mean).max(0.0) / -self.load
    }

    fn onset(&self, rest: &[f64], motion: &[Complex64]) -> Onset {
        if self.kn == 0.0 {
            let limit = self.mu * self.load;
            return Onset::NEVER.with_slider(self.slider_onset(rest[0], limit, [motion[0], Complex64::ZERO]));
        }
        let load = self.load_at(rest[1]);
        let closing = Onset::of_closing(load / self.kn, motion[1]);
        if load < 0.0 {
            return closing;
        }
        closing.with_slider(self.slider_onset(rest[0], self.mu * load, [motion[0], motion[1]]))
    }
}

impl VaryingNormalLoad for ScaledFriction2d {
    /// Without friction (kt or mu is 0) there are no tangential pieces.
    fn coupled_pieces(
        &self,
        set: &HarmonicSet,
        motion: &[f64],
        search: &mut CoupledSearch,
        normal: &mut Vec<Piece>,
        tangential: &mut Vec<CoupledPiece>,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        normal.clear();
        tangential.clear();
        let (x, y) = motion.split_at(set.packed_len());
        self.normal_pieces(set, y, search, normal, interrupt)?;
        if self.kt == 0.0 || self.mu == 0.0 {
            return Ok(());
        }
        for (bound, sign) in search.bounds.iter_mut().zip([1.0, -1.0]) {
            for ((u, x), y) in bound.signal.iter_mut().zip(x).zip(y) {
                *u = self.kt * x + sign * (self.mu * self.kn) * y;
            }
            let found = &mut bound.turning_points;
            find(&mut search.search, set, &bound.signal, found, interrupt)?;
        }
        let mut walk = SliderWalk {
            play: Play {
                kt: self.kt,
                kn: self.kn,
                mu: self.mu,
                load: self.load,
                slider: self.kt * self.slider,
            },
            set,
            motion: (x, y),
            bounds: &search.bounds,
            pieces: tangential,
        };
        match normal.as_slice() {
            [only] if only.is_closed() => always_closed(&mut walk, interrupt),
            pieces => closed_times(pieces, &mut walk, interrupt),
        }
    }

    fn load_at(&self, y: f64) -> f64 {
        self.load - self.kn * y
    }
}

impl ScaledFriction2d {
    /// Factors of the vibration [x, y] from which on the slider of the closed contact is dragged.
    fn slider_onset(&self, rest: f64, limit: f64, [x, y]: [Complex64; 2]) -> [f64; 2] {
        if self.kt == 0.0 || self.mu == 0.0 {
            return [f64::INFINITY; 2];
        }
        slider_in_line(
            self.kt * (rest - self.slider),
            limit,
            self.kt * x,
            self.mu * self.kn * y,
        )
    }

    /// Pieces of the normal force.
    fn normal_pieces(
        &self,
        set: &HarmonicSet,
        y: &[f64],
        search: &mut CoupledSearch,
        pieces: &mut Vec<Piece>,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        if self.kn == 0.0 {
            pieces.push(Piece {
                start: 0.0,
                end: TAU,
                slope: 0.0,
                anchor: None,
                offset: if self.load > 0.0 { -self.load } else { 0.0 },
            });
            return Ok(());
        }
        find(&mut search.search, set, y, &mut search.normal, interrupt)?;
        let spring = ScaledUnilateral {
            stiffness: self.kn,
            gap: -self.load / self.kn,
        };
        spring.pieces(set, y, &search.normal, pieces, interrupt)?;
        for piece in pieces.iter_mut().filter(|p| p.slope != 0.0) {
            // From the load itself, without the rounding of the gap.
            piece.offset = -self.load;
        }
        Ok(())
    }
}

/// Pieces of a motion that never opens the contact. It slips where the bounds, each over the whole turn, leave
/// no room for a slider at rest, and then the highest q₊ drags the slider: below it the slider was
/// when the lowest q₋ had passed, and only q₊ has moved it up since.
fn always_closed(walk: &mut SliderWalk<'_>, interrupt: &Interrupt<'_>) -> Result<()> {
    let [upper, lower] = walk.bounds;
    let limit = walk.play.mu * walk.play.load;
    let highest = extreme(walk.set, upper, 1.0);
    let lowest = extreme(walk.set, lower, -1.0);
    let room = (lowest.x + limit) - (highest.x - limit);
    if room < 0.0 && !upper.turning_points.is_empty() {
        return walk.run([highest.tau, highest.tau + TAU], Phase::slip(0, highest.tau), interrupt);
    }
    let slider = walk.play.slider;
    let dragged = if highest.x - slider > limit {
        Some((1.0, highest.tau))
    } else if lowest.x - slider < -limit {
        Some((-1.0, lowest.tau))
    } else {
        None
    };
    let play = &walk.play;
    let mut piece = dragged.map_or(play.stick_from_start(), |(sign, tau)| play.stick_after_slip(sign, tau));
    (piece.start, piece.end) = (0.0, TAU);
    walk.pieces.push(piece);
    Ok(())
}

/// Walks every closed time from its closing on; the open times between them carry no force.
fn closed_times(normal: &[Piece], walk: &mut SliderWalk<'_>, interrupt: &Interrupt<'_>) -> Result<()> {
    let closed_ends = [normal.first(), normal.last()].map(|p| p.is_some_and(Piece::is_closed));
    // The turn of the normal pieces begins anywhere; a closed time across its begin counts as one.
    let cut = closed_ends == [true, true] && normal.len() > 1;
    for (i, piece) in normal.iter().enumerate().skip(usize::from(cut)) {
        let end = if cut && i + 1 == normal.len() {
            normal[0].end + TAU
        } else {
            piece.end
        };
        if piece.is_closed() {
            let phase = walk.closing(piece.start);
            walk.run([piece.start, end], phase, interrupt)?;
        } else {
            walk.push(CoupledPiece::OPEN, piece.start, end);
        }
    }
    Ok(())
}

/// The highest (sign 1) or lowest (−1) value of a bound's signal.
fn extreme(set: &HarmonicSet, bound: &Bound, sign: f64) -> Extremum {
    let still = Extremum {
        tau: 0.0,
        x: jet(set, &bound.signal, 0.0).x,
    };
    let first = bound.turning_points.first().copied().unwrap_or(still);
    let further = |best: Extremum, e: &Extremum| if sign * (e.x - best.x) > 0.0 { *e } else { best };
    bound.turning_points.iter().fold(first, further)
}
