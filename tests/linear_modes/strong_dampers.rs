//! Damped modes above the size that is solved densely: strong dampers at few places and Coriolis forces, against eigenvalues of the
//! state-space matrix and of chains in closed form. None may be missing, none listed twice.

use crate::common::models::{diagonal, tridiagonal, unit_chain};
use hbvib::{ContactState, Hooks, LinearContacts, MatrixKind, MatrixView, Model, Speed, campbell, damped_modes};
use nalgebra::DMatrix;
use num_complex::Complex64;

struct Matrices {
    mass: DMatrix<f64>,
    damping: DMatrix<f64>,
    stiffness: DMatrix<f64>,
    gyroscopic: DMatrix<f64>,
}

impl Matrices {
    fn model(&self, speed: f64) -> Model {
        let n = self.mass.nrows();
        let mut model = Model::new(n).unwrap();
        let all = [
            (MatrixKind::Mass, &self.mass),
            (MatrixKind::Damping, &self.damping),
            (MatrixKind::Stiffness, &self.stiffness),
            (MatrixKind::Gyroscopic, &self.gyroscopic),
        ];
        for (kind, matrix) in all {
            // Rows first.
            let rows = matrix.transpose();
            model.set_matrix(kind, &MatrixView::dense(n, rows.as_slice())).unwrap();
        }
        model.set_speed(Speed::Fixed(speed)).unwrap();
        model
    }

    /// Eigenvalues in the upper half plane by rising frequency, of the state-space matrix with M diagonal.
    fn dense(&self, speed: f64) -> Vec<Complex64> {
        let n = self.mass.nrows();
        let mut state = DMatrix::zeros(2 * n, 2 * n);
        let damping = &self.damping + speed * &self.gyroscopic;
        for j in 0..n {
            state[(j, n + j)] = 1.0;
            for i in 0..n {
                state[(n + i, j)] = -self.stiffness[(i, j)] / self.mass[(i, i)];
                state[(n + i, n + j)] = -damping[(i, j)] / self.mass[(i, i)];
            }
        }
        let all = state.complex_eigenvalues();
        let mut upper: Vec<Complex64> = all.iter().filter(|z| z.im > 1e-6).copied().collect();
        upper.sort_by(|a, b| a.im.total_cmp(&b.im));
        upper
    }
}

fn found(model: &Model, count: usize) -> Vec<Complex64> {
    damped_modes(model, 0, LinearContacts::Free, count, &mut Hooks::default())
        .unwrap()
        .eigenvalue
}

/// Masses on springs to their neighbours in a grid of two rows, in x and y, on walls at the left, with Coriolis forces.
fn grid(columns: usize) -> Matrices {
    let n = 4 * columns;
    let zeros = || DMatrix::<f64>::zeros(n, n);
    let (mut mass, mut stiffness, mut gyroscopic) = (zeros(), zeros(), zeros());
    let varied = |k: usize| 1.0 + 0.2 * (k as f64 * 1.7).sin();
    for node in 0..2 * columns {
        for dof in [2 * node, 2 * node + 1] {
            mass[(dof, dof)] = varied(node);
            if node < 2 {
                stiffness[(dof, dof)] += 1.0;
            }
        }
        gyroscopic[(2 * node, 2 * node + 1)] = -2.0 * varied(node);
        gyroscopic[(2 * node + 1, 2 * node)] = 2.0 * varied(node);
        for (to, [x, y]) in [(node + 2, [1.0, 0.0]), (node ^ 1, [0.0, 1.0]), (node + 3, [0.8, 0.6])] {
            if to <= node || to >= 2 * columns || (to == node + 3 && node % 2 == 1) {
                continue;
            }
            let k = varied(3 * node + to);
            for (p, q, sign) in [(node, node, k), (to, to, k), (node, to, -k), (to, node, -k)] {
                for (i, a) in [x, y].into_iter().enumerate() {
                    for (j, b) in [x, y].into_iter().enumerate() {
                        stiffness[(2 * p + i, 2 * q + j)] += sign * a * b;
                    }
                }
            }
        }
    }
    let damping = 0.002 * &stiffness;
    Matrices {
        mass,
        damping,
        stiffness,
        gyroscopic,
    }
}

fn check(matrices: &Matrices, speed: f64, count: usize) {
    let model = matrices.model(speed);
    let exact = matrices.dense(speed);
    let found = found(&model, count);
    assert_eq!(found.len(), count);
    for (k, (found, exact)) in found.iter().zip(&exact).enumerate() {
        let n = matrices.mass.nrows();
        assert!(
            (found - exact).norm() < 1e-9,
            "{n}, Ω = {speed}, {k}: {found} for {exact}"
        );
    }
}

