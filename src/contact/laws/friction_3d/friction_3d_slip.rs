//! One panel of slip of friction in a plane, by collocation, and the first zero of a margin in a panel.
//!
//! In slip the force R e(θ) turns with the motion u = kt·x at the rate R θ′ = n·u′, n a quarter turn left of e. Slip lasts while
//! kt·γ = e·u′ − R′ ≥ 0.

use crate::contact::forms::plane_path::{PlaneInstant, SlipPanel};
use crate::contact::forms::radau::{RADAU_POINTS, RADAU_STAGES, RadauTables};
use crate::interrupt::Interrupt;
use crate::linalg::factors::lu::Lu;
use crate::roots::safe_newton;

/// Newton iterations of a panel, after which it is halved.
/// Kind: cap.
const FRICTION_3D_SLIP_ITERATIONS: usize = 12;

/// A step of Newton's method after which the next would be rounding.
/// Kind: rounding.
const FRICTION_3D_SLIP_LAST_STEP: f64 = 1e-8;

/// Largest turn of the first guess.
/// Kind: tuned; measured on: not recorded.
const LARGEST_GUESS: f64 = 0.3;

/// Largest turn between two nodes.
/// Kind: tuned; measured on: not recorded.
const LARGEST_TURN: f64 = 1.0;

/// A margin this small, against its scale, is zero up to rounding, unless rounding of the motion is larger.
/// Kind: rounding.
pub(crate) const FRICTION_3D_SLIP_ROUNDING: f64 = 1e-13;

/// Halvings of the first interval in which a margin is sought that rises from zero before it falls. A shorter time of stick or slip is
/// left out: its force matters by the third power of the time.
/// Kind: cap.
const FRICTION_3D_SLIP_HALVINGS: usize = 20;

/// The turn by a constant speed 1 across the motion, as far as a panel continues it: R δθ′ = 1 − e·u′ δθ.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Across {
    /// Size of its last two terms in Legendre polynomials.
    pub tail: f64,
    /// Its value at the end.
    pub end: f64,
}

/// A solved panel.
pub(crate) struct Solved {
    pub panel: SlipPanel,
    /// Size of the last two terms of θ in Legendre polynomials.
    pub tail: f64,
    /// The response to a speed across the motion.
    pub across: Across,
    /// Derivative of the angle at the end by the one at the start.
    pub by_start: f64,
}

/// Slip over a panel of length `h` from `angle`, where it turns at the rate `rate` and by `turned` for a speed 1 across; `None` where
/// Newton's method does not converge.
pub(crate) fn solve(
    tables: &RadauTables,
    lu: &mut Lu<f64>,
    (h, angle, rate, turned): (f64, f64, f64, f64),
    nodes: &[PlaneInstant; RADAU_STAGES],
) -> Option<Solved> {
    let mut panel = SlipPanel {
        angle,
        angles: tables
            .nodes
            .map(|c| angle + (c * h * rate).clamp(-LARGEST_GUESS, LARGEST_GUESS)),
        directions: [[0.0; 2]; RADAU_STAGES],
        limits: nodes.each_ref().map(|at| at.limit),
        along: [0.0; RADAU_STAGES],
        across: [0.0; RADAU_STAGES],
    };
    let mut step = [f64::INFINITY; RADAU_STAGES];
    let mut rates = [0.0; RADAU_STAGES];
    for _ in 0..FRICTION_3D_SLIP_ITERATIONS {
        turn(&mut panel, nodes);
        for (rate, (across, limit)) in rates.iter_mut().zip(panel.across.iter().zip(&panel.limits)) {
            *rate = across / limit;
        }
        if largest(&step) < FRICTION_3D_SLIP_LAST_STEP {
            break;
        }
        for (i, step) in step.iter_mut().enumerate() {
            let sum: f64 = tables.integrals[i].iter().zip(&rates).map(|(a, g)| a * g).sum();
            *step = angle + h * sum - panel.angles[i];
        }
        let matrix = lu.matrix();
        for j in 0..RADAU_STAGES {
            let slope = -h * panel.along[j] / panel.limits[j];
            for i in 0..RADAU_STAGES {
                matrix[j * RADAU_STAGES + i] = f64::from(u8::from(i == j)) - slope * tables.integrals[i][j];
            }
        }
        // The order is fixed and small: there is nothing to interrupt.
        if lu.factor(&Interrupt::none()).is_err() {
            return None;
        }
        lu.solve(&mut step);
        for (angle, step) in panel.angles.iter_mut().zip(&step) {
            *angle += step;
        }
    }
    let turns_slowly = panel
        .points()
        .windows(2)
        .all(|pair| (pair[1] - pair[0]).abs() < LARGEST_TURN);
    if largest(&step).is_nan() || largest(&step) >= FRICTION_3D_SLIP_LAST_STEP || !turns_slowly {
        return None;
    }
    let tail = |values: &[f64; RADAU_STAGES]| {
        let last = |row: &[f64; RADAU_STAGES]| row.iter().zip(values).map(|(c, g)| c * g).sum::<f64>().abs();
        tables.tail.iter().map(last).sum::<f64>()
    };
    let mut ones = [1.0; RADAU_STAGES];
    lu.solve(&mut ones);
    let mut across: [f64; RADAU_STAGES] = core::array::from_fn(|i| {
        let sum = tables.integrals[i].iter().zip(&panel.limits);
        turned + h * sum.map(|(a, limit)| a / limit).sum::<f64>()
    });
    lu.solve(&mut across);
    Some(Solved {
        panel,
        tail: h * tail(&rates),
        across: Across {
            tail: tail(&across),
            end: across[RADAU_STAGES - 1],
        },
        by_start: ones[RADAU_STAGES - 1],
    })
}

