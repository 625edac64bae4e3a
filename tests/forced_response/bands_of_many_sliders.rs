//! Bands over many free sliders: eight contacts of a face between the blades of a wheel against one of the same stiffness, whose largest
//! peak is one of two; friction in a plane at eight nodes against random residual states.

use crate::common::{harmonics, solve_at, sweep};
use hbvib::{
    BandOf, BandOptions, Contact, ForcedOptions, Frame, Hooks, MatrixKind, MatrixView, Model, TimeOptions, band,
    forced_response, freedom, time_response,
};
use num_complex::Complex64;
use std::cell::Cell;
use std::f64::consts::FRAC_1_SQRT_2;

pub fn diagonal(model: &mut Model, which: MatrixKind, values: &[f64]) {
    let n = values.len();
    let mut full = vec![0.0; n * n];
    for (i, x) in values.iter().enumerate() {
        full[i * n + i] = *x;
    }
    model.set_matrix(which, &MatrixView::dense(n, &full)).unwrap();
}

/// A wedge damper between each blade and the next one; its face on the blade as a number of equal contacts.
fn wheel(parts: usize) -> Model {
    let mut model = Model::cyclic(3, 24).unwrap();
    model.set_wave(3);
    diagonal(&mut model, MatrixKind::Mass, &[1.0, 0.01, 0.01]);
    diagonal(&mut model, MatrixKind::Damping, &[0.02, 0.004, 0.004]);
    diagonal(&mut model, MatrixKind::Stiffness, &[1.0, 1e-3, 1e-3]);
    let r = FRAC_1_SQRT_2;
    let face = |side: f64, mu: f64, share: f64, sector_offset: i64| Contact {
        dof_a: [Some(1), Some(2), None],
        dof_b: [Some(0), None, None],
        frame: Some(Frame::new([side * r, -r, 0.0], Some([side * r, r, 0.0])).unwrap()),
        sector_offset,
        ..Contact::friction_2d([None; 2], [None; 2], (share, 1.5 * share), mu, 0.0)
    };
    for _ in 0..parts {
        model.add_contact(&face(1.0, 0.6, 1.0 / parts as f64, 0)).unwrap();
    }
    model.add_contact(&face(-1.0, 0.15, 1.0, 1)).unwrap();
    model.add_force(2, 0, Complex64::new(1.0, 0.0)).unwrap();
    model.add_force(0, 1, Complex64::new(0.05, 0.0)).unwrap();
    model
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
        let range = ForcedOptions {
            omega_start: 1.0,
            omega_stop: 1.2,
            ..ForcedOptions::default()
        };
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
    let mut model = Model::new(n).unwrap();
    diagonal(&mut model, MatrixKind::Mass, &vec![1.0; n]);
    diagonal(&mut model, MatrixKind::Damping, &vec![NODE_DAMPING; n]);
    model
        .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(n, &node_stiffness(count)))
        .unwrap();
    for node in 0..count {
        let dofs = [3 * node, 3 * node + 1, 3 * node + 2].map(Some);
        let (mu, load) = node_friction(node);
        model
            .add_contact(&Contact::friction_3d(dofs, [None; 3], NODE_CONTACT, mu, load))
            .unwrap();
    }
    for (dof, force) in node_forces(count) {
        model.add_force(dof, 1, force).unwrap();
    }
    model
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
    let mut model = Model::new(5).unwrap();
    diagonal(&mut model, MatrixKind::Mass, &[1.0, 0.01, 0.01, 0.01, 0.01]);
    diagonal(&mut model, MatrixKind::Damping, &[0.04, 0.004, 0.004, 0.004, 0.004]);
    diagonal(&mut model, MatrixKind::Stiffness, &[1.0, 1e-3, 1e-3, 1e-3, 1e-3]);
    let r = FRAC_1_SQRT_2;
    for (u, platform, blade) in [(1, 0.6, 0.2), (3, second, 0.2)] {
        let damper = [Some(u), Some(u + 1), None];
        for (normal, tangent, other, mu) in [
            ([r, -r, 0.0], [r, r, 0.0], None, platform),
            ([-r, -r, 0.0], [-r, r, 0.0], Some(0), blade),
        ] {
            let contact = Contact {
                dof_a: damper,
                dof_b: [other, None, None],
                frame: Some(Frame::new(normal, Some(tangent)).unwrap()),
                ..Contact::friction_2d([None; 2], [None; 2], (1.0, 1.5), mu, 0.0)
            };
            model.add_contact(&contact).unwrap();
        }
        model.add_force(u + 1, 0, Complex64::new(1.0, 0.0)).unwrap();
    }
    model.add_force(0, 1, Complex64::new(0.1, 0.0)).unwrap();
    model
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
