//! Every law in time: harmonic balance tends to the motion in time as its harmonics grow, and laws that
//! contain each other move alike.

mod common;

use common::{all_harmonics, harmonics, relative_gap, solve_at, sweep};
use hbvib::analysis::time_response::{TimeResponse, time_response};
use hbvib::contact::polynomial::{Monomial, Polynomial};
use hbvib::contact::table::Table;
use hbvib::contact::user::{Call, User, UserForce};
use hbvib::contact::{Contact, ContactKind};
use hbvib::error::{Error, Status};
use hbvib::hooks::Hooks;
use hbvib::linalg::matrix_view::MatrixView;
use hbvib::model::Model;
use hbvib::model::structure::MatrixKind;
use hbvib::options::{SteadyMethod, TimeOptions};
use num_complex::Complex64;
use std::sync::Arc;

/// Harmonics that are compared.
const COMMON: usize = 5;

/// A structure with contacts and forces (degree of freedom, harmonic, value).
fn model(n: usize, [m, c, k]: [&[f64]; 3], contacts: &[Contact], forces: &[(usize, usize, Complex64)]) -> Model {
    let mut model = Model::new(n).unwrap();
    for (which, a) in [
        (MatrixKind::Mass, m),
        (MatrixKind::Damping, c),
        (MatrixKind::Stiffness, k),
    ] {
        model.set_matrix(which, &MatrixView::dense(n, a)).unwrap();
    }
    for contact in contacts {
        model.add_contact(contact).unwrap();
    }
    for &(dof, harmonic, value) in forces {
        model.add_force(dof, harmonic, value).unwrap();
    }
    model
}

/// Mass 1, damping 0.05, stiffness 1 with a contact to the ground under a force of harmonic 1 and a mean one.
fn oscillator(contact: Contact, force: f64, mean: f64) -> Model {
    let forces = [(0, 1, force.into()), (0, 0, mean.into())];
    model(1, [&[1.0], &[0.05], &[1.0]], &[contact], &forces)
}

/// Masses that move along the surface (0) and along its normal (1), coupled; and one beyond (2).
fn slanted(contacts: &[Contact], forces: &[(usize, usize, Complex64)]) -> Model {
    let m = [1.0, 0.1, 0.0, 0.1, 1.2, 0.0, 0.0, 0.0, 0.8];
    let k = [3.0, -0.4, -1.0, -0.4, 2.5, -0.3, -1.0, -0.3, 2.0];
    let c = k.map(|k| 0.04 * k);
    model(3, [&m, &c, &k], contacts, forces)
}

/// Friction between the first two degrees of freedom of [`slanted`] and the ground.
fn friction(mu: f64, preload: f64) -> Contact {
    Contact::friction([Some(0), Some(1)], [None, None], (2.0, 3.0), mu, preload)
}

fn try_in_time(model: &Model, options: &TimeOptions<'_>) -> Result<TimeResponse, Error> {
    time_response(model, options, &mut Hooks::default())
}

fn in_time(model: &Model, omega: f64, start: Option<&[Complex64]>) -> TimeResponse {
    let options = TimeOptions {
        omega,
        harmonics: COMMON,
        start,
        ..TimeOptions::default()
    };
    let found = try_in_time(model, &options).unwrap();
    assert_eq!(found.status, Status::Ok);
    found
}

/// Integrates from the solution of 15 harmonics, and returns the distances from it of those with few and
/// with many.
fn distances(name: &str, model: &Model, omega: f64, [few, many]: [usize; 2]) -> (TimeResponse, [f64; 2]) {
    let balanced = |highest: usize| all_harmonics(&solve_at(model, &harmonics(highest), omega), 0);
    let truth = in_time(model, omega, Some(&balanced(15)));
    let errors = [few, many].map(|highest| {
        let found = balanced(highest);
        relative_gap(&found[..truth.harmonics.len()], &truth.harmonics)
    });
    println!(
        "{name}, {omega}: H = {few} {:.1e}, H = {many} {:.1e}; {} events, {} periods, residual {:.0e}",
        errors[0], errors[1], truth.events, truth.periods, truth.residual
    );
    (truth, errors)
}

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
        assert!(fine < 1e-6 && fine < 0.2 * coarse);
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

#[test]
fn friction_under_a_varying_load_is_what_harmonic_balance_tends_to() {
    let forces = |normal: f64| [(0, 1, 1.0.into()), (1, 1, Complex64::new(0.0, normal))];
    let mut open = 0;
    for (name, mu, preload, normal) in [
        ("closed", 0.4, 2.0, 0.6),
        ("lifting off", 0.4, 0.5, 1.5),
        ("much friction, lifting off", 1.5, 0.4, 1.5),
        ("gap", 0.8, 0.0, 1.2),
    ] {
        let mut contact = friction(mu, preload);
        if preload == 0.0 {
            contact.gap = 0.1;
        }
        let model = slanted(&[contact], &forces(normal));
        for omega in [0.7, 1.3, 2.2] {
            let (truth, [coarse, fine]) = distances(name, &model, omega, [15, 63]);
            open += usize::from(truth.events > 4);
            assert!(fine < 2e-4 && (fine < 0.3 * coarse || fine < 1e-9), "{name} at {omega}");
        }
    }
    assert!(open > 3);
}

