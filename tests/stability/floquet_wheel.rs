//! Blocks of perturbations of a wheel together have the multipliers of the whole wheel.

use crate::common::{BASE, SECTORS, harmonics, solve_at};
use crate::{multipliers, of_class};
use hbvib::MultiplierClass;
use hbvib::options::Waves;
use std::f64::consts::TAU;

#[test]
fn the_ring_damper_has_the_radii_of_its_reference() {
    let model = BASE.sector();
    let branch = solve_at(&model, &harmonics(63), TAU * 208.85);
    for (waves, radius) in [(Waves::Wave, 0.993_431_437_676), (Waves::Wheel, 0.998_436_261_437)] {
        let begin = std::time::Instant::now();
        let found = multipliers(&model, &branch, 0, waves);
        println!(
            "{waves:?}: {} of {}, {} neutral, {:?} zeros, change {:.1e} {:.1e} in {:?}",
            found.radius,
            found.multipliers.len(),
            found.neutral,
            of_class(&found, MultiplierClass::Memory).len(),
            found.orbit_change,
            found.residual,
            begin.elapsed()
        );
        assert!((found.radius - radius).abs() < 1e-9);
        if waves == Waves::Wheel {
            assert_eq!(found.multipliers.len(), 9 * SECTORS);
            assert_eq!(found.neutral, 1);
        }
    }
}
