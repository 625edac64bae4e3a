//! The path of friction in a plane through a time in which the sides touch, from event to event.
//!
//! In units of force, with u = kt·x and the limit R = μN:
//!
//! > stick f′ = u′ while |f| < R,  slip f = R e(θ), R θ′ = n·u′, while e·u′ − R′ ≥ 0.
//!
//! The force is continuous at both events. Before an opening R falls to zero, and θ turns there with a power of the time left; panels
//! then shorten towards the opening. At a closing the force starts from zero: in stick where |u′| < R′, else along u′, the one direction
//! whose turn stays finite.

use crate::contact::forms::plane_path::{CONTEXT, PlaneForce, PlaneInstant, PlanePath, PlanePiece, SlipPanel};
use crate::contact::forms::radau::{RADAU_POINTS, RADAU_STAGES};
use crate::contact::laws::friction_3d::friction_3d_slip::{
    FRICTION_3D_SLIP_ROUNDING, Solved, along_motion, first_zero, solve, turn_rate,
};
use crate::error::{Error, Result, Status, try_push};
use crate::interrupt::Interrupt;
use std::f64::consts::TAU;

/// Largest neglected part of a panel's turn, weighted by its limit against the largest limit.
/// Kind: tuned; measured on: not recorded.
const TURN_TOLERANCE: f64 = 3e-5;

/// Largest neglected part of the turn in a panel by a speed across the motion as large as the largest speed, weighted by the panel's
/// limit against the largest limit and by its share of the turn. Along a straight line the angle is constant, and only its derivatives
/// tell that a panel is too long: behind a reversal they fall within a few slip lengths.
/// Kind: tuned; measured on: derivatives of the force at reversals of a line of 1e4 slip lengths.
const ACROSS_TOLERANCE: f64 = 1e-3;

/// Share of the tolerance below which the next panel is twice as long.
/// Kind: tuned; measured on: not recorded.
const EASY: f64 = 1e-3;

/// Share of the time to an opening by which slip proceeds in one panel.
/// Kind: tuned; measured on: not recorded.
const TOWARDS_OPENING: f64 = 0.8;

/// Impulse of the force before an opening, against the largest limit times the turn, that is neglected.
/// Kind: rounding.
const NEGLECTED_IMPULSE: f64 = 1e-14;

/// Solutions up to the end of slip: the last two correct its time.
/// Kind: tuned; measured on: not recorded.
const FRICTION_3D_PATH_CORRECTIONS: usize = 3;

/// Shortest panel, against the turn.
/// Kind: rounding.
const FRICTION_3D_PATH_SHORTEST: f64 = 1e-13;

/// Rounding of the margin of a stick, over the motion against the largest limit.
/// Kind: rounding.
const PULL_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Pieces per panel of the turn beyond which a path is given up.
/// Kind: cap.
const MOST_PIECES: usize = 200;

/// The same for a whole path, and pieces per panel that it may have all the same: with their list growing some 100 MB.
/// Kind: cap.
const MOST_OF_A_PATH: usize = 1 << 18;
/// Pieces per panel that a path may have all the same: with their list growing some 100 MB.
/// Kind: tuned; measured on: not recorded.
const ALLOWED_PIECES: usize = 8;

/// The force while the sides touch.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Phase {
    Stick { force: [f64; 2] },
    Slip { angle: f64 },
}

/// A path under way.
pub(crate) struct PathWalk<'a> {
    path: &'a mut PlanePath,
    interrupt: &'a Interrupt<'a>,
    /// The largest limit.
    size: f64,
    /// The largest speed |u′|.
    speed: f64,
    /// Derivative of the force across the motion by a constant speed there, by size.
    across: f64,
    /// Derivatives of the force, or in slip of the angle (first row), by the force at the start.
    by_start: [[f64; 2]; 2],
    /// Whether the next piece begins with a closing.
    closes: bool,
    /// Length of the next panel of slip, as far as the last one tells.
    length: f64,
}

