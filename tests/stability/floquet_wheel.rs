//! Blocks of perturbations of a wheel together have the multipliers of the whole wheel.

use crate::common::models::Structure;
use crate::common::{BASE, SECTORS, Wheel, harmonics, solve_at};
use crate::{multipliers, of_class, ordinary};
use hbvib::{Constant, Contact, Floquet, MatrixKind, MatrixView, Model, MultiplierClass, Speed, Waves};
use num_complex::Complex64;
use std::f64::consts::TAU;

#[test]
fn the_ring_damper_has_the_radii_of_its_reference() {
    let model = BASE.sector();
    let branch = solve_at(&model, &harmonics(63), TAU * 208.85);
    for (waves, radius, blocks) in [
        (Waves::Wave, 0.993_431_437_676, 1),
        (Waves::Wheel, 0.998_436_261_437, 4),
    ] {
        let found = multipliers(&model, &branch, 0, waves);
        println!(
            "{waves:?}: {}, {} neutral, moved {:.1e}",
            found.radius, found.neutral, found.orbit_change
        );
        assert!((found.radius - radius).abs() < 1e-9);
        // Odd laws halve the twelve sectors of the wave: blocks of 54 states.
        assert_eq!(found.multipliers.len(), 54 * blocks);
        assert_eq!(of_class(&found, MultiplierClass::Memory).len(), 6 * blocks);
        assert_eq!(found.neutral, usize::from(waves == Waves::Wheel));
        assert_eq!(found.unstable, 0);
    }
}

#[test]
fn the_blocks_of_the_ring_damper_are_its_full_wheel() {
    let (sector, wheel) = (BASE.sector(), BASE.full_wheel());
    let omega = TAU * 208.85;
    let blocks = multipliers(&sector, &solve_at(&sector, &harmonics(63), omega), 0, Waves::Wheel);
    let whole = multipliers(&wheel, &solve_at(&wheel, &harmonics(63), omega), 0, Waves::Wave);
    let gap = gap(&ordinary(&blocks), &ordinary(&whole));
    println!(
        "{gap:.1e} between {} and {} multipliers",
        blocks.multipliers.len(),
        whole.multipliers.len()
    );
    assert_eq!(blocks.multipliers.len(), 9 * SECTORS);
    assert_eq!(whole.neutral, 1);
    assert!(gap < 1e-8);
}

const MASS: [f64; 4] = [1.0, 0.1, 0.1, 0.8];
const DAMPING: [f64; 4] = [0.06, -0.01, -0.01, 0.05];
const STIFFNESS: [f64; 4] = [1.4, -0.3, -0.3, 1.1];
/// Without mirror symmetry: a wave and its opposite differ.
const NEXT: [f64; 4] = [-0.05, 0.08, -0.12, -0.02];

fn contacts() -> [Contact; 2] {
    let between = Contact {
        sector_offset: 1,
        ..Contact::jenkins(0, Some(1), 0.6, 0.5, 0.5)
    };
    [between, Contact::unilateral(Some(1), None, 0.7, 0.2)]
}

fn sector(sectors: usize, engine_order: i64, contacts: &[Contact]) -> Model {
    Structure::cyclic(2, sectors)
        .mass(&MASS)
        .damping(&DAMPING)
        .stiffness(&STIFFNESS)
        .next(MatrixKind::Stiffness, &NEXT)
        .wave(engine_order)
        .contacts(contacts)
        .force(0, 1, 0.6)
        .build()
}

fn wheel(sectors: usize, engine_order: i64, contacts: &[Contact]) -> Model {
    let mut wheel = Wheel::new(2, sectors);
    wheel.set(MatrixKind::Mass, &MASS, None, None);
    wheel.set(MatrixKind::Damping, &DAMPING, None, None);
    wheel.set(MatrixKind::Stiffness, &STIFFNESS, Some(&NEXT), None);
    for contact in contacts {
        wheel.add_contact(contact);
    }
    wheel.add_force(0, 1, 0.6.into(), engine_order);
    wheel.model
}

