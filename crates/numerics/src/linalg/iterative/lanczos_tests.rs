//! Tests of Lanczos' method.

use super::*;

/// Three equal free chains of 100 unit masses: every eigenvalue 2 − 2 cos(jπ/100) thrice.
fn three_chains() -> (Csc, Csc) {
    let (chains, length) = (3, 100);
    let n = chains * length;
    let mut k = Vec::new();
    for c in 0..chains {
        for i in 0..length - 1 {
            let (p, q) = (c * length + i, c * length + i + 1);
            for (r, s, v) in [(p, p, 1.0), (q, q, 1.0), (p, q, -1.0), (q, p, -1.0)] {
                k.push((r, s, Complex64::from(v)));
            }
        }
    }
    let m = (0..n).map(|i| (i, i, Complex64::ONE)).collect();
    (
        Csc::from_triplets(n, n, k).unwrap(),
        Csc::from_triplets(n, n, m).unwrap(),
    )
}

fn of_chain(j: usize) -> f64 {
    2.0 - 2.0 * (j as f64 * std::f64::consts::PI / 100.0).cos()
}

#[test]
fn repeated_and_zero_eigenvalues_are_all_found() {
    let (k, m) = three_chains();
    let pairs = lowest(&k, &m, 8, &Interrupt::none()).unwrap();
    for (i, value) in pairs.values.iter().enumerate() {
        let exact = of_chain(i / 3);
        assert!((value - exact).abs() < 1e-12, "{i}: {value} against {exact}");
    }
}

#[test]
fn the_lowest_of_a_family_far_from_zero_are_told_apart() {
    // A chain of unit masses, fixed at its ends, on springs: λ = s + 2 − 2 cos(jπ/(n + 1)).
    for (n, s) in [
        (130, 100.0),
        (201, 1e3),
        (300, 1.0),
        (600, 0.2),
        (600, 1e4),
        (3000, 1.0),
    ] {
        let (mut k, mut m) = (Vec::new(), Vec::new());
        for i in 0..n {
            k.push((i, i, Complex64::from(s + 2.0)));
            m.push((i, i, Complex64::ONE));
            if i > 0 {
                k.push((i - 1, i, Complex64::from(-1.0)));
                k.push((i, i - 1, Complex64::from(-1.0)));
            }
        }
        let (k, m) = (
            Csc::from_triplets(n, n, k).unwrap(),
            Csc::from_triplets(n, n, m).unwrap(),
        );
        for count in [1, 3] {
            let pairs = lowest(&k, &m, count, &Interrupt::none()).unwrap();
            assert_eq!(pairs.values.len(), count);
            for (j, value) in pairs.values.iter().enumerate() {
                let angle = (j + 1) as f64 * std::f64::consts::PI / (n + 1) as f64;
                let exact = s + 4.0 * (0.5 * angle).sin().powi(2);
                assert!(
                    (value / exact - 1.0).abs() < 1e-13,
                    "{n}, {s}, {j}: {value} against {exact}"
                );
            }
        }
    }
}

#[test]
fn equal_oscillators_have_one_frequency_as_often_as_they_are() {
    // 200 equal oscillators, apart from each other but for the last two.
    let n = 200;
    let (mut k, m) = (Vec::new(), (0..n).map(|i| (i, i, Complex64::ONE)).collect());
    for i in 0..n {
        k.push((i, i, Complex64::from(if i < n - 2 { 5.0 } else { 5.5 })));
    }
    for (i, j) in [(n - 2, n - 1), (n - 1, n - 2)] {
        k.push((i, j, Complex64::from(-1.0)));
    }
    let (k, m) = (
        Csc::from_triplets(n, n, k).unwrap(),
        Csc::from_triplets(n, n, m).unwrap(),
    );
    let pairs = lowest(&k, &m, 4, &Interrupt::none()).unwrap();
    for (value, exact) in pairs.values.iter().zip([4.5, 5.0, 5.0, 5.0]) {
        assert!((value - exact).abs() < 1e-12, "{value} against {exact}");
    }
}

#[test]
fn all_eigenvalues_of_an_interval_are_found_with_their_copies() {
    let (k, m) = three_chains();
    for (low, high) in [(-1e-9, 0.3), (0.5, 0.8), (1.9, 2.1), (3.5, 4.5), (0.5, 2.5), (5.0, 6.0)] {
        let exact: Vec<f64> = (0..300)
            .map(|i| of_chain(i / 3))
            .filter(|x| (low..=high).contains(x))
            .collect();
        let pairs = within_at_once((&k, &m), (low, high), 200, &Interrupt::none())
            .unwrap()
            .unwrap();
        assert_eq!(pairs.values.len(), exact.len(), "{low} .. {high}");
        for (at, (value, exact)) in pairs.values.iter().zip(&exact).enumerate() {
            assert!((value - exact).abs() < 1e-11, "{value} against {exact}");
            let x: Vec<Complex64> = pairs.vectors.column(at).iter().copied().collect();
            let mut rest = vec![Complex64::ZERO; 300];
            k.multiply_add(Complex64::ONE, &x, &mut rest);
            m.multiply_add((-value).into(), &x, &mut rest);
            let off = rest.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
            assert!(off < 1e-6, "{low} .. {high}, {at}: {off:e}");
        }
    }
    assert!(
        within_at_once((&k, &m), (0.5, 2.5), 20, &Interrupt::none())
            .unwrap()
            .is_none()
    );
}

#[test]
fn intervals_of_complex_pencils_with_massless_motions_are_those_of_dense_algebra() {
    for (n, every) in [(140, 1000), (260, 7)] {
        let (mut k, mut m) = (Vec::new(), Vec::new());
        for i in 0..n {
            let x = i as f64;
            k.push((i, i, Complex64::from(4.0 + (1.3 * x).sin())));
            for apart in [1, 5] {
                if i + apart < n {
                    let value = Complex64::from_polar(0.8, 0.7 * x);
                    k.push((i, i + apart, value));
                    k.push((i + apart, i, value.conj()));
                }
            }
            if i % every != 3 {
                m.push((i, i, Complex64::from(1.0 + 0.4 * (0.9 * x).cos())));
            }
        }
        let (k, m) = (
            Csc::from_triplets(n, n, k).unwrap(),
            Csc::from_triplets(n, n, m).unwrap(),
        );
        let all = all_of(&k, &m, n, &Interrupt::none()).unwrap().values;
        for (from, to) in [(0, 9), (20, 60), (n / 2, n / 2 + 2), (n / 3, 2 * n / 3)] {
            let middle = |at: usize| 0.5 * (all[at] + all[at + 1]);
            let interval = (if from == 0 { all[0] - 1.0 } else { middle(from - 1) }, middle(to));
            let found = within_at_once((&k, &m), interval, n, &Interrupt::none())
                .unwrap()
                .unwrap();
            assert_eq!(found.values.len(), to + 1 - from, "{n}, {from} to {to}");
            for (value, exact) in found.values.iter().zip(&all[from..=to]) {
                assert!((value - exact).abs() < 1e-10, "{n}: {value} against {exact}");
            }
        }
    }
}
