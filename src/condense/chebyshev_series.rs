//! Tables as a function of frequency on one interval: series of Chebyshev polynomials through samples at their extrema.
//!
//! With ω = ω_m + w x, x ∈ [−1, 1], samples at xⱼ = cos(πj/N) give Σ cₖ Tₖ(x), cₖ = (2/N) Σ″ f(xⱼ) cos(πjk/N), the first and the
//! last of both sums halved (Trefethen, Approximation Theory and Approximation Practice, 2013, ch. 3). Twice as many intervals keep
//! the samples that are there.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::condense::flexibility::Table;
use crate::error::{Result, try_push, try_room, try_vec};
use crate::linalg::power_of_two;
use num_complex::{Complex, Complex64};
use pulp::bytemuck::{cast_slice, cast_slice_mut};
use pulp::{Arch, Simd, WithSimd};
use std::f64::consts::PI;

/// Most intervals between the extrema.
pub const MOST_INTERVALS: usize = 32;

/// Entries of a table that are summed at a time: sums and terms stay in the innermost memory of the processor.
const ENTRIES: usize = 256;

const CONTEXT: &str = "the interpolated flexibility";

/// The series on one interval.
pub struct ChebyshevSeries {
    low: f64,
    high: f64,
    /// cₖ, tables of values.
    coefficients: Vec<Vec<Complex64>>,
    /// The small ones behind them, over a power of two each.
    narrow: Vec<Vec<Complex<f32>>>,
    units: Vec<f64>,
}

/// Samples at extrema, in the order in which they are taken: each doubling of the intervals adds those between.
#[derive(Default)]
pub struct Samples {
    tables: Vec<Vec<Complex64>>,
    /// Angles πj/N of the samples in units of π/[`MOST_INTERVALS`].
    angles: Vec<usize>,
}

impl Samples {
    /// Leaves no samples.
    pub fn clear(&mut self) {
        self.tables.clear();
        self.angles.clear();
    }

    /// Adds those samples that are missing for so many intervals, a power of two; `sample` fills a table of `size` at x.
    ///
    /// # Errors
    /// Those of `sample`; `OutOfMemory`.
    pub fn refine(
        &mut self,
        intervals: usize,
        size: usize,
        mut sample: impl FnMut(f64, &mut [Complex64]) -> Result<()>,
    ) -> Result<()> {
        for angle in (0..=MOST_INTERVALS).step_by(MOST_INTERVALS / intervals) {
            if !self.angles.contains(&angle) {
                let mut table = try_vec(size, Complex64::ZERO, CONTEXT)?;
                sample(cosine(angle), &mut table)?;
                try_push(&mut self.tables, table, CONTEXT)?;
                try_push(&mut self.angles, angle, CONTEXT)?;
            }
        }
        Ok(())
    }

    /// The samples in the order of x, from 1 to −1.
    pub fn in_order(&self) -> impl Iterator<Item = &[Complex64]> {
        (0..=MOST_INTERVALS).filter_map(|angle| self.of_angle(angle))
    }

    /// The sample at the end x = 1 or x = −1.
    #[must_use]
    pub fn at(&self, end: f64) -> Option<&[Complex64]> {
        self.of_angle(if end > 0.0 { 0 } else { MOST_INTERVALS })
    }

    fn of_angle(&self, angle: usize) -> Option<&[Complex64]> {
        let at = self.angles.iter().position(|known| *known == angle)?;
        Some(&self.tables[at])
    }

    /// The series through the samples on an interval.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn series(&self, (low, high): (f64, f64)) -> Result<ChebyshevSeries> {
        let count = self.tables.len();
        let intervals = count - 1;
        let end = |at: bool| if at { 0.5 } else { 1.0 };
        let mut weights = try_vec(count * count, 0.0, CONTEXT)?;
        let mut coefficients = Vec::new();
        for (k, row) in weights.chunks_exact_mut(count).enumerate() {
            let factor = 2.0 / intervals as f64 * end(k == 0 || k == intervals);
            for (weight, &angle) in row.iter_mut().zip(&self.angles) {
                *weight = factor * end(angle % MOST_INTERVALS == 0) * cosine(k * angle);
            }
            let table = try_vec(self.tables[0].len(), Complex64::ZERO, CONTEXT)?;
            try_push(&mut coefficients, table, CONTEXT)?;
        }
        Arch::new().dispatch(Transform {
            samples: &self.tables,
            weights: &weights,
            coefficients: &mut coefficients,
        });
        Ok(ChebyshevSeries {
            narrow: Vec::new(),
            units: Vec::new(),
            low,
            high,
            coefficients,
        })
    }
}

