//! Multipliers on modes and sliders are those on all degrees of freedom.

use super::*;
use crate::analysis::forced_response;
use crate::analysis::perturbed::floquet_on_modes::{KeptModes, floquet_of};
use crate::analysis::perturbed::two_numbers_of_modes::{change, error_of_radius};
use crate::hooks::Hooks;
use crate::linalg::sparse_storage::matrix_view::MatrixView;
use crate::model::matrices::structure::MatrixKind;
use crate::options::{ForcedOptions, SolverOptions, Waves};
use crate::results::Recovery;

const N: usize = 8;

/// A bar of lumps that becomes thinner towards its end, held at one end.
fn set_bar(model: &mut Model) {
    let (mut mass, mut stiffness) = (vec![0.0; N * N], vec![0.0; N * N]);
    for i in 0..N {
        let thickness = 1.0 - 0.6 * i as f64 / N as f64;
        mass[i * N + i] = thickness * thickness / N as f64;
        let k = 3.0 * thickness * N as f64;
        stiffness[i * N + i] += k;
        if i > 0 {
            stiffness[(i - 1) * N + i - 1] += k;
            stiffness[(i - 1) * N + i] -= k;
            stiffness[i * N + i - 1] -= k;
        }
    }
    for (kind, values) in [(MatrixKind::Mass, &mass), (MatrixKind::Stiffness, &stiffness)] {
        model.set_matrix(kind, &MatrixView::dense(N, values)).unwrap();
    }
}

fn plain() -> Model {
    let mut model = Model::new(N).unwrap();
    set_bar(&mut model);
    model.set_rayleigh(0.1, 0.02).unwrap();
    for contact in [
        Contact::jenkins(N - 1, None, 1.0, 0.5, 0.4),
        Contact::jenkins(N / 2, Some(N / 3), 3.0, 0.5, 0.1),
        Contact::jenkins(N / 2 + 1, None, 1.0, 0.5, 100.0),
    ] {
        model.add_contact(&contact).unwrap();
    }
    model.add_force(N - 4, 1, 0.4.into()).unwrap();
    model.add_force(N / 3, 3, 0.08.into()).unwrap();
    model
}

fn wheel(engine_order: i64, mean: f64) -> Model {
    let mut next = vec![0.0; N * N];
    (next[1], next[N]) = (-0.3, -0.1);
    let mut model = Model::cyclic(N, 8).unwrap();
    set_bar(&mut model);
    model
        .set_coupling(MatrixKind::Stiffness, &MatrixView::dense(N, &next))
        .unwrap();
    model.set_rayleigh(0.05, 0.005).unwrap();
    model.set_wave(engine_order);
    for contact in [
        Contact {
            sector_offset: 1,
            ..Contact::jenkins(N - 1, Some(N - 2), 2.0, 0.5, 0.2)
        },
        Contact::jenkins(N - 3, None, 1.0, 0.5, 0.3),
    ] {
        model.add_contact(&contact).unwrap();
    }
    model.add_force(N - 3, 1, 0.3.into()).unwrap();
    if mean != 0.0 {
        model.add_force(N - 5, 0, mean.into()).unwrap();
    }
    model
}

/// The multipliers on all degrees of freedom, and those on each of some numbers of modes.
fn both(model: &Model, omega: f64, waves: Waves, modes: &[usize]) -> (Floquet, Vec<Floquet>) {
    let solver = SolverOptions {
        harmonics: 15,
        tolerance: 0.0,
        ..SolverOptions::default()
    };
    let range = ForcedOptions {
        omega_start: omega,
        omega_stop: omega,
        ..ForcedOptions::default()
    };
    let branch = forced_response(model, &solver, &range, &mut Hooks::default()).unwrap();
    let none = Interrupt::none();
    let harmonics = Recovery::at(&branch, 0, &none).unwrap().all(15).unwrap();
    let motion = Motion {
        omega,
        harmonics: &harmonics,
        autonomous: false,
        compared: true,
        fine: None,
        difference: None,
        quick: false,
    };
    let mut options = FloquetOptions {
        waves,
        modes: Some(0),
        ..FloquetOptions::default()
    };
    let (hooks, kept) = (&mut Hooks::default(), &mut KeptModes::default());
    let all = floquet_of(model, &motion, &options, hooks, kept, &none).unwrap();
    options.modes = None;
    let step = match waves {
        Waves::Wave => model.structure().sectors() / model.structure().repeating_sectors(),
        Waves::Wheel => 1,
    };
    let on = |&count: &usize| {
        let seen = SliderModes::new(model, step, count, &none).unwrap();
        let found = perturbed_sliders(model, &seen, count, &motion, &options, &none).unwrap();
        println!(
            "{count} modes: radius {:.9}, {:.1e} off, moved {:.1e} ({:.1e} on all)",
            found.stability.radius,
            found.stability.radius - all.stability.radius,
            found.shift,
            all.shift
        );
        found.stability
    };
    let found = modes.iter().map(on).collect();
    (all.stability, found)
}

/// Largest distance of a large multiplier in `a` from the nearest one in `b`.
fn largest_gap(a: &Floquet, b: &Floquet) -> f64 {
    let gap = |x: Complex64| {
        b.multipliers
            .iter()
            .map(|y| (x - y.value).norm())
            .fold(f64::INFINITY, f64::min)
    };
    a.multipliers.iter().map(|x| gap(x.value)).fold(0.0, f64::max)
}

