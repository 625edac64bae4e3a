//! The linear modes that nonlinear modes start from: the choice among the stuck modes, what is done
//! about repeated frequencies, and the mode with the structure's damping.

mod common;
#[path = "common/refusal.rs"]
mod refusal;

use common::{BASE, D, NDOF, R, SECTORS, largest};
use hbvib::contact::Contact;
use hbvib::error::Status;
use hbvib::linalg::matrix_view::{MatrixView, Part};
use hbvib::model::Model;
use hbvib::model::damped_mode::DampedMode;
use hbvib::model::linear_modes::ContactState;
use hbvib::model::repeated::Multiple;
use hbvib::model::spring::{Spring, Wave};
use hbvib::model::start_mode::StartMode;
use hbvib::model::structure::MatrixKind;
use hbvib::options::{Amplitude, DampingForm, ModeChoice, ModeOptions};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;
use refusal::refused;
use std::f64::consts::TAU;

/// The blisk's sector under an engine order.
fn sector(engine_order: i64) -> Model {
    let mut model = BASE.sector();
    model.set_wave(engine_order);
    model
}

/// A sector without mirror symmetry: a second contact reaches into the next sector, so that the
/// matrices of a wave are complex.
fn skewed(engine_order: i64) -> Model {
    let mut model = sector(engine_order);
    model
        .add_contact(&Contact {
            dof_a: Some(common::B1),
            sector_offset: 1,
            ..Contact::jenkins(D, Some(common::B1), 3e6, 0.3, 10.0)
        })
        .unwrap();
    model
        .add_spring(&Spring {
            dof_a: Some(common::B2),
            dof_b: Some(D),
            sector_offset: 1,
            stiffness: 4e5,
        })
        .unwrap();
    model
}

/// aᴴ M b over one sector.
fn mass_product(model: &Model, a: &[Complex64], b: &[Complex64]) -> Complex64 {
    let mass = model.structure().wave_matrix(MatrixKind::Mass, 1).unwrap();
    let mut mb = vec![Complex64::ZERO; b.len()];
    mass.multiply_add(Complex64::ONE, b, &mut mb);
    a.iter().zip(&mb).map(|(a, b)| a.conj() * b).sum()
}

fn gap(a: &[Complex64], b: &[Complex64]) -> f64 {
    largest(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>()) / largest(b)
}

#[test]
fn families_of_the_sector_are_the_natural_modes_of_its_diameter() {
    for diameter in [0, 2, 3, 12] {
        let model = sector(diameter as i64);
        let stuck = model.linear_modes(diameter, ContactState::Stuck).unwrap();
        let free = model.linear_modes(diameter, ContactState::Free).unwrap();
        for family in 0..3 {
            let mode = model.start_mode(ModeChoice::Index(family)).unwrap();
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
            let most = mode.shape.iter().find(|z| z.norm() == largest(&mode.shape)).unwrap();
            assert!(most.re > 0.0 && most.im.abs() < 1e-15);
        }
    }
}

#[test]
fn a_backward_wave_has_the_conjugate_shapes_of_the_forward_one() {
    for family in 0..4 {
        let forward = skewed(2).start_mode(ModeChoice::Index(family)).unwrap();
        let backward = skewed(22).start_mode(ModeChoice::Index(family)).unwrap();
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
        let mode = model.start_mode(ModeChoice::Index(family)).unwrap();
        let near = model.start_mode(ModeChoice::Near(1.01 * mode.omega)).unwrap();
        assert_eq!(near.index, family);
        // Disturbed, turned and of an absurd size.
        let shape: Vec<_> = mode
            .shape
            .iter()
            .enumerate()
            .map(|(i, z)| (z + 0.05 * (i as f64).cos()) * Complex64::cis(1.0) * 1e200)
            .collect();
        let alike = model.start_mode(ModeChoice::Shape(&shape)).unwrap();
        assert_eq!(alike.index, family);
        assert!(gap(&alike.shape, &mode.shape) < 1e-14);
    }
    let stuck = model.start_mode(ModeChoice::Index(0)).unwrap().stuck;
    let below = model
        .start_mode(ModeChoice::Near(0.499 * (stuck[1] + stuck[2])))
        .unwrap();
    let above = model
        .start_mode(ModeChoice::Near(0.501 * (stuck[1] + stuck[2])))
        .unwrap();
    assert_eq!((below.index, above.index), (1, 2));
}

