//! Natural modes of stiffnesses that no structure has: a motion of negative stiffness is told by a frequency below zero, in as
//! many places as Sturm's sequence counts, and degrees of freedom under a penalty of 1e36 are fixed ones.

use crate::common::{at_dof, omega_range};
use hbvib::{
    Contact, ContactState, ForcedOptions, Hooks, LinearContacts, MatrixKind, MatrixView, Model, Part, SolverOptions,
    Speed, Status, Storage, Values, damped_modes, forced_response,
};

/// A tridiagonal matrix by its diagonal and what stands beside it.
#[derive(Clone)]
struct Tridiagonal {
    diagonal: Vec<f64>,
    beside: Vec<f64>,
}

impl Tridiagonal {
    fn set(&self, model: &mut Model, kind: MatrixKind) {
        let n = self.diagonal.len();
        let (mut col_ptr, mut row_idx, mut values) = (vec![0_i64], Vec::new(), Vec::new());
        for j in 0..n {
            for i in j.saturating_sub(1)..=(j + 1).min(n - 1) {
                let v = if i == j {
                    self.diagonal[j]
                } else {
                    self.beside[i.min(j)]
                };
                if v != 0.0 {
                    row_idx.push(i as i64);
                    values.push(v);
                }
            }
            col_ptr.push(row_idx.len() as i64);
        }
        let view = MatrixView {
            rows: n,
            cols: n,
            storage: Storage::Csc {
                col_ptr: &col_ptr,
                row_idx: &row_idx,
            },
            values: Values::Real(&values),
            part: Part::Full,
            index_base: 0,
        };
        model.set_matrix(kind, &view).unwrap();
    }

    /// Number of eigenvalues of (K, M) below λ, M diagonal: the negative pivots of K − λM.
    fn below(&self, mass: &[f64], lambda: f64) -> usize {
        let mut pivot = 1.0;
        let mut count = 0;
        for (i, (d, m)) in self.diagonal.iter().zip(mass).enumerate() {
            let beside = if i == 0 { 0.0 } else { self.beside[i - 1] };
            pivot = d - lambda * m - beside * beside / pivot;
            count += usize::from(pivot < 0.0);
        }
        count
    }
}

/// A chain between two walls.
fn chain(n: usize) -> Tridiagonal {
    let spring = |i: usize| 1.0 + 0.3 * (i as f64).sin();
    Tridiagonal {
        diagonal: (0..n).map(|i| spring(i) + spring(i + 1)).collect(),
        beside: (1..n).map(|i| -spring(i)).collect(),
    }
}

fn model(stiffness: &Tridiagonal, mass: &[f64]) -> Model {
    let mut model = Model::new(mass.len()).unwrap();
    stiffness.set(&mut model, MatrixKind::Stiffness);
    let diagonal = Tridiagonal {
        diagonal: mass.to_vec(),
        beside: vec![0.0; mass.len() - 1],
    };
    diagonal.set(&mut model, MatrixKind::Mass);
    model
}

fn lowest(model: &Model, count: usize) -> Vec<f64> {
    model.lowest_modes(0, ContactState::Stuck, count).unwrap().omega
}

#[test]
fn a_diagonal_stiffness_below_zero_has_the_rate_of_growth() {
    let stiffness = Tridiagonal {
        diagonal: vec![-4.0, 1.0, 9.0],
        beside: vec![0.0; 2],
    };
    let omega = lowest(&model(&stiffness, &[1.0; 3]), 3);
    for (found, expected) in omega.iter().zip([-2.0, 1.0, 3.0]) {
        assert!((found - expected).abs() < 1e-14, "{omega:?}");
    }
    assert_eq!(omega.len(), 3);
}

#[test]
fn motions_that_grow_are_as_many_as_sturms_sequence_counts() {
    for n in [12, 100, 101, 150, 300, 500] {
        for unstable in [0, 1, 3] {
            let mut stiffness = chain(n);
            for k in 0..unstable {
                // Springs to the ground of −4 and less.
                stiffness.diagonal[(2 * k + 1) * n / 7] -= 6.3 + 0.4 * k as f64;
            }
            let mass: Vec<f64> = (0..n).map(|i| 1.0 + 0.2 * (2.0 * i as f64).cos()).collect();
            let omega = lowest(&model(&stiffness, &mass), 6);
            assert!(omega.is_sorted());
            assert_eq!(omega.iter().filter(|w| **w < 0.0).count(), unstable, "{n}: {omega:?}");
            for (k, w) in omega.iter().enumerate() {
                let lambda = w * w.abs();
                let near = |factor: f64| stiffness.below(&mass, lambda + factor * lambda.abs());
                assert_eq!((near(-1e-10), near(1e-10)), (k, k + 1), "{n}, {unstable}: {omega:?}");
            }
        }
    }
}

