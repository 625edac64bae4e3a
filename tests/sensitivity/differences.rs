//! Derivatives by every kind of parameter, with every law that has it, equal differences of converged solutions.

use crate::common::laws::{pulled, shaken};
use crate::common::{BASE, amplitude_range};
use crate::design::{Change, Design, Results, check};
use hbvib::MatrixKind::{Damping, Mass, Stiffness};
use hbvib::{Amplitude, Constant, Contact, DampingForm, ModeOptions};
use std::f64::consts::TAU;

const OF_CONTACT: [Constant; 7] = [
    Constant::Preload,
    Constant::Mu,
    Constant::Kt,
    Constant::Kn,
    Constant::Gap,
    Constant::Cubic,
    Constant::Velocity,
];

/// The constants of the first contact, and those of all together if there are several.
fn constants(design: &Design) -> Vec<Change> {
    let has = |c: &Constant| design.contacts[0].by_constant(*c).is_some();
    let mut changes = Vec::new();
    for constant in OF_CONTACT.into_iter().filter(has) {
        changes.push(Change::Contact(constant, Some(0)));
        if design.contacts.len() > 1 {
            changes.push(Change::Contact(constant, None));
        }
    }
    changes
}

/// Factors and directions of the structure.
fn structure(design: &Design, sizes: [f64; 3]) -> Vec<Change> {
    let n = design.ndof;
    let mut changes = Vec::new();
    for (kind, size) in [Mass, Damping, Stiffness].into_iter().zip(sizes) {
        let mut direction = vec![0.0; n * n];
        direction[n * n - 1] = size;
        direction[0] = 0.4 * size;
        changes.extend([Change::Factor(kind), Change::Direction(kind, direction)]);
    }
    changes
}

fn ring_damper() -> (Design, Vec<Change>) {
    let design = Design::ring_damper(&BASE, 300.0);
    let mut changes = vec![Change::Force];
    changes.extend(constants(&design));
    changes.extend(structure(&design, [1e-5, 1.0, 10.0]));
    (design, changes)
}

#[test]
fn forced_response_of_the_ring_damper() {
    let (design, changes) = ring_damper();
    for results in [Results::At(208.2 * TAU), Results::Peak(207.0 * TAU, 209.0 * TAU)] {
        let gap = check(&design, results, 9, &changes, 1e-6);
        println!("{results:?}: {gap:.1e}");
    }
}

#[test]
#[ignore = "takes a minute"]
fn forced_response_of_the_ring_damper_with_many_harmonics() {
    let (design, changes) = ring_damper();
    for results in [Results::At(208.2 * TAU), Results::Peak(207.0 * TAU, 209.0 * TAU)] {
        let gap = check(&design, results, 63, &changes, 1e-6);
        println!("{results:?}: {gap:.1e}");
    }
}

/// Three masses under vibrating and constant forces with contacts.
fn shaken_masses(contacts: Vec<Contact>) -> Design {
    let model = |values: [f64; 9]| values.to_vec();
    let mut design = Design::plain(
        3,
        [
            model([1.0, 0.0, 0.0, 0.0, 1.2, 0.0, 0.0, 0.0, 0.8]),
            model([0.06, 0.0, -0.01, 0.0, 0.05, 0.0, -0.01, 0.0, 0.04]),
            model([4.0, -0.5, 0.2, -0.5, 5.0, -0.3, 0.2, -0.3, 6.0]),
        ],
    );
    design.forces = if contacts[0].is_preloaded() { pulled() } else { shaken() };
    design.contacts = contacts;
    design
}

/// A contact of every law, and ten Jenkins contacts.
fn laws() -> Vec<(&'static str, Design)> {
    let plane = [Some(0), Some(1), None];
    let space = [Some(0), Some(1), Some(2)];
    let ten = (0..10).map(|i| {
        let i = f64::from(i);
        Contact::jenkins(usize::from(i > 5.0), None, 0.2 + 0.1 * i, 0.3, 0.2 + 0.5 * i)
    });
    [
        ("Jenkins", vec![Contact::jenkins(0, Some(1), 2.0, 0.4, 1.0)]),
        ("ten Jenkins", ten.collect()),
        (
            "friction 2d",
            vec![
                Contact::friction_2d([Some(0), Some(2)], [None, None], (3.0, 2.0), 0.4, 1.5)
                    .with(Constant::Gap, 0.05)
                    .unwrap(),
            ],
        ),
        (
            "friction 3d",
            vec![
                Contact::friction_3d(space, [None; 3], (3.0, 2.0), 0.4, 1.5)
                    .with(Constant::Gap, -0.1)
                    .unwrap(),
            ],
        ),
        (
            "friction 3d, constant load",
            vec![Contact::friction_3d(plane, [None; 3], (3.0, 0.0), 0.4, 1.5)],
        ),
        (
            "unilateral",
            vec![
                Contact::unilateral(Some(2), None, 3.0, 0.1)
                    .with(Constant::Preload, 0.3)
                    .unwrap(),
            ],
        ),
        ("cubic", vec![Contact::cubic(0, Some(1), 1.0, 0.3)]),
        ("regularised", vec![Contact::regularised(0, Some(1), 0.4, 1.0, 0.8)]),
        (
            "several laws",
            vec![
                Contact::friction_2d([Some(0), Some(2)], [Some(1), None], (3.0, 2.0), 0.4, 1.5),
                Contact::jenkins(1, None, 2.0, 0.4, 1.0),
                Contact::unilateral(Some(2), None, 3.0, 0.2)
                    .with(Constant::Preload, 0.2)
                    .unwrap(),
            ],
        ),
    ]
    .map(|(name, contacts)| (name, shaken_masses(contacts)))
    .to_vec()
}

