//! Parameter values at which a linear response is computed, placed by its resonances.
//!
//! Near a pole ω + iσ the response is that of one mode, a circle in the complex plane: points at ω + σ tan θ divide it
//! evenly. Between two poles, where it varies with the distance from the nearer one, the points are equidistant in the
//! logarithm of that distance.

use crate::error::{Result, try_push};
use crate::model::natural_modes::resonances::Resonance;
use crate::options::Range;
use num_complex::Complex64;

/// Distances from a pole in half widths. Those of equidistant poles that overlap do not coincide.
/// Kind: tuned; measured on: not recorded.
const RESONANCE_GRID_NEAR: [f64; 5] = [0.0, 0.4, 1.0, 1.8, 5.0];

/// Points beside a pole, from the last of [`RESONANCE_GRID_NEAR`] to the middle between two poles.
/// Kind: tuned; measured on: not recorded.
const RESONANCE_GRID_BESIDE: usize = 5;

/// Least ratio of the distances of two such points.
/// Kind: tuned; measured on: not recorded.
const RESONANCE_GRID_RATIO: f64 = 2.0;

/// Ratio from which the response between two poles is computed in their middle, too.
/// Kind: tuned; measured on: random chains and dense matrices, whose maxima between resonances are known.
const RESONANCE_GRID_WIDE: f64 = 3.0;

/// Equidistant points over the whole range.
/// Kind: tuned; measured on: not recorded.
const BASE: usize = 36;

/// Half width relative to the frequency that is assumed of an undamped resonance, so that it is passed at a distance.
/// Kind: tuned; measured on: not recorded.
const RESONANCE_GRID_UNDAMPED: f64 = 1e-4;

const CONTEXT: &str = "the frequencies of a linear response";

/// Parameter values at which the linear response is computed.
pub(crate) struct LinearGrid {
    /// Parameter values of the grid, ascending.
    values: Vec<f64>,
    /// The resonances, ascending.
    poles: Vec<Resonance>,
    /// The first undamped one that was passed and is excited: the response is unbounded there.
    pub unbounded: Option<f64>,
}

impl LinearGrid {
    /// The grid over a whole range `(low, high)`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(poles: Vec<Resonance>, range: Range) -> Result<Self> {
        Ok(Self {
            values: values(&poles, range)?,
            poles,
            unbounded: None,
        })
    }

    /// Parameter values of undamped resonances.
    pub fn undamped(&self) -> impl Iterator<Item = f64> + '_ {
        self.poles
            .iter()
            .filter(|pole| pole.is_undamped())
            .map(|pole| pole.omega)
    }

    /// The complex poles next to the interval between two values, below and above it.
    pub fn poles_beside(&self, from: f64, to: f64) -> PolesBeside {
        let above = self.poles.partition_point(|pole| pole.omega < from.max(to));
        let below = self.poles.partition_point(|pole| pole.omega <= from.min(to));
        let poles = [below.checked_sub(1), Some(above)].map(|place| {
            let pole = self.poles.get(place?)?;
            Some(Complex64::new(pole.omega, pole.half_width))
        });
        PolesBeside {
            poles,
            ..PolesBeside::none(from, to)
        }
    }

    /// The next value of the grid after `value`, or a nearer one at the distance `most`.
    pub fn after(&self, value: f64, rising: bool, most: f64) -> Option<f64> {
        if rising {
            let next = self.values.partition_point(|&x| x <= value);
            return self.values.get(next).map(|next| next.min(value + most));
        }
        let next = self.values.partition_point(|&x| x < value);
        next.checked_sub(1).map(|i| self.values[i].max(value - most))
    }
}

/// An interval with the poles next to it. A response z is a sum over poles: freed of these two, q z with q = (p − p₁)(p − p₂) is
/// smooth over the interval.
pub(crate) struct PolesBeside {
    pub from: f64,
    pub width: f64,
    poles: [Option<Complex64>; 2],
}

impl PolesBeside {
    /// An interval whose poles are not known: q = 1.
    pub fn none(from: f64, to: f64) -> Self {
        Self {
            from,
            width: to - from,
            poles: [None; 2],
        }
    }

    /// The value of the parameter at a share s of the interval.
    pub fn at(&self, s: f64) -> f64 {
        self.from + s * self.width
    }

    /// q and dq/ds at a share s of the interval, in units of its width.
    pub fn factor(&self, s: f64) -> (Complex64, Complex64) {
        let mut factor = (Complex64::ONE, Complex64::ZERO);
        for pole in self.poles.into_iter().flatten() {
            let distance = (self.from - pole) / self.width + s;
            factor = (factor.0 * distance, factor.1 * distance + factor.0);
        }
        factor
    }
}

