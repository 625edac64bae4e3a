//! Aerodynamic influence coefficients without mirror symmetry: a sector of a wheel has the responses, modes and multipliers of the
//! full wheel whose matrices are built by hand, of closed forms, and of time integration.

use crate::common::mode_cases::follow;
use crate::common::models::{Structure, sector_of_faces};
use crate::common::refusal::refused;
use crate::common::{Wheel, all_harmonics, amplitude_range, harmonics, phase, relative_gap, slip, solve_at};
use crate::{multipliers, ordinary};
use hbvib::{
    AeroForm, Contact, FloquetOptions, Hooks, LinearContacts, MatrixKind, MatrixView, ModeOptions, Model, Part,
    SectorDescription, Status, TimeOptions, VerifyOptions, Waves, damped_modes, floquet, time_response, verify,
};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Sectors.
const N: usize = 6;
const MASS: [f64; 4] = [1.0, 0.1, 0.1, 0.8];
const DAMPING: [f64; 4] = [0.06, -0.01, -0.01, 0.05];
const STIFFNESS: [f64; 4] = [1.4, -0.3, -0.3, 1.1];
/// Without mirror symmetry: a wave and its opposite differ.
const NEXT: [f64; 4] = [-0.05, 0.08, -0.12, -0.02];
/// One neighbour is three sectors away.
const OFFSETS: [i64; 4] = [0, 1, -1, 3];
/// Row after row, one offset after another.
const PER_DISPLACEMENT: [f64; 16] = [
    -0.05, 0.03, 0.02, -0.04, 0.06, -0.02, 0.01, 0.03, -0.04, 0.01, -0.03, 0.02, 0.02, 0.01, -0.02, 0.015,
];
const PER_VELOCITY: [f64; 16] = [
    -0.02, 0.01, -0.01, -0.03, 0.012, 0.006, -0.01, 0.008, -0.015, 0.004, 0.002, -0.01, 0.004, -0.006, 0.003, 0.002,
];
const FORMS: [(AeroForm, &[f64; 16]); 2] = [
    (AeroForm::Displacement, &PER_DISPLACEMENT),
    (AeroForm::Velocity, &PER_VELOCITY),
];

fn complex(values: &[f64]) -> Vec<Complex64> {
    values.iter().map(|&c| c.into()).collect()
}

fn contacts() -> [Contact; 2] {
    let between = Contact {
        sector_offset: 1,
        ..Contact::jenkins(0, Some(1), 0.6, 0.5, 0.5)
    };
    [between, Contact::unilateral(Some(1), None, 0.7, 0.2)]
}

fn sector(engine_order: i64) -> Model {
    let mut model = Structure::cyclic(2, N)
        .mass(&MASS)
        .damping(&DAMPING)
        .stiffness(&STIFFNESS)
        .next(MatrixKind::Stiffness, &NEXT)
        .rayleigh(0.0, 0.01)
        .wave(engine_order)
        .contacts(contacts())
        .force(0, 1, 0.6)
        .build();
    for (form, coefficients) in FORMS {
        model.set_aero(&[0, 1], &complex(coefficients), &OFFSETS, form).unwrap();
    }
    model
}

/// A matrix of the wheel, column-major: K or C of the structure minus the coefficients.
fn around(own: &[f64; 4], next: &[f64; 4], coefficients: &[f64; 16]) -> Vec<f64> {
    let order = 2 * N;
    let mut a = vec![0.0; order * order];
    let mut add = |i: usize, j: usize, value: f64| a[j * order + i] += value;
    for s in 0..N {
        for i in 0..2 {
            for j in 0..2 {
                // `own` and `next` are column-major.
                add(2 * s + i, 2 * s + j, own[2 * j + i]);
                add(2 * s + i, 2 * ((s + 1) % N) + j, next[2 * j + i]);
                add(2 * ((s + 1) % N) + j, 2 * s + i, next[2 * j + i]);
                for (k, offset) in OFFSETS.iter().enumerate() {
                    let to = (s as i64 + offset).rem_euclid(N as i64) as usize;
                    add(2 * s + i, 2 * to + j, -coefficients[4 * k + 2 * i + j]);
                }
            }
        }
    }
    a
}

fn wheel(engine_order: i64) -> Model {
    let mut wheel = Wheel::new(2, N);
    wheel.set(MatrixKind::Mass, &MASS, None, None);
    let structural = |factor: f64, a: [f64; 4]| a.map(|a| factor * a);
    let damping: [f64; 4] = core::array::from_fn(|i| DAMPING[i] + 0.01 * STIFFNESS[i]);
    for (kind, a) in [
        (MatrixKind::Stiffness, around(&STIFFNESS, &NEXT, &PER_DISPLACEMENT)),
        (
            MatrixKind::Damping,
            around(&damping, &structural(0.01, NEXT), &PER_VELOCITY),
        ),
    ] {
        let view = MatrixView::dense(2 * N, &a).part(Part::General);
        wheel.model.set_matrix(kind, &view).unwrap();
    }
    for contact in contacts() {
        wheel.add_contact(&contact);
    }
    wheel.add_force(0, 1, 0.6.into(), engine_order);
    wheel.model
}

