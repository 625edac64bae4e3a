//! The Jenkins element: a spring of stiffness k in series with a Coulomb slider of limit fc.
//!
//! While it sticks, f = k·(x − x(r)) + σ·fc from the turning point r that ended the last slip of sign σ;
//! while it slips, f = ±fc. A slider that never slips carries f = k·x; where the mean of the motion
//! alone exceeds its range, it is dragged along just so far (a virgin slider loaded slowly). A slider that was
//! left at w carries f = k·(x − w) and is dragged from there.
//! The law is a play operator; see Visintin, Differential Models of Hysteresis (1994), and the
//! exact multi-harmonic friction element of Petrov & Ewins, J. Turbomach. 125 (2003) 364–371,
//! doi:10.1115/1.1539868.

use crate::contact::forms::constants::{Constant, Role, named_constants, needs_stiffness, slip_limit};
use crate::contact::forms::contact_state::State;
use crate::contact::forms::force_derivative::{Combination, ForceDerivative};
use crate::contact::forms::law::{ContactLaw, Form, Law, LawInTime, PiecewiseLinear};
use crate::contact::forms::linearisation::Range;
use crate::contact::forms::onset::{Onset, slider_in_line};
use crate::contact::forms::piece::Piece;
use crate::contact::laws::friction_2d::friction_2d_events::Slider;
use crate::contact::laws::saturated::Saturated;
use crate::contact::laws::sliding_mass::SlidingMass;
use crate::error::{Result, fail};
use crate::fourier::HarmonicSet;
use crate::fourier::{Extremum, VALUES_OF_A_CROSSING, crossing};
use crate::interrupt::Interrupt;
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A Jenkins contact in the caller's units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jenkins {
    /// Stiffness while it sticks, force per length, at least 0; infinite: rigid while it sticks.
    pub kt: f64,
    /// Friction coefficient, at least 0.
    pub mu: f64,
    /// Normal load, force, at least 0; infinite sticks for ever.
    pub preload: f64,
    /// Place of the slider before any motion. The force of a contact that sticks through the period is kt·(x − slider).
    pub slider: f64,
}

named_constants!(Jenkins, 0, Kt => kt, Mu => mu, Preload => preload, Slider(0) => slider);

impl Jenkins {
    fn slip_limit(&self) -> f64 {
        slip_limit(self.mu, self.preload)
    }
}

impl ContactLaw for Jenkins {
    fn name(&self) -> &'static str {
        "Jenkins contact"
    }

    fn check_stiffness(&self) -> Result<()> {
        needs_stiffness(Constant::Kt, self.kt)
    }

    fn role(&self) -> Role {
        if self.kt == 0.0 || self.slip_limit() == 0.0 {
            Role::Inert
        } else if self.slip_limit().is_infinite() {
            Role::Spring
        } else {
            Role::Active
        }
    }

    fn stiffness_at_small_motion(&self, _k: usize, _l: usize) -> f64 {
        if self.role() == Role::Inert { 0.0 } else { self.kt }
    }

    fn stiffness(&self, _k: usize) -> f64 {
        self.kt
    }

    fn is_spring(&self) -> bool {
        false
    }

    fn largest_force(&self) -> f64 {
        self.slip_limit()
    }

    fn is_preloaded(&self) -> bool {
        self.role() == Role::Active && self.slider != 0.0
    }

    /// A slider that never slips is a spring.
    fn by_constant(&self, constant: Constant) -> Option<ForceDerivative> {
        let sticks = self.role() == Role::Spring;
        Some(match constant {
            Constant::Kt if sticks => ForceDerivative::tangential(Combination::MOTION),
            Constant::Kt => ForceDerivative::by_factor(self.kt, Combination::BY_TANGENTIAL),
            Constant::Mu | Constant::Preload if sticks => ForceDerivative::ZERO,
            Constant::Mu => ForceDerivative::by_factor(self.mu, Combination::BY_LIMIT),
            Constant::Preload => ForceDerivative::by_factor(self.preload, Combination::BY_LIMIT),
            Constant::Slider(0) => ForceDerivative::tangential(Combination::of_slider(0)),
            _ => return None,
        })
    }

    fn may_be_infinite(&self, constant: Constant) -> bool {
        matches!(constant, Constant::Kt | Constant::Preload)
    }

    fn normal_load(&self, _y: f64) -> f64 {
        self.preload
    }

    fn law(&self, length: f64) -> Result<Arc<dyn Law>> {
        Ok(Arc::new(ScaledJenkins {
            stiffness: self.kt,
            limit: self.slip_limit() / length,
            slider: self.slider / length,
        }))
    }

    fn exchanged(&self, (stiffness, late): (f64, Option<f64>), length: f64) -> Option<Arc<dyn Law>> {
        if self.slider != 0.0 {
            return None;
        }
        let limit = self.slip_limit() / length;
        Some(match late {
            Some(late) => Arc::new(SlidingMass { stiffness, limit, late }),
            None => Arc::new(Saturated { stiffness, limit }),
        })
    }

    fn in_time(&self) -> Result<LawInTime> {
        if self.kt.is_infinite() {
            return fail!(
                Unsupported,
                "a Jenkins contact of kt = inf cannot be integrated in time, needs a finite kt"
            );
        }
        Ok(LawInTime::events(
            Slider::under_constant_load(self.kt, self.slip_limit()).starting_at(self.slider),
        ))
    }
}

