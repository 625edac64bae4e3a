//! A sector on the cantilever modes of its blade against the sector in full: tuned frequencies with the told error, a mistuned wheel with
//! friction, and sectors that cannot be reduced.

use crate::common::models::{Structure, diagonal};
use crate::common::refusal::refused;
use crate::common::{all_harmonics, harmonics, omega_range, solve_at};
use hbvib::{
    BladeProperty, Contact, ContactState, ForcedOptions, Hooks, Interrupt, MatrixKind, MatrixView, Mistuning, Model,
    Response, Speed, Status, forced_response,
};
use num_complex::Complex64;

/// Degrees of freedom: two of the disk, then a chain of masses as blade.
const N: usize = 16;
const SECTORS: usize = 6;
const DELTA: [f64; SECTORS] = [0.03, -0.05, 0.01, 0.04, -0.02, -0.015];

fn sector() -> Model {
    let mut k = vec![0.0; N * N];
    let mut spring = |a: usize, b: usize, v: f64| {
        for (i, j, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
            k[N * i + j] += sign * v;
        }
    };
    spring(0, 1, 60.0);
    for i in 2..N {
        spring(i - 1, i, 40.0 - i as f64);
    }
    // The blade is also tied to the other mass of the disk.
    spring(0, 2, 5.0);
    k[0] += 20.0 + 2.0 * 8.0;
    let masses: Vec<f64> = (0..N)
        .map(|i| if i < 2 { 3.0 } else { 0.3 + 0.01 * i as f64 })
        .collect();
    let mut m = diagonal(&masses);
    // A mass that blade and disk share.
    m[N + 2] = 0.05;
    m[2 * N + 1] = 0.05;
    let mut next = vec![0.0; N * N];
    next[0] = -8.0;
    Structure::cyclic(N, SECTORS)
        .mass(&m)
        .stiffness(&k)
        .next(MatrixKind::Stiffness, &next)
        .rayleigh(0.01, 1e-3)
        .wave(2)
        .slider(1, 3.0, 0.3, 0.2)
        .force(N - 1, 1, Complex64::new(0.02, 0.01))
        .force(0, 1, 0.01)
        .build()
}

fn blade() -> Vec<usize> {
    (2..N).collect()
}

/// Frequencies of all nodal diameters with stuck contacts, then those with free ones.
fn frequencies(model: &Model, sectors: usize, families: usize) -> Vec<f64> {
    let mut all = Vec::new();
    for state in [ContactState::Stuck, ContactState::Free] {
        for d in 0..=sectors / 2 {
            all.extend(model.lowest_modes(d as i64, state, families).unwrap().omega);
        }
    }
    all
}

#[test]
fn tuned_frequencies_err_as_told_and_all_modes_but_one_leave_little() {
    let sector = sector();
    let exact = frequencies(&sector, SECTORS, 3);
    let mut last = f64::INFINITY;
    for modes in [3, 5, 8, 13] {
        let found = sector.on_blade_modes(&blade(), (modes, 3), &Interrupt::none()).unwrap();
        assert_eq!(found.model.ndof(), 2 + modes);
        assert_eq!((found.first, found.numbers[1], found.numbers[5]), (2, Some(1), None));
        let errors = frequencies(&found.model, SECTORS, 3)
            .into_iter()
            .zip(&exact)
            .map(|(a, b)| a / b - 1.0);
        let errors: Vec<f64> = errors.collect();
        let largest = errors.iter().fold(0.0_f64, |m, e| m.max(*e));
        println!("{modes} modes: {largest:.3e}, told {:.3e}", found.left_out);
        // Frequencies of fewer motions are too high.
        assert!(errors.iter().all(|e| *e > -1e-12));
        assert!(
            found.left_out > 0.95 * largest && found.left_out < 1.15 * largest,
            "{largest:e}"
        );
        assert!(largest < 0.7 * last);
        last = largest;
    }
    assert!(last < 1e-4);
    // The third family has its frequencies above the second cantilever mode.
    let few = sector.on_blade_modes(&blade(), (1, 3), &Interrupt::none()).unwrap();
    assert!(few.left_out.is_infinite());
}