/// Asserts that every sector of the wheel lags behind the one before by 2π·diameter/N.
fn assert_wave(shape: &[Complex64], diameter: f64) {
    let lag = Complex64::cis(-TAU * diameter / SECTORS as f64);
    for s in 0..SECTORS {
        let next = (s + 1) % SECTORS;
        for i in 0..NDOF {
            let (a, b) = (shape[s * NDOF + i], shape[next * NDOF + i]);
            assert!((b - lag * a).norm() < 1e-9 * largest(shape), "sector {s}, dof {i}");
        }
    }
}

#[test]
fn a_double_mode_of_the_full_wheel_becomes_a_travelling_wave() {
    let wheel = BASE.wheel();
    for (diameter, family) in [(2, 0), (3, 1), (11, 2)] {
        let sector = sector(diameter).start_mode(ModeChoice::Index(family)).unwrap();
        let lower = wheel.start_mode(ModeChoice::Near(sector.omega)).unwrap();
        assert_eq!((lower.multiplicity, lower.multiple), (2, Multiple::TravellingWave));
        assert!((lower.omega / sector.omega - 1.0).abs() < 1e-12);
        assert_wave(&lower.shape, diameter as f64);
        // One sector holds 1/N of the modal mass, and is the sector's mode.
        let scaled: Vec<_> = lower.shape[..NDOF]
            .iter()
            .map(|z| z * (SECTORS as f64).sqrt())
            .collect();
        assert!((mass_product(&self::sector(diameter), &sector.shape, &scaled).norm() - 1.0).abs() < 1e-9);
        let upper = wheel.start_mode(ModeChoice::Index(lower.index + 1)).unwrap();
        assert_eq!((upper.index, upper.multiplicity), (lower.index + 1, 2));
        assert_wave(&upper.shape, -(diameter as f64));
    }
    // Diameter 0 and N/2 are simple.
    for diameter in [0, 12] {
        let sector = sector(diameter).start_mode(ModeChoice::Index(0)).unwrap();
        let mode = wheel.start_mode(ModeChoice::Near(sector.omega)).unwrap();
        assert_eq!((mode.multiplicity, mode.multiple), (1, Multiple::Single));
        assert_wave(&mode.shape, diameter as f64);
    }
}

#[test]
fn a_given_standing_shape_of_a_double_mode_is_kept() {
    let wheel = BASE.wheel();
    let sector = sector(2).start_mode(ModeChoice::Index(0)).unwrap();
    let mut standing = vec![Complex64::ZERO; NDOF * SECTORS];
    for (s, chunk) in standing.chunks_exact_mut(NDOF).enumerate() {
        for (z, x) in chunk.iter_mut().zip(&sector.shape) {
            *z = x * (TAU * 2.0 * s as f64 / SECTORS as f64 + 0.3).cos();
        }
    }
    let norm = mass_product(&wheel, &standing, &standing).re.sqrt();
    standing.iter_mut().for_each(|z| *z /= norm);
    let mode = wheel.start_mode(ModeChoice::Shape(&standing)).unwrap();
    assert_eq!((mode.multiplicity, mode.multiple), (2, Multiple::Projected));
    assert!(gap(&mode.shape, &standing) < 1e-9);
    // What does not belong to the modes of this frequency is taken away.
    let mut disturbed = standing.clone();
    disturbed[17] += 0.1 * largest(&standing);
    let mode = wheel.start_mode(ModeChoice::Shape(&disturbed)).unwrap();
    assert_eq!(mode.multiple, Multiple::Projected);
    let overlap = mass_product(&wheel, &standing, &mode.shape).norm();
    assert!(overlap > 0.99 && overlap < 1.0 - 1e-9);
}

