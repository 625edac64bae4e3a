//! Damped modes of a rotating sector, its matrices given as blocks and per nodal diameter, against the eigenvalues of the
//! whole wheel as a dense first-order system: both senses of each wave, and nothing else.

use crate::common::phase;
use crate::rotating_modes::first_order;
use hbvib::{Contact, Hooks, LinearContacts, MatrixKind, MatrixView, Model, Speed, campbell, damped_modes};
use nalgebra::DMatrix;
use num_complex::Complex64;

const N: usize = 3;
const SPEED: f64 = 0.8;
const ALPHA: f64 = 0.01;
const BETA: f64 = 0.002;
const ETA: f64 = 0.02;
const KT: f64 = 1.5;

/// A kind of matrix with its own and next blocks, column-major, and the sign of its transpose.
struct Blocks {
    kind: MatrixKind,
    own: DMatrix<f64>,
    next: DMatrix<f64>,
    sign: f64,
}

fn blocks() -> Vec<Blocks> {
    let of = |kind, own: [f64; 9], next: [f64; 9], sign| Blocks {
        kind,
        own: DMatrix::from_column_slice(N, N, &own),
        next: DMatrix::from_column_slice(N, N, &next),
        sign,
    };
    vec![
        of(
            MatrixKind::Mass,
            [1.0, 0.1, 0.0, 0.1, 1.5, 0.0, 0.0, 0.0, 0.7],
            [0.02, 0.0, 0.05, 0.0, 0.01, 0.0, -0.03, 0.0, 0.0],
            1.0,
        ),
        of(
            MatrixKind::Damping,
            [0.05, 0.0, 0.01, 0.0, 0.06, 0.0, 0.01, 0.0, 0.04],
            [0.004, 0.01, 0.0, -0.003, 0.0, 0.006, 0.0, 0.002, 0.001],
            1.0,
        ),
        of(
            MatrixKind::Stiffness,
            [9.0, -2.0, -1.0, -2.0, 8.0, -1.5, -1.0, -1.5, 7.0],
            [-0.8, 0.1, -0.9, 0.4, -0.5, 0.0, -0.2, 0.7, -0.6],
            1.0,
        ),
        of(
            MatrixKind::Structural,
            [0.2, 0.03, 0.0, 0.03, 0.1, 0.0, 0.0, 0.0, 0.3],
            [-0.02, 0.0, 0.01, 0.0, -0.03, 0.0, 0.0, 0.02, 0.0],
            1.0,
        ),
        of(
            MatrixKind::Gyroscopic,
            [0.0, 0.9, -0.4, -0.9, 0.0, 0.6, 0.4, -0.6, 0.0],
            [0.1, 0.2, 0.0, -0.1, 0.05, 0.15, 0.0, 0.0, -0.2],
            -1.0,
        ),
        of(
            MatrixKind::StiffnessSpeed2,
            [-0.9, 0.2, 0.0, 0.2, -0.7, 0.1, 0.0, 0.1, 0.5],
            [0.1, 0.0, -0.05, 0.0, 0.08, 0.0, 0.02, 0.0, -0.06],
            1.0,
        ),
    ]
}

/// Across the sectors, stuck.
fn contact(sector_offset: i64) -> Contact {
    Contact {
        sector_offset,
        ..Contact::jenkins(2, Some(0), KT, 1.0, 1.0)
    }
}

/// A sector, numbered in the sense of rotation or against it.
fn sector(sectors: usize, per_diameter: bool, reversed: bool) -> Model {
    let mut model = Model::cyclic(N, sectors).unwrap();
    for blocks in blocks() {
        let next = if reversed {
            blocks.next.transpose() * blocks.sign
        } else {
            blocks.next
        };
        if !per_diameter {
            let view = |a| MatrixView::dense(N, a);
            model.set_matrix(blocks.kind, &view(blocks.own.as_slice())).unwrap();
            model.set_coupling(blocks.kind, &view(next.as_slice())).unwrap();
            continue;
        }
        for diameter in 0..=sectors / 2 {
            let lag = phase(1, diameter as i64, 1, sectors);
            let a = DMatrix::from_fn(N, N, |i, j| {
                blocks.own[(i, j)] + lag * next[(i, j)] + lag.conj() * blocks.sign * next[(j, i)]
            });
            let view = MatrixView::dense_complex(N, a.as_slice());
            model.set_diameter(blocks.kind, diameter as i64, &view).unwrap();
        }
    }
    model.set_rayleigh(ALPHA, BETA).unwrap();
    model.set_loss_factor(ETA).unwrap();
    model.set_speed(Speed::Fixed(SPEED)).unwrap();
    model.add_contact(&contact(if reversed { -1 } else { 1 })).unwrap();
    model
}

