//! The linear modes that nonlinear modes start from: the choice among the stuck modes, and what is
//! done about repeated frequencies.

use crate::common::modes::{self, assert_wave, chain_frequency, chains, gap, mass_product, sector, skewed};
use crate::common::refusal::refused;
use crate::common::{BASE, NDOF, R, SECTORS, largest};
use hbvib::internals::Multiple;
use hbvib::{ContactState, MatrixKind, MatrixView, ModeChoice, Model, Part, Spring, Status};
use num_complex::Complex64;
use std::f64::consts::TAU;

#[test]
fn families_of_the_sector_are_the_natural_modes_of_its_diameter() {
    for diameter in [0, 2, 3, 12] {
        let model = sector(diameter);
        let stuck = model.linear_modes(diameter, ContactState::Stuck).unwrap();
        let free = model.linear_modes(diameter, ContactState::Free).unwrap();
        for family in 0..3 {
            let mode = model.select_mode(ModeChoice::Index(family)).unwrap();
            assert_eq!((mode.index, mode.multiplicity), (family, 1));
            assert_eq!(mode.multiple, Multiple::Single);
            assert!((mode.omega / stuck.omega[family] - 1.0).abs() < 1e-12);
            assert!((mass_product(&model, &mode.shape, &mode.shape).re - 1.0).abs() < 1e-14);
            let overlap = mass_product(&model, &mode.shape, &stuck.shapes[family * NDOF..(family + 1) * NDOF]);
            assert!((overlap.norm() - 1.0).abs() < 1e-12);
            assert_eq!((mode.stuck.len(), mode.free.len()), (NDOF, NDOF));
            for (found, expected) in [(&mode.stuck, &stuck.omega), (&mode.free, &free.omega)] {
                let highest = expected[NDOF - 1];
                // A rigid ring of diameter 0 has only rounding for a frequency.
                assert!(
                    found
                        .iter()
                        .zip(expected)
                        .all(|(a, b)| (a - b).abs()
                            <= 1e-12 * b + if *b < 1e-6 * highest { 1e-6 * highest } else { 0.0 })
                );
            }
            // The entry that moves most is real and positive.
            let most = mode.shape.iter().max_by(|a, b| a.norm().total_cmp(&b.norm())).unwrap();
            assert!(most.re > 0.0 && most.im.abs() < 1e-15);
        }
    }
}

#[test]
fn a_backward_wave_has_the_conjugate_shapes_of_the_forward_one() {
    for family in 0..4 {
        let forward = skewed(2).select_mode(ModeChoice::Index(family)).unwrap();
        let backward = skewed(22).select_mode(ModeChoice::Index(family)).unwrap();
        assert!((forward.omega / backward.omega - 1.0).abs() < 1e-13);
        let conjugate: Vec<_> = backward.shape.iter().map(Complex64::conj).collect();
        assert!(gap(&conjugate, &forward.shape) < 1e-12);
        assert!(
            forward
                .shape
                .iter()
                .any(|z| z.im.abs() > 1e-5 * largest(&forward.shape))
        );
    }
}

#[test]
fn a_mode_is_found_by_its_frequency_and_by_its_shape() {
    let model = skewed(3);
    for family in 0..4 {
        let mode = model.select_mode(ModeChoice::Index(family)).unwrap();
        let near = model.select_mode(ModeChoice::Near(1.01 * mode.omega)).unwrap();
        assert_eq!(near.index, family);
        // Disturbed, turned and of an absurd size.
        let shape: Vec<_> = mode
            .shape
            .iter()
            .enumerate()
            .map(|(i, z)| (z + 0.05 * (i as f64).cos()) * Complex64::cis(1.0) * 1e200)
            .collect();
        let alike = model.select_mode(ModeChoice::Shape(&shape)).unwrap();
        assert_eq!(alike.index, family);
        assert!(gap(&alike.shape, &mode.shape) < 1e-14);
    }
    let stuck = model.select_mode(ModeChoice::Index(0)).unwrap().stuck;
    let below = model
        .select_mode(ModeChoice::Near(0.499 * (stuck[1] + stuck[2])))
        .unwrap();
    let above = model
        .select_mode(ModeChoice::Near(0.501 * (stuck[1] + stuck[2])))
        .unwrap();
    assert_eq!((below.index, above.index), (1, 2));
}

