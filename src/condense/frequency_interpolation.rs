//! Interpolated flexibility of a large structure along a sweep: Chebyshev panels instead of a factorisation per
//! iteration.
//!
//! The interpolated function is d(ω)·H(ω) with d = Π(ω − pₖ) over the resonances pₖ near the range, which removes
//! these poles. It is analytic away from the other resonances, so that on a panel that is short against its
//! distance from them the Chebyshev series converges geometrically (Trefethen, Approximation Theory and
//! Approximation Practice, 2013, ch. 8). Panels are added along the sweep, as wide as the tail of the series
//! allows; the derivative is that of the series.

use crate::condense::chebyshev_series::{ChebyshevSeries, MOST_INTERVALS, Samples};
use crate::condense::flexibility::Table;
use crate::condense::table_layout::TableLayout;
use crate::error::{Result, try_push, try_vec};
use num_complex::Complex64;

/// Intervals between the samples with which a panel is tried, one after the other.
const INTERVALS: [usize; 3] = [8, 16, MOST_INTERVALS];

/// Last coefficients that must be small.
const TAIL: usize = 2;

/// Last coefficients that show whether the series still converges, against as many before them.
const TREND: usize = 3;

const CONTEXT: &str = "the interpolated flexibility";

/// Attempts at one panel before it is rejected.
const MAX_ATTEMPTS: usize = 24;

/// Size of coefficients, over the tolerance, whose rounding to 24 bits is a tenth of the tolerance.
const NARROW: f64 = 0.1 / f32::EPSILON as f64;

/// Largest tail at which a panel is accepted whose convergence rounding prevents.
const NOISE: f64 = 1e-8;

/// The panels of one harmonic.
pub struct FrequencyInterpolation {
    outputs: usize,
    layout: TableLayout,
    /// A table of kept numbers, and a sample, where a half is left out.
    packed: Table,
    sample: Vec<Complex64>,
    tolerance: f64,
    resonances: Vec<Complex64>,
    /// Width of the next attempt at a panel.
    width: f64,
    /// Width of the panel added last.
    last_width: f64,
    rising: bool,
    panels: Vec<ChebyshevSeries>,
    samples: Samples,
    /// Relative size of the coefficients of the series tried last.
    decay: Vec<f64>,
    /// Number of factorisations.
    evaluations: usize,
}

