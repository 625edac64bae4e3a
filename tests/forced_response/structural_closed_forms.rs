//! Structural damping to rounding: one oscillator, with a spring and with a sliding Jenkins contact at one harmonic, and
//! sectors of two degrees of freedom by Cramer's rule, their matrices dense and sparse, as blocks and per diameter.

use crate::common::energy::exactly;
use crate::common::{phase, solve_at};
use crate::structural_damping::{ETA, FORMS, Form, describing_function, set, set_stiffness};
use hbvib::{Contact, MatrixKind, MatrixView, Model, Part, Spring, Storage, Values};
use nalgebra::{DMatrix, Matrix2, Vector2};
use num_complex::Complex64;
use std::f64::consts::PI;

const LOSSY: Complex64 = Complex64::new(1.0, ETA);

/// One mass with the given damping, no contact yet.
fn oscillator(m: f64, k: f64, form: Form, sparse: bool) -> Model {
    let mut model = Model::new(1).unwrap();
    model.set_matrix(MatrixKind::Mass, &MatrixView::dense(1, &[m])).unwrap();
    set_stiffness(&mut model, &DMatrix::from_element(1, 1, k), form, sparse);
    model
}

#[test]
fn an_oscillator_with_a_sliding_contact_has_the_closed_form_of_one_harmonic() {
    let (m, k, kt, slip) = (1.5, 40.0, 25.0, 0.1);
    let mut worst = (0.0_f64, 0.0_f64);
    for form in FORMS {
        for sparse in [false, true] {
            for a in [1.05, 1.5, 4.0, 30.0] {
                for omega in [3.0, 5.0, 6.4, 8.0] {
                    let amplitude: f64 = a * slip;
                    let z = k * LOSSY + kt * describing_function(a) - omega * omega * m;
                    let mut model = oscillator(m, k, form, sparse);
                    model
                        .add_contact(&Contact::jenkins(0, None, kt, 1.0, kt * slip))
                        .unwrap();
                    model.add_force(0, 1, z * amplitude).unwrap();
                    let branch = solve_at(&model, &exactly(1), omega);
                    let x = branch.response_at(0).unwrap()[0];
                    worst.0 = worst.0.max((x / amplitude - 1.0).norm());
                    let energy = branch.energy_at(0).unwrap();
                    let loss = PI * k * ETA * amplitude * amplitude;
                    let friction = 4.0 * kt * slip * (amplitude - slip);
                    worst.1 = worst.1.max((energy.structural_loss / loss - 1.0).abs());
                    worst.1 = worst.1.max((energy.friction_loss / friction - 1.0).abs());
                }
            }
        }
    }
    println!("motion {:.1e}, losses {:.1e}", worst.0, worst.1);
    assert!(worst.0 < 1e-13 && worst.1 < 1e-12, "{worst:?}");
}

#[test]
fn springs_and_contacts_beside_a_loss_factor_have_no_loss() {
    let (m, k, spring, kt, omega) = (1.5, 40.0, 30.0, 25.0, 4.0);
    for form in FORMS {
        let mut model = oscillator(m, k, form, false);
        let added = Spring {
            dof_a: Some(0),
            dof_b: None,
            sector_offset: 0,
            stiffness: spring,
        };
        model.add_spring(&added).unwrap();
        // A contact that sticks for ever, one that sticks, and one that is linear by its law.
        for contact in [
            Contact::jenkins(0, None, kt, 1.0, f64::INFINITY),
            Contact::jenkins(0, None, kt, 1.0, 1e3),
            Contact::cubic(0, None, kt, 0.0),
        ] {
            model.add_contact(&contact).unwrap();
        }
        model.add_force(0, 1, 1.0.into()).unwrap();
        let branch = solve_at(&model, &exactly(1), omega);
        let expected = (k * LOSSY + spring + 3.0 * kt - omega * omega * m).inv();
        let gap = (branch.response_at(0).unwrap()[0] / expected - 1.0).norm();
        assert!(gap < 1e-13, "{form:?}: {gap:e}");
        let loss = PI * k * ETA * expected.norm_sqr();
        let found = branch.energy_at(0).unwrap().structural_loss;
        assert!((found / loss - 1.0).abs() < 1e-12, "{form:?}: {found} {loss}");
    }
}