fn compare(model: &Model, omega: f64, waves: Waves) {
    let (all, found) = both(model, omega, waves, &[6, N]);
    let exact = &found[1];
    assert_eq!(
        all.multipliers.len() - all.neutral,
        exact.multipliers.len() - exact.neutral
    );
    assert_eq!((all.neutral, all.unstable), (exact.neutral, exact.unstable));
    let gap = largest_gap(&all, exact).max(largest_gap(exact, &all));
    println!("radius {:.9}, multipliers {gap:.1e} off on all modes", all.radius);
    assert!(gap < 1e-8, "{gap:.1e}");
    let off = (found[0].radius - all.radius).abs();
    assert!(
        off < 1e-2 * (1.0 - all.radius).abs(),
        "{off:.1e} off on three quarters of the modes"
    );
}

#[test]
fn sliders_of_a_plain_structure_have_the_multipliers_of_all_degrees_of_freedom() {
    compare(&plain(), 3.0, Waves::Wave);
}

#[test]
fn sliders_of_waves_have_the_multipliers_of_all_degrees_of_freedom() {
    for (engine_order, mean) in [(2, 0.0), (3, 0.01)] {
        compare(&wheel(engine_order, mean), 2.9, Waves::Wave);
    }
}

#[test]
fn sliders_of_a_wheel_have_the_multipliers_of_all_degrees_of_freedom() {
    compare(&wheel(2, 0.0), 2.9, Waves::Wheel);
}

/// The radius on all degrees of freedom lies within the error told by two numbers of modes.
#[test]
fn the_error_of_the_radius_holds_on_sliders() {
    let models = [
        (plain(), 3.0),
        (plain(), 1.7),
        (wheel(2, 0.0), 2.9),
        (wheel(3, 0.01), 1.6),
    ];
    for (model, omega) in &models {
        let (all, found) = both(model, *omega, Waves::Wave, &[2, 3, 4, 6]);
        for (few, many) in [(0, 2), (1, 3)] {
            let (few, many) = (&found[few], &found[many]);
            let off = (many.radius - all.radius).abs();
            let (told, change) = (error_of_radius(few, many), change(few, many));
            println!("at {omega}: {off:.1e} off, {told:.1e} told, {change:.1e} of any multiplier");
            assert!(off <= told.max(1e-10), "{off:.1e} {told:.1e}");
        }
    }
}

#[test]
#[ignore = "as the tests above, in further waves: half a minute"]
fn sliders_of_further_waves_have_the_multipliers_of_all_degrees_of_freedom() {
    compare(&wheel(-3, 0.0), 2.9, Waves::Wave);
    for (engine_order, mean) in [(3, 0.0), (2, 0.01)] {
        compare(&wheel(engine_order, mean), 2.9, Waves::Wheel);
    }
}

/// On few modes neighbouring contacts are coupled by the motions that these leave out: a slider that begins to slip
/// may stop another one while it moves, and the time of that follows from the first.
#[test]
fn the_map_of_coupled_sliders_is_the_difference_of_neighbouring_motions() {
    let mut model = plain();
    for dof in [N - 2, N - 3, 1] {
        model
            .add_contact(&Contact::jenkins(
                dof,
                Some(dof - 1),
                40.0,
                0.5,
                0.05 + 0.01 * dof as f64,
            ))
            .unwrap();
    }
    let none = Interrupt::none();
    let seen = SliderModes::new(&model, 1, 2, &none).unwrap();
    let structure = model.structure();
    let closure = closures(structure, Waves::Wave, false).unwrap()[0];
    let ring = ModalRing::<f64>::new(structure, closure, (&seen.modes, 2), &seen.sliders, &none).unwrap();
    let forces = forces_on(structure, &ring, &seen, &none).unwrap();
    let motion = SliderMotion::new(&ring, &seen.sliders, (2.0, 1), forces, &none).unwrap();
    let mut stopped = 0;
    for start in 0..40 {
        let at = |i: usize| 0.6 * ((start * 7 + i * 3 + 1) as f64 * 1.7).sin();
        let state = SliderState {
            q: DVector::from_fn(2, |i, _| at(i)),
            v: DVector::from_fn(2, |i, _| 2.0 * at(i + 2)),
            w: DVector::from_fn(ring.all(), |i, _| 0.1 * at(i + 4)),
        };
        let mut image = state.try_clone().unwrap();
        let path = motion.run(&mut image).unwrap();
        stopped += path
            .changes
            .iter()
            .filter(|change| !change.slips && change.speed != 0.0)
            .count();
        let map = SliderMap::new(&ring, &path, &path.moved, &none).unwrap();
        let matrix = map.matrix((1.0, 1.0), |_| 1.0, &none).unwrap();
        const STEP: f64 = 1e-6;
        for column in 0..map.states() {
            let moved = |sign: f64| {
                let mut state = state.try_clone().unwrap();
                let step = sign * STEP;
                match column {
                    0 | 1 => state.q[column] += step,
                    2 | 3 => state.v[column - 2] += step,
                    _ => state.w[map.moving[column - 4]] += step,
                }
                motion.run(&mut state).unwrap();
                let w = map.moving.iter().map(|&e| state.w[e]);
                let all: Vec<f64> = state.q.iter().chain(&state.v).copied().chain(w).collect();
                all
            };
            let (more, less) = (moved(1.0), moved(-1.0));
            for (i, (a, b)) in more.iter().zip(&less).enumerate() {
                let difference = (a - b) / (2.0 * STEP);
                let found = matrix[(i, column)];
                assert!(
                    (difference - found).abs() < 1e-4 * (1.0 + found.abs()),
                    "start {start}, ({i}, {column}): {found} and {difference}"
                );
            }
        }
    }
    println!("{stopped} sliders were stopped by others");
    assert!(stopped > 0);
}
