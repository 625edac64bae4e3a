//! Loss factor, structural matrix, complex symmetric stiffness and modal damping against closed forms: plain and
//! cyclic, dense and sparse, with and without a contact.

use crate::common::models::{Structure, dense, oscillator};
use crate::common::{harmonics, solve_at, sweep};
use hbvib::{
    Branch, ContactState, Hooks, MatrixKind, MatrixView, Model, Part, Status, Storage, TimeOptions, Values,
    time_response,
};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};

pub const ETA: f64 = 0.05;

/// How damping iD of an equal share η of the stiffness is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    LossFactor,
    Matrix,
    ComplexStiffness,
    LowerTriangle,
    UpperTriangle,
}

pub const FORMS: [Form; 5] = [
    Form::LossFactor,
    Form::Matrix,
    Form::ComplexStiffness,
    Form::LowerTriangle,
    Form::UpperTriangle,
];

/// Passes a matrix dense or as compressed columns.
pub fn set(model: &mut Model, which: MatrixKind, a: &DMatrix<Complex64>, part: Part, sparse: bool) {
    let n = a.nrows();
    if !sparse {
        let view = MatrixView::dense_complex(n, a.as_slice()).part(part);
        return model.set_matrix(which, &view).unwrap();
    }
    let (mut col_ptr, mut row_idx, mut values) = (vec![0], Vec::new(), Vec::new());
    for j in 0..n {
        for i in (0..n).filter(|&i| a[(i, j)] != Complex64::ZERO) {
            row_idx.push(i as i64);
            values.push(a[(i, j)]);
        }
        col_ptr.push(row_idx.len() as i64);
    }
    let view = MatrixView {
        storage: Storage::Csc {
            col_ptr: &col_ptr,
            row_idx: &row_idx,
        },
        values: Values::Complex(&values),
        part,
        ..MatrixView::dense(n, &[])
    };
    model.set_matrix(which, &view).unwrap();
}

/// One triangle, the other full of numbers that nobody may read.
fn triangle(a: &DMatrix<Complex64>, lower: bool) -> DMatrix<Complex64> {
    let garbage = Complex64::new(f64::NAN, 1e9);
    DMatrix::from_fn(a.nrows(), a.ncols(), |i, j| {
        let unread = if lower { i < j } else { i > j };
        if unread { garbage } else { a[(i, j)] }
    })
}

pub fn set_stiffness(model: &mut Model, k: &DMatrix<f64>, form: Form, sparse: bool) {
    let real = k.map(Complex64::from);
    let complex = &real * Complex64::new(1.0, ETA);
    match form {
        Form::LossFactor => {
            set(model, MatrixKind::Stiffness, &real, Part::Full, sparse);
            model.set_loss_factor(ETA).unwrap();
        }
        Form::Matrix => {
            set(model, MatrixKind::Stiffness, &real, Part::Full, sparse);
            set(
                model,
                MatrixKind::Structural,
                &(&real * Complex64::from(ETA)),
                Part::Symmetric,
                sparse,
            );
        }
        Form::ComplexStiffness => set(model, MatrixKind::Stiffness, &complex, Part::Symmetric, sparse),
        Form::LowerTriangle => {
            let given = triangle(&complex, true);
            set(model, MatrixKind::Stiffness, &given, Part::SymmetricLower, sparse);
        }
        Form::UpperTriangle => {
            let given = triangle(&complex, false);
            set(model, MatrixKind::Stiffness, &given, Part::SymmetricUpper, sparse);
        }
    }
}

/// A chain of n uneven masses and springs, held at both ends.
fn chain(n: usize) -> (DMatrix<f64>, DMatrix<f64>) {
    let mass = DMatrix::from_diagonal(&DVector::from_fn(n, |i, _| 1.0 + 0.3 * (i as f64).sin()));
    let mut k = DMatrix::zeros(n, n);
    for i in 0..=n {
        let spring = 2.0 + (1.7 * i as f64).cos();
        if i < n {
            k[(i, i)] += spring;
        }
        if i > 0 {
            k[(i - 1, i - 1)] += spring;
        }
        if i > 0 && i < n {
            k[(i, i - 1)] -= spring;
            k[(i - 1, i)] -= spring;
        }
    }
    (mass, k)
}

fn response(branch: &Branch, harmonic: usize) -> Vec<Complex64> {
    let n = branch.ndof();
    crate::common::all_harmonics(branch, 0)[harmonic * n..(harmonic + 1) * n].to_vec()
}

