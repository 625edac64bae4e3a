//! Collocation at Radau's right nodes on [0, 1]: Runge–Kutta tables, derivatives and interpolation.
//!
//! The method of s stages (Radau IIA; Hairer & Wanner 1996, doi:10.1007/978-3-642-05221-7, §IV.5) has order 2s − 1, damps stiff components
//! entirely, and has no node at the start of a step, where an equation may be singular. The end is a node.

/// Stages s.
/// Kind: fixed.
pub const RADAU_STAGES: usize = 10;

/// Points of interpolation: the start and the nodes.
/// Kind: fixed.
pub const RADAU_POINTS: usize = RADAU_STAGES + 1;

/// Tables of the method.
#[derive(Clone, Debug)]
pub struct RadauTables {
    /// Nodes c, ascending; the last is 1.
    pub nodes: [f64; RADAU_STAGES],
    /// aᵢⱼ, integrals of the Lagrange polynomials of the nodes up to the nodes. The last row has the weights of
    /// quadrature, exact up to degree 2s − 2.
    pub integrals: [[f64; RADAU_STAGES]; RADAU_STAGES],
    /// The highest two coefficients in Legendre polynomials of values at the nodes.
    pub tail: [[f64; RADAU_STAGES]; 2],
    /// Derivatives at the points of the polynomial through values there.
    slopes: [[f64; RADAU_POINTS]; RADAU_POINTS],
    /// Barycentric weights of the points.
    barycentric: [f64; RADAU_POINTS],
}

/// P₀ … Pₛ of Legendre at x.
fn legendre(x: f64) -> [f64; RADAU_STAGES + 1] {
    let mut p = [1.0; RADAU_STAGES + 1];
    p[1] = x;
    for k in 1..RADAU_STAGES {
        let n = k as f64;
        p[k + 1] = ((2.0 * n + 1.0) * x * p[k] - n * p[k - 1]) / (n + 1.0);
    }
    p
}