impl<'a> PathWalk<'a> {
    /// A walk whose largest limit is `size`.
    pub fn new(path: &'a mut PlanePath, size: f64, interrupt: &'a Interrupt<'a>) -> Self {
        path.pieces.clear();
        let speed = path
            .grid
            .iter()
            .fold(0.0_f64, |m, at| m.max(at.rate[0].hypot(at.rate[1])));
        Self {
            path,
            interrupt,
            size,
            speed,
            across: 0.0,
            by_start: [[1.0, 0.0], [0.0, 1.0]],
            closes: false,
            length: f64::INFINITY,
        }
    }

    /// The phase of a force at τ, brought onto the limit where it lies beyond. At the limit but for rounding it slips: where it
    /// does not, slip ends at once.
    pub fn begin(&mut self, tau: f64, force: [f64; 2]) -> Phase {
        let at = self.path.at(tau);
        let (limit, length) = (at.limit, force[0].hypot(force[1]));
        self.by_start = [[1.0, 0.0], [0.0, 1.0]];
        if length >= limit * (1.0 - self.rounding(&at)) {
            self.by_start[0] = [-force[1] / (length * length), force[0] / (length * length)];
            return Phase::Slip {
                angle: force[1].atan2(force[0]),
            };
        }
        Phase::Stick { force }
    }

    /// The phase after a closing at τ.
    pub fn close(&mut self, tau: f64) -> Phase {
        let at = self.path.at(tau);
        self.closes = true;
        self.by_start = [[0.0; 2]; 2];
        if at.rate[0].hypot(at.rate[1]) <= at.limit_rate {
            Phase::Stick { force: [0.0; 2] }
        } else {
            along_rate(&at)
        }
    }

    /// The limit at τ.
    pub fn limit(&self, tau: f64) -> f64 {
        self.path.at(tau).limit
    }

    /// Adds a piece without force.
    pub fn open(&mut self, start: f64, end: f64) -> Result<()> {
        self.push(start, end, &PlaneForce::Open)
    }

    /// The force at τ in a phase that has just ended there, and its derivatives by the force at the start.
    pub fn force(&self, tau: f64, phase: Phase) -> ([f64; 2], [[f64; 2]; 2]) {
        match phase {
            Phase::Stick { force } => (force, self.by_start),
            Phase::Slip { angle } => {
                let limit = self.path.at(tau).limit;
                let (sin, cos) = angle.sin_cos();
                let [by, _] = self.by_start;
                let along = |n: f64| by.map(|b| limit * n * b);
                ([limit * cos, limit * sin], [along(-sin), along(cos)])
            }
        }
    }

    /// Pieces beyond which the path is given up.
    fn most_pieces(&self) -> usize {
        let panels = self.path.panels;
        (MOST_PIECES * panels).min(MOST_OF_A_PATH.max(ALLOWED_PIECES * panels))
    }

    /// Follows the force over a time in which the sides touch, and which an opening may end.
    pub fn follow(&mut self, (from, to): (f64, f64), begin: Phase, opens: bool) -> Result<Phase> {
        let shortest = FRICTION_3D_PATH_SHORTEST * self.path.turn;
        let (mut tau, mut phase) = (from, begin);
        let (mut events_here, mut after_slip) = (0, false);
        while to - tau > shortest {
            self.interrupt.check()?;
            if self.path.pieces.len() > self.most_pieces() {
                return Err(Error::new(
                    Status::NoConvergence,
                    format_args!("friction in a plane passes between stick and slip too often to be followed"),
                )
                .recoverable());
            }
            let (before, slipped) = (tau, matches!(phase, Phase::Slip { .. }));
            // Both phases claim their end at once where a motion grazes the limit: slip then goes on for a little while.
            let goes_on = events_here > 2;
            (tau, phase) = match phase {
                Phase::Stick { force } => self.stick((tau, to), force, after_slip)?,
                Phase::Slip { angle } => {
                    if opens && self.is_over(tau, to) {
                        break;
                    }
                    let end = if opens { tau + TOWARDS_OPENING * (to - tau) } else { to };
                    self.slip((tau, end), angle, goes_on)?
                }
            };
            after_slip = slipped;
            events_here = if tau - before > shortest { 0 } else { events_here + 1 };
        }
        if opens {
            self.open(tau, to)?;
        }
        Ok(phase)
    }

