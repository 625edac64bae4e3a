//! Tests of factors with few entries in a column.

use super::*;
use crate::linalg::factors::factor::Factor;

/// A matrix without symmetry of values: bands, numbered at random, of which some have zeros on the diagonal.
fn bands(n: usize, width: usize, seed: f64) -> Csc {
    let place = |i: usize| (i * 7 + 3) % n;
    let mut entries = Vec::new();
    for i in 0..n {
        for j in i.saturating_sub(width)..(i + width + 1).min(n) {
            let noise = |a: f64| (a * (i * n + j) as f64 + seed).sin();
            let zero = i == j && i % 5 == 0;
            let value = Complex64::new(noise(0.37) + f64::from(u8::from(i == j)), noise(1.3));
            entries.push((place(i), place(j), if zero { Complex64::ZERO } else { value }));
        }
    }
    Csc::from_triplets(n, n, entries).unwrap()
}

fn size(z: &[Complex64]) -> f64 {
    z.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt()
}

#[test]
fn solutions_satisfy_their_equations_and_those_of_the_transpose() {
    for (n, width) in [(30, 1), (101, 1), (240, 3)] {
        let mut lu = SlenderLu::new(n).unwrap();
        for seed in [0.2, 1.9] {
            let a = bands(n, width, seed);
            lu.factor(&a).unwrap();
            let b: Vec<Complex64> = (0..n).map(|k| Complex64::cis(0.7 * k as f64)).collect();
            let mut x = b.clone();
            lu.solve(&mut x, false).unwrap();
            let mut rest = b.clone();
            a.multiply_add(-Complex64::ONE, &x, &mut rest);
            assert!(size(&rest) < 1e-11 * size(&b), "{n}: {:e}", size(&rest));
            // (Aᵀ y)ᵀ c = yᵀ (A c)
            let mut y = b.clone();
            lu.solve(&mut y, true).unwrap();
            let c: Vec<Complex64> = (0..n).map(|k| Complex64::cis(1.1 * (k * k) as f64)).collect();
            let mut of_c = vec![Complex64::ZERO; n];
            a.multiply_add(Complex64::ONE, &c, &mut of_c);
            let product = |a: &[Complex64], b: &[Complex64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<Complex64>();
            let (found, exact) = (product(&y, &of_c), product(&b, &c));
            assert!(
                (found - exact).norm() < 1e-10 * size(&y) * size(&of_c),
                "{n}: {found} {exact}"
            );
        }
    }
}

#[test]
fn a_flexibility_side_by_side_is_made_of_solutions_one_by_one() {
    let (n, count) = (120, 37);
    let a = bands(n, 2, 0.4);
    let mut factor = Factor::new(&a, 1).unwrap();
    factor.factor(&a, &Interrupt::none()).unwrap();
    let ports: Vec<Vec<(usize, Complex64)>> = (0..count)
        .map(|c| {
            vec![
                (3 * c, Complex64::cis(c as f64)),
                ((5 * c + 1) % n, Complex64::new(-0.5, 0.2)),
            ]
        })
        .collect();
    let entries: Vec<Entries<'_>> = ports.iter().map(Vec::as_slice).collect();
    let weights: Vec<Complex64> = (0..n).map(|k| Complex64::cis(0.3 * k as f64)).collect();
    let stride = count + 2;
    let mut table = vec![Complex64::ZERO; stride * count];
    let mut products = vec![Complex64::ZERO; count];
    let lu = factor.slender().expect("factors with few entries in a column");
    let moved = (&weights[..], &mut products[..]);
    lu.flexibility(
        entries.len(),
        |port| entries[port],
        (&mut table, stride),
        moved,
        &Interrupt::none(),
    )
    .unwrap();
    for (c, input) in ports.iter().enumerate() {
        let mut x = vec![Complex64::ZERO; n];
        for &(p, a) in input {
            x[p] += a.conj();
        }
        factor.solve(&mut x, false, &Interrupt::none()).unwrap();
        for (r, output) in ports.iter().enumerate() {
            let exact: Complex64 = output.iter().map(|&(p, a)| a * x[p]).sum();
            assert!((table[c * stride + r] - exact).norm() < 1e-12 * size(&x), "{c} {r}");
        }
        let exact: Complex64 = weights.iter().zip(&x).map(|(w, x)| w * x).sum();
        assert!((products[c] - exact).norm() < 1e-11 * size(&x), "{c}");
    }
}

#[test]
fn a_matrix_without_inverse_or_with_a_number_that_is_none_is_an_error() {
    let n = 40;
    let chain = |middle: Complex64| {
        let mut entries = Vec::new();
        for i in 0..n {
            // A free chain: its rows add to zero.
            let ends = f64::from(u8::from(i == 0 || i == n - 1));
            entries.push((i, i, if i == 20 { middle } else { (2.0 - ends).into() }));
            if i > 0 {
                entries.push((i, i - 1, -Complex64::ONE));
                entries.push((i - 1, i, -Complex64::ONE));
            }
        }
        Csc::from_triplets(n, n, entries).unwrap()
    };
    for middle in [Complex64::new(2.0, 0.0), Complex64::new(f64::NAN, 0.0)] {
        let a = chain(middle);
        let mut factor = Factor::new(&chain(Complex64::new(2.0, 0.0)), 1).unwrap();
        let solved = factor.factor(&a, &Interrupt::none()).and_then(|()| {
            let mut b = vec![Complex64::ONE; n];
            factor.solve(&mut b, false, &Interrupt::none())
        });
        assert_eq!(solved.unwrap_err().status, Status::Singular);
    }
}