/// A Jenkins element in the units of a solver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaledJenkins {
    /// k
    pub stiffness: f64,
    /// fc, infinite for a contact that sticks for ever
    pub limit: f64,
    /// Place of the slider before any motion.
    pub slider: f64,
}

/// The slider between two slips: where the current stick began, and the sign of the slip before.
struct Stick {
    start: f64,
    x: f64,
    sign: f64,
}

impl ScaledJenkins {
    /// No spring or no friction: no force.
    fn is_inert(&self) -> bool {
        self.stiffness == 0.0 || self.limit == 0.0
    }

    /// A motion that stays within the slider's range 2p.
    fn stuck(&self, end: f64, lowest: (f64, f64), highest: (f64, f64), pieces: &mut Vec<Piece>) {
        let play = self.limit / self.stiffness;
        let (anchor, offset) = if highest.1 - self.slider > play {
            (Some(highest.0), self.limit)
        } else if lowest.1 - self.slider < -play {
            (Some(lowest.0), -self.limit)
        } else if self.slider == 0.0 {
            (None, 0.0)
        } else {
            (None, -self.stiffness * self.slider)
        };
        pieces.push(Piece {
            start: 0.0,
            end,
            slope: self.stiffness,
            anchor,
            offset,
        });
    }

    fn push_stick(&self, stick: &Stick, end: f64, pieces: &mut Vec<Piece>) {
        if end > stick.start {
            pieces.push(Piece {
                start: stick.start,
                end,
                slope: self.stiffness,
                anchor: Some(stick.start),
                offset: stick.sign * self.limit,
            });
        }
    }
}

impl Law for ScaledJenkins {
    fn is_odd(&self) -> bool {
        self.slider == 0.0
    }

    fn form(&self) -> Form<'_> {
        Form::PiecewiseLinear(self)
    }

    fn linearisation_scale(&self, ranges: &[Range], _reference: f64) -> f64 {
        self.stiffness * ranges[0].half / self.limit
    }

    fn onset(&self, rest: &[f64], motion: &[Complex64]) -> Onset {
        let k = self.stiffness;
        Onset::NEVER.with_slider(slider_in_line(
            k * (rest[0] - self.slider),
            self.limit,
            k * motion[0],
            Complex64::ZERO,
        ))
    }
}

