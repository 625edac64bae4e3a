//! Harmonics and samples of a motion given in polynomial steps.
//!
//! X_h = (2 − δ₀ₕ)/T ∫ x e^{−ihωt} dt over the period, step by step with the moments ∫ θᵏ e^{−iαθ} dθ, which Gauss's
//! quadrature computes to round-off on parts of at most four radians. A lapse of all sectors is the whole period of
//! one: x₀(t + kT/n) is the motion at t of the sector k·j before.

use crate::error::{Result, try_push, try_vec};
use crate::model::Model;
use crate::model::degree_map::DegreeMap;
use crate::time_integration::gauss::nodes;
use crate::time_integration::step_polynomial::{DEGREE, StepPolynomial};
use crate::time_integration::unrolled_structure::System;
use num_complex::Complex64;
use std::f64::consts::TAU;

const CONTEXT: &str = "the harmonics of the motion";

/// Points of quadrature on each part.
const POINTS: usize = 20;

/// Largest angle of a part.
const WIDEST: f64 = 4.0;

/// A requested time within the lapse, with its sector and its sample.
struct RequestedTime {
    time: f64,
    sector: usize,
    sample: usize,
}

/// Harmonics and samples of a lapse.
pub(crate) struct HarmonicAnalysis {
    ndof: usize,
    degrees: DegreeMap,
    sectors: usize,
    omega: f64,
    /// ∫ x e^{−ihωt} dt of all degrees of freedom, harmonic after harmonic.
    integrals: Vec<Complex64>,
    nodes: ([f64; POINTS], [f64; POINTS]),
    /// Requested times in ascending order.
    requested: Vec<RequestedTime>,
    next: usize,
    /// Motion of sector 0 at each sample.
    samples: Vec<f64>,
    x: Vec<f64>,
    v: Vec<f64>,
    lapse: f64,
}

impl HarmonicAnalysis {
    /// Memory for harmonics 0 ..= `harmonics` and for `samples` times of the period.
    pub fn new(system: &System<'_>, harmonics: usize, samples: usize) -> Result<Self> {
        let n = system.order();
        let mut requested = Vec::new();
        for sample in 0..samples {
            // Whole parts of the period are counted exactly.
            let part = sample * system.sectors / samples;
            let within = sample * system.sectors % samples;
            let entry = RequestedTime {
                time: system.lapse() * within as f64 / samples as f64,
                sector: before(system, part),
                sample,
            };
            try_push(&mut requested, entry, "the samples of the motion")?;
        }
        requested.sort_unstable_by(|a, b| a.time.total_cmp(&b.time));
        Ok(Self {
            ndof: system.ndof,
            sectors: system.sectors,
            omega: system.omega,
            integrals: try_vec((harmonics + 1).saturating_mul(n), Complex64::ZERO, CONTEXT)?,
            nodes: nodes(),
            requested,
            next: 0,
            degrees: system.degrees.clone(),
            samples: try_vec(
                samples.saturating_mul(system.degrees.given()),
                0.0,
                "the samples of the motion",
            )?,
            x: try_vec(n, 0.0, CONTEXT)?,
            v: try_vec(n, 0.0, CONTEXT)?,
            lapse: system.lapse(),
        })
    }

    /// Adds the part of a step up to θ.
    pub fn add(&mut self, step: &StepPolynomial, theta: f64) {
        if theta <= 0.0 {
            return;
        }
        let n = self.ndof * self.sectors;
        let length = theta * step.length;
        for (h, integral) in self.integrals.chunks_exact_mut(n).enumerate() {
            let rate = h as f64 * self.omega;
            let moments = moments(&self.nodes, rate * length, step.degree);
            let mut scale = length * Complex64::cis(-rate * step.begin);
            for (k, moment) in moments.iter().enumerate().take(step.degree + 1) {
                let weight = scale * moment;
                for (integral, c) in integral.iter_mut().zip(step.term(k)) {
                    *integral += weight * c;
                }
                scale *= theta;
            }
        }
        let end = step.begin + length;
        while let Some(requested) = self.requested.get(self.next) {
            // Round-off may leave the last times of a lapse just beyond its last step.
            if requested.time > end && end < self.lapse * (1.0 - 1e-12) {
                break;
            }
            let within = ((requested.time - step.begin) / step.length).clamp(0.0, theta);
            step.at(within, &mut self.x, &mut self.v);
            let given = self.degrees.given();
            let sector = |s: usize| &self.x[s % self.sectors * self.ndof..][..self.ndof];
            self.degrees.expand_in_time(
                sector(requested.sector),
                sector(requested.sector + 1),
                &mut self.samples[requested.sample * given..][..given],
            );
            self.next += 1;
        }
    }