/// θ′ in slip; 0 where it is not finite, as at a closing.
pub(crate) fn turn_rate(at: &PlaneInstant, angle: f64) -> f64 {
    let (sin, cos) = angle.sin_cos();
    let rate = (cos * at.rate[1] - sin * at.rate[0]) / at.limit;
    if rate.is_finite() { rate } else { 0.0 }
}

/// A panel, too short to matter, over which the force turns to the motion at once: the limit is nearly zero.
pub(crate) fn along_motion(nodes: &[PlaneInstant; RADAU_STAGES], angle: f64) -> Solved {
    let last = nodes[RADAU_STAGES - 1];
    let turned = last.rate[1].atan2(last.rate[0]);
    let (sin, cos) = turned.sin_cos();
    Solved {
        panel: SlipPanel {
            angle,
            angles: [turned; RADAU_STAGES],
            directions: [[cos, sin]; RADAU_STAGES],
            limits: nodes.each_ref().map(|at| at.limit.max(f64::MIN_POSITIVE)),
            along: nodes.each_ref().map(|at| cos * at.rate[0] + sin * at.rate[1]),
            across: [0.0; RADAU_STAGES],
        },
        tail: 0.0,
        across: Across::default(),
        by_start: 0.0,
    }
}

/// Directions at the angles, and the parts of u′ along and across them.
fn turn(panel: &mut SlipPanel, nodes: &[PlaneInstant; RADAU_STAGES]) {
    for (j, at) in nodes.iter().enumerate() {
        let (sin, cos) = panel.angles[j].sin_cos();
        panel.directions[j] = [cos, sin];
        panel.along[j] = cos * at.rate[0] + sin * at.rate[1];
        panel.across[j] = cos * at.rate[1] - sin * at.rate[0];
    }
}

fn largest(values: &[f64]) -> f64 {
    values
        .iter()
        .fold(0.0, |m, x| if x.abs() > m || x.is_nan() { x.abs() } else { m })
}

/// The share of a panel after which a margin, given at its points in units of its scale, first falls below zero. `margin` returns it
/// and its derivative at a share. A margin up to `rounding` counts as zero at the begin, and any where it is zero there by a previous
/// event.
pub(crate) fn first_zero(
    tables: &RadauTables,
    values: &[f64; RADAU_POINTS],
    (is_zero, rounding): (bool, f64),
    mut margin: impl FnMut(f64) -> (f64, f64),
) -> Option<f64> {
    let slopes = tables.derivatives(values);
    let bends = tables.derivatives(&slopes);
    for i in 0..RADAU_STAGES {
        let (from, to) = (tables.point(i), tables.point(i + 1));
        let (before, after) = (values[i], values[i + 1]);
        let begins_at_zero = i == 0 && (is_zero || before <= rounding);
        if after < 0.0 {
            if begins_at_zero {
                return Some(return_to_zero((to, after), rounding, &mut margin));
            }
            return Some(safe_newton(from, to, before, after, &mut margin));
        }
        // A dip between the points.
        if !begins_at_zero && slopes[i] < 0.0 && slopes[i + 1] > 0.0 {
            let lowest = safe_newton(from, to, slopes[i], slopes[i + 1], |share| {
                (margin(share).1, tables.interpolate(&bends, share))
            });
            let low = margin(lowest).0;
            if low < 0.0 {
                return Some(safe_newton(from, lowest, before, low, &mut margin));
            }
        }
    }
    None
}

/// The share at which a margin that begins at zero, and is below it at `end`, falls below zero. It may rise first: where stick begins,
/// its slope vanishes as well, and a stick may be shorter than the first interval.
fn return_to_zero(end: (f64, f64), rounding: f64, margin: &mut impl FnMut(f64) -> (f64, f64)) -> f64 {
    let mut end = end;
    for _ in 0..FRICTION_3D_SLIP_HALVINGS {
        let share = 0.5 * end.0;
        let value = margin(share).0;
        if value > rounding {
            return safe_newton(share, end.0, value, end.1, margin);
        }
        if value >= 0.0 {
            break;
        }
        end = (share, value);
    }
    0.0
}