/// `chains` equal chains of unit masses and springs, one end of each held by a contact of
/// stiffness 1; the other free.
fn chains(chains: usize, length: usize) -> Model {
    let n = chains * length;
    let mut model = Model::new(n).unwrap();
    let mut mass = vec![0.0; n * n];
    let springs: Vec<_> = (0..n)
        .filter(|i| (i + 1) % length != 0)
        .map(|i| Spring {
            dof_a: Some(i),
            dof_b: Some(i + 1),
            sector_offset: 0,
            stiffness: 1.0,
        })
        .collect();
    for i in 0..n {
        mass[i * n + i] = 1.0;
    }
    model
        .set_matrix(MatrixKind::Mass, &MatrixView::dense(n, &mass))
        .unwrap();
    model.add_springs(&springs).unwrap();
    for c in 0..chains {
        model
            .add_contact(&Contact::jenkins(c * length, None, 1.0, 0.5, 1.0))
            .unwrap();
    }
    model
}

/// Frequency k of a chain of unit masses, one end held by a unit spring.
fn chain_frequency(k: usize, length: usize) -> f64 {
    2.0 * (std::f64::consts::PI * (2 * k + 1) as f64 / (4 * length + 2) as f64).sin()
}

#[test]
fn modes_of_a_large_structure_are_found_among_the_lowest() {
    let length = 300;
    let model = chains(1, length);
    for choice in [
        ModeChoice::Index(4),
        ModeChoice::Near(1.001 * chain_frequency(4, length)),
    ] {
        let mode = model.start_mode(choice).unwrap();
        assert_eq!((mode.index, mode.multiple), (4, Multiple::Single));
        assert!((mode.omega / chain_frequency(4, length) - 1.0).abs() < 1e-12);
        assert!(mode.stuck.len() >= 6 && mode.stuck.len() < 40 && mode.free.len() == mode.stuck.len());
        assert!(mode.free[0] < 1e-5);
    }
    // Beyond the first search, and beyond what Lanczos iteration is used for.
    for k in [30, 200, 299] {
        let wanted = chain_frequency(k, length);
        assert_eq!(model.start_mode(ModeChoice::Near(wanted)).unwrap().index, k);
        let mode = model.start_mode(ModeChoice::Index(k)).unwrap();
        assert!((mode.omega / wanted - 1.0).abs() < 1e-12);
    }
    let twelfth = model.start_mode(ModeChoice::Index(12)).unwrap();
    assert_eq!(model.start_mode(ModeChoice::Shape(&twelfth.shape)).unwrap().index, 12);
    // A pair is seen whole wherever it lies.
    let pair = chains(2, length);
    for k in 0..6 {
        let mode = pair.start_mode(ModeChoice::Index(k)).unwrap();
        assert_eq!((mode.index, mode.multiplicity), (k, 2));
        assert_eq!(mode.multiple, Multiple::TravellingWave);
        assert!((mode.omega / chain_frequency(k / 2, length) - 1.0).abs() < 1e-12);
    }
    let triple = chains(3, length).start_mode(ModeChoice::Index(1)).unwrap();
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
        let mode = model.start_mode(ModeChoice::Index(k)).unwrap();
        let expected = (1.0 / 50.0_f64 / 2.0).sqrt() * chain_frequency(k, 5);
        assert!((mode.omega / expected - 1.0).abs() < 1e-11, "{} {expected}", mode.omega);
    }
    refused(
        model.start_mode(ModeChoice::Index(5)),
        Status::Index,
        &["mode_index = 5, needs 0 .. 4"],
    );
}