#[test]
fn amplitude_under_every_law() {
    for (name, design) in laws() {
        let mut changes = vec![Change::Force];
        changes.extend(constants(&design));
        changes.extend(structure(&design, [1e-3, 1e-3, 1e-3]));
        let gap = check(&design, Results::At(1.9), 9, &changes, 1e-6);
        println!("{name}: {gap:.1e}");
    }
}

fn check_peaks(name: &str, design: &Design) {
    let mut changes = vec![Change::Force];
    changes.extend(constants(design));
    let gap = check(design, Results::Peak(1.3, 3.5), 5, &changes, 1e-6);
    println!("{name}: {gap:.1e}");
}

fn is_quick(name: &str) -> bool {
    !name.contains("3d") && !name.contains("several")
}

#[test]
fn peaks_under_every_law_but_friction_in_a_plane() {
    for (name, design) in laws().iter().filter(|(name, _)| is_quick(name)) {
        check_peaks(name, design);
    }
}

#[test]
#[ignore = "takes half a minute"]
fn peaks_with_friction_in_a_plane() {
    for (name, design) in laws().iter().filter(|(name, _)| !is_quick(name)) {
        check_peaks(name, design);
    }
}

/// A rotor whose damping, stiffness and normal load follow the speed.
#[test]
fn amplitude_by_speed() {
    let mut design = shaken_masses(vec![
        Contact::jenkins(0, Some(1), 2.0, 0.4, 1.0),
        Contact::friction_2d([Some(0), Some(2)], [None, None], (3.0, 2.0), 0.4, 1.5),
    ]);
    design.rotating = [
        vec![0.0, 0.3, 0.0, -0.3, 0.0, 0.1, 0.0, -0.1, 0.0],
        vec![0.2, 0.0, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.15],
    ];
    design.speed = 0.7;
    design.loss_factor = 0.02;
    design.rayleigh = (0.01, 0.02);
    design.speed_loads = vec![(0, 0.8, 0.6), (1, 1.2, -0.3)];
    let mut changes = vec![Change::Speed, Change::Force];
    changes.extend(structure(&design, [1e-3, 1e-3, 1e-3]));
    let gap = check(&design, Results::At(1.9), 7, &changes, 1e-6);
    println!("{gap:.1e}");
}

/// The mode that starts as the first linear one, up to an amplitude.
fn mode(log10: f64, amplitude: Amplitude, damping_form: DampingForm) -> ModeOptions<'static> {
    ModeOptions {
        amplitude,
        damping_form,
        ..amplitude_range(log10 - 0.4, log10)
    }
}

#[test]
fn mode_of_the_ring_damper() {
    let (design, changes) = ring_damper();
    for (log10, amplitude, form) in [
        (-4.2, Amplitude::Modal, DampingForm::Mass),
        (-4.2, Amplitude::Modal, DampingForm::Stiffness),
        (-4.6, Amplitude::Contact(0), DampingForm::Mass),
    ] {
        let results = Results::Mode(mode(log10, amplitude, form));
        let gap = check(&design, results, 9, &changes, 1e-6);
        println!("{amplitude:?}, {form:?}: {gap:.1e}");
    }
}

fn check_mode(name: &str, design: &Design) {
    let design = Design {
        rayleigh: (0.01, 0.004),
        ..design.clone()
    };
    let mut changes = vec![Change::Force];
    changes.extend(constants(&design));
    changes.extend(structure(&design, [1e-3, 1e-3, 1e-3]));
    let mut options = mode(0.1, Amplitude::Modal, DampingForm::Mass);
    if design.contacts.iter().any(Contact::is_preloaded) {
        options.log10_start = -1.5;
    }
    let gap = check(&design, Results::Mode(options), 5, &changes, 1e-6);
    println!("{name}: {gap:.1e}");
}

/// Regularised friction has no linear mode to start from.
fn has_mode(name: &str) -> bool {
    name != "regularised"
}

#[test]
fn modes_under_every_law_but_friction_in_a_plane() {
    for (name, design) in laws().iter().filter(|(name, _)| has_mode(name) && is_quick(name)) {
        check_mode(name, design);
    }
}

#[test]
#[ignore = "takes half a minute"]
fn modes_with_friction_in_a_plane() {
    for (name, design) in laws().iter().filter(|(name, _)| has_mode(name) && !is_quick(name)) {
        check_mode(name, design);
    }
}
