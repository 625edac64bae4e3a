//! Terms that depend on speed, and structural damping, added to random models.

use hbvib::{Constant, MatrixKind, MatrixView, Model, Speed};
use num_complex::Complex64;
use proptest::prelude::*;

/// Speeds: none, a fixed one, one that is tied to the frequency.
pub fn speeds() -> impl Strategy<Value = Speed> {
    prop::sample::select(vec![Speed::Fixed(0.0), Speed::Fixed(0.7), Speed::PerOmega(0.4)])
}

/// (A + sAᴴ)/2
fn with_symmetry(a: &[Complex64], n: usize, sign: f64) -> Vec<Complex64> {
    let entry = |i: usize, j: usize| a[j * n + i];
    (0..n * n)
        .map(|at| 0.5 * (entry(at % n, at / n) + sign * entry(at / n, at % n).conj()))
        .collect()
}

/// Adds G, K₁, D, η, an unbalance, a load of contact 0 that grows with the square of the speed, and the speed.
pub fn rotate(model: &mut Model, speed: Speed, per_diameter: bool, mut real: impl FnMut() -> f64) {
    let (n, sectors) = (model.ndof(), model.structure().sectors());
    for (which, sign, size) in [
        (MatrixKind::Gyroscopic, -1.0, 0.6),
        (MatrixKind::StiffnessSpeed2, 1.0, 0.4),
        (MatrixKind::Structural, 1.0, 0.3),
    ] {
        let mut matrix = |is_complex: bool| -> Vec<Complex64> {
            let entry = |_| size * Complex64::new(real(), if is_complex { real() } else { 0.0 });
            (0..n * n).map(entry).collect()
        };
        if per_diameter {
            for diameter in 0..=sectors / 2 {
                let a = with_symmetry(&matrix(diameter > 0), n, sign);
                let view = MatrixView::dense_complex(n, &a);
                model.set_diameter(which, diameter as i64, &view).unwrap();
            }
            continue;
        }
        let own: Vec<f64> = with_symmetry(&matrix(false), n, sign).iter().map(|z| z.re).collect();
        model.set_matrix(which, &MatrixView::dense(n, &own)).unwrap();
        if sectors > 1 {
            let next: Vec<f64> = matrix(false).iter().map(|z| 0.3 * z.re).collect();
            model.set_coupling(which, &MatrixView::dense(n, &next)).unwrap();
        }
    }
    model.set_loss_factor(0.04).unwrap();
    let preload = model.contacts()[0].constant(Constant::Preload);
    model.set_preload_at_speed(0, preload, 0.3).unwrap();
    model.add_unbalance(0, 1, 0.2 * real(), real()).unwrap();
    model.set_speed(speed).unwrap();
}
