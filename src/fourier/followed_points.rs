//! Turning points followed from those of a neighbouring motion.
//!
//! Householder's method leads from each old time to a new one. There x″ = a and x‴ = b, and |x⁗| ≤ d everywhere, so that x″ keeps its
//! sign as long as |a| ± b·s − d·s²/2 > 0: within that interval x′ has this root and no other, and Taylor's formula bounds |x′|
//! at its ends from below. Between such intervals and the points of the grid x′ keeps its sign where it is larger, at both ends,
//! than it can depart from its chord. Cells of the grid in which that holds throughout need no isolation; all others are searched
//! as without old times. A turning point that came or went is therefore never missed, whatever the old times are.

use crate::fourier::HarmonicSet;
use crate::fourier::roots::{householder, is_last};
use crate::fourier::series::{Approach, last_step};

/// A turning point and the interval in which it is the only one.
#[derive(Clone, Copy)]
pub(super) struct Followed {
    pub(super) tau: f64,
    pub(super) x: f64,
    /// The interval, each end with a bound of x′ there, on its side of zero.
    low: (f64, f64),
    high: (f64, f64),
}

/// Largest number of values of the series that a followed root takes.
const MOST_VALUES: usize = 4;

/// Share of an interval that is used, which leaves room for rounding.
const SHARE: f64 = 0.99;

/// Largest bend of x′ in a step, beyond which the old root is of no use.
const LARGEST_BEND: f64 = 0.3;

impl Followed {
    /// The root of x′ near an old one, if Householder's method finds it at once; `bound` is one of |x⁗|.
    fn near(set: &HarmonicSet, packed: &[f64], old: f64, bound: f64) -> Option<Self> {
        let mut signal = Approach::new(set, packed);
        let (short, mut tau) = (last_step(set), old);
        for _ in 0..MOST_VALUES {
            let at = signal.at(tau);
            let (step, by_curvature) = householder([at.dx, at.ddx, at.dddx, at.fourth]);
            let far = by_curvature.abs() > LARGEST_BEND || step.abs() > SHARE;
            if far || by_curvature.is_nan() || step.is_nan() {
                return None;
            }
            if is_last(step, by_curvature, short) {
                // Times from here and slopes, both counted so that x″ > 0.
                let side = at.ddx.signum();
                let (slope, bend, rise) = (side * at.dx, at.ddx.abs(), side * at.dddx);
                let root = (rise * rise + 2.0 * bound * bend).sqrt();
                let end = |s: f64| {
                    let least = s * (bend + 0.5 * s * (rise - s.abs() * bound / 3.0)) + slope;
                    (tau + s, side * least)
                };
                return Some(Self {
                    tau: tau - step,
                    x: at.value_after(-step),
                    low: end(SHARE * (rise - root) / bound),
                    high: end(SHARE * (rise + root) / bound),
                });
            }
            tau -= step;
        }
        None
    }

    /// The same root a turn later, or half a turn, where the motion has the other sign.
    fn shifted(self, turn: f64, sign: f64) -> Self {
        Self {
            tau: self.tau + turn,
            x: sign * self.x,
            low: (self.low.0 + turn, sign * self.low.1),
            high: (self.high.0 + turn, sign * self.high.1),
        }
    }
}

/// Followed roots in ascending order, with the last one before the turn and the first one after it.
pub(super) struct FollowedPoints {
    points: Vec<Followed>,
    /// The first root whose interval may hold the next cell.
    next: usize,
}

impl FollowedPoints {
    pub(super) fn new() -> Self {
        Self {
            points: Vec::new(),
            next: 0,
        }
    }

    /// Memory for so many roots.
    pub(super) fn reserve(&mut self, roots: usize) -> Result<(), std::collections::TryReserveError> {
        self.points.try_reserve_exact(roots + 2)
    }

    pub(super) fn clear(&mut self) {
        self.points.clear();
        self.next = 0;
    }

