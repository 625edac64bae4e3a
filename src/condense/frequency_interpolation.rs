//! Interpolated flexibility of a large structure along a sweep: Chebyshev panels instead of a factorisation per
//! iteration.
//!
//! The interpolated function is d(ω)·H(ω) with d = Π(ω − pₖ) over the resonances pₖ near the range, which removes
//! these poles. It is analytic away from the other resonances, so that on a panel that is short against its
//! distance from them the Chebyshev series converges geometrically (Trefethen, Approximation Theory and
//! Approximation Practice, 2013, ch. 8). Panels are added along the sweep, as wide as the tail of the series
//! allows; the derivative is that of the series.

use crate::condense::flexibility::Table;
use crate::error::{Result, try_copy, try_push, try_vec};
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use num_complex::Complex64;
use std::f64::consts::PI;

/// Samples per panel.
const NODES: usize = 24;

/// Samples with which a panel is tried first: every third of the others.
const FEW: usize = NODES / 3;

const CONTEXT: &str = "the interpolated flexibility";

/// Attempts at one panel before it is accepted at the accuracy that rounding allows, or rejected.
const MAX_ATTEMPTS: usize = 24;

/// Share of the tolerance below which the last coefficients are left out.
const NEGLIGIBLE: f64 = 1e-2;

/// Largest tail at which a panel is accepted whose convergence rounding prevents.
const NOISE: f64 = 1e-8;

/// One interval with its series.
struct Panel {
    low: f64,
    high: f64,
    /// Degrees × table size, degree by degree.
    coefficients: Vec<Complex64>,
}

/// The panels of one harmonic.
pub struct FrequencyInterpolation {
    outputs: usize,
    tolerance: f64,
    resonances: Vec<Complex64>,
    /// Width of the next attempt at a panel.
    width: f64,
    /// Width of the panel added last.
    last_width: f64,
    rising: bool,
    panels: Vec<Panel>,
    samples: Vec<Complex64>,
    /// Degrees of the series tried last, and the relative size of the coefficients of each.
    degrees: usize,
    decay: [f64; NODES],
    /// Number of factorisations.
    evaluations: usize,
}

