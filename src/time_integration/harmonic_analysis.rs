//! Harmonics and samples of a motion given in polynomial steps.
//!
//! X_h = (2 − δ₀ₕ)/T ∫ x e^{−ihωt} dt over the period, step by step with the moments ∫ θᵏ e^{−iαθ} dθ, which Gauss's
//! quadrature computes to round-off on parts of at most four radians. A lapse of all sectors is the whole period of
//! one: x₀(t + kT/n) is the motion at t of the sector k·j before.

use crate::error::{Result, try_vec};
use crate::fourier::gcd;
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::model::matrices::degree_map::DegreeMap;
use crate::time_integration::gauss::nodes;
use crate::time_integration::step_polynomial::{DEGREE, StepPolynomial};
use crate::time_integration::unrolled_structure::System;
use num_complex::Complex64;
use std::f64::consts::TAU;

const CONTEXT: &str = "the harmonics of the motion";

/// Points of quadrature on each part.
/// Kind: tuned; measured on: not recorded.
const HARMONIC_ANALYSIS_POINTS: usize = 20;

/// Harmonics, or times, between two checks of a stop.
/// Kind: block.
const HARMONIC_ANALYSIS_BETWEEN_CHECKS: usize = 64;

/// Largest angle of a part.
/// Kind: tuned; measured on: not recorded.
const WIDEST: f64 = 4.0;

/// A requested time within the lapse, with its sector and its sample.
struct RequestedTime {
    time: f64,
    sector: usize,
    sample: usize,
}

/// The times of `count` samples of a period, in the order of time within a lapse, which `sectors` times makes a period.
///
/// Sample s lies at s·sectors/count lapses. With g = gcd(sectors, count) the times within a lapse are w·g/count, w = 0 … count/g − 1,
/// and the samples of w are those with s·(sectors/g) ≡ w (mod count/g): g of them.
struct RequestedTimes {
    count: usize,
    sectors: usize,
    /// Number g of samples at each time within a lapse.
    together: usize,
    /// Inverse of sectors/g modulo count/g.
    inverse: usize,
}

impl RequestedTimes {
    fn new(count: usize, sectors: usize) -> Self {
        let together = gcd(sectors, count.max(1));
        let modulus = count.max(1) / together;
        Self {
            count,
            sectors,
            together,
            inverse: inverse(sectors / together % modulus, modulus),
        }
    }

    /// The i-th requested time, in the order of time.
    fn get(&self, system: (f64, usize), i: usize) -> Option<RequestedTime> {
        if i >= self.count {
            return None;
        }
        let (lapse, follower) = system;
        let modulus = self.count / self.together;
        let (w, k) = (i / self.together, i % self.together);
        let sample = w * self.inverse % modulus + k * modulus;
        // Whole parts of the period are counted exactly.
        let part = sample * self.sectors / self.count;
        Some(RequestedTime {
            time: lapse * (w * self.together) as f64 / self.count as f64,
            sector: back(part * follower, self.sectors),
            sample,
        })
    }
}

/// x with a x ≡ 1 (mod m), for a and m without a common divisor, by Euclid's algorithm; 0 for m = 1.
fn inverse(a: usize, m: usize) -> usize {
    let (mut r, mut x) = ((m as i128, a as i128), (0_i128, 1_i128));
    while r.1 > 0 {
        let quotient = r.0 / r.1;
        r = (r.1, r.0 - quotient * r.1);
        x = (x.1, x.0 - quotient * x.1);
    }
    x.0.rem_euclid(m as i128) as usize
}

/// Harmonics and samples of a lapse.
pub(crate) struct HarmonicAnalysis {
    ndof: usize,
    degrees: DegreeMap,
    sectors: usize,
    omega: f64,
    /// Integrals ∫ x e^{−ihωt} dt of all degrees of freedom, harmonic after harmonic.
    integrals: Vec<Complex64>,
    nodes: ([f64; HARMONIC_ANALYSIS_POINTS], [f64; HARMONIC_ANALYSIS_POINTS]),
    times: Times,
    follower: usize,
    /// Motion of sector 0 at each sample.
    samples: Vec<f64>,
    x: Vec<f64>,
    v: Vec<f64>,
    lapse: f64,
}

/// Requested times.
pub(crate) struct Times {
    requested: RequestedTimes,
    /// Number of requested times that are done.
    done: usize,
}

