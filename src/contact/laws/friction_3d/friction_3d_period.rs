//! The periodic force of friction in a plane: from closing to closing, with a slider at rest, or the one that slip repeats.
//!
//! A contact that opens forgets: its path starts at each closing. A contact that stays closed rests if one place of its slider lies in
//! the circle of the limit at all times, see friction_3d_stuck.rs. Otherwise it slips, which brings all forces at the start closer to the
//! one that returns, found by Newton's method.

use crate::contact::forms::piece::Piece;
use crate::contact::forms::plane_path::{
    CONTEXT, Drift, Hold, PlaneForce, PlaneInstant, PlanePath, PlanePiece, Repetition,
};
use crate::contact::forms::radau::{RADAU_POINTS, RADAU_STAGES};
use crate::contact::laws::friction_3d::friction_3d_path::{PathWalk, Phase};
use crate::contact::laws::friction_3d::friction_3d_stuck::{Disc, StuckSlider, stuck_slider};
use crate::error::{Error, Result, Status, try_push};
use crate::fourier::jet;
use crate::interrupt::Interrupt;
use crate::roots::safe_newton;
use std::f64::consts::TAU;

/// Turns that are followed at most.
/// Kind: cap.
const TURNS: usize = 120;

/// Turns after which a force that returns to [`FRICTION_3D_PERIOD_ENOUGH`] is taken.
/// Kind: tuned; measured on: not recorded.
const FRICTION_3D_PERIOD_PATIENCE: usize = 40;

/// Difference of a force that returns, against the largest limit.
/// Kind: rounding.
const RETURNS: f64 = 1e-13;

/// Difference that a step of Newton's method takes to [`RETURNS`].
/// Kind: rounding.
const SQUARE_RETURNS: f64 = 1e-7;

/// The same where the difference before promised more, or after [`FRICTION_3D_PERIOD_PATIENCE`] turns.
/// Kind: rounding.
const FRICTION_3D_PERIOD_ENOUGH: f64 = 1e-10;

/// Searches of the times that hold a slider at rest.
/// Kind: cap.
const FRICTION_3D_PERIOD_ROUNDS: usize = 8;

/// Change of the slider's place, against the largest motion, that is rounding.
/// Kind: rounding.
const FRICTION_3D_PERIOD_SETTLED: f64 = 1e-15;

/// Distance beyond a limit, against the largest motion, that is rounding.
/// Kind: rounding.
const FRICTION_3D_PERIOD_ROUNDING: f64 = 1e-13;

/// Times closer than this, against a panel, are the same time found more exactly.
/// Kind: tuned; measured on: not recorded.
const NEIGHBOURS: f64 = 0.2;

/// Depth inside the limit, against the largest limit, at which a time is not looked at more closely.
/// Kind: tuned; measured on: not recorded.
const DEEP: f64 = 0.1;

/// Finds the path over one turn of the loaded motion. `normal` has the pieces of the normal force, none under a
/// constant load.
pub(crate) fn find(normal: &[Piece], path: &mut PlanePath, interrupt: &Interrupt<'_>) -> Result<()> {
    if normal.iter().any(|piece| !piece.is_closed()) {
        path.repetition = Repetition::FromNothing;
        return closed_times(normal, path, interrupt);
    }
    if path.largest_limit() <= 0.0 {
        // The sides touch without load.
        path.repetition = Repetition::FromNothing;
        let turn = path.turn;
        return PathWalk::new(path, 0.0, interrupt).open(0.0, turn);
    }
    let settled = settle(path)?;
    if let Some(settled) = &settled
        && let Some(holds) = rest(path, settled)?
    {
        path.repetition = Repetition::Rests(holds);
        return Ok(());
    }
    repeat(path, settled.as_ref(), interrupt)
}

