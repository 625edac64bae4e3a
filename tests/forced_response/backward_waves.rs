//! Damping per nodal diameter in waves of either sense: the response of a sector whose matrices are given per diameter is
//! that of the whole wheel, and a complex stiffness, whose backward wave is unknown, is refused there.

use crate::common::{all_harmonics, harmonics, omega_range, phase, relative_gap, slip, solve_at};
use hbvib::{Contact, Hooks, MatrixKind, MatrixView, Model, Part, Status, forced_response};
use num_complex::Complex64;

const N: usize = 2;
const SECTORS: usize = 6;
const ETA: f64 = 0.07;

/// Column-major; the blocks to the next sector have no symmetry.
const MASS: [f64; 4] = [1.0, 0.1, 0.1, 0.8];
const STIFFNESS: [f64; 4] = [6.0, -1.5, -1.5, 5.0];
const STIFFNESS_NEXT: [f64; 4] = [-0.9, 0.5, -0.2, -0.7];
const LOSS: [f64; 4] = [0.3, -0.05, -0.05, 0.4];
const LOSS_NEXT: [f64; 4] = [-0.06, 0.05, -0.01, -0.03];

fn finished(mut model: Model, engine_order: i64) -> Model {
    let sectors = model.structure().sectors();
    let copies = if sectors == 1 { SECTORS } else { 1 };
    for s in 0..copies {
        let contact = Contact::jenkins(N * s, Some(N * s + 1), 2.0, 0.5, 0.1);
        model.add_contact(&contact).unwrap();
        let turn = phase(1, engine_order, s, SECTORS);
        model.add_force(N * s, 1, turn).unwrap();
        model.add_force(N * s + 1, 1, Complex64::new(-0.2, 0.6) * turn).unwrap();
    }
    model.set_wave(engine_order);
    model
}

/// How the loss of the sector is given.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    /// A structural matrix per diameter, complex Hermitian.
    Matrix,
    /// A loss factor beside the stiffness per diameter.
    LossFactor,
    /// K(1 + iη) per diameter.
    ComplexStiffness,
}

/// Σ A_s e^{−isφ} of two blocks and the transpose of the second.
fn wave(own: &[f64; 4], next: &[f64; 4], diameter: usize) -> [Complex64; 4] {
    let lag = phase(1, diameter as i64, 1, SECTORS);
    core::array::from_fn(|i| {
        let mirror = next[(i % N) * N + i / N];
        own[i] + lag * next[i] + lag.conj() * mirror
    })
}

fn sector(form: Form, engine_order: i64) -> Model {
    let mut model = Model::cyclic(N, SECTORS).unwrap();
    model
        .set_matrix(MatrixKind::Mass, &MatrixView::dense(N, &MASS))
        .unwrap();
    for d in 0..=SECTORS / 2 {
        let k = wave(&STIFFNESS, &STIFFNESS_NEXT, d);
        let mut set = |which, a: &[Complex64], part| {
            let view = MatrixView::dense_complex(N, a).part(part);
            model.set_diameter(which, d as i64, &view).unwrap();
        };
        if form == Form::ComplexStiffness {
            let complex = k.map(|k| k * Complex64::new(1.0, ETA));
            set(MatrixKind::Stiffness, &complex, Part::General);
            continue;
        }
        set(MatrixKind::Stiffness, &k, Part::Full);
        if form == Form::Matrix {
            set(MatrixKind::Structural, &wave(&LOSS, &LOSS_NEXT, d), Part::Full);
        }
    }
    if form == Form::LossFactor {
        model.set_loss_factor(ETA).unwrap();
    }
    finished(model, engine_order)
}

/// The matrix of the wheel, from the blocks of its sectors.
fn wheel_matrix(own: &[f64; 4], next: &[f64; 4]) -> Vec<f64> {
    let size = N * SECTORS;
    let mut a = vec![0.0; size * size];
    for s in 0..SECTORS {
        let after = (s + 1) % SECTORS;
        for (i, j) in (0..N).flat_map(|i| (0..N).map(move |j| (i, j))) {
            a[(N * s + j) * size + N * s + i] += own[j * N + i];
            a[(N * after + j) * size + N * s + i] += next[j * N + i];
            a[(N * s + i) * size + N * after + j] += next[j * N + i];
        }
    }
    a
}

fn whole_wheel(form: Form, engine_order: i64) -> Model {
    let size = N * SECTORS;
    let mut model = Model::new(size).unwrap();
    let mut set = |which, a: &[f64]| model.set_matrix(which, &MatrixView::dense(size, a)).unwrap();
    set(MatrixKind::Mass, &wheel_matrix(&MASS, &[0.0; 4]));
    let stiffness = wheel_matrix(&STIFFNESS, &STIFFNESS_NEXT);
    set(MatrixKind::Stiffness, &stiffness);
    if form == Form::Matrix {
        set(MatrixKind::Structural, &wheel_matrix(&LOSS, &LOSS_NEXT));
    } else {
        let loss: Vec<f64> = stiffness.iter().map(|k| ETA * k).collect();
        set(MatrixKind::Structural, &loss);
    }
    finished(model, engine_order)
}

#[test]
fn loss_per_diameter_damps_waves_of_either_sense_as_in_the_wheel() {
    // Harmonics 1, 3 and 5 of EO 2 are the forward wave of 2, all sectors alike, and the backward wave of 2.
    for engine_order in [2, -2, 1, 5, 3] {
        for form in [Form::Matrix, Form::LossFactor] {
            let (sector, wheel) = (sector(form, engine_order), whole_wheel(form, engine_order));
            let mut most = 0.0_f64;
            for omega in [1.1, 2.0, 2.6] {
                let (a, b) = (
                    solve_at(&sector, &harmonics(5), omega),
                    solve_at(&wheel, &harmonics(5), omega),
                );
                let mut spread = Vec::new();
                for (h, block) in all_harmonics(&a, 0).chunks_exact(N).enumerate() {
                    for s in 0..SECTORS {
                        spread.extend(block.iter().map(|x| x * phase(h, engine_order, s, SECTORS)));
                    }
                }
                let gap = relative_gap(&all_harmonics(&b, 0), &spread);
                assert!(gap < 1e-9, "{form:?}, EO {engine_order}, ω = {omega}: {gap:e}");
                most = most.max(slip(&a, 0));
            }
            assert!(most > 0.0, "EO {engine_order}: nothing slips");
        }
    }
}

#[test]
fn a_complex_stiffness_per_diameter_serves_forward_waves_and_is_refused_in_backward_ones() {
    // One harmonic of a forward wave has a matrix of its own.
    let one = harmonics(1);
    let (a, b) = (
        solve_at(&sector(Form::ComplexStiffness, 2), &one, 2.0),
        solve_at(&sector(Form::LossFactor, 2), &one, 2.0),
    );
    assert!(relative_gap(&all_harmonics(&a, 0), &all_harmonics(&b, 0)) < 1e-10);
    for (engine_order, highest) in [(-2, 1), (5, 1), (2, 5), (1, 5)] {
        let model = sector(Form::ComplexStiffness, engine_order);
        let range = omega_range(2.0, 2.1);
        let refused = forced_response(&model, &harmonics(highest), &range, &mut Hooks::default()).unwrap_err();
        assert_eq!(refused.status, Status::Unsupported, "EO {engine_order}: {refused}");
        let sentence = refused.to_string();
        for word in ["nodal diameter", "backward", "loss factor", "structural"] {
            assert!(sentence.contains(word), "{sentence}");
        }
    }
}
