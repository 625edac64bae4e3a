//! Laws in time, with and without events: harmonic balance tends to the motion in time as its harmonics
//! grow, and laws that contain each other move alike.

use crate::common::laws_in_time::{distances, forces, friction, in_time, oscillator, slanted, try_in_time};
use crate::common::relative_gap;
use hbvib::{Call, Contact, ContactKind, Monomial, Polynomial, Status, Table, TimeOptions, User, UserForce};
use std::sync::Arc;

/// Softening, then stiff, without symmetry.
fn table() -> Contact {
    let table = Table::new(&[-2.0, -0.7, 0.1, 0.6, 1.5], &[-2.6, -1.0, 0.02, 0.3, 2.0]).unwrap();
    Contact::between(0, None, ContactKind::Table(table))
}

#[test]
fn a_table_is_what_harmonic_balance_tends_to() {
    let model = oscillator(table(), 0.4, 0.1);
    for omega in [0.5, 1.2, 1.9] {
        let (truth, [coarse, fine]) = distances("table", &model, omega, [15, 63]);
        assert!(truth.events >= 2);
        assert!(fine < 1e-8 && fine < 0.1 * coarse);
    }
}

#[test]
fn a_table_of_two_lines_is_a_unilateral_spring() {
    let spring = Contact::unilateral(Some(0), None, 3.0, 0.2);
    let table = Table::new(&[-1.2, -0.2, 0.0], &[-3.0, 0.0, 0.0]).unwrap();
    let table = Contact::between(0, None, ContactKind::Table(table));
    let [a, b] = [spring, table].map(|c| in_time(&oscillator(c, 0.3, 0.0), 0.8, None));
    let error = relative_gap(&a.harmonics, &b.harmonics);
    println!("{error:.1e}, {} events", a.events);
    assert!(error < 1e-11);
    assert_eq!((a.events, b.events), (2, 2));
}

/// f = −c·v + c·x²·v: it feeds small motions and damps large ones.
fn van_der_pol(c: f64) -> Contact {
    let monomial = |coefficient, displacements: &'static [u32]| Monomial {
        direction: 0,
        coefficient,
        displacements,
        velocities: &[1],
    };
    let law = Polynomial::new(1, &[monomial(-c, &[0]), monomial(c, &[2])]).unwrap();
    Contact::between(0, None, ContactKind::Polynomial(law))
}

#[test]
fn a_van_der_pol_damper_under_forcing_is_what_harmonic_balance_tends_to() {
    for (omega, force) in [(1.0, 0.8), (1.3, 2.5)] {
        let model = oscillator(van_der_pol(0.8), force, 0.0);
        let (truth, [coarse, fine]) = distances("van der Pol", &model, omega, [9, 31]);
        assert_eq!(truth.events, 0);
        assert!(fine < 1e-12 && fine < 1e-3 * coarse);
    }
}

/// A full tensor over two motions, as a polynomial.
fn tensor() -> Polynomial {
    let linear = [0.5, -0.2, -0.2, 0.7];
    let quadratic = [0.1, 0.2, -0.1, 0.3, 0.0, 0.1, 0.2, -0.2];
    let mut cubic = [0.05; 16];
    (cubic[0], cubic[15], cubic[7]) = (0.4, 0.6, -0.1);
    Polynomial::tensors(2, &linear, &quadratic, &cubic).unwrap()
}

/// The same force of the caller, told by the polynomial's terms one by one; and what it was asked.
struct Host;

impl UserForce for Host {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        let (d, u) = (call.directions, call.u);
        for j in 0..call.samples {
            let (x, y, v) = (u[d * j], u[d * j + 1], call.v[d * j]);
            call.f[d * j] = x.sinh() + 0.3 * y * y + 0.2 * v * v * v;
            call.f[d * j + 1] = 0.6 * x * y;
            let k = &mut call.df_du[4 * j..4 * j + 4];
            k.copy_from_slice(&[x.cosh(), 0.6 * y, 0.6 * y, 0.6 * x]);
            call.df_dv[4 * j] = 0.6 * v * v;
        }
        0
    }
}

#[test]
fn smooth_laws_over_several_motions_are_what_harmonic_balance_tends_to() {
    let forces = [(0, 1, 1.0.into()), (2, 2, 0.4.into())];
    let caller = User::new(Arc::new(Host), 2, 1024).unwrap();
    for (name, kind) in [
        ("tensor", ContactKind::Polynomial(tensor())),
        ("host", ContactKind::User(caller)),
    ] {
        let model = slanted(&[Contact::over(vec![2, 0], kind)], &forces);
        for omega in [0.5, 1.4] {
            let (truth, [coarse, fine]) = distances(name, &model, omega, [5, 31]);
            assert_eq!(truth.events, 0);
            assert!(fine < 1e-12 && fine < 1e-3 * coarse, "{name}");
        }
    }
}

#[test]
fn regularised_friction_is_what_harmonic_balance_tends_to() {
    for velocity in [0.3, 0.05] {
        let model = slanted(
            &[Contact::regularised(0, Some(2), 0.4, 1.0, velocity)],
            &[(2, 1, 1.0.into())],
        );
        let (_, [coarse, fine]) = distances("tanh", &model, 1.1, [15, 63]);
        assert!(fine < 1e-5 && fine < 0.05 * coarse, "{velocity}");
    }
}

#[test]
fn a_cubic_spring_is_its_polynomial() {
    let cubic = Contact::cubic(0, None, 0.5, 0.3);
    let law = Polynomial::scalar(&[0.5, 0.0, 0.3], &[]).unwrap();
    let polynomial = Contact::between(0, None, ContactKind::Polynomial(law));
    let [a, b] = [cubic, polynomial].map(|c| in_time(&oscillator(c, 1.0, 0.1), 0.9, None));
    let error = relative_gap(&a.harmonics, &b.harmonics);
    println!("{error:.1e}");
    assert!(error < 1e-10);
}

#[test]
fn laws_with_and_without_events_are_followed_together() {
    let contacts = [
        friction(0.5, 0.5),
        Contact {
            dof_a: [Some(2), None, None],
            ..table()
        },
        Contact::regularised(2, Some(1), 0.2, 1.0, 0.3),
        van_der_pol(0.2),
    ];
    let model = slanted(&contacts, &forces(1.6));
    let (truth, [coarse, fine]) = distances("all", &model, 1.2, [15, 63]);
    assert!(truth.events >= 6);
    assert!(fine < 1e-7 && fine < 0.1 * coarse);
    // Newton's method converges as its exact derivative promises.
    assert!(truth.periods <= 12);
}

/// A caller that refuses motions beyond a size, or all of them.
struct Refusing {
    beyond: f64,
    code: i32,
}

impl UserForce for Refusing {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        call.f.fill(0.0);
        if call.u[0].abs() >= self.beyond { self.code } else { 0 }
    }
}

#[test]
fn what_a_callback_refuses_is_told() {
    let options = TimeOptions {
        omega: 0.9,
        ..TimeOptions::default()
    };
    for (beyond, code) in [(0.0, -3), (0.5, -3), (0.0, 7), (0.5, 7)] {
        let user = User::new(Arc::new(Refusing { beyond, code }), 1, 0).unwrap();
        let model = oscillator(Contact::between(0, None, ContactKind::User(user)), 1.0, 0.0);
        let error = try_in_time(&model, &options).unwrap_err();
        println!("{beyond}, {code}: {error}");
        assert_eq!((error.status, error.callback), (Status::Callback, code));
    }
}
