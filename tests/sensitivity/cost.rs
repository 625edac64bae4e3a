//! Derivatives by a hundred parameters take fewer evaluations of the contacts than three solutions of the point.

use crate::common::models::dense;
use crate::design::{Results, tight};
use hbvib::{
    Call, Constant, Contact, ContactKind, MatrixKind, MatrixView, Parameter, Quantity, User, UserForce, sensitivity,
};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

const N: usize = 8;

/// A linear damper that counts its evaluations.
#[derive(Default)]
struct Counted(AtomicUsize);

impl UserForce for Counted {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        self.0.fetch_add(1, Ordering::Relaxed);
        for j in 0..call.samples {
            call.f[j] = 0.02 * call.v[j];
            call.df_du[j] = 0.0;
            call.df_dv[j] = 0.02;
        }
        0
    }
}

fn diagonal(value: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut a = vec![0.0; N * N];
    for i in 0..N {
        a[i * N + i] = value(i);
    }
    a
}

#[test]
fn a_hundred_parameters_cost_less_than_three_solutions() {
    let counted = Arc::new(Counted::default());
    let mut stiffness = diagonal(|i| 2.0 + 0.1 * i as f64);
    for i in 1..N {
        stiffness[i * N + i - 1] = -1.0;
        stiffness[(i - 1) * N + i] = -1.0;
    }
    let law = User::new(counted.clone(), 1, 0).unwrap();
    let mut model = dense(&diagonal(|_| 1.0), &stiffness)
        .damping(&diagonal(|_| 0.03))
        .contact(Contact::between(0, None, ContactKind::User(law)))
        .build();
    for i in 0..N - 1 {
        model
            .add_contact(&Contact::jenkins(i, Some(i + 1), 1.0 + 0.1 * i as f64, 0.3, 0.8))
            .unwrap();
    }
    model.add_force(0, 1, 1.0.into()).unwrap();
    model.add_force(N - 1, 1, 0.5.into()).unwrap();
    let directions: Vec<Vec<f64>> = (0..N * N)
        .map(|k| {
            let mut a = vec![0.0; N * N];
            a[k] = 1.0;
            a
        })
        .collect();
    let mut parameters = vec![Parameter::Force];
    for contact in 1..N {
        parameters.extend(
            [Constant::Preload, Constant::Mu, Constant::Kt].map(|constant| Parameter::Contact {
                constant,
                contact: Some(contact),
            }),
        );
    }
    for a in &directions {
        let direction = MatrixView::dense(N, a).part(hbvib::Part::General);
        for which in [MatrixKind::Stiffness, MatrixKind::Damping] {
            parameters.push(Parameter::Direction { which, direction });
        }
    }
    assert!(parameters.len() > 100);
    let (branch, point, _) = Results::At(1.1).solve(&model, &tight(9));
    let solution = counted.0.swap(0, Ordering::Relaxed);
    assert!(branch.slip_fraction_at(point).unwrap().iter().any(|&slip| slip > 0.1));
    sensitivity(&model, &branch, point, &parameters, Quantity::Amplitude).unwrap();
    let adjoint = counted.0.swap(0, Ordering::Relaxed);
    println!(
        "{adjoint} evaluations for {} parameters, {solution} for the solution",
        parameters.len()
    );
    assert!(adjoint <= 3 * solution, "{adjoint}, {solution}");
    // One of the static force, one of the point.
    assert!(adjoint <= 3, "{adjoint}");
    let (branch, point, _) = Results::Peak(0.5, 2.5).solve(&model, &tight(9));
    counted.0.store(0, Ordering::Relaxed);
    sensitivity(&model, &branch, point, &parameters, Quantity::PeakOmega).unwrap();
    let adjoint = counted.0.load(Ordering::Relaxed);
    assert!(adjoint <= 3 * solution && adjoint <= 8, "{adjoint}, {solution}");
}