#[test]
fn a_double_mode_of_the_full_wheel_becomes_a_travelling_wave() {
    let full_wheel = BASE.full_wheel();
    for (diameter, family) in [(2, 0), (3, 1), (11, 2)] {
        let sector = sector(diameter).select_mode(ModeChoice::Index(family)).unwrap();
        let lower = full_wheel.select_mode(ModeChoice::Near(sector.omega)).unwrap();
        assert_eq!((lower.multiplicity, lower.multiple), (2, Multiple::TravellingWave));
        assert!((lower.omega / sector.omega - 1.0).abs() < 1e-12);
        assert_wave(&lower.shape, diameter as f64);
        // One sector holds 1/N of the modal mass, and is the sector's mode.
        let scaled: Vec<_> = lower.shape[..NDOF]
            .iter()
            .map(|z| z * (SECTORS as f64).sqrt())
            .collect();
        assert!((mass_product(&modes::sector(diameter), &sector.shape, &scaled).norm() - 1.0).abs() < 1e-9);
        let upper = full_wheel.select_mode(ModeChoice::Index(lower.index + 1)).unwrap();
        assert_eq!((upper.index, upper.multiplicity), (lower.index + 1, 2));
        assert_wave(&upper.shape, -(diameter as f64));
    }
    // Diameter 0 and N/2 are simple.
    for diameter in [0, 12] {
        let sector = sector(diameter).select_mode(ModeChoice::Index(0)).unwrap();
        let mode = full_wheel.select_mode(ModeChoice::Near(sector.omega)).unwrap();
        assert_eq!((mode.multiplicity, mode.multiple), (1, Multiple::Single));
        assert_wave(&mode.shape, diameter as f64);
    }
}

#[test]
fn a_given_standing_shape_of_a_double_mode_is_kept() {
    let full_wheel = BASE.full_wheel();
    let sector = sector(2).select_mode(ModeChoice::Index(0)).unwrap();
    let mut standing = vec![Complex64::ZERO; NDOF * SECTORS];
    for (s, chunk) in standing.chunks_exact_mut(NDOF).enumerate() {
        for (z, x) in chunk.iter_mut().zip(&sector.shape) {
            *z = x * (TAU * 2.0 * s as f64 / SECTORS as f64 + 0.3).cos();
        }
    }
    let norm = mass_product(&full_wheel, &standing, &standing).re.sqrt();
    for z in &mut standing {
        *z /= norm;
    }
    let mode = full_wheel.select_mode(ModeChoice::Shape(&standing)).unwrap();
    assert_eq!((mode.multiplicity, mode.multiple), (2, Multiple::Projected));
    assert!(gap(&mode.shape, &standing) < 1e-9);
    // Parts that do not belong to the modes of this frequency are taken away.
    let mut disturbed = standing.clone();
    disturbed[17] += 0.1 * largest(&standing);
    let mode = full_wheel.select_mode(ModeChoice::Shape(&disturbed)).unwrap();
    assert_eq!(mode.multiple, Multiple::Projected);
    let overlap = mass_product(&full_wheel, &standing, &mode.shape).norm();
    assert!(overlap > 0.99 && overlap < 1.0 - 1e-9);
}

#[test]
fn modes_of_a_large_structure_are_found_among_the_lowest() {
    let length = 300;
    let model = chains(1, length);
    for choice in [
        ModeChoice::Index(4),
        ModeChoice::Near(1.001 * chain_frequency(4, length)),
    ] {
        let mode = model.select_mode(choice).unwrap();
        assert_eq!((mode.index, mode.multiple), (4, Multiple::Single));
        assert!((mode.omega / chain_frequency(4, length) - 1.0).abs() < 1e-12);
        assert!(mode.stuck.len() >= 6 && mode.stuck.len() < 40 && mode.free.len() == mode.stuck.len());
        assert!(mode.free[0] < 1e-5);
    }
    // Beyond the first search, and beyond what Lanczos iteration is used for.
    for k in [30, 200, 299] {
        let wanted = chain_frequency(k, length);
        assert_eq!(model.select_mode(ModeChoice::Near(wanted)).unwrap().index, k);
        let mode = model.select_mode(ModeChoice::Index(k)).unwrap();
        assert!((mode.omega / wanted - 1.0).abs() < 1e-12);
    }
    let twelfth = model.select_mode(ModeChoice::Index(12)).unwrap();
    assert_eq!(model.select_mode(ModeChoice::Shape(&twelfth.shape)).unwrap().index, 12);
    // A pair is seen whole wherever it lies.
    let pair = chains(2, length);
    for k in 0..6 {
        let mode = pair.select_mode(ModeChoice::Index(k)).unwrap();
        assert_eq!((mode.index, mode.multiplicity), (k, 2));
        assert_eq!(mode.multiple, Multiple::TravellingWave);
        assert!((mode.omega / chain_frequency(k / 2, length) - 1.0).abs() < 1e-12);
    }
    let triple = chains(3, length).select_mode(ModeChoice::Index(1)).unwrap();
    assert_eq!((triple.multiplicity, triple.multiple), (3, Multiple::First));
}

