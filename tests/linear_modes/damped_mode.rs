//! Linear modes with the structure's damping, kept periodic by artificial damping: against closed
//! forms and an independent solution.

use crate::common::models::{self, Structure};
use crate::common::modes::{assert_wave, chain_frequency, chains, gap, mass_product, sector, skewed};
use crate::common::refusal::refused;
use crate::common::{self, BASE, largest};
use hbvib::internals::DampedMode;
use hbvib::internals::SelectedMode;
use hbvib::internals::Wave;
use hbvib::{Contact, DampingForm, MatrixKind, MatrixView, ModeChoice, Model, Part, Status};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

#[test]
fn damped_modes_of_a_long_chain_keep_their_digits() {
    for length in [300, 1500] {
        let mut model = chains(1, length);
        let alpha = 1e-4;
        model.set_rayleigh(alpha, 0.0).unwrap();
        for k in [0, 3] {
            let start = model.select_mode(ModeChoice::Index(k)).unwrap();
            let mode = model.damped_mode(&start, DampingForm::Mass).unwrap();
            let (w, d) = (chain_frequency(k, length), alpha / 2.0 / chain_frequency(k, length));
            assert!((start.omega / w - 1.0).abs() < 1e-14);
            assert!((mode.omega / w - 1.0).abs() < 1e-12);
            assert!((mode.damping / d - 1.0).abs() < 1e-12);
        }
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
fn independent(model: &Model, start: &SelectedMode, form: DampingForm) -> (f64, f64, DVector<Complex64>) {
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
                let start = model.select_mode(ModeChoice::Index(family)).unwrap();
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
    Structure::plain(2)
        .mass(&[2.0, 0.3, 0.3, 1.0])
        .part(MatrixKind::Stiffness, &stiffness, Part::General)
        .part(MatrixKind::Damping, &damping, Part::General)
        .build()
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
            let start = model.select_mode(ModeChoice::Index(index)).unwrap();
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
            let start = model.select_mode(ModeChoice::Index(index)).unwrap();
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
        let start = model.select_mode(ModeChoice::Index(1)).unwrap();
        let mode = model.damped_mode(&start, form).unwrap();
        assert!(mode.damping == 0.0 && mode.omega.to_bits() == start.omega.to_bits() && mode.shape == start.shape);
    }
}

#[test]
fn the_damped_wheel_keeps_the_wave_that_it_started_from() {
    let full_wheel = BASE.full_wheel();
    for form in FORMS {
        let one = sector(2);
        let start = one.select_mode(ModeChoice::Index(1)).unwrap();
        let of_sector = one.damped_mode(&start, form).unwrap();
        let pair = full_wheel.select_mode(ModeChoice::Near(start.omega)).unwrap();
        for (member, sense) in [(0, 2.0), (1, -2.0)] {
            let start = full_wheel.select_mode(ModeChoice::Index(pair.index + member)).unwrap();
            let mode = full_wheel.damped_mode(&start, form).unwrap();
            assert!((mode.omega / of_sector.omega - 1.0).abs() < 1e-12);
            assert!((mode.damping / of_sector.damping - 1.0).abs() < 1e-10);
            assert_wave(&mode.shape, sense);
        }
        let standing: Vec<_> = pair.shape.iter().map(|z| z.re.into()).collect();
        let start = full_wheel.select_mode(ModeChoice::Shape(&standing)).unwrap();
        let mode = full_wheel.damped_mode(&start, form).unwrap();
        let tilted = largest(&mode.shape.iter().map(|z| z.im.into()).collect::<Vec<_>>());
        // The damping turns the phase within a sector, the wheel stays in a standing wave.
        assert!(tilted < 1e-2 * largest(&mode.shape));
        assert!((mass_product(&full_wheel, &start.shape, &mode.shape).norm() - 1.0).abs() < 1e-4);
    }
}

#[test]
fn a_pair_that_damping_parts_is_left_for_one_of_its_modes() {
    // Two equal oscillators, one of them damped: no mixture of them is a mode.
    let model = models::dense(&[1.0, 0.0, 0.0, 1.0], &[4.0, 0.0, 0.0, 4.0])
        .damping(&[0.08, 0.0, 0.0, 0.02])
        .build();
    let shape = [Complex64::ONE, Complex64::from(0.4)];
    let start = model.select_mode(ModeChoice::Shape(&shape)).unwrap();
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
    let model = Structure::plain(1)
        .mass(&[1.0])
        .damping(&[0.1])
        .slider(0, 4.0, 0.5, 1.0)
        .build();
    let start = model.select_mode(ModeChoice::Index(0)).unwrap();
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