/// Roots of P_{s−1} − Pₛ on [−1, 1], ascending.
fn roots() -> [f64; RADAU_STAGES] {
    let s = RADAU_STAGES as f64;
    let mut roots = [1.0; RADAU_STAGES];
    for (i, root) in roots.iter_mut().rev().enumerate().skip(1) {
        let mut x = (core::f64::consts::TAU * i as f64 / (2.0 * s - 1.0)).cos();
        for _ in 0..100 {
            let p = legendre(x);
            // (1 − x²) P′ₙ = n (Pₙ₋₁ − x Pₙ)
            let slope = ((s - 1.0) * (p[RADAU_STAGES - 2] - x * p[RADAU_STAGES - 1])
                - s * (p[RADAU_STAGES - 1] - x * p[RADAU_STAGES]))
                / ((1.0 - x) * (1.0 + x));
            let step = (p[RADAU_STAGES - 1] - p[RADAU_STAGES]) / slope;
            x -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        *root = x;
    }
    roots
}

impl RadauTables {
    /// Computes the tables.
    #[must_use]
    pub fn new() -> Self {
        let roots = roots();
        let nodes = roots.map(|x| 0.5 * (1.0 + x));
        let count = RADAU_STAGES as f64;
        // Coefficients in Legendre polynomials of values at the nodes; the quadrature is exact for them.
        let mut coefficients = [[0.0; RADAU_STAGES]; RADAU_STAGES];
        for (j, &x) in roots.iter().enumerate() {
            let p = legendre(x);
            let weight = 0.5 * (1.0 + x) / (count * p[RADAU_STAGES - 1]).powi(2);
            for (k, row) in coefficients.iter_mut().enumerate() {
                row[j] = (2 * k + 1) as f64 * weight * p[k];
            }
        }
        let mut integrals = [[0.0; RADAU_STAGES]; RADAU_STAGES];
        for (row, (&x, &c)) in integrals.iter_mut().zip(roots.iter().zip(&nodes)) {
            let p = legendre(x);
            for (k, of_values) in coefficients.iter().enumerate() {
                // The integral of P_k from 0 to c is (P_{k+1} − P_{k−1})/(2(2k + 1)).
                let integral = if k == 0 {
                    c
                } else {
                    (p[k + 1] - p[k - 1]) / (2 * (2 * k + 1)) as f64
                };
                for (a, v) in row.iter_mut().zip(of_values) {
                    *a += integral * v;
                }
            }
        }
        let mut points = [0.0; RADAU_POINTS];
        points[1..].copy_from_slice(&nodes);
        let barycentric: [f64; RADAU_POINTS] = core::array::from_fn(|i| {
            let others = points.iter().enumerate().filter(|(j, _)| *j != i);
            others.map(|(_, p)| points[i] - p).product::<f64>().recip()
        });
        let mut slopes = [[0.0; RADAU_POINTS]; RADAU_POINTS];
        for i in 0..RADAU_POINTS {
            for j in (0..RADAU_POINTS).filter(|j| *j != i) {
                slopes[i][j] = barycentric[j] / barycentric[i] / (points[i] - points[j]);
                slopes[i][i] -= slopes[i][j];
            }
        }
        Self {
            nodes,
            integrals,
            tail: [coefficients[RADAU_STAGES - 2], coefficients[RADAU_STAGES - 1]],
            slopes,
            barycentric,
        }
    }

    /// The i-th point: 0, then the nodes.
    pub fn point(&self, i: usize) -> f64 {
        if i == 0 { 0.0 } else { self.nodes[i - 1] }
    }

    /// Derivatives at the points of the polynomial with these values.
    pub fn derivatives(&self, values: &[f64; RADAU_POINTS]) -> [f64; RADAU_POINTS] {
        core::array::from_fn(|i| self.slopes[i].iter().zip(values).map(|(d, v)| d * v).sum())
    }

    /// The polynomial with these values at the points, at `at` in [0, 1].
    pub fn interpolate(&self, values: &[f64; RADAU_POINTS], at: f64) -> f64 {
        let (mut above, mut below) = (0.0, 0.0);
        for (i, (value, weight)) in values.iter().zip(&self.barycentric).enumerate() {
            let distance = at - self.point(i);
            if distance == 0.0 {
                return *value;
            }
            above += weight / distance * value;
            below += weight / distance;
        }
        above / below
    }
}

impl Default for RadauTables {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_exact_for_polynomials_of_their_degree() {
        let tables = RadauTables::new();
        assert!((tables.nodes[RADAU_STAGES - 1] - 1.0).abs() < 1e-16);
        for degree in 0..2 * RADAU_STAGES - 1 {
            let power = |x: f64| x.powi(degree as i32);
            let whole: f64 = (0..RADAU_STAGES)
                .map(|j| tables.integrals[RADAU_STAGES - 1][j] * power(tables.nodes[j]))
                .sum();
            assert!((whole - 1.0 / (degree + 1) as f64).abs() < 1e-14, "degree {degree}");
            if degree < RADAU_STAGES {
                for (row, c) in tables.integrals.iter().zip(&tables.nodes) {
                    let part: f64 = row.iter().zip(&tables.nodes).map(|(a, c)| a * power(*c)).sum();
                    assert!((part - c * power(*c) / (degree + 1) as f64).abs() < 1e-14);
                }
            }
            if degree <= RADAU_STAGES {
                let values = core::array::from_fn(|i| power(tables.point(i)));
                assert!((tables.interpolate(&values, 0.37) - power(0.37)).abs() < 1e-14);
                for (i, slope) in tables.derivatives(&values).iter().enumerate() {
                    let exact = if degree == 0 {
                        0.0
                    } else {
                        degree as f64 * tables.point(i).powi(degree as i32 - 1)
                    };
                    assert!((slope - exact).abs() < 1e-11);
                }
            }
        }
    }
}