    /// Follows old roots; `turn` is 2π, or π for sets of odd harmonics, after which the motion has the other sign.
    pub(super) fn follow(&mut self, set: &HarmonicSet, packed: &[f64], old: &[f64], bound: f64, turn: f64) {
        self.clear();
        let sign = if set.is_odd() { -1.0 } else { 1.0 };
        for &tau in old {
            let Some(point) = Followed::near(set, packed, tau, bound) else {
                continue;
            };
            // Two old roots may lead to one.
            if self.points.last().is_none_or(|last| last.high.0 < point.tau) {
                if self.points.is_empty() {
                    // The place of the last root, before the turn.
                    self.points.push(point);
                }
                self.points.push(point);
            }
        }
        let (Some(&first), Some(&last)) = (self.points.first(), self.points.last()) else {
            return;
        };
        let (before, after) = (last.shifted(-turn, sign), first.shifted(turn, sign));
        if after.tau > last.high.0 {
            self.points.push(after);
        }
        if before.tau < first.low.0 {
            self.points[0] = before;
        } else {
            self.next = 1;
        }
    }

    /// The roots in a cell, if they are all; `bend` is a bound of |x‴|, and the ends of the cell have their values of x′. Cells
    /// come in ascending order.
    #[inline]
    pub(super) fn all_within(&mut self, mut from: (f64, f64), end: (f64, f64), bend: f64) -> Option<&[Followed]> {
        let begin = from.0;
        while self.points.get(self.next)?.high.0 < begin {
            self.next += 1;
        }
        let keeps_sign = |a: (f64, f64), b: (f64, f64)| {
            let width = b.0 - a.0;
            width <= 0.0 || a.1 * b.1 > 0.0 && a.1.abs().min(b.1.abs()) > 0.125 * bend * width * width
        };
        let (mut first, mut last) = (self.next, self.next);
        for (k, point) in self.points.iter().enumerate().skip(self.next) {
            if point.low.0 >= end.0 {
                break;
            }
            if !keeps_sign(from, point.low) {
                return None;
            }
            from = point.high;
            if point.tau < begin {
                first = k + 1;
            }
            if point.tau < end.0 {
                last = k + 1;
            }
        }
        keeps_sign(from, end).then(|| &self.points[first..last.max(first)])
    }
}

#[cfg(test)]
mod tests {
    use crate::fourier::series::jet;
    use crate::fourier::{Extremum, HarmonicSet, TurningPoints};
    use crate::interrupt::Interrupt;
    use num_complex::Complex64;
    use std::f64::consts::PI;

    /// Followed and isolated turning points of motions one after the other.
    struct Both {
        set: HarmonicSet,
        search: TurningPoints,
        followed: Vec<Extremum>,
        isolated: Vec<Extremum>,
        times: Vec<f64>,
    }

    impl Both {
        fn new(highest: usize, odd: bool) -> Self {
            let set = HarmonicSet::excited(&[1], highest, true, odd, false).unwrap();
            let mut search = TurningPoints::new(&set).unwrap();
            search.reserve_followed(&set).unwrap();
            Self {
                set,
                search,
                followed: Vec::new(),
                isolated: Vec::new(),
                times: Vec::new(),
            }
        }

        /// Compares both at a motion. Times of nearly double roots are not known to rounding; x, and x′ = 0, are.
        fn compare(&mut self, packed: &[f64]) -> usize {
            let none = Interrupt::none();
            let Self { set, search, .. } = self;
            search.find(set, packed, &mut self.isolated, &none).unwrap();
            search
                .find_near(set, packed, &self.times, &mut self.followed, &none)
                .unwrap();
            let size: f64 = packed.iter().map(|a| a.abs()).sum();
            let highest = set.highest_reduced() as f64;
            let turn = if set.is_odd() { PI } else { 2.0 * PI };
            assert_eq!(self.followed.len(), self.isolated.len());
            assert!(self.followed.windows(2).all(|pair| pair[0].tau < pair[1].tau));
            for (a, b) in self.followed.iter().zip(&self.isolated) {
                assert!((0.0..turn).contains(&a.tau));
                assert!((a.x - b.x).abs() < 3e-14 * size, "{a:?} and {b:?}");
                let at = jet(set, packed, a.tau);
                assert!(at.dx.abs() < 1e-14 * size * highest * highest, "{:e}", at.dx);
                let apart = (a.tau - b.tau).abs();
                assert!(apart * at.ddx.abs() < 3e-14 * size * highest * highest, "{apart:e}");
            }
            self.times.clear();
            self.times.extend(self.followed.iter().map(|e| e.tau));
            self.followed.len()
        }
    }

