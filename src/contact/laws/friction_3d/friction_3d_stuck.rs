//! Place of the slider of friction in a plane that sticks through the period.
//!
//! A force f = kt·(x − w) with the slider at rest at w stays within its limit if w lies in every disc
//! |w − xⱼ| ≤ ρⱼ = μNⱼ/kt about the motion at a sample; within a step, where x and ρ are linear, the
//! ends suffice, because |w − x| − ρ is convex. If the discs have points in common, each of them is a
//! periodic state; if not, slip continues, and with it the memory of the past is lost: the march is a
//! map that brings no two states apart, and slip brings them together.
//!
//! The solution is the common point nearest to the virgin slider at 0,
//!
//! > w = argmin |w| over the intersection of the discs:
//!
//! 0 itself, or a point on one circle, or the corner of two. On a line it is the clamp
//! w = clamp(0; max(x − ρ), min(x + ρ)) of a virgin slider loaded slowly. It is a continuous function of the
//! discs, the last point at which they have one in common included, and does not depend on where the
//! period begins.
//!
//! The point is found as in other problems of low dimension (Sharir & Welzl 1992): at most two discs hold
//! it; the most violated one is added, and of the three those that hold the new point are found. Every round
//! moves the point further out, so that their number is finite.

use std::f64::consts::FRAC_1_SQRT_2;

/// A disc |w − centre| ≤ radius.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Disc {
    pub centre: [f64; 2],
    /// Infinite for the whole plane.
    pub radius: f64,
}

/// A disc that holds the slider, with the derivatives of w by its centre, rows first, and its radius.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Holding {
    pub disc: usize,
    pub by_centre: [[f64; 2]; 2],
    pub by_radius: [f64; 2],
}

/// The slider at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StuckSlider {
    pub at: [f64; 2],
    /// None where the slider is virgin, one disc or two.
    pub holding: [Option<Holding>; 2],
    /// Whether the discs have the point in common. If not, it lies midway between two that are apart.
    pub is_common: bool,
}

/// Violations below this, relative to the current lengths, are rounding.
/// Kind: rounding.
const FRICTION_3D_STUCK_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Gap between two discs, relative to the size of the motion, that is no rounding.
/// Kind: rounding.
const CLEARLY: f64 = 1e-6;

/// Directions along which discs are compared, unit vectors at 0, 45, 90 and 135 degrees.
/// Kind: fixed.
const DIRECTIONS: [[f64; 2]; 4] = [
    [1.0, 0.0],
    [FRAC_1_SQRT_2, FRAC_1_SQRT_2],
    [0.0, 1.0],
    [-FRAC_1_SQRT_2, FRAC_1_SQRT_2],
];

/// Largest number of discs that are added; a few suffice but for a cycle by rounding.
/// Kind: cap.
const FRICTION_3D_STUCK_ROUNDS: usize = 200;

impl Disc {
    /// Distance of `w` outside the disc; not above 0 for points that are inside to rounding.
    fn violation(&self, w: [f64; 2]) -> f64 {
        let [x, y] = self.centre;
        let size = x.abs() + y.abs() + w[0].abs() + w[1].abs();
        (w[0] - x).hypot(w[1] - y) - self.radius - FRICTION_3D_STUCK_ROUNDING * size
    }

    /// Its point nearest to 0, which lies outside.
    fn nearest(&self) -> [f64; 2] {
        let share = 1.0 - self.radius / self.centre[0].hypot(self.centre[1]);
        self.centre.map(|x| share * x)
    }

    /// The intersection of two circles nearer to 0.
    fn corner(&self, other: &Self) -> Option<[f64; 2]> {
        let across = [other.centre[0] - self.centre[0], other.centre[1] - self.centre[1]];
        let distance = across[0].hypot(across[1]);
        let [ux, uy] = across.map(|x| x / distance);
        let along = 0.5 * (distance + (self.radius - other.radius) * ((self.radius + other.radius) / distance));
        let square = (self.radius - along) * (self.radius + along);
        if square.is_nan() || square < 0.0 {
            return None;
        }
        let foot = [self.centre[0] + along * ux, self.centre[1] + along * uy];
        let height = if uy * foot[0] > ux * foot[1] {
            square.sqrt()
        } else {
            -square.sqrt()
        };
        Some([foot[0] - height * uy, foot[1] + height * ux])
    }
}

/// The point nearest to 0 that `count` discs have in common. If there is none, the point midway between two
/// that are apart, where they are found, else nothing.
///
/// Shortly before slip ends, two discs are hardly apart. A little slip at both takes the slider to that point, but
/// the slower the nearer it is, so that it is good to begin there.
pub(crate) fn stuck_slider(count: usize, disc: impl Fn(usize) -> Disc) -> Option<StuckSlider> {
    if let Some((a, b)) = clearly_apart(count, &disc) {
        return midway(a, b, &disc);
    }
    let mut at = [0.0; 2];
    let mut held: [Option<usize>; 2] = [None; 2];
    for _ in 0..FRICTION_3D_STUCK_ROUNDS {
        let mut worst = (0.0, None);
        for j in 0..count {
            let violation = disc(j).violation(at);
            if violation > worst.0 {
                worst = (violation, Some(j));
            }
        }
        let Some(new) = worst.1 else {
            return written(at, held, disc);
        };
        match among(new, held, &disc) {
            Some(next) => (at, held) = next,
            None => return held.iter().flatten().find_map(|&other| midway(new, other, &disc)),
        }
    }
    None
}

