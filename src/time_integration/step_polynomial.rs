//! Polynomials of a step of the integration for every displacement, and the first fall of a margin through zero
//! within it.

use crate::error::{Result, try_vec};
use crate::time_integration::event_law::{Row, along};

/// Highest degree of a step's polynomials.
/// Kind: tuned; measured on: not recorded.
pub(crate) const DEGREE: usize = 26;

/// The motion x(t₀ + θh) = Σₖ Xₖ θᵏ, 0 ≤ θ ≤ 1, of n degrees of freedom.
pub(crate) struct StepPolynomial {
    n: usize,
    /// Degree of the polynomials in use.
    pub degree: usize,
    /// Coefficients X₀, X₁, …, n numbers each.
    pub coefficients: Vec<f64>,
    /// Time t₀ at the beginning of the step.
    pub begin: f64,
    /// Length h of the step.
    pub length: f64,
}

impl StepPolynomial {
    /// Memory for steps of `n` degrees of freedom.
    pub fn new(n: usize) -> Result<Self> {
        Ok(Self {
            n,
            degree: 0,
            coefficients: try_vec((DEGREE + 1).saturating_mul(n), 0.0, "a time step")?,
            begin: 0.0,
            length: 0.0,
        })
    }

    /// Coefficients Xₖ of all degrees of freedom.
    pub fn term(&self, k: usize) -> &[f64] {
        &self.coefficients[k * self.n..(k + 1) * self.n]
    }

    /// Displacements x and velocities v at the share θ of the step.
    pub fn at(&self, theta: f64, x: &mut [f64], v: &mut [f64]) {
        x.fill(0.0);
        v.fill(0.0);
        for k in (0..=self.degree).rev() {
            for ((x, v), &c) in x.iter_mut().zip(v.iter_mut()).zip(self.term(k)) {
                *v = *v * theta + *x;
                *x = *x * theta + c;
            }
        }
        for v in v {
            *v /= self.length;
        }
    }

    /// Fills `y` with the coefficients of a relative motion.
    pub fn relative(&self, row: &Row, y: &mut [f64; DEGREE + 1]) {
        y.fill(0.0);
        for (k, y) in y.iter_mut().enumerate().take(self.degree + 1) {
            *y = along(row, self.term(k));
        }
    }

    /// Change y(θ) − y(0) of a relative motion, without cancellation.
    pub fn growth(&self, row: &Row, theta: f64) -> f64 {
        let sum = |sum: f64, k: usize| sum * theta + along(row, self.term(k));
        theta * (1..=self.degree).rev().fold(0.0, sum)
    }

    /// Rescales the polynomials to a step of `factor` times the length.
    pub fn rescale(&mut self, factor: f64) {
        let mut power = 1.0;
        for k in 1..=self.degree {
            power *= factor;
            for c in &mut self.coefficients[k * self.n..(k + 1) * self.n] {
                *c *= power;
            }
        }
        self.length *= factor;
    }
}

/// Width of an interval of θ in which two roots cannot be distinguished.
/// Kind: rounding.
const STEP_POLYNOMIAL_FINEST: f64 = 1e-14;

/// Relative size against its terms below which a margin counts as zero.
/// Kind: rounding.
const ZERO: f64 = 4.0 * f64::EPSILON;

/// The first θ in [0, 1] at which a margin m(θ) = Σ cₖθᵏ falls below zero; `None`: it does not. `zeros` of its first
/// coefficients are zero by construction, apart from round-off.
///
/// No fall is missed: in Bernstein's form a polynomial has no more roots in an interval than its coefficients change
/// sign (Farouki 2012, doi:10.1016/j.cagd.2012.03.001). Intervals are halved from the left until they hold one root
/// or none; two that cannot be distinguished are a touch, which does not end a piece.
pub(crate) fn first_fall(margin: &[f64], zeros: usize) -> Option<f64> {
    let mut c = &margin[zeros.min(margin.len())..];
    while c.last() == Some(&0.0) {
        c = &c[..c.len() - 1];
    }
    let size: f64 = c.iter().map(|c| c.abs()).sum();
    let mut known = zeros > 0;
    // At the border, or beyond it by round-off, the first coefficient that is not zero decides.
    while *c.first()? <= ZERO * size {
        if known && c[0] < -ZERO * size {
            return Some(0.0);
        }
        known = true;
        c = &c[1..];
    }
    let first = c.first()?;
    if first + c.iter().map(|c| c.min(0.0)).sum::<f64>() > 0.0 {
        return None;
    }
    search(c)
}