#[test]
fn a_free_chain_has_a_rigid_motion_and_none_that_grows() {
    for n in [5, 99, 150, 1000] {
        let mut stiffness = Tridiagonal {
            diagonal: vec![2e9; n],
            beside: vec![-1e9; n - 1],
        };
        (stiffness.diagonal[0], stiffness.diagonal[n - 1]) = (1e9, 1e9);
        let model = model(&stiffness, &vec![0.7; n]);
        let omega = lowest(&model, 4);
        assert!(omega[0] >= 0.0 && omega[0] < 1e-4 * omega[1], "{n}: {omega:?}");
        let damped = damped_modes(&model, 0, LinearContacts::Stuck, 3, &mut Hooks::default()).unwrap();
        let least = 1e-9 * omega[1];
        assert!(
            damped.eigenvalue.iter().all(|z| z.re < least && z.im > 0.0),
            "{n}: {:?}",
            damped.eigenvalue
        );
    }
}

#[test]
fn negative_stiffness_on_a_motion_without_mass_is_condensed_or_refused() {
    // Springs of 3 and −1 in series are one of 3·(−1)/(3 − 1) = −1.5; at the end of the chain it makes one motion grow.
    let n = 160;
    let mut stiffness = chain(n);
    let mut mass = vec![1.0; n];
    mass[n - 1] = 0.0;
    stiffness.diagonal[n - 1] = -0.5;
    let found = model(&stiffness, &mass).lowest_modes(0, ContactState::Stuck, 4);
    // The massless end has the pivot −0.5 whatever λ is, so that the other pivots count the modes.
    let below_zero = stiffness.below(&mass, 0.0) - 1;
    match found {
        Ok(modes) => assert_eq!(
            modes.omega.iter().filter(|w| **w < 0.0).count(),
            below_zero,
            "{:?}",
            modes.omega
        ),
        Err(e) => assert_eq!(e.status, Status::NotPositiveDefinite, "{e}"),
    }
}

#[test]
fn a_damped_motion_that_grows_without_oscillation_is_a_mode() {
    // λ² + 0.3λ − 4 = 0 beside two that oscillate; with gyroscopic forces between the others.
    let diagonal = |values: [f64; 3]| Tridiagonal {
        diagonal: values.to_vec(),
        beside: vec![0.0; 2],
    };
    let mut model = model(&diagonal([-4.0, 1.0, 9.0]), &[1.0; 3]);
    diagonal([0.3, 0.1, 0.1]).set(&mut model, MatrixKind::Damping);
    let found = damped_modes(&model, 0, LinearContacts::Stuck, 3, &mut Hooks::default()).unwrap();
    let rate = -0.15 + (0.15_f64 * 0.15 + 4.0).sqrt();
    assert_eq!(found.count(), 3);
    assert!((found.eigenvalue[0] - rate).norm() < 1e-13, "{:?}", found.eigenvalue);
    assert!((found.damping_ratio(0) + 1.0).abs() < 1e-15 && found.omega(0).abs() < 1e-15);
    assert!((found.omega(1) - (1.0_f64 - 0.0025).sqrt()).abs() < 1e-13);
    let gyroscopic = [0.0, 0.0, 0.0, 0.0, 0.0, 0.7, 0.0, -0.7, 0.0];
    model
        .set_matrix(MatrixKind::Gyroscopic, &MatrixView::dense(3, &gyroscopic))
        .unwrap();
    model.set_speed(Speed::Fixed(1.0)).unwrap();
    let omega = lowest(&model, 3);
    // The other two: (1 − ω²)(9 − ω²) = 0.49 ω².
    let (sum, product) = (10.0 + 0.49, 9.0_f64);
    let root = |sign: f64| (0.5 * (sum + sign * (sum * sum - 4.0 * product).sqrt())).sqrt();
    for (found, expected) in omega.iter().zip([-2.0, root(-1.0), root(1.0)]) {
        assert!((found - expected).abs() < 1e-12, "{omega:?}, {expected}");
    }
}

