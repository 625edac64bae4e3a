//! The pattern of a wheel from its modes: those of the mistuned wheel as a plain model are the measurement.

use crate::common::models::Structure;
use crate::common::random;
use crate::common::refusal::refused;
use hbvib::{
    BladeProperty, ContactState, IdentifiedPattern, Interrupt, LinearContacts, LinearModes, MatrixKind, MatrixView,
    MeasuredModes, Mistuning, Model, Result, Status, wheel_identify,
};
use num_complex::Complex64;

const N: usize = 9;
const DELTA: [f64; N] = [0.012, -0.02, 0.007, 0.001, -0.013, 0.016, -0.004, 0.009, -0.011];

/// Blade and disk, and a ring that sticks to the disk.
fn sector(sectors: usize) -> Model {
    let (mass, own, next) = ([1.0, 0.0, 0.0, 2.0], [1.0, -1.0, -1.0, 5.2], [0.0, 0.0, 0.0, -2.0]);
    Structure::cyclic(2, sectors)
        .mass(&mass)
        .stiffness(&own)
        .next(MatrixKind::Stiffness, &next)
        .wave(2)
        .slider(1, 0.5, 0.3, 0.1)
        .build()
}

/// The modes of the mistuned wheel.
fn modes(sector: &Model, what: &Mistuning<'_>, delta: &[f64]) -> LinearModes {
    let mut wheel = sector.wheel().unwrap();
    wheel.mistune(sector, what, delta).unwrap();
    wheel.linear_modes(0, ContactState::Stuck).unwrap()
}

/// Tips of the blades in the lowest modes.
fn tips(modes: &LinearModes, count: usize) -> Vec<Complex64> {
    let sectors = modes.omega.len() / 2;
    let of_mode = |k: usize| (0..sectors).map(move |s| modes.shapes[2 * sectors * k + 2 * s]);
    (0..count).flat_map(of_mode).collect()
}

struct Noise {
    omega: Vec<f64>,
    sigma_omega: Vec<f64>,
    shapes: Vec<Complex64>,
    sigma_shape: Vec<f64>,
}

impl Noise {
    fn identified(&self, sector: &Model, what: &Mistuning<'_>, families: usize) -> Result<IdentifiedPattern> {
        let measured = MeasuredModes {
            points: &[0],
            omega: &self.omega,
            sigma_omega: &self.sigma_omega,
            shapes: &self.shapes,
            sigma_shape: &self.sigma_shape,
        };
        let by = (LinearContacts::Stuck, families);
        wheel_identify(sector, what, &measured, by, &Interrupt::none())
    }
}

/// The lowest family without noise.
fn exact(sector: &Model, what: &Mistuning<'_>, delta: &[f64]) -> Noise {
    let found = modes(sector, what, delta);
    let count = delta.len();
    Noise {
        omega: found.omega[..count].to_vec(),
        sigma_omega: vec![1e-4; count],
        shapes: tips(&found, count),
        sigma_shape: vec![1e-3; count],
    }
}

fn gap(found: &[f64], expected: &[f64]) -> f64 {
    let gaps = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    gaps.fold(0.0, f64::max)
}

#[test]
fn modes_of_a_wheel_without_noise_have_its_pattern() {
    for sectors in [N, N - 1] {
        let sector = sector(sectors);
        let delta = &DELTA[..sectors];
        let dofs = [0];
        let direction = [1.0, -1.0, -1.0, 1.0];
        let matrix = MatrixView::dense(2, &direction);
        for what in [
            Mistuning::Blade(BladeProperty::Stiffness, &dofs),
            Mistuning::Blade(BladeProperty::Frequency, &dofs),
            Mistuning::Blade(BladeProperty::Mass, &dofs),
            Mistuning::Matrix(MatrixKind::Stiffness, &matrix),
        ] {
            let found = exact(&sector, &what, delta).identified(&sector, &what, 2).unwrap();
            let gap = gap(&found.delta, delta);
            println!("{what:?}: {gap:.1e} in {} steps, chi2 {:.1e}", found.steps, found.chi2);
            assert!(gap < 1e-10 && found.chi2 < 1e-10);
            assert_eq!(found.degrees, sectors * sectors - sectors);
        }
    }
}

/// The tuned wheel has pairs of modes of one frequency, of which any mixture is a mode.
#[test]
fn modes_of_a_tuned_wheel_have_no_pattern() {
    let sector = sector(N);
    let what = Mistuning::Blade(BladeProperty::Stiffness, &[0]);
    let found = exact(&sector, &what, &[0.0; N]).identified(&sector, &what, 2).unwrap();
    println!("{:.1e} in {} steps", gap(&found.delta, &[0.0; N]), found.steps);
    assert!(gap(&found.delta, &[0.0; N]) < 1e-10);
    assert!((0..N).all(|s| found.covariance[(N + 1) * s] > 1e-14));
}