/// Follows every closed time from its closing on.
fn closed_times(normal: &[Piece], path: &mut PlanePath, interrupt: &Interrupt<'_>) -> Result<()> {
    let closed_ends = [normal.first(), normal.last()].map(|p| p.is_some_and(Piece::is_closed));
    // The turn of the normal pieces begins anywhere; a closed time across its begin counts as one.
    let cut = closed_ends == [true, true];
    let end_of = |i: usize| {
        if cut && i + 1 == normal.len() {
            normal[0].end + TAU
        } else {
            normal[i].end
        }
    };
    let pieces = || normal.iter().enumerate().skip(usize::from(cut));
    // A touch may be shorter than the distance of the nodes: its limit then rises and falls between them.
    let middles = pieces()
        .filter(|(_, piece)| piece.is_closed())
        .map(|(i, piece)| path.at(piece.start + 0.5 * (end_of(i) - piece.start)).limit);
    let size = middles.fold(path.largest_limit(), f64::max);
    let mut walk = PathWalk::new(path, size, interrupt);
    for (i, piece) in pieces() {
        let end = end_of(i);
        if piece.is_closed() {
            let phase = walk.close(piece.start);
            walk.follow((piece.start, end), phase, true)?;
        } else {
            walk.open(piece.start, end)?;
        }
    }
    Ok(())
}

fn disc(at: &PlaneInstant) -> Disc {
    Disc {
        centre: at.pull,
        radius: at.limit,
    }
}

/// Time of the j-th node of the grid.
fn grid_time(path: &PlanePath, j: usize) -> f64 {
    path.spacing() * ((j / RADAU_STAGES) as f64 + path.tables.nodes[j % RADAU_STAGES])
}

/// The slider at rest by the times at which circles hold it, or midway between two circles that are apart: `moments` of
/// the path has those times, which are found anew from each place of the slider until it settles.
fn settle(path: &mut PlanePath) -> Result<Option<StuckSlider>> {
    let size = path
        .grid
        .iter()
        .fold(0.0_f64, |m, at| m.max(at.pull[0].hypot(at.pull[1])));
    path.moments.clear();
    // Along one circle the slider rests at the point nearest to 0, where a virgin one is furthest beyond its limit.
    let mut place = [0.0; 2];
    look_closer(path, place)?;
    if path.moments.is_empty() {
        // A motion whose distance from the limit does not change has no closest time; any will do.
        let furthest = furthest(path);
        let at = path.grid[furthest];
        if at.pull[0].hypot(at.pull[1]) > at.limit {
            let tau = grid_time(path, furthest);
            try_push(&mut path.moments, (tau, at), CONTEXT)?;
        }
    }
    let mut settled = None;
    for _ in 0..FRICTION_3D_PERIOD_ROUNDS {
        settled = stuck_slider(path.moments.len(), |j| disc(&path.moments[j].1));
        let Some(found) = settled else {
            break;
        };
        let change = (found.at[0] - place[0]).hypot(found.at[1] - place[1]);
        place = found.at;
        if change <= FRICTION_3D_PERIOD_SETTLED * size {
            break;
        }
        look_closer(path, place)?;
    }
    Ok(settled)
}

/// The times that hold the slider if it can rest, with the path.
fn rest(path: &mut PlanePath, settled: &StuckSlider) -> Result<Option<[Option<Hold>; 2]>> {
    // Under an odd motion the mirrored circles hold the slider back: it rests at 0 or nowhere.
    if !settled.is_common || (path.turn < TAU && settled.holding[0].is_some()) {
        return Ok(None);
    }
    let size = path
        .grid
        .iter()
        .fold(0.0_f64, |m, at| m.max(at.pull[0].hypot(at.pull[1])));
    let place = settled.at;
    let mut holds = settled.holding.map(|held| {
        held.map(|held| Hold {
            tau: path.moments[held.disc].0,
            by_pull: held.by_centre,
            by_limit: held.by_radius,
            drift: None,
        })
    });
    // A place that the circles at other times exclude is none.
    let beyond = |at: &PlaneInstant| (at.pull[0] - place[0]).hypot(at.pull[1] - place[1]) - at.limit;
    if path
        .grid
        .iter()
        .any(|at| beyond(at) > FRICTION_3D_PERIOD_ROUNDING * size)
    {
        return Ok(None);
    }
    // Two circles that hold the slider determine its place; along one it drifts as the time of the contact moves.
    if let [Some(hold), None] = &mut holds {
        hold.drift = drift(path, place, hold.tau);
    }
    path.pieces.clear();
    let pull = path.at(0.0).pull;
    let force = PlaneForce::Stick {
        force: [pull[0] - place[0], pull[1] - place[1]],
        pull,
    };
    let piece = PlanePiece {
        start: 0.0,
        end: path.turn,
        force,
        closes: false,
    };
    try_push(&mut path.pieces, piece, CONTEXT)?;
    Ok(Some(holds))
}

