//! Limit cycles on nonlinear modes are found where the damping ratio is zero, are motions in time, and have one trivial
//! multiplier.

use crate::common::mode_cases::follow;
use crate::common::models::dense;
use crate::common::{BASE, amplitude_range, harmonics};
use crate::{multipliers, of_class, ordinary};
use hbvib::{Branch, Contact, ModeChoice, ModeOptions, Model, MultiplierClass, Waves};
use num_complex::Complex64;

/// Two masses, the first with negative damping, and friction between them.
fn two_masses() -> Model {
    dense(&[1.0, 0.0, 0.0, 0.5], &[1.1, -0.1, -0.1, 0.5])
        .damping(&[-0.02, 0.0, 0.0, 0.01])
        .contact(Contact::jenkins(0, Some(1), 0.5, 0.5, 0.2))
        .build()
}

fn amplitudes(branch: &Branch, point: usize) -> [f64; 2] {
    let mut x = vec![Complex64::ZERO; (branch.harmonics() + 1) * 2];
    branch.harmonics_at(point, &mut x).unwrap();
    [x[2].norm(), x[3].norm()]
}

#[test]
fn friction_limits_the_flutter_of_two_masses() {
    let model = two_masses();
    let range = amplitude_range(-2.0, 2.0);
    let branch = follow(&model, &harmonics(31), &range);
    let cycles = branch.limit_cycles().unwrap();
    for cycle in &cycles {
        let found = multipliers(&model, &branch, cycle.point, Waves::Wave);
        println!(
            "{cycle:?} {:?} omega {} unstable {} {:.1e} {:?}",
            amplitudes(&branch, cycle.point),
            found.omega,
            found.unstable,
            found.residual,
            found.multipliers
        );
        assert_eq!(of_class(&found, MultiplierClass::Trivial).len(), 1);
        assert!(found.residual <= 1e-12);
        assert!(cycle.slope > 0.0 || found.unstable > 0);
    }
    let inner = cycles.iter().find(|c| (c.omega - 0.963_164).abs() < 1e-4).unwrap();
    let found = multipliers(&model, &branch, inner.point, Waves::Wave);
    assert!((found.omega - 0.963_164_341_122_1).abs() < 1e-9);
    for (mu, expected) in ordinary(&found).iter().zip([0.859_662_769_5, 0.451_781_811_5]) {
        assert!((mu - expected).norm() < 1e-7, "{mu}");
    }
    assert_eq!(found.unstable, 0);
}

/// The same to eight digits: harmonic balance with so many harmonics is the motion in time.
#[test]
fn the_limit_cycle_of_two_masses_has_the_amplitudes_of_its_reference() {
    let range = amplitude_range(-2.0, 2.0);
    let mut errors = Vec::new();
    for highest in [31, 127] {
        let branch = follow(&two_masses(), &harmonics(highest), &range);
        let cycles = branch.limit_cycles().unwrap();
        let inner = cycles.iter().find(|c| (c.omega - 0.963_164).abs() < 1e-4).unwrap();
        let x = amplitudes(&branch, inner.point);
        let error = (x[0] - 2.089_761_496_4).abs().max((x[1] - 2.422_198_189_5).abs());
        println!(
            "H = {highest}: omega {:.13}, |X1| {x:.10?}, {error:.1e} off",
            inner.omega
        );
        errors.push((error, (inner.omega - 0.963_164_341_122_1).abs()));
    }
    assert!(errors[0].0 < 1e-6 && errors[1].0 < 1e-8, "{errors:?}");
    assert!(errors[1].1 < 1e-9, "{errors:?}");
}

/// On the second mode, free of friction at large motions, the damping is negative again: beyond this cycle nothing limits
/// the motion.
#[test]
fn the_outer_limit_cycle_of_two_masses_is_unstable() {
    let model = two_masses();
    let range = ModeOptions {
        choice: ModeChoice::Index(1),
        ..amplitude_range(-2.0, 2.0)
    };
    let branch = follow(&model, &harmonics(31), &range);
    let cycles = branch.limit_cycles().unwrap();
    let outer = cycles.last().unwrap();
    let found = multipliers(&model, &branch, outer.point, Waves::Wave);
    println!(
        "{cycles:?} {:?} omega {:.12} {:?}",
        amplitudes(&branch, outer.point),
        found.omega,
        found.multipliers
    );
    assert!(outer.slope < 0.0 && found.unstable > 0 && found.residual <= 1e-12);
}

#[test]
fn the_ring_damper_flutters_in_a_wave() {
    const ALPHA: f64 = 7.0;
    let mut model = BASE.sector();
    model.set_rayleigh(-ALPHA, 1.5e-6).unwrap();
    model.clear_forces();
    let range = ModeOptions {
        diameter: Some(2),
        ..amplitude_range(-6.0, -1.0)
    };
    let branch = follow(&model, &harmonics(31), &range);
    let cycles = branch.limit_cycles().unwrap();
    let mut radii = Vec::new();
    for cycle in &cycles {
        for waves in [Waves::Wave, Waves::Wheel] {
            let found = multipliers(&model, &branch, cycle.point, waves);
            println!(
                "{cycle:?} {waves:?}: omega {}, radius {}, {} unstable, {} neutral, residual {:.1e}, change {:.1e}",
                found.omega, found.radius, found.unstable, found.neutral, found.residual, found.orbit_change
            );
            assert_eq!(of_class(&found, MultiplierClass::Trivial).len(), 1);
            assert!(found.residual <= 1e-12);
            // Both repel, whatever the slope: α drives other waves and modes, too.
            radii.push(found.radius);
            assert!(found.unstable > 0);
        }
    }
    assert!(cycles[0].slope > 0.0 && cycles[1].slope < 0.0);
    for (radius, expected) in radii.iter().zip([1.0099, 1.0155, 1.0103, 1.0150]) {
        assert!((radius - expected).abs() < 1e-4, "{radius} {expected}");
    }
    assert_eq!(cycles.len(), 2);
}