#[test]
fn friction_under_a_load_that_stays_is_a_jenkins_contact() {
    // The normal motion is free of the others and not forced: its load is shared by two springs.
    let (m, k, c) = ([1.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 2.0], [0.05, 0.0, 0.0, 0.3]);
    let of = |contact| model(2, [&m, &c, &k], &[contact], &[(0, 1, 0.5.into())]);
    let varying = Contact::friction([Some(0), Some(1)], [None, None], (2.0, 3.0), 0.5, 1.0);
    let constant = Contact::jenkins(0, None, 2.0, 0.5, 1.0 * 2.0 / (2.0 + 3.0));
    for omega in [0.6, 1.1] {
        let [a, b] = [&varying, &constant].map(|c| in_time(&of(c.clone()), omega, None));
        let along = |x: &TimeResponse| x.harmonics.iter().step_by(2).copied().collect::<Vec<_>>();
        let error = relative_gap(&along(&a), &along(&b));
        println!(
            "{omega}: {error:.1e}, {} events, {} and {} periods",
            a.events, a.periods, b.periods
        );
        assert!(error < 1e-10 && a.events == 4);
        assert_eq!(a.events, b.events);
        // N = n₀ − kn·y = k·y at rest
        assert!((a.harmonics[1].re - 1.0 / 5.0).abs() < 1e-12);
    }
}

#[test]
fn friction_without_a_coefficient_is_a_unilateral_spring() {
    let forces = [(0, 1, 1.0.into()), (1, 1, 1.5.into())];
    let mut spring = Contact::unilateral(Some(1), None, 3.0, 0.0);
    spring.preload = 0.5;
    let [a, b] = [friction(0.0, 0.5), spring].map(|c| in_time(&slanted(&[c], &forces), 1.3, None));
    let error = relative_gap(&a.harmonics, &b.harmonics);
    println!("{error:.1e}, {} events", a.events);
    assert!(error < 1e-12 && a.events == b.events && a.events >= 2);
}

#[test]
fn marching_and_shooting_end_in_the_same_motion_with_separation() {
    let forces = [(0, 1, 1.0.into()), (1, 1, Complex64::new(0.0, 1.5))];
    for mu in [0.4, 1.5] {
        let model = slanted(&[friction(mu, 0.5)], &forces);
        let shot = in_time(&model, 1.3, None);
        let options = TimeOptions {
            omega: 1.3,
            harmonics: COMMON,
            method: SteadyMethod::Marching,
            ..TimeOptions::default()
        };
        let marched = try_in_time(&model, &options).unwrap();
        let error = relative_gap(&marched.harmonics, &shot.harmonics);
        println!(
            "mu = {mu}: {error:.1e}, {} and {} periods",
            marched.periods, shot.periods
        );
        assert!(error < 1e-9);
        // Newton's method converges as its exact derivative promises.
        assert!(shot.periods <= 20 && marched.periods > shot.periods);
    }
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
        assert!(coarse > 1e-8 && fine < 1e-9);
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

/// The same force of the host, told by the polynomial's terms one by one; and what it was asked.
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
    let host = User::new(Arc::new(Host), 2, 1024).unwrap();
    for (name, kind) in [
        ("tensor", ContactKind::Polynomial(tensor())),
        ("host", ContactKind::User(host)),
    ] {
        let model = slanted(&[Contact::over(vec![2, 0], kind)], &forces);
        for omega in [0.5, 1.4] {
            let (truth, [coarse, fine]) = distances(name, &model, omega, [5, 31]);
            assert_eq!(truth.events, 0);
            assert!(coarse > 1e-8 && fine < 1e-9, "{name}");
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
    let forces = [(0, 1, 1.0.into()), (1, 1, Complex64::new(0.0, 1.6))];
    let model = slanted(&contacts, &forces);
    let (truth, [coarse, fine]) = distances("all", &model, 1.2, [15, 63]);
    assert!(truth.events >= 6);
    assert!(fine < 1e-4 && fine < 0.3 * coarse);
    // Newton's method converges as its exact derivative promises.
    assert!(truth.periods <= 12);
}

/// A chain of three masses above each other, each pressed on the next by the weight of those above, on a
/// base that shakes it across and along.
#[test]
fn masses_pressed_statically_that_lift_off_are_what_harmonic_balance_tends_to() {
    let n = 6;
    // Across: 0, 1, 2; along: 3, 4, 5. Weak springs hold each mass to the frame.
    let (mut m, mut k, mut c) = (vec![0.0; n * n], vec![0.0; n * n], vec![0.0; n * n]);
    for i in 0..n {
        m[i * n + i] = 1.0 + 0.2 * (i % 3) as f64;
        k[i * n + i] = 0.8 + 0.1 * i as f64;
        c[i * n + i] = 0.25;
    }
    let pressed = |a: usize, b: Option<usize>, preload: f64| {
        Contact::friction([Some(a), Some(a + 3)], [b, b.map(|b| b + 3)], (4.0, 6.0), 0.3, preload)
    };
    let contacts = [
        pressed(0, None, 0.9),
        pressed(1, Some(0), 0.6),
        pressed(2, Some(1), 0.3),
    ];
    let forces = [
        (0, 1, 0.6.into()),
        (2, 1, 0.3.into()),
        (3, 1, Complex64::new(0.2, 0.7)),
        (5, 1, 0.5.into()),
    ];
    let model = model(n, [&m, &c, &k], &contacts, &forces);
    let mut most = 0;
    for omega in [0.9, 1.6] {
        let branch = sweep(&model, &harmonics(15), 0.5, omega, &[]);
        let start = all_harmonics(&branch, branch.points() - 1);
        let truth = in_time(&model, omega, Some(&start));
        let errors = [15, 63].map(|h| {
            let found = all_harmonics(&solve_at(&model, &harmonics(h), omega), 0);
            relative_gap(&found[..truth.harmonics.len()], &truth.harmonics)
        });
        println!(
            "{omega}: {errors:.1e?}, {} events, {} periods",
            truth.events, truth.periods
        );
        most = most.max(truth.events);
        assert!(errors[1] < 1e-3 && errors[1] < 0.5 * errors[0]);
    }
    assert!(most >= 9);
}

/// A host that refuses motions beyond a size, or all of them.
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