/// Scale and phase of a shape are arbitrary, one mode is enough, and with a basis of one family something is left out.
#[test]
fn shapes_have_any_scale_and_phase_and_few_modes_are_enough() {
    let sector = sector(N);
    let what = Mistuning::Blade(BladeProperty::Stiffness, &[0]);
    let mut data = exact(&sector, &what, &DELTA);
    for (k, of_mode) in data.shapes.chunks_exact_mut(N).enumerate() {
        let factor = Complex64::from_polar(3.0 + k as f64, 1.0 + k as f64);
        of_mode.iter_mut().for_each(|z| *z *= factor);
        data.sigma_shape[k] *= 3.0 + k as f64;
    }
    let all = data.identified(&sector, &what, 2).unwrap();
    assert!(gap(&all.delta, &DELTA) < 1e-10);
    let narrow = data.identified(&sector, &what, 1).unwrap();
    println!("one family: {:.1e}", gap(&narrow.delta, &DELTA));
    assert!(gap(&narrow.delta, &DELTA) > 1e-7 && gap(&narrow.delta, &DELTA) < 0.2 * 0.02);
    let few = Noise {
        omega: data.omega[2..4].to_vec(),
        sigma_omega: data.sigma_omega[2..4].to_vec(),
        shapes: data.shapes[2 * N..4 * N].to_vec(),
        sigma_shape: data.sigma_shape[2..4].to_vec(),
    };
    let found = few.identified(&sector, &what, 2).unwrap();
    assert!(gap(&found.delta, &DELTA) < 1e-8);
    assert!((0..N).all(|s| found.covariance[(N + 1) * s] > all.covariance[(N + 1) * s]));
}

/// Normal deviates of a stated sequence.
struct Deviates(u64);

impl Deviates {
    fn uniform(&mut self) -> f64 {
        random::unit(&mut self.0) + 0.5 / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        let (u, v) = (self.uniform(), self.uniform());
        (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
    }
}

/// Errors of repeated identifications.
struct Scatter {
    /// Share of the errors within 1.96 standard deviations.
    coverage: f64,
    /// Mean of errors over their covariance, eᵀC⁻¹e, over the number of blades.
    distance: f64,
    /// Mean of χ² over its degrees of freedom.
    residual: f64,
    /// Mean error of a blade over its standard error, the largest.
    bias: f64,
}

/// Measurements of some modes of the lowest family, with the relative noise `omega` of frequencies and `shape` of each part of a shape.
struct Measurement<'a> {
    delta: &'a [f64],
    modes: core::ops::Range<usize>,
    omega: f64,
    shape: f64,
    is_real: bool,
}

/// eᵀC⁻¹e by Cholesky's factor of C.
fn distance(mut l: Vec<f64>, mut z: Vec<f64>) -> f64 {
    let n = z.len();
    for j in 0..n {
        for k in 0..j {
            for i in j..n {
                l[i * n + j] -= l[i * n + k] * l[j * n + k];
            }
        }
        let root = l[j * n + j].sqrt();
        (j..n).for_each(|i| l[i * n + j] /= root);
        z[j] = (z[j] - (0..j).map(|k| l[j * n + k] * z[k]).sum::<f64>()) / root;
    }
    z.iter().map(|z| z * z).sum()
}

fn scatter(draws: usize, of: &Measurement<'_>) -> Scatter {
    let n = of.delta.len();
    let sector = sector(n);
    let what = Mistuning::Blade(BladeProperty::Stiffness, &[0]);
    let data = exact(&sector, &what, of.delta);
    let omega = &data.omega[of.modes.clone()];
    let shapes = &data.shapes[n * of.modes.start..n * of.modes.end];
    let mut noise = Deviates(7);
    let share = 1.0 / (n * draws) as f64;
    let (mut sum, mut inside) = (vec![0.0; n], 0);
    let mut found_all = Scatter {
        coverage: 0.0,
        distance: 0.0,
        residual: 0.0,
        bias: 0.0,
    };
    for _ in 0..draws {
        let mut drawn = Noise {
            omega: omega.iter().map(|w| w * (1.0 + of.omega * noise.normal())).collect(),
            sigma_omega: omega.iter().map(|w| w * of.omega).collect(),
            shapes: shapes.to_vec(),
            sigma_shape: vec![of.shape; omega.len()],
        };
        for z in &mut drawn.shapes {
            let (re, im) = (noise.normal(), if of.is_real { 0.0 } else { noise.normal() });
            *z += Complex64::new(re, im) * of.shape;
        }
        let found = drawn.identified(&sector, &what, 2).unwrap();
        found_all.residual += found.chi2 / found.degrees as f64 / draws as f64;
        let error: Vec<f64> = found.delta.iter().zip(of.delta).map(|(a, b)| a - b).collect();
        for s in 0..n {
            let z = error[s] / found.covariance[(n + 1) * s].sqrt();
            inside += usize::from(z.abs() < 1.96);
            sum[s] += z;
        }
        found_all.distance += share * distance(found.covariance, error);
    }
    found_all.coverage = inside as f64 * share;
    found_all.bias = sum.iter().fold(0.0_f64, |m, s| m.max(s.abs())) / (draws as f64).sqrt();
    println!(
        "within {:.3}, distance {:.3}, chi2 {:.3} of its degrees, bias {:.2}",
        found_all.coverage, found_all.distance, found_all.residual, found_all.bias
    );
    found_all
}