/// With n the normal of the circle at the slider and t across, at the time of the contact n·u′ + R′ = 0. The time moves by
/// δτ = (t·u′ t·δu/(R + |w|) − n·δu′ − δR′)/(n·u″ + R″ − (t·u′)²/(R + |w|)), and the slider by t·u′ δτ |w|/(R + |w|) along t.
fn drift(path: &PlanePath, place: [f64; 2], tau: f64) -> Option<Drift> {
    let at = path.at(tau);
    let second = [0, 1, 2].map(|i| jet(path.motion.set(), path.motion.signal(i), tau).ddx);
    let n = [(place[0] - at.pull[0]) / at.limit, (place[1] - at.pull[1]) / at.limit];
    let t = [-n[1], n[0]];
    let length = place[0].hypot(place[1]);
    let reach = at.limit + length;
    let across = t[0] * at.rate[0] + t[1] * at.rate[1];
    let bend = n[0] * second[0] + n[1] * second[1] + second[2] - across * across / reach;
    (bend != 0.0).then(|| Drift {
        place: t.map(|t| t * across * length / reach),
        by_pull: t.map(|t| t * across / (reach * bend)),
        by_rate: n.map(|n| -n / bend),
        by_limit_rate: -bend.recip(),
    })
}

/// Adds the times between the nodes at which a slider at rest is closest to its limit, or beyond it.
fn look_closer(path: &mut PlanePath, place: [f64; 2]) -> Result<()> {
    let size = path.largest_limit();
    let margin = |at: &PlaneInstant| {
        let f = [at.pull[0] - place[0], at.pull[1] - place[1]];
        (f[0].hypot(f[1]), f)
    };
    let origin = path.at(0.0);
    for k in 0..path.panels {
        let start = path.spacing() * k as f64;
        let first = path.at(start);
        // The end of the last panel is the begin of the first, to the last bit.
        let closing = (path.panels - 1) * RADAU_STAGES + RADAU_STAGES - 1;
        let node = |i: usize| match k * RADAU_STAGES + i {
            _ if i == 0 => first,
            at if at == closing + 1 => origin,
            at => path.grid[at - 1],
        };
        // The derivative of |u − w| − R, which falls through zero at a maximum.
        let rate = |at: &PlaneInstant| {
            let (length, f) = margin(at);
            if length == 0.0 {
                -at.limit_rate
            } else {
                (f[0] * at.rate[0] + f[1] * at.rate[1]) / length - at.limit_rate
            }
        };
        let rates: [f64; RADAU_POINTS] = core::array::from_fn(|i| rate(&node(i)));
        let slopes = path.tables.derivatives(&rates);
        for i in 0..RADAU_STAGES {
            let near = |i: usize| {
                let at = node(i);
                at.limit - margin(&at).0 < DEEP * size
            };
            if rates[i] > 0.0 && rates[i + 1] <= 0.0 && (near(i) || near(i + 1)) {
                let share = safe_newton(
                    path.tables.point(i),
                    path.tables.point(i + 1),
                    rates[i],
                    rates[i + 1],
                    |share| {
                        let at = path.at(start + path.spacing() * share);
                        (rate(&at), path.tables.interpolate(&slopes, share))
                    },
                );
                let tau = start + path.spacing() * share;
                let at = path.at(tau);
                if at.limit < margin(&at).0 + DEEP * size {
                    let apart = |other: f64| (tau - other).abs().min(path.turn - (tau - other).abs());
                    let same = path
                        .moments
                        .iter()
                        .position(|(other, _)| apart(*other) < NEIGHBOURS * path.spacing());
                    match same {
                        Some(same) => path.moments[same] = (tau, at),
                        None => try_push(&mut path.moments, (tau, at), CONTEXT)?,
                    }
                }
            }
        }
    }
    Ok(())
}