#[test]
fn a_linear_structure_has_the_response_of_its_complex_stiffness() {
    for n in [1, 2, 5, 150] {
        let (m, k) = chain(n);
        let dynamic = |w: f64| k.map(|k| k * Complex64::new(1.0, ETA)) - m.map(|m| Complex64::from(m * w * w));
        for form in FORMS {
            for sparse in [false, true] {
                let mut model = Model::new(n).unwrap();
                model
                    .set_matrix(MatrixKind::Mass, &MatrixView::dense(n, m.as_slice()))
                    .unwrap();
                set_stiffness(&mut model, &k, form, sparse);
                model.add_force(n - 1, 1, Complex64::new(0.4, -0.7)).unwrap();
                model.add_force(0, 3, 0.5.into()).unwrap();
                model.add_force(0, 0, 0.3.into()).unwrap();
                for omega in [0.31, 0.9] {
                    let branch = solve_at(&model, &harmonics(3), omega);
                    for (h, dof, force) in [(1, n - 1, Complex64::new(0.4, -0.7)), (3, 0, 0.5.into())] {
                        let mut f = DVector::zeros(n);
                        f[dof] = force;
                        let z = dynamic(h as f64 * omega);
                        let x = z.clone().lu().solve(&f).unwrap();
                        let condition = z.norm() * z.try_inverse().unwrap().norm();
                        let gap = (DVector::from_vec(response(&branch, h)) - &x).norm() / x.norm();
                        let allowed = 1e-13_f64.max(1e-15 * condition);
                        assert!(
                            gap < allowed,
                            "{form:?}, n = {n}, harmonic {h}: {gap:e}, condition {condition:e}"
                        );
                    }
                    // The mean sees the real stiffness alone.
                    let mut f = DVector::zeros(n);
                    f[0] = 0.3;
                    let x = k.clone().lu().solve(&f).unwrap().map(Complex64::from);
                    let gap = (DVector::from_vec(response(&branch, 0)) - &x).norm() / x.norm();
                    assert!(gap < 1e-12, "{form:?}, mean: {gap:e}");
                }
            }
        }
    }
}

