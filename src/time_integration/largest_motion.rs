//! The largest displacement of one degree of freedom over steps, from their polynomials.

use crate::roots::root;
use crate::time_integration::step_polynomial::StepPolynomial;
use std::convert::Infallible;

/// Parts of a step between which the velocity is looked at: steps are shorter than half a period of the quickest motion.
/// Kind: tuned; measured on: not recorded.
const LARGEST_MOTION_PARTS: usize = 8;

/// Search for the largest |x| of a degree of freedom.
pub(crate) struct LargestMotion<'a> {
    /// Terms of the degree of freedom in the independent ones.
    terms: &'a [(usize, f64)],
    /// Largest |x| so far.
    pub size: f64,
    /// Time of the largest |x|.
    pub time: f64,
}

impl<'a> LargestMotion<'a> {
    /// A search without any step so far.
    pub fn new(terms: &'a [(usize, f64)]) -> Self {
        Self {
            terms,
            size: 0.0,
            time: 0.0,
        }
    }

    /// Adds a step up to the share θ.
    pub fn add(&mut self, step: &StepPolynomial, theta: f64) {
        let (terms, degree) = (self.terms, step.degree);
        let at = |s: f64| -> (f64, f64) {
            let (mut x, mut v) = (0.0, 0.0);
            for k in (0..=degree).rev() {
                v = v * s + x;
                let term = step.term(k);
                x = x * s + terms.iter().map(|&(dof, a)| a * term[dof]).sum::<f64>();
            }
            (x, v)
        };
        let mut low = 0.0;
        let mut before = at(low);
        self.take(step, low, before.0);
        for part in 1..=LARGEST_MOTION_PARTS {
            let high = theta * part as f64 / LARGEST_MOTION_PARTS as f64;
            let after = at(high);
            if (before.1 < 0.0) != (after.1 < 0.0) {
                let turned = root((low, before.1), (high, after.1), |s| Ok::<_, Infallible>(at(s).1));
                let turned = turned.unwrap_or(low);
                self.take(step, turned, at(turned).0);
            }
            self.take(step, high, after.0);
            (low, before) = (high, after);
        }
    }

    fn take(&mut self, step: &StepPolynomial, s: f64, x: f64) {
        if x.abs() > self.size {
            self.size = x.abs();
            self.time = step.begin + s * step.length;
        }
    }
}