/// Where to start, and a force near the one that returns. A slider midway between two circles that are apart slips
/// at the times of both; after one of them it lies on that circle, up to the other it sticks.
fn guess(path: &PlanePath, settled: Option<&StuckSlider>) -> (f64, [f64; 2]) {
    let (place, from, until) = match settled.map(|settled| (settled.at, settled.holding)) {
        Some((place, [Some(a), Some(b)])) if path.turn >= TAU => {
            (place, path.moments[a.disc], Some(path.moments[b.disc].0))
        }
        _ => {
            let first = furthest(path);
            ([0.0; 2], (grid_time(path, first), path.grid[first]), None)
        }
    };
    let (from, at) = from;
    let stretch = [at.pull[0] - place[0], at.pull[1] - place[1]];
    let share = (at.limit / stretch[0].hypot(stretch[1])).min(1.0);
    let until = until.unwrap_or(from + path.turn);
    let start = from + 0.5 * (until - from).rem_euclid(path.turn + f64::EPSILON);
    let here = path.at(start);
    let slider = [at.pull[0] - share * stretch[0], at.pull[1] - share * stretch[1]];
    (start, [here.pull[0] - slider[0], here.pull[1] - slider[1]])
}

/// The node of the grid at which a virgin slider is furthest beyond its limit.
fn furthest(path: &PlanePath) -> usize {
    let beyond = |at: &PlaneInstant| at.pull[0].hypot(at.pull[1]) - at.limit;
    let further = |best: usize, j: usize| {
        if beyond(&path.grid[j]) > beyond(&path.grid[best]) {
            j
        } else {
            best
        }
    };
    (0..path.grid.len()).fold(0, further)
}

/// Follows turns until the force returns.
fn repeat(path: &mut PlanePath, settled: Option<&StuckSlider>, interrupt: &Interrupt<'_>) -> Result<()> {
    let size = path.largest_limit();
    let (start, mut force) = guess(path, settled);
    let end = start + path.turn;
    let sign = path.sign();
    let (mut before, mut is_last) = (f64::INFINITY, false);
    let (mut plain, mut between) = (1_u32, 1_u32);
    for turn in 0..TURNS {
        interrupt.check()?;
        let mut walk = PathWalk::new(path, size, interrupt);
        let begin = walk.begin(start, force);
        if let Phase::Slip { angle } = begin {
            let limit = walk.limit(start);
            force = [limit * angle.cos(), limit * angle.sin()];
        }
        let phase = walk.follow((start, end), begin, false)?;
        let (last, by) = walk.force(end, phase);
        let by = by.map(|row| row.map(|b| sign * b));
        let step = [sign * last[0] - force[0], sign * last[1] - force[1]];
        let defect = step[0].hypot(step[1]);
        path.repetition = Repetition::Returns;
        if defect <= RETURNS * size || (is_last && defect <= FRICTION_3D_PERIOD_ENOUGH * size) {
            return Ok(());
        }
        // (1 − by) δ = step
        let a = [[1.0 - by[0][0], -by[0][1]], [-by[1][0], 1.0 - by[1][1]]];
        let det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
        let newton = [
            (a[1][1] * step[0] - a[0][1] * step[1]) / det,
            (a[0][0] * step[1] - a[1][0] * step[0]) / det,
        ];
        // Newton's method knows the times of slip of this turn only. A plain turn after each step finds those that return;
        // more of them where the steps lead nowhere.
        let by_newton = plain == 0 && newton[0].hypot(newton[1]) < size;
        if by_newton {
            between = if defect < before { 1 } else { between.saturating_mul(2) };
            before = defect;
            plain = between;
        } else {
            plain = plain.saturating_sub(1);
        }
        let taken = if by_newton { newton } else { step };
        // Newton's method squares the error; slip alone reduces it by its own factor.
        let factor = by.iter().flatten().fold(0.0_f64, |m, b| m.max(b.abs()));
        is_last = turn > FRICTION_3D_PERIOD_PATIENCE
            || factor * defect <= RETURNS * size
            || (by_newton && defect <= SQUARE_RETURNS * size);
        force = [force[0] + taken[0], force[1] + taken[1]];
    }
    Err(Error::new(
        Status::NoConvergence,
        format_args!("friction in a plane: the force did not return after {TURNS} periods"),
    )
    .recoverable())
}
