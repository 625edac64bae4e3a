//! Interpolated flexibility of a large structure along a sweep: Chebyshev panels instead of a factorisation per
//! iteration.
//!
//! The interpolated function is d(ω)·H(ω) with d = Π(ω − pₖ) over the resonances pₖ near the panel, which removes
//! these poles. It is analytic away from the other resonances, so that on a panel that is short against its
//! distance from them the Chebyshev series converges geometrically (Trefethen, Approximation Theory and
//! Approximation Practice, 2013, ch. 8). Panels are added along the sweep, as wide as the tail of the series
//! allows; the derivative is that of the series. A panel is compared with H where it is used first and at its ends, and is
//! not used where it deviates.

use crate::condense::chebyshev_series::{ChebyshevSeries, MOST_INTERVALS, Samples};
use crate::condense::flexibility::Table;
use crate::condense::series_decay::SeriesDecay;
use crate::condense::table_layout::{TableLayout, deviation};
use crate::error::{Result, try_push, try_room, try_vec};
use num_complex::Complex64;

/// Intervals between the samples with which a panel is tried, one after the other.
const INTERVALS: [usize; 3] = [8, 16, MOST_INTERVALS];

const CONTEXT: &str = "the interpolated flexibility";

/// Attempts at one panel before it is rejected.
const MAX_ATTEMPTS: usize = 24;

/// Size of coefficients, over the tolerance, whose rounding to 24 bits is a tenth of the tolerance.
const NARROW: f64 = 0.1 / f32::EPSILON as f64;

/// Largest tail at which a panel is accepted whose convergence rounding prevents.
const NOISE: f64 = 1e-10;

/// Most resonances that are divided out on one panel: each takes one more term of the series.
const MOST_ON_A_PANEL: usize = 12;

/// Distance from a panel, in its widths, up to which resonances are divided out.
const BESIDE_PANEL: f64 = 0.5;

/// Deviation of a panel from H, over the tolerance, with which it is used.
const AGREES: f64 = 10.0;

/// Panels that deviate until no more are made.
const MOST_REFUSED: usize = 2;

/// One panel: d·H, and the resonances in d.
struct Panel {
    series: ChebyshevSeries,
    resonances: Vec<Complex64>,
}

