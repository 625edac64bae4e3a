//! A plate of 3,060 degrees of freedom on a basis: points by factors, a sweep with a tolerance, and how little is computed.

use crate::common::depth::some_of;
use crate::common::{all_harmonics, harmonics, sweep};
use crate::plate::Plate;
use hbvib::{ContactState, Flexibility, Model, SolverOptions};
use num_complex::Complex64;

const PLATE: [usize; 3] = [20, 16, 2];

fn plate() -> (Plate, Model, f64) {
    of_thickness(0.02)
}

fn of_thickness(thickness: f64) -> (Plate, Model, f64) {
    let mut plate = Plate::new(PLATE);
    plate.size[2] = thickness;
    let model = plate.with_sliders(8, 2e5, 0.05).unwrap();
    let omega = model.lowest_modes(0, ContactState::Stuck, 1).unwrap().omega[0];
    (plate, model, omega)
}

fn options(plate: &Plate, flexibility: Flexibility) -> SolverOptions {
    SolverOptions {
        response_dof: Some(plate.corner()),
        flexibility,
        ..harmonics(3)
    }
}

#[test]
fn all_degrees_of_freedom_agree_with_direct_factors_within_the_limit_of_the_certificate() {
    let (plate, model, omega) = plate();
    for at in [0.8 * omega, 1.02 * omega] {
        let reduced = sweep(&model, &options(&plate, Flexibility::Automatic), at, at, &[]);
        let direct = sweep(&model, &options(&plate, Flexibility::Direct), at, at, &[]);
        let reduction = reduced.reduction();
        assert!(reduction.basis > 0 && reduction.basis < 150, "{}", reduction.basis);
        assert!(reduction.certificate > 0.0 && reduction.certificate < 1e-8);
        let (x, exact) = (all_harmonics(&reduced, 0), all_harmonics(&direct, 0));
        let size = |x: &mut dyn Iterator<Item = Complex64>| x.map(|z| z.norm_sqr()).sum::<f64>().sqrt();
        let off = size(&mut x.iter().zip(&exact).map(|(a, b)| a - b)) / size(&mut exact.iter().copied());
        println!(
            "{at:.3} rad/s: certificate {:.1e}, true {off:.1e}",
            reduction.certificate
        );
        assert!(off < 1e-8, "{off:e}");
        let (e, f) = (reduced.energy_at(0).unwrap(), direct.energy_at(0).unwrap());
        assert!((e.potential_peak / f.potential_peak - 1.0).abs() < 1e-7);
        assert!((e.kinetic_peak / f.kinetic_peak - 1.0).abs() < 1e-7);
        assert!((e.friction_loss / f.friction_loss - 1.0).abs() < 1e-6);
        let history = (
            reduced.time_history(0, plate.corner(), 16).unwrap(),
            direct.time_history(0, plate.corner(), 16).unwrap(),
        );
        let largest = history.1.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        assert!(
            history
                .0
                .iter()
                .zip(&history.1)
                .all(|(a, b)| (a - b).abs() < 1e-8 * largest)
        );
    }
}

/// K and M of a plate by their lower triangles.
struct Matrices {
    offsets: Vec<i64>,
    rows: Vec<i64>,
    values: [Vec<f64>; 2],
}

impl Matrices {
    /// K x or M x, summed in twice the precision: each product is two numbers, and so is the sum.
    fn times(&self, which: usize, x: &[Complex64]) -> Vec<Complex64> {
        let mut sums = vec![[0.0; 4]; x.len()];
        let add = |sum: &mut [f64; 4], a: f64, z: Complex64| {
            for (part, b) in [(0, z.re), (2, z.im)] {
                let product = a * b;
                let new = sum[part] + product;
                let taken = new - sum[part];
                sum[part + 1] += a.mul_add(b, -product) + (sum[part] - (new - taken)) + (product - taken);
                sum[part] = new;
            }
        };
        for j in 0..x.len() {
            for p in self.offsets[j] as usize..self.offsets[j + 1] as usize {
                let (i, a) = (self.rows[p] as usize, self.values[which][p]);
                add(&mut sums[i], a, x[j]);
                if i != j {
                    add(&mut sums[j], a, x[i]);
                }
            }
        }
        sums.iter().map(|s| Complex64::new(s[0] + s[1], s[2] + s[3])).collect()
    }
}