/// Two discs whose shadows along some direction are apart, by more than rounding: slip needs no search. The direction of the
/// largest gap among a few.
fn clearly_apart(count: usize, disc: &impl Fn(usize) -> Disc) -> Option<(usize, usize)> {
    // The largest lower end and the smallest upper end of the shadows, along each direction.
    let mut ends = [((f64::NEG_INFINITY, 0), (f64::INFINITY, 0)); DIRECTIONS.len()];
    let mut size = 0.0_f64;
    for j in 0..count {
        let Disc { centre: [x, y], radius } = disc(j);
        size = size.max(x.abs() + y.abs());
        for ([c, s], (low, high)) in DIRECTIONS.iter().zip(&mut ends) {
            let at = c * x + s * y;
            if at - radius > low.0 {
                *low = (at - radius, j);
            }
            if at + radius < high.0 {
                *high = (at + radius, j);
            }
        }
    }
    let gap = |(low, high): &((f64, usize), (f64, usize))| low.0 - high.0;
    let widest = ends.iter().max_by(|a, b| gap(a).total_cmp(&gap(b)))?;
    (gap(widest) > CLEARLY * size).then_some((widest.0.1, widest.1.1))
}

/// The point nearest to 0 in the disc `new`, which holds it, and in those that held it before.
fn among(
    new: usize,
    held: [Option<usize>; 2],
    disc: &impl Fn(usize) -> Disc,
) -> Option<([f64; 2], [Option<usize>; 2])> {
    let added = disc(new);
    let inside = |w: [f64; 2]| held.iter().flatten().all(|&j| disc(j).violation(w) <= 0.0);
    let alone = added.nearest();
    if inside(alone) {
        return Some((alone, [Some(new), None]));
    }
    let size = |w: [f64; 2]| w[0].hypot(w[1]);
    let mut best: Option<([f64; 2], usize)> = None;
    for &other in held.iter().flatten() {
        if let Some(corner) = added.corner(&disc(other))
            && inside(corner)
            && best.is_none_or(|(w, _)| size(corner) < size(w))
        {
            best = Some((corner, other));
        }
    }
    best.map(|(w, other)| (w, [Some(new), Some(other)]))
}

/// The point midway between two discs that are apart. With the unit vector u from centre a to centre b at the
/// distance c, and n across, w = xₐ + λ(x_b − xₐ) with λ = (c + ρₐ − ρ_b)/2c, so that
/// u·δw = u·(δxₐ + δx_b)/2 + (δρₐ − δρ_b)/2, n·δw = n·((1 − λ)δxₐ + λδx_b).
fn midway(a: usize, b: usize, disc: &impl Fn(usize) -> Disc) -> Option<StuckSlider> {
    let (first, second) = (disc(a), disc(b));
    let across: [f64; 2] = std::array::from_fn(|i| second.centre[i] - first.centre[i]);
    let distance = across[0].hypot(across[1]);
    if distance.is_nan() || distance <= first.radius + second.radius {
        return None;
    }
    let u = across.map(|x| x / distance);
    let share = 0.5 * (1.0 + (first.radius - second.radius) / distance);
    let of = |disc: usize, share: f64, sign: f64| {
        let unit = |i: usize, k: usize| if i == k { share } else { 0.0 };
        Some(Holding {
            disc,
            by_centre: std::array::from_fn(|i| std::array::from_fn(|k| unit(i, k) + (0.5 - share) * u[i] * u[k])),
            by_radius: u.map(|u| 0.5 * sign * u),
        })
    };
    Some(StuckSlider {
        at: std::array::from_fn(|i| first.centre[i] + share * across[i]),
        holding: [of(a, 1.0 - share, 1.0), of(b, share, -1.0)],
        is_common: false,
    })
}

/// With its derivatives. On one circle w = x − ρe, e = x/|x|; at a corner nₐ·δw = nₐ·δxₐ − δρₐ for both
/// circles, nₐ the normal of the one at w.
fn written(at: [f64; 2], held: [Option<usize>; 2], disc: impl Fn(usize) -> Disc) -> Option<StuckSlider> {
    let normal = |j: usize| {
        let Disc { centre, radius } = disc(j);
        [(centre[0] - at[0]) / radius, (centre[1] - at[1]) / radius]
    };
    let holding = match held {
        [Some(a), Some(b)] => {
            let (na, nb) = (normal(a), normal(b));
            let turn = na[0] * nb[1] - na[1] * nb[0];
            // Circles that only touch: the point has no derivative.
            if turn == 0.0 {
                return None;
            }
            let of = |disc: usize, n: [f64; 2], column: [f64; 2]| Holding {
                disc,
                by_centre: column.map(|c| [c * n[0], c * n[1]]),
                by_radius: column.map(|c| -c),
            };
            [
                Some(of(a, na, [nb[1] / turn, -nb[0] / turn])),
                Some(of(b, nb, [-na[1] / turn, na[0] / turn])),
            ]
        }
        [Some(a), None] => {
            let Disc { centre, radius } = disc(a);
            let length = centre[0].hypot(centre[1]);
            let (share, e) = (radius / length, centre.map(|x| x / length));
            let unit = |i: usize, k: usize| if i == k { 1.0 - share } else { 0.0 };
            [
                Some(Holding {
                    disc: a,
                    by_centre: std::array::from_fn(|i| std::array::from_fn(|k| unit(i, k) + share * e[i] * e[k])),
                    by_radius: e.map(|e| -e),
                }),
                None,
            ]
        }
        _ => [None; 2],
    };
    Some(StuckSlider {
        at,
        holding,
        is_common: true,
    })
}
