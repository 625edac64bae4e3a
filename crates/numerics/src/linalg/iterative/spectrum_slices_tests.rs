//! Tests of the eigenpairs of an interval.

use super::*;
use num_complex::Complex64;

/// Equal chains of unit masses between unit springs, held at both ends, beside each other: λ = 4 sin²(jπ/(2n + 2)), each so often.
fn chains(count: usize, n: usize) -> (Csc, Csc) {
    let mut k = Vec::new();
    for chain in 0..count {
        for i in 0..n {
            let p = chain * n + i;
            k.push((p, p, Complex64::from(2.0)));
            if i > 0 {
                k.push((p - 1, p, Complex64::from(-1.0)));
                k.push((p, p - 1, Complex64::from(-1.0)));
            }
        }
    }
    let order = count * n;
    let m = (0..order).map(|i| (i, i, Complex64::ONE)).collect();
    (
        Csc::from_triplets(order, order, k).unwrap(),
        Csc::from_triplets(order, order, m).unwrap(),
    )
}

fn exact(n: usize, j: usize) -> f64 {
    4.0 * (0.5 * j as f64 * std::f64::consts::PI / (n + 1) as f64).sin().powi(2)
}

#[test]
fn slices_find_every_eigenvalue_of_an_interval_once_and_repeated_ones_so_often() {
    for (count, n, (from, to)) in [(1, 400, (20, 330)), (3, 100, (1, 70)), (1, 300, (1, 300))] {
        let (k, m) = chains(count, n);
        let low = 0.5 * (exact(n, from - 1) + exact(n, from));
        let high = 0.5 * (exact(n, to) + exact(n, to + 1));
        let pairs = within((&k, &m), (low, high), 1000, &Interrupt::none())
            .unwrap()
            .unwrap();
        assert_eq!(pairs.values.len(), count * (to + 1 - from));
        for (i, value) in pairs.values.iter().enumerate() {
            let expected = exact(n, from + i / count);
            assert!((value - expected).abs() < 1e-12, "{i}: {value} against {expected}");
        }
        // K Φ = M Φ Λ and Φᴴ M Φ = 1, between vectors of different slices, too.
        for (i, value) in pairs.values.iter().enumerate().step_by(7) {
            let column = pairs.vectors.column(i);
            let product = k.times(column.as_slice(), CONTEXT).unwrap();
            let gap = product
                .iter()
                .zip(&column)
                .map(|(p, x)| (p - value * x).norm_sqr())
                .sum::<f64>()
                .sqrt();
            assert!(gap < 1e-7, "{i}: {gap:e}");
            for j in (0..pairs.values.len()).step_by(5) {
                let with = pairs.vectors.column(j).dotc(&column);
                let expected = if i == j { 1.0 } else { 0.0 };
                assert!((with - expected).norm() < 1e-7, "{i} {j}: {with}");
            }
        }
    }
}

#[test]
fn more_eigenvalues_than_are_allowed_are_told_without_a_search() {
    let (k, m) = chains(1, 400);
    let interval = (0.0, 4.0);
    assert!(within((&k, &m), interval, 399, &Interrupt::none()).unwrap().is_none());
    assert_eq!(
        within((&k, &m), interval, 400, &Interrupt::none())
            .unwrap()
            .unwrap()
            .values
            .len(),
        400
    );
}