#[test]
fn one_damper_of_any_strength_loses_no_mode() {
    for (columns, strengths) in [(26, &[0.3, 3.0][..]), (28, &[1.0, 2.0, 30.0]), (40, &[2.5])] {
        for &strength in strengths {
            let mut matrices = grid(columns);
            let n = 4 * columns;
            for dof in [n - 2, n - 1] {
                matrices.damping[(dof, dof)] += strength;
            }
            check(&matrices, 0.0, 12);
        }
    }
}

#[test]
fn dampers_at_several_places_and_coriolis_forces_lose_no_mode() {
    for (places, speed) in [(1, 0.3), (3, 0.05), (6, 0.3)] {
        let mut matrices = grid(28);
        let n = matrices.mass.nrows();
        for place in 0..places {
            let dof = n - 1 - place * n / places;
            matrices.damping[(dof, dof)] += 1.5 + place as f64;
        }
        check(&matrices, speed, 20);
    }
}

/// Two chains of unit masses and springs between walls, in x and y, with Coriolis forces and damping αM.
///
/// Along each mode of frequency ω of the chain z = x + iy obeys z″ + (α + 2iΩ) z′ + ω² z = 0.
fn whirling_chain(length: usize, alpha: f64) -> (Matrices, impl Fn(f64) -> Vec<Complex64>) {
    let n = 2 * length;
    let zeros = || DMatrix::<f64>::zeros(n, n);
    let (mut stiffness, mut gyroscopic) = (zeros(), zeros());
    for i in 0..length {
        for plane in 0..2 {
            stiffness[(2 * i + plane, 2 * i + plane)] = 2.0;
            if i + 1 < length {
                stiffness[(2 * i + plane, 2 * i + 2 + plane)] = -1.0;
                stiffness[(2 * i + 2 + plane, 2 * i + plane)] = -1.0;
            }
        }
        gyroscopic[(2 * i, 2 * i + 1)] = -2.0;
        gyroscopic[(2 * i + 1, 2 * i)] = 2.0;
    }
    let exact = move |speed: f64| {
        let mut all = Vec::new();
        for k in 1..=length {
            let omega = 2.0 * (0.5 * std::f64::consts::PI * k as f64 / (length + 1) as f64).sin();
            for sense in [1.0, -1.0] {
                let half = Complex64::new(0.5 * alpha, sense * speed);
                let root = (half * half - omega * omega).sqrt();
                all.extend([-half + root, -half - root].into_iter().filter(|z| z.im > 0.0));
            }
        }
        all.sort_by(|a: &Complex64, b| a.im.total_cmp(&b.im));
        all
    };
    let matrices = Matrices {
        mass: DMatrix::identity(n, n),
        damping: alpha * DMatrix::<f64>::identity(n, n),
        stiffness,
        gyroscopic,
    };
    (matrices, exact)
}

#[test]
fn modes_at_high_speed_are_those_in_closed_form() {
    // At many times the first frequency the modes that whirl backward lie far below all frequencies without rotation.
    for (length, alpha, speed, count) in [(64, 0.0, 0.3, 20), (128, 0.01, 0.5, 15), (320, 0.0, 0.1, 12)] {
        let (matrices, exact) = whirling_chain(length, alpha);
        let model = matrices.model(speed);
        let exact = exact(speed);
        for (found, exact) in found(&model, count).iter().zip(&exact) {
            assert!((found - exact).norm() < 1e-10, "{length}: {found} for {exact}");
        }
        if alpha == 0.0 {
            let modes = model.lowest_modes(0, ContactState::Free, count).unwrap();
            for (omega, exact) in modes.omega.iter().zip(&exact) {
                assert!((omega - exact.im).abs() < 1e-10, "{length}: {omega} for {exact}");
            }
        }
    }
}