#[test]
fn modal_damping_of_a_motion_that_grows_is_refused() {
    let stiffness = Tridiagonal {
        diagonal: vec![-4.0, 1.0, 9.0],
        beside: vec![0.0; 2],
    };
    let e = model(&stiffness, &[1.0; 3]).set_modal_damping(&[0.01]).unwrap_err();
    assert!(e.status == Status::Argument && e.to_string().contains("grows"), "{e}");
}

/// Every third row of a chain under a penalty of 1e36, with its mass or without; the same chain with these rows fixed.
fn held(n: usize, with_mass: bool) -> (Model, Model) {
    let free = chain(n);
    let mut penalty = free.clone();
    let mut mass: Vec<f64> = (0..n).map(|i| 1.0 + 0.3 * (i as f64).cos()).collect();
    let fixed: Vec<usize> = (0..n).filter(|i| i % 7 == 0 || *i < n / 4).collect();
    let mut reference = model(&free, &mass);
    reference.fix(&fixed).unwrap();
    for &i in &fixed {
        penalty.diagonal[i] = 1e36;
        if !with_mass {
            mass[i] = 0.0;
        }
    }
    (model(&penalty, &mass), reference)
}

#[test]
fn degrees_of_freedom_under_a_penalty_are_fixed_ones() {
    for n in [9, 60, 100, 150, 400] {
        for with_mass in [true, false] {
            let (penalty, reference) = held(n, with_mass);
            let count = 4.min(n / 3);
            let (own, right) = (lowest(&penalty, count), lowest(&reference, count));
            for (own, right) in own.iter().zip(&right) {
                assert!((own / right - 1.0).abs() < 1e-11, "{n}: {own} and {right}");
            }
            let of = |model: &Model| {
                let found = damped_modes(model, 0, LinearContacts::Stuck, count, &mut Hooks::default()).unwrap();
                (0..count).map(|k| found.omega(k)).collect::<Vec<_>>()
            };
            for (own, right) in of(&penalty).iter().zip(of(&reference)) {
                assert!((own / right - 1.0).abs() < 1e-10, "{n}: {own} and {right}");
            }
            let modes = penalty.lowest_modes(0, ContactState::Stuck, count).unwrap();
            assert!(modes.shapes.chunks_exact(n).all(|shape| shape[0].norm() == 0.0));
        }
    }
}

#[test]
fn a_response_with_friction_beside_a_penalty_is_that_of_fixed_rows() {
    for n in [9, 60, 150] {
        let stuck = lowest(&held(n, true).1, 1)[0];
        let responses = |mut model: Model| {
            model.set_rayleigh(0.0, 1e-2).unwrap();
            let last = n - 1 - usize::from((n - 1) % 7 == 0);
            let contact = Contact::jenkins(last, None, 0.5, 0.3, 1.0);
            model.add_contact(&contact).unwrap();
            model.add_force(last, 1, 0.4.into()).unwrap();
            let range = ForcedOptions {
                at: &[0.9 * stuck, stuck, 1.1 * stuck],
                ..omega_range(0.8 * stuck, 1.3 * stuck)
            };
            let options = at_dof(last, SolverOptions::default());
            let branch = forced_response(&model, &options, &range, &mut Hooks::default()).unwrap();
            assert_eq!(branch.status(), Status::Ok, "{n}");
            let at = (0..3).flat_map(|i| branch.at(i).to_vec());
            let all = branch.peaks().iter().copied().chain(at);
            all.map(|p| (p.omega, p.amplitude)).collect::<Vec<_>>()
        };
        let (penalty, reference) = held(n, true);
        let (own, right) = (responses(penalty), responses(reference));
        assert!(own.len() == right.len() && own.len() > 2, "{n}: {own:?} and {right:?}");
        for (own, right) in own.iter().zip(&right) {
            assert!(
                (own.0 / right.0 - 1.0).abs() < 1e-8 && (own.1 / right.1 - 1.0).abs() < 1e-8,
                "{n}: {own:?} {right:?}"
            );
        }
    }
}
