//! Bands over many free sliders: eight contacts of a face between the blades of a wheel against one of the same stiffness, whose largest
//! peak is one of two; friction in a plane at eight nodes against random residual states.

use crate::common::models::{Structure, damper_face, dense, diagonal};
use crate::common::{harmonics, omega_range, solve_at, sweep};
use hbvib::{BandOf, BandOptions, Contact, Hooks, Model, TimeOptions, band, forced_response, freedom, time_response};
use num_complex::Complex64;
use std::cell::Cell;

/// A wedge damper between each blade and the next one; its face on the blade as a number of equal contacts.
fn wheel(parts: usize) -> Model {
    let share = 1.0 / parts as f64;
    let on_blade = damper_face([1, 2], 1.0, Some(0), [share, 1.5 * share, 0.6]);
    let mut on_next = damper_face([1, 2], -1.0, Some(0), [1.0, 1.5, 0.15]);
    on_next.sector_offset = 1;
    Structure::cyclic(3, 24)
        .wave(3)
        .diagonals([&[1.0, 0.01, 0.01], &[0.02, 0.004, 0.004], &[1.0, 1e-3, 1e-3]])
        .contacts(vec![on_blade; parts])
        .contact(on_next)
        .force(2, 0, 1.0)
        .force(0, 1, 0.05)
        .build()
}

#[test]
fn eight_sliders_a_sector_have_the_band_of_one() {
    let solver = harmonics(5);
    let bands = [1, 8].map(|parts| {
        let model = wheel(parts);
        let branch = sweep(&model, &solver, 1.0, 1.2, &[]);
        let peak = branch.peaks()[0].point;
        assert_eq!(freedom(&model, &branch, peak).unwrap().len(), parts);
        let options = BandOptions {
            of: BandOf::PeakAmplitude,
            ..BandOptions::default()
        };
        // Work is counted by the questions whether to stop.
        let asked = Cell::new(0_u64);
        let count = || {
            asked.set(asked.get() + 1);
            false
        };
        let mut hooks = Hooks {
            cancelled: Some(&count),
            ..Hooks::default()
        };
        let range = omega_range(1.0, 1.2);
        forced_response(&model, &solver, &range, &mut hooks).unwrap();
        let of_sweep = asked.replace(0);
        let found = band(&model, &branch, peak, &solver, &options, &mut hooks).unwrap();
        println!("{parts}: sweep {of_sweep}, band {}", asked.get());
        assert!(asked.get() < 100 * of_sweep);
        found
    });
    let [one, many] = &bands;
    println!("{} .. {}, {} solved", many.lower.value, many.upper.value, many.solved);
    assert!(many.is_complete && many.sliders.len() == 8);
    assert!(one.upper.value > 1.1 * one.lower.value);
    assert!((one.lower.value / many.lower.value - 1.0).abs() < 1e-6);
    assert!((one.upper.value / many.upper.value - 1.0).abs() < 1e-6);
}

/// Damping of each motion of [`nodes`].
pub const NODE_DAMPING: f64 = 0.03;

/// Stiffnesses of the contacts of [`nodes`] along the face and across it.
pub const NODE_CONTACT: (f64, f64) = (0.3, 0.5);

/// Stiffness matrix of [`nodes`].
pub fn node_stiffness(count: usize) -> Vec<f64> {
    let n = 3 * count;
    let mut stiffness = vec![0.0; n * n];
    for i in 0..n {
        stiffness[i * n + i] = 1.5 + 0.05 * (i % 24) as f64;
        for j in 0..i {
            let coupled = -0.12 / (1.0 + (i - j) as f64);
            (stiffness[i * n + j], stiffness[j * n + i]) = (coupled, coupled);
        }
    }
    stiffness
}

/// Friction coefficient and normal load of the contact of a node.
pub const fn node_friction(node: usize) -> (f64, f64) {
    if node.is_multiple_of(2) {
        (0.15, 0.1)
    } else {
        (0.5, 0.3)
    }
}

