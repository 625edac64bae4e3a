//! Forces without their Jacobian: the same as with it, for every law; and they follow many harmonics in little memory.

use crate::common::laws::cases;
use hbvib::{Call, Contact, ContactKind, User, UserForce, contact_evaluate};
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::sync::Arc;

/// A spring beside a Maxwell element, whose state follows the motion within unit time.
struct Maxwell;

impl UserForce for Maxwell {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        let step = TAU / (call.omega * call.samples as f64);
        let mut before = call.states.z0[0];
        for (j, u) in call.u.iter().enumerate() {
            let z = (before + step * u) / (1.0 + step);
            call.states.z[j] = z;
            call.states.dz_dz[j] = 1.0 / (1.0 + step);
            call.states.dz_du[j] = step / (1.0 + step);
            call.states.dz_domega[j] = (u - z) / (1.0 + step) * -step / call.omega;
            call.f[j] = u.powi(3) + 0.4 * (u - z);
            call.df_du[j] = 3.0 * u * u + 0.4;
            call.states.df_dz[j] = -0.4;
            before = z;
        }
        0
    }
}

fn motion(directions: usize, highest: usize, seed: usize) -> Vec<Complex64> {
    let mut motion = Vec::new();
    for k in 0..directions {
        for h in 0..=highest {
            let turn = (7 * seed + 3 * k) as f64 + 2.4 * (h * h) as f64;
            motion.push(Complex64::cis(turn) / (1.0 + (h * h) as f64));
        }
    }
    motion
}

/// The forces without and with the Jacobian, and the largest.
fn both(contact: &Contact, (highest, samples): (usize, usize), seed: usize) -> [Vec<Complex64>; 2] {
    let d = contact.directions();
    let x = motion(d, highest, seed);
    let mut forces = [0, 1].map(|_| vec![Complex64::ZERO; x.len()]);
    let mut jacobian = vec![0.0; 4 * x.len() * x.len()];
    let [alone, beside] = &mut forces;
    contact_evaluate(contact, highest, samples, 1.3, &x, alone, None).unwrap();
    contact_evaluate(contact, highest, samples, 1.3, &x, beside, Some(&mut jacobian)).unwrap();
    forces
}

#[test]
fn it_is_the_force_beside_the_jacobian() {
    let mut contacts: Vec<(&str, Contact)> = cases().into_iter().map(|case| (case.name, case.contact)).collect();
    let maxwell = User {
        states: 1,
        velocity: false,
        ..User::new(Arc::new(Maxwell), 1, 0).unwrap()
    };
    contacts.push(("states", Contact::over(vec![0], ContactKind::User(maxwell))));
    for (name, contact) in &contacts {
        for highest in [0, 1, 2, 7, 24] {
            for samples in [0, 4 * highest + 16] {
                for seed in 0..3 {
                    let [alone, beside] = both(contact, (highest, samples), seed);
                    let size = beside.iter().fold(1e-3, |m: f64, f| m.max(f.norm()));
                    for (a, b) in alone.iter().zip(&beside) {
                        let claim = format!("{name}, H = {highest}, {samples} samples, motion {seed}: {a} for {b}");
                        assert!((a - b).norm() <= 1e-13 * size * (1.0 + highest as f64), "{claim}");
                    }
                }
            }
        }
    }
}

/// A slider that slips between −a and a has, per turn, F₁ in closed form (Den Hartog): with θ the angle at which stick ends,
/// cos θ = 1 − 2 μN/(kt a), Re F₁ = kt a (θ − sin 2θ/2)/π and Im F₁ = 4 μN (1 − μN/(kt a))/π.
#[test]
fn thousands_of_harmonics_keep_the_closed_form_of_the_first() {
    let (kt, limit, a) = (1.0, 0.3, 1.0);
    let contact = Contact::jenkins(0, None, kt, 0.3, 1.0);
    for highest in [1, 500, 6000] {
        let mut x = vec![Complex64::ZERO; highest + 1];
        let mut force = x.clone();
        x[1] = a.into();
        contact_evaluate(&contact, highest, 0, 1.0, &x, &mut force, None).unwrap();
        let theta = (1.0 - 2.0 * limit / (kt * a)).acos();
        let exact = Complex64::new(
            kt * a * (theta - 0.5 * (2.0 * theta).sin()),
            4.0 * limit * (1.0 - limit / (kt * a)),
        ) / std::f64::consts::PI;
        assert!(
            (force[1] - exact).norm() <= 1e-13,
            "H = {highest}: {} for {exact}",
            force[1]
        );
        // By symmetry there is none in even harmonics, and the others fall with the square of their number.
        for (h, f) in force.iter().enumerate() {
            let most = if h % 2 == 0 { 1e-13 } else { 2.0 / (h * h) as f64 };
            assert!(f.norm() <= most, "H = {highest}, {h}: {f}");
        }
    }
}