#[test]
fn a_wheel_has_the_response_of_each_nodal_diameter() {
    let (sectors, m, own, coupling) = (12, 1.3, 2.0, -0.4);
    for diameter in 0..=6_i64 {
        for engine_order in [diameter, -diameter, 12 - diameter] {
            for by_diameters in [false, true] {
                for form in [Form::LossFactor, Form::Matrix] {
                    let mut model = Structure::cyclic(1, sectors).wave(engine_order).mass(&[m]).build();
                    let wave = |d: usize| own + 2.0 * coupling * (TAU * d as f64 / 12.0).cos();
                    let mut give = |which: MatrixKind, share: f64| {
                        if by_diameters {
                            for d in 0..=6 {
                                let a = [share * wave(d)];
                                model.set_diameter(which, d as i64, &MatrixView::dense(1, &a)).unwrap();
                            }
                        } else {
                            model.set_matrix(which, &MatrixView::dense(1, &[share * own])).unwrap();
                            let next = [share * coupling];
                            model.set_coupling(which, &MatrixView::dense(1, &next)).unwrap();
                        }
                    };
                    give(MatrixKind::Stiffness, 1.0);
                    if form == Form::Matrix {
                        give(MatrixKind::Structural, ETA);
                    } else {
                        model.set_loss_factor(ETA).unwrap();
                    }
                    model.add_force(0, 1, 0.8.into()).unwrap();
                    model.add_force(0, 3, Complex64::new(0.1, 0.2)).unwrap();
                    let branch = solve_at(&model, &harmonics(3), 0.6);
                    for (h, force) in [(1, Complex64::from(0.8)), (3, Complex64::new(0.1, 0.2))] {
                        let k = wave((h * diameter.rem_euclid(12) as usize) % 12);
                        let w = 0.6 * h as f64;
                        let x = force / (k * Complex64::new(1.0, ETA) - w * w * m);
                        let gap = (response(&branch, h)[0] / x - 1.0).norm();
                        assert!(gap < 1e-13, "EO {engine_order}, harmonic {h}: {gap:e}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_resonance_has_the_height_of_the_loss_factor_and_stays_in_place() {
    let model = oscillator(2.0, 50.0).loss_factor(0.02).force(0, 1, 3.0).build();
    let branch = sweep(&model, &harmonics(1), 4.0, 6.0, &[]);
    let [peak] = branch.peaks() else {
        panic!("{} peaks", branch.peaks().len());
    };
    assert!((peak.omega / 5.0 - 1.0).abs() < 1e-12, "{}", peak.omega);
    assert!((peak.amplitude / (3.0 / (0.02 * 50.0)) - 1.0).abs() < 1e-12);
    // All the work of the force goes into the loss factor.
    let energy = branch.energy_at(peak.point).unwrap();
    let loss = PI * 0.02 * 50.0 * peak.amplitude * peak.amplitude;
    assert!((energy.structural_loss / loss - 1.0).abs() < 1e-12);
}

/// Jenkins contact at one harmonic: k_eq + i·loss over kt at amplitude a over the slip motion.
pub fn describing_function(a: f64) -> Complex64 {
    let theta = (1.0 - 2.0 / a).acos();
    Complex64::new((theta - 0.5 * (2.0 * theta).sin()) / PI, 4.0 * (a - 1.0) / (PI * a * a))
}

#[test]
fn modal_damping_damps_each_mode_by_its_ratio_and_no_other_motion() {
    let n = 6;
    let (m, k) = chain(n);
    let ratios = [0.01, 0.0, 0.03, 0.002];
    let mut model = dense(m.as_slice(), k.as_slice()).build();
    model.set_modal_damping(&ratios).unwrap();
    let force = DVector::from_fn(n, |i, _| Complex64::new(1.0 - 0.3 * i as f64, 0.2 * i as f64));
    for (dof, f) in force.iter().enumerate() {
        model.add_force(dof, 1, *f).unwrap();
    }
    let modes = model.linear_modes(0, ContactState::Free).unwrap();
    for omega in [0.4, 1.0, 2.2] {
        let mut x = DVector::zeros(n);
        for (r, shape) in modes.shapes.chunks_exact(n).enumerate() {
            let shape = DVector::from_column_slice(shape);
            let (w, ratio) = (modes.omega[r], ratios.get(r).copied().unwrap_or(0.0));
            x += &shape * (shape.dotc(&force) / Complex64::new(w * w - omega * omega, 2.0 * ratio * w * omega));
        }
        let branch = solve_at(&model, &harmonics(1), omega);
        let gap = (DVector::from_vec(response(&branch, 1)) - &x).norm() / x.norm();
        assert!(gap < 1e-11, "{gap:e}");
    }
    // Viscous: the same motion in time.
    let options = TimeOptions {
        omega: 1.0,
        harmonics: 1,
        samples: 9,
        ..TimeOptions::default()
    };
    let mut all = model.try_clone().unwrap();
    all.set_modal_damping(&[0.05; 6]).unwrap();
    let time = time_response(&all, &options, &mut Hooks::default()).unwrap();
    let branch = solve_at(&all, &harmonics(1), 1.0);
    assert!(crate::common::relative_gap(&time.harmonics[n..2 * n], &response(&branch, 1)) < 1e-9);
    // Removed, the structure is undamped again.
    model.set_modal_damping(&[]).unwrap();
    assert!(!model.structure().is_damped());
}

#[test]
fn modal_damping_of_a_wheel_counts_the_modes_of_each_diameter() {
    for engine_order in [0, 2, 5, -2, 12, 22] {
        let base = crate::common::Blisk {
            engine_order,
            ..crate::common::BASE
        };
        let mut model = base.sector_without_contact();
        model.set_rayleigh(0.0, 0.0).unwrap();
        let ratios = [1e-3, 2e-3, 5e-3, 0.01];
        model.set_modal_damping(&ratios).unwrap();
        let n = model.ndof();
        let modes = model.linear_modes(engine_order, ContactState::Free).unwrap();
        let mut force = vec![Complex64::ZERO; n];
        for f in model.excitation().forces() {
            force[f.dof] += f.value;
        }
        let omega = TAU * 200.0;
        let mut x = vec![Complex64::ZERO; n];
        for (r, shape) in modes.shapes.chunks_exact(n).enumerate() {
            let w = modes.omega[r];
            let work: Complex64 = shape.iter().zip(&force).map(|(p, f)| p.conj() * f).sum();
            let share = work / Complex64::new(w * w - omega * omega, 2.0 * ratios[r] * w * omega);
            for (x, p) in x.iter_mut().zip(shape) {
                *x += p * share;
            }
        }
        let branch = solve_at(&model, &harmonics(1), omega);
        let gap = crate::common::relative_gap(&response(&branch, 1), &x);
        assert!(gap < 1e-10, "EO {engine_order}: {gap:e}");
        // In time the wheel is unrolled.
        let options = TimeOptions {
            omega,
            harmonics: 1,
            samples: 9,
            ..TimeOptions::default()
        };
        if engine_order == 2 || engine_order == 12 {
            let time = time_response(&model, &options, &mut Hooks::default()).unwrap();
            assert_eq!(time.status, Status::Ok);
            let gap = crate::common::relative_gap(&time.harmonics[n..2 * n], &x);
            assert!(gap < 1e-7, "EO {engine_order} in time: {gap:e}");
        }
    }
}