/// Harmonic forces of [`nodes`].
pub fn node_forces(count: usize) -> Vec<(usize, Complex64)> {
    let mut forces = vec![(0, Complex64::new(0.06, 0.0)), (4, Complex64::new(0.0, 0.03))];
    // Far nodes with a small limit slip as well.
    for node in (8..count).step_by(2) {
        forces.push((3 * node, Complex64::new(0.06, 0.0)));
    }
    forces
}

/// Nodes of unit mass that move in three directions on friction in a plane, every other one with a large limit.
pub fn nodes(count: usize) -> Model {
    let n = 3 * count;
    let contact = |node: usize| {
        let (mu, load) = node_friction(node);
        Contact::friction_3d([0, 1, 2].map(|k| Some(3 * node + k)), [None; 3], NODE_CONTACT, mu, load)
    };
    dense(&diagonal(&vec![1.0; n]), &node_stiffness(count))
        .damping(&diagonal(&vec![NODE_DAMPING; n]))
        .contacts((0..count).map(contact))
        .forces(node_forces(count).into_iter().map(|(dof, force)| (dof, 1, force)))
        .build()
}

#[test]
fn no_random_residual_state_lies_outside_the_band() {
    outside_of(8, (6, 30), 0.2);
}

#[test]
#[ignore = "seconds: twenty nodes, of which half stick; tests/deep.sh runs it"]
fn no_random_residual_state_of_twenty_nodes_lies_outside_the_band() {
    outside_of(20, (16, 10), 0.05);
}

/// The band of a case with at least so many free sliders holds so many random states, which span this share of it.
fn outside_of(count: usize, (least, trials): (usize, usize), spread: f64) {
    let model = nodes(count);
    let solver = harmonics(3);
    let omega = 1.35;
    let branch = solve_at(&model, &solver, omega);
    let free = freedom(&model, &branch, 0).unwrap();
    let options = BandOptions {
        starts: 1,
        ..BandOptions::default()
    };
    let found = band(&model, &branch, 0, &solver, &options, &mut Hooks::default()).unwrap();
    let (lower, upper) = (&found.lower, &found.upper);
    println!(
        "{} free, {} .. {}, {} solved",
        free.len(),
        lower.value,
        upper.value,
        found.solved
    );
    assert!(found.is_complete && free.len() >= least && upper.value > 1.002 * lower.value);
    let mut most = [f64::INFINITY, 0.0];
    for trial in 0..trials {
        let mut other = model.try_clone().unwrap();
        for (i, slider) in free.iter().enumerate() {
            // Anywhere; a place beyond the limit acts as the nearest one within.
            let turn = 0.618_033_988_75 * (1 + trial * free.len() + i) as f64;
            other
                .set_slider(slider.contact, slider.direction, 1.2 * (turn.fract() - 0.5))
                .unwrap();
        }
        let amplitude = solve_at(&other, &solver, omega).amplitude()[0];
        most = [most[0].min(amplitude), most[1].max(amplitude)];
        assert!(
            amplitude > lower.value * (1.0 - 1e-6) && amplitude < upper.value * (1.0 + 1e-6),
            "{amplitude}"
        );
    }
    // The ends are motions of the model itself.
    for end in [lower, upper] {
        let amplitude = end.branch.as_ref().unwrap().amplitude()[0];
        assert!((amplitude / end.value - 1.0).abs() < 1e-7, "{amplitude}");
    }
    println!("random states {most:?}");
    assert!(most[1] - most[0] > spread * (upper.value - lower.value));
}

/// A blade with two wedge dampers: one whose contact with the platform sticks at any force, and one on a second platform that slips at
/// the largest amplitudes and sticks at the smaller ones, where its residual force is free as well.
fn blade_with_two_dampers(second: f64) -> Model {
    two_dampers()
        .contact(damper_face([1, 2], 1.0, None, [1.0, 1.5, 0.6]))
        .contact(damper_face([1, 2], -1.0, Some(0), [1.0, 1.5, 0.2]))
        .force(2, 0, 1.0)
        .contact(damper_face([3, 4], 1.0, None, [1.0, 1.5, second]))
        .contact(damper_face([3, 4], -1.0, Some(0), [1.0, 1.5, 0.2]))
        .force(4, 0, 1.0)
        .force(0, 1, 0.1)
        .build()
}

