//! Tests of Cholesky factors.

use super::*;
use crate::linalg::sparse_storage::triangle_product::multiply;

/// A Hermitian chain in the plane with random couplings.
fn matrix(n: usize, complex: bool, shift: f64) -> Csc {
    let mut entries = Vec::new();
    for i in 0..n {
        entries.push((i, i, Complex64::from(4.0 + shift + (i as f64).sin())));
        for (step, size) in [(1, 0.9), (17, 0.7)] {
            if i >= step {
                let im = if complex { (3.0 * i as f64).cos() } else { 0.0 };
                let z = size * Complex64::new((2.0 * i as f64).cos(), im);
                entries.extend([(i, i - step, z), (i - step, i, z.conj())]);
            }
        }
    }
    Csc::from_triplets(n, n, entries).unwrap()
}

#[test]
fn solutions_leave_no_residual_and_an_indefinite_matrix_is_refused() {
    let n = 300;
    let none = Csc::from_triplets(n, n, Vec::new()).unwrap();
    for complex in [false, true] {
        let a = matrix(n, complex, 0.0);
        let x: Vec<Complex64> = (0..n).map(|k| Complex64::cis(k as f64)).collect();
        let mut b = a.times(&x, "a test").unwrap();
        let interrupt = Interrupt::none();
        let mut factor = Definite::new(&a, (0.0, &none), &interrupt).unwrap().unwrap();
        assert_eq!(matches!(factor, Definite::Complex(_)), complex);
        factor.solve(&mut b, &interrupt).unwrap();
        assert!(x.iter().zip(&b).all(|(x, b)| (x - b).norm() < 1e-12));
        let indefinite = matrix(n, complex, -4.0);
        assert!(Definite::new(&indefinite, (0.0, &none), &interrupt).unwrap().is_none());
    }
}

/// A box of finite elements with three rows at each node, and random couplings.
fn box_of_elements<T: Entry>(side: usize) -> Triangle<T> {
    let place = |k: usize| [k / 3 % side, k / 3 / side % side, k / 3 / side / side];
    let n = 3 * side * side * side;
    let (mut col_ptr, mut row_idx, mut values) = (vec![0], Vec::new(), Vec::new());
    for j in 0..n {
        let beside = |i: &usize| (0..3).all(|d| place(*i)[d].abs_diff(place(j)[d]) <= 1);
        for i in (j..n.min(j + 3 * (side * side + side + 2))).filter(beside) {
            let z = Complex64::new((3.0 * i as f64 + j as f64).cos(), (i as f64 - 2.0 * j as f64).sin());
            row_idx.push(crate::linalg::sparse_storage::row_index::narrow(i));
            values.push(T::of(if i == j { 100.0.into() } else { z }));
        }
        col_ptr.push(values.len());
    }
    Triangle {
        n,
        col_ptr,
        row_idx,
        values,
    }
}

fn solutions_by_both_orders<T: Entry>(side: usize) {
    let interrupt = Interrupt::none();
    let a = box_of_elements::<T>(side);
    let x: Vec<T> = (0..a.n).map(|k| T::of(Complex64::cis(k as f64))).collect();
    let [first, second] = [Order::Degrees, Order::Dissection].map(|order| {
        let mut b = vec![T::NONE; a.n];
        multiply(&[(1.0, &a)], &x, &mut b, &interrupt).unwrap();
        let factor = Cholesky::by_order(&a, order, |_| Ok(()), &interrupt).unwrap();
        factor.unwrap().solve(&mut b, &interrupt).unwrap();
        b
    });
    for (x, (a, b)) in x.iter().zip(first.iter().zip(&second)) {
        assert!((a.complex() - b.complex()).norm() < 1e-13);
        assert!((a.complex() - x.complex()).norm() < 1e-13);
    }
}

#[test]
fn both_orders_of_elimination_give_the_same_solutions() {
    for side in [1, 2, 6] {
        solutions_by_both_orders::<f64>(side);
        solutions_by_both_orders::<Complex64>(side);
    }
}

#[test]
fn dissection_has_the_smaller_factor_of_a_box_and_is_taken_where_it_is_large() {
    let a = box_of_elements::<f64>(17);
    let rows = widened(&a.row_idx, "a test").unwrap();
    let pattern = SymbolicSparseColMatRef::new_checked(a.n, a.n, &a.col_ptr, None, &rows);
    let [degrees, dissection, smaller] = [Order::Degrees, Order::Dissection, Order::Smaller]
        .map(|order| analysed(pattern, order, &Interrupt::none()).unwrap().len_val());
    println!("{degrees} entries by degrees, {dissection} by dissection");
    assert!((dissection as f64) < 0.85 * degrees as f64);
    assert_eq!(smaller, if degrees < DISSECTED_FROM { degrees } else { dissection });
}

#[test]
fn memory_is_counted_before_it_is_asked_for() {
    let n = 300;
    let none = Csc::from_triplets(n, n, Vec::new()).unwrap();
    let interrupt = Interrupt::none();
    let a = Triangle::<f64>::sum(&matrix(n, false, 0.0), (0.0, &none), &interrupt).unwrap();
    let mut told = 0;
    let refused = Cholesky::new(
        &a,
        |need| {
            told = need;
            fail!(OutOfMemory, "too much")
        },
        &interrupt,
    );
    assert!(refused.is_err() && told > 8 * a.values.len());
}

#[test]
fn products_by_the_triangle_are_those_of_the_matrix() {
    let n = 60;
    let a = matrix(n, true, 0.0);
    let m = matrix(n, true, 2.0);
    let interrupt = Interrupt::none();
    let triangle = Triangle::<Complex64>::sum(&a, (0.5, &m), &interrupt).unwrap();
    let x: Vec<Complex64> = (0..n).map(|k| Complex64::cis(k as f64)).collect();
    let mut y = vec![Complex64::ZERO; n];
    multiply(&[(1.0, &triangle)], &x, &mut y, &interrupt).unwrap();
    let mut exact = a.times(&x, "a test").unwrap();
    m.multiply_add(0.5.into(), &x, &mut exact);
    assert!(y.iter().zip(&exact).all(|(y, e)| (y - e).norm() < 1e-12));
}
