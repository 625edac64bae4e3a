//! The metric of a branch: the unknowns in units that follow the branch, the parameter in units of the range.

use crate::continuation::Settings;
use crate::linalg::norm;

/// Units in which the unknowns and the parameter are measured.
#[derive(Clone, Copy, Debug)]
pub struct Metric {
    /// Unit of the unknowns.
    pub u: f64,
    /// Unit of the parameter.
    pub p: f64,
}

impl Metric {
    /// Norm of a vector (u, p).
    #[must_use]
    pub fn norm(self, v: &[f64]) -> f64 {
        let (u, p) = v.split_at(v.len() - 1);
        (norm(u) / self.u).hypot(p[0] / self.p)
    }

    /// Distance of two points.
    #[must_use]
    pub fn distance(self, a: &[f64], b: &[f64]) -> f64 {
        self.dot_with(a, b, |x, y| (x - y) * (x - y)).sqrt()
    }

    /// Inner product.
    #[must_use]
    pub fn dot(self, a: &[f64], b: &[f64]) -> f64 {
        self.dot_with(a, b, |x, y| x * y)
    }

    /// Inner product of an unscaled vector and a scaled one.
    #[must_use]
    pub fn along_row(self, v: &[f64], row: &[f64]) -> f64 {
        let n = v.len() - 1;
        let u: f64 = v[..n].iter().zip(row).map(|(x, r)| x * r).sum();
        u / self.u + v[n] / self.p * row[n]
    }

    fn dot_with(self, a: &[f64], b: &[f64], f: impl Fn(f64, f64) -> f64) -> f64 {
        let n = a.len() - 1;
        let u: f64 = a[..n].iter().zip(&b[..n]).map(|(x, y)| f(x / self.u, y / self.u)).sum();
        u + f(a[n] / self.p, b[n] / self.p)
    }

    /// v += factor·step, the step in scaled unknowns.
    pub fn add(self, v: &mut [f64], factor: f64, step: &[f64]) {
        let n = v.len() - 1;
        for (v, s) in v[..n].iter_mut().zip(step) {
            *v += factor * self.u * s;
        }
        v[n] += factor * self.p * step[n];
    }

    /// Turns scaled into unscaled numbers.
    pub fn unscale(self, v: &mut [f64]) {
        let n = v.len() - 1;
        for x in &mut v[..n] {
            *x *= self.u;
        }
        v[n] *= self.p;
    }

    /// Turns a direction in unscaled numbers into a scaled vector of length 1.
    pub fn unit(self, direction: &[f64], row: &mut [f64]) {
        let n = row.len() - 1;
        let length = self.norm(direction);
        for i in 0..n {
            row[i] = direction[i] / self.u / length;
        }
        row[n] = direction[n] / self.p / length;
    }

    /// Units for unknowns of the given size and the range of `settings`.
    #[must_use]
    pub fn along(size: f64, settings: &Settings) -> Self {
        let range = (settings.end - settings.start).abs();
        Self {
            u: if size > 0.0 { 10.0 * size } else { 1.0 },
            p: if range > 0.0 {
                range
            } else {
                settings.start.abs().max(1.0)
            },
        }
    }
}