/// Largest distance of a multiplier from the nearest of another list that no other one has taken.
fn gap(a: &[Complex64], b: &[Complex64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let mut left = b.to_vec();
    let mut worst = 0.0_f64;
    for a in a {
        let distance = |i: usize| (left[i] - a).norm();
        let nearest = (0..left.len())
            .min_by(|&i, &j| distance(i).total_cmp(&distance(j)))
            .unwrap();
        worst = worst.max(distance(nearest));
        left.swap_remove(nearest);
    }
    worst
}

#[test]
fn blocks_of_waves_make_up_the_wheel() {
    const N: usize = 6;
    for (name, contacts) in [("friction and stop", &contacts()[..]), ("friction", &contacts()[..1])] {
        for engine_order in [0, 1, -1, 2, 3, 7] {
            let (sector, wheel) = (sector(N, engine_order, contacts), wheel(N, engine_order, contacts));
            let of = |model: &Model, waves| -> Floquet {
                multipliers(model, &solve_at(model, &harmonics(21), 1.05), 0, waves)
            };
            let (blocks, whole) = (of(&sector, Waves::Wheel), of(&wheel, Waves::Wave));
            let own = of(&sector, Waves::Wave);
            let gap = gap(&ordinary(&blocks), &ordinary(&whole));
            println!(
                "{name}, EO {engine_order}: {gap:.1e}; {} ordinary, radius {:.4} of the wave, {:.4} of the wheel",
                ordinary(&whole).len(),
                own.radius,
                whole.radius
            );
            assert_eq!(blocks.multipliers.len(), 5 * N);
            assert_eq!(blocks.neutral, whole.neutral);
            assert!(gap < 1e-8, "{name}, EO {engine_order}: {gap:.1e}");
            for mu in ordinary(&own) {
                assert!(ordinary(&whole).iter().any(|w| (w - mu).norm() < 1e-8), "{mu}");
            }
        }
    }
}

/// K + Ω²K₁ at a fixed speed has the multipliers of the same stiffness given at once.
#[test]
fn stiffness_of_a_fixed_speed_is_in_the_multipliers() {
    const OF_SPEED: [f64; 4] = [0.4, 0.1, 0.1, -0.2];
    const SPEED: f64 = 0.8;
    let mut rotating = sector(6, 2, &contacts());
    rotating
        .set_matrix(MatrixKind::StiffnessSpeed2, &MatrixView::dense(2, &OF_SPEED))
        .unwrap();
    rotating.set_speed(Speed::Fixed(SPEED)).unwrap();
    let stiffness: [f64; 4] = core::array::from_fn(|i| STIFFNESS[i] + SPEED * SPEED * OF_SPEED[i]);
    let mut fixed = sector(6, 2, &contacts());
    fixed
        .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(2, &stiffness))
        .unwrap();
    let of = |model: &Model| {
        ordinary(&multipliers(
            model,
            &solve_at(model, &harmonics(21), 1.05),
            0,
            Waves::Wheel,
        ))
    };
    let gap = gap(&of(&rotating), &of(&fixed));
    println!("{gap:.1e}");
    assert!(gap < 1e-9);
}

/// Neighbours that move opposite to each other, in half as many waves as sectors, with a stop between them: it is closed on one side of a
/// sector while it is open on the other, so that perturbations do not repeat from one sector to the next.
#[test]
fn a_stop_between_opposite_neighbours_has_the_multipliers_of_the_wheel() {
    for (sectors, engine_order) in [(2, 1), (4, 2), (6, 3), (4, 1)] {
        for (gap_of_stop, preload) in [(0.2, 0.0), (0.0, 0.1)] {
            let stop = Contact {
                sector_offset: 1,
                ..Contact::unilateral(Some(1), Some(1), 0.7, gap_of_stop)
            }
            .with(Constant::Preload, preload)
            .unwrap();
            let (sector, wheel) = (
                sector(sectors, engine_order, &[stop.clone()]),
                wheel(sectors, engine_order, &[stop]),
            );
            let of = |model: &Model, waves| -> Floquet {
                multipliers(model, &solve_at(model, &harmonics(21), 1.05), 0, waves)
            };
            let (blocks, whole) = (of(&sector, Waves::Wheel), of(&wheel, Waves::Wave));
            let gap = gap(&ordinary(&blocks), &ordinary(&whole));
            println!(
                "{sectors} sectors, EO {engine_order}: {gap:.1e}, radius {:.4}",
                whole.radius
            );
            assert!(gap < 1e-8, "{sectors} sectors, EO {engine_order}: {gap:.1e}");
        }
    }
}
