//! Batches of designs: each peak is that of the model built from the changed numbers, whatever the number of threads; a
//! design that fails is reported alone.

use crate::common::laws::cases;
use crate::common::models::{dense, sector_of_faces};
use crate::common::random;
use crate::common::{BASE, Blisk, omega_range};
use crate::design::{Change, Design, Results, tight};
use hbvib::{
    Batch, BatchOptions, Constant, Contact, Hooks, MatrixKind, MatrixView, Model, Parameter, Part, SectorDescription,
    SectorFrame, SolverOptions, Status, batch, forced_response,
};
use std::cell::Cell;
use std::f64::consts::TAU;

const RANGE: (f64, f64) = (200.0 * TAU, 215.0 * TAU);

const PRELOAD: Parameter<'static> = Parameter::Contact {
    constant: Constant::Preload,
    contact: None,
};

fn options(range: (f64, f64), threads: usize) -> BatchOptions<'static> {
    BatchOptions {
        omega_start: range.0,
        omega_stop: range.1,
        threads,
        keep: false,
        responses: &[],
    }
}

fn run(
    model: &Model,
    solver: &SolverOptions,
    options: &BatchOptions<'_>,
    (parameters, values): (&[Parameter<'_>], &[f64]),
) -> Batch {
    batch(model, solver, options, (parameters, values), &mut Hooks::default()).unwrap()
}

/// The value of a parameter after a change of the design by a step.
fn value(change: &Change, new: &Design, step: f64) -> f64 {
    match change {
        Change::Force | Change::Factor(_) => 1.0 + step,
        Change::Direction(..) => step,
        Change::Speed => new.speed,
        Change::Contact(constant, contact) => new.contacts[contact.unwrap_or(0)].constant(*constant),
    }
}

/// Three masses with friction under a varying load, a stop and a Jenkins contact, on a rotor.
fn rotor() -> Design {
    let matrices = [
        vec![1.0, 0.0, 0.0, 0.0, 1.2, 0.0, 0.0, 0.0, 0.8],
        vec![0.06, 0.0, -0.01, 0.0, 0.05, 0.0, -0.01, 0.0, 0.04],
        vec![4.0, -0.5, 0.2, -0.5, 5.0, -0.3, 0.2, -0.3, 6.0],
    ];
    Design {
        rayleigh: (0.01, 1e-3),
        loss_factor: 0.01,
        rotating: [
            vec![0.0, 0.2, 0.0, -0.2, 0.0, 0.0, 0.0, 0.0, 0.0],
            vec![0.1, 0.0, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.0],
        ],
        speed: 0.7,
        contacts: vec![
            Contact::jenkins(0, Some(1), 2.0, 0.5, 0.4),
            Contact::friction_2d([Some(0), Some(2)], [None; 2], (2.5, 1.5), 0.4, 1.5),
            Contact::unilateral(None, Some(2), 3.0, 0.1),
        ],
        forces: vec![(0, 1, 1.0.into()), (1, 1, 0.3.into()), (2, 1, 0.4.into())],
        ..Design::plain(3, matrices)
    }
}

#[test]
fn every_parameter_gives_the_peak_of_the_model_with_the_changed_numbers() {
    let constants = [
        Change::Contact(Constant::Preload, Some(0)),
        Change::Contact(Constant::Mu, Some(1)),
        Change::Contact(Constant::Kt, Some(0)),
        Change::Contact(Constant::Kn, Some(1)),
        Change::Contact(Constant::Gap, Some(2)),
        Change::Speed,
    ];
    let matrices = |n: usize| {
        let direction: Vec<f64> = (0..n * n).map(|e| if e == 0 { 0.3 } else { 0.0 }).collect();
        let all = [MatrixKind::Mass, MatrixKind::Damping, MatrixKind::Stiffness];
        let directions = all.map(|kind| Change::Direction(kind, direction.clone()));
        directions
            .into_iter()
            .chain(all.map(Change::Factor))
            .chain([Change::Force])
    };
    let wheel = Design::ring_damper(&BASE, 300.0);
    let of_wheel = matrices(4).chain([
        Change::Contact(Constant::Preload, None),
        Change::Contact(Constant::Kt, None),
    ]);
    let of_rotor = matrices(3).chain(constants);
    for (design, range, changes) in [
        (wheel, RANGE, of_wheel.collect::<Vec<_>>()),
        (rotor(), (1.2, 2.6), of_rotor.collect()),
    ] {
        let model = design.model();
        let solver = tight(5);
        for change in &changes {
            for step in [-0.01, 0.02] {
                let (new, _) = design.changed(change, step);
                let given = value(change, &new, step);
                let parameter = [change.parameter(&design)];
                let found = run(&model, &solver, &options(range, 1), (&parameter, &[given]));
                let (_, _, expected) = Results::Peak(range.0, range.1).solve(&new.model(), &solver);
                let peak = &found.peaks()[0];
                assert_eq!(peak.status, Status::Ok, "{change:?}");
                let gap = (peak.amplitude / expected[0].1 - 1.0).abs() + (peak.omega / expected[1].1 - 1.0).abs();
                assert!(gap < 1e-9, "{change:?} by {step}: {gap:.1e}");
            }
        }
    }
}

/// A direction on a sector with faces acts on both of its neighbours, too.
#[test]
fn a_direction_on_a_sector_with_faces_is_that_of_the_changed_matrix() {
    let side = |first: usize| [Some(first), Some(first + 1), Some(first + 2)];
    let stiffness = |p: f64| -> Vec<f64> {
        let plain = |i: usize, j: usize| {
            if i == j {
                9.0 + i as f64
            } else {
                -1.0 / (1.0 + i.abs_diff(j) as f64)
            }
        };
        (0..81).map(|e| plain(e / 9, e % 9) + p * direction(e)).collect()
    };
    let solve = |p: f64| {
        let (left, right) = (side(0), side(6));
        let mut model = Model::sector(&SectorDescription {
            engine_order: 3,
            frame: SectorFrame::Cartesian,
            ..sector_of_faces(9, 7, [&left, &right])
        })
        .unwrap();
        let mass: Vec<f64> = (0..81).map(|e| if e % 10 == 0 { 1.0 } else { 0.0 }).collect();
        model
            .set_matrix(MatrixKind::Mass, &MatrixView::dense(9, &mass))
            .unwrap();
        model
            .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(9, &stiffness(p)))
            .unwrap();
        model.set_rayleigh(0.1, 0.01).unwrap();
        model.add_contact(&Contact::jenkins(3, Some(5), 2.0, 0.4, 1.0)).unwrap();
        model.add_force(3, 1, 0.5.into()).unwrap();
        model
    };
    let added: Vec<f64> = (0..81).map(direction).collect();
    for part in [Part::Full, Part::General] {
        let parameter = Parameter::Direction {
            which: MatrixKind::Stiffness,
            direction: MatrixView::dense(9, &added).part(part),
        };
        let found = run(&solve(0.0), &tight(3), &options((2.0, 5.0), 1), (&[parameter], &[0.4]));
        let (_, _, expected) = Results::Peak(2.0, 5.0).solve(&solve(0.4), &tight(3));
        let peak = &found.peaks()[0];
        assert!((peak.amplitude / expected[0].1 - 1.0).abs() < 1e-10, "{part:?}");
        assert!((peak.omega / expected[1].1 - 1.0).abs() < 1e-10, "{part:?}");
    }
}

/// Entry of a symmetric matrix between both faces.
fn direction(entry: usize) -> f64 {
    match (entry / 9, entry % 9) {
        (i, j) if i == j => 1.0,
        (0, 7) | (7, 0) => 0.5,
        (3, 8) | (8, 3) => -0.3,
        _ => 0.0,
    }
}

/// Designs of the ring damper, reproducible.
fn designs(count: usize) -> Vec<f64> {
    let mut state = 7_u64;
    let mut random = || random::unit(&mut state);
    let one = |_| {
        [
            2e7 + 8e7 * random(),
            0.02 * 2500.0_f64.powf(random()) / Blisk::mu(),
            -0.025 + 0.047 * random(),
        ]
    };
    (0..count).flat_map(one).collect()
}

/// Bits of all results.
fn bits(found: &Batch) -> Vec<(u64, u64, Status, usize)> {
    let one = |p: &hbvib::DesignPeak| (p.amplitude.to_bits(), p.omega.to_bits(), p.status, p.points);
    found.peaks().iter().map(one).collect()
}

#[test]
fn the_number_of_threads_and_the_order_of_designs_change_no_bit() {
    let model = BASE.sector();
    let ring = [0.0; 15].iter().copied().chain([1.0]).collect::<Vec<_>>();
    let kt = Parameter::Contact {
        constant: Constant::Kt,
        contact: Some(0),
    };
    let mass = Parameter::Direction {
        which: MatrixKind::Mass,
        direction: MatrixView::dense(4, &ring),
    };
    let parameters = [kt, PRELOAD, mass];
    let mut values = designs(30);
    // Two that cannot be: a stiffness below zero, a load that is no number.
    (values[3 * 4], values[3 * 9 + 1]) = (-1.0, f64::NAN);
    let range = (205.0 * TAU, 213.0 * TAU);
    let solve = |threads, values: &[f64]| run(&model, &tight(9), &options(range, threads), (&parameters, values));
    let one = solve(1, &values);
    for threads in [2, 4, 64] {
        assert_eq!(bits(&solve(threads, &values)), bits(&one), "{threads} threads");
    }
    let backward: Vec<f64> = values.chunks(3).rev().flatten().copied().collect();
    let mut reversed = bits(&solve(2, &backward));
    reversed.reverse();
    assert_eq!(reversed, bits(&one));
    for (i, peak) in one.peaks().iter().enumerate() {
        match i {
            4 => {
                assert!(peak.status == Status::Argument && peak.reason.as_ref().unwrap().message().contains("kt = -1"));
            }
            9 => assert!(peak.status == Status::NotFinite && peak.amplitude.is_nan() && peak.omega.is_nan()),
            _ => assert!(
                peak.status == Status::Ok && peak.amplitude > 0.0 && peak.points > 0,
                "{i}: {peak:?}"
            ),
        }
    }
}

#[test]
fn peaks_of_the_ring_damper_are_the_references_and_branches_are_kept() {
    let reference = [
        [100.0, 207.845_047_9, 4.886_556_792e-3],
        [300.0, 208.097_030_8, 1.934_880_980e-3],
        [488.545_417_9, 208.814_072_9, 1.415_917_557e-3],
        [800.0, 209.376_838_4, 1.706_910_530e-3],
    ];
    let loads = reference.map(|row| row[0]);
    let options = BatchOptions {
        keep: true,
        ..options(RANGE, 2)
    };
    let mut found = run(&BASE.sector(), &tight(9), &options, (&[PRELOAD], &loads));
    for (i, [load, hertz, amplitude]) in reference.into_iter().enumerate() {
        let peak = found.peaks()[i].clone();
        assert!((peak.amplitude / amplitude - 1.0).abs() < 1e-8, "{load}: {peak:?}");
        assert!((peak.omega / TAU / hertz - 1.0).abs() < 1e-8, "{load}: {peak:?}");
        let branch = found.take_branch(i).unwrap();
        assert_eq!(branch.points(), peak.points);
        assert!(
            branch
                .peaks()
                .iter()
                .any(|p| p.amplitude.to_bits() == peak.amplitude.to_bits())
        );
        assert!(found.take_branch(i).is_none());
    }
}

#[test]
fn a_range_without_a_maximum_a_stop_and_bad_calls_are_told() {
    let model = BASE.sector();
    let solver = tight(3);
    let below = run(
        &model,
        &solver,
        &options((200.0 * TAU, 204.0 * TAU), 1),
        (&[PRELOAD], &[300.0]),
    );
    let peak = &below.peaks()[0];
    assert!(peak.status == Status::StoppedNoPeak && peak.amplitude.is_nan() && peak.points > 1);

    for threads in [1, 3] {
        let calls = Cell::new(0);
        let mut stop = |progress: &hbvib::Progress| {
            assert!(progress.point >= 1 && progress.fraction_done <= 1.0);
            calls.set(calls.get() + 1);
            calls.get() == 2
        };
        let mut hooks = Hooks {
            progress: Some(&mut stop),
            ..Hooks::default()
        };
        // So many that no thread solves half of them while another one waits for a core.
        let loads = [300.0; 2000];
        let found = batch(
            &model,
            &solver,
            &options(RANGE, threads),
            (&[PRELOAD], &loads),
            &mut hooks,
        )
        .unwrap();
        assert_eq!(found.status(), Status::StoppedByCaller);
        let solved = found.peaks().iter().filter(|p| p.status == Status::Ok).count();
        let left = found
            .peaks()
            .iter()
            .filter(|p| p.status == Status::StoppedByCaller)
            .count();
        assert!(
            (2..1000).contains(&solved) && solved + left == 2000,
            "{solved} solved by {threads} threads"
        );
        assert_eq!(calls.get(), 2);
    }

    let refused = |parameters: &[Parameter<'_>], values: &[f64], threads, status| {
        let options = options(RANGE, threads);
        let error = batch(&model, &solver, &options, (parameters, values), &mut Hooks::default()).unwrap_err();
        assert_eq!(error.status, status, "{error}");
    };
    let kn = Parameter::Contact {
        constant: Constant::Kn,
        contact: Some(0),
    };
    refused(&[], &[], 1, Status::Dimension);
    refused(&[PRELOAD, Parameter::Force], &[1.0; 3], 1, Status::Dimension);
    refused(&[kn], &[1.0], 1, Status::Unsupported);
    refused(&[PRELOAD], &[1.0], 0, Status::Argument);
    refused(&[PRELOAD], &[1.0], 2000, Status::Argument);
    assert!(
        run(&model, &solver, &options(RANGE, 3), (&[PRELOAD], &[]))
            .peaks()
            .is_empty()
    );

    let own = cases()
        .into_iter()
        .find(|case| case.contact.kind.user().is_some())
        .unwrap();
    let mut called = rotor().model();
    called.add_contact(&own.contact).unwrap();
    let error = batch(
        &called,
        &solver,
        &options((1.0, 2.0), 2),
        (&[Parameter::Force], &[1.0]),
        &mut Hooks::default(),
    );
    assert_eq!(error.unwrap_err().status, Status::Unsupported);
}

/// Bases of a large structure are prepared once, and are not changed by one design for another.
#[test]
fn designs_that_share_a_structure_find_the_peaks_of_single_solves() {
    let n = 120;
    let entry = |i: usize, j: usize| match i.abs_diff(j) {
        0 => 2.0,
        1 => -1.0,
        _ => 0.0,
    };
    let stiffness: Vec<f64> = (0..n * n).map(|e| entry(e / n, e % n)).collect();
    let mass: Vec<f64> = (0..n * n).map(|e| if e % (n + 1) == 0 { 1.0 } else { 0.0 }).collect();
    let model = dense(&mass, &stiffness)
        .rayleigh(0.0, 0.5)
        .slider(n / 2, 0.01, 0.3, 1.0)
        .force(n / 2, 1, 0.05)
        .build();
    let range = (0.015, 0.045);
    let solver = tight(3);
    let loads = [0.02, 0.2, 0.6, 1.5];
    let bits_of = |threads| bits(&run(&model, &solver, &options(range, threads), (&[PRELOAD], &loads)));
    assert_eq!(bits_of(1), bits_of(3));
    for (load, peak) in loads.iter().zip(bits_of(2)) {
        let mut one = model.clone();
        one.set_preload(0, *load).unwrap();
        let range = omega_range(range.0, range.1);
        let branch = forced_response(&one, &solver, &range, &mut Hooks::default()).unwrap();
        let highest = branch.peaks().iter().fold(0.0_f64, |m, p| m.max(p.amplitude));
        assert!((f64::from_bits(peak.0) / highest - 1.0).abs() < 1e-9, "{load}");
    }
}