impl FrequencyInterpolation {
    /// Interpolation of tables of `coordinates` contacts along a sweep over `range` = (start, end) with the given
    /// `resonances` near it, with a relative error of `tolerance`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(coordinates: usize, range: (f64, f64), resonances: Vec<Complex64>, tolerance: f64) -> Result<Self> {
        let (start, end) = range;
        let outputs = coordinates + 1;
        let size = NODES.saturating_mul(outputs.saturating_mul(outputs));
        Ok(Self {
            outputs,
            tolerance,
            resonances,
            // One panel over the whole range, with the margin behind its start.
            width: 1.1 * (end - start).abs(),
            last_width: 0.0,
            rising: end >= start,
            panels: Vec::new(),
            samples: try_vec(size, Complex64::ZERO, CONTEXT)?,
            degrees: 0,
            decay: [0.0; NODES],
            evaluations: 0,
        })
    }

    /// Number of factorisations so far.
    #[must_use]
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// Fills `table` at `omega`; `sample` evaluates H by factorisation. Returns `false` if no panel of acceptable
    /// width converged here.
    ///
    /// # Errors
    /// Those of `sample`, `OutOfMemory`.
    pub fn evaluate(
        &mut self,
        omega: f64,
        table: &mut Table,
        mut sample: impl FnMut(f64, &mut [Complex64]) -> Result<()>,
    ) -> Result<bool> {
        let found = self.panels.iter().rposition(|p| p.low <= omega && omega <= p.high);
        let index = match found {
            Some(index) => index,
            None => match self.add_panel(omega, &mut sample)? {
                Some(panel) => {
                    try_push(&mut self.panels, panel, CONTEXT)?;
                    self.panels.len() - 1
                }
                None => return Ok(false),
            },
        };
        self.panels[index].evaluate(omega, table);
        let (d, d_slope) = self.denominator(omega);
        let inverse = d.inv();
        for (value, slope) in table.value.iter_mut().zip(&mut table.slope) {
            *value *= inverse;
            *slope = (*slope - d_slope * *value) * inverse;
        }
        Ok(true)
    }

    /// d(ω), its factors scaled by the size of their resonances, and d′(ω).
    fn denominator(&self, omega: f64) -> (Complex64, Complex64) {
        let (mut d, mut slope) = (Complex64::ONE, Complex64::ZERO);
        for p in &self.resonances {
            let scale = 1.0 / p.norm();
            let factor = (omega - p) * scale;
            slope = slope * factor + d * scale;
            d *= factor;
        }
        (d, slope)
    }

    /// Adds a panel over `omega`, beside its neighbours.
    fn add_panel(
        &mut self,
        omega: f64,
        sample: &mut impl FnMut(f64, &mut [Complex64]) -> Result<()>,
    ) -> Result<Option<Panel>> {
        let below = self
            .panels
            .iter()
            .map(|p| p.high)
            .filter(|&x| x < omega)
            .fold(0.0, f64::max);
        let above = self
            .panels
            .iter()
            .map(|p| p.low)
            .filter(|&x| x > omega)
            .fold(f64::INFINITY, f64::min);
        let mut last_tail = f64::INFINITY;
        for _ in 0..MAX_ATTEMPTS {
            // A small margin behind, in case the corrector steps back.
            let back = 0.05 * self.width;
            let (low, high) = if self.rising {
                let low = below.max(omega - back);
                (low, (low + self.width).min(above).max(omega))
            } else {
                let high = above.min(omega + back);
                ((high - self.width).max(below).min(omega), high)
            };
            if high - low <= 1e-9 * omega {
                return Ok(None);
            }
            let series = self.series((low, high), sample)?;
            let (tail, is_level) = (self.tail(), self.is_level());
            let stalled = tail < NOISE && (tail > 0.3 * last_tail || is_level);
            if stalled {
                // This is the rounding error of the factorisations: later panels cannot be better.
                self.tolerance = self.tolerance.max(2.0 * tail);
            }
            if tail <= self.tolerance {
                // Beyond them rounding, or next to nothing.
                let least = if is_level { 1.0 } else { NEGLIGIBLE } * self.tolerance;
                let needed = self.degrees_above(least) * self.outputs * self.outputs;
                let coefficients = try_copy(&series[..needed], CONTEXT)?;
                // Towards a resonance each panel is shorter than the one before.
                let width = high - low;
                let trend = if self.last_width > 0.0 {
                    width / self.last_width
                } else {
                    1.0
                };
                self.width = width * trend.clamp(0.3, 1.0) * self.possible_widening().clamp(0.7, 4.0);
                self.last_width = width;
                return Ok(Some(Panel {
                    low,
                    high,
                    coefficients,
                }));
            }
            last_tail = tail;
            let factor = 0.9 * (self.tolerance / tail).powf(1.0 / (NODES - 1) as f64);
            self.width = (high - low) * factor.clamp(0.1, 0.6);
        }
        Ok(None)
    }

    /// Largest of the last coefficients of the series tried last.
    fn tail(&self) -> f64 {
        let last = if self.degrees == FEW { 3 } else { 2 };
        self.decay[self.degrees - last..self.degrees]
            .iter()
            .fold(0.0, |tail, d| tail.max(*d))
    }

    /// Whether the coefficients of the last half of all degrees do not fall any more.
    fn is_level(&self) -> bool {
        let most = |part: &[f64]| part.iter().fold(0.0_f64, |most, d| most.max(*d));
        let (before, last) = self.decay[NODES / 2..].split_at(NODES / 4);
        self.degrees == NODES && most(last) > 0.3 * most(before)
    }

    /// Degrees of the series tried last up to the last one whose coefficients are above `least`.
    fn degrees_above(&self, least: f64) -> usize {
        let last = self.decay[..self.degrees].iter().rposition(|d| *d > least);
        last.map_or(1, |last| last + 1)
    }

    /// Factor by which a panel could have been wider. Its series reached the tolerance t at degree k, so that it
    /// converges like t^(1/k) per degree, and about as much slower as the panel is wider.
    fn possible_widening(&self) -> f64 {
        let needed = self.degrees_above(3.0 * self.tolerance) + 1;
        let spare = 1.0 / needed as f64 - 1.0 / (NODES - 2) as f64;
        0.9 * self.tolerance.powf(-spare)
    }

    /// The series on a panel, degree by degree: from few samples where these are enough, else from all.
    fn series(
        &mut self,
        panel: (f64, f64),
        sample: &mut impl FnMut(f64, &mut [Complex64]) -> Result<()>,
    ) -> Result<Vec<Complex64>> {
        let is_of_few = |j: &usize| j % 3 == 1;
        self.take_samples((0..NODES).filter(is_of_few), panel, sample)?;
        let coefficients = self.transform(FEW)?;
        if self.tail() <= self.tolerance {
            return Ok(coefficients);
        }
        self.take_samples((0..NODES).filter(|j| !is_of_few(j)), panel, sample)?;
        self.transform(NODES)
    }

    /// Samples d·H at some of the nodes of a panel.
    fn take_samples(
        &mut self,
        nodes: impl Iterator<Item = usize>,
        (low, high): (f64, f64),
        sample: &mut impl FnMut(f64, &mut [Complex64]) -> Result<()>,
    ) -> Result<()> {
        let size = self.outputs * self.outputs;
        for j in nodes {
            let x = (PI * (j as f64 + 0.5) / NODES as f64).cos();
            let omega = 0.5 * (low + high) + 0.5 * (high - low) * x;
            let (d, _) = self.denominator(omega);
            let values = &mut self.samples[j * size..(j + 1) * size];
            sample(omega, values)?;
            for v in values {
                *v *= d;
            }
            self.evaluations += 1;
        }
        Ok(())
    }

    /// Turns samples into coefficients of so many degrees, and notes their relative size: the largest over contact
    /// flexibility, contact motion, response row and response, each against its own largest value.
    fn transform(&mut self, degrees: usize) -> Result<Vec<Complex64>> {
        let size = self.outputs * self.outputs;
        let (first, stride) = if degrees == FEW { (1, 3) } else { (0, 1) };
        let mut cosines = try_vec(degrees * degrees, Complex64::ZERO, CONTEXT)?;
        for (k, row) in cosines.chunks_exact_mut(degrees).enumerate() {
            let factor = if k == 0 { 1.0 } else { 2.0 } / degrees as f64;
            for (j, z) in row.iter_mut().enumerate() {
                // cos(kπ(2j + 1)/(2N)), the angle reduced to one turn.
                let angle = PI * ((k * (2 * j + 1)) % (4 * degrees)) as f64 / (2 * degrees) as f64;
                *z = (factor * angle.cos()).into();
            }
        }
        let mut coefficients = try_vec(degrees * size, Complex64::ZERO, CONTEXT)?;
        matmul(
            MatMut::from_row_major_slice_mut(&mut coefficients, degrees, size),
            Accum::Replace,
            MatRef::from_row_major_slice(&cosines, degrees, degrees),
            MatRef::from_row_major_slice_with_stride(&self.samples[first * size..], degrees, size, stride * size),
            Complex64::ONE,
            Par::Seq,
        );
        let mut largest = [0.0_f64; 4];
        for j in (first..NODES).step_by(stride) {
            self.squares(&self.samples[j * size..(j + 1) * size], &mut largest);
        }
        self.degrees = degrees;
        for (k, of_degree) in coefficients.chunks_exact(size).enumerate() {
            let mut sizes = [0.0_f64; 4];
            self.squares(of_degree, &mut sizes);
            let relative = sizes.iter().zip(&largest).filter(|(_, largest)| **largest > 0.0);
            self.decay[k] = relative
                .fold(0.0_f64, |worst, (size, largest)| worst.max(size / largest))
                .sqrt();
        }
        Ok(coefficients)
    }

    /// Raises the largest squares of each of the four parts of a table to those of its entries.
    fn squares(&self, table: &[Complex64], largest: &mut [f64; 4]) {
        let most = |part: &[Complex64], least: f64| part.iter().fold(least, |most, z| most.max(z.norm_sqr()));
        for (j, column) in table.chunks_exact(self.outputs).enumerate() {
            let excited = 2 * usize::from(j + 1 == self.outputs);
            let (contacts, response) = column.split_at(self.outputs - 1);
            largest[excited] = most(contacts, largest[excited]);
            largest[excited + 1] = most(response, largest[excited + 1]);
        }
    }
}