    /// The harmonics of all degrees of freedom in the caller's numbering, harmonic by harmonic.
    pub fn of_all_degrees(self, system: &System<'_>, model: &Model) -> Result<Vec<Complex64>> {
        self.finish_all(system, model).map(|(harmonics, _)| harmonics)
    }

    /// The harmonics of the independent degrees of freedom of sector 0, harmonic by harmonic.
    pub fn of_independent(self, system: &System<'_>) -> Result<Vec<Complex64>> {
        self.finish(system).map(|(harmonics, _)| harmonics)
    }

    /// The same with the samples, time by time.
    pub fn finish_all(self, system: &System<'_>, model: &Model) -> Result<(Vec<Complex64>, Vec<f64>)> {
        let given = model.ndof();
        let (independent, samples) = self.finish(system)?;
        let count = independent.len() / system.ndof;
        let mut harmonics = try_vec(count.saturating_mul(given), Complex64::ZERO, CONTEXT)?;
        let rows = harmonics.chunks_exact_mut(given);
        for (h, (all, x)) in rows.zip(independent.chunks_exact(system.ndof)).enumerate() {
            system.degrees.expand(model.structure().phase(h, 1), x, all);
        }
        Ok((harmonics, samples))
    }

    /// The harmonics of sector 0, harmonic by harmonic, and its samples, time by time.
    fn finish(self, system: &System<'_>) -> Result<(Vec<Complex64>, Vec<f64>)> {
        let n = self.ndof * self.sectors;
        let count = self.integrals.len() / n;
        let mut harmonics = try_vec(count * self.ndof, Complex64::ZERO, CONTEXT)?;
        let period = TAU / self.omega;
        for (h, (sum, integral)) in harmonics
            .chunks_exact_mut(self.ndof)
            .zip(self.integrals.chunks_exact(n))
            .enumerate()
        {
            let share = if h == 0 { 1.0 } else { 2.0 } / period;
            for part in 0..self.sectors {
                let sector = before(system, part);
                let turns = (h * part) % self.sectors;
                let turn = share * Complex64::cis(-TAU * turns as f64 / self.sectors as f64);
                for (sum, integral) in sum.iter_mut().zip(&integral[sector * self.ndof..]) {
                    *sum += turn * integral;
                }
            }
            if h == 0 {
                for x in sum {
                    x.im = 0.0;
                }
            }
        }
        Ok((harmonics, self.samples))
    }
}

/// The sector whose present motion sector 0 repeats `parts` lapses later.
fn before(system: &System<'_>, parts: usize) -> usize {
    let back = parts * system.follower % system.sectors;
    (system.sectors - back) % system.sectors
}

/// ∫ θᵏ e^{−iαθ} dθ from 0 to 1, k = 0 ..= degree.
fn moments((c, b): &([f64; POINTS], [f64; POINTS]), angle: f64, degree: usize) -> [Complex64; DEGREE + 1] {
    let mut sums = [Complex64::ZERO; DEGREE + 1];
    let parts = (angle / WIDEST).ceil().max(1.0) as usize;
    let width = 1.0 / parts as f64;
    for part in 0..parts {
        for (c, b) in c.iter().zip(b) {
            let theta = (part as f64 + c) * width;
            let mut value = b * width * Complex64::cis(-angle * theta);
            for sum in sums.iter_mut().take(degree + 1) {
                *sum += value;
                value *= theta;
            }
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_those_in_closed_form() {
        let nodes = nodes();
        for angle in [0.0, 1e-3, 0.7, 3.9, 50.0, 1000.0] {
            let m = moments(&nodes, angle, DEGREE);
            let expected = if angle == 0.0 {
                Complex64::ONE
            } else {
                (Complex64::cis(-angle) - 1.0) / Complex64::new(0.0, -angle)
            };
            assert!((m[0] - expected).norm() < 1e-13, "{angle}");
            // Integration by parts: −iα m_k = e^{−iα} − k m_{k−1}.
            for k in 1..=DEGREE {
                let gap = Complex64::new(0.0, -angle) * m[k] - Complex64::cis(-angle) + k as f64 * m[k - 1];
                assert!(gap.norm() < 1e-13 * (1.0 + angle), "{angle}, {k}: {gap}");
            }
        }
    }
}
