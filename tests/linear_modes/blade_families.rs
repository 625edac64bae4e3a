//! Damped modes of families: blades on one body have as many nearly equal modes as there are blades. With damping proportional to mass
//! and stiffness each follows from a natural one.

use crate::common::models::dense;
use hbvib::{ContactState, Hooks, LinearContacts, damped_modes};

#[test]
fn families_of_blades_are_found_whole() {
    const BETA: f64 = 2e-3;
    let (blades, length) = (24, 20);
    let order = blades * length + 1;
    let body = order - 1;
    for scatter in [0.0, 0.01, 0.05] {
        let (mut mass, mut stiffness) = (vec![0.0; order * order], vec![0.0; order * order]);
        for i in 0..order {
            mass[i * order + i] = if i == body { 10.0 } else { 0.1 };
        }
        stiffness[body * order + body] = 20.0;
        for blade in 0..blades {
            let k = 5.0 * (1.0 + scatter * (2.7 * blade as f64).sin());
            for i in 0..length {
                let own = blade * length + i;
                let before = if i == 0 { body } else { own - 1 };
                for (row, column, sign) in [
                    (own, own, 1.0),
                    (before, before, 1.0),
                    (own, before, -1.0),
                    (before, own, -1.0),
                ] {
                    stiffness[column * order + row] += sign * k;
                }
            }
        }
        let mut model = dense(&mass, &stiffness).build();
        let natural = model.lowest_modes(0, ContactState::Free, 50).unwrap().omega;
        model.set_rayleigh(0.0, BETA).unwrap();
        for count in [1, 4, 24, 26, 50] {
            let found = damped_modes(&model, 0, LinearContacts::Free, count, &mut Hooks::default()).unwrap();
            for (k, omega) in natural.iter().enumerate().take(count) {
                let ratio = 0.5 * BETA * omega;
                let exact = omega * (1.0 - ratio * ratio).sqrt();
                assert!(
                    (found.omega(k) / exact - 1.0).abs() < 1e-10,
                    "scatter {scatter}, {count}: mode {k} at {} for {exact}",
                    found.omega(k)
                );
                assert!(
                    (found.damping_ratio(k) / ratio - 1.0).abs() < 1e-7,
                    "scatter {scatter}, {count}: {k}"
                );
            }
        }
    }
}