/// A chain of masses on a rim with random springs and masses, and a slider at its second mass; `random` gives numbers between two others.
fn random_sector(random: &mut impl FnMut(f64, f64) -> f64) -> (Model, usize, usize) {
    let (n, sectors) = (random(6.0, 20.0) as usize, random(4.0, 9.0) as usize);
    let mut model = Model::cyclic(n, sectors).unwrap();
    let (mut k, mut m, mut next) = (vec![0.0; n * n], vec![0.0; n * n], vec![0.0; n * n]);
    for i in 1..n {
        let v = random(1.0, 6.0);
        for (row, column, sign) in [(i, i, 1.0), (i - 1, i - 1, 1.0), (i, i - 1, -1.0), (i - 1, i, -1.0)] {
            k[n * row + column] += sign * v;
        }
    }
    for m in m.iter_mut().step_by(n + 1) {
        *m = random(0.5, 2.0);
    }
    m[0] *= random(1.0, 8.0);
    let coupling = random(0.3, 4.0);
    k[0] += random(1.0, 6.0) + 2.0 * coupling;
    next[0] = -coupling;
    for (kind, a) in [(MatrixKind::Mass, &m), (MatrixKind::Stiffness, &k)] {
        model.set_matrix(kind, &MatrixView::dense(n, a)).unwrap();
    }
    model
        .set_coupling(MatrixKind::Stiffness, &MatrixView::dense(n, &next))
        .unwrap();
    model
        .add_contact(&Contact::jenkins(1, None, random(0.5, 10.0), 0.3, 0.05))
        .unwrap();
    (model, n, sectors)
}

