//! Tests of perturbations.

use super::*;
use crate::contact::laws::Table;
use crate::contact::laws::{Monomial, Polynomial};
use crate::contact::{Contact, ContactKind};
use crate::interrupt::Interrupt;
use crate::linalg::sparse_storage::matrix_view::MatrixView;
use crate::model::Model;
use crate::model::matrices::structure::MatrixKind;
use crate::options::Waves;
use crate::stability::closures;
use crate::time_integration::{EventLoop, Observers, State};

/// Numbers in −1 … 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// A random damped structure of three masses under forces of two harmonics, excited along both motions of `contact`.
fn structure(random: &mut Random, contacts: &[Contact]) -> Model {
    const N: usize = 3;
    let mut model = Model::new(N).unwrap();
    let mut positive = |size: f64, diagonal: f64| {
        let mut a = [0.0; N * N];
        for i in 0..N {
            for j in 0..i {
                let v = 0.3 * size * random.next();
                (a[i * N + j], a[j * N + i]) = (v, v);
            }
            a[i * N + i] = diagonal * (1.0 + 0.3 * random.next());
        }
        a
    };
    for (kind, a) in [
        (MatrixKind::Mass, positive(1.0, 1.0)),
        (MatrixKind::Damping, positive(0.05, 0.1)),
        (MatrixKind::Stiffness, positive(1.0, 2.0)),
    ] {
        model.set_matrix(kind, &MatrixView::dense(N, &a)).unwrap();
    }
    for contact in contacts {
        model.add_contact(contact).unwrap();
    }
    for (dof, harmonic) in [(0, 1), (1, 1), (2, 3)] {
        let force = Complex64::new(random.next(), random.next());
        model.add_force(dof, harmonic, 1.5 * force).unwrap();
    }
    model
}

fn laws() -> Vec<(&'static str, Vec<Contact>)> {
    let table = Table::new(&[-1.0, -0.2, 0.3, 1.0], &[-1.5, -0.1, 0.1, 2.0]).unwrap();
    let terms = [
        Monomial {
            direction: 0,
            coefficient: 0.4,
            displacements: &[3],
            velocities: &[0],
        },
        Monomial {
            direction: 0,
            coefficient: 0.3,
            displacements: &[2],
            velocities: &[1],
        },
    ];
    let polynomial = Polynomial::new(1, &terms).unwrap();
    let plane = |preload| Contact::friction_2d([Some(0), Some(1)], [None, None], (2.0, 3.0), 0.6, preload);
    vec![
        ("friction", vec![Contact::jenkins(0, Some(1), 1.0, 0.5, 0.6)]),
        (
            "two sliders",
            vec![
                Contact::jenkins(0, None, 2.0, 0.5, 0.5),
                Contact::jenkins(1, Some(2), 1.0, 0.5, 0.3),
            ],
        ),
        ("stop", vec![Contact::unilateral(Some(0), None, 4.0, 0.1)]),
        (
            "friction and stop",
            vec![
                Contact::jenkins(0, Some(1), 1.0, 0.5, 0.6),
                Contact::unilateral(Some(2), None, 4.0, 0.1),
            ],
        ),
        ("varying load", vec![plane(1.0)]),
        ("varying load that lands often", vec![plane(0.1)]),
        ("table", vec![Contact::between(0, None, ContactKind::Table(table))]),
        ("cubic", vec![Contact::cubic(0, Some(1), 0.5, 0.4)]),
        (
            "cubic and friction",
            vec![
                Contact::cubic(0, Some(1), 0.5, 0.4),
                Contact::jenkins(1, None, 1.0, 0.5, 0.6),
            ],
        ),
        ("smooth friction", vec![Contact::regularised(0, None, 0.5, 0.6, 0.2)]),
        (
            "polynomial",
            vec![Contact::between(0, None, ContactKind::Polynomial(polynomial))],
        ),
    ]
}

/// Displacements, velocities and sliders after a lapse.
fn after(event_loop: &mut EventLoop, system: &mut System<'_>, z: &[f64]) -> (Vec<f64>, usize) {
    let n = system.order();
    let mut state = State::rest(system).unwrap();
    state.x.copy_from_slice(&z[..n]);
    state.v.copy_from_slice(&z[n..2 * n]);
    let mut slider = 2 * n;
    for (i, e) in system.elements.iter().enumerate() {
        if e.slider().is_some() {
            state.e[i] = e.relative(&state.x)[0] - z[slider];
            slider += 1;
        }
    }
    let summary = event_loop.run(system, &mut state, Observers::default()).unwrap();
    let mut found = state.x.clone();
    found.extend(&state.v);
    for (i, e) in system.elements.iter().enumerate() {
        if e.slider().is_some() {
            found.push(e.relative(&state.x)[0] - state.e[i]);
        }
    }
    (found, summary.events)
}

#[test]
fn perturbations_are_the_differences_of_neighbouring_motions() {
    let interrupt = Interrupt::none();
    // Half a minute for eight without optimisation.
    let seeds = if std::env::var_os("HBVIB_THOROUGH").is_some() {
        8
    } else {
        2
    };
    for (name, contacts) in laws() {
        let (mut worst, mut events) = (0.0_f64, 0);
        for seed in 1..=seeds {
            let mut random = Random(seed * 7919);
            let model = structure(&mut random, &contacts);
            let mut system = System::new(&model, 1.1 + 0.3 * random.next(), &interrupt).unwrap();
            let mut event_loop = EventLoop::new(&system, 1e-13).unwrap();
            let sliders = system.elements.iter().filter(|e| e.slider().is_some()).count();
            let z: Vec<f64> = (0..6 + sliders)
                .map(|i| if i < 6 { random.next() } else { 0.1 * random.next() })
                .collect();
            let list = closures(model.structure(), Waves::Wave, false).unwrap();
            let mut blocks = Blocks::new(model.structure(), &system, &list).unwrap();
            let mut state = State::rest(&system).unwrap();
            state.x.copy_from_slice(&z[..3]);
            state.v.copy_from_slice(&z[3..6]);
            let mut slider = 6;
            for (i, e) in system.elements.iter().enumerate() {
                if e.slider().is_some() {
                    state.e[i] = e.relative(&state.x)[0] - z[slider];
                    slider += 1;
                }
            }
            let observers = Observers {
                variation: Some(&mut blocks),
                ..Observers::default()
            };
            events += event_loop.run(&mut system, &mut state, observers).unwrap().events;
            let states = z.len();
            for j in 0..states {
                let mut moved = |step: f64| {
                    let mut z = z.clone();
                    z[j] += step;
                    after(&mut event_loop, &mut system, &z).0
                };
                let h = 2e-6;
                let (up, down) = (moved(h), moved(-h));
                for i in 0..states {
                    let difference = (up[i] - down[i]) / (2.0 * h);
                    let exact = blocks.list[0].carried(i, j);
                    worst = worst.max((exact - difference).norm());
                }
            }
        }
        println!("{name}: {worst:.1e} after {events} events");
        assert!(worst < 1e-5, "{name}: {worst:.1e}");
    }
}
