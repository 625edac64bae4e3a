//! Structures whose K is a multiple of M, and whose damping is no multiple of either, against a direct solution: isotropic rotors and
//! equal blades.

use crate::common::models::Structure;
use crate::common::options::{harmonics, omega_range};
use hbvib::{Hooks, Spring, forced_response};
use nalgebra::{Complex, DMatrix, DVector};

const RANGE: [f64; 2] = [0.3, 2.5];

/// n equal masses on equal springs, K the multiple 1 of M but for `rounding`, and dashpots of different sizes.
fn structure(n: usize, rounding: f64) -> (Structure, [Vec<f64>; 2]) {
    let (mut stiffness, mut damping) = (vec![0.0; n * n], vec![0.0; n * n]);
    let mut mass = vec![0.0; n * n];
    for i in 0..n {
        mass[i * n + i] = 1.0;
        stiffness[i * n + i] = 1.0 + rounding * (2.3 * i as f64).sin();
        damping[i * n + i] = 0.02 + 0.03 * (1.1 * i as f64).cos().abs();
    }
    let matrices = [stiffness.clone(), damping.clone()];
    (Structure::plain(n).matrices([&mass, &damping, &stiffness]), matrices)
}

#[test]
fn sweeps_of_a_structure_whose_stiffness_is_a_multiple_of_its_mass_are_direct_solutions() {
    for n in [1, 2, 3, 33, 101] {
        for rounding in [0.0, 1e-15, 1e-6] {
            for springs in [0.0, 0.2] {
                let (built, [stiffness, damping]) = structure(n, rounding);
                let mut k = DMatrix::from_vec(n, n, stiffness).map(Complex::from);
                let mut links = Vec::new();
                for i in 1..n {
                    if springs > 0.0 {
                        links.push(Spring {
                            dof_a: Some(i - 1),
                            dof_b: Some(i),
                            sector_offset: 0,
                            stiffness: springs,
                        });
                        for (a, b) in [(i - 1, i), (i, i - 1)] {
                            k[(a, a)] += springs;
                            k[(a, b)] -= springs;
                        }
                    }
                }
                let c = DMatrix::from_vec(n, n, damping).map(Complex::from);
                let model = built.springs(links).force(0, 1, 1.0).build();
                for [start, stop] in [RANGE, [RANGE[1], RANGE[0]]] {
                    let range = omega_range(start, stop);
                    let branch = forced_response(&model, &harmonics(1), &range, &mut Hooks::default()).unwrap();
                    for (omega, amplitude) in branch.omega().iter().zip(branch.amplitude()).step_by(7) {
                        let z = &k + &c * Complex::new(0.0, *omega)
                            - DMatrix::identity(n, n) * Complex::from(omega * omega);
                        let mut force = DVector::zeros(n);
                        force[0] = Complex::new(1.0, 0.0);
                        let exact = z.lu().solve(&force).unwrap()[branch.response_dof()].norm();
                        assert!(
                            (amplitude - exact).abs() < 1e-9 * exact,
                            "{n} {rounding} {springs} at {omega}: {amplitude} {exact}"
                        );
                    }
                }
            }
        }
    }
}