    /// Numbers between −1 and 1.
    fn random(seed: &mut u64) -> f64 {
        *seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    #[test]
    fn followed_points_are_those_of_the_isolation_on_random_paths() {
        let mut seed = 7;
        let (mut changes, mut total) = (0, 0);
        for highest in [1, 2, 3, 5, 9, 15, 31, 63] {
            for odd in [false, true] {
                let mut both = Both::new(highest, odd);
                let m = both.set.packed_len();
                for decay in [0.5, 1.0, 2.0, 3.0] {
                    let mut motion = || -> Vec<f64> {
                        let of = |i: usize| (1.0 + (i / 2) as f64).powf(-decay);
                        (0..m).map(|i| of(i) * random(&mut seed)).collect()
                    };
                    let (from, to) = (motion(), motion());
                    // Steps from those of a last iteration to those from one motion to another.
                    let mut share = 0.0;
                    for step in [1e-9, 1e-6, 1e-4, 1e-3, 1e-2, 3e-2, 0.1, 0.3] {
                        let mut last = None;
                        for _ in 0..12 {
                            share += step;
                            let packed: Vec<f64> = (0..m).map(|i| from[i] + share * (to[i] - from[i])).collect();
                            let count = both.compare(&packed);
                            changes += usize::from(last.is_some_and(|last| last != count));
                            total += 1;
                            last = Some(count);
                        }
                    }
                }
            }
        }
        // Turning points come and go along these paths.
        assert!(changes > 200, "{changes} of {total}");
    }

    #[test]
    fn a_pair_that_comes_or_goes_is_seen_from_either_side() {
        // x′ = −sin t + b sin 3t has roots at 0 and ±e, e² = (3b − 1)/(4b); old times of one or of three roots.
        for odd in [false, true] {
            let mut both = Both::new(3, odd);
            for shift in [0.0, 1e-17, 1e-9, 0.37, 1.234, PI - 1e-9, PI] {
                for (excess, count) in [
                    (1e-2, 3),
                    (-1e-2, 1),
                    (1e-4, 3),
                    (1e-6, 3),
                    (-1e-6, 1),
                    (1e-8, 3),
                    (-1e-8, 1),
                    (1e-6, 3),
                    (0.5, 3),
                    (-0.9, 1),
                ] {
                    let b = (1.0 + excess) / 3.0;
                    let (x1, x3) = (Complex64::cis(shift), -Complex64::cis(3.0 * shift) * b / 3.0);
                    let packed = if odd {
                        vec![x1.re, x1.im, x3.re, x3.im]
                    } else {
                        vec![0.0, x1.re, x1.im, 0.0, 0.0, x3.re, x3.im]
                    };
                    let found = both.compare(&packed);
                    assert_eq!(found, if odd { count } else { 2 * count }, "{excess:e}, {shift}");
                }
            }
        }
    }

    #[test]
    fn any_old_times_lead_to_the_same_points() {
        let mut seed = 3;
        for (highest, odd) in [(5, false), (9, true), (31, false)] {
            let mut both = Both::new(highest, odd);
            let turn = if odd { PI } else { 2.0 * PI };
            for _ in 0..400 {
                let packed: Vec<f64> = (0..both.set.packed_len())
                    .map(|i| random(&mut seed) / (1.0 + i as f64))
                    .collect();
                both.times.clear();
                for _ in 0..8 {
                    both.times.push(0.5 * turn * (1.0 + random(&mut seed)));
                }
                both.times.sort_unstable_by(f64::total_cmp);
                both.times.extend([f64::NAN, f64::INFINITY]);
                let twice = both.times[0];
                both.times.insert(0, twice);
                both.compare(&packed);
            }
        }
    }
}
