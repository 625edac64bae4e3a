//! The band of a blade with two wedge dampers, whose contacts stick or slip from state to state: no random residual state lies outside.

use crate::bands_of_many_sliders::two_dampers;
use crate::common::models::{coupled, damper_face};
use crate::common::random;
use crate::common::{harmonics, omega_range, solve_at};
use hbvib::{BandOptions, Contact, Frame, Hooks, Model, band, forced_response, freedom};
use num_complex::Complex64;

/// Numbers without pattern between 0 and 1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        random::unit(&mut self.0)
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

/// A blade with two dampers of any friction, weight and stiffness, and a frequency.
fn any_dampers(numbers: &mut Numbers) -> (Model, f64) {
    let mut model = two_dampers();
    for u in [1, 3] {
        let (platform, blade) = (numbers.within(0.15, 0.6), numbers.within(0.1, 0.3));
        let (kt, kn) = (numbers.within(0.5, 1.5), numbers.within(1.0, 2.0));
        model = model
            .contact(damper_face([u, u + 1], 1.0, None, [kt, kn, platform]))
            .contact(damper_face([u, u + 1], -1.0, Some(0), [kt, kn, blade]))
            .force(u + 1, 0, numbers.within(0.5, 1.5));
    }
    let model = model.force(0, 1, numbers.within(0.05, 0.15)).build();
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
        if found.sliders.is_empty() {
            assert!(free.is_empty());
            continue;
        }
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

/// Two to four masses on springs with as many contacts under varying loads, pressed by constant forces of any size, and a frequency.
fn any_contacts(numbers: &mut Numbers) -> (Model, f64) {
    let n = 3 + (4.0 * numbers.next()) as usize;
    let (mut ground, mut between) = (vec![], vec![]);
    for i in 0..n {
        ground.push(numbers.within(0.5, 2.0));
        if i > 0 {
            between.push(numbers.next());
        }
    }
    let masses: Vec<f64> = (0..n).map(|_| numbers.within(0.05, 1.0)).collect();
    let mut model = coupled(&masses, &ground, &between).rayleigh(0.0, 0.03).build();
    for _ in 0..2 + (3.0 * numbers.next()) as usize {
        let along = (n as f64 * numbers.next()) as usize;
        let out = (along + 1 + ((n - 1) as f64 * numbers.next()) as usize) % n;
        let (sine, cosine) = numbers.within(0.0, std::f64::consts::TAU).sin_cos();
        let kn = numbers.within(0.5, 3.0);
        let contact = Contact {
            dof_a: [Some(along), Some(out), None],
            dof_b: [None; 3],
            frame: Some(Frame::new([cosine, sine, 0.0], Some([-sine, cosine, 0.0])).unwrap()),
            ..Contact::friction_2d(
                [None; 2],
                [None; 2],
                (numbers.within(0.3, 2.0), kn),
                numbers.within(0.1, 0.8),
                numbers.within(0.0, 0.3),
            )
        };
        model.add_contact(&contact).unwrap();
    }
    for dof in 0..n {
        model
            .add_force(dof, 0, Complex64::new(numbers.within(-0.5, 0.5), 0.0))
            .unwrap();
    }
    let dof = (n as f64 * numbers.next()) as usize;
    model
        .add_force(dof, 1, Complex64::new(numbers.within(0.005, 0.08), 0.0))
        .unwrap();
    (model, numbers.within(0.7, 2.0))
}

/// Where no slider is free at the point but some stick, places far from it may make a contact slip, open or close. Returns how many models
/// have other states.
fn bands_of_stuck_models(models: std::ops::Range<u64>, trials: usize) -> usize {
    let solver = harmonics(7);
    let (mut stuck, mut wide, mut outside) = (0, 0, 0);
    for number in models {
        let mut numbers = Numbers(number.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x1234_5678);
        for _ in 0..8 {
            numbers.next();
        }
        let (model, omega) = any_contacts(&mut numbers);
        let range = omega_range(omega, omega);
        let at = |model: &Model| forced_response(model, &solver, &range, &mut Hooks::default()).ok();
        let Some(branch) = at(&model) else { continue };
        let sticks = (0..branch.contacts()).any(|c| {
            let summary = branch.contact_summary(0, c).unwrap();
            summary.slip_share == 0.0 && summary.open_share == 0.0
        });
        if !sticks || !freedom(&model, &branch, 0).unwrap().is_empty() {
            continue;
        }
        stuck += 1;
        let options = BandOptions::default();
        let found = band(&model, &branch, 0, &solver, &options, &mut Hooks::default()).unwrap();
        let [low, high] = [found.lower.value, found.upper.value];
        // What is sampled is not proven.
        assert!(!found.is_complete && low <= high && found.sliders.is_empty() == (low.to_bits() == high.to_bits()));
        let mut most = [branch.amplitude()[0]; 2];
        for _ in 0..trials {
            let mut other = model.try_clone().unwrap();
            for contact in 0..branch.contacts() {
                other.set_slider(contact, 0, numbers.within(-1.0, 1.0)).unwrap();
            }
            if let Some(other) = at(&other) {
                let amplitude = other.amplitude()[0];
                most = [most[0].min(amplitude), most[1].max(amplitude)];
            }
        }
        wide += usize::from(most[1] > most[0] * (1.0 + 1e-6));
        let is_outside = most[0] < low * (1.0 - 1e-6) || most[1] > high * (1.0 + 1e-6);
        outside += usize::from(is_outside);
        println!(
            "{number}: {low} .. {high}, {} solved; random {most:?}{}",
            found.solved,
            if is_outside { " OUTSIDE" } else { "" }
        );
    }
    println!("{stuck} models, {wide} with other states, {outside} of them outside");
    assert_eq!(outside, 0);
    wide
}

#[test]
fn states_far_from_a_point_that_sticks_are_in_its_band() {
    assert!(bands_of_stuck_models(0..12, 10) > 0);
}

#[test]
#[ignore = "thousands of solutions; tests/deep.sh runs it"]
fn states_far_from_two_hundred_points_that_stick_are_in_their_bands() {
    assert!(bands_of_stuck_models(12..240, 30) > 20);
}