fn distance(x: &[Complex64], exact: &[Complex64]) -> f64 {
    let size = |x: &mut dyn Iterator<Item = Complex64>| x.map(|z| z.norm_sqr()).sum::<f64>().sqrt();
    size(&mut x.iter().zip(exact).map(|(a, b)| a - b)) / size(&mut exact.iter().copied())
}

/// With stuck contacts the motion is known to many digits: factors of double precision, refined by residuals of twice that
/// precision. A plate of 2 mm loses six digits in its factors, and none of those that its certificate promises on a basis.
#[test]
fn the_certificate_bounds_the_error_where_rounding_decides() {
    const STICKS: f64 = 1e9;
    const KT: f64 = 2e5;
    for (thickness, shares) in [(0.02, [0.8, 1.02]), (0.002, [1.02, 0.8])] {
        let (plate, _, omega) = of_thickness(thickness);
        let mut model = plate.model(2e-6).unwrap();
        model.add_force(plate.corner(), 1, Complex64::ONE).unwrap();
        model.add_contacts(&plate.sliders(8, KT, STICKS)).unwrap();
        let (offsets, rows, values) = plate.matrices();
        let matrices = Matrices { offsets, rows, values };
        let held = plate.places_of_sliders(8);
        let n = plate.ndof();
        for share in &shares[..some_of(1, 2)] {
            let at = share * omega;
            let linear = |model: &Model, flexibility| {
                let solver = SolverOptions {
                    harmonics: 1,
                    ..options(&plate, flexibility)
                };
                let branch = sweep(model, &solver, at, at, &[]);
                (all_harmonics(&branch, 0)[n..].to_vec(), branch.reduction().certificate)
            };
            let (reduced, certificate) = linear(&model, Flexibility::Automatic);
            let (direct, _) = linear(&model, Flexibility::Direct);
            let mut exact = direct.clone();
            for _ in 0..2 {
                let (k, m) = (matrices.times(0, &exact), matrices.times(1, &exact));
                let mut rest: Vec<Complex64> = (0..n)
                    .map(|i| at * at * m[i] - Complex64::new(1.0, at * 2e-6) * k[i])
                    .collect();
                for &dof in &held {
                    rest[dof] -= KT * exact[dof];
                }
                rest[plate.corner()] += 1.0;
                let mut correction = model.try_clone().unwrap();
                correction.clear_forces();
                for (dof, force) in rest.into_iter().enumerate() {
                    correction.add_force(dof, 1, force).unwrap();
                }
                for (x, dx) in exact.iter_mut().zip(linear(&correction, Flexibility::Direct).0) {
                    *x += dx;
                }
            }
            let (off, of_factors) = (distance(&reduced, &exact), distance(&direct, &exact));
            println!(
                "{thickness} m, {share} of the resonance: certificate {certificate:.1e}, true {off:.1e}, of factors {of_factors:.1e}"
            );
            assert!(off < certificate, "{thickness} m: {off:e} {certificate:e}");
            assert!(certificate < if thickness < 0.01 { 1e-6 } else { 1e-8 });
        }
    }
}

#[test]
fn a_sweep_with_a_tolerance_chooses_its_harmonics_on_the_basis() {
    let (plate, model, omega) = plate();
    let solver = SolverOptions {
        tolerance: 1e-3,
        ..options(&plate, Flexibility::Automatic)
    };
    let branch = sweep(&model, &solver, 0.95 * omega, 1.05 * omega, &[]);
    assert!(branch.status() as i32 == 0, "{:?}", branch.status());
    let reduction = branch.reduction();
    assert!(reduction.basis > 0 && branch.harmonics() >= 3);
    println!(
        "{} points with up to {} harmonics on {} coordinates, certificate {:.1e}",
        branch.points(),
        branch.harmonics(),
        reduction.basis,
        reduction.certificate
    );
    // The same frequency with many harmonics.
    let middle = branch.points() / 2;
    let at = branch.omega()[middle];
    let many = SolverOptions {
        harmonics: 31,
        ..options(&plate, Flexibility::Automatic)
    };
    let exact = sweep(&model, &many, at, at, &[]).amplitude()[0];
    let error = (branch.amplitude()[middle] / exact - 1.0).abs();
    assert!(error < 1e-3, "{error:e}");
}