/// The panels of one harmonic.
pub struct FrequencyInterpolation {
    outputs: usize,
    layout: TableLayout,
    /// A table of kept numbers, where a half is left out.
    packed: Table,
    /// Numbers of a whole table.
    sample: Vec<Complex64>,
    tolerance: f64,
    resonances: Vec<Complex64>,
    /// Width of the next attempt at a panel.
    width: f64,
    /// Width of the panel added last.
    last_width: f64,
    rising: bool,
    panels: Vec<Panel>,
    samples: Samples,
    decay: SeriesDecay,
    /// Number of panels that were not used.
    refused: usize,
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
        let half = if is_symmetric { layout.size() } else { 0 };
        Ok(Self {
            outputs,
            layout,
            packed: Table::of_size(half)?,
            sample: try_vec(outputs * outputs, Complex64::ZERO, CONTEXT)?,
            tolerance,
            resonances,
            // One panel over the whole range, with the margin behind its start.
            width: 1.1 * (end - start).abs(),
            last_width: 0.0,
            rising: end >= start,
            panels: Vec::new(),
            samples: Samples::default(),
            decay: SeriesDecay::new(layout),
            refused: 0,
            evaluations: 0,
        })
    }

    /// Number of factorisations so far.
    #[must_use]
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// Fills `table` at `omega`, its slope if `slopes`; `sample` evaluates H by factorisation. Returns `false` if no panel
    /// of acceptable width converged here, or the one that did deviates from H.
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
        if self.refused >= MOST_REFUSED {
            return Ok(false);
        }
        let Some(panel) = self.add_panel(omega, &mut sample)? else {
            return Ok(false);
        };
        let (low, high) = panel.interval();
        try_push(&mut self.panels, panel, CONTEXT)?;
        // The samples at its ends are known.
        let is_inside = low < omega && omega < high;
        if self.gives_its_ends(table) && (!is_inside || self.gives(omega, table, &mut sample)?) {
            return Ok(self.evaluate_known((omega, slopes), table));
        }
        self.panels.pop();
        self.refused += 1;
        Ok(false)
    }

    /// Fills `table` at `omega` where a panel is known; `false` elsewhere.
    pub fn evaluate_known(&mut self, (omega, slopes): (f64, bool), table: &mut Table) -> bool {
        let Some(panel) = self.panels.iter().rev().find(|panel| panel.series.holds(omega)) else {
            return false;
        };
        let denominator = panel.denominator(omega);
        if self.layout.is_symmetric() {
            panel.series.evaluate(omega, denominator, slopes, &mut self.packed);
            self.layout.unpack(&self.packed.value, &mut table.value);
            self.layout.unpack(&self.packed.slope, &mut table.slope);
        } else {
            panel.series.evaluate(omega, denominator, slopes, table);
        }
        true
    }

    /// Whether the panel added last gives the samples at its ends.
    fn gives_its_ends(&mut self, table: &mut Table) -> bool {
        let Some((low, high)) = self.panels.last().map(Panel::interval) else {
            return false;
        };
        for (omega, end) in [(low, -1.0), (high, 1.0)] {
            let known = self.evaluate_known((omega, false), table);
            let (Some(panel), Some(sample)) = (self.panels.last(), self.samples.at(end)) else {
                return false;
            };
            let (d, _) = panel.denominator(omega);
            if self.layout.is_symmetric() {
                self.layout.unpack(sample, &mut self.sample);
            } else {
                self.sample.copy_from_slice(sample);
            }
            for z in &mut self.sample {
                *z /= d;
            }
            if !known || deviation(&table.value, &self.sample, self.outputs) > AGREES * self.tolerance {
                return false;
            }
        }
        true
    }

    /// Whether the panel added last gives H at a frequency.
    fn gives(
        &mut self,
        omega: f64,
        table: &mut Table,
        sample: &mut impl FnMut(f64, &mut [Complex64]) -> Result<()>,
    ) -> Result<bool> {
        self.evaluations += 1;
        sample(omega, &mut self.sample)?;
        let known = self.evaluate_known((omega, false), table);
        Ok(known && deviation(&table.value, &self.sample, self.outputs) <= AGREES * self.tolerance)
    }

    /// Adds a panel over `omega`, beside its neighbours.
    fn add_panel(
        &mut self,
        omega: f64,
        sample: &mut impl FnMut(f64, &mut [Complex64]) -> Result<()>,
    ) -> Result<Option<Panel>> {
        let ends = self.panels.iter().map(Panel::interval);
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
            let Some(resonances) = self.resonances_near((low, high))? else {
                self.width = 0.6 * width;
                continue;
            };
            if let Some(panel) = self.panel((low, high), resonances, last_tail, sample)? {
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
            last_tail = self.decay.tail();
            let factor = 0.9 * (self.tolerance / last_tail).powf(1.0 / MOST_INTERVALS as f64);
            self.width = width * factor.clamp(0.1, 0.6);
        }
        Ok(None)
    }

    /// The resonances that are divided out of a panel; `None` where it has too many.
    fn resonances_near(&self, (low, high): (f64, f64)) -> Result<Option<Vec<Complex64>>> {
        let beside = BESIDE_PANEL * (high - low);
        let mut found = try_room(MOST_ON_A_PANEL, CONTEXT)?;
        for p in &self.resonances {
            if p.re >= low - beside && p.re <= high + beside {
                if found.len() == MOST_ON_A_PANEL {
                    return Ok(None);
                }
                found.push(*p);
            }
        }
        Ok(Some(found))
    }

    /// A panel from as few samples as suffice; `None` where all do not. `last_tail`: that of the panel tried before.
    fn panel(
        &mut self,
        interval: (f64, f64),
        resonances: Vec<Complex64>,
        last_tail: f64,
        sample: &mut impl FnMut(f64, &mut [Complex64]) -> Result<()>,
    ) -> Result<Option<Panel>> {
        let (low, high) = interval;
        let size = self.layout.size();
        self.samples.clear();
        for intervals in INTERVALS {
            let (layout, whole, evaluations) = (self.layout, &mut self.sample, &mut self.evaluations);
            self.samples.refine(intervals, size, |x, values| {
                let omega = 0.5 * (low + high) + 0.5 * (high - low) * x;
                if layout.is_symmetric() {
                    sample(omega, whole)?;
                    layout.pack(whole, values);
                } else {
                    sample(omega, values)?;
                }
                let (d, _) = denominator(&resonances, high - low, omega);
                for v in values {
                    *v *= d;
                }
                *evaluations += 1;
                Ok(())
            })?;
            let mut series = self.samples.series(interval)?;
            self.decay.note(self.samples.in_order(), series.coefficients())?;
            let tail = self.decay.tail();
            let stalled = tail < NOISE && (tail > 0.3 * last_tail || self.decay.is_level());
            if stalled {
                // This is the rounding error of the factorisations: later panels cannot be better.
                self.tolerance = self.tolerance.max(2.0 * tail);
            }
            if tail <= self.tolerance {
                let wide = self.decay.terms_above(NARROW * self.tolerance);
                series.compress(wide, self.decay.terms_above(self.tolerance) + 1)?;
                return Ok(Some(Panel { series, resonances }));
            }
        }
        Ok(None)
    }

    /// Factor by which a panel could have been wider. Its series reached the tolerance t at degree k, so that it
    /// converges like t^(1/k) per degree, and about as much slower as the panel is wider.
    fn possible_widening(&self) -> f64 {
        let needed = self.decay.terms_above(3.0 * self.tolerance) + 1;
        let spare = 1.0 / needed as f64 - 1.0 / (MOST_INTERVALS - 1) as f64;
        0.9 * self.tolerance.powf(-spare)
    }
}

impl Panel {
    /// Ends of the panel.
    fn interval(&self) -> (f64, f64) {
        self.series.interval()
    }

    /// d(ω) and d′(ω).
    fn denominator(&self, omega: f64) -> (Complex64, Complex64) {
        let (low, high) = self.interval();
        denominator(&self.resonances, high - low, omega)
    }
}

/// d(ω), its factors over the width of the panel, and d′(ω).
fn denominator(resonances: &[Complex64], width: f64, omega: f64) -> (Complex64, Complex64) {
    let (mut d, mut slope) = (Complex64::ONE, Complex64::ZERO);
    for p in resonances {
        let factor = (omega - p) / width;
        slope = slope * factor + d / width;
        d *= factor;
    }
    (d, slope)
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
        // The samples, and the comparison where the panel is used first.
        assert_eq!(interpolation.evaluations(), 17 + 1);
    }
}
