//! An element for tests of meshes.

type Rows = Vec<[[f64; 24]; 24]>;

/// Stiffness and mass of a brick with eight nodes of density 1, from the elastic modulus and Poisson's ratio, by 2 × 2 × 2 points.
pub fn brick(x: &[[f64; 3]], (e, nu): (f64, f64)) -> Rows {
    let (lambda, shear) = (e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), e / (2.0 * (1.0 + nu)));
    let signs: [[f64; 3]; 8] = [
        [-1.0, -1.0, -1.0],
        [1.0, -1.0, -1.0],
        [1.0, 1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
        [1.0, -1.0, 1.0],
        [1.0, 1.0, 1.0],
        [-1.0, 1.0, 1.0],
    ];
    let mut both = vec![[[0.0; 24]; 24]; 2];
    for point in signs {
        let p = point.map(|s| s / 3.0_f64.sqrt());
        let factors = signs.map(|s| [0, 1, 2].map(|d| 1.0 + s[d] * p[d]));
        let shapes = factors.map(|f| f[0] * f[1] * f[2] / 8.0);
        let slopes: Vec<[f64; 3]> = signs
            .iter()
            .zip(&factors)
            .map(|(s, f)| {
                [
                    s[0] * f[1] * f[2] / 8.0,
                    s[1] * f[0] * f[2] / 8.0,
                    s[2] * f[0] * f[1] / 8.0,
                ]
            })
            .collect();
        let j = [0, 1, 2].map(|a| [0, 1, 2].map(|b| slopes.iter().zip(x).map(|(s, x)| s[a] * x[b]).sum::<f64>()));
        let minor = |a: usize, b: usize| {
            let (r, s, c, d) = ((a + 1) % 3, (a + 2) % 3, (b + 1) % 3, (b + 2) % 3);
            j[r][c] * j[s][d] - j[r][d] * j[s][c]
        };
        let determinant: f64 = (0..3).map(|b| j[0][b] * minor(0, b)).sum();
        assert!(determinant > 0.0);
        let slope = |s: &[f64; 3]| [0, 1, 2].map(|b| (0..3).map(|a| minor(a, b) * s[a]).sum::<f64>() / determinant);
        let global: Vec<[f64; 3]> = slopes.iter().map(slope).collect();
        for m in 0..8 {
            for n in 0..8 {
                let (g, h) = (global[m], global[n]);
                let scalar: f64 = (0..3).map(|d| g[d] * h[d]).sum();
                for a in 0..3 {
                    for b in 0..3 {
                        let same = if a == b { shear * scalar } else { 0.0 };
                        both[0][3 * m + a][3 * n + b] +=
                            determinant * (lambda * g[a] * h[b] + shear * g[b] * h[a] + same);
                    }
                    both[1][3 * m + a][3 * n + a] += determinant * shapes[m] * shapes[n];
                }
            }
        }
    }
    both
}
