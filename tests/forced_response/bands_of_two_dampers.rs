//! The band of a blade with two wedge dampers, whose contacts stick or slip from state to state: no random residual state lies outside.

use crate::bands_of_many_sliders::diagonal;
use crate::common::{harmonics, solve_at};
use hbvib::{BandOptions, Contact, ContactKind, Frame, Hooks, MatrixKind, Model, band, freedom};
use num_complex::Complex64;
use std::f64::consts::FRAC_1_SQRT_2;

/// Numbers without pattern between 0 and 1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

/// A blade with two dampers of any friction, weight and stiffness, and a frequency.
fn any_dampers(numbers: &mut Numbers) -> (Model, f64) {
    let mut model = Model::new(5).unwrap();
    diagonal(&mut model, MatrixKind::Mass, &[1.0, 0.01, 0.01, 0.01, 0.01]);
    diagonal(&mut model, MatrixKind::Damping, &[0.04, 0.004, 0.004, 0.004, 0.004]);
    diagonal(&mut model, MatrixKind::Stiffness, &[1.0, 1e-3, 1e-3, 1e-3, 1e-3]);
    let r = FRAC_1_SQRT_2;
    for u in [1, 3] {
        let (platform, blade) = (numbers.within(0.15, 0.6), numbers.within(0.1, 0.3));
        let (kt, kn) = (numbers.within(0.5, 1.5), numbers.within(1.0, 2.0));
        for (normal, tangent, other, mu) in [
            ([r, -r, 0.0], [r, r, 0.0], None, platform),
            ([-r, -r, 0.0], [-r, r, 0.0], Some(0), blade),
        ] {
            let contact = Contact {
                kind: ContactKind::Friction2d,
                dof_a: [Some(u), Some(u + 1), None],
                dof_b: [other, None, None],
                frame: Some(Frame::new(normal, Some(tangent)).unwrap()),
                kn,
                ..Contact::jenkins(0, None, kt, mu, 0.0)
            };
            model.add_contact(&contact).unwrap();
        }
        let weight = numbers.within(0.5, 1.5);
        model.add_force(u + 1, 0, Complex64::new(weight, 0.0)).unwrap();
    }
    let force = numbers.within(0.05, 0.15);
    model.add_force(0, 1, Complex64::new(force, 0.0)).unwrap();
    (model, numbers.within(1.1, 1.7))
}

/// The share of models, by number, in whose band so many random states lie.
fn models_hold(models: std::ops::Range<u64>, trials: usize) {
    let solver = harmonics(7);
    let mut outside = 0;
    for number in models {
        let mut numbers = Numbers(number.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5851_f42d);
        for _ in 0..8 {
            numbers.next();
        }
        let (model, omega) = any_dampers(&mut numbers);
        let branch = solve_at(&model, &solver, omega);
        let free = freedom(&model, &branch, 0).unwrap();
        if free.is_empty() {
            println!("{number}: nothing is free at {omega}");
            continue;
        }
        let found = band(
            &model,
            &branch,
            0,
            &solver,
            &BandOptions::default(),
            &mut Hooks::default(),
        )
        .unwrap();
        let (lower, upper) = (&found.lower, &found.upper);
        let mut most = [f64::INFINITY, 0.0];
        for _ in 0..trials {
            let mut other = model.try_clone().unwrap();
            for contact in 0..4 {
                other.set_slider(contact, 0, numbers.within(-0.5, 2.0)).unwrap();
            }
            let amplitude = solve_at(&other, &solver, omega).amplitude()[0];
            most = [most[0].min(amplitude), most[1].max(amplitude)];
        }
        let is_outside = most[0] < lower.value * (1.0 - 1e-6) || most[1] > upper.value * (1.0 + 1e-6);
        outside += usize::from(is_outside);
        println!(
            "{number}: {} free at the point, {:?}, {} .. {} {}, {} solved; random {most:?}{}",
            free.len(),
            found.sliders,
            lower.value,
            upper.value,
            found.is_complete,
            found.solved,
            if is_outside { " OUTSIDE" } else { "" }
        );
        for end in [lower, upper] {
            let mut placed = model.try_clone().unwrap();
            for ((contact, k), place) in found.sliders.iter().zip(&end.places) {
                placed.set_slider(*contact, *k, *place).unwrap();
            }
            let amplitude = end.branch.as_ref().unwrap().amplitude()[0];
            assert!(
                (amplitude / end.value - 1.0).abs() < 1e-6,
                "{number}: {amplitude} {}",
                end.value
            );
        }
    }
    assert_eq!(outside, 0);
}

#[test]
fn no_random_state_of_two_dampers_lies_outside_the_band() {
    models_hold(0..3, 30);
}

#[test]
#[ignore = "thousands of solutions; tests/deep.sh runs it"]
fn no_random_state_of_twenty_models_with_two_dampers_lies_outside_the_band() {
    models_hold(0..20, 200);
}
