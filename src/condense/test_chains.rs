//! Structures for the tests of what follows from modes.

use crate::contact::Contact;
use crate::linalg::sparse_storage::matrix_view::MatrixView;
use crate::model::Model;
use crate::model::matrices::spring::Spring;
use crate::model::matrices::structure::MatrixKind;
use num_complex::Complex64;

/// Degrees of freedom.
/// Kind: fixed.
pub const N: usize = 9;

/// A chain with uneven masses and springs, on a wheel where `sectors` is more than 1, without contacts.
pub fn structure(sectors: usize, (alpha, beta): (f64, f64)) -> Model {
    let mut model = if sectors > 1 {
        let mut wheel = Model::cyclic(N, sectors).unwrap();
        wheel.set_wave(2);
        wheel
    } else {
        Model::new(N).unwrap()
    };
    let (mut m, mut k) = (vec![0.0; N * N], vec![0.0; N * N]);
    for i in 0..N {
        m[i * N + i] = 1.0 + 0.3 * (i as f64).sin();
        k[i * N + i] += 0.2 + 0.1 * (2.0 * i as f64).cos();
        if i > 0 {
            let spring = 40.0 + 7.0 * (3.0 * i as f64).sin();
            k[i * N + i] += spring;
            k[(i - 1) * N + i - 1] += spring;
            k[i * N + i - 1] -= spring;
            k[(i - 1) * N + i] -= spring;
        }
    }
    model.set_matrix(MatrixKind::Mass, &MatrixView::dense(N, &m)).unwrap();
    model
        .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(N, &k))
        .unwrap();
    if sectors > 1 {
        let mut to_next = vec![0.0; N * N];
        (to_next[3], to_next[5 * N + 4]) = (-0.11, -0.07);
        model
            .set_coupling(MatrixKind::Stiffness, &MatrixView::dense(N, &to_next))
            .unwrap();
    }
    model.set_rayleigh(alpha, beta).unwrap();
    model.add_force(8, 1, Complex64::new(0.7, -0.2)).unwrap();
    model
}

/// Model of `structure` with sliders, a stuck contact and a spring.
pub fn chain(sectors: usize, damping: (f64, f64)) -> Model {
    let mut model = structure(sectors, damping);
    model.add_contact(&Contact::jenkins(1, Some(4), 9.0, 0.3, 1.0)).unwrap();
    model.add_contact(&Contact::jenkins(6, None, 25.0, 0.3, 1.0)).unwrap();
    let mut across = Contact::jenkins(2, Some(7), 4.0, 0.3, 1.0);
    across.sector_offset = i64::from(sectors > 1);
    model.add_contact(&across).unwrap();
    // One that never slips is a spring.
    model
        .add_contact(&Contact::jenkins(0, Some(8), 12.0, 0.3, f64::INFINITY))
        .unwrap();
    model
        .add_spring(&Spring {
            dof_a: Some(3),
            dof_b: Some(5),
            sector_offset: i64::from(sectors > 1),
            stiffness: 15.0,
        })
        .unwrap();
    model
}

/// A wheel of five sectors whose matrices are real in every wave, so that a wave and the one that travels the other way have the same,
/// with sliders and a spring within and across sectors. Harmonics 1, 2 travel forward, 3, 4 backward.
pub fn real_wheel((alpha, beta): (f64, f64)) -> Model {
    let mut model = Model::cyclic(3, 5).unwrap();
    model.set_wave(1);
    let m = [1.0, 0.0, 0.0, 0.0, 1.3, 0.0, 0.0, 0.0, 0.8];
    let k = [2.3, -1.0, 0.0, -1.0, 2.9, -0.9, 0.0, -0.9, 1.7];
    let to_next = [-0.15, 0.0, 0.0, 0.0, -0.4, 0.0, 0.0, 0.0, 0.0];
    for (kind, values) in [(MatrixKind::Mass, m), (MatrixKind::Stiffness, k)] {
        model.set_matrix(kind, &MatrixView::dense(3, &values)).unwrap();
    }
    model
        .set_coupling(MatrixKind::Stiffness, &MatrixView::dense(3, &to_next))
        .unwrap();
    model.set_rayleigh(alpha, beta).unwrap();
    model.add_force(0, 1, Complex64::new(0.7, -0.2)).unwrap();
    for (a, b, offset, kt) in [(0, Some(1), 0, 0.7), (2, Some(2), 1, 0.9), (2, None, 0, 0.2)] {
        let mut contact = Contact::jenkins(a, b, kt, 0.3, 1.0);
        contact.sector_offset = offset;
        model.add_contact(&contact).unwrap();
    }
    model
        .add_spring(&Spring {
            dof_a: Some(2),
            dof_b: Some(2),
            sector_offset: 2,
            stiffness: 0.3,
        })
        .unwrap();
    model
}

/// Damping αM + βK and loss factor.
/// Kind: fixed.
pub const DAMPED: [((f64, f64), f64); 6] = [
    ((0.0, 1e-3), 0.0),
    ((0.02, 0.0), 0.0),
    ((0.03, 4e-2), 0.0),
    ((0.0, 1e-6), 0.0),
    ((0.0, 0.0), 0.03),
    ((0.03, 4e-2), 0.2),
];

/// A chain of `n` unit masses between walls with sliders to the ground, as many as there is room for at every other mass.
pub fn long_chain(n: usize, contacts: usize, (alpha, beta): (f64, f64)) -> Model {
    let mut model = Model::new(n).unwrap();
    let (mut m, mut k) = (vec![0.0; n * n], vec![0.0; n * n]);
    for i in 0..n {
        (m[i * n + i], k[i * n + i]) = (1.0, 2.0);
        if i > 0 {
            (k[i * n + i - 1], k[(i - 1) * n + i]) = (-1.0, -1.0);
        }
    }
    model.set_matrix(MatrixKind::Mass, &MatrixView::dense(n, &m)).unwrap();
    model
        .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(n, &k))
        .unwrap();
    model.set_rayleigh(alpha, beta).unwrap();
    for dof in (1..n).step_by(2).take(contacts) {
        model
            .add_contact(&Contact::jenkins(dof, None, 0.5 + 0.01 * dof as f64, 0.3, 1.0))
            .unwrap();
    }
    model
}
