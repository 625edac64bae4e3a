//! Chains of masses and an oscillator, from plain numbers.

use hbvib::{Contact, MatrixKind, MatrixView, Model};

/// A chain of n masses of 1 between springs of 1, held at both ends, C = 0.02 K, a force on the first mass, and two sliders against
/// the ground. A `preload` adds a stop with that load at rest; with an infinite one nothing slips.
pub fn chain(n: usize, preload: f64) -> Model {
    chain_with(n, preload, [1.5, 0.3, 1.0])
}

/// The same with stiffness and slip limit of the first slider, and the force.
pub fn chain_with(n: usize, preload: f64, [kt, limit, force]: [f64; 3]) -> Model {
    let mut k = vec![0.0; n * n];
    for i in 0..n {
        k[i * n + i] = 2.0;
        if i > 0 {
            k[i * n + i - 1] = -1.0;
            k[(i - 1) * n + i] = -1.0;
        }
    }
    let mut m = vec![0.0; n * n];
    for i in 0..n {
        m[i * n + i] = 1.0 + 0.1 * i as f64;
    }
    let mut model = Model::new(n).unwrap();
    model.set_matrix(MatrixKind::Mass, &MatrixView::dense(n, &m)).unwrap();
    model
        .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(n, &k))
        .unwrap();
    model.set_rayleigh(0.0, 0.02).unwrap();
    model.add_force(0, 1, force.into()).unwrap();
    if preload.is_finite() {
        model.add_contact(&Contact::jenkins(1, None, kt, limit, 1.0)).unwrap();
        model
            .add_contact(&Contact::jenkins(n - 1, Some(n - 2), 2.0, 0.5, 1.0))
            .unwrap();
    }
    if preload.is_finite() && preload > 0.0 {
        model
            .add_contact(&Contact::unilateral(Some(2), None, 0.5, 0.0))
            .unwrap();
        model.add_force(2, 0, (-preload).into()).unwrap();
    }
    model
}

/// x″ + d x′ + x + c x³ = F cos ωt.
pub fn duffing(damping: f64, cubic: f64, force: f64) -> Model {
    let mut model = Model::new(1).unwrap();
    for (kind, value) in [
        (MatrixKind::Mass, 1.0),
        (MatrixKind::Damping, damping),
        (MatrixKind::Stiffness, 1.0),
    ] {
        model.set_matrix(kind, &MatrixView::dense(1, &[value])).unwrap();
    }
    model.add_contact(&Contact::cubic(0, None, 0.0, cubic)).unwrap();
    model.add_force(0, 1, force.into()).unwrap();
    model
}
