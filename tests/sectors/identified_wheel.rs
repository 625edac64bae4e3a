//! The pattern of a wheel from its modes: those of the mistuned wheel as a plain model are the measurement.

use crate::common::refusal::refused;
use hbvib::{
    BladeProperty, Contact, ContactState, IdentifiedPattern, Interrupt, LinearContacts, LinearModes, MatrixKind,
    MatrixView, MeasuredModes, Mistuning, Model, Result, Status, wheel_identify,
};
use num_complex::Complex64;

const N: usize = 9;
const DELTA: [f64; N] = [0.012, -0.02, 0.007, 0.001, -0.013, 0.016, -0.004, 0.009, -0.011];

/// Blade and disk, and a ring that sticks to the disk.
fn sector(sectors: usize) -> Model {
    let mut model = Model::cyclic(2, sectors).unwrap();
    let (mass, own, next) = ([1.0, 0.0, 0.0, 2.0], [1.0, -1.0, -1.0, 5.2], [0.0, 0.0, 0.0, -2.0]);
    for (kind, matrix) in [(MatrixKind::Mass, &mass), (MatrixKind::Stiffness, &own)] {
        model.set_matrix(kind, &MatrixView::dense(2, matrix)).unwrap();
    }
    model
        .set_coupling(MatrixKind::Stiffness, &MatrixView::dense(2, &next))
        .unwrap();
    model.set_wave(2);
    model.add_contact(&Contact::jenkins(1, None, 0.5, 0.3, 0.1)).unwrap();
    model
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
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        let (u, v) = (self.uniform(), self.uniform());
        (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
    }
}

/// In 300 measurements with noise, 95 % of the errors lie within 1.96 standard deviations, errors over their covariance have the
/// mean N of chi-squared, and so have the residuals the mean of their degrees of freedom.
#[test]
fn the_covariance_is_that_of_repeated_measurements() {
    const DRAWS: usize = 300;
    let sector = sector(N);
    let what = Mistuning::Blade(BladeProperty::Stiffness, &[0]);
    let data = exact(&sector, &what, &DELTA);
    let mut noise = Deviates(7);
    let (mut inside, mut distance, mut residual, mut sum) = (0, 0.0, 0.0, [0.0; N]);
    for _ in 0..DRAWS {
        let mut drawn = Noise {
            omega: data.omega.iter().map(|w| w * (1.0 + 1e-4 * noise.normal())).collect(),
            sigma_omega: data.omega.iter().map(|w| w * 1e-4).collect(),
            shapes: data.shapes.clone(),
            sigma_shape: vec![5e-3; N],
        };
        for z in &mut drawn.shapes {
            *z += Complex64::new(noise.normal(), noise.normal()) * 5e-3;
        }
        let found = drawn.identified(&sector, &what, 2).unwrap();
        residual += found.chi2 / found.degrees as f64 / DRAWS as f64;
        // Errors in units of their covariance C = L Lᵀ.
        let mut l = found.covariance.clone();
        let error: Vec<f64> = found.delta.iter().zip(&DELTA).map(|(a, b)| a - b).collect();
        inside += (0..N)
            .filter(|&s| error[s].abs() < 1.96 * l[(N + 1) * s].sqrt())
            .count();
        (0..N).for_each(|s| sum[s] += error[s] / l[(N + 1) * s].sqrt());
        let mut z = error;
        for j in 0..N {
            for k in 0..j {
                for i in j..N {
                    l[i * N + j] -= l[i * N + k] * l[j * N + k];
                }
            }
            let root = l[j * N + j].sqrt();
            (j..N).for_each(|i| l[i * N + j] /= root);
            z[j] = (z[j] - (0..j).map(|k| l[j * N + k] * z[k]).sum::<f64>()) / root;
        }
        distance += z.iter().map(|z| z * z).sum::<f64>() / (N * DRAWS) as f64;
    }
    let coverage = inside as f64 / (N * DRAWS) as f64;
    let bias = sum.iter().fold(0.0_f64, |m, s| m.max(s.abs())) / (DRAWS as f64).sqrt();
    println!("within {coverage:.3}, distance {distance:.3}, chi2 {residual:.3} of its degrees, bias {bias:.2}");
    // Standard errors: 0.008 with errors that hang together, 0.03, 0.01; a bias of 4 is that of one in a thousand.
    assert!((coverage - 0.95).abs() < 0.02 && (distance - 1.0).abs() < 0.1);
    assert!((residual - 1.0).abs() < 0.05 && bias < 4.0);
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