/// M, C + ΩG and K + Ω²K₁ + i(D + ηK) of the wheel with its contacts stuck.
fn wheel(sectors: usize) -> [DMatrix<Complex64>; 3] {
    let order = N * sectors;
    let mut found: [DMatrix<Complex64>; 3] = std::array::from_fn(|_| DMatrix::zeros(order, order));
    for blocks in blocks() {
        let mut whole = DMatrix::<f64>::zeros(order, order);
        for s in 0..sectors {
            let after = (s + 1) % sectors;
            let mut place = |row: usize, column: usize, a: &DMatrix<f64>| {
                let mut part = whole.view_mut((row * N, column * N), (N, N));
                part += a;
            };
            place(s, s, &blocks.own);
            place(s, after, &blocks.next);
            place(after, s, &(blocks.next.transpose() * blocks.sign));
        }
        let whole = whole.map(Complex64::from);
        let mut add = |to: usize, factor: Complex64| found[to] += &whole * factor;
        match blocks.kind {
            MatrixKind::Mass => {
                add(0, Complex64::ONE);
                add(1, ALPHA.into());
            }
            MatrixKind::Damping => add(1, Complex64::ONE),
            MatrixKind::Stiffness => {
                add(1, BETA.into());
                add(2, Complex64::new(1.0, ETA));
            }
            MatrixKind::Structural => add(2, Complex64::I),
            MatrixKind::Gyroscopic => add(1, SPEED.into()),
            MatrixKind::StiffnessSpeed2 => add(2, (SPEED * SPEED).into()),
        }
    }
    for s in 0..sectors {
        let ends = [(N * s + 2, 1.0), (N * ((s + 1) % sectors), -1.0)];
        for (i, a) in ends {
            for (j, b) in ends {
                found[2][(i, j)] += KT * a * b;
            }
        }
    }
    found
}

fn eigenvalues(model: &Model, diameter: i64) -> Vec<Complex64> {
    let found = damped_modes(model, diameter, LinearContacts::Stuck, N, &mut Hooks::default()).unwrap();
    assert_eq!(found.count(), N);
    // Gyroscopic forces move every frequency of such a wave.
    assert!(found.direction.iter().all(|d| d.abs() == 1), "{:?}", found.direction);
    found.eigenvalue
}

#[test]
fn damped_modes_of_each_wave_are_those_of_the_rotating_wheel() {
    for sectors in [5, 6] {
        let [m, c, k] = wheel(sectors);
        let known = first_order(&m, &c, &k);
        assert_eq!(known.len(), N * sectors);
        for per_diameter in [false, true] {
            let mut found = Vec::new();
            for reversed in [false, true] {
                let model = sector(sectors, per_diameter, reversed);
                for diameter in 0..=sectors / 2 {
                    // Waves of diameter 0 and N/2 have one sense.
                    if !(reversed && (diameter == 0 || 2 * diameter == sectors)) {
                        found.extend(eigenvalues(&model, diameter as i64));
                    }
                }
            }
            found.sort_by(|a, b| a.im.total_cmp(&b.im));
            assert_eq!(found.len(), known.len());
            let mut worst = 0.0_f64;
            for (a, b) in found.iter().zip(&known) {
                worst = worst.max((a - b).norm() / b.norm());
            }
            println!("{sectors} sectors, per diameter {per_diameter}: {worst:.1e}");
            assert!(worst < 1e-9, "{worst:e}");
        }
    }
}

#[test]
fn a_campbell_diagram_of_a_wave_has_the_modes_at_each_speed() {
    let model = sector(6, true, false);
    let speeds = [0.2, SPEED, 1.4];
    for diameter in 0..=3 {
        let at = (diameter, LinearContacts::Stuck, N);
        let diagram = campbell(&model, &speeds, at, &[1], &mut Hooks::default()).unwrap();
        for (i, speed) in speeds.into_iter().enumerate() {
            let mut model = model.try_clone().unwrap();
            model.set_speed(Speed::Fixed(speed)).unwrap();
            for (k, lambda) in eigenvalues(&model, diameter).into_iter().enumerate() {
                assert!((diagram.omega[i * N + k] / lambda.im - 1.0).abs() < 1e-12);
                assert!((diagram.damping_ratio[i * N + k] + lambda.re / lambda.norm()).abs() < 1e-12);
            }
        }
    }
}