const MASS: [f64; 4] = [1.3, 0.2, 0.2, 0.9];
const OWN: [f64; 4] = [3.0, -1.1, -1.1, 2.4];
/// Column-major: [i + 2 j] couples i of a sector to j of the next; one entry is zero.
const NEXT: [f64; 4] = [-0.5, 0.2, 0.0, -0.3];
const SECTORS: usize = 12;

/// A(φ) = A₀ + A₁ e^{−iφ} + A₁ᵀ e^{iφ}
fn of_wave(own: &[f64], next: &[f64], lag: Complex64) -> Matrix2<Complex64> {
    Matrix2::from_fn(|i, j| own[2 * j + i] + lag * next[2 * j + i] + lag.conj() * next[2 * i + j])
}

fn cramer(a: &Matrix2<Complex64>, b: Vector2<Complex64>) -> Vector2<Complex64> {
    let det = a[(0, 0)] * a[(1, 1)] - a[(0, 1)] * a[(1, 0)];
    Vector2::new(b[0] * a[(1, 1)] - b[1] * a[(0, 1)], a[(0, 0)] * b[1] - a[(1, 0)] * b[0]) / det
}

/// How the matrices of a sector are passed.
#[derive(Clone, Copy, Debug)]
struct Passed {
    form: Form,
    sparse: bool,
    per_diameter: bool,
}