impl Panel {
    /// Σ cₖ Tₖ(x) and its derivative, T′ₖ = k Uₖ₋₁.
    fn evaluate(&self, omega: f64, table: &mut Table) {
        let x = (2.0 * omega - self.low - self.high) / (self.high - self.low);
        let stretch = 2.0 / (self.high - self.low);
        table.value.fill(Complex64::ZERO);
        table.slope.fill(Complex64::ZERO);
        let size = table.value.len();
        let (mut t, mut t_next) = (1.0, x);
        let (mut u_before, mut u) = (0.0, 1.0);
        for (k, coefficients) in self.coefficients.chunks_exact(size).enumerate() {
            // uₖ₋₁ is in `u_before` shifted by one: U₋₁ = 0, U₀ = 1.
            let slope = k as f64 * u_before * stretch;
            for ((v, s), c) in table.value.iter_mut().zip(&mut table.slope).zip(coefficients) {
                *v += t * c;
                *s += slope * c;
            }
            (t, t_next) = (t_next, 2.0 * x * t_next - t);
            (u_before, u) = (u, 2.0 * x * u - u_before);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sweep_over_a_sharp_resonance_is_reproduced_with_its_slope() {
        // One mode with Q = 500: H = 1/(1 - w^2 + 0.002 i w), in both directions.
        let exact = |w: f64| 1.0 / Complex64::new(1.0 - w * w, 0.002 * w);
        let slope = |w: f64| -exact(w) * exact(w) * Complex64::new(-2.0 * w, 0.002);
        for (start, end) in [(0.9, 1.1), (1.1, 0.9)] {
            let mut interpolation = FrequencyInterpolation::new(0, (start, end), Vec::new(), 1e-11).unwrap();
            let mut table = Table::new(0).unwrap();
            for k in 0..=400 {
                let w = start + (end - start) * f64::from(k) / 400.0;
                let done = interpolation
                    .evaluate(w, &mut table, |w, values| {
                        values[0] = exact(w);
                        Ok(())
                    })
                    .unwrap();
                assert!(done);
                assert!(
                    (table.value[0] - exact(w)).norm() < 1e-9 * exact(w).norm(),
                    "{w}: {:.2e}",
                    (table.value[0] - exact(w)).norm() / exact(w).norm()
                );
                assert!(
                    (table.slope[0] - slope(w)).norm() < 1e-6 * slope(w).norm(),
                    "{w}: {:.2e}",
                    (table.slope[0] - slope(w)).norm() / slope(w).norm()
                );
            }
            assert!(interpolation.evaluations() < 600, "{}", interpolation.evaluations());
        }
    }

    #[test]
    fn a_resonance_that_is_known_costs_a_single_panel() {
        let pole = (Complex64::new(4.0 - 0.002_f64.powi(2), 0.0).sqrt() + Complex64::new(0.0, 0.002)) * 0.5;
        let exact = |w: f64| 1.0 / Complex64::new(1.0 - w * w, 0.002 * w);
        let mut interpolation = FrequencyInterpolation::new(0, (0.9, 1.1), vec![pole], 1e-11).unwrap();
        let mut table = Table::new(0).unwrap();
        for k in 0..=100 {
            let w = 0.9 + 0.002 * f64::from(k);
            let sample = |w: f64, values: &mut [Complex64]| {
                values[0] = exact(w);
                Ok(())
            };
            assert!(interpolation.evaluate(w, &mut table, sample).unwrap());
            assert!((table.value[0] - exact(w)).norm() < 1e-11 * exact(w).norm());
            let slope = -exact(w) * exact(w) * Complex64::new(-2.0 * w, 0.002);
            assert!((table.slope[0] - slope).norm() < 1e-9 * slope.norm());
        }
        assert_eq!(interpolation.evaluations(), NODES);
    }
}