impl HarmonicAnalysis {
    /// Memory for harmonics 0 ..= `harmonics` and for `samples` times of the period.
    pub fn new(system: &System<'_>, harmonics: usize, samples: usize) -> Result<Self> {
        let n = system.order();
        Ok(Self {
            ndof: system.ndof,
            sectors: system.wave.sectors,
            omega: system.omega,
            integrals: try_vec((harmonics + 1).saturating_mul(n), Complex64::ZERO, CONTEXT)?,
            nodes: nodes(),
            times: Times {
                requested: RequestedTimes::new(samples, system.wave.sectors),
                done: 0,
            },
            follower: system.wave.follower,
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

    /// Adds the part of a step up to the share θ.
    pub fn add(&mut self, step: &StepPolynomial, theta: f64, interrupt: &Interrupt<'_>) -> Result<()> {
        if theta <= 0.0 {
            return Ok(());
        }
        let n = self.ndof * self.sectors;
        let length = theta * step.length;
        for (h, integral) in self.integrals.chunks_exact_mut(n).enumerate() {
            if h % HARMONIC_ANALYSIS_BETWEEN_CHECKS == 0 {
                let parts = (h as f64 * self.omega * length / WIDEST) as usize + 1;
                interrupt.check_before(
                    (HARMONIC_ANALYSIS_BETWEEN_CHECKS * (parts * HARMONIC_ANALYSIS_POINTS * DEGREE + n * DEGREE))
                        as u64,
                )?;
            }
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
        while let Some(requested) = self.times.requested.get((self.lapse, self.follower), self.times.done) {
            if self.times.done.is_multiple_of(HARMONIC_ANALYSIS_BETWEEN_CHECKS) {
                interrupt.check_before((HARMONIC_ANALYSIS_BETWEEN_CHECKS * n * DEGREE) as u64)?;
            }
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
            self.times.done += 1;
        }
        Ok(())
    }

    /// The harmonics of all degrees of freedom in the caller's numbering, harmonic by harmonic.
    pub fn of_all_degrees(self, system: &System<'_>, model: &Model) -> Result<Vec<Complex64>> {
        self.finish_all(system, model).map(|(harmonics, _)| harmonics)
    }

    /// The harmonics of the independent degrees of freedom of sector 0, harmonic by harmonic.
    pub fn of_independent(self, system: &System<'_>) -> Result<Vec<Complex64>> {
        self.finish(system).map(|(harmonics, _)| harmonics)
    }

    /// The harmonics of all degrees of freedom in the caller's numbering, harmonic by harmonic; and the samples, time
    /// by time.
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
    back(parts * system.wave.follower, system.wave.sectors)
}

/// The sector `count` sectors before sector 0.
fn back(count: usize, sectors: usize) -> usize {
    (sectors - count % sectors) % sectors
}

/// Moments ∫ θᵏ e^{−iαθ} dθ from 0 to 1, k = 0 ..= degree.
fn moments(
    (c, b): &([f64; HARMONIC_ANALYSIS_POINTS], [f64; HARMONIC_ANALYSIS_POINTS]),
    angle: f64,
    degree: usize,
) -> [Complex64; DEGREE + 1] {
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
    fn requested_times_are_in_order_and_each_sample_is_among_them() {
        let cases = [
            (1, 1, 0),
            (7, 1, 0),
            (12, 8, 3),
            (9, 24, 5),
            (64, 24, 23),
            (5, 5, 2),
            (1000, 37, 11),
        ];
        for (count, sectors, follower) in cases {
            let lapse = 0.7;
            let times = RequestedTimes::new(count, sectors);
            let mut seen = vec![false; count];
            let mut last = 0.0;
            for i in 0..count {
                let requested = times.get((lapse, follower), i).unwrap();
                let turned = requested.sample * sectors;
                let within = lapse * (turned % count) as f64 / count as f64;
                assert!((requested.time - within).abs() < 1e-12 && requested.time >= last);
                let moved = turned / count * follower % sectors;
                assert_eq!((requested.sector + moved) % sectors, 0);
                assert!(!seen[requested.sample]);
                seen[requested.sample] = true;
                last = requested.time;
            }
            assert!(times.get((lapse, follower), count).is_none());
        }
    }

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