/// A block as dense numbers, or as compressed columns without its zero entries.
fn give(sparse: bool, a: &[Complex64], part: Part, take: &mut dyn FnMut(&MatrixView<'_>)) {
    if !sparse {
        return take(&MatrixView::dense_complex(2, a).part(part));
    }
    let (mut col_ptr, mut row_idx, mut values) = (vec![0], Vec::new(), Vec::new());
    for column in a.chunks_exact(2) {
        for (i, v) in column.iter().enumerate().filter(|(_, v)| v.norm() > 0.0) {
            row_idx.push(i as i64);
            values.push(*v);
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
        ..MatrixView::dense(2, &[])
    };
    take(&view);
}

impl Passed {
    fn all() -> Vec<Self> {
        let mut all = Vec::new();
        for sparse in [false, true] {
            for form in [Form::LossFactor, Form::Matrix, Form::ComplexStiffness] {
                for per_diameter in [false, true] {
                    // A complex stiffness per diameter is not that of the backward wave.
                    if !(per_diameter && form == Form::ComplexStiffness) {
                        all.push(Self {
                            form,
                            sparse,
                            per_diameter,
                        });
                    }
                }
            }
        }
        all
    }

    fn place(self, model: &mut Model, which: MatrixKind, factor: Complex64, (own, next): (&[f64], &[f64])) {
        let scaled = |a: &[f64]| -> Vec<Complex64> { a.iter().map(|x| x * factor).collect() };
        if !self.per_diameter {
            let part = if factor.im == 0.0 { Part::Full } else { Part::Symmetric };
            let (own, next) = (scaled(own), scaled(next));
            give(self.sparse, &own, part, &mut |view| {
                model.set_matrix(which, view).unwrap();
            });
            give(self.sparse, &next, Part::Full, &mut |view| {
                model.set_coupling(which, view).unwrap();
            });
            return;
        }
        for diameter in 0..=SECTORS / 2 {
            let a = of_wave(own, next, phase(1, diameter as i64, 1, SECTORS)) * factor;
            give(self.sparse, a.as_slice(), Part::Full, &mut |view| {
                model.set_diameter(which, diameter as i64, view).unwrap();
            });
        }
    }

    fn model(self, engine_order: i64) -> Model {
        let mut model = Model::cyclic(2, SECTORS).unwrap();
        model.set_wave(engine_order);
        let mass = set_mass(self.sparse);
        mass(&mut model);
        let stiffness = (&OWN[..], &NEXT[..]);
        match self.form {
            Form::LossFactor => {
                self.place(&mut model, MatrixKind::Stiffness, Complex64::ONE, stiffness);
                model.set_loss_factor(ETA).unwrap();
            }
            Form::Matrix => {
                self.place(&mut model, MatrixKind::Stiffness, Complex64::ONE, stiffness);
                self.place(&mut model, MatrixKind::Structural, ETA.into(), stiffness);
            }
            _ => self.place(&mut model, MatrixKind::Stiffness, LOSSY, stiffness),
        }
        model
    }
}

fn set_mass(sparse: bool) -> impl Fn(&mut Model) {
    move |model| {
        let mass = DMatrix::from_column_slice(2, 2, &MASS).map(Complex64::from);
        set(model, MatrixKind::Mass, &mass, Part::Full, sparse);
    }
}

/// Z of harmonic h.
fn dynamic(h: usize, engine_order: i64, omega: f64) -> Matrix2<Complex64> {
    let lag = phase(h, engine_order, 1, SECTORS);
    let hw = h as f64 * omega;
    of_wave(&OWN, &NEXT, lag) * LOSSY
        - Matrix2::from_column_slice(&MASS).map(Complex64::from) * Complex64::from(hw * hw)
}

const ENGINE_ORDERS: [i64; 6] = [0, 1, -2, 5, 6, 11];

#[test]
fn sectors_of_two_degrees_of_freedom_have_the_responses_of_cramers_rule() {
    let mut worst = 0.0_f64;
    for passed in Passed::all() {
        for engine_order in ENGINE_ORDERS {
            let mut model = passed.model(engine_order);
            let forces = [
                (1, Vector2::new(Complex64::new(0.4, -0.7), Complex64::new(0.1, 0.2))),
                (3, Vector2::new(Complex64::new(-0.2, 0.1), Complex64::ZERO)),
            ];
            for (h, f) in forces {
                for (dof, f) in f.iter().enumerate() {
                    model.add_force(dof, h, *f).unwrap();
                }
            }
            for omega in [0.4, 0.7] {
                let branch = solve_at(&model, &exactly(3), omega);
                let x = crate::common::all_harmonics(&branch, 0);
                let mut loss = 0.0;
                for (h, f) in forces {
                    let known = cramer(&dynamic(h, engine_order, omega), f);
                    let found = Vector2::new(x[2 * h], x[2 * h + 1]);
                    worst = worst.max((found - known).norm() / known.norm());
                    let lag = phase(h, engine_order, 1, SECTORS);
                    loss += PI * h as f64 * ETA * known.dotc(&(of_wave(&OWN, &NEXT, lag) * known)).re;
                }
                let told = branch.energy_at(0).unwrap().structural_loss;
                assert!(
                    (told / loss - 1.0).abs() < 1e-12,
                    "{passed:?}, EO {engine_order}: {told} {loss}"
                );
            }
        }
    }
    println!("off by {worst:.1e}");
    assert!(worst < 1e-13, "{worst:e}");
}

#[test]
fn sectors_with_a_sliding_contact_have_the_closed_form_of_one_harmonic() {
    let (kt, slip, omega) = (1.7, 0.2, 0.9);
    let mut worst = 0.0_f64;
    for passed in Passed::all() {
        for engine_order in ENGINE_ORDERS {
            for sector_offset in [0, 1] {
                for a in [1.2, 3.0, 20.0] {
                    let lag = phase(1, engine_order * sector_offset, 1, SECTORS);
                    // y = w·x of amplitude a over the slip motion, with a motion chosen at will.
                    let w = Vector2::new(Complex64::ONE, -lag);
                    let shape = Vector2::new(Complex64::new(0.8, 0.3), Complex64::new(-0.5, 0.6));
                    let y = w.dot(&shape);
                    let x = shape * Complex64::from(a * slip / y.norm());
                    let friction = w.map(|w| w.conj()) * (w.dot(&x) * describing_function(a) * kt);
                    let force = dynamic(1, engine_order, omega) * x + friction;
                    let mut model = passed.model(engine_order);
                    let contact = Contact {
                        sector_offset,
                        ..Contact::jenkins(0, Some(1), kt, 1.0, kt * slip)
                    };
                    model.add_contact(&contact).unwrap();
                    for (dof, f) in force.iter().enumerate() {
                        model.add_force(dof, 1, *f).unwrap();
                    }
                    let branch = solve_at(&model, &exactly(1), omega);
                    let found = crate::common::all_harmonics(&branch, 0);
                    let gap = (Vector2::new(found[2], found[3]) - x).norm() / x.norm();
                    assert!(
                        gap < 1e-13,
                        "{passed:?}, EO {engine_order}, offset {sector_offset}, a = {a}: {gap:e}"
                    );
                    worst = worst.max(gap);
                }
            }
        }
    }
    println!("off by {worst:.1e}");
}