/// The told error is the larger one of stuck and of free contacts, which differ up to thirtyfold, and no multiple of the true one where a
/// frequency comes near the first mode that is left out.
#[test]
fn the_error_told_is_that_of_both_states_over_random_sectors() {
    let mut state = 20_261_128_u64;
    let mut random = |low: f64, high: f64| {
        // Knuth's MMIX.
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let (mut finite, mut free_is_larger, mut near) = (0, 0, 0);
    for number in 0..400 {
        let (sector, n, sectors) = random_sector(&mut random);
        let modes = (random(1.0, 6.0) as usize).min(n - 4);
        let families = (random(1.0, 4.0) as usize).min(2 + modes);
        let blade: Vec<usize> = (2..n).collect();
        let found = sector
            .on_blade_modes(&blade, (modes, families), &Interrupt::none())
            .unwrap();
        let exact = frequencies(&sector, sectors, families);
        let reduced = frequencies(&found.model, sectors, families);
        let errors: Vec<f64> = reduced.iter().zip(&exact).map(|(a, b)| a / b - 1.0).collect();
        let (stuck, free) = errors.split_at(errors.len() / 2);
        let most = |errors: &[f64]| errors.iter().fold(0.0_f64, |m, e| m.max(*e));
        let (stuck, free) = (most(stuck), most(free));
        if found.left_out.is_infinite() {
            // More families than the few modes can have.
            assert!(stuck.max(free) > 0.05, "{number}: {stuck:e} {free:e}");
            continue;
        }
        finite += 1;
        free_is_larger += usize::from(free > 2.0 * stuck);
        near += usize::from(stuck.max(free) > 0.01);
        let ratio = found.left_out / stuck.max(free);
        println!("{number}: stuck {stuck:.1e}, free {free:.1e}, told {ratio:.3} of the larger");
        assert!((0.65..1.5).contains(&ratio), "{number}: {stuck:e} {free:e} {ratio}");
    }
    assert!(
        finite >= 300 && free_is_larger >= 100 && near >= 3,
        "{finite} {free_is_larger} {near}"
    );
}

/// Tips of all blades of a wheel with a pattern of blade frequencies, in the range of the first family.
fn tips(sector: &Model, dofs: &[usize], tip: (&[usize], &[f64])) -> Vec<f64> {
    let mut wheel = sector.wheel().unwrap();
    let what = Mistuning::Blade(BladeProperty::Frequency, dofs);
    wheel.mistune(sector, &what, &DELTA).unwrap();
    let n = sector.ndof();
    let places: Vec<Vec<usize>> = (0..SECTORS)
        .map(|s| tip.0.iter().map(|dof| s * n + dof).collect())
        .collect();
    let responses: Vec<Response<'_>> = places
        .iter()
        .map(|dofs| Response {
            dofs,
            weights: tip.1,
            ..Response::default()
        })
        .collect();
    let tuned = sector.lowest_modes(2, ContactState::Stuck, 1).unwrap().omega[0];
    let mut all = Vec::new();
    for factor in [0.97, 1.0, 1.02] {
        let range = ForcedOptions {
            responses: &responses,
            ..omega_range(factor * tuned, factor * tuned)
        };
        let found = forced_response(&wheel, &harmonics(3), &range, &mut Hooks::default()).unwrap();
        all.extend(found.responses().iter().map(|one| one.values()[0]));
    }
    all
}

#[test]
fn no_error_is_told_where_matrices_of_a_speed_act() {
    let mut sector = sector();
    let n = N * N;
    for kind in [MatrixKind::Gyroscopic, MatrixKind::StiffnessSpeed2] {
        let mut values = vec![0.0; n];
        let at = [(N - 1) * N + N - 2, (N - 2) * N + N - 1];
        (values[at[0]], values[at[1]]) = if kind == MatrixKind::Gyroscopic {
            (0.1, -0.1)
        } else {
            (0.1, 0.1)
        };
        let mut turning = sector.try_clone().unwrap();
        turning.set_matrix(kind, &MatrixView::dense(N, &values)).unwrap();
        let told = |model: &hbvib::Model| {
            let found = model.on_blade_modes(&blade(), (5, 1), &Interrupt::none()).unwrap();
            found.left_out
        };
        assert!(told(&turning) < 1.0);
        turning.set_speed(Speed::Fixed(0.5)).unwrap();
        assert!(told(&turning).is_nan());
    }
    sector.set_speed(Speed::Fixed(0.5)).unwrap();
    assert!(
        sector
            .on_blade_modes(&blade(), (5, 1), &Interrupt::none())
            .unwrap()
            .left_out
            < 1.0
    );
}

#[test]
fn a_mistuned_wheel_on_modes_of_blades_moves_as_in_full() {
    let sector = sector();
    let full = tips(&sector, &blade(), (&[N - 1], &[1.0]));
    let largest = full.iter().fold(0.0_f64, |m, x| m.max(*x));
    let mut last = f64::INFINITY;
    for (modes, most) in [(2, 0.1), (5, 3e-3), (13, 1e-5)] {
        let found = sector.on_blade_modes(&blade(), (modes, 1), &Interrupt::none()).unwrap();
        let weights = found.weights(&sector, N - 1).unwrap();
        let dofs: Vec<usize> = (0..weights.len()).collect();
        let numbers: Vec<usize> = (0..modes).map(|j| found.first + j).collect();
        let reduced = tips(&found.model, &numbers, (&dofs, &weights));
        let gap = full
            .iter()
            .zip(&reduced)
            .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()))
            / largest;
        println!(
            "{modes} modes: {gap:.1e} of the largest amplitude, told {:.1e}",
            found.left_out
        );
        assert!(gap < most && gap < last);
        last = gap;
    }
    // The disk moves as it did, and the contact is where it was.
    let found = sector.on_blade_modes(&blade(), (13, 1), &Interrupt::none()).unwrap();
    let tuned = sector.lowest_modes(2, ContactState::Stuck, 1).unwrap().omega[0];
    let (one, other) = (
        solve_at(&sector, &harmonics(3), tuned),
        solve_at(&found.model, &harmonics(3), tuned),
    );
    let (one, other) = (all_harmonics(&one, 0), all_harmonics(&other, 0));
    assert!((one[N + 1] / other[found.model.ndof() + 1] - 1.0).norm() < 1e-5);
}

#[test]
fn blades_that_cannot_be_reduced_are_refused_by_name() {
    let sector = sector();
    let of = |dofs: &[usize], modes| sector.on_blade_modes(dofs, (modes, 1), &Interrupt::none());
    refused(of(&[3, 4, 3], 1), Status::Argument, &["dofs[2] = 3", "twice"]);
    refused(of(&[3, 99], 1), Status::Index, &["dofs[1]", "dof = 99", "0 .. 15"]);
    refused(of(&blade(), 14), Status::Argument, &["modes = 14", "1 .. 13"]);
    refused(
        of(&[1, 2, 3], 1),
        Status::Argument,
        &["contact 0", "dof = 1", "leave it out"],
    );
    refused(
        of(&[0, 2, 3], 1),
        Status::Argument,
        &["couples the blade to another sector"],
    );
    let mut damped = sector.try_clone().unwrap();
    damped.set_modal_damping(&[0.01]).unwrap();
    refused(
        damped.on_blade_modes(&blade(), (3, 1), &Interrupt::none()),
        Status::Unsupported,
        &["modal damping"],
    );
}
