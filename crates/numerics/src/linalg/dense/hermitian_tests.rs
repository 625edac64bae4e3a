//! Tests of Hermitian eigenvalues.

use super::*;

fn matrix(n: usize, seed: f64) -> Vec<Complex64> {
    let mut a = vec![Complex64::ZERO; n * n];
    for j in 0..n {
        for i in j..n {
            let k = (i * n + j) as f64;
            let z = Complex64::new((k * 0.37 + seed).sin(), if i == j { 0.0 } else { (k * 0.71).cos() });
            a[j * n + i] = z;
            a[i * n + j] = z.conj();
        }
    }
    a
}

#[test]
fn vectors_diagonalise_the_matrix_and_are_orthonormal() {
    for n in [1, 2, 3, 17, 60] {
        let a = matrix(n, 0.2);
        let (values, x) = eigen(&mut a.clone(), n, &Interrupt::none()).unwrap();
        assert!(values.is_sorted());
        let column = |k: usize| &x[k * n..(k + 1) * n];
        for (k, value) in values.iter().enumerate() {
            for l in 0..n {
                let product: Complex64 = column(k).iter().zip(column(l)).map(|(x, y)| x.conj() * y).sum();
                assert!((product - f64::from(u8::from(k == l))).norm() < 1e-13);
            }
            for i in 0..n {
                let ax: Complex64 = (0..n).map(|j| a[j * n + i] * column(k)[j]).sum();
                assert!((ax - value * column(k)[i]).norm() < 1e-12 * n as f64);
            }
        }
    }
}

#[test]
fn a_chain_has_its_frequencies_in_closed_form_and_repeated_ones_keep_their_vectors() {
    // Two equal chains of 40 masses with fixed ends: λ = 2 − 2 cos(kπ/41), each twice.
    let (length, n) = (40, 80);
    let mut a = vec![Complex64::ZERO; n * n];
    for i in 0..n {
        a[i * n + i] = 2.0.into();
        if i % length > 0 {
            a[i * n + i - 1] = -Complex64::I;
            a[(i - 1) * n + i] = Complex64::I;
        }
    }
    let (values, x) = eigen(&mut a, n, &Interrupt::none()).unwrap();
    for (k, value) in values.iter().enumerate() {
        let exact = 2.0 - 2.0 * ((k / 2 + 1) as f64 * std::f64::consts::PI / (length + 1) as f64).cos();
        assert!((value - exact).abs() < 1e-13, "{k}: {value} {exact}");
    }
    let product: Complex64 = x[..n].iter().zip(&x[n..2 * n]).map(|(x, y)| x.conj() * y).sum();
    assert!(product.norm() < 1e-13);
}

#[test]
fn a_positive_definite_matrix_has_a_triangular_root() {
    let n = 30;
    let mut a = matrix(n, 0.4);
    for i in 0..n {
        a[i * n + i] += 20.0;
    }
    let mut l = a.clone();
    assert!(cholesky(&mut l, n, &Interrupt::none()).unwrap());
    let mut x: Vec<Complex64> = (0..n).map(|k| Complex64::cis(k as f64)).collect();
    let mut b: Vec<Complex64> = (0..n).map(|i| (0..n).map(|j| a[j * n + i] * x[j]).sum()).collect();
    solve_triangular(&l, n, false, &mut b, &Interrupt::none()).unwrap();
    solve_triangular(&l, n, true, &mut b, &Interrupt::none()).unwrap();
    for (x, b) in x.iter_mut().zip(b) {
        assert!((*x - b).norm() < 1e-13);
    }
    a[0] = (-1.0).into();
    assert!(!cholesky(&mut a, n, &Interrupt::none()).unwrap());
}
