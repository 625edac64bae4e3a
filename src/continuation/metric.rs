//! The metric of a branch: the unknowns in units that follow the branch, the parameter in units of the range.

use crate::continuation::Settings;
use crate::linalg::{SAFE_SQUARES, dot, norm};

/// Numbers that are summed side by side.
/// Kind: block.
const METRIC_LANES: usize = 4;

/// Units in which the unknowns and the parameter are measured.
#[derive(Clone, Copy, Debug)]
pub struct Metric {
    /// Unit of the unknowns.
    pub u: f64,
    /// Unit of the parameter.
    pub p: f64,
}

impl Metric {
    /// Norm of a vector (u, p) in scaled numbers.
    #[must_use]
    pub fn norm(self, v: &[f64]) -> f64 {
        let (u, p) = v.split_at(v.len() - 1);
        let (u, p) = (norm(u) / self.u, p[0] / self.p);
        let square = u * u + p * p;
        // Neither an overflow nor squares lost below the smallest number.
        if (SAFE_SQUARES..f64::INFINITY).contains(&square) {
            square.sqrt()
        } else {
            u.hypot(p)
        }
    }

    /// Distance of two points in scaled numbers.
    #[must_use]
    pub fn distance(self, a: &[f64], b: &[f64]) -> f64 {
        let n = a.len() - 1;
        let squares = a[..n].iter().zip(&b[..n]).map(|(x, y)| (x - y) * (x - y));
        let along = (a[n] - b[n]) / self.p;
        (squares.sum::<f64>() / (self.u * self.u) + along * along).sqrt()
    }

    /// Inner product of two vectors in scaled numbers.
    #[must_use]
    pub fn dot(self, a: &[f64], b: &[f64]) -> f64 {
        let n = a.len() - 1;
        dot(&a[..n], &b[..n]) / (self.u * self.u) + a[n] * b[n] / (self.p * self.p)
    }

    /// Inner products of two `vectors` with the way from `here` to `v` and with a tangent.
    #[must_use]
    pub fn products(self, here: &[f64], (v, tangent): (&[f64], &[f64]), vectors: [&[f64]; 2]) -> [[f64; 2]; 2] {
        let n = here.len() - 1;
        let [a, b] = vectors;
        // Partial sums, which the processor adds in parallel.
        let mut parts = [[0.0; METRIC_LANES]; 4];
        let [v4, h4, t4, a4, b4] = [v, here, tangent, a, b].map(|x| x[..n].as_chunks::<METRIC_LANES>());
        let numbers = v4.0.iter().zip(h4.0).zip(t4.0).zip(a4.0).zip(b4.0);
        for ((((v, h), t), a), b) in numbers {
            for k in 0..METRIC_LANES {
                let way = v[k] - h[k];
                parts[0][k] += way * a[k];
                parts[1][k] += t[k] * a[k];
                parts[2][k] += way * b[k];
                parts[3][k] += t[k] * b[k];
            }
        }
        let [mut own, mut d_own, mut other, mut d_other] = parts.map(|p| (p[0] + p[1]) + (p[2] + p[3]));
        for k in 0..v4.1.len() {
            let (way, t) = (v4.1[k] - h4.1[k], t4.1[k]);
            own += way * a4.1[k];
            d_own += t * a4.1[k];
            other += way * b4.1[k];
            d_other += t * b4.1[k];
        }
        let mut sums = [[own, d_own], [other, d_other]];
        let (unknowns, parameter) = (1.0 / (self.u * self.u), 1.0 / (self.p * self.p));
        let last = [v[n] - here[n], tangent[n]];
        for (sums, vector) in sums.iter_mut().zip(vectors) {
            for (sum, last) in sums.iter_mut().zip(last) {
                *sum = *sum * unknowns + last * (vector[n] * parameter);
            }
        }
        sums
    }

    /// Squared distance of two points without its part along the scaled unit vector `row`.
    #[must_use]
    pub fn square_across(self, a: &[f64], b: &[f64], row: &[f64]) -> f64 {
        let n = row.len() - 1;
        let (mut along, mut square) = (0.0, 0.0);
        for ((a, b), r) in a[..n].iter().zip(&b[..n]).zip(row) {
            let difference = a - b;
            along += difference * r;
            square += difference * difference;
        }
        let of_parameter = (a[n] - b[n]) / self.p;
        let along = along / self.u + of_parameter * row[n];
        square / (self.u * self.u) + of_parameter * of_parameter - along * along
    }

    /// Distance from one point to another along the scaled unit vector `row`.
    #[must_use]
    pub fn along_row(self, from: &[f64], to: &[f64], row: &[f64]) -> f64 {
        let n = row.len() - 1;
        let unknowns = from[..n].iter().zip(&to[..n]).zip(row);
        let along: f64 = unknowns.map(|((from, to), row)| (to - from) * row).sum();
        along / self.u + (to[n] - from[n]) / self.p * row[n]
    }

    /// v ← v + factor·step, the step being given in scaled unknowns.
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

    /// Turns a direction in unscaled numbers into a scaled vector of length 1; returns its former length.
    pub fn unit(self, direction: &[f64], row: &mut [f64]) -> f64 {
        let n = row.len() - 1;
        let length = self.norm(direction);
        let (u, p) = (1.0 / (self.u * length), 1.0 / (self.p * length));
        for i in 0..n {
            row[i] = direction[i] * u;
        }
        row[n] = direction[n] * p;
        length
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
