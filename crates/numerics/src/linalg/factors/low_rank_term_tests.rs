//! Solutions with the damping of few modes as a term of low rank beside sparse factors, against dense factors of the whole matrix.

use super::*;

/// Stiffness, mass, gyroscopic coupling and loss of a chain of unit masses and springs between walls at ν.
struct Chain {
    n: usize,
    nu: f64,
    coupling: f64,
    loss: f64,
}

impl Chain {
    fn omega(&self, k: usize) -> f64 {
        2.0 * (k as f64 * std::f64::consts::FRAC_PI_2 / (self.n + 1) as f64).sin()
    }

    /// Z₀ without modal damping.
    fn matrix(&self) -> Csc {
        let n = self.n;
        let mut entries = Vec::new();
        for i in 0..n {
            // A loss at every other mass, so that the stiffness is complex and no multiple of a real one.
            let lost = if i % 2 == 0 { self.loss } else { 0.0 };
            entries.push((i, i, Complex64::new(2.0 - self.nu * self.nu, lost)));
            if i > 0 {
                let turned = Complex64::new(0.0, self.nu * self.coupling);
                entries.push((i - 1, i, turned - 1.0));
                entries.push((i, i - 1, -turned - 1.0));
            }
        }
        Csc::from_triplets(n, n, entries).unwrap()
    }

    /// Columns of L for damping ratios of the lowest modes.
    fn directions(&self, count: usize, ratio: f64) -> Vec<SparseVector> {
        let n = self.n;
        let shape = |k: usize, i: usize| {
            (2.0 / (n + 1) as f64).sqrt() * (std::f64::consts::PI * (k * (i + 1)) as f64 / (n + 1) as f64).sin()
        };
        let column = |k: usize| -> SparseVector {
            let size = (2.0 * ratio * self.omega(k)).sqrt();
            (0..n).map(|i| (i, (size * shape(k, i)).into())).collect()
        };
        (1..=count).map(column).collect()
    }
}

/// Largest difference from dense factors, relative to the motion and to the rounding ε‖Z‖‖Z⁻¹‖ of any solution.
fn departure(chain: &Chain, count: usize, ratio: f64, transposed: bool) -> f64 {
    let none = Interrupt::none();
    let (n, z, directions) = (chain.n, chain.matrix(), chain.directions(count, ratio));
    let c = Complex64::new(0.0, chain.nu);
    let mut dense = Lu::<Complex64>::new(n, 2).unwrap();
    dense.matrix().fill(Complex64::ZERO);
    z.add_to_dense(Complex64::ONE, dense.matrix());
    for direction in &directions {
        for (j, b) in direction {
            for (i, a) in direction {
                dense.matrix()[j * n + i] += c * a * b.conj();
            }
        }
    }
    dense.factor(&none).unwrap();
    let mut loads = vec![Complex64::ZERO; 2 * n];
    loads[n / 3] = Complex64::ONE;
    for (i, load) in loads[n..].iter_mut().enumerate() {
        *load = Complex64::new((0.3 * i as f64).cos(), (1.1 * i as f64).sin());
    }
    let mut known = loads.clone();
    dense.solve_columns(&mut known, transposed, &none).unwrap();
    let mut factor = Factor::new(&z, 2).unwrap();
    factor.factor(&z, &none).unwrap();
    let mut term = LowRankTerm::new(n, count).unwrap();
    let mut sides = Sides {
        factor: &mut factor,
        matrix: &z,
        directions: &directions,
    };
    term.renew(c, &mut sides, &none).unwrap();
    term.solve(&mut sides, &mut loads, transposed, &none).unwrap();
    let off: Vec<Complex64> = loads.iter().zip(&known).map(|(a, b)| a - b).collect();
    // Loads of about 1, and a matrix of about 4.
    largest(&off) / (largest(&known) * 4.0 * f64::EPSILON * largest(&known).max(1.0))
}

#[test]
fn solutions_are_those_of_dense_factors() {
    for n in [10, 33, 101, 200, 700, 1000] {
        let count = (n / 6).min(8);
        let ratios: &[f64] = if n < 500 { &[1e-7, 1e-3, 0.3] } else { &[1e-5] };
        for &ratio in ratios {
            for (coupling, loss) in [(0.0, 0.0), (0.02, 0.0), (0.02, 1e-3)] {
                for at_resonance in [true, false] {
                    let mut chain = Chain {
                        n,
                        nu: 0.3,
                        coupling,
                        loss,
                    };
                    if at_resonance {
                        chain.nu = chain.omega(1);
                    }
                    let transposed = n != 700 && (n != 1000 || coupling > 0.0);
                    let off = departure(&chain, count, ratio, transposed);
                    let plain = if n < 500 {
                        departure(&chain, count, ratio, false)
                    } else {
                        off
                    };
                    assert!(
                        off.max(plain) < 300.0,
                        "n = {n}, ratio {ratio:e}, coupling {coupling}, loss {loss}, ν = {}: {off:e}, {plain:e}",
                        chain.nu
                    );
                }
            }
        }
    }
}

#[test]
fn products_with_the_term_are_those_of_its_matrix() {
    let chain = Chain {
        n: 40,
        nu: 0.4,
        coupling: 0.0,
        loss: 0.0,
    };
    let mut directions = chain.directions(5, 0.1);
    // Complex ones, whose transposed product differs.
    for (k, direction) in directions.iter_mut().enumerate() {
        for (i, z) in direction {
            *z *= Complex64::cis(0.2 * (k * *i) as f64);
        }
    }
    let c = Complex64::new(0.3, -0.7);
    let x: Vec<Complex64> = (0..40).map(|i| Complex64::cis(0.7 * f64::from(i))).collect();
    for transposed in [false, true] {
        let mut found = vec![Complex64::ZERO; 40];
        add_term_product(&directions, c, transposed, &x, &mut found);
        for (i, found) in found.iter().enumerate() {
            let mut exact = Complex64::ZERO;
            for direction in &directions {
                for (j, x) in x.iter().enumerate() {
                    let (a, b) = if transposed { (j, i) } else { (i, j) };
                    exact += c * direction[a].1 * direction[b].1.conj() * x;
                }
            }
            assert!((found - exact).norm() < 1e-14, "{transposed}, {i}");
        }
    }
}