/// A blade and two dampers on soft supports, without contacts.
pub fn two_dampers() -> Structure {
    let each = |blade: f64, damper: f64| [blade, damper, damper, damper, damper];
    Structure::plain(5).diagonals([&each(1.0, 0.01), &each(0.04, 0.004), &each(1.0, 1e-3)])
}

#[test]
fn contacts_that_stick_at_an_end_alone_are_free_there() {
    let solver = harmonics(7);
    let mut grew = 0;
    for (second, omega) in [(0.2, 1.4), (0.25, 1.4), (0.3, 1.4), (0.2, 1.5)] {
        let model = blade_with_two_dampers(second);
        let branch = solve_at(&model, &solver, omega);
        let at_point = freedom(&model, &branch, 0).unwrap();
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
        println!(
            "{second} {omega}: {} {:?} {} .. {} {}",
            at_point.len(),
            found.sliders,
            lower.value,
            upper.value,
            found.is_complete
        );
        assert_eq!(lower.places.len(), found.sliders.len());
        assert_eq!(upper.places.len(), found.sliders.len());
        grew += usize::from(found.sliders.len() > at_point.len());
        assert!(found.is_complete);
        let mut least = [f64::INFINITY, 0.0];
        for trial in 0..40 {
            let mut other = model.try_clone().unwrap();
            for contact in 0..4 {
                let turn = 0.618_033_988_75 * (1 + 4 * trial + contact) as f64;
                other.set_slider(contact, 0, 2.5 * turn.fract() - 0.5).unwrap();
            }
            let amplitude = solve_at(&other, &solver, omega).amplitude()[0];
            least = [least[0].min(amplitude), least[1].max(amplitude)];
        }
        println!("   random states {least:?}");
        assert!(least[0] > lower.value * (1.0 - 1e-6) && least[1] < upper.value * (1.0 + 1e-6));
        for end in [lower, upper] {
            let mut placed = model.try_clone().unwrap();
            for ((contact, k), place) in found.sliders.iter().zip(&end.places) {
                placed.set_slider(*contact, *k, *place).unwrap();
            }
            let amplitude = end.branch.as_ref().unwrap().amplitude()[0];
            assert!((amplitude / end.value - 1.0).abs() < 1e-7);
        }
    }
    assert_eq!(grew, 4);
}

/// The ends of bands over several sliders are motions in time, with exact events: the amplitude at the places of the end, and those of
/// the sliders that stick there.
#[test]
fn ends_of_two_dampers_are_motions_in_time() {
    let solver = harmonics(25);
    for (second, omega) in [(0.2, 1.4), (0.3, 1.4)] {
        let model = blade_with_two_dampers(second);
        let branch = solve_at(&model, &solver, omega);
        let options = BandOptions {
            starts: 1,
            ..BandOptions::default()
        };
        let found = band(&model, &branch, 0, &solver, &options, &mut Hooks::default()).unwrap();
        for end in [&found.lower, &found.upper] {
            let mut placed = model.try_clone().unwrap();
            for ((contact, k), place) in found.sliders.iter().zip(&end.places) {
                placed.set_slider(*contact, *k, *place).unwrap();
            }
            let own = end.branch.as_ref().unwrap();
            let start = crate::common::all_harmonics(own, 0);
            let options = TimeOptions {
                omega,
                start: Some(&start),
                ..TimeOptions::default()
            };
            let in_time = time_response(&placed, &options, &mut Hooks::default()).unwrap();
            let amplitude = in_time.harmonics[model.ndof()].norm();
            // Sliders that slip at the end forget their places; twenty-five harmonics leave the others beyond a limit by a little.
            let free = freedom(&placed, own, 0).unwrap();
            let sliders = found.sliders.iter().zip(&end.places);
            let dragged = sliders
                .filter(|((c, _), _)| free.iter().any(|f| f.contact == *c))
                .map(|((c, _), place)| (in_time.places[*c] - place).abs())
                .fold(0.0, f64::max);
            println!(
                "{second} {omega}: {} in time {amplitude}, {} free, dragged by {dragged:.1e}",
                end.value,
                free.len()
            );
            assert!(!free.is_empty() && (amplitude / end.value - 1.0).abs() < 1e-4 && dragged < 1e-4);
        }
    }
}