impl FrequencyInterpolation {
    /// Interpolation of tables of `coordinates` contacts, symmetric or not, along a sweep over `range` = (start, end) with the
    /// given `resonances` near it, with a relative error of `tolerance`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(
        (coordinates, is_symmetric): (usize, bool),
        range: (f64, f64),
        resonances: Vec<Complex64>,
        tolerance: f64,
    ) -> Result<Self> {
        let (start, end) = range;
        let outputs = coordinates + 1;
        let layout = TableLayout::new(coordinates, is_symmetric);
        let (half, whole) = if is_symmetric {
            (layout.size(), outputs * outputs)
        } else {
            (0, 0)
        };
        Ok(Self {
            outputs,
            layout,
            packed: Table::of_size(half)?,
            sample: try_vec(whole, Complex64::ZERO, CONTEXT)?,
            tolerance,
            resonances,
            // One panel over the whole range, with the margin behind its start.
            width: 1.1 * (end - start).abs(),
            last_width: 0.0,
            rising: end >= start,
            panels: Vec::new(),
            samples: Samples::default(),
            decay: Vec::new(),
            evaluations: 0,
        })
    }

    /// Number of factorisations so far.
    #[must_use]
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// Fills `table` at `omega`, its slope if `slopes`; `sample` evaluates H by factorisation. Returns `false` if no panel
    /// of acceptable width converged here.
    ///
    /// # Errors
    /// Those of `sample`, `OutOfMemory`.
    pub fn evaluate(
        &mut self,
        (omega, slopes): (f64, bool),
        table: &mut Table,
        mut sample: impl FnMut(f64, &mut [Complex64]) -> Result<()>,
    ) -> Result<bool> {
        if self.evaluate_known((omega, slopes), table) {
            return Ok(true);
        }
        let Some(panel) = self.add_panel(omega, &mut sample)? else {
            return Ok(false);
        };
        try_push(&mut self.panels, panel, CONTEXT)?;
        Ok(self.evaluate_known((omega, slopes), table))
    }

    /// Fills `table` at `omega` where a panel is known; `false` elsewhere.
    pub fn evaluate_known(&mut self, (omega, slopes): (f64, bool), table: &mut Table) -> bool {
        let denominator = self.denominator(omega);
        let Some(panel) = self.panels.iter().rev().find(|panel| panel.holds(omega)) else {
            return false;
        };
        if self.layout.is_symmetric() {
            panel.evaluate(omega, denominator, slopes, &mut self.packed);
            self.layout.unpack(&self.packed.value, &mut table.value);
            self.layout.unpack(&self.packed.slope, &mut table.slope);
        } else {
            panel.evaluate(omega, denominator, slopes, table);
        }
        true
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
    ) -> Result<Option<ChebyshevSeries>> {
        let ends = self.panels.iter().map(ChebyshevSeries::interval);
        let below = ends.clone().map(|(_, high)| high).filter(|&x| x < omega);
        let below = below.fold(0.0, f64::max);
        let above = ends.map(|(low, _)| low).filter(|&x| x > omega);
        let above = above.fold(f64::INFINITY, f64::min);
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
            let width = high - low;
            if width <= 1e-9 * omega {
                return Ok(None);
            }
            if let Some(panel) = self.series((low, high), last_tail, sample)? {
                // Towards a resonance each panel is shorter than the one before.
                let trend = if self.last_width > 0.0 {
                    width / self.last_width
                } else {
                    1.0
                };
                self.width = width * trend.clamp(0.3, 1.0) * self.possible_widening().clamp(0.7, 4.0);
                self.last_width = width;
                return Ok(Some(panel));
            }
            last_tail = self.tail();
            let factor = 0.9 * (self.tolerance / last_tail).powf(1.0 / MOST_INTERVALS as f64);
            self.width = width * factor.clamp(0.1, 0.6);
        }
        Ok(None)
    }

    /// The series on a panel, from as few samples as suffice; `None` where all do not. `last_tail`: that of the panel tried before.
    fn series(
        &mut self,
        panel: (f64, f64),
        last_tail: f64,
        sample: &mut impl FnMut(f64, &mut [Complex64]) -> Result<()>,
    ) -> Result<Option<ChebyshevSeries>> {
        let (low, high) = panel;
        let size = self.layout.size();
        let mut samples = core::mem::take(&mut self.samples);
        samples.clear();
        for intervals in INTERVALS {
            samples.refine(intervals, size, |x, values| {
                let omega = 0.5 * (low + high) + 0.5 * (high - low) * x;
                if self.layout.is_symmetric() {
                    sample(omega, &mut self.sample)?;
                    self.layout.pack(&self.sample, values);
                } else {
                    sample(omega, values)?;
                }
                let (d, _) = self.denominator(omega);
                for v in values {
                    *v *= d;
                }
                self.evaluations += 1;
                Ok(())
            })?;
            let mut series = samples.series(panel)?;
            self.note_decay(&samples, &series)?;
            let tail = self.tail();
            let stalled = tail < NOISE && (tail > 0.3 * last_tail || self.is_level());
            if stalled {
                // This is the rounding error of the factorisations: later panels cannot be better.
                self.tolerance = self.tolerance.max(2.0 * tail);
            }
            if tail <= self.tolerance {
                let wide = self.terms_above(NARROW * self.tolerance);
                series.compress(wide, self.terms_above(self.tolerance) + 1)?;
                self.samples = samples;
                return Ok(Some(series));
            }
        }
        self.samples = samples;
        Ok(None)
    }

    /// Largest of the last coefficients of the series tried last.
    fn tail(&self) -> f64 {
        self.largest(0, TAIL)
    }

    /// Largest of so many coefficients behind which there are so many more.
    fn largest(&self, behind: usize, count: usize) -> f64 {
        let end = self.decay.len() - behind;
        self.decay[end - count..end]
            .iter()
            .fold(0.0_f64, |most, d| most.max(*d))
    }

    /// Whether the last coefficients do not fall any more.
    fn is_level(&self) -> bool {
        self.largest(0, TREND) > 0.3 * self.largest(TREND, TREND)
    }

    /// Terms of the series tried last up to the last one whose coefficients are above `least`.
    fn terms_above(&self, least: f64) -> usize {
        let last = self.decay.iter().rposition(|d| *d > least);
        last.map_or(1, |last| last + 1)
    }

    /// Factor by which a panel could have been wider. Its series reached the tolerance t at degree k, so that it
    /// converges like t^(1/k) per degree, and about as much slower as the panel is wider.
    fn possible_widening(&self) -> f64 {
        let needed = self.terms_above(3.0 * self.tolerance) + 1;
        let spare = 1.0 / needed as f64 - 1.0 / (MOST_INTERVALS - 1) as f64;
        0.9 * self.tolerance.powf(-spare)
    }

    /// Notes the relative size of the coefficients: the largest over contact flexibility, contact motion, response row and
    /// response, each against its own largest sample.
    fn note_decay(&mut self, samples: &Samples, series: &ChebyshevSeries) -> Result<()> {
        let mut largest = [0.0_f64; 4];
        for sample in samples.iter() {
            self.squares(sample, &mut largest);
        }
        self.decay.clear();
        for of_degree in series.coefficients() {
            let mut sizes = [0.0_f64; 4];
            self.squares(of_degree, &mut sizes);
            let relative = sizes.iter().zip(&largest).filter(|(_, largest)| **largest > 0.0);
            let worst = relative.fold(0.0_f64, |worst, (size, largest)| worst.max(size / largest));
            try_push(&mut self.decay, worst.sqrt(), CONTEXT)?;
        }
        Ok(())
    }

    /// Raises the largest squares of each of the four parts of a table to those of its entries.
    fn squares(&self, table: &[Complex64], largest: &mut [f64; 4]) {
        let most = |part: &[Complex64], least: f64| part.iter().fold(least, |most, z| most.max(z.norm_sqr()));
        let mut rest = table;
        for (j, from) in self.layout.columns() {
            let (column, others) = rest.split_at(self.outputs - from);
            rest = others;
            let excited = 2 * usize::from(j + 1 == self.outputs);
            let (contacts, response) = column.split_at(column.len() - 1);
            largest[excited] = most(contacts, largest[excited]);
            largest[excited + 1] = most(response, largest[excited + 1]);
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
            let mut interpolation = FrequencyInterpolation::new((0, false), (start, end), Vec::new(), 1e-11).unwrap();
            let mut table = Table::new(0).unwrap();
            for k in 0..=400 {
                let w = start + (end - start) * f64::from(k) / 400.0;
                let done = interpolation
                    .evaluate((w, true), &mut table, |w, values| {
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
    fn a_half_of_a_symmetric_table_gives_the_same_as_all_of_it() {
        // Twenty contacts, an unsymmetric row of the response, and an excitation.
        let coordinates = 20;
        let outputs = coordinates + 1;
        let fill = |w: f64, values: &mut [Complex64]| {
            for (k, z) in values.iter_mut().enumerate() {
                let (i, j) = ((k % outputs) as f64, (k / outputs) as f64);
                let inner = i.max(j) < coordinates as f64;
                let (a, b) = if inner { (i.min(j), i.max(j)) } else { (i, 2.0 * j) };
                *z = Complex64::new((w * a).cos() + b, (w + b).sin());
            }
            Ok(())
        };
        let make = |half| FrequencyInterpolation::new((coordinates, half), (0.9, 1.4), Vec::new(), 1e-11).unwrap();
        let [mut half, mut whole] = [true, false].map(make);
        let [mut a, mut b] = [0; 2].map(|_| Table::new(coordinates).unwrap());
        for k in 0..20 {
            let w = 0.9 + 0.025 * f64::from(k);
            assert!(
                half.evaluate((w, true), &mut a, fill).unwrap() && whole.evaluate((w, true), &mut b, fill).unwrap()
            );
            let mut exact = vec![Complex64::ZERO; outputs * outputs];
            fill(w, &mut exact).unwrap();
            for ((a, b), exact) in a.value.iter().zip(&b.value).zip(&exact) {
                assert!((a - b).norm() < 1e-10 && (a - exact).norm() < 1e-9);
            }
            assert!(a.slope.iter().zip(&b.slope).all(|(a, b)| (a - b).norm() < 1e-8));
        }
    }

    #[test]
    fn a_resonance_that_is_known_costs_a_single_panel() {
        let pole = (Complex64::new(4.0 - 0.002_f64.powi(2), 0.0).sqrt() + Complex64::new(0.0, 0.002)) * 0.5;
        let exact = |w: f64| 1.0 / Complex64::new(1.0 - w * w, 0.002 * w);
        let mut interpolation = FrequencyInterpolation::new((0, false), (0.9, 1.1), vec![pole], 1e-11).unwrap();
        let mut table = Table::new(0).unwrap();
        for k in 0..=100 {
            let w = 0.9 + 0.002 * f64::from(k);
            let sample = |w: f64, values: &mut [Complex64]| {
                values[0] = exact(w);
                Ok(())
            };
            assert!(interpolation.evaluate((w, true), &mut table, sample).unwrap());
            assert!((table.value[0] - exact(w)).norm() < 1e-11 * exact(w).norm());
            let slope = -exact(w) * exact(w) * Complex64::new(-2.0 * w, 0.002);
            assert!((table.slope[0] - slope).norm() < 1e-9 * slope.norm());
        }
        assert_eq!(interpolation.panels.len(), 1);
        assert_eq!(interpolation.evaluations(), 17);
    }
}