/// cos of so many times π/[`MOST_INTERVALS`], the angle reduced to one turn.
fn cosine(angle: usize) -> f64 {
    let reduced = angle % (2 * MOST_INTERVALS);
    (PI * reduced as f64 / MOST_INTERVALS as f64).cos()
}

impl ChebyshevSeries {
    /// Whether a frequency is on the interval.
    #[must_use]
    pub fn holds(&self, omega: f64) -> bool {
        self.low <= omega && omega <= self.high
    }

    /// Ends of the interval.
    #[must_use]
    pub fn interval(&self) -> (f64, f64) {
        (self.low, self.high)
    }

    /// cₖ
    pub fn coefficients(&self) -> impl Iterator<Item = &[Complex64]> {
        self.coefficients.iter().map(Vec::as_slice)
    }

    /// Leaves out the terms behind so many, and keeps those behind `wide` in half the memory.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn compress(&mut self, wide: usize, count: usize) -> Result<()> {
        self.coefficients.truncate(count);
        for coefficients in self.coefficients.drain(wide.min(count)..) {
            let size = coefficients
                .iter()
                .fold(0.0_f64, |size, z| size.max(z.re.abs()).max(z.im.abs()));
            let unit = power_of_two(size);
            let mut narrow = try_room(coefficients.len(), CONTEXT)?;
            let as_narrow = |x: f64| (x / unit) as f32;
            narrow.extend(
                coefficients
                    .iter()
                    .map(|z| Complex::new(as_narrow(z.re), as_narrow(z.im))),
            );
            try_push(&mut self.narrow, narrow, CONTEXT)?;
            try_push(&mut self.units, unit, CONTEXT)?;
        }
        Ok(())
    }

    /// Fills a table with the value of the series S over d(ω), and its slope, where `with_slopes`, with (S′ − d′ S/d)/d, from
    /// d and d′, or with 0. T′ₖ = k Uₖ₋₁.
    pub fn evaluate(&self, omega: f64, denominator: (Complex64, Complex64), with_slopes: bool, table: &mut Table) {
        let stretch = 2.0 / (self.high - self.low);
        let x = (2.0 * omega - self.low - self.high) / (self.high - self.low);
        let [mut values, mut slopes] = [[0.0; MOST_INTERVALS + 1]; 2];
        let count = self.coefficients.len() + self.narrow.len();
        let (mut t, mut t_next) = (1.0, x);
        // U₋₁ and U₀
        let (mut u_before, mut u) = (0.0, 1.0);
        for (k, (value, slope)) in values.iter_mut().zip(&mut slopes).enumerate().take(count) {
            (*value, *slope) = (t, k as f64 * u_before * stretch);
            (t, t_next) = (t_next, 2.0 * x * t_next - t);
            (u_before, u) = (u, 2.0 * x * u - u_before);
        }
        for weights in [&mut values, &mut slopes] {
            for (weight, unit) in weights[self.coefficients.len()..].iter_mut().zip(&self.units) {
                *weight *= unit;
            }
        }
        Arch::new().dispatch(Values {
            coefficients: &self.coefficients,
            narrow: &self.narrow,
            weights: [&values[..count], if with_slopes { &slopes[..count] } else { &[] }],
            denominator,
            table,
        });
    }
}

/// Terms that are added at a time: sums are read and written as much less often.
const AT_ONCE: usize = 4;

/// cₖ ← Σ wₖⱼ f(xⱼ)
struct Transform<'a> {
    samples: &'a [Vec<Complex64>],
    weights: &'a [f64],
    coefficients: &'a mut [Vec<Complex64>],
}

impl WithSimd for Transform<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let count = self.samples.len();
        for from in (0..self.samples[0].len()).step_by(ENTRIES) {
            for (to, weights) in self.coefficients.iter_mut().zip(self.weights.chunks_exact(count)) {
                let end = to.len().min(from + ENTRIES);
                let part = |k: usize| cast_slice::<Complex64, f64>(&self.samples[k][from..end]);
                add(cast_slice_mut(&mut to[from..end]), weights, part);
            }
        }
    }
}

/// Σ cₖ Tₖ/d and its derivative.
struct Values<'a> {
    coefficients: &'a [Vec<Complex64>],
    narrow: &'a [Vec<Complex<f32>>],
    /// Tₖ and their derivatives by ω where slopes are wanted, those of narrow coefficients with their units.
    weights: [&'a [f64]; 2],
    denominator: (Complex64, Complex64),
    table: &'a mut Table,
}