#[test]
fn a_long_chain_with_a_damper_at_its_end_has_every_mode_once() {
    // u_j = sin(jθ), λ = 2i sin(θ/2), and at the end λ²u + u − u₋ + cλu = 0 with the mass and one spring there. The real parts of
    // θ lie about π/N apart, so that a mode missing leaves a gap and one listed twice none.
    let length = 640;
    for strength in [0.2, 0.9, 5.0] {
        let n = length;
        let stiffness = DMatrix::from_fn(n, n, |i, j| match i.abs_diff(j) {
            0 if i + 1 == n => 1.0,
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        });
        let mut matrices = Matrices {
            mass: DMatrix::identity(n, n),
            damping: DMatrix::zeros(n, n),
            stiffness,
            gyroscopic: DMatrix::zeros(n, n),
        };
        matrices.damping[(n - 1, n - 1)] = strength;
        let apart = std::f64::consts::PI / n as f64;
        let mut before = 0.0;
        for (k, value) in found(&matrices.model(0.0), 12).into_iter().enumerate() {
            let theta = 2.0 * (value / Complex64::new(0.0, 2.0)).asin();
            let (end, inner) = ((theta * n as f64).sin(), (theta * (n as f64 - 1.0)).sin());
            let residual = (value * value + 1.0 + strength * value) * end - inner;
            assert!(residual.norm() < 1e-9, "{strength}, {k}: {residual}");
            let gap = (theta.re - before) / apart;
            assert!((0.4..1.1).contains(&gap), "{strength}, {k}: {gap}");
            before = theta.re;
        }
    }
}

#[test]
fn a_diagram_keeps_the_other_speeds_where_one_has_no_modes() {
    // At the speed 1 the first stiffness vanishes with K₁, and its force has no static state.
    let mut model = Model::new(2).unwrap();
    let all: [(MatrixKind, [f64; 4]); 3] = [
        (MatrixKind::Mass, [1.0, 0.0, 0.0, 1.0]),
        (MatrixKind::Stiffness, [1.0, 0.0, 0.0, 9.0]),
        (MatrixKind::StiffnessSpeed2, [-1.0, 0.0, 0.0, 0.0]),
    ];
    for (kind, values) in &all {
        model.set_matrix(*kind, &MatrixView::dense(2, values)).unwrap();
    }
    model
        .add_contact(&hbvib::Contact::unilateral(Some(1), None, 3.0, 1.0))
        .unwrap();
    model.add_force(0, 0, 0.5.into()).unwrap();
    let mut lines = Vec::new();
    let mut log = |_: hbvib::LogLevel, line: &str| lines.push(line.to_owned());
    let mut hooks = Hooks {
        log: Some(&mut log),
        ..Hooks::default()
    };
    let at = (0, LinearContacts::Static, 1);
    let diagram = campbell(&model, &[0.0, 0.5, 1.0], at, &[1], &mut hooks).unwrap();
    drop(hooks);
    for (speed, omega) in diagram.speeds.iter().zip(&diagram.omega) {
        let exact = (1.0 - speed * speed).sqrt();
        assert!(
            if *speed == 1.0 {
                omega.is_nan()
            } else {
                (omega - exact).abs() < 1e-12
            },
            "{speed}: {omega}"
        );
    }
    assert!(
        lines.iter().any(|line| line.contains("the speed 1 are left out")),
        "{lines:?}"
    );
    let error = campbell(&model, &[1.0], at, &[1], &mut Hooks::default()).unwrap_err();
    assert!(error.message().contains("singular"), "{error:?}");
}

/// Structural damping gives a frequency to motions that strong dampers hold; whatever the number of modes asked for, they are those of all
/// eigenvalues.
#[test]
fn held_motions_with_structural_damping_are_found_at_any_count() {
    for (n, dampers) in [
        (102, [100.0, 0.0, 0.0]),
        (102, [300.0, 390.0, 0.0]),
        (202, [100.0, 130.0, 160.0]),
        (202, [30.0, 0.0, 0.0]),
    ] {
        let k = 0.1 * (n * n) as f64;
        let mut built = unit_chain(n);
        let mut damping = vec![0.0; n];
        for (i, c) in dampers.into_iter().enumerate() {
            damping[(7 + 13 * i) % n] += c;
        }
        built = built
            .stiffness(&tridiagonal(&vec![2.0 * k; n], &vec![-k; n - 1]))
            .damping(&diagonal(&damping))
            .loss_factor(0.01);
        let model = built.build();
        let modes = |count: usize| damped_modes(&model, 0, LinearContacts::Free, count, &mut Hooks::default()).unwrap();
        let all = modes(n / 2);
        for count in [1, 4, 16] {
            let found = modes(count);
            for k in 0..count {
                let off = (found.eigenvalue[k] - all.eigenvalue[k]).norm();
                assert!(off < 1e-8 * all.eigenvalue[k].norm(), "{n}, {dampers:?}, {count}: {k}");
            }
        }
    }
}