    /// Whether the force before an opening matters no more. The limit at the middle tells an opening from a closing.
    fn is_over(&self, tau: f64, opening: f64) -> bool {
        let limit = self.limit(tau).max(self.limit(0.5 * (tau + opening)));
        limit * (opening - tau) < NEGLECTED_IMPULSE * self.size * self.path.turn
    }

    /// The end of the panel of the grid that holds τ, or `to` before it, and whether τ is the begin of the panel.
    fn panel_end(&self, tau: f64, to: f64) -> (f64, Option<usize>) {
        let spacing = self.path.spacing();
        let place = tau / spacing;
        let near = place.round();
        let whole = (place - near).abs() < 1e-9;
        let k = if whole { near } else { place.floor() };
        let end = ((k + 1.0) * spacing).min(to);
        let is_whole = whole && end < to;
        (end, is_whole.then_some(k.rem_euclid(self.path.panels as f64) as usize))
    }

    /// The motion at the nodes of [from, end]; from the grid where that is its panel.
    fn nodes(&self, from: f64, end: f64, panel: Option<usize>) -> [PlaneInstant; RADAU_STAGES] {
        // Past half a turn an odd motion returns with opposite sign.
        match panel {
            Some(k) if from < self.path.turn || self.path.turn >= TAU => {
                core::array::from_fn(|j| self.path.grid[k * RADAU_STAGES + j])
            }
            _ => core::array::from_fn(|j| self.path.at(from + (end - from) * self.path.tables.nodes[j])),
        }
    }

    /// Rounding of the margin of a stick. The force is a difference of motions, which may be far larger: where a body that friction
    /// holds has gone a long way.
    fn rounding(&self, at: &PlaneInstant) -> f64 {
        FRICTION_3D_SLIP_ROUNDING.max(PULL_ROUNDING * at.pull[0].hypot(at.pull[1]) / self.size)
    }

    /// Sticks up to an onset of slip or to the end. After slip the force begins at the limit, and rounding must not take it beyond.
    fn stick(&mut self, (from, to): (f64, f64), force: [f64; 2], after_slip: bool) -> Result<(f64, Phase)> {
        let start = self.path.at(from);
        let scale = (self.size * self.size).recip();
        let forces =
            |at: &PlaneInstant| -> [f64; 2] { core::array::from_fn(|i| force[i] + at.pull[i] - start.pull[i]) };
        // (R − |f|)(R + |f|) and its derivative. After a closing it rises from zero like the square of the time since; their
        // ratio starts at R′² − |u′|².
        let after_closing = self.closes;
        let rounding = self.rounding(&start);
        let margin = |at: &PlaneInstant, tau: f64| {
            let f = forces(at);
            let length = f[0].hypot(f[1]);
            let value = scale * (at.limit - length) * (at.limit + length);
            let slope = 2.0 * scale * (at.limit * at.limit_rate - f[0] * at.rate[0] - f[1] * at.rate[1]);
            let since = tau - from;
            if !after_closing {
                (value, slope)
            } else if since > 0.0 {
                let square = since * since;
                (value / square, (slope - 2.0 * value / since) / square)
            } else {
                let speed = at.rate[0].hypot(at.rate[1]);
                (scale * (at.limit_rate - speed) * (at.limit_rate + speed), 0.0)
            }
        };
        let mut tau = from;
        while tau < to {
            let (end, panel) = self.panel_end(tau, to);
            let nodes = self.nodes(tau, end, panel);
            let first = if tau > from { self.path.at(tau) } else { start };
            let length = end - tau;
            let values: [f64; RADAU_POINTS] = core::array::from_fn(|i| match i {
                0 => margin(&first, tau).0,
                _ => margin(&nodes[i - 1], tau + length * self.path.tables.nodes[i - 1]).0,
            });
            let is_zero = after_slip && tau <= from;
            let zero = first_zero(&self.path.tables, &values, (is_zero, rounding), |share| {
                let at = tau + length * share;
                let (value, slope) = margin(&self.path.at(at), at);
                (value, length * slope)
            });
            if let Some(share) = zero {
                let onset = tau + length * share;
                if after_closing && onset <= from {
                    return Ok((from, along_rate(&start)));
                }
                let f = forces(&self.path.at(onset));
                let size = f[0].hypot(f[1]);
                self.push(
                    from,
                    onset,
                    &PlaneForce::Stick {
                        force,
                        pull: start.pull,
                    },
                )?;
                let [x, y] = self.by_start;
                self.by_start[0] = core::array::from_fn(|k| (f[0] * y[k] - f[1] * x[k]) / (size * size));
                return Ok((
                    onset,
                    Phase::Slip {
                        angle: f[1].atan2(f[0]),
                    },
                ));
            }
            tau = end;
        }
        self.push(
            from,
            to,
            &PlaneForce::Stick {
                force,
                pull: start.pull,
            },
        )?;
        Ok((
            to,
            Phase::Stick {
                force: forces(&self.path.at(to)),
            },
        ))
    }

