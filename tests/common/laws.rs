//! A contact of every law in a vibration, for the tests of the states inside contacts.

use crate::common::energy::exactly;
use crate::common::models::dense;
use crate::common::solve_at;
use hbvib::{Branch, Call, Constant, Contact, ContactKind, Model, Polynomial, SolverOptions, Table, User, UserForce};
use num_complex::Complex64;
use std::sync::Arc;

/// Three masses, coupled and damped: 0 and 1 move along a surface, 2 along its normal.
pub fn structure() -> Model {
    dense(
        &[1.0, 0.0, 0.0, 0.0, 1.2, 0.0, 0.0, 0.0, 0.8],
        &[4.0, -0.5, 0.2, -0.5, 5.0, -0.3, 0.2, -0.3, 6.0],
    )
    .damping(&[0.06, 0.0, -0.01, 0.0, 0.05, 0.0, -0.01, 0.0, 0.04])
    .build()
}

pub type Forces = Vec<(usize, usize, Complex64)>;

/// A vibration of all three masses in the first harmonic, elliptic along the surface.
pub fn shaken() -> Forces {
    [(0, 1.0, 0.2), (1, -0.3, 0.9), (2, 2.0, -2.3)]
        .map(|(dof, re, im)| (dof, 1, Complex64::new(re, im)))
        .to_vec()
}

/// The same under constant forces, along and normal to the surface.
pub fn pulled() -> Forces {
    let constant = [(0, 0, 0.8.into()), (2, 0, 0.3.into())];
    shaken().into_iter().chain(constant).collect()
}

/// The same in other harmonics.
pub fn shaken_in(harmonics: &[usize]) -> Forces {
    let times = |h: usize| shaken().into_iter().map(move |(dof, _, f)| (dof, h, f));
    harmonics.iter().flat_map(|&h| times(h)).collect()
}

/// A plate in a fluid and in a field that couples its directions: a force that is no polynomial.
pub struct Plate;

impl Plate {
    pub fn force(u: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        let drag = (0.1 + v[0] * v[0] + v[1] * v[1]).sqrt();
        [u[0].sin() + 0.2 * drag * v[0], u[1].tanh() * u[0] + 0.2 * drag * v[1]]
    }
}

impl UserForce for Plate {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        for j in 0..call.samples {
            let at = |x: &[f64]| [x[2 * j], x[2 * j + 1]];
            let (u, v) = (at(call.u), at(call.v));
            call.f[2 * j..2 * j + 2].copy_from_slice(&Self::force(u, v));
            let (drag, tanh) = ((0.1 + v[0] * v[0] + v[1] * v[1]).sqrt(), u[1].tanh());
            let du = [u[0].cos(), 0.0, tanh, u[0] * (1.0 - tanh * tanh)];
            call.df_du[4 * j..4 * j + 4].copy_from_slice(&du);
            for (at, (a, b)) in [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter().enumerate() {
                let own = if a == b { drag } else { 0.0 };
                call.df_dv[4 * j + at] = 0.2 * (own + v[a] * v[b] / drag);
            }
        }
        0
    }
}

/// A contact in a vibration, with its requirements.
pub struct Case {
    pub name: &'static str,
    pub contact: Contact,
    pub omega: f64,
    pub highest: usize,
    /// Samples of the solution; 0 selects the number of the law.
    pub samples: usize,
    pub forces: Forces,
    /// Bound of the difference between area and work, over force times range.
    pub area: f64,
}

pub fn case(name: &'static str, contact: Contact) -> Case {
    Case {
        name,
        contact,
        omega: 1.7,
        highest: 9,
        samples: 0,
        forces: shaken(),
        area: 1e-6,
    }
}

/// At least one case of every law.
pub fn cases() -> Vec<Case> {
    let ground = [None; 3];
    let over = |kind| Contact::over(vec![0, 1], kind);
    let (tangents, all) = ([Some(0), Some(1), None], [Some(0), Some(1), Some(2)]);
    let plane = |dofs, load| Contact::friction_3d(dofs, ground, (2.5, 1.5), 0.4, load);
    let flat = |load| plane(tangents, load).with(Constant::Kn, 0.0).unwrap();
    let pair = |load| Contact::friction_2d([Some(0), Some(2)], [None; 2], (2.5, 1.5), 0.4, load);
    let table = Table::new(&[-0.5, -0.1, 0.2, 0.6], &[-1.4, -0.1, 0.3, 0.5]).unwrap();
    let damper = Polynomial::scalar(&[0.5, 0.3, 0.2], &[0.02, 0.0, 0.05]).unwrap();
    let caller = || ContactKind::User(User::new(Arc::new(Plate), 2, 0).unwrap());
    // These samples make the sampled law accurate enough for the bound of the area.
    let fine = |samples, case: Case| Case { samples, ..case };
    let with = |forces, case: Case| Case { forces, ..case };
    vec![
        case("Jenkins", Contact::jenkins(0, Some(1), 2.0, 0.5, 0.4)),
        case("Jenkins, stuck", Contact::jenkins(0, Some(1), 2.0, 0.5, 40.0)),
        case("cubic", Contact::cubic(0, Some(1), 0.5, 0.7)),
        case("unilateral", Contact::unilateral(None, Some(2), 3.0, 0.1)),
        case("friction, separating", pair(0.5)),
        case("friction, pressed", pair(1.5)),
        with(
            shaken_in(&[3]),
            Case {
                omega: 0.6,
                ..case("friction, in thirds", pair(0.5))
            },
        ),
        with(pulled(), case("friction, pulled and separating", pair(0.5))),
        fine(4096, with(pulled(), case("plane, pulled", plane(all, 0.5)))),
        case("friction, stuck", pair(1.5).with(Constant::Mu, 40.0).unwrap()),
        case("friction, a gap at rest", pair(0.0).with(Constant::Gap, 0.1).unwrap()),
        fine(4096, case("plane, separating", plane(all, 0.5))),
        fine(4096, case("plane, pressed", plane(all, 1.5))),
        fine(4096, case("plane, constant load", flat(0.5))),
        case("plane, stuck", flat(1.0).with(Constant::Mu, 40.0).unwrap()),
        fine(
            4096,
            with(
                shaken_in(&[3]),
                Case {
                    omega: 0.6,
                    ..case("plane, in thirds", flat(0.5))
                },
            ),
        ),
        fine(4096, case("tanh", Contact::regularised(0, Some(1), 0.5, 0.8, 0.3))),
        case("table", Contact::between(0, Some(1), ContactKind::Table(table))),
        case(
            "polynomial with damper",
            Contact::between(0, Some(1), ContactKind::Polynomial(damper)),
        ),
        fine(256, case("host", over(caller()))),
        fine(
            256,
            with(
                shaken_in(&[3, 6]),
                Case {
                    omega: 0.6,
                    highest: 15,
                    ..case("host, in thirds", over(caller()))
                },
            ),
        ),
    ]
}

pub fn solve(case: &Case) -> Branch {
    let mut model = structure();
    model.add_contact(&case.contact).unwrap();
    for &(dof, h, value) in &case.forces {
        model.add_force(dof, h, value).unwrap();
    }
    let solver = SolverOptions {
        samples: case.samples,
        ..exactly(case.highest)
    };
    solve_at(&model, &solver, case.omega)
}

pub fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)))
}
