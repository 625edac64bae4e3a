//! Finite differences against analytic derivatives, for the derivative tests.
//!
//! Tolerance. Where the slope is monotone in [x − h, x + h], its middle value lies between the one-sided differences,
//! within half their gap of the central one. The gap is O(h) on smooth intervals; across the onset of a slip the
//! slope jumps, and may overshoot next to the jump, so the whole gap is allowed. Round-off adds about 1e-15/h = 1e-9
//! of the scale; 1e-7 allows for cancellation in long sums.

use num_complex::Complex64;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestCaseError};

pub type Checked = Result<(), TestCaseError>;

/// Inputs are random but the same in every run, so that a failure can be reproduced.
pub fn config(cases: u32) -> Config {
    Config {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(20_031_125),
        ..Config::default()
    }
}

/// Values of a function at x − h, x and x + h.
pub struct Stencil {
    pub below: Vec<f64>,
    pub here: Vec<f64>,
    pub above: Vec<f64>,
    pub h: f64,
}

impl Stencil {
    pub fn of(h: f64, mut f: impl FnMut(f64) -> Vec<f64>) -> Self {
        Self {
            below: f(-h),
            here: f(0.0),
            above: f(h),
            h,
        }
    }

    /// Compares with an analytic slope; `scale` is the size of the slopes that are summed in it.
    pub fn check(&self, name: &str, slope: &[f64], scale: f64) -> Checked {
        prop_assert_eq!(slope.len(), self.here.len());
        for (i, s) in slope.iter().enumerate() {
            let (a, b, c) = (self.below[i], self.here[i], self.above[i]);
            let central = (c - a) / (2.0 * self.h);
            let gap = (a - 2.0 * b + c).abs() / self.h;
            let tolerance = gap + 1e-7 * scale;
            prop_assert!(
                (s - central).abs() <= tolerance,
                "{name}[{i}]: {s:e} but differences give {central:e} ± {tolerance:.1e}"
            );
        }
        Ok(())
    }
}

pub fn parts(x: &[Complex64]) -> Vec<f64> {
    x.iter().flat_map(|z| [z.re, z.im]).collect()
}

pub fn pairs(x: &[f64]) -> Vec<Complex64> {
    x.chunks_exact(2).map(|p| Complex64::new(p[0], p[1])).collect()
}