#[test]
fn few_masses_in_a_large_structure_have_as_many_modes() {
    let length = 300;
    let mut model = chains(1, length);
    let mut mass = vec![0.0; length * length];
    for i in [49, 99, 149, 199, 249] {
        mass[i * length + i] = 2.0;
    }
    model
        .set_matrix(MatrixKind::Mass, &MatrixView::dense(length, &mass))
        .unwrap();
    // The springs between the masses in series, then a chain of five with its own exact frequencies.
    for k in 0..5 {
        let mode = model.select_mode(ModeChoice::Index(k)).unwrap();
        let expected = (1.0 / 50.0_f64 / 2.0).sqrt() * chain_frequency(k, 5);
        assert!((mode.omega / expected - 1.0).abs() < 1e-11, "{} {expected}", mode.omega);
    }
    refused(
        model.select_mode(ModeChoice::Index(5)),
        Status::Index,
        &["mode_index = 5, needs 0 .. 4"],
    );
}

#[test]
fn modes_that_cannot_be_had_are_refused_by_name() {
    let model = sector(2);
    let start = |model: &Model, choice| model.select_mode(choice);
    let words = ["mode_index = 7, needs 0 .. 3 (natural modes with mass)"];
    refused(start(&model, ModeChoice::Index(7)), Status::Index, &words);
    refused(start(&model, ModeChoice::Index(4)), Status::Index, &["mode_index = 4"]);
    refused(
        start(&model, ModeChoice::Index(usize::MAX)),
        Status::Index,
        &["mode_index"],
    );
    refused(
        start(&model, ModeChoice::Near(f64::NAN)),
        Status::NotFinite,
        &["near_omega"],
    );
    refused(
        start(&model, ModeChoice::Near(0.0)),
        Status::Argument,
        &["near_omega = 0"],
    );
    let zero = [Complex64::ZERO; NDOF];
    refused(
        start(&model, ModeChoice::Shape(&zero)),
        Status::Argument,
        &["shape is zero"],
    );
    refused(
        start(&model, ModeChoice::Shape(&zero[1..])),
        Status::Dimension,
        &["shape has 3", "ndof = 4"],
    );
    // A rigid ring: diameter 0 without contact, small and large.
    let free = {
        let mut model = BASE.sector_without_contact();
        model.set_wave(0);
        model
    };
    let rigid = ["mode 0 has no frequency (rigid body)"];
    refused(start(&free, ModeChoice::Index(0)), Status::Argument, &rigid);
    assert!(start(&free, ModeChoice::Index(1)).is_ok());
    let mut chain = chains(1, 300);
    chain.set_preload(0, 0.0).unwrap();
    refused(start(&chain, ModeChoice::Index(0)), Status::Argument, &rigid);
    assert!(start(&chain, ModeChoice::Index(1)).is_ok());
    // Pushed over by a negative spring.
    let mut unstable = sector(2);
    unstable
        .add_spring(&Spring {
            dof_a: Some(R),
            dof_b: None,
            sector_offset: 0,
            stiffness: -1e9,
        })
        .unwrap();
    refused(
        start(&unstable, ModeChoice::Index(0)),
        Status::Argument,
        &["mode 0 has no frequency", "unstable"],
    );
}

#[test]
fn matrices_without_natural_modes_are_refused() {
    for length in [4, 300] {
        // Positive on the diagonal, and yet negative along the difference of two motions.
        let mut model = chains(1, length);
        let mut mass = vec![0.0; length * length];
        for i in 0..length {
            mass[i * length + i] = 1.0;
        }
        mass[2] = 2.0;
        mass[2 * length] = 2.0;
        model
            .set_matrix(MatrixKind::Mass, &MatrixView::dense(length, &mass))
            .unwrap();
        for choice in [ModeChoice::Index(0), ModeChoice::Near(0.5)] {
            refused(
                model.select_mode(choice),
                Status::NotPositiveDefinite,
                &["mass matrix is not positive semidefinite"],
            );
        }
        model
            .set_matrix(
                MatrixKind::Mass,
                &MatrixView::dense(length, &vec![0.0; length * length]),
            )
            .unwrap();
        refused(
            model.select_mode(ModeChoice::Index(0)),
            Status::NotPositiveDefinite,
            &["mass matrix is zero"],
        );
        let mut model = chains(1, length);
        let mut stiffness = vec![0.0; length * length];
        stiffness[1] = 0.5;
        model
            .set_matrix(
                MatrixKind::Stiffness,
                &MatrixView::dense(length, &stiffness).part(Part::General),
            )
            .unwrap();
        refused(
            model.select_mode(ModeChoice::Index(0)),
            Status::NotHermitian,
            &["stiffness[1,0]"],
        );
    }
}
