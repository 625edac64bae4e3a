//! Gauss's nodes on [0, 1], and the Runge–Kutta tables of collocation at them.

use crate::time_integration::step_polynomial::DEGREE;

/// Stages of the implicit method, of order twice that.
/// Kind: fixed.
pub(crate) const GAUSS_STAGES: usize = 8;

/// Nodes and weights of quadrature with `N` points on [0, 1], exact up to degree 2N − 1.
pub(super) fn nodes<const N: usize>() -> ([f64; N], [f64; N]) {
    let (mut c, mut b) = ([0.0; N], [0.0; N]);
    for i in 0..N {
        // Newton's method on the Legendre polynomial, from Tricomi's guess of its root on [−1, 1].
        let mut x = -(core::f64::consts::PI * (i as f64 + 0.75) / (N as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..100 {
            let (mut p, mut before) = (1.0, 0.0);
            for k in 0..N {
                let k = k as f64;
                (p, before) = (((2.0 * k + 1.0) * x * p - k * before) / (k + 1.0), p);
            }
            slope = N as f64 * (x * p - before) / (x * x - 1.0);
            let step = p / slope;
            x -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        c[i] = 0.5 * (1.0 + x);
        b[i] = 1.0 / ((1.0 - x * x) * slope * slope);
    }
    (c, b)
}

/// Tables of collocation at Gauss's nodes.
pub(crate) struct GaussTables {
    /// Nodes cᵢ in [0, 1].
    pub nodes: [f64; GAUSS_STAGES],
    /// Weights aᵢⱼ, integrals of the Lagrange polynomials up to the nodes.
    pub once: [[f64; GAUSS_STAGES]; GAUSS_STAGES],
    /// Weights Σₖ aᵢₖ aₖⱼ of double integrals.
    pub twice: [[f64; GAUSS_STAGES]; GAUSS_STAGES],
    /// Matrix from values at the nodes to the coefficients of the shifted Legendre polynomials.
    pub legendre: [[f64; GAUSS_STAGES]; GAUSS_STAGES],
    /// Coefficient of θᵐ in the j-th shifted Legendre polynomial: (−1)^{j+m} C(j,m) C(j+m,m).
    pub powers: [[f64; GAUSS_STAGES]; GAUSS_STAGES],
}

impl GaussTables {
    pub fn new() -> Self {
        let (nodes, weights) = nodes::<GAUSS_STAGES>();
        let mut powers = [[0.0; GAUSS_STAGES]; GAUSS_STAGES];
        for (j, row) in powers.iter_mut().enumerate() {
            let mut value = if j % 2 == 0 { 1.0 } else { -1.0 };
            for (m, p) in row.iter_mut().enumerate().take(j + 1) {
                *p = value;
                value *= -((j - m) as f64) * (j + m + 1) as f64 / ((m + 1) * (m + 1)) as f64;
            }
        }
        // The recurrence avoids the cancellation of powers.
        let values = |theta: f64| {
            let x = 2.0 * theta - 1.0;
            let mut p = [1.0; GAUSS_STAGES + 1];
            p[1] = x;
            for k in 1..GAUSS_STAGES {
                let n = k as f64;
                p[k + 1] = ((2.0 * n + 1.0) * x * p[k] - n * p[k - 1]) / (n + 1.0);
            }
            p
        };
        let mut tables = Self {
            nodes,
            once: [[0.0; GAUSS_STAGES]; GAUSS_STAGES],
            twice: [[0.0; GAUSS_STAGES]; GAUSS_STAGES],
            legendre: [[0.0; GAUSS_STAGES]; GAUSS_STAGES],
            powers,
        };
        for (j, (&c, &b)) in nodes.iter().zip(&weights).enumerate() {
            let p = values(c);
            for (k, p) in p.iter().enumerate().take(GAUSS_STAGES) {
                tables.legendre[k][j] = (2 * k + 1) as f64 * b * p;
            }
        }
        for (i, &c) in nodes.iter().enumerate() {
            let p = values(c);
            for k in 0..GAUSS_STAGES {
                // The integral of P_k from 0 to θ is (P_{k+1} − P_{k−1})/(2(2k + 1)).
                let integral = if k == 0 {
                    c
                } else {
                    (p[k + 1] - p[k - 1]) / (2 * (2 * k + 1)) as f64
                };
                for j in 0..GAUSS_STAGES {
                    tables.once[i][j] += integral * tables.legendre[k][j];
                }
            }
        }
        for i in 0..GAUSS_STAGES {
            for j in 0..GAUSS_STAGES {
                tables.twice[i][j] = (0..GAUSS_STAGES).map(|k| tables.once[i][k] * tables.once[k][j]).sum();
            }
        }
        tables
    }

    /// Weights of the accelerations at the nodes in v and x at θ: v = v₀ + h Σ pⱼaⱼ,
    /// x = x₀ + hθv₀ + h² Σ qⱼaⱼ.
    pub fn weights(&self, theta: f64) -> ([f64; GAUSS_STAGES], [f64; GAUSS_STAGES]) {
        let (mut p, mut q) = ([0.0; GAUSS_STAGES], [0.0; GAUSS_STAGES]);
        for k in 0..GAUSS_STAGES {
            let (mut once, mut twice, mut power) = (0.0, 0.0, theta);
            for m in 0..=k {
                let c = self.powers[k][m] / (m + 1) as f64;
                once += c * power;
                power *= theta;
                twice += c / (m + 2) as f64 * power;
            }
            for j in 0..GAUSS_STAGES {
                p[j] += once * self.legendre[k][j];
                q[j] += twice * self.legendre[k][j];
            }
        }
        (p, q)
    }
}

const _: () = assert!(GAUSS_STAGES < DEGREE);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadrature_is_exact_up_to_its_degree() {
        let (c, b) = nodes::<20>();
        for degree in 0..40 {
            let sum: f64 = c.iter().zip(&b).map(|(c, b)| b * c.powi(degree)).sum();
            assert!(
                (sum - 1.0 / f64::from(degree + 1)).abs() < 1e-14,
                "degree {degree}: {sum}"
            );
        }
    }

    #[test]
    fn tables_integrate_polynomials_once_and_twice() {
        let t = GaussTables::new();
        for degree in 0..GAUSS_STAGES as i32 {
            let a = t.nodes.map(|c| c.powi(degree));
            let d = f64::from(degree);
            for i in 0..GAUSS_STAGES {
                let once: f64 = (0..GAUSS_STAGES).map(|j| t.once[i][j] * a[j]).sum();
                assert!((once - t.nodes[i].powi(degree + 1) / (d + 1.0)).abs() < 1e-15);
            }
            let (p, q) = t.weights(0.7);
            let v: f64 = p.iter().zip(&a).map(|(p, a)| p * a).sum();
            let x: f64 = q.iter().zip(&a).map(|(q, a)| q * a).sum();
            assert!((v - 0.7_f64.powi(degree + 1) / (d + 1.0)).abs() < 1e-14);
            assert!((x - 0.7_f64.powi(degree + 2) / ((d + 1.0) * (d + 2.0))).abs() < 1e-14);
        }
    }
}