    /// Slips over one panel, or up to the begin of stick.
    fn slip(&mut self, (from, to): (f64, f64), angle: f64, goes_on: bool) -> Result<(f64, Phase)> {
        let (mut end, mut panel) = self.panel_end(from, to);
        if goes_on {
            (end, panel) = (from + (end - from) / 16.0, None);
        } else if end - from > self.length {
            (end, panel) = (from + self.length, None);
        }
        let start = self.path.at(from);
        let rate = turn_rate(&start, angle);
        let turned = self.turned_across(&start);
        let (solved, nodes) = loop {
            let nodes = self.nodes(from, end, panel);
            let weight = nodes.iter().fold(0.0_f64, |m, at| m.max(at.limit)) / self.size;
            let solved = solve(
                &self.path.tables,
                &mut self.path.lu,
                (end - from, angle, rate, turned),
                &nodes,
            );
            let last = end - from < 2.0 * FRICTION_3D_PATH_SHORTEST * self.path.turn;
            let share = (end - from) / self.path.turn;
            let neglected = |solved: &Solved| {
                let across = self.speed * share * solved.across.tail / ACROSS_TOLERANCE;
                weight * across.max(solved.tail / TURN_TOLERANCE)
            };
            match solved {
                Some(solved) if last || neglected(&solved) <= 1.0 => {
                    let eases = neglected(&solved) < EASY;
                    self.length = if eases { 2.0 } else { 1.0 } * (end - from);
                    break (solved, nodes);
                }
                None if last => break (along_motion(&nodes, angle), nodes),
                _ => (end, panel) = (from + 0.5 * (end - from), None),
            }
        };
        let stop = if goes_on {
            None
        } else {
            self.stick_begins((from, end), &solved.panel, &nodes)
        };
        let Some(stop) = stop else {
            self.pass(from, end, &solved)?;
            return Ok((
                end,
                Phase::Slip {
                    angle: solved.panel.end(),
                },
            ));
        };
        let mut last = angle;
        let mut stop = stop;
        if stop > from {
            let mut part = None;
            // The angle between nodes is less exact than at the end of a panel: solved up to the event, it corrects it.
            for round in 0..FRICTION_3D_PATH_CORRECTIONS {
                let nodes = self.nodes(from, stop, None);
                part = solve(
                    &self.path.tables,
                    &mut self.path.lu,
                    (stop - from, angle, rate, turned),
                    &nodes,
                );
                let Some(part) = &part else { break };
                let step = correction(
                    &part.panel,
                    &nodes,
                    stop - from,
                    1.0 - self.path.tables.nodes[RADAU_STAGES - 2],
                );
                if round + 1 < FRICTION_3D_PATH_CORRECTIONS && step.abs() < 0.01 * (stop - from) {
                    stop += step;
                }
            }
            if let Some(part) = part {
                self.pass(from, stop, &part)?;
                last = part.panel.end();
            }
        }
        let (force, by_start) = self.force(stop, Phase::Slip { angle: last });
        self.by_start = by_start;
        Ok((stop, Phase::Stick { force }))
    }

