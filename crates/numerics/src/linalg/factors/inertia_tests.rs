//! Tests of counts of eigenvalues.

use super::*;
use crate::linalg::sparse_storage::sparse::Csc;

/// A chain of `n` masses with springs 1, held at both ends, over a second one that turns its phases, or not.
fn chain(n: usize, phase: f64) -> (Csc, Csc) {
    let mut k = Vec::new();
    for i in 0..n {
        k.push((i, i, Complex64::from(2.0)));
        if i > 0 {
            k.push((i, i - 1, -Complex64::cis(phase)));
            k.push((i - 1, i, -Complex64::cis(-phase)));
        }
    }
    let m = (0..n).map(|i| (i, i, Complex64::ONE)).collect();
    (
        Csc::from_triplets(n, n, k).unwrap(),
        Csc::from_triplets(n, n, m).unwrap(),
    )
}

/// A square of `n` × `n` masses, whose factors have supernodes: sums of the eigenvalues of two chains.
fn square(n: usize) -> (Csc, Csc) {
    let mut k = Vec::new();
    let mut add = |i, j, v: f64| k.push((i, j, Complex64::from(v)));
    for p in 0..n * n {
        add(p, p, 4.0);
        for q in [(p % n > 0).then(|| p - 1), (p >= n).then(|| p - n)]
            .into_iter()
            .flatten()
        {
            add(p, q, -1.0);
            add(q, p, -1.0);
        }
    }
    let m = (0..n * n).map(|i| (i, i, Complex64::ONE)).collect();
    (
        Csc::from_triplets(n * n, n * n, k).unwrap(),
        Csc::from_triplets(n * n, n * n, m).unwrap(),
    )
}

fn of_chain(n: usize) -> Vec<f64> {
    let value = |j: usize| 2.0 - 2.0 * (j as f64 * std::f64::consts::PI / (n + 1) as f64).cos();
    (1..=n).map(value).collect()
}

#[test]
fn counts_are_those_of_closed_forms() {
    let count = |(k, m): &(Csc, Csc), sigma, real| {
        eigenvalues_below(k, (sigma, m), real, &Interrupt::none())
            .unwrap()
            .unwrap()
            .count
    };
    let single = of_chain(150);
    let (real, complex) = (chain(150, 0.0), chain(150, 0.7));
    let side = of_chain(40);
    let sums: Vec<f64> = side.iter().flat_map(|a| side.iter().map(move |b| a + b)).collect();
    let plane = square(40);
    for sigma in [-0.1, 1e-4, 0.013, 0.5, 1.7, 2.3, 3.9, 9.0] {
        let below = |values: &[f64]| values.iter().filter(|&&value| value < sigma).count();
        assert_eq!(count(&real, sigma, true), below(&single), "{sigma}");
        assert_eq!(count(&complex, sigma, false), below(&single), "{sigma}");
        assert_eq!(count(&plane, sigma, true), below(&sums), "{sigma}");
        assert_eq!(count(&plane, sigma, false), below(&sums), "{sigma}");
    }
}

#[test]
fn a_factor_counts_in_its_memory_and_is_made_again_to_the_bit() {
    let none = Interrupt::none();
    let side = of_chain(40);
    let sums: Vec<f64> = side.iter().flat_map(|a| side.iter().map(move |b| a + b)).collect();
    let (k, m) = square(40);
    let a = Triangle::<f64>::sum(&k, (0.01, &m), &none).unwrap();
    let mut factor = Cholesky::new(&a, |_| Ok(()), &none).unwrap().unwrap();
    let load: Vec<f64> = (0..1600).map(|i| f64::from(i % 7) - 2.0).collect();
    let mut before = load.clone();
    factor.solve(&mut before, &none).unwrap();
    for sigma in [1e-4, 0.5, 1.7, 9.0] {
        let shifted = Triangle::sum(&k, (-sigma, &m), &none).unwrap();
        let below = factor.negative_pivots(&shifted, &none).unwrap().unwrap();
        assert_eq!(below.count, sums.iter().filter(|&&value| value < sigma).count());
        factor.make_again(&a, &none).unwrap();
        let mut after = load.clone();
        factor.solve(&mut after, &none).unwrap();
        assert!(before.iter().zip(&after).all(|(x, y)| x.to_bits() == y.to_bits()));
    }
    assert!(
        factor
            .make_again(&Triangle::sum(&k, (-0.5, &m), &none).unwrap(), &none)
            .is_err()
    );
}