impl WithSimd for Values<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let inverse = self.denominator.0.inv();
        let Table { value, slope } = self.table;
        let mut from = 0;
        for (value, slope) in value.chunks_mut(ENTRIES).zip(slope.chunks_mut(ENTRIES)) {
            let end = from + value.len();
            let wide = |k: usize| cast_slice::<Complex64, f64>(&self.coefficients[k][from..end]);
            let narrow = |k: usize| cast_slice::<Complex<f32>, f32>(&self.narrow[k][from..end]);
            for (sum, weights) in [&mut *value, &mut *slope].into_iter().zip(self.weights) {
                sum.fill(Complex64::ZERO);
                if weights.is_empty() {
                    continue;
                }
                let (of_wide, of_narrow) = weights.split_at(self.coefficients.len());
                add(cast_slice_mut(sum), of_wide, wide);
                add(cast_slice_mut(sum), of_narrow, narrow);
            }
            for (v, s) in value.iter_mut().zip(slope) {
                *v *= inverse;
                if !self.weights[1].is_empty() {
                    *s = (*s - self.denominator.1 * *v) * inverse;
                }
            }
            from = end;
        }
    }
}

/// sum ← sum + Σ wₖ tₖ
#[inline(always)]
fn add<'a, T: Copy + Into<f64> + 'a>(sum: &mut [f64], weights: &[f64], term: impl Fn(usize) -> &'a [T]) {
    let (groups, last) = weights.as_chunks::<AT_ONCE>();
    for (group, w) in groups.iter().enumerate() {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| &term(AT_ONCE * group + k)[..sum.len()]);
        for i in 0..sum.len() {
            sum[i] += w[0] * a[i].into() + w[1] * b[i].into() + (w[2] * c[i].into() + w[3] * d[i].into());
        }
    }
    for (k, w) in last.iter().enumerate() {
        for (s, t) in sum.iter_mut().zip(term(AT_ONCE * groups.len() + k)) {
            *s += w * (*t).into();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_is_reproduced_with_its_slope_from_more_samples_than_it_has_coefficients() {
        let exact = |w: f64, i: usize| (w.powi(5) - 3.0 * w + i as f64) * Complex64::new(1.0, -0.5 * i as f64);
        let slope = |w: f64, i: usize| (5.0 * w.powi(4) - 3.0) * Complex64::new(1.0, -0.5 * i as f64);
        // More entries than are summed at a time.
        let mut table = Table::new(19).unwrap();
        let size = table.value.len();
        assert!(size > ENTRIES);
        let (low, high) = (0.7, 1.9);
        let mut samples = Samples::default();
        let mut taken = 0;
        for intervals in [8, 16, 32] {
            let fill = |x: f64, table: &mut [Complex64]| {
                let w = 0.5 * (low + high) + 0.5 * (high - low) * x;
                for (i, z) in table.iter_mut().enumerate() {
                    *z = exact(w, i);
                }
                taken += 1;
                Ok(())
            };
            samples.refine(intervals, size, fill).unwrap();
            assert_eq!(taken, intervals + 1);
            // All terms in full, or the last three in half the memory.
            for (wide, error) in [(6, 1e-13), (3, 2e-7)] {
                let mut series = samples.series((low, high)).unwrap();
                let largest = |c: &[Complex64]| c.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
                let sizes: Vec<f64> = series.coefficients().map(largest).collect();
                assert!(sizes[5] > 1e-6 * sizes[0]);
                assert!(sizes[6..].iter().all(|&c| c < 1e-14 * sizes[0]), "{sizes:?}");
                series.compress(wide, 6).unwrap();
                // Over d = ω².
                for w in [0.7, 0.9, 1.33, 1.9] {
                    assert!(series.holds(w));
                    let mut values = Table::of_size(size).unwrap();
                    values.slope.fill(1.0.into());
                    for (slopes, table) in [(true, &mut table), (false, &mut values)] {
                        series.evaluate(w, ((w * w).into(), (2.0 * w).into()), slopes, table);
                    }
                    assert_eq!(values.value, table.value);
                    assert!(values.slope.iter().all(|z| *z == Complex64::ZERO));
                    for i in 0..size {
                        let value = exact(w, i) / (w * w);
                        let by_omega = slope(w, i) / (w * w) - 2.0 * value / w;
                        let error = error * (1.0 + i as f64).powi(2);
                        assert!((table.value[i] - value).norm() < error, "{wide}, {i} at {w}");
                        assert!((table.slope[i] - by_omega).norm() < 10.0 * error, "{wide}, {i} at {w}");
                    }
                }
            }
        }
    }
}