    /// The time in a panel of slip at which e·u′ − R′ falls below zero.
    fn stick_begins(
        &self,
        (from, end): (f64, f64),
        panel: &SlipPanel,
        nodes: &[PlaneInstant; RADAU_STAGES],
    ) -> Option<f64> {
        let tables = &self.path.tables;
        let start = self.path.at(from);
        let rate = |at: &PlaneInstant, angle: f64| {
            let (sin, cos) = angle.sin_cos();
            cos * at.rate[0] + sin * at.rate[1] - at.limit_rate
        };
        let scale = nodes.iter().fold(0.0_f64, |m, at| {
            m.max(at.rate[0].abs()).max(at.rate[1].abs()).max(at.limit_rate.abs())
        });
        let mut values = [rate(&start, panel.angle) / scale; RADAU_POINTS];
        for (value, (along, at)) in values[1..].iter_mut().zip(panel.along.iter().zip(nodes)) {
            *value = (along - at.limit_rate) / scale;
        }
        let angles = panel.points();
        let slopes = tables.derivatives(&values);
        let share = first_zero(tables, &values, (false, FRICTION_3D_SLIP_ROUNDING), |share| {
            let at = self.path.at(from + (end - from) * share);
            let value = rate(&at, tables.interpolate(&angles, share)) / scale;
            (value, tables.interpolate(&slopes, share))
        })?;
        Some(from + (end - from) * share)
    }

    /// Derivative of the angle by a speed across the motion where a panel of slip starts. After a closing, and where nothing is known of
    /// the force before, it is that of a direction that follows the motion.
    fn turned_across(&self, start: &PlaneInstant) -> f64 {
        let follows = start.rate[0].hypot(start.rate[1]).recip();
        let turned = self.across / start.limit;
        if turned > 0.0 && turned.is_finite() {
            turned
        } else if follows.is_finite() {
            follows
        } else {
            0.0
        }
    }

    /// Adds a panel of slip.
    fn pass(&mut self, from: f64, end: f64, solved: &Solved) -> Result<()> {
        self.by_start[0] = self.by_start[0].map(|b| solved.by_start * b);
        let last = solved.panel.limits[RADAU_STAGES - 1];
        self.across = last * solved.across.end;
        self.push(from, end, &PlaneForce::Slip(solved.panel))
    }

    fn push(&mut self, start: f64, end: f64, force: &PlaneForce) -> Result<()> {
        match force {
            PlaneForce::Open => self.across = 0.0,
            PlaneForce::Stick { .. } => self.across += end - start,
            PlaneForce::Slip(_) => (),
        }
        let closes = core::mem::take(&mut self.closes);
        let piece = PlanePiece {
            start,
            end,
            force: *force,
            closes,
        };
        try_push(&mut self.path.pieces, piece, CONTEXT)
    }
}

/// Slip from a closing on: along the motion.
fn along_rate(at: &PlaneInstant) -> Phase {
    Phase::Slip {
        angle: at.rate[1].atan2(at.rate[0]),
    }
}

/// The step of the secant to the zero of e·u′ − R′, from the end of a panel of slip and the node before it.
fn correction(panel: &SlipPanel, nodes: &[PlaneInstant; RADAU_STAGES], length: f64, before: f64) -> f64 {
    let margin = |j: usize| panel.along[j] - nodes[j].limit_rate;
    let (last, next) = (margin(RADAU_STAGES - 1), margin(RADAU_STAGES - 2));
    let step = -last * before * length / (last - next);
    if step.is_finite() { step } else { 0.0 }
}