/// Values within the whole range `(low, high)`, ascending, its ends included.
///
/// # Errors
/// `OutOfMemory`.
fn values(resonances: &[Resonance], range: Range) -> Result<Vec<f64>> {
    let (low, high) = (range.low(), range.high());
    let mut found = Vec::new();
    let mut add = |value: f64| {
        if value > low && value < high {
            try_push(&mut found, value, CONTEXT)?;
        }
        Ok(())
    };
    for i in 1..BASE {
        add(low + (high - low) * i as f64 / BASE as f64)?;
    }
    for (i, pole) in resonances.iter().enumerate() {
        let (width, nearest) = if pole.is_undamped() {
            (RESONANCE_GRID_UNDAMPED * pole.omega, 1)
        } else {
            (pole.half_width, 0)
        };
        let middle = |other: Option<&Resonance>, end: f64| other.map_or(end, |o| 0.5 * (pole.omega + o.omega));
        let before = i.checked_sub(1).and_then(|j| resonances.get(j));
        for (sense, bound) in [(-1.0, middle(before, low)), (1.0, middle(resonances.get(i + 1), high))] {
            // The middle itself serves both neighbours.
            let reach = sense * (bound - pole.omega);
            for &x in RESONANCE_GRID_NEAR[nearest.max(usize::from(sense > 0.0))..]
                .iter()
                .filter(|&&x| x * width <= reach)
            {
                add(pole.omega + sense * x * width)?;
            }
            let first = RESONANCE_GRID_NEAR[RESONANCE_GRID_NEAR.len() - 1] * width;
            let ratio = (reach / first)
                .powf(1.0 / RESONANCE_GRID_BESIDE as f64)
                .max(RESONANCE_GRID_RATIO);
            let mut distance = first * ratio;
            for _ in 0..RESONANCE_GRID_BESIDE {
                if distance >= reach / ratio.sqrt() {
                    break;
                }
                add(pole.omega + sense * distance)?;
                distance *= ratio;
            }
            if sense > 0.0 && ratio > RESONANCE_GRID_WIDE {
                add(bound)?;
            }
        }
    }
    try_push(&mut found, low, CONTEXT)?;
    try_push(&mut found, high, CONTEXT)?;
    found.sort_by(f64::total_cmp);
    found.dedup_by(|b, a| *b - *a <= 4.0 * f64::EPSILON * b.abs());
    // A point next to an end would make a step of rounding.
    if let Some(last) = found.last_mut() {
        *last = high;
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_of_neighbours_has_a_bound_if_one_is_given() {
        let grid = LinearGrid::new(Vec::new(), (0.0, 1.0).into()).unwrap();
        for (most, count) in [(f64::INFINITY, BASE), (0.01, 3 * BASE)] {
            for rising in [true, false] {
                let (mut at, end) = if rising { (0.0, 1.0) } else { (1.0, 0.0) };
                let mut steps = 0;
                while let Some(next) = grid.after(at, rising, most) {
                    assert!((next - at).abs() <= most * (1.0 + 1e-12) && (next > at) == rising);
                    at = next;
                    steps += 1;
                }
                assert_eq!((at, steps), (end, count));
            }
        }
    }

    #[test]
    fn points_are_dense_at_each_of_many_resonances_and_few() {
        for (count, damping, gap) in [(1, 1e-7, 1.0), (5, 1e-5, 1e-4), (300, 1e-3, 1e-3), (20, 1e-2, 1e-4)] {
            let poles: Vec<Resonance> = (0..count)
                .map(|i| {
                    let omega = 1.0 + gap * f64::from(i);
                    Resonance {
                        omega,
                        half_width: damping * omega,
                    }
                })
                .collect();
            let range = Range::new(0.5, 1.5 + gap * f64::from(count));
            let found = values(&poles, range).unwrap();
            assert!(found.len() <= 40 + 20 * poles.len(), "{}", found.len());
            assert!(found.windows(2).all(|w| w[0] < w[1]));
            let ends = [found[0], found[found.len() - 1]].map(f64::to_bits);
            assert_eq!(ends, [range.start, range.stop].map(f64::to_bits));
            for pole in &poles {
                let nearest = found.iter().map(|x| (x - pole.omega).abs());
                assert!(nearest.fold(f64::INFINITY, f64::min) <= 1e-14);
            }
        }
    }
}