#[test]
fn damped_modes_of_a_long_chain_keep_their_digits() {
    for length in [300, 1500] {
        let mut model = chains(1, length);
        let alpha = 1e-4;
        model.set_rayleigh(alpha, 0.0).unwrap();
        for k in [0, 3] {
            let start = model.start_mode(ModeChoice::Index(k)).unwrap();
            let mode = model.damped_mode(&start, DampingForm::Mass).unwrap();
            let (w, d) = (chain_frequency(k, length), alpha / 2.0 / chain_frequency(k, length));
            assert!((start.omega / w - 1.0).abs() < 1e-14);
            assert!((mode.omega / w - 1.0).abs() < 1e-12);
            assert!((mode.damping / d - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn modes_that_cannot_be_had_are_refused_by_name() {
    let model = sector(2);
    let start = |model: &Model, choice| model.start_mode(choice);
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
        &["mode_frequency"],
    );
    refused(
        start(&model, ModeChoice::Near(0.0)),
        Status::Argument,
        &["mode_frequency = 0"],
    );
    let zero = [Complex64::ZERO; NDOF];
    refused(
        start(&model, ModeChoice::Shape(&zero)),
        Status::Argument,
        &["mode_shape is zero"],
    );
    refused(
        start(&model, ModeChoice::Shape(&zero[1..])),
        Status::Dimension,
        &["mode_shape has 3", "ndof = 4"],
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
                model.start_mode(choice),
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
            model.start_mode(ModeChoice::Index(0)),
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
            model.start_mode(ModeChoice::Index(0)),
            Status::NotHermitian,
            &["stiffness[1,0]"],
        );
    }
}

/// Dense matrix of the fundamental.
fn dense(model: &Model, which: MatrixKind) -> DMatrix<Complex64> {
    let n = model.ndof();
    let mut d = DMatrix::zeros(n, n);
    model
        .structure()
        .wave_matrix(which, 1)
        .unwrap()
        .add_to_dense(Complex64::ONE, d.as_mut_slice());
    d
}

/// ω, D and shape by Newton's method on real unknowns, in the whole of K, C, M.
fn independent(model: &Model, start: &StartMode, form: DampingForm) -> (f64, f64, DVector<Complex64>) {
    let n = model.ndof();
    let i = Complex64::I;
    let (m, c, own) = (
        dense(model, MatrixKind::Mass),
        dense(model, MatrixKind::Damping),
        dense(model, MatrixKind::Stiffness),
    );
    let mut k = DMatrix::zeros(n, n);
    model
        .sprung_stiffness(Wave::Harmonic(1), model.contacts().iter())
        .unwrap()
        .add_to_dense(Complex64::ONE, k.as_mut_slice());
    let v = &m * DVector::from_column_slice(&start.shape);
    let (mut x, mut w, mut d) = (DVector::from_column_slice(&start.shape), start.omega, 0.0);
    for _ in 0..50 {
        let (a, aw, ad) = match form {
            DampingForm::Mass => (
                &k + &c * (i * w) - &m * (w * w * (1.0 + 2.0 * i * d)),
                &c * i - &m * (2.0 * w * (1.0 + 2.0 * i * d)),
                &m * (-2.0 * i * w * w),
            ),
            DampingForm::Stiffness => (
                &k - &own * (2.0 * i * d) + &c * (i * w) - &m * Complex64::from(w * w),
                &c * i - &m * Complex64::from(2.0 * w),
                &own * (-2.0 * i),
            ),
        };
        let mut system = DMatrix::<f64>::zeros(2 * n + 2, 2 * n + 2);
        let mut right = DVector::<f64>::zeros(2 * n + 2);
        let (r, rw, rd) = (&a * &x, &aw * &x, &ad * &x);
        for p in 0..n {
            for q in 0..n {
                let z = a[(p, q)];
                system[(p, q)] = z.re;
                system[(p, n + q)] = -z.im;
                system[(n + p, q)] = z.im;
                system[(n + p, n + q)] = z.re;
            }
            for (column, z) in [(2 * n, rw[p]), (2 * n + 1, rd[p])] {
                system[(p, column)] = z.re;
                system[(n + p, column)] = z.im;
            }
            (right[p], right[n + p]) = (-r[p].re, -r[p].im);
            // vᴴ dx = 0
            let z = v[p].conj();
            system[(2 * n, p)] = z.re;
            system[(2 * n, n + p)] = -z.im;
            system[(2 * n + 1, p)] = z.im;
            system[(2 * n + 1, n + p)] = z.re;
        }
        let step = system.lu().solve(&right).unwrap();
        for p in 0..n {
            x[p] += Complex64::new(step[p], step[n + p]);
        }
        w += step[2 * n];
        d += step[2 * n + 1];
    }
    let norm = x.dotc(&(&m * &x)).re.sqrt();
    (w, d, x / Complex64::from(norm))
}

const FORMS: [DampingForm; 2] = [DampingForm::Mass, DampingForm::Stiffness];

fn agrees(mode: &DampedMode, expected: &(f64, f64, DVector<Complex64>)) {
    let (omega, damping, shape) = expected;
    assert!((mode.omega / omega - 1.0).abs() < 1e-12, "{} {omega}", mode.omega);
    assert!(
        (mode.damping / damping - 1.0).abs() < 1e-12,
        "{} {damping}",
        mode.damping
    );
    assert!(gap(&mode.shape, shape.as_slice()) < 1e-11);
}

#[test]
fn damped_modes_of_the_sector_agree_with_an_independent_solution() {
    // Rayleigh damping leaves the contacts out, so that it is not proportional in the stuck
    // structure. 1e-4 s damps the third family by a half.
    for beta in [common::BETA, 1e-4] {
        for mut model in [sector(2), skewed(3), skewed(21)] {
            model.set_rayleigh(2.0, beta).unwrap();
            for family in 0..3 {
                let start = model.start_mode(ModeChoice::Index(family)).unwrap();
                for form in FORMS {
                    let mode = model.damped_mode(&start, form).unwrap();
                    assert!(mode.damping > 0.0);
                    agrees(&mode, &independent(&model, &start, form));
                    assert!((mass_product(&model, &mode.shape, &mode.shape).re - 1.0).abs() < 1e-14);
                }
            }
        }
    }
}

/// Two masses, K and C given.
fn two(stiffness: [f64; 4], damping: [f64; 4]) -> Model {
    let mut model = Model::new(2).unwrap();
    for (which, a) in [
        (MatrixKind::Mass, [2.0, 0.3, 0.3, 1.0]),
        (MatrixKind::Stiffness, stiffness),
        (MatrixKind::Damping, damping),
    ] {
        model
            .set_matrix(
                which,
                &MatrixView::dense(2, &a).part(if which == MatrixKind::Mass {
                    Part::Full
                } else {
                    Part::General
                }),
            )
            .unwrap();
    }
    model
}

#[test]
fn proportional_damping_has_its_closed_form() {
    let (k, beta, alpha) = ([7.0, -2.0, -2.0, 3.0], 0.03, 0.4);
    // C = βK of the stuck structure, the contact among it: frequency and shape stay, D = βω/2.
    let mut stuck = two(k, [k[0] * beta + 1.5 * beta, -2.0 * beta, -2.0 * beta, 3.0 * beta]);
    stuck.add_contact(&Contact::jenkins(0, None, 1.5, 0.2, 1.0)).unwrap();
    // C = αM: D = α/(2ω).
    let mut heavy = stuck.try_clone().unwrap();
    heavy
        .set_matrix(MatrixKind::Damping, &MatrixView::dense(2, &[0.0; 4]))
        .unwrap();
    heavy.set_rayleigh(alpha, 0.0).unwrap();
    // C = βK without contact, artificial damping of the stiffness type: D = βω/2.
    let mut own = two(k, [0.0; 4]);
    own.set_rayleigh(0.0, beta).unwrap();
    for index in 0..2 {
        for (model, form) in [
            (&stuck, DampingForm::Mass),
            (&heavy, DampingForm::Mass),
            (&own, DampingForm::Mass),
            (&own, DampingForm::Stiffness),
        ] {
            let start = model.start_mode(ModeChoice::Index(index)).unwrap();
            let mode = model.damped_mode(&start, form).unwrap();
            let expected = if core::ptr::eq(model, &raw const heavy) {
                alpha / (2.0 * start.omega)
            } else {
                beta * start.omega / 2.0
            };
            assert!((mode.omega / start.omega - 1.0).abs() < 1e-13);
            assert!((mode.damping / expected - 1.0).abs() < 1e-13);
            assert!(gap(&mode.shape, &start.shape) < 1e-12);
        }
    }
}

#[test]
fn strong_and_gyroscopic_damping_agree_with_an_independent_solution() {
    let k = [7.0, -2.0, -2.0, 3.0];
    for damping in [
        [0.9, -0.1, -0.1, 0.05],
        // Gyroscopic forces take no energy: D = 0, the frequencies part.
        [0.0, 0.5, -0.5, 0.0],
        [0.3, 0.5, -0.4, -0.2],
    ] {
        let model = two(k, damping);
        for index in 0..2 {
            let start = model.start_mode(ModeChoice::Index(index)).unwrap();
            for form in FORMS {
                let mode = model.damped_mode(&start, form).unwrap();
                let expected = independent(&model, &start, form);
                if damping[0] == 0.0 {
                    assert!(mode.damping.abs() < 1e-15);
                    assert!((mode.omega / expected.0 - 1.0).abs() < 1e-14);
                    assert!((mode.omega / start.omega - 1.0).abs() > 1e-3);
                } else {
                    agrees(&mode, &expected);
                }
            }
        }
    }
}

#[test]
fn without_damping_the_start_mode_is_returned_as_it_is() {
    let mut model = skewed(2);
    model.set_rayleigh(0.0, 0.0).unwrap();
    for form in FORMS {
        let start = model.start_mode(ModeChoice::Index(1)).unwrap();
        let mode = model.damped_mode(&start, form).unwrap();
        assert!(mode.damping == 0.0 && mode.omega == start.omega && mode.shape == start.shape);
    }
}

#[test]
fn the_damped_wheel_keeps_the_wave_that_it_started_from() {
    let wheel = BASE.wheel();
    for form in FORMS {
        let one = sector(2);
        let start = one.start_mode(ModeChoice::Index(1)).unwrap();
        let of_sector = one.damped_mode(&start, form).unwrap();
        let pair = wheel.start_mode(ModeChoice::Near(start.omega)).unwrap();
        for (member, sense) in [(0, 2.0), (1, -2.0)] {
            let start = wheel.start_mode(ModeChoice::Index(pair.index + member)).unwrap();
            let mode = wheel.damped_mode(&start, form).unwrap();
            assert!((mode.omega / of_sector.omega - 1.0).abs() < 1e-12);
            assert!((mode.damping / of_sector.damping - 1.0).abs() < 1e-10);
            assert_wave(&mode.shape, sense);
        }
        let standing: Vec<_> = pair.shape.iter().map(|z| z.re.into()).collect();
        let start = wheel.start_mode(ModeChoice::Shape(&standing)).unwrap();
        let mode = wheel.damped_mode(&start, form).unwrap();
        let tilted = largest(&mode.shape.iter().map(|z| z.im.into()).collect::<Vec<_>>());
        // The damping turns the phase within a sector, the wheel stays in a standing wave.
        assert!(tilted < 1e-2 * largest(&mode.shape));
        assert!((mass_product(&wheel, &start.shape, &mode.shape).norm() - 1.0).abs() < 1e-4);
    }
}

#[test]
fn a_pair_that_damping_parts_is_left_for_one_of_its_modes() {
    // Two equal oscillators, one of them damped: no mixture of them is a mode.
    let mut model = Model::new(2).unwrap();
    for (which, a) in [
        (MatrixKind::Mass, [1.0, 0.0, 0.0, 1.0]),
        (MatrixKind::Stiffness, [4.0, 0.0, 0.0, 4.0]),
        (MatrixKind::Damping, [0.08, 0.0, 0.0, 0.02]),
    ] {
        model.set_matrix(which, &MatrixView::dense(2, &a)).unwrap();
    }
    let shape = [Complex64::ONE, Complex64::from(0.4)];
    let start = model.start_mode(ModeChoice::Shape(&shape)).unwrap();
    let mode = model.damped_mode(&start, DampingForm::Mass).unwrap();
    assert!((mode.omega - 2.0).abs() < 1e-12);
    let known = [0.02, 0.005];
    assert!(
        known.iter().any(|d| (mode.damping / d - 1.0).abs() < 1e-10),
        "{}",
        mode.damping
    );
}

#[test]
fn damped_modes_that_do_not_exist_are_refused() {
    // All stiffness in a spring: nothing for the stiffness type to act on.
    let mut model = Model::new(1).unwrap();
    model
        .set_matrix(MatrixKind::Mass, &MatrixView::dense(1, &[1.0]))
        .unwrap();
    model
        .set_matrix(MatrixKind::Damping, &MatrixView::dense(1, &[0.1]))
        .unwrap();
    model.add_contact(&Contact::jenkins(0, None, 4.0, 0.5, 1.0)).unwrap();
    let start = model.start_mode(ModeChoice::Index(0)).unwrap();
    assert!((model.damped_mode(&start, DampingForm::Mass).unwrap().damping - 0.025).abs() < 1e-14);
    refused(
        model.damped_mode(&start, DampingForm::Stiffness),
        Status::Singular,
        &["stiffness type", "use the mass type"],
    );
    refused(
        sector(2).damped_mode(&start, DampingForm::Mass),
        Status::Dimension,
        &["ndof = 4"],
    );
}

#[test]
fn every_bad_mode_option_is_refused_by_name() {
    let good = ModeOptions {
        log10_start: -6.0,
        log10_stop: 0.0,
        ..ModeOptions::default()
    };
    let zero = [Complex64::ZERO; 4];
    let cases = [
        (
            ModeOptions::default(),
            Status::Argument,
            "amplitude range is empty or reversed: log10_start = 0, log10_stop = 0, needs start < stop",
        ),
        (
            ModeOptions {
                log10_stop: -7.0,
                ..good
            },
            Status::Argument,
            "empty or reversed",
        ),
        (
            ModeOptions {
                log10_start: f64::NAN,
                ..good
            },
            Status::NotFinite,
            "log10_start",
        ),
        (
            ModeOptions {
                log10_stop: f64::INFINITY,
                ..good
            },
            Status::NotFinite,
            "log10_stop",
        ),
        (
            ModeOptions {
                log10_start: -400.0,
                ..good
            },
            Status::Argument,
            "log10_start = -400",
        ),
        (
            ModeOptions {
                at: &[-1.0, 0.5],
                ..good
            },
            Status::Argument,
            "at[1] = 0.5",
        ),
        (
            ModeOptions {
                at: &[f64::NAN],
                ..good
            },
            Status::NotFinite,
            "at[0]",
        ),
        (
            ModeOptions {
                reference_dof: Some(4),
                ..good
            },
            Status::Index,
            "reference_dof = 4, needs 0 .. 3",
        ),
        (
            ModeOptions {
                amplitude: Amplitude::Contact(2),
                ..good
            },
            Status::Index,
            "contact id = 2, but the model has 2 contacts",
        ),
        (
            ModeOptions {
                choice: ModeChoice::Near(-1.0),
                ..good
            },
            Status::Argument,
            "mode_frequency = -1",
        ),
        (
            ModeOptions {
                choice: ModeChoice::Shape(&zero[..3]),
                ..good
            },
            Status::Dimension,
            "mode_shape has 3",
        ),
        (
            ModeOptions {
                choice: ModeChoice::Shape(&zero),
                ..good
            },
            Status::Argument,
            "mode_shape is zero",
        ),
    ];
    for (options, status, words) in cases {
        refused(options.check(4, 2), status, &[words]);
    }
    let all = ModeOptions {
        at: &[-6.0, 0.0],
        reference_dof: Some(3),
        amplitude: Amplitude::Contact(1),
        ..good
    };
    all.check(4, 2).unwrap();
    assert_eq!(all.damping_form, DampingForm::Mass);
}