/// In 300 measurements with noise, 95 % of the errors lie within 1.96 standard deviations, errors over their covariance have the
/// mean N of chi-squared, and so have the residuals the mean of their degrees of freedom.
#[test]
fn the_covariance_is_that_of_repeated_measurements() {
    let found = scatter(
        300,
        &Measurement {
            delta: &DELTA,
            modes: 0..N,
            omega: 1e-4,
            shape: 5e-3,
            is_real: false,
        },
    );
    // Standard errors: 0.008 with errors that hang together, 0.03, 0.01; a bias of 4 is that of one in a thousand.
    assert!((found.coverage - 0.95).abs() < 0.02 && (found.distance - 1.0).abs() < 0.1);
    assert!((found.residual - 1.0).abs() < 0.05 && found.bias < 4.0);
}

/// A pattern of 24 blades whose frequencies are closer than the deviations of the measured ones, the closest a tenth of them.
fn close_pattern() -> Vec<f64> {
    let mut noise = Deviates(3);
    (0..24).map(|_| 3e-3 * noise.normal()).collect()
}

/// Measurements of 24 blades with a relative noise of frequencies.
fn of_24(draws: usize, (delta, omega): (&[f64], f64), is_real: bool) -> Scatter {
    let measurement = Measurement {
        delta,
        modes: 0..24,
        omega,
        shape: 5e-3,
        is_real,
    };
    scatter(draws, &measurement)
}

/// With noise of the size of the conditions alone the joint covariance would be too large by a half, χ² of the errors 0.7 of N.
#[test]
fn frequencies_closer_than_their_deviations_have_the_joint_covariance_of_their_errors() {
    let draws = 24;
    let found = of_24(draws, (&close_pattern(), 1e-3), false);
    // Four standard errors of a mean of χ² with 24 degrees of freedom; the coverage of errors that hang together.
    assert!((found.distance - 1.0).abs() < 4.0 * (2.0 / (24 * draws) as f64).sqrt());
    assert!((found.coverage - 0.95).abs() < 0.06 && (found.residual - 1.0).abs() < 0.04);
}

#[test]
#[ignore = "takes half a minute"]
fn two_hundred_measurements_of_24_blades_have_their_joint_covariance() {
    let draws = 200;
    let close = close_pattern();
    let apart: Vec<f64> = close.iter().map(|delta| 3.0 * delta).collect();
    let error = (2.0 / (24 * draws) as f64).sqrt();
    for is_real in [false, true] {
        let found = of_24(draws, (&apart, 1e-4), is_real);
        assert!((found.distance - 1.0).abs() < 4.0 * error && (found.residual - 1.0).abs() < 0.02);
        // Closer frequencies leave terms of second order: deviations are told to 5 %.
        let found = of_24(draws, (&close, 1e-3), is_real);
        assert!((found.distance.sqrt() - 1.0).abs() < 0.05 && (found.residual - 1.0).abs() < 0.02);
    }
}

/// Three modes, two of which lie as close as their deviations: what one would tell of the coupling of both is lost in their noise.
#[test]
fn two_close_modes_do_not_tell_more_than_they_know() {
    let found = scatter(
        100,
        &Measurement {
            delta: &DELTA,
            modes: 0..3,
            omega: 1e-4,
            shape: 5e-3,
            is_real: false,
        },
    );
    assert!(found.distance < 2.0 && (found.coverage - 0.95).abs() < 0.05);
}

#[test]
fn measurements_that_cannot_be_are_refused() {
    let sector = sector(N);
    let blade = Mistuning::Blade(BladeProperty::Stiffness, &[0]);
    let data = || exact(&sector, &blade, &DELTA);
    let of = |what: &Mistuning<'_>, data: &Noise, families| data.identified(&sector, what, families);
    let damping = Mistuning::Blade(BladeProperty::Damping, &[0]);
    refused(
        of(&damping, &data(), 2),
        Status::Unsupported,
        &["stiffness, frequency or mass"],
    );
    refused(
        of(&Mistuning::Force, &data(), 2),
        Status::Unsupported,
        &["loads and forces"],
    );
    refused(of(&blade, &data(), 3), Status::Argument, &["families = 3", "1 .. 2"]);
    let mut wrong = data();
    wrong.sigma_omega[2] = 0.0;
    refused(
        of(&blade, &wrong, 2),
        Status::Argument,
        &["sigma_omega[2] = 0", "above 0"],
    );
    let mut wrong = data();
    wrong.shapes.truncate(5);
    refused(of(&blade, &wrong, 2), Status::Dimension, &["5 numbers of shapes", "81"]);
    let mut wrong = data();
    wrong.shapes[N..2 * N].fill(Complex64::ZERO);
    refused(of(&blade, &wrong, 2), Status::Argument, &["mode 1 is zero"]);
    let plain = Model::new(2).unwrap();
    refused(data().identified(&plain, &blade, 2), Status::Dimension, &["needs 9"]);
}