impl PiecewiseLinear for ScaledJenkins {
    fn pieces(
        &self,
        set: &HarmonicSet,
        motion: &[f64],
        turning_points: &[Extremum],
        pieces: &mut Vec<Piece>,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        if self.is_inert() {
            return Ok(());
        }
        let turn = if set.is_odd() { PI } else { TAU };
        let play = self.limit / self.stiffness;
        let mean = if set.has_mean() { motion[0] } else { 0.0 };
        let (lowest, highest) = range(set, turning_points).unwrap_or(((0.0, mean), (0.0, mean)));
        // A motion without turning points does not move, or is not finite.
        if turning_points.is_empty() || highest.1 - lowest.1 <= 2.0 * play {
            self.stuck(turn, lowest, highest, pieces);
            return Ok(());
        }
        // The motion is known to slip into its highest value (odd sets: its largest magnitude).
        let mut first = 0;
        for (i, e) in turning_points.iter().enumerate() {
            let larger = if set.is_odd() {
                e.x.abs() > turning_points[first].x.abs()
            } else {
                e.x > turning_points[first].x
            };
            if larger {
                first = i;
            }
        }
        let count = turning_points.len();
        let begin = turning_points[first];
        let mut stick = Stick {
            start: begin.tau,
            x: begin.x,
            sign: if set.is_odd() { begin.x.signum() } else { 1.0 },
        };
        let mut last = begin;
        for step in 1..=count {
            let index = first + step;
            let mut next = turning_points[index % count];
            if index >= count {
                next.tau += turn;
                if set.is_odd() {
                    next.x = -next.x;
                }
            }
            let direction = (next.x - last.x).signum();
            // Slip starts where the force has reached direction·fc.
            let threshold = stick.x + (direction - stick.sign) * play;
            if direction * (next.x - threshold) > 0.0 {
                let slip = if direction * (last.x - threshold) >= 0.0 {
                    last.tau
                } else {
                    interrupt.check_before((VALUES_OF_A_CROSSING * motion.len()) as u64)?;
                    crossing(set, motion, last.tau, next.tau, last.x, next.x, threshold)
                };
                self.push_stick(&stick, slip, pieces);
                pieces.push(Piece {
                    start: slip,
                    end: next.tau,
                    slope: 0.0,
                    anchor: None,
                    offset: direction * self.limit,
                });
                stick = Stick {
                    start: next.tau,
                    x: next.x,
                    sign: direction,
                };
            }
            last = next;
        }
        // A stick ends here only by rounding at the very onset of slip.
        if stick.start < last.tau {
            self.push_stick(&stick, last.tau, pieces);
        }
        Ok(())
    }

    /// The slider is marched from the highest sample, which it reaches slipping, once around.
    fn sampled_pieces(&self, samples: &[f64], pieces: &mut Vec<Piece>) {
        if self.is_inert() {
            return;
        }
        let n = samples.len();
        let play = self.limit / self.stiffness;
        let (mut low, mut high) = (0, 0);
        for j in 1..n {
            if samples[j] < samples[low] {
                low = j;
            }
            if samples[j] > samples[high] {
                high = j;
            }
        }
        if samples[high] - samples[low] <= 2.0 * play {
            let at = |j: usize| (j as f64, samples[j]);
            self.stuck(n as f64, at(low), at(high), pieces);
            return;
        }
        let mut slider = samples[high] - play;
        let mut anchor = (high, 1.0);
        let mut piece = Piece {
            start: high as f64,
            end: high as f64,
            slope: 0.0,
            anchor: None,
            offset: self.limit,
        };
        for j in high..high + n {
            let x = samples[j % n];
            let next = if x - slider >= play {
                slider = x - play;
                anchor = (j, 1.0);
                (0.0, None, self.limit)
            } else if x - slider <= -play {
                slider = x + play;
                anchor = (j, -1.0);
                (0.0, None, -self.limit)
            } else {
                (self.stiffness, Some(anchor.0 as f64), anchor.1 * self.limit)
            };
            if next != (piece.slope, piece.anchor, piece.offset) {
                pieces.push(piece);
                piece.start = j as f64;
                (piece.slope, piece.anchor, piece.offset) = next;
            }
            piece.end = (j + 1) as f64;
        }
        pieces.push(piece);
    }

    fn state(&self, piece: &Piece) -> State {
        if piece.slope == 0.0 { State::Slip } else { State::Stick }
    }

    fn at(&self, _x: f64) -> Option<(f64, State)> {
        None
    }
}

/// Lowest and highest value of a motion, each as (time, value).
fn range(set: &HarmonicSet, turning_points: &[Extremum]) -> Option<((f64, f64), (f64, f64))> {
    let first = turning_points.first()?;
    let (mut low, mut high) = ((first.tau, first.x), (first.tau, first.x));
    for e in turning_points {
        if e.x < low.1 {
            low = (e.tau, e.x);
        }
        if e.x > high.1 {
            high = (e.tau, e.x);
        }
    }
    if set.is_odd() {
        // The other half of the turn is the mirror image of the one that was scanned.
        let largest = high.1.max(-low.1);
        return Some(((0.0, -largest), (0.0, largest)));
    }
    Some((low, high))
}