/// Largest distance of a number from the nearest of another list that no other one has taken.
fn gap(a: &[Complex64], b: &[Complex64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let mut left = b.to_vec();
    let mut worst = 0.0_f64;
    for a in a {
        let distance = |i: usize| (left[i] - a).norm();
        let nearest = (0..left.len()).min_by(|&i, &j| distance(i).total_cmp(&distance(j)));
        let nearest = nearest.unwrap();
        worst = worst.max(distance(nearest));
        left.swap_remove(nearest);
    }
    worst
}

#[test]
fn forced_waves_and_their_multipliers_are_those_of_the_full_wheel() {
    let mut radii = Vec::new();
    for engine_order in [1, -1, 2, -2, 3] {
        let (sector, wheel) = (sector(engine_order), wheel(engine_order));
        let (own, whole) = (
            solve_at(&sector, &harmonics(21), 1.05),
            solve_at(&wheel, &harmonics(21), 1.05),
        );
        assert!(slip(&own, 0) > 0.1);
        let (x, y) = (all_harmonics(&own, 0), all_harmonics(&whole, 0));
        let mut expected = Vec::new();
        for h in 0..=21 {
            for s in 0..N {
                let lag = phase(h, engine_order, s, N);
                expected.extend(x[2 * h..2 * h + 2].iter().map(|x| x * lag));
            }
        }
        let response = relative_gap(&expected, &y);
        let (blocks, all) = (
            multipliers(&sector, &own, 0, Waves::Wheel),
            multipliers(&wheel, &whole, 0, Waves::Wave),
        );
        let stability = gap(&ordinary(&blocks), &ordinary(&all));
        println!(
            "EO {engine_order}: response {response:.1e}, multipliers {stability:.1e}, radius {}",
            all.radius
        );
        assert!(response < 1e-10 && stability < 1e-8);
        radii.push(all.radius);
        let verified = verify(&sector, &own, 0, &VerifyOptions::default(), &mut Hooks::default()).unwrap();
        println!("    in time {:.1e}", verified.response_error);
        assert!(verified.same);
    }
    assert!((radii[2] - radii[3]).abs() > 1e-3, "opposite waves must differ");
}

#[test]
fn damped_modes_of_all_diameters_are_those_of_the_full_wheel() {
    let (sector, wheel) = (sector(1), wheel(1));
    let of = |model: &Model, diameter, count| {
        damped_modes(model, diameter, LinearContacts::Stuck, count, &mut Hooks::default())
            .unwrap()
            .eigenvalue
    };
    let mut whole = of(&wheel, 0, 2 * N);
    let signed = sector.structure().all_diameters();
    let found: Vec<Complex64> = signed.flat_map(|d| of(&sector, d, 2)).collect();
    assert_eq!(found.len(), whole.len());
    for lambda in found {
        let distance = |w: &Complex64| (w - lambda).norm();
        let nearest = (0..whole.len()).min_by(|a, b| distance(&whole[*a]).total_cmp(&distance(&whole[*b])));
        let gap = distance(&whole.swap_remove(nearest.unwrap()));
        assert!(gap < 1e-9, "{lambda}: {gap:.1e}");
    }
}

/// One degree of freedom and a force in harmonic h: X (k − A(d) − h²ω² m + ihω(c − A'(d))) = F, d = h·EO mod N.
#[test]
fn complex_coefficients_act_by_the_nodal_diameter_of_the_harmonic() {
    let (offsets, omega) = ([0, 1, -2], 0.8);
    let c = [
        [
            Complex64::new(-0.1, -0.05),
            Complex64::new(0.07, 0.02),
            Complex64::new(0.01, -0.06),
        ],
        [
            Complex64::new(-0.02, 0.01),
            Complex64::new(0.03, -0.04),
            Complex64::new(-0.05, 0.0),
        ],
    ];
    for engine_order in [1_i64, -1, 2, 7] {
        for h in [0_usize, 1, 3] {
            let mut model = Structure::cyclic(1, 5)
                .mass(&[1.0])
                .damping(&[0.03])
                .stiffness(&[3.0])
                .wave(engine_order)
                .force(0, h, 1.0)
                .build();
            for (form, c) in [AeroForm::Displacement, AeroForm::Velocity].into_iter().zip(&c) {
                model.set_aero(&[0], c, &offsets, form).unwrap();
            }
            let x = all_harmonics(&solve_at(&model, &harmonics(3), omega), 0)[h];
            let influence = |c: &[Complex64; 3]| -> Complex64 {
                let d = h as f64 * engine_order as f64;
                c.iter()
                    .zip(offsets)
                    .map(|(c, k)| c * Complex64::cis(-TAU * k as f64 * d / 5.0))
                    .sum()
            };
            let hw = h as f64 * omega;
            let (a, b) = (influence(&c[0]), influence(&c[1]));
            // No imaginary part acts on a constant motion.
            let a = if h == 0 { a.re.into() } else { a };
            let z = 3.0 - a - hw * hw + Complex64::new(0.0, hw) * (0.03 - b);
            let gap = (x * z - 1.0).norm();
            assert!(gap < 1e-12, "EO {engine_order}, harmonic {h}: {gap:.1e}");
        }
    }
}

/// One degree of freedom with a cubic spring γ and one harmonic: ω²(1 + 2iD) = k − A(d) + iω(c − A'(d)) + ¾γa².
#[test]
fn a_nonlinear_mode_has_frequency_and_damping_of_its_closed_form() {
    let (a, b) = ([-0.2, 0.3, -0.1], [-0.04, 0.05, 0.02]);
    let offsets = [0, 1, -1];
    let gamma = 0.7;
    for diameter in [1_i64, 2] {
        let mut model = Structure::cyclic(1, 5)
            .mass(&[1.0])
            .damping(&[0.03])
            .stiffness(&[3.0])
            .wave(diameter)
            .contact(Contact::cubic(0, None, 0.0, gamma))
            .build();
        model
            .set_aero(&[0], &complex(&a), &offsets, AeroForm::Displacement)
            .unwrap();
        model
            .set_aero(&[0], &complex(&b), &offsets, AeroForm::Velocity)
            .unwrap();
        let range = ModeOptions {
            diameter: Some(diameter),
            ..amplitude_range(-3.0, 0.5)
        };
        let branch = follow(&model, &harmonics(1), &range);
        let influence = |c: &[f64; 3]| -> Complex64 {
            let turn = |k: i64| Complex64::cis(-TAU * (k * diameter) as f64 / 5.0);
            c.iter().zip(offsets).map(|(c, k)| c * turn(k)).sum()
        };
        let mut worst = 0.0_f64;
        for point in 0..branch.points() {
            let mode = branch.mode_at(point).unwrap();
            let x = all_harmonics(&branch, point)[1].norm();
            let omega = branch.omega_at(point).unwrap();
            let stiffness =
                3.0 - influence(&a) + Complex64::new(0.0, omega) * (0.03 - influence(&b)) + 0.75 * gamma * x * x;
            let found = omega * omega * Complex64::new(1.0, 2.0 * mode.damping_ratio);
            worst = worst.max((found - stiffness).norm() / stiffness.norm());
        }
        println!("diameter {diameter}: {worst:.1e} in {} points", branch.points());
        assert!(worst < 1e-9);
        let cycles = branch.limit_cycles().unwrap();
        println!("{cycles:?}");
    }
}

#[test]
fn motions_in_time_are_those_of_harmonics() {
    let model = sector(-2);
    let branch = solve_at(&model, &harmonics(41), 1.05);
    let x = all_harmonics(&branch, 0);
    let options = TimeOptions {
        omega: 1.05,
        harmonics: 5,
        ..TimeOptions::default()
    };
    let found = time_response(&model, &options, &mut Hooks::default()).unwrap();
    let gap = relative_gap(&x[..12], &found.harmonics);
    println!("{gap:.1e}");
    assert!(gap < 1e-5);
}

#[test]
fn saved_models_and_copies_keep_the_influence() {
    let model = sector(1);
    let loaded = Model::load(&model.save().unwrap()).unwrap();
    let copy = model.try_clone().unwrap();
    let of = |model: &Model| all_harmonics(&solve_at(model, &harmonics(9), 1.05), 0);
    assert!(of(&loaded) == of(&model) && of(&copy) == of(&model));
    for (form, coefficients) in FORMS {
        let entries: Vec<_> = loaded.aero(form).unwrap().entries().collect();
        assert_eq!(entries.len(), 16);
        assert_eq!((entries[6].force, entries[6].motion, entries[6].offset), (1, 0, 1));
        assert!(
            entries
                .iter()
                .zip(coefficients)
                .all(|(e, &c)| e.coefficient == c.into())
        );
    }
    let mut without = model.try_clone().unwrap();
    for (form, _) in FORMS {
        without.set_aero(&[], &[], &[], form).unwrap();
    }
    assert!(without.aero(AeroForm::Velocity).is_none() && of(&without) != of(&model));
    // The format of a model without influence is the first one.
    assert_eq!((without.save().unwrap()[8], model.save().unwrap()[8]), (1, 2));
    let natural = |model: &Model| model.linear_modes(1, hbvib::ContactState::Stuck).unwrap().omega;
    assert_eq!(natural(&without), natural(&model));
}

/// A degree of freedom on the right face is that of the next sector.
#[test]
fn the_influence_on_a_face_acts_on_the_next_sector() {
    let responses: Vec<Vec<Complex64>> = [0, 1]
        .into_iter()
        .map(|dof| {
            let sector = SectorDescription {
                engine_order: 2,
                components: 1,
                ..sector_of_faces(2, 5, [&[Some(0)], &[Some(1)]])
            };
            let mut model = Model::sector(&sector).unwrap();
            for (kind, a) in [
                (MatrixKind::Mass, [0.5, 0.0, 0.0, 0.5]),
                (MatrixKind::Stiffness, [2.0, -0.7, -0.7, 2.0]),
            ] {
                model.set_matrix(kind, &MatrixView::dense(2, &a)).unwrap();
            }
            model.add_force(0, 1, 1.0.into()).unwrap();
            let c = complex(&[-0.1, 0.2, 0.05]);
            model.set_aero(&[dof], &c, &[0, 1, -2], AeroForm::Displacement).unwrap();
            all_harmonics(&solve_at(&model, &harmonics(1), 0.7), 0)
        })
        .collect();
    assert!(relative_gap(&responses[0], &responses[1]) < 1e-14);
}

#[test]
fn bad_influence_is_refused() {
    let mut model = sector(1);
    let one = [Complex64::ONE];
    let nan = [Complex64::new(0.0, f64::NAN)];
    let form = AeroForm::Displacement;
    for (dofs, coefficients, offsets, status, words) in [
        (&[2][..], &one[..], &[0][..], Status::Index, "dofs[0] = 2, needs 0 .. 1"),
        (&[0, 0], &one, &[0], Status::Argument, "dofs[0] and dofs[1]"),
        (
            &[0],
            &[Complex64::ONE; 2],
            &[1, -5],
            Status::Argument,
            "offsets[0] and offsets[1]",
        ),
        (
            &[0],
            &one,
            &[0, 1],
            Status::Dimension,
            "1 coefficients, needs 2 offsets",
        ),
        (
            &[0],
            &one,
            &[6],
            Status::Argument,
            "offsets[0] = 6, needs -5 .. 5 on 6 sectors",
        ),
        (
            &[0],
            &one,
            &[-(1 << 40)],
            Status::Argument,
            "offsets[0] = -1099511627776",
        ),
        (&[0], &nan, &[0], Status::NotFinite, "coefficients[0]"),
    ] {
        refused(model.set_aero(dofs, coefficients, offsets, form), status, &[words]);
    }
    assert_eq!(model.aero(form).unwrap().entries().len(), 16, "the model has changed");
    let mut plain = Model::new(2).unwrap();
    refused(
        plain.set_aero(&[0], &one, &[0], form),
        Status::Unsupported,
        &["plain structure"],
    );

    let complex_ones = [Complex64::new(-0.1, 0.05)];
    for form in [AeroForm::Displacement, AeroForm::Velocity] {
        let mut model = sector(1);
        model.set_aero(&[0], &complex_ones, &[0], form).unwrap();
        let branch = solve_at(&model, &harmonics(5), 1.05);
        let words = ["aerodynamic influence are complex"];
        let options = TimeOptions {
            omega: 1.05,
            ..TimeOptions::default()
        };
        refused(
            time_response(&model, &options, &mut Hooks::default()),
            Status::Unsupported,
            &words,
        );
        let stable = floquet(&model, &branch, 0, &FloquetOptions::default(), &mut Hooks::default());
        refused(stable, Status::Unsupported, &words);
        let verified = verify(&model, &branch, 0, &VerifyOptions::default(), &mut Hooks::default());
        refused(verified, Status::Unsupported, &words);
    }
    let krylov = hbvib::SolverOptions {
        flexibility: hbvib::Flexibility::Krylov,
        ..harmonics(5)
    };
    let range = hbvib::ForcedOptions {
        omega_start: 1.0,
        omega_stop: 1.1,
        at: &[],
        guess: None,
        responses: &[],
        together: false,
        ..hbvib::ForcedOptions::default()
    };
    let solved = hbvib::forced_response(&sector(1), &krylov, &range, &mut Hooks::default());
    refused(solved, Status::Unsupported, &["aerodynamic"]);
}