/// The first fall through zero of a polynomial that begins above it.
fn search(c: &[f64]) -> Option<f64> {
    /// Brackets that wait at most.
    /// Kind: cap.
    const DEEPEST: usize = 64;
    let degree = c.len() - 1;
    let mut stack = [([0.0; DEGREE + 1], 0.0, 0.0); DEEPEST];
    stack[0] = (bernstein(c), 0.0, 1.0);
    let mut open = 1;
    while open > 0 {
        open -= 1;
        let (b, from, to) = stack[open];
        let b = &b[..=degree];
        let changes = b.windows(2).filter(|w| (w[0] > 0.0) != (w[1] > 0.0)).count();
        if changes == 0 {
            if b[0] > 0.0 {
                continue;
            }
            return Some(from);
        }
        if changes == 1 {
            if b[0] > 0.0 {
                return Some(root(c, from, to));
            }
            // The margin rises again after two roots that could not be distinguished.
            continue;
        }
        if to - from < STEP_POLYNOMIAL_FINEST || open + 2 > DEEPEST {
            continue;
        }
        let (left, right) = halves(b);
        let middle = 0.5 * (from + to);
        stack[open] = (right, middle, to);
        stack[open + 1] = (left, from, middle);
        open += 2;
    }
    None
}

/// Bernstein's form of Σ cₖθᵏ on [0, 1]: bᵢ = Σ_{k ≤ i} C(i,k)/C(n,k) cₖ.
fn bernstein(c: &[f64]) -> [f64; DEGREE + 1] {
    let n = c.len() - 1;
    let mut b = [0.0; DEGREE + 1];
    for (i, b) in b.iter_mut().enumerate().take(n + 1) {
        let mut ratio = 1.0;
        for (k, c) in c.iter().enumerate().take(i + 1) {
            *b += ratio * c;
            if k < n {
                ratio *= (i - k) as f64 / (n - k) as f64;
            }
        }
    }
    b
}

/// The two halves of a polynomial in Bernstein's form, by de Casteljau's algorithm.
fn halves(b: &[f64]) -> ([f64; DEGREE + 1], [f64; DEGREE + 1]) {
    let n = b.len() - 1;
    let (mut left, mut right) = ([0.0; DEGREE + 1], [0.0; DEGREE + 1]);
    right[..=n].copy_from_slice(b);
    for (i, left) in left.iter_mut().enumerate().take(n + 1) {
        *left = right[0];
        for k in 0..n - i {
            right[k] = 0.5 * (right[k] + right[k + 1]);
        }
    }
    (left, right)
}

/// The one root in an interval at whose ends the polynomial has opposite signs, by Newton's method kept within the
/// bracket.
fn root(c: &[f64], mut from: f64, mut to: f64) -> f64 {
    let mut theta = 0.5 * (from + to);
    for _ in 0..100 {
        let (mut value, mut slope) = (0.0, 0.0);
        for &c in c.iter().rev() {
            slope = slope * theta + value;
            value = value * theta + c;
        }
        if value == 0.0 {
            return theta;
        }
        if value > 0.0 {
            from = theta;
        } else {
            to = theta;
        }
        let newton = theta - value / slope;
        let next = if newton > from && newton < to {
            newton
        } else {
            0.5 * (from + to)
        };
        if (next - theta).abs() <= f64::EPSILON * to || to - from <= f64::EPSILON * to {
            return next;
        }
        theta = next;
    }
    theta
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_fall_is_found_among_roots_close_to_each_other() {
        // (θ − 0.3)(θ − 0.3001)(θ − 0.9) falls at 0.9 when turned, and at 0.3 as −.
        let (a, b, c) = (0.3, 0.3001, 0.9);
        let cubic = [a * b * c, -(a * b + a * c + b * c), a + b + c, -1.0];
        assert!((first_fall(&cubic, 0).unwrap() - a).abs() < 1e-11);
        let missing = [0.25 + 1e-9, -1.0, 1.0];
        assert_eq!(first_fall(&missing, 0), None);
        let passing = [0.25 - 1e-9, -1.0, 1.0];
        assert!((first_fall(&passing, 0).unwrap() - (0.5 - 1e-9_f64.sqrt())).abs() < 1e-11);
        assert_eq!(first_fall(&[1.0, -0.5], 0), None);
        assert_eq!(first_fall(&[0.0], 0), None);
    }

    #[test]
    fn a_margin_that_begins_at_zero_falls_only_if_it_goes_on_falling() {
        assert_eq!(first_fall(&[0.0, 1.0, 0.5], 0), None);
        assert_eq!(first_fall(&[1e-17, -1.0, 0.5], 0), Some(0.0));
        assert_eq!(first_fall(&[0.0, 1e-17, 1.0, -0.5], 2), None);
        assert_eq!(first_fall(&[-1e-17, -1e-17, 1.0, -4.0], 2), Some(0.25));
        assert_eq!(first_fall(&[0.0, 0.0, -1.0, 0.5], 2), Some(0.0));
    }
}
